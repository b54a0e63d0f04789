// What a step costs: a hanging sheet that burns, with a ball that crosses it and a plane under it.
//
//   singe_bench_step [--springs N] [--threads N] [--steps N] [--limit-ms N]
//
// Prints milliseconds a step, by stage, median and least; nanoseconds a spring; memory. Fails when the median
// is above --limit-ms.
#include "singe/singe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Options {
    long springs, threads, steps, limit_ms;
} Options;

enum { WARM_UP = 40, COLUMNS = SINGE_STAGE_COUNT + 1 };

static bool option_read(Options *options, const char *name, const char *value) {
    long *slot = !strcmp(name, "--springs")    ? &options->springs
                 : !strcmp(name, "--threads")  ? &options->threads
                 : !strcmp(name, "--steps")    ? &options->steps
                 : !strcmp(name, "--limit-ms") ? &options->limit_ms
                                               : NULL;
    char *end;
    if (!slot || !value) return false;
    *slot = strtol(value, &end, 10);
    return *end == 0 && *value != 0 && *slot > 0;
}

/// A square sheet that hangs upright, x to the right and z up, of about `springs` springs (10 a cell).
static SingeResult add_sheet(SingeSim *sim, long springs, SingeSheetId *id) {
    const float side = 0.3f;
    uint32_t n = (uint32_t)(sqrt((double)springs / 10) + 0.999), row = n + 1;
    float *positions = malloc(3 * sizeof *positions * row * row);
    uint32_t *cells = malloc(4 * sizeof *cells * n * n);
    if (!positions || !cells) {
        free(positions);
        free(cells);
        return SINGE_ERROR_MEMORY;
    }
    for (uint32_t v = 0; v < row * row; v++) {
        positions[3 * v] = side * (float)(v % row) / (float)n;
        positions[3 * v + 1] = 0;
        positions[3 * v + 2] = side * (float)(v / row) / (float)n;
    }
    for (uint32_t c = 0; c < n * n; c++) {
        uint32_t v = c / n * row + c % n, *cell = cells + 4 * (size_t)c;
        cell[0] = v, cell[1] = v + 1, cell[2] = v + row + 1, cell[3] = v + row;
    }
    SingeSheetDef def = singe_default_sheet();
    def.vertex_count = row * row, def.positions = positions;
    def.cell_count = n * n, def.cells = cells;
    def.material.mass_rate.field = SINGE_FIELD_NOISE;
    def.material.mass_rate.to = 2 * def.material.mass_rate.value;
    def.material.mass_rate.noise = (SingeNoise){0.05f, 4, 1};
    SingeResult result = singe_sim_add_sheet(sim, &def, id);
    free(positions);
    free(cells);
    return result;
}

#define TRY(call)                      \
    do {                               \
        SingeResult result_ = (call);  \
        if (result_) return result_;   \
    } while (0)

static SingeResult build(SingeSim *sim, long springs) {
    SingeSheetId sheet;
    TRY(add_sheet(sim, springs, &sheet));
    TRY(singe_sim_commit(sim));

    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    const float corners[6] = {0, 0, 0.3f, 0.3f, 0, 0.3f};
    pin.sheet = sheet, pin.point_count = 2, pin.points = corners, pin.radius = 0.01f;
    TRY(singe_sim_add_pin(sim, &pin, &pin_id));

    const SingePoseKey across[2] = {{0, {0.05f, 0, 0.1f}, {0, 0, 0, 1}}, {2, {0.25f, 0, 0.1f}, {0, 0, 0, 1}}};
    SingeSourceDef ball = singe_default_source();
    SingeSourceId source_id;
    ball.kind = SINGE_SOURCE_BALL, ball.radius = 0.04f, ball.falloff = 0.02f;
    ball.path_count = 2, ball.path = across, ball.conductance = 1000;
    TRY(singe_sim_add_source(sim, &ball, &source_id));

    const SingePoseKey floor_key = {0, {0, 0, 0.005f}, {0, 0, 0, 1}}; // the sheet's lower edge lies on it
    SingeColliderDef plane = singe_default_collider();
    SingeColliderId collider_id;
    plane.path_count = 1, plane.path = &floor_key;
    return singe_sim_add_collider(sim, &plane, &collider_id);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Milliseconds of every stage and of the whole step; column after column.
static SingeResult measure(SingeSim *sim, long steps, double *ms) {
    for (long i = -WARM_UP; i < steps; i++) {
        SingeTimers before = singe_sim_timers(sim);
        TRY(singe_sim_step(sim));
        SingeTimers after = singe_sim_timers(sim);
        double total = 0;
        for (int stage = 0; i >= 0 && stage < SINGE_STAGE_COUNT; stage++) {
            ms[stage * steps + i] = 1e3 * (after.seconds[stage] - before.seconds[stage]);
            total += ms[stage * steps + i];
        }
        if (i >= 0) ms[SINGE_STAGE_COUNT * steps + i] = total;
    }
    for (int column = 0; column < COLUMNS; column++) qsort(ms + column * steps, (size_t)steps, sizeof *ms, ascending);
    return SINGE_OK;
}

static double report(const SingeSim *sim, const Options *options, const double *ms) {
    static const char *const names[COLUMNS] = {"heat", "burn", "ablate", "dynamics", "step"};
    SingeCensus census = singe_sim_census(sim);
    SingeStats stats = singe_sim_stats(sim);
    SingeTimers timers = singe_sim_timers(sim);
    double springs = 0, median = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) springs += census.springs[colour];
    printf("%.0f springs, %u particles, %ld threads, %ld steps\n", springs, census.particles, options->threads,
           options->steps);
    printf("%-10s %10s %10s %12s\n", "stage", "median ms", "least ms", "ns a spring");
    for (int column = 0; column < COLUMNS; column++) {
        median = ms[column * options->steps + options->steps / 2];
        printf("%-10s %10.3f %10.3f %12.2f\n", names[column], median, ms[column * options->steps],
               1e6 * median / springs);
    }
    printf("memory %.1f MB; %.1f heat iterations and %.0f contacts a step; %.2f %% burnt, up to %.0f K\n",
           (double)census.memory / 1e6, (double)timers.heat_iterations / (double)timers.steps,
           (double)timers.contacts / (double)timers.steps, 100 * stats.burnt_fraction, (double)stats.temperature_max);
    return median;
}

static int fail(const char *what, const SingeError *error) {
    fprintf(stderr, "singe_bench_step: %s%s%s\n", what, error ? ": " : "", error ? error->message : "");
    return 1;
}

int main(int argc, char **argv) {
    Options options = {100000, 1, 100, 0};
    for (int i = 1; i < argc; i += 2)
        if (!option_read(&options, argv[i], argv[i + 1])) {
            fail("usage: singe_bench_step [--springs N] [--threads N] [--steps N] [--limit-ms N]", NULL);
            return 2;
        }
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;
    SingeError error;
    def.thread_count = options.threads > 64 ? 64 : (int)options.threads;
    if (singe_sim_create(&def, &sim, &error)) return fail("create", &error);
    double *ms = calloc((size_t)(COLUMNS * options.steps), sizeof *ms), median = 0;
    int status = !ms ? fail("out of memory", NULL) : 0;
    if (!status && (build(sim, options.springs) || measure(sim, options.steps, ms)))
        status = fail("run", singe_sim_error(sim));
    if (!status) median = report(sim, &options, ms);
    if (!status && options.limit_ms && median > (double)options.limit_ms) {
        fprintf(stderr, "the median is above the limit of %ld ms\n", options.limit_ms);
        status = 1;
    }
    free(ms);
    singe_sim_destroy(sim);
    return status;
}
