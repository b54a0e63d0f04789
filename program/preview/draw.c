// One frame: tiles of blocks of 4 x 4 pixels, a packet of 16 rays per block and sample.
//
// A sample is: the nearest surface; its appearance; the light of sun, sky (lighting.c) and lamps (lamps.c) before
// occlusion, whose visible shares the first samples test by rays; they are smoothed over neighbours last (seen.c).
// Pixels whose first samples agree get no more. Blocks that no sheet or shape can touch show only the table or the
// background: nothing is intersected, and where no shadow can fall one sample is enough. Random numbers depend only on
// the pixel's position and the sample's number, not on threads.

#include "preview/airborne.h"
#include "preview/block.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

enum {
    HOLE_LIMIT = 4,
};

static const float CALM = 0.026f; ///< range of a pixel's first samples, as l / (1 + l), that needs no more of them

static void store(float (*layer)[3], size_t pixel, Float3 value) {
    if (layer) float3_store(layer[pixel], value);
}

/// Writes the layers of a pixel whose samples are done.
static void layers_write(const Preview *preview, size_t pixel, const LayerSum *sum) {
    const PreviewLayers *layers = &preview->layers;
    float sample = 1 / maxf((float)sum->samples, 1), hit = 1 / maxf((float)sum->hits, 1);
    store(layers->glow, pixel, float3_scale(sum->glow, sample));

    if (layers->fire) {
        float *fire = layers->fire[pixel];
        float3_store(fire, float3_scale(sum->fire, sample));
        fire[3] = sum->fire_hides * sample;
    }

    store(layers->normal, pixel, float3_unit_or(sum->normal, float3(0, 0, 0)));
    if (layers->coverage) layers->coverage[pixel] = (float)sum->hits * sample;
    if (layers->temperature) layers->temperature[pixel] = sum->temperature * hit;
    if (layers->burn) layers->burn[pixel] = sum->burn * hit;
    if (layers->depth) layers->depth[pixel] = sum->depth;
    if (layers->sheet) layers->sheet[pixel] = sum->sheet;
    if (layers->piece) layers->piece[pixel] = sum->piece;
    for (int k = 0; layers->mattes && k < PREVIEW_MATTES; k++) {
        layers->mattes[pixel][k] = sum->mattes[k];
        layers->mattes[pixel][k].share *= sample;
    }
}

typedef struct Job {
    Preview *preview;
    void (*draw)(Preview *preview, Block *block); ///< one block
    atomic_int next, threads;
    int across, count;
    bool fire; ///< flame and smoke are drawn
} Job;

/// A sample's position in the pixel: a tent of radius 0.9 pixel, softer than a box and without ringing.
static void sample_offset(int sample, float at[2]) {
    sample_square((uint32_t)sample, 0.5f, 0.5f, at);
    for (int c = 0; c < 2; c++) at[c] = 0.9f * (at[c] < 0.5f ? sqrtf(2 * at[c]) - 1 : 1 - sqrtf(2 - 2 * at[c]));
}

/// Rays of a sample through the pixels, each with its position on the lens and its time: SAMPLE_CENTRE of both.
static void aim_block(const Preview *preview, Block *block, int sample, const float at[2]) {
    bool lens = preview->camera.lens > 0 && sample >= 0, shutter = preview->def.shutter > 0 && sample >= 0;
    for (int i = 0; i < LANES; i++) {
        float x = 2 * ((float)block->x[i] + 0.5f + at[0]) / (float)preview->def.width - 1;
        float y = 1 - 2 * ((float)block->y[i] + 0.5f + at[1]) / (float)preview->def.height;
        float square[2], disc[2] = {0, 0};
        if (lens) {
            sample_lens((uint32_t)sample, block->key[i], square);
            sample_disc(square, disc);
        }

        camera_ray(&preview->camera, x, y, disc, &block->origin[i], &block->direction[i]);
        block->time[i] = shutter ? sample_time((uint32_t)sample, block->key[i]) : 0.5f;
    }
}

static void start_point(Point *point, const Preview *preview, Float3 origin, Float3 direction, float distance) {
    *point = (Point){.lit = true, .view = float3_scale(direction, -1), .distance = distance, .sheet = -1, .piece = -1};
    point->position = float3_mad(origin, direction, distance);
    point->footprint = preview->camera.pixel * distance;
}

