#include "analysis/strip.h"

#include <math.h>
#include <stdlib.h>

static const double strip_lit = 0.02;                  // m
static const double gate_first = 0.4, gate_last = 0.9; // shares of the length between which the front is measured

typedef struct Strip {
    SingeSim *sim;
    uint32_t along, across; ///< cells
    double first, last;     ///< m, the gates
    float *positions;
    uint32_t *cells;
    float *lit; ///< 1 where it is hot at the start
} Strip;

StripSetup strip_setup(const SingeMaterialDef *material) {
    return (StripSetup){.material = *material,
                        .cell = 1e-3f,
                        .time_step = singe_default_sim().time_step,
                        .length = 0.12f,
                        .width = 3e-3f,
                        .gravity = {0, 0, -9.81f},
                        .pace = 1,
                        .threads = 1,
                        .patience = 20000,
                        .work_max = 1000000};
}

static bool strip_mesh(Strip *strip, const StripSetup *setup) {
    float cell = setup->cell;
    strip->along = (uint32_t)lround((double)(setup->length / cell));
    strip->across = (uint32_t)lround((double)(setup->width / cell));
    if (strip->across < 3) strip->across = 3;
    strip->first = gate_first * (double)setup->length;
    strip->last = gate_last * (double)setup->length;

    uint32_t n = strip->along, row = n + 1, vertices = row * (strip->across + 1), count = n * strip->across;
    strip->positions = malloc((size_t)3 * vertices * sizeof *strip->positions);
    strip->lit = malloc(vertices * sizeof *strip->lit);
    strip->cells = malloc((size_t)4 * count * sizeof *strip->cells);
    if (!strip->positions || !strip->lit || !strip->cells) return false;

    for (uint32_t v = 0; v < vertices; v++) {
        float *x = strip->positions + (size_t)3 * v;
        x[0] = (float)(v % row) * cell;
        x[1] = (float)(v / row) * cell;
        x[2] = 0;
        if (setup->shape) setup->shape(x, v % row, v / row, cell);
        strip->lit[v] = (double)x[0] < strip_lit;
    }

    for (uint32_t c = 0; c < count; c++) {
        uint32_t v = c / n * row + c % n, *corner = strip->cells + (size_t)4 * c;
        corner[0] = v;
        corner[1] = v + 1;
        corner[2] = v + row + 1;
        corner[3] = v + row;
    }

    return true;
}

/// A strip has no uv, no attributes and one speed: varying parameters take their mean.
static SingeMaterialDef strip_material(const SingeMaterialDef *from) {
    SingeMaterialDef material = *from;
    SingeParam *params[] = {
#define SINGE_PARAM(number, NAME, name, ...) &material.name,
#define SINGE_PARAM_BACK SINGE_PARAM
#include "singe/material.def"
    };
    for (size_t i = 0; i < sizeof params / sizeof *params; i++)
        if (params[i]->field) *params[i] = singe_param(0.5f * (params[i]->value + params[i]->to));

    // char glows in patches; the hottest counts
    const SingeParam *patchy[] = {&from->char_yield, &from->char_density, &from->char_heat, &from->char_rate,
                                  &from->char_air};
    SingeParam *chars[] = {&material.char_yield, &material.char_density, &material.char_heat, &material.char_rate,
                           &material.char_air};
    for (size_t i = 0; i < sizeof chars / sizeof *chars; i++)
        if (patchy[i]->field && patchy[i]->field->kind == SINGE_FIELD_NOISE) *chars[i] = *patchy[i];

    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        material.weight[c] = singe_param(1);
        material.compliance[c] = singe_param(0);
    }

    // where it is lit it is hot and dry
    static const SingeField lit = {.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "lit"};
    material.temperature = singe_param_field(material.temperature.value, 1100, &lit);
    if (material.moisture.value > 0) material.moisture = singe_param_field(material.moisture.value, 0, &lit);
    return material;
}

