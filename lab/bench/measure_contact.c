// What contact costs: cloth that falls on itself and on other cloth, a ball of paper that collapses, and a sheet in gusts,
// where cells move far in a step. Of gusts the lightest come first; their processor time is the unit of the others.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"
#include "bench/machine.h"
#include "bench/timing.h"

static const float apart = 0.01f;              // m, between sheets
static const float ball = 0.1f, above = 2e-3f; // m, radius of the ball of paper, and its height above the ground

/// What moves, unless options ask for other cells, sheets and seconds.
typedef struct Motion {
    double seconds, cells[2];   ///< cells a side, one or two numbers
    uint32_t sheets;            ///< 0: a hollow ball
    float side, lowest, sphere; ///< m: of a sheet, the height of the lowest one, the radius of the sphere; 0: none
    float thickness, offset;    ///< m, of contact and of colliders; 0: the defaults
    bool upright, gusts;
} Motion;

static const Motion heap = {.seconds = 3,
                            .cells = {100, 200},
                            .sheets = 1,
                            .side = 1,
                            .lowest = 0.3f,
                            .sphere = 0.12f,
                            .thickness = 1e-3f,
                            .offset = 1e-3f,
                            .upright = true};
static const Motion collapse = {.seconds = 0.3, .cells = {40, 102}, .offset = 1e-3f};
static const Motion pile = {.seconds = 1, .cells = {70}, .sheets = 10, .side = 0.35f, .lowest = 0.21f, .sphere = 0.1f};
static const Motion alone = {.seconds = 2, .cells = {100}, .sheets = 1, .side = 1, .lowest = 0.61f, .sphere = 0.3f};
static const Motion shaken = {.seconds = 40.0 / 240, .cells = {60}, .sheets = 1, .side = 0.1f, .gusts = true};
static const double winds[] = {5, 15, 30}; // m/s

/// Sheets above each other; no two are the same. An upright one has slight waves, so that it folds instead of standing.
static SingeResult add_sheets(SingeSim *sim, const Motion *motion, uint32_t sheets, uint32_t cells, SingeError *error) {
    SingeGridDef grid = singe_default_grid();
    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;
    const float side = motion->side;
    grid.size[0] = grid.size[1] = side;
    grid.cells[0] = grid.cells[1] = cells;
    if (motion->upright) {
        grid.jitter = 0;
        def.material.thickness = singe_param(0.8f * side / (float)cells);
    } else if (!motion->gusts) {
        if (singe_material_preset("cotton", &def.material, error)) return error->code;
        def.material.mass_loss = singe_param(0);
    }

    for (uint32_t k = 0; k < sheets; k++) {
        SingeMesh *mesh;
        grid.seed = k + 1;
        if (singe_mesh_create_grid(&grid, &mesh, error)) return error->code;

        singe_mesh_fill_sheet(mesh, &def);
        float *placed = malloc(3 * (size_t)def.vertex_count * sizeof *placed);
        for (size_t v = 0; placed && v < def.vertex_count; v++) {
            const float x = def.positions[3 * v], y = def.positions[3 * v + 1], z = def.positions[3 * v + 2];
            const float wave = 0.02f * sinf(19 * (y / side + 0.5f)) + 0.01f * sinf(13 * (x / side + 0.5f));
            placed[3 * v] = x;
            placed[3 * v + 1] = motion->upright ? wave : y;
            placed[3 * v + 2] = motion->lowest + (motion->upright ? y + side / 2 : z + apart * (float)k);
        }

        def.positions = placed;
        const SingeResult result = placed ? singe_sim_add_sheet(sim, &def, &id) : SINGE_ERROR_MEMORY;
        free(placed);
        singe_mesh_destroy(mesh);
        if (result) return result;
    }

    return SINGE_OK;
}

