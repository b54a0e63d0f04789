// Scratch memory of the dynamics, and the parts of its step. Nothing outside src/dynamics includes this.
#pragma once

#include "dynamics/attach.h"
#include "dynamics/brace.h"
#include "dynamics/dynamics.h"
#include "dynamics/height.h"
#include "dynamics/move.h"
#include "dynamics/plane.h"
#include "dynamics/smooth.h"
#include "dynamics/solver.h"
#include "dynamics/strand/strand_lanes.h"

#include <stdatomic.h>

/// A collider at the two ends of a substep, and a box about it that turns with it: a point outside the box is not in
/// contact, whatever the shape. A plane's box is infinite except along its normal.
typedef struct MovingCollider {
    const Collider *collider;
    bool is_simple; ///< a sphere, box or capsule: four particles at once
    bool is_still;  ///< before and after are the same
    Pose before, after;
    Float3 axis[3];                    ///< of the box, which has `after.position` for its origin
    float low[3], high[3];             ///< m
    int ends;                          ///< first axis along which the box has ends
    float world_low[4], world_high[4]; ///< m, the box along the world's axes; the fourth: no bound
    float drift; ///< m, max displacement of its surface in its frame: 0 except for a deforming mesh
} MovingCollider;

/// The loops that have a version for each instruction set.
typedef struct Kernels {
    StrandSolve *solve;
    AttachHold *hold;
    StrandBend *bend;
    MoveRange *move;
    UnitRange *unit;
    PlaneRange *plane;
    HeightRange *height;
    SmoothGroup *smooth;
    CollisionOpen *open;
    RepulsionApply *push;
    CcdApply *stop;
    SingeInstructions instructions;
} Kernels;

/// The loops for these instructions, or NULL if the processor lacks them (strand_kernels.c).
const Kernels *kernels_choose(SingeInstructions instructions);

/// The strands of all colours, and scratch for the threads that solve them.
typedef struct Strands {
    StrandSet sets[SINGE_COLOUR_COUNT];
    StrandSolve *solve;
    uint32_t longest; ///< rows
    int room_count;   ///< 1 to 64 threads that may solve at once
    float *keep;      ///< room_count times STRAND_KEEP (longest + 1) STRAND_LANES
    _Atomic uint64_t taken;
    bool started; ///< this substep has a start
    bool opens;   ///< the colour that is projected is a substep's first
} Strands;

/// A spring that a tear has removed from its strand, or made (patch.c).
typedef struct Patch {
    uint32_t spring, a, b;
    float length, weight, compliance;
    float pull; ///< sum of mu in this step
} Patch;

/// The patches of all colours. Empty where sheets cannot tear.
typedef struct Patches {
    uint32_t capacity; ///< of each list
    uint32_t count[SINGE_COLOUR_COUNT];
    Patch *items[SINGE_COLOUR_COUNT];
    uint32_t split_count;            ///< of the shell when they were listed
    float *pull[SINGE_COLOUR_COUNT]; ///< [springs] N/m, as in patch.c, of the step done
} Patches;

typedef struct Paper Paper;

enum { PLATE_LIMIT = 256 };

/// A free piece that falls (plates.c).
typedef struct Plate Plate;

/// The edge between two cells that a green spring joins, at rest (crease.c).
typedef struct Hinge {
    uint8_t side[2]; ///< which side of the cell at each of the spring's ends it is
    float arc;       ///< m, s, from centroid to centroid along the sheet
    float angle;     ///< rad, theta_0
    float twist;     ///< rad, tau_0
    float max;       ///< rad, beta
    float lean;      ///< rad, phi
    float limit;     ///< 1/m, the sharpest bend that creases: curvature_max, INFINITY if none
} Hinge;