static SingeResult strip_fill(Strip *strip, const StripSetup *setup) {
    SingeSheetDef sheet = singe_default_sheet();
    SingeAttribute lit = {"lit", strip->lit};
    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    const float centre[3] = {setup->length / 2, 0, 0};

    sheet.vertex_count = (strip->along + 1) * (strip->across + 1);
    sheet.positions = strip->positions;
    sheet.cell_count = strip->along * strip->across;
    sheet.cells = strip->cells;
    sheet.attribute_count = 1;
    sheet.attributes = &lit;
    sheet.material = strip_material(&setup->material);

    SingeResult result = singe_sim_add_sheet(strip->sim, &sheet, &pin.sheet);
    if (!result) result = singe_sim_commit(strip->sim);
    pin.point_count = 1;
    pin.points = centre;
    pin.radius = 1; // all of it
    return result ? result : singe_sim_add_pin(strip->sim, &pin, &pin_id);
}

/// The position of the fire along the centre.
static double strip_front(const Strip *strip, const SingeView *view) {
    const float *ignited = view->time_ignited + (strip->across / 2) * (strip->along + 1);
    uint32_t i = strip->along;
    while (i > 0 && ignited[i] < 0) i--;
    return (double)view->rest_position[i][0];
}

static uint64_t strip_work(const Strip *strip) {
    const SingeTimers timers = singe_sim_timers(strip->sim);
    return timers.steps + timers.heat_iterations;
}

static SingeResult strip_run(Strip *strip, const StripSetup *setup, StripResult *result) {
    double reached = 0;
    for (int since = 0; reached <= strip->last && since < setup->patience && strip_work(strip) < setup->work_max;) {
        SingeResult failed = singe_sim_step(strip->sim);
        if (failed) return failed;

        SingeView view = singe_sim_view(strip->sim);
        double front = strip_front(strip, &view);
        since++;

        if (front > reached) {
            reached = front;
            since = 0;
        }
    }

    SingeView view = singe_sim_view(strip->sim);
    result->thickening = (double)singe_sim_stats(strip->sim).thickening;

    // the least-squares line through positions and times of ignition between the gates
    double n = 0, x1 = 0, t1 = 0, xt = 0, tt = 0;
    for (uint32_t v = 0; v < view.vertex_count; v++) {
        double x = (double)view.rest_position[v][0], t = (double)view.time_ignited[v];
        if (x < strip->first || x > strip->last || t < 0) continue;
        n++;
        x1 += x;
        t1 += t;
        xt += x * t;
        tt += t * t;
    }

    const double speed = (n * xt - x1 * t1) / (n * tt - t1 * t1);
    result->speed = strip_front(strip, &view) > strip->last ? speed / (double)setup->pace : 0;

    double area = 0, mass = 0;
    result->hottest = 0;
    for (uint32_t i = 0; i < view.particle_count; i++) {
        double x = (double)view.rest_position[i][0];
        if (x < strip->first || x > strip->last) continue;
        result->hottest = fmax(result->hottest, (double)view.temperature_peak[i]);
        if (x > (strip->first + strip->last) / 2) continue; // long burnt
        area += (double)view.area[i];
        mass += (double)view.area[i] * (double)view.mass[i];
    }

    result->residue = mass / area;

    result->work = strip_work(strip);
    result->end = reached > strip->last ? STRIP_THROUGH : result->work < setup->work_max ? STRIP_OUT : STRIP_CUT;
    return SINGE_OK;
}

SingeResult strip_burn(const StripSetup *setup, StripResult *result, SingeError *error) {
    Strip strip = {0};
    SingeSimDef def = singe_default_sim();
    def.time_step = setup->time_step;
    def.thread_count = setup->threads;
    def.solver.substeps = 1; // nothing moves
    def.pace = setup->pace;
    def.gas.enabled = setup->gas;
    def.gas.cell_size = setup->gas_cell;
    for (int d = 0; d < 3; d++) def.gravity[d] = setup->gravity[d];

    SingeResult code = strip_mesh(&strip, setup) ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (!code) code = singe_sim_create(&def, &strip.sim, error);
    else *error = (SingeError){.code = code, .element = -1};

    if (strip.sim) {
        code = strip_fill(&strip, setup);
        if (!code) code = strip_run(&strip, setup, result);
        if (code) *error = *singe_sim_error(strip.sim);
    }

    singe_sim_destroy(strip.sim);
    free(strip.positions);
    free(strip.lit);
    free(strip.cells);
    return code;
}