static SingeResult add_ball(SingeSim *sim, uint32_t n) {
    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;

    def.vertex_count = 6 * n * n + 2;
    def.cell_count = 6 * n * n;

    float *x = malloc(3 * (size_t)def.vertex_count * sizeof *x);
    uint32_t *cells = malloc(4 * (size_t)def.cell_count * sizeof *cells);
    SingeResult result = x && cells ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (!result) {
        // the six faces of a cube of n x n cells each, projected to a sphere that lies on the ground
        for (uint32_t c = 0; c < 6 * n * n; c++) {
            uint32_t axis = c / (2 * n * n), upper = c / (n * n) % 2, i = c / n % n, j = c % n;
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t at[3], turn = upper ? k : 3 - k;
                at[axis] = upper * n;
                at[(axis + 1) % 3] = i + (turn == 1 || turn == 2);
                at[(axis + 2) % 3] = j + turn / 2;

                // its index: (n + 1) x (n + 1) points at the bottom and the top of the cube, and rings in between
                const uint32_t row = n + 1;
                uint32_t v = (at[2] ? row * row : 0) + at[1] * row + at[0];
                if (at[2] > 0 && at[2] < n) {
                    const uint32_t ring = at[1] == 0   ? at[0]
                                          : at[0] == n ? n + at[1]
                                          : at[1] == n ? 3 * n - at[0]
                                                       : 4 * n - at[1];
                    v = 2 * row * row + (at[2] - 1) * 4 * n + ring;
                }
                cells[4 * c + k] = v;

                float square = 0, *p = x + 3 * (size_t)v;
                for (int d = 0; d < 3; d++) {
                    p[d] = tanf(0.785398f * (2 * (float)at[d] / (float)n - 1));
                    square += p[d] * p[d];
                }

                for (int d = 0; d < 3; d++) p[d] = ball / sqrtf(square) * p[d] + (d == 2 ? ball + above : 0);
            }
        }

        def.positions = x;
        def.cells = cells;
        result = singe_sim_add_sheet(sim, &def, &id);
    }

    free(x), free(cells);
    return result;
}

/// The ground and the sphere on it; or pins at two corners, in a wind.
static SingeResult add_holders(SingeSim *sim, const Motion *motion, uint32_t cells, float speed) {
    SingeResult result = SINGE_OK;
    if (motion->gusts) {
        SingePinDef pin = singe_default_pin();
        SingeWindDef wind = singe_default_wind();
        SingePinId id;
        const float half = motion->side / 2, corners[] = {-half, -half, 0, half, -half, 0};
        pin.sheet = (SingeSheetId){0, 1};
        pin.point_count = 2;
        pin.points = corners;
        pin.radius = half / (float)cells;
        wind.velocity[0] = wind.gust = speed;
        result = singe_sim_add_pin(sim, &pin, &id);
        return result ? result : singe_sim_set_wind(sim, &wind);
    }

    SingeColliderDef solid = singe_default_collider();
    SingePoseKey key = {.rotation = {0, 0, 0, 1}};
    SingeColliderId id;
    solid.path_count = 1;
    solid.path = &key;
    if (motion->offset > 0) solid.offset = motion->offset;
    result = singe_sim_add_collider(sim, &solid, &id);
    solid.kind = SINGE_COLLIDER_SPHERE;
    solid.radius = key.position[2] = motion->sphere;
    return result || solid.radius == 0 ? result : singe_sim_add_collider(sim, &solid, &id);
}

