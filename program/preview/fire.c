// Prepares the gas for drawing: flame and smoke, cell by cell, and the empty regions.
//
// Burning is q / (q + q0) of the heat released, q (W/m3). The height of a flame's gas above the paper is that above the
// paper that burns in its cell, and elsewhere found by following the velocity back, layer by layer from below: r(x) =
// (r(x - v dt) + dz) times the share that was burning there; it distinguishes the clear base, the bright centre and the
// torn tip. Smoke is its extinction, 8.7 m2/g times its density (Mulholland & Croarkin 2000, for the soot of flames).

#include "preview/internal.h"

#include <string.h>

#define BURNING 2e6f      ///< W/m3, q0
#define FLAME_SEEN 0.085f ///< a smaller value is outside the flame, whatever the noise
#define SMOKE_SEEN 0.08f  ///< 1/m

static size_t fire_at(const Fire *fire, int x, int y, int z) {
    return (size_t)x + (size_t)fire->size[0] * ((size_t)y + (size_t)fire->size[1] * (size_t)z);
}

// ---- the cells

static void fill_cell(const SingeGas *gas, size_t from, FireCell *cell, float source[3]) {
    float flame = gas->flame[from], smoke = gas->smoke[from], up = maxf(gas->velocity[from][2], 0.1f);
    source[2] = flame > 0 ? flame / (flame + BURNING) : 0;
    cell->smoke = smoke > 0 ? GAS_EXTINCTION * smoke : 0;
    for (int c = 0; c < 2; c++) source[c] = clampf(gas->velocity[from][c] / up, -1, 1);
}

static void fill_cells(Fire *fire, const SingeGas *gas) {
    memset(fire->cells, 0, fire->cell_capacity * sizeof *fire->cells);
    memset(fire->source, 0, fire->cell_capacity * sizeof *fire->source);
    size_t from = 0;
    for (uint32_t z = 0; z < gas->size[2]; z++)
        for (uint32_t y = 0; y < gas->size[1]; y++)
            for (uint32_t x = 0; x < gas->size[0]; x++, from++) {
                size_t to = fire_at(fire, (int)x + FIRE_BORDER, (int)y + FIRE_BORDER, (int)z + FIRE_BORDER);
                fill_cell(gas, from, &fire->cells[to], fire->source[to]);
            }
}

// ---- height above the paper

/// Where paper burns: the mean height in each cell, weighted by the rate.
static void find_roots(Preview *preview) {
    const PreviewScene *scene = &preview->scene;
    Fire *fire = &preview->fire;
    memset(fire->roots, 0, fire->cell_capacity * sizeof *fire->roots);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        float rate = scene->vertices[i].flaming, rest;
        if (rate < 0.02f) continue;
        Float3 g = float3_scale(float3_sub(float3_load(scene->positions[i]), fire->origin), 1 / fire->cell);
        int position[3] = {noise_floor(g.x + 0.5f, &rest), noise_floor(g.y + 0.5f, &rest),
                           noise_floor(g.z + 0.5f, &rest)};
        bool in = true;
        for (int c = 0; c < 3; c++) in = in && position[c] > 0 && position[c] < fire->size[c] - 1;
        if (!in) continue;
        float *root = fire->roots[fire_at(fire, position[0], position[1], position[2])];
        root[0] += rate, root[1] += rate * scene->positions[i][2];
    }
}

/// The layer below, where the gas came from: flame and rise at (x - vx/vz, y - vy/vz).
static FireCell upstream(const Fire *fire, int x, int y, int z) {
    const float *drift = fire->source[fire_at(fire, x, y, z)];
    float fx, fy;
    int ix = noise_floor((float)x - drift[0], &fx), iy = noise_floor((float)y - drift[1], &fy);
    const FireCell *a = &fire->cells[fire_at(fire, ix, iy, z - 1)], *b = a + fire->size[0];
    FireCell out = {.flame = mixf(mixf(a[0].flame, a[1].flame, fx), mixf(b[0].flame, b[1].flame, fx), fy)};
    out.rise = mixf(mixf(a[0].rise, a[1].rise, fx), mixf(b[0].rise, b[1].rise, fx), fy);
    return out;
}

static void raise_cell(Fire *fire, int x, int y, int z) {
    size_t here = fire_at(fire, x, y, z), above = fire_at(fire, x, y, z + 1);
    FireCell *cell = &fire->cells[here];
    cell->rise = 0;
    cell->flame = fire->source[here][2];
    if (cell->flame <= 0) return;
    // the paper in the cell, or just above it, where the flame has not arrived yet
    const float *root = fire->roots[fire->roots[here][0] > 0 ? here : above];
    if (root[0] > 0) {
        float height = fire->origin.z + (float)z * fire->cell - root[1] / root[0];
        cell->rise = cell->flame * maxf(height, -fire->cell);
        return;
    }
    FireCell below = upstream(fire, x, y, z);
    if (below.flame <= 0) return;
    float share = minf(2 * below.flame / cell->flame, 1);
    cell->rise = cell->flame * share * (below.rise / below.flame + fire->cell);
}

