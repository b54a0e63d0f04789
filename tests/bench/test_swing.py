"""singe bench swing: a square metre that falls from the horizontal keeps its edges' lengths and moves as it should."""

import json
import os
import subprocess
import unittest

FALL = {"0.33": -0.373, "0.50": -0.486, "0.67": -0.299}  # m, where all solvers converge to with finer time steps


def swing(*options):
    command = [os.environ["SINGE"], "bench", "swing", "--cells", "32", "--json", *options]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["rows"]


class Swing(unittest.TestCase):
    def hold(self, row, strain_max, strain_p99):
        with self.subTest(thickness=row["thickness_mm"]):
            self.assertEqual((row["result"], row["bars"]), ("ok", "held"))
            self.assertLessEqual(row["blue_pct_max"], strain_max)
            self.assertLessEqual(row["blue_pct_p99"], strain_p99)

    def test_two_corners(self):
        rows = swing("--thickness", "1,2,5")
        self.assertEqual(len(rows), 3)
        for row in rows:
            self.hold(row, 0.5, 0.05)
            for mark, height in FALL.items():
                self.assertAlmostEqual(row[f"fall_m_{mark}"], height, delta=0.02)

    def test_a_start_leaves_less_strain(self):
        options = ("--thickness", "1", "--steps", "1", "--substeps", "48", "--time", "0.7", "--start")
        without, with_start = swing(*options, "0")[0], swing(*options, "0.6")[0]
        for column, share in (("blue_pct_p99", 0.5), ("blue_pct_mean", 0.55), ("off_cm", 0.3)):
            self.assertLess(with_start[column], share * without[column])

    def test_edges_are_projected_again(self):
        # projected once they have .0082 % in the mean held by two corners, and 4.4 % at most by one
        options = ("--thickness", "1", "--steps", "1", "--start", "0", "--time", "0.7")
        self.assertLess(swing(*options, "--substeps", "16")[0]["blue_pct_mean"], 0.006)
        self.assertLess(swing(*options, "--substeps", "32", "--pins", "1")[0]["blue_pct_max"], 2.5)

    def test_one_corner(self):
        for row in swing("--thickness", "1,2,5", "--pins", "1"):
            self.hold(row, 5, 0.5)

    def test_bars_are_marked(self):
        options = ("--thickness", "1", "--steps", "2", "--substeps", "1")
        self.assertEqual(swing(*options, "--time", "0.8")[0]["bars"], "missed")
        self.assertEqual(swing(*options, "--time", "0.1")[0]["bars"], "-")
