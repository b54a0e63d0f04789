// Where flames stand.
//
// The gas has cells of several millimetres, and its fuel enters half a cell off a sheet: so gas burns aside of the rim, over
// paper that is whole, and above a sheet under which another one burns. Flames stand on what burns and is seen to:
//
// A vertex feeds a flame unless whole paper covers it: less than COVER above it, on both sides of its own sheet.
//
// A flame follows the gas that rises from what burns, however much that leans, and spreads by little: by LEAN, and higher
// up, where it mixes with air, by LEAN_HIGH. With a and h the horizontal distance to a vertex that feeds it and the height
// above that, how far a place is aside of all flames is, at the vertex,
//
//     s(x) = min (a - LEAN h),   with LEAN_BELOW (h + BELOW_FREE) for LEAN h below
//
// and upwards from there, layer by layer, s(x) = s(x - v dt) - LEAN dz. A flame of which more was left had feet as wide as
// the gas's cells: bags of haze beside the paper. Where s is FAR or more, no foot is near, and the way up brings none nearer.
//
// A hot shape feeds flames, too. With cells of size dx a flame f loses LEAN_FALLS (s/dx - LEAN_FOOT).
//
// Fuel that enters hot gas burns further up, so a flame may hang above the rim. It comes down to what burns there: up to
// two cells from above, and to RIM_FLAME at most, times a share that falls from the vertex to RIM_REACH.

#include "preview/internal.h"

#include <string.h>

#define COVER 0.03f       ///< m
#define COVER_OFF 0.0015f ///< m off the sheet, where the search begins
#define COVER_WHOLE 0.3f  ///< burnt share, up to which paper hides flames below it
#define LEAN 0.17f
#define LEAN_HIGH 0.6f
#define LEAN_BEGINS 0.02f ///< m above what burns, up to which it spreads by LEAN, in a flame of scale 1
#define LEAN_ENDS 0.06f
#define LEAN_BELOW 2.0f
#define BELOW_FREE 1.5f ///< cells below, from where on it counts: the flame at the paper is a mean with theirs
#define LEAN_FOOT 0.3f  ///< cells
#define LEAN_FALLS 1.3f ///< per cell
#define RIM_FLAME 0.85f ///< of a full flame, where paper burns
#define RIM_REACH 1.5f  ///< cells, over which that ends
#define RIM_UP 0.6f     ///< of a cell's height
#define RIM_BELOW 2.0f  ///< of one down
#define RIM_LOW 0.1f    ///< 1/s, rate from which on paper has a flame of its own
#define RIM_HIGH 1.0f
#define SHAPE_HOT 800.0f ///< K
#define NOWHERE 0.04f    ///< m
#define FAR 0.039f       ///< m, a little less: between cells that no foot is near

static bool stops_at_whole(void *context, int lane, uint32_t triangle, float u, float v) {
    (void)lane, (void)u, (void)v;
    const PreviewScene *scene = context;
    const uint32_t *t = scene->triangles[triangle];
    const PaperVertex *a = scene->vertices;
    return maxf(a[t[0]].burn, maxf(a[t[1]].burn, a[t[2]].burn)) < COVER_WHOLE;
}

/// Vertices that whole paper covers feed no flame. Each has two rays, and a packet those of LANES / 2.
static void cover(PreviewScene *scene) {
    uint32_t at[LANES / 2];
    Rays rays;
    int count = 0;
    for (uint32_t v = 0; v <= scene->vertex_count; v++) {
        const bool last = v == scene->vertex_count;
        if (!last && scene->vertices[v].feeds >= FLAMES_FROM) {
            for (int side = 0; side < 2; side++) {
                const Float3 normal = float3_load(scene->vertices[v].normal);
                const Float3 from = float3_mad(float3_load(scene->positions[v]), normal, side ? COVER_OFF : -COVER_OFF);
                aim_ray(&rays, 2 * count + side, from, float3(0, 0, 1), 0, COVER, 0.5f);
            }
            at[count++] = v;
        }
        if (!count || (!last && count < LANES / 2)) continue;

        for (int i = 2 * count; i < LANES; i++) rest_ray(&rays, i);
        bvh_pass(&scene->bvh, &rays, stops_at_whole, scene);
        for (int i = 0; i < count; i++)
            if (rays.far[2 * i] < 0 && rays.far[2 * i + 1] < 0) scene->vertices[at[i]].feeds = 0;
        count = 0;
    }
}

static size_t cell_at(const Fire *fire, int x, int y, int z) {
    return (size_t)x + (size_t)fire->size[0] * ((size_t)y + (size_t)fire->size[1] * (size_t)z);
}

