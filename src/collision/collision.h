// Contact of sheets with themselves and each other.
//
// The drawn mesh must not cross itself: a cell's four triangles around its virtual centre, the mean of its corners
// (sections 6 and 7 of the paper let layers pass through each other). This part of the dynamics acts twice in a step:
//
//   in every substep   points of two cells that are nearer than the contact thickness are pushed apart, with friction
//                      (repulsion.c)
//   at the step's end  no straight trajectory from the last step's positions to the present ones may pass through
//                      another cell: one that would is stopped before it collides (ccd.c). That is a guarantee, not a
//                      force
//
// Both use pairs of nearby cells. The search for pairs runs again when cells have used up the motion that the last
// search allowed for (broad_phase.c). All lists have a fixed order: the same bytes for any number of threads. A list
// that is too small for its pairs grows (collision_plan.c).
#pragma once

#include "common/stream.h"
#include "common/pool.h"
#include "shell/shell.h"

typedef struct CollisionPlan CollisionPlan;

/// Scratch for the shell; `time_step` in s. SINGE_ERROR_MEMORY. The plan does not keep `memory`, which its owner may move:
/// calls that may grow its lists are given it.
SingeResult collision_plan_create(Memory *memory, const Shell *shell, const SingeContactDef *def, float time_step,
                                  CollisionPlan **plan);
void collision_plan_free(Memory *memory, CollisionPlan *plan);

/// The plan's data of the last search, as part of a snapshot of cells with these flags. SINGE_ERROR_MEMORY when
/// reading; data that does not fit fails the stream.
SingeResult collision_plan_stream(Memory *memory, CollisionPlan *plan, const Shell *shell, const uint8_t *cell_flags,
                                  Stream *stream);

/// Keeps the last search, on which the next steps depend, before a step that may fail; and puts it back if it has.
void collision_plan_keep(CollisionPlan *plan);
void collision_plan_restore(Memory *memory, CollisionPlan *plan, const Shell *shell);

/// Must be called when the corners of cells have changed.
void collision_plan_forget(CollisionPlan *plan);

/// In how many parts the next step is to be taken, so that none moves layers through many others: 1 for all but storms.
int collision_parts(const CollisionPlan *plan);

/// Opens a step or, if h is less than the time step, a part of one, whose particles are at `dynamics`, the inverse masses
/// in place; `first`: no part of this step has gone before. SINGE_ERROR_MEMORY, as ccd_apply: where sheets crowd, lists
/// grow. After an error the step must be rolled back; the next one searches again.
typedef SingeResult CollisionOpen(Memory *memory, CollisionPlan *plan, const Shell *shell, const StateInput *state,
                                  Pool *pool, float h, bool first, const DynamicsState *dynamics);
CollisionOpen collision_open, collision_open_v3;

/// In how many turns a substep pushes points apart: 1, or 2 to 3 where sheets crowd. What a turn has strained is to be
/// mended before the next.
int repulsion_turns(const CollisionPlan *plan);

/// A turn: pushes points apart that are too near, in a substep of h seconds that began at `predicted` less h times the
/// velocities. All but the last turn push too far. False: there were none.
typedef bool RepulsionApply(CollisionPlan *plan, const Shell *shell, Pool *pool, const float (*predicted)[4], float h,
                            bool last, DynamicsState *dynamics);
RepulsionApply repulsion_apply, repulsion_apply_v3;

/// Closes the step: no cell of the drawn mesh has passed through another since collision_open.
typedef SingeResult CcdApply(Memory *memory, CollisionPlan *plan, const Shell *shell, const StateInput *state,
                             Pool *pool, float h, DynamicsState *dynamics);
CcdApply ccd_apply, ccd_apply_v3;

/// Whether a quarter of the work that CCD may do in a step is done.
bool ccd_is_busy(const CollisionPlan *plan);

/// Counts since the plan was made.
typedef struct CollisionCounters {
    uint64_t searches;           ///< for nearby pairs
    uint64_t pairs;              ///< pairs of cells that the last search has found near, summed over steps
    uint64_t repulsions;         ///< pairs of points that a substep had to push apart, summed over substeps
    uint64_t stops;              ///< pairs of cells stopped by CCD
    uint64_t looks;              ///< pairs of cells checked again, as an iteration had moved one of them
    uint64_t unresolved;         ///< pairs that could not be kept apart, as both are held by pins
    uint64_t halts;              ///< steps in which CCD's work reached its bound (ccd.c)
    uint64_t dropped;            ///< pairs, of cells or of points, for which there was no room
    uint32_t intersecting;       ///< cells that have intersected or coincided with others since the start
    uint32_t intersecting_first; ///< the lowest of them
    uint64_t rounds;             ///< in which CCD has moved what it had found to collide
    double find_seconds, push_seconds, stop_seconds;
} CollisionCounters;

CollisionCounters collision_counters(const CollisionPlan *plan);

/// NULL, or which invariant of the plan is broken between two steps (collision_plan.c).
const char *collision_validate(const CollisionPlan *plan);

/// Lowers room[vertices], m, at vertices whose cells have another cell near in the present state, to its distance: the
/// drawn surface deviates from its flat triangles by less than half of that. Searches up to a quarter of a cell.
void collision_clearance(const CollisionPlan *plan, const Shell *shell, const StateInput *state, float *room);
