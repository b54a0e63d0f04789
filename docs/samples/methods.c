// Solvers: the same sheet hangs by each, within so much of its lengths: strands, the paper's projection, Hooke's springs.
//
// Prints:
//   strands         0.2 %
//   fast projection 2 %
//   Hooke           0.2 %
#include "sample.h"

int main(void) {
    static const struct {
        SingeSolverMethod method;
        const char *name;
    } methods[] = {
        {SINGE_SOLVER_STRAND, "strands"}, {SINGE_SOLVER_PAPER, "fast projection"}, {SINGE_SOLVER_MASS_SPRING, "Hooke"}};
    for (int k = 0; k < 3; k++) {
        SingeSimDef def = singe_default_sim();
        singe_init_solver_method(&def.solver, sizeof def.solver, methods[k].method); // with its own settings
        SingeSim *sim = sample_sim(def);
        const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.12f, 8, 0);
        sample_pin(sim, sheet, -0.06f, 0.06f, 0, 0.005f);
        sample_pin(sim, sheet, 0.06f, 0.06f, 0, 0.005f);
        TRY(sim, singe_sim_commit(sim));
        TRY(sim, singe_sim_advance(sim, 0.2, 0, NULL));
        const double strain = singe_sim_stats(sim).strain_p99;
        printf("%-15s %s\n", methods[k].name, strain < 0.002 ? "0.2 %" : strain < 0.02 ? "2 %" : "more");
        singe_sim_destroy(sim);
    }
}
