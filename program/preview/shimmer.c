// What is seen through hot gas shimmers.
//
// Light is bent towards what is denser, by the gradient of the refractive index along its way: n - 1 is 2.8e-4 in air and in
// proportion to its density, a fifth of that in a flame. Eddies have steep borders, which a ray meets one after another while
// the shutter is open. So it is turned by an angle of the eddies that pass, the same for rays side by side, and spread over
// others. With l the length of the way in hot gas, up to what is seen, the angle is
//
//     a = BENDS l / (l + BENDS_HALF)
//
// some times what air alone does over so short a way: print would lie behind a flame as sharp as if that were a picture laid
// over it. What lies far behind would be torn: it is shifted by SHIFT_MOST at most. The gas bends a ray in the middle of that
// length, and what is near there stays in its place.

#include "preview/block.h"

#define BENDS 0.035f
#define BENDS_HALF 0.006f ///< m
#define SHIFT_MOST 0.003f ///< of the picture's height
#define SPREADS 0.9f      ///< of the angle
#define SPREAD_KEY 0x6a31c5d9u

void shimmer_bend(const Preview *preview, Block *block, int lane, int sample) {
    const Camera *camera = &preview->camera;
    const float *to = block->bend_to[lane], height = (float)preview->def.height;
    float square[2], disc[2];

    // the same points for all pixels: as they are spread by little, their means are smooth
    sample_lens((uint32_t)sample, SPREAD_KEY, square);
    sample_disc(square, disc);
    const float up = block->bend[lane] / (0.5f * height * camera->pixel),
                right = up * height / (float)preview->def.width;
    const Float3 across = float3_scale(camera->right, right * (to[0] + SPREADS * disc[0]));
    const Float3 turn = float3_mad(across, camera->up, up * (to[1] + SPREADS * disc[1]));
    block->origin[lane] = float3_mad(block->origin[lane], turn, -block->bend_at[lane]);
    block->direction[lane] = float3_unit(float3_add(block->direction[lane], turn));
}

void shimmer_find(const Preview *preview, Block *block, const int *active) {
    Met met;
    block_aim(preview, block, SAMPLE_CENTRE, (const float[2]){0, 0});
    for (int i = 0; i < LANES; i++) {
        aim_ray(&block->rays, i, block->origin[i], block->direction[i], 0, INFINITY, block->time[i]);
        block->valid[i] = active[i];
    }
    tracer_intersect(preview, block->valid, &block->rays, &block->hits);
    tracer_meet_shapes(preview, block->valid, &block->rays, &block->hits, &met);

    for (int i = 0; i < LANES; i++) {
        if (!active[i]) continue;
        const Float3 from = block->origin[i], ray = block->direction[i];
        const float seen = minf(met.distance[i], backdrop_hit(preview, from, ray));
        const float hot = fire_heats(block->tile, block->x[i], block->y[i], seen, &block->bend_at[i]);
        if (!(hot > 0)) continue;
        const float angle = BENDS * hot / (hot + BENDS_HALF);
        const float shift = angle * (1 - block->bend_at[i] / seen) / preview->camera.pixel;
        block->bend[i] = angle / (1 + shift / (SHIFT_MOST * (float)preview->def.height));
        fire_turns(&preview->fire, float3_mad(from, ray, block->bend_at[i]), block->bend_to[i]);
    }
}
