# Accounts: where the heat and the mass have gone, and that nothing is missing.
#
# Prints:
#   heat: 10 tenths by the fire, the rest by the match; 5 tenths lost, the rest still there
#   mass: 1.2 g, of which 0.6 burnt
#   the ledgers close
import sample

sim = sample.fire()
sim.sheet(*sample.square(0.12, 20, 0.001))
sim.collider("plane")
sample.match(sim, 0, 0, 0)
sim.commit()
sim.advance(1.2)
stats = sim.stats()
whole = stats["heat_in"] + stats["heat_of_combustion"]
print(f"heat: {10 * stats['heat_of_combustion'] / whole:.0f} tenths by the fire, the rest by the match; "
      f"{10 * stats['heat_lost'] / whole:.0f} tenths lost, the rest still there")
print(f"mass: {1e3 * stats['mass_initial']:.1f} g, of which {1e3 * stats['mass_burnt']:.1f} burnt")
print(f"the ledgers {'close' if stats['ledgers_close'] else 'are open'}")
