"""singe paper, and the paper's solver in a scene."""

import csv
import os
import unittest

from support import Case

TABLE1 = "0.4306 0.4401 0.5527 0.4954 0.5767 0.5038 0.5804 0.5050 0.5810 0.5052".split()


class Paper(Case):
    def test_table1(self):
        out, _ = self.singe("paper", "table1")
        for number in TABLE1:
            self.assertGreaterEqual(out.count(number), 2, "ours beside the paper's")
        self.assertIn("largest difference 0.0000", out)

    def test_fig8(self):
        out, _ = self.singe("paper", "fig8", "-o", self.path("new", "fig"), timeout=600)
        self.assertEqual(out.count("never rises"), 2)
        for state in "swing", "shrink":
            with open(self.path("new", "fig", f"fig8-{state}.csv")) as file:
                rows = list(csv.DictReader(file))
            sums = [float(row["sum"]) for row in rows]
            self.assertEqual(len(rows), 21)
            self.assertEqual(sums, sorted(sums, reverse=True))
            for row in rows:
                self.assertAlmostEqual(sum(float(row[c]) for c in ("red", "green", "blue", "yellow")) /
                                       float(row["sum"]), 1, 6)
            with open(self.path("new", "fig", f"fig8-{state}.svg")) as file:
                svg = file.read()
            self.assertTrue(svg.startswith("<svg ") and svg.rstrip().endswith("</svg>"))
            self.assertEqual(svg.count("<path "), 5)

    def test_fig8_folder(self):
        with open(self.path("file"), "w"):
            pass
        _, err = self.singe("paper", "fig8", "-o", self.path("file"), expect=1)
        self.assertIn("file", err)

    def test_all_at_once(self):
        out, _ = self.singe("paper", "all-at-once", timeout=600)
        self.assertIn("360 constraints, 249 degrees of freedom", out)

    def test_scene_with_the_method(self):
        small = self.write_scene("small.yaml", frames=3, steps=1, cells=6)
        for setting in "solver=paper", "solver.method=paper":
            with self.subTest(setting=setting):
                _, err = self.singe("run", small, "-o", self.path("out"), "--no-preview", "--set", setting)
                self.assertIn("solver: up to 7 projections", err)
                with open(self.path("out", "run.json")) as file:
                    self.assertIn('"method": "paper"', file.read())
        _, err = self.singe("check", small, "--set", "solver=papers", expect=2)
        self.assertIn("did you mean 'paper'?", err)


if __name__ == "__main__":
    unittest.main()
