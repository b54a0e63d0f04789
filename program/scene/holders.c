// What holds sheets, in pictures: where pins hold edges, and how what holds them moves. Their triangles are made in
// program/preview/holder.c.
//
// Vertices that a pin holds, and those next to them, are a part if cells join them. Of its edges those count that face the
// same way, upwards if some do.
#include "common/curves.h"
#include "common/float3.h"
#include "common/store.h"
#include "common/order.h"
#include "scene/assets.h"
#include "scene/scene.h"
#include "scene/space.h"

#include <stdlib.h>
#include <string.h>

#define ROD_NEAR 0.06f ///< m, from a capsule's axis to rings that hang from it

/// A side of a cell that is held. That of only one cell is of the sheet's edge.
typedef struct Side {
    uint32_t root, ends[2];
    Float3 middle, along, out, normal; ///< m; away from the cell and unit, twice the cell's area
} Side;

/// A part of an edge.
typedef struct Grip {
    PreviewHeld held;
    uint32_t pin;
    int32_t rod;  ///< a ring's: a collider, or -1
    Float3 hangs; ///< m, what hangs from a ring
    bool lined;
} Grip;

typedef struct Holding {
    const Scene *scene;
    SceneAssets *assets;
    Grip *grips;
    uint32_t grip_count;
    size_t grip_room, holder_room;
} Holding;

// ---- parts of edges

static uint32_t root_of(uint32_t *parent, uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

static Float3 vertex_at(const Mesh *mesh, uint32_t v) { return float3_load(mesh->positions + 3 * (size_t)v); }

#define FREE UINT32_MAX       ///< neither held nor beside what is
#define HELD (UINT32_MAX - 1) ///< for now

/// Makes each vertex that the pin holds, and those next to them, a part of its own: where it holds the inside of a sheet, its
/// edge may be beside that. Others are FREE.
static void mark_held(const ScenePin *pin, const Mesh *mesh, uint32_t *parent) {
    memset(parent, 0xff, mesh->vertex_count * sizeof *parent);
    for (uint32_t i = 0; i < pin->vertex_count; i++) {
        const uint32_t v = pin->vertices[i], at = mesh->became && v < mesh->source_count ? mesh->became[v] : v;
        if (at < mesh->vertex_count) parent[at] = HELD;
    }

    for (uint32_t i = 0; i < pin->point_count && mesh->vertex_count; i++) {
        uint32_t nearest = 0;
        double least = INFINITY;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            const double distance = distance_of(pin->points[i].position, mesh->positions + 3 * (size_t)v);
            if (distance <= (double)pin->radius) parent[v] = HELD;
            if (!(distance < least)) continue;
            least = distance;
            nearest = v;
        }
        parent[nearest] = HELD;
    }

    for (size_t k = 0; k < 4 * (size_t)mesh->cell_count; k++) {
        const uint32_t *cell = mesh->cells + k / 4 * 4;
        for (int i = 0; i < 4 && parent[cell[k % 4]] == HELD; i++)
            if (parent[cell[i]] == FREE) parent[cell[i]] = cell[i];
    }

    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (parent[v] == HELD) parent[v] = v;
}

