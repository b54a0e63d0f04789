// Light cast by embers and hot shapes, as a few point sources.
//
// A patch of area A and radiance L that glows on both sides lights a point at distance r by about L A / (2 pi r^2) per
// unit of its albedo. Triangles are summed in the cells of a grid over the surface; the strongest cells become lights,
// scaled to preserve the total. A sphere of radius R gives L R^2 / r^2. A flame of volume V that emits j (radiance a
// metre) gives j V / (pi r^2); its clusters are created and chosen in the same way.

#include "preview/internal.h"

enum { GRID = 10, CELLS = GRID * GRID * GRID, FLAME_LIGHTS = 6 };

typedef struct Cluster {
    Float3 position, strength;
    float weight;
} Cluster;

/// Embers are drawn on the film's scale, which compresses bright parts (blackbody.c). The light they cast is not
/// compressed, and an eye in the dark sees it better than a camera set for daylight.
static const float EMBER_CAST = 5;

/// Share of a triangle that the ember's line covers: the overlap of the two ranges of burn.
static float coverage(const PaperVertex *a, const PaperVertex *b, const PaperVertex *c) {
    float low = minf(a->burn, minf(b->burn, c->burn)), high = maxf(a->burn, maxf(b->burn, c->burn));
    float gradient = (a->gradient + b->gradient + c->gradient) / 3, half = EMBER_WIDTH * maxf(gradient, 20.0f);
    float overlap = minf(high, EMBER_BURN + 1.3f * half) - maxf(low, EMBER_BURN - half);
    return overlap > 0 ? overlap / maxf(high - low, 2 * half) : 0;
}

static void add_to_cluster(Cluster *clusters, Float3 low, Float3 high, Float3 position, Float3 strength, float weight) {
    Float3 size = float3_sub(high, low);
    int cell[3];
    float at[3] = {(position.x - low.x) / maxf(size.x, 1e-6f), (position.y - low.y) / maxf(size.y, 1e-6f),
                   (position.z - low.z) / maxf(size.z, 1e-6f)};
    for (int i = 0; i < 3; i++) cell[i] = (int)clampf(at[i] * GRID, 0, GRID - 1);
    Cluster *cluster = &clusters[(cell[2] * GRID + cell[1]) * GRID + cell[0]];
    cluster->position = float3_mad(cluster->position, position, weight);
    cluster->strength = float3_add(cluster->strength, strength);
    cluster->weight += weight;
}

static void gather_triangle(const Preview *preview, const uint32_t t[3], Cluster *clusters) {
    const PreviewScene *scene = &preview->scene;
    const PaperVertex *a = &scene->vertices[t[0]], *b = &scene->vertices[t[1]], *c = &scene->vertices[t[2]];
    float hottest = maxf(a->temperature, maxf(b->temperature, c->temperature));
    float share = hottest > BLACKBODY_MIN ? coverage(a, b, c) : 0;
    if (share <= 0) return;
    Float3 pa = float3_load(scene->positions[t[0]]), pb = float3_load(scene->positions[t[1]]),
           pc = float3_load(scene->positions[t[2]]);
    float area = 0.5f * float3_length(float3_cross(float3_sub(pb, pa), float3_sub(pc, pa)));
    float rate = (a->burn_rate + b->burn_rate + c->burn_rate) / 3;
    float temperature = (a->temperature + b->temperature + c->temperature) / 3;
    Float3 glow = blackbody_glow(preview->blackbody, ember_temperature(temperature));
    Float3 radiance = float3_scale(glow, EMBER_CAST * EMBER_GAIN * ember_activity(rate));
    Float3 position = float3_scale(float3_add(pa, float3_add(pb, pc)), 1.0f / 3);
    Float3 strength = float3_scale(radiance, ember_air(preview, position) * area * share / (2 * PI_F));
    float weight = float3_luminance(strength);
    if (!(weight > 0)) return;
    add_to_cluster(clusters, scene->low, scene->high, position, strength, weight);
}

