// The burning front of materials: speed, max temperature and residue on strips, compared with sources.
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

/// The strips of a material: first in still air, with changed resolution and time step; then with gas, on strips wide
/// enough to produce it.
typedef struct FrontCase {
    FrontDirection direction;
    float cell, step; ///< m; in default steps
} FrontCase;

static const FrontCase cases[] = {{FRONT_STILL, 1e-3f, 1},   {FRONT_STILL, 0.5e-3f, 1}, {FRONT_STILL, 1e-3f, 0.5f},
                                  {FRONT_LEVEL, 2.5e-3f, 1}, {FRONT_DOWN, 2.5e-3f, 1},  {FRONT_UP, 2.5e-3f, 1}};
enum { CASES = sizeof cases / sizeof *cases, CASES_STILL = 3 };

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

static SingeResult front_material(const BenchOptions *options, const BenchMaterial *material, BenchTable *table,
                                  SingeError *error) {
    FrontKnown known = {0};
    const int count = options->quick ? CASES_STILL : CASES;
    for (int i = 0; i < count; i++) {
        const FrontDirection direction = cases[i].direction;
        StripSetup setup = strip_setup(&material->def);
        setup.cell = cases[i].cell;
        setup.time_step *= cases[i].step;
        setup.threads = options->threads;
        if (direction != FRONT_STILL) {
            setup.gas = true;
            setup.gas_cell = 6e-3f;
            setup.length = 0.15f;
            setup.width = 0.05f;
            if (direction == FRONT_UP) setup.gravity[0] = setup.gravity[2], setup.gravity[2] = 0;
            if (direction == FRONT_DOWN) setup.gravity[0] = -setup.gravity[2], setup.gravity[2] = 0;
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
        result = front_material(options, &options->materials[m], table, error);
    return result;
}
