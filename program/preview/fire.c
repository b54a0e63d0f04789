// Prepares the gas for drawing: flame and smoke, cell by cell, and the empty regions.
//
// With q the heat released (W/m3), the flame is f = ln(q/q0) / ln(q1/q0), from 0 to 1. The logarithm falls evenly from a
// flame's middle to its outside and its tip, so that noise moves its edge alike everywhere; q itself is a peak with steep
// sides, whose contours are round.
//
// The gas burns its fuel within a cell or two, and a flame of that size burns as it mixes with air, which takes longer the
// larger it is. So light lasts for a while in what rises out of burning cells, and falls by e in tau = sqrt(dx/2g):
// f(x) is at least f(x - v dt) - dz/(vz tau ln(q1/q0)).
//
// The height of a flame's gas above the paper is that above what burns around its cell, less the further aside that is,
// and elsewhere found by following the velocity back, layer by layer from below: r(x) = (r(x - v dt) + dz) times the
// share that was burning there; it distinguishes the clear base, the bright centre and the torn tip. Cells below what
// burns have its flame and a negative height: so both are linear at the paper, where flames begin. Gas that burns low,
// but several cells aside of what gives it off, has a negative height, too, and no foot there. Smoke is its extinction,
// 8.7 m2/g times its density (Mulholland & Croarkin 2000, for the soot of flames), where the gas is cold: in hot gas soot
// still burns and vapours have not condensed.

#include "preview/fire_lanes.h"
#include "preview/internal.h"

#include <string.h>

#define FLAME_LOW 5e4f     ///< W/m3, the heat released where the flame is 0
#define FLAME_HIGH 5e6f    ///< where it is 1
#define FLAME_THICK 0.014f ///< m, of burning gas: in wider cells the heat is a mean with what does not burn
#define ROOT_REACH 4.4f    ///< cells, over which what burns gives gas its height
#define ROOT_OVER 1.5f     ///< cells aside of what burns, over which flames come down to it
#define ROOT_FALLS 0.05f   ///< of a full flame per cell, as they do
#define ROOT_WIDE 0.6f     ///< cells aside, from which on a flame draws together
#define ROOT_LEAN 0.4f
#define NOISE_LARGER 0.85f ///< of the hills of one size, how high those are that are twice as wide
#define NOISE_SIZES 0.68f  ///< of the smallest, so that all of them vary as one size would
#define FIRE_PASSING 0.93f ///< share of the gas over burning paper that came from flames below
#define MIX_PASSES 2       ///< in which a flame mixes with what is beside it
#define MIX_SHARE 0.2f     ///< that goes to each of the four cells beside it in one of them
#define MIX_BEGINS 0.01f   ///< m above the paper
#define MIX_FULL 0.06f     ///< m
#define MIX_FEEDS 0.5f     ///< air that it mixes with makes more of it burn, the more fuel is left
#define MIX_BURNT 1.5f     ///< nothing more does
#define SMOKE_COLD 450.0f  ///< K: what is colder is all smoke
#define SMOKE_HOT 650.0f   ///< K: what is hotter is none yet
#define SMOKE_FOLLOWS 0.4f ///< m of the air's way from a flame, over which smoke that comes from it falls by e
#define SMOKE_BESIDE 0.8f  ///< of what comes from a flame, what cells beside that have
#define SMOKE_TIP 0.03f ///< share of a fire's brightest cell from which smoke beside and below takes a cell for a flame
#define SMOKE_TIPS 0.09f ///< m below and beside it over which that falls by a factor of e
#define SMOKE_BELOW \
    0.9f ///< share of its light that smoke there does not show: it would look like a pale blob without a root
#define SMOKE_ADRIFT 0.25f ///< of smoke that comes from no flame, what is seen as long as there are flames
#define SMOKE_FLAME 0.3f   ///< flame from which on it is full for smoke
#define SMOKE_LEAVES 0.25f ///< of the gas's height, from the top down, in which smoke fades: there the gas is cut

static size_t fire_at(const Fire *fire, int x, int y, int z) {
    return (size_t)x + (size_t)fire->size[0] * ((size_t)y + (size_t)fire->size[1] * (size_t)z);
}

