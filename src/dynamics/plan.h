// The dynamics' own scratch and the parts of its step. Nothing outside src/dynamics includes this.
#ifndef DYNAMICS_PLAN_H
#define DYNAMICS_PLAN_H

#include "dynamics/dynamics.h"

/// A collider at the two ends of a substep.
typedef struct MovingCollider {
    const SingeColliderDef *def;
    Pose before, after;
} MovingCollider;

struct DynamicsPlan {
    DynamicsSettings settings;
    // per particle, refreshed at every step
    float *inverse_mass;     ///< 1/kg; 0 for what is pinned or gone
    float *drag;             ///< 1/m, k of the quadratic drag: dv/dt = -k |v_n| v_n
    float (*normal)[4];      ///< unit
    float (*air)[4];         ///< m/s, the wind there
    float (*predicted)[4];   ///< m, x~ of eq 9
    // per spring, refreshed at every step
    float *weight[SINGE_COLOUR_COUNT]; ///< W of eq 19, with char; 0 where the spring is gone
    float *compliance[SINGE_COLOUR_COUNT]; ///< m/N, mean of the ends; never changes
    // scratch of the strand solves, indexed by spring: strands of a family never share one
    float (*direction)[4];   ///< u, and w: the eliminated right-hand side
    float *upper;            ///< c' of the Thomas algorithm
    float *cyclic;           ///< second right-hand side of rings
    float (*cell_normal)[4]; ///< unit times twice the area
    MovingCollider *colliders;
    uint32_t collider_capacity;
    double *partial;         ///< [pool_blocks(particles)]
    uint32_t particle_count, cell_count, spring_count[SINGE_COLOUR_COUNT], spring_most;
};

/// Inverse masses, weights, normals, drag and wind for this step (prepare.c).
void dynamics_prepare(DynamicsPlan *plan, const Shell *shell, const State *state, const SingeWindDef *wind, Pool *pool);

/// Eq 8 and 9: velocities under gravity, drag and damping, then positions (predict.c).
void dynamics_predict(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, DynamicsState *dynamics);

/// Puts pinned particles on their paths (predict.c).
void dynamics_place_pins(DynamicsPlan *plan, const PinList *pins, const AblateState *ablate, double time, float h,
                         DynamicsState *dynamics);

/// One projection of one colour, family after family (strand_project.c). Returns the number of strands.
uint64_t strand_project(DynamicsPlan *plan, const Shell *shell, const BurnState *burn, SingeColour colour, Pool *pool,
                        float h, DynamicsState *dynamics);

/// Keeps every centre over its cell's corners (height.c).
void height_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics);

/// Internal friction of both layers over a step of h seconds (smooth.c).
void dynamics_smooth(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, DynamicsState *dynamics);

/// Strands of a family that make about 2,048 springs: the least a thread is given.
static inline int dynamics_strand_grain(const SpringSet *set, uint32_t family) {
    uint32_t first = set->family_first[family], last = set->family_first[family + 1];
    uint32_t springs = set->strand_first[last] - set->strand_first[first];
    return (int)(2048 * (last - first) / (springs + 1)) + 1;
}

/// Contact and friction with the colliders in plan->colliders (contact.c). Returns the number of contacts.
uint64_t contact_project(DynamicsPlan *plan, uint32_t collider_count, Pool *pool, float h, DynamicsState *dynamics);

#endif
