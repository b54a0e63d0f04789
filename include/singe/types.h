/// Singe: the Defs that describe a simulation. Each has a `singe_default_...()` that returns it with
/// values that work; change what you need and pass it on. The simulation copies a Def and the arrays
/// that it points to, so both may be freed after the call.
///
/// `singe_init_...(def, struct_size)` is the same for callers that cannot use an inline function. It
/// fills `struct_size` bytes, which is the caller's sizeof, and no more. Fields that the library does
/// not know become 0. A Def inside another must hold its own struct_size before the call.
#ifndef SINGE_TYPES_H
#define SINGE_TYPES_H

#include "singe/material.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A key of a motion. Poses are interpolated linearly, and constant before the first key and after the last.
typedef struct SingePoseKey {
    float time;        ///< s, increasing
    float position[3]; ///< m
    float rotation[4]; ///< unit quaternion x, y, z, w; {0,0,0,1} is none
} SingePoseKey;

/// A key of a number. Values are interpolated linearly, and constant before the first key and after the last.
typedef struct SingeValueKey {
    float time;  ///< s, increasing
    float value; ///< a factor, without a unit
} SingeValueKey;

/// A sheet: a quad mesh and its material. Cells are counter-clockwise seen from the front. The centre
/// layer lies in front of the corner layer, at a distance of `thickness` along the normal.
///
/// Defaults: material singe_default_material(); all else 0 or NULL.
typedef struct SingeSheetDef {
    size_t struct_size;
    const char *name;                 ///< for messages; NULL is "sheet"
    uint32_t vertex_count;            ///< at least 4
    const float *positions;           ///< [3 * vertex_count] m, each within 1e15
    uint32_t cell_count;              ///< at least 1
    const uint32_t *cells;            ///< [4 * cell_count], vertex indices
    const float *uv;                  ///< [2 * vertex_count], or NULL: textures are refused
    uint32_t attribute_count;         ///< 0 without attributes
    const SingeAttribute *attributes; ///< [attribute_count]
    SingeMaterialDef material;        ///< what it is made of
    float velocity[3];                ///< m/s, -1e6 to 1e6; at the start
    float drop_pieces_below;          ///< m2, >= 0; loose pieces smaller than this vanish; 0 keeps all
    /// [8 * cell_count] uv of each cell's corners, or NULL: those of the vertices. A vertex lies on a seam if its cells
    /// have different uv: it is drawn once for each uv, at the same position. uv is needed as well: the particle of a
    /// vertex has one uv
    const float *corner_uv;
    const int32_t *source_vertex; ///< [vertex_count] values of SingeSurface.source_vertex: below source_count, or -1
    uint32_t source_count;        ///< vertices of the mesh that this one was made from; 0 without source_vertex
    /// [4 * cell_count] the same for each cell's corners, where one vertex on a seam was several vertices of that mesh,
    /// or NULL. Needs corner_uv and source_vertex
    const int32_t *corner_source_vertex;
    void *user_data; ///< for the caller's use; see singe_sim_sheet_user_data
} SingeSheetDef;

SINGE_API void singe_init_sheet(SingeSheetDef *def, size_t struct_size);

static inline SingeSheetDef singe_default_sheet(void) {
    SingeSheetDef def;
    def.material.struct_size = sizeof def.material;
    singe_init_sheet(&def, sizeof def);
    return def;
}

typedef enum SingeSourceKind {
    SINGE_SOURCE_BALL = 0,       ///< a hot ball on a path; heats its neighbourhood
    SINGE_SOURCE_TEXTURE = 1,    ///< a flux drawn on the sheet: over uv, black none, white full
    SINGE_SOURCE_SPOT = 2,       ///< a hot ball that stands still
    SINGE_SOURCE_CALLBACK = 3,   ///< a function of the caller
    SINGE_SOURCE_ARRIVAL = 4,    ///< a picture of the front's arrival times
    SINGE_SOURCE_WATER = 5,      ///< a picture of where the sheet is wetted
    SINGE_SOURCE_JET = 6,        ///< air blown from a nozzle; it cools, and puts fires out
    SINGE_SOURCE_VORTEX = 7,     ///< air that turns about an axis
    SINGE_SOURCE_ATTRACT = 8,    ///< air that flows to a point; it draws sheets along
    SINGE_SOURCE_TURBULENCE = 9, ///< swirls of air everywhere
} SingeSourceKind;

