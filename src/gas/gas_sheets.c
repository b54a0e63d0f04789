// Exchange between gas and sheets.
//
// The fuel that a particle lost since the gas's last step, dm = (1 - nu) df, gives the gas the fuel (char glows without
// a flame)
//
//   E = (1 - radiated) dm H_gas/pace
//
// half a cell off the sheet on the particle's own side (the upper one, where the sheet lies level), where H_gas J/kg is
// the heat of combustion that did not stay in the sheet (shell/matter.c). The fire runs `pace` times as fast as the gas
// moves, and its power is that of the real fire.
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
#include "common/assertion.h"
#include "common/real.h"
#include "gas/gas_plan.h"

static const float SHEET_REACH = 1.25f; ///< cells
static const float SHEET_LAYER = 7e-3f; ///< m, of the gas that flows along a sheet
static const float SHEET_STILL = 0.05f; ///< m/s, u_0
static const float SHEET_LEVEL = 0.5f;  ///< cosine between down and the normal of a side that faces down
static const float SHEET_MIN = 1;       ///< K, min excess over the ambient that has an effect
static const float SHEET_CP = 1005;     ///< J/(kg K)

static void sheets_cells(void *context, int begin, int end) {
    const GasPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end && (uint32_t)end <= pass->shell->cell_count);
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
    SINGE_ASSERT(begin >= 0 && begin <= end && (uint32_t)end <= pass->shell->vertex_count);
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
    pool_for(pass->pool, (int)pass->shell->cell_count, POOL_BLOCK, sheets_cells, pass);
    pool_for(pass->pool, (int)pass->shell->vertex_count, POOL_BLOCK, sheets_corners, pass);
}

/// A particle's own side of the sheet.
static float sheets_side(const GasPass *pass, uint32_t i) { return shell_is_corner(pass->shell, i) ? -0.5f : 0.5f; }

/// The side on which its gas leaves: its own, unless that faces down. Then the gas goes up through the burnt sheet.
static float sheets_vent(const GasPass *pass, uint32_t i) {
    float side = sheets_side(pass, i);
    Float3 down = float3_unit(float3_load(pass->plan->settings.gravity)), normal = float3_load(pass->plan->normal[i]);
    return 2 * side * float3_dot(normal, down) > SHEET_LEVEL ? -side : side;
}

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

/// Adds to a field, shared among the cells with gas whose centres are about x.
static void sheets_add(const GasPlan *plan, float *field, Float3 x, float amount) {
    float position[3];
    if (!gas_position(plan, x, position)) return;
    int at[3];
    float part[3], weight[8], sum = 0;
    size_t cell[8];
    for (int d = 0; d < 3; d++) at[d] = (int)(position[d] + 1) - 1, part[d] = position[d] - (float)at[d];

    // trilinear weights of the eight cells, if they are open
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

    // their shares of the amount
    for (int e = 0; e < 8 && sum > 0; e++)
        if (weight[e] > 0) field[cell[e]] += amount * weight[e] / sum;
}

bool gas_fed(const GasPass *pass) {
    const float *now = pass->state->burn->fuel, *before = pass->from->fuel;
    bool fed = false;
    for (uint32_t i = 0; i < pass->plan->particles && !fed; i++) fed = now[i] < before[i];
    return fed;
}

void gas_feed(GasPass *pass) {
    const GasPlan *plan = pass->plan;
    const Matter *matter = &pass->shell->matter;
    const float *now = pass->state->burn->fuel, *before = pass->from->fuel;
    float volume = plan->cell * plan->cell * plan->cell;
    float scale = (1 - plan->settings.def.radiated) / (plan->settings.pace * volume);
    Float3 x;
    for (uint32_t i = 0; i < plan->particles; i++) {
        float gone = (before[i] - now[i]) * (1 - field_at(matter->char_yield, i));
        pass->to->fuel[i] = now[i];
        if (gone > 0 && sheets_position(pass, i, sheets_vent(pass, i), &x))
            sheets_add(plan, pass->to->field[GAS_FUEL], x,
                       gone * matter->mass[i] * field_at(matter->gas_heat, i) * scale);
    }
}

/// B/(e^B - 1).
static float sheets_blown(float b) { return b > 1e-3f ? b < 30 ? b / real_expm1f(b) : 0 : 1; }

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

