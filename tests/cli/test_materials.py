"""Materials on the command line: check, runs that no longer need the material's file, bench front on a file."""

import json
import os
from pathlib import Path

from support import Case

MINE = """\
base: newsprint
grammage: 60 g/m2
measured: {speed: [1 mm/s, 2 mm/s]}
"""


class Materials(Case):
    def write_mine(self, text=MINE):
        os.makedirs(self.path("materials"), exist_ok=True)
        Path(self.path("materials", "mine.yaml")).write_text(text)

    def write_scene_of(self, material, name="tiny.yaml"):
        path = self.write_scene(name)
        text = Path(path).read_text()
        Path(path).write_text(text.replace("sources:", "    material: %s\nsources:" % material))
        return path

    def test_check_tells_the_front(self):
        for material, line in (("newsprint", "newsprint, 45 g/m2: a level front of 11."),
                               ("{grammage: 160 g/m2}", "its own, 160 g/m2: a level front of 3."),
                               ("{base: tissue, name: kerchief}", "kerchief, 20 g/m2: a level front of 2"),
                               ("{heat_share: 0}", "its own, 80 g/m2: a level strip of it goes out\n")):
            with self.subTest(material):
                out, _ = self.singe("check", self.write_scene_of(material))
                self.assertIn("material      " + line, out)
                self.assertEqual("on film" in out, "front" in line)

    def test_check_looks_for_a_front_for_so_long(self):
        """Where heat hardly spreads the front creeps; check gives up after 60,000 steps and iterations."""
        for diffusivity, line in (("1e-6", "a level front of "), ("1e-8", "measuring its burning speed would take too long")):
            with self.subTest(diffusivity):
                material = "{thickening: 10, diffusivity: %s}" % diffusivity
                out, _ = self.singe("check", self.write_scene_of(material))
                self.assertIn("its own, 80 g/m2: " + line, out)

    def test_check_tells_of_long_steps(self):
        scene = self.write_scene_of("{base: tissue, thickening: 1}")
        out, _ = self.singe("check", scene, "--set", "pace=16")
        self.assertIn("slower in steps this long: raise `steps`", out)
        self.assertNotIn("slower", self.singe("check", scene, "--set", "pace=1", "--set", "steps=20")[0])

    def test_set_material(self):
        out, _ = self.singe("check", self.write_scene_of("office-paper"), "--set", "sheets.0.material.base=tissue")
        self.assertIn("tissue, 20 g/m2", out)
        _, err = self.singe("check", self.scene, "--set", "sheets.0.material=tisue", expect=2)
        self.assertIn("did you mean 'tissue'?", err)

    def test_a_run_keeps_its_material(self):
        """A resolved scene no longer needs the material's file; a file that has changed makes it another scene."""
        self.write_mine()
        self.write_scene_of("materials/mine.yaml")
        self.run_scene("o", "--quiet", "--frames", "3")
        self.run_scene("whole", "--quiet")
        material = self.record("o")["scene"]["sheets"][0]["material"]
        self.assertEqual((material["name"], material["grammage"]), ("mine", 0.06))
        self.assertNotIn("base", material)
        self.run_scene("o", "--resume", "--quiet")
        self.assertEqual(self.plys("o"), self.plys("whole"))
        self.write_mine(MINE.replace("60", "61"))
        _, err = self.run_scene("o", "--resume", "--quiet", expect=2)
        self.assertIn("scene", err)
        resolved = self.path("resolved.json")
        Path(resolved).write_text(json.dumps(self.record("whole")["scene"]))
        os.remove(self.path("materials", "mine.yaml"))
        self.singe("run", resolved, "-o", self.path("again"), "--no-preview", "--quiet")
        self.assertEqual(self.plys("again"), self.plys("whole"))

    def test_bench_front_on_ones_own(self):
        self.write_mine()
        both = ["--quick", "--json", "--material", "materials/mine.yaml,tissue"]
        out, _ = self.singe("bench", "front", *both, cwd=self.dir)
        mine, _, _, tissue, _, _ = json.loads(out)["rows"]
        self.assertEqual((mine["material"], mine["g_m2"], mine["finding"]), ("mine", 60, "faster"))
        self.assertEqual((tissue["material"], tissue["finding"]), ("tissue", "as sources say"))
        self.write_mine("base: newsprint\nthikness: 1\n")
        _, err = self.singe("bench", "front", "--material", "materials/mine.yaml", cwd=self.dir, expect=2)
        self.assertIn("mine.yaml:2:1: error: unknown key in a material; did you mean 'thickness'?", err)
        _, err = self.singe("bench", "front", "--material", "newsprint," * 17, expect=2)
        self.assertIn("at most 16 materials", err)
