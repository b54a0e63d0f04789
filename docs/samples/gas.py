# The gas above the fire: hot air, flames and smoke on a grid, for a volume renderer.
#
# Prints:
#   1.0 s: gas of more than 700 K rises; flames, smoke
import numpy as np

import sample

sim = sample.fire(gas={"cell_size": 0.01, "height": 0.15})  # m
sim.sheet(*sample.square(0.12, 20, 0.001))
sim.collider("plane")
sample.match(sim, 0, 0, 0)
sim.commit()
sim.advance(1)
gas = sim.gas()
hottest = np.unravel_index(gas.temperature.argmax(), gas.temperature.shape)  # z, y, x
print(f"1.0 s: gas of {'more' if gas.temperature[hottest] > 700 else 'less'} than 700 K "
      f"{'rises' if gas.velocity[hottest][2] > 0 else 'falls'}; {'flames' if gas.flame.any() else 'no flames'}, "
      f"{'smoke' if gas.smoke.any() else 'no smoke'}")
