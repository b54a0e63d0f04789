// Shared declarations of the ablate stage's files.
#ifndef ABLATE_ABLATE_PLAN_H
#define ABLATE_ABLATE_PLAN_H

#include "ablate/ablate.h"

/// Corners, virtual centres, cuts of blue springs and cuts of red springs, numbered in this order: every
/// vertex that a surface may have.
typedef struct SurfaceKeys {
    uint32_t centre, blue, red; ///< the first of each; corners begin at 0
    uint32_t count;
} SurfaceKeys;

struct AblatePlan {
    uint32_t particle_count, vertex_count;
    float *level;         ///< [particles] m' of eq 7 at the present masses
    uint8_t *rim;         ///< [vertices] 1 at the mesh's boundary, and where it is torn
    uint32_t split_count; ///< of the shell that `rim` is for
    // scratch: pieces and the surface are never worked on at the same time
    void *scratch;
    size_t scratch_size;
    double *area;   ///< [particles] at a root: m2 at rest of its corner layer
    uint32_t *root; ///< [particles] of the disjoint sets; the smallest particle of its set
    uint32_t *size; ///< [particles] at a root: particles of the piece
    uint32_t *heir; ///< [particles] by id: root of the piece that keeps the id
    uint8_t *mark;  ///< [particles] at a root: PIECE_HELD, PIECE_DROPPED
    SurfaceKeys keys;
    uint32_t *output; ///< [keys.count] index in the surface; in the same scratch
};

/// Updates the plan for a shell that has torn.
void ablate_plan_follow(AblatePlan *plan, const Shell *shell);

/// Fills plan->level.
void ablate_levels(AblatePlan *plan, const Shell *shell, const BurnState *burn);

/// The remaining triangles of a cell: bit i is the triangle of side i (corners i, i + 1 and the virtual centre). A
/// triangle is gone when its three levels are negative.
static inline unsigned ablate_triangles(const AblatePlan *plan, const Shell *shell, uint32_t cell) {
    const uint32_t *corners = shell->cells[cell];
    unsigned left = 0;
    if (plan->level[shell_centre(shell, cell)] >= 0) return 15;
    for (unsigned i = 0; i < 4; i++)
        if (plan->level[corners[i]] >= 0) left |= 1u << i | 1u << ((i + 3) & 3);
    return left;
}

/// Arguments of removal.
typedef struct Removal {
    AblatePlan *plan;
    const Shell *shell;
    const StateInput *state;
    AblateState *ablate;
    float heat_ambient; ///< K
    bool changed;       ///< something was removed
} Removal;

/// Removes a spring unless it is already gone, and a particle with its last spring.
void remove_spring(Removal *removal, SingeColour colour, uint32_t spring);

/// Removes burnt springs, cells and particles.
void remove_burnt(Removal *removal);

/// Pushes a SINGE_EVENT_HOLE_OPENED for every hole that opened in this step. To be called before the removal.
void hole_report(const AblatePlan *plan, const Shell *shell, const StateInput *state, const AblateState *ablate,
                 EventList *events);

/// Finds the pieces after a change: drops small loose ones, keeps or gives ids, pushes SINGE_EVENT_PIECE_FREED.
void piece_update(Removal *removal, EventList *events);

/// Makes room for `count` triangles or vertices; previous contents are lost. On failure the surface is empty.
SingeResult surface_reserve_triangles(SingeSurface *surface, uint64_t count, SingeError *error);
SingeResult surface_reserve_vertices(SingeSurface *surface, uint64_t count, SingeError *error);

/// Makes room for `count` vertices in total; existing ones are kept. On failure the surface is empty.
SingeResult surface_grow_vertices(SingeSurface *surface, uint64_t count, SingeError *error);
/// Copies vertex `from` to vertex `to`.
void surface_copy_vertex(SingeSurface *surface, uint32_t from, uint32_t to);

/// Gives vertices on seams of the uv a copy for each uv. cell_first: [cells + 1] the first triangle of each cell. Its
/// scratch comes from the surface's allocator and is freed. On failure the surface is empty (surface_seams.c).
SingeResult surface_seams(const Shell *shell, const uint32_t *cell_first, SingeSurface *surface, SingeError *error);

/// Empties a surface; keeps its allocator.
void surface_clear(SingeSurface *surface);

/// Fills the normals of a surface's vertices from its triangles.
void surface_normals(SingeSurface *surface);

/// Fills the vertex of a key at `index` (all but its normal).
void surface_vertex(const AblatePlan *plan, const Shell *shell, const State *state, uint32_t key, uint32_t index,
                    SingeSurface *surface);

/// Cuts closer to an end of their edge than this fraction of it would make triangles as thin as the rounding of floats.
#define SURFACE_NEAREST 1e-3f

/// Where the level set cuts an edge, eq 7, as a fraction of the edge from its inside end. Less than `nearest` becomes
/// 0, the inside end itself; the max is 1 - nearest.
float surface_cut(float inside, float outside, float nearest);

/// The corner from which a clipped triangle is triangulated: of a quadrilateral, the inside end that is farther from
/// its cut, as the other diagonal would leave a triangle thinner than the min distance of cuts from ends.
int surface_fan(const float level[3], float nearest);

#endif
