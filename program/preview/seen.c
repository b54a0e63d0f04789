// What is visible of sun, sky and lamps in a pixel, from few rays.
//
// The light U of each kind before occlusion has no noise; its visible share V has, as only some samples trace a ray to
// it. So V is smoothed over the pixels around that show the same face, and the picture gets V U: print and edges remain
// sharp. The sun's shadows are the sharpest, so its V is smoothed least. A pixel that shows several faces keeps its own
// V, from more rays, and lends it to none.

#include "preview/block.h"

/// Of each kind of light, the share that what lies deep in a gap does not get.
static const float gap_hides[LIT_KINDS] = {[LIT_SUN] = 0.6f, [LIT_SKY] = 0.6f, [LIT_LAMPS] = 0.78f};

enum { EDGE_REACH = 3 }; ///< pixels around a pixel of several faces that are searched for each face alone

void seen_write(const Preview *preview, size_t pixel, const Block *block, int lane, int samples, bool mixed) {
    const Point *point = &block->point[lane];
    Lit lit = {.normal = point->geometric, .distance = point->distance, .blur = block->spread, .sheet = point->sheet};
    const LayerSum *sum = &block->layer[lane];
    lit.burnt =
        stepf(0.15f, 0.45f, sum->burn / maxf((float)sum->hits, 1)) * (float)sum->hits / maxf((float)sum->samples, 1);
    if (mixed) {
        lit.distance = -sum->depth / float3_dot(block->direction[lane], preview->camera.forward);
        lit.sheet = sum->sheet;
        lit.before = sum->behind > 0;
    }
    const float count = (float)samples, mean = block->shown[lane] / count;
    lit.noise = samples > 1 ? maxf(block->squares[lane] / count - mean * mean, 0) / (count - 1) : 0;
    for (int k = 0; k < LIT_KINDS; k++) {
        lit.light[k] = float3_scale(block->lit[k][lane], 1 / (float)samples);
        lit.other[k] = float3_scale(block->lit_other[k][lane], 1 / (float)samples);
        float asked = block->lit_asked[k][lane];
        lit.seen[k] = asked > 0 ? block->lit_seen[k][lane] / asked : -1;
    }

    preview->lit[pixel] = lit;
}

/// Pixels that are smoothed to each side.
static void find_reach(const Preview *preview, int reach[LIT_KINDS]) {
    reach[LIT_SUN] = is_still(preview) ? 0 : 2;
    reach[LIT_SKY] = 2 + preview->def.height / 180;
    reach[LIT_LAMPS] = 3 + preview->def.height / 108; // flames are large, and their shadows the softest
}

/// Means of visible shares along a line of pixels `stride` apart that show the lit one's face, weighted by nearness.
/// `before` and `after` are the numbers of pixels on both sides.
static void smooth_line(const Lit *lit, const float (*values)[LIT_KINDS], size_t values_size, ptrdiff_t stride,
                        int before, int after, const int reach[LIT_KINDS], float out[LIT_KINDS]) {
    float sum[LIT_KINDS] = {0}, total[LIT_KINDS] = {0};
    const int first = before < reach[LIT_LAMPS] ? -before : -reach[LIT_LAMPS];
    const int last = after < reach[LIT_LAMPS] ? after : reach[LIT_LAMPS];
    for (int at = first; at <= last; at++) {
        const Lit *other = lit + at * stride;
        const bool one_face = lit->sheet == other->sheet &&
                              fabsf(lit->distance - other->distance) < 0.02f * lit->distance &&
                              float3_dot(lit->normal, other->normal) > SAME_FACING;
        if (!one_face) continue;
        const float *value = (const float *)(const void *)((const char *)values + at * stride * (ptrdiff_t)values_size);
        for (int k = 0; k < LIT_KINDS; k++) {
            float weight = (float)(reach[k] + 1 - (at < 0 ? -at : at));
            if (weight <= 0 || value[k] < 0) continue;
            sum[k] += weight * value[k];
            total[k] += weight;
        }
    }

    for (int k = 0; k < LIT_KINDS; k++) out[k] = total[k] > 0 ? sum[k] / total[k] : -1;
}

