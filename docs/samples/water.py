# Water: one half of the sheet is wet, and the fire stops there.
#
# Prints:
#   dry half: burnt; wet half: not
import singe

import sample

# dry at the left, wet at the right; kg of water a kg of paper
wet = {"moisture": singe.Vary(0.06, 1.5, texture=[[0, 1]])}
sim = sample.fire()
sim.sheet(*sample.square(0.15, 16, 0.001), material=wet)
sim.collider("plane")
sample.match(sim, -0.06, 0, 0)
sim.commit()
sim.advance(2.5)
x = sim.rest_position[:, 0]
dry, damp = sim.mass[x < -0.03].mean(), sim.mass[x > 0.03].mean()
print(f"dry half: {'burnt' if dry < 0.6 else 'not'}; wet half: {'not' if damp > 0.95 else 'burnt'}")
