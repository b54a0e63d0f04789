// Converts a surface for shading: fields packed by vertex; values that are not finite are repaired or left out.
//
// The gradient of burn in rest space is constant on a triangle: with edges e1, e2, N = e1 x e2, grad b = [(b1 - b0) e2
// x N + (b2 - b0) N x e1] / |N|^2; a vertex takes the mean of its triangles, weighted by area. Where the angles of a
// vertex's triangles in rest space fall short of 2 pi, it lies on the border of a piece.
//
// The appearance of a point runs from fresh (0) through black char (CHAR_LEAF) to ash (1). If pyrolysis leaves char that
// glows away later, it does not follow from the mass alone: with the fractions c of char, a of ash and f of fuel, and
// about half of the char staying as ash, q = c / (c + 2 a) is the share of what has burnt that is still char, and
//
//     look = q CHAR_LEAF (1 - f) + (1 - q) burn
//
// which is `burn` if there is one reaction, without char.

#include "preview/internal.h"
#include "preview/share.h"

#include <string.h>

static bool mesh_in_grow(Preview *preview, void *array_pointer, uint32_t *capacity, uint32_t count, size_t size) {
    void **array = array_pointer;
    if (count <= *capacity) return true;
    uint32_t wanted = count + count / 4 < count ? count : count + count / 4;
    if ((size_t)wanted > SIZE_MAX / size / 2) return false;

    void *grown = allocator_resize(preview->allocator, *array, *capacity * size, wanted * size);
    if (!grown) return false;
    *array = grown;
    *capacity = wanted;
    return true;
}

static float finite_or(float x, float otherwise) { return isfinite(x) ? x : otherwise; }

static bool near_enough(const float p[3]) {
    return fabsf(p[0]) < 1e4f && fabsf(p[1]) < 1e4f && fabsf(p[2]) < 1e4f; // false for NaN
}

/// Packs a vertex's fields and its position; if a shutter moves it, also its positions at both ends of the exposure.
static void pack_vertex(const Preview *preview, const SingeSurface *surface, uint32_t i) {
    const float zero[3] = {0, 0, 0};
    const float *rest = near_enough(surface->rest_position[i]) ? surface->rest_position[i] : zero;
    const float rate = clampf(finite_or(surface->burn_rate[i], 0), 0, 1e6f);
    Float3 normal = float3_unit_or(float3_load(surface->normal[i]), float3(0, 0, 0));
    PaperVertex *out = &preview->scene.vertices[i];
    *out = (PaperVertex){
        .normal = {normal.x, normal.y, normal.z},
        .rest = {rest[0], rest[1], rest[2]},
        .uv = {finite_or(surface->uv[i][0], 0), finite_or(surface->uv[i][1], 0)},
        .temperature = clampf(finite_or(surface->temperature[i], 293), 0, preview->def.hottest),
        .peak = clampf(finite_or(surface->temperature_peak[i], 293), 0, preview->def.hottest),
        .burn = clampf(finite_or(surface->burn[i], 0), 0, 1),
        .burn_rate = rate,
        .sheet = surface->sheet[i],
        .piece = surface->piece ? surface->piece[i] : -1,
        .water = surface->wet && surface->water ? clampf(finite_or(surface->water[i], 0), 0, 10) : 0,
    };

    // an unknown time of ignition counts as long ago
    if (surface->time_ignited && surface->time_ignited[i] >= 0)
        out->age = clampf((float)(preview->time - (double)surface->time_ignited[i]) * preview->def.pace, 0, 1e6f);
    else if (out->burn > 0) out->age = 60;

    const Ember ember = ember_at(surface, i, out->burn, rate);
    out->burn = ember.burn;
    out->flaming = out->feeds = ember.flaming;
    out->starved = ember.starved;

    if (preview->def.plain) {
        out->temperature = out->peak = 293;
        out->burn = out->burn_rate = out->flaming = out->feeds = out->starved = out->age = 0;
    }

    float *position = preview->scene.positions[i];
    for (int c = 0; c < 3; c++) position[c] = surface->position[i][c];
    position[3] = 0;
    const float *velocity = surface->velocity ? surface->velocity[i] : zero;

    for (int end = 0; preview->def.shutter > 0 && near_enough(position) && end < 2; end++) {
        float *moved = preview->scene.moved[end][i], half = (end ? 0.5f : -0.5f) * preview->def.shutter;
        for (int c = 0; c < 3; c++) moved[c] = position[c] + half * velocity[c];
        if (!near_enough(moved)) memcpy(moved, position, 3 * sizeof *moved);
        moved[3] = 0;
    }
}

typedef struct Packing {
    const Preview *preview;
    const SingeSurface *surface;
} Packing;

