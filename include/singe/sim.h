/// Singe: a simulation and its results.
///
/// One thread at a time may call into one simulation; different simulations are independent.
/// Particles are numbered over all sheets: first every vertex of every sheet (the corner or blue
/// layer) in the order added, then one particle for every cell (the centre or green layer).
///
/// What it does not do:
/// - Colliders do not burn, and sheets do not push them: they are where the host says. There are no rigid bodies.
/// - Sheets are thin. There are no solids, threads or liquids; water is a mass that a sheet holds.
/// - Sheets are not remeshed: cells go and vertices split, and nothing else changes how they are connected. No sheet
///   can be added after the commit.
/// - Time runs forward. To go back, load what singe_sim_save has saved.
/// - Different simulations do not feel each other.
#ifndef SINGE_SIM_H
#define SINGE_SIM_H

#include "singe/surface.h"
#include "singe/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SingeSim SingeSim;

/// Makes an empty simulation, to be freed by singe_sim_destroy. On failure *sim is NULL and *error (may be NULL) says
/// why: SINGE_ERROR_ARGUMENT or SINGE_ERROR_MEMORY.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_create(const SingeSimDef *def, SingeSim **sim, SingeError *error);

/// Frees a simulation; NULL is allowed.
SINGE_API void singe_sim_destroy(SingeSim *sim);

/// The last failure of a call on this simulation, which owns it. Valid until the next call; never NULL.
SINGE_API const SingeError *singe_sim_error(const SingeSim *sim);

/// Adds a sheet, before singe_sim_commit. SINGE_ERROR_MESH and, for a parameter out of its range, SINGE_ERROR_ARGUMENT
/// name the cell or vertex. Here and below, *id (may be NULL) is the new handle; on failure it is zeroed.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_add_sheet(SingeSim *sim, const SingeSheetDef *def, SingeSheetId *id);

/// Builds the shell (springs, strands, families) and every buffer that a step needs. Sheets cannot be added
/// afterwards. SINGE_ERROR_STATE: there is no sheet, or the simulation is committed already. A failed commit may be
/// repeated.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_commit(SingeSim *sim);

// Objects can be added, moved and removed at any time; a pin after its sheet. Two checks wait for the commit: that a
// texture has sheets with uv, and that a pin's vertices exist. A Def out of its ranges is SINGE_ERROR_ARGUMENT, a stale
// handle SINGE_ERROR_HANDLE. A call that fails changes nothing.

SINGE_API SINGE_NODISCARD SingeResult singe_sim_add_source(SingeSim *sim, const SingeSourceDef *def, SingeSourceId *id);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_remove_source(SingeSim *sim, SingeSourceId id);
/// Sets the callback of a callback source, which is necessary after a load; NULL: no heat. `context` must outlive it.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_source_callback(SingeSim *sim, SingeSourceId id,
                                                                    SingeFluxFn *callback, void *context);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_add_collider(SingeSim *sim, const SingeColliderDef *def,
                                                             SingeColliderId *id);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_remove_collider(SingeSim *sim, SingeColliderId id);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_add_pin(SingeSim *sim, const SingePinDef *def, SingePinId *id);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_remove_pin(SingeSim *sim, SingePinId id);
/// Replaces the path of a source that has a position (ball, spot, jet, vortex, attract), a collider or a pin. Times are
/// simulation time, in s, and increase. The particles of a pin follow the new path from their present positions.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_move_source(SingeSim *sim, SingeSourceId id, uint32_t path_count,
                                                            const SingePoseKey *path);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_move_collider(SingeSim *sim, SingeColliderId id, uint32_t path_count,
                                                              const SingePoseKey *path);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_move_pin(SingeSim *sim, SingePinId id, uint32_t path_count,
                                                         const SingePoseKey *path);
/// Sets the positions of a deforming collider's vertices at `time` (s of the simulation): vertices[3 * vertex_count of
/// its Def], m in its own frame, each within 1e4. The vertices move there in straight lines at constant velocity, and
/// stay. A host calls it before the steps of each frame, with the time of the frame's end. If `time` is not later than
/// now, the vertices are there at once, without a velocity. The mesh must not intersect itself; triangles may have no
/// area.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_collider_vertices(SingeSim *sim, SingeColliderId id,
                                                                      const float *vertices, double time);
