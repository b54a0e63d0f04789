// The nearest of many triangles, by a tree of boxes, four side by side: a node's boxes, or a leaf's triangles, are
// tested at once (Wald et al., Getting rid of packets, 2008, for rays). Triangles are halved along the longest axis of
// the centroids; all leaves but the last are full, so that the number of nodes follows from that of triangles.
#include "common/assertion.h"
#include "common/real.h"
#include "world/mesh_solid.h"

/// Three pending children at each level of a path, for the levels of a tree of 2^31 triangles.
enum { TREE_STACK = 3 * 17 + 4 };

typedef struct TreeBuild {
    MeshSolid *solid;
    float (*centroid)[3];
    uint32_t leaves, nodes;
} TreeBuild;

/// Number of triangles in the first half; all leaves but the last are full.
static uint32_t tree_half(uint32_t count) {
    return count <= SOLID_WIDE ? count : (count / 2 + SOLID_WIDE - 1) / SOLID_WIDE * SOLID_WIDE;
}

/// The numbers of triangles of a node's children.
static void tree_parts(uint32_t count, uint32_t parts[4]) {
    uint32_t half = tree_half(count);
    parts[0] = tree_half(half);
    parts[1] = half - parts[0];
    parts[2] = tree_half(count - half);
    parts[3] = count - half - parts[2];
}

static void tree_count(uint32_t count, uint32_t *nodes) {
    uint32_t parts[4];
    tree_parts(count, parts);
    ++*nodes;
    for (int i = 0; i < 4; i++)
        if (parts[i] > SOLID_WIDE) tree_count(parts[i], nodes);
}

/// Extends a box, low and high, to a triangle.
static void tree_box_add(float box[2][3], const MeshSolid *solid, uint32_t triangle) {
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++) {
            float x = solid->vertices[solid->triangles[triangle][i]][d];
            box[0][d] = float_min(box[0][d], x);
            box[1][d] = float_max(box[1][d], x);
        }
}

/// Whether triangle a comes before b along the axis; equal ones are ordered by number, so that the order is unique.
static bool tree_before(const TreeBuild *build, int axis, uint32_t a, uint32_t b) {
    float x = build->centroid[a][axis], y = build->centroid[b][axis];
    return x < y || (!(y < x) && a < b);
}

/// Moves the first `half` triangles along the axis in which the centroids extend the most to the front (Hoare's
/// selection).
static void tree_split(TreeBuild *build, uint32_t first, uint32_t count, uint32_t half) {
    uint32_t *order = build->solid->order;
    int axis = 0;
    float widest = -1;

    for (int d = 0; d < 3; d++) {
        float min = INFINITY, max = -INFINITY;
        for (uint32_t k = first; k < first + count; k++) {
            min = float_min(min, build->centroid[order[k]][d]);
            max = float_max(max, build->centroid[order[k]][d]);
        }

        if (!(max - min > widest)) continue;
        widest = max - min;
        axis = d;
    }

    int64_t low = first, high = (int64_t)first + count - 1, wanted = (int64_t)first + half;
    while (half < count && low < high) {
        uint32_t pivot = order[low + (high - low) / 2];
        int64_t i = low, j = high;
        while (i <= j) {
            while (tree_before(build, axis, order[i], pivot)) i++;
            while (tree_before(build, axis, pivot, order[j])) j--;
            if (i > j) break;
            uint32_t swap = order[i];
            order[i++] = order[j];
            order[j--] = swap;
        }

        if (wanted <= j) high = j;
        else if (wanted >= i) low = i;
        else break;
    }
}

static int32_t tree_leaf(TreeBuild *build, uint32_t first, uint32_t count) {
    uint32_t index = first / SOLID_WIDE;
    SolidLeaf *leaf = &build->solid->leaves[index];

    for (uint32_t lane = 0; lane < SOLID_WIDE; lane++) {
        uint32_t slot = first + (lane < count ? lane : count - 1);
        const uint32_t *corner = build->solid->triangles[build->solid->order[slot]];
        for (int i = 0; i < 3; i++) {
            float a = build->solid->vertices[corner[0]][i];
            leaf->a[i][lane] = a;
            leaf->ab[i][lane] = build->solid->vertices[corner[1]][i] - a;
            leaf->ac[i][lane] = build->solid->vertices[corner[2]][i] - a;
        }
    }

    return ~(int32_t)index;
}

