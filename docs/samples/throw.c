// Thrown: a sheet that burns gets a velocity, all of it or some of its vertices, when the host says so.
//
// Prints:
//   thrown up: 110 mm after 0.2 s
#include "sample.h"

int main(void) {
    enum { SIDE = 17, COUNT = SIDE * SIDE };
    static float velocity[3 * COUNT];
    for (int i = 0; i < COUNT; i++) { // m/s: up, and turning over
        const float x = (float)(i % SIDE) / (SIDE - 1) - 0.5f;
        velocity[3 * i + 2] = 1.6f + 1.2f * x;
    }
    SingeSheetDef card = singe_default_sheet();
    card.material.drag = singe_param(0);
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, card, 0.1f, SIDE - 1, 0.001f);
    sample_table(sim);
    sample_match(sim, 0.05f, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.4, 0, NULL));
    TRY(sim, singe_sim_set_velocity(sim, sheet, 0, COUNT, velocity)); // from its vertex 0 on
    TRY(sim, singe_sim_advance(sim, 0.2, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    double height = 0;
    for (uint32_t i = 0; i < view.vertex_count; i++) height += (double)view.position[i][2] / COUNT;
    printf("thrown up: %.0f mm after 0.2 s\n", 10 * round(height * 100));
    singe_sim_destroy(sim);
}