static void miss_point(Point *point, const Preview *preview, Float3 direction) {
    *point = (Point){.glow = background_colour(preview, direction), .distance = INFINITY, .sheet = -1, .piece = -1};
}

static float hit_ground(const Preview *preview, Float3 origin, Float3 direction) {
    float height = origin.z - preview->def.ground_height;
    if (!isfinite(preview->def.ground_height) || height <= 0 || direction.z >= -1e-5f) return INFINITY;
    float t = -height / direction.z;
    return t < 1e4f ? t : INFINITY;
}

static size_t pixel_index(const Preview *preview, const Block *block, int lane) {
    return (size_t)block->y[lane] * (size_t)preview->def.width + (size_t)block->x[lane];
}

/// The table, or the background.
static void see_ground(const Preview *preview, Block *block, int lane) {
    Float3 d = block->direction[lane];
    Point *point = &block->point[lane];
    float distance = hit_ground(preview, block->origin[lane], d);

    if (!isfinite(distance)) {
        miss_point(point, preview, d);
        return;
    }

    start_point(point, preview, block->origin[lane], d, distance);
    ground_shade(preview, distance, &preview->table[pixel_index(preview, block, lane)], point);
    point->mirrored = mirror_see(preview, block->x[lane], block->y[lane]);
    point->glow = float3_scale(point->mirrored.light, light_mirrored(point));
}

/// The length of a motion as the eye sees it, along a unit ray.
static float moved_across(Float3 motion, Float3 ray) {
    return float3_length(float3_mad(motion, ray, -float3_dot(motion, ray)));
}

/// The point that a lane's ray sees; false if it passes through a hole and must continue.
static bool resolve(const Preview *preview, Block *block, int lane, bool last) {
    Float3 o = block->origin[lane], d = block->direction[lane], normal = {0, 0, 1}, found = {0, 0, 1};
    Point *point = &block->point[lane];
    const struct RTCHit16 *hit = &block->rays.hit;
    bool paper = hit->geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    float distance = paper ? block->rays.ray.tfar[lane] : INFINITY;
    const PreviewShape *shape = NULL;
    float moment = shutter_moment(preview, block->time[lane]);

    for (uint32_t k = 0; k < preview->shape_count; k++) {
        float t = shape_intersect(&preview->shapes[k], moment, o, d, 0, distance, &normal);
        if (t > 0) {
            distance = t;
            shape = &preview->shapes[k];
            found = normal;
        }
    }

    if (hit_ground(preview, o, d) < distance) {
        see_ground(preview, block, lane);
        return true;
    }

    if (!shape && !paper) {
        miss_point(point, preview, d);
        return true;
    }

    start_point(point, preview, o, d, distance);
    if (shape) {
        point->hit = true;
        point->temperature = shape->temperature;
        point->moved = preview->def.shutter * moved_across(float3_load(shape->velocity), d);
        point->normal = point->geometric = float3_dot(found, point->view) >= 0 ? found : float3_scale(found, -1);
        shape_shade(preview, shape, moment, point);
        return true;
    }

    const uint32_t *t = preview->scene.triangles[hit->primID[lane]];
    const PaperVertex *vertices = preview->scene.vertices;
    const PaperVertex *a = &vertices[t[0]], *b = &vertices[t[1]], *c = &vertices[t[2]];
    float u = hit->u[lane], v = hit->v[lane];
    Float3 geometric = float3_unit_or(float3(hit->Ng_x[lane], hit->Ng_y[lane], hit->Ng_z[lane]), point->view);
    Float3 smooth = float3_unit_or(float3_blend(a->normal, b->normal, c->normal, u, v), geometric);
    point->geometric = float3_dot(geometric, point->view) >= 0 ? geometric : float3_scale(geometric, -1);
    point->normal = float3_dot(smooth, point->geometric) >= 0 ? smooth : float3_scale(smooth, -1);
    PaperState state;
    paper_state(&preview->scene, hit->primID[lane], u, v, &state);
    if (cloth_weave(preview, state.sheet)) cloth_frame(&preview->scene, hit->primID[lane], point);
    point->hit = true;
    point->sheet = state.sheet;
    point->piece = state.piece;
    point->temperature = state.temperature;
    point->burn = state.burn;
    if (preview->def.shutter > 0)
        point->moved = moved_across(
            float3_sub(float3_load(preview->scene.moved[1][t[0]]), float3_load(preview->scene.moved[0][t[0]])), d);

    return paper_shade(preview, &state, point) || last;
}

