#include "bench/options.h"

#include <math.h>

static const char *const solver_names[] = {"strand", "paper", "paper-literal", "all-at-once", "mass-spring"};
static const char *const instruction_names[] = {"best", "plain", "v2", "v3", "v4", "neon"};

const char *options_solver_name(SingeSolverMethod method) { return solver_names[method]; }
const char *options_instructions_name(SingeInstructions instructions) { return instruction_names[instructions]; }

int options_cells(double springs) {
    double cells = round(sqrt(springs / 10));
    return cells < 2 ? 2 : (int)cells;
}

BenchList bench_list(const BenchList *asked, int count, const double *defaults) {
    if (asked->count) return *asked;
    BenchList list = {.count = count};
    for (int i = 0; i < count; i++) list.values[i] = defaults[i];
    return list;
}