static int32_t tree_build(TreeBuild *build, uint32_t first, uint32_t count) {
    if (count <= SOLID_WIDE) return tree_leaf(build, first, count);

    const MeshSolid *solid = build->solid;
    uint32_t index = build->nodes++, half = tree_half(count), parts[4];
    tree_parts(count, parts);
    tree_split(build, first, count, half);
    if (half > SOLID_WIDE) tree_split(build, first, half, parts[0]);
    if (count - half > SOLID_WIDE) tree_split(build, first + half, count - half, parts[2]);

    for (int i = 0; i < SOLID_WIDE; first += parts[i++]) {
        float box[2][3] = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (uint32_t k = first; k < first + parts[i]; k++) tree_box_add(box, solid, solid->order[k]);

        int32_t child = parts[i] ? tree_build(build, first, parts[i]) : 0;
        SolidNode *node = &solid->nodes[index];
        for (int d = 0; d < 3; d++) {
            node->low[d][i] = box[0][d];
            node->high[d][i] = box[1][d];
        }
        node->child[i] = child;
    }

    return (int32_t)index;
}

bool mesh_tree_create(Memory *memory, MeshSolid *solid) {
    uint32_t count = solid->triangle_count, nodes = 0;
    tree_count(count, &nodes);
    solid->leaf_count = count / SOLID_WIDE + (count % SOLID_WIDE > 0);
    solid->node_count = nodes;
    TreeBuild build = {.solid = solid};
    bool ok = NEW(memory, solid->order, count) && NEW(memory, solid->leaves, solid->leaf_count) &&
              NEW(memory, solid->nodes, nodes) && NEW(memory, build.centroid, count);

    // centroids
    for (uint32_t t = 0; ok && t < count; t++) {
        solid->order[t] = t;
        for (int i = 0; i < 3; i++) {
            const uint32_t *corner = solid->triangles[t];
            float a = solid->vertices[corner[0]][i], b = solid->vertices[corner[1]][i];
            build.centroid[t][i] = a + b + solid->vertices[corner[2]][i];
        }
    }

    // nodes and leaves
    if (ok && count > SOLID_WIDE) tree_build(&build, 0, count);
    if (ok && count <= SOLID_WIDE) { // a single leaf gets a node, too
        tree_leaf(&build, 0, count);
        for (int i = 0; i < 3; i++) {
            solid->nodes[0].low[i] = float4_all(-INFINITY);
            solid->nodes[0].high[i] = float4_all(INFINITY);
        }

        for (int i = 0; i < SOLID_WIDE; i++) solid->nodes[0].child[i] = ~0;
    }

    SINGE_ASSERT(!ok || count <= SOLID_WIDE || build.nodes == nodes); // tree_count has counted them
    FREE(memory, build.centroid, count);
    return ok;
}

void mesh_tree_refit(MeshSolid *solid) {
    TreeBuild build = {.solid = solid};
    const uint32_t count = solid->triangle_count;

    for (uint32_t first = 0; first < count; first += SOLID_WIDE)
        tree_leaf(&build, first, count - first < SOLID_WIDE ? count - first : SOLID_WIDE);

    // boxes from the leaves up: a node's children have higher numbers
    float all[2][3] = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t n = solid->node_count; n-- > 0;) {
        SolidNode *node = &solid->nodes[n];
        for (int i = 0; i < SOLID_WIDE; i++) {
            float box[2][3] = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
            const int32_t child = node->child[i];
            if (child == 0) continue; // empty: the root is nobody's child

            for (int lane = 0; lane < SOLID_WIDE; lane++) {
                uint32_t slot = (uint32_t)~child * SOLID_WIDE + (uint32_t)lane;
                if (child < 0) tree_box_add(box, solid, solid->order[slot < count ? slot : count - 1]);
                for (int d = 0; d < 3 && child > 0; d++) {
                    box[0][d] = float_min(box[0][d], solid->nodes[child].low[d][lane]);
                    box[1][d] = float_max(box[1][d], solid->nodes[child].high[d][lane]);
                }
            }

            for (int d = 0; d < 3; d++) {
                node->low[d][i] = box[0][d];
                node->high[d][i] = box[1][d];
                all[0][d] = n > 0 ? all[0][d] : float_min(all[0][d], box[0][d]);
                all[1][d] = n > 0 ? all[1][d] : float_max(all[1][d], box[1][d]);
            }
        }
    }

    solid->low = float3_load(all[0]);
    solid->high = float3_load(all[1]);
}

