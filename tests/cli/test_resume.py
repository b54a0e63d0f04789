"""Interrupted and killed runs, and going on from them."""

import os
import random
import shutil
import signal
import time
import unittest

from support import HAS_FFMPEG, HAS_PREVIEW, Case


class Resume(Case):
    FRAMES = 24

    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(frames=self.FRAMES, cells=20, steps=4)

    def lines(self, out):
        try:
            with open(self.path(out, "stats.csv"), "rb") as file:
                return file.read().count(b"\n") - 1
        except FileNotFoundError:
            return -1

    def start_until(self, out, frame, *args):
        """Starts a run and comes back as soon as that frame is in its stats."""
        run = self.start("run", self.scene, "-o", self.path(out), *args)
        self.addCleanup(run.stderr.close)
        self.addCleanup(lambda: run.poll() is None and run.kill())
        end = time.monotonic() + 60
        while self.lines(out) < frame and run.poll() is None:
            self.assertLess(time.monotonic(), end, "the run does not come forward")
            time.sleep(0.001)
        return run

    def same_as_whole(self, out, whole="whole"):
        self.assertEqual(self.plys(whole), self.plys(out))
        self.assertEqual(self.numbers(whole), self.numbers(out))
        self.assertEqual(self.record(out)["result"], "complete")
        self.assertEqual(self.record(out)["totals"], self.record(whole)["totals"])
        self.no_temporaries(out)

    def test_kill_and_resume(self):
        self.run_scene("whole", "--quiet")
        seed = int(time.time())
        rng = random.Random(seed)
        for attempt in range(4):
            out, frame = f"k{attempt}", rng.randrange(0, self.FRAMES - 2)
            with self.subTest(seed=seed, frame=frame):
                run = self.start_until(out, frame, "--no-preview", "--threads", "2")
                time.sleep(rng.random() * 0.01)
                run.kill()
                run.wait()
                self.run_scene(out, "--resume", "--threads", str(rng.choice((1, 2, 4))))
                self.same_as_whole(out)

    def test_killed_twice(self):
        self.run_scene("whole", "--quiet")
        for frame, more in (6, []), (14, ["--resume"]):
            run = self.start_until("k", frame, "--no-preview", *more)
            run.kill()
            run.wait()
        self.run_scene("k", "--resume")
        self.same_as_whole("k")

    def test_debris_of_a_killed_run(self):
        """What a kill can leave at its worst: a line cut in two, later frames, a temporary file."""
        self.run_scene("whole", "--quiet")
        self.run_scene("k", "--frames", "9", "--quiet")
        with open(self.path("k", "stats.csv"), "a") as file:
            file.write("10,0.375,1,2\n11,0.4")
        with open(self.path("k", "ply", "tiny.0010.ply"), "w") as file:
            file.write("not a frame")
        for name in "ply/tiny.0011.ply.4711-0.tmp", "checkpoint.singe.4711-0.tmp":
            with open(self.path("k", name), "w") as file:
                file.write("half")
        _, err = self.run_scene("k", "--resume")
        self.assertIn("going on from frame 9", err)
        self.same_as_whole("k")
        self.assertEqual(self.record("k")["resumed_from"], 9)

    def interrupted(self, number):
        run = self.start_until("i", 3)
        run.send_signal(number)
        _, err = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 1, err)
        done = self.record("i")["frames_done"]
        self.assertEqual(self.record("i")["result"], "interrupted", err)
        self.assertEqual(len(self.stats("i")), done)
        self.assertEqual(len(self.plys("i")), done)
        self.assertGreaterEqual(done, 3)
        self.assertLess(done, self.FRAMES)
        self.assertIn("--resume", err)
        self.no_temporaries("i")
        if HAS_PREVIEW:
            self.assertEqual(len(os.listdir(self.path("i", "frames"))), done)
            self.assertEqual(os.path.exists(self.path("i", "preview.mp4")), HAS_FFMPEG)
        return done

    def test_ctrl_c(self):
        self.run_scene("whole", "--quiet")
        done = self.interrupted(signal.SIGINT)
        _, err = self.run_scene("i", "--resume", preview=True)
        self.assertIn(f"going on from frame {done}", err)
        self.same_as_whole("i")

    def test_terminate(self):
        self.interrupted(signal.SIGTERM)

    def test_second_ctrl_c_ends_at_once(self):
        self.scene = self.write_scene(frames=100, cells=60, steps=400)
        run = self.start_until("i", 1, "--no-preview")
        time.sleep(0.1)
        run.send_signal(signal.SIGINT)
        time.sleep(0.1)
        self.assertIsNone(run.poll(), "the first only asks")
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(timeout=2), -signal.SIGINT)

    def test_nothing_to_resume(self):
        _, err = self.run_scene("new", "--resume", "--frames", "2")
        self.assertIn("starting from the beginning", err)
        self.assertEqual(len(self.plys("new")), 2)

    def test_resume_of_a_finished_run(self):
        self.run_scene("o", "--frames", "3", "--quiet")
        before = self.plys("o")
        self.run_scene("o", "--frames", "3", "--resume")
        self.assertEqual(self.plys("o"), before)

    def test_longer_run_and_other_looks(self):
        self.run_scene("whole", "--quiet")
        self.run_scene("o", "--frames", "3", "--quiet")
        self.run_scene("o", "--resume", "--set", "preview.exposure=2")
        self.same_as_whole("o")

    def test_other_scene_is_refused(self):
        self.run_scene("o", "--frames", "3", "--quiet")
        _, err = self.run_scene("o", "--resume", "--set", "pace=5", expect=2)
        self.assertIn("another scene", err)
        self.assertEqual(len(self.plys("o")), 3)

    def test_other_mesh_is_refused(self):
        def mesh(height):
            with open(self.path("square.obj"), "w") as file:
                for y in range(4):
                    for x in range(4):
                        file.write(f"v {x / 100} {y / 100} {height if x == y == 3 else 0}\n")
                for y in range(3):
                    for x in range(3):
                        a = 4 * y + x + 1
                        file.write(f"f {a} {a + 1} {a + 5} {a + 4}\n")

        self.scene = self.path("mesh.yaml")
        with open(self.scene, "w") as file:
            file.write("frames: 5\nsheets: [{mesh: square.obj}]\n")
        mesh(0)
        self.run_scene("o", "--frames", "3", "--quiet")
        self.run_scene("o", "--resume", "--frames", "4")
        mesh(0.001)
        self.assertIn("another scene", self.run_scene("o", "--resume", expect=2)[1])

    def test_fewer_frames_than_done(self):
        self.run_scene("o", "--frames", "5", "--quiet")
        self.assertIn("at frame 5", self.run_scene("o", "--resume", "--frames", "4", expect=2)[1])

    def test_damaged_checkpoint(self):
        self.run_scene("o", "--frames", "3", "--quiet")
        path = self.path("o", "checkpoint.singe")
        with open(path, "rb") as file:
            good = file.read()
        flipped = bytearray(good)
        flipped[len(good) // 2] ^= 1
        for name, data in (("flipped", bytes(flipped)), ("cut", good[:-7]), ("short", good[:20]), ("empty", b""),
                           ("longer", good + b"x"), ("text", b"not a checkpoint" * 100)):
            with self.subTest(name):
                with open(path, "wb") as file:
                    file.write(data)
                _, err = self.run_scene("o", "--resume", expect=2)
                self.assertIn("checkpoint", err)
                self.assertIn("without --resume", err)
        self.run_scene("o", "--frames", "3")

    def test_stats_lost(self):
        self.run_scene("o", "--frames", "3", "--quiet")
        os.remove(self.path("o", "stats.csv"))
        self.assertIn("stats.csv", self.run_scene("o", "--resume", expect=2)[1])

    def test_checkpoint_moves_with_its_folder(self):
        self.run_scene("whole", "--quiet")
        self.run_scene("a", "--frames", "7", "--quiet")
        shutil.move(self.path("a"), self.path("b"))
        self.run_scene("b", "--resume")
        self.same_as_whole("b")


if __name__ == "__main__":
    unittest.main()
