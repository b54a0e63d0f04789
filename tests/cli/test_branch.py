"""Runs that continue from a frame of an earlier run."""

import json
import os
import re
import shutil
from pathlib import Path

from support import ROOT, SANITIZED, Case

FRAMES = 6
# what may change, and which of it a frame later shows
CHANGES = {
    "wind": ["wind.velocity=[2, 0, 1]"],
    "gravity": ["gravity=[0, 1, -9.81]"],
    "pace": ["pace=8"],
    "ambient temperature": ["ambient_temperature=350 K"],
    "a source": ["sources.0.temperature=900 K"],
    "a source's place": ["sources.0.position=[-3 cm, 1 cm, 5 cm]"],
    "no sources": ["sources=[]"],
    "another source": ["sources=[{kind: spot, position: [3 cm, 0, 5 cm], temperature: 1500 K, conductance: 300, "
                       "radius: 2 cm, falloff: 1 cm}]"],
    "a map": ["sources=[{kind: arrival, texture: map.png, to: 0.2 s}]"],
    "a collider": ["colliders=[{kind: sphere, radius: 2 cm, position: [0, 0, 0]}]"],
    "a pin": ["pins=[{points: [[3 cm, 3 cm, 5 cm]], radius: 5 mm}]"],
    "a material": ["sheets.0.material.ignition_temperature=450 K"],
}


