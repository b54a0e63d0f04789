// A burning sheet that is drawn, and fields for it that drawings must reproduce.
#pragma once

#include "ablate/burning_sheet.h"
#include "shell/split.h"
#include "surface/surface_fine.h"

typedef struct Drawing {
    BurningSheet *sheet;
    AblatePlan *plan;
    Pool *pool; ///< of draw_fine, or NULL
    SurfaceDetail detail;
    SingeSurface surface;
} Drawing;

/// Takes the sheet, which drawing_free frees.
static inline Drawing *drawing_of(BurningSheet *sheet) {
    Drawing *d = calloc(1, sizeof *d);
    assert_non_null(d);
    d->sheet = sheet;
    assert_int_equal(ablate_plan_create(&sheet->memory, &sheet->shell, &d->plan), SINGE_OK);
    return d;
}

/// A sheet of plain_material to be refined.
static inline Drawing *fine_drawing(uint32_t nx, uint32_t ny, float cell, float detail, float raggedness) {
    SingeMaterialDef material = plain_material();
    Drawing *d = drawing_of(burning_sheet(nx, ny, cell, &material));
    d->detail = (SurfaceDetail){.size = detail, .raggedness = raggedness, .seed = 1};
    return d;
}

static inline void drawing_free(Drawing *d) {
    singe_surface_free(&d->surface);
    ablate_plan_free(&d->sheet->memory, d->plan);
    if (d->pool) pool_destroy(&d->sheet->memory, d->pool);
    burning_sheet_free(d->sheet);
    free(d);
}

static inline void drawing_end(Drawing **d) { drawing_free(*d); }
#define OwnDrawing OWNED(drawing_end) Drawing

static inline void draw_coarse(Drawing *d) {
    const BurningSheet *b = d->sheet;
    assert_int_equal(surface_draw(d->plan, &b->shell, &b->state, &d->surface, &d->sheet->error), SINGE_OK);
}

static inline void draw_fine(Drawing *d) {
    const BurningSheet *b = d->sheet;
    assert_int_equal(surface_draw_fine(d->plan, &b->shell, &b->state, &d->detail, &d->sheet->memory, d->pool,
                                       &d->surface, &d->sheet->error),
                     SINGE_OK);
}

/// Removes what has burnt.
static inline void ablate(Drawing *d) { sheet_ablate(d->sheet, d->plan); }

static inline void set_level(Drawing *d, uint32_t particle, float level) {
    d->sheet->state.burn.mass[particle] = field_at(d->sheet->shell.matter.mass_loss, particle) + level;
}

/// A field a x + b y + c of the rest position.
typedef struct Linear {
    double a, b, c;
} Linear;
static inline double value_at(Linear f, const float *p) { return f.a * (double)p[0] + f.b * (double)p[1] + f.c; }

static const struct {
    Linear temperature, peak, rate, ignited, velocity[3];
} linear_fields = {{100, 200, 300}, {-50, 100, 900}, {0.1, -0.1, 1}, {2, 1, 5}, {{1, 2, 3}, {0, 0, 0}, {-3, 1, 0}}};

/// The sheet is tilted: z = x/2.
static inline void set_linear_fields(Drawing *d, Linear level) {
    BurningSheet *b = d->sheet;
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        const float *p = b->shell.rest_position[i];
        set_level(d, i, (float)value_at(level, p));
        b->state.heat.temperature[i] = (float)value_at(linear_fields.temperature, p);
        b->state.heat.temperature_peak[i] = (float)value_at(linear_fields.peak, p);
        b->state.burn.burn_rate[i] = (float)value_at(linear_fields.rate, p);
        b->state.burn.time_ignited[i] = (float)value_at(linear_fields.ignited, p);
        for (int k = 0; k < 3; k++) b->state.dynamics.velocity[i][k] = (float)value_at(linear_fields.velocity[k], p);
        b->state.dynamics.position[i][2] = i < b->shell.vertex_count ? 0.5f * p[0] : 77; // centres do not count
    }
}

