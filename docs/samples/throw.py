# Thrown: a sheet that burns gets a velocity, all of it or some of its vertices, when the host says so.
#
# Prints:
#   thrown up: 110 mm after 0.2 s
import numpy as np

import sample

SIDE = 17
x = np.arange(SIDE * SIDE) % SIDE / (SIDE - 1) - 0.5
velocity = np.stack([0 * x, 0 * x, 1.6 + 1.2 * x], axis=1)  # m/s: up, and turning over

sim = sample.fire()
card = sim.sheet(*sample.square(0.1, SIDE - 1, 0.001), material={"drag": 0})
sim.collider("plane")
sample.match(sim, 0.05, 0, 0)
sim.commit()
sim.advance(0.4)
card.set_velocity(velocity)
sim.advance(0.2)
print(f"thrown up: {10 * round(100 * sim.position[card.vertices, 2].mean())} mm after 0.2 s")
