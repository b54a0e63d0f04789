// Wind that begins while the sheet burns: a mean velocity, and gusts of a seed.
//
// Prints:
//   without wind the lower edge is -10 mm to the side
//   with wind the lower edge is 70 mm to the side
#include "sample.h"

/// mm that the lowest particles are in front of the plane in which the sheet hangs.
static double aside(const SingeSim *sim) {
    const SingeView view = singe_sim_view(sim);
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < view.vertex_count; i++)
        if (view.particle_flags[i] & SINGE_ALIVE && view.rest_position[i][1] < -0.06f)
            sum += 1e3 * (double)view.position[i][1] - 75, count++;
    return 10 * round(sum / count / 10);
}

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.15f, 20, 0);
    sample_pin(sim, sheet, -0.075f, 0.075f, 0, 0.01f);
    sample_pin(sim, sheet, 0.075f, 0.075f, 0, 0.01f);
    sample_match(sim, 0.075f, -0.075f, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1, 0, NULL));
    printf("without wind the lower edge is %.0f mm to the side\n", aside(sim));

    SingeWindDef wind = singe_default_wind();
    wind.velocity[1] = 2, wind.gust = 0.5f, wind.seed = 7; // m/s
    TRY(sim, singe_sim_set_wind(sim, &wind));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    printf("with wind the lower edge is %.0f mm to the side\n", aside(sim));
    singe_sim_destroy(sim);
}
