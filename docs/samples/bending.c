// Stiffness in N m: strips of the same mass are held at one end. The stiffer one hangs less.
//
// Prints:
//   1e-05 N m: hangs down
//   1e-03 N m: sticks out
#include "sample.h"

int main(void) {
    static const float stiffness[] = {1e-5f, 1e-3f};
    SingeSimDef def = singe_default_sim();
    def.solver.substeps = 0; // as many as the stiffness needs
    SingeSim *sim = sample_sim(def);
    SingeGridDef grid = singe_default_grid();
    grid.size[0] = 0.12f, grid.size[1] = 0.04f, grid.cells[0] = 24, grid.cells[1] = 8, grid.jitter = 0;
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create_grid(&grid, &mesh, &error), &error);
    float moved[25 * 9 * 3];
    for (int k = 0; k < 2; k++) {
        SingeSheetDef strip = singe_default_sheet();
        singe_mesh_fill_sheet(mesh, &strip);
        strip.material.bending = singe_param(stiffness[k]), strip.material.thickness = singe_param(3e-3f),
        strip.material.damping = singe_param(5);
        for (uint32_t i = 0; i < 3 * strip.vertex_count; i++)
            moved[i] = strip.positions[i] + (i % 3 == 1 ? 0.06f * (float)k : 0);
        strip.positions = moved;
        SingeSheetId id;
        TRY(sim, singe_sim_add_sheet(sim, &strip, &id));
        sample_pin(sim, id, -0.06f, 0.06f * (float)k, 0, 0.03f);
    }
    singe_mesh_destroy(mesh);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.7, 0, NULL));
    for (int k = 0; k < 2; k++) {
        const float z = singe_sim_view(sim).position[25 * 9 * k + 24][2]; // of the free end
        printf("%.0e N m: %s\n", (double)stiffness[k], z < -0.05f ? "hangs down" : "sticks out");
    }
    singe_sim_destroy(sim);
}
