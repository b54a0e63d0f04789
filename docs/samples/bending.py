# Stiffness in N m: strips of the same mass are held at one end. The stiffer one hangs less.
#
# Prints:
#   1e-05 N m: hangs down
#   1e-03 N m: sticks out
import numpy as np

import sample
import singe

sim = sample.fire(solver={"substeps": 0})  # as many as the stiffness needs
points, faces, uv = singe.grid((0.12, 0.04), (24, 8), jitter=0)
strips = {}
for k, stiffness in enumerate((1e-5, 1e-3)):
    strip = sim.sheet(points + np.float32([0, 0.06 * k, 0]), faces, uv,
                      material={"bending": stiffness, "thickness": 3e-3, "damping": 5})
    sample.pin(sim, strip, -0.06, 0.06 * k, 0, radius=0.03)
    strips[stiffness] = strip
sim.commit()
sim.advance(0.7)
for stiffness, strip in strips.items():
    end = sim.position[strip.vertices][24]  # the free one
    print(f"{stiffness:.0e} N m: {'hangs down' if end[2] < -0.05 else 'sticks out'}")
