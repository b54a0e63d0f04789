"""singe bench: every measurement at a tiny size, its JSON and CSV, and what is refused."""

import csv
import json
import math
import re
import subprocess
import sys
import xml.dom.minidom
from pathlib import Path

from support import ROOT, SINGE, Case

# a measurement, options that make it short, and keys that its rows must have
TINY = (
    ("swing", ["--cells", "6,8", "--thickness", "2", "--time", "0.1"], ["cpu_ms", "blue_pct_max", "fall_m_0.33"]),
    ("hang-and-shrink", ["--cells", "8", "--thickness", "2", "--time", "0.1"], ["blue_pct_p99", "speed", "result"]),
    ("dynamics", ["--springs", "250,1000", "--steps", "3", "--quick"], ["step_ms", "ns_spring_sweep", "blue_pct_mean"]),
    ("dynamics", ["--springs", "250", "--steps", "3", "--quick", "--state", "shrink", "--threads", "2"], ["gflops"]),
    ("step", ["--springs", "1000", "--steps", "3"], ["step_ms", "heat_ms", "contacts"]),
    ("front", ["--material", "tissue", "--quick"], ["speed_mm_s_is", "hottest_C_from", "finding"]),
    ("surface", ["--springs", "1000", "--steps", "20"], ["detail_mm", "triangles", "fine_pct", "surface_ms"]),
    ("heap", ["--cells", "8", "--time", "0.1"], ["step_ms", "pairs_step", "inverted"]),
    ("collapse", ["--cells", "6", "--time", "0.1"], ["stops_step", "repulsions_substep"]),
    ("drop", ["--cells", "12", "--time", "0.1", "--steps", "3"], ["frame_ms", "worst_p99_pct", "max_mb"]),
    ("wind", ["--cells", "12", "--time", "0.05"], ["wind_m_s", "of_first", "crossing"]),
    ("memory", ["--springs", "1000"], ["bytes_spring", "all_bytes_spring"]),
    ("compare", ["--springs", "250", "--time", "0.1", "--quick"], ["ratio", "no_more_error"]),
    ("stability", ["--cells", "8", "--quick", "--time", "0.1"], ["result", "max_strain_pct"]),
    ("spectrum", ["--quick", "--time", "0.05", "--substeps", "2"], ["wavelength_mm", "base", "h_x_2", "s_div_2"]),
    ("isotropy", ["--quick", "--outline", "disc", "--cells", "12", "--time", "0.05", "--seeds", "3"],
     ["r_0", "r_45", "effect", "mean", "error", "gentle", "sharp"]),
    ("plate", ["--quick", "--cells", "6", "--substeps", "3"], ["over_D", "k1_per_m", "rolls_deg"]),
)


# whose tables are more than columns: facts above them, notes below them, a drawing. All others are printed by the same
# lines of table.c
PRINTED = ("swing", "step", "front", "compare", "stability", "plate")


