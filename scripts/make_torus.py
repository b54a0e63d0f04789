#!/usr/bin/env python3
"""Makes examples/burning-torus/torus.obj, which the repository contains: a torus of quads around the z axis, in metres.

Each half of the ring has its own chart of uv: v goes around the hole, u around the tube from a cut on the inside.

    scripts/make_torus.py [--around N] [--across M] [FILE]
"""

import argparse
import math
import pathlib

FILE = pathlib.Path(__file__).resolve().parent.parent / "examples" / "burning-torus" / "torus.obj"
RING, TUBE = 0.10, 0.042  # radii, m


def place(s, t):
    """s around the hole, t around the tube from the inside of the hole over the bottom, 0 to 1."""
    turn, roll = 2 * math.pi * s, math.pi + 2 * math.pi * t
    away = RING + TUBE * math.cos(roll)
    return away * math.cos(turn), away * math.sin(turn), TUBE * math.sin(roll)


def lines(n, m):
    yield "# a torus, made by scripts/make_torus.py: metres, z up"
    for j in range(m):
        for i in range(n):
            yield "v %.6f %.6f %.6f" % place(i / n, j / m)
    half = n // 2  # both halves have the same uv, all of the picture
    for j in range(m + 1):
        for i in range(half + 1):
            yield "vt %.6f %.6f" % (j / m, i / half)
    for j in range(m):
        for i in range(n):
            corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
            uv = ((y * (half + 1) + x - i + i % half + 1) for x, y in corners)
            yield "f " + " ".join("%d/%d" % (y % m * n + x % n + 1, k) for (x, y), k in zip(corners, uv))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--around", type=int, default=132, help="quads around the hole, an even number")
    parser.add_argument("--across", type=int, default=56, help="quads around the tube")
    parser.add_argument("file", nargs="?", type=pathlib.Path, default=FILE)
    options = parser.parse_args()
    options.file.write_text("\n".join(lines(options.around, options.across)) + "\n", encoding="ascii")
    print("%s: %d quads" % (options.file, options.around * options.across))


if __name__ == "__main__":
    main()
