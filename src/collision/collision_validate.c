// Invariants of the contact plan, for assertions and tests.
#include "collision/collision_plan.h"

static const char *validate_pairs(const CollisionPlan *plan) {
    if (plan->listed_count > plan->pair_count && plan->pair_count) return "a step's pairs begin with the search's";
    if (plan->pair_count > plan->pair_capacity || plan->listed_count > plan->pair_capacity) return "pairs have room";
    if (plan->pair_capacity > plan->sizes.pair_max) return "lists of pairs do not outgrow their limit";
    for (uint32_t k = 0; k < plan->listed_count; k++) {
        const CollisionPair *pair = &plan->pairs[k];
        if (pair->a >= plan->cell_count || pair->b >= plan->cell_count || pair->a > pair->b)
            return "a pair is of cells in order";
        if (pair->bridge != SHELL_NONE && pair->bridge >= plan->cell_count) return "a bridge is a cell";
        if (!(pair->distance >= 0)) return "distances are not negative";
    }
    return NULL;
}

static const char *validate_repulsions(const CollisionPlan *plan) {
    if (plan->repulsion_count > plan->repulsion_capacity) return "repulsions have room";
    if (plan->repulsion_capacity > plan->sizes.repulsion_max) return "lists of repulsions do not outgrow their limit";
    for (uint32_t k = 0; k < plan->repulsion_count; k++) {
        const Repulsion *repulsion = &plan->repulsions[k];
        float sum = 0;
        if (repulsion->count < 1 || repulsion->count > 8) return "a repulsion is of one to eight corners";
        for (uint32_t n = 0; n < repulsion->count; n++) {
            if (repulsion->node[n] >= plan->vertex_count) return "a repulsion is of vertices";
            sum += repulsion->weight[n];
        }
        if (!(fabsf(sum) < 1e-4f)) return "the weights of two points cancel";
        if (!isfinite(repulsion->target)) return "a repulsion has a target";
    }
    return NULL;
}

const char *collision_validate(const CollisionPlan *plan) {
    const char *broken = plan->searched ? validate_pairs(plan) : NULL;
    return broken || !plan->searched ? broken : validate_repulsions(plan);
}
