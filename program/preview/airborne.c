// Where sparks and wisps come from, and how they reach the picture.
//
// The veil is what they add at a pixel: light J, a sum of radiance times optical depth for smoke, and optical depth D.
// Over a picture P, with smoke and sparks mixed, it gives P exp(-D) + J (1 - exp(-D)) / D.

#include "preview/airborne.h"
#include "preview/ground.h"

#include <string.h>

#define FORWARD 0.45f     ///< g of the smoke's phase function
#define FIRE_FAINT 0.06f  ///< light of a fire that loses half of its colour
#define LIGHT_MOST 40.0f  ///< of a pixel: a spark that flies at the eye is all in one
#define LEAF_WIDTH 0.008f ///< m: a leaf that glows as a whole counts as a line for each

// ---- embers

/// What a triangle adds to its site. False: nothing.
static bool ember_of(const PreviewScene *scene, uint32_t t, float size, EmberSite *add) {
    const PaperVertex *v[3];
    for (int k = 0; k < 3; k++) v[k] = &scene->vertices[scene->triangles[t][k]];
    float hottest = maxf(v[0]->temperature, maxf(v[1]->temperature, v[2]->temperature));
    float high = maxf(v[0]->burn, maxf(v[1]->burn, v[2]->burn));
    if (hottest < 600 || high < 0.15f) return false; // most are neither

    Float3 position = {0, 0, 0}, rest = {0, 0, 0};
    float low = 1, burn = 0, rate = 0, flaming = 0, starved = 0, gradient = 0;
    for (int k = 0; k < 3; k++) {
        low = minf(low, v[k]->burn);
        rate += v[k]->burn_rate / 3;
        flaming += v[k]->flaming / 3;
        starved += v[k]->starved / 3;
        burn += v[k]->burn / 3;
        gradient += v[k]->gradient / 3;
        rest = float3_mad(rest, float3_load(v[k]->rest), 1.0f / 3);
        position = float3_mad(position, float3_load(scene->positions[scene->triangles[t][k]]), 1.0f / 3);
    }

    // the glowing line runs where burn is EMBER_BURN; leaves of char glow as a whole, with threads
    const float *p[3];
    for (int k = 0; k < 3; k++) p[k] = scene->positions[scene->triangles[t][k]];
    Float3 a = float3_sub(float3_load(p[1]), float3_load(p[0])), b = float3_sub(float3_load(p[2]), float3_load(p[0]));
    const Float3 normal = float3_cross(a, b);
    float area = 0.5f * float3_length(normal), live = ember_activity(rate);
    float length = low < EMBER_BURN && high > EMBER_BURN ? area * maxf(gradient, 20) / maxf(high - low, 0.02f) : 0;
    length = live * minf(length, 2 * sqrtf(area)) + ember_leaf(rate - flaming, starved, burn) * area / LEAF_WIDTH;
    if (hottest < BLACKBODY_MIN) length = 0;
    float smoulder = area * stepf(600, 760, hottest) * (1 - stepf(0.02f, 0.2f, flaming));
    if (length + smoulder <= 0) return false;

    float rests[3], within, weight = length + 0.1f * smoulder / size;
    float3_store(rests, rest);
    uint32_t key = hash_u32((uint32_t)v[0]->sheet + 1);
    for (int c = 0; c < 3; c++) key = hash_u32(key ^ (uint32_t)noise_floor(rests[c] / size + 0.37f, &within));
    *add = (EmberSite){.key = key | 1,
                       .length = length,
                       .flaming = rate > 0 ? length * flaming / rate : 0,
                       .smoulder = smoulder,
                       .weight = weight,
                       .level = area > 0 ? 0.5f * weight * fabsf(normal.z) / area : 0,
                       .position = position};
    return true;
}

/// The site with a key, or an empty one for it; NULL: all are taken.
static EmberSite *site_of(EmberSite sites[SITE_LIMIT], uint32_t key) {
    for (uint32_t i = 0; i < SITE_LIMIT; i++) {
        EmberSite *site = &sites[(key + i) & (SITE_LIMIT - 1)];
        if (!site->key || site->key == key) return site;
    }
    return NULL;
}

