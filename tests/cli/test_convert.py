"""Formats for other programs: written while running, from the cache, and after a resumption, with the same bytes."""

import os
import re
import struct
import unittest
import xml.etree.ElementTree as xml

from support import Case

FORMATS = {"usd": ".usda", "vtp": ".pvd"}  # and the ending of their roots; None: no root


class Convert(Case):
    def files(self, out, name):
        """All that a format has left: bytes by name."""
        found = {}
        folder = self.path(out, name)
        for file in sorted(os.listdir(folder)):
            with open(os.path.join(folder, file), "rb") as bytes_:
                found[file] = bytes_.read()
        if FORMATS[name]:
            with open(self.path(out, "tiny" + FORMATS[name]), "rb") as bytes_:
                found["root"] = bytes_.read()
        return found

    def run_formats(self, out, *args, **options):
        self.run_scene(out, "--quiet", "--set", "output.formats=[%s]" % ", ".join(FORMATS), *args, **options)

    def test_same_bytes(self):
        self.run_formats("o", "--frames", "5")
        self.run_scene("c", "--quiet", "--frames", "5")
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

    def test_resume(self):
        """A run that goes on, with a format more than it began with, leaves what one from the start does."""
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
        self.assertIn("is there twice", self.run_scene("x", "--set", "output.formats=[vtp, vtp]", expect=2)[1])
        with open(self.path("o", "ply", "tiny.0002.ply"), "r+b") as file:
            file.truncate(2000)
        self.assertIn("tiny.0002.ply", self.singe("convert", self.path("o"), "--to", "vtp", expect=2)[1])

    def test_vtp_holds_the_cache(self):
        """Every number of the appended arrays is the PLY's."""
        self.run_formats("o", "--frames", "6")
        ply = open(self.path("o", "ply", "tiny.0006.ply"), "rb").read()
        header, body = ply.split(b"end_header\n", 1)
        names = re.findall(r"property (float|int) (\w+)", header.decode())
        count = int(re.search(rb"element vertex (\d+)", header).group(1))
        rows = list(struct.iter_unpack("<" + "".join(kind[0] for kind, _ in names), body[: 100 * count]))
        column = {name: [row[i] for row in rows] for i, (_, name) in enumerate(names)}
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
        self.assertEqual(checked, len(names))
        times = [float(item.get("timestep")) for item in xml.parse(self.path("o", "tiny.pvd")).iter("DataSet")]
        self.assertEqual(times, [frame / 24 for frame in range(6)])
        self.assertEqual(root.find("PolyData/FieldData/DataArray").text, re.search(r"time (\S+)", header.decode()).group(1))


if __name__ == "__main__":
    unittest.main()
