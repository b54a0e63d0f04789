// The direction in which fire spreads faster: strips of office paper in gas: level, hanging and lit at the top, hanging
// and lit at the bottom.
#include "bench/bench.h"
#include "analysis/strip.h"

#include <math.h>

/// In m; a gas cell of 0: without gas.
typedef struct SpreadCase {
    const char *direction;
    float cell, gas_cell;
} SpreadCase;

static const SpreadCase cases[] = {
    {"level", 2e-3f, 0},     {"level", 2e-3f, 6e-3f}, {"down", 2e-3f, 6e-3f}, {"up", 2e-3f, 6e-3f},
    {"up", 1e-3f, 6e-3f},    {"up", 2e-3f, 4e-3f},    {"up", 2e-3f, 9e-3f},   {"level", 1e-3f, 6e-3f},
    {"level", 2e-3f, 9e-3f}, {"down", 1e-3f, 6e-3f},  {"down", 2e-3f, 9e-3f},
};
enum { CASES = sizeof cases / sizeof *cases, CASES_QUICK = 7 };

SingeResult bench_spread(const BenchOptions *options, BenchTable *table, SingeError *error) {
    double level = NAN, down = NAN;
    for (int i = 0; i < (options->quick ? CASES_QUICK : CASES); i++) {
        const SpreadCase *it = &cases[i];
        double speed;

        const int threads = options->threads;
        const SingeMaterialDef paper = singe_default_material();
        StripSetup setup = strip_setup(&paper);
        StripResult result = {0};
        setup.cell = it->cell;
        setup.threads = threads;
        setup.length = 0.15f;
        setup.width = 0.05f;
        setup.pace = 4;
        setup.gas = it->gas_cell > 0;
        setup.gas_cell = it->gas_cell;
        if (it->direction[0] != 'l') setup.gravity[0] = it->direction[0] == 'u' ? -9.81f : 9.81f, setup.gravity[2] = 0;
        SingeResult code = strip_burn(&setup, &result, error);
        speed = result.speed;

        if (code) return code;
        if (i == 1) level = speed;
        if (i == 2) down = speed;
        table_text(table, "direction", 9, it->direction);
        table_number(table, "cell_mm", "%.2g", 7, 1e3 * (double)it->cell);
        table_number(table, "gas_cell_mm", "%.2g", 11, it->gas_cell > 0 ? 1e3 * (double)it->gas_cell : NAN);
        table_number(table, "speed_mm_s", "%.3g", 10, 1e3 * speed);
        table_number(table, "over_level", "%.2f", 10, speed / level);
        table_number(table, "over_down", "%.2f", 9, speed / down);
        if (table_end_row(table)) return SINGE_ERROR_MEMORY;
    }

    return SINGE_OK;
}
