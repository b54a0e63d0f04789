// The grid and its memory.
//
// The grid reaches from a few cells beside and below the sheets, as they are at rest, to `height` above them. A face
// of cells lies at the lower end of the sheets along each axis: a flat sheet is then between two layers of cells.
#include "gas/advect_axis.h"

#include <string.h>

static const float PLAN_RATE = 60;                              ///< 1/s, steps of the gas
static const float PLAN_CELLS_ACROSS = 42;                      ///< cells along the diagonal of the sheets
static const float PLAN_CELL_MIN = 4e-3f, PLAN_MARGIN = 0.045f; ///< m
static const double PLAN_CELLS_USUAL = 200e3, PLAN_CELLS_MAX = 2e6;
enum { PLAN_PARTS_MAX = 16, PLAN_COARSEST = 4 };
enum { PLAN_SIDE_MAX = 4096 }; ///< cells along an axis: as many as a frame's file holds

static GasGrid plan_grid(const int n[3]) {
    GasGrid grid = {.n = {n[0], n[1], n[2]}};
    size_t cells = 1;
    for (int d = 0; d < 3; d++) {
        grid.stride[d] = cells;
        cells *= (size_t)n[d] + 2 * GAS_GHOSTS;
    }
    grid.cells = cells;
    return grid;
}

/// Fits cells of size `cell` to the box low to high with its margins, in multiples of eight so that coarser grids fit;
/// returns how many.
static double plan_fit(GasPlan *plan, const float low[3], const float high[3], float cell) {
    int up = 2;
    const float *g = plan->settings.gravity;
    for (int d = 0; d < 3; d++)
        if (fabsf(g[d]) > fabsf(g[up])) up = d;

    // cells along each axis, a multiple of eight, with a margin and the height above
    double cells = 1;
    for (int d = 0; d < 3; d++) {
        float below = PLAN_MARGIN, above = PLAN_MARGIN;
        if (d == up && g[d] > 0) below = plan->settings.def.height;
        else if (d == up) above = plan->settings.def.height;
        double lower = ceil((double)below / (double)cell);
        double upper = ceil((double)(high[d] - low[d] + above) / (double)cell);
        double count = 8 * ceil((lower + upper) / 8), spare = count - lower - upper;
        if (d != up) lower += floor(spare / 2);
        cells *= count;
        plan->grid.n[d] = count < 1e6 ? (int)count : 1000000;
        plan->origin[d] = low[d] - (float)lower * cell;
    }

    plan->cell = cell;
    return cells;
}

/// Fits the grid to the sheets at rest, then coarser and coarser grids, each of half as many cells along each axis.
static void plan_lay(GasPlan *plan, const Shell *shell) {
    float low[3] = {0}, high[3] = {0}, diagonal = 0, wanted = plan->settings.def.cell_size;
    bool first = true;

    // the box around all sheets at rest
    for (uint32_t i = 0; i < shell->particle_count; i++) {
        if (!(shell->matter.area[i] > 0)) continue;
        for (int d = 0; d < 3; d++) {
            float x = shell->rest_position[i][d];
            low[d] = first || x < low[d] ? x : low[d];
            high[d] = first || x > high[d] ? x : high[d];
        }

        first = false;
    }

    for (int d = 0; d < 3; d++) diagonal += (high[d] - low[d]) * (high[d] - low[d]);

    // the requested cell size, or one in proportion; larger until the grid fits the limits
    float cell = sqrtf(diagonal) / PLAN_CELLS_ACROSS;
    if (wanted > 0) cell = wanted;
    else if (cell < PLAN_CELL_MIN) cell = PLAN_CELL_MIN;
    if (cell < 1e-4f) cell = 1e-4f;
    double max = wanted > 0 ? PLAN_CELLS_MAX : PLAN_CELLS_USUAL;
    const int *n = plan->grid.n;
    while (plan_fit(plan, low, high, cell) > max || n[0] > PLAN_SIDE_MAX || n[1] > PLAN_SIDE_MAX ||
           n[2] > PLAN_SIDE_MAX)
        cell *= 1.05f;
    plan->grid = plan_grid(n);

    // levels of the pressure, while the grid can be halved
    GasGrid grid = plan->grid;
    for (bool even = true; even && plan->levels < GAS_LEVELS;) {
        int half[3];
        plan->level[plan->levels++].grid = grid;
        for (int d = 0; d < 3; d++) {
            even = even && grid.n[d] % 2 == 0 && grid.n[d] >= PLAN_COARSEST;
            half[d] = grid.n[d] / 2;
        }

        grid = plan_grid(half);
    }
}

