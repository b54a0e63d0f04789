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

/// Combustion, sources and losses of particles [i, end) of one sheet; adds to the block's ledger.
static void heat_exchange_run(const HeatPass *pass, uint32_t i, uint32_t end, double ledger[4]) {
    HeatPlan *plan = pass->plan;
    const Matter *matter = &pass->shell->matter;
    uint32_t sheet = matter->sheet[i];
    const float *temperature = pass->heat->temperature, *mass = pass->state->burn->mass;
    const float *burn_rate = pass->state->burn->burn_rate, *release = pass->state->burn->release;
    const float *fuel = pass->state->burn->fuel;
    float *water = pass->heat->water;
    float ambient = plan->settings.ambient_temperature, dt = pass->dt, h = pass->h;
    float slower = 1 / plan->thickening[sheet];

    for (; i < end; i++) {
        float T = temperature[i];
        bool calm = T == ambient && burn_rate[i] == 0 && plan->flux[i] == 0 && plan->source_conductance[i] == 0 &&
                    plan->source_temperature[i] == 0;
        if (calm || !plan->alive[i]) {
            plan->star[i] = T;
            plan->delta[i] = 0;
            continue;
        }

        // heat of combustion
        const float out = plan->puts_out ? plan->put_out[i] : 0;
        float combustion = release[i] * h;
        if (out > 0 && (fuel[i] > 0 || out == HEAT_SMOTHERED)) combustion *= out < 1 ? 1 - out : 0;
        float T1 = T + combustion;

        // sources, implicit in their conductance
        float warmth = dt * matter->area[i] / matter->capacity[i]; // dt/C''
        float g = plan->source_conductance[i];
        float flux = (plan->flux[i] + (plan->source_temperature[i] - g * T1)) / (1 + warmth * g);
        float T2 = T1 + warmth * flux;
        if (T2 < HEAT_COLDEST && flux < 0 && flux > -INFINITY) { // limit the cooling
            T2 = T1 < HEAT_COLDEST ? T1 : HEAT_COLDEST;
            flux = (T2 - T1) / warmth;
        }

        // convection and radiation, implicit in their conductance
        float floor_mass = field_at(matter->loss_mass_floor, i), burnt = mass[i] > floor_mass ? mass[i] : floor_mass;
        float radiation = field_at(matter->emissivity, i) * STEFAN_BOLTZMANN;
        float exchange = field_at(matter->convection, i) + radiation * (T2 + ambient) * (T2 * T2 + ambient * ambient);
        float rate = warmth * exchange / burnt * slower / shell_glow_slowing(matter, i, fuel[i]); // dt K
        rate *= 1 + 0.5f * rate;                                                                  // y
        float loss = rate * (T2 - ambient) / (1 + rate);
        plan->star[i] = T2 - loss;
        plan->delta[i] = combustion + warmth * flux - loss;
        if (rate > 1) { // little remains of T - Ta, so the difference would have no digits
            if (rate > HEAT_RATE_MAX) rate = HEAT_RATE_MAX;
            loss = rate * (T2 - ambient) / (1 + rate);
            if (isinf(loss)) loss = (T2 - ambient) * (rate / (1 + rate)); // the product overflows, the loss does not
            plan->star[i] = ambient + (T2 - ambient) / (1 + rate);
            plan->delta[i] = plan->star[i] - T;
        }

        // boiling; the steam takes the heat along
        const float excess = plan->star[i] - BOILING;
        if (water && water[i] > 0 && excess > 0) {
            const float latent = STEAM + WATER * float_max(BOILING - ambient, 0), boils = matter->mass[i] * latent;
            const float steam = float_min(water[i], excess * matter->capacity[i] / boils);
            const float cooling = steam * boils / matter->capacity[i];
            water[i] -= steam;
            plan->star[i] -= cooling;
            plan->delta[i] -= cooling;
            ledger[3] += (double)cooling * (double)matter->capacity[i];
        }

        // ledger
        ledger[0] += (double)flux * matter->area[i] * dt;
        ledger[1] += (double)loss * matter->capacity[i];
        ledger[2] += (double)combustion * matter->capacity[i];
    }
}

/// Combustion, sources and losses of all particles, and the ledger of each block.
static void heat_exchange(void *context, int begin, int end) {
    const HeatPass *pass = context;
    HeatPlan *plan = pass->plan;
    const uint16_t *sheet = pass->shell->matter.sheet;
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

            // otherwise exchange heat, sheet by sheet; a group is warm if a live particle leaves that temperature
            for (uint32_t i = first, run; i < last && busy; i = run) {
                for (run = i + 1; run < last && sheet[run] == sheet[i];) run++;
                heat_exchange_run(pass, i, run, ledger);
            }

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
