"""The materials that are built in burn as their sources say: one is calibrated, the others are predicted."""

import json
import os
import subprocess
import unittest
from pathlib import Path

SINGE = os.environ["SINGE"]
MATERIALS = {path.stem for path in (Path(__file__).parents[2] / "src/materials").glob("*.yaml")}


def front(*options):
    done = subprocess.run([SINGE, "bench", "front", "--json", *options], capture_output=True, text=True, timeout=580)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["rows"]


class Front(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with_gas = front("--material", "tissue")  # the quickest to burn
        cls.rows = front("--quick", "--material", ",".join(MATERIALS - {"tissue"})) + with_gas
        for row in cls.rows:
            print(row["material"], row["direction"], row["cell_mm"], row["speed_mm_s_is"], row["finding"])

    def rows_of(self, *directions):
        return [row for row in self.rows if row["direction"] in directions]

    def usual(self, direction):
        return {row["material"]: row for row in reversed(self.rows_of(direction))}

    def test_as_sources_say(self):
        self.assertEqual(set(self.usual("still")), MATERIALS)
        for row in self.rows_of("still", "level"):
            with self.subTest(row["material"], direction=row["direction"]):
                self.assertEqual(row["finding"], "as sources say")
                self.assertLessEqual(row["speed_mm_s_from"], row["speed_mm_s_is"])
                self.assertLessEqual(row["speed_mm_s_is"], row["speed_mm_s_to"])
                self.assertEqual(row["basis"], "calibrated" if row["material"] == "office-paper" else "predicted")

    def test_resolution_and_step(self):
        changed = [row for row in self.rows_of("still") if row["change_pct"] is not None]
        self.assertEqual({row["cell_mm"] for row in changed}, {0.5, 1})
        for row in changed:
            with self.subTest(row["material"]):
                self.assertLess(abs(row["change_pct"]), 5)

    def test_papers_burn_by_mass(self):
        """Speed times grammage is nearly that of office paper: other papers have less ash, and for tissue the steps are
        long."""
        usual = self.usual("still")
        office = usual["office-paper"]
        for name in "newsprint", "tissue":
            row = usual[name]
            with self.subTest(name):
                ratio = row["speed_mm_s_is"] * row["g_m2"] / (office["speed_mm_s_is"] * office["g_m2"])
                self.assertAlmostEqual(ratio, 1, delta=0.05)

    def test_directions(self):
        """Down is as level, and up is four times that and more."""
        down = self.usual("down")
        self.assertEqual(set(down), {"tissue"})
        for row in self.rows_of("down", "up"):
            with self.subTest(row["material"], direction=row["direction"]):
                self.assertEqual(row["finding"], "near level" if row["direction"] == "down" else "climbs")
        for row in self.rows_of("up"):
            self.assertGreater(row["speed_mm_s_is"], 4 * down[row["material"]]["speed_mm_s_is"])
