#!/usr/bin/env python3
"""Makes meshes of every kind that users bring, and their broken twins, as OBJ, PLY and GLB files.

    scripts/make_meshes.py DIR [NAME...]     all of them, or the named ones
    scripts/make_meshes.py --list            names, classes and descriptions

A mesh is about 20 cm large, around the origin, in metres and z up, unless its description says otherwise. The files are
the same each time. tests/meshes runs a scene with each of them (docs/meshes.md).
"""

import argparse
import math
import os
import random
from pathlib import Path

from mesh_files import Mesh, mesh_bytes

SIZE = 0.2  # m


# ---- shapes


def grid(nx=16, ny=16, place=None, uv=True):
    """nx x ny quads; place(s, t) puts the point at (s, t) of the unit square."""
    place = place or (lambda s, t: (SIZE * (s - 0.5), SIZE * (t - 0.5), 0.004 * math.sin(9 * s) * math.cos(7 * t)))
    lines = [(i / nx, j / ny) for j in range(ny + 1) for i in range(nx + 1)]
    faces = []
    for j in range(ny):
        for i in range(nx):
            v = j * (nx + 1) + i
            faces.append((v, v + 1, v + nx + 2, v + nx + 1))
    return Mesh([place(s, t) for s, t in lines], faces, lines if uv else None)


def ring(n, m, place, closed=False):
    """n quads around, m along; closed: the other way around as well."""
    rows = m if closed else m + 1
    points = [place(i / n, j / m) for j in range(rows) for i in range(n)]
    faces = []
    for j in range(m):
        below, above = j * n, (j + 1) % rows * n
        for i in range(n):
            k = (i + 1) % n
            faces.append((below + i, below + k, above + k, above + i))
    return Mesh(points, faces)


def circle(turn, radius):
    return radius * math.cos(2 * math.pi * turn), radius * math.sin(2 * math.pi * turn)


def tube():
    return ring(24, 12, lambda s, t: (*circle(s, 0.06), SIZE * (t - 0.5)))


def torus():
    def place(s, t):
        across, up = circle(t, 0.03)
        return (*circle(s, 0.08 + across), up)
    return ring(28, 12, place, closed=True)


def ball(n=7):
    """A cube of 6 n x n quads blown up to a ball: corners of valence 3."""
    points, numbers, faces = [], {}, []

    def number(p):
        if p not in numbers:
            numbers[p] = len(points)
            length = math.sqrt(sum((2 * c / n - 1) ** 2 for c in p))
            points.append(tuple(0.5 * SIZE * (2 * c / n - 1) / length for c in p))
        return numbers[p]

    for axis in range(3):
        for end in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    if end == 0:
                        corners.reverse()
                    face = []
                    for a, b in corners:
                        p = [0, 0, 0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = end, a, b
                        face.append(number(tuple(p)))
                    faces.append(tuple(face))
    return Mesh(points, faces)


def high_valence(n=40, rings=5):
    """Quads around a vertex of valence 40 whose other three corners are of valence 3 and more."""
    def at(turn, radius):
        x, y = circle(turn, radius)
        return x, y, 0.3 * (0.1 - radius)
    points, faces = [(0, 0, 0.03)], []
    for r in range(1, rings + 1):
        points += [at((i + 0.5 * (r % 2)) / n, 0.1 * r / rings) for i in range(n)]
    for i in range(n):  # two sides of each are spokes, the outer corner lies between them
        faces.append((0, 1 + i, n + 1 + (i + 1) % n, 1 + (i + 1) % n))
    for r in range(1, rings - 1):
        shift = (r + 1) % 2
        for i in range(n):
            a, b = 1 + (r - 1) * n, 1 + r * n
            c = b + n
            inner = a + (i + shift) % n
            left, right = b + i, b + (i + 1) % n
            faces.append((inner, left, c + (i + shift) % n, right))
    return Mesh(points, faces)


def cone(n=40, rings=8):
    """A fan of 40 triangles around the tip, quads below."""
    points = [(0, 0, 0.06)]
    for r in range(1, rings + 1):
        points += [(*circle(i / n, 0.1 * r / rings), 0.06 - 0.06 * r / rings) for i in range(n)]
    faces = [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)]
    for r in range(1, rings):
        a, b = 1 + (r - 1) * n, 1 + r * n
        faces += [(a + i, b + i, b + (i + 1) % n, a + (i + 1) % n) for i in range(n)]
    return Mesh(points, faces)