// ---- height above the paper

/// The rate at which paper burns around each cell, and the mean place, in cells; what is nearer counts more.
static void find_roots(Preview *preview) {
    const PreviewScene *scene = &preview->scene;
    Fire *fire = &preview->fire;

    memset(fire->roots, 0, fire->cell_capacity * sizeof *fire->roots);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        const float rate = scene->vertices[i].feeds;
        if (rate < FLAMES_FROM) continue;
        const Float3 g = float3_scale(float3_sub(float3_load(scene->positions[i]), fire->origin), 1 / fire->cell);
        const float at[3] = {g.x, g.y, g.z};
        int low[3], high[3];
        for (int c = 0; c < 3; c++) {
            low[c] = (int)clampf(ceilf(at[c] - ROOT_REACH), 0, (float)fire->size[c]);
            high[c] = (int)clampf(floorf(at[c] + ROOT_REACH), -1, (float)fire->size[c] - 1);
        }

        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++) {
                    const Float3 to = float3_sub(g, float3((float)x, (float)y, (float)z));
                    const float near = 1 - float3_dot(to, to) / (ROOT_REACH * ROOT_REACH);
                    if (near < 0.05f) continue; // its power would be 0
                    const float near4 = near * near * near * near, weight = rate * near4 * near4 * near4 * near4;
                    float *root = fire->roots[fire_at(fire, x, y, z)];
                    root[0] += weight, root[1] += weight * g.x, root[2] += weight * g.y, root[3] += weight * g.z;
                }
    }
}

/// The height of a cell above what burns around it, and how near that is, 1 to 0 a cell away. Flames draw together towards
/// it: what is aside is less high.
static float root_height(const Fire *fire, int x, int y, int z, float *near) {
    const float *root = fire->roots[fire_at(fire, x, y, z)], each = 1 / root[0];
    const float dx = (float)x - each * root[1], dy = (float)y - each * root[2], dz = (float)z - each * root[3];
    const float aside = sqrtf(dx * dx + dy * dy);
    *near = maxf(1 - sqrtf(aside * aside + dz * dz), 0);
    return fire->cell * (dz - ROOT_LEAN * maxf(aside - ROOT_WIDE, 0));
}

/// Near paper the gas is too rich to burn: flames that begin a few cells above what burns come down to it.
static void root_cells(Fire *fire) {
    for (int z = fire->size[2] - 3; z > 0; z--)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) {
                const size_t here = fire_at(fire, x, y, z), above = fire_at(fire, x, y, z + 1);
                const float *root = fire->roots[here];
                if (!(root[0] > 0) || fire->source[above][2] - ROOT_FALLS <= fire->source[here][2]) continue;
                const float dx = (float)x - root[1] / root[0], dy = (float)y - root[2] / root[0];
                const float aside = sqrtf(dx * dx + dy * dy), dz = (float)z - root[3] / root[0];
                if (aside > ROOT_OVER || dz < -1) continue;
                fire->source[here][2] = fire->source[above][2] - ROOT_FALLS;
            }
}

/// The height of the gas above the paper where paper burns, and upwards from there, layer by layer.
static void raise_cells(Preview *preview) {
    Fire *fire = &preview->fire;
    for (int z = 1; z < fire->size[2] - 1; z++)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) {
                size_t here = fire_at(fire, x, y, z), above = fire_at(fire, x, y, z + 1);
                FireCell *cell = &fire->cells[here];
                const float *drift = fire->source[here];
                cell->rise = 0;

                // the layer below, where the gas came from: at (x - vx/vz, y - vy/vz)
                float fx, fy;
                int ix = noise_floor((float)x - drift[0], &fx), iy = noise_floor((float)y - drift[1], &fy);
                const FireCell *a = &fire->cells[fire_at(fire, ix, iy, z - 1)], *b = a + fire->size[0];
                float flame = mixf(mixf(a[0].flame, a[1].flame, fx), mixf(b[0].flame, b[1].flame, fx), fy);
                const bool roots = fire->roots[here][0] > 0;
                float near;
                const float height = roots ? root_height(fire, x, y, z, &near) : 0;

                // below what burns, too, or flames would fade towards it
                const bool below = roots && flame <= 0 && fabsf(height) < fire->cell;
                const float own = below ? maxf(drift[2], fire->source[above][2]) : drift[2];
                cell->flame = maxf(own, flame - fire->fading / drift[3]);
                if (cell->flame <= 0) continue;

                float rise = mixf(mixf(a[0].rise, a[1].rise, fx), mixf(b[0].rise, b[1].rise, fx), fy);
                if (flame > 0)
                    cell->rise = cell->flame * minf(2 * flame / cell->flame, 1) * (rise / flame + fire->cell);

                // up a hanging sheet gas that has burnt for a while passes what begins to
                if (!roots) continue;
                const float passing = minf(flame / cell->flame, 1) * (1 - (1 - FIRE_PASSING) * near);
                cell->rise = mixf(cell->flame * height, cell->rise, passing);
            }
}