class Branch(Case):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(frames=FRAMES, cells=8)
        shutil.copy(os.path.join(ROOT, "examples", "page-hot", "rate.png"), self.path("map.png"))

    def whole(self, *args):
        self.run_scene("whole", "--quiet", *args)

    def branch(self, out, frame, *sets, of="whole", args=(), **options):
        given = [part for one in sets for part in ("--set", one)]
        return self.run_scene(out, "--from", f"{self.path(of)}:{frame}", *given, *args, **options)

    def same(self, out, whole="whole"):
        self.assertEqual(self.plys(whole), self.plys(out))
        self.assertEqual(self.numbers(whole), self.numbers(out))
        for name in os.listdir(self.path(whole, "gas")):
            with open(self.path(whole, "gas", name), "rb") as one, open(self.path(out, "gas", name), "rb") as other:
                self.assertEqual(one.read(), other.read(), name)
        self.assertEqual(self.record(out)["totals"], self.record(whole)["totals"])
        self.no_temporaries(out)

    def test_unchanged(self):
        """With and without a checkpoint, on one thread and on two, the frames are those of the whole run, also where a
        material has keys."""
        keys = "sheets.0.material.drag=[{time: 0, value: 1}, {time: 0.1, value: 1}, {time: 0.2, value: 9}]"
        self.whole("--set", "checkpoints.every=3", "--set", keys)
        self.assertEqual(sorted(os.listdir(self.path("whole", "checkpoints"))), ["tiny.0003.singe", "tiny.0006.singe"])
        for frame, threads in ((5, "2"),) if SANITIZED else ((1, "1"), (3, "2"), (5, "1")):
            with self.subTest(frame=frame):
                _, err = self.branch(f"b{frame}", frame, keys, args=("--threads", threads))
                if frame < 5:  # the run's own last checkpoints depend on its speed
                    self.assertNotIn("again", err)
                self.same(f"b{frame}")
        record = self.record("b5")
        self.assertEqual((record["from"]["folder"], record["from"]["frame"]),
                         (os.path.realpath(self.path("whole")), 5))
        self.assertTrue(os.path.samefile(self.path("whole", "ply", "tiny.0002.ply"),
                                         self.path("b5", "ply", "tiny.0002.ply")))

    def test_killed(self):
        """A branch that was killed continues from its own checkpoint, and stays a branch."""
        self.whole()
        out = self.path("k")
        run = self.start("run", self.scene, "-o", out, "--from", f"{self.path('whole')}:3", "--no-preview",
                         "--set", "wind.velocity=[2, 0, 1]", "--set", "frames=200")
        while not os.path.exists(os.path.join(out, "ply", "tiny.0005.ply")) and run.poll() is None:
            pass
        run.kill()
        run.wait()
        run.stderr.close()
        wind = ("--set", "wind.velocity=[2, 0, 1]", "--set", "frames=10")
        self.run_scene("k", "--resume", *wind)
        self.branch("b", 3, "wind.velocity=[2, 0, 1]", "frames=10", args=("--threads", "1"))
        self.same("k", "b")
        self.assertEqual(self.record("k")["from"]["frame"], 3)

    def test_each_change(self):
        """Each setting that may change takes effect from the next frame on."""
        self.whole("--set", "checkpoints.every=2")
        whole = self.plys("whole")
        frames = sorted(whole)
        for what, sets in list(CHANGES.items())[::4 if SANITIZED else 1]:
            with self.subTest(what):
                self.branch("b", 2, *sets, args=("--force",))
                made = self.plys("b")
                self.assertEqual([whole[frame] for frame in frames[:2]], [made[frame] for frame in frames[:2]])
                self.assertNotEqual(whole[frames[-1]], made[frames[-1]])

    def test_there_and_back(self):
        """What is changed at a frame and changed back at the same frame leaves no trace."""
        self.whole("--set", "checkpoints.every=2")
        there = [one for what, sets in CHANGES.items() if "source" not in what and "pin" not in what for one in sets]
        self.branch("there", 2, *there, "sources=[]", args=("--threads", "2"))
        self.branch("back", 2, of="there", args=("--threads", "1"))
        self.same("back")

    def test_outputs_and_pictures(self):
        self.whole("--set", "name=tiny", "--set", "checkpoints.every=4")
        self.branch("b", 4, "name=other", "output.formats=[ply, vtp]", "gas.detail=2")
        self.assertEqual(list(self.plys("whole").values()), list(self.plys("b").values()))
        self.assertEqual(len(os.listdir(self.path("b", "vtp"))), FRAMES)
        self.assertEqual(len(os.listdir(self.path("b", "gas_detail"))), FRAMES)
        if not SANITIZED:
            self.run_scene("drawn", "--set", "preview.size=[32, 32]", preview=True)
            self.branch("p", 4, "preview.size=[32, 32]", preview=True)
            for name in os.listdir(self.path("drawn", "frames")):
                with open(self.path("drawn", "frames", name), "rb") as a, open(self.path("p", "frames", name), "rb") as b:
                    self.assertEqual(a.read(), b.read(), name)

    def test_a_root_names_only_what_is_there(self):
        """Earlier frames are written in the branch's formats before its root names them."""
        usd = "output.formats=[ply, usd]"
        self.whole("--set", "checkpoints.every=3")
        os.truncate(self.path("whole", "ply", "tiny.0002.ply"), 200)
        _, err = self.branch("b", 3, usd, expect=1)
        self.assertIn("tiny.0002.ply", err)
        self.assertEqual(os.listdir(self.path("b", "usd")), ["tiny.0001.usdc"])
        self.assertFalse(os.path.exists(self.path("b", "tiny.usda")))
        shutil.copy(self.path("whole", "ply", "tiny.0001.ply"), self.path("b", "ply", "tiny.0002.ply"))
        self.run_scene("b", "--resume", "--set", usd)
        named = set(re.findall(r"@\./usd/(.*?)@", Path(self.path("b", "tiny.usda")).read_text()))
        self.assertEqual(sorted(named), sorted(os.listdir(self.path("b", "usd"))))

    def test_keyed_pace(self):
        """A pace by keys: constant it is that number, at 0 the fire stands still, and it survives a branch."""
        self.whole("--set", "pace=4")
        self.run_scene("const", "--set", "pace=[{time: 0, value: 4}, {time: 1 s, value: 4}]")
        self.same("const")
        keys = "pace=[{time: 0, value: 4}, {time: 0.1 s, value: 4}, {time: 0.11 s, value: 0}]"
        self.run_scene("still", "--set", keys, "--set", "checkpoints.every=3")
        mass = [float(row["mass"]) for row in self.stats("still")]
        self.assertEqual(self.stats("still")[2]["mass"], self.stats("whole")[2]["mass"])
        self.assertLess(mass[3], mass[1])
        self.assertLess(abs(mass[5] - mass[3]), 1e-6 * mass[0])  # frame 4 is at 0.125 s
        self.assertLess(float(self.stats("whole")[5]["mass"]), mass[5])
        for frame in (5,) if SANITIZED else (3, 5):
            self.branch("b", frame, keys, of="still", args=("--force",))
            self.same("b", "still")
        self.branch("on", 4, "pace=4", of="still")  # the fire goes on
        self.assertLess(float(self.stats("on")[5]["mass"]), mass[5])
        self.assertEqual(self.record("still")["scene"]["pace"][2]["value"], 0)
        for wrong, part in (("[{time: 1, value: 2}, {time: 1, value: 3}]", "increase"), ("[{time: 0, value: -1}]", "value"),
                            ("fast", "number")):
            with self.subTest(wrong):
                self.assertIn(part, self.run_scene("no", "--set", f"pace={wrong}", expect=2)[1])

    def test_burn_by(self):
        """The given share has burnt by the frame, whether the fire must hurry or wait; then the scene's pace applies."""
        self.whole("--frames", "40")
        own = float(self.stats("whole")[29]["burnt_fraction"])
        for goal in (0.3 * own,) if SANITIZED else (0.3 * own, 2 * own):
            by = f"burn_by={{fraction: {goal}, frame: 30}}"
            self.run_scene("by", "--force", "--frames", "40", "--set", by, "--set", "checkpoints.every=10")
            rows = self.stats("by")
            self.assertLess(abs(float(rows[29]["burnt_fraction"]) / goal - 1), 0.02)
            self.assertEqual(rows[35]["pace"], self.stats("whole")[0]["pace"])
            self.branch("b", 15, by, of="by", args=("--force", "--frames", "40"))
            self.same("b", "by")
        self.branch("free", 15, of="by", args=("--frames", "40"))  # without it the pace is the scene's
        self.assertEqual(self.stats("free")[20]["pace"], self.stats("whole")[0]["pace"])
        for wrong, part in (("burn_by={fraction: 2, frame: 9}", "fraction"), ("burn_by={fraction: 50 %}", "frame"),
                            ("burn_by={fraction: 50 %, frame: 1}", "frame")):
            with self.subTest(wrong):
                self.assertIn(part, self.run_scene("no", "--set", wrong, expect=2)[1])
        keys = ("--set", "pace=[{time: 0, value: 1}, {time: 1, value: 2}]", "--set", "burn_by={fraction: 50 %, frame: 9}")
        self.assertIn("'pace' must be one number", self.run_scene("no", *keys, expect=2)[1])

    def test_a_run_is_its_scene(self):
        """The folder of a run stands for the scene that it has burnt, wherever the command runs."""
        self.whole("--set", "pace=5", "--set", "checkpoints.every=4")
        self.scene = self.path("whole")
        self.branch("b", 4, cwd="/")
        self.same("b")
        self.assertEqual(self.record("b")["scene"], self.record("whole")["scene"])
        self.assertEqual(self.record("b")["scene_folder"], self.record("whole")["scene_folder"])
        self.run_scene("c", "--set", "frames=2")
        self.assertEqual(list(self.plys("c").values()), list(self.plys("b").values())[:2])

    def test_branch_of_a_branch(self):
        """A branch can be branched before and after its first frame, also without its ancestors."""
        self.whole()
        self.branch("one", 5, "pace=8")
        os.rename(self.path("whole"), self.path("away"))
        self.branch("two", 6, "pace=8", of="one")
        self.assertEqual(self.plys("one"), self.plys("two"))
        self.assertEqual(self.record("two")["from"]["from"]["frame"], 5)
        self.branch("old", 3, of="one")
        self.assertEqual(self.plys("away"), self.plys("old"))

    def test_refusals(self):
        """What cannot change is named with its place in the scene, and nothing is written."""
        self.whole()
        text = Path(self.scene).read_text()
        Path(self.scene).write_text(text.replace("steps: 2", "steps: 3") + "contact: {friction: 0.9}\n")
        _, err = self.branch("b", 4, "sheets.0.grid.cells=[9, 8]", "sheets.0.material.thickness=2 mm", "seed=4",
                             expect=2)
        for part in ("tiny.yaml:3:8: error: steps cannot change in a branch: it was 2",
                     "contact.friction cannot change", "--set sheets.0.grid.cells=[9, 8]: error: ",
                     "sheets.0.material.thickness cannot change", "seed cannot change"):
            self.assertIn(part, err)
        self.assertFalse(os.path.exists(self.path("b")))
        Path(self.scene).write_text(text)
        os.symlink("whole", self.path("link"))
        for of, frame, out, part in (("whole", 7, "b", "whole has 1-6"), ("whole", 0, "b", "expected DIR:FRAME"),
                                     ("none", 4, "b", "run.json"), ("link", 4, "whole", "also the folder of this run"),
                                     ("whole", "4x", "b", "expected DIR:FRAME")):
            with self.subTest(of=of, frame=frame):
                _, err = self.branch(out, frame, of=of, expect=2)
                self.assertIn(part, err)
                self.assertFalse(os.path.exists(self.path("b")))
        _, err = self.branch("b", 4, "output.events=true", expect=2)
        self.assertIn("output.events cannot change", err)
        _, err = self.branch("b", 4, "frames=3", expect=2)
        self.assertIn("only 3 frames", err)

    def test_damaged_runs(self):
        """A damaged record, checkpoint, frame or table is an error or is not needed, and is never believed."""
        self.whole("--set", "checkpoints.every=2")

        def damaged(name, change, expect, part):
            if SANITIZED and name == "run.json" and part == "damaged":
                return  # three more of the same
            shutil.rmtree(self.path("d"), ignore_errors=True)
            shutil.copytree(self.path("whole"), self.path("d"))
            for own in "checkpoint.singe", "checkpoint.previous.singe":
                os.remove(self.path("d", own))
            path = self.path("d", name)
            change(path)
            with self.subTest(name=name, part=part):
                _, err = self.branch("b", 5, of="d", args=("--force",), expect=expect)
                self.assertIn(part, err)
                if expect:
                    self.assertFalse(os.path.exists(self.path("b")))
                else:
                    self.same("b")
                    shutil.rmtree(self.path("b"))

        def cut(path):
            os.truncate(path, os.path.getsize(path) // 2)

        def flip(path):
            with open(path, "r+b") as file:
                header = file.read().find(b"end_header\n")
                file.seek(header + 12 if header >= 0 else os.path.getsize(path) // 3)
                byte = file.read(1)
                file.seek(-1, os.SEEK_CUR)
                file.write(bytes([byte[0] ^ 1]))

        def record(**members):
            def change(path):
                whole = json.loads(Path(path).read_text())
                whole.update(members)
                Path(path).write_text(json.dumps(whole))
            return change

        damaged("run.json", cut, 2, "run.json is not the record of a run")
        damaged("run.json", os.remove, 2, "run.json")
        damaged("run.json", record(name="../whole/tiny"), 2, "damaged")
        damaged("run.json", record(name="other"), 2, "no frames")
        damaged("run.json", record(scene={"sheets": 1}), 2, "sheets")
        damaged("run.json", record(scene_folder=3), 2, "damaged")
        damaged("run.json", record(**{"from": {"frame": "x"}}), 2, "damaged")
        damaged("run.json", record(**{"from": {"frame": 7}}), 2, "damaged")
        damaged("checkpoints/tiny.0004.singe", flip, 0, "damaged")
        damaged("checkpoints/tiny.0004.singe", cut, 0, "frames 3 to 5 again")
        damaged("checkpoints/tiny.0004.singe", lambda path: os.truncate(path, 0), 0, "frames 3 to 5 again")
        damaged("checkpoints", shutil.rmtree, 0, "frames 1 to 5 again")
        damaged("ply/tiny.0003.ply", os.remove, 2, "a branch needs all frames up to it")
        damaged("ply/tiny.0005.ply", flip, 2, "differs from that in")
        damaged("stats.csv", cut, 2, "stats.csv lacks frames 1 to 5")

        # a file of the earlier scene is not what it was
        Path(self.path("mesh.obj")).write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
        text = Path(self.scene).read_text()
        self.scene = self.path("of_mesh.yaml")
        Path(self.scene).write_text(text.replace("grid: {size: [6 cm, 6 cm], cells: [8, 8]}", "mesh: mesh.obj"))
        self.run_scene("m", "--set", "frames=3")
        with open(self.path("mesh.obj"), "a") as file:
            file.write("v 2 0 0\nv 2 1 0\nf 2 5 6 3\n")
        _, err = self.branch("b", 2, of="m", expect=2)
        self.assertIn("a mesh or picture that its scene names has changed", err)
        self.scene = self.path("tiny.yaml")

        # a link is not followed
        shutil.rmtree(self.path("d"))
        shutil.copytree(self.path("whole"), self.path("d"))
        os.remove(self.path("d", "ply", "tiny.0002.ply"))
        os.symlink(self.path("tiny.yaml"), self.path("d", "ply", "tiny.0002.ply"))
        _, err = self.branch("b", 5, of="d", expect=1)
        self.assertIn("it is a link", err)

    def test_checkpoints_within_a_budget(self):
        self.whole("--set", "checkpoints={every: 1}")
        size = os.path.getsize(self.path("whole", "checkpoints", "tiny.0004.singe"))
        self.run_scene("few", "--set", f"checkpoints={{every: 1, megabytes: {2.5e-6 * size}}}")
        self.assertEqual(sorted(os.listdir(self.path("few", "checkpoints"))), ["tiny.0004.singe"])
        self.assertEqual(self.plys("whole"), self.plys("few"))
        self.assertEqual(len(Path(self.path("few", "checkpoints", "tiny.0004.singe")).read_bytes()), size)
        self.run_scene("few", "--force")  # a run without them removes those of another
        self.assertFalse(os.path.exists(self.path("few", "checkpoints")))

    def written_is_estimated(self):
        out, _ = self.singe("check", self.scene, "--set", "checkpoints.every=4")
        low, high = map(float, re.search(r"^disk +about (\S+) to (\S+) MB, \S+ MB of them checkpoints$", out,
                                         re.M).groups())
        written = 1e-6 * sum(os.path.getsize(self.path("whole", folder, name)) for folder in ("ply", "gas", "checkpoints")
                             for name in os.listdir(self.path("whole", folder)))
        self.assertTrue(0.98 * low < written < high, (low, written, high))

    def test_info_and_clean(self):
        self.whole("--set", "checkpoints.every=4")
        self.branch("b", 4)
        if not SANITIZED:  # burns a strip of the material
            self.written_is_estimated()
        out, _ = self.singe("info", self.path("b"))
        for part in (f"frame 4 of {os.path.realpath(self.path('whole'))}", "ply           1 to 6: ",
                     "checkpoints   4: ", "complete", "shared with other folders"):
            self.assertIn(part, out)
        note = self.path("b", "ply", "tiny.0099.ply"), self.path("b", "ply", "tiny.0002.ply.txt")
        for path in note:
            Path(path).write_text("mine")
        _, err = self.singe("clean", self.path("b"), "--keep-every", "4")
        self.assertIn("removed 6 files of 6 frames", err)
        self.assertEqual([name[5:9] for name in self.plys("b")], ["0001", "0002", "0004", "0006", "0099"])
        self.assertEqual(len(self.plys("whole")), FRAMES)
        out, _ = self.singe("info", self.path("b"))
        self.assertIn("gas           1, 4, 6: ", out)
        self.assertIn("a branch needs all frames", self.branch("c", 4, of="b", expect=2)[1])

        # a record that lists nothing, and a folder that is a link, lose nothing
        os.rename(self.path("b", "gas"), self.path("away"))
        os.symlink(self.path("away"), self.path("b", "gas"))
        self.singe("clean", self.path("b"), "--keep-every", "100")
        self.assertEqual(len(os.listdir(self.path("away"))), 3)
        for text, code in ("{}", 2), ('{"name": "tiny", "frames": 6, "frames_done": -4}', 2), ("[", 2), ("", 2):
            Path(self.path("whole", "run.json")).write_text(text)
            self.singe("clean", self.path("whole"), "--keep-every", "4", expect=code)
        self.singe("clean", self.path("whole"), expect=2)
        self.assertEqual(len(self.plys("whole")), FRAMES)
