// The cost of the drawn surface of a burning sheet, with plain cells and refined near the front.
#include "bench/bench.h"
#include "bench/burning.h"
#include "bench/machine.h"
#include "analysis/numbers.h"
#include "bench/timing.h"

enum { BURNING_STEPS = 240, DRAWINGS = 15 };
static const float fire_pace = 20; // so that much is gone after these steps

enum { SPRINGS, THREADS, DETAIL, TRIANGLES, FINE, VERTICES, MEDIAN, CPU, CACHE, COLUMNS };

static const BenchColumn columns[COLUMNS] = {
    [SPRINGS] = {"springs", "%.0f", 8, NULL},    [THREADS] = {"threads", "%.0f", 7, NULL},
    [DETAIL] = {"detail_mm", "%.2f", 9, NULL},   [TRIANGLES] = {"triangles", "%.0f", 9, NULL},
    [FINE] = {"fine_pct", "%.1f", 8, NULL},      [VERTICES] = {"vertices", "%.0f", 8, NULL},
    [MEDIAN] = {"surface_ms", "%.3g", 10, NULL}, [CPU] = {"cpu_ms", "%.3g", 8, NULL},
    [CACHE] = {"cache_mb", "%.2f", 8, NULL},
};

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
    BenchValue row[COLUMNS] = {
        [SPRINGS] = bench_number(timing_springs(sim)),
        [THREADS] = bench_number(options->threads),
        [DETAIL] = bench_number(1e3 * options->detail),
        [TRIANGLES] = bench_number(triangles),
        [FINE] = bench_number(triangles > 0 ? 100 * surface.fine_triangle_count / triangles : 0),
        [VERTICES] = bench_number(surface.vertex_count),
        [MEDIAN] = bench_number(wall),
        [CPU] = bench_number(cpu),
        [CACHE] = bench_number(1e-6 * (92.0 * surface.vertex_count + 13 * triangles)),
    };
    if (!result && !table_add(table, row)) result = SINGE_ERROR_MEMORY;
    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_surface(const BenchOptions *options, BenchTable *table, SingeError *error) {
    const double details[] = {0, 0.8e-3, 0.4e-3, 0.2e-3};
    BenchList springs = bench_list(&options->springs, 2, (const double[]){3e4, 1e5});
    SingeResult result = SINGE_OK;
    *table = table_begin("surface", columns, COLUMNS, table->text);
    for (int i = 0; i < springs.count && !result; i++)
        for (size_t k = 0; k < sizeof details / sizeof *details && !result; k++) {
            BenchOptions with = *options;
            with.detail = details[k];
            result = surface_measure(&with, springs.values[i], table, error);
        }
    return result;
}
