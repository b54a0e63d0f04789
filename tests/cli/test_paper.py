"""singe paper, and the paper's solver in a scene."""

import json
import math
import os
import re
from pathlib import Path

from support import Case
from test_docs import ROOT

TABLE1 = "0.4306 0.4401 0.5527 0.4954 0.5767 0.5038 0.5804 0.5050 0.5810 0.5052".split()


class Paper(Case):
    def check_page(self, folder, items, failed=0, bad_cases=True):
        """The page and its data agree, and all pictures exist."""
        data = json.loads(Path(self.path(folder, "measures.json")).read_text())
        rows = self.table(folder, "measures.csv")
        page = Path(self.path(folder, "index.html")).read_text()
        self.assertEqual(data["failed"], failed)
        self.assertEqual([m["item"] for m in data["measures"]], [r["item"] for r in rows])
        self.assertEqual([m["holds"] for m in data["measures"]], [r["verdict"] == "holds" for r in rows])
        missing = [m for m in data["measures"] if m.get("known_to_miss")]
        self.assertEqual(sum(not m["holds"] for m in data["measures"]), failed + len(missing))
        self.assertEqual(data["missing"], len(missing))
        self.assertEqual(list(dict.fromkeys(r["item"] for r in rows)), [i for i in items if i != "grades"])
        for m in data["measures"] if bad_cases else ():  # every bar has a case that it does not let pass
            low, high = (math.inf * sign if m[key] is None else m[key] for key, sign in (("low", -1), ("high", 1)))
            self.assertIn("bad_what", m, m["measure"])
            self.assertFalse(low <= (math.nan if m["bad"] is None else m["bad"]) <= high, m)
        self.assertEqual(re.findall(r'<h2 id="([^"]*)"', page), items)
        for name in re.findall(r'src="([^"]*)"', page):
            self.assertTrue(os.path.exists(self.path(folder, name)), name)
        self.assertNotIn("<script", page)
        self.assertNotIn("http", page.replace("http://www.w3.org/2000/svg", ""))

    def test_unknown(self):
        _, err = self.singe("paper", "fig12", expect=2)
        self.assertIn("did you mean 'fig1", err)

    def test_scenes_lie_beside_the_page(self):
        self.singe("paper", "fig5", "-o", self.path("page"))
        for name in "fig4c.yaml", "torus.obj", "rate.png":
            self.assertTrue(os.path.getsize(self.path("page", "scenes", name)) > 100)
        for name in os.listdir(self.path("page", "scenes")):
            if name.endswith(".yaml"):
                self.singe("run", self.path("page", "scenes", name), "-o", self.path("run"), "--frames", "1",
                           "--no-preview", "--quiet")

    def test_parts_of_a_figure_differ_only_in_what_they_show(self):
        """fig4a.yaml to fig4d.yaml and the like are one scene each but for these keys; each wears its plain look."""
        shown = {"fig4": "tearing shrink_front shrink_back ablate mass_rate mass_loss char_strength",
                 "fig7a fig7b": "solver", "fig7c fig7d": "solver", "fig10": "thickness weight"}
        folder = os.path.join(ROOT, "lab", "paper", "scenes")
        for figure, keys in shown.items():
            names = figure.split() if " " in figure else [figure + part for part in "abcd"]
            texts = []
            for name in names:
                with open(os.path.join(folder, name + ".yaml")) as file:
                    lines = [line.split("#")[0].strip() for line in file]
                texts.append([line for line in lines if line])
                self.assertEqual("plain: yes" in lines, figure != "fig4", name)
            kept = [[line for line in text if line.split(":")[0] not in keys.split()] for text in texts]
            for name, text, lines in zip(names, texts, kept):
                self.assertEqual(lines, kept[0], name)
                self.assertNotIn(text, [other for other in texts if other is not text], name)

    def test_the_papers_system_is_in_its_scenes(self):
        """No losses, eq 3 as printed, no ceiling, all of eq 6, no compliance, no tears, and its solver."""
        for number in 1, 4, 11:
            with open(os.path.join(ROOT, "lab", "paper", "scenes", f"whole-fig{number}.yaml")) as file:
                lines = [line.split("#")[0].strip() for line in file]
            for line in ("heat_operator: umbrella-live", "convection: 0", "emissivity: 0", "rate_ceiling: 1e6",
                         "ash_exponent: 0", "shrink_front: 1", "shrink_back: 1", "tearing: no", "contact: no",
                         "compliance: {red: 0, green: 0, blue: 0, yellow: 0}",
                         "solver: {method: paper, order: [red, green, blue, yellow], projections: 7, tolerance: 1e-7, "
                         "early_exit: yes}"):
                self.assertIn(line, lines, number)

    def test_table1(self):
        out, _ = self.singe("paper", "table1", "-o", self.path("page"))
        for number in TABLE1:
            self.assertGreaterEqual(out.count(number), 2, "ours beside the paper's")
        self.check_page("page", ["table1"])

    def test_fig8(self):
        out, _ = self.singe("paper", "fig8", "-o", self.path("new", "fig"), timeout=600)
        self.check_page(os.path.join("new", "fig"), ["fig8"])
        for state in "swing", "shrink":
            rows = self.table("new", "fig", f"fig8-{state}.csv")
            sums = [float(row["sum"]) for row in rows]
            self.assertEqual(len(rows), 21)
            self.assertEqual(sums, sorted(sums, reverse=True))
            for row in rows:
                self.assertAlmostEqual(sum(float(row[c]) for c in ("red", "green", "blue", "yellow")) /
                                       float(row["sum"]), 1, 6)
            svg = Path(self.path("new", "fig", f"fig8-{state}.svg")).read_text()
            self.assertTrue(svg.startswith("<svg ") and svg.rstrip().endswith("</svg>"))
            self.assertEqual(svg.count("<path "), 5)

    def test_fig8_folder(self):
        with open(self.path("file"), "w"):
            pass
        _, err = self.singe("paper", "fig8", "-o", self.path("file"), expect=1)
        self.assertIn("file", err)

    def test_all_at_once(self):
        self.singe("paper", "all-at-once", "-o", self.path("page"), timeout=600)
        out = Path(self.path("page", "index.html")).read_text()
        self.assertIn("360 constraints, 249 degrees of freedom", out)

    def test_scene_with_the_method(self):
        small = self.write_scene("small.yaml", frames=3, steps=1, cells=6)
        for setting in "solver=paper", "solver.method=paper":
            with self.subTest(setting=setting):
                _, err = self.singe("run", small, "-o", self.path("out"), "--no-preview", "--set", setting)
                self.assertIn("solver: up to 7 projections", err)
                self.assertIn('"method": "paper"', Path(self.path("out", "run.json")).read_text())
        _, err = self.singe("check", small, "--set", "solver=papers", expect=2)
        self.assertIn("did you mean 'paper'?", err)