/// Takes `count` floats from the block; with a NULL base only the size is counted.
static float *gas_take(float *base, size_t *used, size_t count) {
    float *slice = base ? base + *used : NULL;
    *used += (count + 15) / 16 * 16;
    return slice;
}

static size_t plan_turn(const GasPlan *plan, float *base, GasTurn *turn) {
    size_t used = 0, n = plan->particles;
    for (int f = 0; f < GAS_FIELDS; f++) turn->field[f] = gas_take(base, &used, plan->grid.cells);
    turn->conductance = gas_take(base, &used, n);
    turn->temperature = gas_take(base, &used, n);
    turn->fuel = gas_take(base, &used, n);
    turn->air = (float(*)[4])gas_take(base, &used, 4 * n);
    return used;
}

static size_t plan_scratch(GasPlan *plan, float *base) {
    size_t used = 0, cells = plan->grid.cells;
    for (int f = 0; f < 3; f++) plan->spare[f] = gas_take(base, &used, cells);
    for (int d = 0; d < 3; d++) plan->open[d] = gas_take(base, &used, cells);
    plan->mixing = gas_take(base, &used, cells);
    plan->expansion = gas_take(base, &used, cells);
    const size_t rows = gas_row(&plan->grid, plan->grid.n[1] + 1, plan->grid.n[2] + 1) + 1;
    for (int s = 0; s < 2; s++)
        plan->row_busy[s] = (GasRange *)gas_take(base, &used, rows * sizeof(GasRange) / sizeof(float));
    plan->solid = (uint8_t *)gas_take(base, &used, cells / sizeof(float) + 1);
    for (int l = 0; l < plan->levels; l++) {
        GasLevel *level = &plan->level[l];
        for (int d = 0; d < 3; d++) level->weight[d] = gas_take(base, &used, level->grid.cells);
        level->inverse = gas_take(base, &used, level->grid.cells);
        level->rhs = gas_take(base, &used, level->grid.cells);
        level->p = l ? gas_take(base, &used, level->grid.cells) : NULL; // the finest is the pressure itself
    }

    for (int f = 0; f < 3; f++) plan->view[f] = gas_take(base, &used, plan->view_cells);
    plan->view_velocity = (float(*)[3])gas_take(base, &used, 3 * plan->view_cells);
    return used;
}

void gas_plan_expose(const GasPlan *plan, GasState *gas) {
    const GasTurn *turn = &plan->turn[gas->turn];
    gas->conductance = turn->conductance;
    gas->temperature = turn->temperature;
    gas->fuel = turn->fuel;
    gas->air = (const float(*)[4])turn->air;
}

