// The samples of a block of 4 x 4 pixels: a packet of 16 rays each.
//
// A sample is: the nearest surface (points.c); its appearance; the light of sun, sky (lighting.c) and lamps (lamps.c)
// before occlusion, whose visible shares the first samples test by rays; they are smoothed over neighbours last (seen.c).
// Pixels whose first samples agree get no more. Blocks that no sheet or shape can touch show only the table or the
// background: nothing is intersected, and where no shadow can fall one sample is enough. Random numbers depend only on
// the pixel's position and the sample's number, not on threads.

#include "preview/ground.h"
#include "preview/block.h"

#include <string.h>

static const float CALM = 0.026f;   ///< range of a pixel's first samples, as l / (1 + l), that needs no more of them
static const float UNEVEN = 0.045f; ///< range of a block's, beyond which its pixels need more
static const float BLURRED = 0.3f;  ///< the same where lens and shutter spread what is seen: all pixels get all samples

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

/// Adds a lane's point to its sums for the layers; `fire` is in front of it and lets the share `clear` through. True if the
/// point is on another sheet than the pixel's first one, or far from it.
static bool add_to_layers(const Preview *preview, Block *block, int lane, Float3 fire, float clear) {
    const Point *point = &block->point[lane];
    LayerSum *sum = &block->layer[lane];
    const float depth = point->distance * float3_dot(block->direction[lane], preview->camera.forward);
    const bool first = !sum->samples++;
    const bool other = !first && (point->sheet != sum->sheet || fabsf(depth - sum->depth) > 0.02f * depth);
    if (other) sum->ends = true;
    if (other || (!first && float3_dot(point->geometric, sum->facing) < SAME_FACING)) sum->mixed = true;
    if (other) sum->behind += depth > sum->depth ? 1 : -1;
    if (first) {
        sum->facing = point->geometric;
        sum->depth = depth;
        sum->sheet = point->sheet;
        sum->piece = point->piece;
    }

    sum->fire = float3_add(sum->fire, fire);
    sum->fire_hides += 1 - clear;
    if (!point->hit) return other;
    sum->hits++;

    // a sample counts if its piece is among the first that the pixel has met
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
    return other;
}

void block_add_light(const Preview *preview, Block *block, const int *active, int sample, const int *ask) {
    float through[LANES], known[LANES];
    bool other[LANES] = {false};
    Float3 before[LIT_KINDS][LANES];
    memcpy(before, block->lit, sizeof before);
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

        // the fire in front of the point
        if (block->tile) {
            fire_until(block->tile, block->x[i], block->y[i], point->distance, &fire, &clear);
            colour = float3_mad(fire, colour, clear);
        }

        known[i] -= float3_luminance(fire); // what hides it, or does not, makes samples differ
        through[i] = clear * (1 - point->fade);
        colour = float3(minf(colour.x, 40), minf(colour.y, 40), minf(colour.z, 40));
        block->sum[i] = float3_add(block->sum[i], colour);

        other[i] = add_to_layers(preview, block, i, fire, clear);
    }

    // sky and lamps change slowly enough for every second sample, but not where faces meet; so does the sun where it is
    // blurred. What is settled is asked no more, but for the other faces of a pixel that are met later
    const int unasked[LANES] = {0}, *asked[LIT_KINDS];
    const bool all = sample < 0 || sample >= SAMPLES_FIRST || preview->def.samples == 1 || is_still(preview);
    const bool odd = sample % 2 != 0, due[LIT_KINDS] = {odd || block->spread <= 1, !odd, odd};
    for (int k = 0; k < LIT_KINDS; k++) asked[k] = all || (due[k] && !block->settled[k]) ? ask : unasked;
    lamps_add(preview, block, active, sample, through, asked[LIT_LAMPS]);
    light_add_sun(preview, block, active, sample, through, asked[LIT_SUN]);
    light_add_sky(preview, block, active, sample, through, asked[LIT_SKY]);

    // how much the samples differ, but for what hides the light
    for (int i = 0; i < LANES; i++) {
        if (!active[i]) continue;
        float l = through[i] * float3_luminance(block->point[i].glow) - known[i];
        for (int k = 0; k < LIT_KINDS; k++) {
            l += float3_luminance(block->lit[k][i]);
            const Float3 added = float3_sub(block->lit[k][i], before[k][i]);
            if (other[i]) block->lit_other[k][i] = float3_add(block->lit_other[k][i], added);
        }
        float shown = l / (1 + l);
        block->low[i] = minf(block->low[i], shown);
        block->high[i] = maxf(block->high[i], shown);
        block->shown[i] += shown;
        block->squares[i] += shown * shown;
    }
}

