// Values that stay the same during a step: masses, weights, normals, drag and wind.
//
// Weight of a spring (eq 19): the mean of its ends' material weights, times a factor that goes from 1
// for fresh material to the ends' mean char_weight at m_min: char is soft.
//
// Drag of a sheet of area A on its normal velocity v_n: F = 1/2 rho C_d A v_n |v_n|; each layer
// takes half of it.
#include "common/assertion.h"
#include "dynamics/dynamics_plan.h"

#include <string.h>

/// Min mass of a particle that is left, as a share of the unburnt one: with a mass of 0 it would not move at all.
static const float PREPARE_MASS_MIN = 0.01f;

typedef struct Prepare {
    DynamicsPlan *plan;
    const Shell *shell;
    const StateInput *state;
    const SingeWindDef *wind;
    DynamicsState *dynamics; ///< its positions get the inverse mass
    SingeColour colour;
} Prepare;

static void prepare_cells(void *task, int begin, int end) {
    Prepare *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end && (uint32_t)end <= job->shell->cell_count);
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    for (int c = begin; c < end; c++) {
        const uint32_t *corner = job->shell->cells[c];
        Float3 a = float3_sub(float3_load(x[corner[2]]), float3_load(x[corner[0]]));
        Float3 b = float3_sub(float3_load(x[corner[3]]), float3_load(x[corner[1]]));
        float3_store(job->plan->cell_normal[c], float3_cross(a, b));
    }
}

static Float3 prepare_normal(const DynamicsPlan *plan, const Shell *shell, const uint8_t *cell_flags,
                             uint32_t particle) {
    SINGE_ASSERT(particle < shell->particle_count);
    if (particle >= shell->vertex_count)
        return float3_unit(float3_load(plan->cell_normal[particle - shell->vertex_count]));
    Float3 sum = {0, 0, 0};
    for (uint32_t k = shell->fan_first[particle]; k < shell->fan_first[particle + 1]; k++) {
        uint32_t cell = shell->fan[k];
        if (cell_flags[cell] & SINGE_ALIVE) sum = float3_add(sum, float3_load(plan->cell_normal[cell]));
    }
    return float3_unit(sum);
}

static void prepare_particles(void *task, int begin, int end) {
    Prepare *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end && (uint32_t)end <= job->shell->particle_count);
    DynamicsPlan *plan = job->plan;
    const StateInput *state = job->state;
    const Matter *matter = &job->shell->matter;
    for (int i = begin; i < end; i++) {
        // inverse mass; weight, which falls with char
        bool alive = state->ablate->particle_flags[i] & SINGE_ALIVE;
        float left = state->burn->mass[i];
        float mass = matter->mass[i] * (left > PREPARE_MASS_MIN ? left : PREPARE_MASS_MIN);
        plan->inverse_mass[i] = alive && !job->dynamics->pinned[i] && mass > 0 ? 1 / mass : 0;
        job->dynamics->position[i][3] = plan->inverse_mass[i];
        float progress = shell_burn_progress(state->burn->mass[i], field_at(matter->mass_min, (uint32_t)i));
        plan->soft[i] = 1 + (field_at(matter->char_weight, (uint32_t)i) - 1) * progress;
        if (!alive) continue;

        // drag, and what it needs: normal and air
        float drag = plan->settings.air_density * field_at(matter->drag, (uint32_t)i);
        plan->drag[i] = 0.25f * drag * matter->area[i] / mass;
        if (drag == 0) continue;
        float3_store(plan->normal[i], prepare_normal(plan, job->shell, state->ablate->cell_flags, (uint32_t)i));
        Float3 air = wind_velocity(job->wind, float3_load(job->dynamics->position[i]), state->time);
        float3_store(plan->air[i], state->gas->awake ? float3_add(air, float3_load(state->gas->air[i])) : air);
    }
}

static void prepare_strands(void *task, int begin, int end) {
    Prepare *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    const SpringSet *springs = &job->shell->springs[job->colour];
    StrandSet *set = &job->plan->strands.sets[job->colour];
    const uint8_t *flags = job->state->ablate->spring_flags[job->colour];
    const float *target = job->state->burn->spring_length[job->colour];
    const Field material = job->shell->matter.weight[job->colour];
    const float *soft = job->plan->soft;
    const Hinge *hinges = job->colour == SINGE_GREEN ? job->plan->hinges : NULL;
    const float *crease = job->dynamics->crease, *bend = job->dynamics->bend;
    const bool torn = job->shell->split_count > 0;
    for (int s = begin; s < end; s++) {
        // weights and lengths into the lanes; a crease changes lengths of green springs
        size_t slot = set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, slot += STRAND_LANES) {
            uint32_t a = springs->ends[k][0], b = springs->ends[k][1];
            bool here = flags[k] & SINGE_ALIVE;
            if (torn) here = here && patch_is_in_strand(job->plan, job->shell, job->colour, k, slot);
            set->weight[slot] = here ? dynamics_weight(material, soft, a, b) : 0;
            set->length[slot] = target[k];
            if (!hinges || crease[k] == 0) continue;
            float stays = crease[k] * hinges[k].arc * crease_kept(job->shell, job->state, k);
            set->length[slot] *= crease_ratio(&hinges[k], stays, bend[k] * hinges[k].arc);
        }
        if (set->bend_limit) curvature_prepare(job->shell, job->state, job->colour, (uint32_t)s, set);
    }
}

void dynamics_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, const SingeWindDef *wind,
                      Pool *pool, DynamicsState *dynamics) {
    Prepare job = {plan, shell, state, wind, dynamics, SINGE_RED};
    memset(plan->height_wait, 0, height_wait_count(shell));
    pool_for(pool, (int)shell->cell_count, POOL_BLOCK, prepare_cells, &job);
    pool_for(pool, (int)shell->particle_count, POOL_BLOCK, prepare_particles, &job);
    bool torn = patch_follow(plan, shell);
    // nothing has burnt, so the values of an earlier step are still right
    bool same = plan->strands_written && state->burn->mass_burnt == 0 && !torn;
    plan->strands_written = false; // till the step is done: one that is undone may have written other weights
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        if (same && !(plan->creased && colour == SINGE_GREEN)) continue;
        job.colour = (SingeColour)colour;
        const SpringSet *springs = &shell->springs[colour];
        int grain = 1 + (int)((uint64_t)POOL_BLOCK * springs->strand_count / (springs->count + 1));
        pool_for(pool, (int)springs->strand_count, grain, prepare_strands, &job);
    }
    patch_prepare(plan, shell, state);
}