Float3 ember_across(uint32_t key) {
    const float turn = 2 * PI_F * hash_unit(key);
    return float3(cosf(turn), sinf(turn), 0);
}

void ember_sites(const Preview *preview, float size, EmberSite sites[SITE_LIMIT]) {
    const PreviewScene *scene = &preview->scene;
    EmberSite add, *site;
    memset(sites, 0, SITE_LIMIT * sizeof *sites);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (!ember_of(scene, t, size, &add) || !(site = site_of(sites, add.key))) continue;
        site->key = add.key;
        site->length += add.length;
        site->flaming += add.flaming;
        site->smoulder += add.smoulder;
        site->weight += add.weight;
        site->level += add.level;
        site->position = float3_mad(site->position, add.position, add.weight);
    }

    float nearest[SITE_LIMIT], furthest[SITE_LIMIT][2];
    for (int i = 0; i < SITE_LIMIT; i++) {
        nearest[i] = furthest[i][0] = furthest[i][1] = INFINITY;
        if (!(sites[i].weight > 0)) continue;
        sites[i].position = float3_scale(sites[i].position, 1 / sites[i].weight);
        sites[i].level /= sites[i].weight;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (!ember_of(scene, t, size, &add) || !(site = site_of(sites, add.key))) continue;
        const float glow = add.length * LEAF_WIDTH / (add.smoulder + 1e-9f);
        const Float3 off = float3_sub(add.position, site->position);
        const float dull = 0.4f * size * (1 - stepf(0, 0.5f, glow)), distance = float3_length(off) + dull;
        if (distance < nearest[site - sites]) nearest[site - sites] = distance, site->ember = add.position;
        const float along = float3_dot(off, ember_across(site->key)), beyond[2] = {along + dull, dull - along};
        for (int k = 0; k < 2; k++)
            if (beyond[k] < furthest[site - sites][k])
                furthest[site - sites][k] = beyond[k], site->ends[k] = add.position;
    }
}

// ---- the picture

Float3 smoke_light(const Preview *preview, Float3 p) {
    const EmberLights *lamps = &preview->scene.lights;
    const Float3 blue = {0.74f, 0.87f, 1.0f}; // of fine, fresh smoke
    Float3 d = float3_unit_or(float3_sub(p, preview->camera.eye), float3(0, 1, 0));
    const float g = FORWARD, cosine = float3_dot(preview->sun, d);
    const float phase = (1 - g * g) / powf(1 + g * g - 2 * g * cosine, 1.5f);
    Float3 sky = float3_add(sky_ambient(&preview->sky, float3(0, 0, 1)), sky_ambient(&preview->sky, float3(0, 0, -1)));
    Float3 light = float3_mad(float3_scale(sky, 0.5f), preview->sun_light, 0.25f * phase);
    Float3 fire = {0, 0, 0};
    for (int k = 0; k < preview->scene.light_count; k++) {
        Float3 to = float3_sub(float3(lamps->x[k], lamps->y[k], lamps->z[k]), p);
        float share = 0.25f / (float3_dot(to, to) + lamps->softness[k] + 4e-4f);
        fire = float3_mad(fire, float3(lamps->strength[0][k], lamps->strength[1][k], lamps->strength[2][k]), share);
    }

    // where it is faint its colour is lost, too: red and blue would be purple
    const float grey = float3_luminance(fire), faint = FIRE_FAINT / (FIRE_FAINT + grey);
    light = float3_add(light, float3_mix(fire, float3(grey, grey, grey), faint));
    return float3_mul(light, blue);
}

bool airborne_project(const Preview *preview, Float3 p, float at[2], float *depth) {
    const Camera *camera = &preview->camera;
    Float3 ray = float3_sub(p, camera->eye);
    *depth = float3_dot(ray, camera->forward);
    if (*depth < 0.01f) return false;
    float x = float3_dot(ray, camera->right) / (*depth * float3_dot(camera->right, camera->right));
    float y = float3_dot(ray, camera->up) / (*depth * float3_dot(camera->up, camera->up));
    at[0] = 0.5f * (x + 1) * (float)preview->def.width - 0.5f;
    at[1] = 0.5f * (1 - y) * (float)preview->def.height - 0.5f;
    return fabsf(x) < 1.5f && fabsf(y) < 1.5f;
}

