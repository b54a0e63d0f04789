# What happens, as it happens: ignitions, holes and pieces, for sounds and sparks; and a probe at one point.
#
# Prints:
#   0.01 s: first ignition
#   0.87 s: first hole
#   the probe was hottest with 1100 K at 0.5 s
import numpy as np

import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.12, 18))
for x in (-0.06, 0.06):
    for y in (-0.06, 0.06):
        sample.pin(sim, sheet, x, y, 0)
sample.match(sim, 0, 0, 0)
sim.commit()
probe = np.linalg.norm(sim.rest_position[sheet.vertices, :2] - [0.02, 0], axis=1).argmin()

names, hottest, when = {0: "ignition", 1: "hole"}, 0, 0
for frame in range(1, 31):
    sim.advance(1 / 24)
    for event in sim.events:  # of all steps of the frame
        name = names.pop(int(event["kind"]), None)
        if name:
            print(f"{event['time']:.2f} s: first {name}")
    if sim.temperature[probe] > hottest:
        hottest, when = sim.temperature[probe], frame / 24
print(f"the probe was hottest with {100 * round(float(hottest) / 100)} K at {when:.1f} s")