/// In a bare block the rays stay the same, unless the lens spreads them.
static void add_sample(const Preview *preview, Block *block, const int *active, bool bare, int sample, const int *ask) {
    if (!bare || block->corner || preview->camera.lens > 0) {
        float at[2];
        sample_offset(sample, at);
        block_aim(preview, block, sample, at);
        if (!bare) {
            block_find_points(preview, block, active);
            glints_add(preview, block, active);
        }
        for (int i = 0; bare && i < LANES; i++)
            if (active[i]) block_see_backdrop(preview, block, i);
    }

    block_add_light(preview, block, active, sample, ask);
}

/// Whether what a pixel's samples show ends in it: it is on several sheets, or far apart, or some of them hit nothing.
static bool is_edge(const LayerSum *sum) { return sum->ends || (sum->hits > 0 && sum->hits < sum->samples); }

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

/// How much the samples of all pixels differ.
static float block_range(const Block *block) {
    float low = INFINITY, high = -INFINITY;
    for (int i = 0; i < LANES; i++) {
        low = minf(low, block->low[i]);
        high = maxf(high, block->high[i]);
    }
    return high - low;
}

/// The lanes whose first samples differ by more than `calm`, or from their neighbours'. Returns how many.
static int find_restless(const Block *block, const int *active, float calm, int *more) {
    int count = 0, hits = 0, samples = 0;
    const float range = block_range(block);
    for (int i = 0; i < LANES; i++) {
        hits += block->layer[i].hits;
        samples += block->layer[i].samples;
    }

    // where what is blurred ends, few samples agree by chance
    const bool ends = block->spread > 1 && hits > 0 && hits < samples;

    for (int i = 0; i < LANES; i++) {
        bool rests = !is_edge(&block->layer[i]) && block->high[i] - block->low[i] < calm && range < UNEVEN;
        if (block->spread > 1) rests = rests && !ends && block->high[i] - block->low[i] < 0.7f * calm;
        else rests = rests && !is_beside_edge(block, i);
        more[i] = active[i] && !rests ? -1 : 0;
        count += more[i] != 0;
    }

    return count;
}

/// Takes SAMPLES_FIRST samples of every pixel, and the rest of pixels that need it. Bare blocks get the first only. Where
/// nothing blocks the light two are enough, in bare blocks and in those that are evenly lit.
static void add_samples(const Preview *preview, Block *block, const int *active, bool bare, bool hot, int *taken) {
    const bool blurs = mask_blurs(preview, block->x[0], block->y[0]); // even if the first samples miss what is blurred
    int more[LANES], samples = preview->def.samples, first = SAMPLES_FIRST;
    if (!bare && hot) shimmer_find(preview, block, active);
    if (samples < first || is_still(preview) || block->corner) first = samples;
    for (int s = 0; s < first; s++) {
        add_sample(preview, block, active, bare, s, active);
        if (s != 1 || block->hidden || is_still(preview) || block->corner) continue;
        if (bare || (!blurs && block->spread <= 1 && !find_restless(block, active, 0.5f * CALM, more))) first = s + 1;
    }

    bool on = first < samples && !bare && first > 2 && find_restless(block, active, CALM, more);
    for (int i = 0; i < LANES; i++) taken[i] = on && more[i] ? samples : first;

    for (int s = first; s < samples && on; s++) {
        // after half of the samples: only lanes whose samples still differ visibly; soften.c smooths what lenses blur
        if (s == samples / 2) {
            const bool blurred = block->spread > 1 && block_range(block) > BLURRED;
            on = false;
            for (int i = 0; i < LANES; i++) {
                if (more[i] && !blurred && !is_edge(&block->layer[i]) && block->high[i] - block->low[i] < 0.22f) {
                    more[i] = 0;
                    taken[i] = s;
                }

                on = on || more[i];
            }
        }

        // only pixels that show several faces need more rays
        int ask[LANES];
        for (int i = 0; i < LANES; i++) ask[i] = more[i] && is_edge(&block->layer[i]);
        if (on) add_sample(preview, block, more, bare, s, ask);
    }
}

