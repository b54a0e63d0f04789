// Burns a sheet of paper of 15 cm: a mesh, a match, and every frame where its vertices are and how hot they are.
//
//   cc burn.c $(pkg-config --cflags --libs singe) -o burn && ./burn
#include <singe/singe.h>
#include <math.h>
#include <stdio.h>

enum { CELLS = 40, CORNERS = CELLS + 1, FRAMES = 48, FRAMES_PER_SECOND = 24 };

static int fail(const SingeError *error) {
    fprintf(stderr, "%s: %s\n", error->stage, error->message);
    return 1;
}

int main(void) {
    static float positions[CORNERS][CORNERS][3]; // m
    static uint32_t cells[CELLS][CELLS][4];
    for (int y = 0; y < CORNERS; y++)
        for (int x = 0; x < CORNERS; x++) {
            positions[y][x][0] = 0.15f * ((float)x / CELLS - 0.5f);
            positions[y][x][1] = 0.15f * ((float)y / CELLS - 0.5f);
            const uint32_t corner = (uint32_t)(y * CORNERS + x);
            const uint32_t cell[4] = {corner, corner + 1, corner + 1 + CORNERS, corner + CORNERS};
            for (int i = 0; i < 4 && x < CELLS && y < CELLS; i++) cells[y][x][i] = cell[i];
        }
    SingeSheetDef sheet = singe_default_sheet(); // office paper
    sheet.vertex_count = CORNERS * CORNERS, sheet.positions = &positions[0][0][0];
    sheet.cell_count = CELLS * CELLS, sheet.cells = &cells[0][0][0];
    const SingePoseKey edge = {.position = {0.075f, 0, 0}, .rotation = {0, 0, 0, 1}};
    SingeSourceDef match = singe_default_source();
    match.kind = SINGE_SOURCE_SPOT, match.path_count = 1, match.path = &edge;
    match.radius = 0.01f, match.falloff = 0.01f, match.temperature = 1123, match.end = 0.5f;
    const uint32_t held[2] = {0, CORNERS - 1}; // two corners
    SingePinDef pin = singe_default_pin();
    pin.vertex_count = 2, pin.vertices = held;

    SingeSimDef def = singe_default_sim();
    def.pace = 5; // the fire runs five times as fast as a real one
    SingeSim *sim;
    SingeError error;
    SingeSourceId source;
    if (singe_sim_create(&def, &sim, &error)) return fail(&error);
    if (singe_sim_add_sheet(sim, &sheet, &pin.sheet) || singe_sim_commit(sim) ||
        singe_sim_add_source(sim, &match, &source) || singe_sim_add_pin(sim, &pin, &(SingePinId){0}))
        return fail(singe_sim_error(sim));

    for (int frame = 1; frame <= FRAMES; frame++) {
        const double end = (double)frame / FRAMES_PER_SECOND;
        while (singe_sim_view(sim).time + 0.5 * (double)def.time_step < end)
            if (singe_sim_step(sim)) return fail(singe_sim_error(sim));
        const SingeView view = singe_sim_view(sim);
        float lowest = INFINITY, hottest = 0;
        for (uint32_t i = 0; i < view.particle_count; i++) {
            if (!(view.particle_flags[i] & SINGE_ALIVE)) continue;
            lowest = fminf(lowest, view.position[i][2]), hottest = fmaxf(hottest, view.temperature[i]);
        }
        printf("frame %2d: lowest at %4.0f mm, hottest %4.0f K, %3.0f %% burnt\n", frame, 1e3 * (double)lowest,
               (double)hottest, 100 * singe_sim_stats(sim).burnt_fraction);
    }
    singe_sim_destroy(sim);
    return 0;
}
