// Checks of a simulation that was read back: everything that stages and public functions rely on, whoever wrote the
// bytes.
#ifndef SIM_SNAPSHOT_CHECK_H
#define SIM_SNAPSHOT_CHECK_H

#include "sim/sim_internal.h"

/// Points in motion have finite positions and finite times.
bool snapshot_motion_fits(const Motion *motion);

/// Whether an advance can have left such a remainder.
bool snapshot_remainder_fits(const SingeSim *sim);

/// Objects have generations that were given out.
bool snapshot_generations_fit(const SingeSim *sim);

/// A pin's particles are in order and exist; its anchors are positions.
bool snapshot_pin_fits(const Shell *shell, const Pin *pin);

/// The State holds what steps can leave there, for the shell as it has torn and the pins that there are. Target lengths
/// and the slots of lanes without a strand follow from the rest: they are put as they should be.
bool snapshot_state_fits(SingeSim *sim);

#endif
