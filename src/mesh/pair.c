// Triangles joined to quads. Polygons of five corners and more are cut into triangles first, and quads of a mixed mesh
// into pairs that are joined already.
//
// A pair of triangles costs, in degrees,
//
//   max |angle - 90| over the quad's four corners + the fold between the two triangles
//
// and less if the quad continues the rows of an existing one: at an end of the side that both share, their angles add
// up to 180 if the other sides run straight through. The cheapest pairs are made first, so rows grow from where quads
// fit best, and opposite sides run through many quads: strands are long. Single triangles that remain are resolved by
// match.c, which shifts pairs along a path of triangles until two single ones meet, or one reaches the border. A pair
// that would make a bad quad (an angle above 175 degrees, a sharp fold, a seam of the uv) gets a new vertex at the
// midpoint of its shared side, which makes both triangles quads; so does a single triangle at the border.
#include "common/real.h"
#include "mesh/polygon.h"

#include <math.h>
#include <string.h>

#define DEGREES (180 / 3.14159265358979323846)
static const double angle_max = 175, fold_max = 60, straight_gain = 0.5, straight_within = 60;

typedef struct PairItem {
    double cost;
    uint32_t half; ///< the half-edge that the pair shares; decides between equal costs
} PairItem;

/// A heap of pairs of triangles, cheapest first.
typedef struct PairHeap {
    PairItem *items;
    uint32_t count, capacity;
} PairHeap;

/// The triangles of a mesh while they are joined to quads.
typedef struct Pairs {
    Work *work;
    uint32_t *mate;   ///< [triangles]
    uint32_t *whole;  ///< [triangles] the first corner, in `before`, of the quad that it is half of; else MESH_NONE
    double *cost;     ///< [half-edges] of the pair across a side, at the lower of its two half-edges
    uint8_t *good;    ///< [half-edges] whether that pair makes a good quad
    uint32_t *degree; ///< [vertices] triangles
    uint8_t *rim;     ///< [vertices] whether on an open edge
    Faces before;     ///< the faces that the triangles come from
    uint32_t *before_face, *before_twin; ///< [corners of `before`]
    uint32_t *from;                      ///< [half-edges] the corner in `before` at which it begins
    PairHeap heap;
} Pairs;

/// The order of the heap.
static bool is_before(const PairItem *a, const PairItem *b) {
    return a->cost < b->cost || (a->cost == b->cost && a->half < b->half);
}

// ---- faces cut into triangles

static uint32_t pair_next3(uint32_t half) { return half - half % 3 + (half + 1) % 3; }
static uint32_t pair_last3(uint32_t half) { return half - half % 3 + (half + 2) % 3; }

/// Degrees between 0 and 180 at vertex b of the corner a b c.
static double pair_angle(const Work *work, uint32_t a, uint32_t b, uint32_t c) {
    double p[3], q[3];
    sub3(work->position[a], work->position[b], p);
    sub3(work->position[c], work->position[b], q);
    const double square = dot3(p, p) * dot3(q, q);
    return DEGREES * acos(square > 0 ? double_max(-1, double_min(1, dot3(p, q) / sqrt(square))) : 1);
}

/// The smallest angle of a triangle, in degrees; negative if it is flipped against the normal.
static double worth_of(const Pairs *pairs, const uint32_t half[3], const double normal[3]) {
    const Work *work = pairs->work;
    const uint32_t a = work->faces.corner[half[0]], b = work->faces.corner[half[1]], c = work->faces.corner[half[2]];
    double p[3], q[3], m[3];
    sub3(work->position[b], work->position[a], p);
    sub3(work->position[c], work->position[b], q);
    cross3(p, q, m);

    double min =
        double_min(pair_angle(work, a, b, c), double_min(pair_angle(work, b, c, a), pair_angle(work, c, a, b)));
    return dot3(m, normal) > 0 ? min : -1 - min;
}

/// Pushes a triangle of corners of `before`.
static void push_triangle(Pairs *pairs, Faces *out, uint32_t a, uint32_t b, uint32_t c, uint32_t origin) {
    const Faces *old = &pairs->before;
    uint32_t *from = pairs->from + out->corner_count;
    from[0] = a;
    from[1] = b;
    from[2] = c;
    faces_push(out, old->corner[a], old, a);
    faces_push(out, old->corner[b], old, b);
    faces_push(out, old->corner[c], old, c);
    faces_end(out, origin);
}

