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

#include "common/float4.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

static const float AIR_REACH = 0.015f; // m, l
static const float AIR_ACROSS = 0.55f; // mean of the sum of the weights' squares
#define AIR_EMPTY UINT64_MAX

/// Bits of the 27 nodes about a position, and of the nine at -1 along x.
enum { AIR_ALL = (1u << 27) - 1, AIR_FIRST = 0x1249249 };

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

/// The nodes in the middle of those about four positions, and the weights of these along each axis.
static void air_weigh(const BurnAir *air, const float position[4][4], Float4Mask middle[3], Float4 weight[3][3]) {
    for (int d = 0; d < 3; d++) {
        const Float4 p = {position[0][d], position[1][d], position[2][d], position[3][d]};
        const Float4 x = float4_min(float4_max(p / float4_all(air->reach), float4_all(-1e6f)), float4_all(1e6f));
        const Float4 up = x + float4_all(0.5f);
        const Float4Mask toward = __builtin_convertvector(up, Float4Mask);
        middle[d] = toward + (__builtin_convertvector(toward, Float4) > up); // -1 where it was rounded up

        const Float4 f = x - __builtin_convertvector(middle[d], Float4);
        const Float4 less = float4_all(0.5f) - f, more = float4_all(0.5f) + f;
        weight[d][0] = float4_all(0.5f) * less * less;
        weight[d][1] = float4_all(0.75f) - f * f;
        weight[d][2] = float4_all(0.5f) * more * more;
    }
}

/// Whether lane k has its middle elsewhere than `near`.
static bool air_is_elsewhere(const BurnAirNear *near, const Float4Mask middle[3], int k) {
    return !near->known || middle[0][k] != near->middle[0] || middle[1][k] != near->middle[1] ||
           middle[2][k] != near->middle[2];
}

/// Puts nodes of `near` back: bits of them.
static void air_put(BurnAir *air, const BurnAirNear *near, uint32_t nodes) {
    for (; nodes; nodes &= nodes - 1) {
        const unsigned n = (unsigned)__builtin_ctz(nodes);
        if (near->slot[n] < air->count) air->demand[near->slot[n]] = near->demand[n / 3][n % 3];
    }
}

void burn_air_flush(BurnAir *air, const BurnAirNear *near) { air_put(air, near, near->known ? AIR_ALL : 0); }

/// Takes the nodes about the middle of lane k into `near`, with new ones where `adds`, and puts back those that it had.
/// What the table has no place for is not there: there is as much air as in a front.
static void air_go(BurnAir *air, BurnAirNear *near, const Float4Mask middle[3], int k, bool adds) {
    const int by = middle[0][k] - near->middle[0];
    const bool follows =
        near->known && (by == 1 || by == -1) && middle[1][k] == near->middle[1] && middle[2][k] == near->middle[2];
    for (int d = 0; d < 3; d++) near->middle[d] = middle[d][k];

    // usually one node farther along x than before, so that only nine are new: those at -1 along x, or at 1
    uint32_t fresh = follows ? AIR_FIRST << (by < 0 ? 0 : 2) : AIR_ALL;
    if (adds && near->known) air_put(air, near, follows ? AIR_FIRST << (by < 0 ? 2 : 0) : AIR_ALL);
    if (follows) {
        memmove(near->slot + (by < 0), near->slot + (by > 0), 26 * sizeof *near->slot);
        for (int row = 0; row < 9; row++) {
            const Float4 q = near->demand[row];
            near->demand[row] = by < 0 ? FLOAT4_SHUFFLE(q, q, 3, 0, 1, 3) : FLOAT4_SHUFFLE(q, q, 1, 2, 3, 3);
        }
    }

    near->known = true;
    uint64_t first = 0; // the node at -1 along all axes: 21 bits of each, as positions end at a million nodes
    for (int d = 2; d >= 0; d--) first = (first << 21) + (uint64_t)(near->middle[d] - 1 + (1 << 20));
    for (; fresh; fresh &= fresh - 1) {
        const unsigned n = (unsigned)__builtin_ctz(fresh), row = n / 3, x = n % 3;
        const uint64_t node = first + x + ((uint64_t)(row % 3) << 21) + ((uint64_t)(row / 3) << 42);
        const uint32_t slot = air_slot(air, node);
        if (adds && slot < air->count) air->node[slot] = node;
        const bool found = slot < air->count && air->node[slot] == node;
        near->slot[n] = found ? slot : air->count;
        near->demand[row][x] = found ? air->demand[slot] : 0;
    }
}

void burn_air_add(BurnAir *air, BurnAirNear *near, const float position[4][4], const float demand[4]) {
    Float4 weight[3][3];
    Float4Mask middle[3];
    air_weigh(air, position, middle, weight);

    for (int k = 0; k < 4; k++) {
        if (!(demand[k] > 0)) continue;

        if (air_is_elsewhere(near, middle, k)) air_go(air, near, middle, k, true);

        const Float4 along = {weight[0][0][k], weight[0][1][k], weight[0][2][k], 0};
        for (int row = 0; row < 9; row++) {
            const float across = weight[1][row % 3][k] * weight[2][row / 3][k];
            near->demand[row] += along * float4_all(across) * float4_all(demand[k]);
        }
    }
}

Float4 burn_air_share(BurnAir *air, BurnAirNear *near, const float position[4][4]) {
    const Float4 supply = float4_all(air_supply(air));
    Float4 weight[3][3], share = float4_all(1);
    Float4Mask middle[3];
    air_weigh(air, position, middle, weight);

    for (unsigned left = 15; left;) { // mostly all four lanes at once
        const int k = __builtin_ctz(left);
        if (air_is_elsewhere(near, middle, k)) air_go(air, near, middle, k, false);
        const Float4Mask same =
            (middle[0] == near->middle[0]) & (middle[1] == near->middle[1]) & (middle[2] == near->middle[2]);
        Float4 demand = float4_all(0);
        for (int row = 0; row < 9; row++) {
            const Float4 across = weight[1][row % 3] * weight[2][row / 3];
            for (int x = 0; x < 3; x++) demand += weight[0][x] * across * float4_all(near->demand[row][x]);
        }
        share = float4_select(same & (demand > supply), supply / demand, share);
        left &= ~float4_bits(same);
    }

    return share;
}
