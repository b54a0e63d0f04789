// Triangles joined to quads. Polygons of five corners and more are cut into triangles first, and quads of a mixed mesh
// into pairs that are joined already (pair_triangles.c).
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
#include "mesh/pair.h"

#include <math.h>

#define DEGREES (180 / 3.14159265358979323846)
static const double angle_max = 175, fold_max = 60, straight_gain = 0.5, straight_within = 60;

// ---- what a pair costs

static uint32_t pair_next3(uint32_t half) { return half - half % 3 + (half + 1) % 3; }
static uint32_t pair_last3(uint32_t half) { return half - half % 3 + (half + 2) % 3; }
static uint32_t pair_name(const Pairs *pairs, uint32_t half) {
    uint32_t twin = pairs->work->twin[half];
    return twin < half ? twin : half;
}

/// The angle of a half-edge's triangle at the corner where the half-edge begins.
static double corner_angle(const Pairs *pairs, uint32_t half) {
    const uint32_t *corner = pairs->work->faces.corner;
    return pair_angle(pairs->work, corner[pair_last3(half)], corner[half], corner[pair_next3(half)]);
}

static double fold_between(const Pairs *pairs, uint32_t a, uint32_t b) {
    double n[3], m[3];
    face_area(pairs->work, a, n), face_area(pairs->work, b, m);
    double square = dot3(n, n) * dot3(m, m);
    return square > 0 ? DEGREES * acos(fmax(-1, fmin(1, dot3(n, m) / sqrt(square)))) : 180;
}

static bool is_seam(const Pairs *pairs, uint32_t half, uint32_t twin) {
    float(*uv)[2] = pairs->work->faces.uv;
    if (!uv) return false;
    uint32_t a = pair_next3(twin), b = pair_next3(half);
    return uv[half][0] != uv[a][0] || uv[half][1] != uv[a][1] || uv[b][0] != uv[twin][0] || uv[b][1] != uv[twin][1];
}

static void cost_pair(Pairs *pairs, uint32_t half, uint32_t twin) {
    const uint32_t *corner = pairs->work->faces.corner;
    double angle[4] = {corner_angle(pairs, half) + corner_angle(pairs, pair_next3(twin)),
                       corner_angle(pairs, pair_next3(half)) + corner_angle(pairs, twin),
                       corner_angle(pairs, pair_last3(half)), corner_angle(pairs, pair_last3(twin))};
    double worst = 0, max = 0, fold = fold_between(pairs, half / 3, twin / 3);
    for (int i = 0; i < 4; i++) worst = fmax(worst, fabs(angle[i] - 90)), max = fmax(max, angle[i]);
    bool thin_fan = corner[pair_last3(half)] == corner[pair_last3(twin)]; // an interior vertex must keep three cells
    for (int i = 0; i < 2; i++) {
        uint32_t v = corner[i ? pair_next3(half) : half];
        thin_fan = thin_fan || (!pairs->rim[v] && pairs->degree[v] <= 3);
    }
    pairs->cost[half] = worst + fold;
    pairs->good[half] = max <= angle_max && fold <= fold_max && !thin_fan && !is_seam(pairs, half, twin);
}

static void cost_all(Pairs *pairs) {
    Work *work = pairs->work;
    const Faces *faces = &work->faces;
    pairs->cost = work_new(work, faces->corner_count, sizeof *pairs->cost);
    pairs->good = work_new(work, faces->corner_count, 1);
    pairs->degree = work_new(work, work->vertex_count, sizeof *pairs->degree);
    pairs->rim = work_new(work, work->vertex_count, 1);
    if (work->no_memory) return;
    work_mark_open(work, pairs->rim);
    for (uint32_t h = 0; h < faces->corner_count; h++) pairs->degree[faces->corner[h]]++;
    for (uint32_t h = 0; h < faces->corner_count; h++)
        if (work->twin[h] != MESH_NONE && h < work->twin[h]) cost_pair(pairs, h, work->twin[h]);
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

/// The gain of the pair across `half` from continuing the rows of the quads around it.
static double pair_gain(const Pairs *pairs, uint32_t half) {
    const Work *work = pairs->work;
    uint32_t twin = work->twin[half];
    double gain = 0;
    for (int i = 0; i < 4; i++) {
        uint32_t inner = i < 2 ? half : twin, other = i < 2 ? twin : half;
        uint32_t side = i & 1 ? pair_next3(inner) : pair_last3(inner), across = work->twin[side];
        if (across == MESH_NONE || pairs->mate[across / 3] == MESH_NONE) continue;
        uint32_t shared = shared_half(pairs, across / 3);
        if (shared == MESH_NONE || shared == across) continue;
        uint32_t shared_twin = work->twin[shared];
        double from =
            quad_angle(pairs, side, inner, other) + quad_angle(pairs, pair_next3(across), shared, shared_twin);
        double to = quad_angle(pairs, pair_next3(side), inner, other) + quad_angle(pairs, across, shared, shared_twin);
        gain += fmax(0, straight_within - 0.5 * (fabs(from - 180) + fabs(to - 180)));
    }
    return straight_gain * gain;
}

/// Offers the pairs of a single triangle.
static void offer(Pairs *pairs, uint32_t triangle) {
    const Work *work = pairs->work;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        if (work->twin[h] == MESH_NONE || pairs->mate[work->twin[h] / 3] != MESH_NONE) continue;
        uint32_t name = pair_name(pairs, h);
        if (pairs->good[name])
            pair_heap_push(pairs->work, &pairs->heap, (PairItem){pairs->cost[name] - pair_gain(pairs, name), name});
    }
}

