// The burning front on strips: speed, max temperature and residue, of materials compared with sources; and the direction
// in which fire spreads faster.
#include "bench/bench.h"
#include "analysis/strip.h"

#include <math.h>

/// A measured value, and its range in sources; 0 and 0 if there is none.
static BenchValue beside(double is, const float range[2], double scale, double zero) {
    bool known = range[1] > 0;
    return (BenchValue){.number = {is * scale - zero, known ? (double)range[0] * scale - zero : NAN,
                                   known ? (double)range[1] * scale - zero : NAN}};
}

static bool holds(double is, const float range[2]) {
    return !(range[1] > 0) || (is >= (double)range[0] && is <= (double)range[1]);
}

typedef enum FrontDirection {
    FRONT_STILL, ///< level, in still air: no gas
    FRONT_LEVEL,
    FRONT_DOWN,
    FRONT_UP,
} FrontDirection;
static const char *const direction_names[] = {
    [FRONT_STILL] = "still", [FRONT_LEVEL] = "level", [FRONT_DOWN] = "down", [FRONT_UP] = "up"};

/// A strip. With gas it is wide enough to produce it.
typedef struct FrontCase {
    FrontDirection direction;
    float cell, step, gas_cell; ///< m; in default steps; m
    bool wide;
} FrontCase;

/// Strips of one material, the first of which is the usual one; the quick ones come first.
typedef struct FrontCases {
    int count, quick;
    float pace;
    const FrontCase *items;
} FrontCases;

/// Of materials: first in still air, with changed resolution and time step; then with gas.
static const FrontCases material_cases = {6, 3, 1,
                                          (const FrontCase[]){{FRONT_STILL, 1e-3f, 1, 0, false},
                                                              {FRONT_STILL, 0.5e-3f, 1, 0, false},
                                                              {FRONT_STILL, 1e-3f, 0.5f, 0, false},
                                                              {FRONT_LEVEL, 2.5e-3f, 1, 6e-3f, true},
                                                              {FRONT_DOWN, 2.5e-3f, 1, 6e-3f, true},
                                                              {FRONT_UP, 2.5e-3f, 1, 6e-3f, true}}};

/// By direction: with changed cells of the sheet and of the gas.
static const FrontCases spread_cases = {11, 7, 4,
                                        (const FrontCase[]){{FRONT_STILL, 2e-3f, 1, 0, true},
                                                            {FRONT_LEVEL, 2e-3f, 1, 6e-3f, true},
                                                            {FRONT_DOWN, 2e-3f, 1, 6e-3f, true},
                                                            {FRONT_UP, 2e-3f, 1, 6e-3f, true},
                                                            {FRONT_UP, 1e-3f, 1, 6e-3f, true},
                                                            {FRONT_UP, 2e-3f, 1, 4e-3f, true},
                                                            {FRONT_UP, 2e-3f, 1, 9e-3f, true},
                                                            {FRONT_LEVEL, 1e-3f, 1, 6e-3f, true},
                                                            {FRONT_LEVEL, 2e-3f, 1, 9e-3f, true},
                                                            {FRONT_DOWN, 1e-3f, 1, 6e-3f, true},
                                                            {FRONT_DOWN, 2e-3f, 1, 9e-3f, true}}};

/// Values shared by the strips of a material.
typedef struct FrontKnown {
    double usual, level, down; ///< m/s: of the first strip; with gas, level and down
} FrontKnown;

static const char *finding(const BenchMaterial *material, FrontDirection direction, const StripResult *result,
                           const FrontKnown *known) {
    if (result->speed <= 0) return "goes out";
    if (direction == FRONT_DOWN) return fabs(result->speed / known->level - 1) <= 0.25 ? "near level" : "off level";
    if (direction == FRONT_UP) return result->speed >= 4 * known->down ? "climbs" : "hardly climbs";
    if (!holds(result->speed, material->speed)) return result->speed < (double)material->speed[0] ? "slower" : "faster";
    if (!holds(result->hottest, material->temperature))
        return result->hottest < (double)material->temperature[0] ? "colder" : "hotter";
    if (!holds(result->residue, material->residue))
        return result->residue < (double)material->residue[0] ? "less left" : "more left";

    return material->speed[1] > 0 ? "as sources say" : "no source";
}