/// Adds a row; *first is the processor time of the first one.
static SingeResult contact_measure(const BenchOptions *options, const Motion *motion, uint32_t sheets, uint32_t cells,
                                   float speed, double *first, BenchTable *table, SingeError *error) {
    const int of_frame = motion->gusts ? 10 : options_steps(options);
    MachineHeld held = {0};
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    def.allocator = (SingeAllocator){machine_resize, &held};
    def.thread_count = options->threads;
    def.time_step = 1.0f / (float)(of_frame * BENCH_FPS);
    def.contact.enabled = true;
    if (motion->thickness > 0) def.contact.thickness = motion->thickness;
    def.solver.substeps = options_substeps(options);
    if (options->start >= 0) def.solver.start = (float)options->start;
    if (singe_sim_create(&def, &sim, error)) return error->code;

    SingeResult result = sheets ? add_sheets(sim, motion, sheets, cells, error) : add_ball(sim, cells);
    if (!result) result = singe_sim_commit(sim);
    if (!result) result = add_holders(sim, motion, cells, speed);

    const double time = options->time > 0 ? options->time : motion->seconds;
    const int steps = (int)fmax(1, time * of_frame * BENCH_FPS);
    const double begun = machine_clock(), processor = machine_cpu_clock();
    double worst = 0, worst_frame = 0, worst_p99 = 0, frame_begun = begun;
    for (int step = 0; step < steps && !result; step++) {
        const double before = machine_clock();
        result = singe_sim_step(sim);
        const double now = machine_clock();
        worst = fmax(worst, now - before);
        if (step % of_frame == of_frame - 1) {
            worst_frame = fmax(worst_frame, now - frame_begun);
            frame_begun = now;
        }
        if (step % of_frame == 0 && !result) worst_p99 = fmax(worst_p99, singe_sim_stats(sim).strain_p99);
    }

    const double wall = machine_clock() - begun, busy = machine_cpu_clock() - processor;
    const size_t max = held.max;
    uint64_t crossing = 0;
    if (*first == 0) *first = busy;
    if (result && !error->code) *error = *singe_sim_error(sim);
    if (!result) result = geometry_crossings(sim, &crossing, error);

    if (!result) {
        const SingeTimers t = singe_sim_timers(sim);
        const SingeStats stats = singe_sim_stats(sim);
        const double a_step = 1.0 / steps, ms = 1e3 * a_step; // the mean of a step

        if (sheets) table_number(table, "sheets", "%.0f", 6, sheets);
        table_number(table, "cells", "%.0f", 5, cells);
        table_number(table, "springs", "%.0f", 8, timing_springs(sim));
        table_number(table, "threads", "%.0f", 7, options->threads);
        if (motion->gusts) {
            table_number(table, "wind_m_s", "%.0f", 8, (double)speed); // mean, and of gusts
            table_number(table, "cpu_s", "%.3g", 8, busy);
            table_number(table, "of_first", "%.3g", 8, busy / *first);
        }

        table_number(table, "frame_ms", "%.4g", 8, ms * of_frame * busy); // of all threads, the mean of a frame
        table_number(table, "max_ms", "%.4g", 8, 1e3 * worst_frame);
        table_number(table, "step_ms", "%.4g", 8, ms * wall);
        table_number(table, "worst_ms", "%.4g", 8, 1e3 * worst);
        table_number(table, "cpu_ms", "%.4g", 8, ms * busy); // of all threads
        table_number(table, "contact_ms", "%.4g", 10, ms * t.contact_seconds);
        table_number(table, "find_ms", "%.4g", 8, ms * t.contact_find_seconds);
        table_number(table, "push_ms", "%.4g", 8, ms * t.contact_push_seconds);
        table_number(table, "stop_ms", "%.4g", 8, ms * t.contact_stop_seconds);
        table_number(table, "searches_step", "%.2f", 13, a_step * (double)t.contact_searches);
        table_number(table, "pairs_step", "%.0f", 10, a_step * (double)t.contact_pairs);
        table_number(table, "repulsions_substep", "%.0f", 18,
                     a_step * (double)t.contact_repulsions / options_substeps(options));
        table_number(table, "rounds_step", "%.2f", 11, a_step * (double)t.contact_rounds);
        table_number(table, "looks_step", "%.0f", 10, a_step * (double)t.contact_looks);
        table_number(table, "stops_step", "%.1f", 10, a_step * (double)t.contact_stops);
        table_number(table, "halts", "%.0f", 5, (double)t.contact_halts);

        table_parts(table, "strain_pct", "%.3g", 20, "max/p99/mean", strain_of(&stats));
        table_number(table, "worst_p99_pct", "%.3g", 13, 100 * worst_p99); // of all frames
        table_number(table, "inverted", "%.0f", 8, stats.inverted_cells);
        table_number(table, "crossing", "%.0f", 8, (double)crossing); // pairs of drawn triangles
        table_number(table, "speed", "%.4f", 8, stats.speed_rms_unburnt);
        table_number(table, "max_mb", "%.1f", 8, 1e-6 * (double)max);
        result = table_end_row(table);
    }

    singe_sim_destroy(sim);
    return result;
}

static SingeResult contact_rows(const BenchOptions *options, const Motion *motion, BenchTable *table,
                                SingeError *error) {
    BenchList sheets = bench_list(&options->sheets, 1, (const double[]){motion->sheets});
    BenchList cells = bench_list(&options->cells, motion->cells[1] > 0 ? 2 : 1, motion->cells);
    const int speeds = motion->gusts ? (int)(sizeof winds / sizeof *winds) : 1;
    SingeResult result = SINGE_OK;
    for (int i = 0; i < sheets.count; i++)
        for (int k = 0; k < cells.count; k++) {
            double first = 0;
            for (int w = 0; w < speeds && !result; w++)
                result = contact_measure(options, motion, (uint32_t)sheets.values[i], (uint32_t)cells.values[k],
                                         (float)winds[w], &first, table, error);
        }
    return result;
}

#define MEASURE(name, motion)                                                                     \
    SingeResult bench_##name(const BenchOptions *options, BenchTable *table, SingeError *error) { \
        return contact_rows(options, &(motion), table, error);                                    \
    }
MEASURE(heap, heap)
MEASURE(collapse, collapse)
MEASURE(stack, pile)
MEASURE(drop, alone)
MEASURE(wind, shaken)
