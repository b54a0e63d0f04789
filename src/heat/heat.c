// Eq 1, with losses in addition:
//
//   T*  = T + r h + dt (q + g (Ts - T*))/C''
//   T** : dT/dt = -[h_c (T - Ta) + eps sigma (T^4 - Ta^4)]/(C'' max(m, floor) F F_c)
//
// T      K         temperature; Ta ambient, Ts of a source
// r      K/s       heating by burning in the last step: eta (-dm) of eq 4 (burn/lose_mass.c), and char (burn/glow.c)
// q, g   W/m2, W/(m2 K)  flux and conductance of the sources
// C''    J/(m2 K)  capacity per area of a layer, unburnt
// h_c    W/(m2 K)  convection; eps emissivity; sigma Stefan and Boltzmann's constant. Each layer owns one side
// m      mass fraction; F front thickening (thicken.c), F_c that of glowing char (burn/glow.c)
// h, dt  s         scene time; fire time dt = h pace
//
// Sources are implicit, T* = (T1 + dt (q + g Ts)/C'')/(1 + dt g/C''), so T* never passes Ts; with the flux at the end
// of the step, f = (q + g Ts - g T1)/(1 + dt g/C''), it is T* = T1 + dt f/C''. A negative flux does not cool T* below
// 1 K. Losses are implicit, too, with T^4 - Ta^4 = (T + Ta)(T^2 + Ta^2)(T - Ta) and the first two factors at T*:
//   T** = (T* + y Ta)/(1 + y),  y = dt K (1 + dt K/2): 1/(1 + y) is exp(-dt K) to second order,
//   K = [h_c/C'' + eps sigma/C'' (T* + Ta)(T*^2 + Ta^2)]/max(m, floor)/(F F_c).
//
// Water boils at T_b = 373 K, where T** is above it: by at most C (T** - T_b)/L kg, and T falls by L/C of them, with
//
//   L = 2.257 MJ/kg + 4186 J/(kg K) (T_b - Ta)    from water at Ta to steam at T_b
//
// so that nothing wet gets hotter, but for what is conducted in the step. Water has no other effect on heat.
//
// Ledger: heat in = A dt f, heat lost = C y (T** - Ta), heat of combustion = C r h, with the particle's unburnt
// capacity C, as in the stored enthalpy C (T - Ta).
#include <math.h>

#include "common/float4.h"
#include "common/real.h"
#include "heat/heat_plan.h"

static const float STEFAN_BOLTZMANN = 5.670374e-8f; // W/(m2 K4)
static const float HEAT_COLDEST = 1;                // K, a negative flux does not cool below it
static const float HEAT_RATE_MAX = 1e30f;           // everything is lost in a step
static const float BOILING = 373.15f;               // K
static const float STEAM = 2.257e6f, WATER = 4186;  // J/kg, J/(kg K)

void heat_blocks(HeatPass *pass, SingeTaskFn *run) { pool_for(pass->pool, pass->plan->blocks, 1, run, pass); }

double heat_sum(const HeatPlan *plan, int column) {
    double sum = 0;
    for (int block = 0; block < plan->blocks; block++) sum += plan->partial[block][column];
    return sum;
}

/// Four particles; in lanes without one the last is repeated.
typedef struct HeatFour {
    uint32_t first, at[4];
    Float4Mask acts; ///< those that are there and have or get other than the ambient temperature
    Float4 fuel, area, capacity, ambient;
    Float4 T, warmth;              ///< before the step; dt/C''
    Float4 combustion, flux, loss; ///< K, W/m2, K
    Float4 T2;                     ///< T* of eq 1
    Float4 star, delta;            ///< T**, and what is above T
} HeatFour;

static inline Float4 heat_load(const float *x, const HeatFour *four) { return float4_load(x + four->first); }

/// Which of the particles [first, end), at most four, eq 1 may change.
static inline void heat_begin(const HeatPass *pass, uint32_t first, uint32_t end, HeatFour *four) {
    const HeatPlan *plan = pass->plan;
    const Matter *matter = &pass->shell->matter;
    four->first = first;
    for (uint32_t k = 0; k < 4; k++) four->at[k] = first + k < end ? first + k : end - 1;
    const uint8_t *alive = plan->alive;
    const Float4Mask there = {alive[four->at[0]], alive[four->at[1]], alive[four->at[2]], alive[four->at[3]]};

    // arrays of plan and State end with room for four
    four->ambient = float4_all(plan->settings.ambient_temperature);
    four->T = heat_load(pass->heat->temperature, four);
    const Float4Mask heats = (four->T != four->ambient) | (heat_load(pass->state->burn->burn_rate, four) != 0) |
                             (heat_load(plan->flux, four) != 0) | (heat_load(plan->source_conductance, four) != 0) |
                             (heat_load(plan->source_temperature, four) != 0);
    four->acts = heats & (there != 0) & ((Float4Mask){0, 1, 2, 3} < (int32_t)(end - first));
    four->fuel = heat_load(pass->state->burn->fuel, four);
    four->area = float4_gather(matter->area, four->at);
    four->capacity = float4_gather(matter->capacity, four->at);
    four->warmth = float4_all(pass->dt) * four->area / four->capacity;
}

