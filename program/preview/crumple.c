// The facets of crumpled paper.
//
// Paper hardly stretches, so a crumpled sheet is flat between straight, sharp ridges, while the drawn surface is smooth. Its
// sheet at rest is divided into cells around scattered points (Worley 1996), with straight walls; most are broken into
// smaller ones, so that no two are alike. Where the sheet is bent sharply the normals within a cell draw together towards
// their mean, some more than others, as of a cone, and change at its walls. Small dents are left between the creases.

#include "preview/internal.h"
#include "preview/share.h"

#include <string.h>

#define FACET_SIZE 0.0150f ///< m
#define FACET_PART 0.0068f ///< m, of the parts that they are broken into
#define FACET_WHOLE 0.25f  ///< the share of facets that are not
#define FACET_FLAT 0.95f   ///< of what their normals differ from the mean, that goes at most
#define FACET_BENT 0.4f    ///< and that stays of it at most
#define DENT_SIZE 0.0032f  ///< m
#define DENT_TILT 0.16f    ///< slope at most
#define RIDGE 0.035f       ///< of a cell: where the flat parts end
/// 1/m, of a sheet that bends without a crease, and of one that is all facets
#define CREASED_LOW 30.0f
#define CREASED_HIGH 120.0f
#define FACET_TILT 0.30f ///< slope
#define PROBES 16u

float crumple_amount(float bent) { return stepf(CREASED_LOW, CREASED_HIGH, bent); }

/// The key of the facet at a place of the sheet at rest, and how far its walls are, in cells.
static uint32_t facet_key(const PreviewScene *scene, Float3 rest, int32_t sheet, float *wall) {
    uint32_t key, part;
    *wall = scene->cell(float3_scale(rest, 1 / FACET_SIZE), 37 + (uint32_t)sheet, &key);
    if (hash_unit(key + 4) < FACET_WHOLE) return key | 1;
    const float nearer = scene->cell(float3_scale(rest, 1 / FACET_PART), 59 + (uint32_t)sheet, &part);
    *wall = minf(*wall * FACET_SIZE / FACET_PART, nearer);
    return hash_u32(key + 3 * part) | 1;
}

/// What a vertex weighs in the mean of its facet.
static float facet_weight(const PaperVertex *v) { return crumple_amount(v->bent) * v->spacing * v->spacing; }

static void find_facets(void *context, int part) {
    PreviewScene *scene = context;
    const uint32_t end = share_first(scene->vertex_count, part + 1, SHARE_PARTS);
    float wall;
    for (uint32_t i = share_first(scene->vertex_count, part, SHARE_PARTS); i < end; i++) {
        PaperVertex *v = &scene->vertices[i];
        v->facet = facet_weight(v) > 0 ? facet_key(scene, float3_load(v->rest), v->sheet, &wall) : 0;
    }
}

void crumple_load(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    memset(scene->facets, 0, sizeof scene->facets);
    share_out(preview->def.thread_count, SHARE_PARTS, find_facets, scene);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        const PaperVertex *v = &scene->vertices[i];
        const float weight = facet_weight(v);
        const uint32_t key = v->facet;
        for (uint32_t k = 0; k < PROBES && key; k++) {
            CrumpleFacet *facet = &scene->facets[(key / 2 + k) % CRUMPLE_FACETS];
            if (facet->key && facet->key != key) continue;
            facet->key = key;
            facet->sum = float3_mad(facet->sum, float3_load(v->normal), weight);
            break;
        }
    }
}

void crumple_shade(const PreviewScene *scene, const PaperState *state, float amount, Point *point) {
    float wall;
    const uint32_t key = facet_key(scene, state->rest, state->sheet, &wall);
    Float3 mean = point->normal;
    for (uint32_t k = 0; k < PROBES; k++) {
        const CrumpleFacet *facet = &scene->facets[(key / 2 + k) % CRUMPLE_FACETS];
        if (facet->key == key) mean = float3_unit_or(facet->sum, mean);
        if (facet->key == key || !facet->key) break;
    }

    const float facing = float3_dot(mean, point->normal);
    if (facing < 0) mean = float3_scale(mean, -1); // seen from behind
    const Float3 aside = float3(hash_unit(key) - 0.5f, hash_unit(key + 1) - 0.5f, hash_unit(key + 2) - 0.5f);
    mean = float3_mad(mean, aside, 2 * FACET_TILT);
    const float over = amount * stepf(0.2f, 0.6f, fabsf(facing)), // not over a fold
        flat = (FACET_FLAT - FACET_BENT * hash_unit(key + 5)) * over * stepf(0, RIDGE, wall);
    Float3 turned = float3_unit_or(float3_mix(point->normal, mean, flat), point->normal);

    const float near = 1 - stepf(0.25f, 0.7f, point->footprint / DENT_SIZE);
    if (near > 0) {
        uint32_t dent;
        scene->cell(float3_scale(state->rest, 1 / DENT_SIZE), 83, &dent);
        const Float3 down = float3(hash_unit(dent) - 0.5f, hash_unit(dent + 1) - 0.5f, hash_unit(dent + 2) - 0.5f);
        turned = float3_unit_or(float3_mad(turned, down, 2 * DENT_TILT * near * over * hash_unit(dent + 3)), turned);
    }
    if (float3_dot(turned, point->view) > 0.02f) point->normal = turned;
}
