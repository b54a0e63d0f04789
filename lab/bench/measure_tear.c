// A strip that is pulled apart. Paper of 120 mm x 60 mm, of a stretch stiffness of 500 N/m, is held at its short sides,
// which separate at 4 mm/s. Across it, at 50 mm, a texture weakens a line from 2 to 1 N/m. The load is the mean line
// force along the strip over the cells between the grips. It should break at the weak line, at about its strength, for
// any cells and steps.
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/geometry.h"

static const float length = 0.12f, width = 0.06f, line = 0.05f; // m
static const float strength = 2, line_strength = 1;             // N/m
static const float speed = 4e-3f, seconds = 0.45f;
static const float stiffness = 500; // N/m

enum { STEP_RATE = 480, SUBSTEPS = 16, GRIP_CELLS = 2, PICTURE_WIDTH = 18, PICTURE_LINE = 7 };

typedef struct Pulled {
    double load;    ///< N/m, the max
    double stretch; ///< at that time
    int tears, aside;
    uint32_t pieces;
} Pulled;

static SingeResult add_strip(SingeSim *sim, uint32_t nx, uint32_t ny, SingeSheetId *id) {
    uint32_t row = nx + 1, vertices = row * (ny + 1), cells = nx * ny;
    float *positions = calloc((size_t)3 * vertices, sizeof *positions), *uv = calloc((size_t)2 * vertices, sizeof *uv);
    uint32_t *corners = calloc((size_t)4 * cells, sizeof *corners);
    float picture[PICTURE_WIDTH] = {0};
    SingeSheetDef def = singe_default_sheet();
    SingeResult result = SINGE_ERROR_MEMORY;

    picture[PICTURE_LINE] = 1;
    if (positions && uv && corners) {
        for (uint32_t v = 0; v < vertices; v++) {
            float x = (float)(v % row) / (float)nx, y = (float)(v / row) / (float)ny;
            positions[3 * v] = length * x;
            positions[3 * v + 1] = width * y;
            uv[2 * v] = x;
            uv[2 * v + 1] = y;
        }

        geometry_grid(nx, ny, corners);
        def.vertex_count = vertices;
        def.positions = positions;
        def.uv = uv;
        def.cell_count = cells;
        def.cells = corners;
        def.material.compliance[SINGE_BLUE] = singe_param(1 / stiffness);
        def.material.strength =
            singe_param_field(strength, line_strength,
                              &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {PICTURE_WIDTH, 1, picture}});
        result = singe_sim_add_sheet(sim, &def, id);
    }

    free(positions);
    free(uv);
    free(corners);
    return result;
}

/// Holds the first or last columns of vertices, and moves them.
static SingeResult add_grip(SingeSim *sim, uint32_t nx, uint32_t ny, bool last, float by, SingeSheetId id) {
    uint32_t columns_held = GRIP_CELLS + 1, count = 0, *held = malloc(columns_held * (ny + 1) * sizeof *held);
    if (!held) return SINGE_ERROR_MEMORY;
    for (uint32_t j = 0; j <= ny; j++)
        for (uint32_t i = 0; i < columns_held; i++) held[count++] = j * (nx + 1) + (last ? nx - i : i);

    const SingePoseKey path[2] = {{0, {0, 0, 0}, {0, 0, 0, 1}}, {seconds, {by, 0, 0}, {0, 0, 0, 1}}};
    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;

    pin.sheet = id;
    pin.vertex_count = count;
    pin.vertices = held;
    pin.path_count = 2;
    pin.path = path;
    SingeResult result = singe_sim_add_pin(sim, &pin, &pin_id);
    free(held);
    return result;
}

static SingeResult pull(const BenchOptions *options, uint32_t nx, uint32_t ny, int rate, Pulled *pulled,
                        SingeError *error) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;
    SingeSheetId id;

    def.thread_count = options->threads;
    def.instructions = options->instructions;
    def.time_step = 1.0f / (float)rate;
    def.gravity[2] = 0;
    def.solver.tearing = true;
    def.solver.substeps = options->substeps ? options->substeps : SUBSTEPS;
    TRY(singe_sim_create(&def, &sim, error));

    SingeResult result = add_strip(sim, nx, ny, &id);
    if (!result) result = singe_sim_commit(sim);
    if (!result) result = add_grip(sim, nx, ny, false, 0, id);
    if (!result) result = add_grip(sim, nx, ny, true, speed * seconds, id);

    *pulled = (Pulled){0};
    for (int k = 0; k < (int)(seconds * (float)rate) && !result; k++) {
        result = singe_sim_step(sim);
        const SingeView view = singe_sim_view(sim);

        // the mean line force along the strip, of the cells between the grips
        double sum = 0, count = 0;
        for (uint32_t c = 0; c < view.cell_count; c++) {
            if (c % nx < GRIP_CELLS || c % nx >= nx - GRIP_CELLS) continue;
            sum += (double)view.line_force[c][0];
            count++;
        }

        double load = sum / count;

        if (load > pulled->load) {
            pulled->load = load;
            pulled->stretch = (double)speed * view.time / (double)length;
        }
    }

    const SingeStats stats = singe_sim_stats(sim);
    const SingeView view = singe_sim_view(sim);
    pulled->tears = (int)stats.tears;
    pulled->pieces = stats.pieces;

    // vertices that were created by tears, away from the line
    const float cell = length / (float)nx;
    for (uint32_t v = (nx + 1) * (ny + 1); v < view.vertex_count; v++)
        pulled->aside += view.particle_flags[v] & SINGE_ALIVE && fabsf(view.rest_position[v][0] - line) > 0.6f * cell;
    if (result) *error = *singe_sim_error(sim);
    singe_sim_destroy(sim);
    return result;
}

SingeResult bench_tear(const BenchOptions *options, BenchTable *table, SingeError *error) {
    double first = 0;
    for (int finer = 1; finer <= 2; finer++)
        for (int rate = STEP_RATE; rate <= 2 * STEP_RATE; rate *= 2) {
            Pulled pulled;
            uint32_t nx = 24 * (uint32_t)finer, ny = 12 * (uint32_t)finer;
            TRY(pull(options, nx, ny, rate, &pulled, error));
            if (first == 0) first = pulled.load;
            table_number(table, "cell_mm", "%.3g", 7, 1e3 * (double)length / nx);
            table_number(table, "step_ms", "%.3f", 7, 1e3 / rate);
            table_number(table, "substeps", "%.0f", 8, options->substeps ? options->substeps : SUBSTEPS);
            table_number(table, "load_n_m", "%.3f", 9, pulled.load);
            table_number(table, "off_pct", "%.1f", 8,
                         100 * (pulled.load / first - 1)); // relative to the first row's load
            table_number(table, "stretch_pct", "%.2f", 11, 100 * pulled.stretch);
            table_number(table, "tears", "%.0f", 6, pulled.tears);
            table_number(table, "pieces", "%.0f", 6, pulled.pieces);
            table_number(table, "aside", "%.0f", 6, pulled.aside); // vertices that tore away from the line
            if (table_end_row(table)) return SINGE_ERROR_MEMORY;
        }

    return SINGE_OK;
}