static SingeResult front_material(const BenchOptions *options, const BenchMaterial *material, const FrontCases *cases,
                                  BenchTable *table, SingeError *error) {
    FrontKnown known = {0};
    const int count = options->quick ? cases->quick : cases->count;
    for (int i = 0; i < count; i++) {
        const FrontCase *it = &cases->items[i];
        const FrontDirection direction = it->direction;
        StripSetup setup = strip_setup(&material->def);
        setup.cell = it->cell;
        setup.time_step *= it->step;
        setup.threads = options->threads;
        setup.pace = cases->pace;
        setup.gas = direction != FRONT_STILL;
        setup.gas_cell = it->gas_cell;
        if (it->wide) {
            setup.length = 0.15f;
            setup.width = 0.05f;
        }

        if (direction == FRONT_UP || direction == FRONT_DOWN) {
            setup.gravity[0] = direction == FRONT_UP ? setup.gravity[2] : -setup.gravity[2];
            setup.gravity[2] = 0;
        }

        StripResult result = {0};
        SingeResult code = strip_burn(&setup, &result, error);
        if (code) return code;

        static const float nothing[2] = {0};
        const bool level = direction == FRONT_STILL || direction == FRONT_LEVEL;

        table_text(table, "material", 13, material->name);
        table_number(table, "g_m2", "%.0f", 4, 1e3 * (double)material->def.grammage.value);
        table_text(table, "direction", 9, direction_names[direction]);

        table_number(table, "cell_mm", "%.2g", 7, 1e3 * (double)setup.cell);
        table_number(table, "gas_mm", "%.2g", 6, setup.gas ? 1e3 * (double)setup.gas_cell : NAN);
        table_number(table, "step_ms", "%.2f", 7, 1e3 * (double)setup.time_step);
        table_number(table, "F", "%.2f", 5, result.thickening);
        table_parts(table, "speed_mm_s", "%.3g", 15, "is/from/to",
                    beside(result.speed, level ? material->speed : nothing, 1e3, 0));
        table_number(table, "change_pct", "%+.1f", 10, known.usual > 0 ? 100 * (result.speed / known.usual - 1) : NAN);

        // the front that has climbed to the end has not burnt through yet
        const bool burnt = direction != FRONT_UP;
        table_parts(table, "hottest_C", "%.0f", 11, "is/from/to",
                    beside(burnt ? result.hottest : (double)NAN, level ? material->temperature : nothing, 1, 273.15));
        table_parts(table, "residue_pct", "%.0f", 11, "is/from/to",
                    beside(burnt ? result.residue : (double)NAN, level ? material->residue : nothing, 100, 0));
        table_text(table, "basis", 10, material->calibrated && level ? "calibrated" : "predicted");
        table_text(table, "finding", 15, finding(material, direction, &result, &known));

        if (i == 0) known.usual = result.speed;
        if (direction == FRONT_LEVEL) known.level = result.speed;
        if (direction == FRONT_DOWN) known.down = result.speed;
        if (table_end_row(table)) return SINGE_ERROR_MEMORY;
    }

    return SINGE_OK;
}

SingeResult bench_front(const BenchOptions *options, BenchTable *table, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int m = 0; m < options->material_count && !result; m++)
        result = front_material(options, &options->materials[m], &material_cases, table, error);
    return result;
}

SingeResult bench_spread(const BenchOptions *options, BenchTable *table, SingeError *error) {
    const BenchMaterial paper = {.name = "default", .def = singe_default_material()};
    return front_material(options, &paper, &spread_cases, table, error);
}