static void add_light(PreviewScene *scene, Float3 position, Float3 strength, float softness, float extent) {
    EmberLights *lights = &scene->lights;
    int k = scene->light_count++;
    lights->x[k] = position.x;
    lights->y[k] = position.y;
    lights->z[k] = position.z;
    lights->strength[0][k] = strength.x;
    lights->strength[1][k] = strength.y;
    lights->strength[2][k] = strength.z;
    lights->softness[k] = softness;
    lights->extent[k] = extent, lights->power[k] = float3_luminance(strength);
}

static void add_shapes(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    for (uint32_t k = 0; k < preview->shape_count && scene->light_count < LIGHT_LIMIT / 2; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        if (!(shape->temperature > BLACKBODY_MIN) || shape->kind == SINGE_COLLIDER_PLANE) continue;
        float r = shape->facets ? 0.5f * shape->facets->extent : shape->radius;
        if (shape->kind == SINGE_COLLIDER_BOX) r = float3_length(float3_load(shape->half_size)) * 0.6f;
        Float3 glow = blackbody_glow(preview->blackbody, shape->temperature);
        Float3 position = shape_centre(shape);
        add_light(scene, position, float3_scale(glow, 1.6f * r * r), 0.3f * r * r,
                  1.02f * shape_extent(shape, preview->def.shutter));
    }
}

static void gather_flames(const Preview *preview, Cluster *clusters) {
    const Fire *fire = &preview->fire;
    float volume = fire->cell * fire->cell * fire->cell;
    Float3 strength = float3_scale(fire_emission(preview), 0.14f * volume / PI_F);
    const FireCell *cell = fire->cells;
    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++, cell++) {
                float share = fire_share(cell);
                if (share <= 0) continue;
                Float3 position = float3_mad(fire->origin, float3((float)x, (float)y, (float)z), fire->cell);
                Float3 light = float3_scale(strength, share);
                add_to_cluster(clusters, fire->low, fire->high, position, light, float3_luminance(light));
            }
}

/// Turns the strongest clusters into lights until there are `limit`, and scales them to the total of all clusters.
static void choose_lights(PreviewScene *scene, Cluster *clusters, int limit, float softness) {
    float total = 0, kept = 0;
    int first = scene->light_count;
    for (int i = 0; i < CELLS; i++) total += clusters[i].weight;
    while (scene->light_count < limit) {
        int best = 0;
        for (int i = 1; i < CELLS; i++)
            if (clusters[i].weight > clusters[best].weight) best = i;
        Cluster *cluster = &clusters[best];
        if (!(cluster->weight > 0)) break;
        Float3 position = float3_scale(cluster->position, 1 / cluster->weight);
        add_light(scene, position, cluster->strength, softness, 1.5f * sqrtf(softness));
        kept += cluster->weight;
        cluster->weight = 0;
    }
    for (int i = first; i < scene->light_count && kept > 0; i++) {
        for (int c = 0; c < 3; c++) scene->lights.strength[c][i] *= total / kept;
        scene->lights.power[i] *= total / kept;
    }
}

void light_gather(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    scene->light_count = 0;
    scene->lights = (EmberLights){.x = {0}};
    for (int k = 0; k < LIGHT_LIMIT; k++) scene->lights.softness[k] = 1;
    add_shapes(preview);
    if (preview->fire.visible) {
        Cluster flames[CELLS] = {{{0, 0, 0}, {0, 0, 0}, 0}};
        gather_flames(preview, flames);
        float side = float3_length(float3_sub(preview->fire.high, preview->fire.low)) / GRID;
        int limit = scene->light_count + FLAME_LIGHTS;
        choose_lights(scene, flames, limit, 0.1f * side * side + 1e-4f);
    }
    Cluster clusters[CELLS] = {{{0, 0, 0}, {0, 0, 0}, 0}};
    for (uint32_t t = 0; t < scene->triangle_count; t++) gather_triangle(preview, scene->triangles[t], clusters);
    float cell = float3_length(float3_sub(scene->high, scene->low)) / GRID;
    choose_lights(scene, clusters, LIGHT_LIMIT, 0.02f * cell * cell + 4e-6f);
}
