"""The materials that are built in burn as their sources say: one is calibrated, the others are predicted."""

import json
import os
import subprocess
import unittest

SINGE = os.environ["SINGE"]


class Front(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = subprocess.run([SINGE, "bench", "front", "--json"], capture_output=True, text=True, timeout=280)
        assert done.returncode == 0, done.stderr
        cls.rows = json.loads(done.stdout)["rows"]
        cls.usual = {row["material"]: row for row in cls.rows if row["cell_mm"] == 1 and row["change_pct"] is None}

    def test_as_sources_say(self):
        self.assertEqual(set(self.usual), {"cotton", "newsprint", "office-paper", "tissue"})
        for row in self.rows:
            print(row["material"], row["cell_mm"], "mm:", row["speed_mm_s_is"], "mm/s,", row["hottest_C_is"], "C")
            with self.subTest(row["material"]):
                self.assertEqual(row["finding"], "as sources say")
                self.assertLessEqual(row["speed_mm_s_from"], row["speed_mm_s_is"])
                self.assertLessEqual(row["speed_mm_s_is"], row["speed_mm_s_to"])
                self.assertEqual(row["basis"], "calibrated" if row["material"] == "office-paper" else "predicted")

    def test_resolution_and_step(self):
        changed = [row for row in self.rows if row["change_pct"] is not None]
        self.assertEqual({row["cell_mm"] for row in changed}, {0.5, 1})
        for row in changed:
            with self.subTest(row["material"]):
                self.assertLess(abs(row["change_pct"]), 5)

    def test_papers_burn_by_mass(self):
        """Speed times grammage is that of office paper, but for what else differs: less ash, and steps that are long
        for tissue."""
        office = self.usual["office-paper"]
        for name in "newsprint", "tissue":
            row = self.usual[name]
            with self.subTest(name):
                ratio = row["speed_mm_s_is"] * row["g_m2"] / (office["speed_mm_s_is"] * office["g_m2"])
                self.assertAlmostEqual(ratio, 1, delta=0.05)


if __name__ == "__main__":
    unittest.main()