static void pack_part(void *context, int k) {
    const Packing *packing = context;
    const uint32_t all = packing->surface->vertex_count, end = share_first(all, k + 1, SHARE_PARTS);
    for (uint32_t i = share_first(all, k, SHARE_PARTS); i < end; i++)
        pack_vertex(packing->preview, packing->surface, i);
}

/// Gradient of a field with these values at the corners, times |N|^2.
static Float3 gradient(Float3 e1, Float3 e2, Float3 n, float f0, float f1, float f2) {
    return float3_mad(float3_scale(float3_cross(e2, n), f1 - f0), float3_cross(n, e1), f2 - f0);
}

static void add3(float sum[3], Float3 v, float weight) {
    sum[0] += weight * v.x;
    sum[1] += weight * v.y;
    sum[2] += weight * v.z;
}

static void bound_vertex(const float *p, Float3 *low, Float3 *high) {
    *low = float3(minf(low->x, p[0]), minf(low->y, p[1]), minf(low->z, p[2]));
    *high = float3(maxf(high->x, p[0]), maxf(high->y, p[1]), maxf(high->z, p[2]));
}

/// Adds the triangle's share of the gradients to its corners (times area into `slope`, `warming` and `bent`, the
/// area into `gradient`), and its angles to their `rim`.
static void add_triangle(PreviewScene *scene, const uint32_t t[3]) {
    PaperVertex *v[3] = {&scene->vertices[t[0]], &scene->vertices[t[1]], &scene->vertices[t[2]]};
    float bent2 = 0;
    for (int k = 0; k < 3; k++) {
        Float3 corner = float3_load(v[k]->rest);
        Float3 a = float3_sub(float3_load(v[(k + 1) % 3]->rest), corner);
        Float3 b = float3_sub(float3_load(v[(k + 2) % 3]->rest), corner);
        v[k]->rim += atan2f(float3_length(float3_cross(a, b)), float3_dot(a, b));
        const Float3 turn = float3_sub(float3_load(v[(k + 1) % 3]->normal), float3_load(v[k]->normal));
        bent2 = maxf(bent2, float3_dot(turn, turn) / maxf(float3_dot(a, a), 1e-8f));
    }

    Float3 origin = float3_load(v[0]->rest), e1 = float3_sub(float3_load(v[1]->rest), origin),
           e2 = float3_sub(float3_load(v[2]->rest), origin);
    Float3 n = float3_cross(e1, e2);
    float n2 = float3_dot(n, n);
    if (!(n2 > 1e-24f)) return;

    Float3 burn = gradient(e1, e2, n, v[0]->burn, v[1]->burn, v[2]->burn);
    Float3 heat = gradient(e1, e2, n, v[0]->peak, v[1]->peak, v[2]->peak);
    const float area = 0.5f * sqrtf(n2), bent = sqrtf(bent2);

    for (int k = 0; k < 3; k++) {
        add3(v[k]->slope, burn, area / n2);
        add3(v[k]->warming, heat, area / n2);
        v[k]->bent += area * bent;
        v[k]->gradient += area;
        v[k]->spacing += 1;
    }
}

/// The bounds of the triangles, and the pictures' texels per metre on them.
static void measure(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    Float3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t v = scene->triangles[t][k];
            bound_vertex(scene->positions[v], &low, &high);
            for (int end = 0; preview->def.shutter > 0 && end < 2; end++)
                bound_vertex(scene->moved[end][v], &low, &high);
        }
    if (!scene->triangle_count) low = high = float3(0, 0, 0);
    scene->epsilon = maxf(2e-4f * float3_length(float3_sub(high, low)), 1e-6f);
    Float3 margin = float3(scene->epsilon, scene->epsilon, scene->epsilon);
    scene->low = float3_sub(low, margin);
    scene->high = float3_add(high, margin);
    if (!scene->triangle_count) scene->epsilon = 1e-4f;

    for (uint32_t s = 0; s < 2 * preview->def.sheet_count; s++) {
        Texture *texture = &preview->textures[s];
        double texels = 0, area = 0;
        for (uint32_t t = 0; texture->count && t < scene->triangle_count; t++) {
            const PaperVertex *v = scene->vertices, *a = &v[scene->triangles[t][0]];
            const PaperVertex *b = &v[scene->triangles[t][1]], *c = &v[scene->triangles[t][2]];
            if (a->sheet != (int32_t)(s % preview->def.sheet_count)) continue;
            float bu = b->uv[0] - a->uv[0], bv = b->uv[1] - a->uv[1];
            float cu = c->uv[0] - a->uv[0], cv = c->uv[1] - a->uv[1];
            texels += fabs((double)bu * (double)cv - (double)bv * (double)cu);
            Float3 o = float3_load(a->rest);
            area += (double)float3_length(
                float3_cross(float3_sub(float3_load(b->rest), o), float3_sub(float3_load(c->rest), o)));
        }

        texels *= (double)texture->width[0] * (double)texture->height[0];
        texture->texels_per_metre = area > 0 && texels < 1e12 ? (float)sqrt(texels / area) : 0;
    }
}

