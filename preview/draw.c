// One frame: tiles of blocks of 4 x 4 pixels, a packet of 16 rays per block and sample.
//
// A sample is: the nearest surface; its look; light = sun (a ray to a random point of its disc) + sky and bounce
// (one ambient-occlusion ray) + embers (point sources). Radiance of a diffuse surface of albedo a:
//
//     L = a [ E_sun max(n.l, 0) V + tau E_sun max(-n.l, 0) V + (sky (1 + n_z)/2 + bounce (1 - n_z)/2) A + embers ]
//
// with V, A the visibilities and tau the paper's transmission. Pixels whose first half of samples agree stop there.
// Everything random comes from the pixel's place and the sample's number, so threads do not matter.

#include "preview/internal.h"

#include <pthread.h>
#include <stdatomic.h>

enum { HOLE_LIMIT = 4 };
static const float occluded_sky = 0.22f; ///< light that still comes from where the sky is hidden

typedef struct Block {
    struct RTCRayHit16 rays;
    struct RTCRay16 shadow;
    _Alignas(64) int valid[LANES];
    int x[LANES], y[LANES];
    float turn[LANES][2];
    V3 direction[LANES], light[LANES], sum[LANES];
    Point point[LANES];
    float low[LANES], high[LANES];
    bool blocked[LANES];
} Block;

typedef struct Job {
    Preview *preview;
    atomic_int next;
    int across, count;
} Job;

static void aim_ray(struct RTCRay16 *ray, int lane, V3 origin, V3 direction, float near, float far) {
    ray->org_x[lane] = origin.x, ray->org_y[lane] = origin.y, ray->org_z[lane] = origin.z;
    ray->dir_x[lane] = direction.x, ray->dir_y[lane] = direction.y, ray->dir_z[lane] = direction.z;
    ray->tnear[lane] = near, ray->tfar[lane] = far;
    ray->time[lane] = 0, ray->mask[lane] = ~0u, ray->id[lane] = (unsigned)lane, ray->flags[lane] = 0;
}

static void rest_ray(struct RTCRay16 *ray, int lane) { aim_ray(ray, lane, v3(0, 0, 0), v3(0, 0, 1), 0, -1); }

static void aim_block(const Preview *preview, Block *block, int sample) {
    float at[2];
    sample_square((uint32_t)sample, 0.5f, 0.5f, at);
    // a tent of radius 0.9 pixel: softer than a box, no ringing
    for (int c = 0; c < 2; c++) at[c] = 0.9f * (at[c] < 0.5f ? sqrtf(2 * at[c]) - 1 : 1 - sqrtf(2 - 2 * at[c]));
    for (int i = 0; i < LANES; i++) {
        float x = 2 * ((float)block->x[i] + 0.5f + at[0]) / (float)preview->def.width - 1;
        float y = 1 - 2 * ((float)block->y[i] + 0.5f + at[1]) / (float)preview->def.height;
        block->direction[i] = camera_ray(&preview->camera, x, y);
        aim_ray(&block->rays.ray, i, preview->camera.eye, block->direction[i], 0, INFINITY);
    }
}

static void start_point(Point *point, const Preview *preview, V3 direction, float distance) {
    *point = (Point){.lit = true, .view = v3_scale(direction, -1)};
    point->position = v3_mad(preview->camera.eye, direction, distance);
    point->footprint = preview->camera.pixel * distance;
}

static V3 blend(const float *a, const float *b, const float *c, float u, float v) {
    float w = 1 - u - v;
    return v3(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1], w * a[2] + u * b[2] + v * c[2]);
}

