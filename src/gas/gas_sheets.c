// Exchange between gas and sheets.
//
// The fuel that a particle lost since the gas's last step, dm = (1 - nu) df, gives the gas the fuel (char glows without
// a flame)
//
//   E = (1 - radiated) dm H_gas/pace
//
// half a cell off the sheet on the particle's own side (the upper one, where the sheet lies level), where H_gas J/kg is
// the heat of combustion that did not stay in the sheet (shell/matter.c). What leaves below a sheet that smothers gets no
// air and gives nothing: half a cell off the sheet may be above the other one. The fire runs `pace` times as fast as the gas
// moves, and its power is that of the real fire.
//
// A source of power P adds E = (1 - radiated) P dt at its centre: the gas of its own flame.
//
// In turn the gas heats the sheet, with the temperature upstream, so that heat arrives only by the flow and not because
// of the size of the cells:
//
//   g = g_0 B/(e^B - 1),   B = m'' cp/g_0,   T = T_gas(x + side cell/2 - reach u/(|u| + u_0))
//
// Gas that leaves the sheet pushes the hot gas away from it: m'' kg/(m2 s) of it lower the conductance by the classical
// factor for transpiration (Bird, Stewart & Lightfoot, Transport Phenomena, 22.8). Glowing char takes less by its front
// thickening F_c (burn/glow.c). The gas loses the heat that the sheet takes.
//
// The air that drags at a particle is the gas's own speed times the open share of the faces about it: the gas flows
// along an intact sheet, and only flakes and edges are in its path.
#include "common/real.h"
#include "gas/gas_plan.h"
#include "world/air.h"

static const float SHEET_REACH = 1.25f; ///< cells
static const float SHEET_LAYER = 7e-3f; ///< m, of the gas that flows along a sheet
static const float SHEET_STILL = 0.05f; ///< m/s, u_0
static const float SHEET_LEVEL = 0.5f;  ///< cosine between down and the normal of a side that faces down
static const float SHEET_MIN = 1;       ///< K, min excess over the ambient that has an effect
static const float SHEET_CP = 1005;     ///< J/(kg K)

static void sheets_cells(void *context, int begin, int end) {
    const GasPass *pass = context;
    const Shell *shell = pass->shell;
    const float(*x)[4] = (const float(*)[4])pass->state->dynamics->position;

    for (int c = begin; c < end; c++) {
        const uint32_t *corner = shell->cells[c];
        Float3 a = float3_sub(float3_load(x[corner[2]]), float3_load(x[corner[0]]));
        Float3 b = float3_sub(float3_load(x[corner[3]]), float3_load(x[corner[1]]));
        float3_store(pass->plan->normal[shell_centre(shell, (uint32_t)c)], float3_unit(float3_cross(a, b)));
    }
}

static void sheets_corners(void *context, int begin, int end) {
    const GasPass *pass = context;
    const Shell *shell = pass->shell;

    for (int v = begin; v < end; v++) {
        Float3 sum = {0, 0, 0};
        for (uint32_t k = shell->fan_first[v]; k < shell->fan_first[v + 1]; k++)
            if (pass->state->ablate->cell_flags[shell->fan[k]] & SINGE_ALIVE)
                sum = float3_add(sum, float3_load(pass->plan->normal[shell_centre(shell, shell->fan[k])]));
        float3_store(pass->plan->normal[v], float3_unit(sum));
    }
}

void gas_normals(GasPass *pass) {
    pool_for(pass->pool, (int)pass->shell->cell_count, POOL_GRAIN, sheets_cells, pass);
    pool_for(pass->pool, (int)pass->shell->vertex_count, POOL_GRAIN, sheets_corners, pass);
}

/// A particle's own side of the sheet.
static float sheets_side(const GasPass *pass, uint32_t i) { return shell_is_corner(pass->shell, i) ? -0.5f : 0.5f; }

/// The particle's position half a cell off the sheet, on that side or, if that is inside a collider, on the other.
/// False outside the grid.
static bool sheets_position(const GasPass *pass, uint32_t i, float side, Float3 *x) {
    const GasPlan *plan = pass->plan;
    Float3 at = float3_load(pass->state->dynamics->position[i]), normal = float3_load(plan->normal[i]);
    float position[3];

    for (int k = 0; k < 2; k++, side = -side) {
        *x = float3_mad(at, normal, side * plan->cell);
        if (!gas_position(plan, *x, position)) continue;
        int cell[3];
        for (int d = 0; d < 3; d++) {
            cell[d] = (int)(position[d] + 0.5f);
            if (cell[d] >= plan->grid.n[d]) cell[d] = plan->grid.n[d] - 1;
        }
        if (!plan->solid[gas_at(&plan->grid, cell[0], cell[1], cell[2])]) return true;
    }

    return false;
}

