// What the coarse and the fine surface have in common. Nothing outside src/surface includes this.
#pragma once

#include "common/float3.h"
#include "surface/surface.h"

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

/// The velocity of a point of the surface, which is `now`, was `earlier` at the state's earlier time, and starts with
/// `first`: displacement over time. The last substep's velocity would show how strands tremble, and smear what is still.
static inline Float3 surface_velocity(const State *state, Float3 now, Float3 earlier, Float3 first) {
    const double passed = state->time - state->dynamics.earlier_time;
    return passed > 0 ? float3_scale(float3_sub(now, earlier), (float)(1 / passed)) : first;
}

/// Empties a surface; keeps its allocator.
void surface_clear(SingeSurface *surface);

/// Fills the normals of a surface's vertices from its triangles.
void surface_normals(SingeSurface *surface);

/// Cuts closer to an end of their edge than this fraction of it would make triangles as thin as the rounding of floats.
#define SURFACE_NEAREST 1e-3f

/// Where the level set cuts an edge, eq 7, as a fraction of the edge from its inside end. Less than `nearest` becomes
/// 0, the inside end itself; the max is 1 - nearest.
float surface_cut(float inside, float outside, float nearest);

/// The corner from which a clipped triangle is triangulated: of a quadrilateral, the inside end that is farther from
/// its cut, as the other diagonal would leave a triangle thinner than the min distance of cuts from ends.
int surface_fan(const float level[3], float nearest);