/// The look of the sheet at a hit; false at a hole.
static bool hit_paper(const Preview *preview, const struct RTCHit16 *hit, int lane, float distance, V3 direction,
                      Point *point) {
    const uint32_t *t = preview->scene.triangles[hit->primID[lane]];
    const PaperVertex *vertices = preview->scene.vertices;
    const PaperVertex *a = &vertices[t[0]], *b = &vertices[t[1]], *c = &vertices[t[2]];
    float u = hit->u[lane], v = hit->v[lane], w = 1 - u - v;
    start_point(point, preview, direction, distance);
    V3 geometric = v3_unit(v3(hit->Ng_x[lane], hit->Ng_y[lane], hit->Ng_z[lane]), point->view);
    V3 normal = v3_unit(blend(a->normal, b->normal, c->normal, u, v), geometric);
    point->geometric = v3_dot(geometric, point->view) >= 0 ? geometric : v3_scale(geometric, -1);
    point->normal = v3_dot(normal, point->geometric) >= 0 ? normal : v3_scale(normal, -1);
    PaperState state = {
        .rest = blend(a->rest, b->rest, c->rest, u, v),
        .uv = {w * a->uv[0] + u * b->uv[0] + v * c->uv[0], w * a->uv[1] + u * b->uv[1] + v * c->uv[1]},
        .temperature = w * a->temperature + u * b->temperature + v * c->temperature,
        .peak = w * a->peak + u * b->peak + v * c->peak,
        .burn = w * a->burn + u * b->burn + v * c->burn,
        .burn_rate = w * a->burn_rate + u * b->burn_rate + v * c->burn_rate,
        .gradient = w * a->gradient + u * b->gradient + v * c->gradient,
        .sheet = a->sheet,
    };
    return paper_shade(preview, &state, point);
}

static float hit_ground(const Preview *preview, V3 direction) {
    float height = preview->camera.eye.z - preview->def.ground_height;
    if (!isfinite(preview->def.ground_height) || height <= 0 || direction.z >= -1e-5f) return INFINITY;
    float t = -height / direction.z;
    return t < 1e4f ? t : INFINITY;
}

/// What the ray of a lane sees; false when it passes through a hole and must go on.
static bool resolve(const Preview *preview, Block *block, int lane, bool last) {
    V3 d = block->direction[lane], normal = {0, 0, 1}, found = {0, 0, 1};
    Point *point = &block->point[lane];
    bool paper = block->rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    float distance = paper ? block->rays.ray.tfar[lane] : INFINITY;
    const PreviewShape *shape = NULL;
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        float t = shape_intersect(&preview->shapes[k], preview->camera.eye, d, 0, distance, &normal);
        if (t > 0) distance = t, shape = &preview->shapes[k], found = normal;
    }
    float ground = hit_ground(preview, d);
    if (ground < distance) {
        start_point(point, preview, d, ground);
        ground_shade(preview, ground, point);
    } else if (shape) {
        start_point(point, preview, d, distance);
        point->normal = point->geometric = v3_dot(found, point->view) >= 0 ? found : v3_scale(found, -1);
        shape_shade(preview, shape, point);
    } else if (paper) {
        return hit_paper(preview, &block->rays.hit, lane, distance, d, point) || last;
    } else {
        *point = (Point){.emission = background_colour(preview, d)};
    }
    return true;
}

static void find_points(const Preview *preview, Block *block, const int *active) {
    int left = 0;
    for (int i = 0; i < LANES; i++) block->valid[i] = active[i], left += active[i] != 0;
    for (int pass = 0; pass < HOLE_LIMIT && left; pass++) {
        tracer_intersect(preview, block->valid, &block->rays);
        left = 0;
        for (int i = 0; i < LANES; i++) {
            if (!block->valid[i]) continue;
            if (resolve(preview, block, i, pass == HOLE_LIMIT - 1)) {
                block->valid[i] = 0;
            } else {
                block->rays.ray.tnear[i] = block->rays.ray.tfar[i] + preview->scene.epsilon;
                block->rays.ray.tfar[i] = INFINITY;
                left++;
            }
        }
    }
}

/// Reflected share of the light along l, per unit of irradiance: diffuse and a Blinn-Phong lobe.
static V3 reflect(const Point *point, V3 l) {
    float cosine = v3_dot(point->normal, l), side = v3_dot(point->geometric, l);
    if (side <= 0) return v3_scale(point->albedo, point->transmission * maxf(-cosine, 0));
    if (cosine <= 0) return v3(0, 0, 0);
    V3 out = v3_scale(point->albedo, cosine);
    if (point->gloss > 0) {
        V3 half = v3_unit(v3_add(l, point->view), point->normal);
        float aligned = v3_dot(half, point->normal);
        if (aligned < 0.6f) return out; // the lobe is dark there
        float lobe = point->gloss * powf(aligned, point->shininess);
        out = v3_add(out, v3(lobe, lobe, lobe));
    }
    return out;
}

static bool is_lit(const Block *block, const int *active, int lane) {
    return active[lane] && block->point[lane].lit && block->point[lane].fade < 0.995f;
}

