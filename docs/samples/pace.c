// Slow motion: the pace of the fire changes while it burns. Motion keeps its own time.
//
// Prints:
//   at pace 12 half a second burns 10 times as much as at pace 1
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.15f, 24, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.6, 0, NULL));
    double burnt[3] = {singe_sim_stats(sim).burnt_fraction};
    for (int i = 0; i < 2; i++) {
        TRY(sim, singe_sim_set_pace(sim, i ? 12 : 1)); // seconds of fire a second
        TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
        burnt[i + 1] = singe_sim_stats(sim).burnt_fraction;
    }
    const double slow = burnt[1] - burnt[0], fast = burnt[2] - burnt[1];
    printf("at pace 12 half a second burns %s as much as at pace 1\n", fast > 9 * slow ? "10 times" : "about");
    singe_sim_destroy(sim);
}
