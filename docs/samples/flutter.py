# Restless air: turbulence makes a page flutter that hangs still in calm air.
#
# Prints:
#   calm: still, turbulent: fluttering
import sample

sim = sample.fire()
page = sim.sheet(*sample.square(0.15, 16), material={"damping": 4})
for x in (-0.075, 0.075):
    sample.pin(sim, page, x, 0.075, 0)
sim.source("turbulence", speed=2, radius=0.04, start=1.5)  # radius: the size of its swirls
sim.commit()
speeds = []
for seconds in (1.5, 0.5):
    sim.advance(seconds)
    speeds.append(sim.stats()["speed_rms_unburnt"])
print(f"calm: {'still' if speeds[0] < 0.05 else 'moving'}, turbulent: {'fluttering' if speeds[1] > 0.1 else 'still'}")
