# A hand takes hold: the host says every frame where a pin's particles are, as a player's controller does.
#
# Prints:
#   the corner follows the hand within 0.1 mm
import numpy as np

import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.12, 20, 0.001))
sim.collider("plane")
sim.commit()
sim.advance(0.1)
hand = sample.pin(sim, sheet, 0.06, 0.06, 0, radius=0.012)  # now, in the middle of things
place = sim.position[hand.particles].copy()
for frame in range(1, 25):
    place += np.float32([-0.04 / 24, -0.04 / 24, 0.06 * np.cos(0.1 * frame) / 24])  # up, and back over the sheet
    hand.set_positions(place, sim.time + 1 / 24)
    sim.advance(1 / 24)
off = np.abs(sim.position[hand.particles, 2] - place[:, 2]).max()
print(f"the corner follows the hand {'within' if off < 1e-4 else 'by more than'} 0.1 mm")
