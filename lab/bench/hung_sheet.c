#include "bench/hung_sheet.h"

#include <stdlib.h>

#include "bench/geometry.h"
#include "common/store.h"

static const float size = 1; // m

BenchSetup sheet_setup(const BenchOptions *options, BenchState state, int steps) {
    BenchSetup setup = {
        .state = state,
        .cells = 100,
        .pins = 2,
        .thickness = 1e-3f,
        .shrink = 0.8f,
        .threads = options->threads,
        .time_step = 1.0f / (float)(BENCH_FPS * steps),
        .instructions = options->instructions,
    };

    singe_init_solver_method(&setup.solver, sizeof setup.solver, options->solver);
    setup.rigid = options->solver != SINGE_SOLVER_STRAND;
    if (options->substeps || options->solver == SINGE_SOLVER_STRAND) setup.solver.substeps = options_substeps(options);
    if (options->projections) setup.solver.projections = options->projections;
    if (options->start >= 0) setup.solver.start = (float)options->start;
    if (options->smoothing >= 0) setup.solver.smoothing = (float)options->smoothing;
    return setup;
}

SingeResult sheet_add_strip(SingeSim *sim, SingeSheetDef *def, const int cells[2], const float sides[2], bool upright,
                            SingeSheetId *id) {
    uint32_t n = (uint32_t)cells[0], rows = (uint32_t)cells[1], row = n + 1, vertices = row * (rows + 1);
    float *positions = malloc((size_t)3 * vertices * sizeof *positions);
    uint32_t *corners = malloc((size_t)4 * n * rows * sizeof *corners);
    SingeResult result = SINGE_ERROR_MEMORY;

    if (positions && corners) {
        for (uint32_t v = 0; v < vertices; v++) {
            float across = sides[0] * (float)(v % row) / (float)n, along = sides[1] * (float)(v / row) / (float)rows;
            float *x = positions + (size_t)3 * v;
            x[0] = across;
            x[1] = upright ? 0 : along;
            x[2] = upright ? along : 0;
        }

        geometry_grid(n, rows, corners);
        def->vertex_count = vertices;
        def->positions = positions;
        def->cell_count = n * rows;
        def->cells = corners;
        result = singe_sim_add_sheet(sim, def, id);
    }

    free(positions);
    free(corners);
    return result;
}

SingeResult sheet_add(SingeSim *sim, SingeSheetDef *def, int cells, float side, bool upright, SingeSheetId *id) {
    return sheet_add_strip(sim, def, (const int[]){cells, cells}, (const float[]){side, side}, upright, id);
}

void sheet_inert(SingeMaterialDef *material) {
    material->grammage = singe_param(0.1f);
    material->reference_grammage = 0;
    material->diffusivity = material->layer_exchange = singe_param(0);
    material->convection = material->emissivity = singe_param(0);
    material->heat_share = singe_param(0);
    material->thickening = 1;
    material->drag = material->damping = singe_param(0);
    material->char_weight = singe_param(1);
    material->ablate = false;
}

static SingeResult hung_sheet_fill(SingeSim *sim, const BenchSetup *setup) {
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;

    sheet_inert(&sheet.material);
    sheet.material.thickness = singe_param(setup->thickness);
    if (setup->state == BENCH_SHRINK) {
        // The sheet is hot from the start and loses one hundredth of its mass within a second; by eq 5 and 6 the ratio
        // of lengths becomes m_min/ash_density = `ratio`. It never burns through, as mass_loss is below m_min.
        const float ratio = setup->shrink;
        const float min = 0.99f, excess = 100; // excess in K

        sheet.material.ignition_temperature = singe_param(500);
        sheet.material.temperature = singe_param(500 + excess);
        sheet.material.rate_ceiling = singe_param(excess);
        sheet.material.mass_rate = singe_param((1 - min) / excess);
        sheet.material.ash_exponent = singe_param(0);
        sheet.material.mass_min = singe_param(min);
        sheet.material.mass_loss = singe_param(0);
        sheet.material.ash_density = singe_param(min / ratio);
        sheet.material.shrink_front = sheet.material.shrink_back = sheet.material.fibre_shrink = singe_param(1);
    }

    for (int c = 0; setup->rigid && c < SINGE_COLOUR_COUNT; c++) sheet.material.compliance[c] = singe_param(0);
    SingeResult result;
    if (setup->shape) {
        sheet.vertex_count = setup->shape->vertex_count;
        sheet.positions = setup->shape->positions;
        sheet.cell_count = setup->shape->cell_count;
        sheet.cells = setup->shape->cells;
        result = singe_sim_add_sheet(sim, &sheet, &id);
    } else {
        result = sheet_add(sim, &sheet, setup->cells, size, setup->state != BENCH_SWING, &id);
    }

    if (!result) result = singe_sim_commit(sim);
    if (result) return result;

    // pins: only a corner's vertex if the sheet swings, else a patch
    const bool upright = setup->state != BENCH_SWING;
    const float high = upright ? size : 0, corners[2][3] = {{0, 0, high}, {size, 0, high}};
    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;

    pin.sheet = id;
    pin.point_count = 1;
    pin.radius = upright ? 0.05f * size : 0;
    for (int p = 0; p < setup->pins; p++) {
        pin.points = corners[p];
        TRY(singe_sim_add_pin(sim, &pin, &pin_id));
    }

    return SINGE_OK;
}

