// One frame: tiles of blocks of 4 x 4 pixels, by threads. Before them the table's own colour and what it mirrors; after
// them the light is smoothed (seen.c, soften.c), and sparks, flakes and wisps are added.

#include "preview/ground.h"
#include "preview/airborne.h"
#include "preview/share.h"

#include <stdatomic.h>
#include <string.h>

#define FIRE_MIRRORED \
    2.0f ///< times as long as usual are steps through a fire that is mirrored, and smoothed afterwards

typedef struct Job {
    Preview *preview;
    void (*draw)(Preview *preview, Block *block); ///< one block
    void (*beside)(Preview *preview); ///< what needs nothing of the blocks, and nothing of them needs; or NULL
    atomic_int next;
    int side; ///< of a tile, in pixels
    int across, count;
    bool fire; ///< flame and smoke are drawn
} Job;

/// Adds the fire to what blocks mirror. Two of them above each other see the same, unless something hides it from one.
static void mirror_fire(Preview *preview, const Block *block, const int *active, const Float3 *origin,
                        const Float3 *towards, const float *reached) {
    Float3 from[LANES], along[LANES], light[LANES];
    float far[LANES], clear[LANES];
    int count = 0, ray[LANES];
    bool open = false;
    for (int k = 0; k < LANES; k++) {
        const int i = k / 4 + BLOCK * (k % 4);
        const bool shared = k % 2 && open;
        ray[i] = -1;
        open = active[i] && reached[i] > fire_leaves(&preview->fire, origin[i], towards[i]);
        if (!active[i]) continue;
        if (!(shared && open)) {
            from[count] = origin[i];
            along[count] = towards[i];
            far[count++] = reached[i];
        }
        ray[i] = count - 1;
    }

    fire_along(preview, count, from, along, far, FIRE_MIRRORED, light, clear);
    for (int i = 0; i < LANES; i++) {
        if (ray[i] < 0) continue;
        Mirrored *mirrored = &preview->mirrored[0][mirror_block(preview, block, i)];
        mirrored->light = float3_mad(light[ray[i]], mirrored->light, clear[ray[i]]);
        mirrored->share = 1 - clear[ray[i]] * (1 - mirrored->share);
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
    block->mirrored = true;

    for (int i = 0; i < LANES; i++) {
        active[i] = 0;
        block_forget_lamps(block, i);
        if (!mirror_aim(preview, block, i, &origin[i], &towards[i])) continue;
        preview->mirrored[0][mirror_block(preview, block, i)] = (Mirrored){.share = 0};
        float distance = ground_hit(preview, origin[i], towards[i]);
        if (!isfinite(distance) || wall_hit(preview, origin[i], towards[i]) < distance) continue;
        origin[i] = float3_mad(origin[i], towards[i], distance);
        origin[i].z += preview->scene.epsilon;
        towards[i].z = -towards[i].z;
        active[i] = -1;
    }

    const int unasked[LANES] = {0};
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
        block_find_points(preview, block, active);
        for (int i = 0; i < LANES; i++) {
            hit[i] = active[i] && block->point[i].lit ? -1 : 0;
            if (active[i] && !s) reached[i] = block->point[i].distance;
        }
        block_add_light(preview, block, hit, SAMPLE_CENTRE, unasked);
        for (int i = 0; i < LANES; i++) {
            if (!hit[i]) continue;
            Mirrored *mirrored = &preview->mirrored[0][mirror_block(preview, block, i)];
            mirrored->share += share;
            for (int k = 0; k < LIT_KINDS; k++) block->sum[i] = float3_add(block->sum[i], block->lit[k][i]);
            mirrored->light = float3_mad(mirrored->light, block->sum[i], share);
        }
    }

    if (preview->fire.visible) mirror_fire(preview, block, active, origin, towards, reached);
}

/// The table's own colour in every pixel. The camera does not move, so it is computed once.
static void fill_table(Preview *preview, Block *block) {
    Table sum[LANES] = {{.polish = 0}};
    int count[LANES] = {0};
    AshSquares squares = {0};
    for (int i = 0; i < LANES; i++)
        block->key[i] = 0x80008000u; // the same points of the lens, or a soft table were speckled

    // where a lens blurs the table, its grain is as fine as the distance between the samples on the lens
    block_aim(preview, block, SAMPLE_CENTRE, (const float[2]){0, 0});
    float far = backdrop_hit(preview, block->origin[0], block->direction[0]);
    float blur = isfinite(far) ? camera_blur(&preview->camera, far) : 0, wide = maxf(blur, 1);
    const int samples = blur > 1.5f ? 9 : 4;

    for (int s = 0; s < samples; s++) {
        float at[2];
        sample_offset(s, at);
        block_aim(preview, block, s, at);
        for (int i = 0; i < LANES; i++) {
            const float ground = ground_hit(preview, block->origin[i], block->direction[i]);
            const float distance = backdrop_hit(preview, block->origin[i], block->direction[i]);
            if (!isfinite(distance)) continue;
            Table look;
            Float3 position = float3_mad(block->origin[i], block->direction[i], distance);
            if (distance < ground) wall_look(preview, position, wide * preview->camera.pixel * distance, &look);
            else ground_look(preview, position, block->direction[i].z, wide * distance, &squares, &look);
            sum[i].albedo = float3_add(sum[i].albedo, look.albedo);
            sum[i].polish += look.polish;
            sum[i].ash.albedo += look.ash.albedo;
            sum[i].ash.cover += look.ash.cover;
            for (int d = 0; d < 2; d++) {
                sum[i].tilt[d] += look.tilt[d];
                sum[i].ash.tilt[d] += look.ash.tilt[d];
                sum[i].ash.from[d] += look.ash.from[d];
            }
            count[i]++;
        }
    }

    for (int i = 0; i < LANES; i++) {
        if (block->x[i] >= preview->def.width || block->y[i] >= preview->def.height) continue;
        float share = 1 / maxf((float)count[i], 1);
        preview->table[block_pixel(preview, block, i)] =
            (Table){.albedo = float3_scale(sum[i].albedo, share),
                    .polish = share * sum[i].polish,
                    .ash = {.cover = share * sum[i].ash.cover,
                            .albedo = share * sum[i].ash.albedo,
                            .tilt = {share * sum[i].ash.tilt[0], share * sum[i].ash.tilt[1]},
                            .from = {share * sum[i].ash.from[0], share * sum[i].ash.from[1]}},
                    .tilt = {share * sum[i].tilt[0], share * sum[i].tilt[1]}};
    }
}

