// Groups at rest. If a group of particles and all that conduct with it are at the ambient temperature and unheated,
// every term of eq 1 to 3 is zero to the bit, and the conduction there need not be computed. In the k-th iteration of
// the conjugate gradients heat reaches groups k links farther: they wake ring by ring.
#include "heat/heat_plan.h"

#include <string.h>

/// Lists the groups near one. `seen` holds for each group 1 + the last group that listed it.
static void list_near(HeatPlan *plan, uint32_t group, uint32_t *seen) {
    const HeatMatrix *matrix = &plan->matrix;
    uint32_t count = 0, begin = matrix->first[group * (HEAT_GROUP / HEAT_ROWS)];
    uint32_t end = matrix->first[(heat_group_last(plan, group) - 1) / HEAT_ROWS + 1];

    seen[group] = group + 1;
    for (uint32_t k = begin; k < end && count <= HEAT_NEAR; k++) {
        uint32_t other = matrix->column[k] / HEAT_GROUP;
        if (seen[other] == group + 1) continue;
        seen[other] = group + 1;
        if (count < HEAT_NEAR) plan->rest.near[group][count] = other;
        count++;
    }

    plan->rest.near_count[group] = (uint8_t)count;
}

void heat_rest_rebuild(HeatPlan *plan, uint32_t *seen) {
    memset(seen, 0, plan->rest.groups * sizeof *seen);
    for (uint32_t g = 0; g < plan->rest.groups; g++) list_near(plan, g, seen);
}

void heat_rest_update(HeatPlan *plan, uint32_t group, uint32_t *seen) {
    memset(seen, 0, plan->rest.groups * sizeof *seen);
    list_near(plan, group, seen);
}

SingeResult heat_rest_create(Memory *memory, HeatPlan *plan) {
    HeatRest *rest = &plan->rest;
    uint32_t groups = rest->groups = plan->particles / HEAT_GROUP + (plan->particles % HEAT_GROUP > 0), *seen = NULL;
    bool ok = NEW(memory, rest->near, groups) && NEW(memory, rest->near_count, groups) &&
              NEW(memory, rest->warm, groups) && NEW(memory, rest->awake[0], groups) &&
              NEW(memory, rest->awake[1], groups) && NEW(memory, seen, groups);

    if (ok) heat_rest_rebuild(plan, seen);
    FREE(memory, seen, groups);
    return ok ? SINGE_OK : SINGE_ERROR_MEMORY;
}

void heat_rest_free(Memory *memory, HeatPlan *plan) {
    HeatRest *rest = &plan->rest;
    FREE(memory, rest->near, rest->groups);
    FREE(memory, rest->near_count, rest->groups);
    FREE(memory, rest->warm, rest->groups);
    FREE(memory, rest->awake[0], rest->groups);
    FREE(memory, rest->awake[1], rest->groups);
}

bool heat_rest_reaches(const HeatRest *rest, const uint8_t *set, uint32_t group) {
    if (set[group] || rest->near_count[group] > HEAT_NEAR) return true;
    for (uint32_t k = 0; k < rest->near_count[group]; k++)
        if (set[rest->near[group][k]]) return true;
    return false;
}
