// What the rays of a block see: the ground, the wall, a shape, a sheet through its holes, or the background.

#include "preview/ground.h"
#include "preview/block.h"

enum { HOLE_LIMIT = 4 };

void sample_offset(int sample, float at[2]) {
    sample_square((uint32_t)sample, 0.5f, 0.5f, at);
    for (int c = 0; c < 2; c++) at[c] = 0.9f * (at[c] < 0.5f ? sqrtf(2 * at[c]) - 1 : 1 - sqrtf(2 - 2 * at[c]));
}

// What is spread over few pixels is the mean of sharp pictures, which lie closer than a pixel, if all pixels have the same
// points of the lens and of time: its edges are smooth. With points of their own their pixels would differ, like teeth. What
// is spread over many pixels needs these: the pictures would be seen.
#define TURNED_LENS 1.5f ///< pixels
#define TURNED_TIME 4.0f ///< pixels: their times lie along a line

void block_aim_each(const Preview *preview, Block *block, int sample, const float at[2], int step) {
    bool lens = preview->camera.lens > 0 && sample >= 0, shutter = preview->def.shutter > 0 && sample >= 0;
    const bool turned = block->spread > TURNED_LENS, late = block->spread > TURNED_TIME;
    float disc[2] = {0, 0}, square[2];
    if (lens && !turned) {
        sample_lens((uint32_t)sample, 0, square);
        sample_disc(square, disc);
    }

    for (int i = 0; i < LANES; i += step) {
        float x = 2 * ((float)block->x[i] + 0.5f + at[0]) / (float)preview->def.width - 1;
        float y = 1 - 2 * ((float)block->y[i] + 0.5f + at[1]) / (float)preview->def.height;
        if (lens && turned) {
            sample_lens((uint32_t)sample, block->key[i], square);
            sample_disc(square, disc);
        }

        camera_ray(&preview->camera, x, y, disc, &block->origin[i], &block->direction[i]);
        if (block->bend[i] > 0) shimmer_bend(preview, block, i, sample);
        block->time[i] = shutter ? sample_time((uint32_t)sample, late ? block->key[i] : 0) : 0.5f;
    }
}

void block_aim(const Preview *preview, Block *block, int sample, const float at[2]) {
    block_aim_each(preview, block, sample, at, 1);
}

static void start_point(Point *point, const Preview *preview, Float3 origin, Float3 direction, float distance) {
    *point = (Point){.lit = true, .view = float3_scale(direction, -1), .distance = distance, .sheet = -1, .piece = -1};
    point->position = float3_mad(origin, direction, distance);
    point->footprint = preview->camera.pixel * distance;
}

static void miss_point(Point *point, const Preview *preview, Float3 direction) {
    *point = (Point){.glow = background_colour(preview, direction), .distance = INFINITY, .sheet = -1, .piece = -1};
}

float ground_hit(const Preview *preview, Float3 origin, Float3 direction) {
    float height = origin.z - preview->def.ground_height;
    if (!isfinite(preview->def.ground_height) || height <= 0 || direction.z >= -1e-5f) return INFINITY;
    float t = -height / direction.z;
    return t < 1e4f ? t : INFINITY;
}

float backdrop_hit(const Preview *preview, Float3 origin, Float3 direction) {
    return minf(ground_hit(preview, origin, direction), wall_hit(preview, origin, direction));
}

size_t block_pixel(const Preview *preview, const Block *block, int lane) {
    return (size_t)block->y[lane] * (size_t)preview->def.width + (size_t)block->x[lane];
}

void block_see_backdrop(const Preview *preview, Block *block, int lane) {
    Float3 d = block->direction[lane];
    Point *point = &block->point[lane];
    const float distance = ground_hit(preview, block->origin[lane], d),
                wall = wall_hit(preview, block->origin[lane], d);

    if (!isfinite(distance) && !isfinite(wall)) {
        miss_point(point, preview, d);
        return;
    }

    const Table *table = &preview->table[block_pixel(preview, block, lane)];
    Table look;
    start_point(point, preview, block->origin[lane], d, minf(distance, wall));
    if (wall < distance) {
        if (block->mirrored) wall_look(preview, point->position, 4 * point->footprint, &look);
        wall_shade(preview, block->mirrored ? &look : table, point);
        return;
    }
    ground_shade(preview, distance, table, point);

    // its waves bend the mirrored ray up or down and aside, over a third of the way from the lens to what it meets; those
    // of honed stone are as fine as what makes it dull
    const float *tilt = table->tilt, wavy = preview->def.ground == PREVIEW_GROUND_STONE ? 0.15f : 0.7f;
    const float bend = wavy / preview->camera.pixel;
    const Float3 right = float3_unit_or(preview->camera.right, float3(1, 0, 0));
    const float aside = -d.z * (right.x * tilt[0] + right.y * tilt[1]), down = -(d.x * tilt[0] + d.y * tilt[1]);
    if (preview->mirrored[0])
        point->mirrored = mirror_see(preview, preview->mirrored[0], (float)block->x[lane] + bend * aside,
                                     (float)block->y[lane] + bend * down);
    point->glow = float3_scale(point->mirrored.light, light_mirrored(point));
}