/// Cuts all faces into triangles: fills `before`, `from`, `mate` and `whole`, and the faces of `work`. False if a
/// face cannot be cut. work->no_memory is set when out of memory.
static bool cut_faces(Pairs *pairs) {
    Work *work = pairs->work;
    const Faces *old = &work->faces;
    const uint32_t triangles = old->corner_count - 2 * old->count;
    Faces out = work_faces(work, triangles, 3 * triangles);
    uint32_t *ring = work_new(work, old->corner_count, sizeof *ring);
    PolygonCut cut;

    work_edges(work);
    pairs->before = *old;
    pairs->before_face = work->face;
    pairs->before_twin = work->twin;
    pairs->from = work_new(work, 3 * (size_t)triangles, sizeof *pairs->from);
    pairs->mate = work_new(work, triangles, sizeof *pairs->mate);
    pairs->whole = work_new(work, triangles, sizeof *pairs->whole);
    if (work->no_memory || !polygon_begin(&cut, work, old)) return true;

    memset(pairs->mate, 0xff, triangles * sizeof *pairs->mate);
    memset(pairs->whole, 0xff, triangles * sizeof *pairs->whole);

    for (uint32_t f = 0; f < old->count; f++) {
        const uint32_t first = old->first[f], n = old->first[f + 1] - first;
        if (n == 4) { // along the diagonal that gives the better triangles, which are a pair
            const uint32_t whole[4] = {first, first + 1, first + 2, first + 3};
            double normal[3], value[2];
            face_area(work, f, normal);
            for (uint32_t k = 0; k < 2; k++) {
                const uint32_t last = whole[(k + 3) % 4], ear[3] = {last, whole[k], whole[k + 1]};
                const uint32_t other[3] = {whole[k + 1], whole[k + 2], last};
                value[k] = double_min(worth_of(pairs, ear, normal), worth_of(pairs, other, normal));
            }
            const uint32_t s = value[1] >= value[0] ? 0 : 1, t = out.count; // the ears are at s + 1 and s + 3
            push_triangle(pairs, &out, first + s, first + s + 1, first + s + 2, old->origin[f]);
            push_triangle(pairs, &out, first + s, first + s + 2, first + (s + 3) % 4, old->origin[f]);
            pairs->mate[t] = t + 1;
            pairs->mate[t + 1] = t;
            pairs->whole[t] = pairs->whole[t + 1] = first;
            continue;
        }

        for (uint32_t i = 0; i < n; i++) ring[i] = first + i;
        cut.count = 0;
        if (n == 3) push_triangle(pairs, &out, ring[0], ring[1], ring[2], old->origin[f]);
        else if (!polygon_cut(&cut, ring, n)) return false;

        for (uint32_t t = 0; t < cut.count; t++) {
            const uint32_t *half = cut.triangle[t];
            push_triangle(pairs, &out, half[0], half[1], half[2], old->origin[f]);
        }
    }

    work->faces = out;
    return true;
}

// ---- what a pair costs

static uint32_t pair_name(const Pairs *pairs, uint32_t half) {
    uint32_t twin = pairs->work->twin[half];
    return twin < half ? twin : half;
}

/// The angle of a half-edge's triangle at the corner where the half-edge begins.
static double corner_angle(const Pairs *pairs, uint32_t half) {
    const uint32_t *corner = pairs->work->faces.corner;
    return pair_angle(pairs->work, corner[pair_last3(half)], corner[half], corner[pair_next3(half)]);
}