/// The power of a source's flame now, W. Only kinds with a path have one; of others it is never checked.
static float feed_power(const Source *source, double time) {
    return source->path.count > 0 && source_is_lit(source, time) ? source->def.power : 0;
}

bool gas_fed(const GasPass *pass) {
    const float *now = pass->state->burn->fuel, *before = pass->from->fuel;
    bool fed = false;
    for (uint32_t i = 0; i < pass->plan->particles && !fed; i++) fed = now[i] < before[i];
    for (uint32_t k = 0; pass->sources && k < pass->sources->count && !fed; k++)
        fed = feed_power(&pass->sources->items[k], pass->state->time) > 0;
    return fed;
}

/// Adds an amount to the eight cells about a position, by trilinear weights, where there is gas in them.
static void feed_point(const GasPlan *plan, float *field, const float position[3], float amount) {
    int at[3];
    float part[3], weight[8], sum = 0;
    size_t cell[8];
    for (int d = 0; d < 3; d++) {
        at[d] = (int)(position[d] + 1) - 1;
        part[d] = position[d] - (float)at[d];
    }

    for (int e = 0; e < 8; e++) {
        weight[e] = 1;
        bool inside = true;
        for (int d = 0; d < 3; d++) {
            int up = e >> d & 1, c = at[d] + up;
            weight[e] *= up ? part[d] : 1 - part[d];
            inside = inside && c >= 0 && c < plan->grid.n[d];
        }

        cell[e] = gas_at(&plan->grid, at[0] + (e & 1), at[1] + (e >> 1 & 1), at[2] + (e >> 2));
        if (!inside || plan->solid[cell[e]]) weight[e] = 0;
        sum += weight[e];
    }

    for (int e = 0; e < 8 && sum > 0; e++)
        if (weight[e] > 0) field[cell[e]] += amount * weight[e] / sum;
}

void gas_feed(GasPass *pass) {
    GasPlan *plan = pass->plan;
    const Matter *matter = &pass->shell->matter;
    const float *now = pass->state->burn->fuel, *before = pass->from->fuel;
    const bool smothers = smother_place(&plan->smother, pass->shell, pass->state, pass->pool);
    float volume = plan->cell * plan->cell * plan->cell;
    float scale = (1 - plan->settings.def.radiated) / (plan->settings.pace * volume);
    Float3 x, down = float3_unit(float3_load(plan->settings.gravity));

    for (uint32_t i = 0; i < plan->particles; i++) {
        float gone = (before[i] - now[i]) * (1 - field_at(matter->char_yield, i)), position[3];
        pass->to->fuel[i] = now[i];
        if (!(gone > 0) || (smothers && smother_covers(&plan->smother, pass->shell, pass->state, i))) continue;

        // gas leaves on the particle's own side; if that faces down it goes up through the burnt sheet
        float side = sheets_side(pass, i);
        if (2 * side * float3_dot(float3_load(plan->normal[i]), down) > SHEET_LEVEL) side = -side;
        if (!sheets_position(pass, i, side, &x) || !gas_position(plan, x, position)) continue;
        float amount = gone * matter->mass[i] * field_at(matter->gas_heat, i) * scale;

        feed_point(plan, pass->to->field[GAS_FUEL], position, amount);
    }

    // flames of sources
    for (uint32_t k = 0; pass->sources && k < pass->sources->count; k++) {
        const Source *source = &pass->sources->items[k];
        float power = feed_power(source, pass->state->time), position[3];
        if (!(power > 0) || !gas_position(plan, path_pose(&source->path, pass->state->time).position, position))
            continue;
        feed_point(plan, pass->to->field[GAS_FUEL], position,
                   power * pass->dt * (1 - plan->settings.def.radiated) / volume);
    }
}

/// The upstream position from which gas reaches a particle at x.
static Float3 sheets_upstream(const GasPass *pass, Float3 x) {
    const GasPlan *plan = pass->plan;
    float position[3], u[3];
    if (!gas_position(plan, x, position)) return x;
    for (int d = 0; d < 3; d++)
        u[d] = gas_sample(&plan->grid, pass->to->field[GAS_VELOCITY + d], position) + pass->wind[d];
    Float3 v = float3_load(u);
    return float3_mad(x, v, -SHEET_REACH * plan->cell / (float3_length(v) + SHEET_STILL));
}