struct SingeView;

/// A heat source of the caller. It adds to the arrays, which have view->particle_count entries.
/// The heat flux into a layer is flux + conductance * (temperature - T) in W/m2, where
/// `conductance_temperature` sums conductance * temperature. A flux below 0 cools, but not below 1 K. What it adds must
/// not depend on the order of calls.
typedef void SingeFluxFn(void *context, const struct SingeView *view, float *flux, float *conductance,
                         float *conductance_temperature);

/// A heat source. Ball and spot: a conductance towards `temperature`, full within `radius` of a point in
/// space, and falling smoothly to 0 at `radius + falloff`. Fluxes and conductances are those into one layer;
/// a sheet has two layers, and takes up twice as much per square metre.
///
/// Defaults: kind SINGE_SOURCE_SPOT, end INFINITY, temperature 1200, conductance 150, radius 0.005, falloff 0.01, flux
/// 30e3, arrival_to 1, lead 0.1, wetting 0.1, direction {0, 0, 1}, speed 5, blow_out 4; all else 0 or NULL.
typedef struct SingeSourceDef {
    size_t struct_size;
    /// ball: a hot ball on a path; spot: a hot ball that stands still; texture: a flux drawn on the sheet; arrival: a
    /// picture of the front's arrival times; water: a picture of where the sheet is wetted. These move air, which bends
    /// flames, carries sheets and cools them: jet from a nozzle, vortex about an axis, attract to a point, turbulence
    /// everywhere
    SingeSourceKind kind;
    float start;       ///< s, >= 0; time at which it starts
    float end;         ///< s, >= 0; time at which it ends; inf: never
    float temperature; ///< K, ball and spot, 1 to 1e4; of the ball or flame
    float conductance; ///< W/(m2 K), ball and spot, 0 to 1e9; heat transfer coefficient to the sheet
    /// m, ball, spot, jet, vortex, attract and turbulence, 0 to 1e4; full heat within it; of a jet's nozzle; where a
    /// vortex or attraction is fastest; of turbulence's swirls
    float radius;
    float falloff; ///< m, ball and spot, >= 0; beyond the radius, over which the heat falls to nothing
    /// W, ball and spot, 0 to 1e6; of a flame that it carries: the flame's gas rises and burns from its centre, if the
    /// scene has gas; a match has 60 W. It heats sheets through the gas alone
    float power;
    uint32_t path_count;      ///< of ball, spot, jet, vortex and attract; 0: at rest at position. A spot has at most 1
    const SingePoseKey *path; ///< [path_count] positions only
    SingeTexture texture;     ///< texture source, or arrival map
    /// W/m2, texture, -1e15 to 1e15; into each of the sheet's two layers where the texture is white; at most 1e15 W/m2
    /// after strength and the texture. Below 0 it cools, but not below 1 K
    float flux;
    /// texture, water and what moves air: key frames that multiply flux, wetting or speed; 0 means 1
    uint32_t strength_count;
    const SingeValueKey *strength; ///< [strength_count]
    SingeFluxFn *callback;         ///< not saved; must be set again after a load
    void *callback_context;        ///< its first argument
    float position[3];             ///< m, of what has no path
    void *user_data;               ///< for the caller's use; see singe_sim_source_user_data
    float arrival_from;            ///< s, arrival, 0 to 1e9; when the front arrives where the map is black
    float arrival_to; ///< s, arrival, 0 to 1e9; when it arrives where the map is white; pure white never ignites
    /// s, arrival, 1e-3 to 1e6; how long before the front the sheet begins to scorch; longer makes a wider brown rim
    float lead;
    /// kg/(m2 s), water, 0 to 1e6; water that falls where the picture is white, at the air's temperature. It needs a
    /// sheet with moisture above 0, which holds at most three times its own mass
    float wetting;
    /// jet and vortex, -1e6 to 1e6; in which a jet blows; a vortex turns about it, counter-clockwise seen against it
    float direction[3];
    float speed; ///< m/s, jet, vortex, attract and turbulence, 0 to 1000; of the air, where it is fastest
    /// m/s, jet, > 0; speed of the jet's air past a sheet from which on its flame gives the sheet no heat; it gives
    /// less from half of that on. inf: never
    float blow_out;
} SingeSourceDef;

