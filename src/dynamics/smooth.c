// Internal friction: bending paper loses energy, and the error that a projection leaves shows as jitter of single
// particles and as drumming of the whole sheet. Once a step, along every strand of both layers, the second difference
// of velocities
//
//   r = v_a - 2 v_b + v_c      (three nodes at equal distances along a strand)
//
// is reduced by the share 1 - exp(-smoothing h) with the impulse that conserves linear momentum:
//
//   v_a -= w_a j,  v_b += 2 w_b j,  v_c -= w_c j,   j = share r / (w_a + 4 w_b + w_c)
//
// first over nodes `smoothing_length` apart, then over adjacent nodes. The first removes the drumming: what it takes
// from a wave falls with the fourth power of its length over smoothing_length, whatever the mesh. The second removes
// what the first cannot see. A rigid motion of a flat sheet has r = 0 and is unchanged. Where the nodes are not
// collinear or not equally far apart, r sees a rotation too: a curved sheet that spins loses angular momentum.
#include "common/real.h"
#include "common/float4.h"
#include "dynamics/dynamics_plan.h"

/// The two layers' strands.
static const SingeColour SMOOTH_LAYERS[] = {SINGE_BLUE, SINGE_GREEN};

typedef struct Smooth {
    const SpringSet *set;
    SmoothLanes lanes;
    SmoothGroup *group;    ///< for groups of lanes
    const uint32_t *reach; ///< [strands] of the plan
    const uint8_t *flags;  ///< of the springs
    float (*velocity)[4];
    const float (*position)[4];         ///< fourth: inverse mass
    uint32_t first_group, first_strand; ///< of a family
    float share;
} Smooth;

bool smooth_create(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    for (int layer = 0; layer < 2; layer++) {
        const SingeColour colour = SMOOTH_LAYERS[layer];
        const SpringSet *springs = &shell->springs[colour];
        StrandSet *set = &plan->strands.sets[colour];
        const Field weight = shell->matter.weight[colour], char_weight = shell->matter.char_weight;
        if (!NEW(memory, plan->reach[layer], springs->strand_count)) return false;

        // lanes know springs that are gone by their weights, and know no velocities of nodes that are not there
        bool weighs = true;
        for (uint32_t i = 0; i < shell->particle_count; i++)
            weighs &= field_at(weight, i) > 0 && field_at(char_weight, i) > 0;
        for (uint32_t g = 0; g < set->group_count; g++) {
            StrandGroup *group = &set->groups[g];
            const uint32_t *node = set->node + (size_t)group->row * STRAND_LANES;
            group->apart = group->ring || !weighs;
            group->reach = UINT32_MAX;
            for (uint32_t row = 0; row <= group->rows; row++)
                for (uint32_t lane = 0; lane < group->width; lane++)
                    group->apart |= node[row * STRAND_LANES + lane] >= 4 * shell->particle_count;
        }

        // springs in a smoothing_length, of every strand, and of groups whose strands agree
        for (uint32_t s = 0; s < springs->strand_count; s++) {
            const uint32_t first = springs->strand_first[s], last = springs->strand_first[s + 1];
            const float count = (float)(last - first);
            float length = 0;
            for (uint32_t k = first; k < last; k++) length += springs->rest[k];
            const float across = plan->settings.solver.smoothing_length * count / length;
            const uint32_t reach = across >= 2 ? (uint32_t)(across < count ? across + 0.5f : count) : 0;
            plan->reach[layer][s] = reach;
            if (set->group_count == 0) continue;
            StrandGroup *group = &set->groups[set->strand_group[s]];
            group->apart |= group->reach != UINT32_MAX && group->reach != reach;
            group->reach = reach;
        }
    }

    return true;
}

/// Velocities of three nodes, with the inverse masses w.
static inline void smooth_triple(const Smooth *job, float wa, float wb, float wc, Float4 *va, Float4 *vb, Float4 *vc) {
    const float weight = wa + 4 * wb + wc;
    if (weight <= 0) return;

    const Float4 j = (job->share / weight) * (*va - 2 * *vb + *vc);
    *va -= wa * j;
    *vb += 2 * wb * j;
    *vc -= wc * j;
}

