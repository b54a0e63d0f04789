// Strands laid out in lanes. A group is up to STRAND_LANES parallel lanes; a lane holds one strand, or several
// consecutive strands separated by a row without a spring. Row k of lane j of a group is the slot
// (row + k) STRAND_LANES + j, of a node and of the spring from it to the node of the next row; a group ends with
// a row of only nodes. A slot without a spring has weight 0. A slot without a particle has one of the nodes after the
// last particle, which have no mass.
//
// Column c of a group is lane c / (width / 4) + 4 (c % (width / 4)): transposing four by four, as kernels do, then
// takes the particles of width / 4 contiguous columns at once. Strands are laid out so that contiguous columns hold
// particles of consecutive numbers where possible (strand_lay.c).
#pragma once

#include "common/pool.h"
#include "shell/shell.h"

#include <stdatomic.h>

enum { STRAND_LANES = 16, STRAND_KEEP = 3, PREPARE_RUN = 16 };
/// In StrandSet.seen: weight, length or limit of the spring change in this step. No spring has these flags.
enum { PREPARE_STALE = 0x80 };
_Static_assert(STRAND_LANES % 16 == 0, "the widest kernel has 16 lanes");

/// y of the constraint in strand_kernel.h.
#define STRAND_YIELD 0.5f

/// In StrandSet.contiguous: the particles of the row are anywhere.
#define STRAND_GATHERED UINT32_MAX

/// A group of lanes that are solved together.
typedef struct StrandGroup {
    uint32_t row;     ///< its first row in the set
    uint32_t rows;    ///< springs of its longest lane; one more row of nodes
    uint32_t columns; ///< in use
    uint32_t width;   ///< lanes: 4, 8 or 16, as many as columns at least
    bool ring;        ///< every lane is one ring of `rows` springs
    bool apart;       ///< internal friction goes strand by strand (smooth.c)
    uint32_t reach;   ///< otherwise, of its strands: DynamicsPlan.reach
} StrandGroup;

/// The strands of one colour. Family f is the groups [family_first[f], family_first[f + 1]).
typedef struct StrandSet {
    uint32_t group_count, row_count, family_count, strand_count;
    uint32_t longest; ///< rows of the longest group
    uint32_t group_capacity;
    StrandGroup *groups;
    uint32_t *family_first;
    uint32_t *strand_group; ///< [strands]
    uint32_t *strand_slot;  ///< [strands] slot of the strand's first spring; spring k lies k rows further
    uint32_t *node;         ///< [row_count STRAND_LANES] four times the particle's number
    uint32_t *contiguous;  ///< [row_count] node of column 0 where those of the other columns follow, or STRAND_GATHERED
    float *target;         ///< [row_count STRAND_LANES] m2, squares of target lengths
    float *weight;         ///< [row_count STRAND_LANES] half of W of eq 19, with char; 0 where there is no spring
    float *compliance;     ///< [row_count STRAND_LANES] m/N
    float *bend_limit;     ///< [row_count STRAND_LANES] m, as in curvature.c, at a node; NULL: none
    float bend_share;      ///< of a bend beyond its limit that a substep removes
    _Atomic bool bends;    ///< some limit is finite, or has been
    float *pull;           ///< [row_count STRAND_LANES] sums of mu, lambda over length; NULL: not needed
    uint32_t run_count;    ///< of springs: PREPARE_RUN each, in the springs' order
    uint8_t *stale;        ///< [run_count] 1: some of the run's springs change in this step
    uint32_t *run_strand;  ///< [run_count] the strand of the run's first spring
    uint8_t *creased;      ///< [run_count] 1: a crease had changed a length of the run
    _Atomic uint8_t *seen; ///< [run_count PREPARE_RUN] the springs' flags that the weights are for, or PREPARE_STALE
    bool rings;            ///< some strands are rings
    float compliance_all;  ///< m/N, of every spring; negative if they differ
    void *block;           ///< memory of the five arrays
} StrandSet;

static inline uint32_t strand_lane(uint32_t width, uint32_t column) {
    return column / (width / 4) + 4 * (column % (width / 4));
}
static inline uint32_t strand_column(uint32_t width, uint32_t lane) { return lane % 4 * (width / 4) + lane / 4; }

/// Lays out the strands of a colour. `nowhere` is the first particle of no mass. False when out of memory.
bool strand_set_create(Memory *memory, const SpringSet *springs, uint32_t nowhere, bool pulls, StrandSet *set);
void strand_set_free(Memory *memory, StrandSet *set);

/// Runs `run` over the groups of one family after the other; *first_group is what item 0 of a family is. `opens`: each
/// thread has just written its share of the particles.
void strand_families(const StrandSet *set, bool opens, Pool *pool, SingeTaskFn *run, void *context,
                     uint32_t *first_group);

typedef struct StrandJob {
    const StrandSet *set;
    float *position; ///< [4 (particles + 1)] m, fourth: inverse mass
    float regularisation, inverse_h2;
} StrandJob;

/// Projects the strands of one group; `keep` has room for STRAND_KEEP floats for each row and lane.
typedef void StrandSolve(const StrandJob *job, uint32_t group, float *keep);
StrandSolve strand_solve_plain, strand_solve_v2, strand_solve_v3, strand_solve_v4, strand_solve_neon,
    strand_solve_simd128;

/// Limits the curvature along the strands of one group (curvature_kernel.h).
typedef void StrandBend(const StrandSet *set, float *position, uint32_t group);
StrandBend strand_bend_plain, strand_bend_v2, strand_bend_v3, strand_bend_v4, strand_bend_neon, strand_bend_simd128;