SINGE_API void singe_init_source(SingeSourceDef *def, size_t struct_size);

static inline SingeSourceDef singe_default_source(void) {
    SingeSourceDef def;
    singe_init_source(&def, sizeof def);
    return def;
}

typedef enum SingeColliderKind {
    SINGE_COLLIDER_PLANE = 0,       ///< through position, normal = local z
    SINGE_COLLIDER_SPHERE = 1,      ///< of radius
    SINGE_COLLIDER_BOX = 2,         ///< half_size along the local axes
    SINGE_COLLIDER_CAPSULE = 3,     ///< along local z, height between the centres of its caps
    SINGE_COLLIDER_HEIGHTFIELD = 4, ///< solid below heights over a rectangle around the origin, unbounded below
    SINGE_COLLIDER_MESH = 5,        ///< the inside of a closed triangle mesh
    SINGE_COLLIDER_DEFORMING = 6,   ///< the same; its vertices move (singe_sim_set_collider_vertices)
} SingeColliderKind;

/// Which layers of a sheet that touches a collider exchange heat with it.
typedef enum SingeContactSides {
    SINGE_SIDES_TOUCHING = 0, ///< the layer that faces the collider; heat reaches the other through the sheet
    SINGE_SIDES_BOTH = 1,     ///< both layers, as in a sheet so thin that heat passes through it at once
} SingeContactSides;

/// A rigid solid that sheets rest on and slide over.
///
/// Defaults: kind SINGE_COLLIDER_PLANE, radius 0.05, half_size {0.05, 0.05, 0.05}, height 0.1, friction 0.4, offset
/// 0.0005, temperature 293.15, contact_distance 0.002, sides SINGE_SIDES_TOUCHING, size {0.2, 0.2}, rotation {0, 0, 0,
/// 1}; all else 0 or NULL.
typedef struct SingeColliderDef {
    size_t struct_size;
    /// plane (its normal is its own z axis), sphere, box, capsule (along its own z axis), heightfield (solid below
    /// heights over a rectangle of its own x-y plane) or mesh (what a closed mesh encloses)
    SingeColliderKind kind;
    float radius;             ///< m, sphere and capsule, 1e-6 to 1e4; of the sphere or the capsule
    float half_size[3];       ///< m, box, 1e-6 to 1e4; half of the box's lengths along its own axes
    float height;             ///< m, capsule, 0 to 1e4; between the centres of the capsule's caps
    float friction;           ///< 0 to 1000; Coulomb's coefficient
    float offset;             ///< m, 0 to 1000; distance that sheets keep from the surface
    float temperature;        ///< K, 1 to 1e4; matters when conductance is not 0
    float conductance;        ///< W/(m2 K), 0 to 1e9; heat exchanged in contact; 0 for none
    float contact_distance;   ///< m, 0 to 1000; how near counts as contact for heat
    uint32_t path_count;      ///< 0: at rest at position and rotation
    const SingePoseKey *path; ///< [path_count] of its own frame
    /// of a sheet's two layers in contact, touching: that which faces the collider exchanges heat; both: the one behind
    /// it as well, as if heat were through the sheet at once
    SingeContactSides sides;
    /// mesh and deforming: closed, so that each edge is shared by two triangles; counter-clockwise seen from outside,
    /// and free of self-intersections. Vertices at the same position are merged. A mesh that is inside out is flipped
    uint32_t vertex_count;
    const float *vertices;     ///< [3 * vertex_count] m, each within 1e4
    uint32_t triangle_count;   ///< at least 4
    const uint32_t *triangles; ///< [3 * triangle_count], vertex indices
    uint32_t columns;          ///< heightfield: nodes along local x, 2 to 32768
    uint32_t rows;             ///< heightfield: nodes along local y, 2 to 32768
    /// m, heightfield, 1e-6 to 1e4; of the rectangle, from the first nodes to the last, along its own x and y
    float size[2];
    const float *heights; ///< [rows * columns] m, each within 1e4; rows from the min y, columns from the min x
    float position[3];    ///< m, without a path
    float rotation[4];    ///< quaternion x, y, z, w, without a path; {0,0,0,1} is none
    void *user_data;      ///< for the caller's use; see singe_sim_collider_user_data
    bool smothers;        ///< yes: what burns within contact_distance, in either layer, gets no air and goes out
} SingeColliderDef;

