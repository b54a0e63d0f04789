// The light at the points that a block of rays sees. Radiance of a diffuse surface of albedo a:
//
//     L = a [ E_sun max(n.l, 0) V + tau E_sun max(-n.l, 0) V + (E(n) + tau E(-n)) A + lamps ] + m S(r) F A
//
// with V, A the visibilities, tau the paper's transmission and E the ambient light (environment.c); V by rays to random
// points of the sun's disc, A by ambient-occlusion rays, each smoothed over neighbours (seen.c).
// Glossy surfaces reflect the blurred sky S along r. Metal and oiled wood mirror all lights in a lobe, wider across the
// scratches than along them (GGX: Walter et al. 2007; Burley 2012), S as well. Lamps are flames and embers (lamps.c).

#include "preview/block.h"

static const float occluded_sky = 0.22f; ///< light from occluded directions

/// What a lobe of that width mirrors where its half vector is aligned with the view, (Schlick 1994); less at grazing angles
/// than what is smooth.
static Float3 shine_fresnel(const Point *point, float aligned) {
    const float rest = 1 - clampf(aligned, 0, 1), rest2 = rest * rest, grazing = rest2 * rest2 * rest;
    const float most = 1 - maxf(point->rough[0], point->rough[1]);
    const Float3 f = point->shine;
    return float3(f.x + maxf(most - f.x, 0) * grazing, f.y + maxf(most - f.y, 0) * grazing,
                  f.z + maxf(most - f.z, 0) * grazing);
}

Float3 light_fresnel(const Point *point) { return shine_fresnel(point, float3_dot(point->normal, point->view)); }

Float3 light_shine(const Point *point, Float3 l, float wide) {
    const float nl = float3_dot(point->normal, l), nv = maxf(float3_dot(point->normal, point->view), 0.02f);
    if (nl <= 0 || point->shine.x <= 0) return float3(0, 0, 0);
    const Float3 half = float3_unit_or(float3_add(l, point->view), point->normal);
    const float hn = float3_dot(half, point->normal), hx = float3_dot(half, point->brush);
    const float along2 = point->rough[0] * point->rough[0] + 0.25f * wide;
    const float across2 = point->rough[1] * point->rough[1] + 0.25f * wide;
    const float slope = hx * hx / along2 + maxf(1 - hn * hn - hx * hx, 0) / across2 + hn * hn;
    if (slope > 40) return float3(0, 0, 0); // the lobe is dark there
    const float k = 0.5f * point->rough[1], masked = 0.25f / ((nl * (1 - k) + k) * (nv * (1 - k) + k));
    return float3_scale(shine_fresnel(point, float3_dot(half, point->view)),
                        nl * masked / (sqrtf(along2 * across2) * slope * slope));
}

Float3 light_shine_of_lamps(const PreviewScene *scene, const Point *point) {
    const EmberLights *l = &scene->lights;
    Float3 sum = {0, 0, 0};
    for (int k = 0; k < scene->light_count; k++) {
        if (point->glints && k >= scene->flames[0] && k < scene->flames[1]) continue; // it mirrors themselves
        Float3 to = float3_sub(float3(l->x[k], l->y[k], l->z[k]), point->position);
        const float d2 = float3_dot(to, to) + l->softness[k], wide = l->softness[k] / d2;
        Float3 light = float3_scale(float3(l->strength[0][k], l->strength[1][k], l->strength[2][k]), 1 / d2);
        sum = float3_add(sum, float3_mul(light, light_shine(point, float3_scale(to, 1 / sqrtf(d2)), wide)));
    }
    return sum;
}

Float3 light_reflect(const Point *point, Float3 l) {
    float cosine = float3_dot(point->normal, l), side = float3_dot(point->geometric, l);

    if (side <= 0)
        return float3_scale(float3_mul(point->albedo, point->through), point->transmission * maxf(-cosine, 0));
    if (cosine <= 0) return float3(0, 0, 0);

    Float3 out = float3_scale(point->albedo, cosine);
    if (point->gloss > 0) {
        Float3 half = float3_unit_or(float3_add(l, point->view), point->normal);
        float aligned = float3_dot(half, point->normal);
        if (aligned < 0.6f) return out; // the lobe is dark there
        // aligned^shininess by (1 - x/8)^8, near enough to exp(-x)
        float p = maxf(1 - (1 - aligned) * point->shininess * 0.125f, 0);
        p *= p;
        p *= p;
        float lobe = point->gloss * p * p;
        out = float3_add(out, float3(lobe, lobe, lobe));
    }

    return out;
}

