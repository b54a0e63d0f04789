"""What scripts/bench_peers.py measures of another solver: strain and height of a sheet whose motion is known, and what it
says of a peer that fails."""
import os
import stat
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))
import bench_peers  # noqa: E402

# a sheet that hangs level at a height and is 1 % too wide along x
PEER = """#!{python}
import struct, sys
cells, frames, out = int(sys.argv[1]), int(sys.argv[2]), sys.argv[5]
side = cells + 1
with open(out, "wb") as file:
    for frame in range(1, frames + 1):
        height = {{8: -.373, 12: -.486, 16: -.299}}.get(frame, 0) + {above}
        print(frame / 10)
        for k in range(side * side - {short}):
            file.write(struct.pack("3f", 1.01 * (k % side) / cells, k // side / cells, height))
"""


class Peers(unittest.TestCase):
    def row(self, above=0.0, short=0, drop=False):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "peer")
            Path(path).write_text(PEER.format(python=sys.executable, above=above, short=short), encoding="utf-8")
            os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
            return bench_peers.run_peer("Known", [path], 8, 10, 5, drop)

    def test_known_motion(self):
        name, ms, most, p99, mean, off = self.row(above=0.02)
        self.assertEqual(name, "Known, 10 steps of 5 iterations")
        self.assertAlmostEqual(ms, 0.85)
        self.assertAlmostEqual(most, 1, 3)
        self.assertAlmostEqual(p99, 1, 3)
        self.assertAlmostEqual(mean, 0.5, 3)  # half of the edges lie along y
        self.assertAlmostEqual(off, 2, 3)

    def test_a_known_drop(self):
        name, ms, end, worst = self.row(drop=True)
        self.assertAlmostEqual(ms, 2.45)  # the mean of 48 frames
        self.assertAlmostEqual(end, 1, 3)
        self.assertAlmostEqual(worst, 1, 3)

    def test_a_peer_that_is_cut_short_is_refused(self):
        with self.assertRaisesRegex(ValueError, "not 16 frames of 81 points"):
            self.row(short=1)

    def test_a_peer_that_fails_is_named(self):
        self.assertEqual(bench_peers.run_peer("Nobody", ["false"], 8, 10, 5), "Nobody: failed: no word")