SingeResult bench_give_up(SingeSim **sim, SingeResult result, SingeError *error) {
    *error = *singe_sim_error(*sim);
    error->code = result;
    singe_sim_destroy(*sim);
    *sim = NULL;
    return result;
}

SingeResult sheet_build(const BenchSetup *setup, SingeSim **sim, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = setup->threads;
    def.instructions = setup->instructions;
    def.time_step = setup->time_step;
    def.solver = setup->solver;
    TRY(singe_sim_create(&def, sim, error));

    SingeResult result = hung_sheet_fill(*sim, setup);
    return result ? bench_give_up(sim, result, error) : SINGE_OK;
}

// ---- burning

static SingeResult burning_fill(SingeSim *sim, const BenchOptions *options, double springs) {
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId sheet_id;
    const SingeField noise = {.kind = SINGE_FIELD_NOISE, .noise = {0.05f, 4, 1}};
    const float rate = sheet.material.mass_rate.value;
    sheet.material.mass_rate = singe_param_field(rate, 2 * rate, &noise);
    if (options->curvature.count) sheet.material.curvature_max = singe_param((float)options->curvature.values[0]);
    TRY(sheet_add(sim, &sheet, options_cells(springs), 0.3f, true, &sheet_id));
    TRY(singe_sim_commit(sim));

    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    const float corners[6] = {0, 0, 0.3f, 0.3f, 0, 0.3f};

    pin.sheet = sheet_id;
    pin.point_count = 2;
    pin.points = corners;
    pin.radius = 0.01f;
    TRY(singe_sim_add_pin(sim, &pin, &pin_id));

    const SingePoseKey across[2] = {{0, {0.05f, 0, 0.1f}, {0, 0, 0, 1}}, {2, {0.25f, 0, 0.1f}, {0, 0, 0, 1}}};
    SingeSourceDef ball = singe_default_source();
    SingeSourceId source_id;

    ball.kind = SINGE_SOURCE_BALL;
    ball.radius = 0.04f;
    ball.falloff = 0.02f;
    ball.path_count = 2;
    ball.path = across;
    ball.conductance = 1000;
    TRY(singe_sim_add_source(sim, &ball, &source_id));

    const SingePoseKey ground = {0, {0, 0, 0.005f}, {0, 0, 0, 1}}; // the sheet's lower edge lies on it
    const SingePoseKey centre = {0, {0.15f, 0.048f, 0.12f}, {0, 0, 0, 1}};
    SingeColliderDef plane = singe_default_collider(), sphere = singe_default_collider();
    SingeColliderId id;

    plane.path_count = 1;
    plane.path = &ground;
    TRY(singe_sim_add_collider(sim, &plane, &id));
    sphere.kind = SINGE_COLLIDER_SPHERE;
    sphere.radius = 0.05f;
    sphere.path_count = 1;
    sphere.path = &centre;
    return singe_sim_add_collider(sim, &sphere, &id);
}

SingeResult burning_build(const BenchOptions *options, const SingeAllocator *allocator, double springs, float pace,
                          SingeSim **sim, SingeError *error) {
    BenchSetup setup = sheet_setup(options, BENCH_SWING, 20);
    SingeSimDef def = singe_default_sim();
    def.thread_count = options->threads;
    def.instructions = options->instructions;
    def.solver = setup.solver;
    def.pace = pace;
    def.surface_detail = (float)options->detail;
    def.contact.enabled = options->contact;
    if (allocator) def.allocator = *allocator;

    TRY(singe_sim_create(&def, sim, error));
    SingeResult result = burning_fill(*sim, options, springs);
    return result ? bench_give_up(sim, result, error) : SINGE_OK;
}
