// The light of flames, embers and hot shapes, with shadows.
//
// The unoccluded light U = sum_k U_k over the lamps k is exact. Visibility is tested by one ray per sample, to a random
// point of a lamp chosen with probability U_k / U: its mean has no noise where all lamps or none are visible.

#include "common/float4.h"
#include "preview/block.h"

#include <string.h>

// ---- the lamps

// Light cast by embers and hot shapes, as a few point sources.
//
// A patch of area A and radiance L that glows on both sides lights a point at distance r by about L A / (2 pi r^2) per
// unit of its albedo. Triangles are summed in the cells of a grid over the surface; the strongest cells become lights,
// scaled to preserve the total. A sphere of radius R gives L R^2 / r^2. A flame of volume V that emits j (radiance a
// metre) gives j V / (pi r^2) (flame_lamps.c).

enum { GRID = 10, CELLS = GRID * GRID * GRID, FLAME_LIGHTS = 8 };

#define LAMP_WRAP 0.3f ///< cosine over which the least of lamps sets on what turns away from it
#define LAMP_WRAP_MOST 0.7f

typedef struct Cluster {
    Float3 position, strength;
    float weight;
} Cluster;

/// Embers are drawn on the film's scale, which compresses bright parts (blackbody.c). The light they cast is not
/// compressed, and an eye in the dark sees it better than a camera set for daylight. Flames dazzle it.
static const float EMBER_CAST = 5;
static const float DAZZLED = 0.3f; ///< the share of it that is left beside flames that light far more

static void gather_triangle(const Preview *preview, const uint32_t t[3], Cluster *clusters) {
    const PreviewScene *scene = &preview->scene;
    const PaperVertex *a = &scene->vertices[t[0]], *b = &scene->vertices[t[1]], *c = &scene->vertices[t[2]];
    if (!(maxf(a->temperature, maxf(b->temperature, c->temperature)) > BLACKBODY_MIN)) return;

    // the share that the ember's line covers, the overlap of the two ranges of burn, and what leaves of char give
    float low = minf(a->burn, minf(b->burn, c->burn)), high = maxf(a->burn, maxf(b->burn, c->burn));
    float gradient = (a->gradient + b->gradient + c->gradient) / 3, half = EMBER_WIDTH * maxf(gradient, 20.0f);
    float overlap = minf(high, EMBER_BURN + 1.3f * half) - maxf(low, EMBER_BURN - half);
    const float rate = (a->burn_rate + b->burn_rate + c->burn_rate) / 3;
    const float flaming = (a->flaming + b->flaming + c->flaming) / 3,
                starved = (a->starved + b->starved + c->starved) / 3;
    const float line = overlap > 0 ? ember_activity(rate) * overlap / maxf(high - low, 2 * half) : 0;
    const float leaf = ember_leaf(rate - flaming, starved, (a->burn + b->burn + c->burn) / 3);
    const float border = expf(-(a->edge + b->edge + c->edge) / (3 * LEAF_BORDER));
    const float alone = ember_activity(rate - flaming), lit = mixf(LEAF_LIT, LEAF_BORDER_LIT, border);
    const float glowing =
        cloth_weave(preview, a->sheet) ? CLOTH_LIT * leaf : line + lit * mixf(alone, leaf, LEAF_FED_LIT);
    if (glowing <= 0) return;

    Float3 pa = float3_load(scene->positions[t[0]]), pb = float3_load(scene->positions[t[1]]),
           pc = float3_load(scene->positions[t[2]]);
    float area = 0.5f * float3_length(float3_cross(float3_sub(pb, pa), float3_sub(pc, pa)));
    float temperature = (a->temperature + b->temperature + c->temperature) / 3;
    Float3 glow = blackbody_glow(preview->blackbody, ember_temperature(temperature));
    Float3 radiance = float3_scale(glow, EMBER_CAST * EMBER_GAIN * glowing);
    Float3 position = float3_scale(float3_add(pa, float3_add(pb, pc)), 1.0f / 3);
    Float3 strength = float3_scale(radiance, ember_air(preview, position) * area / (2 * PI_F));
    float weight = float3_luminance(strength);
    if (!(weight > 0)) return;

    const Float3 low_corner = scene->low, size = float3_sub(scene->high, low_corner);
    const float at[3] = {(position.x - low_corner.x) / maxf(size.x, 1e-6f),
                         (position.y - low_corner.y) / maxf(size.y, 1e-6f),
                         (position.z - low_corner.z) / maxf(size.z, 1e-6f)};
    int cell[3];
    for (int i = 0; i < 3; i++) cell[i] = (int)clampf(at[i] * GRID, 0, GRID - 1);
    Cluster *cluster = &clusters[(cell[2] * GRID + cell[1]) * GRID + cell[0]];
    cluster->position = float3_mad(cluster->position, position, weight);
    cluster->strength = float3_add(cluster->strength, strength);
    cluster->weight += weight;
}