/// Combustion and sources, which are implicit in their conductance.
static inline void heat_gain(const HeatPass *pass, HeatFour *four) {
    const HeatPlan *plan = pass->plan;
    const Float4 zero = {0}, one = float4_all(1), coldest = float4_all(HEAT_COLDEST);
    const Float4 out = plan->puts_out ? heat_load(plan->put_out, four) : zero;
    const Float4 made = heat_load(pass->state->burn->release, four) * float4_all(pass->h);
    const Float4Mask puts_out = (out > 0) & ((four->fuel > 0) | (out == HEAT_SMOTHERED));
    four->combustion = float4_select(puts_out, made * float4_select(out < 1, one - out, zero), made);

    const Float4 T1 = four->T + four->combustion, g = heat_load(plan->source_conductance, four);
    const Float4 given = heat_load(plan->flux, four) + (heat_load(plan->source_temperature, four) - g * T1);
    const Float4 flux = given / (one + four->warmth * g), T2 = T1 + four->warmth * flux;
    const Float4Mask cold = (T2 < coldest) & (flux < 0) & (flux > -INFINITY); // limit the cooling
    four->T2 = float4_select(cold, float4_select(T1 < coldest, T1, coldest), T2);
    four->flux = float4_select(cold, (four->T2 - T1) / four->warmth, flux);
}

/// Factor by which char is slower: shell_glow_slowing.
static inline Float4 heat_slowing(const Matter *matter, const HeatFour *four) {
    const Float4 one = float4_all(1), squared = (one - four->fuel) * (one - four->fuel), fourth = squared * squared;
    const Float4Mask chars = field_four(matter->char_yield, four->at) > field_four(matter->mass_min, four->at);
    return float4_select(chars, one + float4_all(GLOW_SLOWEST - 1) * fourth * fourth, one);
}

/// Convection and radiation, implicit in their conductance.
static inline void heat_lose(const HeatPass *pass, HeatFour *four) {
    const Matter *matter = &pass->shell->matter;
    const uint32_t *at = four->at;
    const uint16_t *sheet = matter->sheet;
    const Float4 one = float4_all(1), T2 = four->T2, ambient = four->ambient, over = T2 - ambient;
    const Float4 thickening = float4_gather(
        pass->plan->thickening, (const uint32_t[4]){sheet[at[0]], sheet[at[1]], sheet[at[2]], sheet[at[3]]});
    const Float4 burnt = float4_max(heat_load(pass->state->burn->mass, four), field_four(matter->loss_mass_floor, at));
    const Float4 radiation = field_four(matter->emissivity, at) * float4_all(STEFAN_BOLTZMANN);
    const Float4 exchange =
        field_four(matter->convection, at) + radiation * (T2 + ambient) * (T2 * T2 + ambient * ambient);
    Float4 rate = four->warmth * exchange / burnt * (one / thickening) / heat_slowing(matter, four); // dt K
    rate *= one + float4_all(0.5f) * rate;                                                           // y
    four->loss = rate * over / (one + rate);
    four->star = T2 - four->loss;
    four->delta = four->combustion + four->warmth * four->flux - four->loss;

    // little remains of T - Ta, so the difference would have no digits
    const Float4Mask most = rate > 1;
    if (!float4_any(most & four->acts)) return;
    rate = float4_select(rate > HEAT_RATE_MAX, float4_all(HEAT_RATE_MAX), rate);
    const Float4 loss = rate * over / (one + rate); // the product may overflow, the loss does not
    const Float4Mask overflows = (loss == INFINITY) | (loss == -INFINITY);
    four->loss = float4_select(most, float4_select(overflows, over * (rate / (one + rate)), loss), four->loss);
    four->star = float4_select(most, ambient + over / (one + rate), four->star);
    four->delta = float4_select(most, four->star - four->T, four->delta);
}

/// Boils the water of particles above its boiling point; the steam takes the heat along.
static void heat_boil(const HeatPass *pass, HeatFour *four, double *lost) {
    const Matter *matter = &pass->shell->matter;
    const float latent = STEAM + WATER * float_max(BOILING - four->ambient[0], 0);
    float *water = pass->heat->water;
    for (int k = 0; k < 4; k++) {
        const uint32_t i = four->at[k];
        const float excess = four->star[k] - BOILING, boils = matter->mass[i] * latent;
        if (!four->acts[k] || !(water[i] > 0) || !(excess > 0)) continue;
        const float steam = float_min(water[i], excess * matter->capacity[i] / boils);
        const float cooling = steam * boils / matter->capacity[i];
        water[i] -= steam;
        four->star[k] -= cooling;
        four->delta[k] -= cooling;
        *lost += (double)cooling * (double)matter->capacity[i];
    }
}

/// Adds what the four have of a quantity to the ledger, particle after particle.
static inline void heat_note(double *ledger, const HeatFour *four, Float4 value, Float4 per, double factor) {
    value = float4_select(four->acts, value, (Float4){0});
    for (int k = 0; k < 4; k++) *ledger += (double)value[k] * (double)per[k] * factor;
}

