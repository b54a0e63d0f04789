# Writing with fire: a hot ball on a path, as a pen. A path has times, and is straight in between.
#
# Prints:
#   scorched along the stroke, fresh beside it
import numpy as np

import sample

zigzag = np.array([(-0.06, 0.05), (-0.03, -0.05), (0, 0.05), (0.03, -0.05), (0.06, 0.05)])
sim = sample.fire()
sheet = sim.sheet(*sample.square(0.16, 32, 0.001))
sim.collider("plane")
path = [(0.08 * i, x, y, 0) for i, (x, y) in enumerate(zigzag)]
sim.source("ball", path=path, temperature=1300, conductance=1500, radius=0.004, falloff=0.003, end=path[-1][0])
sim.commit()
sim.advance(0.36)
where, peak = sim.rest_position[sheet.vertices, :2], sim.temperature_peak[sheet.vertices]
on_stroke = np.linalg.norm(where[:, None] - zigzag, axis=2).min(axis=1) < 0.003
on, beside = peak[on_stroke].min(), peak[where[:, 0] > 0.076].max()  # K
print(f"{'scorched' if on > 450 else 'fresh'} along the stroke, {'fresh' if beside < 350 else 'scorched'} beside it")