/// Sets the positions of a pin's particles at `time`, instead of a path: positions[3 * count of
/// singe_sim_pin_particles], m, in that order. They move as above; singe_sim_move_pin sets a path again. The first call
/// for a pin allocates. SINGE_ERROR_STATE before the commit.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_pin_positions(SingeSim *sim, SingePinId id, const float *positions,
                                                                  double time);
/// The indices of the *count particles that a pin holds, increasing: vertices and, for a pin of points with a radius,
/// centres of cells. NULL and 0 for a stale handle and before the commit. Valid until the pin is removed.
SINGE_API const uint32_t *singe_sim_pin_particles(const SingeSim *sim, SingePinId id, uint32_t *count);

/// The handles of all objects of a kind. Writes at most `capacity` of them, in the order of their slots, and returns
/// the number of objects. `ids` may be NULL if `capacity` is 0. Handles are the same after a load.
SINGE_API uint32_t singe_sim_sheets(const SingeSim *sim, SingeSheetId *ids, uint32_t capacity);
SINGE_API uint32_t singe_sim_sources(const SingeSim *sim, SingeSourceId *ids, uint32_t capacity);
SINGE_API uint32_t singe_sim_colliders(const SingeSim *sim, SingeColliderId *ids, uint32_t capacity);
SINGE_API uint32_t singe_sim_pins(const SingeSim *sim, SingePinId *ids, uint32_t capacity);

/// The caller's pointer of an object: `user_data` of its Def, or the last one set. The library never dereferences it.
/// It is not saved: it is NULL after a load. A clone has the same pointer. NULL for a stale handle.
SINGE_API void *singe_sim_sheet_user_data(const SingeSim *sim, SingeSheetId id);
SINGE_API void *singe_sim_source_user_data(const SingeSim *sim, SingeSourceId id);
SINGE_API void *singe_sim_collider_user_data(const SingeSim *sim, SingeColliderId id);
SINGE_API void *singe_sim_pin_user_data(const SingeSim *sim, SingePinId id);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_sheet_user_data(SingeSim *sim, SingeSheetId id, void *user_data);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_source_user_data(SingeSim *sim, SingeSourceId id, void *user_data);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_collider_user_data(SingeSim *sim, SingeColliderId id,
                                                                       void *user_data);
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_pin_user_data(SingeSim *sim, SingePinId id, void *user_data);

/// Replaces the wind from the next step on. May be called at any time.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_wind(SingeSim *sim, const SingeWindDef *def);

// Setters take effect from the next step on. They may be called at any time, also before the commit.

/// m/s2, each -10000 to 10000. SINGE_ERROR_STATE: there is gas, and the largest component changes.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_gravity(SingeSim *sim, const float gravity[3]);
/// Seconds of fire per second of motion, 1e-6 to 1e6.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_pace(SingeSim *sim, float pace);
/// K, 1 to 10000. The heat ledger continues; stored heat then counts from the new temperature. Takes the time of a load
/// and, meanwhile, the memory of a second simulation. Earlier arrays of views and events become invalid.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_ambient_temperature(SingeSim *sim, float temperature);
/// Velocities in m/s, each -10000 to 10000, of `count` vertices of a sheet from its `first` on: velocity[3 * count].
/// Vertices made by tears come after those of the mesh (SingeSheetRange). Centres of cells take the mean of their
/// corners; pinned particles keep the motion of their pins. SINGE_ERROR_STATE before the commit.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_velocity(SingeSim *sim, SingeSheetId id, uint32_t first,
                                                             uint32_t count, const float *velocity);
/// Changes the material of a region: share[vertex_count of the sheet's Def] from 0 (unchanged) to 1 (*def), linear in
/// between; NULL is 1 everywhere. Cells take the mean of their corners. Two kinds of parameters do not change:
/// grammage, specific_heat, thickness and temperature, and those that a sheet has only one of (heat_operator,
/// thickening, reference_grammage, ablate). Parameters cannot follow attributes here. Takes the time of a load and,
/// meanwhile, the memory of a second simulation. Earlier arrays of views and events become invalid.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_set_material(SingeSim *sim, SingeSheetId id,
                                                             const SingeMaterialDef *def, const float *share);

