# A ticket tears along its perforation: a texture lowers the strength along a line, and a pin pulls.
#
# Prints:
#   1 piece, 0 vertices torn
#   2 pieces, 17 vertices torn
import numpy as np

import singe

import sample

line = np.zeros((1, 32))  # black but for one column in the middle
line[0, 15:17] = 1
perforated = {"strength": singe.Vary(200, 20, texture=line)}  # N/m where it is black, where it is white

sim = sample.fire(solver={"tearing": True}, gravity=[0, 0, 0])
ticket = sim.sheet(*sample.square(0.1, 16), material=perforated)
sample.pin(sim, ticket, -0.08, 0, 0, radius=0.06)
sample.pin(sim, ticket, 0.08, 0, 0, radius=0.06, path=[(0, 0, 0, 0), (0.5, 0.03, 0, 0.01)])
sim.commit()


def print_pieces():
    stats = sim.stats()
    print(f"{stats['pieces']} piece{'s' if stats['pieces'] > 1 else ''}, {stats['tears']} vertices torn")


print_pieces()
sim.advance(0.5)
print_pieces()
