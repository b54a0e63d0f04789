// Mass loss, eq 4 with an ash exponent:
//
//   dm/dt = (1 - nu) df/dt = -(mu/F) f^p min((T - T_ign)+, theta),   m = nu + (1 - nu) f
//
//   m      mass as a fraction of the initial mass, 1 unburnt; f fuel: share that can still pyrolyse, 1 to 0
//   nu     mass that pyrolysis leaves: char, which then glows to m_min (glow.c), or m_min itself in the paper, where f
//          is (m - m_min)/(1 - m_min)
//   mu     mass rate, 1/(K s)
//   F      front thickening, by which every rate is divided
//   T, T_ign  temperature and ignition temperature, K;  (.)+ is zero below zero
//   theta  ceiling, K: hotter fuel burns no faster, as the air brings no more oxygen; infinite in the paper
//   p      ash exponent; 0 is the paper's straight line, larger p leaves flakes of ash
//
// With a pre-exponential factor A > 0 the rate above T_ign is Arrhenius' instead:
//
//   df/dt = -(A/F) f^p exp(-E/(R T_e)),   T_e = min(T, T_ign + theta),   E activation energy, J/mol
//
// Fuel heats itself. So T is taken in the middle of the step: half of the heat is added that the fuel gives at the T of
// the beginning (midpoint rule), as if air were not short and nothing smothered it. Then k is constant over the step,
//
//   k = mu dt min((T - T_ign)+, theta)/(F (1 - nu)), or A dt exp(-E/(R T_e))/F
//
// df/dt = -(k/dt) f^p is then solved exactly, so that no step overshoots 0, however long, and f falls by
//
//   p = 0     k, at most f
//   p = 1/2   (k/2) (2 sqrt(f) - k/2), and all of f once k/2 >= sqrt(f)
//   p = 1     f (1 - exp(-k))
//   p = 2     f / (1 + 1/(k f))
//   else      f (1 - (1 - r)^(1/(1 - p))),  r = (1 - p) k f^(p - 1), and all of f once r >= 1
//
// Pyrolysis heats the sheet by eta (1 - nu) df, eq 1.
#include "common/real.h"
#include "burn/burn_job.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

static const float STRENGTH_MAX = 1e30f;

/// The decrease of x in a step of strength k; x > 0, k > 0. NaN propagates.
static float fall(float x, float k, float p) {
    if (p == 0.0f) return k > x ? x : k;
    if (p == 1.0f) return -x * real_expm1f(-k);
    if (p == 2.0f) return x / (1 + 1 / (k * x));
    if (p == 0.5f) {
        float root = sqrtf(x), half = 0.5f * k;
        return half > root ? x : half * (2 * root - half);
    }

    float r = (1 - p) * k * real_powf(x, p - 1);
    return r >= 1 ? x : -x * real_expm1f(real_log1pf(-r) / (1 - p));
}

/// The fuel of a particle `excess` K above ignition that pyrolyses in a step where air is not limited; NaN propagates.
static float pyrolysis(const BurnJob *job, uint32_t i, float excess) {
    const Matter *matter = &job->shell->matter;
    const float ceiling = field_at(matter->rate_ceiling, i);
    if (excess > ceiling) excess = ceiling;
    const float dt = job->dt / job->thickening[matter->sheet[i]], fuel = job->burn->fuel[i];
    float k = field_at(matter->mass_rate, i) * dt * excess / (1 - field_at(matter->char_yield, i));
    if (field_at(matter->pre_exponential, i) > 0) {
        const float gas_constant = 8.314462618f; // J/(mol K)
        float temperature = field_at(matter->ignition_temperature, i) + excess;
        float exponent = field_at(matter->activation_energy, i) / (gas_constant * temperature);
        k = field_at(matter->pre_exponential, i) * real_expf(-exponent) * dt;
    }

    if (fuel <= 0 || k <= 0) return 0;
    if (k > STRENGTH_MAX) k = STRENGTH_MAX; // all burns; infinity times a vanishing f^p would be NaN
    return fall(fuel, k, field_at(matter->ash_exponent, i));
}