/// The length of a motion as the eye sees it, along a unit ray.
static float moved_across(Float3 motion, Float3 ray) {
    return float3_length(float3_mad(motion, ray, -float3_dot(motion, ray)));
}

/// The point that a lane's ray sees; false if it passes through a hole and must continue.
static bool resolve(const Preview *preview, Block *block, int lane, const Met *met, bool last) {
    Float3 o = block->origin[lane], d = block->direction[lane];
    Point *point = &block->point[lane];
    const Hits *hits = &block->hits;
    const float distance = met->distance[lane];
    const PreviewShape *shape = met->shape[lane];

    if (backdrop_hit(preview, o, d) < distance) {
        block_see_backdrop(preview, block, lane);
        return true;
    }

    if (!shape && hits->triangle[lane] == BVH_NONE) {
        miss_point(point, preview, d);
        return true;
    }

    start_point(point, preview, o, d, distance);
    if (shape) {
        point->hit = true;
        point->temperature = shape->temperature;
        point->moved = preview->def.shutter * moved_across(float3_load(shape->velocity), d);
        const Float3 found = met->facing[lane].normal;
        point->bent = met->facing[lane].bent;
        point->normal = point->geometric = float3_dot(found, point->view) >= 0 ? found : float3_scale(found, -1);
        shape_shade(preview, shape, shutter_moment(preview, block->time[lane]), point);
        return true;
    }

    const uint32_t *t = preview->scene.triangles[hits->triangle[lane]];
    const PaperVertex *vertices = preview->scene.vertices;
    const PaperVertex *a = &vertices[t[0]], *b = &vertices[t[1]], *c = &vertices[t[2]];
    float u = hits->u[lane], v = hits->v[lane];
    Float3 geometric =
        float3_unit_or(float3(hits->normal[0][lane], hits->normal[1][lane], hits->normal[2][lane]), point->view);
    Float3 smooth = float3_unit_or(float3_blend(a->normal, b->normal, c->normal, u, v), geometric);
    point->geometric = float3_dot(geometric, point->view) >= 0 ? geometric : float3_scale(geometric, -1);
    point->normal = float3_dot(smooth, point->geometric) >= 0 ? smooth : float3_scale(smooth, -1);
    PaperState state;
    paper_state(&preview->scene, hits->triangle[lane], u, v, &state);
    if (cloth_weave(preview, state.sheet)) cloth_frame(&preview->scene, hits->triangle[lane], point);
    const float turn = (b->uv[0] - a->uv[0]) * (c->uv[1] - a->uv[1]) - (b->uv[1] - a->uv[1]) * (c->uv[0] - a->uv[0]);
    point->bent = (1 - u - v) * a->bent + u * b->bent + v * c->bent;
    point->back = turn * float3_dot(geometric, point->view) < 0;
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

void block_find_points(const Preview *preview, Block *block, const int *active) {
    int left = 0;
    for (int i = 0; i < LANES; i++) {
        aim_ray(&block->rays, i, block->origin[i], block->direction[i], 0, INFINITY, block->time[i]);
        block->valid[i] = active[i];
        left += active[i] != 0;
    }

    for (int pass = 0; pass < HOLE_LIMIT && left; pass++) {
        Met met;
        tracer_intersect(preview, block->valid, &block->rays, &block->hits);
        tracer_meet_shapes(preview, block->valid, &block->rays, &block->hits, &met);
        left = 0;
        for (int i = 0; i < LANES; i++) {
            if (!block->valid[i]) continue;
            if (!resolve(preview, block, i, &met, pass == HOLE_LIMIT - 1)) {
                block->rays.near[i] = block->rays.far[i] + preview->scene.epsilon;
                block->rays.far[i] = INFINITY;
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
