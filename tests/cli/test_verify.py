"""singe verify: a good cache passes, faults of every kind are found and named, crossings as in rational numbers."""

import itertools
import math
import os
import random
import signal
import struct
from pathlib import Path
from fractions import Fraction

from support import Case, Ply

FLOATS = ("x y z nx ny nz s t vx vy vz rest_x rest_y rest_z temperature temperature_peak mass burn_rate "
          "char_fraction ash_fraction burnt time_ignited").split()
INTEGERS = "piece_id vertex_id sheet".split()
KINDS = ("crossings", "inverted_cells", "stretched_edges", "non_manifold_edges", "winding", "degenerate_triangles",
         "duplicate_triangles", "not_finite", "missing", "index", "stats")


class Surface:
    """A frame of a cache: rows of values by name, and triangles."""

    def __init__(self, path=None, positions=(), triangles=()):
        self.columns = [("float", n) for n in FLOATS] + [("int", n) for n in INTEGERS]
        self.time = "0"
        self.vertices = [self.vertex(p) for p in positions]
        self.triangles = [list(t) for t in triangles]
        if path:
            self.read(path)

    @staticmethod
    def vertex(position):
        row = dict.fromkeys(FLOATS + INTEGERS, 0)
        for axis, value in zip("xyz", position):
            row[axis] = row["rest_" + axis] = value
        return row

    def form(self):
        return "<" + "".join("i" if kind == "int" else "f" for kind, _ in self.columns)

    def read(self, path):
        frame = Ply(path)
        self.time = frame.time
        self.vertices = frame.vertices()
        self.triangles = [list(corners) for corners in frame.triangles]

    def write(self, path):
        lines = ["ply", "format binary_little_endian 1.0", f"comment singe 0.2.0 time {self.time}",
                 f"element vertex {len(self.vertices)}"]
        lines += [f"property {kind} {name}" for kind, name in self.columns]
        lines += [f"element face {len(self.triangles)}", "property list uchar int vertex_indices", "end_header", ""]
        with open(path, "wb") as file:
            file.write("\n".join(lines).encode())
            for row in self.vertices:
                file.write(struct.pack(self.form(), *(row[name] for _, name in self.columns)))
            for triangle in self.triangles:
                file.write(struct.pack("<B3i", 3, *triangle))


# ---- crossings in rational numbers, by cutting instead of by signs


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normal(t):
    return cross(minus(t[1], t[0]), minus(t[2], t[0]))


def between(p, q, f, g):
    """Where a linear function of f at p and g at q is 0."""
    return [x + (y - x) * f / (f - g) for x, y in zip(p, q)]


def cut(polygon, inward, origin):
    """The part of a polygon with inward . (p - origin) >= 0."""
    kept = []
    for i, p in enumerate(polygon):
        q = polygon[(i + 1) % len(polygon)]
        f, g = dot(inward, minus(p, origin)), dot(inward, minus(q, origin))
        if f >= 0:
            kept.append(p)
        if f * g < 0:
            kept.append(between(p, q, f, g))
    return kept


def overlap_in_plane(a, b):
    n, polygon = normal(a), list(b)
    for i in range(3):
        polygon = cut(polygon, cross(n, minus(a[(i + 1) % 3], a[i])), a[i])
    twice = [sum(c) for c in zip([0] * 3, *(cross(minus(p, a[0]), minus(q, a[0])) for p, q in
                                          zip(polygon, polygon[1:] + polygon[:1])))]
    return any(twice)


def within(p, q, t):
    """Whether a segment in the plane of a triangle has points of its inside."""
    low, high, n = Fraction(0), Fraction(1), normal(t)
    for i in range(3):
        inward = cross(n, minus(t[(i + 1) % 3], t[i]))
        f, g = dot(inward, minus(p, t[i])), dot(inward, minus(q, t[i]))
        if f <= 0 and g <= 0:
            return False
        if f < 0:
            low = max(low, f / (f - g))
        if g < 0:
            high = min(high, f / (f - g))
    return low < high


def triangles_cross(a, b):
    n = normal(a)
    height = [dot(n, minus(p, a[0])) for p in b]
    if not any(height):
        return overlap_in_plane(a, b)
    if min(height) >= 0 or max(height) <= 0:
        return False
    ends = [p for p, h in zip(b, height) if h == 0]
    sides = [(i, j) for i, j in ((0, 1), (1, 2), (2, 0)) if height[i] * height[j] < 0]
    ends += [between(b[i], b[j], height[i], height[j]) for i, j in sides]
    return within(*ends, a)


