"""The gas in a run's folder: drawn from its files, removed with the rest, refused when damaged."""

import os
import shutil
import subprocess
from pathlib import Path

from support import Case

SAMPLE = os.environ["VDB_SAMPLE"]


class Gas(Case):
    def vdb(self, frame, out="o"):
        return self.path(out, "gas", "tiny.%04d.vdb" % frame)

    def put_gas(self, frame):
        """A column of flame over the sheet, as if the run had written it."""
        os.makedirs(self.path("o", "gas"), exist_ok=True)
        subprocess.run([SAMPLE, self.vdb(frame), "37", "21", "40"], check=True, stdout=subprocess.DEVNULL)

    def read(self, path):
        return Path(path).read_bytes()

    def vdbs(self, out):
        folder = self.path(out, "gas")
        return {name: self.read(os.path.join(folder, name)) for name in sorted(os.listdir(folder))}

    def test_run_writes_it(self):
        """One file a frame, the same for any number of threads and after a resumption; none without gas."""
        self.run_scene("o", "--quiet", "--threads", "1")
        files = self.vdbs("o")
        self.assertEqual(list(files), ["tiny.%04d.vdb" % i for i in range(1, 7)])
        self.assertGreater(len(files["tiny.0006.vdb"]), len(files["tiny.0001.vdb"]))
        self.run_scene("r", "--quiet", "--threads", "2", "--frames", "3")
        self.run_scene("r", "--quiet", "--resume")
        self.assertEqual(self.vdbs("r"), files)
        self.run_scene("o", "--quiet", "--set", "gas=no")
        self.assertFalse(os.path.exists(self.path("o", "gas")))

    def test_same_pictures_from_files(self):
        """Pictures drawn from files equal those of the run; without the gas files, flames are missing."""
        self.run_scene("o", "--quiet", preview=True)
        png = self.path("o", "frames", "tiny.0006.png")
        drawn = self.read(png)
        self.singe("render", self.path("o"), "--frames", "6")
        self.assertEqual(self.read(png), drawn)
        os.remove(self.vdb(6))
        self.singe("render", self.path("o"), "--frames", "6")
        self.assertNotEqual(self.read(png), drawn)

    def test_render_reads_it(self):
        self.run_scene("o", "--quiet", preview=True)
        shutil.rmtree(self.path("o", "gas"), ignore_errors=True)
        png = self.path("o", "frames", "tiny.0003.png")
        self.singe("render", self.path("o"), "--frames", "3")
        without = self.read(png)
        self.put_gas(3)
        self.singe("render", self.path("o"), "--frames", "3", "--threads", "2")
        burning = self.read(png)
        self.assertNotEqual(burning, without)
        self.singe("render", self.path("o"), "--frames", "3", "--threads", "1")
        self.assertEqual(self.read(png), burning)
        with open(self.vdb(3), "r+b") as file:
            file.truncate(9000)
        self.assertIn("tiny.0003.vdb", self.singe("render", self.path("o"), "--frames", "3", expect=2)[1])
        os.remove(self.vdb(3))
        self.singe("render", self.path("o"), "--frames", "3")
        self.assertEqual(self.read(png), without)

    def test_left_overs(self):
        """A new run removes the files of an earlier one, a resumed run half-written files; other files stay."""
        self.run_scene("o", "--quiet", "--frames", "3")
        self.put_gas(5)
        for name in "tiny.0002.vdb.4711-0.tmp", "tiny.0002.vdb.bak", "other.0001.vdb":
            shutil.copy(self.vdb(5), self.path("o", "gas", name))
        self.run_scene("o", "--quiet", "--frames", "4", "--resume")
        self.no_temporaries("o")
        self.assertTrue(os.path.exists(self.vdb(5)))
        self.run_scene("o", "--quiet", "--frames", "3")
        self.assertFalse(os.path.exists(self.vdb(5)))
        left = sorted(os.listdir(self.path("o", "gas")))
        self.assertEqual([n for n in left if not n.startswith("tiny.000") or n.endswith(".bak")],
                         ["other.0001.vdb", "tiny.0002.vdb.bak"])
