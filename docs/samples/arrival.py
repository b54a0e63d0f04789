# Fire on cue: a picture says when the front is where. Here it comes in rings, from the middle outwards, in two seconds.
#
# Prints:
#   95 of 100 particles within 0.01 s, 0 missed
import numpy as np

import sample

SIZE = 64
x = (np.arange(SIZE) + 0.5) / SIZE - 0.5
rings = np.minimum(2 * np.hypot(x[None, :], x[:, None]), 1)  # 0: at arrival_from, 1: never, in between in proportion

sim = sample.fire()
sim.sheet(*sample.square(0.15, 30, 0.001))
sim.collider("plane")
sim.source("arrival", texture=rings, arrival_from=0.2, arrival_to=2)  # s
sim.commit()
sim.advance(1.4)
stats = sim.stats()
within = np.ceil(100 * stats["arrival_error"]) / 100
print(f"95 of 100 particles within {within:.2f} s, {stats['arrival_missed']} missed")