def t_junctions():
    """Coarse cells beside fine ones, joined at every second vertex of the fine side only."""
    fine = grid(12, 24, lambda s, t: (0.1 * s, SIZE * (t - 0.5), 0))
    coarse = grid(6, 12, lambda s, t: (0.1 * (s - 1), SIZE * (t - 0.5), 0))
    mesh = fine.joined(coarse)
    base = len(fine.points)
    same = {base + j * 7 + 6: 2 * j * 13 for j in range(13)}
    return mesh.merged(same)


def slivers():
    """Every third row a twentieth as high as the others, and leaning."""
    heights = [0.0]
    for j in range(15):
        heights.append(heights[-1] + (0.05 if j % 3 == 1 else 1))
    total = heights[-1]
    return grid(16, 15, lambda s, t: (SIZE * (s - 0.5) + 0.01 * t, SIZE * (heights[round(15 * t)] / total - 0.5), 0))


def stretched():
    return grid(5, 60, lambda s, t: (SIZE * (s - 0.5), SIZE * (t - 0.5), 0.003 * math.sin(8 * s)))


def tiny_cells():
    """Cells of 18 mm at the rim and of half a millimetre in the middle."""
    def warp(t):
        x = 2 * t - 1
        return 0.08 * x * abs(x) + 0.02 * x ** 3
    return grid(24, 24, lambda s, t: (warp(s), warp(t), 0))