struct DynamicsPlan {
    DynamicsSettings settings;
    const Solver *solver;
    // per particle, refreshed at every step
    float *inverse_mass;   ///< 1/kg; 0 if pinned or gone
    _Atomic bool held;     ///< some that are not gone have 0
    float (*normal)[4];    ///< unit; fourth: 1/m, k of the quadratic drag, dv/dt = -k |v_n| v_n
    float (*air)[4];       ///< m/s, the wind there; fourth: 1/s, damping. Of particle i & air_mask
    uint32_t air_mask;     ///< UINT32_MAX, or 0: the same everywhere, in the first four
    float (*predicted)[4]; ///< m, x~ of eq 9
    float (*start)[4];     ///< m, s of move.c; NULL: none
    float (*given)[4];     ///< m, g of move.c; NULL without a start
    const Kernels *kernels;
    float *soft;     ///< factor on the weight of a spring that ends here: 1 fresh, char_weight at m_min
    Strands strands; ///< of the strand solver
    Braces *braces;  ///< NULL unless bending is isotropic
    Paper *paper;    ///< of the paper's methods
    Patches patches;
    bool written; ///< what dynamics_prepare writes, in a step that succeeded
    Attachments attachments;
    CollisionPlan *collision; ///< NULL without contact of sheets
    Hinge *hinges;            ///< [green springs], or NULL without creases
    bool creased;             ///< there are creases after the last step
    Plate *plates;            ///< [PLATE_LIMIT], of which plate_count are in use during a step
    uint16_t *plate_slot;     ///< [particles] by piece: 1 + its plate, 0 between steps
    uint32_t plate_count;
    uint32_t *reach[2];      ///< [strands] of blue and green: springs in a smoothing_length; 0: fewer than two
    uint8_t *height_wait;    ///< [height_wait_count] substeps for which a block of cells is skipped
    float (*cell_normal)[4]; ///< unit times twice the area; before and after substeps, where `predicted` has centres
    MovingCollider *colliders;
    uint32_t collider_capacity;
    double *partial; ///< [pool_blocks(particles or springs of a colour)]
    uint32_t particle_count, cell_count, spring_count[SINGE_COLOUR_COUNT];
};

/// Inverse masses, weights, normals, drag and wind for this step (prepare.c).
void dynamics_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, const SingeWindDef *wind,
                      const SourceList *sources, Pool *pool, DynamicsState *dynamics);

/// Makes room for the plates; false when out of memory.
bool plates_create(Memory *memory, DynamicsPlan *plan);
void plates_free(Memory *memory, DynamicsPlan *plan);

/// Lift, friction and turning of free pieces in h seconds of air (plates.c).
void dynamics_fly(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, double time, float h,
                  DynamicsState *dynamics);

/// The stages for each particle between two projections (move.c).
typedef struct Between {
    uint32_t collider_count; ///< in plan->colliders, for contact
    bool closes;             ///< eq 13 of the last substep
    bool opens;              ///< eq 8 and 9 of the next substep
    bool attaches;           ///< to sources at their positions in the next substep
} Between;

/// One pass over the particles. Returns the number of contacts.
uint64_t dynamics_move(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h, const Between *between,
                       DynamicsState *dynamics);

/// Whether contact may move particles before that pass. Then their starts are kept before contact (move.c).
static inline bool dynamics_keeps_start(const DynamicsPlan *plan, uint32_t collider_count) {
    return plan->start && (plan->collision || collider_count > 0);
}
void dynamics_keep_start(DynamicsPlan *plan, Pool *pool, DynamicsState *dynamics);

/// Puts pinned particles on their paths (move.c).
void dynamics_move_pins(DynamicsPlan *plan, const PinList *pins, const AblateState *ablate, double time, float h,
                        DynamicsState *dynamics);

/// One projection of one colour, family after family (strand_solver.c).
void strand_project(DynamicsPlan *plan, SingeColour colour, Pool *pool, float h, DynamicsState *dynamics,
                    DynamicsCounters *counters);

/// Room for the limits of bends, where a material has one (curvature.c). False when out of memory.
bool curvature_create(Memory *memory, const Shell *shell, bool isotropic, Strands *strands);
/// Once a step: the limits at the springs [from, to) of a strand, after its weights.
void curvature_prepare(const Shell *shell, const StateInput *state, SingeColour colour, uint32_t strand, uint32_t from,
                       uint32_t to, StrandSet *set);
