// Values that stay the same during a step: masses, weights, normals, drag and wind.
//
// Weight of a spring (eq 19): the mean of its ends' material weights, times a factor that goes from 1 for fresh material
// to the ends' mean char_weight at m_min: char is soft.
//
// Drag of a sheet of area A on its normal velocity v_n: F = 1/2 rho C_d A v_n |v_n|; each layer takes half of it.
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"
#include "world/air.h"

#include <string.h>

/// Min mass of a particle that is left, as a share of the unburnt one: with a mass of 0 it would not move at all.
static const float PREPARE_MASS_MIN = 0.01f;

typedef struct Prepare {
    DynamicsPlan *plan;
    const Shell *shell;
    const StateInput *state;
    const SingeWindDef *wind;
    const SourceList *sources; ///< that move air; or NULL
    DynamicsState *dynamics;   ///< its positions get the inverse mass
    bool known;                ///< values of the last step still hold for particles that have lost no mass since
} Prepare;

/// Marks a spring, if it is in a strand, to be prepared again. Several threads may mark one.
static inline void prepare_mark(StrandSet *set, uint32_t spring) {
    if (spring < set->run_count * PREPARE_RUN)
        atomic_store_explicit(&set->seen[spring], PREPARE_STALE, memory_order_relaxed);
}

/// Normals of cells, 0 of those that are gone; springs at what lost mass get other weights and lengths.
static void prepare_cells(void *task, int begin, int end) {
    Prepare *job = task;
    const Shell *shell = job->shell;
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    const uint8_t *burns = (const uint8_t *)job->state->burn->burns; // nobody marks any more
    StrandSet *sets = job->plan->strands.sets;

    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        const uint32_t *corner = shell->cells[c];
        Float4 a = float4_load(x[corner[2]]) - float4_load(x[corner[0]]);
        Float4 b = float4_load(x[corner[3]]) - float4_load(x[corner[1]]);
        const bool alive = job->state->ablate->cell_flags[c] & SINGE_ALIVE;
        float4_store(job->plan->cell_normal[c], alive ? float4_cross(a, b) : float4_all(0));

        if (!burns[c] || !sets[SINGE_RED].seen) continue;
        const CellSprings *springs = &shell->cell_springs[c];
        for (int i = 0; i < 4; i++) {
            prepare_mark(&sets[SINGE_RED], springs->red[i]);
            prepare_mark(&sets[SINGE_BLUE], springs->blue[i]);
            prepare_mark(&sets[SINGE_GREEN], springs->green[i]);
        }
        for (int i = 0; i < 2; i++) prepare_mark(&sets[SINGE_YELLOW], springs->yellow[i]);
    }
}

/// Air at particles, and their damping.
static void prepare_air(const Prepare *job, uint32_t begin, uint32_t end) {
    DynamicsPlan *plan = job->plan;
    const StateInput *state = job->state;
    const Matter *matter = &job->shell->matter;
    const Float3 mean = float3_load(job->wind->velocity);
    const bool gusts = job->wind->gust > 0;

    for (uint32_t i = begin; i < end; i++) {
        if (!(state->ablate->particle_flags[i] & SINGE_ALIVE)) continue;
        const Float3 x = float3_load(job->dynamics->position[i]);
        Float3 wind = gusts ? wind_velocity(job->wind, x, state->time) : mean;
        if (job->sources) wind = float3_add(wind, air_velocity(job->sources, x, state->time));
        Float4 air = {wind.x, wind.y, wind.z, 0};
        if (state->gas->awake) air += float4_load(state->gas->air[i]);
        float4_store(plan->air[i], float4_with(air, field_at(matter->damping, i)));
    }
}

static void prepare_particles(void *task, int from, int to) {
    const Prepare local = *(const Prepare *)task, *job = &local; // of its own, so that stores cannot change it
    DynamicsPlan *plan = job->plan;
    const StateInput *state = job->state;
    const Shell *shell = job->shell;
    const Matter *matter = &shell->matter;
    const uint32_t begin = (uint32_t)from, end = (uint32_t)to, *fan = shell->fan, *fan_first = shell->fan_first;
    const float(*cell_normal)[4] = (const float(*)[4])plan->cell_normal, *burn_rate = state->burn->burn_rate;
    const uint8_t *flags = state->ablate->particle_flags, *pinned = job->dynamics->pinned;
    float(*normals)[4] = plan->normal, (*position)[4] = job->dynamics->position, *inverse_mass = plan->inverse_mass;
    const Float4Mask three = {-1, -1, -1, 0};
    bool held = false;

    // inverse mass; weight, which falls with char; drag. Most particles move freely and do not burn
    for (uint32_t i = begin; i < end; i++) {
        const bool alive = flags[i] & SINGE_ALIVE, free = alive && !pinned[i];
        if (!(free && job->known && inverse_mass[i] > 0 && burn_rate[i] == 0)) {
            const float drag = plan->settings.air_density * field_at(matter->drag, i), left = state->burn->mass[i];
            const float mass = matter->mass[i] * (left > PREPARE_MASS_MIN ? left : PREPARE_MASS_MIN);
            inverse_mass[i] = free && mass > 0 ? 1 / mass : 0;
            const float progress = shell_burn_progress(left, field_at(matter->mass_min, i));
            plan->soft[i] = 1 + (field_at(matter->char_weight, i) - 1) * progress;
            normals[i][3] = drag == 0 ? 0 : 0.25f * drag * matter->area[i] / mass;
            held |= alive && inverse_mass[i] == 0;
        }
        position[i][3] = inverse_mass[i];
    }
    if (held) atomic_store_explicit(&plan->held, true, memory_order_relaxed);
    if (plan->air_mask) prepare_air(job, begin, end);

    // normals: sums, and then these in lanes, which would wait for what has just been stored
    for (uint32_t i = begin; i < end; i++) {
        Float4 normal = {0};
        if (i >= shell->vertex_count) normal = float4_load(cell_normal[i - shell->vertex_count]);
        else
            for (uint32_t k = fan_first[i]; k < fan_first[i + 1]; k++) normal += float4_load(cell_normal[fan[k]]);
        float4_store(normals[i], float4_select(three, normal, float4_load(normals[i])));
    }
    plan->kernels->unit(normals + begin, end - begin);
}

void dynamics_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, const SingeWindDef *wind,
                      const SourceList *sources, Pool *pool, DynamicsState *dynamics) {
    const bool known = plan->written && plan->patches.split_count == shell->split_count;
    Prepare job = {plan, shell, state, wind, air_of(sources, state->time), dynamics, known};

    // still air, or an even wind
    const Field damping = shell->matter.damping, drag = shell->matter.drag;
    const bool even = !(wind->gust > 0) && !job.sources && !state->gas->awake && damping.mask == 0 && drag.mask == 0 &&
                      plan->settings.air_density * field_at(drag, 0) != 0;
    plan->air_mask = even ? 0 : UINT32_MAX;
    for (int i = 0; even && i < 4; i++)
        float4_store(plan->air[i],
                     (Float4){wind->velocity[0], wind->velocity[1], wind->velocity[2], field_at(damping, 0)});

    memset(plan->height_wait, 0, height_wait_count(shell));
    plan->held = false;
    pool_for(pool, (int)shell->cell_count, POOL_GRAIN, prepare_cells, &job);
    pool_for(pool, (int)shell->particle_count, POOL_GRAIN, prepare_particles, &job);
    if (plan->solver->prepare) plan->solver->prepare(plan, shell, state, pool, dynamics);
    plan->written = false; // till the step is done: one that is undone has left what belongs to other masses
}
