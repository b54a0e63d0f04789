"""The JSON Schema of scenes, and the scenes that `singe new` writes."""

import glob
import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path

from support import ROOT, Case

SHEETS = "sheets:\n  - grid: {size: [6 cm, 6 cm], cells: [12, 12]}\n"
SPOT = "sources:\n  - {kind: spot, position: [0, 0, 0], radius: 1 cm, temperature: 900 C, end: 1 s}\n"
BROKEN = (
    "frames: 10\n",  # no sheets
    "sheets: {}\n",
    SHEETS + "frame: 10\n",
    SHEETS + "frames: 0\n",
    SHEETS + "frames: ten\n",
    SHEETS + "fps: 24 s\n",
    SHEETS + "pace: -1\n",
    SHEETS + "gravity: [0, 0]\n",
    SHEETS + "tearing: maybe\n",
    SHEETS + "solver: strands\n",
    SHEETS + "output: {formats: [obj]}\n",
    SHEETS + "wind: {velocity: [1 cm, 0, 0]}\n",
    SHEETS + "preview: {size: [640]}\n",
    SHEETS + "    material: newspaper\n",
    SHEETS + "    material: {grammage: 80 mm}\n",
    SHEETS + "    material: {mass_rate: {from: 1, to: 2}}\n",
    SHEETS + "    color: [1, 1, 1]\n",
    SHEETS + SPOT.replace("kind: spot", "kind: spit"),
    SHEETS + SPOT.replace("kind: spot, ", ""),
    SHEETS + SPOT.replace("position: [0, 0, 0], ", ""),
    SHEETS + SPOT.replace("radius", "texture"),
    SHEETS + "colliders:\n  - {kind: sphere, radius: 1 cm, height: 2 cm}\n",
    SHEETS + "pins:\n  - {points: [1, 2, 3], radius: 1 cm}\n",
)
CHECKER = os.environ.get("CHECK_JSONSCHEMA") or shutil.which("check-jsonschema")


class Schema(Case):
    def setUp(self):
        super().setUp()
        self.schema = self.path("schema.json")
        Path(self.schema).write_text(self.singe("scene-schema")[0], encoding="utf-8")

    def write_broken(self):
        names = []
        for number, text in enumerate(BROKEN):
            names.append(self.path(f"broken{number}.yaml"))
            Path(names[-1]).write_text(text)
        return names

    def refused(self, files):
        """The names of those files that the schema refuses."""
        done = subprocess.run([CHECKER, "-o", "json", "--schemafile", self.schema, *files], capture_output=True, text=True)
        report = json.loads(done.stdout)
        self.assertFalse(report.get("parse_errors"), report)
        return {error["filename"] for error in report.get("errors", [])}

    def test_the_schema_is_json_and_knows_the_keys(self):
        schema = json.loads(Path(self.schema).read_text(encoding="utf-8"))
        self.assertEqual(schema["required"], ["sheets"])
        with open(os.path.join(ROOT, "docs", "scene.md"), encoding="utf-8") as file:
            scene = file.read().split("\n## Scene\n")[1].split("\n## ")[0]
        keys = [line.split("`")[1] for line in scene.splitlines() if line.startswith("| `")]
        self.assertEqual(list(schema["properties"]), list(dict.fromkeys(keys)))

    def test_check_refuses_the_broken_scenes(self):
        self.assertGreaterEqual(len(BROKEN), 20)
        for name in self.write_broken():
            self.singe("check", name, expect=2)

    @unittest.skipUnless(CHECKER, "check-jsonschema is not installed")
    def test_the_schema_takes_every_example_and_refuses_every_broken_scene(self):
        examples = [name for name in glob.glob(os.path.join(ROOT, "examples", "*", "*.yaml"))
                    if not name.endswith("sweep.yaml")]
        self.assertGreaterEqual(len(examples), 13)
        self.assertEqual(self.refused([*examples, self.scene]), set())
        broken = self.write_broken()
        self.assertEqual(sorted(self.refused(broken)), sorted(broken))

    @unittest.skipUnless(CHECKER, "check-jsonschema is not installed")
    def test_the_schema_takes_every_unit_as_the_reader_does(self):
        for key, good, bad in (
            ("pace", ("4", "'4'", ".5"), ("4 s", "x")),
            ("fps", ("24", "24 fps", "24Hz", "1e1 1/s"), ("24 mm", "-24")),
        ):
            for values, expected in ((good, 0), (bad, 1)):
                files = []
                for number, value in enumerate(values):
                    files.append(self.path(f"{key}{expected}{number}.yaml"))
                    Path(files[-1]).write_text(SHEETS + f"{key}: {value}\n")
                self.assertEqual(len(self.refused(files)), expected * len(files), (key, values))


class New(Case):
    def test_the_scenes_that_new_writes_are_good(self):
        for name in "letter", "cloth", "mesh":
            out, err = self.singe("new", name, "-o", self.path("made"))
            scene = self.path("made", name + ".yaml")
            self.assertTrue(out.endswith(scene + "\n"))
            self.assertIn("next: singe check", err)
            out, err = self.singe("check", scene, "--set", "preview.size=[32, 32]")
            self.assertIn(name + ".yaml: good", out)
            self.assertNotIn("warning", err)

    def test_a_sweep_that_new_writes_burns_the_letter_that_is_there(self):
        self.singe("new", "letter", cwd=self.dir)
        with open(self.path("letter.yaml"), "a") as file:
            file.write("# mine\n")
        self.assertEqual(self.singe("new", "sweep", cwd=self.dir)[0], "sweep.yaml\n")
        self.assertTrue(Path(self.path("letter.yaml")).read_text().endswith("# mine\n"))
        printed = self.singe("sweep", "sweep.yaml", "--print", cwd=self.dir)[0]
        self.assertEqual(len(printed.strip().splitlines()), 6)

    def test_new_replaces_nothing_unless_it_is_told_to(self):
        Path(self.path("letter.yaml")).write_text("mine\n")
        self.assertIn("already exists", self.singe("new", "letter", "-o", self.dir, expect=2)[1])
        self.assertEqual(Path(self.path("letter.yaml")).read_text(), "mine\n")
        self.singe("new", "letter", "-o", self.dir, "--force")
        self.assertIn("did you mean 'letter'?", self.singe("new", "leter", expect=2)[1])
        self.assertIn("cannot make the folder", self.singe("new", "cloth", "-o", self.path("letter.yaml"), expect=1)[1])

    def test_materials_are_listed_and_printed_as_they_are(self):
        out, _ = self.singe("materials")
        folder = os.path.join(ROOT, "src", "materials")
        names = sorted(name[:-5] for name in os.listdir(folder) if name.endswith(".yaml"))
        self.assertEqual([line.split()[0] for line in out.splitlines()], names)
        for name in names:
            with open(os.path.join(folder, name + ".yaml"), encoding="utf-8") as file:
                self.assertEqual(self.singe("materials", name)[0], file.read())
        self.assertIn("did you mean 'cotton'?", self.singe("materials", "coton", expect=2)[1])