def components():
    patch = grid(8, 8).moved(scale=0.5)
    mesh = patch
    for i in range(1, 4):
        mesh = mesh.joined(patch.moved(x=0.12 * (i % 2), y=0.12 * (i // 2), z=0.01 * i))
    return mesh


def charts():
    """One uv a corner: the left half's picture lies elsewhere than the right half's, with a seam between."""
    mesh = grid(16, 16)
    uv, faces = [], []
    for half in (0, 1):
        uv += [(0.45 * s + 0.1 * half, 0.9 * t) for s, t in mesh.uv]
    for i, f in enumerate(mesh.faces):
        faces.append(tuple(v + (len(mesh.uv) if i % 16 >= 8 else 0) for v in f))
    return Mesh(mesh.points, mesh.faces, corner_uv=(uv, faces))


def split_seam():
    """The same with the vertices of the seam doubled, at the same places."""
    mesh = charts()
    uv, corners = mesh.corner_uv
    used = sorted({c for f in corners for c in f})
    number = {c: i for i, c in enumerate(used)}
    half = len(mesh.points)
    return Mesh([mesh.points[c % half] for c in used], [tuple(number[c] for c in f) for f in corners],
                [uv[c] for c in used])


def split_seam_apart():
    """The same, the two sides of the seam a micrometre apart, as exporters round."""
    mesh = split_seam()
    right = {v for f in mesh.faces[8:16] for v in f} | {v for i, f in enumerate(mesh.faces) if i % 16 >= 8 for v in f}
    mesh.points = [(x + 1e-6 * (v in right), y, z) for v, (x, y, z) in enumerate(mesh.points)]
    return mesh


def honeycomb():
    """Hexagons."""
    side = 0.008
    points, numbers, faces = [], {}, []
    for row in range(11):
        for column in range(11):
            cx, cy = (column + 0.5 * (row % 2)) * side * math.sqrt(3), row * 1.5 * side
            face = []
            for k in range(6):
                angle = math.pi / 6 + k * math.pi / 3
                p = cx + side * math.cos(angle) - 0.08, cy + side * math.sin(angle) - 0.07
                key = round(p[0] / side * 4), round(p[1] / side * 4)
                if key not in numbers:
                    numbers[key] = len(points)
                    points.append((*p, 0.0))
                face.append(numbers[key])
            faces.append(tuple(face))
    return Mesh(points, faces)


def mixed():
    """Quads, triangles, and a few pentagons and hexagons made by leaving edges out."""
    mesh = grid()
    faces = []
    for i, f in enumerate(mesh.faces):
        if i % 16 in (4, 5, 6) and i // 16 % 2:
            faces += [(f[0], f[1], f[2]), (f[0], f[2], f[3])]
        elif i % 16 == 10:
            g = mesh.faces[i + 1]
            faces.append((f[0], f[1], g[1], g[2], f[2], f[3]))  # six corners around two quads
        elif i % 16 != 11:
            faces.append(f)
    return Mesh(mesh.points, faces, mesh.uv)


def keyholes():
    """Squares with a square hole each, which a bridge leads to: ten corners that name eight vertices."""
    def place(i, j):
        return SIZE * (i / 40 - 0.5), SIZE * (j / 40 - 0.5), 0.004 * math.sin(0.2 * i) * math.cos(0.15 * j)
    points, faces, at = [], [], {}

    def number(i, j):
        if (i, j) not in at:
            at[i, j] = len(points)
            points.append(place(i, j))
        return at[i, j]
    for i in range(0, 40, 4):
        for j in range(0, 40, 4):
            outer = [number(i + x, j + y) for x, y in ((0, 0), (4, 0), (4, 4), (0, 4))]
            inner = [number(i + x, j + y) for x, y in ((1, 1), (1, 3), (3, 3), (3, 1))]
            faces.append((*outer, outer[0], *inner, inner[0]))
    return Mesh(points, faces)


def scattered():
    """Triangles of uneven shape: a jittered grid cut along random diagonals."""
    generator = random.Random(3)
    def place(s, t):
        edge = s in (0, 1) or t in (0, 1)
        x, y = (0 if edge else generator.uniform(-0.3, 0.3) / 16 for _ in range(2))
        return SIZE * (s + x - 0.5), SIZE * (t + y - 0.5), 0
    return grid(16, 16, place).triangles(seed=5)


# ---- broken ones


def sheet_with(change):
    mesh = grid()
    change(mesh)
    return mesh


def non_manifold():
    """A fin stands on an edge in the middle of a sheet: three faces at that edge."""
    def change(mesh):
        v = 8 * 17 + 8
        mesh.points += [(x, y, z + 0.02) for x, y, z in (mesh.points[v], mesh.points[v + 1])]
        mesh.uv = None
        mesh.faces.append((v, v + 1, len(mesh.points) - 1, len(mesh.points) - 2))
    return sheet_with(change)


def tent():
    """A tent stands on a sheet: three faces, all of one sheet, at each side of its two feet."""
    mesh = grid(uv=False)
    base = len(mesh.points)
    mesh.points += [(x, y, z + 0.02) for x, y, z in (mesh.points[17 * j + 8] for j in range(17))]
    for j in range(16):
        left, right, top = 17 * j + 6, 17 * j + 10, base + j
        mesh.faces += [(left, left + 17, top + 1, top), (top, top + 1, right + 17, right)]
    return mesh


def moebius():
    n, m = 40, 6
    def place(s, t):
        angle, across = 2 * math.pi * s, 0.06 * (t - 0.5)
        radius = 0.08 + across * math.cos(angle / 2)
        return radius * math.cos(angle), radius * math.sin(angle), across * math.sin(angle / 2)
    mesh = grid(n, m, place, uv=False)
    # the last column of points is the first, upside down
    same = {j * (n + 1) + n: (m - j) * (n + 1) for j in range(m + 1)}
    return mesh.merged(same)


def winding():
    def change(mesh):
        mesh.faces = [tuple(reversed(f)) if i % 7 == 3 else f for i, f in enumerate(mesh.faces)]
    return sheet_with(change)


def duplicate_faces():
    def change(mesh):
        f, g = mesh.faces[20], mesh.faces[100]
        mesh.faces += [f, g[1:] + g[:1]]
    return sheet_with(change)


def degenerate_faces():
    """A quad whose corners lie on a line, and one whose corners all lie at a point."""
    def change(mesh):
        base = len(mesh.points)
        mesh.points += [(0.01 * k, 0, 0.05) for k in range(4)] + [(0.03, 0.03, 0.05)] * 4
        mesh.uv = mesh.uv + [(0, 0)] * 8
        mesh.faces += [tuple(base + k for k in range(4)), tuple(base + 4 + k for k in range(4))]
    return sheet_with(change)


def repeated_vertex():
    """A quad that names a corner twice, which makes it a triangle."""
    def change(mesh):
        f = mesh.faces[40]
        mesh.faces[40] = (f[0], f[1], f[2], f[2])
    return sheet_with(change)


def not_a_number():
    def change(mesh):
        mesh.points[50] = (math.nan, 0, 0)
    return sheet_with(change)


def infinite():
    def change(mesh):
        mesh.points[50] = (0, math.inf, 0)
    return sheet_with(change)


def out_of_range():
    def change(mesh):
        mesh.faces[60] = (*mesh.faces[60][:3], len(mesh.points) + 5)
    return sheet_with(change)


def bow_tie():
    """Two patches that share one vertex."""
    one = grid(10, 10, lambda s, t: (0.1 * s, 0.1 * t, 0), uv=False)
    other = grid(10, 10, lambda s, t: (0.1 * (s - 1), 0.1 * (t - 1), 0), uv=False)
    mesh = one.joined(other)
    last = len(mesh.points) - 1  # of the other, where the one begins
    return Mesh(mesh.points[:-1], [tuple(0 if v == last else v for v in f) for f in mesh.faces])


def inside_out():
    mesh = ball()
    return Mesh(mesh.points, [tuple(reversed(f)) for f in mesh.faces])


def empty():
    return Mesh()


def no_faces():
    return Mesh(grid().points)


def isolated_vertices():
    def change(mesh):
        mesh.points += [(1, 1, 1), (0.05, 0.02, 0.03)]
        mesh.uv = mesh.uv + [(0, 0), (0, 0)]
    return sheet_with(change)


def crossed():
    """Two sheets in one file that go through each other from the start."""
    upright = grid(12, 12, lambda s, t: (0.1 * (s - 0.5) + 0.003, 0.002, 0.1 * (t - 0.5) + 0.003), uv=False)
    return grid(16, 16, uv=False).joined(upright)


def millimetres():
    return grid().moved(scale=1000)


def y_up():
    mesh = grid()
    return Mesh([(x, z, -y) for x, y, z in mesh.points], mesh.faces, mesh.uv)


# name: (file's ending, class, maker, what it is)
MESHES = {
    "open": ("obj", "good", grid, "a wavy sheet of quads"),
    "open-ascii": ("ply", "good", grid, "the same as PLY"),
    "open-binary": ("plyb", "good", grid, "the same as binary PLY"),
    "open-glb": ("glb", "good", lambda: grid().triangles(), "the same as GLB, which has triangles only"),
    "tube": ("obj", "good", tube, "two boundaries"),
    "closed": ("obj", "good", ball, "a ball of quads, eight vertices of valence 3"),
    "torus": ("obj", "good", torus, "genus 1"),
    "torus-triangles": ("ply", "good", lambda: torus().triangles(), "genus 1"),
    "high-valence": ("obj", "good", high_valence, "40 quads at a vertex"),
    "cone": ("obj", "good", cone, "40 triangles at the tip, quads below"),
    "t-junctions": ("obj", "good", t_junctions, "a seam of fine and coarse cells"),
    "slivers": ("obj", "good", slivers, "rows of quads a twentieth as high as long"),
    "sliver-triangles": ("obj", "good", lambda: slivers().triangles(), "the same cut into triangles"),
    "stretched": ("obj", "good", stretched, "cells twelve times as long as wide"),
    "tiny-cells": ("obj", "good", tiny_cells, "cells of 18 mm, and of half a millimetre in the middle"),
    "components": ("obj", "good", components, "four patches in one file"),
    "charts": ("obj", "good", charts, "two uv charts, one uv a corner"),
    "split-seam": ("obj", "good", split_seam, "a uv seam whose vertices are doubled"),
    "split-seam-apart": ("obj", "good", split_seam_apart, "the same, 1 um apart"),
    "triangles": ("obj", "good", lambda: grid().triangles(), "a sheet of regular triangles"),
    "scattered": ("obj", "good", scattered, "a sheet of uneven triangles"),
    "mixed": ("obj", "good", mixed, "triangles, quads and hexagons"),
    "keyholes": ("obj", "good", keyholes, "squares with holes"),
    "honeycomb": ("obj", "good", honeycomb, "hexagons"),
    "millimetres": ("obj", "good", millimetres, "in millimetres"),
    "y-up": ("obj", "good", y_up, "y up"),
    "inside-out": ("obj", "good", inside_out, "a closed ball wound inwards"),
    "crossed": ("obj", "broken", crossed, "goes through itself from the start"),
    "isolated-vertices": ("obj", "broken", isolated_vertices, "vertices of no face"),
    "non-manifold": ("obj", "broken", non_manifold, "three faces at an edge"),
    "tent": ("obj", "broken", tent, "three faces of one sheet at an edge"),
    "moebius": ("obj", "broken", moebius, "a band with one side"),
    "winding": ("obj", "broken", winding, "some faces turned over"),
    "duplicate-faces": ("obj", "broken", duplicate_faces, "two doubled faces"),
    "degenerate-faces": ("obj", "broken", degenerate_faces, "faces without area"),
    "repeated-vertex": ("obj", "broken", repeated_vertex, "a quad with a corner twice"),
    "not-a-number": ("obj", "broken", not_a_number, "a coordinate is NaN"),
    "not-a-number-binary": ("plyb", "broken", not_a_number, "the same in binary PLY"),
    "infinite": ("plyb", "broken", infinite, "a coordinate is infinite"),
    "out-of-range": ("obj", "broken", out_of_range, "a face names no vertex"),
    "out-of-range-binary": ("plyb", "broken", out_of_range, "the same in binary PLY"),
    "bow-tie": ("obj", "broken", bow_tie, "two patches share a vertex"),
    "empty": ("obj", "broken", empty, "nothing in the file"),
    "no-faces": ("obj", "broken", no_faces, "vertices only"),
    "empty-ply": ("ply", "broken", empty, "no vertices, no faces"),
}


# ---- the command


def file_name(name):
    return f"{name}.{MESHES[name][0].replace('plyb', 'ply')}"


def write(name, folder):
    ending, _, make, _ = MESHES[name]
    path = os.path.join(folder, file_name(name))
    Path(path).write_bytes(mesh_bytes(make(), ending))
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?")
    parser.add_argument("names", nargs="*", metavar="name")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    if options.list:
        for name, (_, kind, _, text) in MESHES.items():
            print(f"{file_name(name):28}{kind:8}{text}")
        return
    if not options.folder:
        parser.error("needs DIR")
    unknown = [name for name in options.names if name not in MESHES]
    if unknown:
        parser.error(f"no mesh {', '.join(unknown)}; --list has the names")
    os.makedirs(options.folder, exist_ok=True)
    for name in options.names or MESHES:
        print(write(name, options.folder))


if __name__ == "__main__":
    main()