/// One step of length time_step: heat, burn, ablate, dynamics, tears, gas. Allocates nothing, unless the lists of contact
/// must grow. On failure the simulation is unchanged and the error names stage and element: SINGE_ERROR_DIVERGED,
/// SINGE_ERROR_MEMORY if a list cannot grow, or SINGE_ERROR_STATE before the commit.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_step(SingeSim *sim);

/// Makes as many steps as fit in `seconds` (0 to 1e6) plus the remainder of earlier calls. The rest, less than one
/// step, is the new remainder; snapshots include it. A remainder within 1 % of a step counts as a step. At most
/// `steps_max` steps are made (0: any number). Whole steps beyond them are dropped: the simulation of a slow host slows
/// down. *steps (may be NULL) is the number of steps made. The first call allocates memory for events;
/// singe_sim_events then returns those of all steps of the call. A failed step ends the call as in singe_sim_step: the
/// steps before it remain, and so does the remaining time, in the remainder.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_advance(SingeSim *sim, double seconds, uint32_t steps_max,
                                                        uint32_t *steps);

/// The remainder of the last singe_sim_advance, s: a renderer may extrapolate positions by it and the velocities. Less
/// than one step, unless that call failed.
SINGE_API double singe_sim_remainder(const SingeSim *sim);

/// Flags of a particle, spring or cell.
enum {
    SINGE_ALIVE = 1,  ///< still part of the shell
    SINGE_PINNED = 2, ///< particle held by a pin
};

/// Read-only arrays of the shell. Pointers stay valid until the simulation is destroyed, or rebuilt by
/// singe_sim_set_ambient_temperature or singe_sim_set_material; contents change with each step.
/// `topology_version` grows whenever something is removed or torn. Sheets that may tear have a reserve:
/// vertices after each sheet's own, and springs after all blue ones. These are not SINGE_ALIVE until a tear
/// uses them; `cells` and `springs` change then, too.
typedef struct SingeView {
    size_t struct_size; ///< bytes that the library has filled in; callbacks get a view by pointer
    double time;        ///< s
    uint64_t step;      ///< steps done
    uint64_t topology_version;
    uint32_t particle_count, vertex_count, cell_count;
    uint32_t spring_count[SINGE_COLOUR_COUNT];
    const float (*position)[4];      ///< [particle_count] m; fourth is unused
    const float (*velocity)[4];      ///< [particle_count] m/s, of the last substep: the next one starts with it
    const float (*rest_position)[4]; ///< [particle_count] m
    const float (*uv)[2];            ///< [particle_count], centres at the mean of their corners
    const float *area;               ///< [particle_count] m2 at rest, of the particle's own layer
    const float *mass;               ///< [particle_count] fraction of the initial mass
    const float *fuel;               ///< [particle_count] 1 unburnt, 0 fully pyrolysed to char and ash
    const float *temperature;        ///< [particle_count] K
    const float *temperature_peak;   ///< [particle_count] K, highest so far
    const float *burn_rate;          ///< [particle_count] 1/s, mass fraction lost per second
    const float *time_ignited;       ///< [particle_count] s, -1 before
    const float *time_burnt;         ///< [particle_count] s, when its mass fell below m_loss, -1 before
    const int32_t *piece;            ///< [particle_count] id of its connected piece, -1 if gone
    const uint8_t *particle_flags;   ///< [particle_count] SINGE_ALIVE, SINGE_PINNED
    const uint8_t *cell_flags;       ///< [cell_count] SINGE_ALIVE
    const uint32_t (*cells)[4];      ///< [cell_count] corners
    const uint32_t (*springs[SINGE_COLOUR_COUNT])[2]; ///< [spring_count[c]] ends
    const float *spring_length[SINGE_COLOUR_COUNT];   ///< [spring_count[c]] m, target length, eq 6
    const float *spring_rest[SINGE_COLOUR_COUNT];     ///< [spring_count[c]] m, initial length
    const uint8_t *spring_flags[SINGE_COLOUR_COUNT];  ///< [spring_count[c]] SINGE_ALIVE
    /// [cell_count] N/m, line force that decides on tears, in rest coordinates: xx, yy, zz, yz, zx, xy; NULL if sheets
    /// cannot tear
    const float (*line_force)[6];
    const int32_t *source_vertex; ///< [vertex_count] of the input, numbered over all sheets; -1: new, or in reserve
} SingeView;

