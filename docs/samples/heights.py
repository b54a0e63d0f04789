# A landscape: cotton falls onto a height field, a grid of heights.
#
# Prints:
#   it lies on the hills, at most 3 mm above them
import numpy as np

import sample

NODES, SIDE = 41, 0.2


def hill(x, y):
    return 0.012 * (np.sin(50 * x) * np.cos(50 * y) + 1)


along = SIDE * (np.arange(NODES) / (NODES - 1) - 0.5)
sim = sample.fire()
cloth = sim.sheet(*sample.square(0.15, 22, 0.04), material={"base": "cotton", "damping": 4})
sim.collider("heightfield", heights=hill(along[None, :], along[:, None]), size=[SIDE, SIDE])  # [rows, columns]
sim.commit()
sim.advance(0.5)
x, y, z = sim.position[cloth.vertices].T
near = (z - hill(x, y) < 0.003).mean() > 0.5
print(f"it lies on the hills, {'at most 3 mm above them' if near else 'and hovers'}")