class Bench(Case):
    def measure(self, *args):
        out, err = self.singe("bench", *args, "--json")
        self.assertEqual(err, "")
        return json.loads(out)

    def test_tables(self):
        for name, options, keys in TINY:
            if name not in PRINTED:
                continue
            with self.subTest(name):
                drawn = ["--svg", self.path("plate.svg")] if name == "plate" else []
                out, err = self.singe("bench", name, *options, *drawn)
                self.assertEqual(err, "")
                self.assertGreaterEqual(len(out.splitlines()), 2)
        svg = Path(self.path("plate.svg")).read_text()
        self.assertEqual(svg.count("<path "), 12)  # strips at 0 and 45 degrees and four discs, without and with `isotropic`
        self.assertTrue(svg.endswith("</svg>\n"))

    def test_json_and_csv(self):
        for name, options, keys in TINY:
            with self.subTest(name):
                path = self.path("table.csv")
                result = self.measure(name, *options, "--csv", path)
                self.assertEqual(result["command"], name)
                self.assertTrue(result["machine"])
                rows = result["rows"]
                self.assertGreaterEqual(len(rows), 1)
                for key in keys:
                    self.assertIn(key, rows[0])
                with open(path, newline="") as file:
                    table = list(csv.DictReader(line for line in file if not line.startswith("#")))
                self.assertEqual([list(row) for row in table], [list(row) for row in rows])
                for line, row in zip(table, rows):
                    for key, value in row.items():
                        if value is None:
                            self.assertEqual(line[key], "")
                        if isinstance(value, float):
                            self.assertAlmostEqual(float(line[key]), value, delta=1e-5 * abs(value))

    def test_same_springs_and_cells(self):
        rows = self.measure("memory", "--springs", "1000,4000,100000")["rows"]
        self.assertEqual([row["springs"] for row in rows], [1000, 4000, 100000])
        # 618, 220 and 112 with chunks of 64 items, boxes in the entries of the grid and lists that grow in the first
        # step; 498, 190 and 92 with memory of its own for each of two lists that are never needed at the same time
        for row, most in zip(rows, (470, 180, 90)):
            self.assertGreater(row["contact_bytes_spring"], 50)
            self.assertLess(row["contact_bytes_spring"], most)
        rows = self.measure("swing", "--cells", "6,8", "--thickness", "1,2.5", "--time", "0.05")["rows"]
        self.assertEqual([(r["cells"], r["thickness_mm"]) for r in rows], [(6, 1), (6, 2.5), (8, 1), (8, 2.5)])

    def test_swing_falls(self):
        """The motion that all solvers converge to, within what eight cells can show."""
        row = self.measure("swing", "--cells", "8", "--thickness", "1", "--time", "1")["rows"][0]
        self.assertEqual(row["result"], "ok")
        self.assertAlmostEqual(row["fall_m_0.33"], -0.373, delta=0.03)
        self.assertLess(row["blue_pct_mean"], 1)
        self.assertGreater(row["cpu_ms"], 0)

    def test_shrink_ends_at_its_ratio(self):
        """A sheet held by one corner, far from any stress, ends with lengths of 0.8."""
        options = ["--cells", "8", "--thickness", "5", "--pins", "1", "--time", "1.2"]
        row = self.measure("hang-and-shrink", *options)["rows"][0]
        self.assertEqual(row["result"], "ok")
        self.assertTrue(math.isfinite(row["speed"]))
        self.assertLess(row["blue_pct_mean"], 1, "strain is measured against the lengths that shrink")

    def test_peaks(self):
        result = self.measure("dynamics", "--springs", "250", "--steps", "2", "--quick")
        self.assertGreater(result["fma_gflops"], 0.1)
        self.assertGreater(result["stream_24k_gb_s"], 0.1)

    def test_instructions_of_this_processor_and_of_another(self):
        """Each set is run or refused; those of Arm, x86-64 and WebAssembly never run together."""
        refused = {}
        for name in "plain", "v2", "v3", "v4", "neon", "simd128":
            command = [SINGE, "bench", "compare", "--springs", "250", "--time", "0.1", "--quick", "--instructions", name]
            done = subprocess.run(command, capture_output=True, text=True)
            refused[name] = "this processor lacks the requested instructions" in done.stderr
            self.assertEqual(done.returncode, 1 if refused[name] else 0, done.stderr)
        self.assertFalse(refused["plain"])
        self.assertGreaterEqual(refused["neon"] + refused["v2"] + refused["simd128"], 2)

    def test_a_crowd_is_not_strained_by_its_pushes(self):
        row = self.measure("stack", "--sheets", "10", "--cells", "20", "--time", "0.3", "--threads", "1")["rows"][0]
        self.assertLess(row["worst_p99_pct"], 2.6)  # 3.6 where all pushes come last, 1.7 where sides have their turns
        self.assertEqual(row["crossing"], 0)

    def test_few_long_steps_hold_a_drop(self):
        """Three steps a frame are enough, with substeps: these decide the strain."""
        drop = ["drop", "--cells", "50", "--steps", "3"]
        row, few = (self.measure(*drop, "--substeps", n)["rows"][0] for n in ("10", "3"))
        self.assertLess(row["worst_p99_pct"], 4)  # 2.8, and 14 with three substeps
        self.assertEqual(row["crossing"], 0)
        self.assertGreater(few["worst_p99_pct"], 4)

    def test_wind_costs_by_its_speed(self):
        """Three times the wind is at most four times the work, and nothing crosses; six times the wind is more."""
        calm, windy, stormy = self.measure("wind")["rows"]
        self.assertEqual([row["crossing"] for row in (calm, windy, stormy)], [0, 0, 0])
        self.assertLess(windy["of_first"], 4)  # 3.1; 39 when CCD went on in rounds over all that moved
        self.assertGreater(stormy["of_first"], 4)

    def test_limit(self):
        out, err = self.singe("bench", "step", "--springs", "1000", "--steps", "3", "--limit-ms", "0.001", expect=1)
        self.assertIn("above the limit of 0.001 ms", err)
        self.singe("bench", "step", "--springs", "1000", "--steps", "3", "--limit-ms", "10000")

    def test_draw_cost(self):
        table, picture = self.path("a&b.csv"), self.path("cost.svg")
        self.singe("bench", "dynamics", "--springs", "250,1000", "--steps", "2", "--quick", "--csv", table)
        subprocess.run([sys.executable, ROOT + "/scripts/draw_cost.py", table, picture], check=True)
        texts = [node.firstChild.data for node in xml.dom.minidom.parse(picture).getElementsByTagName("text")]
        self.assertIn("strand, 1 thread, a&b", texts)
        self.assertTrue(any("Table 2" in text for text in texts))

    def test_help(self):
        out, _ = self.singe("bench", "--help")
        listed = re.findall(r"^  ([a-z-]+) ", out.split("measurements:")[1].split("\n\n")[0], re.M)
        section = (Path(ROOT) / "docs/cli.md").read_text().split("\n## bench\n")[1].split("\n## ")[0]
        self.assertEqual(sorted(re.findall(r"^\| `([a-z-]+)` \|", section, re.M)), sorted(listed))
        for name, options, _ in TINY:
            self.assertIn(name, out)
            help = self.singe("bench", name, "--help")[0]
            self.assertIn(f"usage: singe bench {name}", help)
            for option in options:
                if option.startswith("--"):
                    self.assertIn(option, help)

    def test_bad_usage(self):
        for args, hint in (
            ([], "a measurement is missing"),
            (["swin"], "did you mean 'swing'?"),
            (["--swing"], "unknown measurement"),
            (["swing", "x"], "unexpected argument"),
            (["swing", "--cells", "1"], "whole numbers from 2 to 2000"),
            (["swing", "--cells", "8,"], "whole numbers from 2 to 2000"),
            (["swing", "--cells", "8.5"], "whole numbers"),
            (["swing", "--cells", ""], "whole numbers"),
            (["swing", "--cells", "nan"], "whole numbers"),
            (["swing", "--cells", ",".join(["8"] * 17)], "at most 16"),
            (["swing", "--thickness", "0"], "--thickness: expected numbers from 0.01 to 100 as MM,MM,..."),
            (["swing", "--pins", "3"], "from 1 to 2"),
            (["swing", "--time", "0"], "--time S: expected a number from 0.01 to 60"),
            (["swing", "--time", "1s"], "a number from 0.01 to 60"),
            (["swing", "--substeps", "0"], "from 1 to 1000"),
            (["swing", "--threads", "65"], "from 1 to 64"),
            (["swing", "--springs", "1000"], "unknown option"),
            (["dynamics", "--springs", "10"], "from 40 to 40000000"),
            (["dynamics", "--solver", "best"], "strand, paper"),
            (["dynamics", "--instructions", "v5"], "v2, v3, v4, neon or simd128"),
            (["dynamics", "--state", "still"], "swing or shrink"),
            (["dynamics", "--json=1"], "takes no value"),
            (["step", "--limit-ms", "-1"], "a number from 0.001 to 1000000"),
            (["memory", "--steps", "3"], "unknown option"),
            (["isotropy", "--outline", "ring"], "square or disc"),
            (["isotropy", "--curvature", "-1"], "numbers from 0 to 1000000"),
            (["isotropy", "--seeds", "0"], "whole numbers from 1 to 1000000"),
        ):
            with self.subTest(args=args):
                self.assertIn(hint, self.singe("bench", *args, expect=2)[1])

    def test_csv_that_cannot_be_written(self):
        _, err = self.singe("bench", "memory", "--springs", "250", "--csv", self.path("no", "x.csv"), expect=1)
        self.assertIn("cannot write", err)
