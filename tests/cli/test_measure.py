"""singe measure: its table and file, the jitter by another way, and what is refused."""

import math
import os

from support import SANITIZED, Case, Ply


def read_ply(path):
    """Time, and position and velocity, by vertex of the input mesh, of what has not ignited."""
    frame, found = Ply(path), {}
    for value in frame.vertices():
        if value["vertex_id"] >= 0 and value["time_ignited"] < 0:
            found[value["vertex_id"]] = ([value[k] for k in "xyz"], [value["v" + k] for k in "xyz"])
    return float(frame.time), found


class Measure(Case):
    def setUp(self):
        super().setUp()
        self.run_scene("o", "--quiet")

    def rows(self, *args):
        path = self.path("numbers.csv")
        out, err = self.singe("measure", self.path("o"), "--csv", path, *args)
        self.assertEqual(err, "")
        return out, self.table("numbers.csv")

    def test_table_and_file(self):
        out, rows = self.rows()
        self.assertEqual([int(row["frame"]) for row in rows], list(range(1, 7)))
        self.assertIn("creases along axes over diagonals", out)
        self.assertIn("jitter of the unburnt", out)
        self.assertEqual(rows[0]["jitter_mm_per_s"], "")  # has no frame before it
        shares = [float(word) for line in out.splitlines()[-4:] for word in line.split()[1::2]]
        self.assertEqual(len(shares), 24)
        self.assertAlmostEqual(sum(shares), 1, delta=0.01)

    def test_rim(self):
        """A table of bands, and a column for each of their numbers."""
        self.run_scene("o", "--quiet", "--frames", "30")
        out, rows = self.rows()
        self.assertIn("rim of the largest piece", out)
        bands = [line.split() for line in out.splitlines() if " - " in line and line.split()[1] == "-"]
        self.assertEqual([band[0] for band in bands], ["0", "1", "2", "4", "7", "11", "20"])
        last = {name: float(value) for name, value in rows[-1].items() if name.startswith("rim_") and value}
        self.assertTrue(0.2 < last["rim_0_1_area"] < 1)
        self.assertLess(last["rim_0_1_mass"], last["rim_7_11_mass"])
        self.assertLess(abs(last["rim_20_40_mass"] - 1), 0.2)
        self.assertGreater(float(rows[-1]["curl_p90_deg"]), float(rows[-1]["curl_p50_deg"]))
        self.assertEqual(rows[0]["curl_p50_deg"], "")  # nothing has burnt yet
        self.assertEqual(rows[0]["rim_0_1_area"], "")

    def test_jitter_by_another_way(self):
        _, rows = self.rows()
        frames = [read_ply(self.path("o", "ply", "tiny.%04d.ply" % i)) for i in range(1, 7)]
        for i in range(1, 5):
            (t0, a), (_, b), (t1, c) = frames[i - 1 : i + 2]
            squares = [sum((b[v][1][k] - (c[v][0][k] - a[v][0][k]) / (t1 - t0)) ** 2 for k in range(3))
                       for v in b if v in a and v in c]
            self.assertGreater(len(squares), 50)
            expected = 1e3 * math.sqrt(sum(squares) / len(squares))
            self.assertAlmostEqual(float(rows[i]["jitter_mm_per_s"]), expected, delta=1e-3 * expected + 1e-6)

    def test_what_rests_by_another_way(self):
        """A page that falls has nothing at rest; one that lies on the ground without a fire rests wholly."""
        for name, sets, low, high in (("falls", (), 0, 0), ("lies", ("sheets.0.translate=[0, 0, 0.0005]",), 95, 100)):
            with open(self.path(name + ".yaml"), "w", encoding="utf-8") as scene:
                scene.write("frames: 30\nsheets: [{grid: {size: [0.1, 0.1], cells: [10, 10]}, translate: [0, 0, 5]}]\n"
                            "colliders: [{kind: plane, offset: 0.0005}]\n")
            self.singe("run", self.path(name + ".yaml"), "-o", self.path(name), "--no-preview", "--quiet",
                       *[word for text in sets for word in ("--set", text)])
            self.singe("measure", self.path(name), "--csv", self.path("rest.csv"), "--no-preview")
            row = self.table("rest.csv")[-1]
            (_, vertices) = read_ply(self.path(name, "ply", name + ".0030.ply"))
            squares = sorted(sum(v * v for v in vertex[1]) for vertex in vertices.values())
            # a sheet at rest without a fire does not creep: p99 of .01 mm/s
            self.assertEqual(squares[int(0.99 * len(squares))] < 1e-10, name == "lies")
            slow = [square < 1e-8 for square in squares]
            self.assertAlmostEqual(float(row["still_percent"]), 100 * sum(slow) / len(slow), delta=0.01)
            self.assertTrue(low <= float(row["still_percent"]) <= high, row["still_percent"])

    def test_frames(self):
        _, rows = self.rows("--frames", "3-5")
        self.assertEqual([int(row["frame"]) for row in rows], [3, 4, 5])
        self.assertNotEqual(rows[1]["jitter_mm_per_s"], "")

    def test_fire_is_drawn_unless_asked_otherwise(self):
        root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
        letter = os.path.join(root, "examples", "letter", "letter.yaml")
        sets = ("pace=16", "gas.cell_size=0.02", "preview.size=[160, 120]",
                f"sheets.0.grid.cells={[14, 20] if SANITIZED else [21, 30]}")
        self.singe("run", letter, "-o", self.path("o"), "--no-preview", "--frames", "14",
                   *(word for value in sets for word in ("--set", value)))
        drawn, without = self.rows()[1], self.rows("--no-preview")[1]
        seen = ("ember_width_mm", "flame_pale_percent", "flame_lemon_percent", "flame_foot_p50_mm", "flame_foot_p90_mm",
                "flame_astray_percent")
        for name in seen:
            self.assertTrue(any(row[name] for row in drawn), name)
            self.assertFalse(any(row[name] for row in without), name)
        for row, other in zip(drawn, without):
            row.update((name, "") for name in seen)
            self.assertEqual(row, other)

    def test_damaged_frame(self):
        path = self.path("o", "ply", "tiny.0003.ply")
        with open(path, "r+b") as file:
            file.truncate(os.path.getsize(path) // 2)
        self.assertIn("tiny.0003.ply", self.singe("measure", self.path("o"), expect=2)[1])