SINGE_API void singe_init_collider(SingeColliderDef *def, size_t struct_size);

static inline SingeColliderDef singe_default_collider(void) {
    SingeColliderDef def;
    singe_init_collider(&def, sizeof def);
    return def;
}

/// Holds particles of one sheet: those within `radius` of any of the points (rest position) and the
/// listed vertices. They follow the path, relative to its pose at the time when the pin is added.
///
/// Defaults: radius 0.005, end INFINITY; all else 0 or NULL.
typedef struct SingePinDef {
    size_t struct_size;
    SingeSheetId sheet;   ///< the sheet that it holds
    uint32_t point_count; ///< a pin needs points or vertices
    const float *points;  ///< [3 * point_count] m, each within 1e9
    /// m, 0 to 1e6; all particles within this distance of a point are held, and at least the vertex nearest to each
    /// point; a point that misses the sheet by a tenth of its diagonal is warned of
    float radius;
    uint32_t vertex_count;    ///< 0 without a list of vertices
    const uint32_t *vertices; ///< [vertex_count] of the sheet's mesh, from 0
    uint32_t path_count;      ///< 0: held still
    const SingePoseKey *path; ///< [path_count]
    void *user_data;          ///< for the caller's use; see singe_sim_pin_user_data
    float end;                ///< s, >= 0; time at which it lets go; what it held keeps its velocity; inf: never
} SingePinDef;

SINGE_API void singe_init_pin(SingePinDef *def, size_t struct_size);

static inline SingePinDef singe_default_pin(void) {
    SingePinDef def;
    singe_init_pin(&def, sizeof def);
    return def;
}

/// The motion of the air: a mean velocity and seeded gusts that vary over time and space.
///
/// Defaults: gust_time 0.5, gust_size 0.3, seed 1; all else 0 or NULL.
typedef struct SingeWindDef {
    size_t struct_size;
    float velocity[3]; ///< m/s, -1000 to 1000; mean velocity of the air
    float gust;        ///< m/s, 0 to 1000; amplitude of the gusts
    float gust_time;   ///< s, 1e-6 to 1e6; how long a gust lasts
    float gust_size;   ///< m, 1e-6 to 1e6; how far a gust reaches
    uint32_t seed;     ///< seed of the gusts
} SingeWindDef;

SINGE_API void singe_init_wind(SingeWindDef *def, size_t struct_size);

static inline SingeWindDef singe_default_wind(void) {
    SingeWindDef def;
    singe_init_wind(&def, sizeof def);
    return def;
}

/// How springs are kept at their lengths.
typedef enum SingeSolverMethod {
    SINGE_SOLVER_STRAND = 0, ///< projection along whole strands of springs, in SIMD lanes and single precision
    SINGE_SOLVER_PAPER = 1,  ///< successive fast projection by conjugate gradients (section 7.1), in double precision
    SINGE_SOLVER_PAPER_LITERAL = 2, ///< the same exactly as printed in the paper; may fail
    SINGE_SOLVER_ALL_AT_ONCE = 3,   ///< fast projection of all colours in one system, which diverges (section 7.1)
    SINGE_SOLVER_MASS_SPRING = 4,   ///< Hooke's law, the comparison of section 8
} SingeSolverMethod;

