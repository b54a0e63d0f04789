"""Sheets of one scene as separate runs: which are together, what a row has, and whether they stayed apart."""

import csv
import os
import re
import shutil
import struct
import unittest

from support import Case

SHEET = "  - {{grid: {{size: [6 cm, 6 cm], cells: [12, 12]}}, translate: {at}, name: {name}{more}}}\n"


class Sheets(Case):
    def write(self, places, plan="", velocity="", extra=""):
        """A scene of sheets side by side, and its plan. The last sheet has the velocity."""
        with open(self.path("many.yaml"), "w") as file:
            file.write("frames: 6\ndetail: 0\nraggedness: 0\ngravity: [0, 0, 0]\nair_density: 0\ngas: no\n"
                       "preview: {size: [64, 48], samples: 1}\nsheets:\n")
            for i, at in enumerate(places):
                more = f", velocity: {velocity}" if velocity and i + 1 == len(places) else ""
                file.write(SHEET.format(at=at, name=f"s{i}", more=more))
            file.write("sources:\n  - {kind: spot, position: [0.53, 0, 0.2], radius: 1 cm, temperature: 850 C}\n")
            file.write(extra)
        with open(self.path("plan.yaml"), "w") as file:
            file.write("scene: many.yaml\nmethod: sheets\n" + plan)

    def sweep(self, *args, expect=0):
        shutil.rmtree(self.path("p"), ignore_errors=True)
        return self.singe("sweep", self.path("plan.yaml"), "-o", self.path("p"), "--no-preview", *args, expect=expect)

    def table(self, name):
        with open(self.path("p", name), newline="") as file:
            return list(csv.DictReader(file))

    def groups(self, *args):
        self.sweep("--print", *args)
        return [row["only_sheets"] for row in self.table("plan.csv")]

    def vertices(self, out, frame, sheet):
        """Positions of a sheet's vertices."""
        path = self.path(out, "ply", f"many.{frame:04d}.ply")
        with open(path, "rb") as file:
            head, _, body = file.read().partition(b"end_header\n")
        count = int(re.search(rb"element vertex (\d+)", head)[1])
        lines = re.search(rb"element vertex \d+\n(.*?)element", head, re.S)[1].decode().split("\n")
        names = [line.split()[2] for line in lines if line.startswith("property")]
        kinds = [line.split()[1] for line in lines if line.startswith("property")]
        row = struct.Struct("<" + "".join({"float": "f", "int": "i", "uint": "I", "uchar": "B"}[k] for k in kinds))
        values = [dict(zip(names, row.unpack_from(body, i * row.size))) for i in range(count)]
        return [(v["x"], v["y"], v["z"]) for v in values if v["sheet"] == sheet]

    def test_groups(self):
        places = ("[0, 0, 0.2]", "[0.5, 0, 0.2]", "[0.05, 0, 0.2]", "[1.2, 0, 0.2]")
        self.write(places)
        self.assertEqual(self.groups(), ["[0, 2]", "[1]", "[3]"])
        self.write(places, "margin: 45 cm\n")
        self.assertEqual(self.groups(), ["[0, 1, 2]", "[3]"])
        self.write(places, "margin: 1 m\n")
        self.assertIn("all sheets can meet", self.sweep("--print")[1])
        self.assertEqual(len(self.table("plan.csv")), 1)
        self.write(("[0, 0, 0.2]", "[0, 0, 1.2]"), "set: {gravity: [0, 0, -9.8]}\n")
        self.assertEqual(self.groups(), ["[0, 1]"])  # the upper one may fall
        self.write(("[0, 0, 0.2]", "[0, 0, 1.2]"))
        self.assertEqual(self.groups(), ["[0]", "[1]"])

    def test_rows_are_the_scene_in_parts(self):
        pins = ("pins:\n  - {points: [[-0.03, 0, 0.2]]}\n  - {sheet: 1, points: [[0.47, 0, 0.2]]}\n"
                "probes:\n  - {sheet: s1, kind: uv, at: [0.5, 0.5]}\n")
        plan = "set: {gravity: [0, 0, -9.8], output.formats: [usd]}\n"
        self.write(("[0, 0, 0.2]", "[0.5, 0, 0.2]"), plan, extra=pins)
        self.sweep()
        self.singe("run", self.path("many.yaml"), "-o", self.path("whole"), "--no-preview", "--set",
                   "gravity=[0, 0, -9.8]")
        for row in (1, 2):
            part, whole = self.vertices(f"p/rows/000{row}", 6, 0), self.vertices("whole", 6, row - 1)
            self.assertEqual(len(part), len(whole))
            # parts take substeps of their own: the same motion, not the same bytes
            self.assertLess(max(abs(a - b) for p, q in zip(part, whole) for a, b in zip(p, q)), 1e-4)
        self.assertFalse(os.path.exists(self.path("p", "rows", "0001", "probes.csv")))
        self.assertTrue(os.path.exists(self.path("p", "rows", "0002", "probes.csv")))
        pair, = self.table("apart.csv")
        gaps = []
        for frame in range(1, 7):
            left, right = (self.vertices(f"p/rows/000{row}", frame, 0) for row in (1, 2))
            gaps.append(min(v[0] for v in right) - max(v[0] for v in left))
        self.assertLess(float(pair["sheets_gap_m"]), min(gaps))  # what is between frames counts as well
        self.assertGreater(float(pair["sheets_gap_m"]), min(gaps) - 0.05)
        with open(self.path("p", "many.usda")) as file:
            text = file.read()
        self.assertEqual(re.findall(r"@\./(.*?)@", text), ["rows/0001/many.usda", "rows/0002/many.usda"])
        self.assertEqual(text.count('over "camera"'), 1)

    def test_sheets_that_met_are_reported(self):
        """One flies at the other, or past it."""
        for velocity, expect in (("[-2, 0, 0]", 1), ("[0, -2, 0]", 0)):
            self.write(("[0, 0, 0.2]", "[0.5, 0, 0.2]"), "set: {frames: 8}\n", velocity)
            _, err = self.sweep(expect=expect)
            self.assertEqual("rows 1 and 2 do not stay apart: boxes of their sheets meet in frame" in err, bool(expect))
            self.assertEqual(float(self.table("apart.csv")[0]["sheets_gap_m"]) == 0, bool(expect))

    def test_gas_that_met_a_sheet_is_reported(self):
        plan = "margin: 0\nset: {gas.enabled: yes, frames: 16, pace: 8, gravity: [0, 0, -9.8]}\n"
        for x, expect in ((0.565, 1), (0.9, 0)):
            pins = "pins:\n"
            for s, a, z in ((0, 0.5, 0.2), (1, x, 0.26)):
                pins += f"  - {{sheet: {s}, radius: 2 cm, points: [[{a - 0.03}, 0, {z}], [{a + 0.03}, 0, {z}]]}}\n"
            self.write(("[0.5, 0, 0.2]", f"[{x}, 0, 0.26]"), plan, extra=pins)
            _, err = self.sweep(expect=expect)
            self.assertEqual("hot gas of one meets the other's sheets" in err, bool(expect))

    def test_bad(self):
        for plan, expected in (
            ("parameters: {pace: [1]}\n", "plan.yaml:3:20: error: method sheets has no 'parameters'"),
            ("margin: -1 cm\n", "plan.yaml:3:9: error: margin: expected a length, 0 or more, got"),
            ("margin: far\n", "plan.yaml:3:9: error: margin: expected a length, 0 or more, got"),
        ):
            self.write(("[0, 0, 0.2]",), plan)
            self.assertIn(expected, self.sweep(expect=2)[1])
        self.write(("[0, 0, 0.2]",))
        with open(self.path("plan.yaml"), "w") as file:
            file.write("scene: many.yaml\nmargin: 1\nparameters: {pace: [1]}\n")
        self.assertIn("'margin' belongs to method sheets", self.sweep(expect=2)[1])
        for only, expected in (("[1]", "there is no sheet 1; the scene has 1, numbered from 0"),
                               ("[0, 0]", "sheet 0 is given twice"),
                               ("[]", "only_sheets must be a list of whole numbers, at least one")):
            err = self.singe("check", self.path("many.yaml"), "--set", f"only_sheets={only}", expect=2)[1]
            self.assertIn(f"--set only_sheets={only}", err)
            self.assertIn(expected, err)


if __name__ == "__main__":
    unittest.main()