static void find_points(const Preview *preview, Block *block, const int *active) {
    int left = 0;
    for (int i = 0; i < LANES; i++) {
        aim_ray(&block->rays.ray, i, block->origin[i], block->direction[i], 0, INFINITY, block->time[i]);
        block->valid[i] = active[i];
        left += active[i] != 0;
    }

    for (int pass = 0; pass < HOLE_LIMIT && left; pass++) {
        tracer_intersect(preview, block->valid, &block->rays);
        left = 0;
        for (int i = 0; i < LANES; i++) {
            if (!block->valid[i]) continue;
            if (!resolve(preview, block, i, pass == HOLE_LIMIT - 1)) {
                block->rays.ray.tnear[i] = block->rays.ray.tfar[i] + preview->scene.epsilon;
                block->rays.ray.tfar[i] = INFINITY;
                left++;
                continue;
            }
            block->valid[i] = 0;

            // the pixels over which the lens and the shutter spread the point
            const Point *point = &block->point[i];
            if (!point->hit) continue;
            const float depth = point->distance * float3_dot(block->direction[i], preview->camera.forward);
            block->spread = maxf(block->spread, camera_blur(&preview->camera, depth));
            if (preview->def.shutter > 0)
                block->spread = maxf(block->spread, point->moved / (preview->camera.pixel * depth));
        }
    }
}

static bool is_still(const Preview *preview) { return preview->def.samples >= SAMPLES_STILL; }

/// Adds the colour of block->point in one sample and its layers. `ask`: whether rays test what lights it.
static void add_light(const Preview *preview, Block *block, const int *active, int sample, bool ask) {
    float through[LANES], known[LANES];
    for (int i = 0; i < LANES; i++) {
        through[i] = known[i] = 0;
        if (!active[i]) continue;
        const Point *point = &block->point[i];
        Float3 colour = point->glow, fire = {0, 0, 0};
        float clear = 1;
        for (int k = 0; k < LIT_KINDS; k++) known[i] += float3_luminance(block->lit[k][i]);
        if (point->fade > 0)
            colour = float3_mad(float3_scale(colour, 1 - point->fade), background_colour(preview, block->direction[i]),
                                point->fade);

        // the fire in front of the point; a pixel's points mostly have nearly the same distance
        if (block->tile) {
            const float same = 1e-3f; // m, less than flames are thick
            if (point->distance < block->fire_from[i] || point->distance > block->fire_to[i]) {
                block->fire_from[i] = point->distance - same;
                block->fire_to[i] = point->distance + same;
                fire_until(block->tile, block->x[i] % TILE, block->y[i] % TILE, point->distance, &block->fire_light[i],
                           &block->fire_clear[i]);
            }

            fire = block->fire_light[i];
            clear = block->fire_clear[i];
            colour = float3_mad(fire, colour, clear);
        }

        through[i] = clear * (1 - point->fade);
        colour = float3(minf(colour.x, 40), minf(colour.y, 40), minf(colour.z, 40));
        block->sum[i] = float3_add(block->sum[i], colour);

        LayerSum *sum = &block->layer[i];
        if (!sum->samples++) {
            sum->depth = point->distance * float3_dot(block->direction[i], preview->camera.forward);
            sum->sheet = point->sheet;
            sum->piece = point->piece;
        }

        sum->fire = float3_add(sum->fire, fire);
        sum->fire_hides += 1 - clear;
        if (!point->hit) continue;
        sum->hits++;

        // a sample of the piece counts if that is among the first that the pixel has met
        for (int k = 0; k < PREVIEW_MATTES && preview->layers.mattes && point->sheet >= 0; k++) {
            PreviewMatte *matte = &sum->mattes[k];
            if (matte->share > 0 && (matte->sheet != point->sheet || matte->piece != point->piece)) continue;
            *matte = (PreviewMatte){point->sheet, point->piece, matte->share + 1};
            break;
        }

        sum->glow = float3_mad(sum->glow, point->glow, clear);
        sum->normal = float3_add(sum->normal, point->normal);
        sum->temperature += point->temperature;
        sum->burn += point->burn;
    }

    // sky and lamps change slowly enough for every second sample, but not where faces meet
    const bool all = sample < 0 || sample >= SAMPLES_FIRST || preview->def.samples == 1 || is_still(preview);
    lamps_add(preview, block, active, sample, through, ask && (all || sample % 2 != 0));
    light_add_sun(preview, block, active, sample, through, ask);
    light_add_sky(preview, block, active, sample, through, ask && (all || sample % 2 == 0));

    // how much the samples differ, but for what hides the light
    for (int i = 0; i < LANES; i++) {
        if (!active[i]) continue;
        float l = through[i] * float3_luminance(block->point[i].glow) - known[i];
        for (int k = 0; k < LIT_KINDS; k++) l += float3_luminance(block->lit[k][i]);
        float shown = l / (1 + l);
        block->low[i] = minf(block->low[i], shown);
        block->high[i] = maxf(block->high[i], shown);
        block->shown[i] += shown;
        block->squares[i] += shown * shown;
    }
}