/// Straightens bends that are sharper than the material's curvature_max.
void curvature_project(const DynamicsPlan *plan, Pool *pool, DynamicsState *dynamics);

bool patches_create(Memory *memory, const Shell *shell, Patches *patches);
void patches_free(Memory *memory, const Shell *shell, Patches *patches);
/// Once a step: if tears have changed the shell (then true), finds the springs that are no longer in a strand, ...
bool patch_follow(DynamicsPlan *plan, const Shell *shell);
/// ... takes over their weights and lengths, and starts to sum.
void patch_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state);
/// Whether a spring is still in its strand, from the lanes themselves: its ends are the nodes of its slot.
static inline bool patch_is_in_strand(const DynamicsPlan *plan, const Shell *shell, SingeColour colour, uint32_t spring,
                                      size_t slot) {
    const uint32_t *node = plan->strands.sets[colour].node + slot, *ends = shell->springs[colour].ends[spring];
    return node[0] == 4 * ends[0] && node[STRAND_LANES] == 4 * ends[1];
}
/// Projects a colour's patches one by one.
void patch_project(DynamicsPlan *plan, SingeColour colour, const StrandJob *job);
/// The forces of the step's substeps of h seconds, in plan->patches.pull.
void patch_gather(DynamicsPlan *plan, const Shell *shell, Pool *pool, float h);

/// Bytes of height_wait.
size_t height_wait_count(const Shell *shell);

/// Keeps every centre above its cell's corners (layer_order.c).
void height_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics);

/// How many springs smoothing_length spans, in plan->reach. False when out of memory.
bool smooth_create(Memory *memory, const Shell *shell, DynamicsPlan *plan);
/// Internal friction of both layers over a step of h seconds (smooth.c).
void dynamics_smooth(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool, float h,
                     DynamicsState *dynamics);

/// Shortens sides and diagonals that a step has left far too long (limit.c). True if it has found any.
bool dynamics_limit(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                    DynamicsState *dynamics);

/// Moves centres that have crossed their corners back over them: the last pass of a step (layer_order.c).
void dynamics_order(const DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics);

/// Geometry of all hinges at rest (crease.c).
void creases_measure(const Shell *shell, Hinge *hinges);

/// Makes bending beyond the crease radius partly plastic, for the steps to come.
void dynamics_crease(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool, float h,
                     DynamicsState *dynamics);

/// Target length of a green spring with a crease of `stays` rad, over that without, when it is bent to `now` rad.
float crease_ratio(const Hinge *hinge, float stays, float now);

/// The same of a green spring now; 1 without a crease.
float crease_factor(const DynamicsPlan *plan, const Shell *shell, const StateInput *state,
                    const DynamicsState *dynamics, uint32_t green);

/// Share of a green spring's crease that burning has left.
float crease_kept(const Shell *shell, const StateInput *state, uint32_t green);

/// A collider between two times of a substep.
MovingCollider contact_collider(const Collider *collider, double before, double after);

/// W (eq 19) of a spring from a to b that is not gone: the mean of its ends' material weights, times that of their
/// softness.
static inline float dynamics_weight(Field material, const float *soft, uint32_t a, uint32_t b) {
    return 0.25f * (field_at(material, a) + field_at(material, b)) * (soft[a] + soft[b]);
}

/// Contact and friction of particles [begin, end) with the colliders in plan->colliders (collider_contact.c). Returns
/// the number of contacts.
uint64_t contact_range(const DynamicsPlan *plan, uint32_t collider_count, float h, DynamicsState *dynamics, int begin,
                       int end);

/// Contact and friction of one position, which was at `previous` when the substep began, at `offset` from the surface;
/// false without contact.
bool contact_particle(const MovingCollider *collider, float offset, Float3 previous, float *position);

/// Contact of a cell's centroid, between its corners (collider_contact.c).
void contact_centroids(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, uint32_t collider_count,
                       Pool *pool, float h, DynamicsState *dynamics);

/// contact_range for all particles.
uint64_t contact_project(DynamicsPlan *plan, uint32_t collider_count, Pool *pool, float h, DynamicsState *dynamics);
