# Wind that begins while the sheet burns: a mean velocity, and gusts of a seed.
#
# Prints:
#   without wind the lower edge is -10 mm to the side
#   with wind the lower edge is 70 mm to the side
import sample

sim = sample.fire()
sheet = sim.sheet(*sample.square(0.15, 20))
for x in (-0.075, 0.075):
    sample.pin(sim, sheet, x, 0.075, 0)
sample.match(sim, 0.075, -0.075, 0)
sim.commit()


def aside():
    """mm that the lowest vertices are in front of the plane in which the sheet hangs."""
    vertices = sheet.vertices
    low = sim.alive[vertices] & (sim.rest_position[vertices, 1] < -0.06)
    return 10 * round((1e3 * sim.position[vertices][low, 1].mean() - 75) / 10)


sim.advance(1)
print(f"without wind the lower edge is {aside()} mm to the side")
sim.wind([0, 2, 0], gust=0.5, seed=7)  # m/s
sim.advance(0.5)
print(f"with wind the lower edge is {aside()} mm to the side")