static void add_sun(const Preview *preview, Block *block, const int *active, int sample) {
    V3 reflected[LANES];
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!is_lit(block, active, i)) continue;
        const Point *point = &block->point[i];
        float square[2], disc[2];
        sample_square((uint32_t)sample, block->turn[i][0], block->turn[i][1], square);
        sample_disc(square, disc);
        V3 l = v3_mad(preview->sun, preview->sun_right, disc[0] * preview->sun_spread);
        l = v3_unit(v3_mad(l, preview->sun_up, disc[1] * preview->sun_spread), preview->sun);
        reflected[i] = reflect(point, l);
        if (reflected[i].x + reflected[i].y + reflected[i].z < 1e-4f) continue;
        float side = v3_dot(point->geometric, l) > 0 ? preview->scene.epsilon : -preview->scene.epsilon;
        aim_ray(&block->shadow, i, v3_mad(point->position, point->geometric, side), l, 0, INFINITY);
        block->valid[i] = -1;
    }
    int asked[LANES];
    for (int i = 0; i < LANES; i++) asked[i] = block->valid[i];
    tracer_occlude(preview, block->valid, &block->shadow, block->blocked);
    V3 sun = v3_load(preview->def.sun_colour);
    for (int i = 0; i < LANES; i++)
        if (asked[i] && !block->blocked[i]) block->light[i] = v3_add(block->light[i], v3_mul(reflected[i], sun));
}

/// Whether the point is nearer than `reach` to the surface's bounds.
static bool within(const Scene *scene, V3 p, float reach) {
    return p.x > scene->low.x - reach && p.x < scene->high.x + reach && p.y > scene->low.y - reach &&
           p.y < scene->high.y + reach && p.z > scene->low.z - reach && p.z < scene->high.z + reach;
}

static void add_sky(const Preview *preview, Block *block, const int *active, int sample) {
    const PreviewDef *def = &preview->def;
    float reach = 0.28f * v3_length(v3_sub(preview->scene.high, preview->scene.low)) + 0.01f;
    for (int i = 0; i < LANES; i++) {
        block->valid[i] = 0;
        rest_ray(&block->shadow, i);
        if (!is_lit(block, active, i)) continue;
        const Point *point = &block->point[i];
        if (!preview->shape_count && !within(&preview->scene, point->position, reach)) continue;
        float square[2];
        sample_square((uint32_t)sample, block->turn[i][1], block->turn[i][0], square);
        V3 d = sample_cosine(point->normal, square);
        if (v3_dot(d, point->geometric) <= 0.01f) continue;
        aim_ray(&block->shadow, i, v3_mad(point->position, point->geometric, preview->scene.epsilon), d, 0, reach);
        block->valid[i] = -1;
    }
    tracer_occlude(preview, block->valid, &block->shadow, block->blocked);
    bool table = isfinite(def->ground_height);
    V3 sky = v3_load(def->sky_colour), sun = v3_scale(v3_load(def->sun_colour), maxf(preview->sun.z, 0));
    V3 bounce = table ? v3_mul(v3_load(def->ground_colour), v3_mad(sky, sun, 0.8f)) : v3_scale(sky, 0.5f);
    for (int i = 0; i < LANES; i++) {
        if (!is_lit(block, active, i)) continue;
        const Point *point = &block->point[i];
        float open = block->blocked[i] ? occluded_sky : 1;
        V3 ambient = v3_mix(bounce, sky, 0.5f + 0.5f * point->normal.z);
        // thin paper also passes some of what falls on its other side
        ambient = v3_mad(ambient, v3_mix(sky, bounce, 0.5f + 0.5f * point->normal.z), point->transmission);
        block->light[i] = v3_mad(block->light[i], v3_mul(point->albedo, ambient), open);
    }
}

static V3 ember_light(const Scene *scene, const Point *point, int first, int stride) {
    V3 sum = {0, 0, 0};
    for (int k = first; k < scene->light_count; k += stride) {
        const EmberLight *light = &scene->lights[k];
        V3 to = v3_sub(light->position, point->position);
        float d2 = v3_dot(to, to) + light->softness, cosine = v3_dot(point->normal, to) / sqrtf(d2);
        // wrapped: clusters have an extent that a point does not, and the sheet they lie in must be lit too
        float wrapped = maxf((cosine + 0.25f) / 1.25f, 0.3f * point->transmission);
        sum = v3_mad(sum, light->strength, wrapped / d2);
    }
    return v3_scale(v3_mul(sum, point->albedo), (float)stride);
}