void light_add(struct PreviewScene *scene, Float3 position, Float3 strength, float softness, float extent) {
    EmberLights *lights = &scene->lights;
    int k = scene->light_count++;
    lights->x[k] = position.x;
    lights->y[k] = position.y;
    lights->z[k] = position.z;
    lights->strength[0][k] = strength.x;
    lights->strength[1][k] = strength.y;
    lights->strength[2][k] = strength.z;
    lights->softness[k] = softness;
    lights->extent[k] = extent;
    lights->power[k] = float3_luminance(strength);
}

/// Turns the strongest clusters into lights as long as there is room, and scales them to the total of all clusters, less
/// beside flames that give `flaming`.
static void choose_lights(PreviewScene *scene, Cluster *clusters, float flaming) {
    const float cell = float3_length(float3_sub(scene->high, scene->low)) / GRID,
                softness = 0.02f * cell * cell + 4e-6f;
    float total = 0, kept = 0;
    int first = scene->light_count;
    for (int i = 0; i < CELLS; i++) total += clusters[i].weight;

    while (scene->light_count < LIGHT_LIMIT) {
        int best = 0;
        for (int i = 1; i < CELLS; i++)
            if (clusters[i].weight > clusters[best].weight) best = i;
        Cluster *cluster = &clusters[best];
        if (!(cluster->weight > 0)) break;
        Float3 position = float3_scale(cluster->position, 1 / cluster->weight);
        light_add(scene, position, cluster->strength, softness, 1.5f * sqrtf(softness));
        kept += cluster->weight;
        cluster->weight = 0;
    }

    const float factor = total / maxf(kept, 1e-12f) * mixf(1, DAZZLED, flaming / maxf(flaming + total, 1e-12f));
    for (int i = first; i < scene->light_count; i++) {
        for (int c = 0; c < 3; c++) scene->lights.strength[c][i] *= factor;
        scene->lights.power[i] *= factor;
    }
}

void light_gather(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    scene->light_count = 0;
    scene->lights = (EmberLights){.x = {0}};
    for (int k = 0; k < LIGHT_LIMIT; k++) scene->lights.softness[k] = 1;

    const Float3 lamp = float3_scale(float3_load(preview->def.lamp_colour), FILM_SPEED);
    const float radius = maxf(preview->def.lamp_radius, 1e-4f);
    if (float3_luminance(lamp) > 0)
        light_add(scene, float3_load(preview->def.lamp_position), lamp, 0.3f * radius * radius, radius);

    for (uint32_t k = 0; k < preview->shape_count && scene->light_count < LIGHT_LIMIT / 2; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        if (!(shape->temperature > BLACKBODY_MIN) || shape->kind == SINGE_COLLIDER_PLANE) continue;
        float r = shape->facets ? 0.5f * shape->facets->extent : shape->radius;
        if (shape->kind == SINGE_COLLIDER_BOX) r = float3_length(float3_load(shape->half_size)) * 0.6f;
        Float3 glow = blackbody_glow(preview->blackbody, shape->temperature);
        light_add(scene, shape_centre(shape), float3_scale(glow, 1.6f * r * r), 0.3f * r * r,
                  1.02f * shape_extent(shape, preview->def.shutter));
    }

    const float flaming = flame_lamps_add(preview, FLAME_LIGHTS);
    Cluster embers[CELLS] = {{{0, 0, 0}, {0, 0, 0}, 0}};
    for (uint32_t t = 0; t < scene->triangle_count; t++) gather_triangle(preview, scene->triangles[t], embers);
    choose_lights(scene, embers, flaming);
}

// ---- their light

static const float too_faint = 1e-3f;
static const float bounced =
    0.06f; ///< of what is hidden of flames, the light that comes by way of sheets, ground and walls