static void draw_tiles(void *context, int thread) {
    Job *job = context;
    Block block = {.tile = NULL};
    const PreviewDef *def = &job->preview->def;
    FireTile *fire = job->fire ? &job->preview->fire.tiles[thread] : NULL;

    for (int tile; (tile = atomic_fetch_add(&job->next, 1)) < job->count;) {
        if (def->stop && def->stop()) break;
        if (tile < 0) {
            job->beside(job->preview);
            continue;
        }
        int x0 = tile % job->across * job->side, y0 = tile / job->across * job->side;
        if (fire) fire_see(job->preview, x0, y0, fire);
        block.tile = fire && !fire->empty ? fire : NULL;
        for (int y = y0; y < y0 + job->side && y < def->height; y += BLOCK)
            for (int x = x0; x < x0 + job->side && x < def->width; x += BLOCK) {
                for (int i = 0; i < LANES; i++) {
                    block.x[i] = x + i % BLOCK;
                    block.y[i] = y + i / BLOCK;
                }
                job->draw(job->preview, &block);
            }
    }
}

/// Draws all blocks; `beside`, if any, is done first by one of the threads, as it is longer than a tile.
static void draw_all(Preview *preview, void (*draw)(Preview *, Block *), void (*beside)(Preview *)) {
    Job job = {.preview = preview, .draw = draw, .beside = beside, .side = TILE};
    job.fire = draw == block_draw && preview->fire.visible;
    if (job.fire) job.side = FIRE_SQUARES * fire_every(preview);
    job.across = (preview->def.width + job.side - 1) / job.side;
    job.count = job.across * ((preview->def.height + job.side - 1) / job.side);
    atomic_init(&job.next, beside ? -1 : 0);
    const int threads = preview->def.thread_count;
    share_out(threads, threads, draw_tiles, &job);
}

/// What is made of a frame's surface before anything is seen, in parts that do not need each other.
enum { READY_FIRE, READY_MASK, READY_GROUND, READY_PARTS };

static void ready_part(void *context, int part) {
    Preview *preview = context;
    switch (part) {
    case READY_FIRE: fire_raise(preview); break;
    case READY_MASK: mask_fill(preview); break;
    default: wood_singe(preview); stain_fill(preview);
    }
}

/// Blurred pixels are smoothed before the veil comes over them.
static void finish_block(Preview *preview, Block *block) {
    soften(preview, block);
    airborne_lay(preview, block);
}

SingeResult preview_draw(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb, SingeError *error) {
    return preview_draw_layers(preview, surface, time, rgb, &(PreviewLayers){.glow = NULL}, error);
}

SingeResult preview_draw_layers(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb,
                                const PreviewLayers *layers, SingeError *error) {
    if (!isfinite(time)) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the time is not finite");
    preview->time = time;
    TRY(tracer_load(preview, surface, error));

    preview->layers = *layers;
    share_out(preview->def.thread_count, READY_PARTS, ready_part, preview);
    light_gather(preview);
    fire_light_smoke(preview);
    if (!preview->table_known) draw_all(preview, fill_table, NULL);
    preview->table_known = !(preview->def.stop && preview->def.stop());
    draw_all(preview, draw_mirrored, NULL);
    // further down: what is rough draws lights out towards the eye
    for (int pass = 0; pass < 2 && preview->mirrored[0]; pass++)
        mirror_smooth(preview, preview->mirrored, 2 + preview->def.height / 90);
    draw_all(preview, glints_draw, NULL);
    draw_all(preview, block_draw, airborne_draw);
    draw_all(preview, seen_smooth, NULL);
    gaps_fill(preview);
    draw_all(preview, seen_finish, NULL);
    draw_all(preview, finish_block, NULL);
    if (preview->def.stop && preview->def.stop())
        return preview_fail(error, SINGE_ERROR_STATE, -1, "the picture was given up");

    const size_t pixels = (size_t)preview->def.width * (size_t)preview->def.height;
    for (size_t i = 0; layers->beauty && i < pixels; i++) float3_store(layers->beauty[i], preview->picture[i]);
    if (rgb) {
        bloom_apply(preview);
        tonemap_write(preview, rgb);
    }

    return SINGE_OK;
}
