// Air that turns: a vortex that lies on its side lifts a scrap of tissue off the table.
//
// Prints:
//   the scrap is high above the table
#include "sample.h"

int main(void) {
    SingeSheetDef tissue = singe_default_sheet();
    SingeError error;
    must(singe_material_preset("tissue", &tissue.material, &error), &error);
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, tissue, 0.1f, 16, 0.001f);
    sample_table(sim);
    SingeSourceDef vortex = singe_default_source();
    vortex.kind = SINGE_SOURCE_VORTEX, vortex.speed = 3, vortex.radius = 0.08f;
    vortex.position[0] = 0.1f, vortex.position[2] = 0.05f;
    vortex.direction[1] = 1, vortex.direction[2] = 0; // its axis; on the left of it the air rises
    TRY(sim, singe_sim_add_source(sim, &vortex, NULL));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.25, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    double height = 0;
    for (uint32_t i = 0; i < view.vertex_count; i++) height += (double)view.position[i][2] / view.vertex_count;
    printf("the scrap is %s the table\n", height > 0.1 ? "high above" : "on");
    singe_sim_destroy(sim);
}
