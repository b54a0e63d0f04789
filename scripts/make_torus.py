#!/usr/bin/env python3
"""Makes examples/burning-torus/torus.obj, which the repository contains: a torus of crumpled paper around the z axis, of
quads, in metres.

Each half of the ring has a chart of uv: v goes around the hole, u around the tube from a cut on the inside. Paper that
has been crumpled is cones between ridges: so is the distance to the nearest of some points on the torus, which moves the
surface inwards for some points and outwards for others, in two sizes. Around the hole, where a tube of paper that is
bent to a ring has too much length, it lies in pleats.

    scripts/make_torus.py [--around N] [--across M] [--smooth] [FILE]
"""

import argparse
import math
import pathlib
import random

FILE = pathlib.Path(__file__).resolve().parent.parent / "examples" / "burning-torus" / "torus.obj"
RING, TUBE = 0.10, 0.040  # radii, m
# points of the cones, their slope, and whether they are dents (-1) or bumps
CONES = ((36, 0.30, -1), (28, 0.16, 1), (140, 0.50, -1), (100, 0.40, 1))
PLEATS, PLEAT = 30, 0.0045  # around the hole, and how deep, m
CUT = 0.275  # around the hole, where a chart begins: the lit places have text, as a dark photograph looks burnt
UNEVEN = 0.06  # by which share the tube is wider and narrower around the ring


def place(s, t, out=0.0, tube=TUBE):
    """s around the hole, t around the tube from the inside of the hole over the bottom, 0 to 1; moved outwards."""
    turn, roll = 2 * math.pi * s, math.pi + 2 * math.pi * t
    away = RING + (tube + out) * math.cos(roll)
    return away * math.cos(turn), away * math.sin(turn), (tube + out) * math.sin(roll)


class Crumpled:
    """How far the paper is moved outwards."""

    def __init__(self, seed):
        chance = random.Random(seed)
        self.cones = []
        for count, slope, side in CONES:
            points = [place(chance.random(), chance.random()) for _ in range(count)]
            # the mean distance to the nearest of points with this density is half of its root
            mean = 0.5 * math.sqrt(4 * math.pi**2 * RING * TUBE / count)
            self.cones.append((points, -slope * side, mean))
        widths = [chance.uniform(0.5, 1.5) for _ in range(PLEATS)]
        self.folds = [sum(widths[:i]) / sum(widths) for i in range(PLEATS + 1)]
        self.depths = [chance.uniform(0.3, 1.0) for _ in range(PLEATS)]
        self.reach = [chance.uniform(0.10, 0.24) for _ in range(PLEATS)]
        self.waves = [(k, UNEVEN * chance.uniform(0.4, 1) / k, chance.random()) for k in (1, 2, 3, 5)]

    def tube(self, s):
        return TUBE * (1 + sum(a * math.sin(2 * math.pi * (k * s + phase)) for k, a, phase in self.waves))

    def pleats(self, s, t):
        s = (s + 0.006 * math.sin(2 * math.pi * (7 * t + 3 * s))) % 1  # they lean
        k = max(i for i in range(PLEATS) if self.folds[i] <= s)
        across = (s - self.folds[k]) / (self.folds[k + 1] - self.folds[k])
        inside = max(0.0, 1 - min(t, 1 - t) / self.reach[k])
        return PLEAT * self.depths[k] * inside * (0.5 - abs(2 * across - 1))

    def out(self, s, t):
        at = place(s, t)
        far = sum(share * (min(math.dist(at, p) for p in points) - mean) for points, share, mean in self.cones)
        return far + self.pleats(s, t)


def lines(n, m, crumpled):
    yield "# a torus, made by scripts/make_torus.py: metres, z up"
    for j in range(m):
        for i in range(n):
            moved = (crumpled.out(i / n, j / m), crumpled.tube(i / n)) if crumpled else ()
            yield "v %.6f %.6f %.6f" % place(i / n, j / m, *moved)
    half = n // 2  # both halves have the same uv, all of the picture
    first = round(CUT * n)
    for j in range(m + 1):
        for i in range(half + 1):
            yield "vt %.6f %.6f" % (j / m, i / half)
    for j in range(m):
        for i in range(n):
            corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
            uv = ((y * (half + 1) + x - i + (i - first) % half + 1) for x, y in corners)
            yield "f " + " ".join("%d/%d" % (y % m * n + x % n + 1, k) for (x, y), k in zip(corners, uv))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--around", type=int, default=156, help="quads around the hole, an even number")
    parser.add_argument("--across", type=int, default=66, help="quads around the tube")
    parser.add_argument("--smooth", action="store_true", help="paper that nothing has crumpled")
    parser.add_argument("file", nargs="?", type=pathlib.Path, default=FILE)
    options = parser.parse_args()
    crumpled = None if options.smooth else Crumpled(3)
    options.file.write_text("\n".join(lines(options.around, options.across, crumpled)) + "\n", encoding="ascii")
    print("%s: %d quads" % (options.file, options.around * options.across))


if __name__ == "__main__":
    main()
