"""Speed of the front in paper of several weights, by a study in threads with a progress bar: study.py [OUT.png]."""
import sys
from concurrent.futures import ThreadPoolExecutor

import matplotlib
import numpy as np
import singe
from tqdm import tqdm

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def front_speed(grammage):
    """mm/s along a strip of 100 x 20 mm that is lit at its left end and lies still in the air."""
    sim = singe.Sim(pace=4, gravity=(0, 0, 0))
    sheet = sim.sheet(*singe.grid((0.1, 0.02), (100, 20)), material={"base": "office-paper", "grammage": grammage})
    sim.pin(sheet, vertices=np.arange(101 * 21))
    sim.source("ball", path=[(0, -0.05, 0, 0)], radius=0.012, temperature=1200, end=0.6)
    sim.commit()
    sim.advance(2.5)
    return 1e3 * sim.stats()["front_speed"]


weights = np.array([0.045, 0.06, 0.08, 0.1, 0.12])  # kg/m2
with ThreadPoolExecutor(2) as pool:  # steps release the interpreter's lock
    speeds = list(tqdm(pool.map(front_speed, weights), total=len(weights)))
plt.plot(1e3 * weights, speeds, "o-")
plt.xlabel("grammage (g/m²)")
plt.ylabel("speed of the front (mm/s)")
plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "study.png", dpi=80)
print(" ".join(f"{speed:.2f}" for speed in speeds))
