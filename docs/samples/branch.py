# One burn, two ends: a snapshot is loaded twice, and one of them gets wind. Equal ends have equal bytes.
#
# Prints:
#   left alone: the same bytes
#   with wind: other bytes
import singe

import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.15, 20))
for x in (-0.075, 0.075):
    sample.pin(sim, sheet, x, 0.075, 0)
sample.match(sim, 0.075, 0, 0)
sim.commit()
sim.advance(0.5)
middle = sim.save()
sim.advance(0.5)
end = sim.save()
for name, wind in ("left alone", None), ("with wind", [0, 1.5, 0]):
    again = singe.Sim.load(middle)
    if wind:
        again.wind(wind)
    again.advance(0.5)
    print(f"{name}: {'the same' if again.save() == end else 'other'} bytes")
