#!/usr/bin/env python3
"""Makes lab/paper/scenes/graded.obj, which the repository contains: the sheet of `singe paper adaptive` (section 8.2).

It measures 108 by 36 mm. Its cells are quads, of 1.5 mm on the left and 4.5 mm on the right. Between them lies a row of
large cells one of whose sides is cut in three.

    scripts/make_graded.py [FILE]
"""

import argparse
import pathlib
import random

FILE = pathlib.Path(__file__).resolve().parent.parent / "lab" / "paper" / "scenes" / "graded.obj"
FINE, COARSE = 1.5e-3, 4.5e-3  # cells, m
FINE_COLUMNS, COARSE_COLUMNS, COARSE_ROWS = 45, 8, 8
JITTER = 0.15  # of a cell, as grids of scenes have it


class Sheet:
    def __init__(self):
        self.points, self.number, self.faces = [], {}, []

    def vertex(self, x, y):
        key = round(1e7 * x), round(1e7 * y)
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append((x, y))
        return self.number[key]

    def face(self, *corners):
        self.faces.append([self.vertex(*corner) for corner in corners])

    def grid(self, left, columns, rows, cell):
        for i in range(columns):
            for j in range(rows):
                x, y = left + i * cell, j * cell
                self.face((x, y), (x + cell, y), (x + cell, y + cell), (x, y + cell))

    def seam(self, left):
        """Large cells whose left side is cut in three: four cells each."""
        for j in range(COARSE_ROWS):
            y = [j * COARSE + k * FINE for k in range(4)]
            middle, right = left + COARSE / 2, left + COARSE
            self.face((left, y[0]), (right, y[0]), (middle, y[1]), (left, y[1]))
            self.face((left, y[1]), (middle, y[1]), (middle, y[2]), (left, y[2]))
            self.face((left, y[2]), (middle, y[2]), (right, y[3]), (left, y[3]))
            self.face((middle, y[1]), (right, y[0]), (right, y[3]), (middle, y[2]))


def lines():
    sheet = Sheet()
    seam = FINE_COLUMNS * FINE
    sheet.grid(0, FINE_COLUMNS, 3 * COARSE_ROWS, FINE)
    sheet.seam(seam)
    sheet.grid(seam + COARSE, COARSE_COLUMNS, COARSE_ROWS, COARSE)
    width, height = seam + (1 + COARSE_COLUMNS) * COARSE, COARSE_ROWS * COARSE
    generator = random.Random(1)
    yield "# a sheet of two sizes of cells, made by scripts/make_graded.py: metres, z up"
    for x, y in sheet.points:
        cell = FINE if x < seam + COARSE / 2 else COARSE
        move = [JITTER * cell * generator.uniform(-1, 1) for _ in range(2)]
        if x in (0, width) or abs(x - width) < 1e-9:
            move[0] = 0
        if y == 0 or abs(y - height) < 1e-9:
            move[1] = 0
        yield "v %.6f %.6f 0" % (x + move[0] - width / 2, y + move[1] - height / 2)
    for face in sheet.faces:
        yield "f " + " ".join(str(v + 1) for v in face)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", default=FILE, type=pathlib.Path)
    parser.parse_args().file.write_text("\n".join(lines()) + "\n")


if __name__ == "__main__":
    main()
