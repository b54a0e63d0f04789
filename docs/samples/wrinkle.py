# Without ablation nothing is removed: the sheet chars, shrinks and wrinkles, and stays whole.
#
# Prints:
#   gone: 105 of 400 cells left
#   whole: 400 of 400 cells left
import sample

for whole in (False, True):
    sim = sample.fire()
    little_char = {"ablate": not whole, "char_yield": 0.05}  # which would stay
    sim.sheet(*sample.square(0.08, 20, 0.001), material=little_char)
    sim.collider("plane")
    sim.spot([0, 0, 0], radius=0.1, temperature=1100, end=1)
    sim.commit()
    sim.advance(1.5)
    print(f"{'whole' if whole else 'gone'}: {sim.stats()['cells']} of {len(sim.cells)} cells left")
