"""A small sheet that burns, and a temporary folder for each test."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bindings/python"))

import singe  # noqa: E402

SCENE = """\
frames: 6
steps: 2
pace: 4
sheets:
  - grid: {size: [6 cm, 6 cm], cells: [12, 12]}
    translate: [0, 0, 5 cm]
sources:
  - {kind: spot, position: [-3 cm, 0, 5 cm], temperature: 1200 K, conductance: 300, radius: 1 cm, falloff: 1 cm}
preview: {size: [64, 48], samples: 1}
gas: {cell_size: 8 mm}
"""

# as tests/cli/support.py
FOLDERS = "/dev/shm" if os.path.isdir("/dev/shm") and shutil.disk_usage("/dev/shm").free > 1 << 30 else None


def burning(cells=16, commit=True, **options):
    """A sheet that hangs from two corners, lit at an edge."""
    sim = singe.Sim(pace=5, **options)
    sheet = sim.sheet(*singe.grid((0.1, 0.1), (cells, cells), jitter=0))
    sim.pin(sheet, vertices=[0, cells])
    sim.spot([0.05, 0, 0], radius=0.01, temperature=1200, end=0.5)
    if commit:
        sim.commit()
    return sim


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="singe-test-", dir=FOLDERS))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def scene(self, text=SCENE, name="tiny.yaml"):
        path = self.dir / name
        path.write_text(text)
        return path

    def python(self, text, expect=0):
        """Runs a program of Python with singe; what it printed."""
        text = f"import sys; sys.path[:0] = [{str(ROOT / 'bindings/python')!r}, {str(ROOT / 'tests/python')!r}]\n" + text
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=300,
                              env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout
