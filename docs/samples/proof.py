# A material changes while it burns: one half is made fireproof, and the fire stops there.
#
# Prints:
#   the dry half burns on, the proofed half went out
import numpy as np

import sample

SIDE = 25
sim = sample.fire()
sheet = sim.sheet(*sample.square(0.15, SIDE - 1, 0.001))
sim.collider("plane")
sample.match(sim, 0, 0, 0)
sim.commit()
sim.advance(0.5)
share = np.arange(SIDE * SIDE) % SIDE >= SIDE // 2  # of each vertex: 0 as it was, 1 the new material
sheet.set_material({"ignition_temperature": 5000, "char_rate": 0}, share)  # nothing lights it
sim.advance(0.7)
burning, right = sim.burn_rate > 0.01, sim.rest_position[:, 0] > 0.004
dry, proofed = (burning & ~right).sum() > 10, (burning & right).any()
print(f"the dry half {'burns on' if dry else 'went out'}, the proofed half {'burns on' if proofed else 'went out'}")
