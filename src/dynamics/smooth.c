// Internal friction: paper is lossy, and what a projection leaves unsolved shows as jitter of single
// particles. Once a step, along every strand of both layers, the second difference of velocities
//
//   r = v_a - 2 v_b + v_c      (three nodes in a row)
//
// is lessened by the share `smoothing` with the impulse that keeps momentum:
//
//   v_a -= w_a j,  v_b += 2 w_b j,  v_c -= w_c j,   j = smoothing r / (w_a + 4 w_b + w_c)
//
// A rigid motion of a flat sheet has r = 0 and is not touched; the loss falls with the fourth power of the
// wavelength.
#include "dynamics/plan.h"

typedef struct Smooth {
    const DynamicsPlan *plan;
    const SpringSet *set;
    const float *weight;
    float (*velocity)[4];
    uint32_t first_strand;
} Smooth;

static void smooth_triple(const Smooth *job, uint32_t a, uint32_t b, uint32_t c) {
    const float *w = job->plan->inverse_mass;
    float weight = w[a] + 4 * w[b] + w[c];
    if (weight <= 0) return;
    float *va = job->velocity[a], *vb = job->velocity[b], *vc = job->velocity[c];
    float share = job->plan->settings.solver.smoothing / weight;
    for (int k = 0; k < 3; k++) {
        float j = share * (va[k] - 2 * vb[k] + vc[k]);
        va[k] -= w[a] * j;
        vb[k] += 2 * w[b] * j;
        vc[k] -= w[c] * j;
    }
}

static void smooth_range(void *task, int begin, int end) {
    const Smooth *job = task;
    const SpringSet *set = job->set;
    for (int i = begin; i < end; i++) {
        uint32_t s = job->first_strand + (uint32_t)i;
        for (uint32_t k = set->strand_first[s]; k + 1 < set->strand_first[s + 1]; k++)
            if (job->weight[k] > 0 && job->weight[k + 1] > 0) smooth_triple(job, set->ends[k][0], set->ends[k][1], set->ends[k + 1][1]);
    }
}

void dynamics_smooth(DynamicsPlan *plan, const Shell *shell, Pool *pool, DynamicsState *dynamics) {
    if (plan->settings.solver.smoothing <= 0) return;
    const SingeColour layers[] = {SINGE_BLUE, SINGE_GREEN};
    for (int layer = 0; layer < 2; layer++) {
        const SpringSet *set = &shell->springs[layers[layer]];
        Smooth job = {plan, set, plan->weight[layers[layer]], dynamics->velocity, 0};
        for (uint32_t f = 0; f < set->family_count; f++) {
            job.first_strand = set->family_first[f];
            uint32_t strands = set->family_first[f + 1] - job.first_strand;
            pool_for(pool, (int)strands, dynamics_strand_grain(set, f), smooth_range, &job);
        }
    }
}