float light_mirrored(const Point *point) {
    float rest = 1 - maxf(float3_dot(point->normal, point->view), 0), rest2 = rest * rest;
    return point->mirror * (0.06f + 0.54f * rest2 * rest2 * rest);
}

bool light_reaches(const Block *block, const int *active, int lane) {
    return active[lane] && block->point[lane].lit && block->point[lane].fade < 0.995f;
}

/// Whether light of a kind adds too little to what else lights the lane's point for its shadow to be seen: under 2 % of it.
/// Lamps are added before, in every sample.
static bool is_outshone(const Block *block, int lane, float luminance) {
    const float lamps = float3_luminance(block->lit[LIT_LAMPS][lane]) / (float)block->layer[lane].samples;
    return luminance < 0.02f * lamps;
}

void light_count(Block *block, int kind, const float asked[LANES], const float open[LANES]) {
    int count = 0, clear = 0, blocked = 0;
    for (int i = 0; i < LANES; i++) {
        if (!(asked[i] > 0)) continue;
        block->lit_asked[kind][i] += asked[i];
        block->lit_seen[kind][i] += asked[i] * open[i];
        count++;
        clear += block->clear[i] > 0.99f;
        blocked += block->clear[i] < 0.01f;
    }

    const bool even = clear == count || blocked == count;
    block->settled[kind] = block->settled[kind] || (even && count >= LANES / 2);
    block->hidden = block->hidden || (!even && kind != LIT_LAMPS);
}

void light_add_sun(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES],
                   const int *ask) {
    float asked[LANES];
    bool any = false;
    for (int i = 0; i < LANES; i++) {
        asked[i] = 0;
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!light_reaches(block, active, i)) continue;
        const Point *point = &block->point[i];
        float square[2] = {0, 0}, disc[2];
        if (sample != SAMPLE_CENTRE) sample_square((uint32_t)sample, block->turn[i][0], block->turn[i][1], square);
        sample_disc(square, disc);
        Float3 l = float3_mad(preview->sun, preview->sun_right, disc[0] * preview->sun_spread);
        l = float3_unit_or(float3_mad(l, preview->sun_up, disc[1] * preview->sun_spread), preview->sun);
        // metal mirrors the whole of its disc: a lobe that is narrower would show single rays
        const Float3 shone = light_shine(point, preview->sun, preview->sun_spread * preview->sun_spread);
        const Float3 reflected = float3_add(light_reflect(point, l), shone);
        Float3 light = float3_scale(float3_mul(reflected, preview->sun_light), through[i]);
        block->lit[LIT_SUN][i] = float3_add(block->lit[LIT_SUN][i], light);
        asked[i] = float3_luminance(light);
        if (!ask[i] || asked[i] < 1e-4f || is_outshone(block, i, asked[i])) continue;
        float side = float3_dot(point->geometric, l) > 0 ? preview->scene.epsilon : -preview->scene.epsilon;
        aim_ray(&block->shadow, i, float3_mad(point->position, point->geometric, side), l, 0, INFINITY, block->time[i]);
        block->valid[i] = -1;
        any = true;
    }

    if (!any) return;
    for (int i = 0; i < LANES; i++) asked[i] = block->valid[i] ? asked[i] : 0;
    tracer_occlude(preview, block->valid, &block->shadow, block->clear);
    light_count(block, LIT_SUN, asked, block->clear);
}

/// Length of ambient-occlusion rays.
static float sky_reach(const PreviewScene *scene) {
    return 0.28f * float3_length(float3_sub(scene->high, scene->low)) + 0.01f;
}

/// Whether the surface's bounds or a shape are nearer to the point than `reach`.
static bool sky_may_be_hidden(const Preview *preview, Float3 p, float reach) {
    const Float3 low = preview->scene.low, high = preview->scene.high;
    if (p.x > low.x - reach && p.x < high.x + reach && p.y > low.y - reach && p.y < high.y + reach &&
        p.z > low.z - reach && p.z < high.z + reach)
        return true;
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        float near = shape_extent(&preview->shapes[k], preview->def.shutter) + reach;
        Float3 to = float3_sub(shape_centre(&preview->shapes[k]), p);
        if (float3_dot(to, to) < near * near && shape_near(&preview->shapes[k], p, preview->sun, 0, near)) return true;
    }

    return false;
}

