# A lid puts a fire out: what burns beneath a collider that smothers gets no air.
#
# Prints:
#   under the lid 0 particles burn, elsewhere many do
import sample

sim = sample.fire()
sim.sheet(*sample.square(0.15, 24, 0.001))
sim.collider("plane")
sample.match(sim, 0, 0, 0)
# from above, down onto the right half, in a tenth of a second
sim.collider("box", half_size=[0.05, 0.1, 0.01], smothers=True, contact_distance=0.004, conductance=400,
             path=[(0.6, 0.05, 0, 0.1), (0.7, 0.05, 0, 0.012)])
sim.commit()
sim.advance(1.2)
burning, lid = sim.burn_rate > 0.01, sim.rest_position[:, 0] > 0.005
elsewhere = "many do" if (burning & ~lid).sum() > 20 else "few do"
print(f"under the lid {(burning & lid).sum()} particles burn, elsewhere {elsewhere}")
