// Char of cloth does not lie as smoothly as its cells: it shrinks unevenly, so it buckles over centimetres and puckers between,
// and its borders curl. Vertices go along their normals by noise of the rest position, which moves with the cloth; no farther
// than something lies there.

#include "preview/internal.h"

#include <string.h>

#define BUCKLE 0.0065f      ///< m, how far char stands out at most
#define BUCKLE_WIDTH 0.028f ///< m, of a buckle
#define PUCKER 0.0018f      ///< m
#define PUCKER_WIDTH 0.009f ///< m
#define CURL 0.005f         ///< m, how far a border does
#define CURL_WIDTH 0.008f   ///< m, from there to where cloth lies as it did
#define CURL_CHANGES 0.035f ///< m, over which a border curls the other way
#define RUMPLE_GAP 0.0004f  ///< m, kept from what lies there

/// How much of its relief burnt cloth has, 0 to 1.
static float rumple_share(const Preview *preview, const PaperVertex *v) {
    return cloth_weave(preview, v->sheet) ? stepf(0.25f, 0.6f, v->burn) : 0;
}

/// How far a vertex goes along its normal.
static float rumple_height(const PaperVertex *v) {
    const Float3 rest = float3_load(v->rest);
    Float3 at = float3(0.8f * rest.x + 0.6f * rest.z, rest.y + 0.35f * rest.x, 0.8f * rest.z - 0.6f * rest.x);
    const float bow = 0.006f * noise3(float3_scale(at, 1 / 0.015f), 231);
    at = float3_add(at, float3(bow, -bow, bow));
    const float buckle = noise3(float3_scale(at, 1 / BUCKLE_WIDTH), 232), folded = 2 * fabsf(buckle) - 0.6f;
    float height = BUCKLE * (0.5f * folded + noise3(float3_scale(at, 0.5f / BUCKLE_WIDTH), 233));
    height += PUCKER * (1 - 2.5f * fabsf(noise3(float3_scale(at, 1 / PUCKER_WIDTH), 234)));
    const float near = maxf(1 - v->edge / CURL_WIDTH, 0);
    return height + CURL * near * near * clampf(3 * noise3(float3_scale(at, 1 / CURL_CHANGES), 235), -1, 1);
}

/// How far of a way along a unit normal nothing lies.
static float rumple_clear(const Preview *preview, Float3 p, Float3 n, float way) {
    const Float3 d = float3_scale(n, way < 0 ? -1.0f : 1.0f);
    float clear = fabsf(way);
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        const Float3 to = float3_sub(shape_centre(shape), p);
        const float extent = shape_extent(shape, 0) + clear + RUMPLE_GAP;
        if (float3_dot(to, to) > extent * extent) continue;
        Facing facing;
        const float hit = shape_intersect(shape, 0, p, d, 0, clear + RUMPLE_GAP, &facing);
        if (hit >= 0) clear = maxf(hit - RUMPLE_GAP, 0);
    }
    const float above = p.z - preview->def.ground_height - RUMPLE_GAP; // infinite without a ground
    if (d.z * clear < -above) clear = maxf(-above / d.z, 0);
    return way < 0 ? -clear : clear;
}

void rumple_char(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    bool any = false;
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        PaperVertex *v = &scene->vertices[i];
        const float share = rumple_share(preview, v);
        if (share <= 0) continue;
        const Float3 p = float3_load(scene->positions[i]), n = float3_load(v->normal);
        const float way = rumple_clear(preview, p, n, share * rumple_height(v));
        float *places[3] = {scene->positions[i], NULL, NULL};
        for (int end = 0; preview->def.shutter > 0 && end < 2; end++) places[1 + end] = scene->moved[end][i];
        for (int k = 0; k < 3 && places[k]; k++)
            for (int c = 0; c < 3; c++) places[k][c] += way * v->normal[c];
        memset(v->slope, 0, sizeof v->slope);
        any = true;
    }

    // normals follow; the gradients' sums are no longer needed
    for (uint32_t t = 0; any && t < scene->triangle_count; t++) {
        const uint32_t *corner = scene->triangles[t];
        const Float3 a = float3_load(scene->positions[corner[0]]);
        const Float3 face = float3_cross(float3_sub(float3_load(scene->positions[corner[1]]), a),
                                         float3_sub(float3_load(scene->positions[corner[2]]), a));
        for (int k = 0; k < 3; k++) {
            float *sum = scene->vertices[corner[k]].slope;
            sum[0] += face.x, sum[1] += face.y, sum[2] += face.z;
        }
    }
    for (uint32_t i = 0; any && i < scene->vertex_count; i++) {
        PaperVertex *v = &scene->vertices[i];
        const float share = minf(4 * rumple_share(preview, v), 1);
        if (share <= 0) continue;
        const Float3 old = float3_load(v->normal), found = float3_unit_or(float3_load(v->slope), old);
        float3_store(v->normal, float3_unit_or(float3_mix(old, found, float3_dot(old, found) < 0 ? 0 : share), old));
    }
}