/// Joins the parts that cells join, and lists the held sides of the sheet's edge, those of a part together. NULL without
/// memory.
static Side *find_sides(const Mesh *mesh, uint32_t *parent, uint32_t *count) {
    size_t room = 0, used = 0, kept = 0;
    Side *sides = NULL;
    for (uint32_t c = 0; c < mesh->cell_count; c++) {
        const uint32_t *cell = mesh->cells + 4 * (size_t)c;
        Float3 middle = {0, 0, 0};
        for (int k = 0; k < 4; k++) middle = float3_mad(middle, vertex_at(mesh, cell[k]), 0.25f);

        const Float3 normal = float3_cross(float3_sub(vertex_at(mesh, cell[2]), vertex_at(mesh, cell[0])),
                                           float3_sub(vertex_at(mesh, cell[3]), vertex_at(mesh, cell[1])));
        for (int k = 0; k < 4; k++) {
            const uint32_t a = cell[k], b = cell[(k + 1) % 4];
            if (a == b || parent[a] == FREE || parent[b] == FREE) continue;
            parent[root_of(parent, a)] = root_of(parent, b);
            if (!store_grow((SingeAllocator){0}, &sides, &room, used + 1, sizeof *sides)) return NULL;

            Side *side = &sides[used++];
            *side = (Side){.ends = {a < b ? a : b, a < b ? b : a}, .normal = normal};
            side->along = float3_sub(vertex_at(mesh, b), vertex_at(mesh, a));
            side->middle = float3_mad(vertex_at(mesh, a), side->along, 0.5f);
            side->out = float3_unit(float3_cross(side->along, normal));
            if (float3_dot(side->out, float3_sub(side->middle, middle)) < 0) side->out = float3_scale(side->out, -1);
        }
    }

    if (used) qsort(sides, used, sizeof *sides, order_by_three);
    for (size_t i = 0, next; i < used; i = next) {
        for (next = i + 1; next < used && order_by_three(&sides[i], &sides[next]) == 0;) next++;
        if (next > i + 1) continue; // of two cells
        sides[kept] = sides[i];
        sides[kept++].root = root_of(parent, sides[i].ends[0]);
    }

    if (kept) qsort(sides, kept, sizeof *sides, order_by_three);
    *count = (uint32_t)kept;
    return sides ? sides : calloc(1, sizeof *sides);
}

/// What is held, from the sides of a part: those that face the way that most do; those that face upwards count more. False if
/// none has a length.
static bool held_of(const Side *sides, uint32_t count, PreviewHeld *held) {
    Float3 out = {0, 0, 0};
    float most = 0;
    for (uint32_t i = 0; i < count; i++) {
        Float3 sum = {0, 0, 0};
        for (uint32_t j = 0; j < count; j++)
            if (float3_dot(sides[i].out, sides[j].out) > 0.8f)
                sum = float3_mad(sum, sides[j].out, float3_length(sides[j].along));
        const float size = float3_length(sum) * (1 + 3 * fmaxf(sides[i].out.z, 0));
        if (size > most * 1.0001f) out = float3_unit(sum);
        most = fmaxf(most, size);
    }
    if (!(most > 0)) return false;

    Float3 normal = {0, 0, 0}, middle = {0, 0, 0};
    float length = 0, low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        if (float3_dot(sides[i].out, out) <= 0.8f) continue;
        const float weight = float3_length(sides[i].along);
        normal = float3_add(normal, sides[i].normal);
        middle = float3_mad(middle, sides[i].middle, weight);
        length += weight;
    }
    middle = float3_scale(middle, 1 / length);

    const Float3 along = float3_unit(float3_cross(normal, out));
    for (uint32_t i = 0; i < count; i++) {
        if (float3_dot(sides[i].out, out) <= 0.8f) continue;
        const float at = float3_dot(float3_sub(sides[i].middle, middle), along),
                    half = 0.5f * float3_length(sides[i].along);
        low = fminf(low, at - half);
        high = fmaxf(high, at + half);
    }

    float3_store(held->at, float3_mad(middle, along, 0.5f * (low + high)));
    float3_store(held->along, along);
    float3_store(held->over, float3_cross(out, along));
    float3_store(held->out, out);
    held->width = high - low;
    return true;
}

// ---- motion

/// Carries a point of the start with its pin; with `axes`, also directions.
static Float3 carry(const ScenePin *pin, double time, Float3 p, Float3 axes[2]) {
    if (!pin->key_count) return p;
    PreviewShape start, now;
    keys_pose(pin->keys, pin->key_count, 0, &start);
    keys_pose(pin->keys, pin->key_count, time, &now);
    for (int k = 0; k < 2 && axes; k++) axes[k] = quat_rotate(now.rotation, quat_unrotate(start.rotation, axes[k]));
    const Float3 from = quat_unrotate(start.rotation, float3_sub(p, float3_load(start.position)));
    return float3_add(float3_load(now.position), quat_rotate(now.rotation, from));
}

