// What a step costs: a hanging sheet that burns, with a ball that crosses it and a plane under it.
//
//   singe_bench_step [--springs N] [--threads N] [--steps N] [--limit-ms N]
//
// Prints milliseconds a step, by stage, median and least; nanoseconds a spring; memory; and milliseconds of the
// yardstick, a fixed piece of work done before every step. Fails when the step is above --limit-ms, where a
// machine on which the yardstick takes longer than on the reference machine has that much more time.
#include "bench/yardstick.h"
#include "singe/singe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Options {
    long springs, threads, steps, limit_ms;
} Options;

enum { WARM_UP = 40, STEP = SINGE_STAGE_COUNT, YARDSTICK, STEP_SCALED, COLUMNS };

/// What the yardstick takes on the reference machine, one 2.6 GHz Zen 4 core (AMD EPYC, gcc 12 -O3), between
/// steps as measured here.
static const double yardstick_reference_ms = 8.6;

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

/// How many times slower than the reference machine; a faster one counts as the same.
static double slowness(double yardstick_ms) { return fmax(1, yardstick_ms / yardstick_reference_ms); }

/// Milliseconds of every stage, of the whole step, of the yardstick, and of the step as the reference machine
/// would take it; column after column, each in ascending order. Each step is scaled by the yardstick just before
/// it, so that a machine that is slow for a while slows both.
static SingeResult measure(SingeSim *sim, Yardstick *yardstick, long steps, double *ms) {
    for (long i = -WARM_UP; i < steps; i++) {
        double yardstick_ms = yardstick_run(yardstick);
        SingeTimers before = singe_sim_timers(sim);
        TRY(singe_sim_step(sim));
        SingeTimers after = singe_sim_timers(sim);
        double total = 0;
        for (int stage = 0; i >= 0 && stage < SINGE_STAGE_COUNT; stage++) {
            ms[stage * steps + i] = 1e3 * (after.seconds[stage] - before.seconds[stage]);
            total += ms[stage * steps + i];
        }
        if (i < 0) continue;
        ms[STEP * steps + i] = total;
        ms[YARDSTICK * steps + i] = yardstick_ms;
        ms[STEP_SCALED * steps + i] = total / slowness(yardstick_ms);
    }
    for (int column = 0; column < COLUMNS; column++) qsort(ms + column * steps, (size_t)steps, sizeof *ms, ascending);
    return SINGE_OK;
}

static double median(const double *ms, long steps, int column) { return ms[column * steps + steps / 2]; }

static void report(const SingeSim *sim, const Options *options, const double *ms) {
    static const char *const names[STEP + 1] = {"heat", "burn", "ablate", "dynamics", "step"};
    long steps = options->steps;
    SingeCensus census = singe_sim_census(sim);
    SingeStats stats = singe_sim_stats(sim);
    SingeTimers timers = singe_sim_timers(sim);
    double springs = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) springs += census.springs[colour];
    printf("%.0f springs, %u particles, %ld threads, %ld steps\n", springs, census.particles, options->threads,
           options->steps);
    printf("%-10s %10s %10s %12s\n", "stage", "median ms", "least ms", "ns a spring");
    for (int column = 0; column <= STEP; column++) {
        double middle = median(ms, steps, column);
        printf("%-10s %10.3f %10.3f %12.2f\n", names[column], middle, ms[column * steps], 1e6 * middle / springs);
    }
    printf("%-10s %10.3f %10.3f\n", "yardstick", median(ms, steps, YARDSTICK), ms[YARDSTICK * steps]);
    printf("memory %.1f MB; %.1f heat iterations and %.0f contacts a step; %.2f %% burnt, up to %.0f K\n",
           (double)census.memory / 1e6, (double)timers.heat_iterations / (double)timers.steps,
           (double)timers.contacts / (double)timers.steps, 100 * stats.burnt_fraction, (double)stats.temperature_max);
}

/// Holds the step against the limit of the reference machine.
static int judge(const Options *options, const double *ms) {
    double step = median(ms, options->steps, STEP_SCALED), limit = (double)options->limit_ms;
    double ratio = slowness(median(ms, options->steps, YARDSTICK));
    printf("%.2f times the reference machine's time (yardstick %.1f ms there): limit %ld ms * %.2f = %.1f ms\n", ratio,
           yardstick_reference_ms, options->limit_ms, ratio, limit * ratio);
    if (step <= limit) return 0;
    fflush(stdout);
    fprintf(stderr, "singe_bench_step: %.1f ms at the reference machine's pace, above the limit of %ld ms\n", step,
            options->limit_ms);
    return 1;
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
    double *ms = calloc((size_t)(COLUMNS * options.steps), sizeof *ms);
    Yardstick *yardstick = yardstick_create();
    int status = !ms || !yardstick ? fail("out of memory", NULL) : 0;
    if (!status && (build(sim, options.springs) || measure(sim, yardstick, options.steps, ms)))
        status = fail("run", singe_sim_error(sim));
    if (!status) report(sim, &options, ms);
    if (!status && options.limit_ms) status = judge(&options, ms);
    yardstick_destroy(yardstick);
    free(ms);
    singe_sim_destroy(sim);
    return status;
}
