# A click lights it: the ray of a mouse meets the sheet, and a match burns where it does.
#
# Prints:
#   the ray meets the sheet 300 mm away
#   there it burns
import numpy as np

import sample

sim = sample.fire()
sim.sheet(*sample.square(0.15, 20, 0.001))
sim.collider("plane")
sim.commit()
sim.advance(0.1)

eye, ray = np.array([0.02, -0.18, 0.241]), np.array([0, 0.6, -0.8])
surface = sim.surface()
a, b, c = (surface.position[surface.triangles[:, k]].astype(float) for k in range(3))
p, q = np.cross(ray, c - a), np.cross(eye - a, b - a)
det = ((b - a) * p).sum(axis=1)
u, v = ((eye - a) * p).sum(axis=1) / det, (ray * q).sum(axis=1) / det
far = ((c - a) * q).sum(axis=1) / det
near = far[(u >= 0) & (v >= 0) & (u + v <= 1) & (far > 0)].min()
print(f"the ray meets the sheet {10 * round(100 * near)} mm away")

sim.spot(eye + near * ray, radius=0.01, falloff=0.01, temperature=1123, start=sim.time, end=sim.time + 0.4)
sim.advance(0.5)
print(f"there it {'burns' if sim.stats()['temperature_max'] > 900 else 'does not burn'}")