/// Combustion, sources and losses of particles [first, end), at most four; adds to the block's ledger.
static void heat_exchange_four(const HeatPass *pass, uint32_t first, uint32_t end, double ledger[4]) {
    HeatFour four;
    heat_begin(pass, first, end, &four);
    four.star = four.T;
    four.delta = (Float4){0};
    if (float4_any(four.acts)) {
        heat_gain(pass, &four);
        heat_lose(pass, &four);
        if (pass->heat->water) heat_boil(pass, &four, &ledger[3]);
        heat_note(&ledger[0], &four, four.flux, four.area, (double)pass->dt);
        heat_note(&ledger[1], &four, four.loss, four.capacity, 1);
        heat_note(&ledger[2], &four, four.combustion, four.capacity, 1);
    }
    float4_store(pass->plan->star + first, float4_select(four.acts, four.star, four.T));
    float4_store(pass->plan->delta + first, float4_select(four.acts, four.delta, (Float4){0}));
}

/// Combustion, sources and losses of all particles, and the ledger of each block.
static void heat_exchange(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    const float *temperature = pass->heat->temperature, *burn_rate = pass->state->burn->burn_rate;
    const float *flux = plan->flux, *conductance = plan->source_conductance, *tends = plan->source_temperature;
    float ambient = plan->settings.ambient_temperature;

    for (int block = begin; block < end; block++) {
        double *ledger = plan->partial[block];
        ledger[0] = ledger[1] = ledger[2] = ledger[3] = 0;
        for (uint32_t g = heat_group_first(block); g < heat_group_end(plan, block); g++) {
            uint32_t first = g * HEAT_GROUP, last = heat_group_last(plan, g);

            // eq 1 changes nothing in a group at the ambient temperature that no source or fire heats
            int busy = 0, warm = 0;
            for (uint32_t i = first; i < last; i++)
                busy |= (temperature[i] != ambient) | (flux[i] != 0) | (conductance[i] != 0) | (tends[i] != 0) |
                        (burn_rate[i] != 0);
            for (uint32_t i = first; i < last && !busy; i++) {
                plan->star[i] = ambient;
                plan->delta[i] = 0;
            }

            // otherwise exchange heat; a group is warm if a live particle leaves that temperature
            for (uint32_t i = first; i < last && busy; i += 4) heat_exchange_four(pass, i, last, ledger);
            for (uint32_t i = first; busy && i < last; i++)
                warm |= plan->alive[i] & ((plan->star[i] != ambient) | (plan->delta[i] != 0));
            plan->rest.warm[g] = warm != 0;
        }
    }
}

/// Copies the new temperatures where they may have changed.
static void heat_take_over(void *context, int begin, int end) {
    const HeatPass *pass = context;
    const HeatPlan *plan = pass->plan;
    float *restrict temperature = pass->heat->temperature, *restrict peak = pass->heat->temperature_peak;
    const float *restrict next = plan->next;

    for (uint32_t g = heat_group_first(begin); g < heat_group_end(plan, end - 1); g++) {
        if (!plan->rest.awake[pass->turn][g]) continue;
        for (uint32_t i = g * HEAT_GROUP; i < heat_group_last(plan, g); i++) {
            temperature[i] = next[i];
            peak[i] = next[i] > peak[i] ? next[i] : peak[i];
        }
    }
}

SingeResult heat_step(HeatPlan *plan, const StepContext *context, HeatState *heat, HeatCounters *counters) {
    const Shell *shell = context->shell;
    const StateInput *state = &context->state;
    HeatPass pass = {.plan = plan,
                     .shell = shell,
                     .state = state,
                     .heat = heat,
                     .pool = context->pool,
                     .h = context->h,
                     .dt = context->h * plan->settings.pace,
                     .heard = context->heard,
                     .hearer = context->hearer};
    double made = 0;

    // the smallest theta that makes no new extremes, and at least that of second order (conduct.c)
    const float stiffness = pass.dt * plan->stiffness;
    pass.theta = stiffness > 2 ? 1 - 1 / stiffness : 0.5f;
    heat_plan_follow(plan, shell, state);
    heat_matrix_follow(plan, shell, state->ablate, pass.theta * pass.dt);

    // eq 1: sources, combustion, losses
    heat_gather(&pass, context->sources, context->colliders, context->view);
    heat_blocks(&pass, heat_exchange);
    double in = heat_sum(plan, 0), lost = heat_sum(plan, 1) + heat_sum(plan, 3), combustion = heat_sum(plan, 2);

    // eq 2 and 3: diffusion
    TRY(heat_conduct(&pass, counters, &made, context->error));
    TRY(pool_check_cancelled(context->pool, "heat", context->error));

    heat_blocks(&pass, heat_take_over);
    heat->heat_in += in + made + heat_arrive(&pass, context->sources);
    heat->heat_lost += lost;
    heat->heat_of_combustion += combustion;
    return SINGE_OK;
}
