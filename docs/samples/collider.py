# Cotton falls over a sphere that is hot, and smoulders where it touches.
#
# Prints:
#   after 0.5 s lowest at 0 mm, hottest 1200 K
import sample

sim = sample.fire()
sim.sheet(*sample.square(0.2, 24, 0.11), material="cotton")
# K, W/(m2 K); a conductance of 0, the default, exchanges no heat
sim.collider("sphere", radius=0.05, position=[0, 0, 0.05], temperature=1000, conductance=300)
sim.collider("plane")
sim.commit()
sim.advance(0.5)
lowest, hottest = sim.position[sim.alive, 2].min(), sim.stats()["temperature_max"]
print(f"after 0.5 s lowest at {10 * round(100 * lowest)} mm, hottest {100 * round(hottest / 100)} K")
