// A material that varies over the sheet: the rate by noise, the grammage by an attribute of the vertices.
//
// Prints:
//   the thin half has burnt more than the thick one
#include "sample.h"

int main(void) {
    enum { CELLS = 20, VERTICES = (CELLS + 1) * (CELLS + 1) };
    float thick[VERTICES]; // 0 at the left, 1 at the right
    for (int i = 0; i < VERTICES; i++) thick[i] = (float)(i % (CELLS + 1)) / CELLS;
    const SingeAttribute attribute = {"thick", thick};
    const SingeField grows = {.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "thick"};
    const SingeField patches = {.kind = SINGE_FIELD_NOISE, .noise = {.scale = 0.02f, .octaves = 4, .seed = 1}};
    SingeGridDef grid = singe_default_grid();
    grid.size[0] = grid.size[1] = 0.15f, grid.cells[0] = grid.cells[1] = CELLS;
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create_grid(&grid, &mesh, &error), &error);
    SingeSheetDef sheet = singe_default_sheet();
    singe_mesh_fill_sheet(mesh, &sheet);
    sheet.attribute_count = 1, sheet.attributes = &attribute;
    sheet.material.grammage = singe_param_field(0.045f, 0.16f, &grows);    // kg/m2
    sheet.material.mass_rate = singe_param_field(4e-3f, 12e-3f, &patches); // uneven paper burns unevenly

    SingeSim *sim = sample_sim(singe_default_sim());
    TRY(sim, singe_sim_add_sheet(sim, &sheet, NULL));
    singe_mesh_destroy(mesh);
    SingeColliderDef table = singe_default_collider();
    table.position[2] = -0.001f;
    TRY(sim, singe_sim_add_collider(sim, &table, NULL));
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1.2, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    int burnt[2] = {0};
    for (uint32_t i = 0; i < view.particle_count; i++) burnt[view.rest_position[i][0] > 0] += view.mass[i] < 0.5f;
    printf("the thin half has burnt %s than the thick one\n", burnt[0] > burnt[1] ? "more" : "less");
    singe_sim_destroy(sim);
}
