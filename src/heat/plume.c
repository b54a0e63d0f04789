// Hot gas that rises from what burns, as quasi-steady columns: nothing is carried from step to step.
//
// Space is cut into cells of side b along the frame (two level axes, up). With z the height in cells:
//
//   W(x, y, z + 1) = e^(-b/H) blur[W + P](x, y, z)         power that enters a cell from below, W
//   P = sum of C eta burn_rate share / pace                power set free in the cell, W
//
// H m: plume_height. `blur` mixes 1/12 of a cell with each of its four neighbours: entrained air widens the column.
// At height f b within the cell the column carries Q = W + f P. Gas of excess temperature dT over Ta, as wide
// as the cell and rising at w = Fr sqrt(g H dT/Ta), carries Q = rho cp w dT b^2 (weak plume: rho as at Ta), hence
//
//   dT = min(1200 K, (Q/(Fr rho cp b^2 sqrt(g H/Ta)))^(2/3)),  rho = 353/Ta kg/m3, cp = 1005 J/(kg K), Fr = 0.5
//
// (the two-thirds power of Morton, Taylor & Turner 1956). A particle colder than the gas gets
// plume_conductance towards Ta + dT. Power is shared among the four columns next to a particle, and read back in the same way.
#include <math.h>
#include <string.h>

#include "heat/plan.h"

static const float PLUME_CELL = 0.012f;     // m
static const float PLUME_MIX = 1.0f / 12;   // with each neighbour, per level
static const float PLUME_HOTTEST = 1200;    // K over ambient
static const float PLUME_FROUDE = 0.5f;

void heat_plume_frame(PlumeGrid *grid, const float up[3]) {
    Vec z = vec_unit(vec_load(up));
    if (!(vec_dot(z, z) > 0.5f)) z = vec(0, 0, 1);
    Vec side = fabsf(z.x) < 0.6f ? vec(1, 0, 0) : vec(0, 1, 0);
    grid->axis[2] = z;
    grid->axis[0] = vec_unit(vec_sub(side, vec_scale(z, vec_dot(side, z))));
    grid->axis[1] = vec_cross(z, grid->axis[0]);
}

/// Lays the grid over what is alive, on whole multiples of the cell so that it does not slide about; larger cells when
/// it would not fit. False when there is nothing to lay it over.
static bool plume_fit(PlumeGrid *grid, const HeatPass *pass) {
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < pass->plan->particles; i++) {
        if (!pass->plan->alive[i]) continue;
        Vec x = vec_load(pass->state->dynamics.position[i]);
        for (int a = 0; a < 3; a++) {
            float s = vec_dot(x, grid->axis[a]);
            low[a] = s < low[a] ? s : low[a];
            high[a] = s > high[a] ? s : high[a];
        }
    }
    for (int a = 0; a < 3; a++)
        if (!(high[a] >= low[a] && high[a] - low[a] < 1e6f && fabsf(low[a]) < 1e6f)) return false;
    for (double cell = PLUME_CELL;; cell *= 1.25) {
        double cells = 1;
        for (int a = 0; a < 3; a++) {
            double first = floor(low[a] / cell) - 1, count = floor(high[a] / cell) + 2 - first;
            grid->origin[a] = first * cell;
            grid->size[a] = count < PLUME_CELLS ? (int)count : PLUME_CELLS;
            cells *= count;
        }
        grid->cell = (float)cell;
        if (cells <= PLUME_CELLS) return true;
    }
}

/// Where a point lies: the lower of its columns each way, the weights of the upper ones, its level and height within.
typedef struct PlumePlace {
    int column[3];
    float part[3];
} PlumePlace;

static PlumePlace plume_place(const PlumeGrid *grid, const float *position) {
    PlumePlace place;
    Vec x = vec_load(position);
    for (int a = 0; a < 3; a++) {
        float s = (float)((vec_dot(x, grid->axis[a]) - grid->origin[a]) / grid->cell) - (a < 2 ? 0.5f : 0);
        float last = (float)(grid->size[a] - (a < 2 ? 2 : 1));
        s = s > 0 ? s : 0; // and what is not a number
        place.column[a] = (int)(s < last ? s : last);
        float part = s - (float)place.column[a];
        place.part[a] = part < 1 ? part : 1;
    }
    return place;
}

/// Index of corner k (0 to 3) of a place, and its weight.
static inline size_t plume_corner(const PlumeGrid *grid, const PlumePlace *place, int k, float *weight) {
    int right = k & 1, back = k >> 1;
    *weight = (right ? place->part[0] : 1 - place->part[0]) * (back ? place->part[1] : 1 - place->part[1]);
    size_t x = (size_t)(place->column[0] + right), y = (size_t)(place->column[1] + back), z = (size_t)place->column[2];
    return x + (size_t)grid->size[0] * (y + (size_t)grid->size[1] * z);
}

