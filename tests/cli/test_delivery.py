"""Textures over uv, vertex animation textures, and files of all frames: what is in them is the cache's."""

import json
import math
import os
import struct
import unittest
import zipfile
from pathlib import Path

import exr
from support import HAS_EXR, Case, Ply, write_png


def glb(path):
    """The JSON, and a function that gives the values of an accessor."""
    data = Path(path).read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    text, body = json.loads(data[20 : 20 + size]), data[28 + size :]

    def values(accessor):
        accessor = text["accessors"][accessor]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        kind = {5126: "f", 5125: "I"}[accessor["componentType"]]
        begin = text["bufferViews"][accessor["bufferView"]]["byteOffset"]
        flat = struct.unpack_from("<%d%s" % (width * accessor["count"], kind), body, begin)
        return list(flat) if width == 1 else list(zip(*(flat[i::width] for i in range(width))))

    return text, values


def smooth(low, high, x):
    t = min(max((x - low) / (high - low), 0), 1)
    return t * t * (3 - 2 * t)


def ember(column, v):
    """Light of a vertex (program/formats/ember.h): of char without fuel, of char below a flame, of the line before ash."""
    kelvin, rate, charred, ash = (column[name][v] for name in ("temperature", "burn_rate", "char_fraction", "ash_fraction"))
    fuel = min(max(column["mass"][v] - charred - ash, 0), 1)
    burn = column["burnt"][v]
    if charred > 0:
        burn += (0.64 * (1 - fuel) - burn) * charred / (charred + 2 * ash)
    active = rate / (rate + 0.12)
    alone = active if fuel <= 0.01 else 0
    below = 0.7 * smooth(0.08, 0.4, rate) * smooth(0.32, 0.46, burn) if fuel > 0.01 and charred > 0 else 0
    share = max(alone + below * (1 - alone), smooth(0.64, 0.74, burn) * active)
    return share * 2.5 * math.exp(14388 / 0.61 * (1 / 1200 - 1 / kelvin)) if kelvin >= 800 else 0


BURNING = "frames: 10\nfps: 24\nsteps: 4\npace: 16\ngas: no\npreview: {size: [64, 48], samples: 1}\n"
SPOT = ("sources: [{kind: spot, position: [-3 cm, 0, 5 cm], temperature: 1200 K, conductance: 300, radius: 1 cm, "
        "falloff: 1 cm}]\n")