/// The drawn surface of a sheet of nx x ny cells of 1 m has the fields of set_linear_fields.
static inline void expect_linear_fields(const Drawing *d, Linear level, double normal_tolerance) {
    const SingeSurface *s = &d->surface;
    const double nx = d->sheet->nx, ny = d->sheet->ny;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const float *p = s->position[v];
        assert_float_equal(s->mass[v], 0.25 + value_at(level, p), 2e-6);
        assert_float_equal(s->temperature[v], value_at(linear_fields.temperature, p), 1e-3);
        assert_float_equal(s->temperature_peak[v], value_at(linear_fields.peak, p), 1e-3);
        assert_float_equal(s->burn_rate[v], value_at(linear_fields.rate, p), 1e-5);
        assert_float_equal(s->time_ignited[v], value_at(linear_fields.ignited, p), 2e-5);

        for (int k = 0; k < 3; k++)
            assert_float_equal(s->velocity[v][k], value_at(linear_fields.velocity[k], p), k == 1 ? 0 : 2e-5);
        assert_float_equal(p[2], 0.5 * (double)p[0], 2e-6);
        assert_float_equal(s->uv[v][0], (double)p[0] / nx, 1e-6);
        assert_float_equal(s->uv[v][1], (double)p[1] / ny, 1e-6);

        for (int k = 0; k < 2; k++) assert_float_equal(s->rest_position[v][k], p[k], 1e-6);
        assert_float_equal(s->rest_position[v][2], 0, 0);
        assert_float_equal(s->normal[v][0], -0.5 / sqrt(1.25), normal_tolerance);
        assert_float_equal(s->normal[v][1], 0, normal_tolerance);
        assert_float_equal(s->normal[v][2], 1 / sqrt(1.25), normal_tolerance);
        assert_int_equal(s->sheet[v], 0);
        assert_int_equal(s->piece[v], 0);
        if (s->source_vertex[v] < 0) continue;
        assert_memory_equal(p, d->sheet->state.dynamics.position[s->source_vertex[v]], 12);
    }
}

/// Tears the sheet along y = row from its border on, up to `length` cells far; the tear edges stay at one position.
static inline void tear_along(Drawing *d, uint32_t row, uint32_t length) {
    BurningSheet *b = d->sheet;
    for (uint32_t i = 0; i < length; i++) {
        ShellSplit split = {.vertex = corner_at(b, i, row)};
        Fan fan;
        split_fan(&b->shell, split.vertex, &fan);
        for (int k = 0; k < fan.count; k++) split.cells |= (uint32_t)(fan.cell[k] >= row * b->nx) << k;
        assert_true(split_is_possible(&b->shell, &fan, &split));

        uint32_t spare = split_vertex(&b->shell, &fan, &split).spare;
        memcpy(b->state.dynamics.position[spare], b->state.dynamics.position[split.vertex], 16);
        b->state.burn.mass[spare] = b->state.burn.mass[split.vertex];
        b->state.ablate.particle_flags[spare] = SINGE_ALIVE;
        b->shell.split_count++;
    }
}

/// A fire that burns from some points at 1 m/s: rings, so that the front runs in all directions.
static inline void burn_rings(Drawing *d, float time) {
    const float at[3][2] = {{0.031f, 0.042f}, {0.068f, 0.075f}, {0.083f, 0.017f}};
    const float width = 0.008f; // of the front, m
    BurnState *burn = &d->sheet->state.burn;

    d->sheet->state.time = (double)time;
    for (uint32_t i = 0; i < d->sheet->shell.particle_count; i++) {
        const float *p = d->sheet->shell.rest_position[i];
        float nearest = 1;
        for (int k = 0; k < 3; k++) nearest = fminf(nearest, hypotf(p[0] - at[k][0], p[1] - at[k][1]));
        float mass = 0.6f + (nearest - time) / width;
        if (mass < 1) burn->time_ignited[i] = nearest - 0.4f * width;
        if (mass < 0.25f) burn->time_burnt[i] = nearest + 0.35f * width;
        burn->mass[i] = fminf(1, fmaxf(0.15f, mass));
    }
}
