"""Mesh files that are good, hostile, or refer to other files, as `check` meets them."""

import os
import resource
import subprocess
import time
from pathlib import Path

from hostile import GOOD, HOSTILE, SQUARE, TWO, gltf, struct
from support import SINGE, Case, Ply

HAS_ASSIMP = os.environ["SINGE_ASSIMP"] == "1"
OWN = (".obj", ".ply", ".stl", ".gltf", ".glb")
SANITIZED = os.environ["SINGE_SANITIZED"] == "1"
SECONDS = 30
STACK = 256 << 10  # the least with which a command runs (test_failure.py); sanitizers need more
ENVIRONMENT = 32 << 10  # bytes of a long one: it lies on the stack
MEGABYTES = 4000 if SANITIZED else 750


def limit_stack():
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_STACK, (STACK, STACK))


class Meshes(Case):
    def check(self, *names):
        """The code, what was printed, seconds and megabytes of `check` on a scene with these meshes."""
        scene = self.path("mesh.yaml")
        with open(scene, "w") as file:
            file.write("preview: {size: [16, 16], samples: 1}\nsheets:\n")
            for i, name in enumerate(names):
                file.write(f"  - mesh: {name}\n    scale: 0.1\n    translate: [0, 0, {i} cm]\n")
        with open(self.path("printed"), "w+") as printed:
            begin = time.monotonic()
            singe = subprocess.Popen([SINGE, "check", scene], stdout=printed, stderr=printed,
                                     preexec_fn=limit_stack, env={**os.environ, "LONG": ENVIRONMENT * "x"})
            _, status, usage = os.wait4(singe.pid, 0)  # children's memory, too
            singe.returncode = os.waitstatus_to_exitcode(status)
            seconds = time.monotonic() - begin
            printed.seek(0)
            text = printed.read()
        return singe.returncode, text, seconds, usage.ru_maxrss // 1024

    def files(self, files):
        return {name: file for name, file in files.items() if HAS_ASSIMP or name.endswith(OWN)}

    def write(self, name, content):
        Path(self.path(name)).write_bytes(content)

    def test_good_files_are_read(self):
        files = self.files(GOOD)
        for name, content in files.items():
            self.write(name, content)
        code, text, _, _ = self.check(*files)
        self.assertEqual(code, 0, text)
        for name in files:
            self.assertIn(f"{name}: ", text)

    def test_hostile_files_are_refused(self):
        for name, (content, part) in self.files(HOSTILE).items():
            with self.subTest(name):
                self.write(name, content)
                code, text, seconds, megabytes = self.check(name)
                self.assertEqual(code, 2, text)
                self.assertIn(name, text)
                self.assertIn(part, text)
                self.assertLess(seconds, SECONDS)
                self.assertLess(megabytes, MEGABYTES)
                os.remove(self.path(name))

    def test_files_beside(self):
        data = SQUARE + struct.pack("<6I", *TWO)
        os.mkdir(self.path("in"))
        os.mkdir(self.path("in", "deep"))
        os.mkfifo(self.path("in", "pipe.bin"))
        for place in "out.bin", "in/beside.bin", "in/deep/below.bin":
            Path(self.path(place)).write_bytes(data)
        os.symlink("../out.bin", self.path("in", "link.bin"))
        os.symlink("deep/below.bin", self.path("in", "good.bin"))
        files = {}
        for uri, good in (
            ("beside.bin", True),
            ("deep/below.bin", True),
            ("good.bin", True),
            ("../out.bin", False),
            ("deep/../../out.bin", False),
            ("deep/../beside.bin", False),
            (self.path("out.bin"), False),
            (self.path("in", "beside.bin"), False),
            ("/dev/zero", False),
            ("link.bin", False),
            ("pipe.bin", False),
            ("deep", False),
            ("missing.bin", False),
            ("", False),
        ):
            name = f"in/{len(files)}.gltf"
            files[name] = good
            self.write(name, gltf(buffers=[{"byteLength": len(data), "uri": uri}]))
            if good:
                continue
            with self.subTest(uri):
                code, text, seconds, _ = self.check(name)
                self.assertEqual(code, 2, text)
                self.assertIn(name, text)
                self.assertLess(seconds, SECONDS)
        code, text, _, _ = self.check(*(name for name, good in files.items() if good))
        self.assertEqual(code, 0, text)


    def numbers(self, name):
        """The output of `check` for one file: its report, and its cells and springs."""
        code, text, _, _ = self.check(name)
        self.assertEqual(code, 0, text)
        report = text[text.index(f"{name}: ") + len(name) + 2 :].split("\n", 1)[0]
        return report, [line.split()[1] for line in text.splitlines() if line.startswith(("particles", "cells", "springs"))]

    def test_what_blender_exports(self):
        """Blender 4.5 splits a PLY's vertices where uv or normals differ: welded, it is the mesh that it was."""
        side, corners = 5, []
        for y in range(side - 1):
            for x in range(side - 1):
                corners.append([(y + dy) * side + x + dx for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1))])
        place = lambda v: (v % side / 40, v // side / 40, abs(v % side - 2) / 80)  # a fold along its middle
        with open(self.path("whole.obj"), "w") as file:
            for v in range(side * side):
                file.write("v %g %g %g\n" % place(v))
            for face in corners:
                file.write("f " + " ".join(str(v + 1) for v in face) + "\n")
        rows, number, faces = [], {}, b""
        for i, face in enumerate(corners):
            island = i % (side - 1) // 2  # of uv, and flat shaded: left and right of the fold
            face = [number.setdefault((v, island), len(number)) for v in face]
            faces += struct.pack("<B4I", 4, *face)
        for v, island in number:
            x, y, z = place(v)
            rows.append(struct.pack("<8f", x, y, z, 0.4 - 0.8 * island, 0, 0.9, x + island, y))
        self.assertEqual(len(rows), side * side + side)
        names = "".join("property float %s\n" % name for name in "x y z nx ny nz s t".split())
        header = ("ply\nformat binary_little_endian 1.0\ncomment Created in Blender version 4.5.15 LTS\n"
                  "element vertex %d\n%selement face %d\nproperty list uchar uint vertex_indices\nend_header\n")
        self.write("split.ply", (header % (len(rows), names, len(corners))).encode() + b"".join(rows) + faces)
        whole, counts = self.numbers("whole.obj")
        split, split_counts = self.numbers("split.ply")
        self.assertEqual(split_counts, counts)
        self.assertEqual(whole, "25 vertices, 0 triangles, 16 quads, 0 polygons, 1 component")
        self.assertEqual(split, "30 vertices, 0 triangles, 16 quads, 0 polygons, 1 component, 5 vertices on seams")
        # parts farther apart than the welding distance stay separate
        for i, (v, island) in enumerate(number):
            x, y, z = place(v)
            rows[i] = struct.pack("<8f", x + 1e-3 * island, y, z, 0, 0, 1, x + island, y)
        self.write("apart.ply", (header % (len(rows), names, len(corners))).encode() + b"".join(rows) + faces)
        self.assertIn("2 components", self.numbers("apart.ply")[0])

    def area(self, name):
        """Of the first frame, as it is drawn."""
        scene = self.path("area.yaml")
        Path(scene).write_text(f"sheets: [{{mesh: {name}}}]\ngas: no\nframes: 1\n")
        self.singe("run", scene, "-o", self.path("area"), "--no-preview", "--quiet")
        frame = Ply(self.path("area", "ply", "area.0001.ply"))
        total = 0
        for a, b, c in ([frame.rows[v] for v in triangle] for triangle in frame.triangles):  # x and y come first
            total += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2
        return total

    def test_polygons_of_an_obj(self):
        """A square of 6 x 6 parts: an L of 8 corners, a face with a notch, one with 7 corners, and quads."""
        side, faces, taken = 7, [], set()
        at = lambda x, y: y * side + x + 1

        def face(cells, *points):
            taken.update(cells)
            faces.append([at(x, y) for x, y in points])
        face([(0, 0), (1, 0), (0, 1)], (0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2), (0, 1))
        face([(3, 3), (4, 3), (5, 3), (3, 4), (5, 4)], (3, 3), (4, 3), (5, 3), (6, 3), (6, 4), (6, 5), (5, 5), (5, 4),
             (4, 4), (4, 5), (3, 5), (3, 4))
        face([(3, 0), (4, 0)], (3, 0), (4, 0), (5, 0), (5, 1), (4, 1), (3, 1))
        for y in range(side - 1):
            for x in range(side - 1):
                if (x, y) not in taken:
                    face([], (x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1))
        with open(self.path("ngons.obj"), "w") as file:
            for i in range(side * side):
                file.write("v %g %g 0\nvt %g %g\n" % (i % side / 50, i // side / 50, i % side / 6, i // side / 6))
            for corners in faces:
                file.write("f " + " ".join(f"{v}/{v}" for v in corners) + "\n")
        report, _ = self.numbers("ngons.obj")
        self.assertEqual(report, "49 vertices, 0 triangles, 26 quads, 3 polygons, 1 component")
        self.assertLess(abs(self.area("ngons.obj") / 0.12**2 - 1), 1e-5)
