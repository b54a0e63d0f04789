"""Interrupted and killed runs, and going on from them."""

import os
import random
import re
import resource
import shutil
import signal
import time
from pathlib import Path

from support import HAS_FFMPEG, SANITIZED, Case, at_most, write_png


class Resume(Case):
    FRAMES = 17 if SANITIZED else 24

    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(frames=self.FRAMES, cells=20, steps=4)

    def lines(self, out):
        try:
            return Path(self.path(out, "stats.csv")).read_bytes().count(b"\n") - 1
        except FileNotFoundError:
            return -1

    def start_until(self, out, frame, *args, **options):
        """Starts a run and comes back as soon as that frame is in its stats."""
        run = self.start("run", self.scene, "-o", self.path(out), *args, **options)
        self.addCleanup(run.stderr.close)
        self.addCleanup(lambda: run.poll() is None and run.kill())
        self.wait_for(lambda: self.lines(out) >= frame, run)
        return run

    def whole(self):
        """The usual scene, which nothing interrupts."""
        self.once("whole", lambda folder: self.run_scene(folder, "--quiet"))

    def same_as_whole(self, out, whole="whole"):
        self.assertEqual(self.plys(whole), self.plys(out))
        self.assertEqual(self.numbers(whole), self.numbers(out))
        self.assertEqual(self.record(out)["result"], "complete")
        self.assertEqual(self.record(out)["totals"], self.record(whole)["totals"])
        self.no_temporaries(out)

    def test_kill_and_resume(self):
        self.whole()
        seed = int(time.time())
        rng = random.Random(seed)
        for attempt in range(2 if SANITIZED else 4):
            out, frame = f"k{attempt}", rng.randrange(0, self.FRAMES - 2)
            with self.subTest(seed=seed, frame=frame):
                run = self.start_until(out, frame, "--no-preview", "--threads", "2")
                time.sleep(rng.random() * 0.01)
                run.kill()
                run.wait()
                self.run_scene(out, "--resume", "--threads", str(rng.choice((1, 2, 4))))
                self.same_as_whole(out)

    def test_killed_twice(self):
        self.whole()
        for frame, more in (6, []), (14, ["--resume"]):
            run = self.start_until("k", frame, "--no-preview", *more)
            run.kill()
            run.wait()
        self.run_scene("k", "--resume")
        self.same_as_whole("k")

    def test_debris_of_a_killed_run(self):
        """The worst debris of a kill: a truncated line, later frames, a temporary file."""
        self.whole()
        self.run_scene("k", "--frames", "9", "--quiet")
        with open(self.path("k", "stats.csv"), "a") as file:
            file.write("10,0.375,1,2\n11,0.4")
        Path(self.path("k", "ply", "tiny.0010.ply")).write_text("not a frame")
        for name in "ply/tiny.0011.ply.4711-0.tmp", "checkpoint.singe.4711-0.tmp":
            Path(self.path("k", name)).write_text("half")
        _, err = self.run_scene("k", "--resume")
        self.assertIn("continuing from frame 9", err)
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
        self.assertEqual(len(os.listdir(self.path("i", "frames"))), done)
        self.assertEqual(os.path.exists(self.path("i", "preview.mp4")), HAS_FFMPEG)
        return done

    def test_ctrl_c(self):
        self.whole()
        done = self.interrupted(signal.SIGINT)
        _, err = self.run_scene("i", "--resume", preview=True)
        self.assertIn(f"continuing from frame {done}", err)
        self.same_as_whole("i")

    def test_terminate(self):
        self.interrupted(signal.SIGTERM)

    def test_ctrl_c_in_a_picture(self):
        """A picture that would take minutes is given up. Frames before it stay."""
        self.run_scene("p", "--quiet", "--frames", "2")
        for wait in 0.2, 0.5, 2, 8:  # it may come before anything watches for it
            render = self.start("render", self.path("p"), "--set", "preview.size=[2048,2048]", "--set",
                                "preview.samples=4096")
            self.addCleanup(lambda render=render: render.poll() is None and render.kill())
            time.sleep(wait)
            begun = time.monotonic()
            render.send_signal(signal.SIGINT)
            _, err = render.communicate(timeout=120)
            if render.returncode != -signal.SIGINT:
                break
        self.assertLess(time.monotonic() - begun, 30)
        self.assertEqual(render.returncode, 1, err)
        self.assertNotIn("error", err)
        self.no_temporaries("p")

    def test_ctrl_c_in_a_step(self):
        """A step of which the colliders take long is given up. Frames and the checkpoint before it stay."""
        ball = "{kind: sphere, position: [0, 0, 0], radius: 0.3}"
        self.scene = self.write_scene(frames=3, cells=150, steps=1, gas="{enabled: no}",
                                      extra=f"colliders: [{', '.join([ball] * 990)}]\n")
        run = self.start_until("s", -1, "--no-preview", "--threads", "1")
        begun = ""  # the first frame, before any step
        while run.poll() is None and not begun:
            time.sleep(0.01)
            begun = os.path.isdir(self.path("s", "ply")) and os.listdir(self.path("s", "ply"))
        time.sleep(1)
        begun = time.monotonic()
        run.send_signal(signal.SIGINT)
        _, err = run.communicate(timeout=200)
        print(f"given up after {time.monotonic() - begun:.1f} s")
        self.assertLess(time.monotonic() - begun, 10)
        self.assertEqual((run.returncode, self.record("s")["result"]), (1, "interrupted"), err)
        self.assertNotIn("error", err)
        self.assertEqual(len(self.plys("s")), self.record("s")["frames_done"])
        self.no_temporaries("s")

    def test_ctrl_c_between_steps(self):
        """It does not wait for the frame, and nothing of it is lost."""
        self.scene = self.write_scene(frames=4, cells=20, steps=800)
        self.run_scene("whole", "--quiet")
        tried = stopped = 0
        for attempt in range(8):
            if stopped and (SANITIZED or tried == 3):
                break
            out = f"i{attempt}"
            run = self.start_until(out, 2, "--no-preview", "--threads", "1")
            time.sleep(0.02 + 0.03 * tried)
            begun = time.monotonic()
            run.send_signal(signal.SIGINT)
            _, err = run.communicate(timeout=60)
            self.assertLess(time.monotonic() - begun, 5)
            if run.returncode == 0:  # it ended first: this process may wait for long
                continue
            tried += 1
            self.assertEqual(run.returncode, 1, err)
            done = self.record(out)["frames_done"]
            self.assertEqual((self.record(out)["result"], len(self.plys(out)), len(self.stats(out))),
                             ("interrupted", done, done))
            self.singe("verify", self.path(out))
            stopped += self.record(out)["totals"]["steps"] % 800 != 0
            self.assertIn(f"continuing from frame {done}", self.run_scene(out, "--resume")[1])
            self.same_as_whole(out)
        self.assertGreater(stopped, 0, "never stopped within a frame")

    def test_second_ctrl_c_ends_at_once(self):
        """While the video is made, which the first one waits for."""
        self.scene = self.write_scene(frames=100000)
        run = self.start_until("i", 1, env=self.fake_ffmpeg(f"touch {self.path('made')}; exec sleep 100"))
        run.send_signal(signal.SIGINT)
        self.wait_for(lambda: os.path.exists(self.path("made")))
        self.assertIsNone(run.poll(), "the first only asks")
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(timeout=2), -signal.SIGINT)
        self.run_scene("i", "--resume", "--set", f"frames={self.record('i')['frames_done'] + 2}")
        self.no_temporaries("i")

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
        self.whole()
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
        Path(self.scene).write_text("frames: 5\nsheets: [{mesh: square.obj}]\n")
        mesh(0)
        self.run_scene("o", "--frames", "3", "--quiet")
        self.run_scene("o", "--resume", "--frames", "4")
        mesh(0.001)
        self.assertIn("another scene", self.run_scene("o", "--resume", expect=2)[1])

    CUBE = (-1, 1)

    def cube(self, name, half):
        with open(self.path(name), "w") as file:
            for x in self.CUBE:
                for y in self.CUBE:
                    for z in self.CUBE:
                        file.write(f"v {x * half} {y * half} {z * half}\n")
            file.write("f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")

    def picture(self, name, value):
        """A grey picture of 4 x 4 pixels."""
        write_png(self.path(name), [bytes([value, 128, 7, 200])] * 4)

    def test_other_files_are_refused(self):
        """Every file that a scene reads, but for the preview's."""
        def material(thickness):
            Path(self.path("m.yaml")).write_text(f"base: newsprint\nthickness: {thickness} mm\n"
                                                 "grammage: {from: 50 g/m2, to: 60 g/m2, texture: rate.png}\n")

        extra = ("colliders:\n  - {kind: mesh, mesh: c.obj, position: [0, 0, -10 cm]}\n"
                 "  - {kind: heightfield, picture: heights.png, size: [1, 1], heights: [-30 cm, -20 cm]}\n")
        self.scene = self.write_scene(frames=5, extra=extra)
        text = Path(self.scene).read_text()
        text = text.replace("    translate:",
                            "    material: {base: ./m.yaml}\n    picture: print.png\n    back: back.png\n    translate:", 1)
        text = text.replace("sources:\n", "sources:\n  - {kind: texture, texture: flux.png, flux: 100}\n", 1)
        text = text.replace("samples: 1}", "samples: 1, environment: {picture: sky.png}}")
        Path(self.scene).write_text(text)
        pictures = ["rate.png", "flux.png", "heights.png", "print.png", "back.png", "sky.png"]
        for name in pictures:
            self.picture(name, 100)
        self.cube("c.obj", 0.02)
        material(1)
        self.run_scene("o", "--frames", "2", "--quiet")
        changes = {name: (lambda n=name: self.picture(n, 101), lambda n=name: self.picture(n, 100))
                   for name in pictures[:-1]}
        changes["c.obj"] = (lambda: self.cube("c.obj", 0.021), lambda: self.cube("c.obj", 0.02))
        changes["m.yaml"] = (lambda: material(1.1), lambda: material(1))
        for name, (change, restore) in changes.items():
            with self.subTest(name):
                change()
                self.assertIn("another scene", self.run_scene("o", "--resume", "--frames", "4", expect=2)[1])
                self.assertEqual(len(self.plys("o")), 2)
                restore()
        self.run_scene("o", "--resume", "--frames", "3")
        self.picture("sky.png", 101)
        _, err = self.run_scene("o", "--resume", "--frames", "4", preview=True)
        self.assertIn("the preview has changed", err)
        self.run_scene("whole", "--frames", "4", "--quiet")
        self.same_as_whole("o")

    def test_missing_frames_are_refused(self):
        self.run_scene("o", "--frames", "6", "--quiet")
        for name in "ply/tiny.0003.ply", "gas/tiny.0001.vdb", "ply/tiny.0006.ply":
            for emptied in False, True:
                with self.subTest(name=name, emptied=emptied):
                    os.rename(self.path("o", name), self.path("kept"))
                    if emptied:
                        open(self.path("o", name), "w").close()
                    _, err = self.run_scene("o", "--resume", expect=2)
                    self.assertIn(name + " is missing or empty", err)
                    self.assertIn("without --resume", err)
                    self.assertEqual(len(self.stats("o")), 6)
                    os.rename(self.path("kept"), self.path("o", name))
        self.run_scene("o", "--resume", "--frames", "7")

    def test_missing_pictures_are_drawn(self):
        """The same ones, so that what is complete is."""
        def pictures(out):
            found = {}
            for name in sorted(os.listdir(self.path(out, "frames"))):
                found[name] = Path(self.path(out, "frames", name)).read_bytes()
            return found

        self.run_scene("whole", "--frames", "8", "--quiet", preview=True)
        self.run_scene("o", "--frames", "5", "--quiet")
        _, err = self.run_scene("o", "--resume", "--frames", "8", preview=True)
        self.assertIn("drawing 5 missing pictures", err)
        self.assertEqual(pictures("o"), pictures("whole"))
        os.remove(self.path("o", "frames", "tiny.0002.png"))
        open(self.path("o", "frames", "tiny.0008.png"), "w").close()
        self.run_scene("o", "--resume", "--frames", "8", preview=True)
        self.assertEqual(pictures("o"), pictures("whole"))
        self.assertEqual(os.path.exists(self.path("o", "preview.mp4")), HAS_FFMPEG)
        os.remove(self.path("o", "frames", "tiny.0002.png"))
        _, err = self.run_scene("o", "--resume", "--frames", "8")
        self.assertNotIn("drawing", err)

    def test_fewer_frames_than_done(self):
        self.run_scene("o", "--frames", "5", "--quiet")
        self.assertIn("at frame 5", self.run_scene("o", "--resume", "--frames", "4", expect=2)[1])

    def damage(self, good):
        """Bytes of checkpoints that must be refused, by name. Offsets: the magic is at the trailer's start."""
        flipped = bytearray(good)
        flipped[len(good) // 2] ^= 1
        start = good.rindex(b"SINGECP")
        older = good[:start] + b"SINGECP1" + good[start + 8:]
        return {"flipped": bytes(flipped), "cut": good[:-7], "short": good[:20], "empty": b"", "longer": good + b"x",
                "text": b"not a checkpoint" * 100, "older": older}

    def test_damaged_checkpoint(self):
        self.run_scene("o", "--frames", "3", "--quiet")
        path = self.path("o", "checkpoint.singe")
        good = Path(path).read_bytes()
        for name, data in self.damage(good).items():
            with self.subTest(name):
                for file_name in "checkpoint.singe", "checkpoint.previous.singe":
                    Path(self.path("o", file_name)).write_bytes(data)
                _, err = self.run_scene("o", "--resume", expect=2)
                self.assertIn("checkpoint", err)
                self.assertIn("without --resume", err)
        self.run_scene("o", "--frames", "3")

    def test_the_checkpoint_before_a_damaged_one(self):
        """It is used, with the reason; the cache has the same bytes, and a good checkpoint is there all the time."""
        frames = 12
        self.scene = self.write_scene(frames=frames, cells=20, steps=4)
        self.run_scene("short", "--quiet")
        self.run_scene("a", "--frames", "5", "--quiet")
        self.run_scene("a", "--frames", "9", "--resume", "--quiet")
        good = Path(self.path("a", "checkpoint.singe")).read_bytes()
        cases = list({**self.damage(good), "missing": None}.items())
        if SANITIZED:  # each takes five seconds there
            cases = cases[::4] + cases[-1:]
        for name, data in cases:
            with self.subTest(name):
                shutil.rmtree(self.path("o"), ignore_errors=True)
                shutil.copytree(self.path("a"), self.path("o"))
                os.remove(self.path("o", "checkpoint.singe"))
                if data is not None:
                    Path(self.path("o", "checkpoint.singe")).write_bytes(data)
                _, err = self.run_scene("o", "--resume")
                frame = int(re.search(r"continuing from frame (\d+)", err).group(1))
                self.assertLess(frame, 9)
                self.assertEqual("the checkpoint before it is used" in err, data is not None, err)
                self.same_as_whole("o", "short")
                # the damaged one never took the place of the good one before it
                os.remove(self.path("o", "checkpoint.singe"))
                self.assertIn("continuing from frame", self.run_scene("o", "--resume", "--frames", str(frames + 1))[1])

    def test_the_checkpoint_before_does_not_hide_a_changed_scene(self):
        self.run_scene("o", "--frames", "5", "--quiet")
        self.assertTrue(os.path.exists(self.path("o", "checkpoint.previous.singe")))
        self.assertIn("another scene", self.run_scene("o", "--resume", "--set", "pace=3", expect=2)[1])

    def test_a_failed_write_leaves_both_checkpoints(self):
        self.run_scene("o", "--frames", "5", "--quiet")
        size = os.path.getsize(self.path("o", "checkpoint.singe"))
        before = [self.bytes_of("o", n) for n in ("checkpoint.singe", "checkpoint.previous.singe")]
        self.run_scene("o", "--resume", expect=1, preexec_fn=at_most(resource.RLIMIT_FSIZE, size // 2))
        self.assertEqual(before, [self.bytes_of("o", n) for n in ("checkpoint.singe", "checkpoint.previous.singe")])

    def bytes_of(self, *parts):
        return Path(self.path(*parts)).read_bytes()

    def test_stats_lost(self):
        self.run_scene("o", "--frames", "3", "--quiet")
        os.remove(self.path("o", "stats.csv"))
        self.assertIn("stats.csv", self.run_scene("o", "--resume", expect=2)[1])

    def test_checkpoint_moves_with_its_folder(self):
        self.whole()
        self.run_scene("a", "--frames", "7", "--quiet")
        shutil.move(self.path("a"), self.path("b"))
        self.run_scene("b", "--resume")
        self.same_as_whole("b")