/// In a bare block the rays stay the same, unless the lens spreads them.
static void add_sample(const Preview *preview, Block *block, const int *active, bool bare, int sample, bool ask) {
    if (!bare || preview->camera.lens > 0) {
        float at[2];
        sample_offset(sample, at);
        aim_block(preview, block, sample, at);
        if (!bare) find_points(preview, block, active);
        for (int i = 0; bare && i < LANES; i++)
            if (active[i]) see_ground(preview, block, i);
    }

    add_light(preview, block, active, sample, ask);
}

/// Whether some of a pixel's samples hit a sheet or a shape and some do not.
static bool is_edge(const LayerSum *sum) { return sum->hits > 0 && sum->hits < sum->samples; }

/// Whether a sheet or a shape ends between the lane's pixel and one beside it in the block.
static bool is_beside_edge(const Block *block, int lane) {
    const int x = lane % BLOCK, y = lane / BLOCK, step[4] = {-1, 1, -BLOCK, BLOCK};
    const bool inside[4] = {x > 0, x<BLOCK - 1, y> 0, y < BLOCK - 1};
    const LayerSum *sum = &block->layer[lane];
    for (int k = 0; k < 4; k++)
        if (inside[k] && sum->samples && block->layer[lane + step[k]].samples &&
            (sum->hits > 0) != (block->layer[lane + step[k]].hits > 0))
            return true;
    return false;
}

/// The lanes whose first samples differ by more than `calm`, or from their neighbours'. Returns how many.
static int find_restless(const Block *block, const int *active, float calm, int *more) {
    int count = 0;
    float low = INFINITY, high = -INFINITY;
    for (int i = 0; i < LANES; i++) {
        low = minf(low, block->low[i]);
        high = maxf(high, block->high[i]);
    }

    for (int i = 0; i < LANES; i++) {
        bool rests = !is_edge(&block->layer[i]) && block->high[i] - block->low[i] < calm;
        if (block->spread > 1) rests = rests && block->high[i] - block->low[i] < 0.4f * calm;
        else rests = rests && !is_beside_edge(block, i) && high - low < 0.15f;
        more[i] = active[i] && !rests ? -1 : 0;
        count += more[i] != 0;
    }

    return count;
}