// ---- mixing

/// The share of a flame that has mixed with air, at its height.
static float mixed_share(const Fire *fire, const FireCell *cell) {
    return stepf(MIX_BEGINS * fire->scale, MIX_FULL * fire->scale, cell->rise / cell->flame);
}

/// A flame grows wider as it rises and mixes with the air beside it. The gas has steep sides, a cell or two thick: noise moves
/// an edge by no more than that, and where the gas stands straight, so did its flame.
static void mix_cells(Fire *fire) {
    const size_t row = (size_t)fire->size[0], count = row * (size_t)fire->size[1] * (size_t)fire->size[2];
    for (int pass = 0; pass < MIX_PASSES; pass++) {
        for (size_t here = row; here < count - row; here++) {
            const FireCell *cell = &fire->cells[here];
            const FireCell *beside[4] = {cell - 1, cell + 1, cell - row, cell + row};
            float *mixed = fire->sway[here]; // free until the cells sway
            mixed[0] = cell->flame;
            mixed[1] = cell->rise;
            for (int k = 0; k < 4; k++) {
                const FireCell *more = beside[k]->flame > cell->flame ? beside[k] : cell;
                if (more->flame <= 0) continue;
                const float share = MIX_SHARE * mixed_share(fire, more);
                mixed[0] += share * (beside[k]->flame - cell->flame);
                mixed[1] += share * (beside[k]->rise - cell->rise);
            }
        }

        for (size_t here = row; here < count - row; here++)
            fire->cells[here].flame = fire->sway[here][0], fire->cells[here].rise = fire->sway[here][1];
    }

    for (size_t here = row; here < count - row; here++) {
        FireCell *cell = &fire->cells[here];
        if (cell->flame <= 0) continue;
        const float fed = 1 + MIX_FEEDS * maxf(MIX_BURNT - cell->flame, 0) * mixed_share(fire, cell);
        cell->flame *= fed;
        cell->rise *= fed;
    }
}

// ---- the widest eddies