/// Aims at the middles of the pixels. Returns whether the block shows where the wall meets the ground or the background,
/// through any part of the lens.
static bool aim_at_corner(const Preview *preview, Block *block, const int *active) {
    const float centre[2] = {0, 0};
    const int rays = !isfinite(preview->def.wall_distance) ? 0 : preview->camera.lens > 0 ? 8 : 1;
    int walls = 0, lanes = 0;
    int step = BLOCK - 1; // its corners among others: where they agree, the wall's straight border is not
    for (int i = 0; i < LANES; i++)
        if (!active[i]) step = 1;
    for (int s = 0; s < rays; s++) {
        block_aim_each(preview, block, s, centre, step);
        for (int i = 0; i < LANES; i += step) {
            if (!active[i]) continue;
            const float ground = ground_hit(preview, block->origin[i], block->direction[i]);
            walls += wall_hit(preview, block->origin[i], block->direction[i]) < ground;
            lanes++;
        }
    }
    block_aim(preview, block, SAMPLE_CENTRE, centre);
    return walls > 0 && walls < lanes;
}

void block_draw(Preview *preview, Block *block) {
    const PreviewDef *def = &preview->def;
    int active[LANES], taken[LANES];
    block->hidden = false;
    memset(block->settled, 0, sizeof block->settled);
    block->spread = 0;
    memset(block->lit, 0, sizeof block->lit);
    memset(block->lit_other, 0, sizeof block->lit_other);
    memset(block->lit_seen, 0, sizeof block->lit_seen);
    memset(block->lit_asked, 0, sizeof block->lit_asked);
    memset(block->bend, 0, sizeof block->bend);

    for (int i = 0; i < LANES; i++) {
        active[i] = block->x[i] < def->width && block->y[i] < def->height ? -1 : 0;
        block_forget_lamps(block, i);
        sample_pixel(block->x[i], block->y[i], def->seed, block->turn[i]);
        block->key[i] = sample_key(block->x[i], block->y[i], def->seed);
        block->sum[i] = float3(0, 0, 0);
        block->low[i] = INFINITY;
        block->high[i] = -INFINITY;
        block->shown[i] = block->squares[i] = 0;
        block->time[i] = 0.5f;
        block->layer[i] = (LayerSum){.depth = INFINITY, .sheet = -1, .piece = -1};
    }

    const bool hot = block->tile && fire_is_hot(block->tile, block->x[0], block->y[0]);
    const bool bare = !(hot ? mask_nears : mask_covers)(preview, block->x[0], block->y[0]);
    block->corner = false;
    if (bare) {
        block->corner = aim_at_corner(preview, block, active);
        for (int i = 0; i < LANES; i++)
            if (active[i]) block_see_backdrop(preview, block, i);
    }

    // in a still nothing is smoothed, so lamps, whose shadows reach far, need all samples
    const bool lamps = is_still(preview) && preview->scene.light_count;
    if (bare && !block->corner && !lamps && !light_may_be_hidden(preview, block, active)) {
        block_add_light(preview, block, active, SAMPLE_CENTRE, active);
        for (int i = 0; i < LANES; i++) taken[i] = 1;
    } else {
        add_samples(preview, block, active, bare, hot, taken);
    }

    // the picture gets the mean of the sums
    for (int i = 0; i < LANES; i++) {
        if (!active[i]) continue;
        size_t pixel = block_pixel(preview, block, i);
        preview->picture[pixel] = float3_scale(block->sum[i], 1 / (float)taken[i]);
        layers_write(preview, pixel, &block->layer[i]);
        const LayerSum *sum = &block->layer[i];
        seen_write(preview, pixel, block, i, taken[i], is_edge(sum) || sum->mixed);
    }
}
