// The light at the points that a block of rays sees. Radiance of a diffuse surface of albedo a:
//
//     L = a [ E_sun max(n.l, 0) V + tau E_sun max(-n.l, 0) V + (E(n) + tau E(-n)) A + lamps ] + m S(r) F A
//
// with V, A the visibilities, tau the paper's transmission and E the light of all around (environment.c); V by a ray to
// a random point of the sun's disc, or several where the block has found the rim of a shadow; A by an ambient-occlusion
// ray. What shines mirrors the blurred sky S along r. Lamps are flames and embers (lamps.c).

#include "preview/block.h"

static const float occluded_sky = 0.22f; ///< light that still comes from where the sky is hidden

V3 light_reflect(const Point *point, V3 l) {
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

bool light_reaches(const Block *block, const int *active, int lane) {
    return active[lane] && block->point[lane].lit && block->point[lane].fade < 0.995f;
}

/// One ray a lane; `share` of what it finds is added.
static void add_sun_ray(const Preview *preview, Block *block, const int *active, int index, float share) {
    V3 reflected[LANES];
    int asked[LANES];
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = asked[i] = 0;
        rest_ray(&block->shadow, i);
        if (!light_reaches(block, active, i)) continue;
        const Point *point = &block->point[i];
        float square[2] = {0, 0}, disc[2];
        if (index != SAMPLE_MIDDLE) sample_square((uint32_t)index, block->turn[i][0], block->turn[i][1], square);
        sample_disc(square, disc);
        V3 l = v3_mad(preview->sun, preview->sun_right, disc[0] * preview->sun_spread);
        l = v3_unit(v3_mad(l, preview->sun_up, disc[1] * preview->sun_spread), preview->sun);
        reflected[i] = light_reflect(point, l);
        if (reflected[i].x + reflected[i].y + reflected[i].z < 1e-4f) continue;
        float side = v3_dot(point->geometric, l) > 0 ? preview->scene.epsilon : -preview->scene.epsilon;
        aim_ray(&block->shadow, i, v3_mad(point->position, point->geometric, side), l, 0, INFINITY, block->time[i]);
        block->valid[i] = asked[i] = -1;
    }
    tracer_occlude(preview, block->valid, &block->shadow, block->clear);
    for (int i = 0; i < LANES; i++) {
        if (!asked[i]) continue;
        block->light[i] = v3_mad(block->light[i], v3_mul(reflected[i], preview->sun_light), share * block->clear[i]);
        block->sunlit = block->sunlit || block->clear[i] > 0.99f, block->shaded = block->shaded || block->clear[i] < 0.99f;
        block->sun_seen += block->clear[i], block->sun_asked++;
    }
}

/// Light from the sun's middle, of which as much comes as the block's rays have found: without another one.
static void add_known_sun(const Preview *preview, Block *block, const int *active) {
    float seen = block->sun_asked ? block->sun_seen / (float)block->sun_asked : 1;
    for (int i = 0; i < LANES; i++)
        if (light_reaches(block, active, i))
            block->light[i] = v3_mad(block->light[i], v3_mul(light_reflect(&block->point[i], preview->sun),
                                                            preview->sun_light), seen);
}

void light_add_sun(const Preview *preview, Block *block, const int *active, int sample, int rays) {
    if (!rays) add_known_sun(preview, block, active);
    for (int k = 0; k < rays; k++)
        add_sun_ray(preview, block, active, sample == SAMPLE_MIDDLE ? SAMPLE_MIDDLE : sample * rays + k, 1 / (float)rays);
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
    while (first < LANES && !light_reaches(block, active, first)) first++;
    if (first == LANES) return false;
    V3 p = block->point[first].position;
    float spread = 0;
    for (int i = first + 1; i < LANES; i++)
        if (light_reaches(block, active, i)) spread = maxf(spread, v3_length(v3_sub(block->point[i].position, p)));
    return sky_may_be_hidden(preview, p, table_reach(&preview->scene, p) + spread) ||
           sun_may_be_hidden(preview, p, spread);
}

/// The sky in a dull gloss, more of it at grazing angles (Schlick 1994), though less than a smooth face would.
static V3 mirror_sky(const Sky *sky, const Point *point) {
    float cosine = maxf(v3_dot(point->normal, point->view), 0), rest = 1 - cosine, rest2 = rest * rest;
    V3 out = v3_mad(v3_scale(point->view, -1), point->normal, 2 * cosine);
    return v3_scale(sky_mirrored(sky, out), point->mirror * (0.06f + 0.54f * rest2 * rest2 * rest));
}

/// Asks by a ray each what share of the points' sky is open.
static void ask_sky(const Preview *preview, Block *block, const int *active, int sample) {
    float reach = sky_reach(&preview->scene);
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!light_reaches(block, active, i)) continue;
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
    tracer_occlude(preview, block->valid, &block->shadow, block->clear);
    for (int i = 0; i < LANES; i++) {
        block->open[i] = mixf(occluded_sky, 1, block->clear[i]);
        block->sky_seen[i] += block->open[i], block->sky_asked[i]++;
        block->clouded = block->clouded || block->clear[i] < 1;
    }
}

void light_add_sky(const Preview *preview, Block *block, const int *active, int sample, bool ask) {
    if (ask) ask_sky(preview, block, active, sample);
    for (int i = 0; i < LANES; i++) {
        if (!light_reaches(block, active, i)) continue;
        const Point *point = &block->point[i];
        V3 ambient = sky_ambient(&preview->sky, point->normal);
        // thin paper also passes some of what falls on its other side
        if (point->transmission > 0)
            ambient = v3_mad(ambient, sky_ambient(&preview->sky, v3_scale(point->normal, -1)), point->transmission);
        V3 light = v3_mul(point->albedo, ambient);
        if (point->mirror > 0) light = v3_add(light, mirror_sky(&preview->sky, point));
        float open = ask ? block->open[i] : block->sky_seen[i] / (float)block->sky_asked[i];
        block->light[i] = v3_mad(block->light[i], light, open);
    }
}