void seen_smooth(Preview *preview, Block *block) {
    int w = preview->def.width, h = preview->def.height, reach[LIT_KINDS];
    find_reach(preview, reach);
    for (int i = 0; i < LANES; i++) {
        int x = block->x[i], y = block->y[i];
        if (x >= w || y >= h) continue;
        size_t pixel = (size_t)y * (size_t)w + (size_t)x;
        const Lit *lit = &preview->lit[pixel];
        smooth_line(lit, &lit->seen, sizeof *lit, 1, x, w - 1 - x, reach, preview->seen[pixel]);
    }
}

/// The light of a pixel that shows several faces. For sky and lamps, whose shadows are the softest, each face takes its
/// light from pixels around that show it alone: with the few rays of one pixel, bright edges had teeth.
static Float3 light_of_faces(const Preview *preview, const Lit *lit, int x, int y) {
    enum { FIRST, OTHER, FACES };
    const int w = preview->def.width, h = preview->def.height;
    float sum[FACES][LIT_KINDS] = {{0}}, total[FACES][LIT_KINDS] = {{0}};
    for (int j = -EDGE_REACH; j <= EDGE_REACH; j++)
        for (int i = -EDGE_REACH; i <= EDGE_REACH; i++) {
            if (x + i < 0 || x + i >= w || y + j < 0 || y + j >= h) continue;
            const ptrdiff_t at = (ptrdiff_t)j * w + i;
            const Lit *near = lit + at;
            if (near->distance < 0) continue;
            const float apart = fabsf(near->distance + lit->distance), weight = 1 / (float)(1 + i * i + j * j);
            const int face = near->sheet == lit->sheet && apart < 0.02f * near->distance ? FIRST : OTHER;
            const float *seen = preview->seen[y * w + x + at];
            for (int k = LIT_SKY; k < LIT_KINDS; k++) {
                if (seen[k] < 0) continue;
                sum[face][k] += weight * seen[k];
                total[face][k] += weight;
            }
        }

    // of two faces the one behind lies in the gap, and char in front of it does not
    const float first = gap_at(preview, x, y, lit), behind = gap_at(preview, x, y, &(Lit){.distance = INFINITY});
    const float gap[FACES] = {lit->before && lit->burnt > 0 ? 0 : first, lit->before ? behind : 0};
    Float3 colour = {0, 0, 0};
    for (int k = 0; k < LIT_KINDS; k++) {
        const Float3 light[FACES] = {float3_sub(lit->light[k], lit->other[k]), lit->other[k]};
        const float own = lit->seen[k] < 0 ? 1 : lit->seen[k];
        for (int face = 0; face < FACES; face++)
            colour =
                float3_mad(colour, light[face],
                           (total[face][k] > 0 ? sum[face][k] / total[face][k] : own) * (1 - gap_hides[k] * gap[face]));
    }
    return colour;
}

void seen_finish(Preview *preview, Block *block) {
    int w = preview->def.width, h = preview->def.height, reach[LIT_KINDS];
    find_reach(preview, reach);
    for (int i = 0; i < LANES; i++) {
        int x = block->x[i], y = block->y[i];
        if (x >= w || y >= h) continue;
        size_t pixel = (size_t)y * (size_t)w + (size_t)x;
        Lit *lit = &preview->lit[pixel];
        float seen[LIT_KINDS];
        Float3 colour = preview->picture[pixel];
        if (lit->distance < 0) colour = float3_add(colour, light_of_faces(preview, lit, x, y));
        else {
            smooth_line(lit, &preview->seen[pixel], sizeof *preview->seen, w, y, h - 1 - y, reach, seen);
            const float gap = gap_at(preview, x, y, lit);
            for (int k = 0; k < LIT_KINDS; k++)
                colour = float3_mad(colour, lit->light[k], (seen[k] < 0 ? 1 : seen[k]) * (1 - gap_hides[k] * gap));
        }
        preview->picture[pixel] = colour;

        // of light before occlusion nothing more is needed
        lit->light[SOFT_COLOUR] = colour;
        lit->light[SOFT_SHOWN] = float3_scale(colour, 1 / (1 + float3_luminance(colour)));
    }
}