/// How far eddies move the flame of each cell, and how much they feed it. The height of a flame's gas is known in its own
/// cells and around what burns; it is spread over those around them, as far as eddies reach.
static void sway_cells(Fire *fire) {
    const size_t over[3] = {1, (size_t)fire->size[0], (size_t)fire->size[0] * (size_t)fire->size[1]};

    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++) {
                const size_t here = fire_at(fire, x, y, z);
                const FireCell *cell = &fire->cells[here];
                const bool burns = cell->flame > 0.5f * FLAME_SEEN; // a fainter one's height is not known well
                const bool roots = fire->roots[here][0] > 0;
                float near, *sway = fire->sway[here];
                sway[0] = sway[1] = 0;
                sway[2] = burns ? cell->rise / cell->flame : roots ? root_height(fire, x, y, z, &near) : 0;
                sway[3] = burns || roots; // later 1 more than the number of cells over which it was spread
            }

    const int reach = 1 + (int)minf(fire->scale * FIRE_SWAY / fire->cell, 1000);
    for (int far = 1; far <= reach; far++)
        for (int z = 1; z < fire->size[2] - 1; z++)
            for (int y = 1; y < fire->size[1] - 1; y++)
                for (int x = 1; x < fire->size[0] - 1; x++) {
                    const size_t here = fire_at(fire, x, y, z);
                    if (fire->sway[here][3] > 0) continue;
                    float sum = 0, count = 0;
                    for (int c = 0; c < 3; c++)
                        for (int side = 0; side < 2; side++) {
                            const float *near = fire->sway[side ? here + over[c] : here - over[c]];
                            if (!(near[3] > 0) || near[3] > (float)far) continue;
                            sum += near[2] + (c < 2 ? 0 : side ? -fire->cell : fire->cell);
                            count++;
                        }
                    if (count <= 0) continue;
                    fire->sway[here][2] = maxf(sum / count, 0);
                    fire->sway[here][3] = (float)far + 1;
                }

    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++) {
                float *sway = fire->sway[fire_at(fire, x, y, z)];
                if (!(sway[3] > 0)) continue;
                const Float3 p = float3_mad(fire->origin, float3((float)x, (float)y, (float)z), fire->cell);
                fire_sway(fire, p, sway[2], sway);
                FireCell *cell = &fire->cells[fire_at(fire, x, y, z)];
                if (!(cell->flame > 0)) continue;
                const float off = fire_leans(fire, fire->apart[fire_at(fire, x, y, z)]);
                const float fed = maxf(fire_feed(fire, p, sway[2], cell->flame) - off, 0);
                cell->rise *= fed / cell->flame;
                cell->flame = fed;
            }
}

// ---- the bricks

static size_t brick_at(const Fire *fire, int x, int y, int z) {
    return (size_t)x + (size_t)fire->bricks[0] * ((size_t)y + (size_t)fire->bricks[1] * (size_t)z);
}

/// Marks the bricks that come nearer than `reach` cells to the box of a cell around a position, in cells.
static void mark_bricks(Fire *fire, const float position[3], float reach, uint8_t what) {
    int low[3], high[3];
    for (int c = 0; c < 3; c++) {
        low[c] = (int)(maxf(position[c] - 0.5f - reach, 0) / FIRE_BRICK);
        int last = (int)((position[c] + 0.5f + reach) / FIRE_BRICK);
        high[c] = last < fire->bricks[c] ? last : fire->bricks[c] - 1;
    }

    for (int k = low[2]; k <= high[2]; k++)
        for (int j = low[1]; j <= high[1]; j++)
            for (int i = low[0]; i <= high[0]; i++) fire->seen[brick_at(fire, i, j, k)] |= what;
}

/// Marks the bricks that flame and smoke may reach, and the cells that the small eddies may.
static void mark_all(Fire *fire) {
    memset(fire->seen, 0, fire->brick_capacity);
    memset(fire->burns, 0, fire->cell_capacity);
    float wide = fire->scale * (FIRE_WARP_WIDE + FIRE_WARP_FINE) / fire->cell;
    int fine = 1 + (int)minf(fire->scale * FIRE_WARP_FINE / fire->cell, 1000);

    for (int z = 1; z < fire->size[2] - 1; z++)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) {
                const int position[3] = {x, y, z};
                float seen[3] = {(float)x, (float)y, (float)z};
                if (fire->cells[fire_at(fire, x, y, z)].smoke > SMOKE_THIN)
                    mark_bricks(fire, seen, 1 + 1.5f * fire->scale * SMOKE_WARP / fire->cell, FIRE_SMOKE);

                // the max of the spline in the cell's box: the largest of its Bezier points, which are the means of
                // the cells that meet in its faces, edges and corners
                float max = 0;
                for (int k = 0; k < 27; k++) {
                    int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
                    float sum = 0;
                    for (int m = 0; m < 8; m++)
                        sum +=
                            fire->cells[fire_at(fire, x + (m & 1 ? dx : 0), y + (m & 2 ? dy : 0), z + (m & 4 ? dz : 0))]
                                .flame;
                    max = maxf(max, 0.125f * sum);
                }

                if (!(max > FLAME_SEEN)) continue;

                // it is seen where eddies bring it: at q, with q + sway(q) here
                for (int again = 0; again < 3; again++) {
                    const float *sway = fire->sway[fire_at(fire, (int)(seen[0] + 0.5f), (int)(seen[1] + 0.5f), z)];
                    for (int c = 0; c < 2; c++)
                        seen[c] = clampf((float)position[c] - sway[c] / fire->cell, 0, (float)(fire->size[c] - 1));
                }
                mark_bricks(fire, seen, wide + 0.5f, FIRE_FLAME);
                int low[3], high[3];
                for (int c = 0; c < 3; c++) {
                    low[c] = position[c] > fine ? position[c] - fine : 0;
                    high[c] = position[c] + fine < fire->size[c] ? position[c] + fine : fire->size[c] - 1;
                }

                for (int k = low[2]; k <= high[2]; k++)
                    for (int j = low[1]; j <= high[1]; j++)
                        memset(&fire->burns[fire_at(fire, low[0], j, k)], 1, (size_t)(high[0] - low[0] + 1));
            }
}