/// Both reactions of one particle, of whose fuel `gone` pyrolyses.
static void react(BurnJob *job, uint32_t i, float gone) {
    const Matter *matter = &job->shell->matter;
    BurnState *burn = job->burn;
    float dt = job->dt / job->thickening[matter->sheet[i]], floor_mass = field_at(matter->loss_mass_floor, i);
    float min = field_at(matter->mass_min, i), yield = field_at(matter->char_yield, i), span = yield - min;
    float before = burn->mass[i], fuel = burn->fuel[i], left = fuel;
    if (!(gone <= 0)) left = fuel - gone < 0 ? 0 : fuel - gone; // NaN propagates

    // the char that it makes, and what is left of it after glowing
    float fresh = shell_char(before, fuel, min, yield) + (span > 0 ? fuel - left : 0);
    float share = span > 0 ? burn_glow(job, i, left, fresh, fuel < 1 ? burn->release[i] : 0, dt) : 0;

    // mass, and the heat of both
    float after = min + (1 - min) * left + span * share;
    if (after >= before) left = fuel; // too little for the mass's last digit: springs follow only what loses mass
    burn->fuel[i] = left;
    burn->mass[i] = after < before || isnan(after) ? after : before;
    burn->burn_rate[i] = (before - burn->mass[i]) / job->h;

    float glow = fresh > share ? burn_glow_heat(job, i) * span * (fresh - share) / float_max(before, floor_mass) : 0;
    burn->release[i] = (field_at(matter->heating, i) * (1 - yield) * (fuel - left) + glow) / job->h;
}

/// The fuel that pyrolyses by eq 4, in burn_rate until lose_mass; 0 where nothing is hot. What a block has of it is its
/// partial.
static void wish(void *context, int begin, int end) {
    BurnJob *job = context;
    const Matter *matter = &job->shell->matter;
    const float *temperature = job->state->heat->temperature;
    const uint8_t *flags = job->state->ablate->particle_flags;
    float *wish = job->burn->burn_rate;

    for (int block = begin; block < end; block++) {
        uint32_t first, last, run;
        double sum = 0;

        burn_block(job, block, &first, &last);
        for (; first < last; first = run) {
            run = burn_run_end(first, last);
            memset(wish + first, 0, (run - first) * sizeof *wish);
            if (!burn_is_hot(job, first, run)) continue;

            for (uint32_t i = first; i < run; i++) {
                float excess = temperature[i] - field_at(matter->ignition_temperature, i);
                if (excess <= 0 || !(flags[i] & SINGE_ALIVE)) continue;
                const float heats = 0.5f * field_at(matter->heating, i) * (1 - field_at(matter->char_yield, i));
                wish[i] = pyrolysis(job, i, excess + heats * pyrolysis(job, i, excess)); // NaN stays NaN
                sum += (double)wish[i];
            }
        }

        job->partial[block] = sum;
    }
}

/// The positions of particles i to i + 3; those from `last` on are that of i.
static const float (*four_positions(const float (*x)[4], uint32_t i, uint32_t last, float room[4][4]))[4] {
    if (i + 4 <= last) return x + i;
    for (uint32_t k = 0; k < 4; k++) memcpy(room[k], x[i + k < last ? i + k : i], sizeof room[k]);
    return (const float(*)[4])room;
}

/// Reduces what the particles [first, last) would burn to what their air suffices for.
static void share_air(BurnJob *job, BurnAirNear *near, uint32_t first, uint32_t last) {
    const float(*x)[4] = (const float(*)[4])job->state->dynamics->position;
    float *gone = job->burn->burn_rate, room[4][4];
    for (uint32_t i = first; i < last; i += 4) {
        uint32_t count = last - i < 4 ? last - i : 4, asks = 0;
        for (uint32_t k = 0; k < count; k++)
            if (gone[i + k] > 0 && field_at(job->shell->matter.air_supply, i + k) < INFINITY) asks |= 1u << k;
        if (!asks) continue;
        const Float4 share = burn_air_share(job->air, near, four_positions(x, i, last, room));
        for (uint32_t k = 0; k < count; k++)
            if (asks >> k & 1) gone[i + k] *= share[k];
    }
}

