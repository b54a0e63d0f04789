// Checks of a simulation that was read back: everything that stages and public functions rely on, whoever wrote the
// bytes.
#pragma once

#include "sim/sim_internal.h"

/// Whether points in motion have finite positions and finite times.
bool snapshot_motion_fits(const Motion *motion);

/// Whether an advance can have left such a remainder.
bool snapshot_remainder_fits(const SingeSim *sim);

/// Whether all generations of objects were given out.
bool snapshot_generations_fit(const SingeSim *sim);

/// Whether a pin's particles are in order and exist, and its anchors are positions.
bool snapshot_pin_fits(const Shell *shell, const Pin *pin);

/// Whether the State is one that steps can leave, for the torn shell and the present pins. Target lengths and the slots
/// of lanes without a strand follow from other data: they are set to that.
bool snapshot_state_fits(SingeSim *sim);