void holder_pose(const Scene *scene, const SceneHolder *holder, double time, PreviewShape *shape) {
    *shape = holder->part.shape;
    if (holder->pin < 0) return;

    const ScenePin *pin = &scene->pins[holder->pin];
    Float3 axes[2] = {quat_rotate(shape->rotation, float3(1, 0, 0)), quat_rotate(shape->rotation, float3(0, 1, 0))};
    Float3 at = carry(pin, time, float3_load(shape->position), holder->swings ? NULL : axes);
    if (holder->swings) {
        at = float3_load(shape->position);
        if (holder->rod >= 0) {
            PreviewShape rod;
            keys_pose(scene->colliders[holder->rod].keys, scene->colliders[holder->rod].key_count, time, &rod);
            const Float3 axis = quat_rotate(rod.rotation, float3(0, 0, 1));
            axes[1] = float3_dot(axis, axes[1]) < 0 ? float3_scale(axis, -1) : axis;
            at = float3_load(rod.position);
        }

        const Float3 p = carry(pin, time, float3_load(holder->at), NULL);
        at = float3_mad(at, axes[1], float3_dot(float3_sub(p, at), axes[1]));
        const Float3 x = float3_sub(at, p);
        if (float3_dot(x, x) > 0) axes[0] = float3_unit(x);
    }

    float3_store(shape->position, at);
    quat_of_axes(axes[0], axes[1], float3_cross(axes[0], axes[1]), shape->rotation);
}

// ---- rings

/// Hangs a ring from the nearest capsule, or from a rod above it, by its greatest distance from that.
static void hang(const Scene *scene, Grip *grip) {
    PreviewHeld *held = &grip->held;
    const Float3 p = float3_load(held->at);
    Float3 axis = float3_load(held->along), at = float3_mad(p, float3_load(held->out), 0.015f * held->scale);
    float nearest = ROD_NEAR;

    grip->rod = -1;
    grip->hangs = p;

    held->rod = 0.005f * held->scale;
    for (uint32_t i = 0; i < scene->collider_count; i++) {
        const SceneCollider *collider = &scene->colliders[i];
        if (collider->def.kind != SINGE_COLLIDER_CAPSULE) continue;

        PreviewShape pose;
        keys_pose(collider->keys, collider->key_count, 0, &pose);
        const Float3 way = quat_rotate(pose.rotation, float3(0, 0, 1)),
                     from = float3_sub(p, float3_load(pose.position));
        const float along = float3_dot(from, way), away = float3_length(float3_mad(from, way, -along));
        if (!(away < nearest) || !(away > collider->def.radius) ||
            fabsf(along) > 0.5f * collider->def.height + ROD_NEAR)
            continue;

        nearest = away;
        grip->rod = (int32_t)i;
        axis = float3_dot(way, float3_load(held->along)) < 0 ? float3_scale(way, -1) : way;
        at = float3_mad(float3_load(pose.position), way, along);
        held->rod = collider->def.radius;
    }

    const ScenePin *pin = &scene->pins[grip->pin];
    held->drop = 0;
    for (uint32_t k = 0; k <= pin->key_count; k++) {
        const Float3 d = float3_sub(carry(pin, k ? (double)pin->keys[k - 1].time : 0, p, NULL), at);
        held->drop = fmaxf(held->drop, float3_length(float3_mad(d, axis, -float3_dot(d, axis))));
    }

    const Float3 out = float3_unit(float3_sub(at, p));
    float3_store(held->along, axis);
    float3_store(held->out, out);
    float3_store(held->over, float3_cross(out, axis));
    float3_store(held->at, float3_mad(at, out, -held->drop));
}

// ---- all of them