void fire_raise(Preview *preview) {
    Fire *fire = &preview->fire;
    fire->moment = (float)fmod(preview->time, 1e3);
    fire->visible = false;
    if (!fire->size[0]) return;

    fire_find_feet(preview);
    find_roots(preview);
    root_cells(fire);
    raise_cells(preview);

    // above their max height flames are too thin to be seen
    for (size_t i = 0; i < fire->cell_capacity; i++) {
        FireCell *cell = &fire->cells[i];
        if (cell->flame <= 0) continue;
        float left = 1 - stepf(0.6f * FLAME_END, FLAME_END, cell->rise / cell->flame / fire->scale);
        cell->flame *= left;
        cell->rise *= left;
    }

    mix_cells(fire);
    sway_cells(fire);
    for (size_t i = 0; i < fire->cell_capacity; i++) fire->flames[i] = fire->cells[i].flame;
    memset(fire->flames + fire->cell_capacity, 0, FIRE_BEYOND * sizeof *fire->flames);
    mark_all(fire);

    // bounds of the bricks that are not empty
    Float3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    float side = FIRE_BRICK * fire->cell;
    for (int z = 0; z < fire->bricks[2]; z++)
        for (int y = 0; y < fire->bricks[1]; y++)
            for (int x = 0; x < fire->bricks[0]; x++) {
                if (!fire->seen[brick_at(fire, x, y, z)]) continue;
                Float3 near = float3_mad(fire->origin, float3((float)x, (float)y, (float)z), side);
                Float3 far = float3(near.x + side, near.y + side, near.z + side);
                low = float3(minf(low.x, near.x), minf(low.y, near.y), minf(low.z, near.z));
                high = float3(maxf(high.x, far.x), maxf(high.y, far.y), maxf(high.z, far.z));
            }
    fire->visible = low.x < high.x;
    fire->low = fire->visible ? low : fire->origin; // finite, as heights are measured from it
    fire->high = fire->visible ? high : fire->origin;
}

// ---- the whole

static size_t flames_size(size_t cells) { return (cells + FIRE_BEYOND) * sizeof(float); }

/// A block that could not be allocated is NULL and has no size.
static void free_cells(const Preview *preview, const Fire *fire) {
    const SingeAllocator *allocator = &preview->allocator;
    allocator_resize(*allocator, fire->cells, fire->cells ? fire->cell_capacity * sizeof *fire->cells : 0, 0);
    allocator_resize(*allocator, fire->flames, fire->flames ? flames_size(fire->cell_capacity) : 0, 0);
    allocator_resize(*allocator, fire->seen, fire->seen ? fire->brick_capacity : 0, 0);
    allocator_resize(*allocator, fire->burns, fire->burns ? fire->cell_capacity : 0, 0);
    allocator_resize(*allocator, fire->source, fire->source ? fire->cell_capacity * sizeof *fire->source : 0, 0);
    allocator_resize(*allocator, fire->sway, fire->sway ? fire->cell_capacity * sizeof *fire->sway : 0, 0);
    allocator_resize(*allocator, fire->apart, fire->apart ? fire->cell_capacity * sizeof *fire->apart : 0, 0);
    allocator_resize(*allocator, fire->roots, fire->roots ? fire->cell_capacity * sizeof *fire->roots : 0, 0);
}