/// Marks the cells of a particle that loses mass. Several threads may mark one.
static void mark_cells(const Shell *shell, BurnState *burn, uint32_t i) {
    if (!shell_is_corner(shell, i))
        atomic_store_explicit(&burn->burns[i - shell->vertex_count], 1, memory_order_relaxed);
    else
        for (uint32_t f = shell->fan_first[i]; f < shell->fan_first[i + 1]; f++)
            atomic_store_explicit(&burn->burns[shell->fan[f]], 1, memory_order_relaxed);
}

/// Lets the particles of blocks react; the mass that they lose, kg, is the block's partial.
static void lose_mass(void *context, int begin, int end) {
    BurnJob *job = context;
    const Matter *matter = &job->shell->matter;
    const float *temperature = job->state->heat->temperature;
    const uint8_t *flags = job->state->ablate->particle_flags;
    BurnState *burn = job->burn;

    for (int block = begin; block < end; block++) {
        uint32_t first, last, run;
        double lost = 0;
        BurnAirNear near = {0};

        burn_block(job, block, &first, &last);
        for (; first < last; first = run) {
            run = burn_run_end(first, last);
            if (!burn_is_hot(job, first, run)) {
                memset(burn->release + first, 0, (run - first) * sizeof *burn->release);
                continue;
            }

            if (job->shares) share_air(job, &near, first, run);
            for (uint32_t i = first; i < run; i++) {
                float before = burn->mass[i];
                if (temperature[i] <= field_at(matter->ignition_temperature, i) || !(flags[i] & SINGE_ALIVE)) {
                    burn->release[i] = 0;
                    continue;
                }

                react(job, i, burn->burn_rate[i]);
                float after = burn->mass[i];
                if (after < field_at(matter->mass_loss, i) && burn->time_burnt[i] < 0) burn->time_burnt[i] = job->time;
                lost += ((double)before - (double)after) * (double)matter->mass[i];
                if (burn->burn_rate[i] > 0) mark_cells(job->shell, burn, i);
            }

            for (uint32_t i = first; i < run; i += 4) // arrays of the State end with room for four
                if (float4_any(float4_load(burn->burn_rate + i) > 0)) burn_follow(matter, burn, i, run);
        }

        job->partial[block] = lost;
    }
}

double burn_lose_mass(BurnJob *job, Pool *pool) {
    const Matter *matter = &job->shell->matter;
    const float(*x)[4] = (const float(*)[4])job->state->dynamics->position, *wishes = job->burn->burn_rate;
    int blocks = pool_blocks((int)job->shell->particle_count);
    pool_for(pool, blocks, 1, wish, job);

    // what would burn goes into the grid of air, particle after particle
    BurnAirNear near = {0};
    bool any = false;
    for (int block = 0; block < blocks && job->air; block++) {
        uint32_t first, last;
        burn_block(job, block, &first, &last);
        for (; first < last && !(job->partial[block] == 0); first += 4) {
            float room[4][4], demand[4] = {0};
            bool asks = false;
            for (uint32_t i = first; i < last && i < first + 4; i++) {
                const float supply = field_at(matter->air_supply, i);
                if (!(wishes[i] > 0 && supply < INFINITY)) continue;
                const float burns = (1 - field_at(matter->char_yield, i)) * matter->mass[i] * wishes[i];
                demand[i - first] = burns / (job->dt * supply);
                asks = true;
            }

            if (!asks) continue;
            if (!any) burn_air_clear(job->air);
            any = true;
            burn_air_add(job->air, &near, four_positions(x, first, last, room), demand);
        }
    }

    if (any) burn_air_flush(job->air, &near);
    job->shares = any && burn_air_is_short(job->air);

    double lost = 0;
    memset((uint8_t *)job->burn->burns, 0, job->shell->cell_count);
    pool_for(pool, blocks, 1, lose_mass, job);
    for (int block = 0; block < blocks; block++) lost += job->partial[block];
    return lost;
}
