// The limit of curvature along the strands of one group, with one strand per lane: see curvature.c. Included after
// strand_kernel.h, whose groups and operations it uses.

/// Three consecutive nodes.
typedef struct Bend {
    Float4s a, b, c;
} Bend;

/// Straightens bends that are too sharp by their share; false if there are none.
static inline bool bend_straighten(Bend *bend, Lanes max, float share) {
    // r as quadruples, so that it alone is turned into lanes
    const Float4s twice = float4s_add(&bend->b, &bend->b), half = float4s_sub(&bend->a, &twice);
    const Float4s off = float4s_add(&half, &bend->c);
    const LaneNode r = float4s_node(&off);
    Lanes square = r.x * r.x + r.y * r.y + r.z * r.z, limit = max * max, zero = lanes_all(0);
    if (__builtin_expect(!lanes_any_less(limit, square), 1)) return false;

    LaneNode a = float4s_node(&bend->a), b = float4s_node(&bend->b), c = float4s_node(&bend->c);
    Lanes weight = lanes_max(a.w + lanes_all(4) * b.w + c.w, lanes_all(1e-20f));
    Lanes factor = (lanes_all(1) - max / lanes_sqrt(square)) * lanes_all(share) / weight;
    factor = lanes_where_less(limit, square, factor, zero);
    // r = (c - b) - (b - a): a and c move by -w r factor, b by 2 w r factor
    Float4s after = float4s_correction(&bend->b, &bend->c, factor),
            before = float4s_correction(&bend->a, &bend->b, factor);
    float4s_move(&bend->a, &before, &after);
    float4s_move(&bend->b, &after, &before);
    float4s_move(&bend->b, &after, &before);
    float4s_move(&bend->c, &before, &after);
    return true;
}

static inline void group_straighten(const Group *group, const float *limit, float share, bool ring) {
    Bend bend = {.b = group_float4s(group, 0), .c = group_float4s(group, 1)};
    for (uint32_t k = 1; k < group->rows; k++) {
        bend.a = bend.b;
        bend.b = bend.c;
        bend.c = group_float4s(group, k + 1);
        if (!bend_straighten(&bend, lanes_load(limit + (size_t)k * STRAND_LANES), share)) continue;
        group_put(group, k - 1, &bend.a);
        group_put(group, k, &bend.b);
        group_put(group, k + 1, &bend.c);
    }
    if (!ring) return;
    bend = (Bend){group_float4s(group, group->rows - 1), group_float4s(group, 0), group_float4s(group, 1)};
    if (!bend_straighten(&bend, lanes_load(limit), share)) return;
    group_put(group, group->rows - 1, &bend.a);
    group_put(group, 0, &bend.b);
    group_put(group, 1, &bend.c);
}

void STRAND_BEND(const StrandSet *set, float *position, uint32_t index) {
    const StrandGroup *part = &set->groups[index];
#ifdef BEND_NARROWER
    if (part->width < LANES) {
        BEND_NARROWER(set, position, index);
        return;
    }
#endif
    for (uint32_t lane = 0; lane < part->width; lane += LANES) {
        size_t slot = (size_t)part->row * STRAND_LANES + lane;
        Group group = {.position = position,
                       .node = set->node + slot,
                       .contiguous = set->contiguous + part->row,
                       .rows = part->rows,
                       .stride = part->width,
                       .first_contiguous = position + 4 * strand_column(part->width, lane)};
        group_straighten(&group, set->bend_limit + slot, set->bend_share, part->ring);
    }
}
