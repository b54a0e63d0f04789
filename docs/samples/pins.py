# Pins hold a sheet, carry it along a path, and let go.
#
# Prints:
#   0.5 s: lowest at -140 mm
#   1.0 s: lowest at -30 mm
#   1.5 s: lowest at -720 mm
import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.15, 20))
pins = [sample.pin(sim, sheet, x, 0.075, 0) for x in (-0.075, 0.075)]
sample.match(sim, 0, 0.075, -0.05)  # comes to the sheet when it hangs
sim.commit()


def go_on():
    sim.advance(0.5)
    lowest = sim.position[sim.alive, 2].min()
    print(f"{sim.time:.1f} s: lowest at {10 * round(100 * lowest)} mm")


go_on()
for pin in pins:  # up by 100 mm; a path is relative to the pose of its first key
    pin.move([(0.5, 0, 0, 0), (1, 0, 0, 0.1)])
go_on()
for pin in pins:
    pin.remove()
go_on()