static void cost_pair(Pairs *pairs, uint32_t half, uint32_t twin) {
    const Work *work = pairs->work;
    const uint32_t *corner = work->faces.corner;
    float(*uv)[2] = work->faces.uv;
    double angle[4] = {corner_angle(pairs, half) + corner_angle(pairs, pair_next3(twin)),
                       corner_angle(pairs, pair_next3(half)) + corner_angle(pairs, twin),
                       corner_angle(pairs, pair_last3(half)), corner_angle(pairs, pair_last3(twin))};
    double worst = 0, max = 0;
    for (int i = 0; i < 4; i++) {
        worst = double_max(worst, fabs(angle[i] - 90));
        max = double_max(max, angle[i]);
    }

    double n[3], m[3];
    face_area(work, half / 3, n);
    face_area(work, twin / 3, m);
    const double square = dot3(n, n) * dot3(m, m);
    const double fold = square > 0 ? DEGREES * acos(double_max(-1, double_min(1, dot3(n, m) / sqrt(square)))) : 180;

    // an interior vertex must keep three cells
    bool thin_fan = corner[pair_last3(half)] == corner[pair_last3(twin)];
    for (int i = 0; i < 2; i++) {
        uint32_t v = corner[i ? pair_next3(half) : half];
        thin_fan = thin_fan || (!pairs->rim[v] && pairs->degree[v] <= 3);
    }

    const uint32_t a = pair_next3(twin), b = pair_next3(half);
    const bool seam = uv && (uv[half][0] != uv[a][0] || uv[half][1] != uv[a][1] || uv[b][0] != uv[twin][0] ||
                             uv[b][1] != uv[twin][1]);
    pairs->cost[half] = worst + fold;
    pairs->good[half] = max <= angle_max && fold <= fold_max && !thin_fan && !seam;
}

// ---- the cheapest first

/// The angle of the quad of a triangle and its mate, at the corner where `corner_half` begins. `half` is the shared
/// side of the triangle, `twin` that of the mate.
static double quad_angle(const Pairs *pairs, uint32_t corner_half, uint32_t half, uint32_t twin) {
    double angle = corner_angle(pairs, corner_half);
    if (corner_half == half) angle += corner_angle(pairs, pair_next3(twin));
    else if (corner_half == pair_next3(half)) angle += corner_angle(pairs, twin);
    return angle;
}

/// The half-edge that a triangle shares with its mate.
static uint32_t shared_half(const Pairs *pairs, uint32_t triangle) {
    uint32_t mate = pairs->mate[triangle];
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++)
        if (pairs->work->twin[h] != MESH_NONE && pairs->work->twin[h] / 3 == mate) return h;
    return MESH_NONE;
}

/// Offers the pairs of a single triangle.
static void offer(Pairs *pairs, uint32_t triangle) {
    const Work *work = pairs->work;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        if (work->twin[h] == MESH_NONE || pairs->mate[work->twin[h] / 3] != MESH_NONE) continue;
        const uint32_t name = pair_name(pairs, h), twin = work->twin[name];
        if (!pairs->good[name]) continue;

        // the gain from continuing the rows of the quads around the pair
        double gain = 0;
        for (int i = 0; i < 4; i++) {
            uint32_t inner = i < 2 ? name : twin, other = i < 2 ? twin : name;
            uint32_t side = i & 1 ? pair_next3(inner) : pair_last3(inner), across = work->twin[side];
            if (across == MESH_NONE || pairs->mate[across / 3] == MESH_NONE) continue;

            uint32_t shared = shared_half(pairs, across / 3);
            if (shared == MESH_NONE || shared == across) continue;

            uint32_t beyond = work->twin[shared];
            double from = quad_angle(pairs, side, inner, other) + quad_angle(pairs, pair_next3(across), shared, beyond);
            double to = quad_angle(pairs, pair_next3(side), inner, other) + quad_angle(pairs, across, shared, beyond);
            gain += double_max(0, straight_within - 0.5 * (fabs(from - 180) + fabs(to - 180)));
        }

        PairHeap *heap = &pairs->heap;
        const PairItem item = {pairs->cost[name] - straight_gain * gain, name};

        if (heap->count == heap->capacity) {
            uint32_t capacity = 2 * heap->capacity + 64;
            PairItem *items = work_new(pairs->work, capacity, sizeof *items);
            if (!items) return;
            if (heap->count) memcpy(items, heap->items, heap->count * sizeof *items);
            heap->items = items;
            heap->capacity = capacity;
        }

        uint32_t at = heap->count++;
        for (; at > 0 && is_before(&item, &heap->items[(at - 1) / 2]); at = (at - 1) / 2)
            heap->items[at] = heap->items[(at - 1) / 2];
        heap->items[at] = item;
    }
}

