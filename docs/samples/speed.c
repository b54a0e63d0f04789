// Measured: how fast the front runs, of the fire's own time. Thinner paper burns faster.
//
// Prints:
//   40 g/m2 burns faster than 80 g/m2
#include "sample.h"

static double front(float grammage) {
    SingeSheetDef sheet = singe_default_sheet();
    sheet.material.grammage = singe_param(grammage);
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, sheet, 0.12f, 24, 0.001f);
    sample_table(sim);
    for (int i = -2; i <= 2; i++) sample_match(sim, -0.06f, 0.024f * (float)i, 0); // a straight front
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.8, 0, NULL));
    const double speed = singe_sim_stats(sim).front_speed; // m/s
    singe_sim_destroy(sim);
    return speed;
}

int main(void) {
    const double thin = front(0.04f), thick = front(0.08f);
    printf("40 g/m2 burns %s than 80 g/m2\n", thin > 1.2 * thick ? "faster" : "no faster");
}
