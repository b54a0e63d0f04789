"""The Python package: run, check, measure and caches."""

import importlib.util
import os
import re
import shutil
import signal
import stat
import unittest
import unittest.mock

from support import ROOT, SCENE, Case, singe

import numpy as np
from singe import notebook


@unittest.skipUnless(os.environ.get("SINGE_PROGRAM"), "SINGE_PROGRAM names no command")
class Command(Case):
    def test_run_and_read(self):
        reported = []
        cache = singe.run(self.scene(), self.dir / "out", frames=4, preview=False, settings={"pace": np.float32(3)},
                          progress=lambda done, frames: reported.append((done, frames)))
        self.assertEqual(reported[-1], (4, 4))
        self.assertEqual(reported, sorted(set(reported)))
        self.assertEqual(cache.frames, [1, 2, 3, 4])
        self.assertEqual(cache.scene["pace"], 3)
        self.assertTrue(np.allclose(cache.stats["time"], [frame.time for frame in cache], atol=1e-5))
        self.assertTrue(np.array_equal(cache.stats["triangles"], [len(frame.triangles) for frame in cache]))
        last = cache[-1]
        self.assertEqual(last.number, 4)
        self.assertAlmostEqual(float(last.temperature.max()), cache.stats["temperature_max"][-1], delta=1)
        self.assertTrue(last.gas.is_file())
        self.assertFalse(last.position.flags.writeable)
        self.assertIsNone(cache.picture())
        self.assertIn("<img", cache._repr_html_())
        for wrong in (0, 5, -5):
            with self.assertRaisesRegex(IndexError, "1 to 4"):
                cache[wrong]
        measured = singe.measure(self.dir / "out", frames=(2, 3))
        self.assertEqual(list(measured["frame"]), [2, 3])

    def test_branch(self):
        whole = singe.run(self.scene(), self.dir / "out", frames=4, preview=False, settings={"pace": 3})
        other = singe.branch(whole, 2, self.dir / "faster", settings={"pace": 9}, preview=False)
        back = singe.branch(other.folder, 2, self.dir / "back", settings={"pace": 3}, preview=False, threads=1)
        for frame in whole:
            self.assertEqual(frame.path.read_bytes(), back[frame.number].path.read_bytes())
            self.assertEqual(frame.path.read_bytes() == other[frame.number].path.read_bytes(), frame.number <= 2)
        self.assertEqual(other.record["from"]["frame"], 2)
        with self.assertRaisesRegex(singe.SceneError, "seed cannot change"):
            singe.branch(whole, 2, self.dir / "no", settings={"seed": 2})
        self.assertFalse((self.dir / "no").exists())

    def test_a_frame_is_what_its_file_says(self):
        cache = singe.run(self.scene(), self.dir / "out", frames=3, preview=False)
        frame, data = cache[3], cache[3].path.read_bytes()
        header, body = data.split(b"end_header\n", 1)
        names = [line.split()[2] for line in header.decode().splitlines() if line.startswith(("property float",
                                                                                          "property int"))]
        count = len(frame.position)
        rows = np.frombuffer(body[:count * 4 * len(names)], "<f4").reshape(count, len(names))
        for array, columns in ((frame.position, "x y z"), (frame.normal, "nx ny nz"), (frame.uv, "s t"),
                               (frame.velocity, "vx vy vz"), (frame.rest_position, "rest_x rest_y rest_z")):
            self.assertTrue(np.array_equal(array, rows[:, [names.index(c) for c in columns.split()]]))
        self.assertTrue(np.array_equal(frame.burn, rows[:, names.index("burnt")]))
        self.assertTrue(np.array_equal(frame.source_vertex, rows[:, names.index("vertex_id")].view("<i4")))

    def test_a_frame_of_nothing(self):
        cache = singe.run(self.scene(), self.dir / "out", frames=2, preview=False)
        path = cache[2].path
        header = path.read_bytes().split(b"end_header\n", 1)[0]
        empty = re.sub(rb"element (\w+) \d+", rb"element \1 0", header) + b"end_header\n"
        path.write_bytes(empty)
        frame = cache[2]
        self.assertEqual((frame.position.shape, frame.uv.shape, frame.triangles.shape), ((0, 3), (0, 2), (0, 3)))
        self.assertEqual(len(frame.temperature), 0)
        self.assertFalse(frame.position.flags.writeable)

    def test_view(self):
        """Without anywidget: what it needs. Its server answers the page's questions, and no others, and ends."""
        cache = singe.run(self.scene(), self.dir / "out", frames=2, preview=False)
        if not importlib.util.find_spec("anywidget"):
            with self.assertRaisesRegex(ImportError, "pip install anywidget"):
                singe.view(cache)
            self.assertIsNone(cache._repr_mimebundle_())
        try:
            server = notebook.Server(cache.folder)
        except singe.CommandError as error:
            self.assertIn("built without", str(error))
            return
        self.assertEqual(server.ask("state")[0], 200)
        self.assertIn(b"<canvas", server.ask("")[1])
        self.assertEqual([server.ask(path)[0] for path in ("../state", "x y", "none.js", "view.js?a")], [404] * 4)
        server.close()
        self.assertEqual(server.ask("state")[0], 503)
        with self.assertRaises(singe.CommandError):
            notebook.Server(self.dir / "nothing")

    def test_alembic(self):
        cache = singe.run(self.scene(), self.dir / "out", frames=3, preview=False)
        if not importlib.util.find_spec("rerun"):
            with self.assertRaisesRegex(ImportError, "pip install rerun-sdk"):
                singe.log_to_rerun(cache)
        try:
            import alembic3d  # noqa: F401
        except ImportError:
            with self.assertRaisesRegex(ImportError, "pip install alembic3d"):
                cache.write_alembic()
            return
        reported = []
        path = cache.write_alembic(progress=lambda done, frames: reported.append((done, frames)))
        self.assertEqual((path, reported), (self.dir / "out" / "tiny.abc", [(1, 3), (2, 3), (3, 3)]))
        self.assertTrue(path.read_bytes().startswith(b"Ogawa"))
        whole = path.read_bytes()
        cache[2].path.unlink()
        with self.assertRaisesRegex(singe.FormatError, "lacks frames"):
            cache.write_alembic()
        self.assertEqual(path.read_bytes(), whole)
        with self.assertRaises((singe.FormatError, OSError)):
            singe.run(self.scene(), self.dir / "out", preview=False).write_alembic(self.dir / "nowhere" / "a.abc")
        self.assertEqual([name for name in os.listdir(self.dir / "out") if name.endswith(".tmp")], [])

    def test_damaged_caches(self):
        with self.assertRaisesRegex(singe.FormatError, "not a cache"):
            singe.read_cache(self.dir)
        cache = singe.run(self.scene(), self.dir / "out", frames=2, preview=False)
        path = cache[2].path
        data = path.read_bytes()
        for cut in (0, 10, 300, len(data) // 2, len(data) - 1):
            path.write_bytes(data[:cut])
            with self.assertRaises(singe.FormatError):
                cache[2]
        path.write_bytes(data[:-1] + b"\x7f")
        with self.assertRaisesRegex(singe.FormatError, "out of range"):
            cache[2]
        (self.dir / "out/stats.csv").write_text("frame,time\n1\n")
        with self.assertRaisesRegex(singe.FormatError, "damaged"):
            cache.stats
        (self.dir / "out/run.json").write_text("{")
        with self.assertRaisesRegex(singe.FormatError, "damaged"):
            singe.read_cache(self.dir / "out")

    def test_errors_have_their_place(self):
        wrong = self.scene(SCENE.replace("pace: 4", "pase: 4").replace("frames: 6", "frames: many"))
        for call in (singe.check, singe.run):
            with self.assertRaises(singe.SceneError) as caught:
                call(wrong)
            places = [(p.line, p.column) for p in caught.exception.problems]
            self.assertEqual(places, [(1, 9), (3, 1)])
            self.assertIn("did you mean 'pace'", str(caught.exception))
            self.assertEqual(caught.exception.returncode, 2)
        with self.assertRaisesRegex(singe.SceneError, "cannot read"):
            singe.measure(self.dir / "nowhere")
        (self.dir / "file").write_text("")
        with self.assertRaises(singe.CommandError):
            singe.run(self.scene(), self.dir / "file")

    def test_check(self):
        text = singe.check(self.scene(), settings={"sheets.0.grid.cells": [10, 20]})
        self.assertRegex(text, r"cells +200 ")

    def test_an_exception_in_progress_leaves_a_checkpoint(self):
        class Enough(Exception):
            pass

        def stop(done, frames):
            if done >= 2:
                raise Enough

        scene = self.scene(SCENE.replace("frames: 6", "frames: 10000").replace("steps: 2", "steps: 20"))
        with self.assertRaises(Enough):
            singe.run(scene, self.dir / "out", preview=False, progress=stop)
        self.assertEqual(singe.read_cache(self.dir / "out").record["result"], "interrupted")
        cut = len(singe.read_cache(self.dir / "out"))
        self.assertTrue(2 <= cut < 10000)
        cache = singe.run(scene, self.dir / "out", frames=cut + 8, preview=False, resume=True)
        whole = singe.run(scene, self.dir / "whole", frames=cut + 8, preview=False)
        self.assertEqual([frame.path.read_bytes() for frame in cache], [frame.path.read_bytes() for frame in whole])

    def test_a_command_that_cannot_be_interrupted_is_ended(self):
        """As on Windows. The exception arrives, and nobody writes into the folder any more."""
        def refuse(child, number):
            if number == signal.SIGINT:
                raise ValueError("Unsupported signal: 2")
            os.kill(child.pid, number)

        def stop(done, frames):
            raise KeyError("enough")

        scene = self.scene(SCENE.replace("frames: 6", "frames: 10000").replace("steps: 2", "steps: 20"))
        with unittest.mock.patch("subprocess.Popen.send_signal", refuse), self.assertRaisesRegex(KeyError, "enough"):
            singe.run(scene, self.dir / "out", preview=False, progress=stop)
        self.assertEqual(len(singe.run(scene, self.dir / "out", frames=2, preview=False)), 2)

    def test_ctrl_c_reaches_the_command_once(self):
        scene = self.scene(SCENE.replace("frames: 6", "frames: 400").replace("steps: 2", "steps: 20"))
        out = self.python(f"""
import os, signal, singe
sent = []
def kill(done, frames):
    if not sent: sent.append(os.kill(os.getpid(), signal.SIGINT))
try:
    singe.run({str(scene)!r}, {str(self.dir / "out")!r}, preview=False, progress=kill)
except KeyboardInterrupt:
    print(singe.read_cache({str(self.dir / "out")!r}).record["result"])
""")
        self.assertEqual(out.strip(), "interrupted")

    def test_the_program_is_found_and_made_executable(self):
        package = self.dir / "singe"
        shutil.copytree(ROOT / "bindings/python/singe", package, ignore=shutil.ignore_patterns("__pycache__"))
        (package / "bin").mkdir()
        program = package / "bin/singe"
        program.write_text("#!/bin/sh\necho it is \"$@\"\n")
        program.chmod(0o644)
        text = (f"import os, sys; sys.path.insert(0, {str(self.dir)!r}); named = os.environ.pop('SINGE_PROGRAM')\n"
                "import singe\nprint(singe.check('x'), singe.command_path())")
        self.assertIn("it is check x", self.python(text))
        self.assertTrue(program.stat().st_mode & stat.S_IXUSR)
        program.unlink()
        text = text.replace("print(singe.check('x')", "try: singe.check('x')\nexcept singe.CommandMissingError as e: "
                            "print('missing', e)\nsys.exit()\n(0")
        self.assertIn("missing", self.python(text))
