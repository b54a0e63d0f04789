"""Two processes at one folder: who writes what, and that no lock outlives its process."""

import os
import re
import signal
import socket
from pathlib import Path

from support import Case


class Lock(Case):
    def begin(self, out, *args):
        """Starts a run that would take very long, and waits for its second frame."""
        scene = self.write_scene("long.yaml", frames=100000, cells=20)
        run = self.start("run", scene, "-o", self.path(out), "--no-preview", *args)
        self.addCleanup(run.stderr.close)
        self.addCleanup(lambda: run.poll() is None and run.kill())
        self.wait_for(lambda: os.path.exists(self.path(out, "ply", "long.0002.ply")), run)
        return run

    def end(self, process, number=signal.SIGKILL):
        process.send_signal(number)
        process.wait(timeout=60)

    def test_second_run_is_refused(self):
        run = self.begin("o")
        before = self.record("o")
        _, err = self.run_scene("o", expect=1)
        self.assertIn(f"its frames are being written by process {run.pid} on {socket.gethostname()}", err)
        _, err = self.run_scene("o", "--resume", expect=1)
        self.assertIn(f"process {run.pid} ", err)
        self.assertIsNone(run.poll())
        self.assertEqual(self.record("o"), before)
        self.end(run, signal.SIGINT)
        self.assertFalse([n for n in os.listdir(self.path("o")) if n.endswith(".lock")])
        self.singe("verify", self.path("o"))
        self.run_scene("o")
        self.singe("verify", self.path("o"))

    def test_two_at_once(self):
        """One of them runs; the other has touched nothing."""
        runs = []
        for pace in 12, 6:
            scene = self.write_scene(f"pace{pace}.yaml", frames=12, cells=30, extra="name: both\n")
            runs.append(self.start("run", scene, "-o", self.path("o"), "--no-preview", "-q", "--set", f"pace={pace}"))
        errors = [run.communicate(timeout=120)[1] for run in runs]
        codes = [run.returncode for run in runs]
        self.assertIn(sorted(codes), ([0, 1], [0, 0]), errors)  # [0, 0]: one after the other
        self.singe("verify", self.path("o"))
        winner = codes.index(0)
        if codes[1 - winner]:
            self.assertIn("are being written by process", errors[1 - winner])
            self.assertEqual(self.record("o")["scene"]["pace"], (12, 6)[winner])

    def whole_ply(self, path):
        """Whether the file has as many bytes as its head says, of the vertices and at least the faces' counts."""
        head, mark, body = Path(path).read_bytes().partition(b"end_header\n")
        properties = re.search(rb"element vertex \d+\n(.*?)element face", head, re.S)[1].count(b"property")
        vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", head)[:2])
        return mark and len(body) == 4 * properties * vertices + 13 * faces

    def test_a_cache_is_read_while_it_is_written(self):
        """A file under its final name is complete. Readers stop at the last frame, and do not disturb the run."""
        run = self.begin("o")
        looked = 0
        for _ in range(300):
            for name in sorted(os.listdir(self.path("o", "ply"))):
                if re.fullmatch(r"long\.\d+\.ply", name):
                    self.assertTrue(self.whole_ply(self.path("o", "ply", name)), name)
                    looked += 1
            lines = Path(self.path("o", "stats.csv")).read_text().split("\n")
            self.assertEqual({line.count(",") for line in lines[:-1]}, {lines[0].count(",")})
        self.assertGreater(looked, 300)
        shown, _ = self.singe("measure", self.path("o"), "--frames", "1-2")
        self.assertIn("jitter", shown)
        self.assertIn("wait for it to end", self.singe("convert", self.path("o"), "--to", "vtp", expect=1)[1])
        self.assertIsNone(run.poll())
        self.end(run, signal.SIGINT)
        self.singe("verify", self.path("o"))
        part = Path(self.path("o", "ply", "long.0002.ply")).read_bytes()[:-1]
        Path(self.path("cut.ply")).write_bytes(part)
        self.assertFalse(self.whole_ply(self.path("cut.ply")))  # the test would see it

    def test_a_killed_run_holds_nothing(self):
        self.end(self.begin("o"))
        self.run_scene("o")
        self.assertEqual(self.record("o")["result"], "complete")

    def test_links_and_pipes_in_the_place_of_a_lock(self):
        os.mkdir(self.path("o"))
        Path(self.path("theirs")).write_text("theirs")
        os.symlink(self.path("theirs"), self.path("o", "cache.lock"))
        self.assertIn("o/cache.lock: cannot write: it is a link", self.run_scene("o", expect=1)[1])
        self.assertEqual(Path(self.path("theirs")).read_text(), "theirs")
        os.remove(self.path("o", "cache.lock"))
        os.mkfifo(self.path("o", "cache.lock"))
        self.assertIn("cache.lock", self.run_scene("o", expect=1, timeout=20)[1])

    def test_renders_of_parts_run_side_by_side(self):
        self.run_scene("o", "--frames", "4", "--quiet")
        slow = ["--set", "preview.samples=4000", "--set", "preview.size=[640, 480]", "--threads", "1"]
        first = self.start("render", self.path("o"), "--frames", "1-2", *slow)
        self.addCleanup(first.stderr.close)
        self.addCleanup(lambda: first.poll() is None and first.kill())
        self.wait_for(lambda: os.path.exists(self.path("o", "pictures.lock")), first)
        self.singe("render", self.path("o"), "--frames", "3-4")
        self.assertEqual(sorted(os.listdir(self.path("o", "frames"))), ["tiny.0003.png", "tiny.0004.png"])
        self.singe("render", self.path("o"), "--only-sheet")  # writes no frames
        for args in ["render", self.path("o")], ["run", self.scene, "-o", self.path("o")]:
            _, err = self.singe(*args, expect=1)
            self.assertIn(f"its pictures are being written by process {first.pid} ", err)
        self.assertIsNone(first.poll(), "the test's own premise")
        self.end(first)
        self.singe("render", self.path("o"))
        self.assertFalse([n for n in os.listdir(self.path("o")) if n.endswith(".lock")])

    def test_pictures_of_a_run_without(self):
        """`render` may draw the frames of a run that draws no pictures itself."""
        run = self.begin("o")
        self.singe("render", self.path("o"), "--frames", "1-2")
        self.assertEqual(len(os.listdir(self.path("o", "frames"))), 2)
        self.assertIsNone(run.poll())
        self.end(run)
