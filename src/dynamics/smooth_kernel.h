// Internal friction along the strands of one group, with one strand per lane: see smooth.c. One file per instruction set
// defines the operations on lanes and quadruples, as for strand_kernel.h, and includes this.
#include "dynamics/smooth.h"

/// A node of every lane.
typedef struct SmoothNode {
    Float4s velocity;
    Lanes w; ///< 1/kg, inverse mass
} SmoothNode;

/// The lanes of a group that are processed together.
typedef struct SmoothPart {
    const float *position, *first_position; ///< the second: as seen from this part's first lane
    float *velocity, *first_velocity;
    const uint32_t *node, *contiguous;
    const float *weight;
    uint32_t rows;
    size_t stride; ///< floats from one quadruple to the next where particles are contiguous
    float share;
} SmoothPart;

static inline SmoothNode smooth_node(const SmoothPart *part, uint32_t k) {
    const uint32_t first = part->contiguous[k], *node = part->node + (size_t)k * STRAND_LANES;
    Float4s position;
    SmoothNode it;
    if (first != STRAND_GATHERED) {
        it.velocity = float4s_load_contiguous(part->first_velocity + first, part->stride);
        position = float4s_load_contiguous(part->first_position + first, part->stride);
    } else {
        it.velocity = float4s_gather(part->velocity, node);
        position = float4s_gather(part->position, node);
    }
    it.w = float4s_node(&position).w;
    return it;
}

static inline void smooth_put(const SmoothPart *part, uint32_t k, const SmoothNode *it) {
    const uint32_t first = part->contiguous[k];
    if (first != STRAND_GATHERED) float4s_store_contiguous(part->first_velocity + first, part->stride, &it->velocity);
    else float4s_scatter(part->velocity, part->node + (size_t)k * STRAND_LANES, &it->velocity);
}

/// The number of springs in the unbroken run that ends with spring k.
static inline Lanes smooth_run(const SmoothPart *part, uint32_t k, Lanes run) {
    const Lanes zero = lanes_all(0), weight = lanes_load(part->weight + (size_t)k * STRAND_LANES);
    return lanes_where_less(zero, weight, run + lanes_all(1), zero);
}

/// Velocities of the quadruples e of three nodes.
#define SMOOTH_QUADRUPLES(e)                                                                                     \
    do {                                                                                                         \
        const Lanes s = LANES_SPREAD(factor, e), wa = LANES_SPREAD(a->w, e), wb = LANES_SPREAD(b->w, e);         \
        const Lanes va = (Lanes)a->velocity.at[e], vb = (Lanes)b->velocity.at[e], vc = (Lanes)c->velocity.at[e]; \
        const Lanes j = s * (va - lanes_all(2) * vb + vc), wc = LANES_SPREAD(c->w, e);                           \
        FLOAT4S_SET(a->velocity, e, lanes_where_less(zero, s, va - wa * j, va));                                 \
        FLOAT4S_SET(b->velocity, e, lanes_where_less(zero, s, vb + lanes_all(2) * wb * j, vb));                  \
        FLOAT4S_SET(c->velocity, e, lanes_where_less(zero, s, vc - wc * j, vc));                                 \
    } while (0)

/// Smooths three nodes where more than `least` springs are not gone; false if nowhere.
static inline bool smooth_nodes(const SmoothPart *part, Lanes run, Lanes least, SmoothNode *a, SmoothNode *b,
                                SmoothNode *c) {
    const Lanes zero = lanes_all(0), weight = a->w + lanes_all(4) * b->w + c->w;
    Lanes factor = lanes_where_less(zero, weight, lanes_all(part->share) / weight, zero);
    factor = lanes_where_less(least, run, factor, zero);
    if (!lanes_any_less(zero, factor)) return false;

    SMOOTH_QUADRUPLES(0);
    SMOOTH_QUADRUPLES(1);
    SMOOTH_QUADRUPLES(2);
    SMOOTH_QUADRUPLES(3);
    return true;
}

static inline void smooth_part(const SmoothPart *given, uint32_t reach) {
    const SmoothPart local = *given, *part = &local; // of its own, so that stores cannot change it
    Lanes run = lanes_all(0);
    const Lanes far = lanes_all(2 * (float)reach - 0.5f), near = lanes_all(1.5f);

    // nodes `reach` apart, then adjacent ones
    for (uint32_t k = 0; k < part->rows && reach > 0; k++) {
        run = smooth_run(part, k, run);
        if (!lanes_any_less(far, run)) continue;

        const uint32_t c = k + 1, b = c - reach, a = b - reach;
        SmoothNode nodes[3] = {smooth_node(part, a), smooth_node(part, b), smooth_node(part, c)};
        if (!smooth_nodes(part, run, far, &nodes[0], &nodes[1], &nodes[2])) continue;
        smooth_put(part, a, &nodes[0]);
        smooth_put(part, b, &nodes[1]);
        smooth_put(part, c, &nodes[2]);
    }

    SmoothNode a = smooth_node(part, 0), b = smooth_node(part, 1);
    run = smooth_run(part, 0, lanes_all(0));
    for (uint32_t k = 1; k < part->rows; k++) {
        SmoothNode c = smooth_node(part, k + 1);
        run = smooth_run(part, k, run);
        smooth_nodes(part, run, near, &a, &b, &c);
        smooth_put(part, k - 1, &a);
        a = b;
        b = c;
    }
    smooth_put(part, part->rows - 1, &a);
    smooth_put(part, part->rows, &b);
}

void SMOOTH_GROUP(const SmoothLanes *job, uint32_t index) {
    const StrandSet *set = job->set;
    const StrandGroup *group = &set->groups[index];
#ifdef SMOOTH_NARROWER
    if (group->width < LANES) {
        SMOOTH_NARROWER(job, index);
        return;
    }
#endif
    for (uint32_t lane = 0; lane < group->width; lane += LANES) {
        const size_t slot = (size_t)group->row * STRAND_LANES + lane;
        const uint32_t column = 4 * strand_column(group->width, lane);
        const SmoothPart part = {.position = job->position,
                                 .first_position = job->position + column,
                                 .velocity = job->velocity,
                                 .first_velocity = job->velocity + column,
                                 .node = set->node + slot,
                                 .contiguous = set->contiguous + group->row,
                                 .weight = set->weight + slot,
                                 .rows = group->rows,
                                 .stride = group->width,
                                 .share = job->share};
        smooth_part(&part, group->reach);
    }
}
