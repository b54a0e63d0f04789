# A material that varies over the sheet: the rate by noise, the grammage by an attribute of the vertices.
#
# Prints:
#   the thin half has burnt more than the thick one
import numpy as np

import singe

import sample

points, faces, uv = sample.square(0.15, 20)
uneven = {"grammage": singe.Vary(0.045, 0.16, attribute="thick"),  # kg/m2
          "mass_rate": singe.Vary(4e-3, 12e-3, noise=(0.02, 4, 1))}

sim = sample.fire()
sim.sheet(points, faces, uv, material=uneven, thick=np.arange(len(points)) % 21 / 20)  # 0 at the left, 1 at the right
sim.collider("plane", position=[0, 0, -0.001])
sample.match(sim, 0, 0, 0)
sim.commit()
sim.advance(1.2)
burnt, right = sim.mass < 0.5, sim.rest_position[:, 0] > 0
more = (burnt & ~right).sum() > (burnt & right).sum()
print(f"the thin half has burnt {'more' if more else 'less'} than the thick one")
