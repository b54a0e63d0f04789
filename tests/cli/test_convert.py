"""Formats for other programs: written while running, from the cache, and after a resumption, with the same bytes."""

import json
import os
import re
import struct
import xml.etree.ElementTree as xml
from pathlib import Path

from support import HAS_EXR, Case, Ply, write_png

FORMATS = {"usd": ".usda", "vtp": ".pvd", "glb": None}  # and the ending of their roots; None: no root
if HAS_EXR:
    FORMATS["textures"] = None


class Convert(Case):
    def files(self, out, name):
        """All files that a format has written: {name: bytes}."""
        found = {}
        folder = self.path(out, name)
        for file in sorted(os.listdir(folder)):
            found[file] = Path(folder, file).read_bytes()
        root = self.path(out, "tiny%s" % FORMATS[name])
        if os.path.exists(root):
            found["root"] = Path(root).read_bytes()
        return found

    def run_formats(self, out, *args, **options):
        self.run_scene(out, "--quiet", "--set", "output.formats=[%s]" % ", ".join(FORMATS),
                       "--set", "output.texture_size=64", *args, **options)

    def test_same_bytes(self):
        self.run_formats("o", "--frames", "5")
        self.run_scene("c", "--quiet", "--frames", "5", "--set", "output.texture_size=64")
        for name, root in FORMATS.items():
            self.assertFalse(os.path.exists(self.path("c", name)))
            out, _ = self.singe("convert", self.path("c"), "--to", name)
            self.assertEqual(os.path.exists(out.strip()), True)
            files = self.files("o", name)
            self.assertEqual(files, self.files("c", name), name)
            self.assertEqual(len(files), 5 + (root is not None))
        self.no_temporaries("o")
        self.no_temporaries("c")
        self.assertEqual(self.plys("o"), self.plys("c"))

    def test_some_frames(self):
        """Only these frames are written, with the same bytes, and no root file, which would name missing ones."""
        self.run_formats("o", "--frames", "5")
        self.run_scene("c", "--quiet", "--frames", "5")
        for name in FORMATS:
            out, err = self.singe("convert", self.path("c"), "--to", name, "--frames", "2-3",
                                  "--set", "output.texture_size=64")
            self.assertTrue(os.path.exists(out.strip()), out)
            ends = re.findall(r"frame (\d+)/(\d+)", err)
            self.assertEqual(sum(a == b for a, b in ends), 1, err)
            whole = self.files("o", name)
            part = {file: whole[file] for file in whole if ".0002." in file or ".0003." in file}
            self.assertGreaterEqual(len(part), 2)
            self.assertEqual(self.files("c", name), part)
        error = self.singe("convert", self.path("c"), "--to", "vtp", "--frames", "4-6", expect=2)[1]
        self.assertIn("frames 4-6 are requested, but", error)
        for args in (["--to", "vat"], ["--to", "gas"], ["--to", "usdz"], ["--to", "usd", "--single"]):
            error = self.singe("convert", self.path("c"), *args, "--frames", "2", expect=2)[1]
            self.assertIn("--frames: not with", error)

    def test_progress_ends_once(self):
        """Whatever the format, and however often it reads the frames."""
        self.run_scene("o", "--quiet", "--set", "output.texture_size=64")
        for wanted in (["usd"], ["usd", "glb", "vtp"], ["vat"], ["usdz", "vat", "glb"]):
            with self.subTest(wanted):
                _, err = self.singe("convert", self.path("o"), *(word for name in wanted for word in ("--to", name)))
                ends = re.findall(r"frame (\d+)/(\d+)", err)
                self.assertEqual(sum(a == b for a, b in ends), 1, err)

    def test_resume(self):
        """A run resumed with an additional format leaves the files of a run that had it from the start."""
        self.run_formats("o")
        self.run_scene("r", "--quiet", "--frames", "3")
        self.run_formats("r", "--resume")
        for name in FORMATS:
            self.assertEqual(self.files("o", name), self.files("r", name), name)

    def test_left_overs(self):
        """A new run without formats clears away frames and roots of one that had them, and nothing else."""
        self.run_formats("o", "--frames", "3")
        keep = self.path("o", next(iter(FORMATS)), "mine.txt")
        open(keep, "w").close()
        self.run_scene("o", "--quiet", "--frames", "2")
        for name, root in FORMATS.items():
            left = os.listdir(self.path("o", name)) if os.path.exists(self.path("o", name)) else []
            self.assertIn(left, ([], ["mine.txt"]))
            self.assertFalse(root and os.path.exists(self.path("o", "tiny" + root)))
        self.assertTrue(os.path.exists(keep))

    def test_refusals(self):
        self.run_scene("o", "--quiet", "--frames", "2")
        self.assertIn("needs --to", self.singe("convert", self.path("o"), expect=2)[1])
        self.assertIn("expected one of", self.singe("convert", self.path("o"), "--to", "abc", expect=2)[1])
        self.assertIn("expected one of", self.singe("convert", self.path("o"), "--to", "ply", expect=2)[1])
        self.assertIn("run.json", self.singe("convert", self.path("none"), "--to", "vtp", expect=2)[1])
        error = self.run_scene("x", "--set", "output.formats=[vtk]", expect=2)[1]
        self.assertIn("did you mean 'vtp'?", error)
        self.assertIn("is repeated", self.run_scene("x", "--set", "output.formats=[vtp, vtp]", expect=2)[1])
        with open(self.path("o", "ply", "tiny.0002.ply"), "r+b") as file:
            file.truncate(2000)
        self.assertIn("tiny.0002.ply", self.singe("convert", self.path("o"), "--to", "vtp", expect=2)[1])

    def test_glb_holds_the_cache(self):
        self.run_formats("o", "--frames", "6", "--set", "sheets.0.material.moisture=20 %")
        frame = Ply(self.path("o", "ply", "tiny.0006.ply"))
        count, column = len(frame.rows), frame.columns()
        glb = Path(self.path("o", "glb", "tiny.0006.glb")).read_bytes()
        magic, version, size, text_size, _ = struct.unpack_from("<4s4I", glb)
        self.assertEqual((magic, version, size), (b"glTF", 2, len(glb)))
        stage = json.loads(glb[20 : 20 + text_size])
        data = glb[28 + text_size :]
        self.assertEqual(stage["buffers"][0]["byteLength"], len(data))

        def values(accessor):
            accessor = stage["accessors"][accessor]
            width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
            begin = stage["bufferViews"][accessor["bufferView"]]["byteOffset"]
            return struct.unpack_from("<%df" % (width * accessor["count"]), data, begin)

        primitive, = (mesh["primitives"][0] for mesh in stage["meshes"])
        for name, accessor in primitive["attributes"].items():
            if name[1:].lower() in column:
                self.assertEqual(list(values(accessor)), [float(x) for x in column[name[1:].lower()]], name)
        self.assertIn("_WATER", primitive["attributes"])
        self.assertTrue(0 < max(values(primitive["attributes"]["_WATER"])) <= 0.201)
        at = values(primitive["attributes"]["POSITION"])
        self.assertEqual(len(at), 3 * count)
        # y is up
        self.assertEqual((list(at[0::3]), list(at[1::3]), list(at[2::3])), (column["x"], column["z"], [-y for y in column["y"]]))
        low = stage["accessors"][primitive["attributes"]["POSITION"]]["min"]
        self.assertEqual(struct.pack("<3f", *low), struct.pack("<3f", *(min(at[i::3]) for i in range(3))))
        # Singe takes it for a mesh, too
        with open(self.path("again.yaml"), "w") as file:
            file.write("sheets: [{mesh: o/glb/tiny.0001.glb, up: y}]\npreview: {size: [64, 48], samples: 1}\ngas: no\n")
        self.singe("check", self.path("again.yaml"), "--frames", "1")

    def test_a_single_glb_is_packed_unless_it_is_to_be_plain(self):
        """tests/clients/gltf.js decodes it, and compares the values."""
        write_png(self.path("p.png"), [b"abcdef"] * 2, channels=3)
        self.run_scene("o", "--quiet", "--frames", "3", "--set", "sheets.0.picture=" + self.path("p.png"))
        stages, sizes = [], []
        for plain in (["--plain"], []):
            self.singe("convert", self.path("o"), "--to", "glb", "--single", *plain)
            glb = Path(self.path("o", "tiny.glb")).read_bytes()
            size = struct.unpack_from("<I", glb, 12)[0]
            stages.append(json.loads(glb[20 : 20 + size]))
            sizes.append(len(glb))
            image = stages[-1]["images"][0]
            view = stages[-1]["bufferViews"][image["bufferView"]]
            self.assertEqual(glb[28 + size + view["byteOffset"] :][: view["byteLength"]], Path(self.path("p.png")).read_bytes())
            self.assertEqual(image["mimeType"], "image/png")
        self.assertNotIn("extensionsRequired", stages[0])
        attributes = [[mesh["primitives"][0]["attributes"].keys() for mesh in stage["meshes"]] for stage in stages]
        self.assertEqual(*attributes)
        if "extensionsRequired" in stages[1]:  # this build has meshoptimizer
            self.assertLess(sizes[1], 0.5 * sizes[0])

    def test_vtp_holds_the_cache(self):
        """Every number of the appended arrays is the PLY's, with and without water."""
        for moisture in "0", "20 %":
            with self.subTest(moisture):
                self.run_formats("o", "--frames", "6", "--force", "--set", "sheets.0.material.moisture=" + moisture)
                self.check_vtp(moisture != "0")

    def check_vtp(self, wet):
        frame = Ply(self.path("o", "ply", "tiny.0006.ply"))
        count, column = len(frame.rows), frame.columns()
        vtp = open(self.path("o", "vtp", "tiny.0006.vtp"), "rb").read()
        text, data = vtp.split(b'<AppendedData encoding="raw">\n_', 1)
        root = xml.fromstring(text.decode() + "</VTKFile>")
        piece = root.find("PolyData/Piece")
        self.assertEqual(int(piece.get("NumberOfPoints")), count)
        self.assertGreater(int(piece.get("NumberOfPolys")), 100)
        vectors = {"points": "x y z", "normal": "nx ny nz", "uv": "s t", "velocity": "vx vy vz",
                   "rest": "rest_x rest_y rest_z"}
        checked = 0
        for array in piece.iter("DataArray"):
            size, = struct.unpack_from("<Q", data, int(array.get("offset")))
            kind = {"Float32": "f", "Int32": "i", "Int64": "q"}[array.get("type")]
            values = struct.unpack_from("<%d%s" % (size // struct.calcsize(kind), kind), data, int(array.get("offset")) + 8)
            width = int(array.get("NumberOfComponents"))
            if array.get("Name") in ("connectivity", "offsets"):
                continue
            for i, name in enumerate(vectors.get(array.get("Name"), array.get("Name")).split()):
                self.assertEqual(list(values[i::width]), column[name], name)
                checked += 1
        self.assertEqual(checked, len(column))
        self.assertEqual("water" in column, wet)
        self.assertEqual("primvars:water" in open(self.path("o", "tiny.usda")).read(), wet)
        times = [float(item.get("timestep")) for item in xml.parse(self.path("o", "tiny.pvd")).iter("DataSet")]
        self.assertEqual(times, [frame / 24 for frame in range(6)])
        self.assertEqual(root.find("PolyData/FieldData/DataArray").text, frame.time)
