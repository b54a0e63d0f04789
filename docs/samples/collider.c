// Cotton falls over a sphere that is hot, and smoulders where it touches.
//
// Prints:
//   after 0.5 s lowest at 0 mm, hottest 1200 K
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    SingeSheetDef sheet = singe_default_sheet();
    SingeError error;
    must(singe_material_preset("cotton", &sheet.material, &error), &error);
    sample_sheet(sim, sheet, 0.2f, 24, 0.11f);

    SingeColliderDef ball = singe_default_collider();
    ball.kind = SINGE_COLLIDER_SPHERE, ball.radius = 0.05f, ball.position[2] = 0.05f;
    ball.temperature = 1000, ball.conductance = 300; // K, W/(m2 K); 0, the default, exchanges no heat
    TRY(sim, singe_sim_add_collider(sim, &ball, NULL));
    sample_table(sim);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));

    const SingeView view = singe_sim_view(sim);
    float lowest = INFINITY;
    for (uint32_t i = 0; i < view.particle_count; i++)
        if (view.particle_flags[i] & SINGE_ALIVE) lowest = fminf(lowest, view.position[i][2]);
    printf("after 0.5 s lowest at %.0f mm, hottest %.0f K\n", 10 * round(100 * (double)lowest),
           100 * round((double)singe_sim_stats(sim).temperature_max / 100));
    singe_sim_destroy(sim);
}
