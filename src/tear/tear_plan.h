// Shared declarations of the stage's files.
#pragma once

#include "common/float3.h"
#include "shell/split.h"
#include "tear/tear.h"

/// Share of the strength between cells that are connected only by a vertex.
static const float TEAR_HINGE = 0.25f;

/// A symmetric tensor: xx, yy, zz, yz, zx, xy.
typedef float Tensor[6];

/// n . t n
static inline float tensor_across(const float *t, Float3 n) {
    return t[0] * n.x * n.x + t[1] * n.y * n.y + t[2] * n.z * n.z +
           2 * (t[3] * n.y * n.z + t[4] * n.z * n.x + t[5] * n.x * n.y);
}

/// t += s n n
static inline void tensor_add(float *t, Float3 n, float s) {
    t[0] += s * n.x * n.x;
    t[1] += s * n.y * n.y;
    t[2] += s * n.z * n.z;
    t[3] += s * n.y * n.z;
    t[4] += s * n.z * n.x;
    t[5] += s * n.x * n.y;
}

/// The load at a vertex.
typedef struct TearPull {
    float ratio;   ///< largest principal line force over the strength; 0 where nothing can tear
    Float3 across; ///< its direction at rest
    Tensor force;
} TearPull;

struct TearPlan {
    uint32_t cell_count, vertex_count, particle_count;
    float (*centroid)[4]; ///< [cells] m, at rest, of the corners: the centre, projected along the normal
    Tensor *smooth[2];    ///< [cells] N/m, averaged over the process zone, alternating
    float *ratio;         ///< [vertices] of TearPull
    uint8_t *torn;        ///< [vertices] an edge at it is torn
    uint32_t split_count; ///< of the shell that `torn` is for
    uint32_t *leader;     ///< [particles] by piece: its weakest vertex, or LEADER_RUNS
    double *partial;      ///< [pool_blocks(cells)]
    uint32_t sheet_count;
    float safe;     ///< N/m, nothing tears below: the least strength that a vertex of any sheet without ash can come to
    float safe_ash; ///< N/m, the same with ash
    float *weakened; ///< [sheets] max share of its fresh strength in this step
    float *fresh;    ///< [sheets] N/m, strength of the weakest vertex before it burns
    float *min;      ///< [sheets] that factor while it is held farther apart than its length
};

/// N/m, the line force at which a vertex tears.
float tear_strength(const TearPlan *plan, const Shell *shell, const State *state, uint32_t vertex);

/// N/m, what no vertex of a sheet falls below, however it burns and soaks, while at most the share `ash` of it is ash,
/// where it keeps the share `weakened` of its strength when it must tear.
float tear_strength_least(const Shell *shell, uint32_t sheet, float weakened, float ash);

/// Whether an edge or a diagonal at a vertex may be so long that the vertex tears, whatever its strength.
bool tear_is_stretched(const Shell *shell, const State *state, uint32_t vertex);

/// Computes the filtered line force of every cell (line_force.c). Not 0 if a cell is near its strength.
double tear_measure(TearPlan *plan, const Shell *shell, State *state, const float *const pull[SINGE_COLOUR_COUNT],
                    Pool *pool, float h);

/// Averages it over the process zone; the result is in plan->smooth[0].
void tear_smooth(TearPlan *plan, const Shell *shell, const State *state, Pool *pool);

/// The load at a vertex, from the averaged line force.
TearPull tear_pull(const TearPlan *plan, const Shell *shell, const State *state, uint32_t vertex);

/// The normal of the sheet at a vertex at rest.
Float3 tear_normal(const Shell *shell, const Fan *fan);

/// Splits a vertex and gives the new one its state (split_state.c).
void tear_split(Shell *shell, State *state, const Fan *fan, const ShellSplit *split, SplitResult *result);
