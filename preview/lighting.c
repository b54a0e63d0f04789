// The light at the points that a block of rays sees. Radiance of a diffuse surface of albedo a:
//
//     L = a [ E_sun max(n.l, 0) V + tau E_sun max(-n.l, 0) V + (E(n) + tau E(-n)) A + embers ] + m S(r) F A
//
// with V, A the visibilities, tau the paper's transmission and E the light of all around (environment.c); V by a ray to
// a random point of the sun's disc, A by an ambient-occlusion ray. What shines mirrors the blurred sky S along r.

#include "preview/block.h"

static const float occluded_sky = 0.22f; ///< light that still comes from where the sky is hidden

/// Reflected share of the light along l, per unit of irradiance: diffuse and a Blinn-Phong lobe.
static V3 reflect(const Point *point, V3 l) {
    float cosine = v3_dot(point->normal, l), side = v3_dot(point->geometric, l);
    // what comes through has been scattered often, and is warmer for it
    const V3 warm = {1.35f, 1.12f, 0.80f};
    if (side <= 0) return v3_scale(v3_mul(point->albedo, warm), point->transmission * maxf(-cosine, 0));
    if (cosine <= 0) return v3(0, 0, 0);
    V3 out = v3_scale(point->albedo, cosine);
    if (point->gloss > 0) {
        V3 half = v3_unit(v3_add(l, point->view), point->normal);
        float aligned = v3_dot(half, point->normal);
        if (aligned < 0.6f) return out; // the lobe is dark there
        // aligned^shininess by (1 - x/8)^8, near enough to exp(-x)
        float p = maxf(1 - (1 - aligned) * point->shininess * 0.125f, 0);
        p *= p, p *= p;
        float lobe = point->gloss * p * p;
        out = v3_add(out, v3(lobe, lobe, lobe));
    }
    return out;
}

static bool is_lit(const Block *block, const int *active, int lane) {
    return active[lane] && block->point[lane].lit && block->point[lane].fade < 0.995f;
}

void light_add_sun(const Preview *preview, Block *block, const int *active, int sample) {
    V3 reflected[LANES];
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!is_lit(block, active, i)) continue;
        const Point *point = &block->point[i];
        float square[2] = {0, 0}, disc[2];
        if (sample != SAMPLE_MIDDLE) sample_square((uint32_t)sample, block->turn[i][0], block->turn[i][1], square);
        sample_disc(square, disc);
        V3 l = v3_mad(preview->sun, preview->sun_right, disc[0] * preview->sun_spread);
        l = v3_unit(v3_mad(l, preview->sun_up, disc[1] * preview->sun_spread), preview->sun);
        reflected[i] = reflect(point, l);
        if (reflected[i].x + reflected[i].y + reflected[i].z < 1e-4f) continue;
        float side = v3_dot(point->geometric, l) > 0 ? preview->scene.epsilon : -preview->scene.epsilon;
        aim_ray(&block->shadow, i, v3_mad(point->position, point->geometric, side), l, 0, INFINITY, block->time[i]);
        block->valid[i] = -1;
    }
    int asked[LANES];
    for (int i = 0; i < LANES; i++) asked[i] = block->valid[i];
    tracer_occlude(preview, block->valid, &block->shadow, block->blocked);
    V3 sun = preview->sun_light;
    for (int i = 0; i < LANES; i++)
        if (asked[i] && !block->blocked[i]) block->light[i] = v3_add(block->light[i], v3_mul(reflected[i], sun));
}

/// Whether the point is nearer than `reach` to the surface's bounds.
static bool within(const Scene *scene, V3 p, float reach) {
    return p.x > scene->low.x - reach && p.x < scene->high.x + reach && p.y > scene->low.y - reach &&
           p.y < scene->high.y + reach && p.z > scene->low.z - reach && p.z < scene->high.z + reach;
}

/// Length of the rays that ask how much of the sky is hidden.
static float sky_reach(const Scene *scene) { return 0.28f * v3_length(v3_sub(scene->high, scene->low)) + 0.01f; }

static bool sky_may_be_hidden(const Preview *preview, V3 p, float reach) {
    if (within(&preview->scene, p, reach)) return true;
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        float near = shape_extent(&preview->shapes[k], preview->def.shutter) + reach;
        V3 to = v3_sub(shape_middle(&preview->shapes[k]), p);
        if (v3_dot(to, to) < near * near) return true;
    }
    return false;
}