static inline Float4 tree_dot(const Float4 a[3], const Float4 b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Squares of the distances to the boxes; infinite for an empty one.
static inline Float4 tree_boxes(const SolidNode *node, const Float4 p[3]) {
    Float4 sum = float4_all(0);
    for (int i = 0; i < 3; i++) {
        Float4 out = float4_max(float4_max(node->low[i] - p[i], p[i] - node->high[i]), float4_all(0));
        sum += out * out;
    }
    return sum;
}

/// Square of the distance from pa (seen from the edge's start) to the edge.
static inline Float4 tree_edge(const Float4 pa[3], const Float4 edge[3]) {
    Float4 t = float4_min(float4_max(tree_dot(pa, edge) / tree_dot(edge, edge), float4_all(0)), float4_all(1)), off[3];
    for (int i = 0; i < 3; i++) off[i] = pa[i] - t * edge[i];
    return tree_dot(off, off);
}

static inline void tree_cross(const Float4 a[3], const Float4 b[3], Float4 out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/// Squares of the distances to a leaf's triangles: to the plane over the inside, else to the nearest edge.
static inline Float4 tree_triangles(const SolidLeaf *leaf, const Float4 p[3]) {
    Float4 pa[3], pb[3], bc[3], normal[3], side[3], back[3];
    for (int i = 0; i < 3; i++) {
        pa[i] = p[i] - leaf->a[i];
        pb[i] = pa[i] - leaf->ab[i];
        bc[i] = leaf->ac[i] - leaf->ab[i];
        back[i] = -leaf->ac[i];
    }

    tree_cross(leaf->ab, leaf->ac, normal);
    tree_cross(leaf->ab, pa, side);

    Float4Mask inside = tree_dot(side, normal) >= 0;
    tree_cross(bc, pb, side);
    inside &= tree_dot(side, normal) >= 0;
    tree_cross(back, pa, side);
    inside &= tree_dot(side, normal) >= 0;

    Float4 height = tree_dot(pa, normal);
    Float4 plane = height * height / tree_dot(normal, normal);
    Float4 edges = float4_min(float4_min(tree_edge(pa, leaf->ab), tree_edge(pa, leaf->ac)), tree_edge(pb, bc));
    return float4_select(inside, plane, edges);
}

typedef struct TreeItem {
    float square;
    int32_t child;
} TreeItem;

/// Pushes a node's children that are nearer than the best, the nearest last.
static int tree_push(const SolidNode *node, const Float4 p[3], float best, TreeItem *stack, int depth) {
    Float4 square = tree_boxes(node, p);
    int first = depth;

    for (int i = 0; i < SOLID_WIDE; i++) {
        if (!(square[i] < best)) continue;
        int k = depth++;
        for (; k > first && stack[k - 1].square < square[i]; k--) stack[k] = stack[k - 1];
        stack[k] = (TreeItem){square[i], node->child[i]};
    }

    return depth;
}

uint32_t mesh_tree_nearest(const MeshSolid *solid, Float3 at, float *square) {
    const Float4 p[3] = {float4_all(at.x), float4_all(at.y), float4_all(at.z)};
    TreeItem stack[TREE_STACK];
    float best = *square;
    uint32_t found = UINT32_MAX;
    int depth = tree_push(&solid->nodes[0], p, best, stack, 0);

    // depth first, through nodes that are near enough
    while (depth > 0) {
        SINGE_ASSERT(depth <= TREE_STACK);
        TreeItem item = stack[--depth];
        if (!(item.square < best)) continue;
        if (item.child >= 0) {
            depth = tree_push(&solid->nodes[item.child], p, best, stack, depth);
            continue;
        }

        // a leaf
        Float4 near = tree_triangles(&solid->leaves[~item.child], p);
        for (int i = 0; i < SOLID_WIDE; i++)
            if (near[i] < best) {
                best = near[i];
                found = (uint32_t)~item.child * SOLID_WIDE + (uint32_t)i;
            }
    }

    if (found == UINT32_MAX) return found;

    *square = best;
    return solid->order[found < solid->triangle_count ? found : solid->triangle_count - 1];
}
