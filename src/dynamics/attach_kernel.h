// The attachments of vertices, LANES at a time. One file per instruction set includes this, like strand_kernel.h.
#include "dynamics/attach.h"

/// Where sources p and q are farther apart than the sheet between them, by the ratio f, no position near the line
/// between them satisfies both spheres: there both lengths grow, as if the sheet were stretched, by at most f and so
/// far that the spheres overlap by a margin.
static inline void attach_stretch(const AttachSpread *spread, Lanes length[ATTACH_SOURCES]) {
    Lanes factor[ATTACH_SOURCES], one = lanes_all(1);
    for (int p = 0; p < ATTACH_SOURCES; p++) factor[p] = one;
    for (int p = 0; p < spread->count; p++)
        for (int q = 0; q < p; q++) {
            Lanes enough = lanes_all(1.15f * spread->apart[p][q]) / (length[p] + length[q]);
            Lanes max = lanes_all(spread->ratio[p][q]);
            enough = lanes_where_less(max, enough, max, enough);
            factor[p] = lanes_max(factor[p], enough);
            factor[q] = lanes_max(factor[q], enough);
        }
    for (int p = 0; p < spread->count; p++) length[p] *= factor[p];
}

void ATTACH_HOLD(const AttachSpread *spread, const float *length, float *position, int count) {
    Lanes zero = lanes_all(0), one = lanes_all(1);
    for (int i = 0; i + LANES <= count; i += LANES) {
        Float4s point = float4s_load_contiguous(position + 4 * i, LANES),
                lengths = float4s_load_contiguous(length + 4 * i, LANES);
        LaneNode node = float4s_node(&point), by_source = float4s_node(&lengths);
        Lanes max[ATTACH_SOURCES] = {by_source.x, by_source.y, by_source.z, by_source.w};
        bool moved = false;
        if (spread->gives) attach_stretch(spread, max);
        for (int k = 0; k < spread->count; k++) {
            const float *anchor = spread->position[k];
            Lanes dx = node.x - lanes_all(anchor[0]), dy = node.y - lanes_all(anchor[1]);
            Lanes dz = node.z - lanes_all(anchor[2]);
            Lanes square = dx * dx + dy * dy + dz * dz, limit = max[k] * max[k];
            if (!lanes_any_less(limit, square)) continue;
            // sqrt(q) - 1 for q = limit/square; up to a hundredth too far, (q - 1)/(q + 1) equals it to 1e-5
            Lanes pull = (limit - square) / (limit + square);
            Lanes max_square = limit * lanes_all(1.02f);
            if (lanes_any_less(max_square, square))
                pull = lanes_where_less(max_square, square, lanes_sqrt(limit / square) - one, pull);
            pull = lanes_where_less(limit, square, pull, zero);
            pull = pull * lanes_all(spread->share);
            pull = lanes_where_less(zero, node.w, pull, zero); // held vertices stay
            node.x += dx * pull;
            node.y += dy * pull;
            node.z += dz * pull;
            float4s_pull(&point, anchor, pull);
            moved = true;
        }
        if (moved) float4s_store_contiguous(position + 4 * i, LANES, &point);
    }
}
