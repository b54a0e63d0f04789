// Burns a sheet of paper that hangs from two corners. It prints, every frame, how low and how hot the sheet is.
//
//   cc burn.c $(pkg-config --cflags --libs singe-input) -lm -o burn && ./burn
#include <singe/mesh.h>
#include <singe/singe.h>
#include <math.h>
#include <stdio.h>

int main(void) {
    SingeGridDef grid = singe_default_grid(); // singe_mesh_create takes any triangles and polygons
    grid.size[0] = grid.size[1] = 0.15f, grid.cells[0] = grid.cells[1] = 40;
    SingeSheetDef sheet = singe_default_sheet(); // office paper
    SingePinDef corners = singe_default_pin();
    corners.vertex_count = 2, corners.vertices = (const uint32_t[]){0, 40};
    SingeSourceDef match = singe_default_source();
    match.kind = SINGE_SOURCE_SPOT, match.position[0] = 0.075f, match.radius = match.falloff = 0.01f;
    match.temperature = 1123, match.end = 0.5f;
    SingeSimDef def = singe_default_sim();
    def.pace = 5; // the fire burns five times as fast as a real one

    SingeMesh *mesh;
    SingeSim *sim;
    SingeError error;
    if (singe_mesh_create_grid(&grid, &mesh, &error) || singe_sim_create(&def, &sim, &error))
        return puts(error.message), 1;
    singe_mesh_fill_sheet(mesh, &sheet);
    int failed = singe_sim_add_sheet(sim, &sheet, &corners.sheet) || singe_sim_add_pin(sim, &corners, NULL) ||
                 singe_sim_add_source(sim, &match, NULL) || singe_sim_commit(sim);
    for (int frame = 1; frame <= 48 && !failed; frame++) {
        failed = singe_sim_advance(sim, 1.0 / 24, 0, NULL);
        const SingeView view = singe_sim_view(sim);
        float lowest = INFINITY, hottest = 0;
        for (uint32_t i = 0; i < view.particle_count; i++)
            if (view.particle_flags[i] & SINGE_ALIVE)
                lowest = fminf(lowest, view.position[i][2]), hottest = fmaxf(hottest, view.temperature[i]);
        printf("frame %2d: lowest at %4.0f mm, hottest %4.0f K\n", frame, 1e3 * (double)lowest, (double)hottest);
    }
    if (failed) puts(singe_sim_error(sim)->message);
    singe_sim_destroy(sim), singe_mesh_destroy(mesh);
    return failed;
}
