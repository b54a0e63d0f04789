#include "common/cube_grid.h"

#include "common/real.h"

bool cube_grid_create(Memory *memory, uint32_t count, CubeGrid *grid) {
    *grid = (CubeGrid){.count = count, .mask = 7};
    while (grid->mask < count) grid->mask = 2 * grid->mask + 1;
    return NEW(memory, grid->next, count) && NEW(memory, grid->first, (size_t)grid->mask + 1);
}

void cube_grid_free(Memory *memory, CubeGrid *grid) {
    FREE(memory, grid->next, grid->count);
    FREE(memory, grid->first, (size_t)grid->mask + 1);
}

void cube_grid_clear(CubeGrid *grid, float cube) {
    grid->cube = cube;
    for (uint32_t s = 0; s <= grid->mask; s++) grid->first[s] = CUBE_GRID_END;
}

static int cube_of(const CubeGrid *grid, float x) {
    return (int)floorf(float_min(float_max(x / grid->cube, -1e9f), 1e9f));
}

static uint32_t slot_of(const CubeGrid *grid, int x, int y, int z) {
    const uint32_t hash = ((uint32_t)x * 0x9e3779b1u) ^ ((uint32_t)y * 0x85ebca77u) ^ ((uint32_t)z * 0xc2b2ae3du);
    return (hash ^ hash >> 15) & grid->mask;
}

void cube_grid_add(CubeGrid *grid, uint32_t member, const float position[3]) {
    const int x = cube_of(grid, position[0]), y = cube_of(grid, position[1]), z = cube_of(grid, position[2]);
    const uint32_t slot = slot_of(grid, x, y, z);
    grid->next[member] = grid->first[slot];
    grid->first[slot] = member;
}

void cube_grid_around(const CubeGrid *grid, Float3 position, uint32_t first[27]) {
    const int x = cube_of(grid, position.x), y = cube_of(grid, position.y), z = cube_of(grid, position.z);
    for (int k = 0; k < 27; k++) first[k] = grid->first[slot_of(grid, x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1)];
}