/// The indices of a sheet's elements in the arrays of a view. They never change during the simulation's life: vertex v
/// of the sheet's Def is particle vertex_first + v, cell c is cell cell_first + c, and its centre is particle
/// centre_first + c. Tears take vertices from the sheet's reserve, in order, from vertex_first + vertex_count on. Each
/// has the source_vertex of the vertex that it was split from.
typedef struct SingeSheetRange {
    size_t struct_size;
    uint32_t vertex_first, vertex_count; ///< vertices of the sheet's Def
    uint32_t torn_count;                 ///< vertices taken from the reserve so far
    uint32_t reserve_count;              ///< vertices of the reserve
    uint32_t cell_first, cell_count;
    uint32_t centre_first;
} SingeSheetRange;

/// Fills `struct_size` bytes, the caller's sizeof; all 0 before the commit and for a stale handle.
SINGE_API void singe_sim_read_sheet_range(const SingeSim *sim, SingeSheetId id, SingeSheetRange *range,
                                          size_t struct_size);

static inline SingeSheetRange singe_sim_sheet_range(const SingeSim *sim, SingeSheetId id) {
    SingeSheetRange range;
    singe_sim_read_sheet_range(sim, id, &range, sizeof range);
    return range;
}

/// The view of a committed simulation; before the commit all counts are 0 and all arrays NULL. Fills `struct_size`
/// bytes, the caller's sizeof.
SINGE_API void singe_sim_read_view(const SingeSim *sim, SingeView *view, size_t struct_size);

static inline SingeView singe_sim_view(const SingeSim *sim) {
    SingeView view;
    singe_sim_read_view(sim, &view, sizeof view);
    return view;
}

typedef enum SingeEventKind {
    SINGE_EVENT_IGNITED = 0,     ///< element is the particle
    SINGE_EVENT_HOLE_OPENED = 1, ///< element is the particle that burnt through first
    SINGE_EVENT_PIECE_FREED = 2, ///< element is the new piece's id
} SingeEventKind;

typedef struct SingeEvent {
    SingeEventKind kind;
    int32_t element;
    double time;       ///< s
    float position[3]; ///< m
} SingeEvent;

/// The events of the last step, or of all steps of the last singe_sim_advance, *count of them. The simulation owns
/// them; they are valid until the next step. Events are not saved: there are none after a load or in a clone.
SINGE_API const SingeEvent *singe_sim_events(const SingeSim *sim, size_t *count);

typedef enum SingeStage {
    SINGE_STAGE_HEAT = 0,
    SINGE_STAGE_BURN = 1,
    SINGE_STAGE_ABLATE = 2,
    SINGE_STAGE_DYNAMICS = 3,
    SINGE_STAGE_GAS = 4,
    SINGE_STAGE_COUNT = 5
} SingeStage;

/// Seconds and work per stage since the commit (or load).
typedef struct SingeTimers {
    double seconds[SINGE_STAGE_COUNT];
    uint64_t steps;
    uint64_t heat_iterations;   ///< of the implicit diffusion
    uint64_t strands_projected; ///< strands times projections
    uint64_t contacts;          ///< of particles with colliders, summed over substeps
    // of the stage dynamics, the projection of springs alone
    double projection_seconds;
    uint64_t springs_projected;     ///< springs times projections
    uint64_t projection_iterations; ///< of the conjugate gradients
    double projection_flops;        ///< floating-point operations by the source; a division or root counts as one
    double projection_bytes;        ///< bytes read and written by the source, as with a cold cache
    // of the stage dynamics, contact of sheets with themselves and each other
    double contact_seconds;
    uint64_t contact_searches;   ///< of the broad phase
    uint64_t contact_repulsions; ///< pairs of points that a substep pushed apart
    uint64_t contact_stops;      ///< pairs of cells stopped by continuous collision detection (CCD)
    uint64_t contact_unresolved; ///< pairs that CCD could not separate: pins hold both
    uint64_t contact_dropped;    ///< pairs beyond the capacity of the lists, not checked
    uint64_t contact_pairs;      ///< pairs of cells that the broad phase found, summed over steps
    uint64_t contact_halts;      ///< steps in which CCD's work reached its bound, so that all sheets stood still
    uint64_t contact_rounds;     ///< of CCD: how often it has moved what it had found to collide
    uint64_t contact_looks;      ///< pairs of cells that CCD checked again, as a round had moved one of them
    double contact_find_seconds; ///< of contact_seconds: finding what is near as a step opens
    double contact_push_seconds; ///< pushing it apart in the substeps
    double contact_stop_seconds; ///< CCD
} SingeTimers;

