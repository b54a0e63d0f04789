# Air that turns: a vortex that lies on its side lifts a scrap of tissue off the table.
#
# Prints:
#   the scrap is high above the table
import sample

sim = sample.fire()
tissue = sim.sheet(*sample.square(0.1, 16, 0.001), material="tissue")
sim.collider("plane")
# its axis lies along y; on the left of it the air rises
sim.source("vortex", speed=3, radius=0.08, position=[0.1, 0, 0.05], direction=[0, 1, 0])
sim.commit()
sim.advance(0.25)
height = sim.position[tissue.vertices, 2].mean()
print(f"the scrap is {'high above' if height > 0.1 else 'on'} the table")