static void offer_around(Pairs *pairs, uint32_t triangle) {
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        uint32_t across = pairs->work->twin[h];
        if (across != MESH_NONE && pairs->mate[across / 3] == MESH_NONE) offer(pairs, across / 3);
    }
}

// ---- triangles that stay single

/// Grows the matching over the graph of good pairs, or of all pairs.
static void pair_grow(Pairs *pairs, bool all, const uint8_t *open) {
    Work *work = pairs->work;
    const uint32_t count = work->faces.count;
    uint32_t *first = work_new(work, (size_t)count + 1, sizeof *first);
    uint32_t *to = work_new(work, work->faces.corner_count, sizeof *to);
    bool alone = false;
    for (uint32_t t = 0; t < count; t++) alone = alone || pairs->mate[t] == MESH_NONE;
    if (work->no_memory || !alone) return;

    for (uint32_t t = 0, total = 0; t < count; t++) {
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++)
            if (work->twin[h] != MESH_NONE && (all || pairs->good[pair_name(pairs, h)]))
                to[total++] = work->twin[h] / 3;
        first[t + 1] = total;
    }

    match_grow(work, count, first, to, open, pairs->mate);
}

/// Pairs the triangles; those with an open side may stay single. False if others would.
static bool find_mates(Pairs *pairs) {
    Work *work = pairs->work;
    const uint32_t count = work->faces.count;
    uint8_t *open = work_new(work, count, 1);
    if (work->no_memory) return true;

    for (uint32_t h = 0; h < work->faces.corner_count; h++) open[h / 3] |= work->twin[h] == MESH_NONE;

    // the cheapest first
    for (uint32_t t = 0; t < count; t++)
        if (pairs->mate[t] == MESH_NONE) offer(pairs, t);
    while (pairs->heap.count && !work->no_memory) {
        PairHeap *heap = &pairs->heap;
        PairItem top = heap->items[0], item = heap->items[--heap->count];
        uint32_t i = 0;
        for (uint32_t child; (child = 2 * i + 1) < heap->count; i = child) {
            if (child + 1 < heap->count && is_before(&heap->items[child + 1], &heap->items[child])) child++;
            if (!is_before(&heap->items[child], &item)) break;
            heap->items[i] = heap->items[child];
        }
        heap->items[i] = item;

        const uint32_t half = top.half, a = half / 3, b = work->twin[half] / 3;
        if (pairs->mate[a] != MESH_NONE || pairs->mate[b] != MESH_NONE) continue;
        pairs->mate[a] = b;
        pairs->mate[b] = a;
        offer_around(pairs, a);
        offer_around(pairs, b);
    }

    // then the triangles that are left
    pair_grow(pairs, false, NULL);
    pair_grow(pairs, false, open);
    pair_grow(pairs, true, open);
    for (uint32_t t = 0; t < count && !work->no_memory; t++)
        if (pairs->mate[t] == MESH_NONE && !open[t]) return false;
    return true;
}

// ---- quads

/// Pushes the triangle of `half` with a vertex at the midpoint of that side.
static void push_halved(const Faces *old, uint32_t half, uint32_t midpoint, Faces *out) {
    faces_push(out, old->corner[half], old, half);
    faces_push_between(out, midpoint, old, half, pair_next3(half));
    faces_push(out, old->corner[pair_next3(half)], old, pair_next3(half));
    faces_push(out, old->corner[pair_last3(half)], old, pair_last3(half));
    faces_end(out, old->origin[half / 3]);
}

static void pair_halve(Pairs *pairs, uint32_t half, Faces *out) {
    Work *work = pairs->work;
    const Faces *old = &work->faces;
    const uint32_t ends[2] = {old->corner[half], old->corner[pair_next3(half)]};
    uint32_t midpoint = work_vertex(work, ends, 2);
    push_halved(old, half, midpoint, out);
    if (work->twin[half] != MESH_NONE) push_halved(old, work->twin[half], midpoint, out);
    work_did(work, MESH_HALVED, 1, work_face_name(work, old->origin[half / 3]));
}