static void offer_around(Pairs *pairs, uint32_t triangle) {
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        uint32_t across = pairs->work->twin[h];
        if (across != MESH_NONE && pairs->mate[across / 3] == MESH_NONE) offer(pairs, across / 3);
    }
}

static void join_cheapest(Pairs *pairs) {
    const Work *work = pairs->work;
    for (uint32_t t = 0; t < work->faces.count; t++)
        if (pairs->mate[t] == MESH_NONE) offer(pairs, t);
    while (pairs->heap.count && !work->no_memory) {
        uint32_t half = pair_heap_pop(&pairs->heap).half, a = half / 3, b = work->twin[half] / 3;
        if (pairs->mate[a] != MESH_NONE || pairs->mate[b] != MESH_NONE) continue;
        pairs->mate[a] = b;
        pairs->mate[b] = a;
        offer_around(pairs, a);
        offer_around(pairs, b);
    }
}

// ---- triangles that stay single

static bool any_alone(const Pairs *pairs) {
    for (uint32_t t = 0; t < pairs->work->faces.count; t++)
        if (pairs->mate[t] == MESH_NONE) return true;
    return false;
}

/// Grows the matching over the graph of good pairs, or of all pairs.
static void pair_grow(Pairs *pairs, bool all, const uint8_t *open) {
    Work *work = pairs->work;
    const uint32_t count = work->faces.count;
    uint32_t *first = work_new(work, (size_t)count + 1, sizeof *first);
    uint32_t *to = work_new(work, work->faces.corner_count, sizeof *to);
    if (work->no_memory || !any_alone(pairs)) return;
    for (uint32_t t = 0, total = 0; t < count; t++) {
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++)
            if (work->twin[h] != MESH_NONE && (all || pairs->good[pair_name(pairs, h)]))
                to[total++] = work->twin[h] / 3;
        first[t + 1] = total;
    }
    match_grow(work, count, first, to, open, pairs->mate);
}

/// The best open side of a triangle to halve: the longest.
static uint32_t open_side(const Pairs *pairs, uint32_t triangle) {
    const Work *work = pairs->work;
    uint32_t best = MESH_NONE;
    double max = -1;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        if (work->twin[h] != MESH_NONE) continue;
        double length =
            distance3(work->position[work->faces.corner[h]], work->position[work->faces.corner[pair_next3(h)]]);
        if (length > max) {
            max = length;
            best = h;
        }
    }
    return best;
}

static bool find_mates(Pairs *pairs) {
    Work *work = pairs->work;
    uint8_t *open = work_new(work, work->faces.count, 1);
    if (work->no_memory) return true;
    for (uint32_t h = 0; h < work->faces.corner_count; h++) open[h / 3] |= work->twin[h] == MESH_NONE;
    join_cheapest(pairs);
    pair_grow(pairs, false, NULL);
    pair_grow(pairs, false, open);
    pair_grow(pairs, true, open);
    for (uint32_t t = 0; t < work->faces.count && !work->no_memory; t++)
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

/// Pushes a pair as a quad; a pair that was a quad of the file, as it was.
static void push_quad(Pairs *pairs, uint32_t half, Faces *out) {
    Work *work = pairs->work;
    const Faces *old = &work->faces;
    const uint32_t twin = work->twin[half], whole = pairs->whole[half / 3];
    if (whole != MESH_NONE && pairs->whole[twin / 3] == whole) {
        for (uint32_t i = 0; i < 4; i++) faces_push(out, pairs->before.corner[whole + i], &pairs->before, whole + i);
    } else {
        const uint32_t ring[4] = {half, pair_last3(twin), pair_next3(half), pair_last3(half)};
        for (int i = 0; i < 4; i++) faces_push(out, old->corner[ring[i]], old, ring[i]);
        work_did(work, MESH_PAIRED, 1, work_face_name(work, old->origin[half / 3]));
    }
    faces_end(out, old->origin[half / 3]);
}

static void emit(Pairs *pairs) {
    Work *work = pairs->work;
    const uint32_t count = work->faces.count;
    Faces out = work_faces(work, count, 4 * count);
    for (uint32_t t = 0; t < count && !work->no_memory; t++) {
        if (pairs->mate[t] == MESH_NONE) {
            pair_halve(pairs, open_side(pairs, t), &out);
            continue;
        }
        if (pairs->mate[t] < t) continue;
        uint32_t half = shared_half(pairs, t), whole = pairs->whole[t];
        bool was_quad = whole != MESH_NONE && pairs->whole[pairs->mate[t]] == whole;
        if (was_quad || pairs->good[pair_name(pairs, half)]) push_quad(pairs, half, &out);
        else pair_halve(pairs, half, &out);
    }
    work->faces = out;
}

bool mesh_pair(Work *work) {
    Pairs *pairs = work_new(work, 1, sizeof *pairs);
    if (!pairs) return true;
    pairs->work = work;
    if (!pair_cut_faces(pairs)) return false;
    if (!work->no_memory) pair_find_twins(pairs);
    if (!work->no_memory) cost_all(pairs);
    if (work->no_memory) return true;
    bool found = find_mates(pairs);
    if (work->no_memory) return true;
    if (found) emit(pairs);
    else work->faces = pairs->before;
    return found;
}
