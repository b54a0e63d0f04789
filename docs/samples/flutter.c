// Restless air: turbulence makes a page flutter that hangs still in calm air.
//
// Prints:
//   calm: still, turbulent: fluttering
#include "sample.h"

int main(void) {
    SingeSheetDef sheet = singe_default_sheet();
    sheet.material.damping = singe_param(4);
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId page = sample_sheet(sim, sheet, 0.15f, 16, 0);
    for (int i = 0; i < 2; i++) sample_pin(sim, page, i ? 0.075f : -0.075f, 0.075f, 0, 0.01f);
    SingeSourceDef air = singe_default_source();
    air.kind = SINGE_SOURCE_TURBULENCE, air.speed = 2, air.radius = 0.04f; // the size of its swirls
    air.start = 1.5f;
    TRY(sim, singe_sim_add_source(sim, &air, NULL));
    TRY(sim, singe_sim_commit(sim));
    double speed[2];
    for (int i = 0; i < 2; i++) {
        TRY(sim, singe_sim_advance(sim, i ? 0.5 : 1.5, 0, NULL));
        speed[i] = singe_sim_stats(sim).speed_rms_unburnt;
    }
    printf("calm: %s, turbulent: %s\n", speed[0] < 0.05 ? "still" : "moving", speed[1] > 0.1 ? "fluttering" : "still");
    singe_sim_destroy(sim);
}