/// Lists the sides of triangles that burn: only what is burnt has loose threads, embers and ash. Returns how many.
static uint32_t list_sides(PreviewScene *scene) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t i = scene->triangles[t][k], j = scene->triangles[t][(k + 1) % 3];
            const PaperVertex *a = &scene->vertices[i], *b = &scene->vertices[j];
            if (maxf(a->burn, b->burn) < BURNT_EDGE || (scene->edges[i] <= 0 && scene->edges[j] <= 0)) continue;
            if (i > j && scene->edges[i] > 0 && scene->edges[j] > 0) continue; // the triangle beside has it as well
            const Float3 side = float3_sub(float3_load(a->rest), float3_load(b->rest));
            scene->sides[count++] = (SurfaceSide){{i, j}, float3_length(side)};
        }
    return count;
}

/// The distance from the border of a piece, along sides of triangles, on what burns of a sheet.
static void find_edges(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        const PaperVertex *v = &scene->vertices[i];
        const Weave *weave = cloth_weave(preview, v->sheet);
        scene->edges[i] = v->rim >= 0.5f ? 0 : weave ? CLOTH_EDGE * weave->pitch : PAPER_EDGE;
    }

    // forwards and backwards by turns
    const uint32_t sides = list_sides(scene);
    bool changes = sides > 0;
    for (uint32_t pass = 0; changes; pass++) {
        changes = false;
        for (uint32_t i = 0; i < sides; i++) {
            const SurfaceSide *side = &scene->sides[pass & 1 ? sides - 1 - i : i];
            float *a = &scene->edges[side->ends[0]], *b = &scene->edges[side->ends[1]];
            if (fabsf(*a - *b) < 1e-6f) continue;
            float *far = *a > *b ? a : b, edge = (*a > *b ? *b : *a) + side->length;
            if (!(edge < *far)) continue;
            *far = edge;
            changes = true;
        }
    }
    for (uint32_t i = 0; i < scene->vertex_count; i++) scene->vertices[i].edge = scene->edges[i];
}

static SingeResult check_surface(const SingeSurface *surface, SingeError *error) {
    if (surface->vertex_count &&
        !(surface->position && surface->normal && surface->uv && surface->rest_position && surface->temperature &&
          surface->temperature_peak && surface->burn && surface->burn_rate && surface->sheet))
        return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the surface lacks an array that drawing needs");
    if (surface->triangle_count && !surface->triangles)
        return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the surface has a triangle count but no triangles");
    for (uint32_t t = 0; t < surface->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (surface->triangles[t][k] >= surface->vertex_count)
                return preview_fail(error, SINGE_ERROR_ARGUMENT, t, "triangle %u uses vertex %u of %u", t,
                                    surface->triangles[t][k], surface->vertex_count);

    return SINGE_OK;
}

SingeResult mesh_load(Preview *preview, const SingeSurface *surface, SingeError *error) {
    PreviewScene *scene = &preview->scene;
    scene->vertex_count = scene->triangle_count = scene->bvh.triangle_count = 0;
    TRY(check_surface(surface, error));

    const uint32_t vertices = surface->vertex_count;
    const size_t position = sizeof *scene->positions;
    bool moves = preview->def.shutter > 0;
    bool room =
        mesh_in_grow(preview, &scene->vertices, &scene->vertex_capacity, vertices, sizeof *scene->vertices) &&
        mesh_in_grow(preview, &scene->edges, &scene->edge_capacity, vertices, sizeof *scene->edges) &&
        mesh_in_grow(preview, &scene->positions, &scene->position_capacity, vertices, position) &&
        mesh_in_grow(preview, &scene->triangles, &scene->triangle_capacity, surface->triangle_count,
                     sizeof *scene->triangles) &&
        mesh_in_grow(preview, &scene->sides, &scene->side_capacity, 3 * surface->triangle_count, sizeof *scene->sides);
    for (int i = 0; room && moves && i < 2; i++)
        room = mesh_in_grow(preview, &scene->moved[i], &scene->moved_capacity[i], vertices, position);
    if (!room)
        return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a surface of %u vertices", vertices);

    share_out(preview->def.thread_count, SHARE_PARTS, pack_part, &(Packing){preview, surface});
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *from = surface->triangles[t];
        const float *p = surface->position[from[0]], *q = surface->position[from[1]], *r = surface->position[from[2]];
        Float3 a = float3_load(p), n = float3_cross(float3_sub(float3_load(q), a), float3_sub(float3_load(r), a));
        if (!near_enough(p) || !near_enough(q) || !near_enough(r) || !(float3_dot(n, n) > 1e-30f)) continue;
        uint32_t *kept = scene->triangles[scene->triangle_count++];
        memcpy(kept, from, sizeof *scene->triangles);
        add_triangle(scene, kept);
    }

    scene->vertex_count = vertices;
    for (uint32_t i = 0; i < vertices; i++) {
        PaperVertex *v = &scene->vertices[i];

        // a triangle of area A has edges of about sqrt(2 A)
        v->spacing = v->spacing > 0 ? sqrtf(2 * v->gradient / v->spacing) : 0;
        v->bent = v->gradient > 0 ? v->bent / v->gradient : 0;
        v->heat_gradient = v->gradient > 0 ? float3_length(float3_load(v->warming)) / v->gradient : 0;
        v->gradient = v->gradient > 0 ? float3_length(float3_load(v->slope)) / v->gradient : 0;
        v->rim = 1 - stepf(1.6f * PI_F, 1.95f * PI_F, v->rim);

        // no triangle of the scene uses these; the builder still reads them
        float *p = scene->positions[i];
        if (near_enough(p)) continue;
        p[0] = p[1] = p[2] = 0;
        for (int end = 0; moves && end < 2; end++) memset(scene->moved[end][i], 0, sizeof *scene->moved[end]);
    }

    crumple_load(preview);
    find_edges(preview);
    rumple_char(preview);
    measure(preview);
    return SINGE_OK;
}