/// Share of the air that can pass at a particle: nearly all at a flake, nothing where the sheet is intact.
static float sheets_open(const GasPlan *plan, const float position[3], const float normal[3]) {
    float sum = 0;
    for (int d = 0; d < 3; d++) {
        int at[3];
        for (int e = 0; e < 3; e++) at[e] = (int)(position[e] + (e == d ? 1 : 0.5f));
        sum += normal[d] * normal[d] * plan->open[d][gas_at(&plan->grid, at[0], at[1], at[2])];
    }
    return sum;
}

/// L of the gas that flows along a sheet at a position: if a cell is thicker than that layer, all of its heat is in the
/// layer.
static float sheets_lightness(const GasPlan *plan, const float *L, const float position[3]) {
    float thick = plan->cell / SHEET_LAYER, max = 1 - plan->settings.ambient_temperature / GAS_HOTTEST;
    float light = gas_sample(&plan->grid, L, position), layer = thick > 1 ? light * thick : light;
    max = light > max ? light : max;
    return layer < max ? layer : max;
}

static void sheets_meet(void *context, int begin, int end) {
    const GasPass *pass = context;
    SINGE_ASSERT(begin >= 0 && begin <= end && (uint32_t)end <= pass->plan->particles);
    const GasPlan *plan = pass->plan;
    const Matter *matter = &pass->shell->matter;
    float ambient = plan->settings.ambient_temperature, g0 = plan->settings.def.conductance, position[3];
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        float *air = pass->to->air[i];
        air[0] = air[1] = air[2] = air[3] = 0;
        pass->to->conductance[i] = 0;
        pass->to->temperature[i] = ambient;
        if (!(pass->state->ablate->particle_flags[i] & SINGE_ALIVE)) continue;
        Float3 x = float3_load(pass->state->dynamics->position[i]);
        if (!gas_position(plan, x, position)) continue;

        // velocity of the air
        float open = sheets_open(plan, position, plan->normal[i]);
        for (int d = 0; d < 3; d++)
            air[d] = open * gas_sample(&plan->grid, pass->to->field[GAS_VELOCITY + d], position);

        // temperature of the gas upstream
        if (!(g0 > 0) || !sheets_position(pass, i, sheets_side(pass, i), &x)) continue;
        if (!gas_position(plan, sheets_upstream(pass, x), position)) continue;
        float temperature = ambient / (1 - sheets_lightness(plan, pass->to->field[GAS_LIGHTNESS], position));
        if (temperature < ambient + SHEET_MIN) continue;

        // conductance, less by the mass that blows out of the sheet
        float gone = (pass->from->fuel[i] - pass->state->burn->fuel[i]) * (1 - field_at(matter->char_yield, i));
        float flux = gone * matter->mass[i] / (matter->area[i] * pass->fire); // m''
        float slower = shell_glow_slowing(matter, i, pass->state->burn->fuel[i]);
        pass->to->conductance[i] = g0 * sheets_blown(flux * SHEET_CP / g0) / slower;
        pass->to->temperature[i] = temperature;
    }
}

/// Removes from the gas the heat that it gives to the sheets in a step.
static void sheets_cool(GasPass *pass) {
    const GasPlan *plan = pass->plan;
    const float *sheet = pass->state->heat->temperature;
    float volume = plan->cell * plan->cell * plan->cell, scale = pass->dt / (GAS_HEAT * volume), position[3];
    Float3 x;
    for (uint32_t i = 0; i < plan->particles; i++) {
        float excess = pass->to->temperature[i] - sheet[i];
        if (!(pass->to->conductance[i] > 0) || !(excess > 0) || !sheets_position(pass, i, sheets_side(pass, i), &x))
            continue;
        if (!gas_position(plan, sheets_upstream(pass, x), position)) continue;
        size_t c = gas_at(&plan->grid, (int)(position[0] + 0.5f), (int)(position[1] + 0.5f), (int)(position[2] + 0.5f));
        float *L = &pass->to->field[GAS_LIGHTNESS][c];
        float loss = pass->to->conductance[i] * excess * pass->shell->matter.area[i] * scale;
        loss = loss < *L ? loss : *L;
        *L -= loss;
        plan->expansion[c] -= loss;
    }
}

void gas_meet(GasPass *pass) {
    pool_for(pass->pool, (int)pass->plan->particles, POOL_BLOCK, sheets_meet, pass);
    sheets_cool(pass);
}
