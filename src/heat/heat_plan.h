// Shared declarations of the stage: the plan, and the passes that heat_step calls in order.
#pragma once

#include <string.h>

#include "common/float3.h"
#include "heat/heat.h"
#include "world/smother.h"

/// Consecutive particles that rest together (rest.c). Divides POOL_BLOCK.
enum { HEAT_GROUP = 64 };
_Static_assert(POOL_BLOCK % HEAT_GROUP == 0, "a block of a sum is whole groups");

/// Max number of groups listed as near a group.
enum { HEAT_NEAR = 48 };

/// A spring that shares both its ends with another conducting spring.
typedef struct HeatTwin {
    uint32_t spring; ///< in the numbering of all colours
    float conductance;
} HeatTwin;

/// Interleaved rows of the matrix.
enum { HEAT_ROWS = 4 };
_Static_assert(HEAT_GROUP % HEAT_ROWS == 0, "a group is whole slices");

/// The heat equation's matrix in rows: an entry is a spring's conductance to particle `column`. `value` is 0 where the
/// spring no longer conducts; conductances do not contain the time step. HEAT_ROWS rows are interleaved, so that a
/// processor can work on all of them at once (sliced ELLPACK): entry k of row i is heat_entry(matrix, i, k). Shorter
/// rows are padded with entries of value 0 in their own column.
typedef struct HeatMatrix {
    uint32_t *first;  ///< [slices + 1]
    uint32_t *column; ///< [entries]
    float *value;     ///< [entries]
    float *inverse;   ///< [particles] 1/(D + theta dt times the sum of the row's values); 0 for particles that are gone
    float dt;         ///< s, of `inverse`: theta dt
    uint32_t slices, entries;
    HeatTwin *twins; ///< rarely any
    uint32_t twin_count, twin_capacity;
    bool full; ///< a row has no room for all springs from tears
} HeatMatrix;

/// The number of entries of each row in the slice of row i, and the index of entry k of row i.
static inline uint32_t heat_row_width(const HeatMatrix *matrix, uint32_t i) {
    return (matrix->first[i / HEAT_ROWS + 1] - matrix->first[i / HEAT_ROWS]) / HEAT_ROWS;
}
static inline uint32_t heat_entry(const HeatMatrix *matrix, uint32_t i, uint32_t k) {
    return matrix->first[i / HEAT_ROWS] + HEAT_ROWS * k + i % HEAT_ROWS;
}

/// Groups of HEAT_GROUP consecutive particles, and which of them conduct in this step (rest.c).
typedef struct HeatRest {
    uint32_t groups;
    uint32_t (*near)[HEAT_NEAR]; ///< [groups] the groups that conduct with it, without itself
    uint8_t *near_count;         ///< [groups] their number; HEAT_NEAR + 1: too many to list, near all others
    uint8_t *warm;               ///< [groups] a particle is not at the ambient temperature, or heated
    uint8_t *awake[2];           ///< [groups] conducts; alternating, each is the other and all groups near it
} HeatRest;

struct HeatPlan {
    HeatSettings settings;
    uint32_t particles, springs, sheets;
    int blocks;
    uint32_t spring_first[SINGE_COLOUR_COUNT + 1]; ///< springs of all colours in one numbering
    float *thickening;                             ///< [sheets] F

    // operator
    float *measure;        ///< [particles] D: m2 (surface) or m (umbrella)
    float stiffness;       ///< 1/s, the most of sum c_ij/D_i before anything is gone; infinite with an umbrella
    float *conductance;    ///< [springs] alpha F times the operator's weight: D/s. Freed once the matrix is built,
                           ///< unless sheets can tear or `live`
    bool live;             ///< a sheet's operator changes as it moves: all is made again at every step
    uint32_t split_count;  ///< of the shell that the matrix is for
    uint8_t *spring_alive; ///< [springs] alive in the matrix
    uint8_t *alive;        ///< [particles] alive in the matrix
    HeatMatrix matrix;
    HeatRest rest;
    Smother smother;

    void *scratch; ///< the arrays below
    size_t scratch_size;

    // sources, per particle
    float *flux, *source_conductance, *source_temperature; ///< W/m2, W/(m2 K), conductance times K
    bool puts_out;                                         ///< something moves air or smothers
    float *
        put_out; ///< share of its flame's heat that a particle lacks, or HEAT_SMOTHERED: of all; the memory of `product`

    // solver, per particle
    float *star;       ///< T* after sources and losses, K
    float *delta;      ///< T* - T, K
    float *correction; ///< T - T* of the diffusion, K
    float *residual, *search, *product;
    float *next;          ///< the new temperature, K
    double (*partial)[4]; ///< [blocks]
    double *weight;       ///< [sheets] of their residuals in the sum of all
};

#define HEAT_SMOTHERED 2.0f

/// Input of a step's passes.
typedef struct HeatPass {
    HeatPlan *plan;
    const Shell *shell;
    const StateInput *state;
    HeatState *heat;
    Pool *pool;
    float h;            ///< s of scene time
    float dt;           ///< s of fire
    float theta;        ///< share of the conduction that is implicit
    float step_length;  ///< of the conjugate gradients
    float direction;    ///< their beta
    int turn;           ///< which of rest.awake is current
    float min, max;     ///< K, the range of T*
    double slack;       ///< K, allowed outside of it before bound.c ends the step
    double share;       ///< fraction of the distance to the range's end, in bound.c
    SingeFluxFn *heard; ///< of the context
    void *hearer;
} HeatPass;

