# A fold that stays: with creases, paper that was bent sharply does not open again; without, it springs back.
#
# Prints:
#   elastic: flat again
#   creased: still folded
import numpy as np

import sample

angles = np.linspace(0, 2.4, 9)  # about the y axis, through the middle
zero = np.zeros(9)
fold = np.column_stack([0.05 * np.arange(9), zero, zero, zero, zero, -np.sin(angles / 2), zero, np.cos(angles / 2)])
for creases in (False, True):
    sim = sample.fire(gravity=(0, 0, 0), solver={"creases": creases, "substeps": 0})
    strip = sim.sheet(*sample.square(0.08, 16),
                      material={"bending": 1e-3, "thickness": 3e-3, "damping": 5, "crease_radius": 0.05})
    sample.pin(sim, strip, -0.08, 0, 0, radius=0.06)  # the left half is held
    # the right edge is folded over it, and let go
    sim.pin(strip, points=[(0.06, 0, 0)], radius=0.045, path=fold, end=0.5)
    sim.commit()
    sim.advance(1.5)
    edge, middle = sim.position[16], sim.position[11]  # along the first row
    angle = np.degrees(np.arctan2(edge[2] - middle[2], middle[0] - edge[0]))
    print(f"{'creased' if creases else 'elastic'}: {'flat again' if abs(angle) > 140 else 'still folded'}")
