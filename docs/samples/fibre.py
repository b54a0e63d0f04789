# Fibres: burning paper shrinks more across them than along them.
#
# Prints:
#   fibres along x: narrower in y; along y: narrower in x
import math

import sample


def widening(angle):
    """How much wider than long the sheet is at the end, m."""
    sim = sample.fire()
    alike = {"ablate": False, "fibre_shrink": 4, "fibre_angle": angle, "shrink_front": 0.8, "shrink_back": 0.8}
    sheet = sim.sheet(*sample.square(0.08, 16, 0.001), material=alike)
    sim.collider("plane")
    for x in (-0.04, 0.04):
        for y in (-0.04, 0.04):
            sample.match(sim, x, y, 0)
    sim.commit()
    sim.advance(1)
    width = sim.position[sheet.vertices].max(0)
    return width[0] - width[1]


print(f"fibres along x: {'narrower' if widening(0) > 0 else 'wider'} in y; "
      f"along y: {'narrower' if widening(math.pi / 2) < 0 else 'wider'} in x")
