"""Fits a material's mass_rate to a front that was measured, by scipy: fit.py [OUT.png]."""
import sys

import matplotlib
import numpy as np
import singe
from scipy.optimize import minimize_scalar

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

points, faces, uv = singe.grid((0.06, 0.01), (60, 10), jitter=0)
position = 1e3 * (points[:61, 0] + 0.03)  # mm from the end that is lit


def times(mass_rate):
    """s after which the fire has come to each vertex along a side; NaN where it has not."""
    sim = singe.Sim(pace=4, gravity=(0, 0, 0))
    sheet = sim.sheet(points, faces, uv, material={"base": "office-paper", "mass_rate": mass_rate})
    sim.pin(sheet, vertices=np.arange(len(points)))
    sim.spot([-0.03, 0, 0], radius=0.012, temperature=1200, end=0.6)
    sim.commit()
    sim.advance(2)
    found = 4 * sim.time_ignited[:61]
    return np.where(found < 0, np.nan, found)


# the measurement stands in for one of a film: a known rate and noise
measured = times(0.012) + np.random.default_rng(1).normal(0, 0.03, 61)
there = np.isfinite(measured) & (position > 12)


def misfit(rate):
    return np.mean(np.where(np.isfinite(found := times(rate)), found - measured, 5)[there] ** 2)


best = minimize_scalar(misfit, bounds=(0.004, 0.03), method="bounded", options={"xatol": 1e-4})
plt.plot(position, measured, ".", position, times(best.x))
plt.xlabel("mm from the end")
plt.ylabel("time of ignition (s)")
plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "fit.png", dpi=80)
print(f"mass_rate {best.x:.4f}, which was 0.0120; off by {np.sqrt(best.fun):.3f} s")