/// Updates operator and matrix for a shell that has torn since the last call, or whose operator follows its motion
/// (heat_plan.c).
void heat_plan_follow(HeatPlan *plan, const Shell *shell, const StateInput *state);

/// One cell's weights of the springs along its four sides and two diagonals by linear elements, without diffusivity and
/// F. Sides opposite to obtuse angles have negative ones. False, and zeros, if the cell cannot be cut into two
/// triangles (weights.c).
bool heat_cell_linear(const Float3 corners[4], double weights[6]);

/// The same with no negative diagonal, and no negative side once the linear weight `across` of the cell on its other
/// side (0 at a border) is added.
void heat_cell_weights(const Float3 corners[4], const double across[4], double weights[6]);

/// Fills plan->conductance and plan->measure (operator.c). `state` is that of the moment, for eq 3 as printed; NULL: at
/// rest.
void heat_operator(HeatPlan *plan, const Shell *shell, const StateInput *state);

/// plan->stiffness, of a matrix with all its springs (matrix.c).
float heat_matrix_stiffness(const HeatPlan *plan, const Shell *shell);

/// The same for one cell's sides and diagonals, and for a vertex, next to a new tear; not for the umbrella.
void heat_operator_torn_cell(HeatPlan *plan, const Shell *shell, uint32_t cell);
void heat_operator_torn_vertex(HeatPlan *plan, const Shell *shell, uint32_t vertex);

/// Whether a tear may change the cell's weights of springs that are not torn.
bool heat_operator_may_change(const Shell *shell, uint32_t cell);

/// Builds the matrix's pattern, all springs alive (matrix.c).
SingeResult heat_matrix_create(Memory *memory, HeatPlan *plan, const Shell *shell);

/// Rebuilds it for a shell that has torn; `length`, [particles], is scratch.
void heat_matrix_rebuild(HeatPlan *plan, const Shell *shell, uint32_t *length);

/// Rewrites a row whose springs were changed by tears; `list` is scratch for its springs. False if the row has no room
/// for all.
bool heat_matrix_row(HeatPlan *plan, const Shell *shell, uint32_t row, uint32_t *list);
void heat_matrix_free(Memory *memory, HeatPlan *plan);

/// Updates the matrix for what ablation removed since the last call, and for theta times the time step.
void heat_matrix_follow(HeatPlan *plan, const Shell *shell, const AblateState *ablate, float dt);

/// Lists which groups conduct with which (rest.c).
SingeResult heat_rest_create(Memory *memory, HeatPlan *plan);

/// Updates the lists of all groups, or of one; `seen`, [groups], is scratch.
void heat_rest_rebuild(HeatPlan *plan, uint32_t *seen);
void heat_rest_update(HeatPlan *plan, uint32_t group, uint32_t *seen);
void heat_rest_free(Memory *memory, HeatPlan *plan);

/// Whether the group or one near it is in `set`.
bool heat_rest_reaches(const HeatRest *rest, const uint8_t *set, uint32_t group);

/// Sums all sources into the plan's arrays (source.c).
void heat_gather(HeatPass *pass, const SourceList *sources, const ColliderList *colliders, const SingeView *view);

/// Value of an arrival map at a point of uv: 0 to 1, or SOURCE_NEVER where it is white (arrival.c).
float heat_sample_arrival(const SingeTexture *map, float u, float v);

/// Holds temperatures to the arrival maps that are lit, and returns the heat that this gave, J.
double heat_arrive(HeatPass *pass, const SourceList *sources);

/// Solves the diffusion and leaves new temperatures in plan->next (conduct.c). *made is the heat in J that
/// the umbrella made.
SingeResult heat_conduct(HeatPass *pass, HeatCounters *counters, double *made, SingeError *error);

/// Leaves new temperatures in the range of T* in plan->next, from plan->star as the solver left it, and returns the
/// heat that the umbrella made (bound.c).
double heat_bound(HeatPass *pass);

enum { HEAT_SEED = 0x68656174 };

/// Stochastic rounding of x to a float above or below, correct in the mean.
static inline float heat_round(double x, uint32_t hash) {
    float near = (float)x;
    if ((double)near == x || !(x > 1e-30 && x < 1e30)) return near;
    uint32_t bits;
    memcpy(&bits, &near, sizeof bits);
    bits = (bits & 0x7f800000u) - (23u << 23); // one unit of the last digit
    float unit;
    memcpy(&unit, &bits, sizeof unit);
    return (float)(x + (double)unit * (((double)(hash >> 8) + 0.5) / 16777216.0 - 0.5));
}

/// Calls run over [0, blocks) through the pool and adds up column c of plan->partial in order.
void heat_blocks(HeatPass *pass, SingeTaskFn *run);
double heat_sum(const HeatPlan *plan, int column);

/// The groups of a block are [heat_group_first, heat_group_end).
static inline uint32_t heat_group_first(int block) { return (uint32_t)block * (POOL_BLOCK / HEAT_GROUP); }
static inline uint32_t heat_group_end(const HeatPlan *plan, int block) {
    uint32_t end = heat_group_first(block + 1);
    return end < plan->rest.groups ? end : plan->rest.groups;
}

/// The particles of a group are [group * HEAT_GROUP, heat_group_last).
static inline uint32_t heat_group_last(const HeatPlan *plan, uint32_t group) {
    uint32_t last = (group + 1) * HEAT_GROUP;
    return last < plan->particles ? last : plan->particles;
}
