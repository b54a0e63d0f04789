// The same run with each instruction set: its cost, and whether the final positions have the same bytes.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/hung_sheet.h"
#include "bench/timing.h"

enum { INSTRUCTIONS, SPRINGS, STEP_MEDIAN, STEP_MIN, PROJECTION, NS, RATIO, BYTES, COLUMNS };

static const BenchColumn columns[COLUMNS] = {
    [INSTRUCTIONS] = {"instructions", NULL, 12, NULL},  [SPRINGS] = {"springs", "%.0f", 8, NULL},
    [STEP_MEDIAN] = {"step_ms", "%.4g", 8, NULL},       [STEP_MIN] = {"min_ms", "%.4g", 8, NULL},
    [PROJECTION] = {"projection_ms", "%.4g", 13, NULL}, [NS] = {"ns_spring_sweep", "%.2f", 15, NULL},
    [RATIO] = {"plain_over_this", "%.2f", 15, NULL},    [BYTES] = {"bytes", NULL, 8, NULL},
};

/// The result of the plain run, with which the others are compared.
typedef struct Reference {
    uint64_t hash;
    double projection_ms;
} Reference;

static SingeResult width_measure(const BenchOptions *options, const BenchSetup *setup, BenchTable *table,
                                 Reference *plain, SingeError *error) {
    SingeSim *sim;
    Timing timing = {0};
    SingeResult result = sheet_build(setup, &sim, error);

    if (result == SINGE_ERROR_LIMIT && setup->instructions != SINGE_INSTRUCTIONS_PLAIN) {
        // refused: this processor lacks them
        BenchValue row[COLUMNS];
        for (int c = 0; c < COLUMNS; c++) row[c] = bench_number(NAN);
        row[INSTRUCTIONS] = bench_text(enum_words.SingeInstructions[setup->instructions]);
        row[BYTES] = bench_text("not here");
        return table_add(table, row) ? SINGE_OK : SINGE_ERROR_MEMORY;
    }

    if (result) return result;
    int steps = options->steps ? options->steps : timing_steps(timing_springs(sim), 5, 200);
    result = timing_measure(&timing, sim, NULL, steps, steps);
    if (result) *error = *singe_sim_error(sim);
    else {
        double springs = timing_springs(sim), sweeps = (double)setup->solver.substeps * setup->solver.projections;
        double projection = timing_median(&timing, TIMED_PROJECTION);

        // FNV-1a over the bytes of all positions
        SingeView view = singe_sim_view(sim);
        uint64_t hash = 14695981039346656037u;
        for (uint32_t i = 0; i < view.particle_count; i++) {
            const unsigned char *bytes = (const unsigned char *)view.position[i];
            for (size_t b = 0; b < 3 * sizeof(float); b++) hash = (hash ^ bytes[b]) * 1099511628211u;
        }

        if (setup->instructions == SINGE_INSTRUCTIONS_PLAIN) *plain = (Reference){hash, projection};
        BenchValue row[COLUMNS] = {
            [INSTRUCTIONS] = bench_text(enum_words.SingeInstructions[setup->instructions]),
            [SPRINGS] = bench_number(springs),
            [STEP_MEDIAN] = bench_number(timing_median(&timing, SINGE_STAGE_DYNAMICS)),
            [STEP_MIN] = bench_number(timing_min(&timing, SINGE_STAGE_DYNAMICS)),
            [PROJECTION] = bench_number(projection),
            [NS] = bench_number(1e6 * projection / (springs * sweeps)),
            [RATIO] = bench_number(plain->projection_ms / projection),
            [BYTES] = bench_text(hash == plain->hash ? "same" : "other"),
        };
        result = table_add(table, row) ? SINGE_OK : SINGE_ERROR_MEMORY;
    }

    timing_free(&timing);
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_width(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList springs = bench_list(&options->springs, 2, (const double[]){16e3, 1e5});
    BenchSetup setup = sheet_setup(options, options->state, 20);
    SingeResult result = SINGE_OK;
    *table = table_begin("width", columns, COLUMNS, table->text);
    for (int i = 0; i < springs.count && !result; i++) {
        Reference plain = {0};
        setup.cells = options_cells(springs.values[i]);
        for (int set = SINGE_INSTRUCTIONS_PLAIN; set <= SINGE_INSTRUCTIONS_WASM_SIMD128 && !result; set++) {
            setup.instructions = (SingeInstructions)set;
            result = width_measure(options, &setup, table, &plain, error);
        }
    }

    return result;
}
