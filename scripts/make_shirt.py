#!/usr/bin/env python3
"""Makes examples/shirt/shirt.obj, which the repository contains: a T-shirt of triangles, as other programs export them.

    scripts/make_shirt.py [FILE]

Front and back are grids, sewn together along the sides and the shoulders. The sleeves are tubes sewn to both. Parts
that are sewn share vertices, but each part is a chart of its own, so seams of the uv run along the sides and the
shoulders, around the arms and under the sleeves. Neck, hem and cuffs are open. The diagonals are random.

Metres, z up, x to the left hand, the front towards -y. It hangs free around a body within |x| < 0.22, |y| < 0.10 at the
chest; shoulders are at z = 1.45, the hem at z = 0.85.
"""
import math
import pathlib
import random
import sys

COLUMNS, ROWS = 44, 48              # cells of front and back; an even number of columns
SLEEVE_COLUMNS = 17
HALF_WIDTH, HEM, NECK_TOP, SHOULDER_TIP = 0.27, 0.85, 1.455, 1.415
NECK = 10                           # columns to either side of the middle that are the neck's
DIP = {"front": 0.085, "back": 0.025}
ARM_ROW = 33                        # row of the armpit
DEPTH, ARM_DEPTH, NECK_DEPTH = 0.145, 0.085, 0.075
SLEEVE_LENGTH, SLEEVE_DOWN = 0.20, math.radians(38)
CUFF = 0.165                        # height of the cuff

random.seed(20)


def round_off(x):
    """The height of a half circle of radius 1 over x."""
    return math.sqrt(max(0.0, 1 - x * x))


def column_x(i):
    return HALF_WIDTH * (2 * i / COLUMNS - 1)


def top(i, side):
    """z of the upper end of a column."""
    away = abs(i - COLUMNS // 2)
    if away < NECK:
        return NECK_TOP - DIP[side] * round_off(away / NECK)
    along = (away - NECK) / (COLUMNS // 2 - NECK)
    return NECK_TOP + (SHOULDER_TIP - NECK_TOP) * along


def depth(i, j, top_depth):
    """Half the distance between front and back."""
    across, up = abs(2 * i / COLUMNS - 1), j / ROWS
    high = max(0.0, (up - 0.6) / 0.4)
    middle = math.sqrt((DEPTH * round_off(high)) ** 2 + (top_depth * high) ** 2)
    side = ARM_DEPTH * round_off(2 * (j - ARM_ROW) / (ROWS - ARM_ROW) - 1) if j > ARM_ROW else 0
    return math.sqrt((middle * round_off(across)) ** 2 + (side * across) ** 2)


def body_place(i, j, side):
    away = abs(i - COLUMNS // 2)
    neck = NECK_DEPTH * round_off(away / NECK) if away < NECK else 0
    z = HEM + (top(i, side) - HEM) * j / ROWS
    y = depth(i, j, neck) * (-1 if side == "front" else 1)
    return (column_x(i), y if abs(y) > 1e-9 else 0.0, z)


def sleeve_place(hand, s, j, side):
    """hand is -1 or 1, s cells along the sleeve from the body, j a row of the body's."""
    edge = body_place(0 if hand < 0 else COLUMNS, j, side)
    share, t = s / SLEEVE_COLUMNS, (j - ARM_ROW) / (ROWS - ARM_ROW)
    along = (hand * math.cos(SLEEVE_DOWN), -math.sin(SLEEVE_DOWN))
    upwards = (hand * math.sin(SLEEVE_DOWN), math.cos(SLEEVE_DOWN))
    tip = (hand * HALF_WIDTH, SHOULDER_TIP)
    end = [tip[k] + SLEEVE_LENGTH * along[k] - CUFF * (1 - t) * upwards[k] for k in (0, 1)]
    x, z = edge[0] + (end[0] - edge[0]) * share, edge[2] + (end[1] - edge[2]) * share
    return (x, edge[1] * (1 - 0.08 * share), z)


class Shirt:
    def __init__(self):
        self.places, self.numbers, self.uvs, self.uv_numbers, self.faces = [], {}, [], {}, []

    def vertex(self, place):
        key = tuple(round(c, 6) for c in place)
        if key not in self.numbers:
            self.numbers[key] = len(self.places) + 1
            self.places.append(place)
        return self.numbers[key]

    def uv(self, chart, u, v):
        key = (chart, round(u, 7), round(v, 7))
        if key not in self.uv_numbers:
            self.uv_numbers[key] = len(self.uvs) + 1
            self.uvs.append((u, v))
        return self.uv_numbers[key]

    def cell(self, corners):
        """Two triangles; corners are (vertex, uv), counter-clockwise seen from outside."""
        a, b, c, d = corners
        self.faces += [(a, b, c), (a, c, d)] if random.random() < 0.5 else [(a, b, d), (b, c, d)]

    def block(self, chart, columns, rows, place, uv, turned):
        def corner(i, j):
            return self.vertex(place(i, j)), self.uv(chart, *uv(i, j))

        for j in rows:
            for i in columns:
                corners = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
                self.cell(corners[::-1] if turned else corners)


def make():
    shirt = Shirt()
    for side in ("front", "back"):
        left = 0.03 if side == "front" else 0.53
        # charts are as large as the cloth, 1.2 m to 1; the back is seen from behind
        def uv(i, j):
            x, _, z = body_place(i, j, side)
            return left + (x if side == "front" else -x) / 1.2 + HALF_WIDTH / 1.2, 0.03 + (z - HEM) / 1.2
        shirt.block(side, range(COLUMNS), range(ROWS), lambda i, j: body_place(i, j, side), uv, side == "back")
    for hand in (-1, 1):
        for side in ("front", "back"):
            def uv(s, j):
                around = (ROWS - j) * (1 if side == "front" else -1) / (ROWS - ARM_ROW)
                return (0.15 if hand < 0 else 0.65) + 0.17 * around * 0.75, 0.97 - 0.2 * s / SLEEVE_COLUMNS
            shirt.block("sleeve%d" % hand, range(SLEEVE_COLUMNS), range(ARM_ROW, ROWS),
                        lambda s, j: sleeve_place(hand, s, j, side), uv, (side == "back") == (hand > 0))
    return shirt


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    path = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else root / "examples" / "shirt" / "shirt.obj"
    shirt = make()
    with open(path, "w", encoding="ascii") as file:
        file.write("# a T-shirt, made by scripts/make_shirt.py: metres, z up\n")
        for place in shirt.places:
            file.write("v %.6f %.6f %.6f\n" % place)
        for uv in shirt.uvs:
            file.write("vt %.6f %.6f\n" % uv)
        for face in shirt.faces:
            file.write("f " + " ".join("%d/%d" % corner for corner in face) + "\n")
    print("%s: %d vertices, %d uv, %d triangles" % (path, len(shirt.places), len(shirt.uvs), len(shirt.faces)))


if __name__ == "__main__":
    main()