// ---- the bricks

static size_t brick_at(const Fire *fire, int x, int y, int z) {
    return (size_t)x + (size_t)fire->bricks[0] * ((size_t)y + (size_t)fire->bricks[1] * (size_t)z);
}

/// Marks the bricks that come nearer than `reach` cells to the box of cell (x, y, z).
static void mark_bricks(Fire *fire, int x, int y, int z, float reach, uint8_t what) {
    const int position[3] = {x, y, z};
    int low[3], high[3];
    for (int c = 0; c < 3; c++) {
        low[c] = (int)(maxf((float)position[c] - 0.5f - reach, 0) / FIRE_BRICK);
        int last = (int)(((float)position[c] + 0.5f + reach) / FIRE_BRICK);
        high[c] = last < fire->bricks[c] ? last : fire->bricks[c] - 1;
    }
    for (int k = low[2]; k <= high[2]; k++)
        for (int j = low[1]; j <= high[1]; j++)
            for (int i = low[0]; i <= high[0]; i++) fire->seen[brick_at(fire, i, j, k)] |= what;
}

/// Marks the cells around (x, y, z), itself included.
static void mark_cells(Fire *fire, int x, int y, int z) {
    int reach = 1 + (int)minf(FIRE_WARP_FINE / fire->cell, 1000), low[3], high[3];
    const int position[3] = {x, y, z};
    for (int c = 0; c < 3; c++) {
        low[c] = position[c] > reach ? position[c] - reach : 0;
        high[c] = position[c] + reach < fire->size[c] ? position[c] + reach : fire->size[c] - 1;
    }
    for (int k = low[2]; k <= high[2]; k++)
        for (int j = low[1]; j <= high[1]; j++)
            memset(&fire->burns[fire_at(fire, low[0], j, k)], 1, (size_t)(high[0] - low[0] + 1));
}

/// The max of the spline in a cell's box: the largest of its Bezier points, which are the means of the cells that meet
/// in its faces, edges and corners.
static float max_flame(const Fire *fire, int x, int y, int z) {
    float max = 0;
    for (int k = 0; k < 27; k++) {
        int d[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        float sum = 0;
        for (int m = 0; m < 8; m++)
            sum += fire->cells[fire_at(fire, x + (m & 1 ? d[0] : 0), y + (m & 2 ? d[1] : 0), z + (m & 4 ? d[2] : 0))]
                       .flame;
        max = maxf(max, 0.125f * sum);
    }
    return max;
}

static void mark_all(Fire *fire) {
    memset(fire->seen, 0, fire->brick_capacity);
    memset(fire->burns, 0, fire->cell_capacity);
    float reach = (FIRE_WARP_WIDE + FIRE_WARP_FINE) / fire->cell;
    for (int z = 1; z < fire->size[2] - 1; z++)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) {
                if (max_flame(fire, x, y, z) > FLAME_SEEN) {
                    mark_bricks(fire, x, y, z, reach, FIRE_FLAME);
                    mark_cells(fire, x, y, z);
                }
                if (fire->cells[fire_at(fire, x, y, z)].smoke > SMOKE_SEEN) mark_bricks(fire, x, y, z, 1, FIRE_SMOKE);
            }
}

/// Bounds of the bricks that are not empty. False if all are.
static bool find_bounds(Fire *fire) {
    Float3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    float side = FIRE_BRICK * fire->cell;
    for (int z = 0; z < fire->bricks[2]; z++)
        for (int y = 0; y < fire->bricks[1]; y++)
            for (int x = 0; x < fire->bricks[0]; x++) {
                if (!fire->seen[brick_at(fire, x, y, z)]) continue;
                Float3 corner = float3_mad(fire->origin, float3((float)x, (float)y, (float)z), side);
                low = float3(minf(low.x, corner.x), minf(low.y, corner.y), minf(low.z, corner.z));
                high =
                    float3(maxf(high.x, corner.x + side), maxf(high.y, corner.y + side), maxf(high.z, corner.z + side));
            }
    fire->low = low;
    fire->high = high;
    return low.x < high.x;
}

/// Flames have a max height: above it they are too thin to be seen.
static void end_flames(Fire *fire) {
    for (size_t i = 0; i < fire->cell_capacity; i++) {
        FireCell *cell = &fire->cells[i];
        if (cell->flame <= 0) continue;
        float left = 1 - stepf(0.6f * FLAME_END, FLAME_END, cell->rise / cell->flame);
        cell->flame *= left;
        cell->rise *= left;
    }
}

void fire_raise(Preview *preview) {
    Fire *fire = &preview->fire;
    fire->moment = (float)fmod(preview->time, 1e3);
    fire->visible = false;
    if (!fire->size[0]) return;
    find_roots(preview);
    for (int z = 1; z < fire->size[2] - 1; z++)
        for (int y = 1; y < fire->size[1] - 1; y++)
            for (int x = 1; x < fire->size[0] - 1; x++) raise_cell(fire, x, y, z);
    end_flames(fire);
    mark_all(fire);
    fire->visible = find_bounds(fire);
}

// ---- the whole