static bool make_room(const Preview *preview, Fire *fire) {
    size_t cells = 1, bricks = 1;
    for (int c = 0; c < 3; c++) {
        fire->bricks[c] = (fire->size[c] + FIRE_BRICK - 1) / FIRE_BRICK;
        cells *= (size_t)fire->size[c];
        bricks *= (size_t)fire->bricks[c];
    }

    if (cells != fire->cell_capacity || bricks != fire->brick_capacity) {
        Fire old = *fire;
        fire->cells = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->cells);
        fire->flames = allocator_resize(preview->allocator, NULL, 0, flames_size(cells));
        fire->seen = allocator_resize(preview->allocator, NULL, 0, bricks);
        fire->burns = allocator_resize(preview->allocator, NULL, 0, cells);
        fire->source = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->source);
        fire->sway = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->sway);
        fire->roots = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->roots);
        fire->apart = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->apart);
        fire->cell_capacity = cells;
        fire->brick_capacity = bricks;
        free_cells(preview, &old);
    }

    return fire->cells && fire->flames && fire->seen && fire->burns && fire->source && fire->sway && fire->roots &&
           fire->apart;
}

static SingeResult check_gas(const SingeGas *gas, SingeError *error) {
    const uint32_t *n = gas->size;
    bool good = n[0] <= 4096 && n[1] <= 4096 && n[2] <= 4096 && n[1] && n[2] &&
                (uint64_t)n[0] * n[1] * n[2] <= GAS_CELL_LIMIT && gas->cell > 1e-6f && gas->cell < 1e3f;

    for (int c = 0; c < 3; c++) good = good && fabsf(gas->origin[c]) < 1e4f;
    good = good && gas->flame && gas->smoke && gas->velocity;

    float sum = 0; // of zeros, unless something is not finite
    for (size_t i = 0; good && i < (size_t)n[0] * n[1] * n[2]; i++)
        sum += 0 * gas->smoke[i] + 0 * gas->flame[i] + 0 * gas->velocity[i][0] + 0 * gas->velocity[i][1] +
               0 * gas->velocity[i][2] + (gas->temperature ? 0 * gas->temperature[i] : 0);
    if (good && sum == 0) return SINGE_OK;
    return preview_fail(error, SINGE_ERROR_ARGUMENT, -1,
                        "gas: size, cell, origin or a value is out of range, or an array is missing");
}

/// Number c at a corner of the noise, of hills `size` wide, from -1 to 1. The larger ones are flatter.
static float noise_hills(const uint32_t at[3], uint32_t c, uint32_t size) {
    const uint32_t sides[3] = {size, size, size > 1 ? size / 2 : 1};
    float sum = 0;
    for (uint32_t m = 0; m < 8; m++) {
        uint32_t corner[3];
        float weight = 1;
        for (uint32_t k = 0; k < 3; k++) {
            const float f = (float)(at[k] % sides[k]) / (float)sides[k];
            corner[k] = (at[k] / sides[k] + (m >> k & 1)) * sides[k] % FIRE_NOISE;
            weight *= m >> k & 1 ? f : 1 - f;
        }
        const uint32_t key = corner[0] + FIRE_NOISE * (corner[1] + FIRE_NOISE * corner[2]);
        sum += weight * (2 * hash_unit(4 * key + c + 1 + (size - 1) * 65536) - 1);
    }

    return sum;
}

/// Initialises data that does not change with the gas.
static bool make_tables(Preview *preview) {
    Fire *fire = &preview->fire;
    if (fire->noise && fire->tiles) return true;
    const uint32_t side = FIRE_CORNERS, period = FIRE_NOISE, count = side * side * side;
    if (!fire->noise) fire->noise = allocator_resize(preview->allocator, NULL, 0, count * sizeof *fire->noise);
    if (!fire->noise) return false;

    fire->tiles = allocator_resize(preview->allocator, NULL, 0, (size_t)preview->def.thread_count * sizeof(FireTile));
    if (!fire->tiles) return false;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t at[3] = {i % side % period, i / side % side % period, i / (side * side) % period};
        for (uint32_t c = 0; c < 4; c++) fire->noise[i][c] = noise_hills(at, c, 1);

        // the third has hills of three sizes: its creases are close together here and far apart there, where those of one
        // size would be the teeth of a comb
        const float wide = noise_hills(at, 2, 2) + NOISE_LARGER * noise_hills(at, 2, 4);
        fire->noise[i][2] = clampf(NOISE_SIZES * (fire->noise[i][2] + NOISE_LARGER * wide), -1, 1);
    }
    fire_fill_colours(preview);
    fire->look = fire_look(SINGE_INSTRUCTIONS_BEST);

    return true;
}