/// Takes SAMPLES_FIRST samples of every pixel, and the rest of pixels that need it. Bare blocks get the first only. Where
/// nothing blocks the light two are enough, in bare blocks and in those that are evenly lit.
static void add_samples(const Preview *preview, Block *block, const int *active, bool bare, int *taken) {
    int more[LANES], samples = preview->def.samples, first = SAMPLES_FIRST;
    if (samples < first || is_still(preview)) first = samples;
    for (int s = 0; s < first; s++) {
        add_sample(preview, block, active, bare, s, true);
        if (s != 1 || block->hidden || is_still(preview)) continue;
        if (bare || (block->spread <= 1 && !find_restless(block, active, 0.5f * CALM, more))) first = s + 1;
    }

    bool on = first < samples && !bare && first > 2 && find_restless(block, active, CALM, more);
    bool ask = block->spread > 1; // only pixels that show several faces need more rays
    for (int i = 0; i < LANES; i++) {
        ask = ask || (active[i] && is_edge(&block->layer[i]));
        taken[i] = on && more[i] ? samples : first;
    }

    for (int s = first; s < samples && on; s++) {
        // after half of the samples: only lanes whose samples still differ visibly; soften.c smooths what lenses blur
        if (s == samples / 2) {
            on = false;
            for (int i = 0; i < LANES; i++) {
                if (more[i] && !is_edge(&block->layer[i]) && block->high[i] - block->low[i] < 0.22f) {
                    more[i] = 0;
                    taken[i] = s;
                }

                on = on || more[i];
            }
        }

        if (on) add_sample(preview, block, more, bare, s, ask);
    }
}

static void draw_block(Preview *preview, Block *block) {
    const PreviewDef *def = &preview->def;
    int active[LANES], taken[LANES];
    block->hidden = false;
    block->spread = 0;
    memset(block->lit, 0, sizeof block->lit);
    memset(block->lit_seen, 0, sizeof block->lit_seen);
    memset(block->lit_asked, 0, sizeof block->lit_asked);

    for (int i = 0; i < LANES; i++) {
        active[i] = block->x[i] < def->width && block->y[i] < def->height ? -1 : 0;
        sample_pixel(block->x[i], block->y[i], def->seed, block->turn[i]);
        block->key[i] = sample_key(block->x[i], block->y[i], def->seed);
        block->sum[i] = float3(0, 0, 0);
        block->low[i] = block->fire_from[i] = INFINITY;
        block->high[i] = block->fire_to[i] = -INFINITY;
        block->shown[i] = block->squares[i] = 0;
        block->time[i] = 0.5f;
        block->layer[i] = (LayerSum){.depth = INFINITY, .sheet = -1, .piece = -1};
    }

    bool bare = !mask_covers(preview, block->x[0], block->y[0]);
    if (bare) {
        aim_block(preview, block, SAMPLE_CENTRE, (const float[2]){0, 0});
        for (int i = 0; i < LANES; i++)
            if (active[i]) see_ground(preview, block, i);
    }

    if (bare && !light_may_be_hidden(preview, block, active)) {
        add_light(preview, block, active, SAMPLE_CENTRE, true);
        for (int i = 0; i < LANES; i++) taken[i] = 1;
    } else {
        add_samples(preview, block, active, bare, taken);
    }

    // the picture gets the mean of the sums
    for (int i = 0; i < LANES; i++) {
        if (!active[i]) continue;
        size_t pixel = pixel_index(preview, block, i);
        preview->picture[pixel] = float3_scale(block->sum[i], 1 / (float)taken[i]);
        layers_write(preview, pixel, &block->layer[i]);
        seen_write(preview, pixel, block, i, taken[i], is_still(preview) || is_edge(&block->layer[i]));
    }
}