/// All 0 before the commit. Fills `struct_size` bytes, the caller's sizeof.
SINGE_API void singe_sim_read_timers(const SingeSim *sim, SingeTimers *timers, size_t struct_size);

static inline SingeTimers singe_sim_timers(const SingeSim *sim) {
    SingeTimers timers;
    singe_sim_read_timers(sim, &timers, sizeof timers);
    return timers;
}

/// A ledger closes while its error is at most this. Sound runs stay below 1e-5.
#define SINGE_LEDGER_BOUND 1e-3

/// Statistics of the present state, computed by the call that reads them.
typedef struct SingeStats {
    double time;                                                ///< s
    uint32_t particles, springs, cells;                         ///< that are alive
    uint32_t pieces;                                            ///< connected components
    double mass;                                                ///< kg, remaining
    double mass_initial;                                        ///< kg
    double mass_burnt;                                          ///< kg, gone as gas, eq 4
    double mass_removed;                                        ///< kg, of removed particles
    double burnt_fraction;                                      ///< mass_burnt + mass_removed over mass_initial
    float temperature_max;                                      ///< K
    double heat_in, heat_lost, heat_of_combustion, heat_stored; ///< J, cumulative; see docs/equations/heat.md
    double ledger_error;      ///< |in + combustion - lost - stored| over the largest of them
    double mass_ledger_error; ///< |initial - left - burnt - removed| / initial
    /// |length/target - 1| of the mesh's edges (blue springs) that are at least partly drawn and not pinned at both
    /// ends.
    double strain_mean, strain_p99, strain_max;
    uint32_t inverted_cells;     ///< centre not in front of its corners; 0 unless solver.height_min is 0
    uint32_t intersecting_cells; ///< intersecting or coincident initially, and not separated since
    double speed_rms_unburnt;    ///< m/s, of particles never ignited and not pinned
    float thickening;            ///< F in use, max over the sheets
    /// m/s of the fire's time: median of 1/|grad time_ignited| over fully ignited cells.
    double front_speed;
    uint32_t tears; ///< vertices that tears have split
    /// Whether both ledger errors are at most SINGE_LEDGER_BOUND. They exceed it if steps of fire are so short that
    /// temperatures change by less than a float's last digit: rounding is correct only on average.
    bool ledgers_close;
    /// s, of the arrival maps that are active: the error of the time of ignition that 95 % of the particles do not exceed,
    /// of those that have ignited; 0 without a map.
    double arrival_error;
    uint32_t arrival_missed; ///< particles that are more than a step late, or have ignited where the map says never
    float pace;              ///< in use
    double water;            ///< kg, in the sheets
    /// J, of what is left: of motion; of springs that give; of heights above the positions at rest.
    double energy_kinetic, energy_elastic, energy_gravity;
    /// J, what these three have lost since the start: to damping, air, friction and the solver, with the mass that has
    /// gone, less what pins, colliders, wind and the fire have put in. It is the remainder, their sum at the start less
    /// that of now: dissipation is not measured by itself, and errors of the three are in it. Below 0 where more has
    /// been put in than lost, as by a sheet that shrinks.
    double energy_lost;
} SingeStats;

/// Fills `struct_size` bytes, the caller's sizeof.
SINGE_API void singe_sim_read_stats(const SingeSim *sim, SingeStats *stats, size_t struct_size);