/// Smoke is seen where the air carries it up from a flame, layer by layer. Elsewhere it is what earlier flames have left, and
/// hung in the air as a ghost. Where the last flame goes out all smoke is its.
static void follow_smoke(Fire *fire) {
    const int row = fire->size[0];
    const float keeps = expf(-fire->cell / SMOKE_FOLLOWS);
    float most = 0;
    for (size_t i = 0; i < fire->cell_capacity; i++) most = maxf(most, fire->source[i][2]);
    const float adrift = mixf(1, SMOKE_ADRIFT, stepf(0, 2 * SMOKE_FLAME, most));
    memset(fire->sway, 0, fire->cell_capacity * sizeof *fire->sway); // free until the cells sway
    for (int z = 1; z < fire->size[2] - 1; z++)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) {
                const size_t here = fire_at(fire, x, y, z);
                const float *source = fire->source[here];
                float fx, fy;
                const int ix = noise_floor((float)x - source[0], &fx), iy = noise_floor((float)y - source[1], &fy);
                const float(*a)[4] = (const float(*)[4]) & fire->sway[fire_at(fire, ix, iy, z - 1)], (*b)[4] = a + row;
                const float(*c)[4] = (const float(*)[4]) & fire->sway[fire_at(fire, x, y, z - 1)];
                const float below = mixf(mixf(a[0][0], a[1][0], fx), mixf(b[0][0], b[1][0], fx), fy);
                const float beside = SMOKE_BESIDE * maxf(maxf(c[-1][0], c[1][0]), maxf(c[-row][0], c[row][0]));
                const float from = maxf(stepf(0, SMOKE_FLAME, source[2]), keeps * maxf(below, beside));
                fire->sway[here][0] = from;
                fire->cells[here].smoke *= mixf(adrift, 1, from);
            }
}

SingeResult preview_set_gas(Preview *preview, const SingeGas *gas, SingeError *error) {
    Fire *fire = &preview->fire;
    memset(fire->size, 0, sizeof fire->size);
    if (!gas || !gas->size[0]) return SINGE_OK;

    SingeResult result = check_gas(gas, error);
    if (result) return result;
    for (int c = 0; c < 3; c++) fire->size[c] = (int)gas->size[c] + 2 * FIRE_BORDER;

    if (!make_tables(preview) || !make_room(preview, fire)) {
        fire_free(preview);
        return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a gas of %u x %u x %u cells",
                            gas->size[0], gas->size[1], gas->size[2]);
    }

    float shift = (0.5f - FIRE_BORDER) * gas->cell;
    fire->cell = gas->cell;
    const float fine = maxf(gas->cell / FIRE_FINE_CELL, 0.4f);
    fire->scale = fine < 1 ? fine : clampf(gas->cell / FIRE_SCALE_CELL, 1, 3);
    fire->origin = float3_add(float3_load(gas->origin), float3(shift, shift, shift));
    const float range = logf(FLAME_HIGH / FLAME_LOW);
    fire->fading = gas->cell / (range * sqrtf(gas->cell / (2 * 9.81f)));
    memset(fire->cells, 0, fire->cell_capacity * sizeof *fire->cells);
    memset(fire->source, 0, fire->cell_capacity * sizeof *fire->source);
    for (size_t i = 0; i < fire->cell_capacity; i++) fire->source[i][3] = 1;
    const float thin = maxf(gas->cell / FLAME_THICK, 1);
    size_t from = 0;

    for (uint32_t z = 0; z < gas->size[2]; z++) {
        const float below = (float)(gas->size[2] - z) / (float)gas->size[2], left = stepf(0, SMOKE_LEAVES, below);
        for (uint32_t y = 0; y < gas->size[1]; y++)
            for (uint32_t x = 0; x < gas->size[0]; x++, from++) {
                size_t to = fire_at(fire, (int)x + FIRE_BORDER, (int)y + FIRE_BORDER, (int)z + FIRE_BORDER);
                const float flame = thin * gas->flame[from], smoke = gas->smoke[from];
                const float up = maxf(gas->velocity[from][2], 0.1f);
                fire->source[to][2] = flame > FLAME_LOW ? minf(logf(flame / FLAME_LOW) / range, 1) : 0;
                fire->source[to][3] = up;
                const float cold = gas->temperature ? 1 - stepf(SMOKE_COLD, SMOKE_HOT, gas->temperature[from]) : 1;
                fire->cells[to].smoke = smoke > 0 ? left * cold * GAS_EXTINCTION * smoke : 0;
                for (int c = 0; c < 2; c++) fire->source[to][c] = clampf(gas->velocity[from][c] / up, -1, 1);
            }
    }

    follow_smoke(fire);
    return SINGE_OK;
}

