# Threads change nothing: the same burn on one thread and on three has the same bytes.
#
# Prints:
#   1 and 3 threads: the same bytes
import sample


def burn(threads):
    """The snapshot of a burn."""
    sim = sample.fire(threads=threads)
    sim.sheet(*sample.square(0.15, 30, 0.001))
    sim.collider("plane")
    sample.match(sim, 0, 0, 0)
    sim.commit()
    sim.advance(0.5)
    return sim.save()


print(f"1 and 3 threads: {'the same' if burn(1) == burn(3) else 'other'} bytes")
