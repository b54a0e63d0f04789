// The network's memory, and the springs around each particle.
#include "reference/spring_network.h"

SingeResult network_create(Memory *memory, uint32_t particle_count, uint32_t group_count, const NetworkSprings *springs,
                           bool matrix, Network *network) {
    *network = (Network){.particle_count = particle_count, .group_count = group_count, .matrix = matrix};
    network->kernel = conjugate_choose(SINGE_INSTRUCTIONS_BEST);

    bool ok = NEW(memory, network->position, particle_count) && NEW(memory, network->inverse_mass, particle_count) &&
              NEW(memory, network->held, particle_count) && NEW(memory, network->groups, group_count);
    for (uint32_t g = 0; ok && g < group_count; g++) {
        SpringGroup *group = &network->groups[g];
        group->count = springs[g].count;
        group->padded = (springs[g].count + NETWORK_LANES - 1) / NETWORK_LANES * NETWORK_LANES;
        ok = NEW(memory, group->ends, group->padded) && NEW(memory, group->length, group->padded) &&
             NEW(memory, group->weight, group->padded) && NEW(memory, group->compliance, group->padded) &&
             NEW(memory, group->first, (size_t)particle_count + 1) &&
             NEW(memory, group->incident, 2 * (size_t)group->count);
        if (!ok) break;

        for (uint32_t k = 0; k < group->count; k++)
            for (int end = 0; end < 2; end++) group->ends[k][end] = springs[g].ends[k][end];

        // the springs around each particle
        for (uint32_t k = 0; k < group->count; k++)
            for (int end = 0; end < 2; end++) group->first[group->ends[k][end] + 1]++;
        for (uint32_t i = 0; i < particle_count; i++) group->first[i + 1] += group->first[i];

        // fills from each particle's last entry down; afterwards first[i] is the first entry again
        for (uint32_t k = group->count; k-- > 0;)
            for (uint32_t end = 2; end-- > 0;) group->incident[--group->first[group->ends[k][end] + 1]] = 2 * k + end;
        for (uint32_t i = 0; i < particle_count; i++) group->first[i] = group->first[i + 1];
        group->first[particle_count] = 2 * group->count;
        ok = !matrix || ellpack_create(memory, group);
    }

    // scratch, as long as the largest group needs
    for (uint32_t g = 0; ok && g < group_count; g++) {
        const SpringGroup *group = &network->groups[g];
        if (network->row_max < group->padded) network->row_max = group->padded;
        if (matrix && network->entry_max < ellpack_entries(group)) network->entry_max = ellpack_entries(group);
    }

    const uint32_t rows = network->row_max;
    ok = ok && NEW(memory, network->gradient, rows);
    if (matrix)
        ok = ok && NEW(memory, network->value, network->entry_max) && NEW(memory, network->scale, rows) &&
             NEW(memory, network->solution, rows) && NEW(memory, network->residual, rows) &&
             NEW(memory, network->direction, rows) && NEW(memory, network->product, rows) &&
             NEW(memory, network->partial, pool_blocks((int)rows));
    if (ok) return SINGE_OK;

    network_free(memory, network);
    return SINGE_ERROR_MEMORY;
}

void network_free(Memory *memory, Network *network) {
    for (uint32_t g = 0; network->groups && g < network->group_count; g++) {
        SpringGroup *group = &network->groups[g];
        ellpack_free(memory, group);
        FREE(memory, group->ends, group->padded);
        FREE(memory, group->length, group->padded);
        FREE(memory, group->weight, group->padded);
        FREE(memory, group->compliance, group->padded);
        FREE(memory, group->first, (size_t)network->particle_count + 1);
        FREE(memory, group->incident, 2 * (size_t)group->count);
    }

    uint32_t rows = network->row_max;
    FREE(memory, network->position, network->particle_count);
    FREE(memory, network->inverse_mass, network->particle_count);
    FREE(memory, network->held, network->particle_count);
    FREE(memory, network->groups, network->group_count);
    FREE(memory, network->gradient, rows);
    FREE(memory, network->value, network->entry_max);
    FREE(memory, network->scale, rows);
    FREE(memory, network->solution, rows);
    FREE(memory, network->residual, rows);
    FREE(memory, network->direction, rows);
    FREE(memory, network->product, rows);
    FREE(memory, network->partial, pool_blocks((int)rows));
    *network = (Network){0};
}