/// All triples of a strand whose outer nodes are `reach` springs from the middle one, and no spring between is gone.
static void smooth_strand(const Smooth *job, uint32_t begin, uint32_t end, uint32_t reach) {
    const uint32_t(*ends)[2] = job->set->ends;
    uint32_t run = 0; // consecutive springs that are not gone
    for (uint32_t k = begin; k < end && reach > 1; k++) {
        if (!(job->flags[k] & SINGE_ALIVE)) run = 0;
        else run = run > 0 && ends[k][0] != ends[k - 1][1] ? 1 : run + 1; // a tear has separated them
        if (run < 2 * reach) continue;

        const uint32_t a = ends[k + 1 - 2 * reach][0], b = ends[k + 1 - reach][0], c = ends[k][1];
        Float4 va = float4_load(job->velocity[a]), vb = float4_load(job->velocity[b]);
        Float4 vc = float4_load(job->velocity[c]);
        smooth_triple(job, job->position[a][3], job->position[b][3], job->position[c][3], &va, &vb, &vc);
        float4_store(job->velocity[a], va);
        float4_store(job->velocity[b], vb);
        float4_store(job->velocity[c], vc);
    }

    // with a reach of 1, the last two nodes of a triple are the first two of the next, and stay in registers
    for (uint32_t k = begin; k < end && reach == 1;) {
        uint32_t a = ends[k][0], b = ends[k][1];
        if (!(job->flags[k++] & SINGE_ALIVE)) continue;

        Float4 va = float4_load(job->velocity[a]), vb = float4_load(job->velocity[b]);
        float wa = job->position[a][3], wb = job->position[b][3];
        for (; k < end && job->flags[k] & SINGE_ALIVE && ends[k][0] == b; k++) {
            const uint32_t c = ends[k][1];
            const float wc = job->position[c][3];
            Float4 vc = float4_load(job->velocity[c]);
            smooth_triple(job, wa, wb, wc, &va, &vb, &vc);
            float4_store(job->velocity[a], va);
            a = b;
            b = c;
            wa = wb;
            wb = wc;
            va = vb;
            vb = vc;
        }

        float4_store(job->velocity[a], va);
        float4_store(job->velocity[b], vb);
    }
}

static void smooth_groups(void *task, int begin, int end) {
    const Smooth *job = task;
    for (uint32_t g = job->first_group + (uint32_t)begin; g < job->first_group + (uint32_t)end; g++)
        if (!job->lanes.set->groups[g].apart) job->group(&job->lanes, g);
}

/// The strands of groups that are apart.
static void smooth_strands(void *task, int begin, int end) {
    const Smooth *job = task;
    const StrandSet *set = job->lanes.set;
    for (uint32_t s = job->first_strand + (uint32_t)begin; s < job->first_strand + (uint32_t)end; s++) {
        if (set->group_count > 0 && !set->groups[set->strand_group[s]].apart) continue;
        const uint32_t *first = &job->set->strand_first[s];
        smooth_strand(job, first[0], first[1], job->reach[s]);
        smooth_strand(job, first[0], first[1], 1);
    }
}

void dynamics_smooth(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool, float h,
                     DynamicsState *dynamics) {
    if (plan->settings.solver.smoothing <= 0) return;

    for (int layer = 0; layer < 2; layer++) {
        const SpringSet *set = &shell->springs[SMOOTH_LAYERS[layer]];
        const StrandSet *lanes = &plan->strands.sets[SMOOTH_LAYERS[layer]];
        const float share = 1 - real_expf(-plan->settings.solver.smoothing * h);
        Smooth job = {.set = set,
                      .lanes = {lanes, dynamics->position[0], dynamics->velocity[0], share},
                      .group = plan->kernels->smooth,
                      .reach = plan->reach[layer],
                      .flags = ablate->spring_flags[SMOOTH_LAYERS[layer]],
                      .velocity = dynamics->velocity,
                      .position = (const float(*)[4])dynamics->position,
                      .share = share};

        // families in turn, their groups and strands in parallel
        for (uint32_t f = 0; f < set->family_count; f++) {
            bool apart = lanes->group_count == 0;
            if (!apart) {
                job.first_group = lanes->family_first[f];
                const uint32_t groups = lanes->family_first[f + 1] - job.first_group;
                for (uint32_t g = 0; g < groups; g++) apart |= lanes->groups[job.first_group + g].apart;
                pool_for(pool, (int)groups, 1, smooth_groups, &job);
            }
            if (!apart) continue;

            job.first_strand = set->family_first[f];
            const uint32_t last = set->family_first[f + 1], strands = last - job.first_strand;
            const uint32_t springs = set->strand_first[last] - set->strand_first[job.first_strand];
            const int grain = 1 + (int)((uint64_t)2 * POOL_BLOCK * strands / (springs + 1));
            pool_for(pool, (int)strands, grain, smooth_strands, &job);
        }
    }
}
