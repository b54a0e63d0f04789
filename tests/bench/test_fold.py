"""singe bench fold: what stays of a fold is the same at every resolution and time step; without creases
nothing stays."""

import json
import os
import subprocess
import unittest


class Fold(unittest.TestCase):
    def test_angles(self):
        command = [os.environ["SINGE"], "bench", "fold", "--quick", "--json"]
        rows = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["rows"]
        sharp = [row for row in rows if row["bent_deg"] == 180]
        gentle = [row for row in rows if row["bent_deg"] == 45]
        self.assertEqual((len(sharp), len(gentle)), (6, 6))
        left = [row["left_deg"] for row in sharp]
        self.assertLess(max(left) - min(left), 6)
        for row in sharp:
            self.assertAlmostEqual(row["left_deg"], row["expected_deg"], delta=8)
            self.assertGreater(row["left_deg"], 85)
        for row in gentle:
            self.assertLess(abs(row["left_deg"]), 1)
        for row in rows:
            self.assertLess(abs(row["elastic_deg"]), 1)
            self.assertEqual(row["inverted"], 0)