/// The sun is a disc: its rays spread by sun_spread of the way they go. The margin is a little more than that.
static bool sun_may_be_hidden(const Preview *preview, V3 p, float margin) {
    const Scene *scene = &preview->scene;
    V3 sun = preview->sun;
    float spread = 1.5f * preview->sun_spread, rise = maxf(scene->high.z - p.z, 0) / maxf(sun.z, 0.02f);
    if (scene->triangle_count && tracer_near(scene, p, sun, INFINITY, spread * rise + margin)) return true;
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        V3 to = v3_sub(shape_middle(&preview->shapes[k]), p);
        float along = v3_dot(to, sun), extent = shape_extent(&preview->shapes[k], preview->def.shutter);
        V3 aside = v3_mad(to, sun, -along);
        float near = extent + margin + spread * maxf(along + extent, 0);
        if (along > -extent - margin && v3_dot(aside, aside) < near * near) return true;
    }
    return false;
}

/// A low sheet far away hides too little of the table's sky to be seen: under 2 % where its height is less than
/// 0.28 of the distance.
static float table_reach(const Scene *scene, V3 p) {
    return minf(sky_reach(scene), 3.5f * maxf(scene->high.z - p.z, 0));
}

bool light_may_be_hidden(const Preview *preview, const Block *block, const int *active) {
    int first = 0;
    while (first < LANES && !is_lit(block, active, first)) first++;
    if (first == LANES) return false;
    V3 p = block->point[first].position;
    float spread = 0;
    for (int i = first + 1; i < LANES; i++)
        if (is_lit(block, active, i)) spread = maxf(spread, v3_length(v3_sub(block->point[i].position, p)));
    return sky_may_be_hidden(preview, p, table_reach(&preview->scene, p) + spread) ||
           sun_may_be_hidden(preview, p, spread);
}

/// The sky in a dull gloss, more of it at grazing angles (Schlick 1994), though less than a smooth face would.
static V3 mirror_sky(const Sky *sky, const Point *point) {
    float cosine = maxf(v3_dot(point->normal, point->view), 0), rest = 1 - cosine, rest2 = rest * rest;
    V3 out = v3_mad(v3_scale(point->view, -1), point->normal, 2 * cosine);
    return v3_scale(sky_mirrored(sky, out), point->mirror * (0.06f + 0.54f * rest2 * rest2 * rest));
}

void light_add_sky(const Preview *preview, Block *block, const int *active, int sample) {
    float reach = sky_reach(&preview->scene);
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!is_lit(block, active, i)) continue;
        const Point *point = &block->point[i];
        if (sample == SAMPLE_MIDDLE || !sky_may_be_hidden(preview, point->position, reach)) continue;
        float square[2];
        sample_square((uint32_t)sample, block->turn[i][1], block->turn[i][0], square);
        V3 d = sample_cosine(point->normal, square);
        if (v3_dot(d, point->geometric) <= 0.01f) continue;
        aim_ray(&block->shadow, i, v3_mad(point->position, point->geometric, preview->scene.epsilon), d, 0, reach,
                block->time[i]);
        block->valid[i] = -1;
    }
    tracer_occlude(preview, block->valid, &block->shadow, block->blocked);
    for (int i = 0; i < LANES; i++) {
        if (!is_lit(block, active, i)) continue;
        const Point *point = &block->point[i];
        V3 ambient = sky_ambient(&preview->sky, point->normal);
        // thin paper also passes some of what falls on its other side
        if (point->transmission > 0)
            ambient = v3_mad(ambient, sky_ambient(&preview->sky, v3_scale(point->normal, -1)), point->transmission);
        V3 light = v3_mul(point->albedo, ambient);
        if (point->mirror > 0) light = v3_add(light, mirror_sky(&preview->sky, point));
        block->light[i] = v3_mad(block->light[i], light, block->blocked[i] ? occluded_sky : 1);
    }
}

V3 light_embers(const Scene *scene, const Point *point, int first, int stride) {
    const EmberLights *l = &scene->lights;
    V3 p = point->position, n = point->normal;
    float least = 0.5f * point->transmission, weight[LIGHT_LIMIT];
    // by arrays: four lights at a time
    for (int k = 0; k < LIGHT_LIMIT; k++) {
        float x = l->x[k] - p.x, y = l->y[k] - p.y, z = l->z[k] - p.z;
        float d2 = x * x + y * y + z * z + l->softness[k], cosine = (n.x * x + n.y * y + n.z * z) / sqrtf(d2);
        // wrapped: clusters have an extent that a point does not, and the sheet they lie in must be lit too
        weight[k] = maxf((cosine + 0.25f) * 0.8f, least) / d2;
    }
    V3 sum = {0, 0, 0};
    for (int k = first; k < scene->light_count; k += stride) sum = v3_mad(sum, l->strength[k], weight[k]);
    return v3_scale(v3_mul(sum, point->albedo), (float)stride);
}
