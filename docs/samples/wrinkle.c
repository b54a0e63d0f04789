// Without ablation nothing is removed: the sheet chars, shrinks and wrinkles, and stays whole.
//
// Prints:
//   gone: 105 of 400 cells left
//   whole: 400 of 400 cells left
#include "sample.h"

int main(void) {
    for (int whole = 0; whole < 2; whole++) {
        SingeSim *sim = sample_sim(singe_default_sim());
        SingeSheetDef sheet = singe_default_sheet();
        sheet.material.ablate = !whole;
        sheet.material.char_yield = singe_param(0.05f); // little char, which would stay
        sample_sheet(sim, sheet, 0.08f, 20, 0.001f);
        sample_table(sim);
        SingeSourceDef fire = singe_default_source();
        fire.radius = 0.1f, fire.temperature = 1100, fire.end = 1;
        TRY(sim, singe_sim_add_source(sim, &fire, NULL));
        TRY(sim, singe_sim_commit(sim));
        TRY(sim, singe_sim_advance(sim, 1.5, 0, NULL));
        const SingeStats stats = singe_sim_stats(sim);
        printf("%s: %u of %u cells left\n", whole ? "whole" : "gone", stats.cells, singe_sim_view(sim).cell_count);
        singe_sim_destroy(sim);
    }
}