void fire_light_smoke(Preview *preview) {
    Fire *fire = &preview->fire;
    const EmberLights *lights = &preview->scene.lights;
    if (!fire->visible) return;

    // the sun lights one side, more the more it comes from behind, the sky all
    const float behind = maxf(float3_dot(preview->sun, preview->camera.forward), 0);
    Float3 sky = float3_add(sky_ambient(&preview->sky, float3(0, 0, 1)), sky_ambient(&preview->sky, float3(0, 0, -1)));
    fire->daylight = float3_mad(float3_scale(sky, 0.5f), preview->sun_light, 0.28f + 0.3f * behind * behind);

    // spread the drawn flames (flame_lamps.c) downwards and sideways, layer by layer, to know where flames are above
    const float tips = expf(-fire->cell / SMOKE_TIPS);
    float most = 0;
    for (size_t i = 0; i < fire->cell_capacity; i++) most = maxf(most, fire->cells[i].glow);
    for (int z = fire->size[2] - 1; z >= 0; z--)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++) {
                FireCell *cell = &fire->cells[fire_at(fire, x, y, z)];
                const bool inside = x && y && x < fire->size[0] - 1 && y < fire->size[1] - 1 && z < fire->size[2] - 1;
                const FireCell *up = &fire->cells[fire_at(fire, x, y, inside ? z + 1 : z)];
                const int row = fire->size[0];
                float above = 0;
                if (inside)
                    above = maxf(up[0].glow, maxf(maxf(up[-1].glow, up[1].glow), maxf(up[-row].glow, up[row].glow)));
                cell->glow = cell->glow > SMOKE_TIP * most ? 1 : tips * above;
            }
    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++) {
                FireCell *cell = &fire->cells[fire_at(fire, x, y, z)];
                const float over = cell->glow;
                cell->glow = 0;
                if (cell->smoke <= 0.4f * SMOKE_THIN) continue; // it may be seen in the cells beside it
                Float3 p = float3_mad(fire->origin, float3((float)x, (float)y, (float)z), fire->cell);
                for (int k = 0; k < preview->scene.light_count; k++) {
                    Float3 to = float3_sub(float3(lights->x[k], lights->y[k], lights->z[k]), p);

                    // scattered equally in all directions: a quarter of the reflection of white paper
                    cell->glow += 0.25f * lights->strength[0][k] / (float3_dot(to, to) + lights->softness[k] + 4e-4f);
                }
                cell->glow *= 1 - SMOKE_BELOW * stepf(0.25f, 0.8f, over);
            }
}

void fire_free(Preview *preview) {
    Fire *fire = &preview->fire;
    free_cells(preview, fire);
    allocator_resize(preview->allocator, fire->noise,
                     fire->noise ? (size_t)FIRE_CORNERS * FIRE_CORNERS * FIRE_CORNERS * sizeof *fire->noise : 0, 0);
    allocator_resize(preview->allocator, fire->tiles,
                     fire->tiles ? (size_t)preview->def.thread_count * sizeof(FireTile) : 0, 0);
    *fire = (Fire){.cells = NULL};
}
