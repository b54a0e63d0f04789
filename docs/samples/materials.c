// Materials by name: five squares, a material each, side by side, lit at the same time.
//
// Prints:
//   cotton        120 g/m2
//   newsprint      45 g/m2
//   office-paper   80 g/m2
//   one-reaction   80 g/m2
//   tissue         20 g/m2
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    SingeGridDef grid = singe_default_grid();
    grid.size[0] = 0.05f, grid.size[1] = 0.12f, grid.cells[0] = 10, grid.cells[1] = 24;
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create_grid(&grid, &mesh, &error), &error);
    for (uint32_t k = 0; singe_material_preset_name(k); k++) {
        SingeSheetDef sheet = singe_default_sheet();
        must(singe_material_preset(singe_material_preset_name(k), &sheet.material, &error), &error);
        printf("%-12s %4.0f g/m2\n", singe_material_preset_name(k), 1e3 * (double)sheet.material.grammage.value);
        singe_mesh_fill_sheet(mesh, &sheet);
        float moved[11 * 25 * 3];
        for (uint32_t i = 0; i < 3 * sheet.vertex_count; i++)
            moved[i] = sheet.positions[i] + (i % 3 == 0 ? 0.06f * ((float)k - 2) : i % 3 == 2 ? 0.001f : 0);
        sheet.positions = moved;
        TRY(sim, singe_sim_add_sheet(sim, &sheet, NULL));
        sample_match(sim, 0.06f * ((float)k - 2), -0.06f, 0);
    }
    singe_mesh_destroy(mesh);
    sample_table(sim);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.9, 0, NULL));
    singe_sim_destroy(sim);
}