/// What the ground mirrors in the 4 x 4 blocks of pixels of which `block` is the first: a few rays through the middle of
/// each, spread by the ground's roughness, and one through the fire.
static void draw_mirrored(Preview *preview, Block *block) {
    enum { RAYS = 4, APART = BLOCK * BLOCK };
    const float roughness = 0.06f;
    if (!preview->mirrored[0] || block->x[0] % APART || block->y[0] % APART) return;
    int active[LANES];
    Float3 origin[LANES], towards[LANES];
    block->tile = NULL;

    for (int i = 0; i < LANES; i++) {
        int x = block->x[0] + BLOCK * (i % BLOCK), y = block->y[0] + BLOCK * (i / BLOCK);
        active[i] = 0;
        block->time[i] = 0.5f;
        sample_pixel(x / BLOCK, y / BLOCK, preview->def.seed, block->turn[i]);
        if (x >= preview->def.width || y >= preview->def.height) continue;
        *mirror_block(preview, x, y) = (Mirrored){.hides = 0};
        camera_ray(&preview->camera, 2 * ((float)x + 0.5f * BLOCK) / (float)preview->def.width - 1,
                   1 - 2 * ((float)y + 0.5f * BLOCK) / (float)preview->def.height, (const float[2]){0, 0}, &origin[i],
                   &towards[i]);
        float distance = hit_ground(preview, origin[i], towards[i]);
        if (!isfinite(distance)) continue;
        origin[i] = float3_mad(origin[i], towards[i], distance);
        origin[i].z += preview->scene.epsilon;
        towards[i].z = -towards[i].z;
        active[i] = -1;
    }

    float reached[LANES], share = 1.0f / RAYS;
    for (int s = 0; s < RAYS; s++) {
        int hit[LANES];
        memset(block->lit, 0, sizeof block->lit);
        for (int i = 0; i < LANES; i++) {
            float square[2], disc[2];
            sample_square((uint32_t)s, block->turn[i][0], block->turn[i][1], square);
            sample_disc(square, disc);
            Float3 bent =
                float3(towards[i].x + 2 * roughness * disc[0], towards[i].y + 2 * roughness * disc[1], towards[i].z);
            block->origin[i] = origin[i];
            block->direction[i] = float3_unit_or(bent, towards[i]);
            block->sum[i] = float3(0, 0, 0);
        }
        find_points(preview, block, active);
        for (int i = 0; i < LANES; i++) {
            hit[i] = active[i] && block->point[i].hit ? -1 : 0;
            if (active[i] && !s) reached[i] = block->point[i].distance;
        }
        add_light(preview, block, hit, SAMPLE_CENTRE, false);
        for (int i = 0; i < LANES; i++) {
            if (!hit[i]) continue;
            Mirrored *mirrored =
                mirror_block(preview, block->x[0] + BLOCK * (i % BLOCK), block->y[0] + BLOCK * (i / BLOCK));
            mirrored->hides += share;
            for (int k = 0; k < LIT_KINDS; k++) block->sum[i] = float3_add(block->sum[i], block->lit[k][i]);
            mirrored->light = float3_mad(mirrored->light, block->sum[i], share);
        }
    }

    // four blocks see the same fire
    Float3 light = {0, 0, 0};
    float clear = 1;
    bool known = false;
    for (int k = 0; preview->fire.visible && k < LANES; k++) {
        const int i = k / 4 % 2 * 2 + k % 2 + BLOCK * (k / 8 * 2 + k % 4 / 2);
        known = known && k % 4;
        if (!active[i]) continue;
        Mirrored *mirrored =
            mirror_block(preview, block->x[0] + BLOCK * (i % BLOCK), block->y[0] + BLOCK * (i / BLOCK));
        if (!known) fire_along(preview, origin[i], towards[i], reached[i], &light, &clear);
        known = true;
        mirrored->light = float3_mad(light, mirrored->light, clear);
        mirrored->hides = 1 - clear * (1 - mirrored->hides);
    }
}

/// The table's own colour in every pixel. The camera does not move, so it is computed once.
static void fill_table(Preview *preview, Block *block) {
    Table sum[LANES] = {{.polish = 0}};
    int count[LANES] = {0};
    for (int i = 0; i < LANES; i++) block->key[i] = sample_key(block->x[i], block->y[i], preview->def.seed);

    // where a lens blurs the table, its grain is as fine as the distance between the samples on the lens
    aim_block(preview, block, SAMPLE_CENTRE, (const float[2]){0, 0});
    float far = hit_ground(preview, block->origin[0], block->direction[0]);
    float blur = isfinite(far) ? camera_blur(&preview->camera, far) : 0, wide = maxf(0.7f * blur, 1);
    int samples = preview->camera.lens > 0 ? 8 : 4;

    for (int s = 0; s < samples; s++) {
        float at[2];
        sample_offset(s, at);
        aim_block(preview, block, s, at);
        for (int i = 0; i < LANES; i++) {
            float distance = hit_ground(preview, block->origin[i], block->direction[i]);
            if (!isfinite(distance)) continue;
            Table look;
            Float3 position = float3_mad(block->origin[i], block->direction[i], distance);
            ground_look(preview, position, block->direction[i].z, wide * distance, &look);
            sum[i].albedo = float3_add(sum[i].albedo, look.albedo);
            sum[i].polish += look.polish;
            sum[i].crumb += look.crumb;
            sum[i].crumbs += look.crumbs;
            sum[i].tilt[0] += look.tilt[0];
            sum[i].tilt[1] += look.tilt[1];
            count[i]++;
        }
    }

    for (int i = 0; i < LANES; i++) {
        if (block->x[i] >= preview->def.width || block->y[i] >= preview->def.height) continue;
        float share = 1 / maxf((float)count[i], 1);
        preview->table[pixel_index(preview, block, i)] =
            (Table){.albedo = float3_scale(sum[i].albedo, share),
                    .polish = share * sum[i].polish,
                    .crumb = share * sum[i].crumb,
                    .crumbs = share * sum[i].crumbs,
                    .tilt = {share * sum[i].tilt[0], share * sum[i].tilt[1]}};
    }
}