/// Lists the parts of edges that a pin holds.
static bool find_grips(Holding *h, uint32_t index, uint32_t *parent) {
    const ScenePin *pin = &h->scene->pins[index];
    const Mesh *mesh = &h->assets->meshes[pin->sheet_index];
    uint32_t count = 0;
    mark_held(pin, mesh, parent);

    Side *sides = find_sides(mesh, parent, &count);
    bool good = sides;
    Box box = BOX_EMPTY;
    box_add_points(&box, mesh->positions, mesh->vertex_count);

    const double *low = box.low, *high = box.high;
    const float diagonal =
        float3_length(float3((float)(high[0] - low[0]), (float)(high[1] - low[1]), (float)(high[2] - low[2])));
    for (uint32_t i = 0, next; i < count && good; i = next) {
        for (next = i + 1; next < count && sides[next].root == sides[i].root;) next++;
        PreviewHeld held = {.scale = 1};
        if (!held_of(sides + i, next - i, &held)) continue;
        good = store_grow((SingeAllocator){0}, &h->grips, &h->grip_room, h->grip_count + (size_t)1, sizeof *h->grips);
        if (!good) break;

        Grip *grip = &h->grips[h->grip_count++];
        *grip = (Grip){.held = held, .pin = index, .rod = -1};
        const float size = fmaxf(grip->held.width, 2 * pin->radius) / 0.012f;
        grip->held.scale = clampf(fminf(size, diagonal / 0.15f), 0.1f, 1);
        grip->held.reach = 2.5f * diagonal;
        if (pin->holder == PREVIEW_HOLDER_RING) hang(h->scene, grip);
    }
    free(sides);

    return good;
}

#define CLIP_GAPE 0.02f ///< m, the most from one sheet in a clip to the next

/// Whether a clip that has the sheets of `a` between its jaws can have those of `b`, too: they lie before or behind them.
static bool share_clip(const Scene *scene, const Grip *a, const Grip *b) {
    const ScenePin *one = &scene->pins[a->pin], *other = &scene->pins[b->pin];
    const bool moves = one->key_count || other->key_count;
    if (one->holder != PREVIEW_HOLDER_CLIP || other->holder != PREVIEW_HOLDER_CLIP || moves) return false;

    const Float3 over = float3_load(a->held.over), way = float3_sub(float3_load(b->held.at), float3_load(a->held.at));
    const float before = float3_dot(way, over), aside = float3_length(float3_mad(way, over, -before));
    return fabsf(float3_dot(over, float3_load(b->held.over))) > 0.9f &&
           float3_dot(float3_load(a->held.out), float3_load(b->held.out)) > 0.8f &&
           fabsf(before) < 0.5f * a->held.gape + CLIP_GAPE * a->held.scale && aside < 0.5f * a->held.width;
}

/// Makes one clip of those whose sheets lie one before the other.
static void join_clips(Holding *h) {
    for (uint32_t i = 0; i < h->grip_count; i++)
        for (uint32_t k = i + 1; k < h->grip_count; k++) {
            PreviewHeld *held = &h->grips[i].held;
            if (!share_clip(h->scene, &h->grips[i], &h->grips[k])) continue;
            const PreviewHeld *more = &h->grips[k].held;
            const Float3 over = float3_load(held->over), at = float3_load(held->at);
            const float before = float3_dot(float3_sub(float3_load(more->at), at), over), half = 0.5f * held->gape;
            const float low = fminf(-half, before), high = fmaxf(half, before);
            const Float3 out = float3_add(float3_load(held->out), float3_load(more->out));
            const Float3 along = float3_unit(float3_cross(out, over));
            float3_store(held->at, float3_mad(at, over, 0.5f * (low + high)));
            float3_store(held->out, float3_cross(over, along));
            float3_store(held->along,
                         float3_dot(along, float3_load(held->along)) < 0 ? float3_scale(along, -1) : along);
            held->width = fmaxf(held->width, more->width);
            held->gape = high - low;
            memmove(&h->grips[k], &h->grips[k + 1], (--h->grip_count - k) * sizeof *h->grips);
            k = i; // sheets that were too far from it may be near enough now
        }
}

static bool add_part(Holding *h, const PreviewHolderPart *part, const Grip *grip, bool still) {
    SceneAssets *assets = h->assets;
    const bool ring = h->scene->pins[grip->pin].holder == PREVIEW_HOLDER_RING;

    if (!part->solid.triangle_count || !store_grow((SingeAllocator){0}, &assets->holders, &h->holder_room,
                                                   assets->holder_count + (size_t)1, sizeof *assets->holders)) {
        free(part->solid.vertices);
        free(part->solid.triangles);
        return !part->solid.triangle_count;
    }

    SceneHolder *holder = &assets->holders[assets->holder_count++];
    *holder = (SceneHolder){
        .part = *part, .pin = still ? -1 : (int32_t)grip->pin, .rod = grip->rod, .swings = ring && !still};
    float3_store(holder->at, grip->hangs);
    return true;
}

