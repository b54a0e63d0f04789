// Bytes per spring by size: of a simulation, added by contact, the peak while building it, and of its drawn mesh.
#include "bench/bench.h"
#include "bench/hung_sheet.h"
#include "bench/machine.h"
#include "bench/timing.h"

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
        if (!result) {
            table_number(table, "springs", "%.0f", 8, count);
            table_number(table, "bytes_spring", "%.1f", 12, (double)simulation / count);
            table_number(table, "contact_bytes_spring", "%.1f", 20,
                         ((double)with_contact - (double)simulation) / count);
            table_number(table, "building_bytes_spring", "%.1f", 21, (double)building / count);
            table_number(table, "surface_bytes_spring", "%.1f", 20, (double)(held.now - simulation) / count);
            table_number(table, "all_bytes_spring", "%.1f", 16, (double)held.now / count);
            table_number(table, "all_mb", "%.2f", 8, 1e-6 * (double)held.now);
            result = table_end_row(table);
        }

        singe_surface_free(&surface);
        singe_sim_destroy(sim);
    }

    return result;
}