/// Makes the quads of all pairs and single triangles.
static void emit(Pairs *pairs) {
    Work *work = pairs->work;
    const Faces *old = &work->faces;
    const uint32_t count = old->count;
    Faces out = work_faces(work, count, 4 * count);
    for (uint32_t t = 0; t < count && !work->no_memory; t++) {
        if (pairs->mate[t] == MESH_NONE) { // its longest open side is halved
            uint32_t longest = MESH_NONE;
            double max = -1;
            for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
                if (work->twin[h] != MESH_NONE) continue;
                double length = distance3(work->position[old->corner[h]], work->position[old->corner[pair_next3(h)]]);
                if (length > max) {
                    max = length;
                    longest = h;
                }
            }
            pair_halve(pairs, longest, &out);
            continue;
        }
        if (pairs->mate[t] < t) continue;

        const uint32_t half = shared_half(pairs, t), whole = pairs->whole[t];
        const bool was_quad = whole != MESH_NONE && pairs->whole[pairs->mate[t]] == whole;
        if (was_quad) { // stays as it was in the file
            for (uint32_t i = 0; i < 4; i++)
                faces_push(&out, pairs->before.corner[whole + i], &pairs->before, whole + i);
            faces_end(&out, old->origin[t]);
        } else if (pairs->good[pair_name(pairs, half)]) {
            const uint32_t ring[4] = {half, pair_last3(work->twin[half]), pair_next3(half), pair_last3(half)};
            for (int i = 0; i < 4; i++) faces_push(&out, old->corner[ring[i]], old, ring[i]);
            work_did(work, MESH_PAIRED, 1, work_face_name(work, old->origin[t]));
            faces_end(&out, old->origin[t]);
        } else {
            pair_halve(pairs, half, &out);
        }
    }

    work->faces = out;
}

bool mesh_pair(Work *work) {
    Pairs *pairs = work_new(work, 1, sizeof *pairs);
    if (!pairs) return true;
    pairs->work = work;
    if (!cut_faces(pairs)) return false;
    if (work->no_memory) return true;

    const Faces *faces = &work->faces;
    const uint32_t count = faces->corner_count, *from = pairs->from;
    uint32_t *side = work_new(work, pairs->before.corner_count, sizeof *side);
    work->face = work_new(work, count, sizeof *work->face);
    work->twin = work_new(work, count, sizeof *work->twin);
    if (work->no_memory) return true;

    // the twins of the triangles' sides: those of the faces in `before`, and for a diagonal its other side; by
    // half-edges and not by vertices, since a diagonal may have the same ends as another side
    for (uint32_t h = 0; h < count; h++) {
        work->face[h] = h / 3;
        if (faces_next(&pairs->before, pairs->before_face, from[h]) == from[pair_next3(h)]) side[from[h]] = h;
    }

    for (uint32_t h = 0; h < count; h++) {
        const uint32_t a = from[h], b = from[pair_next3(h)], face = pairs->before_face[a];
        work->twin[h] = MESH_NONE;
        if (faces_next(&pairs->before, pairs->before_face, a) == b) {
            if (pairs->before_twin[a] != MESH_NONE) work->twin[h] = side[pairs->before_twin[a]];
            continue;
        }

        // the same diagonal in the other triangle of its face
        uint32_t low = h - h % 3, high = low + 3;
        while (low > 0 && pairs->before_face[from[low - 1]] == face) low -= 3;
        while (high < count && pairs->before_face[from[high]] == face) high += 3;
        for (uint32_t g = low; g < high && work->twin[h] == MESH_NONE; g++)
            if (from[g] == b && from[pair_next3(g)] == a) work->twin[h] = g;
    }

    pairs->cost = work_new(work, count, sizeof *pairs->cost);
    pairs->good = work_new(work, count, 1);
    pairs->degree = work_new(work, work->vertex_count, sizeof *pairs->degree);
    pairs->rim = work_new(work, work->vertex_count, 1);
    if (work->no_memory) return true;

    work_mark_open(work, pairs->rim);
    for (uint32_t h = 0; h < count; h++) pairs->degree[faces->corner[h]]++;
    for (uint32_t h = 0; h < count; h++)
        if (work->twin[h] != MESH_NONE && h < work->twin[h]) cost_pair(pairs, h, work->twin[h]);

    const bool found = find_mates(pairs);
    if (work->no_memory) return true;
    if (found) emit(pairs);
    else work->faces = pairs->before;
    return found;
}
