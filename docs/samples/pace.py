# Slow motion: the pace of the fire changes while it burns. Motion keeps its own time.
#
# Prints:
#   at pace 12 half a second burns 10 times as much as at pace 1
import sample

sim = sample.fire()
sim.sheet(*sample.square(0.15, 24, 0.001))
sim.collider("plane")
sample.match(sim, 0, 0, 0)
sim.commit()
sim.advance(0.6)
burnt = [sim.stats()["burnt_fraction"]]
for pace in (1, 12):  # seconds of fire a second
    sim.set_pace(pace)
    sim.advance(0.5)
    burnt.append(sim.stats()["burnt_fraction"])
slow, fast = burnt[1] - burnt[0], burnt[2] - burnt[1]
print(f"at pace 12 half a second burns {'10 times' if fast > 9 * slow else 'about'} as much as at pace 1")
