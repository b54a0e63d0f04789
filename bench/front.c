// The burning front of materials: speed, hottest temperature and residue on strips, beside what sources say.
#include "bench/bench.h"
#include "bench/strip.h"

#include <math.h>

enum {
    MATERIAL, GRAMMAGE, DIRECTION, CELL, STEP, THICKENING, SPEED, CHANGE, HOTTEST, RESIDUE, BASIS, FINDING,
    FRONT_COLUMNS
};

static const BenchColumn front_columns[FRONT_COLUMNS] = {
    [MATERIAL] = {"material", NULL, 13, NULL},
    [GRAMMAGE] = {"g_m2", "%.0f", 4, NULL},
    [DIRECTION] = {"direction", NULL, 9, NULL},
    [CELL] = {"cell_mm", "%.2g", 7, NULL},
    [STEP] = {"step_ms", "%.2f", 7, NULL},
    [THICKENING] = {"F", "%.2f", 5, NULL},
    [SPEED] = {"speed_mm_s", "%.3g", 15, "is/from/to"},
    [CHANGE] = {"change_pct", "%+.1f", 10, NULL},
    [HOTTEST] = {"hottest_C", "%.0f", 11, "is/from/to"},
    [RESIDUE] = {"residue_pct", "%.0f", 11, "is/from/to"},
    [BASIS] = {"basis", NULL, 10, NULL},
    [FINDING] = {"finding", NULL, 15, NULL},
};

/// What is measured, and from where to where a source has it; 0 and 0 where none has.
static BenchValue beside(double is, const float range[2], double scale, double zero) {
    bool known = range[1] > 0;
    return (BenchValue){.number = {is * scale - zero, known ? (double)range[0] * scale - zero : NAN,
                                   known ? (double)range[1] * scale - zero : NAN}};
}

static bool holds(double is, const float range[2]) {
    return !(range[1] > 0) || (is >= (double)range[0] && is <= (double)range[1]);
}

static const char *finding(const BenchMaterial *material, const StripResult *result) {
    if (result->speed <= 0) return "goes out";
    if (!holds(result->speed, material->speed)) return result->speed < (double)material->speed[0] ? "slower" : "faster";
    if (!holds(result->hottest, material->temperature))
        return result->hottest < (double)material->temperature[0] ? "colder" : "hotter";
    if (!holds(result->residue, material->residue))
        return result->residue < (double)material->residue[0] ? "less left" : "more left";
    return material->speed[1] > 0 ? "as sources say" : "no source";
}

/// The strips of a material: the resolution and the time step are changed one after the other.
typedef struct FrontCase {
    float cell, step; ///< m; in default steps
} FrontCase;

static const FrontCase cases[] = {{1e-3f, 1}, {0.5e-3f, 1}, {1e-3f, 0.5f}};

static SingeResult front_material(const BenchOptions *options, const BenchMaterial *material, BenchTable *table,
                                  SingeError *error) {
    double usual = 0;
    const int count = options->quick ? 1 : (int)(sizeof cases / sizeof *cases);
    for (int i = 0; i < count; i++) {
        StripSetup setup = strip_setup(&material->def);
        StripResult result = {0};
        BenchValue row[FRONT_COLUMNS];
        setup.cell = cases[i].cell, setup.time_step *= cases[i].step, setup.threads = options->threads;
        SingeResult code = strip_burn(&setup, &result, error);
        if (code) return code;
        if (i == 0) usual = result.speed;
        row[MATERIAL] = bench_text(material->name);
        row[GRAMMAGE] = bench_number(1e3 * (double)material->def.grammage.value);
        row[DIRECTION] = bench_text("level");
        row[CELL] = bench_number(1e3 * (double)setup.cell);
        row[STEP] = bench_number(1e3 * (double)setup.time_step);
        row[THICKENING] = bench_number(result.thickening);
        row[SPEED] = beside(result.speed, material->speed, 1e3, 0);
        row[CHANGE] = bench_number(i ? 100 * (result.speed / usual - 1) : NAN);
        row[HOTTEST] = beside(result.hottest, material->temperature, 1, 273.15);
        row[RESIDUE] = beside(result.residue, material->residue, 100, 0);
        row[BASIS] = bench_text(material->calibrated ? "calibrated" : "predicted");
        row[FINDING] = bench_text(finding(material, &result));
        if (!table_add(table, row)) return SINGE_ERROR_MEMORY;
    }
    return SINGE_OK;
}

SingeResult bench_front(const BenchOptions *options, BenchTable *table, SingeError *error) {
    SingeResult result = SINGE_OK;
    *table = table_begin("front", front_columns, FRONT_COLUMNS, table->text);
    for (int m = 0; m < options->material_count && !result; m++)
        result = front_material(options, &options->materials[m], table, error);
    return result;
}
