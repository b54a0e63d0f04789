/// Singe: the Defs that describe a simulation. Each has a `singe_default_...()` that returns it with
/// values that work; change what you need and pass it on. The simulation copies everything it is
/// given, so a Def and the arrays it points to may be freed after the call.
///
/// Behind each lies `singe_init_...(def, struct_size)`, for callers that cannot use an inline function.
/// It fills `struct_size` bytes, which is the caller's sizeof, and no more: fields of a newer header
/// than the library become 0. A Def inside another must hold its own struct_size before the call.
#ifndef SINGE_TYPES_H
#define SINGE_TYPES_H

#include "singe/material.h"

#ifdef __cplusplus
extern "C" {
#endif

/// One moment of a key-framed motion; linear in between, held before the first and after the last.
typedef struct SingePoseKey {
    float time;        ///< s, increasing
    float position[3]; ///< m
    float rotation[4]; ///< unit quaternion x, y, z, w; {0,0,0,1} is none
} SingePoseKey;

/// One moment of a key-framed number; linear in between, held before the first and after the last.
typedef struct SingeValueKey {
    float time;  ///< s, increasing
    float value; ///< without a unit: a factor
} SingeValueKey;

/// A sheet: a quad mesh and its material. Cells are counter-clockwise seen from the front; the centre
/// layer lies `thickness` from the corner layer, on the side of the normal (the front).
///
/// Defaults: singe_default_material(), at rest, drop_pieces_below 0; all else 0 or NULL.
typedef struct SingeSheetDef {
    size_t struct_size;
    const char *name; ///< for messages; NULL is "sheet"
    uint32_t vertex_count;
    const float *positions; ///< [3 * vertex_count] m, each within 1e15
    uint32_t cell_count;
    const uint32_t *cells; ///< [4 * cell_count], vertex indices
    const float *uv;       ///< [2 * vertex_count] or NULL (then textures are refused)
    uint32_t attribute_count;
    const SingeAttribute *attributes; ///< [attribute_count]
    SingeMaterialDef material;
    float velocity[3];       ///< m/s at the start
    float drop_pieces_below; ///< m2, >= 0; loose pieces smaller than this vanish; 0 keeps all
    /// [8 * cell_count] uv of each cell's corners, or NULL where those of the vertices hold. Vertices where cells
    /// differ lie on a seam: they are drawn once for each uv, at one place. `uv` is still needed, for what is one a
    /// vertex.
    const float *corner_uv;
    const int32_t *source_vertex; ///< [vertex_count] what SingeSurface.source_vertex says: 0 up to source_count, or -1
    uint32_t source_count;        ///< vertices of the mesh that this one was made from; 0 without source_vertex
    /// [4 * cell_count] the same of each cell's corners, or NULL: where a seam's vertices were several in that mesh.
    /// Needs corner_uv and source_vertex.
    const int32_t *corner_source_vertex;
    void *user_data; ///< the caller's own; see singe_sim_sheet_user_data
} SingeSheetDef;

SINGE_API void singe_init_sheet(SingeSheetDef *def, size_t struct_size);

static inline SingeSheetDef singe_default_sheet(void) {
    SingeSheetDef def;
    def.material.struct_size = sizeof def.material;
    singe_init_sheet(&def, sizeof def);
    return def;
}

typedef enum SingeSourceKind {
    SINGE_SOURCE_BALL = 0,     ///< a hot ball on a path; heats what is near it
    SINGE_SOURCE_TEXTURE = 1,  ///< a flux over uv, black none, white full
    SINGE_SOURCE_SPOT = 2,     ///< a ball that stands still
    SINGE_SOURCE_CALLBACK = 3, ///< the caller's own
} SingeSourceKind;

struct SingeView;

/// A caller's heat source: add to the arrays, one entry a particle, over view->particle_count.
/// Heat flux into a layer is flux + conductance * (temperature - T) in W/m2, where
/// `conductance_temperature` sums conductance * temperature. A flux below 0 cools down to 1 K. Must not depend on call
/// order.
typedef void SingeFluxFn(void *context, const struct SingeView *view, float *flux, float *conductance,
                         float *conductance_temperature);

/// Something that heats. Ball and spot: conductance towards `temperature`, full within `radius` of a point in
/// space, falling smoothly to nothing at `radius + falloff`. Fluxes and conductances are those into a layer, and
/// a sheet has two: it takes twice as much a square metre.
///
/// Defaults: SINGE_SOURCE_SPOT, start 0, end INFINITY, temperature 1200, conductance 150, radius 0.005, falloff 0.01,
/// flux 30e3; all else 0 or NULL: it stands at the origin.
typedef struct SingeSourceDef {
    size_t struct_size;
    SingeSourceKind kind;
    float start, end;         ///< s, when it acts; any, end may be INFINITY
    float temperature;        ///< K, of ball and spot, 1e-3 to 1e5
    float conductance;        ///< W/(m2 K), of ball and spot, 0 to 1e9
    float radius, falloff;    ///< m, of ball and spot, >= 0
    uint32_t path_count;      ///< of ball and spot; 0: it stands still at `position`. A spot has at most 1
    const SingePoseKey *path; ///< [path_count] positions only
    SingeTexture texture;     ///< texture source
    /// W/m2 into each layer where the texture is white, at most 1e15 with texture and strength; below 0 it cools, down
    /// to 1 K
    float flux;
    uint32_t strength_count;       ///< texture: key frames that multiply `flux`; 0 means 1
    const SingeValueKey *strength; ///< [strength_count]
    SingeFluxFn *callback;         ///< not saved: set it again after a load
    void *callback_context;
    float position[3]; ///< m, of a ball or spot without a path
    void *user_data;   ///< the caller's own; see singe_sim_source_user_data
} SingeSourceDef;

SINGE_API void singe_init_source(SingeSourceDef *def, size_t struct_size);

static inline SingeSourceDef singe_default_source(void) {
    SingeSourceDef def;
    singe_init_source(&def, sizeof def);
    return def;
}

typedef enum SingeColliderKind {
    SINGE_COLLIDER_PLANE = 0, ///< through `position`, normal = local z
    SINGE_COLLIDER_SPHERE = 1,
    SINGE_COLLIDER_BOX = 2,         ///< half_size along the local axes
    SINGE_COLLIDER_CAPSULE = 3,     ///< along local z, `height` between the centres of its caps
    SINGE_COLLIDER_HEIGHTFIELD = 4, ///< solid below heights over a rectangle about the origin, without end down local z
    SINGE_COLLIDER_MESH = 5,        ///< what a closed triangle mesh encloses
    SINGE_COLLIDER_DEFORMING = 6,   ///< the same of a mesh whose vertices move (singe_sim_set_collider_vertices)
} SingeColliderKind;

/// Which layers of a sheet that touches a collider exchange heat with it.
typedef enum SingeContactSides {
    SINGE_SIDES_TOUCHING = 0, ///< the one on the side that faces the collider; the other gets it through the sheet
    SINGE_SIDES_BOTH = 1,     ///< the one behind as well, as if the sheet were so thin that heat is through at once
} SingeContactSides;

/// A rigid solid that sheets rest on and slide over.
///
/// Defaults: SINGE_COLLIDER_PLANE, radius 0.05, half_size 0.05, height 0.1, friction 0.4, offset 0.0005, temperature
/// 293.15, conductance 0, contact_distance 0.002, SINGE_SIDES_TOUCHING, size 0.2, rotation {0,0,0,1}; all else 0 or
/// NULL: it stands at the origin.
typedef struct SingeColliderDef {
    size_t struct_size;
    SingeColliderKind kind;
    float radius;             ///< m, sphere and capsule, > 0
    float half_size[3];       ///< m, box, > 0
    float height;             ///< m, capsule, >= 0
    float friction;           ///< Coulomb's coefficient, 0 to 1000
    float offset;             ///< m, distance kept from the surface, 0 to 1000
    float temperature;        ///< K, > 0; only used when conductance > 0
    float conductance;        ///< W/(m2 K) in contact, >= 0; 0 for none
    float contact_distance;   ///< m, how near counts as contact for heat, >= 0
    uint32_t path_count;      ///< 0: it stands still at `position` and `rotation`
    const SingePoseKey *path; ///< [path_count] of its own frame
    SingeContactSides sides;  ///< of a sheet in contact that exchange heat
    /// mesh and deforming: closed; each edge is shared by two triangles, counter-clockwise from outside, that do not
    /// pass through others. Vertices at the same position are one. A mesh that is inside out is turned
    uint32_t vertex_count;
    const float *vertices;     ///< [3 * vertex_count] m, each within 1e4
    uint32_t triangle_count;   ///< at least 4
    const uint32_t *triangles; ///< [3 * triangle_count], vertex indices
    uint32_t columns, rows;    ///< heightfield: nodes along local x and y, 2 to 32768
    float size[2];             ///< m, heightfield: of its rectangle along local x and y, 1e-6 to 1e4
    const float *heights;      ///< [rows * columns] m, each within 1e4, from the least y, each row from the least x
    float position[3];         ///< m, without a path
    float rotation[4];         ///< quaternion x, y, z, w, without a path; {0,0,0,1} is none
    void *user_data;           ///< the caller's own; see singe_sim_collider_user_data
} SingeColliderDef;

SINGE_API void singe_init_collider(SingeColliderDef *def, size_t struct_size);

static inline SingeColliderDef singe_default_collider(void) {
    SingeColliderDef def;
    singe_init_collider(&def, sizeof def);
    return def;
}

/// Holds particles of one sheet: those within `radius` of any of the points (rest position) and the
/// listed vertices. They follow the path, taken relative to its pose at the time the pin is added.
///
/// Defaults: radius 0.005; all else 0 or NULL: held still.
typedef struct SingePinDef {
    size_t struct_size;
    SingeSheetId sheet;
    uint32_t point_count;
    const float *points; ///< [3 * point_count] m; points or vertices are needed
    float radius;        ///< m, >= 0; 0 pins the nearest vertex of each point
    uint32_t vertex_count;
    const uint32_t *vertices; ///< [vertex_count] of the sheet's mesh, from 0
    uint32_t path_count;      ///< 0: held still
    const SingePoseKey *path; ///< [path_count]
    void *user_data;          ///< the caller's own; see singe_sim_pin_user_data
} SingePinDef;

SINGE_API void singe_init_pin(SingePinDef *def, size_t struct_size);

static inline SingePinDef singe_default_pin(void) {
    SingePinDef def;
    singe_init_pin(&def, sizeof def);
    return def;
}

/// The air's motion: a mean and seeded gusts that vary over time and space.
///
/// Defaults: velocity 0, gust 0, gust_time 0.5, gust_size 0.3, seed 1.
typedef struct SingeWindDef {
    size_t struct_size;
    float velocity[3]; ///< m/s, each -1000 to 1000
    float gust;        ///< m/s, amplitude, 0 to 1000
    float gust_time;   ///< s, how long a gust lasts, > 0
    float gust_size;   ///< m, how far it reaches, > 0
    uint32_t seed;     ///< of the gusts
} SingeWindDef;

SINGE_API void singe_init_wind(SingeWindDef *def, size_t struct_size);

static inline SingeWindDef singe_default_wind(void) {
    SingeWindDef def;
    singe_init_wind(&def, sizeof def);
    return def;
}

/// How springs are kept at their lengths.
typedef enum SingeSolverMethod {
    SINGE_SOLVER_STRAND = 0,        ///< strand after strand in SIMD lanes, single precision
    SINGE_SOLVER_PAPER = 1,         ///< successive fast projection (section 7.1): conjugate gradients a colour, double
    SINGE_SOLVER_PAPER_LITERAL = 2, ///< the same to the letter of the paper; may fail
    SINGE_SOLVER_ALL_AT_ONCE = 3,   ///< fast projection of all colours in one system, which diverges (section 7.1)
    SINGE_SOLVER_MASS_SPRING = 4,   ///< Hooke's law, the comparison of section 8
} SingeSolverMethod;

/// The solver of the shell's motion (docs/equations.md).
///
/// Defaults: SINGE_SOLVER_STRAND, substeps 3, projections 1, order green, red, yellow, blue, regularisation 2 (red),
/// 0.1 (green), 0.001 (blue), 0.01 (yellow), attachments, early_exit, tolerance 1e-7, stiffness 1000, smoothing 170,
/// smoothing_length 0.02, height_min 0.3, height_gain 0.5; no creases, no tearing.
typedef struct SingeSolverDef {
    size_t struct_size;
    SingeSolverMethod method;
    int substeps;    ///< per step, 1 to 1000, or 0 for the fewest that give red springs their full stiffness
    int projections; ///< of all colours, per substep, 1 to 1000
    SingeColour order[SINGE_COLOUR_COUNT];    ///< order of projection, each colour once
    float regularisation[SINGE_COLOUR_COUNT]; ///< floor on the diagonal, relative to w_a + w_b = 2; 1e-6 to 1e6
    bool attachments;       ///< keep vertices within their geodesic distance of what is pinned (strand)
    bool early_exit;        ///< stop projecting when the error is below `tolerance` (paper, all-at-once)
    float tolerance;        ///< of the conjugate gradients and the early exit, 1e-12 to 1 (paper, all-at-once)
    float stiffness;        ///< N/m, of every spring (mass-spring), 1e-6 to 1e9
    float smoothing;        ///< 1/s, internal friction: rate at which second differences of velocity are lost; >= 0
    float smoothing_length; ///< m, distance of the nodes they are taken over; >= 0, and a cell at least
    float height_min;       ///< smallest height of a centre over its corners, in thicknesses, 0 to 1; 0 is off
    float height_gain;      ///< share of a height's error mended in a substep, 0 to 1
    bool creases;           ///< bending beyond the material's crease_radius is partly plastic (strand)
    /// sheets tear where the line force in them exceeds the material's `strength` (strand; the others never do); a part
    /// of the vertices is kept in reserve, which views show after each sheet's own
    bool tearing;
} SingeSolverDef;

/// Fills a Def with what suits SINGE_SOLVER_STRAND, and for another method with what the paper gives for it.
SINGE_API void singe_init_solver(SingeSolverDef *def, size_t struct_size);
SINGE_API void singe_init_solver_method(SingeSolverDef *def, size_t struct_size, SingeSolverMethod method);

static inline SingeSolverDef singe_default_solver(void) {
    SingeSolverDef def;
    singe_init_solver(&def, sizeof def);
    return def;
}

/// Instructions that the inner loops use. Results are the same.
typedef enum SingeInstructions {
    SINGE_INSTRUCTIONS_BEST = 0,     ///< the best that the processor has
    SINGE_INSTRUCTIONS_PLAIN = 1,    ///< plain C
    SINGE_INSTRUCTIONS_X86_V2 = 2,   ///< x86-64-v2: SSE 4.2, 4 lanes
    SINGE_INSTRUCTIONS_X86_V3 = 3,   ///< x86-64-v3: AVX2, 8 lanes
    SINGE_INSTRUCTIONS_X86_V4 = 4,   ///< x86-64-v4: AVX-512, 16 lanes
    SINGE_INSTRUCTIONS_ARM_NEON = 5, ///< 64-bit Arm: NEON, 4 lanes
} SingeInstructions;

/// The gas about what burns: hot air, flames and smoke on a grid, which rises, heats and lifts (docs/equations.md).
///
/// Defaults: not enabled, cell_size 0, height 0.25, conductance 10, radiated 0.3, soot 0.01.
typedef struct SingeGasDef {
    size_t struct_size;
    bool enabled;
    float cell_size;   ///< m, side of a cell of the grid, >= 0; 0: as the sheets' size asks for
    float height;      ///< m of room above the sheets as they start, > 0
    float conductance; ///< W/(m2 K), of each side of a sheet towards gas that is hotter than it, >= 0
    float radiated;    ///< share of the flames' power that leaves as radiation, 0 to 0.95
    float soot;        ///< kg of smoke per kg burnt, 0 to 1
} SingeGasDef;

SINGE_API void singe_init_gas(SingeGasDef *def, size_t struct_size);

static inline SingeGasDef singe_default_gas(void) {
    SingeGasDef def;
    singe_init_gas(&def, sizeof def);
    return def;
}

/// Contact of sheets with themselves and each other (docs/equations.md). Colliders have a friction of their own.
///
/// Defaults: not enabled, thickness 0.0005, friction 0.3.
typedef struct SingeContactDef {
    size_t struct_size;
    bool enabled; ///< false: sheets pass through themselves, as in the paper
    /// m, distance that is kept between surfaces, > 0 to 1, and 2/5 of the smallest cell at most. It is not the
    /// material's `thickness`, which lies between the two layers of the model
    float thickness;
    float friction; ///< Coulomb's coefficient, >= 0
} SingeContactDef;

SINGE_API void singe_init_contact(SingeContactDef *def, size_t struct_size);

static inline SingeContactDef singe_default_contact(void) {
    SingeContactDef def;
    singe_init_contact(&def, sizeof def);
    return def;
}

/// A simulation.
///
/// Defaults: libc's allocator, no log, a pool of 1 thread, SINGE_INSTRUCTIONS_BEST, seed 1, time_step 1/480, pace 1,
/// gravity {0,0,-9.81}, ambient_temperature 293.15, air_density 1.2, heat_tolerance 1e-5, surface_detail 0,
/// surface_raggedness 0.002, and the defaults of what lies inside.
typedef struct SingeSimDef {
    size_t struct_size;
    SingeAllocator allocator;
    SingeLog log;
    SingeTasks tasks;
    int thread_count;               ///< of the simulation's own pool, 1 to 64
    SingeInstructions instructions; ///< refused where the processor lacks them
    uint64_t seed;    ///< of the drawn surface's ragged edges, and for a renderer; noise and wind have their own
    float time_step;  ///< s, h of the paper, 1e-9 to 10
    float pace;       ///< seconds of fire per second of motion, > 0; 1 is real
    float gravity[3]; ///< m/s2
    float ambient_temperature; ///< K, 1 to 1e4
    float air_density;         ///< kg/m3, >= 0
    /// relative residual of the implicit diffusion, > 0 to 1; 200 iterations at most: the log warns once
    float heat_tolerance;
    /// m, distance of the points where the drawn surface is cut near the front, a cell's side over 23 at least. The
    /// surface is smooth then, and bent cells are drawn in more triangles, up to as fine; 0: cells are drawn as they
    /// are (Fig 6)
    float surface_detail;
    float surface_raggedness; ///< m, how far noise eats into burnt edges at most, and half a cell; needs a detail
    SingeWindDef wind;
    SingeSolverDef solver;
    SingeGasDef gas;         ///< not enabled: sheets burn as in still air
    SingeContactDef contact; ///< not enabled: sheets pass through themselves and each other
} SingeSimDef;

SINGE_API void singe_init_sim(SingeSimDef *def, size_t struct_size);

static inline SingeSimDef singe_default_sim(void) {
    SingeSimDef def;
    def.wind.struct_size = sizeof def.wind;
    def.solver.struct_size = sizeof def.solver;
    def.gas.struct_size = sizeof def.gas;
    def.contact.struct_size = sizeof def.contact;
    singe_init_sim(&def, sizeof def);
    return def;
}

#ifdef __cplusplus
}
#endif
#endif
