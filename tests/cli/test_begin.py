"""A run from the start leaves the files in its folder alone until its own first frame is written."""

import hashlib
import os
import pty
import resource
import shutil
import subprocess
import threading
from pathlib import Path

from support import HAS_EXR, SINGE, Case, at_most


class Begin(Case):
    def tree(self, out):
        """Digest of every file, by name; where links point."""
        found = {}
        for folder, names, files in os.walk(self.path(out)):
            for name in names + files:
                path = os.path.join(folder, name)
                if os.path.islink(path):
                    found[path] = os.readlink(path)
                elif os.path.isfile(path):
                    found[path] = hashlib.sha256(Path(path).read_bytes()).hexdigest()
        return found

    def limited(self, *args, kind=resource.RLIMIT_FSIZE, most, expect=1):
        return self.singe(*args, expect=expect, preexec_fn=at_most(kind, most))

    def other_run(self, *more):
        return ["run", self.scene, "-o", self.path("o"), "--set", "sheets.0.grid.cells=[30, 30]", *more]

    def test_a_first_frame_that_fails_leaves_the_earlier_run(self):
        """Whichever of its files cannot be written."""
        args = ["--exr"] if HAS_EXR else []
        self.run_scene("o", *args, preview=True)
        before = self.tree("o")
        self.run_scene("p", "--set", "sheets.0.grid.cells=[30, 30]", "--frames", "1", *args, preview=True)
        sizes = sorted({os.path.getsize(p) for p in self.tree("p") if p.endswith((".ply", ".vdb", ".png", ".exr"))})
        self.assertGreaterEqual(len(sizes), 2)
        for most in [10] + sizes[1:]:
            with self.subTest(most=most):
                _, err = self.limited(*self.other_run(*args), most=most - 1)
                self.assertIn("File too large", err)
                self.assertIn("is unchanged", err)
                self.assertNotIn(".tmp", err, "a name that exists for a moment helps nobody")
                self.assertEqual(self.tree("o"), before)
        self.assertEqual(self.run_scene("o", "--resume", "--frames", "7", *args, preview=True)[1].count("frame 6"), 1)

    def on_a_terminal(self, answer, *args):
        """Runs with a terminal as all three streams. Returns the exit code and what was shown.

        The test holds the terminal open until all is read: what a program wrote last may be lost where it closes.
        """
        shown, end = b"", b"\0 all is read"
        terminal, program = pty.openpty()
        self.addCleanup(os.close, terminal)
        self.addCleanup(os.close, program)
        run = subprocess.Popen([SINGE, *args], stdin=program, stdout=program, stderr=program, start_new_session=True)
        waiter = threading.Thread(target=lambda: (run.wait(), os.write(program, end)))
        waiter.start()
        while end not in shown:
            shown += os.read(terminal, 1000)
            if answer and b"[y/N]" in shown:
                os.write(terminal, answer)
                answer = None
        waiter.join()
        return run.returncode, shown.removesuffix(end).decode(errors="replace")

    def test_a_terminal_is_asked_before_an_earlier_run_goes(self):
        """It is asked only if there is something to lose; a script is never asked."""
        run = ["run", self.scene, "-o", self.path("o"), "--no-preview", "--set", "frames=2"]
        code, shown = self.on_a_terminal(None, *run)
        self.assertEqual((code, "[y/N]" in shown), (0, False), shown)
        before = self.tree("o")
        for answer in b"n\n", b"\n", b"\x04":
            code, shown = self.on_a_terminal(answer, *run)
            self.assertEqual(code, 1, shown)
            self.assertRegex(shown, "o has frames of an earlier run of 'tiny'. Replace them?(.|\n)*nothing was replaced")
            self.assertEqual(self.tree("o"), before)
        for answer, more in ((b"y\n", []), (None, ["--force"]), (None, ["--resume"])):
            code, shown = self.on_a_terminal(answer, *run, *more)
            self.assertEqual((code, "[y/N]" in shown), (0, answer is not None), shown)
            self.assertEqual("removed " in shown, more != ["--resume"], shown)
        self.singe(*run)

    def test_a_full_folder_leaves_the_earlier_run(self):
        self.once("o", lambda out: self.run_scene(out, preview=True), changes=True)
        os.rename(self.path("o", "stats.csv"), self.path("stats.csv"))
        os.mkdir(self.path("o", "stats.csv"))
        before = self.tree("o")
        self.assertIn("stats.csv", self.singe(*self.other_run(), expect=1)[1])
        self.assertEqual(self.tree("o"), before)

    def test_a_refused_scene_leaves_the_earlier_run(self):
        self.once("o", lambda out: self.run_scene(out, preview=True), changes=True)
        before = self.tree("o")
        for bad in "sheets.0.grid.cells=[0, 1]", "sheets.0.material.thickness=inf", "pins=[{vertices: [4000000]}]":
            with self.subTest(bad):
                self.singe(*self.other_run("--set", bad), expect=2)
                self.assertEqual(self.tree("o"), before)

    def test_what_check_calls_good_begins(self):
        """Extreme values, which check once accepted and parts behind the simulation refused during the run."""
        lines_of_all = ["frames: 2", "steps: 2", "preview: {size: [32, 32], samples: 1}", "gas: no",
                        "sheets: [{grid: {size: [0.1, 0.1], cells: [6, 6]}}]"]
        for number, extra in enumerate((
            "gas: {height: 100, cell_size: 1 mm}",
            "colliders: [{kind: sphere, radius: 1e6}]",
            "colliders: [{kind: sphere, radius: 10 km, position: [0, 0, -10 km]}]",
            "colliders: [{kind: capsule, radius: 1 mm, height: 1e6}]",
            "colliders: [{kind: box, half_size: [1, 1, 1e6]}]",
            "colliders: [{kind: box, half_size: [1 cm, 1 cm, 1 cm], position: [0, 0, 1e6]}]",
            "colliders: [{kind: box, half_size: [1, 1, 1], path: [{time: 0}, {time: 1 s, position: [1e6, 0, 0]}]}]",
            "sources: [{kind: ball, radius: 1e6, position: [0, 0, 0]}]",
            "sources: [{kind: ball, radius: 1 cm, path: [{time: 0}, {time: 1e-3 s, position: [0, 1e5, 0]}]}]",
            "preview: {size: [32, 32], samples: 1, camera: {eye: [0, 0, 1e-7], target: [0, 0, 0], up: [0, 1, 0]}}",
            "preview: {size: [32, 32], samples: 1, camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1e-7, 0]}}",
            "preview: {size: [32, 32], samples: 1, light: {direction: [0, 0, 1e-12]}}",
        )):
            with self.subTest(extra):
                scene, key = self.path(f"s{number}.yaml"), extra.split(":")[0]
                lines = [line for line in lines_of_all if not line.startswith(key)] + [extra]
                Path(scene).write_text("\n".join(lines) + "\n")
                code = self.code_of("check", scene)
                if code:
                    _, err = self.singe("check", scene, expect=2)
                    self.assertIn(f"s{number}.yaml:{len(lines)}:", err)
                self.singe("run", scene, "-o", self.path(f"o{number}"), expect=code)

    def test_formats_that_no_sheet_can_have_are_refused_by_check(self):
        """Textures need uv, which a mesh without them does not have."""
        Path(self.path("bare.obj")).write_text("v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\nf 1 2 3 4\n")
        for number, (sheets, code) in enumerate((
            ("[{mesh: bare.obj}]", 2),
            ("[{mesh: bare.obj}, {grid: {size: [0.1, 0.1], cells: [4, 4]}, translate: [0, 0, 0.1]}]", 0),
            (f"[{', '.join('{grid: {size: [1 cm, 1 cm], cells: [1, 1]}, translate: [0, 0, %d cm]}' % k for k in range(65))}]", 2),
        )):
            with self.subTest(sheets[:60]):
                scene = self.path(f"t{number}.yaml")
                with open(scene, "w") as file:
                    file.write(f"frames: 1\nsteps: 1\nsheets: {sheets}\noutput: {{formats: [textures], texture_size: 16}}\n"
                               "preview: {size: [32, 32], samples: 1}\ngas: no\n")
                for command in (["check"], ["run", "-o", self.path(f"t{number}")]):
                    _, err = self.singe(*command, scene, expect=code)
                    if code:
                        self.assertIn(f"t{number}.yaml:4:19: error: the format 'textures'", err)
                        self.assertNotIn(".tmp", err)

    def test_a_gas_too_fine_for_a_file_is_refused_by_check(self):
        for detail, code in (1, 0), (4, 2):
            with self.subTest(detail):
                scene = self.path(f"g{detail}.yaml")
                Path(scene).write_text("frames: 1\nsteps: 1\nsheets: [{grid: {size: [0.4, 0.4], cells: [6, 6]}}]\n"
                                       f"preview: {{size: [32, 32], samples: 1}}\ngas: {{cell_size: 3 mm, detail: {detail}}}\n")
                for command in (["check"], ["run", "--no-preview", "-o", self.path(f"g{detail}")]):
                    _, err = self.singe(*command, scene, expect=code)
                    self.assertEqual("g4.yaml:5:32: error: the gas with detail 4 has" in err, code == 2)
                self.assertEqual(os.path.exists(self.path(f"g{detail}")), code == 0)

    def test_checking_a_scene_with_a_huge_picture_takes_little_memory(self):
        """The whole picture would take 2.7 GB; a smaller one is timed."""
        scene = self.path("huge.yaml")
        Path(scene).write_text("frames: 1\nsteps: 1\nsheets: [{grid: {size: [0.4, 0.4], cells: [6, 6]}}]\n"
                               "preview: {size: [4096, 4096], samples: 1}\n")
        run = self.start("check", scene)
        _, status, usage = os.wait4(run.pid, 0)
        run.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(run.returncode, 0)
        self.assertLess(usage.ru_maxrss, 1e6)  # KB

    def code_of(self, *args):
        run = self.start(*args)
        run.communicate(timeout=120)
        return run.returncode

    def test_links_in_the_folder_are_not_followed(self):
        """Their targets belong to somebody else. The folder itself may be a link."""
        os.makedirs(self.path("theirs", "frames"))
        for name in "stats.csv", "run.json", "checkpoint.singe", "preview.mp4", "frames/tiny.0001.png":
            Path(self.path("theirs", name)).write_text("theirs")
        before = self.tree("theirs")
        os.mkdir(self.path("real"))
        os.symlink("real", self.path("o"))
        for inner in ["frames", "gas", "ply"]:
            os.symlink(self.path("theirs"), self.path("o", inner))
            self.assertIn(f"o/{inner}: cannot write: it is a link", self.run_scene("o", expect=1, preview=True)[1])
            os.remove(self.path("o", inner))
            shutil.rmtree(self.path("real"))
            os.mkdir(self.path("real"))
        os.symlink(self.path("theirs", "stats.csv"), self.path("o", "stats.csv"))
        self.assertIn("o/stats.csv: cannot write: it is a link", self.run_scene("o", expect=1)[1])
        os.remove(self.path("o", "stats.csv"))
        # those that a rename replaces, and a folder that is only cleaned
        for name in "run.json", "checkpoint.singe", "preview.mp4":
            os.symlink(self.path("theirs", name), self.path("o", name))
        shutil.rmtree(self.path("o", "frames"), ignore_errors=True)
        os.symlink(self.path("theirs", "frames"), self.path("o", "frames"))
        self.run_scene("o")
        os.remove(self.path("o", "frames"))
        self.run_scene("o", preview=True)
        self.assertEqual(self.tree("theirs"), before)
        self.assertEqual(self.record("o")["result"], "complete")
        self.assertFalse([n for n in os.listdir(self.path("o")) if os.path.islink(self.path("o", n))])

    def test_pipes_do_not_hang(self):
        for name in "stats.csv", "run.json", "checkpoint.singe", "preview.mp4", "ply":
            with self.subTest(name):
                out = "o" + name
                os.mkdir(self.path(out))
                os.mkfifo(self.path(out, name))
                expect = 0 if name in ("checkpoint.singe", "preview.mp4") else 1  # which are removed first
                _, err = self.run_scene(out, expect=expect, preview=True, timeout=30)
                if expect:
                    self.assertIn(name, err)
        os.remove(self.path("ostats.csv", "stats.csv"))
        os.mkfifo(self.path("ostats.csv", "checkpoint.singe"))
        self.run_scene("ostats.csv", "--resume", expect=1, timeout=30)

    def test_drafts_of_a_killed_run_go(self):
        self.run_scene("o", "--quiet")
        for name in "ply/tiny.0001.ply.12-0.tmp.12-0.tmp", "preview.mp4.12-3.tmp", "preview.gif.12-0.tmp":
            Path(self.path("o", name)).write_text("half")
        self.run_scene("o", "--resume")
        self.no_temporaries("o")
