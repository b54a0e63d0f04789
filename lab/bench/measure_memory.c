// Bytes per spring by size: of a simulation, added by contact, the peak while building it, and of its drawn mesh.
#include "bench/bench.h"
#include "bench/burning.h"
#include "bench/machine.h"
#include "bench/timing.h"

enum { SPRINGS, SIMULATION, CONTACT, BUILDING, SURFACE, TOGETHER, MEGABYTES, COLUMNS };

static const BenchColumn columns[COLUMNS] = {
    [SPRINGS] = {"springs", "%.0f", 8, NULL},
    [SIMULATION] = {"bytes_spring", "%.1f", 12, NULL},
    [CONTACT] = {"contact_bytes_spring", "%.1f", 20, NULL},
    [BUILDING] = {"building_bytes_spring", "%.1f", 21, NULL},
    [SURFACE] = {"surface_bytes_spring", "%.1f", 20, NULL},
    [TOGETHER] = {"all_bytes_spring", "%.1f", 16, NULL},
    [MEGABYTES] = {"all_mb", "%.2f", 8, NULL},
};

/// Memory of a simulation with contact, after a step.
static SingeResult measure_contact(const BenchOptions *options, double springs, size_t *held_bytes, SingeError *error) {
    MachineHeld held = {0};
    const SingeAllocator counting = {machine_resize, &held};
    BenchOptions with = *options;
    SingeSim *sim;
    with.contact = true;
    if (burning_build(&with, &counting, springs, 1, &sim, error)) return error->code;
    SingeResult result = singe_sim_step(sim);
    if (result) *error = *singe_sim_error(sim);
    *held_bytes = held.now;
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_memory(const BenchOptions *options, BenchTable *table, SingeError *error) {
    BenchList springs = bench_list(&options->springs, 5, (const double[]){1e3, 4e3, 16e3, 1e5, 1e6});
    SingeResult result = SINGE_OK;
    *table = table_begin("memory", columns, COLUMNS, table->text);
    for (int i = 0; i < springs.count && !result; i++) {
        MachineHeld held = {0};
        const SingeAllocator counting = {machine_resize, &held};
        SingeSim *sim;
        SingeSurface surface = {.allocator = counting};
        size_t with_contact = 0;
        if (measure_contact(options, springs.values[i], &with_contact, error)) return error->code;
        if (burning_build(options, &counting, springs.values[i], 1, &sim, error)) return error->code;
        size_t building = held.max;
        result = singe_sim_step(sim);
        size_t simulation = held.now;
        if (!result) result = singe_sim_surface(sim, &surface);
        if (result) *error = *singe_sim_error(sim);
        double count = timing_springs(sim);
        BenchValue row[COLUMNS] = {
            [SPRINGS] = bench_number(count),
            [SIMULATION] = bench_number((double)simulation / count),
            [CONTACT] = bench_number(((double)with_contact - (double)simulation) / count),
            [BUILDING] = bench_number((double)building / count),
            [SURFACE] = bench_number((double)(held.now - simulation) / count),
            [TOGETHER] = bench_number((double)held.now / count),
            [MEGABYTES] = bench_number(1e-6 * (double)held.now),
        };
        if (!result && !table_add(table, row)) result = SINGE_ERROR_MEMORY;
        singe_surface_free(&surface);
        singe_sim_destroy(sim);
    }

    return result;
}
