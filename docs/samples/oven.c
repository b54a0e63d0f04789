// An oven: the surroundings heat up, and paper that no flame touches browns and catches fire by itself.
//
// Prints:
//   at 400 K it stays, at 700 K it has ignited
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.1f, 12, 0.001f);
    sample_table(sim);
    TRY(sim, singe_sim_commit(sim));
    const char *word[2];
    for (int i = 0; i < 2; i++) {
        TRY(sim, singe_sim_set_ambient_temperature(sim, i ? 700 : 400));
        TRY(sim, singe_sim_advance(sim, 2, 0, NULL));
        const SingeView view = singe_sim_view(sim); // its arrays are new ones
        word[i] = view.time_ignited[0] < 0 ? "stays" : "has ignited";
    }
    printf("at 400 K it %s, at 700 K it %s\n", word[0], word[1]);
    singe_sim_destroy(sim);
}
