// Mass loss, eq 4 with an ash exponent:
//
//   dm/dt = -(mu/F) x^p min((T - T_ign)+, theta),   x = (m - m_min)/(1 - m_min)
//
//   m      mass as a fraction of the initial mass, 1 unburnt; x what of it can still burn, 1 to 0
//   m_min  fraction that never burns
//   mu     mass rate, 1/(K s)
//   F      front thickening, by which every rate is divided
//   T, T_ign  temperature and ignition temperature, K;  (.)+ is zero below zero
//   theta  ceiling, K: hotter fuel burns no faster, for the air brings no more oxygen; infinite in the paper
//   p      ash exponent; 0 is the paper's straight line, larger p leaves flakes of ash
//
// With a pre-exponential factor A > 0 the rate is Arrhenius' instead, for what is above T_ign:
//
//   dx/dt = -(A/F) x^p exp(-E/(R T_e)),   T_e = min(T, T_ign + theta),   E activation energy, J/mol
//
// Over one step T is held, and k = mu dt min((T - T_ign)+, theta)/(F (1 - m_min)), or A dt exp(-E/(R T_e))/F, is a
// number. dx/dt = -(k/dt) x^p is then solved exactly, so that no step however long passes m_min, and x falls by
//
//   p = 0     k, at most x
//   p = 1/2   (k/2) (2 sqrt(x) - k/2), and all of x once k/2 >= sqrt(x)
//   p = 1     x (1 - exp(-k))
//   p = 2     x / (1 + 1/(k x))
//   else      x (1 - (1 - r)^(1/(1 - p))),  r = (1 - p) k x^(p - 1), and all of x once r >= 1
#include "burn/burn_job.h"

#include <math.h>
#include <string.h>

static const float STRENGTH_MAX = 1e30f;

/// How much x falls in a step of strength k; x > 0, k > 0. NaN comes through.
static float fall(float x, float k, float p) {
    if (p == 0.0f) return k > x ? x : k;
    if (p == 1.0f) return -x * expm1f(-k);
    if (p == 2.0f) return x / (1 + 1 / (k * x));
    if (p == 0.5f) {
        float root = sqrtf(x), half = 0.5f * k;
        return half > root ? x : half * (2 * root - half);
    }
    float r = (1 - p) * k * powf(x, p - 1);
    return r >= 1 ? x : -x * expm1f(log1pf(-r) / (1 - p));
}

/// A exp(-E/(R T_e)), 1/s; NaN comes through.
static float arrhenius_rate(const Matter *matter, uint32_t i, float excess) {
    const float gas_constant = 8.314462618f; // J/(mol K)
    float temperature = field_at(matter->ignition_temperature, i) + excess;
    float exponent = field_at(matter->activation_energy, i) / (gas_constant * temperature);
    return field_at(matter->pre_exponential, i) * expf(-exponent);
}

/// One particle's new mass; NaN comes through.
static float lower_mass(const Matter *matter, uint32_t i, float mass, float excess, float dt) {
    float least = field_at(matter->mass_min, i), span = 1 - least;
    float x = (mass - least) / span, k = field_at(matter->mass_rate, i) * dt * excess / span;
    if (field_at(matter->pre_exponential, i) > 0) k = arrhenius_rate(matter, i, excess) * dt;
    if (x <= 0 || k <= 0) return mass;
    if (k > STRENGTH_MAX) k = STRENGTH_MAX; // all burns; infinite it would be NaN times an x^p that vanishes
    float lowered = mass - span * fall(x, k, field_at(matter->ash_exponent, i));
    return lowered < least ? least : lowered;
}

/// Adds the mass that particles [first, last) lose to *lost, kg.
static void lose_mass(BurnJob *job, uint32_t first, uint32_t last, double *lost) {
    const Matter *matter = &job->shell->matter;
    const float *temperature = job->state->heat.temperature;
    const uint8_t *flags = job->state->ablate.particle_flags;
    BurnState *burn = job->burn;
    for (uint32_t i = first; i < last; i++) {
        burn->burn_rate[i] = 0;
        float excess = temperature[i] - field_at(matter->ignition_temperature, i);
        if (excess <= 0 || !(flags[i] & SINGE_ALIVE)) continue;
        if (excess > field_at(matter->rate_ceiling, i)) excess = field_at(matter->rate_ceiling, i); // NaN stays NaN
        float before = burn->mass[i];
        float after = lower_mass(matter, i, before, excess, job->dt / job->thickening[matter->sheet[i]]);
        burn->mass[i] = after;
        burn->burn_rate[i] = (before - after) / job->h;
        if (after < field_at(matter->mass_loss, i) && burn->time_burnt[i] < 0) burn->time_burnt[i] = job->time;
        *lost += ((double)before - (double)after) * (double)matter->mass[i];
    }
}

static void lose_blocks(void *context, int begin, int end) {
    BurnJob *job = context;
    for (int block = begin; block < end; block++) {
        uint32_t first, last, run;
        double lost = 0;
        burn_block(job, block, &first, &last);
        for (; first < last; first = run) {
            run = burn_run_end(first, last);
            if (burn_is_hot(job, first, run))
                lose_mass(job, first, run, &lost);
            else
                memset(job->burn->burn_rate + first, 0, (run - first) * sizeof *job->burn->burn_rate);
        }
        job->partial[block] = lost;
    }
}

double burn_lose_mass(BurnJob *job, Pool *pool) {
    int blocks = pool_blocks((int)job->shell->particle_count);
    pool_for(pool, blocks, 1, lose_blocks, job);
    double lost = 0;
    for (int block = 0; block < blocks; block++) lost += job->partial[block];
    return lost;
}