void paper_state(const PreviewScene *scene, uint32_t triangle, float u, float v, PaperState *state) {
    const uint32_t *t = scene->triangles[triangle];
    const PaperVertex *a = &scene->vertices[t[0]], *b = &scene->vertices[t[1]], *c = &scene->vertices[t[2]];
    float w = 1 - u - v, min = minf(a->rim, minf(b->rim, c->rim));
    *state = (PaperState){
        .rest = float3_blend(a->rest, b->rest, c->rest, u, v),
        .uv = {w * a->uv[0] + u * b->uv[0] + v * c->uv[0], w * a->uv[1] + u * b->uv[1] + v * c->uv[1]},
        .temperature = w * a->temperature + u * b->temperature + v * c->temperature,
        .peak = w * a->peak + u * b->peak + v * c->peak,
        .burn = w * a->burn + u * b->burn + v * c->burn,
        .burn_rate = w * a->burn_rate + u * b->burn_rate + v * c->burn_rate,
        .glowing = w * (a->burn_rate - a->flaming) + u * (b->burn_rate - b->flaming) + v * (c->burn_rate - c->flaming),
        .starved = w * a->starved + u * b->starved + v * c->starved,
        .gradient = w * a->gradient + u * b->gradient + v * c->gradient,
        .heat_gradient = w * a->heat_gradient + u * b->heat_gradient + v * c->heat_gradient,
        .spacing = w * a->spacing + u * b->spacing + v * c->spacing,
        .age = w * a->age + u * b->age + v * c->age,
        // a triangle without inner corner has no distance information: a strip or a crumb, which should remain
        .rim = min > 0.5f ? 0.25f : w * a->rim + u * b->rim + v * c->rim,
        .sheet = a->sheet,
        .piece = a->piece,
        .water = w * a->water + u * b->water + v * c->water,
        .edge = min > 0.5f ? 0.5f * a->spacing : w * a->edge + u * b->edge + v * c->edge,
    };
}

SingeResult tracer_load(Preview *preview, const SingeSurface *surface, SingeError *error) {
    SingeResult result = mesh_load(preview, surface, error);
    return result ? result : tracer_build(preview, error);
}

void tracer_free(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    bvh_free(&scene->bvh, preview->allocator);
    allocator_resize(preview->allocator, scene->vertices, scene->vertex_capacity * sizeof *scene->vertices, 0);
    allocator_resize(preview->allocator, scene->positions, scene->position_capacity * sizeof *scene->positions, 0);
    for (int end = 0; end < 2; end++)
        allocator_resize(preview->allocator, scene->moved[end], scene->moved_capacity[end] * sizeof *scene->moved[end],
                         0);
    allocator_resize(preview->allocator, scene->triangles, scene->triangle_capacity * sizeof *scene->triangles, 0);
    allocator_resize(preview->allocator, scene->edges, scene->edge_capacity * sizeof *scene->edges, 0);
    allocator_resize(preview->allocator, scene->sides, scene->side_capacity * sizeof *scene->sides, 0);
    *scene = (PreviewScene){0};
}
