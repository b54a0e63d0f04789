"""singe bench tear: a strip that is pulled apart breaks at its weakest line, at the same load for all cells and
steps."""

import json
import os
import subprocess
import unittest

LINE_STRENGTH = 1  # N/m, bench/measure_tear.c


class Tear(unittest.TestCase):
    def test_load(self):
        command = [os.environ["SINGE"], "bench", "tear", "--json"]
        rows = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["rows"]
        self.assertEqual(len({(row["cell_mm"], row["step_ms"]) for row in rows}), 4)
        for row in rows:
            with self.subTest(cell=row["cell_mm"], step=row["step_ms"]):
                self.assertLessEqual(abs(row["off_pct"]), 10)
                self.assertLessEqual(abs(row["load_n_m"] / LINE_STRENGTH - 1), 0.2)
                self.assertEqual((row["pieces"], row["aside"]), (2, 0))