SingeResult gas_plan_create(Memory *memory, const Shell *shell, const GasSettings *settings, GasPlan **out,
                            GasState *gas) {
    *out = NULL;
    GasPlan *plan;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;
    plan->settings = *settings;
    plan->rows = sweep_choose(settings->instructions);
    plan->particles = shell->particle_count;
    plan->cell_count = shell->cell_count;

    // steps of the simulation per step of the gas, and parts of the latter
    float steps = 1 / (PLAN_RATE * settings->time_step);
    plan->every = steps > 1 ? (uint64_t)(steps + 0.5f) : 1;
    float length = (float)plan->every * settings->time_step, parts = ceilf(length * PLAN_RATE * 0.99f);
    plan->parts = parts < PLAN_PARTS_MAX ? (int)parts : PLAN_PARTS_MAX;
    plan->dt = length / (float)plan->parts;

    // the grid and its arrays
    plan_lay(plan, shell);
    size_t planes = (size_t)plan->grid.n[2];
    plan->view_cells = (size_t)plan->grid.n[0] * (size_t)plan->grid.n[1] * planes;
    plan->block_size = plan_turn(plan, NULL, &plan->turn[0]);
    plan->scratch_size = plan_scratch(plan, NULL);
    if (!NEW(memory, plan->block[0], plan->block_size) || !NEW(memory, plan->block[1], plan->block_size) ||
        !NEW(memory, plan->scratch, plan->scratch_size) || !NEW(memory, plan->normal, plan->particles) ||
        !NEW(memory, plan->partial, planes) || !NEW(memory, plan->hot, planes) ||
        !NEW(memory, plan->plane_busy, planes) || smother_create(memory, shell, &plan->smother)) {
        gas_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }

    for (int t = 0; t < 2; t++) plan_turn(plan, plan->block[t], &plan->turn[t]);
    plan_scratch(plan, plan->scratch);

    // start: all fuel, no gas
    for (int t = 0; t < 2; t++)
        for (uint32_t i = 0; i < plan->particles; i++) plan->turn[t].fuel[i] = 1;
    *gas = (GasState){0};
    gas_plan_expose(plan, gas);
    GasPass pass = {.plan = plan};
    gas_show(&pass, &plan->turn[0]);
    *out = plan;
    return SINGE_OK;
}

void gas_plan_free(Memory *memory, GasPlan *plan) {
    if (!plan) return;
    smother_free(memory, &plan->smother);
    FREE(memory, plan->normal, plan->particles);
    FREE(memory, plan->partial, (size_t)plan->grid.n[2]);
    FREE(memory, plan->hot, (size_t)plan->grid.n[2]);
    FREE(memory, plan->plane_busy, (size_t)plan->grid.n[2]);
    FREE(memory, plan->scratch, plan->scratch_size);
    for (int t = 0; t < 2; t++) FREE(memory, plan->block[t], plan->block_size);
    FREE(memory, plan, 1);
}

void gas_plan_set_gravity(GasPlan *plan, const float gravity[3]) {
    memcpy(plan->settings.gravity, gravity, sizeof plan->settings.gravity);
}

void gas_plan_set_pace(GasPlan *plan, float pace) { plan->settings.pace = pace; }

void gas_plan_torn(GasPlan *plan, uint32_t vertex, uint32_t spare) {
    for (int t = 0; t < 2; t++) { // only one is current; the other is written before it is read
        GasTurn *turn = &plan->turn[t];
        turn->conductance[spare] = turn->conductance[vertex];
        turn->temperature[spare] = turn->temperature[vertex];
        turn->fuel[spare] = turn->fuel[vertex];
        memcpy(turn->air[spare], turn->air[vertex], sizeof turn->air[spare]);
    }
}

void gas_plan_stream(GasPlan *plan, GasState *gas, Stream *stream) {
    uint8_t awake = gas->awake, warm = gas->warm;
    STREAM(stream, awake);
    STREAM(stream, warm);
    STREAM(stream, gas->steps);
    stream_data(stream, plan->block[gas->turn], plan->block_size * sizeof(float));
    if (stream->mode != STREAM_READ) return;
    for (size_t i = 0; i < plan->block_size; i++) stream->failed |= !isfinite(plan->block[gas->turn][i]);
    if (stream->failed) return;
    gas->awake = awake != 0;
    gas->warm = warm != 0;
    gas_plan_expose(plan, gas);
    GasPass pass = {.plan = plan};
    gas_show(&pass, &plan->turn[gas->turn]);
}
