// Burns a sheet of paper of 15 cm that hangs from two corners, and says in every frame where it is and how hot.
//
//   cc burn.c $(pkg-config --cflags --libs singe-input) -o burn && ./burn
#include <singe/mesh.h>
#include <singe/singe.h>
#include <math.h>
#include <stdio.h>

static int fail(const SingeError *error) { return fprintf(stderr, "%s: %s\n", error->stage, error->message), 1; }

int main(void) {
    SingeError error;
    SingeMesh *mesh;
    SingeGridDef grid = singe_default_grid(); // any triangles or polygons: singe_mesh_create
    grid.size[0] = grid.size[1] = 0.15f, grid.cells[0] = grid.cells[1] = 40;
    if (singe_mesh_create_grid(&grid, &mesh, &error)) return fail(&error);
    SingeSheetDef sheet = singe_default_sheet(); // office paper
    singe_mesh_fill_sheet(mesh, &sheet);

    const SingePoseKey edge = {.position = {0.075f, 0, 0}, .rotation = {0, 0, 0, 1}};
    SingeSourceDef match = singe_default_source();
    match.kind = SINGE_SOURCE_SPOT, match.path_count = 1, match.path = &edge;
    match.radius = match.falloff = 0.01f, match.temperature = 1123, match.end = 0.5f;
    SingePinDef pin = singe_default_pin();
    pin.vertex_count = 2, pin.vertices = (const uint32_t[]){0, 40}; // two corners

    SingeSimDef def = singe_default_sim();
    def.pace = 5; // the fire runs five times as fast as a real one
    SingeSim *sim;
    if (singe_sim_create(&def, &sim, &error)) return fail(&error);
    if (singe_sim_add_sheet(sim, &sheet, &pin.sheet) || singe_sim_commit(sim) ||
        singe_sim_add_source(sim, &match, &(SingeSourceId){0}) || singe_sim_add_pin(sim, &pin, &(SingePinId){0}))
        return fail(singe_sim_error(sim));

    for (int frame = 1; frame <= 48; frame++) {
        if (singe_sim_advance(sim, 1.0 / 24, 0, NULL)) return fail(singe_sim_error(sim));
        const SingeView view = singe_sim_view(sim);
        float lowest = INFINITY, hottest = 0;
        for (uint32_t i = 0; i < view.particle_count; i++)
            if (view.particle_flags[i] & SINGE_ALIVE)
                lowest = fminf(lowest, view.position[i][2]), hottest = fmaxf(hottest, view.temperature[i]);
        printf("frame %2d: lowest at %4.0f mm, hottest %4.0f K, %3.0f %% burnt\n", frame, 1e3 * (double)lowest,
               (double)hottest, 100 * singe_sim_stats(sim).burnt_fraction);
    }
    singe_sim_destroy(sim);
    singe_mesh_destroy(mesh);
    return 0;
}