/// What lamps in those directions give. A lamp sets bit by bit, as it has an extent: E(c) = (c + w)^2 / 4w for |c| < w, and c
/// above. Fuzz scatters its light.
static inline Float4 lamps_before(const Point *point, Float4 cosine, Float4 extent, Float4 distance) {
    const Float4 none = {0, 0, 0, 0};
    const Float4 wrap = float4_min(LAMP_WRAP + point->fuzz + extent / distance, float4_all(LAMP_WRAP_MOST));
    const Float4 up = float4_min(float4_max((cosine + wrap) / (2 * wrap), none), float4_all(1));
    return wrap * up * up + float4_max(cosine - wrap, none);
}

static inline float lamp_before(const Point *point, float cosine, float extent, float distance) {
    return lamps_before(point, float4_all(cosine), float4_all(extent), float4_all(distance))[0];
}

static inline float four_sum(Four a) { return a[0] + a[1] + (a[2] + a[3]); }

/// All lights at the point, over its albedo, and the luminance of each. A surface that faces away from a light is lit
/// through the sheet.
static Float3 lamps_gather(const PreviewScene *scene, const Point *point, float weight[LIGHT_LIMIT]) {
    const EmberLights *l = &scene->lights;
    const int count = scene->light_count;
    Float3 p = point->position, n = point->normal;
    const float through = point->transmission;
    const Float3 tint = float3_sub(point->through, float3(1, 1, 1));
    Four r = {0, 0, 0, 0}, g = r, b = r, all = r;
    for (int k = 0; k < count; k += 4) {
        Four x = four_load(l->x + k) - p.x, y = four_load(l->y + k) - p.y, z = four_load(l->z + k) - p.z;
        const Four d2 = x * x + y * y + z * z + four_load(l->softness + k), distance = float4_sqrt(d2);
        const Four cosine = (n.x * x + n.y * y + n.z * z) / distance;
        Four seen = lamps_before(point, cosine, four_load(l->extent + k), distance);
        const Four red = four_load(l->strength[0] + k), green = four_load(l->strength[1] + k),
                   blue = four_load(l->strength[2] + k);
        if (through > 0) {
            const Four before = seen;
            seen = float4_max(seen, -through * cosine);
            const Four behind = (seen - before) / d2;
            r += tint.x * behind * red;
            g += tint.y * behind * green;
            b += tint.z * behind * blue;
        }
        seen /= d2;
        r += seen * red;
        g += seen * green;
        b += seen * blue;
        seen *= four_load(l->power + k);
        all += seen;
        memcpy(weight + k, &seen, sizeof seen);
    }

    // no fire lights anything more than one that is all around it
    const float sum = four_sum(all);
    float fire = sum;
    for (int k = 0; k < scene->flames[0]; k++) fire -= weight[k];
    const float over = fire / FIRE_MOST, less = over * over < 1e-4f ? 0 : fire / sum * (1 - 1 / sqrtf(1 + over * over));
    return float3_scale(float3(four_sum(r), four_sum(g), four_sum(b)), 1 - less);
}

/// Finds a lamp for a random number from 0 to 1, each as likely as it is bright, and a point of it. False: no ray is asked, as
/// `from` is at it or in it.
static bool find_target(const PreviewScene *scene, const float weight[LIGHT_LIMIT], float random, const float square[2],
                        Float3 from, int *lamp, Float3 *to, float *far) {
    const EmberLights *l = &scene->lights;
    float total = 0, sum = 0;
    int k = 0;
    for (int i = 0; i < scene->light_count; i++) total += weight[i];
    for (; k < scene->light_count - 1 && sum + weight[k] <= random * total; k++) sum += weight[k];
    *lamp = k;

    // those of flames have points, in order: the rest of the number chooses one
    const Float3 centre = {l->x[k], l->y[k], l->z[k]};
    if (l->point_count[k]) {
        const float part = weight[k] > 0 ? clampf((random * total - sum) / weight[k], 0, 0.9999f) : 0;
        *to = scene->flame_points[l->first_point[k] + (int)(part * (float)l->point_count[k])];
        *far = float3_length(float3_sub(*to, from)) - 4 * scene->epsilon;
        return *far > 0;
    }

    // objects within it do not occlude it
    float disc[2];
    const float z = 1.6f * square[0] - 0.8f, extent = l->extent[k];
    sample_disc((const float[2]){0.6f, square[1]}, disc);
    *to = float3_add(centre, float3_scale(float3(disc[0], disc[1], z), 0.8f * extent));
    const float distance = float3_length(float3_sub(*to, from)),
                free = float3_length(float3_sub(centre, from)) - extent;
    *far = minf(free, distance);
    return free >= 0.1f * extent && distance >= 1e-6f;
}