void airborne_sight(const Preview *preview, const Float3 *points, int count, float seen[SIGHT_POINTS]) {
    Rays rays;
    int valid[LANES];
    const Float3 eye = preview->camera.eye;
    for (int i = 0; i < LANES; i++) {
        valid[i] = i < count;
        rest_ray(&rays, i);
        if (!valid[i]) continue;
        Float3 to = float3_sub(points[i], eye);
        float distance = float3_length(to), near = 4 * preview->scene.epsilon;
        aim_ray(&rays, i, eye, float3_scale(to, 1 / distance), 0, maxf(distance - near, 0), 0.5f);
    }
    tracer_occlude(preview, valid, &rays, seen);
    for (int i = 0; i < count; i++) {
        if (isfinite(preview->def.ground_height) && points[i].z < preview->def.ground_height) seen[i] = 0;
        if (wall_hit(preview, eye, float3_sub(points[i], eye)) < 1) seen[i] = 0;
    }
}

void airborne_flames(const Preview *preview, const Float3 *points, int count, Float3 light[SIGHT_POINTS],
                     float clear[SIGHT_POINTS]) {
    Float3 from[SIGHT_POINTS], along[SIGHT_POINTS];
    float far[SIGHT_POINTS];
    for (int k = 0; k < count; k++) {
        const Float3 to = float3_sub(points[k], preview->camera.eye);
        far[k] = float3_length(to);
        from[k] = preview->camera.eye;
        along[k] = float3_scale(to, 1 / far[k]);
        light[k] = float3(0, 0, 0);
        clear[k] = 1;
    }
    if (preview->fire.visible) fire_along(preview, count, from, along, far, 1, light, clear);
}

void airborne_dot(Preview *preview, const float at[2], float radius, Float3 light, float depth) {
    const int width = preview->def.width, height = preview->def.height;
    radius = maxf(radius, 1.1f);
    int left = (int)maxf(ceilf(at[0] - radius), 0), right = (int)minf(floorf(at[0] + radius), (float)width - 1);
    int top = (int)maxf(ceilf(at[1] - radius), 0), bottom = (int)minf(floorf(at[1] + radius), (float)height - 1);
    const float inverse = 1 / (radius * radius), whole = 3 / PI_F * inverse;

    // (1 - (d/R)^2)^2, of which the integral is pi R^2 / 3
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++) {
            float dx = (float)x - at[0], dy = (float)y - at[1], rest = 1 - (dx * dx + dy * dy) * inverse;
            if (rest <= 0) continue;
            Veil *veil = &preview->veil[(size_t)y * (size_t)width + (size_t)x];
            float share = whole * rest * rest;
            veil->light = float3_mad(veil->light, light, share);
            veil->depth += share * depth;
        }
}

void airborne_draw(Preview *preview) {
    const size_t pixels = (size_t)preview->def.width * (size_t)preview->def.height;
    memset(preview->veil, 0, pixels * sizeof *preview->veil);
    wisps_draw(preview);
    flakes_draw(preview);
    sparks_draw(preview);
}

void airborne_lay(Preview *preview, Block *block) {
    for (int k = 0; k < LANES; k++) {
        if (block->x[k] >= preview->def.width || block->y[k] >= preview->def.height) continue;
        const size_t i = block_pixel(preview, block, k);
        const Veil *veil = &preview->veil[i];
        if (veil->depth + veil->light.x <= 0) continue;
        float clear = expf(-veil->depth), part = veil->depth > 1e-3f ? (1 - clear) / veil->depth : 1;
        Float3 light = float3_scale(veil->light, part);
        const float most = maxf(light.x, maxf(light.y, light.z));
        if (most > LIGHT_MOST) light = float3_scale(light, LIGHT_MOST / most); // its colour stays
        preview->picture[i] = float3_mad(light, preview->picture[i], clear);
        if (preview->layers.glow)
            float3_store(preview->layers.glow[i], float3_scale(float3_load(preview->layers.glow[i]), clear));
        if (!preview->layers.fire) continue;
        float *fire = preview->layers.fire[i];
        float3_store(fire, float3_mad(light, float3_load(fire), clear));
        fire[3] = 1 - (1 - fire[3]) * clear;
    }
}
