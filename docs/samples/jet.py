# A breath blows a fire out: a jet of air takes the flame's heat away, and the paper cools.
#
# Prints:
#   0.5 s: burning
#   1.0 s: out
import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.12, 20, 0.05))
for x in (-0.06, 0.06):
    for y in (-0.06, 0.06):
        sample.pin(sim, sheet, x, y, 0.05)
sample.match(sim, 0, 0, 0.05)
sim.source("jet", radius=0.02, speed=12, position=[-0.15, 0, 0.05], direction=[1, 0, 0], start=0.55, end=0.9)
sim.commit()
for half in (1, 2):
    sim.advance(0.5)
    print(f"{half * 0.5:.1f} s: {'burning' if sim.stats()['temperature_max'] > 500 else 'out'}")
