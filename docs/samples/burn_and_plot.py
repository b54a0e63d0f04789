"""Burns a sheet of paper and plots how much is left, and a picture of it: burn_and_plot.py [OUT.png]."""
import sys

import matplotlib
import numpy as np
import singe

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sim = singe.Sim(pace=5, surface_detail=5e-4)
sheet = sim.sheet(*singe.grid((0.15, 0.15), (40, 40)))
sim.pin(sheet, points=[[-0.075, 0.075, 0], [0.075, 0.075, 0]])
sim.spot([0.075, 0, 0], radius=0.01, temperature=1123, end=0.5)
sim.commit()
rows = []
while sim.time < 2:
    sim.advance(1 / 24)
    rows.append((sim.time, sim.stats()["burnt_fraction"]))
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
left.plot(*np.transpose(rows))
left.set(xlabel="time (s)", ylabel="burnt (share of the mass)")
right.imshow(singe.draw(sim.surface()))
right.axis("off")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "burn.png", dpi=80)
print(f"{100 * rows[-1][1]:.0f} % burnt, hottest {sim.temperature.max():.0f} K")
