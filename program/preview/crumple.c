// The facets of crumpled paper.
//
// Paper hardly stretches, so a crumpled sheet is flat between straight, sharp ridges, while the drawn surface is smooth. Its
// sheet at rest is divided into cells around scattered points (Worley 1996), with straight walls. Where the sheet is bent
// sharply the normals within a cell draw together towards their mean, and change at its walls.

#include "preview/internal.h"

#include <string.h>

#define FACET_SIZE 0.0090f ///< m
#define FACET_FLAT 0.9f    ///< of what their normals differ from the mean, that goes
#define RIDGE 0.035f       ///< of a cell: where the flat parts end
/// 1/m, of a sheet that bends without a crease, and of one that is all facets
#define CREASED_LOW 40.0f
#define CREASED_HIGH 160.0f
#define FACET_TILT 0.16f ///< slope
#define PROBES 16u

float crumple_amount(float bent) { return stepf(CREASED_LOW, CREASED_HIGH, bent); }

/// The key of the facet at a place of the sheet at rest, and how far its walls are, in cells.
static uint32_t facet_key(Float3 rest, int32_t sheet, float *wall) {
    uint32_t key;
    *wall = noise_cell(float3_scale(rest, 1 / FACET_SIZE), 37 + (uint32_t)sheet, &key);
    return key | 1;
}

void crumple_load(PreviewScene *scene) {
    float wall;
    memset(scene->facets, 0, sizeof scene->facets);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        const PaperVertex *v = &scene->vertices[i];
        const float weight = crumple_amount(v->bent) * v->spacing * v->spacing;
        if (!(weight > 0)) continue;
        const uint32_t key = facet_key(float3_load(v->rest), v->sheet, &wall);
        for (uint32_t k = 0; k < PROBES; k++) {
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
    const uint32_t key = facet_key(state->rest, state->sheet, &wall);
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
    const float flat =
        FACET_FLAT * amount * stepf(0, RIDGE, wall) * stepf(0.2f, 0.6f, fabsf(facing)); // not over a fold
    const Float3 turned = float3_unit_or(float3_mix(point->normal, mean, flat), point->normal);
    if (float3_dot(turned, point->view) > 0.02f) point->normal = turned;
}
