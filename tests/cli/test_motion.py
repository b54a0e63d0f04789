"""Meshes that move frame by frame: as a collider that deforms, and as what pins follow."""

import math
import os
import struct
from pathlib import Path

from support import Case

FRAMES = 6

SCENE = """\
frames: {frames}
fps: 24
steps: 4
pace: 8
contact: {{thickness: 0.5 mm}}
sheets:
  - mesh: cape.obj
    up: y
sources:
  - {{kind: spot, position: [0, -2 cm, 10 cm], temperature: 1200 K, conductance: 300, radius: 1 cm, falloff: 1 cm}}
colliders:
  - kind: mesh
    motion: {{mesh: body.####.obj, up: y}}
pins:
  - vertices: [0, 1, 2, 3, 4, 5, 6, 7, 8]
    motion: {{mesh: {follows}, up: y}}
gas: no
"""


def box(at, squeeze):
    """A box of 6 cm by 12 cm by 3 cm about a point, y up, wider at its top by `squeeze`."""
    corners = []
    for y in (-0.06, 0.06):
        for x, z in ((-0.03, -0.015), (0.03, -0.015), (0.03, 0.015), (-0.03, 0.015)):
            wide = squeeze if y > 0 else 1
            corners.append((at[0] + x * wide, at[1] + y, at[2] + z))
    faces = ((0, 1, 2, 3), (7, 6, 5, 4), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
    return corners, faces


def write_obj(path, corners, faces):
    with open(path, "w", encoding="utf-8") as file:
        for corner in corners:
            file.write("v %.7f %.7f %.7f\n" % tuple(corner))
        for face in faces:
            file.write("f %s\n" % " ".join(str(v + 1) for v in face))


def turned(point, angle):
    x, y, z = point
    return x * math.cos(angle) + z * math.sin(angle), y, z * math.cos(angle) - x * math.sin(angle)


class Motion(Case):
    def setUp(self):
        super().setUp()
        # y up: the cape hangs in the plane z = 2 cm behind the body's back, from its upper edge
        across, down, side = 8, 8, 0.01
        self.cape = [(side * (i - across / 2), 0.1 - side * j, 0.02) for j in range(down + 1) for i in range(across + 1)]
        quads = [(j * 9 + i, (j + 1) * 9 + i, (j + 1) * 9 + i + 1, j * 9 + i + 1) for j in range(8) for i in range(8)]
        write_obj(self.path("cape.obj"), self.cape, quads)
        for frame in range(FRAMES):
            angle = 0.1 * frame
            corners, faces = box((0, 0.04, 0), 1 + 0.02 * frame)
            write_obj(self.path("body.%04d.obj" % (frame + 1)), [turned(c, angle) for c in corners], faces)
            write_obj(self.path("cape.%03d.obj" % (frame + 1)), [turned(c, angle) for c in self.cape], quads)
        self.scene = self.write("moving.yaml")

    def write(self, name, follows="cape.###.obj", frames=FRAMES, replace=("", "")):
        Path(self.path(name)).write_text(SCENE.format(frames=frames, follows=follows).replace(*replace), encoding="utf-8")
        return self.path(name)

    def vertices(self, out, frame):
        """x, y, z of the cape's vertices by their numbers in its file."""
        header, rest = Path(self.path(out, "ply", "moving.%04d.ply" % frame)).read_bytes().split(b"end_header\n", 1)
        sizes = {"float": ("f", 4), "int": ("i", 4), "uint": ("I", 4), "uchar": ("B", 1), "double": ("d", 8)}
        names, form, count = [], "<", 0
        for line in header.decode().split("\n"):
            words = line.split()
            if words[:2] == ["element", "vertex"]:
                count = int(words[2])
            elif words[:1] == ["element"]:
                break
            elif words[:1] == ["property"]:
                names.append(words[2])
                form += sizes[words[1]][0]
        size = struct.calcsize(form)
        found = {}
        for k in range(count):
            values = dict(zip(names, struct.unpack_from(form, rest, k * size)))
            if values["vertex_id"] >= 0:
                found[values["vertex_id"]] = (values["x"], values["y"], values["z"])
        return found

    def assert_follows(self, out, bar):
        for frame in range(1, FRAMES + 1):
            found = self.vertices(out, frame)
            for v in range(9):
                x, y, z = turned(self.cape[v], 0.1 * (frame - 1))
                for got, want in zip(found[v], (x, -z, y)):
                    self.assertLess(abs(got - want), bar, f"frame {frame}, vertex {v}")

    def test_pins_follow(self):
        """What is pinned is where the sheet's own animated mesh has it, at every frame; any number of threads, and
        after a resume in the middle."""
        self.singe("check", self.scene)
        self.run_scene("one", "--threads", "1")
        self.assert_follows("one", 2e-5)
        _, err = self.singe("check", self.scene, "--set", "frames=9")
        self.assertIn("has files for 6 of 9 frames", err)
        self.run_scene("two", "--threads", "2")
        self.assertEqual(self.plys("one"), self.plys("two"))
        self.assertGreater(float(self.stats("one")[-1]["burnt_fraction"]), 0)
        self.run_scene("half", "--frames", "3")
        self.run_scene("half", "--resume")
        self.assertEqual(self.plys("one"), self.plys("half"))

    def test_pins_follow_a_body(self):
        """The same by the nearest triangles of the body, which turns as the cape does, but swells a little."""
        self.scene = self.write("moving.yaml", follows="body.####.obj")
        self.run_scene("out")
        self.assert_follows("out", 5e-3)
        moved = self.vertices("out", FRAMES)[0]
        self.assertGreater(math.dist(moved, self.vertices("out", 1)[0]), 0.015)

    def test_the_body_pushes(self):
        """A box that swells through the cape takes it along: no vertex is left inside."""
        for frame in range(FRAMES):
            corners, faces = box((0, 0.04, 0.01 * frame), 1)
            write_obj(self.path("body.%04d.obj" % (frame + 1)), corners, faces)
        self.scene = self.write("moving.yaml", follows="cape.###.obj")
        self.run_scene("out")
        inside = [p for v, p in self.vertices("out", FRAMES).items()
                  if v >= 9 and abs(p[0]) < 0.029 and -0.064 < p[1] < -0.036 and -0.019 < p[2] < 0.099]
        self.assertEqual(inside, [])

    def test_another_motion_is_not_resumed(self):
        self.run_scene("half", "--frames", "3")
        corners, faces = box((0, 0.05, 0), 1)
        write_obj(self.path("body.0002.obj"), corners, faces)
        _, err = self.run_scene("half", "--resume", expect=2)
        self.assertIn("belongs to another scene", err)

    def wrong(self, message, **changes):
        scene = self.write("wrong.yaml", **changes)
        _, err = self.singe("check", scene, expect=2)
        self.assertIn(message, err)
        self.assertIn("wrong.yaml:", err)
        _, err = self.singe("run", scene, "-o", self.path("none"), "--no-preview", expect=2)
        self.assertIn(message, err)
        self.assertFalse(os.path.exists(self.path("none", "ply")))

    def test_mistakes_are_reported(self):
        self.wrong("one run of #", follows="cape.obj")
        self.wrong("one run of #", follows="ca#pe.###.obj")
        os.rename(self.path("cape.004.obj"), self.path("away.obj"))
        self.wrong("cape.004.obj: there is no such file, but the next one exists")
        os.rename(self.path("away.obj"), self.path("cape.004.obj"))
        self.wrong("cape.999.obj", replace=("cape.###.obj, up: y", "cape.###.obj, first: 999, up: y"))
        self.wrong("'path' and 'motion' exclude each other",
                   replace=("    motion: {mesh: cape", "    path: [{time: 0}]\n    motion: {mesh: cape"))
        self.wrong("'mesh' and 'motion' exclude each other",
                   replace=("    motion: {mesh: body", "    mesh: body.0001.obj\n    motion: {mesh: body"))
        self.wrong("needs 'mesh' (a file) or 'motion'", replace=("    motion: {mesh: body.####.obj, up: y}\n", ""))
        corners, faces = box((0, 0.04, 0), 1)
        write_obj(self.path("body.0003.obj"), corners + [(9, 9, 9)], faces)
        self.wrong("body.0003.obj has 9 vertices and 12 triangles, but the first file of the motion has 8 and 12")
        corners[2] = (1e9, 0, 0)
        write_obj(self.path("body.0003.obj"), corners, faces)
        self.wrong("body.0003.obj: vertex 2 (from 0) is not finite or beyond 10 km")
        for frame in range(FRAMES):
            write_obj(self.path("body.%04d.obj" % (frame + 1)), box((0, 0.04, 0), 1)[0], faces[:5])
        self.wrong("the mesh is open")