/// Sets each particle's power free, in order of particle.
static void plume_deposit(PlumeGrid *grid, const HeatPass *pass, float share) {
    const Matter *matter = &pass->shell->matter;
    const float *burn_rate = pass->state->burn.burn_rate;
    for (uint32_t i = 0; i < pass->plan->particles; i++) {
        if (!(burn_rate[i] > 0) || !pass->plan->alive[i]) continue;
        float heat = matter->capacity[i] * field_at(matter->heating, i);
        float power = heat * burn_rate[i] * share / pass->plan->settings.pace;
        float weight;
        PlumePlace place = plume_place(grid, pass->state->dynamics.position[i]);
        for (int k = 0; k < 4; k++) {
            size_t cell = plume_corner(grid, &place, k, &weight);
            grid->power[cell] += weight * power;
        }
    }
}

/// From each level to the next. What is mixed out over the border of the grid is lost.
static void plume_sweep(PlumeGrid *grid, float height) {
    int nx = grid->size[0], ny = grid->size[1];
    float keep = expf(-grid->cell / height), mix = keep * PLUME_MIX, stay = keep * (1 - 4 * PLUME_MIX);
    for (int z = 0; z + 1 < grid->size[2]; z++)
        for (int y = 0; y < ny; y++)
            for (int x = 0; x < nx; x++) {
                size_t cell = (size_t)x + (size_t)nx * ((size_t)y + (size_t)ny * (size_t)z);
                float rising = grid->rising[cell] + grid->power[cell];
                if (rising == 0) continue;
                float *above = grid->rising + cell + (size_t)nx * (size_t)ny;
                above[0] += stay * rising;
                if (x > 0) above[-1] += mix * rising;
                if (x + 1 < nx) above[1] += mix * rising;
                if (y > 0) above[-nx] += mix * rising;
                if (y + 1 < ny) above[nx] += mix * rising;
            }
}

typedef struct PlumeJob {
    HeatPass *pass;
    float conductance;
    float scale; ///< 1/(Fr rho cp b^2 sqrt(g H/Ta)), K^1.5/W
} PlumeJob;

static void plume_heat(void *context, int begin, int end) {
    const PlumeJob *job = context;
    HeatPlan *plan = job->pass->plan;
    const PlumeGrid *grid = &plan->plume;
    float ambient = plan->settings.ambient_temperature, weight;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        if (!plan->alive[i]) continue;
        PlumePlace place = plume_place(grid, job->pass->state->dynamics.position[i]);
        float carried = 0;
        for (int k = 0; k < 4; k++) {
            size_t cell = plume_corner(grid, &place, k, &weight);
            carried += weight * (grid->rising[cell] + place.part[2] * grid->power[cell]);
        }
        if (!(carried > 0)) continue;
        float root = cbrtf(carried * job->scale), excess = root * root;
        if (excess < 0.1f) continue;
        excess = excess < PLUME_HOTTEST ? excess : PLUME_HOTTEST;
        // what is hotter than the gas loses no heat to it beyond the losses to still air
        if (ambient + excess <= job->pass->state->heat.temperature[i]) continue;
        plan->source_conductance[i] += job->conductance;
        plan->source_temperature[i] += job->conductance * (ambient + excess);
    }
}

void heat_plume(HeatPass *pass, const SingeSourceDef *def) {
    HeatPlan *plan = pass->plan;
    PlumeGrid *grid = &plan->plume;
    bool burns = false;
    for (uint32_t i = 0; i < plan->particles && !burns; i++)
        burns = plan->alive[i] && pass->state->burn.burn_rate[i] > 0;
    if (!burns || !(def->plume_share > 0) || !plume_fit(grid, pass)) return;
    size_t cells = (size_t)grid->size[0] * (size_t)grid->size[1] * (size_t)grid->size[2];
    memset(grid->power, 0, cells * sizeof *grid->power);
    memset(grid->rising, 0, cells * sizeof *grid->rising);
    plume_deposit(grid, pass, def->plume_share);
    plume_sweep(grid, def->plume_height);
    float ambient = plan->settings.ambient_temperature, density = 353 / ambient;
    float carry = PLUME_FROUDE * density * 1005 * grid->cell * grid->cell * sqrtf(9.81f * def->plume_height / ambient);
    PlumeJob job = {pass, def->plume_conductance, 1 / carry};
    pool_for(pass->pool, (int)plan->particles, POOL_BLOCK, plume_heat, &job);
}
