#!/usr/bin/env python3
"""Makes examples/title/title.png, the arrival map of the word SINGE: from black, where a pen would begin, to the grey
where it would end; what it does not touch is white. Usage: python3 scripts/make_title.py"""

import math
import pathlib
import random
import struct
import zlib

SIZE, SCALE = (220, 100), 3  # mm, pixels a mm
HEIGHT, LEFT, BOTTOM, HALF = 54, 17, 23, 4.4  # mm of the letters, and half a stroke
LETTERS = (  # width; strokes of points in its box, `True`: smooth
    (32, [(True, [(.9, .8), (.72, .96), (.45, 1), (.2, .92), (.1, .74), (.22, .58), (.5, .5), (.78, .41), (.9, .24),
                  (.78, .07), (.5, 0), (.22, .04), (.06, .2)])]),
    (12, [(False, [(.5, 1), (.5, 0)])]),
    (36, [(False, [(.1, 0), (.1, 1), (.9, 0), (.9, 1)])]),
    (40, [(True, [(.9, .78), (.74, .95), (.5, 1), (.22, .9), (.07, .66), (.06, .38), (.2, .12), (.47, 0), (.74, .06),
                  (.9, .2)]), (False, [(.9, .2), (.9, .45), (.58, .45)])]),
    (30, [(False, [(.86, 1), (.12, 1), (.12, 0), (.9, 0)]), (False, [(.12, .52), (.74, .52)])]),
)


def smooth(points):
    """A Catmull-Rom curve through the points."""
    ends = [points[0], *points, points[-1]]
    curve = []
    for i in range(1, len(points)):
        a, b, c, d = ends[i - 1:i + 3]
        for k in range(8):
            t = k / 8
            curve.append(tuple(.5 * (2 * b[j] + (c[j] - a[j]) * t + (2 * a[j] - 5 * b[j] + 4 * c[j] - d[j]) * t * t
                                     + (3 * b[j] - a[j] - 3 * c[j] + d[j]) * t ** 3) for j in (0, 1)))
    return curve + [points[-1]]


class Noise:
    """Smooth noise from -1 to 1 with features of `scale` mm."""

    def __init__(self, seed, scale):
        draw = random.Random(seed)
        self.scale, self.grid = scale, [[draw.uniform(-1, 1) for _ in range(128)] for _ in range(128)]

    def __call__(self, x, y):
        x, y = x / self.scale, y / self.scale
        i, j = int(x) % 127, int(y) % 127
        u, v = (t * t * (3 - 2 * t) for t in (x % 1, y % 1))
        top = self.grid[j][i] * (1 - u) + self.grid[j][i + 1] * u
        return top * (1 - v) + (self.grid[j + 1][i] * (1 - u) + self.grid[j + 1][i + 1] * u) * v


def segments():
    """((x, y), (x, y), way of the pen until there) of all strokes, mm."""
    way, left = 0, LEFT
    for width, strokes in LETTERS:
        for curved, points in strokes:
            line = [(left + x * width, BOTTOM + y * HEIGHT) for x, y in (smooth(points) if curved else points)]
            for a, b in zip(line, line[1:]):
                yield a, b, way
                way += math.dist(a, b)
        left += width + 9
        way += 4


def draw():
    edge, fine, pace = Noise(1, 6), Noise(2, 1.7), Noise(3, 9)
    columns, rows = SIZE[0] * SCALE, SIZE[1] * SCALE
    late = {}
    for (ax, ay), (bx, by), way in segments():
        length = math.dist((ax, ay), (bx, by))
        for row in range(int((SIZE[1] - max(ay, by) - 6) * SCALE), int((SIZE[1] - min(ay, by) + 6) * SCALE)):
            for column in range(int((min(ax, bx) - 6) * SCALE), int((max(ax, bx) + 6) * SCALE)):
                x, y = (column + .5) / SCALE, SIZE[1] - (row + .5) / SCALE
                along = max(0, min(1, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length ** 2))
                off = math.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay))
                if off > HALF + 1.2 or off > HALF + .7 * edge(x, y) + .5 * fine(x, y):
                    continue
                time = way + along * length + .9 * off + 2.5 * pace(x, y)  # the middle goes ahead
                late[row, column] = min(time, late.get((row, column), math.inf))
    low, high = min(late.values()), max(late.values())
    grey = {at: round(254 * (time - low) / (high - low)) for at, time in late.items()}
    return [bytes(grey.get((row, column), 255) for column in range(columns)) for row in range(rows)]


def main():
    lines = draw()
    path = pathlib.Path(__file__).resolve().parent.parent / "examples/title/title.png"

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", len(lines[0]), len(lines), 8, 0, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + line for line in lines), 9)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b""))
    print(f"{path.name}: {path.stat().st_size // 1000} kB")


main()
