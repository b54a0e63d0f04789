// Air for what burns. Rates of eq 4 are those of a front, a few millimetres wide, whose air comes from some
// centimetres about it. Where all of a large area burns, air comes from above it alone, and either face burns no faster
// than `air_supply` a. So the pyrolysis of a particle is that of eq 4 times
//
//   y = min(1, 2 / d),   d = sum over what burns of K(x - x_i) q_i / a_i
//
//   q   kg/s    what would burn by eq 4, of a particle
//   a   kg/(m2 s), of either face: Spalding's (h/c_p) ln(1 + B), 12 g/(m2 s) for cellulose (docs/equations/burning.md)
//   K   1/m2    kernel of a length l = 1.5 cm, or a cell's side where that is longer, with an integral of 1 over a plane
//
// l is the thickness of the layer of hot gas that rises beside a flame: 1.4 cm beside 5 cm of it, 5 x/Gr^(1/4). A
// straight front burns b = 0.11 to 0.18 g/(m s) at either face (Thomas & Law 1965, less the char), and has d/2 = .55
// b/(l a), .34 to .55: nothing limits it.
//
// K is by a grid of nodes l apart: a particle gives to the 27 about it by quadratic B-splines, and takes by the same. In
// a plane that is a bell with a deviation of l/2^(1/2); across it, its sum of squares is divided out in the mean: .55.
#include "burn/supply.h"

#include "common/real.h"

#include <math.h>
#include <string.h>

static const float AIR_REACH = 0.015f; // m, l
static const float AIR_ACROSS = 0.55f; // mean of the sum of the weights' squares
#define AIR_EMPTY UINT64_MAX

SingeResult burn_air_create(Memory *memory, const Shell *shell, BurnAir *air) {
    double area = 0;
    for (uint32_t i = 0; i < shell->particle_count; i++) area += (double)shell->matter.area[i];
    air->reach = AIR_REACH;
    for (uint32_t s = 0; s < shell->sheet_count; s++) air->reach = float_max(air->reach, shell->sheets[s].cell_size);

    // a flat sheet that burns all over has 1.5 nodes on l^2 of its layers
    const double crossed = area / ((double)air->reach * (double)air->reach);
    air->count = (uint32_t)(256 + fmin(fmin(4 * crossed, 27.0 * shell->particle_count), 1e9));
    return NEW(memory, air->node, air->count) && NEW(memory, air->demand, air->count) ? SINGE_OK : SINGE_ERROR_MEMORY;
}

void burn_air_free(Memory *memory, BurnAir *air) {
    FREE(memory, air->node, air->count);
    FREE(memory, air->demand, air->count);
}

void burn_air_clear(BurnAir *air) {
    memset(air->node, 0xff, air->count * sizeof *air->node);
    memset(air->demand, 0, air->count * sizeof *air->demand);
}

/// What a position may take of the nodes about it.
static float air_supply(const BurnAir *air) { return 2 * AIR_ACROSS * air->reach * air->reach; }

bool burn_air_is_short(const BurnAir *air) {
    const float supply = air_supply(air);
    int is_short = 0;
    for (uint32_t s = 0; s < air->count; s++) is_short |= air->demand[s] > supply;
    return is_short;
}

/// The slot of a node, or the empty one where it belongs; count where there is none.
static uint32_t air_slot(const BurnAir *air, uint64_t node) {
    const uint64_t hash = node * 0x9e3779b97f4a7c15u >> 32;
    uint32_t slot = (uint32_t)(hash * air->count >> 32);
    for (int k = 0; k < 64; k++) {
        if (air->node[slot] == node || air->node[slot] == AIR_EMPTY) return slot;
        slot = slot + 1 < air->count ? slot + 1 : 0;
    }
    return air->count;
}

/// Node k of the 27 about the node in the middle of them.
static uint64_t air_node(const int middle[3], int k) {
    uint64_t node = 0;
    const int offset[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    for (int d = 0; d < 3; d++) node |= (uint64_t)((uint32_t)(middle[d] + offset[d] + (1 << 20)) & 0x1fffff) << 21 * d;
    return node;
}

/// The weights of the 27 nodes about a position; true where these are not those of `near`, whose middle it sets.
static bool air_weigh(const BurnAir *air, const float position[3], BurnAirNear *near, float weight[27]) {
    float w[3][3];
    bool moved = !near->known;
    for (int d = 0; d < 3; d++) {
        const float x = float_min(float_max(position[d] / air->reach, -1e6f), 1e6f), middle = floorf(x + 0.5f);
        const float f = x - middle, less = 0.5f - f, more = 0.5f + f;
        w[d][0] = 0.5f * less * less;
        w[d][1] = 0.75f - f * f;
        w[d][2] = 0.5f * more * more;
        moved |= near->middle[d] != (int)middle;
        near->middle[d] = (int)middle;
    }

    for (int k = 0; k < 9; k++) {
        const float across = w[1][k % 3] * w[2][k / 3];
        for (int x = 0; x < 3; x++) weight[3 * k + x] = w[0][x] * across;
    }
    near->known = true;
    return moved;
}

void burn_air_add(BurnAir *air, BurnAirNear *near, const float position[3], float demand) {
    float weight[27];
    if (air_weigh(air, position, near, weight))
        for (int k = 0; k < 27; k++) {
            const uint64_t node = air_node(near->middle, k);
            const uint32_t slot = near->slot[k] = air_slot(air, node);
            if (slot < air->count) air->node[slot] = node;
        }

    for (int k = 0; k < 27; k++) // where the table is full, there is as much air as in a front
        if (near->slot[k] < air->count) air->demand[near->slot[k]] += weight[k] * demand;
}

float burn_air_share(const BurnAir *air, BurnAirNear *near, const float position[3]) {
    float weight[27], demand = 0;
    if (air_weigh(air, position, near, weight))
        for (int k = 0; k < 27; k++) {
            const uint64_t node = air_node(near->middle, k);
            const uint32_t slot = air_slot(air, node);
            near->slot[k] = slot < air->count && air->node[slot] == node ? slot : air->count;
        }

    for (int k = 0; k < 27; k++)
        if (near->slot[k] < air->count) demand += weight[k] * air->demand[near->slot[k]];
    const float supply = air_supply(air);
    return demand > supply ? supply / demand : 1;
}
