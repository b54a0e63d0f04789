// The angle that remains after folding: a strip between two held halves is rolled to an angle, and released.
//
// The strip is 80 mm by 12.5 mm, 1.5 mm thick in the model, D = 9e-6 N m. Its central 15 mm are rolled as around a rod,
// to a radius of 4.8 mm at 180 degrees. The moving half arrives in 0.6 s, rests for 0.3 s and is released; then only
// friction acts. The other half remains held. `left` is the angle between the halves 2 s later.
//
//   expected  crease_share (angle - arc/crease_radius), as for continuous bending (docs/equations/stiffness.md)
//   elastic   left without creases: it should spring back
//
// Folds are towards the layer of centres and towards that of corners. The angles should agree at half the cell size and
// at half the time step.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"
#include "bench/hung_sheet.h"

static const double length = 0.08, width = 0.0125, arc = 0.015, pi = 3.14159265358979323846;
static const double fold_time = 0.6, hold_time = 0.3, free_time = 2;

typedef struct Fold {
    double angle; ///< rad, positive: up, towards the centres
    double cell, step;
    int threads;
    bool creases;
    double left; ///< deg, in the direction of the fold
    double inverted;
} Fold;

enum { KEYS = 65 };

static SingeResult hold(SingeSim *sim, SingeSheetId sheet, const SingeView *view, bool right, const SingePoseKey *path,
                        SingePinId *id) {
    SingePinDef pin = singe_default_pin();
    uint32_t *vertices = malloc(view->vertex_count * sizeof *vertices);
    if (!vertices) return SINGE_ERROR_MEMORY;

    for (uint32_t v = 0; v < view->vertex_count; v++) {
        double x = (double)view->rest_position[v][0];
        if (right ? x > (length + arc) / 2 - 1e-5 : x < (length - arc) / 2 + 1e-5) vertices[pin.vertex_count++] = v;
    }

    pin.sheet = sheet;
    pin.vertices = vertices;
    if (right) {
        pin.path_count = KEYS;
        pin.path = path;
    }

    SingeResult result = singe_sim_add_pin(sim, &pin, id);
    free(vertices);
    return result;
}

static SingeResult run_steps(SingeSim *sim, Fold *fold, double seconds) {
    SingeView view = singe_sim_view(sim);
    SingeResult result = SINGE_OK;
    for (long step = lround(seconds / fold->step); step > 0 && !result; step--) {
        result = singe_sim_step(sim);
        fold->inverted = fmax(fold->inverted, geometry_inverted(&view));
    }
    return result;
}

static SingeResult fold_fill(SingeSim *sim, Fold *fold) {
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;
    SingePinId left, right;
    SingePoseKey path[KEYS];

    sheet_inert(&sheet.material);
    sheet.material.damping = singe_param(4);
    sheet.material.thickness = singe_param(1.5e-3f);
    sheet.material.compliance[SINGE_RED] = singe_param(0.1f); // less would kink between cells of 1.25 mm
    sheet.material.compliance[SINGE_GREEN] = singe_param(0.25f);

    const int cells[2] = {(int)lround(length / fold->cell), (int)lround(width / fold->cell)};
    const float size[2] = {(float)length, (float)width};
    SingeResult result = sheet_add_strip(sim, &sheet, cells, size, false, &id);
    if (!result) result = singe_sim_commit(sim);
    SingeView view = singe_sim_view(sim);

    // the pose of the moving half's start as it rolls
    const double angle = fold->angle;
    for (int k = 0; k < KEYS; k++) {
        double share = k / (KEYS - 1.0), turn = angle * share, curvature = turn / arc;
        double x = k ? sin(turn) / curvature : arc, z = k ? (1 - cos(turn)) / curvature : 0;
        path[k] = (SingePoseKey){(float)(fold_time * share),
                                 {(float)((length - arc) / 2 + x), 0, (float)z},
                                 {0, (float)-sin(turn / 2), 0, (float)cos(turn / 2)}};
    }

    if (!result) result = hold(sim, id, &view, false, NULL, &left);
    if (!result) result = hold(sim, id, &view, true, path, &right);
    if (!result) result = run_steps(sim, fold, fold_time + hold_time);
    if (!result) result = singe_sim_remove_pin(sim, right);
    if (!result) result = run_steps(sim, fold, free_time);
    if (result) return result;

    // the angle between the halves, about the strip's width, within a right angle of that of the fold
    double along[2] = {0, 0};
    for (uint32_t v = 0; v < view.vertex_count; v++) {
        double x = (double)view.rest_position[v][0] - 0.75 * length;
        if (fabs(x) > 0.2 * length) continue;
        along[0] += x * (double)view.position[v][0];
        along[1] += x * (double)view.position[v][2];
    }

    double turned = atan2(along[1], along[0]);
    turned -= 2 * pi * round((turned - angle / 2) / (2 * pi));
    fold->left = 180 / pi * turned * (angle > 0 ? 1 : -1);
    return SINGE_OK;
}

static SingeResult fold_run(const BenchOptions *options, Fold *fold, bool creases, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    def.thread_count = options->threads;
    def.instructions = options->instructions;
    def.time_step = (float)fold->step;
    def.solver.substeps = options->substeps; // 0: as many as the strip's stiffness needs
    def.solver.creases = creases;
    for (int axis = 0; axis < 3; axis++) def.gravity[axis] = 0;
    fold->inverted = 0;

    TRY(singe_sim_create(&def, &sim, error));

    SingeResult result = fold_fill(sim, fold);
    if (result) {
        *error = *singe_sim_error(sim);
        error->code = result;
    }

    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_fold(const BenchOptions *options, BenchTable *table, SingeError *error) {
    static const double bends[] = {180, 45}, cells[] = {2.5e-3, 1.25e-3, 2.5e-3, 1.25e-3};
    static const double steps[] = {480, 480, 960, 960};
    const SingeMaterialDef material = singe_default_material();
    const double share = (double)material.crease_share.value, radius = (double)material.crease_radius.value;
    SingeResult result = SINGE_OK;
    for (int i = 0; i < 2 * 2 * 4 && !result; i++) {
        const int setting = i % 4, towards = i / 4 % 2, bend = i / 8;
        if (options->quick && setting == 3) continue;

        Fold fold = {
            .angle = (towards ? 1 : -1) * bends[bend] * pi / 180, .cell = cells[setting], .step = 1 / steps[setting]};
        result = fold_run(options, &fold, false, error);
        double elastic = fold.left;
        if (!result) result = fold_run(options, &fold, true, error);

        if (!result) {
            table_text(table, "towards", 8, towards ? "centres" : "corners");
            table_number(table, "bent_deg", "%.0f", 8, bends[bend]);
            table_number(table, "cell_mm", "%.3g", 8, 1e3 * fold.cell);
            table_number(table, "h_ms", "%.3g", 6, 1e3 * fold.step);
            table_number(table, "left_deg", "%.1f", 8, fold.left);
            table_number(table, "expected_deg", "%.1f", 12,
                         180 / pi * fmax(0, share * (fabs(fold.angle) - arc / radius)));
            table_number(table, "elastic_deg", "%.1f", 11, elastic);
            table_number(table, "inverted", "%.0f", 8, fold.inverted);
            result = table_end_row(table);
        }
    }

    return result;
}