def neighbours(triangles, at):
    """Pairs of triangles at an edge, as (a, b): (its ends, a's other corner, b's other corner)."""
    places = {}
    for number, t in enumerate(triangles):
        for k in range(3):
            ends = sorted(((tuple(at[number][i]), t[i]) for i in (k, (k + 1) % 3)))
            place, names = tuple(p for p, _ in ends), tuple(v for _, v in ends)
            places.setdefault(place, {}).setdefault(names, []).append((number, at[number][(k + 2) % 3]))
    joined = []
    for place, edges in places.items():
        groups = [g for g in edges.values() if len(g) == 2]
        alone = [g[0] for g in edges.values() if len(g) == 1]
        joined += [(place, *g) for g in groups + ([alone] if len(alone) == 2 else [])]
    return joined


def angle(axis, origin, first, p):
    """A number that grows with the angle about an axis, from that of `first`: 0 to 4."""
    along = dot(axis, axis)
    flat = [minus(v, [dot(v, axis) / along * c for c in axis]) for v in (minus(first, origin), minus(p, origin))]
    x, y = dot(*flat), dot(cross(axis, flat[0]), flat[1])
    # not the angle, but as monotonous: squares of cosine and sine by quadrant
    cosine = x * x * along / (x * x * along + y * y)
    if y == 0:
        return Fraction(0 if x > 0 else 2)
    if y > 0:
        return 1 - cosine if x >= 0 else 1 + cosine
    return 3 - cosine if x <= 0 else 3 + cosine


def hinges_cross(one, other):
    """Whether two edges, each with its two triangles, cross along a length that they have in common."""
    (p, q), (_, a), (_, b) = one
    (r, s), (_, t), (_, u) = other
    axis = minus(q, p)
    if any(cross(axis, minus(r, p))) or any(cross(axis, minus(s, p))):
        return False
    ends = sorted(dot(axis, minus(e, p)) / dot(axis, axis) for e in (r, s))
    if ends[1] <= 0 or ends[0] >= 1:
        return False
    b, t, u = (angle(axis, p, a, e) for e in (b, t, u))
    t, u = sorted((t, u))
    return 0 < t < b < u


def crossings(surface):
    at = [[[Fraction(surface.vertices[v][axis]) for axis in "xyz"] for v in t] for t in surface.triangles]
    found = {(a, b) for a, b in itertools.combinations(range(len(at)), 2) if triangles_cross(at[a], at[b])}
    insides = len(found)
    edges = neighbours(surface.triangles, at)
    for (p, q), (a, one), (b, other) in edges:
        for number, t in enumerate(at):
            n = normal(t)
            sides = [dot(n, minus(v, t[0])) for v in (p, q, one, other)]
            if number not in (a, b) and sides[:2] == [0, 0] and sides[2] * sides[3] < 0 and within(p, q, t):
                found.add(tuple(sorted((min(a, b), number))))
    for one, other in itertools.combinations(edges, 2):
        numbers = [e[0] for e in one[1:] + other[1:]]
        if len(set(numbers)) == 4 and hinges_cross(one, other):
            found.add(tuple(sorted((min(numbers[:2]), min(numbers[2:])))))
    return len(found), len(found) - insides


