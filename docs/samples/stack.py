# Two sheets in contact: one falls onto the other, and the fire of the lower one lights it.
#
# Prints:
#   0.4 s: the upper sheet is above the lower one
#   1.2 s: both burn
import sample

sim = sample.fire(contact=True)  # without it sheets pass through each other
lower = sim.sheet(*sample.square(0.12, 16, 0.001))
upper = sim.sheet(*sample.square(0.10, 16, 0.01))
sim.collider("plane")
sim.commit()
sim.advance(0.4)
heights = [sim.position[sheet.vertices, 2].mean() for sheet in (lower, upper)]
print(f"0.4 s: the upper sheet is {'above' if heights[1] > heights[0] else 'below'} the lower one")

sim.spot([0.05, 0.05, 0], temperature=1123)  # under the lower sheet's corner
sim.advance(0.8)
both = all((sim.time_ignited[sheet.vertices] >= 0).any() for sheet in (lower, upper))
print(f"1.2 s: {'both' if both else 'not both'} burn")
