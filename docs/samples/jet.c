// A breath blows a fire out: a jet of air takes the flame's heat away, and the paper cools.
//
// Prints:
//   0.5 s: burning
//   1.0 s: out
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.12f, 20, 0.05f);
    for (int i = 0; i < 4; i++) sample_pin(sim, sheet, i & 1 ? 0.06f : -0.06f, i & 2 ? 0.06f : -0.06f, 0.05f, 0.01f);
    sample_match(sim, 0, 0, 0.05f);
    SingeSourceDef breath = singe_default_source();
    breath.kind = SINGE_SOURCE_JET, breath.radius = 0.02f, breath.speed = 12;
    breath.position[0] = -0.15f, breath.position[2] = 0.05f;
    breath.direction[0] = 1, breath.direction[2] = 0;
    breath.start = 0.55f, breath.end = 0.9f;
    TRY(sim, singe_sim_add_source(sim, &breath, NULL));
    TRY(sim, singe_sim_commit(sim));
    for (int half = 1; half <= 2; half++) {
        TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
        printf("%.1f s: %s\n", half * 0.5, singe_sim_stats(sim).temperature_max > 500 ? "burning" : "out");
    }
    singe_sim_destroy(sim);
}