static void add_sample(const Preview *preview, Block *block, const int *active, int sample) {
    aim_block(preview, block, sample);
    find_points(preview, block, active);
    for (int i = 0; i < LANES; i++) block->light[i] = v3(0, 0, 0);
    add_sun(preview, block, active, sample);
    add_sky(preview, block, active, sample);
    // few lights a sample, all of them over four samples
    int stride = preview->def.samples % 4 == 0 ? 4 : 1;
    for (int i = 0; i < LANES; i++) {
        if (!active[i]) continue;
        const Point *point = &block->point[i];
        V3 colour = v3_add(block->light[i], point->emission);
        float l = v3_luminance(colour), shown = l / (1 + l);
        block->low[i] = minf(block->low[i], shown), block->high[i] = maxf(block->high[i], shown);
        if (point->lit && preview->scene.light_count)
            colour = v3_add(colour, ember_light(&preview->scene, point, sample % stride, stride));
        if (point->fade > 0) colour = v3_mix(colour, background_colour(preview, block->direction[i]), point->fade);
        colour = v3(minf(colour.x, 40), minf(colour.y, 40), minf(colour.z, 40));
        block->sum[i] = v3_add(block->sum[i], colour);
    }
}

static void draw_block(Preview *preview, Block *block, int x0, int y0) {
    const PreviewDef *def = &preview->def;
    int active[LANES], taken[LANES], samples = def->samples, first = samples;
    if (samples > 4) first = (samples / 2 + 3) / 4 * 4;
    for (int i = 0; i < LANES; i++) {
        block->x[i] = x0 + i % BLOCK, block->y[i] = y0 + i / BLOCK;
        active[i] = block->x[i] < def->width && block->y[i] < def->height ? -1 : 0;
        sample_pixel(block->x[i], block->y[i], def->seed, block->turn[i]);
        block->sum[i] = v3(0, 0, 0), block->low[i] = INFINITY, block->high[i] = -INFINITY;
    }
    for (int s = 0; s < first; s++) add_sample(preview, block, active, s);
    float low = INFINITY, high = -INFINITY;
    for (int i = 0; i < LANES; i++) low = minf(low, block->low[i]), high = maxf(high, block->high[i]);
    int left = 0, more[LANES];
    for (int i = 0; i < LANES; i++) {
        bool calm = block->high[i] - block->low[i] < 0.02f && high - low < 0.25f;
        more[i] = active[i] && first < samples && !calm ? -1 : 0;
        taken[i] = more[i] ? samples : first, left += more[i] != 0;
    }
    for (int s = first; s < samples && left; s++) add_sample(preview, block, more, s);
    for (int i = 0; i < LANES; i++)
        if (active[i])
            preview->picture[(size_t)block->y[i] * (size_t)def->width + (size_t)block->x[i]] =
                v3_scale(block->sum[i], 1 / (float)taken[i]);
}

static void *draw_tiles(void *context) {
    Job *job = context;
    Block block;
    const PreviewDef *def = &job->preview->def;
    for (int tile; (tile = atomic_fetch_add(&job->next, 1)) < job->count;) {
        int x0 = tile % job->across * TILE, y0 = tile / job->across * TILE;
        for (int y = y0; y < y0 + TILE && y < def->height; y += BLOCK)
            for (int x = x0; x < x0 + TILE && x < def->width; x += BLOCK) draw_block(job->preview, &block, x, y);
    }
    return NULL;
}

static void draw_all(Preview *preview) {
    int across = (preview->def.width + TILE - 1) / TILE, down = (preview->def.height + TILE - 1) / TILE;
    Job job = {.preview = preview, .across = across, .count = across * down};
    atomic_init(&job.next, 0);
    pthread_t threads[THREAD_LIMIT];
    int started = 0;
    // a thread that cannot be had only makes it slower
    while (started < preview->def.thread_count - 1 && !pthread_create(&threads[started], NULL, draw_tiles, &job))
        started++;
    draw_tiles(&job);
    for (int i = 0; i < started; i++) pthread_join(threads[i], NULL);
}

SingeResult preview_draw(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb, SingeError *error) {
    if (!isfinite(time)) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the time is not finite");
    SingeResult result = tracer_load(preview, surface, error);
    if (result) return result;
    preview->time = time;
    light_gather(preview);
    draw_all(preview);
    bloom_apply(preview);
    tonemap_write(preview, rgb);
    return SINGE_OK;
}
