#include "bench/options.h"

#include <math.h>

int options_cells(double springs) {
    double cells = round(sqrt(springs / 10));
    return cells < 2 ? 2 : (int)cells;
}

int options_substeps(const BenchOptions *options) { return options->substeps ? options->substeps : 3; }

BenchList bench_list(const BenchList *asked, int count, const double *defaults) {
    if (asked->count) return *asked;
    BenchList list = {.count = count};
    for (int i = 0; i < count; i++) list.values[i] = defaults[i];
    return list;
}
