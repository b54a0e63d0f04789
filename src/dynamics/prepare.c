// What stays the same during a step: masses, weights, normals, drag and wind.
//
// Weight of a spring (eq 19): the mean of its ends' material weights, times a factor that goes from 1
// for fresh material to the ends' mean char_weight at m_min: char is soft.
//
// Drag of a sheet of area A on its normal velocity v_n: F = 1/2 rho C_d A v_n |v_n|; each layer
// takes half of it.
#include "dynamics/plan.h"

/// What is left weighs at least this share of the unburnt particle: a mass of 0 would not move at all.
static const float PREPARE_MASS_MIN = 0.01f;

typedef struct Prepare {
    DynamicsPlan *plan;
    const Shell *shell;
    const State *state;
    const SingeWindDef *wind;
    SingeColour colour;
} Prepare;

static float prepare_progress(const Shell *shell, const State *state, uint32_t particle) {
    return shell_burn_progress(state->burn.mass[particle], shell->matter.mass_min[particle]);
}

static void prepare_cells(void *task, int begin, int end) {
    Prepare *job = task;
    const float(*x)[4] = (const float(*)[4])job->state->dynamics.position;
    for (int c = begin; c < end; c++) {
        const uint32_t *corner = job->shell->cells[c];
        Vec a = vec_sub(vec_load(x[corner[2]]), vec_load(x[corner[0]]));
        Vec b = vec_sub(vec_load(x[corner[3]]), vec_load(x[corner[1]]));
        vec_store(job->plan->cell_normal[c], vec_cross(a, b));
    }
}

static Vec prepare_normal(const DynamicsPlan *plan, const Shell *shell, const uint8_t *cell_flags, uint32_t particle) {
    if (particle >= shell->vertex_count) return vec_unit(vec_load(plan->cell_normal[particle - shell->vertex_count]));
    Vec sum = {0, 0, 0};
    for (uint32_t k = shell->fan_first[particle]; k < shell->fan_first[particle + 1]; k++) {
        uint32_t cell = shell->fan[k];
        if (cell_flags[cell] & SINGE_ALIVE) sum = vec_add(sum, vec_load(plan->cell_normal[cell]));
    }
    return vec_unit(sum);
}

static void prepare_particles(void *task, int begin, int end) {
    Prepare *job = task;
    DynamicsPlan *plan = job->plan;
    const State *state = job->state;
    const Matter *matter = &job->shell->matter;
    for (int i = begin; i < end; i++) {
        bool alive = state->ablate.particle_flags[i] & SINGE_ALIVE;
        float mass = matter->mass[i] * fmaxf(state->burn.mass[i], PREPARE_MASS_MIN);
        plan->inverse_mass[i] = alive && !state->dynamics.pinned[i] && mass > 0 ? 1 / mass : 0;
        if (!alive) continue;
        vec_store(plan->normal[i], prepare_normal(plan, job->shell, state->ablate.cell_flags, (uint32_t)i));
        plan->drag[i] = 0.25f * plan->settings.air_density * matter->drag[i] * matter->area[i] / mass;
        vec_store(plan->air[i], wind_velocity(job->wind, vec_load(state->dynamics.position[i]), state->time));
    }
}

static void prepare_springs(void *task, int begin, int end) {
    Prepare *job = task;
    const Shell *shell = job->shell;
    const SpringSet *set = &shell->springs[job->colour];
    const uint8_t *flags = job->state->ablate.spring_flags[job->colour];
    const float *material_weight = shell->matter.weight[job->colour], *char_weight = shell->matter.char_weight;
    for (int k = begin; k < end; k++) {
        uint32_t a = set->ends[k][0], b = set->ends[k][1];
        float soft = 0.5f * (char_weight[a] + char_weight[b]);
        float progress = 0.5f * (prepare_progress(shell, job->state, a) + prepare_progress(shell, job->state, b));
        float weight = 0.5f * (material_weight[a] + material_weight[b]) * (1 + (soft - 1) * progress);
        job->plan->weight[job->colour][k] = flags[k] & SINGE_ALIVE ? weight : 0;
    }
}

void dynamics_prepare(DynamicsPlan *plan, const Shell *shell, const State *state, const SingeWindDef *wind,
                      Pool *pool) {
    Prepare job = {plan, shell, state, wind, SINGE_RED};
    pool_for(pool, (int)shell->cell_count, POOL_BLOCK, prepare_cells, &job);
    pool_for(pool, (int)shell->particle_count, POOL_BLOCK, prepare_particles, &job);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        job.colour = (SingeColour)colour;
        pool_for(pool, (int)shell->springs[colour].count, POOL_BLOCK, prepare_springs, &job);
    }
}