static void sheets_meet(void *context, int begin, int end) {
    const GasPass *pass = context;
    const GasPlan *plan = pass->plan;
    const Matter *matter = &pass->shell->matter;
    float ambient = plan->settings.ambient_temperature, g0 = plan->settings.def.conductance, position[3];
    const SourceList *airs = air_of(pass->sources, pass->state->time);
    float thick = plan->cell / SHEET_LAYER, lightest = 1 - ambient / GAS_HOTTEST;

    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        float *air = pass->to->air[i];
        air[0] = air[1] = air[2] = air[3] = 0;
        pass->to->conductance[i] = 0;
        pass->to->temperature[i] = ambient;
        if (!(pass->state->ablate->particle_flags[i] & SINGE_ALIVE)) continue;
        Float3 x = float3_load(pass->state->dynamics->position[i]);
        if (!gas_position(plan, x, position)) continue;

        // the share of the air that can pass: nearly all at a flake, nothing where the sheet is intact
        float open = 0;
        for (int d = 0; d < 3; d++) {
            int at[3];
            for (int e = 0; e < 3; e++) at[e] = (int)(position[e] + (e == d ? 1 : 0.5f));
            float normal = plan->normal[i][d];
            open += normal * normal * plan->open[d][gas_at(&plan->grid, at[0], at[1], at[2])];
        }

        // the dynamics adds what sources move
        const Float3 moved = airs ? air_velocity(airs, x, pass->state->time) : (Float3){0, 0, 0};
        const float apart[3] = {moved.x, moved.y, moved.z};
        for (int d = 0; d < 3; d++)
            air[d] = open * (gas_sample(&plan->grid, pass->to->field[GAS_VELOCITY + d], position) - apart[d]);

        // temperature of the gas upstream, which flows along the sheet: if a cell is thicker than that layer, all of
        // its heat is in the layer
        if (!(g0 > 0) || !sheets_position(pass, i, sheets_side(pass, i), &x)) continue;
        if (!gas_position(plan, sheets_upstream(pass, x), position)) continue;
        float light = gas_sample(&plan->grid, pass->to->field[GAS_LIGHTNESS], position);
        float layer = thick > 1 ? light * thick : light, max = light > lightest ? light : lightest;
        float temperature = ambient / (1 - (layer < max ? layer : max));
        if (temperature < ambient + SHEET_MIN) continue;

        // conductance, less by B/(e^B - 1) with the mass that blows out of the sheet
        float gone = (pass->from->fuel[i] - pass->state->burn->fuel[i]) * (1 - field_at(matter->char_yield, i));
        float flux = gone * matter->mass[i] / (matter->area[i] * pass->fire); // m''
        float b = flux * SHEET_CP / g0, blown = b > 1e-3f ? b < 30 ? b / real_expm1f(b) : 0 : 1;
        float slower = shell_glow_slowing(matter, i, pass->state->burn->fuel[i]);
        pass->to->conductance[i] = g0 * blown / slower;
        pass->to->temperature[i] = temperature;
    }
}

void gas_meet(GasPass *pass) {
    const GasPlan *plan = pass->plan;
    const float *sheet = pass->state->heat->temperature, *gas = pass->to->temperature;
    float volume = plan->cell * plan->cell * plan->cell, scale = pass->dt / (GAS_HEAT * volume), position[3];
    Float3 x;

    pool_for(pass->pool, (int)plan->particles, POOL_GRAIN, sheets_meet, pass);

    // the gas loses the heat that it gives to the sheets in a step
    for (uint32_t i = 0; i < plan->particles; i++) {
        float excess = gas[i] - sheet[i], conductance = pass->to->conductance[i];
        if (!(conductance > 0) || !(excess > 0) || !sheets_position(pass, i, sheets_side(pass, i), &x)) continue;
        if (!gas_position(plan, sheets_upstream(pass, x), position)) continue;
        size_t c = gas_at(&plan->grid, (int)(position[0] + 0.5f), (int)(position[1] + 0.5f), (int)(position[2] + 0.5f));
        float *L = &pass->to->field[GAS_LIGHTNESS][c];
        float loss = conductance * excess * pass->shell->matter.area[i] * scale;
        loss = loss < *L ? loss : *L;
        *L -= loss;
        plan->expansion[c] -= loss;
    }
}