/// The solver of the shell's motion (docs/equations/dynamics.md).
///
/// Defaults: method SINGE_SOLVER_STRAND, substeps 8, projections 1, order {SINGE_GREEN, SINGE_RED, SINGE_YELLOW,
/// SINGE_BLUE}, regularisation {2, 0.1, 1e-3, 0.01}, attachments true, early_exit true, tolerance 1e-7, stiffness 1000,
/// smoothing 170, smoothing_length 0.02, height_min 0.3, height_gain 0.5; all else 0 or NULL.
typedef struct SingeSolverDef {
    size_t struct_size;
    /// in this order: projection along strands; the paper's successive fast projection; the same exactly as printed,
    /// which may fail; all colours in one system; Hooke's law. The defaults below are those of strand
    SingeSolverMethod method;
    /// 0 to 1000; substeps of a step; stiff, thick sheets of small cells need more; 0: as many as the red compliance
    /// needs, and the weight of hanging sheets and the plume about them. If sheets may tear in gas and this is less
    /// than half of what that load needs, what it needs is taken
    int substeps;
    int projections;                       ///< 1 to 1000; projections of all colours per substep
    SingeColour order[SINGE_COLOUR_COUNT]; ///< order of the springs' colours, each once; the last is satisfied best
    /// 1e-6 to 1e6; floor on the solver's diagonal by colour of spring, relative to w_a + w_b = 2
    float regularisation[SINGE_COLOUR_COUNT];
    bool attachments; ///< strand: keeps vertices within their geodesic distance of the pins
    bool early_exit;  ///< paper, paper-literal, all-at-once: stops where the error is below tolerance of the lengths
    float tolerance;  ///< 1e-12 to 1; the same methods: of the conjugate gradients and of the early exit
    float stiffness;  ///< N/m, 1e-6 to 1e9; mass-spring: of every spring
    /// 1/s, 0 to 1e6; internal friction: rate at which second differences of velocity along strands are lost
    float smoothing;
    float smoothing_length; ///< m, 0 to 1000; distance between the nodes compared; at least that of neighbours
    /// 0 to 1; smallest height of a cell's centre over its corners, in thicknesses; 0 is off, and cells may be inverted
    float height_min;
    float height_gain; ///< 0 to 1; share of a height's error that is corrected in a substep
    /// yes: sharp bending is partly plastic, by the material's crease_radius and crease_share (solver strand); no:
    /// bending is elastic, as in the paper
    bool creases;
    /// sheets tear where the line force exceeds the material's strength; needs the method strand. Each sheet then has a
    /// reserve of vertices, which views show after its own vertices
    bool tearing;
    /// strand: yes: bending is the same in all directions of the mesh, for what drapes or curls and, with substeps: 0
    /// and curvature_max of 130 1/m for cells of 2 mm, folds off the mesh; no: softest along the diagonals
    bool isotropic;
    /// 0 to 0.65; strand: a substep starts with this share of what steady springs move each node; 0.6 halves the strain
    /// of sheets that hang, swing or drape, or saves a third of their substeps
    float start;
} SingeSolverDef;

/// Fills a Def with the defaults of SINGE_SOLVER_STRAND, or of another method.
SINGE_API void singe_init_solver(SingeSolverDef *def, size_t struct_size);
SINGE_API void singe_init_solver_method(SingeSolverDef *def, size_t struct_size, SingeSolverMethod method);

static inline SingeSolverDef singe_default_solver(void) {
    SingeSolverDef def;
    singe_init_solver(&def, sizeof def);
    return def;
}

/// Instruction set of the inner loops. Results do not depend on it.
typedef enum SingeInstructions {
    SINGE_INSTRUCTIONS_BEST = 0,         ///< the best that the processor has
    SINGE_INSTRUCTIONS_PLAIN = 1,        ///< plain C
    SINGE_INSTRUCTIONS_X86_V2 = 2,       ///< x86-64-v2: SSE 4.2, 4 lanes
    SINGE_INSTRUCTIONS_X86_V3 = 3,       ///< x86-64-v3: AVX2, 8 lanes
    SINGE_INSTRUCTIONS_X86_V4 = 4,       ///< x86-64-v4: AVX-512, 16 lanes
    SINGE_INSTRUCTIONS_ARM_NEON = 5,     ///< 64-bit Arm: NEON, 4 lanes
    SINGE_INSTRUCTIONS_WASM_SIMD128 = 6, ///< WebAssembly: simd128, 4 lanes
} SingeInstructions;