static void *draw_tiles(void *context) {
    Job *job = context;
    Block block = {.tile = NULL};
    const PreviewDef *def = &job->preview->def;
    FireTile *fire = job->fire ? &job->preview->fire.tiles[atomic_fetch_add(&job->threads, 1)] : NULL;

    for (int tile; (tile = atomic_fetch_add(&job->next, 1)) < job->count;) {
        if (def->stop && def->stop()) break;
        int x0 = tile % job->across * TILE, y0 = tile / job->across * TILE;
        if (fire) fire_see(job->preview, x0, y0, fire);
        block.tile = fire && !fire->empty ? fire : NULL;
        for (int y = y0; y < y0 + TILE && y < def->height; y += BLOCK)
            for (int x = x0; x < x0 + TILE && x < def->width; x += BLOCK) {
                for (int i = 0; i < LANES; i++) {
                    block.x[i] = x + i % BLOCK;
                    block.y[i] = y + i / BLOCK;
                }
                job->draw(job->preview, &block);
            }
    }

    return NULL;
}

static void draw_all(Preview *preview, void (*draw)(Preview *, Block *)) {
    int across = (preview->def.width + TILE - 1) / TILE, down = (preview->def.height + TILE - 1) / TILE;
    Job job = {.preview = preview, .draw = draw, .across = across, .count = across * down};
    job.fire = draw == draw_block && preview->fire.visible;
    atomic_init(&job.next, 0);
    atomic_init(&job.threads, 0);
    pthread_t threads[THREAD_LIMIT];
    int started = 0;

    // a thread that cannot be created only makes it slower
    while (started < preview->def.thread_count - 1 && !pthread_create(&threads[started], NULL, draw_tiles, &job))
        started++;
    draw_tiles(&job);
    for (int i = 0; i < started; i++) pthread_join(threads[i], NULL);
}

bool preview_draws(void) { return true; }

SingeResult preview_draw(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb, SingeError *error) {
    return preview_draw_layers(preview, surface, time, rgb, &(PreviewLayers){NULL}, error);
}

SingeResult preview_draw_layers(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb,
                                const PreviewLayers *layers, SingeError *error) {
    if (!isfinite(time)) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the time is not finite");
    preview->time = time;
    SingeResult result = tracer_load(preview, surface, error);
    if (result) return result;

    preview->layers = *layers;
    fire_raise(preview);
    light_gather(preview);
    fire_light_smoke(preview);
    mask_fill(preview);
    if (!preview->table_known) draw_all(preview, fill_table);
    preview->table_known = !(preview->def.stop && preview->def.stop());
    stain_fill(preview);
    draw_all(preview, draw_mirrored);
    mirror_smooth(preview);
    draw_all(preview, draw_block);
    draw_all(preview, seen_smooth);
    draw_all(preview, seen_finish);
    draw_all(preview, soften);
    if (preview->def.stop && preview->def.stop())
        return preview_fail(error, SINGE_ERROR_STATE, -1, "the picture was given up");
    airborne_draw(preview);

    const size_t pixels = (size_t)preview->def.width * (size_t)preview->def.height;
    for (size_t i = 0; layers->beauty && i < pixels; i++) store(layers->beauty, i, preview->picture[i]);
    if (rgb) {
        bloom_apply(preview);
        tonemap_write(preview, rgb);
    }

    return SINGE_OK;
}