class Delivery(Case):
    def burn(self, out, *args):
        self.scene = self.path("burn.yaml")
        Path(self.scene).write_text(BURNING + SPOT + "name: burn\nsheets: [{grid: {size: [6 cm, 6 cm], cells: [16, 16]}, "
                                    "translate: [0, 0, 5 cm]}]\n")
        self.run_scene(out, "--quiet", *args)

    def frame(self, out, number):
        frame = Ply(self.path(out, "ply", "burn.%04d.ply" % number))
        return frame.columns(), frame.triangles

    # ---- textures

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_textures(self):
        self.burn("o")
        self.singe("convert", self.path("o"), "--to", "textures", "--set", "output.texture_size=64", "--quiet")
        column, triangles = self.frame("o", 10)
        width, height, image = exr.read(self.path("o", "textures", "burn.0010.exr"))
        self.assertEqual((width, height, sorted(image)), (64, 64, ["A", "B", "G", "R"]))
        inside = {}  # by pixel: what the triangle over its centre has there
        for corners in triangles:
            p = [(column["s"][v] * 64, (1 - column["t"][v]) * 64) for v in corners]
            area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])
            for y in range(int(min(q[1] for q in p)), min(63, int(max(q[1] for q in p))) + 1):
                for x in range(int(min(q[0] for q in p)), min(63, int(max(q[0] for q in p))) + 1):
                    w = []
                    for a, b in ((1, 2), (2, 0), (0, 1)):
                        w.append(((p[b][0] - p[a][0]) * (y + 0.5 - p[a][1]) - (p[b][1] - p[a][1]) * (x + 0.5 - p[a][0]))
                                 / area if area else -1)
                    if min(w) < 0:
                        continue
                    glow = [ember(column, v) for v in corners]
                    inside[64 * y + x] = [sum(w[k] * values[k] for k in range(3)) for values in (
                        [column["temperature"][v] for v in corners], [column["burnt"][v] for v in corners], glow)]
        left = sum(value == 1 for value in image["A"])
        self.assertEqual({value for value in image["A"]}, {0, 1})
        self.assertTrue(100 < left < 64 * 64 - 100, left)
        self.assertLess(abs(left - len(inside)), 8)  # centres on a side are in or out by rounding
        for pixel, expected in inside.items():
            self.assertEqual(image["A"][pixel], 1)
            for name, value in zip("RGB", expected):
                self.assertLess(abs(image[name][pixel] - value), 2e-3 * abs(value) + 2e-3, (pixel, name))
        self.assertGreater(max(image["R"]), 800)
        # a hole has the values of its rim, so that a filter takes no others, and beyond 16 pixels none
        hole = [pixel for pixel in range(64 * 64) if image["A"][pixel] == 0]
        near = [p for p in hole if any(q in inside for q in (p - 1, p + 1, p - 64, p + 64))]
        self.assertGreater(len(near), 20)
        self.assertGreater(min(image["R"][p] for p in near), 290)

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_seams(self):
        """Two charts with room between them: values and what is left go 16 pixels over their sides."""
        with open(self.path("two.obj"), "w") as file:
            for z in (0, 0.1):
                file.write("v 0 0 %g\nv .05 0 %g\nv .05 .05 %g\nv 0 .05 %g\n" % ((z,) * 4))
            for low in (0, 0.5):
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    file.write("vt %g %g\n" % (low + 0.25 * u, 0.25 * v))
            file.write("f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n")
        self.scene = self.path("two.yaml")
        Path(self.scene).write_text(BURNING + "sheets: [{mesh: two.obj}]\noutput: {formats: [textures], texture_size: 128}\n")
        self.run_scene("o", "--quiet", "--frames", "1")
        _, _, image = exr.read(self.path("o", "textures", "two.0001.exr"))
        row = 127 - 10  # from the top; v = 10.5 / 128
        line = [image["A"][128 * row + x] for x in range(128)]
        # charts are x = 0..31 and 64..95, so all of it to 16 pixels beyond either
        self.assertEqual([x for x in range(128) if line[x]], list(range(48)) + list(range(48, 112)))
        self.assertEqual([x for x in range(128) if image["R"][128 * row + x]], list(range(112)))
        column = [image["A"][128 * y + 5] for y in range(128)]
        self.assertEqual([y for y in range(128) if column[y]], list(range(96 - 16, 128)))

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_layers_and_no_uv(self):
        Path(self.path("bare.obj")).write_text("v 0 0 0\nv .05 0 0\nv .05 .05 0\nv 0 .05 0\nf 1 2 3 4\n")
        grid = "{grid: {size: [6 cm, 6 cm], cells: [4, 4]}, name: %s, translate: [0, 0, %g]}"
        self.scene = self.path("many.yaml")
        with open(self.scene, "w") as file:
            file.write(BURNING + "sheets: [{mesh: bare.obj}, %s, %s]\n" % (grid % ("one", 0.1), grid % ("two too", 0.2)) +
                       "output: {formats: [textures], texture_size: 16}\n")
        self.run_scene("o", "--quiet", "--frames", "1")
        _, _, image = exr.read(self.path("o", "textures", "many.0001.exr"))
        self.assertEqual(sorted(image), ["A", "B", "G", "R"] + ["two_too." + letter for letter in "ABGR"])
        self.assertEqual(min(image["two_too.A"]), 1)
        Path(self.scene).write_text(BURNING + "sheets: [{mesh: bare.obj}]\noutput: {formats: [textures]}\n")
        self.assertIn("many.yaml:8:19: error: the format 'textures' needs a sheet with uv; no sheet has any",
                      self.run_scene("x", expect=2)[1])

    @unittest.skipIf(HAS_EXR, "built with EXR")
    def test_without_exr(self):
        self.burn("o", "--frames", "2")
        for name in ("textures", "vat"):
            self.assertIn("without EXR", self.singe("convert", self.path("o"), "--to", name, expect=1)[1])

    # ---- vertex animation textures

    def check_vat(self, out, frames, vertices, sheets=1):
        """Every vertex of every frame against the cache. Returns how many are gone at the end."""
        about = json.loads(Path(self.path(out, "vat", "burn.json")).read_text())
        self.assertEqual((about["frames"], about["vertices"], about["fps"]), (frames, vertices, 24))
        width, height, image = exr.read(self.path(out, "vat", "burn.position.exr"))
        self.assertEqual((width, height), (about["width"], about["height"]))
        _, _, normal = exr.read(self.path(out, "vat", "burn.normal.exr"))
        gone = set()
        for frame in range(frames):
            column, _ = self.frame(out, frame + 1)
            there = {v: i for i, v in reversed(list(enumerate(column["vertex_id"]))) if v >= 0}
            for v in range(vertices):
                texel = frame * about["rows_per_frame"] * width + v
                at = [image[name][texel] for name in "RGB"]
                self.assertEqual(image["A"][texel], float(v in there), (frame, v))
                for k in range(3):
                    self.assertTrue(about["bounds_min"][k] - 1e-6 <= at[k] <= about["bounds_max"][k] + 1e-6)
                if v not in there:
                    self.assertTrue(all(math.isfinite(x) for x in at))
                    gone.add(v)
                    continue
                self.assertNotIn(v, gone)  # what is gone does not come back
                i = there[v]
                self.assertEqual(at, [column["x"][i], column["z"][i], 0.0 - column["y"][i]])
                facing = [column["nx"][i], column["nz"][i], -column["ny"][i]]
                for k, name in enumerate("RGB"):
                    self.assertLess(abs(normal[name][texel] - facing[k]), 1e-3)
        text, values = glb(self.path(out, "vat", "burn.glb"))
        self.assertEqual(len(text["meshes"]), sheets)
        used = set()
        for mesh in text["meshes"]:
            has = mesh["primitives"][0]["attributes"]
            for place, (u, v) in zip(values(has["POSITION"]), values(has["TEXCOORD_1"])):
                texel = int(v * height) * width + int(u * width)
                used.add(texel)
                self.assertEqual(place, tuple(image[name][texel] for name in "RGB"))
        self.assertEqual(used, set(range(vertices)))
        return len(gone)

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_vat(self):
        self.burn("o")
        self.singe("convert", self.path("o"), "--to", "vat", "--quiet")
        gone = self.check_vat("o", 10, 17 * 17)
        self.assertTrue(20 < gone < 17 * 17, gone)
        # a vertex that is gone goes on with its neighbours: it is not left behind
        width, _, image = exr.read(self.path("o", "vat", "burn.position.exr"))
        last = 9 * 17 * 17
        rows = [image["G"][last + v] for v in range(17 * 17)]
        left = [rows[v] for v in range(17 * 17) if image["A"][last + v]]
        near = [v for v in range(17 * 17) if not image["A"][last + v] and v % 17 < 16 and image["A"][last + v + 1]]
        self.assertGreater(len(near), 3)
        for v in near:
            self.assertLess(min(abs(rows[v] - y) for y in left), 0.01)

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_vat_of_files(self):
        """Triangles, whose mesh has vertices that no file has, a seam of uv, and two sheets."""
        with open(self.path("tri.obj"), "w") as file:
            for y in range(5):
                for x in range(5):
                    file.write("v %g %g .05\nvt %g %g\n" % (x / 80 - 0.025, y / 80 - 0.025, x / 4, y / 4))
            file.write("vt 2 0\nvt 2 .25\n")
            for y in range(4):
                for x in range(4):
                    a = 5 * y + x + 1
                    b, c, d = a + 1, a + 6, a + 5
                    other = {b: 26, c: 27} if (x, y) == (1, 0) else {}
                    for face in ((a, b, c), (a, c, d)):
                        file.write("f " + " ".join("%d/%d" % (v, other.get(v, v)) for v in face) + "\n")
        self.scene = self.path("burn.yaml")
        Path(self.scene).write_text(BURNING + SPOT + "sheets:\n  - {mesh: tri.obj, quads: split}\n" +
                                    "  - {grid: {size: [6 cm, 6 cm], cells: [3, 3]}, translate: [0, 0, 20 cm]}\n")
        self.run_scene("o", "--quiet")
        self.singe("convert", self.path("o"), "--to", "vat", "--quiet")
        about = json.loads(Path(self.path("o", "vat", "burn.json")).read_text())
        self.assertGreater(about["vertices"], 25 + 16 + 30)
        text, values = glb(self.path("o", "vat", "burn.glb"))
        self.assertEqual(len(text["meshes"]), 2)
        # on the seam vertices have two uv and one texel: two of the file, and the middles of two sides
        has = text["meshes"][0]["primitives"][0]["attributes"]
        pairs = set(zip(values(has["TEXCOORD_0"]), values(has["TEXCOORD_1"])))
        self.assertEqual(len(pairs), len(values(has["POSITION"])))
        self.assertEqual(len(pairs) - len({texel for _, texel in pairs}), 4)

    # ---- all frames in one

    def test_glb(self):
        self.burn("o")
        out, _ = self.singe("convert", self.path("o"), "--to", "glb", "--single", "--plain")
        self.assertEqual(out.strip(), self.path("o", "burn.glb"))
        text, values = glb(self.path("o", "burn.glb"))
        self.assertEqual((len(text["meshes"]), len(text["nodes"])), (10, 10))
        animation, = text["animations"]
        shown = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            self.assertEqual((channel["target"]["path"], sampler["interpolation"]), ("scale", "STEP"))
            times, scales = values(sampler["input"]), values(sampler["output"])
            self.assertEqual(times, sorted(times))
            shown[channel["target"]["node"]] = (times, scales)
        for frame in range(10):
            now = (frame + 0.5) / 24
            visible = []
            for node, (times, scales) in shown.items():
                key = max((i for i, t in enumerate(times) if t <= now), default=0)
                if scales[key] == (1, 1, 1):
                    visible.append(node)
                else:
                    self.assertEqual(scales[key], (0, 0, 0))
            self.assertEqual(visible, [frame])
            has = text["meshes"][text["nodes"][frame]["mesh"]]["primitives"][0]["attributes"]
            self.assertEqual(sorted(has), ["COLOR_0", "NORMAL", "POSITION", "TEXCOORD_0", "_BURNT", "_TEMPERATURE",
                                           "_VELOCITY"])
            column, _ = self.frame("o", frame + 1)
            self.assertEqual(values(has["POSITION"]), list(zip(column["x"], column["z"], [0.0 - y for y in column["y"]])))
            self.assertEqual(values(has["_TEMPERATURE"]), column["temperature"])

    def test_usdz(self):
        self.burn("o", "--set", "output.formats=[usd]")
        self.singe("convert", self.path("o"), "--to", "usdz", "--quiet")
        whole = Path(self.path("o", "burn.usdz")).read_bytes()
        with zipfile.ZipFile(self.path("o", "burn.usdz")) as archive:
            self.assertIsNone(archive.testzip())  # every sum is right
            entries = archive.infolist()
            self.assertEqual([entry.filename for entry in entries],
                             ["burn.usda"] + ["usd/burn.%04d.usdc" % frame for frame in range(1, 11)])
            for entry in entries:
                self.assertEqual(entry.compress_type, zipfile.ZIP_STORED)
                name, extra = struct.unpack_from("<HH", whole, entry.header_offset + 26)
                self.assertEqual((entry.header_offset + 30 + name + extra) % 64, 0)
                path = self.path("o", entry.filename)
                self.assertEqual(archive.read(entry), Path(path).read_bytes(), entry.filename)

    def test_usdz_has_pictures(self):
        write_png(self.path("print.png"), [bytes([200, 128, 7] * 4)] * 4, channels=3)
        self.scene = self.path("burn.yaml")
        Path(self.scene).write_text(BURNING + "sheets: [{grid: {size: [6 cm, 6 cm], cells: [4, 4]}, picture: print.png}]\n")
        self.run_scene("o", "--quiet", "--frames", "2")
        self.singe("convert", self.path("o"), "--to", "usdz", "--quiet")
        with zipfile.ZipFile(self.path("o", "burn.usdz")) as archive, open(self.path("print.png"), "rb") as file:
            self.assertEqual(archive.read("pictures/0.png"), file.read())
            self.assertIn(b"@pictures/0.png@", archive.read("burn.usda"))
        os.remove(self.path("print.png"))
        self.singe("convert", self.path("o"), "--to", "usdz", "--quiet", expect=2)

    # ---- gas

    def test_gas(self):
        """Finer cells in 16-bit floats; the run's own files stay as they are."""
        self.scene = self.write_scene(frames=4)
        self.run_scene("o", "--quiet", "--set", "pace=16")
        coarse = Path(self.path("o", "gas", "tiny.0004.vdb")).read_bytes()
        out, _ = self.singe("convert", self.path("o"), "--to", "gas")
        self.assertEqual(out.strip(), self.path("o", "gas_detail", "tiny.0001.vdb"))
        found = {}
        for detail in (1, 2, 2, 4):
            self.singe("convert", self.path("o"), "--to", "gas", "--quiet", "--set", "gas.detail=%d" % detail)
            fine = Path(self.path("o", "gas_detail", "tiny.0004.vdb")).read_bytes()
            self.assertEqual(fine.count(b"_HalfFloat"), 5)
            at, = (i + 17 for i in [fine.index(b"size\x05\0\0\0vec3i")])
            size, = [struct.unpack_from("<3I", fine, at)]
            was = struct.unpack_from("<3I", coarse, coarse.index(b"size\x05\0\0\0vec3i") + 17)
            self.assertEqual(size, tuple(detail * n for n in was))
            self.assertIn(found.setdefault(detail, fine), (fine,))
        self.assertLess(len(found[2]), len(found[4]))
        self.assertEqual(len(os.listdir(self.path("o", "gas_detail"))), 4)
        self.assertEqual(Path(self.path("o", "gas", "tiny.0004.vdb")).read_bytes(), coarse)
        self.assertIn("detail must be 1 to 4", self.singe("convert", self.path("o"), "--to", "gas", "--set",
                                                              "gas.detail=5", expect=2)[1])
        self.burn("none", "--frames", "2")
        self.assertIn("has no gas", self.singe("convert", self.path("none"), "--to", "gas", expect=1)[1])

    def test_gas_of_a_run(self):
        """`gas.detail` in a scene: the run writes what `convert` makes, and a resumed one what is missing."""
        def fine(folder):
            inside = self.path(folder, "gas_detail")
            return {name: open(os.path.join(inside, name), "rb").read() for name in sorted(os.listdir(inside))}
        self.scene = self.write_scene(frames=3)
        sets = ("--quiet", "--set", "pace=16", "--set", "output.formats=[usd]")
        self.run_scene("coarse", *sets)
        self.assertFalse(os.path.exists(self.path("coarse", "gas_detail")))
        self.run_scene("run", *sets, "--set", "gas.detail=2", "--no-preview")
        made = fine("run")
        self.assertEqual(len(made), 3)
        self.singe("convert", self.path("coarse"), "--to", "gas", "--to", "usd", "--quiet", "--set", "gas.detail=2")
        self.assertEqual(fine("coarse"), made)
        with open(self.path("run", "tiny.usda")) as one, open(self.path("coarse", "tiny.usda")) as other:
            root = one.read()
            self.assertEqual(root, other.read())
        self.assertEqual((root.count("@./gas_detail/tiny."), root.count("@./gas/tiny.")), (12, 0))
        os.remove(self.path("run", "gas_detail", "tiny.0002.vdb"))
        self.run_scene("run", *sets, "--set", "gas.detail=2", "--resume")
        self.assertEqual(fine("run"), made)
        # the root names the finer gas only where it is there; a run without it takes away an earlier one's
        self.run_scene("run", *sets)
        self.assertFalse(os.path.exists(self.path("run", "gas_detail")))
        self.singe("convert", self.path("run"), "--to", "usd", "--quiet", "--set", "gas.detail=2")
        self.assertNotIn("gas_detail", Path(self.path("run", "tiny.usda")).read_text())

    def test_refusals(self):
        self.burn("o", "--frames", "2")
        self.assertIn("expected one of usd, usdz, glb, vat",
                      self.singe("convert", self.path("o"), "--to", "vtp", "--single", expect=2)[1])
        self.assertIn("expected one of usd, vtp, glb, textures, usdz, vat, gas",
                      self.singe("convert", self.path("o"), "--to", "abc", expect=2)[1])
        self.assertIn("out of range", self.singe("convert", self.path("o"), "--to", "vtp", "--set",
                                                 "output.texture_size=3", expect=2)[1])
        if HAS_EXR:
            # a cache of another mesh than the scene's
            record = json.loads(Path(self.path("o", "run.json")).read_text())
            record["scene"]["sheets"][0]["grid"]["cells"] = [15, 16]
            Path(self.path("o", "run.json")).write_text(json.dumps(record))
            self.assertIn("is not in frame 1", self.singe("convert", self.path("o"), "--to", "vat", expect=2)[1])
            self.assertFalse(os.listdir(self.path("o", "vat")))
        self.no_temporaries("o")
