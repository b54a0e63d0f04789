// The matrix J M^-1 J^T of eq 16 in ELLPACK format (section 8.1), scaled to a unit diagonal.
//
// Springs i and j that share particle p have the entry
//
//   A_ij = +- w_p g_i . g_j      + where p is the same end of both, - where it is not
//
// so a row has as many entries as the spring has neighbours: 6 where every particle has four springs of the colour, and
// the diagonal makes the paper's 7. Around irregular vertices rows are longer. Plain ELLPACK would pad every row to the
// longest; here that holds within slices of 8 rows (Monakov, Lokhmotov and Avetisyan, HiPEAC 2010), whose entries are
// contiguous, so that 8 rows are multiplied at once. Where the 8 columns are consecutive, as on grids whose springs are
// numbered cell by cell, they are loaded as a run instead of one by one.
#include "reference/spring_network.h"

enum { LINK_MINUS = 2, LINK_EMPTY = 4 };

static uint32_t ellpack_degree(const SpringGroup *group, uint32_t particle) {
    return group->first[particle + 1] - group->first[particle];
}

bool ellpack_create(Memory *memory, SpringGroup *group) {
    // widths of the slices: of their longest rows
    const uint32_t slices = group->padded / NETWORK_LANES;
    if (!NEW(memory, group->slice_first, (size_t)slices + 1)) return false;

    for (uint32_t s = 0; s < slices; s++) {
        size_t width = 0;
        for (uint32_t k = s * NETWORK_LANES; k < (s + 1) * NETWORK_LANES && k < group->count; k++) {
            const uint32_t *ends = group->ends[k];
            size_t row = (size_t)ellpack_degree(group, ends[0]) + ellpack_degree(group, ends[1]) - 2;
            if (width < row) width = row;
        }

        group->slice_first[s + 1] = group->slice_first[s] + width;
    }

    const size_t entries = ellpack_entries(group);
    if (!NEW(memory, group->column, entries) || !NEW(memory, group->link, entries) ||
        !NEW(memory, group->run, entries / NETWORK_LANES))
        return false;

    // the neighbours of each spring, and empty entries up to the slice's width
    for (uint32_t row = 0; row < group->padded; row++) {
        const size_t slice = row / NETWORK_LANES, slice_end = NETWORK_LANES * group->slice_first[slice + 1];
        size_t at = NETWORK_LANES * group->slice_first[slice] + row % NETWORK_LANES;
        for (uint32_t end = 0; end < 2 && row < group->count; end++) {
            const uint32_t particle = group->ends[row][end];
            for (uint32_t i = group->first[particle]; i < group->first[particle + 1]; i++) {
                const uint32_t other = group->incident[i] / 2, other_end = group->incident[i] % 2;
                if (other == row) continue;
                group->column[at] = other;
                group->link[at] = (uint8_t)(end | (end == other_end ? 0 : LINK_MINUS));
                at += NETWORK_LANES;
            }
        }

        for (; at < slice_end; at += NETWORK_LANES) {
            group->column[at] = row;
            group->link[at] = LINK_EMPTY;
        }
    }

    // which eight columns are consecutive
    for (size_t k = 0; k < entries / NETWORK_LANES; k++) {
        const uint32_t *column = group->column + NETWORK_LANES * k;
        group->run[k] = column[0];
        for (uint32_t lane = 1; lane < NETWORK_LANES; lane++)
            if (column[lane] != column[0] + lane) group->run[k] = NETWORK_NO_RUN;
    }

    return true;
}

void ellpack_free(Memory *memory, SpringGroup *group) {
    if (!group->slice_first) return;
    size_t entries = ellpack_entries(group);
    FREE(memory, group->column, entries);
    FREE(memory, group->link, entries);
    FREE(memory, group->run, entries / NETWORK_LANES);
    FREE(memory, group->slice_first, (size_t)group->padded / NETWORK_LANES + 1);
}

typedef struct Assemble {
    Network *network;
    const SpringGroup *group;
} Assemble;

static void ellpack_assemble_range(void *task, int begin, int end) {
    static const double sign[] = {1, -1, 0};
    const Assemble *job = task;
    const SpringGroup *group = job->group;
    Network *network = job->network;
    const double *scale = network->scale;

    for (uint32_t row = (uint32_t)begin; row < (uint32_t)end; row++) {
        const uint32_t *ends = group->ends[row];
        const double *g = network->gradient[row];
        double factor[2];
        for (int k = 0; k < 2; k++) factor[k] = scale[row] * network->inverse_mass[ends[k]];

        const size_t slice = row / NETWORK_LANES, last = NETWORK_LANES * group->slice_first[slice + 1];
        for (size_t e = NETWORK_LANES * group->slice_first[slice] + row % NETWORK_LANES; e < last; e += NETWORK_LANES) {
            uint32_t j = group->column[e];
            const double *h = network->gradient[j];
            double dot = g[0] * h[0] + g[1] * h[1] + g[2] * h[2];
            network->value[e] = sign[group->link[e] / 2] * factor[group->link[e] % 2] * scale[j] * dot;
        }
    }
}

void ellpack_assemble(Network *network, uint32_t group, Pool *pool) {
    Assemble job = {network, &network->groups[group]};
    pool_for(pool, (int)job.group->padded, POOL_BLOCK, ellpack_assemble_range, &job);
}

void ellpack_dense(const Network *network, uint32_t group_index, double *dense) {
    const SpringGroup *group = &network->groups[group_index];
    const double *scale = network->scale;
    for (size_t row = 0; row < group->count; row++) {
        if (scale[row] == 0) continue;

        size_t slice = row / NETWORK_LANES, end = NETWORK_LANES * group->slice_first[slice + 1];
        dense[row * group->count + row] += 1 / (scale[row] * scale[row]);
        for (size_t e = NETWORK_LANES * group->slice_first[slice] + row % NETWORK_LANES; e < end; e += NETWORK_LANES)
            if (network->value[e] != 0)
                dense[row * group->count + group->column[e]] +=
                    network->value[e] / (scale[row] * scale[group->column[e]]);
    }
}