/// The gas around the sheets: hot air, flames and smoke on a grid. It rises, heats and lifts (docs/equations/gas.md).
///
/// Defaults: height 0.25, conductance 10, radiated 0.3, soot 0.01; all else 0 or NULL.
typedef struct SingeGasDef {
    size_t struct_size;
    bool enabled;    ///< no: sheets burn as in still air
    float cell_size; ///< m, 0 to 1000; side of a cell of its grid; 0: 8.7 mm for a sheet of A4, in proportion to others
    float height;    ///< m, above 0, to 1000; height of the grid above the sheets at the start
    /// W/(m2 K), 0 to 1e9; heat transfer from hotter gas to each side of a sheet; a larger value makes fire climb
    /// faster
    float conductance;
    float radiated; ///< 0 to 0.95; share of the flames' power that leaves as radiation
    float soot;     ///< 0 to 1; mass of smoke over the mass burnt
} SingeGasDef;

SINGE_API void singe_init_gas(SingeGasDef *def, size_t struct_size);

static inline SingeGasDef singe_default_gas(void) {
    SingeGasDef def;
    singe_init_gas(&def, sizeof def);
    return def;
}

/// Contact of sheets with themselves and each other (docs/equations/contact.md). Colliders have their own friction.
///
/// Defaults: thickness 0.5e-3, friction 0.3; all else 0 or NULL.
typedef struct SingeContactDef {
    size_t struct_size;
    bool enabled; ///< no: sheets pass through themselves, as in the paper
    /// m, 1e-6 to 1; distance kept between surfaces, at most 2/5 of the smallest cell; not the material's thickness,
    /// which is the distance between the model's layers
    float thickness;
    float friction; ///< 0 to 1000; Coulomb's coefficient
} SingeContactDef;

SINGE_API void singe_init_contact(SingeContactDef *def, size_t struct_size);

static inline SingeContactDef singe_default_contact(void) {
    SingeContactDef def;
    singe_init_contact(&def, sizeof def);
    return def;
}

/// A simulation.
///
/// Defaults: thread_count 1, instructions SINGE_INSTRUCTIONS_BEST, seed 1, time_step 1.0 / 480, velocity_steps 1, pace
/// 1, gravity {0, 0, -9.81}, ambient_temperature 293.15, air_density 1.2, heat_tolerance 1e-5, surface_raggedness 2e-3,
/// wind singe_default_wind(), solver singe_default_solver(), gas singe_default_gas(), contact singe_default_contact();
/// all else 0 or NULL.
typedef struct SingeSimDef {
    size_t struct_size;
    SingeAllocator allocator;       ///< zeroed: libc's
    SingeLog log;                   ///< zeroed: none
    SingeTasks tasks;               ///< zeroed: a pool of thread_count threads
    int thread_count;               ///< 1 to 64; threads of the simulation's own pool
    SingeInstructions instructions; ///< refused where the processor lacks them
    uint64_t seed;                  ///< seed of ragged edges and of the preview; noise and wind have their own seeds
    float time_step;                ///< s, 1e-9 to 10; h of the paper
    /// 1 to 1000000; steps from a frame to the next: over them a surface's velocity is displacement over time
    int velocity_steps;
    float pace;       ///< 1e-6 to 1e6; seconds of fire per second of motion; 1 is real, 4 burns four times as fast
    float gravity[3]; ///< m/s2, -1e4 to 1e4; z is up
    float ambient_temperature; ///< K, 1 to 1e4; temperature of the air and the surroundings
    float air_density;         ///< kg/m3, 0 to 1000; for drag and wind
    /// 1e-9 to 1; relative tolerance of each sheet's heat equation; a step stops after 200 iterations and warns once
    float heat_tolerance;
    /// m, 0 to 1000; resolution of the drawn mesh near the front: distance of the sample points, at least 1/23 of a
    /// cell's side. Bent cells are drawn on a smooth surface. 0: flat cells, sampled at their corners and centres, as
    /// in the paper
    float surface_detail;
    /// m, 0 to 1000; maximum depth of noise at burnt edges, at most half a cell; needs detail
    float surface_raggedness;
    SingeWindDef wind;       ///< the air's motion
    SingeSolverDef solver;   ///< how springs are kept at their lengths
    SingeGasDef gas;         ///< not enabled: still air
    SingeContactDef contact; ///< not enabled: sheets pass through themselves and each other
    SingeRecord record;      ///< zeroed: nothing is recorded. A clone records nothing
    SingeCancel cancel;      ///< zeroed: no step is given up
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
