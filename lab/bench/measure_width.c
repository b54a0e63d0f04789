// The same run with each instruction set: its cost, and whether the final positions have the same bytes.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/hung_sheet.h"
#include "bench/timing.h"

/// The result of the plain run, with which the others are compared.
typedef struct Reference {
    uint64_t hash;
    double projection_ms;
} Reference;

static SingeResult width_measure(const BenchOptions *options, const BenchSetup *setup, BenchTable *table,
                                 Reference *plain, SingeError *error) {
    SingeSim *sim = NULL;
    Timing timing = {0};
    double springs = NAN, step = NAN, least = NAN, projection = NAN;
    const double sweeps = (double)setup->solver.substeps * setup->solver.projections;
    const char *bytes = "not here"; // refused: this processor lacks them
    SingeResult result = sheet_build(setup, &sim, error);
    const bool refused = result == SINGE_ERROR_LIMIT && setup->instructions != SINGE_INSTRUCTIONS_PLAIN;
    if (result && !refused) return result;

    if (!refused) {
        springs = timing_springs(sim);
        const int steps = options->steps ? options->steps : timing_steps(springs, 5, 200);
        result = timing_measure(&timing, sim, NULL, steps, steps);
        if (result) {
            *error = *singe_sim_error(sim);
            timing_free(&timing);
            singe_sim_destroy(sim);
            return result;
        }
        step = timing_median(&timing, SINGE_STAGE_DYNAMICS);
        least = timing_min(&timing, SINGE_STAGE_DYNAMICS);
        projection = timing_median(&timing, TIMED_PROJECTION);

        // FNV-1a over the bytes of all positions
        SingeView view = singe_sim_view(sim);
        uint64_t hash = 14695981039346656037u;
        for (uint32_t i = 0; i < view.particle_count; i++) {
            const unsigned char *position = (const unsigned char *)view.position[i];
            for (size_t b = 0; b < 3 * sizeof(float); b++) hash = (hash ^ position[b]) * 1099511628211u;
        }

        if (setup->instructions == SINGE_INSTRUCTIONS_PLAIN) *plain = (Reference){hash, projection};
        bytes = hash == plain->hash ? "same" : "other";
    }

    table_text(table, "instructions", 12, enum_words.SingeInstructions[setup->instructions]);
    table_number(table, "springs", "%.0f", 8, springs);
    table_number(table, "step_ms", "%.4g", 8, step);
    table_number(table, "min_ms", "%.4g", 8, least);
    table_number(table, "projection_ms", "%.4g", 13, projection);
    table_number(table, "ns_spring_sweep", "%.2f", 15, 1e6 * projection / (springs * sweeps));
    table_number(table, "plain_over_this", "%.2f", 15, plain->projection_ms / projection);
    table_text(table, "bytes", 8, bytes);
    timing_free(&timing);
    singe_sim_destroy(sim);
    return table_end_row(table);
}

SingeResult bench_width(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList springs = bench_list(&options->springs, 2, (const double[]){16e3, 1e5});
    BenchSetup setup = sheet_setup(options, options->state, 20);
    SingeResult result = SINGE_OK;
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
