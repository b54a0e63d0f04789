// The cost of the drawn surface of a burning sheet, with plain cells and refined near the front.
#include "bench/bench.h"
#include "bench/hung_sheet.h"
#include "bench/machine.h"
#include "analysis/numbers.h"
#include "bench/timing.h"

enum { BURNING_STEPS = 240, DRAWINGS = 15 };
static const float fire_pace = 20; // so that much is gone after these steps

static SingeResult surface_measure(const BenchOptions *options, double springs, BenchTable *table, SingeError *error) {
    SingeSim *sim;
    SingeSurface surface = {0};
    if (burning_build(options, NULL, springs, fire_pace, &sim, error)) return error->code;

    SingeResult result = SINGE_OK;
    int steps = options->steps ? options->steps : BURNING_STEPS;
    for (int step = 0; step < steps && !result; step++) result = singe_sim_step(sim);

    // draw the current state several times; medians of wall and processor time
    double walls[DRAWINGS] = {0}, cpus[DRAWINGS] = {0};
    for (int i = 0; i < DRAWINGS && !result; i++) {
        double begun = machine_clock(), cpu_begun = machine_cpu_clock();
        result = singe_sim_surface(sim, &surface);
        walls[i] = 1e3 * (machine_clock() - begun);
        cpus[i] = 1e3 * (machine_cpu_clock() - cpu_begun);
    }

    const double wall = numbers_median(walls, DRAWINGS), cpu = numbers_median(cpus, DRAWINGS);
    if (result) *error = *singe_sim_error(sim);

    double triangles = surface.triangle_count;
    if (!result) {
        table_number(table, "springs", "%.0f", 8, timing_springs(sim));
        table_number(table, "threads", "%.0f", 7, options->threads);
        table_number(table, "detail_mm", "%.2f", 9, 1e3 * options->detail);
        table_number(table, "triangles", "%.0f", 9, triangles);
        table_number(table, "fine_pct", "%.1f", 8, triangles > 0 ? 100 * surface.fine_triangle_count / triangles : 0);
        table_number(table, "vertices", "%.0f", 8, surface.vertex_count);
        table_number(table, "surface_ms", "%.3g", 10, wall);
        table_number(table, "cpu_ms", "%.3g", 8, cpu);
        table_number(table, "cache_mb", "%.2f", 8, 1e-6 * (92.0 * surface.vertex_count + 13 * triangles));
        result = table_end_row(table);
    }

    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_surface(const BenchOptions *options, BenchTable *table, SingeError *error) {
    const double details[] = {0, 0.8e-3, 0.4e-3, 0.2e-3};
    BenchList springs = bench_list(&options->springs, 2, (const double[]){3e4, 1e5});
    SingeResult result = SINGE_OK;
    for (int i = 0; i < springs.count && !result; i++)
        for (size_t k = 0; k < sizeof details / sizeof *details && !result; k++) {
            BenchOptions with = *options;
            with.detail = details[k];
            result = surface_measure(&with, springs.values[i], table, error);
        }

    return result;
}