static inline SingeStats singe_sim_stats(const SingeSim *sim) {
    SingeStats stats;
    singe_sim_read_stats(sim, &stats, sizeof stats);
    return stats;
}

/// Counts of a committed simulation's elements.
typedef struct SingeCounts {
    uint32_t particles, cells, springs[SINGE_COLOUR_COUNT], strands[SINGE_COLOUR_COUNT], families[SINGE_COLOUR_COUNT];
    double mean_strand_length;      ///< springs per strand
    float cell_size;                ///< m, median edge, averaged over the sheets
    size_t memory;                  ///< bytes held from the allocator
    SingeInstructions instructions; ///< in use; never SINGE_INSTRUCTIONS_BEST
} SingeCounts;

/// Fills `struct_size` bytes, the caller's sizeof.
SINGE_API void singe_sim_read_counts(const SingeSim *sim, SingeCounts *counts, size_t struct_size);

static inline SingeCounts singe_sim_counts(const SingeSim *sim) {
    SingeCounts counts;
    singe_sim_read_counts(sim, &counts, sizeof counts);
    return counts;
}

/// Draws the present state into *surface, which grows as needed. Before its first use the caller zeroes it, and may set
/// its allocator; a zeroed allocator is libc's. After SINGE_ERROR_MEMORY it has no vertices and triangles, and can be
/// used again. `struct_size` is the caller's sizeof; SINGE_ERROR_ARGUMENT: it is smaller than that of version 0.2.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_draw(SingeSim *sim, SingeSurface *surface, size_t struct_size);

SINGE_NODISCARD static inline SingeResult singe_sim_surface(SingeSim *sim, SingeSurface *surface) {
    return singe_sim_draw(sim, surface, sizeof *surface);
}

/// Draws a mesh in place of a sheet from now on (SingeRenderMeshDef), beside other meshes that the sheet may have. The
/// caller may free its arrays after the call. The simulation frees the mesh; it is in no snapshot, recording or clone:
/// add it to those again. SINGE_ERROR_STATE before the commit; SINGE_ERROR_MESH with the vertex or triangle in
/// `element`: damaged, without triangles, or too far from the sheet; SINGE_ERROR_ARGUMENT; SINGE_ERROR_LIMIT for more
/// than 16,777,216 triangles; SINGE_ERROR_MEMORY.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_add_render_mesh(SingeSim *sim, SingeSheetId sheet,
                                                                const SingeRenderMeshDef *def);

/// The present gas. The simulation owns the arrays, whose contents change with each step. Fills `struct_size` bytes,
/// the caller's sizeof.
SINGE_API void singe_sim_read_gas(const SingeSim *sim, SingeGas *gas, size_t struct_size);

static inline SingeGas singe_sim_gas(const SingeSim *sim) {
    SingeGas gas;
    singe_sim_read_gas(sim, &gas, sizeof gas);
    return gas;
}

/// Saves the whole simulation. *bytes comes from the simulation's allocator; free it with singe_sim_free_bytes, before
/// the simulation is destroyed. Versioned and checksummed; the byte order is the machine's. SINGE_ERROR_STATE before
/// the commit.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_save(SingeSim *sim, uint8_t **bytes, size_t *size);
SINGE_API void singe_sim_free_bytes(SingeSim *sim, uint8_t *bytes, size_t size);

/// Makes a simulation from saved bytes. Its steps have the same bits as those of the saved simulation. Hooks and
/// thread count come from `hooks`, all else from the bytes, which may be freed afterwards. Handles keep their values.
/// On failure *sim is NULL and *error (may be NULL) says why: SINGE_ERROR_VERSION for another version or machine,
/// SINGE_ERROR_FORMAT for damaged bytes, SINGE_ERROR_MEMORY.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_load(const SingeSimDef *hooks, const uint8_t *bytes, size_t size,
                                                     SingeSim **sim, SingeError *error);

/// A second simulation in the same state, with the same hooks and callbacks; it must be destroyed, too. On failure
/// *copy is NULL and singe_sim_error(sim) says why.
SINGE_API SINGE_NODISCARD SingeResult singe_sim_clone(SingeSim *sim, SingeSim **copy);

#ifdef __cplusplus
}
#endif
#endif
