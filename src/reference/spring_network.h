// A network of springs in double precision and the paper's projection of it (section 7.1). The solvers `paper`,
// `paper-literal`, `all-at-once` and `mass-spring` run on one, and so does singe/research.h.
//
// Springs are in sets. Each set is projected as one system: a colour, or all springs at once.
#pragma once

#include "common/pool.h"
#include "singe/types.h"

struct ConjugateKernel;

/// Rows that are processed together. A slice of the matrix has this many rows, one in each lane.
enum { NETWORK_LANES = 8 };
#define NETWORK_NO_RUN UINT32_MAX

/// Springs that are projected together. `count` springs, padded with empty ones to whole slices.
typedef struct SpringGroup {
    uint32_t count, padded;
    uint32_t (*ends)[2];   ///< [padded]
    double *length;        ///< [padded] m, targets, > 0
    double *weight;        ///< [padded] W of eq 19; 0 removes the spring
    double *compliance;    ///< [padded] m/N
    double regularisation; ///< floor on the diagonal, relative to the mean of w_a and w_b
    // the springs of each particle: incident[first[i]] up to first[i + 1], as 2 spring + end
    uint32_t *first, *incident;
    // ELLPACK pattern of J M^-1 J^T off its diagonal, in slices: entry k of the rows of slice s is the 8 entries from
    // 8 (slice_first[s] + k) on. A slice is as wide as the longest of its 8 rows.
    size_t *slice_first; ///< [padded/8 + 1]
    uint32_t *column;    ///< [8 entries]
    uint32_t *run; ///< [entries] where the 8 entries are 8 columns in a row, the first of them; else NETWORK_NO_RUN
    uint8_t *link; ///< [8 entries] bit 0: end of the row's spring that is shared; bits 1-2: 0 plus, 1 minus, 2 empty
} SpringGroup;

/// Settings of a projection.
typedef struct ProjectionRules {
    bool literal;        ///< C = |d|^2/l - l as in eq 10, and neither floor nor compliance; else row-normalised
    bool early_exit;     ///< the iterations also end when the residual is below `tolerance` of the lengths
    double tolerance;    ///< of the residual, relative to the right-hand side
    uint32_t iterations; ///< max, of the conjugate gradients
    double inverse_h2;   ///< 1/s2, 1/h^2: compliance times it is on the diagonal
} ProjectionRules;

typedef struct Network {
    uint32_t particle_count, group_count;
    double (*position)[3]; ///< m
    double *inverse_mass;  ///< 1/kg; in the system
    uint8_t *held;         ///< 1: not moved, but in the system with its inverse mass
    SpringGroup *groups;
    ProjectionRules rules;
    const struct ConjugateKernel *kernel; ///< never NULL
    bool matrix;                          ///< patterns and scratch of the projection are there
    // scratch shared by the groups, as long as the largest needs
    double (*gradient)[3];                             ///< of C at end b; at end a it is the opposite
    double *value;                                     ///< of the matrix, scaled to a unit diagonal
    double *scale;                                     ///< 1/sqrt(diagonal), 0 for rows outside the system
    double *solution, *residual, *direction, *product; ///< of the conjugate gradients
    double *partial;
    uint32_t row_max;
    size_t entry_max;
} Network;

typedef struct NetworkSprings {
    uint32_t count;
    const uint32_t (*ends)[2];
} NetworkSprings;

/// The caller fills in positions, masses, lengths and weights. `matrix`: with the scratch of network_project. On
/// failure (out of memory) *network holds nothing.
SingeResult network_create(Memory *memory, uint32_t particle_count, uint32_t group_count, const NetworkSprings *springs,
                           bool matrix, Network *network);
void network_free(Memory *memory, Network *network);

/// Result of a projection.
typedef struct ProjectionReport {
    uint32_t iterations;
    bool broken;         ///< the system is not positive definite, or something is not finite: nothing was moved
    double residual;     ///< relative to the right-hand side; 0 where that is 0
    double flops, bytes; ///< counted from the source, see SingeTimers
} ProjectionReport;

/// Eq 16 to 19 for one group (fast_projection.c).
ProjectionReport network_project(Network *network, uint32_t group, Pool *pool);

/// Hooke's law: from x~ to x~ + h^2 w F (mass_spring.c). The network's positions are x~, `velocity` is v~; `stiffness`
/// is in N/m.
ProjectionReport mass_spring_project(Network *network, double stiffness, const float (*velocity)[4], double h,
                                     Pool *pool);

/// C of each spring of a group as its rules have it, and |d| (fast_projection.c).
double network_constraint(const Network *network, uint32_t group, uint32_t spring);

/// Rows of one group's system: gradients, scales and the right-hand side in `residual` (fast_projection.c).
/// Returns the square of the right-hand side's length.
double network_rows(Network *network, uint32_t group, Pool *pool);

/// Values of the matrix from the gradients and scales (ellpack.c).
void ellpack_assemble(Network *network, uint32_t group, Pool *pool);
/// The assembled matrix with its diagonal, not scaled, added to `dense` of [count][count] zeros (ellpack.c).
void ellpack_dense(const Network *network, uint32_t group, double *dense);
/// Counts and lists the pattern of a group (ellpack.c). False when out of memory.
bool ellpack_create(Memory *memory, SpringGroup *group);
void ellpack_free(Memory *memory, SpringGroup *group);
/// Number of entries, with those that pad short rows.
static inline size_t ellpack_entries(const SpringGroup *group) {
    return NETWORK_LANES * group->slice_first[group->padded / NETWORK_LANES];
}

/// The fastest sweeps that the processor supports among those requested. Results are the same.
const struct ConjugateKernel *conjugate_choose(SingeInstructions instructions);

/// Solves the scaled system for `solution`, from zero; `residual` holds the right-hand side and then the residual.
/// `square` is the right-hand side's square, and the iterations end below `enough` (conjugate_gradient.c).
ProjectionReport conjugate_gradient(Network *network, uint32_t group, Pool *pool, double square, double enough);
