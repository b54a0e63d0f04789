#!/usr/bin/env python3
"""Makes examples/hot-iron/iron.obj and handle.obj, which the repository contains: a cast flat iron and its wooden grip.

Both are closed meshes of quads, in millimetres and z up. The middle of the sole is at the origin; the tip points to +x.
"""

import math
import pathlib

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "examples" / "hot-iron"

LENGTH, WIDTH = 110.0, 64.0
STATIONS = 26  # from heel to tip


class Mesh:
    def __init__(self, what):
        self.what, self.vertices, self.faces = what, [], []

    def vertex(self, x, y, z):
        self.vertices.append((x, y, z))
        return len(self.vertices)

    def tube(self, rings, caps):
        """Quads between rings of numbers, counter-clockwise seen from ahead; caps close the first and the last."""
        count = len(rings[0])
        for below, above in zip(rings, rings[1:]):
            for i in range(count):
                j = (i + 1) % count
                self.faces.append((below[i], below[j], above[j], above[i]))
        caps(rings[0], True)
        caps(rings[-1], False)

    def strips(self, ring, turned):
        """Closes a ring of 2 n points by n - 1 quads from side to side."""
        count = len(ring)
        for i in range(count // 2 - 1):
            quad = (ring[i], ring[i + 1], ring[count - 2 - i], ring[count - 1 - i])
            self.faces.append(tuple(reversed(quad)) if turned else quad)

    def write(self, path):
        lines = [f"# {self.what}; scripts/make_iron.py"]
        lines += ["v " + " ".join(f"{c:.4f}".rstrip("0").rstrip(".") for c in v) for v in self.vertices]
        lines += ["f " + " ".join(map(str, f)) for f in self.faces]
        path.write_text("\n".join(lines) + "\n")


def half_width(s):
    """Of the sole at s from the heel, 0, to the tip, 1: round at the heel, an ogive to the tip."""
    body = (1 - max(0.0, (s - 0.28) / 0.72) ** 2.1) if s < 1 else 0.0
    heel = math.sqrt(max(0.0, 1 - max(0.0, (0.16 - s) / 0.16) ** 2.6)) if s < 0.16 else 1.0
    return WIDTH / 2 * max(0.02, body * (0.62 + 0.38 * heel))


def outline(inset, along):
    """The sole's border moved in by `inset`, its length scaled about the middle: right to the tip, left back."""
    right = []
    for k in range(STATIONS):
        s = 0.5 - 0.5 * math.cos(math.pi * k / (STATIONS - 1))
        right.append(((s - 0.5) * LENGTH * along, -max(0.6, half_width(s) - inset)))
    return right + [(x, -y) for x, y in reversed(right)]


def iron():
    mesh = Mesh("a flat iron, millimetres")
    # height, inset, share of the length: a chamfered sole, walls that lean in, a rounded top
    levels = [(0, 1.2, 0.975), (0.5, 0.45, 0.99), (1.6, 0, 1), (8, 0, 1), (10, 0.6, 0.99), (11, 2.2, 0.965),
              (24, 5.0, 0.9), (31, 6.6, 0.86), (34.5, 9, 0.82), (36, 13, 0.74)]
    rings = [[mesh.vertex(x, y, z) for x, y in outline(inset, along)] for z, inset, along in levels]
    mesh.tube(rings, mesh.strips)
    mesh.write(FOLDER / "iron.obj")


def handle():
    """An arch of a round rod over the iron's top, which it does not quite touch."""
    mesh = Mesh("the grip of a flat iron, millimetres")
    around, reach, low, high = 16, 33.0, 36.2, 78.0
    path = [(-reach, low), (-reach, low + 12)]
    path += [(-reach * math.cos(a), low + 22 + (high - low - 22) * math.sin(a) ** 0.8)
             for a in (math.pi * k / 20 for k in range(1, 20))]
    path += [(reach, low + 12), (reach, low)]
    rings = []
    for k, (x, z) in enumerate(path):
        before, after = path[max(k - 1, 0)], path[min(k + 1, len(path) - 1)]
        tx, tz = after[0] - before[0], after[1] - before[1]
        size = math.hypot(tx, tz)
        tx, tz = tx / size, tz / size
        radius = 4.2 + 3.6 * math.sin(math.pi * k / (len(path) - 1)) ** 2
        ring = []
        for i in range(around):
            a = 2 * math.pi * i / around
            across, out = radius * math.cos(a), radius * math.sin(a)
            # across: y; out: the normal of the path in its plane, so that across, out and along are right-handed
            ring.append(mesh.vertex(x + out * tz, across, z - out * tx))
        rings.append(ring)
    if rings:
        mesh.tube(rings, mesh.strips)
    mesh.write(FOLDER / "handle.obj")


iron()
handle()
