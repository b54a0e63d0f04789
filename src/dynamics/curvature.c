// The limit of curvature. A mesh of two layers resists a bend at an edge by the moment of its green spring, which grows
// up to an angle of about atan(2 t/s) and falls beyond: a sheet bent more sharply yields at one row of edges and spares
// their neighbours, so that folds run along rows. Where a sheet has not burnt, three consecutive vertices a, b, c of a
// blue or yellow strand, with springs of the mean length l, therefore keep to
//
//   |r| <= B,   r = x_a - 2 x_b + x_c,   B^2 = |r_0|^2 + (2 l sin(min(kappa l, 2.8)/2))^2
//
// with r_0 the value at rest and kappa = curvature_max: an arc of the curvature kappa turns by kappa l from one spring
// to the next. Cells s that are large for the thickness t cannot bear that: their moment is largest at about
// beta = atan(2 t/s), and kappa is at most beta/s (with l/s times the chord of beta for the chord of beta l/s). Cells
// of more than 8 t, which show no folds of paper, would be held nearly flat by that, and have no limit.
//
// Once a substep the excess is reduced by a share q of itself, with momentum conserved:
//
//   m = q (|r| - B)/|r| r/(w_a + 4 w_b + w_c),   x_a -= w_a m,   x_b += 2 w_b m,   x_c -= w_c m
//
// A projection passes half of what it removes on to the next vertex. So a bend beyond the limit has the stiffness
// q/(1 - q/2) m l^4/(6 h^2 s^2) per width, m a particle's mass and h the substep. With the same q folds along the
// diagonals, across yellow strands, are held four times as stiffly as those along rows. With `solver.isotropic` q is 1
// for blue strands and 0.4 for yellow ones, so that both are held alike; otherwise it is 1/2.
//
// Families of strands follow each other; strands of one family share no particle.
#include "common/real.h"
#include "dynamics/dynamics_plan.h"

#include <math.h>

/// Mass fraction above which a vertex counts as unburnt. Char is weak, and folds freely.
static const float BEND_FRESH = 0.98f;
/// Cells over thickness above which there is no limit.
static const float BEND_COARSE = 8;

bool curvature_create(Memory *memory, const Shell *shell, bool isotropic, Strands *strands) {
    const Field limit = shell->matter.curvature_max;
    bool limited = false;
    for (uint32_t v = 0; v < shell->vertex_count && !limited; v++) limited = field_at(limit, v) > 0;
    if (!limited) return true;

    for (int i = 0; i < 2; i++) {
        StrandSet *set = &strands->sets[i ? SINGE_YELLOW : SINGE_BLUE];
        size_t slots = (size_t)set->row_count * STRAND_LANES;
        if (!NEW(memory, set->bend_limit, slots)) return false;

        set->bend_share = !isotropic ? 0.5f : i ? 0.4f : 1;
        for (size_t slot = 0; slot < slots; slot++) set->bend_limit[slot] = INFINITY;
    }

    return true;
}

/// B above, for the vertex between two springs.
static float bend_limit(const Shell *shell, uint32_t a, uint32_t b, uint32_t c, float length, float side) {
    const float(*x)[4] = (const float(*)[4])shell->rest_position;
    const float curvature = field_at(shell->matter.curvature_max, b);
    float thickness = field_at(shell->matter.thickness, b);
    if (!(curvature > 0) || side > BEND_COARSE * thickness) return INFINITY;

    Float3 rest =
        float3_sub(float3_sub(float3_load(x[c]), float3_load(x[b])), float3_sub(float3_load(x[b]), float3_load(x[a])));
    float turned = 2 * length * real_sinf(0.5f * float_min(curvature * length, 2.8f));
    float cosine = side / sqrtf(side * side + 4 * thickness * thickness); // of beta
    turned = float_min(turned, 2 * length * length / side * sqrtf(0.5f * (1 - cosine)));
    return sqrtf(float3_dot(rest, rest) + turned * turned);
}

void curvature_prepare(const Shell *shell, const StateInput *state, SingeColour colour, uint32_t strand, uint32_t from,
                       uint32_t to, StrandSet *set) {
    const SpringSet *springs = &shell->springs[colour];
    const float *mass = state->burn->mass, *length = state->burn->spring_length[colour];
    const uint32_t first = springs->strand_first[strand], end = springs->strand_first[strand + 1];
    const float side = colour == SINGE_YELLOW ? 0.70710678f : 1; // of a cell, over the spring
    const uint8_t *seen = (const uint8_t *)set->seen;
    size_t slot = set->strand_slot[strand] + (size_t)(from - first) * STRAND_LANES;
    bool bends = false;

    for (uint32_t k = from; k < to; k++, slot += STRAND_LANES) {
        // the spring before, which is the last one at the start of a ring
        const uint32_t b = springs->ends[k][0], c = springs->ends[k][1];
        uint32_t before = k - 1;
        size_t slot_before = slot - STRAND_LANES;
        if (k == first) { // a ring's first vertex lies behind its last spring
            before = end - 1;
            slot_before = slot + (size_t)(end - 1 - first) * STRAND_LANES;
            if (springs->ends[before][1] != b || end - first < 3) continue;
        }

        // only unburnt mesh has a limit, which stays where neither spring has changed
        if (seen[k] != PREPARE_STALE && seen[before] != PREPARE_STALE) continue;
        const uint32_t a = springs->ends[before][0];
        bool fresh = mass[a] > BEND_FRESH && mass[b] > BEND_FRESH && mass[c] > BEND_FRESH;
        bool whole = set->weight[slot] > 0 && set->weight[slot_before] > 0; // neither burnt nor torn
        const float mean = 0.5f * (length[before] + length[k]);
        set->bend_limit[slot] = fresh && whole ? bend_limit(shell, a, b, c, mean, side * mean) : INFINITY;
        bends |= set->bend_limit[slot] < INFINITY;
    }
    if (bends) atomic_store_explicit(&set->bends, true, memory_order_relaxed);
}

typedef struct Curvature {
    const StrandSet *set;
    StrandBend *bend;
    float *position;
    uint32_t first_group;
} Curvature;

static void curvature_range(void *task, int begin, int end) {
    const Curvature *job = task;
    for (int i = begin; i < end; i++) job->bend(job->set, job->position, job->first_group + (uint32_t)i);
}

void curvature_project(const DynamicsPlan *plan, Pool *pool, DynamicsState *dynamics) {
    static const SingeColour colours[] = {SINGE_BLUE, SINGE_YELLOW};
    for (int i = 0; i < 2; i++) {
        const StrandSet *set = &plan->strands.sets[colours[i]];
        Curvature job = {set, plan->kernels->bend, dynamics->position[0], 0};
        if (set->bend_limit && set->bends) strand_families(set, false, pool, curvature_range, &job, &job.first_group);
    }
}
