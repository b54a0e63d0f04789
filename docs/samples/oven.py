# An oven: the surroundings heat up, and paper that no flame touches browns and catches fire by itself.
#
# Prints:
#   at 400 K it stays, at 700 K it has ignited
import sample

sim = sample.fire()
sim.sheet(*sample.square(0.1, 12, 0.001))
sim.collider("plane")
sim.commit()
words = []
for ambient in (400, 700):
    sim.set_ambient_temperature(ambient)
    sim.advance(2)
    words.append("stays" if sim.time_ignited[0] < 0 else "has ignited")
print(f"at 400 K it {words[0]}, at 700 K it {words[1]}")