/// s of what is at g and `wide` across, in cells, in the cells of its height; and its own flame.
static void add_foot(Fire *fire, Float3 g, float wide, float rate) {
    const size_t layer = (size_t)fire->size[0] * (size_t)fire->size[1];
    const float own = RIM_FLAME * stepf(RIM_LOW, RIM_HIGH, rate);
    const float reach = NOWHERE / fire->cell;
    const int low[3] = {(int)clampf(ceilf(g.x - reach), 0, (float)fire->size[0]),
                        (int)clampf(ceilf(g.y - reach), 0, (float)fire->size[1]),
                        (int)clampf(ceilf(g.z) - 2, 0, (float)fire->size[2])};
    const int high[3] = {(int)clampf(floorf(g.x + reach), -1, (float)fire->size[0] - 1),
                         (int)clampf(floorf(g.y + reach), -1, (float)fire->size[1] - 1),
                         (int)clampf(floorf(g.z + 1), -1, (float)fire->size[2] - 1)};
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int x = low[0]; x <= high[0]; x++) {
                const float dx = (float)x - g.x, dy = (float)y - g.y, dz = (float)z - g.z;
                const float less = dz > 0 ? LEAN * dz : LEAN_BELOW * minf(dz + BELOW_FREE, 0);
                const float aside = dx * dx + dy * dy, up = dz > 0 ? RIM_UP * dz : RIM_BELOW * dz;
                float *apart = &fire->apart[cell_at(fire, x, y, z)], *flame = &fire->source[cell_at(fire, x, y, z)][2];
                *apart = minf(*apart, fire->cell * (sqrtf(aside) - wide - less));
                if (aside > RIM_REACH * RIM_REACH || z + 2 >= fire->size[2]) continue;
                const float above = maxf(flame[4 * layer], flame[8 * layer]);
                *flame = maxf(*flame, minf(above, own * (1 - sqrtf(aside + up * up) / RIM_REACH)));
            }
}

/// s upwards from the feet, with the gas.
static void follow_feet(Fire *fire) {
    const float each = 1 / sqrtf(fire->scale);
    for (int z = 1; z < fire->size[2]; z++)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) {
                const size_t here = cell_at(fire, x, y, z);
                float fx, fy;
                const int ix = noise_floor((float)x - fire->source[here][0], &fx);
                const int iy = noise_floor((float)y - fire->source[here][1], &fy);
                const float *a = &fire->apart[cell_at(fire, ix, iy, z - 1)], *b = a + fire->size[0];
                const float from = mixf(mixf(a[0], a[1], fx), mixf(b[0], b[1], fx), fy);
                const float risen =
                    fire->cell + fire->sway[cell_at(fire, ix + (fx > 0.5f), iy + (fy > 0.5f), z - 1)][0];
                const float lean = mixf(LEAN, LEAN_HIGH, stepf(LEAN_BEGINS, LEAN_ENDS, risen * each));
                if (from > FAR || from - lean * fire->cell > fire->apart[here]) continue;
                fire->apart[here] = from - lean * fire->cell;
                fire->sway[here][0] = risen;
            }
}

void fire_find_feet(Preview *preview) {
    PreviewScene *scene = &preview->scene;
    Fire *fire = &preview->fire;
    cover(scene);
    bool any = false;
    for (size_t i = 0; i < fire->cell_capacity; i++) fire->apart[i] = NOWHERE;
    memset(fire->sway, 0, fire->cell_capacity * sizeof *fire->sway); // heights above feet, until the cells sway
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        any = any || scene->vertices[i].flaming >= FLAMES_FROM;
        if (scene->vertices[i].feeds < FLAMES_FROM) continue;
        const Float3 from = float3_sub(float3_load(scene->positions[i]), fire->origin);
        add_foot(fire, float3_scale(from, 1 / fire->cell), 0, scene->vertices[i].feeds);
    }

    // a match has a flame of its own; and where nothing burns, flames are what a caller has put there
    for (uint32_t k = 0; k < preview->shape_count; k++) {
        const PreviewShape *shape = &preview->shapes[k];
        if (shape->temperature < SHAPE_HOT) continue;
        const Float3 from = float3_sub(shape_centre(shape), fire->origin);
        add_foot(fire, float3_scale(from, 1 / fire->cell), shape_extent(shape, 0) / fire->cell, 0);
    }
    if (!any) memset(fire->apart, 0, fire->cell_capacity * sizeof *fire->apart);

    follow_feet(fire);
}

float fire_leans(const Fire *fire, float apart) { return LEAN_FALLS * maxf(apart / fire->cell - LEAN_FOOT, 0); }