/// A block that could not be allocated is NULL and has no size.
static void free_cells(const Preview *preview, const Fire *fire) {
    const SingeAllocator *allocator = &preview->allocator;
    allocator_resize(*allocator, fire->cells, fire->cells ? fire->cell_capacity * sizeof *fire->cells : 0, 0);
    allocator_resize(*allocator, fire->seen, fire->seen ? fire->brick_capacity : 0, 0);
    allocator_resize(*allocator, fire->burns, fire->burns ? fire->cell_capacity : 0, 0);
    allocator_resize(*allocator, fire->source, fire->source ? fire->cell_capacity * sizeof *fire->source : 0, 0);
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
        fire->seen = allocator_resize(preview->allocator, NULL, 0, bricks);
        fire->burns = allocator_resize(preview->allocator, NULL, 0, cells);
        fire->source = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->source);
        fire->roots = allocator_resize(preview->allocator, NULL, 0, cells * sizeof *fire->roots);
        fire->cell_capacity = cells;
        fire->brick_capacity = bricks;
        free_cells(preview, &old);
    }
    return fire->cells && fire->seen && fire->burns && fire->source && fire->roots;
}

static bool is_finite(const SingeGas *gas) {
    size_t count = (size_t)gas->size[0] * gas->size[1] * gas->size[2];
    float sum = 0; // of zeros, unless something is not finite
    for (size_t i = 0; i < count; i++)
        sum += 0 * gas->smoke[i] + 0 * gas->flame[i] + 0 * gas->velocity[i][0] + 0 * gas->velocity[i][1] +
               0 * gas->velocity[i][2];
    return sum == 0;
}

static SingeResult check_gas(const SingeGas *gas, SingeError *error) {
    const uint32_t *n = gas->size;
    bool good = n[0] <= 4096 && n[1] <= 4096 && n[2] <= 4096 && n[1] && n[2] &&
                (uint64_t)n[0] * n[1] * n[2] <= GAS_CELL_LIMIT && gas->cell > 1e-6f && gas->cell < 1e3f;
    for (int c = 0; c < 3; c++) good = good && fabsf(gas->origin[c]) < 1e4f;
    if (good && gas->flame && gas->smoke && gas->velocity && is_finite(gas)) return SINGE_OK;
    return preview_fail(error, SINGE_ERROR_ARGUMENT, -1,
                        "gas: size, cell, origin or a value is out of range, or no array");
}

/// Initialises data that does not change with the gas.
static bool make_tables(Preview *preview) {
    Fire *fire = &preview->fire;
    if (fire->noise && fire->tiles) return true;
    size_t count = (size_t)FIRE_NOISE * FIRE_NOISE * FIRE_NOISE;
    if (!fire->noise) fire->noise = allocator_resize(preview->allocator, NULL, 0, count * sizeof *fire->noise);
    if (!fire->noise) return false;
    fire->tiles = allocator_resize(preview->allocator, NULL, 0, (size_t)preview->def.thread_count * sizeof(FireTile));
    if (!fire->tiles) return false;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < 4; c++) fire->noise[i][c] = 2 * hash_unit(4 * i + c + 1) - 1;
    fire_fill_colours(preview);
    return true;
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
    fire->origin = float3_add(float3_load(gas->origin), float3(shift, shift, shift));
    fill_cells(fire, gas);
    return SINGE_OK;
}

void fire_light_smoke(Preview *preview) {
    Fire *fire = &preview->fire;
    const EmberLights *lights = &preview->scene.lights;
    if (!fire->visible) return;
    // the sun lights one side, the sky all
    Float3 sky = float3_add(sky_ambient(&preview->sky, float3(0, 0, 1)), sky_ambient(&preview->sky, float3(0, 0, -1)));
    fire->daylight = float3_mad(float3_scale(sky, 0.5f), preview->sun_light, 0.28f);
    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++) {
                FireCell *cell = &fire->cells[fire_at(fire, x, y, z)];
                cell->glow = 0;
                if (cell->smoke <= SMOKE_SEEN) continue;
                Float3 p = float3_mad(fire->origin, float3((float)x, (float)y, (float)z), fire->cell);
                for (int k = 0; k < preview->scene.light_count; k++) {
                    Float3 to = float3_sub(float3(lights->x[k], lights->y[k], lights->z[k]), p);
                    // scattered equally in all directions: a quarter of the reflection of white paper
                    cell->glow += 0.25f * lights->strength[0][k] / (float3_dot(to, to) + lights->softness[k] + 4e-4f);
                }
            }
}

void fire_free(Preview *preview) {
    Fire *fire = &preview->fire;
    free_cells(preview, fire);
    allocator_resize(preview->allocator, fire->noise,
                     fire->noise ? (size_t)FIRE_NOISE * FIRE_NOISE * FIRE_NOISE * sizeof *fire->noise : 0, 0);
    allocator_resize(preview->allocator, fire->tiles,
                     fire->tiles ? (size_t)preview->def.thread_count * sizeof(FireTile) : 0, 0);
    *fire = (Fire){.cells = NULL};
}
