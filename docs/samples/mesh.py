# A mesh of one's own: a cone of triangles becomes a sheet of quads, and burns from its tip.
#
# Prints:
#   608 triangles became 304 cells
#   the tip is vertex 0, at 100 mm
#   after 2 s 7 of 10 burnt
import numpy as np

import sample

AROUND, RINGS = 32, 10
k = np.arange(AROUND * RINGS)
radius, angle = 0.006 * (k // AROUND + 1), 2 * np.pi * (k % AROUND) / AROUND
rings = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.1 - radius], axis=1)
points = np.concatenate([[[0, 0, 0.1]], rings])  # m
here, beside = 1 + k, 1 + k // AROUND * AROUND + (k + 1) % AROUND
above = np.where(k < AROUND, 0, here - AROUND)
outer = k >= AROUND  # faces are counter-clockwise seen from outside
triangles = np.concatenate([np.stack([above, here, beside], axis=1),
                            np.stack([above, beside, beside - AROUND], axis=1)[outer]])

sim = sample.fire()
cone = sim.sheet(points, triangles)
sim.collider("plane", position=[0, 0, 0.04])
sample.match(sim, 0, 0, 0.1)
sim.commit()
print(f"{len(triangles)} triangles became {len(sim.cells)} cells")
tip = cone.became[0]  # vertices may have new numbers
print(f"the tip is vertex {tip}, at {1e3 * sim.position[tip, 2]:.0f} mm")
sim.advance(2)
print(f"after 2 s {10 * sim.stats()['burnt_fraction']:.0f} of 10 burnt")
