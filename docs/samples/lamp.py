# A heat source of one's own: a function that adds a flux to every particle, here a line of light that travels.
#
# Prints:
#   ignited at 0.4 s, hottest 1300 K
import numpy as np

import sample


def laser(view):
    """W/m2 into each layer of each particle."""
    x = -0.08 + 0.06 * view.time
    return 30e3 * np.exp(-((view.rest_position[:, 0] - x) / 0.004)**2)


sim = sample.fire()
sim.sheet(*sample.square(0.12, 24, 0.001))
sim.collider("plane")
sim.source("callback", callback=laser)
sim.commit()
ignited = None
while ignited is None and sim.time < 2:
    sim.advance(1 / 24)
    times = sim.events["time"][sim.events["kind"] == 0]  # ignitions
    ignited = times[0] if len(times) else None
sim.advance(1)
print(f"ignited at {ignited:.1f} s, hottest {100 * round(sim.stats()['temperature_max'] / 100)} K")