/// Whether two parts share a cord or a rod.
static bool share_line(const Scene *scene, const Grip *a, const Grip *b) {
    const ScenePin *one = &scene->pins[a->pin], *other = &scene->pins[b->pin];
    const bool moves = one->holder != PREVIEW_HOLDER_RING && (one->key_count || other->key_count);
    if (one->holder != other->holder || a->rod != b->rod || (moves && a->pin != b->pin)) return false;

    const Float3 along = float3_load(a->held.along),
                 from = float3_mad(float3_load(a->held.at), float3_load(a->held.out), a->held.drop),
                 to = float3_mad(float3_load(b->held.at), float3_load(b->held.out), b->held.drop);
    const Float3 way = float3_sub(to, from);
    return float3_length(float3_cross(along, float3_load(b->held.along))) < 0.3f &&
           float3_length(float3_cross(along, way)) < 0.1f * float3_length(way) + 0.005f * a->held.scale;
}

static int by_place(const void *a, const void *b) {
    const PreviewHeld *s = a, *t = b;
    const float way = float3_dot(float3_load(s->along), float3_sub(float3_load(s->at), float3_load(t->at)));
    return way < 0 ? -1 : way > 0;
}

/// Adds the cord or the rod of a part and those that share it. `held` has room for all.
static bool add_line(Holding *h, Grip *grip, PreviewHeld *held) {
    const Scene *scene = h->scene;
    const ScenePin *pin = &scene->pins[grip->pin];
    uint32_t count = 0;
    if (grip->lined) return true;

    for (uint32_t i = 0; i < h->grip_count; i++) {
        if (h->grips[i].lined || !share_line(scene, grip, &h->grips[i])) continue;
        h->grips[i].lined = true;
        held[count] = h->grips[i].held;
        memcpy(held[count++].along, grip->held.along, sizeof held->along);
    }

    if (grip->rod >= 0 && scene->colliders[grip->rod].visible) return true;
    qsort(held, count, sizeof *held, by_place);
    PreviewHolderPart part;
    const bool good = preview_holder_line((PreviewHolder)pin->holder, held, count, &part);
    return add_part(h, &part, grip, pin->holder == PREVIEW_HOLDER_RING) && good;
}

bool holders_make(const Scene *scene, SceneAssets *assets) {
    Holding h = {.scene = scene, .assets = assets};
    uint32_t most = 0;
    for (uint32_t s = 0; s < scene->sheet_count; s++)
        most = assets->meshes[s].vertex_count > most ? assets->meshes[s].vertex_count : most;

    uint32_t *parent = malloc((most + (size_t)1) * sizeof *parent);
    bool good = parent;
    for (uint32_t i = 0; i < scene->pin_count && good; i++)
        if (scene->pins[i].holder) good = find_grips(&h, i, parent);

    join_clips(&h);
    PreviewHeld *held = malloc((h.grip_count + (size_t)1) * sizeof *held);
    good = good && held;
    for (uint32_t i = 0; i < h.grip_count && good; i++) {
        PreviewHolderPart parts[PREVIEW_HOLDER_PARTS];
        const PreviewHolder holder = (PreviewHolder)scene->pins[h.grips[i].pin].holder;
        good = preview_holder_grip(holder, &h.grips[i].held, i, parts);
        for (int k = 0; k < PREVIEW_HOLDER_PARTS; k++) good = add_part(&h, &parts[k], &h.grips[i], false) && good;
    }
    for (uint32_t i = 0; i < h.grip_count && good; i++) good = add_line(&h, &h.grips[i], held);
    free(held);
    free(parent);
    free(h.grips);
    return good;
}

void holders_free(SceneAssets *assets) {
    for (uint32_t i = 0; i < assets->holder_count; i++) {
        free(assets->holders[i].part.solid.vertices);
        free(assets->holders[i].part.solid.triangles);
    }
    free(assets->holders);
}
