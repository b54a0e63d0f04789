"""A small scene in a folder of its own, and the program run on it."""

import csv
import hashlib
import json
import os
import re
import resource
import shutil
import struct
import subprocess
import tempfile
import time
import unittest
import zlib
from pathlib import Path

SINGE = os.environ["SINGE"]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
with open(os.path.join(ROOT, "include", "singe", "base.h"), encoding="utf-8") as header:
    VERSION = re.search(r'#define SINGE_VERSION "(.*)"', header.read()).group(1)
HAS_EXR = os.environ.get("SINGE_EXR", "1") == "1"
SANITIZED = os.environ.get("SINGE_SANITIZED", "0") == "1"
HAS_FFMPEG = shutil.which("ffmpeg") is not None
# runs flush each file to the disk, so the tests' folders lie in memory where there is room
FOLDERS = "/dev/shm" if os.path.isdir("/dev/shm") and shutil.disk_usage("/dev/shm").free > 1 << 30 else None

# a corner of a sheet 6 cm wide, lit at an edge; burns through within its frames
SCENE = """\
frames: {frames}
fps: 24
steps: {steps}
pace: 4
sheets:
  - grid: {{size: [6 cm, 6 cm], cells: [{cells}, {cells}]}}
    translate: [0, 0, 5 cm]
sources:
  - kind: spot
    position: [-3 cm, 0, 5 cm]
    temperature: 1200 K
    conductance: 300
    radius: 1 cm
    falloff: 1 cm
preview: {{size: [64, 48], samples: 1}}
gas: {gas}
"""

COLUMNS = (
    "frame,time,particles,springs,triangles,pieces,mass,burnt_fraction,temperature_max,heat_in,heat_lost,"
    "heat_of_combustion,heat_stored,ledger_error,strain_mean,strain_p99,strain_max,inverted_cells,ms_heat,ms_burn,"
    "ms_ablate,ms_dynamics,ms_gas,ms_output"
).split(",")


class Ply:
    """A frame of a cache: its time, columns of the vertices' values by name, and triangles."""

    def __init__(self, path):
        header, body = Path(path).read_bytes().split(b"end_header\n", 1)
        self.header = header.decode()
        self.time = re.search(r"^comment singe \S+ time (\S+)$", self.header, re.MULTILINE).group(1)
        count, faces = (int(n) for n in re.findall(r"^element \w+ (\d+)$", self.header, re.MULTILINE))
        columns = re.findall(r"^property (float|int) (\w+)$", self.header, re.MULTILINE)
        self.names = [name for _, name in columns]
        row = struct.Struct("<" + "".join(kind[0] for kind, _ in columns))
        self.rows = list(row.iter_unpack(body[: row.size * count]))
        self.triangles = [corners[1:] for corners in struct.iter_unpack("<B3i", body[row.size * count :])]
        assert len(self.triangles) == faces

    def columns(self):
        return {name: [row[i] for row in self.rows] for i, name in enumerate(self.names)}

    def vertices(self):
        return [dict(zip(self.names, row)) for row in self.rows]


def write_png(path, rows, channels=1):
    """Writes rows of bytes as a PNG, grey or RGB."""
    header = struct.pack(">IIBBBBB", len(rows[0]) // channels, len(rows), 8, 0 if channels == 1 else 2, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in ((b"IHDR", header), (b"IDAT", pixels), (b"IEND", b"")):
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def at_most(kind, most):
    """A preexec_fn that limits a resource of the child process."""
    return lambda: resource.setrlimit(kind, (most, most))


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = tempfile.mkdtemp(prefix="singe-test-", dir=FOLDERS)
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)
        self.scene = self.write_scene()

    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.mkdtemp(prefix="singe-test-", dir=FOLDERS)
        cls.addClassCleanup(shutil.rmtree, cls.kept, ignore_errors=True)

    def once(self, name, make, changes=False):
        """A folder that make(path) fills, for all tests of a class: it takes long, and is the same for each. It is
        reached in the test's own folder by its name; a test that changes it gets a copy."""
        folder = os.path.join(self.kept, name)
        if not os.path.exists(folder):
            make(folder)
        (shutil.copytree if changes else os.symlink)(folder, self.path(name))

    def path(self, *parts):
        return os.path.join(self.dir, *parts)

    def write_scene(self, name="tiny.yaml", frames=6, steps=2, cells=12, gas="{cell_size: 8 mm}", extra=""):
        path = self.path(name)
        Path(path).write_text(SCENE.format(frames=frames, steps=steps, cells=cells, gas=gas) + extra)
        return path

    def singe(self, *args, expect=0, **options):
        """Runs the program and checks its exit code. Returns what it printed: (stdout, stderr)."""
        options.setdefault("timeout", 120)
        done = subprocess.run([SINGE, *args], capture_output=True, text=True, **options)
        self.assertEqual(done.returncode, expect, f"singe {args}\n{done.stdout}\n{done.stderr}")
        return done.stdout, done.stderr

    def start(self, *args, **options):
        return subprocess.Popen([SINGE, *args], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **options)

    def fake_ffmpeg(self, script):
        """An environment whose ffmpeg is a script of ours."""
        os.makedirs(self.path("bin"), exist_ok=True)
        Path(self.path("bin", "ffmpeg")).write_text("#!/bin/sh\n" + script + "\n")
        os.chmod(self.path("bin", "ffmpeg"), 0o755)
        return {**os.environ, "PATH": self.path("bin") + os.pathsep + os.environ["PATH"]}

    def run_scene(self, out, *args, expect=0, preview=False, **options):
        args = list(args) if preview else [*args, "--no-preview"]
        return self.singe("run", self.scene, "-o", self.path(out), *args, expect=expect, **options)

    def plys(self, out):
        """Digest of every file of the cache's ply folder, by name."""
        folder = self.path(out, "ply")
        digests = {}
        for name in sorted(os.listdir(folder)):
            digests[name] = hashlib.sha256(Path(folder, name).read_bytes()).hexdigest()
        return digests

    def wait_for(self, condition, process=None):
        """Waits until the condition holds or the process has ended."""
        end = time.monotonic() + 60
        while not condition() and (process is None or process.poll() is None):
            self.assertLess(time.monotonic(), end, "timed out")
            time.sleep(0.001)

    def table(self, *parts):
        """The rows of a table of the test's folder."""
        return list(csv.DictReader(Path(self.path(*parts)).read_text().splitlines()))

    def stats(self, out):
        return self.table(out, "stats.csv")

    def numbers(self, out):
        """The stats without the columns that a clock measured."""
        return [{k: v for k, v in row.items() if not k.startswith("ms_")} for row in self.stats(out)]

    def record(self, out):
        return json.loads(Path(self.path(out, "run.json")).read_text())

    def no_temporaries(self, out):
        left = [n for _, _, names in os.walk(self.path(out)) for n in names if n.endswith((".tmp", ".part"))]
        self.assertEqual(left, [])
