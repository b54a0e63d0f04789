#!/usr/bin/env python3
"""Makes the meshes of examples/garment: a shirt as it is simulated and as it is sewn.

    scripts/make_garment.py [FOLDER]

shirt.obj is a coarse sheet of quads, 24 mm wide: scripts/make_shirt.py's shirt with half as many columns and rows.
sewn.obj is what is drawn: the same surface with cells of 15 mm, a placket and ribs at the neck, hems and cuffs that are
thick, seams along the sides, the shoulders and the arms, and five buttons of 14 mm with a rim and four holes' dents.
"""
import math
import pathlib
import sys

import make_shirt as pattern

PLACKET, HEM, SEAM = 0.018, 0.022, 0.0025   # half widths; the hem's height
COARSE = {"COLUMNS": 22, "ROWS": 24, "SLEEVE_COLUMNS": 8, "NECK": 5, "ARM_ROW": 16}
FINE = {"COLUMNS": 36, "ROWS": 39, "SLEEVE_COLUMNS": 12, "NECK": 8, "ARM_ROW": 26}


class Mesh(pattern.Shirt):
    """Quads, and strips and buttons that lie on the shirt."""

    def cell(self, corners):
        self.faces.append(tuple(corners))

    def strip(self, path, normals, half, height, uv):
        """A band along a path, half as wide as `half`, that rises to `height` in the middle of its rounded section.

        uv: of each point of the path."""
        section = [(-1, 0.0), (-0.8, 0.8), (0.0, 1.0), (0.8, 0.8), (1, 0.0)]
        rings = []
        for k, (p, n) in enumerate(zip(path, normals)):
            before, after = path[max(k - 1, 0)], path[min(k + 1, len(path) - 1)]
            along = unit([b - a for a, b in zip(before, after)])
            across = unit(cross(along, n))
            rings.append([(self.fresh([p[i] + s * half * across[i] + (h * height - 2e-4) * n[i] for i in range(3)]),
                           self.uv("strip", *uv[k])) for s, h in section])
        for a, b in zip(rings, rings[1:]):
            for i in range(len(section) - 1):
                self.cell([a[i], b[i], b[i + 1], a[i + 1]])

    def fresh(self, place):
        """A vertex of its own, so that a part hangs together only within itself."""
        self.places.append(tuple(place))
        return len(self.places)

    def button(self, p, n, radius, uv):
        side = unit(cross(n, (0, 0, 1)))
        up = cross(side, n)
        # rings: back, outer edge, rim, dish
        rings = []
        for r, h in ((0.9, 0.3e-3), (1.0, 1.0e-3), (0.95, 2.1e-3), (0.78, 2.2e-3), (0.66, 1.5e-3), (0.3, 1.4e-3),
                     (0.18, 0.9e-3)):
            ring = []
            for k in range(16):
                a = 2 * math.pi * k / 16
                ring.append((self.fresh([p[i] + radius * r * (math.cos(a) * side[i] + math.sin(a) * up[i]) + h * n[i]
                                         for i in range(3)]), self.uv("button", *uv)))
            rings.append(ring)
        for a, b in zip(rings, rings[1:]):
            for k in range(16):
                self.cell([a[k - 1], b[k - 1], b[k], a[k]])
        self.faces.append(tuple(rings[-1][::-1]))
        self.faces.append(tuple(rings[0]))


def unit(v):
    length = math.sqrt(sum(c * c for c in v)) or 1
    return [c / length for c in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def body(mesh):
    """The sheet: front, back and sleeves, as make_shirt sews them."""
    p = pattern
    for side in ("front", "back"):
        mesh.block(side, range(p.COLUMNS), range(p.ROWS), lambda i, j: p.body_place(i, j, side),
                   lambda i, j: body_uv(p.body_place(i, j, side), side), side == "back")
    for hand in (-1, 1):
        for side in ("front", "back"):
            def uv(s, j):
                around = (p.ROWS - j) * (1 if side == "front" else -1) / (p.ROWS - p.ARM_ROW)
                return (0.15 if hand < 0 else 0.65) + 0.17 * around * 0.75, 0.97 - 0.2 * s / p.SLEEVE_COLUMNS
            mesh.block("sleeve%d" % hand, range(p.SLEEVE_COLUMNS), range(p.ARM_ROW, p.ROWS),
                       lambda s, j: p.sleeve_place(hand, s, j, side), uv, (side == "back") == (hand > 0))


def body_uv(place, side):
    left = 0.03 if side == "front" else 0.53
    x, _, z = place
    return (left + (x if side == "front" else -x) / 1.2 + pattern.HALF_WIDTH / 1.2,
            0.03 + (z - pattern.HEM) / 1.2)


def normal_at(place, i, j):
    """Outwards, from differences of a surface place(i, j)."""
    e = 0.05
    along = [b - a for a, b in zip(place(i - e, j), place(i + e, j))]
    up = [b - a for a, b in zip(place(i, j - e), place(i, j + e))]
    return unit(cross(along, up))


def front(i, j):
    """The front as a surface over real columns and rows: make_shirt's, between its rows."""
    return pattern.body_place(i, j, "front")


def sew(mesh):
    p = pattern
    middle, rows = p.COLUMNS / 2, [p.ROWS * k / 48 for k in range(49)]

    # the placket: a flat band down the middle of the front, and a line of stitches on either side of it
    def line(offset):
        at = [front(middle + offset / (2 * p.HALF_WIDTH) * p.COLUMNS, j) for j in rows]
        return at, [normal_at(front, middle + offset / (2 * p.HALF_WIDTH) * p.COLUMNS, j) for j in rows]
    path, normals = line(0.0)
    mesh.strip(path, normals, PLACKET, 0.0016, [body_uv(q, "front") for q in path])
    for offset in (-PLACKET + 0.003, PLACKET - 0.003):
        at, up = line(offset)
        at = [[q[k] + 1.3e-3 * n[k] for k in range(3)] for q, n in zip(at, up)]
        mesh.strip(at, up, 0.0008, 0.0006, [body_uv(q, "front") for q in at])
    for k in range(5):
        j = p.ROWS * (0.12 + 0.185 * k)
        at, n = front(middle, j), normal_at(front, middle, j)
        mesh.button([at[i] + 1.2e-3 * n[i] for i in range(3)], n, 0.0072, (0.985, 0.985))

    # hem: a doubled edge all around, front and back, with its line of stitches
    for side, turn in (("front", 1), ("back", -1)):
        def place(i, j, side=side):
            return p.body_place(min(max(i, 0), p.COLUMNS), j, side)
        columns = [p.COLUMNS * k / 44 for k in range(45)]
        for height, half, high in ((0.006, 0.006, 0.0016), (0.0135, 0.0008, 0.0010)):
            j = height / (p.NECK_TOP - p.HEM) * p.ROWS
            path = [place(i, j) for i in columns]
            normals = []
            for i in columns:
                n = normal_at(place, min(max(i, 0.06), p.COLUMNS - 0.06), j + 0.06)
                normals.append([turn * c for c in n])
            if side == "back":
                path, normals, = path[::-1], normals[::-1]
            mesh.strip(path, normals, half, high, [body_uv(q, side) for q in path])

        # the rib of the neck, and the shoulders' seams
        def rim(i, down):
            return place(i, p.ROWS - down)
        neck = [p.COLUMNS / 2 + p.NECK * (k / 20 - 1) for k in range(41)]
        path = [rim(i, 0.35) for i in neck]
        normals = [[turn * c for c in normal_at(place, i, p.ROWS - 0.6)] for i in neck]
        if side == "back":
            path, normals = path[::-1], normals[::-1]
        mesh.strip(path, normals, 0.0055, 0.0026, [body_uv(q, side) for q in path])

    # seams around the arms and down the sides: ridges
    for hand in (-1, 1):
        column = 0 if hand < 0 else p.COLUMNS
        around = [(j, "front") for j in range(p.ARM_ROW, p.ROWS + 1)]
        around += [(j, "back") for j in range(p.ROWS - 1, p.ARM_ROW - 1, -1)]
        path = [p.body_place(column, j, side) for j, side in around]
        mesh.strip(path, [[hand, 0, 0.25]] * len(path), SEAM, 0.0014, [body_uv(q, "front") for q in path])
        path = [p.body_place(column, j, "front") for j in range(p.ARM_ROW + 1)]
        mesh.strip(path, [[hand, 0, 0]] * len(path), SEAM, 0.0014, [body_uv(q, "front") for q in path])

        # cuffs
        for s, half, high in ((p.SLEEVE_COLUMNS - 0.5, 0.0055, 0.0016), (p.SLEEVE_COLUMNS - 1.2, 0.0008, 0.0010)):
            path, normals = [], []
            for j, side in around:
                at = sleeve(hand, s, j, side)
                path.append(at)
                core = sleeve(hand, s, (p.ROWS + p.ARM_ROW) / 2, "front")
                inner = sleeve(hand, s, (p.ROWS + p.ARM_ROW) / 2, "back")
                out = [at[k] - 0.5 * (core[k] + inner[k]) for k in range(3)]
                axis = unit([b - a for a, b in zip(sleeve(hand, s - 1, j, side), at)])
                along = sum(a * b for a, b in zip(out, axis))
                normals.append(unit([o - along * a for o, a in zip(out, axis)]))
            if hand > 0:
                path, normals = path[::-1], normals[::-1]
            mesh.strip(path, normals, half, high, [(0.4, 0.8)] * len(path))


def sleeve(hand, s, j, side):
    return pattern.sleeve_place(hand, s, j, side)


def write(mesh, path, what):
    used = sorted({corner[0] for face in mesh.faces for corner in face})
    number = {v: k + 1 for k, v in enumerate(used)}
    with open(path, "w", encoding="ascii") as file:
        file.write("# %s, made by scripts/make_garment.py: metres, z up\n" % what)
        for v in used:
            file.write("v %.4f %.4f %.4f\n" % tuple(mesh.places[v - 1]))
        for uv in mesh.uvs:
            file.write("vt %.4f %.4f\n" % uv)
        for face in mesh.faces:
            file.write("f " + " ".join("%d/%d" % (number[v], uv) for v, uv in face) + "\n")
    print("%s: %d vertices, %d faces" % (path, len(used), len(mesh.faces)))


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else root / "examples" / "garment"
    for values, name, what in ((COARSE, "shirt.obj", "a shirt to simulate"), (FINE, "sewn.obj", "a shirt to draw")):
        for key, value in values.items():
            setattr(pattern, key, value)
        mesh = Mesh()
        body(mesh)
        if values is FINE:
            sew(mesh)
        write(mesh, folder / name, what)


if __name__ == "__main__":
    main()
