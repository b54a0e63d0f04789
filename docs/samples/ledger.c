// Accounts: where the heat and the mass have gone, and that nothing is missing.
//
// Prints:
//   heat: 10 tenths by the fire, the rest by the match; 5 tenths lost, the rest still there
//   mass: 1.2 g, of which 0.6 burnt
//   the ledgers close
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.12f, 20, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1.2, 0, NULL));
    const SingeStats stats = singe_sim_stats(sim);
    const double all = stats.heat_in + stats.heat_of_combustion;
    printf("heat: %.0f tenths by the fire, the rest by the match; %.0f tenths lost, the rest still there\n",
           10 * stats.heat_of_combustion / all, 10 * stats.heat_lost / all);
    printf("mass: %.1f g, of which %.1f burnt\n", 1e3 * stats.mass_initial, 1e3 * stats.mass_burnt);
    printf("the ledgers %s\n", stats.ledgers_close ? "close" : "are open");
    singe_sim_destroy(sim);
}
