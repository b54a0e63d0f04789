# A brand: heat drawn as a picture, here a ring, and turned up and down over time.
#
# Prints:
#   peak 1300 K in the ring, 300 K in its middle
import numpy as np

import sample

SIZE = 64
x = np.arange(SIZE) / SIZE - 0.5
ring = np.abs(np.hypot(x[None, :], x[:, None]) - 0.3) < 0.06  # 1: the full flux

sim = sample.fire()
cloth = sim.sheet(*sample.square(0.12, 32, 0.001), material="cotton")
sim.collider("plane")
sim.source("texture", texture=ring, flux=20e3,  # W/m2 into each side
           strength=[(0, 0), (0.1, 1), (0.3, 1), (0.4, 0)])
sim.commit()
sim.advance(0.5)
r = np.hypot(*sim.rest_position[cloth.vertices, :2].T) / 0.12
peak = sim.temperature_peak[cloth.vertices]
inside, middle = peak[np.abs(r - 0.3) < 0.04].mean(), peak[r < 0.15].mean()
print(f"peak {100 * round(inside / 100)} K in the ring, {100 * round(middle / 100)} K in its middle")