/// Tests the lamps' visibility by one ray per lane, to a random point of a lamp.
static void ask_lamps(const Preview *preview, Block *block, const float wanted[LANES], float (*weight)[LIGHT_LIMIT],
                      int sample) {
    const PreviewScene *scene = &preview->scene;
    const EmberLights *l = &scene->lights;
    const float part = sample_half((uint32_t)sample), dither = hash_unit(preview->def.seed ^ 0x5bd1e995u);
    float open[LANES] = {0};

    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (wanted[i] <= 0) continue;

        float random = dither + 0.75487767f * (float)block->x[i] + 0.56984029f * (float)block->y[i], square[2], far;
        random += part;
        int lamp;
        const Point *point = &block->point[i];
        Float3 to;
        sample_square((uint32_t)sample, block->turn[i][1], block->turn[i][0], square);
        if (!find_target(scene, weight[i], random - floorf(random), square, point->position, &lamp, &to, &far))
            continue;

        // a part of a lamp in front that is behind the sheet shines through it
        const Float3 centre = float3_sub(float3(l->x[lamp], l->y[lamp], l->z[lamp]), point->position);
        to = float3_sub(to, point->position);
        const float distance = maxf(float3_length(centre), 1e-6f),
                    cosine = float3_dot(point->normal, centre) / distance;
        const float above = float3_dot(point->geometric, to);
        const bool before =
            above > 0 || lamp_before(point, cosine, l->extent[lamp], distance) >= -point->transmission * cosine;
        // what has set is not counted twice: it is asked for along the sheet
        if (before) to = float3_mad(to, point->geometric, maxf(0.05f * float3_length(to) - above, 0));
        aim_ray(&block->shadow, i,
                float3_mad(point->position, point->geometric, before ? scene->epsilon : -scene->epsilon),
                float3_scale(to, 1 / float3_length(to)), 0, far, block->time[i]);
        block->valid[i] = -1;
        open[i] = l->point_count[lamp] ? bounced : 0;
    }

    tracer_occlude(preview, block->valid, &block->shadow, block->clear);
    for (int i = 0; i < LANES; i++) open[i] = mixf(open[i], 1, block->clear[i]);
    light_count(block, LIT_LAMPS, wanted, open);
}

void lamps_add(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES],
               const int *ask) {
    const PreviewScene *scene = &preview->scene;
    if (!scene->light_count) return;
    float weight[LANES][LIGHT_LIMIT], wanted[LANES];
    bool any = false;

    for (int i = 0; i < LANES; i++) {
        wanted[i] = 0;
        if (!light_reaches(block, active, i)) continue;

        // the last result is reused if its point was nearby with the same normal, or if it hardly matters, on char
        const Point *point = &block->point[i];
        Float3 moved = float3_sub(point->position, block->lamp_position[i]);
        bool known =
            !ask[i] && float3_dot(moved, moved) < 4 * point->footprint * point->footprint &&
            (float3_dot(point->normal, block->lamp_normal[i]) > 0.99f || float3_luminance(point->albedo) < 0.08f);
        if (!known) {
            block->lamp_position[i] = point->position;
            block->lamp_normal[i] = point->normal;
            block->lamp_white[i] = lamps_gather(scene, point, weight[i]);
        }

        Float3 light = float3_mul(block->lamp_white[i], point->albedo);
        if (point->shine.x > 0) light = float3_add(light, light_shine_of_lamps(scene, point));
        light = float3_scale(float3(minf(light.x, 40), minf(light.y, 40), minf(light.z, 40)), through[i]);
        block->lit[LIT_LAMPS][i] = float3_add(block->lit[LIT_LAMPS][i], light);
        float luminance = float3_luminance(light);
        if (ask[i] && luminance > too_faint) {
            wanted[i] = luminance;
            any = true;
        }
    }

    if (any) ask_lamps(preview, block, wanted, weight, sample > 0 ? sample : 0);
}
