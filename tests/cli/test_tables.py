"""events.csv and probes.csv: what they hold, and the same bytes for any number of threads and after resumptions."""

import os
import signal
import struct
import time
from pathlib import Path

from support import SANITIZED, Case, Ply

PROBES = """\
detail: 0
probes:
  - {kind: uv, at: [0, 0], name: corner}
  - {kind: uv, at: [0.02, 0.5], name: "rim, left"}
  - {kind: point, at: [1 cm, 0, 5 cm], sheet: sheet1}
output: {events: yes}
"""


class Tables(Case):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(frames=16, steps=6, extra=PROBES)

    def bytes(self, out):
        found = []
        for name in ("events.csv", "probes.csv"):
            found.append(Path(self.path(out, name)).read_bytes())
        return found

    def test_events(self):
        self.run_scene("o", "--quiet", "--frames", "24", "--set", "pace=20")
        events, last = self.table("o", "events.csv"), self.stats("o")[-1]
        for kind, column in (("ignited", "ignited"), ("hole", "holes_opened"), ("piece", "pieces_freed")):
            self.assertEqual(sum(event["event"] == kind for event in events), int(last[column]), kind)
        self.assertGreater(int(last["ignited"]), 20)
        self.assertGreater(int(last["holes_opened"]), 0)
        self.assertGreater(int(last["pieces_freed"]), 0)
        times = [float(event["time"]) for event in events]
        self.assertEqual(times, sorted(times))
        for event in events:
            self.assertLessEqual(abs(float(event["time"]) * 24 + 2 - int(event["frame"])), 1.01)
            self.assertLess(abs(float(event["x"])), 0.2)
            self.assertEqual(event["u"] == "", event["event"] == "piece")
            if event["u"]:
                self.assertTrue(0 <= float(event["u"]) <= 1 and 0 <= float(event["v"]) <= 1)
        # no two particles ignite twice
        ignited = [event["element"] for event in events if event["event"] == "ignited"]
        self.assertEqual(len(ignited), len(set(ignited)))

    def vertex(self, out, frame, number):
        """A vertex of the input, as the cache has it."""
        vertices = Ply(self.path(out, "ply", "tiny.%04d.ply" % frame)).vertices()
        return next((vertex for vertex in vertices if vertex["vertex_id"] == number), None)

    def test_probes(self):
        self.run_scene("o", "--quiet", "--frames", "24", "--set", "pace=20")
        rows = self.table("o", "probes.csv")
        self.assertEqual([(row["frame"], row["probe"]) for row in rows],
                         [(str(frame), name) for frame in range(1, 25) for name in ("corner", "rim, left", "probe3")])
        first = {row["probe"]: row for row in rows[:3]}
        self.assertEqual([round(float(first["rim, left"][axis]), 6) for axis in "xyz"], [-0.0288, 0, 0.05])
        self.assertEqual([round(float(first["probe3"][axis]), 6) for axis in "xyz"], [0.01, 0, 0.05])
        # a probe at a vertex shows what the cache has of it
        for frame in (1, 5, 9):
            row, vertex = rows[3 * (frame - 1)], self.vertex("o", frame, 0)
            for name in ("x", "y", "z", "temperature", "temperature_peak", "mass", "burn_rate"):
                self.assertEqual(struct.pack("<f", float(row[name])), struct.pack("<f", vertex[name]), (frame, name))
        self.assertEqual(first["rim, left"]["time_ignited"], "-1")
        # one at the flame ignites, burns and goes
        left = rows[1::3]
        self.assertGreater(max(float(row["temperature"]) for row in left if row["there"] == "1"), 800)
        self.assertEqual(left[-1]["there"], "0")
        self.assertEqual({left[-1][name] for name in ("x", "temperature", "mass", "piece")}, {""})
        gone = [row["there"] for row in left].index("0")
        self.assertEqual({row["there"] for row in left[gone:]}, {"0"})

    def test_same_bytes(self):
        """Any number of threads; a run that continues from a checkpoint."""
        self.run_scene("whole", "--quiet", "--threads", "1")
        self.run_scene("two", "--quiet", "--threads", "2")
        self.assertEqual(self.bytes("whole"), self.bytes("two"))
        self.run_scene("r", "--quiet", "--frames", "5")
        self.run_scene("r", "--quiet", "--resume", "--threads", "2")
        self.assertEqual(self.bytes("whole"), self.bytes("r"))
        self.assertEqual(self.plys("whole"), self.plys("r"))

    def stop(self, out, number):
        """Starts a run, or goes on with it, and sends a signal a while after its next frame."""
        folder = self.path(out, "ply")
        before = len(os.listdir(folder)) if os.path.exists(folder) else 0
        run = self.start("run", self.scene, "-o", self.path(out), "--no-preview", "--resume")
        while run.poll() is None and (not os.path.exists(folder) or len(os.listdir(folder)) <= before):
            time.sleep(0.002)
        time.sleep(0.007 * (before % 5))
        if run.poll() is None:
            run.send_signal(number)
        run.communicate(timeout=60)

    def test_interrupted_often(self):
        """Between steps by Ctrl-C, and anywhere by SIGKILL."""
        frames, stops = (6, 3) if SANITIZED else (16, 8)
        self.scene = self.write_scene(frames=frames, steps=40, cells=24, extra=PROBES)
        self.run_scene("whole", "--quiet")
        for i in range(stops):
            self.stop("r", signal.SIGINT if i % 2 else signal.SIGKILL)
        self.run_scene("r", "--quiet", "--resume")
        self.assertEqual(self.bytes("whole"), self.bytes("r"))
        self.assertEqual(self.plys("whole"), self.plys("r"))

    def test_lost_lines(self):
        """The lines that a checkpoint relies on must exist."""
        self.run_scene("o", "--quiet", "--frames", "8")
        for name, lines in (("events.csv", "events up to frame 8"), ("probes.csv", "frames 1 to 8")):
            whole = Path(self.path("o", name)).read_bytes()
            for broken in (whole[: len(whole) // 2], whole.replace(b"frame", b"Frame", 1), b""):
                Path(self.path("o", name)).write_bytes(broken)
                error = self.run_scene("o", "--resume", expect=2)[1]
                self.assertIn(name, error)
                self.assertIn(lines, error)
            with open(self.path("o", name), "wb") as file:
                file.write(whole + b"9,half a li")  # as a killed run may leave it
        self.run_scene("o", "--resume", "--quiet")
        self.run_scene("whole", "--quiet")
        self.assertEqual(self.bytes("whole"), self.bytes("o"))

    def test_only_if_asked_for(self):
        self.run_scene("o", "--quiet", "--frames", "3")
        self.assertTrue(os.path.exists(self.path("o", "events.csv")))
        self.scene = self.write_scene()
        self.run_scene("o", "--quiet", "--frames", "3")
        for name in ("events.csv", "probes.csv"):
            self.assertFalse(os.path.exists(self.path("o", name)), name)

    def test_links_are_refused(self):
        os.mkdir(self.path("o"))
        Path(self.path("mine")).write_text("mine")
        os.symlink(self.path("mine"), self.path("o", "events.csv"))
        self.assertIn("events.csv", self.run_scene("o", expect=1)[1])
        self.assertEqual(Path(self.path("mine")).read_text(), "mine")

    def test_mistakes(self):
        def complaint(extra, expect=2):
            self.scene = self.write_scene(extra=extra)
            return self.singe("check", self.scene, "--frames", "1", expect=expect)[1]

        self.assertIn("needs 'kind'", complaint("probes: [{at: [0, 0]}]\n"))
        self.assertIn("needs 'at'", complaint("probes: [{kind: uv}]\n"))
        self.assertIn("a list of 2", complaint("probes: [{kind: uv, at: [0, 0, 0]}]\n"))
        self.assertIn("there is no sheet 'shet1'; did you mean 'sheet1'?",
                      complaint("probes: [{kind: uv, at: [0, 0], sheet: shet1}]\n"))
        self.assertIn("two probes are called 'a'",
                      complaint("probes: [{kind: uv, at: [0, 0], name: a}, {kind: uv, at: [0, 1], name: a}]\n"))
        Path(self.path("bare.obj")).write_text("v 0 0 0\nv .01 0 0\nv .01 .01 0\nv 0 .01 0\nf 1 2 3 4\n")
        Path(self.path("bare.yaml")).write_text("sheets: [{mesh: bare.obj}]\nprobes: [{kind: uv, at: [0, 0]}]\n")
        self.assertIn("the mesh has none", self.singe("check", self.path("bare.yaml"), expect=2)[1])
        self.assertIn("the sheet has no uv [2, 0.5]: the probe takes the nearest, 1 away",
                      complaint("probes: [{kind: uv, at: [2, 0.5]}]\n", expect=0))
        self.assertIn("misses the sheet", complaint("probes: [{kind: point, at: [1, 0, 0]}]\n", expect=0))
        self.assertNotIn("probe", complaint("probes: [{kind: point, at: [1 cm, 0, 51 mm]}]\n", expect=0))
