// Groups at rest. Where a group of particles and all that it conducts with are at the ambient temperature and nothing
// heats them, every term of eq 1 to 3 is zero to the bit: what conducts there need not be computed. In the k-th
// iteration of the conjugate gradients heat reaches groups k links farther, and they wake one ring after another.
#include "heat/plan.h"

/// More neighbours than this are not listed: such a group is near all others.
enum { NEAR_MOST = 48 };

/// Appends the groups near `group` to the list where there is one; returns their number. `seen` remembers, by group,
/// the last one that listed it.
static uint32_t list_near(const HeatPlan *plan, uint32_t group, uint32_t *seen, uint32_t *near) {
    const HeatMatrix *matrix = &plan->matrix;
    uint32_t count = 0, begin = matrix->first[group * (HEAT_GROUP / HEAT_ROWS)];
    uint32_t end = matrix->first[(heat_group_last(plan, group) - 1) / HEAT_ROWS + 1];
    seen[group] = group + 1;
    for (uint32_t k = begin; k < end; k++) {
        uint32_t other = matrix->column[k] / HEAT_GROUP;
        if (seen[other] == group + 1) continue;
        seen[other] = group + 1;
        if (count++ == NEAR_MOST) return UINT32_MAX;
        if (near) near[count - 1] = other;
    }
    return count;
}

void heat_rest_rebuild(HeatPlan *plan, uint32_t *seen) {
    HeatRest *rest = &plan->rest;
    for (uint32_t g = 0; g < rest->groups; g++) seen[g] = 0;
    for (uint32_t g = 0; g < rest->groups; g++) {
        uint32_t count = list_near(plan, g, seen, NULL);
        rest->first[g + 1] = rest->first[g] + (count == UINT32_MAX ? 0 : count);
    }
    for (uint32_t g = 0; g < rest->groups; g++) seen[g] = 0;
    for (uint32_t g = 0; g < rest->groups; g++)
        if (rest->first[g + 1] > rest->first[g]) list_near(plan, g, seen, rest->near + rest->first[g]);
}

SingeResult heat_rest_create(Memory *memory, HeatPlan *plan) {
    HeatRest *rest = &plan->rest;
    uint32_t groups = rest->groups = plan->particles / HEAT_GROUP + (plan->particles % HEAT_GROUP > 0), *seen = NULL;
    bool ok = NEW(memory, rest->first, (size_t)groups + 1) && NEW(memory, rest->warm, groups) &&
              NEW(memory, rest->awake[0], groups) && NEW(memory, rest->awake[1], groups) && NEW(memory, seen, groups);
    for (uint32_t g = 0; ok && g < groups; g++) {
        uint32_t count = list_near(plan, g, seen, NULL);
        rest->first[g + 1] = rest->first[g] + (count == UINT32_MAX ? 0 : count);
    }
    if (ok) rest->near_count = plan->conductance ? groups * NEAR_MOST : rest->first[groups];
    ok = ok && NEW(memory, rest->near, rest->near_count);
    if (ok) heat_rest_rebuild(plan, seen);
    FREE(memory, seen, groups);
    return ok ? SINGE_OK : SINGE_ERROR_MEMORY;
}

void heat_rest_free(Memory *memory, HeatPlan *plan) {
    HeatRest *rest = &plan->rest;
    FREE(memory, rest->first, (size_t)rest->groups + 1);
    FREE(memory, rest->near, rest->near_count);
    FREE(memory, rest->warm, rest->groups);
    FREE(memory, rest->awake[0], rest->groups);
    FREE(memory, rest->awake[1], rest->groups);
}

bool heat_rest_reaches(const HeatRest *rest, const uint8_t *set, uint32_t group) {
    if (set[group] || rest->first[group] == rest->first[group + 1]) return true;
    for (uint32_t k = rest->first[group]; k < rest->first[group + 1]; k++)
        if (set[rest->near[k]]) return true;
    return false;
}
