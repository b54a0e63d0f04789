"""Fire climbs faster in its own rising gas than it creeps down, on cells of any size."""

import json
import os
import subprocess
import unittest

SINGE = os.environ["SINGE"]


class Spread(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        command = [SINGE, "bench", "spread", "--quick", "--threads", "1", "--json"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=280)
        assert done.returncode == 0, done.stderr
        cls.rows = json.loads(done.stdout)["rows"]
        for row in cls.rows:
            print(row["direction"], row["cell_mm"], "mm, gas", row["gas_mm"], "mm:", row["speed_mm_s_is"], "mm/s")

    def speed(self, direction, cell=2, gas_cell=6):
        for row in self.rows:
            if row["direction"] == direction and row["cell_mm"] == cell and row["gas_mm"] == gas_cell:
                return row["speed_mm_s_is"]
        self.fail(f"no row {direction} {cell} {gas_cell}")

    def test_up_at_least_four_times_down(self):
        self.assertGreaterEqual(self.speed("up"), 4 * self.speed("down"))
        self.assertGreaterEqual(self.speed("up", cell=1), 4 * self.speed("down"))
        self.assertGreaterEqual(self.speed("up", gas_cell=9), 4 * self.speed("down"))

    def test_down_is_near_level(self):
        self.assertLessEqual(0.7 * self.speed("level"), self.speed("down"))
        self.assertLessEqual(self.speed("down"), 1.5 * self.speed("level"))

    def test_level_at_its_real_pace(self):
        """80 g/m2: 4.4 to 7.0 mm/s, with the gas as without (Thomas & Law, FRN 584)."""
        for speed in self.speed("still", gas_cell=None), self.speed("level"):
            self.assertLessEqual(4.4, speed)
            self.assertLessEqual(speed, 7.0)

    def test_cells_do_not_matter_much(self):
        usual = self.speed("up")
        for other in self.speed("up", cell=1), self.speed("up", gas_cell=4), self.speed("up", gas_cell=9):
            self.assertLess(abs(other / usual - 1), 0.25)
