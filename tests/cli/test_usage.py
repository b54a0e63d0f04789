"""Usage, check, and what is refused before anything is written."""

import os
import re
import resource
import signal
import struct
import subprocess
import time
import unittest
from pathlib import Path

from support import ROOT, SANITIZED, SINGE, VERSION, Case, at_most


class Usage(Case):
    def test_help_and_version(self):
        self.assertIn("usage: singe COMMAND", self.singe("--help")[0])
        self.assertEqual(self.singe("--version")[0], f"singe {VERSION}\n")
        with open(os.path.join(ROOT, "docs/CHANGELOG.md"), encoding="utf-8") as file:
            self.assertEqual(re.search(r"^## ([0-9.]+)", file.read(), re.M).group(1), VERSION)
        for command, word in ("run", "--resume"), ("check", "--threads"), ("render", "--sheet"), ("paper", "table1"):
            out, _ = self.singe(command, "--help")
            self.assertIn(f"usage: singe {command}", out)
            self.assertIn(word, out)

    def test_help_is_where_it_is_looked_for(self):
        whole, _ = self.singe("--help")
        self.assertEqual(self.singe(), (whole, ""))
        self.assertEqual(self.singe("help"), (whole, ""))
        for command in "run", "check", "sweep", "scene-doc":
            self.assertEqual(self.singe("help", command), self.singe(command, "--help"))
        self.assertIn("did you mean 'run'?", self.singe("help", "rum", expect=2)[1])

    def test_a_folder_stands_for_its_scene(self):
        os.mkdir(self.path("letter"))
        self.write_scene("letter/any.yaml", frames=2, gas="no")
        for folder in "letter", "letter/", "./letter":
            self.assertIn("any.yaml: good", self.singe("check", folder, cwd=self.dir)[0])
        self.write_scene("letter/other.yaml", frames=2, gas="no")
        _, err = self.singe("run", self.path("letter"), "-o", self.path("o"), expect=2)
        self.assertRegex(err, r"letter is a folder of several scenes: name one of (any.yaml, other|other.yaml, any).yaml")
        self.write_scene("letter/letter.yaml", frames=2, gas="no")
        self.singe("run", ".", "-o", self.path("o"), "--no-preview", cwd=self.path("letter"))
        self.assertEqual(os.listdir(self.path("o", "ply"))[0][:6], "letter")
        os.mkdir(self.path("empty"))
        self.assertIn("empty is a folder without a scene", self.singe("check", self.path("empty"), expect=2)[1])

    def test_bad_usage(self):
        for args, hint in (
            (["rum"], "did you mean 'run'?"),
            (["--verison"], "unknown option"),
            (["run"], "needs SCENE"),
            (["run", "--frame", "3", self.scene], "did you mean '--frames'?"),
            (["run", "--bogus", self.scene], "unknown option '--bogus'"),
            (["run", "-x", self.scene], "unknown option '-x'"),
            (["run", self.scene, "--threads"], "--threads needs N"),
            (["run", self.scene, "--threads", "0"], "from 1 to 64"),
            (["run", self.scene, "--threads", "2x"], "got '2x'"),
            (["run", self.scene, "--resume=yes"], "takes no value"),
            (["run", self.scene, "other.yaml"], "unexpected argument"),
            (["check"], "needs SCENE"),
            (["render"], "needs DIR"),
            (["render", "x", "--frames", "5-2"], "expected A-B"),
            (["render", "x", "--sheet", "4"], "such as 4x2"),
            (["render", "x", "--set", "pace=2"], "only preview."),
            (["paper"], "needs WHAT"),
            (["paper", "table3"], "did you mean 'table1'?"),
            (["paper", "fig8", "-o", ""], "expected a folder"),
            (["scene-doc", "x"], "unexpected argument"),
        ):
            with self.subTest(args=args):
                self.assertIn(hint, self.singe(*args, expect=2)[1])

    def test_bad_scenes(self):
        unknown = self.write_scene("unknown.yaml", extra="colour: red\n")
        mesh = self.path("mesh.yaml")
        Path(mesh).write_text("sheets:\n  - mesh: nowhere.obj\n")
        empty = self.path("empty.yaml")
        open(empty, "w").close()
        for path, hint in (
            (self.path("nothing.yaml"), "nothing.yaml"),
            (self.dir, "folder of several scenes"),
            (unknown, "colour"),
            (mesh, "nowhere.obj"),
            (empty, "empty.yaml"),
        ):
            for command in "run", "check":
                with self.subTest(command=command, path=path):
                    self.assertIn(hint, self.singe(command, path, expect=2, cwd=self.dir)[1])
        self.assertFalse(os.path.exists(self.path("out")), "a refused scene must leave no folder")

    def test_bad_set(self):
        for text, hint in (
            ("frames=many", "frames"),
            ("frames", "="),
            ("sheets.0.material.grammage=-1", "grammage"),
            ("nosuch=1", "nosuch"),
            ("frames=0", "frames"),
        ):
            with self.subTest(set=text):
                _, err = self.singe("run", self.scene, "--set", text, expect=2, cwd=self.dir)
                self.assertIn(hint, err)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_name_names_files(self):
        bad = self.write_scene("bad.yaml", extra='name: "../up"\n')
        self.singe("run", bad, expect=2, cwd=self.dir)
        self.singe("check", bad, expect=2, cwd=self.dir)

    def test_one_rule_for_names(self):
        """A name that the scene gives, and one taken from its file."""
        for name in ("a:b",) if SANITIZED else ("a:b", "100%", "n" * 101, ".dot"):
            with self.subTest(name):
                given = self.write_scene("given.yaml", extra=f'name: "{name}"\n')
                self.assertIn("at most 100 characters", self.singe("check", given, expect=2)[1])
                taken = self.write_scene(name + ".yaml")
                self.assertIn("give the scene a name", self.singe("check", taken, expect=2)[1])
        self.singe("check", taken, "--set", "name=" + "n" * 100)

    def test_unprintable_arguments(self):
        """Names of files and words of the command line reach the terminal escaped and cut."""
        bad = "a\x1b[31m\u009b\u202e\u2028\nb"
        long = "é" * 3000
        self.write_scene(bad + ".yaml", extra="fps: 0\n")
        mesh = f'sheets: [{{mesh: "{bad}.obj"}}]\n'.replace("\x1b", "\\x1b").replace("\n", "\\n", 1)
        Path(self.path("mesh.yaml")).write_text(mesh)
        Path(self.path(bad + ".obj")).write_text("v SECRET 0 0\n")
        for args in (
            ["check", bad + ".yaml"], ["check", bad], ["check", "mesh.yaml"], ["run", bad], ["render", bad],
            ["verify", bad], ["measure", bad], ["run", self.scene, "--set", bad], ["run", self.scene, "--" + bad],
            ["run", self.scene, bad], ["run", self.scene, "--threads", bad], ["bench", bad], ["paper", bad], [bad],
            ["validate", "--only", bad], ["run", "--set", f"{bad}=1", self.scene],
            ["bench", "front", "--material", bad], ["render", ".", "--frames", bad], [long], ["run", "--" + long],
            ["bench", long], ["run", self.scene, "--threads", long], ["paper", long], ["bench", "swing", "--time", bad],
        ):
            with self.subTest(args):
                done = subprocess.run([SINGE, *args], capture_output=True, text=True, cwd=self.dir, timeout=60)
                self.assertIn(done.returncode, (1, 2))
                for character in "\x1b\u009b\u202e\u2028":
                    self.assertNotIn(character, done.stdout + done.stderr)
                self.assertNotIn("SECRET", done.stderr)
                self.assertNotIn("é" * 300, done.stderr)

    def test_check(self):
        out, _ = self.singe("check", self.scene)
        for word in ("particles     313", "springs       1440", "red         576", "green       264", "blue        312",
                     "yellow      288", "families", "memory", "thickening", "time"):
            self.assertIn(word, out)
        self.assertEqual(sorted(os.listdir(self.dir)), ["tiny.yaml"], "check writes no files")

    def test_memory_is_said_first(self):
        """The memory of a scene is known in advance; one that needs more than the machine has is refused at once."""
        limited = at_most(resource.RLIMIT_AS, 1 << 32)
        cells = "sheets.0.grid.cells="
        for command in ["check"], ["run", "-o", self.path("large")]:
            begun = time.monotonic()
            out, err = self.singe(*command, self.scene, "--set", cells + "[10000, 10000]", expect=2)
            self.assertLess(time.monotonic() - begun, 10)
            self.assertRegex(err, r"tiny.yaml:6:5: error: the scene needs about 6\d\d\.\d GB of memory, but only")
        self.assertFalse(os.path.exists(self.path("large")))
        Path(self.path("two.obj")).write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
        mesh = self.write_scene("mesh.yaml").replace("mesh.yaml", "with_mesh.yaml")
        Path(mesh).write_text("sheets: [{mesh: two.obj}]\n")
        out, _ = self.singe("check", mesh)
        self.assertRegex(out, r"^needs +about \d\.\d\d GB of memory for 0 cells and those of 1 mesh file\n"
                              r"needs +about \d\.\d\d GB of memory for 1 cells\n")
        with open(self.path("heights.png"), "wb") as file:  # of which only the head is there
            file.write(b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sIIBBBBBI", 13, b"IHDR", 16000, 16000, 8, 0, 0, 0, 0, 0))
        heights = self.write_scene("heights.yaml", extra="colliders:\n  - {kind: heightfield, picture: heights.png, "
                                   "size: [1, 1], heights: [-30 cm, -20 cm]}\n")
        out, err = self.singe("check", heights, expect=2)  # too much, or else not a whole picture
        self.assertGreater(float(re.search(r"needs +about ([0-9.]+) GB", out).group(1)), 10)
        self.assertIn("heights.yaml", err)
        if not SANITIZED:
            for command in ["check"], ["run", "-o", self.path("large"), "--no-preview"]:
                _, err = self.singe(*command, heights, expect=2, preexec_fn=limited)
                self.assertRegex(err, r"heights.yaml:\d+:\d+: error: .* but only 4.3 GB are available: give its heightfield")
            for command in ["check"], ["run", "-o", self.path("large")]:
                _, err = self.singe(*command, self.scene, "--set", cells + "[900, 900]", expect=2, preexec_fn=limited)
                self.assertIn("but only 4.3 GB are available", err)

    @unittest.skipIf(SANITIZED, "measures pictures")
    def test_check_of_large_pictures(self):
        """A picture that would take hours is timed with fewer samples."""
        begun = time.monotonic()
        out, _ = self.singe("check", self.scene, "--set", "preview={size: [1024, 1024], samples: 4096}")
        self.assertLess(time.monotonic() - begun, 60)
        self.assertGreater(int(re.search(r"a picture (\d+) ms", out).group(1)), 20000)

    def test_check_can_be_interrupted(self):
        check = self.start("check", self.scene, "--set", "sheets.0.grid.cells=[450, 450]")
        self.assertIn("building", check.stderr.readline())
        time.sleep(0.3)
        check.send_signal(signal.SIGINT)
        self.assertEqual(check.wait(timeout=5), -signal.SIGINT)
        check.stderr.close()

    @unittest.skipIf(SANITIZED, "a sanitizer's memory is another")
    def test_memory_is_as_it_was_said(self):
        for more in "contact=no", "contact=yes":
            out, _ = self.singe("check", self.scene, "--set", "sheets.0.grid.cells=[80, 80]", "--set", more)
            said = 1e3 * float(re.search(r"^needs +about ([0-9.]+) GB", out).group(1)) - 40 - 40 * 64 * 48e-6
            held = float(re.search(r"^memory +([0-9.]+) MB$", out, re.MULTILINE).group(1))
            self.assertGreater(said, held)
            self.assertLess(said, 1.7 * held)

    def test_check_says_good_last(self):
        out, _ = self.singe("check", self.scene)
        self.assertEqual(out.splitlines()[-1], self.scene + ": good")
        # a scene that is well formed and fails in its first step
        out, err = self.singe("check", self.scene, "--set", "sheets.0.velocity=[1e6, 0, 0]", "--set", "air_density=0",
                             expect=1)
        self.assertNotIn("good", out)
        self.assertIn("error", err)
        help = " ".join(self.singe("check", "--help")[0].split())
        self.assertIn("1 a step failed", help)

    def test_standard_output_that_is_full(self):
        self.singe("run", self.scene, "-o", self.path("o"), "--no-preview", "--quiet")
        for args in (["--help"], ["--version"], ["run", "--help"], ["check", self.scene], ["scene-doc"],
                     ["run", self.scene, "-o", self.path("p"), "--no-preview"],
                     ["render", self.path("o"), "--sheet", "2x1"]):
            with self.subTest(args), open("/dev/full", "w") as full:
                done = subprocess.run([SINGE, *args], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("error: cannot write to standard output: No space left on device", done.stderr)
        self.singe("run", self.scene, "-o", self.path("o"), "--no-preview", "--quiet") # which prints nothing

    def test_check_set(self):
        out, _ = self.singe("check", self.scene, "--set", "sheets.0.grid.cells=[4, 4]", "--frames=3")
        self.assertIn("particles     41", out)
        self.assertIn("frames        3 ", out)

    def test_scene_doc(self):
        out, _ = self.singe("scene-doc")
        self.assertIn("grammage", out)

    def test_program_is_there(self):
        self.assertTrue(os.access(SINGE, os.X_OK))
