"""singe fit recovers the parameters of a scene from a run of it."""

import os
import re
import shutil
import signal
import time
import unittest
from pathlib import Path

from support import HAS_EXR, SANITIZED, Case, write_png

SCENE = """\
frames: {frames}
fps: 24
steps: 4
pace: 8
sheets:
  - grid: {{size: [6 cm, 6 cm], cells: [{cells}, {cells}]}}
    translate: [0, 0, 2 mm]
sources:
  - {{kind: spot, position: [-3 cm, 0, 0], temperature: 1200 K, conductance: 300, radius: 1 cm, falloff: 1 cm}}
colliders:
  - kind: plane
probes:
  - {{name: p, kind: point, at: [-1 cm, 0, 2 mm]}}
gas: no
"""
RATE = "sheets.0.material.mass_rate"
RANGE = f"parameters:\n  {RATE}: {{from: 1e-3, to: 3e-2, logarithmic: yes}}\n"


class Fit(Case):
    def write_scene(self, **_):
        path = self.path("tiny.yaml")
        Path(path).write_text(SCENE.format(frames=16, cells=18 if SANITIZED else 24))
        return path

    def truth(self, *args):
        def burn(folder):
            self.run_scene(folder, "--set", f"{RATE}=9e-3", "--quiet", *args)

        burn("truth") if args else self.once("truth", burn)
        return self.stats("truth")[-1]

    def fit(self, plan, *args, out="f", expect=0, **options):
        Path(self.path("plan.yaml")).write_text(plan)
        return self.singe("fit", self.path("plan.yaml"), "-o", self.path(out), *args, expect=expect, **options)

    def lines(self, out="f"):
        try:
            return self.table(out, "fit.csv")
        except FileNotFoundError:
            return []

    def found(self, shown):
        return float(re.search(RATE + r"=([0-9.e-]+)", shown).group(1))

    def test_front_speed(self):
        speed = float(self.truth()["front_speed"])
        plan = f"scene: tiny.yaml\ntarget: {{front_speed: {1e3 * speed} mm/s}}\nevaluations: 12\n{RANGE}"
        shown, err = self.fit(plan)
        self.assertAlmostEqual(self.found(shown), 9e-3, delta=0.1 * 9e-3)
        lines = self.lines()
        self.assertLessEqual(len(lines), 12)
        self.assertEqual(len({line[RATE] for line in lines}), len(lines), "a row was run twice")
        best = min(lines, key=lambda line: float(line["error"]))
        self.assertIn(f"row {best['row']} of {len(lines)}, error", shown)
        self.assertIn(f"1: mass_rate={lines[0][RATE]}: error", err)
        # the line of the result is a command that gives that row
        front = float(self.stats(f"f/rows/{int(best['row']):04}")[-1]["front_speed"])
        self.assertAlmostEqual(float(best["error"]), (front / speed - 1) ** 2, delta=1e-9)

    def test_temperature_curve(self):
        self.truth()
        rows = [(r["time"], r["temperature"]) for r in self.table("truth", "probes.csv") if r["temperature"]]
        with open(self.path("curve.csv"), "w") as file:
            file.write("temperature,note,time\n" + "".join(f"{kelvin},x,{time}\n" for time, kelvin in rows))
        shown, _ = self.fit("scene: tiny.yaml\ntarget: {temperature: {file: curve.csv, probe: p}}\nevaluations: 12\n" +
                            RANGE)
        self.assertAlmostEqual(self.found(shown), 9e-3, delta=0.1 * 9e-3)

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_masks(self):
        """From the textures that a run writes; the search covers the whole range."""
        from exr import read
        self.truth("--set", "output.formats=[textures]", "--set", "output.texture_size=128")
        for frame in 10, 16:
            size, _, channels = read(self.path("truth", "textures", f"tiny.{frame:04}.exr"))
            flat = [255 if alpha < 0.5 or burn >= 0.5 else 0 for alpha, burn in zip(channels["A"], channels["G"])]
            burnt = [flat[i:i + size] for i in range(0, size * size, size)]
            self.assertGreater(sum(map(sum, burnt)), 0)
            write_png(self.path(f"mask{frame:02}.png"), burnt)
        shown, _ = self.fit("scene: tiny.yaml\ntarget: {masks: mask##.png}\nsearch: global\nevaluations: 15\n" + RANGE)
        self.assertAlmostEqual(self.found(shown), 9e-3, delta=0.25 * 9e-3)
        best = min(float(line["error"]) for line in self.lines())
        first = float(self.lines()[0]["error"])
        self.assertLess(best, 0.25 * first, "no better than the middle of the range")

    def test_two_parameters(self):
        """A sum of two targets; a whole number stays one."""
        speed = float(self.truth()["front_speed"])
        self.fit(f"scene: tiny.yaml\ntarget: {{front_speed: {speed}}}\nevaluations: 6\n{RANGE}"
                 "  sheets.0.grid.seed: {from: 1, to: 5, whole: yes}\n")
        self.assertTrue(all(re.fullmatch(r"[1-5]", line["sheets.0.grid.seed"]) for line in self.lines()))

    def stopped(self, stop):
        """Stops a fit after two more rows. False if it ended first: this process may wait for long."""
        before = len(self.lines())
        run = self.start("fit", self.path("plan.yaml"), "-o", self.path("f"))
        end = time.monotonic() + 120
        while len(self.lines()) < before + 2 and run.poll() is None:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.005)
        run.send_signal(stop)
        _, err = run.communicate(timeout=60)
        self.assertIn(run.returncode, (0, 1 if stop == signal.SIGINT else -stop), err)
        return run.returncode != 0

    def test_a_killed_fit_goes_on(self):
        speed = float(self.truth()["front_speed"])
        plan = f"scene: tiny.yaml\ntarget: {{front_speed: {speed}}}\nevaluations: 9\n{RANGE}"
        whole, _ = self.fit(plan, out="whole")
        attempts = 5
        while not (self.stopped(signal.SIGKILL) and self.stopped(signal.SIGINT)):
            attempts -= 1
            self.assertGreater(attempts, 0, "each fit ended before it was stopped")
            shutil.rmtree(self.path("f"))
        times = {f: os.stat(self.path("f", "rows", f)).st_mtime_ns for f in os.listdir(self.path("f", "rows"))}
        shown, _ = self.fit(plan)
        self.assertEqual(shown, whole)
        self.assertEqual(self.lines(), self.lines("whole"))
        for name, changed in times.items():
            self.assertEqual(os.stat(self.path("f", "rows", name)).st_mtime_ns, changed)

    def test_another_fit_is_noticed(self):
        speed = float(self.truth()["front_speed"])
        plan = f"scene: tiny.yaml\ntarget: {{front_speed: {speed}}}\nevaluations: 1\n{RANGE}"
        self.fit(plan)
        for other in plan.replace("to: 3e-2", "to: 2e-2"), plan.replace(str(speed), str(2 * speed)):
            self.assertIn("another plan", self.fit(other, expect=2)[1])

    def test_bad_plans(self):
        for name, text in (("a.csv", "time,temperature\n0,300\n0,400\n"), ("b.csv", "time,kelvin\n0,300\n1,400\n"),
                           ("c.csv", "time,temperature\n0,300\n1,300\n"), ("d.csv", "time,temperature\n0,300\n1,\n")):
            Path(self.path(name)).write_text(text)
        for target, expected in (
            ("", "needs 'target'"),
            ("target: {}\n", "a target needs front_speed, temperature or masks"),
            ("target: {speed: 1}\n", "unknown key 'speed'"),
            ("target: {front_speed: -1}\n", "a speed above 0"),
            ("target: {front_speed: 3 kg}\n", "a speed above 0"),
            ("target: {temperature: curve.csv}\n", "temperature must be a map"),
            ("target: {temperature: {file: curve.csv}}\n", "a curve needs 'probe'"),
            ("target: {temperature: {file: none.csv, probe: p}}\n", "none.csv"),
            ("target: {temperature: {file: a.csv, probe: p}}\n", "times must ascend"),
            ("target: {temperature: {file: b.csv, probe: p}}\n", "needs columns 'time' and 'temperature'"),
            ("target: {temperature: {file: c.csv, probe: p}}\n", "all temperatures are the same"),
            ("target: {temperature: {file: d.csv, probe: p}}\n", "each with a time and a temperature"),
            ("target: {masks: mask.png}\n", "one run of #"),
            ("target: {masks: '#/mask##.png'}\n", "one run of #"),
            ("target: {front_speed: 1}\nsearch: far\n", "local or global"),
            ("target: {front_speed: 1}\nevaluations: 0\n", "evaluations must be 1 to 10000"),
        ):
            with self.subTest(target):
                self.assertIn(expected, self.fit("scene: tiny.yaml\n" + target + RANGE, expect=2)[1])
        target = "scene: tiny.yaml\ntarget: {front_speed: 1 mm/s}\n"
        self.assertIn("without steps", self.fit(target + f"parameters:\n  {RATE}: [1e-3, 2e-3]\n", expect=2)[1])
        Path(self.path("plan.yaml")).write_text(target + RANGE)
        self.assertIn("belongs to singe fit", self.singe("sweep", self.path("plan.yaml"), expect=2)[1])

    def test_what_a_row_lacks(self):
        """A probe that the scene lacks, or masks of frames that do not exist: the fit fails and says so."""
        self.truth()
        Path(self.path("curve.csv")).write_text("time,temperature\n0,300\n1,400\n")
        _, err = self.fit("scene: tiny.yaml\ntarget: {temperature: {file: curve.csv, probe: q}}\nevaluations: 1\n" + RANGE,
                          expect=1)
        self.assertIn("has no temperatures of probe 'q'", err)
        _, err = self.fit("scene: tiny.yaml\ntarget: {masks: mask##.png}\nevaluations: 1\n" + RANGE, out="g", expect=1)
        self.assertIn("no frame has a mask of this name", err)
