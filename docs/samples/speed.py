# Measured: how fast the front runs, of the fire's own time. Thinner paper burns faster.
#
# Prints:
#   40 g/m2 burns faster than 80 g/m2
import sample


def front(grammage):
    """m/s of the fire's own time."""
    sim = sample.fire()
    sim.sheet(*sample.square(0.12, 24, 0.001), material={"grammage": grammage})
    sim.collider("plane")
    for i in range(-2, 3):  # a straight front
        sample.match(sim, -0.06, 0.024 * i, 0)
    sim.commit()
    sim.advance(0.8)
    return sim.stats()["front_speed"]


print(f"40 g/m2 burns {'faster' if front(0.04) > 1.2 * front(0.08) else 'no faster'} than 80 g/m2")