bool light_may_be_hidden(const Preview *preview, const Block *block, const int *active) {
    int first = 0;
    while (first < LANES && !light_reaches(block, active, first)) first++;
    if (first == LANES) return false;

    Float3 p = block->point[first].position;
    float spread = 0;
    for (int i = first + 1; i < LANES; i++)
        if (light_reaches(block, active, i))
            spread = maxf(spread, float3_length(float3_sub(block->point[i].position, p)));

    // a low sheet far away occludes too little of the table's sky to be seen: under 2 % where its height is less than
    // 0.28 of the distance
    float reach = minf(sky_reach(&preview->scene), 3.5f * maxf(preview->scene.high.z - p.z, 0));
    if (sky_may_be_hidden(preview, p, reach + spread)) return true;

    // the sun is a disc: its rays spread by sun_spread times their length, and the margin is a little more than that
    const PreviewScene *scene = &preview->scene;
    const Float3 sun = preview->sun;
    const float margin = 1.5f * preview->sun_spread, rise = maxf(scene->high.z - p.z, 0) / maxf(sun.z, 0.02f);
    if (scene->triangle_count && tracer_near(scene, p, sun, INFINITY, margin * rise + spread)) return true;

    for (uint32_t k = 0; k < preview->shape_count; k++) {
        Float3 to = float3_sub(shape_centre(&preview->shapes[k]), p);
        float along = float3_dot(to, sun), extent = shape_extent(&preview->shapes[k], preview->def.shutter);
        Float3 aside = float3_mad(to, sun, -along);
        float near = extent + spread + margin * maxf(along + extent, 0);
        if (along > -extent - spread && float3_dot(aside, aside) < near * near &&
            shape_near(&preview->shapes[k], p, sun, INFINITY, near))
            return true;
    }

    return false;
}

/// Finds the open share of each point's sky by one ray.
static void ask_sky(const Preview *preview, Block *block, const float asked[LANES], int sample) {
    float open[LANES];
    float reach = sky_reach(&preview->scene);
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!(asked[i] > 0)) continue;
        const Point *point = &block->point[i];
        if (sample == SAMPLE_CENTRE || !sky_may_be_hidden(preview, point->position, reach)) continue;
        float square[2];
        sample_square((uint32_t)sample, block->turn[i][1], block->turn[i][0], square);
        Float3 d = sample_cosine(point->normal, square);
        if (float3_dot(d, point->geometric) <= 0.01f) continue;
        aim_ray(&block->shadow, i, float3_mad(point->position, point->geometric, preview->scene.epsilon), d, 0, reach,
                block->time[i]);
        block->valid[i] = -1;
    }

    tracer_occlude(preview, block->valid, &block->shadow, block->clear);
    for (int i = 0; i < LANES; i++) open[i] = mixf(occluded_sky, 1, block->clear[i]);
    light_count(block, LIT_SKY, asked, open);
}

void light_add_sky(const Preview *preview, Block *block, const int *active, int sample, const float through[LANES],
                   const int *ask) {
    float asked[LANES];
    bool any = false;
    for (int i = 0; i < LANES; i++) {
        asked[i] = 0;
        if (!light_reaches(block, active, i)) continue;
        const Point *point = &block->point[i];
        Float3 ambient = sky_ambient(&preview->sky, point->normal);

        // thin paper also transmits light from its other side
        if (point->transmission > 0)
            ambient = float3_mad(
                ambient, float3_mul(point->through, sky_ambient(&preview->sky, float3_scale(point->normal, -1))),
                point->transmission);
        Float3 light = float3_mul(point->albedo, ambient);

        // dull surfaces reflect more at grazing angles (Schlick 1994), but less than smooth ones
        if (point->mirror > 0) {
            float cosine = maxf(float3_dot(point->normal, point->view), 0);
            Float3 out = float3_mad(float3_scale(point->view, -1), point->normal, 2 * cosine);
            float clear = light_mirrored(point) * (1 - point->mirrored.share);
            light = float3_add(light, float3_scale(sky_mirrored(&preview->sky, out), clear));
        }

        if (point->shine.x > 0 && !point->glints) {
            const float cosine = maxf(float3_dot(point->normal, point->view), 0);
            Float3 out = float3_mad(float3_scale(point->view, -1), point->normal, 2 * cosine);
            light = float3_add(light, float3_mul(light_fresnel(point), sky_mirrored(&preview->sky, out)));
        }

        light = float3_scale(light, through[i]);
        block->lit[LIT_SKY][i] = float3_add(block->lit[LIT_SKY][i], light);
        const float luminance = float3_luminance(light);
        if (!ask[i] || luminance < 1e-6f || is_outshone(block, i, luminance)) continue;
        asked[i] = luminance;
        any = true;
    }

    if (any) ask_sky(preview, block, asked, sample);
}