class Verify(Case):
    def setUp(self):
        super().setUp()
        self.run_scene("o", "--quiet", "--set", "sources=[]", "--set", "gas=no")

    def frame(self, number=3):
        return self.path("o", "ply", "tiny.%04d.ply" % number)

    def verify(self, *args, expect=0):
        path = self.path("counts.csv")
        out, err = self.singe("verify", self.path("o"), "--csv", path, *args, expect=expect)
        return out, err, [{k: int(v) for k, v in row.items()} for row in self.table("counts.csv")]

    def damage(self, change, number=3):
        surface = Surface(self.frame(number))
        change(surface)
        surface.write(self.frame(number))

    def finds(self, kind, change, *messages, others=()):
        """Checks that a change causes a fault of this kind in frame 3, and no others except `others`."""
        whole = Path(self.frame()).read_bytes()
        with self.subTest(kind, change=change.__name__):
            self.damage(change)
            out, err, rows = self.verify(expect=1)
            self.assertGreater(rows[2][kind], 0)
            for row in rows:
                for name in KINDS:
                    if row["frame"] != 3 or name not in (kind, *others):
                        self.assertEqual(row[name], 0, f"{name} of frame {row['frame']}")
            self.assertIn("faults in 1 frames", out)
            self.assertIn("tiny.0003.ply", err)
            for message in messages:
                self.assertIn(message, err)
        Path(self.frame()).write_bytes(whole)

    def test_good(self):
        out, err, rows = self.verify()
        self.assertEqual(err, "")
        self.assertIn("no faults", out)
        self.assertEqual([row["frame"] for row in rows], list(range(1, 7)))
        self.assertEqual(sum(row[kind] for row in rows for kind in KINDS), 0)
        surface = Surface(self.frame(1))
        self.assertEqual((rows[0]["vertices"], rows[0]["triangles"]), (len(surface.vertices), len(surface.triangles)))

    def test_frames(self):
        self.damage(lambda s: s.vertices[5].update(mass=float("nan")))
        _, _, rows = self.verify("--frames", "4-6")
        self.assertEqual([row["frame"] for row in rows], [4, 5, 6])
        _, _, rows = self.verify("--frames", "3", expect=1)
        self.assertEqual(rows[0]["not_finite"], 1)

    def test_values(self):
        def not_a_number(s): s.vertices[7]["temperature"] = float("nan")
        def infinite_position(s): s.vertices[7]["y"] = float("inf")
        def no_uv(s): s.columns = [c for c in s.columns if c[1] not in "st"]
        def no_rest(s): s.columns = [c for c in s.columns if c[1] != "rest_y"]
        def other_type(s): s.columns = [("float" if c[1] == "piece_id" else c[0], c[1]) for c in s.columns]
        def no_vertex(s): s.triangles[9][1] = len(s.vertices)
        def negative(s): s.triangles[9][1] = -1
        self.finds("not_finite", not_a_number, "temperature of vertex 7 is not finite")
        self.finds("not_finite", infinite_position, "y of vertex 7 is not finite")
        self.finds("missing", no_uv, '"float s"', '"float t"')
        self.finds("missing", no_rest, '"float rest_y"')
        self.finds("missing", other_type, '"int piece_id"')
        self.finds("index", no_vertex, "triangle 9 names vertex")
        self.finds("index", negative, "triangle 9 names vertex -1")

    def test_surface(self):
        def through(s):
            a, b = s.triangles[0], next(t for t in s.triangles if not set(t) & set(s.triangles[0]))
            middle = [sum(s.vertices[v][axis] for v in a) / 3 for axis in "xyz"]
            normal_ = normal([[s.vertices[v][axis] for axis in "xyz"] for v in a])
            far = 1e-3 / dot(normal_, normal_) ** 0.5
            for v, way in zip(b, (far, -far, -far)):
                for k, axis in enumerate("xyz"):
                    s.vertices[v][axis] = middle[k] + way * normal_[k] + (2e-4 * k if v == b[2] else 0)
            return b
        def of_other_sheet(s):
            for v in through(s):
                s.vertices[v]["sheet"] = 1
        def long(s): s.vertices[0]["z"] += 1
        def duplicate(s): s.triangles[1] = s.triangles[0][1:] + s.triangles[0][:1]
        def point(s): s.triangles[4][2] = s.triangles[4][1]
        def line(s):
            a, b, c = (s.vertices[v] for v in s.triangles[4])
            c.update({axis: a[axis] for axis in "xyz"})
        def third(s):
            edge = next(set(a) & set(b) for a, b in itertools.combinations(s.triangles, 2) if len(set(a) & set(b)) == 2)
            s.vertices.append(Surface.vertex([s.vertices[min(edge)][axis] + (axis == "z") * 5e-3 for axis in "xyz"]))
            s.triangles[-1] = [*edge, len(s.vertices) - 1]
        def turned(s): s.triangles[0].reverse()
        self.finds("crossings", through, "triangles", "cross near", others=("stretched_edges",))
        self.finds("crossings", of_other_sheet, "of sheets", others=("stretched_edges",))
        self.finds("stretched_edges", long, "mm at rest", others=("crossings",))
        self.finds("duplicate_triangles", duplicate, "triangles 0 and 1 have the same vertices",
                   others=("crossings", "non_manifold_edges", "winding"))
        self.finds("degenerate_triangles", point, "triangle 4", "has no area")
        self.finds("degenerate_triangles", line, "has no area", others=("crossings", "stretched_edges"))
        self.finds("non_manifold_edges", third, "has 3 triangles", others=("stretched_edges", "winding"))
        self.finds("winding", turned, "run the same way along edge")

    def test_what_crosses_from_the_start(self):
        """Triangles that cross in frame 1 are reported but are not faults; those that cross later elsewhere are."""
        def pierce(first):
            def change(s):
                def place(t): return [s.vertices[t[0]]["rest_" + axis] for axis in "xyz"]
                a = s.triangles[first]
                b = min((t for t in s.triangles if not set(t) & set(a)), key=lambda t: math.dist(place(t), place(a)))
                corners = [[s.vertices[v][axis] for axis in "xyz"] for v in a]
                up = normal(corners)
                size = dot(up, up) ** 0.25
                for v, way in zip(b, (0.5, -0.5, -0.5)):
                    for k, axis in enumerate("xyz"):
                        aside = 0.1 * size if v == b[2] and k == 0 else 0
                        s.vertices[v][axis] = sum(c[k] for c in corners) / 3 + way * up[k] / size + aside
            return change

        def total(rows, kind): return [row[kind] for row in rows]
        for number in (1, 3):
            self.damage(pierce(0), number)
        _, _, rows = self.verify("--stretch", "1e9", expect=1) # the run has reported none
        self.assertEqual(sum(total(rows, "initial_crossings")), 0)
        record = Path(self.path("o", "run.json")).read_text()
        self.assertIn('"crossed_at_start": 0', record)
        Path(self.path("o", "run.json")).write_text(record.replace('"crossed_at_start": 0', '"crossed_at_start": 7'))
        out, err, rows = self.verify("--stretch", "1e9")
        start = total(rows, "initial_crossings")
        self.assertGreater(start[0], 0)
        self.assertEqual(start[2], start[0])
        self.assertEqual(sum(start), 2 * start[0])
        self.assertRegex(err, r"^singe: warning: \S*: pairs of triangles that cross from the start: \d+, .*\n$")
        self.assertIn("no faults", out)
        _, _, rows = self.verify("--stretch", "1e9", "--frames", "3-4")
        self.assertEqual(total(rows, "initial_crossings"), [start[0], 0])
        self.damage(pierce(len(Surface(self.frame(4)).triangles) - 1), 4)
        _, err, rows = self.verify("--stretch", "1e9", expect=1)
        self.assertEqual([n > 0 for n in total(rows, "crossings")], [i == 3 for i in range(6)])
        self.assertIn("tiny.0004.ply", err)

    def test_flaws_of_render_meshes(self):
        """verify counts what check warns of: flaws of a mesh that is not a surface, and none that were repaired."""
        corner = [(0.01 * x - 0.02, 0.01 * y - 0.02, 5e-4) for y in range(5) for x in range(5)] + [(0, 0, 4e-3)]
        faces = [face for y in range(4) for x in range(4) for a in [5 * y + x]
                 for face in ((a, a + 1, a + 6), (a, a + 6, a + 5))]
        for name, given, warning, counted in (
            ("good", faces, None, None),
            ("double", faces + faces[:3] + [faces[9][::-1], (0, 1, 2)], "corners of another: 5", None),
            ("wound", faces[:-1] + [faces[-1][::-1]], "for `singe verify`: 2", "edges whose triangles are wound"),
            ("fin", faces + [(6, 12, 25)], "for `singe verify`: 1", "edges of more than two triangles"),
        ):
            with self.subTest(name):
                with open(self.path(name + ".obj"), "w") as file:
                    file.writelines("v %g %g %g\n" % p for p in corner)
                    file.writelines("f %d %d %d\n" % tuple(i + 1 for i in face) for face in given)
                scene = self.path(name + ".yaml")
                Path(scene).write_text("frames: 2\nsteps: 1\nsheets:\n  - grid: {size: [4 cm, 4 cm], cells: [4, 4]}\n"
                                       f"    render_mesh: {{mesh: {name}.obj}}\npreview: {{size: [16, 16], samples: 1}}\n")
                _, err = self.singe("check", scene)
                lines = [line for line in err.splitlines() if "render mesh" in line]
                self.assertEqual(len(lines), 1 if warning else 0, err)
                self.assertIn(warning or "", "".join(lines))
                self.singe("run", scene, "-o", self.path(name), "--quiet", "--no-preview")
                out, err = self.singe("verify", self.path(name), expect=1 if counted else 0)
                self.assertRegex(out, rf"{counted}.* [1-9]" if counted else "no faults")

    def test_rounding(self):
        """An edge as short as the last bits of its coordinates has a rounded length; that is not a stretched edge."""
        def sliver(s, bits, rest_bits=1):
            for x, rest, y in ((1, 1, 1), (1 + bits * 2**-23, 1 + rest_bits * 2**-23, 1), (1, 1, 1.01)):
                s.vertices.append(Surface.vertex([x, y, 1]))
                s.vertices[-1]["rest_x"] = rest
            s.triangles[-1] = [len(s.vertices) - k for k in (3, 2, 1)]
        def rounded(s): sliver(s, 3)
        def stretched(s): sliver(s, 12)
        def short(s): sliver(s, 850, 420) # 50 um, by 1 % more than is allowed
        self.finds("stretched_edges", stretched, "mm at rest")
        self.finds("stretched_edges", short, "mm at rest")
        self.damage(rounded)
        _, _, rows = self.verify()
        self.assertEqual(sum(row["stretched_edges"] for row in rows), 0)

    def test_stats(self):
        path = self.path("o", "stats.csv")
        lines = Path(path).read_text().splitlines()
        names, third = lines[0].split(","), lines[3].split(",")

        def rewrite(name, value):
            cells = list(third)
            cells[names.index(name)] = value
            Path(path).write_text("\n".join(lines[:3] + [",".join(cells)] + lines[4:]) + "\n")

        for name, value, kind, count in (("inverted_cells", "4", "inverted_cells", 4), ("triangles", "1", "stats", 1),
                                         ("time", "7", "stats", 1)):
            rewrite(name, value)
            _, err, rows = self.verify(expect=1)
            self.assertEqual(rows[2][kind], count)
            self.assertIn("stats.csv", err)
        rewrite("time", "soon")
        self.assertIn("stats.csv:4", self.singe("verify", self.path("o"), expect=2)[1])
        Path(path).write_text("\n".join(lines[:-1]) + "\n")
        self.assertIn("no line for frame 6", self.verify(expect=1)[1])
        os.remove(path)
        out, err, _ = self.verify()
        self.assertIn("inverted cells cannot be counted", err)

    def test_stretch(self):
        self.damage(lambda s: [vertex.update(x=1.01 * vertex["x"]) for vertex in s.vertices], 6)
        self.verify()
        _, err, rows = self.verify("--stretch", "1", expect=1)
        self.assertGreater(rows[-1]["stretched_edges"], 0)
        self.assertIn("further ones are only counted", err)
        self.assertEqual(err.count("mm at rest"), 3)

    def test_refusals(self):
        for args, message in (
            (["verify", self.path("o"), "--stretch", "0.5"], "1 or more"),
            (["verify", self.path("o"), "--stretch", "wide"], "1 or more"),
            *(([command, *args], message) for command in ("verify", "measure") for args, message in (
                ([], "needs"),
                ([self.path("nowhere")], "run.json"),
                ([self.path("o"), "--frames", "5-9"], "has 1-6"),
                ([self.path("o"), "--frames", "4-2"], "expected A-B"),
                ([self.path("o"), "--frames", "x"], "expected A-B"),
                ([self.path("o"), "--colour"], "unknown option"),
            )),
        ):
            with self.subTest(args):
                self.assertIn(message, self.singe(*args, expect=2)[1])
        for command in "verify", "measure":
            self.singe(command, self.path("o"), "--csv", self.path("no", "such"), expect=1)

    def test_what_cannot_be_read(self):
        def no_position(s): s.columns = s.columns[1:]
        self.damage(no_position)
        self.assertIn("tiny.0003.ply", self.singe("verify", self.path("o"), expect=2)[1])
        size = os.path.getsize(self.frame(4))
        for keep in (size - 1, size // 2, 40, 0):
            with open(self.frame(4), "r+b") as file:
                file.truncate(keep)
            self.assertIn("tiny.0004.ply", self.singe("verify", self.path("o"), "--frames", "4-6", expect=2)[1])
        os.remove(self.frame(4))
        self.assertIn("tiny.0004.ply", self.singe("verify", self.path("o"), "--frames", "4-6", expect=2)[1])

    def test_rational(self):
        """Random triangles on a lattice, where many touch, and off it; with shared vertices and without."""
        os.remove(self.path("o", "stats.csv"))
        generator = random.Random(7)
        expected, touching = [], 0
        for number in range(1, 7):
            if number < 4:  # hinges of two triangles about a plane, or in it
                points = []
                for _ in range(16):
                    heights, axis = generator.choice([(1, 1, 0, 2), (1, 1, 1, 1), (1, 1, 2, 2)]), generator.randrange(3)
                    for height in heights:
                        point = [generator.randint(0, 1 + number) / 8 for _ in range(3)]
                        point[axis] = height / 8
                        points.append(point)
                corners = [c for i in range(0, 64, 4) for c in ((i, i + 1, i + 2), (i + 1, i, i + 3))]
            else:
                points = [[generator.randint(0, 5) / 8 if number == 4 else generator.random() for _ in range(3)]
                          for _ in range(16)]
                corners = {tuple(generator.sample(range(16), 3)) for _ in range(30)}
            surface = Surface(positions=points, triangles=sorted(corners))
            surface.write(self.frame(number))
            surface.read(self.frame(number))  # rounded as written
            at = [[[Fraction(surface.vertices[v][axis]) for axis in "xyz"] for v in t] for t in surface.triangles]
            surface.triangles = [t for t, a in zip(surface.triangles, at) if any(normal(a))]
            surface.write(self.frame(number))
            count, at_edges = crossings(surface)
            expected.append(count)
            touching += at_edges
        rows = self.verify(expect=1)[2]
        self.assertEqual([row["crossings"] for row in rows], expected)
        self.assertGreater(min(expected), 10)
        self.assertGreater(touching, 5)

    def test_interrupted(self):
        """Ctrl-C ends it after a frame; it reports the frames that it did not check."""
        Surface(self.frame(1)).write(self.frame(7))
        for number in range(8, 3000):
            os.link(self.frame(7), self.frame(number))
        os.remove(self.path("o", "stats.csv"))
        run = self.start("verify", self.path("o"))
        self.addCleanup(run.stderr.close)
        while "singe: warning" not in run.stderr.readline():
            pass
        run.send_signal(signal.SIGINT)
        code = run.wait(timeout=60)
        self.assertEqual(code, 1)
        self.assertIn("are not verified", run.stderr.read())


class RenderMeshes(Case):
    """A mesh in place of each of two sheets that fall on each other and on a ball crosses nothing, however thick it is; rigid
    ones do."""

    SCENE = """\
frames: 6
steps: 5
contact: {{enabled: yes, thickness: 0.5 mm}}
sheets:
  - {{grid: {{size: [4 cm, 4 cm], cells: [12, 12]}}, translate: [0, 0, 22 mm]{mesh}}}
  - {{grid: {{size: [4 cm, 4 cm], cells: [12, 12]}}, translate: [2 mm, 1 mm, 24 mm]{mesh}}}
colliders:
  - {{kind: sphere, radius: 2 cm}}
  - {{kind: plane, position: [0, 0, -5 mm]}}
gas: no
"""

    def crossings(self, height, expect=0, more=""):
        """Pairs of triangles that cross, with two layers at this height (m) to either side; 0: without a mesh."""
        n, side = 16, 0.04
        with open(self.path("layers.obj"), "w") as file:
            for z in (-height, height):
                file.writelines("v %g %g %g\n" % (side * (k % (n + 1) / n - 0.5), side * (k // (n + 1) / n - 0.5), z)
                                for k in range((n + 1) ** 2))
            for first in (1, 1 + (n + 1) ** 2):
                corners = [first + k // n * (n + 1) + k % n for k in range(n * n)]
                file.writelines("f %d %d %d %d\n" % (v, v + 1, v + n + 2, v + n + 1) for v in corners)
        Path(self.scene).write_text(self.SCENE.format(mesh=f", render_mesh: {{mesh: layers.obj{more}}}" if height else ""))
        self.run_scene("o", "--force", "--quiet")
        self.singe("verify", self.path("o"), "--csv=" + self.path("v.csv"), expect=expect)
        return sum(int(row["crossings"]) for row in self.table("v.csv"))

    def test_no_crossings_are_added(self):
        self.assertEqual(self.crossings(0), 0)
        self.assertEqual(self.crossings(0.15e-3), 0)
        self.assertEqual(self.crossings(0.25e-3), 0)
        self.assertEqual(self.crossings(0.7e-3), 0)
        self.assertEqual(self.crossings(3e-3), 0)
        self.assertGreater(self.crossings(0.7e-3, expect=1, more=", rigid: 10 cm"), 0)
