"""Many runs of one scene: what rows a plan makes, what a stopped or failed sweep leaves, and what the report says."""

import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import HAS_FFMPEG, SANITIZED, SINGE, Case, write_png

GREY = (b"\x40\x80", b"\xa0\xc0")


class Sweep(Case):
    FRAMES = 4

    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(frames=self.FRAMES, gas="no")

    def write_plan(self, text, name="plan.yaml"):
        Path(self.path(name)).write_text("scene: tiny.yaml\n" + text)
        return self.path(name)

    def sweep(self, *args, out="s", expect=0, preview=False, **options):
        args = list(args) if preview else [*args, "--no-preview"]
        return self.singe("sweep", self.path("plan.yaml"), "-o", self.path(out), *args, expect=expect, **options)

    def rows(self, plan, out="p"):
        """The rows that a plan makes; nothing is run."""
        self.write_plan(plan)
        shutil.rmtree(self.path(out), ignore_errors=True)
        shown, _ = self.sweep("--print", out=out)
        rows = self.table(out, "plan.csv")
        self.assertEqual(len(shown.splitlines()), len(rows))
        self.assertEqual([int(r.pop("row")) for r in rows], list(range(1, len(rows) + 1)))
        return rows

    def complete(self, out="s"):
        return sorted(os.listdir(self.path(out, "rows")))

    # ---- plans

    def test_grid(self):
        rows = self.rows("parameters:\n  pace: [1, 2]\n  sources.0.temperature: {from: 900 C, to: 1 C, steps: 3}\n")
        self.assertEqual([(r["pace"], r["sources.0.temperature"]) for r in rows],
                         [(p, t) for p in "12" for t in ("900 C", "450.5 C", "1 C")])

    def test_list(self):
        rows = self.rows("method: list\nparameters:\n  pace: [1, 2, 4]\n"
                         "  sheets.0.translate: [[0, 0, 1], [0, 0, 5 cm], [1 mm, 0, 2]]\n")
        self.assertEqual([tuple(r.values()) for r in rows],
                         [("1", "[0, 0, 1]"), ("2", "[0, 0, 5 cm]"), ("4", "[1 mm, 0, 2]")])

    def test_ranges(self):
        rows = self.rows("method: list\nparameters:\n  pace: {from: 0.01, to: 100, steps: 5, logarithmic: yes}\n"
                         "  sheets.0.grid.seed: {from: 1, to: 4, steps: 5, whole: yes}\n")
        self.assertEqual([float(r["pace"]) for r in rows], [0.01, 0.1, 1, 10, 100])
        self.assertEqual([r["sheets.0.grid.seed"] for r in rows], ["1", "2", "3", "3", "4"])

    def test_random(self):
        plan = ("method: random\nsamples: 200\nseed: {}\nparameters:\n  pace: {{from: 1, to: 3}}\n"
                "  sheets.0.grid.seed: {{from: 1, to: 4, whole: yes}}\n  contact.enabled: [yes, no]\n")
        rows, again, other = (self.rows(plan.format(seed)) for seed in (7, 7, 8))
        self.assertEqual(rows, again)
        self.assertNotEqual(rows, other)
        pace = [float(r["pace"]) for r in rows]
        self.assertTrue(all(1 <= p <= 3 for p in pace))
        self.assertAlmostEqual(sum(pace) / 200, 2, delta=0.15)
        for key, values in (("sheets.0.grid.seed", "1234"), ("contact.enabled", ("yes", "no"))):
            counts = [sum(r[key] == v for r in rows) for v in values]
            self.assertEqual(sum(counts), 200)
            self.assertGreater(min(counts), 200 / len(values) * 0.6)

    def test_latin_hypercube(self):
        rows = self.rows("method: latin-hypercube\nsamples: 10\nparameters:\n  pace: {from: 10, to: 20}\n"
                         "  sheets.0.grid.seed: {from: 0, to: 9, whole: yes}\n"
                         "  sources.0.conductance: {from: 1, to: 1024, logarithmic: yes}\n")
        self.assertEqual(sorted(int(float(r["pace"]) - 10) for r in rows), list(range(10)))
        self.assertEqual(sorted(int(r["sheets.0.grid.seed"]) for r in rows), list(range(10)))
        parts = sorted(int(len(bin(int(float(r["sources.0.conductance"])))) - 3) for r in rows)
        self.assertEqual(parts, list(range(10)))
        order = [int(float(r["pace"]) - 10) for r in rows]
        self.assertNotEqual(order, [int(r["sheets.0.grid.seed"]) for r in rows])

    def test_bad_plans(self):
        for text, line, expected in (
            ("method: grd\nparameters: {pace: [1]}\n", 2, "method must be grid, list, random or latin-hypercube, not 'grd'"),
            ("parameters:\n  pace: {from: 1, to: 2 C, steps: 2}\n", 3, "'from' has none and 'to' has C"),
            ("parameters:\n  pace: {from: 1, to: 2}\n", 3, "needs 'steps'"),
            ("parameters:\n  pace: {from: 1, to: 2, steps: 2, stop: 2}\n", 3, "unknown key 'stop'"),
            ("parameters:\n  pace: 3\n", 3, "expected a list of values, or a range"),
            ("parameters:\n  pace: []\n", 3, "expected a list of values, or a range"),
            ("parameters:\n  pace: {from: 0, to: 1, steps: 3, logarithmic: yes}\n", 3, "above 0"),
            ("parameters:\n  pace: {from: nan, to: 1, steps: 3}\n", 3, "expected a number"),
            ("parameters:\n  pace: {from: 0, to: 1, steps: 1}\n", 3, "steps must be 2 to 10000"),
            ("parameters:\n  name: [a, b]\n", 3, "the scene's name"),
            ("method: list\nparameters:\n  pace: [1, 2]\n  fps: [24]\n", 5, "1 here, 2 for the first"),
            ("method: random\nparameters:\n  pace: [1, 2]\n", 1, "needs 'samples'"),
            ("parameters:\n  pace: {from: 1, to: 2, steps: 200}\n  fps: {from: 1, to: 2, steps: 200}\n", 4,
             "more than 10000 rows"),
            ("samples: -1\nparameters: {pace: [1]}\n", 2, "whole number"),
            ("speed: 1\nparameters: {pace: [1]}\n", 2, "unknown key 'speed'"),
            ("set: 1\nparameters: {pace: [1]}\n", 2, "set: expected a map"),
            ("", 1, "needs 'parameters'"),
            ("parameters: {}\n", 2, "expected a map of 1 to 64 keys of the scene"),
            ("method: random\nsamples: many\nparameters: {pace: {from: 1, to: 2}}\n", 3, "whole number"),
            ("parameters:\n  pace: [1, 2]\n  pace: [3]\n", 4, "'pace' is given twice in parameters"),
            ("parameters:\n  pace: {from: 1, to: 2, from: 2, steps: 2}\n", 3, "'from' is given twice in a range"),
            ("set: {fps: 24, fps: 25}\nparameters: {pace: [1]}\n", 2, "'fps' is given twice in set"),
            ("parameters: {pace: [1]}\nscene: tiny.yaml\n", 3, "'scene' is given twice in a plan"),
            ("set: {pace: 3}\nparameters:\n  pace: [1]\n", 4, "'pace' is already set in line 2"),
            ("set: {'sources[0].start': 1}\nparameters:\n  sources.00.start: [1]\n", 4, "is already set"),
            ("set: {gas.cell_size: 1 cm}\nparameters:\n  gas: [no]\n", 4, "'gas' is already set"),
            ("parameters:\n  gas: [no]\n  gas.cell_size: [1 cm]\n", 4, "set the same value"),
            ("parameters:\n  fps: [24]\n  pace: [1, 2, 2.0]\n", 4, "values 2 and 3 are the same: 2.0"),
            ("parameters:\n  pace: [2, 3, \"2\"]\n", 3, "values 1 and 3 are the same"),
            ("parameters:\n  wind.velocity: [[0, 1, 2], [0, 1.0, 2 ]]\n", 3, "values 1 and 2 are the same"),
            ("parameters:\n  sheets.0.grid.seed: {from: 1, to: 4, steps: 5, whole: yes}\n", 3, "values 3 and 4"),
            ("method: list\nparameters:\n  fps: [24, 25, 24]\n  pace: [2, 2, 2.0]\n", 4, "rows 1 and 3 are the same"),
            ("set: {fps: 24, sheets.0.material: newsprint}\nparameters:\n  sheets[0].material.grammage: [0.04]\n", 2,
             "'sheets[0].material.grammage' sets a part of this, so 'set' must give a map (of a material: {base: newsprint})"),
            ("set:\n  sheets.0:\n    material: newsprint\nparameters:\n  sheets.0.material.grammage: [0.04]\n", 4,
             "of a material: {base: newsprint}"),
        ):
            with self.subTest(text):
                self.write_plan(text)
                _, err = self.sweep(expect=2)
                self.assertRegex(err, rf"plan.yaml:{line}:\d+: error: .*" + re.escape(expected))
                self.assertEqual(err.count(": error: "), 1, err)
                self.assertFalse(os.path.exists(self.path("s")))
        Path(self.path("plan.yaml")).write_text("- 1\n")
        self.assertIn("expected a map", self.sweep(expect=2)[1])
        Path(self.path("plan.yaml")).write_text("parameters: {pace: [1]}\n")
        self.assertIn("needs 'scene'", self.sweep(expect=2)[1])
        self.assertIn("No such file", self.singe("sweep", self.path("none.yaml"), expect=2)[1])

    def test_a_parameter_may_be_a_part_of_what_is_set(self):
        rows = self.rows("set: {preview: {size: [32, 24]}, sources.0.start: 0}\n"
                         "parameters:\n  preview.samples: [1, 2]\n  sources.0.end: [1]\n")
        self.assertEqual([r["preview.samples"] for r in rows], ["1", "2"])

    def test_a_plan_shows_no_other_file(self):
        """It may come from a stranger, and its messages may go to one."""
        for number, text in enumerate(("hunter2\nhunter2\n", "hunter2: {\n", "- hunter2\n", "password: hunter2\n")):
            with self.subTest(text), open(self.path("secret"), "w") as file:
                file.write(text)
                file.flush()
                self.write_plan("parameters: {pace: [1]}\n")
                Path(self.path("plan.yaml")).write_text("scene: secret\nparameters: {pace: [1], sheets.0.name: [a]}\n")
                out, err = self.sweep("--print", expect=2)
                self.assertNotIn("hunter2", out + err)
                self.assertIn("secret, which", err)
                self.assertIn("is not a valid scene; `singe check` says why", err)

    def test_a_row_that_is_no_scene_stops_all(self):
        self.write_plan("parameters:\n  pace: [1, 2, -3]\n")
        _, err = self.sweep(expect=2)
        self.assertIn("--set pace=-3", err)
        self.assertIn("row 3", err)
        self.assertFalse(os.path.exists(self.path("s")))

    # ---- rows

    def test_rows_are_runs(self):
        """With the bytes of a run by hand."""
        self.write_plan("set: {steps: 3}\nparameters:\n  pace: [2, 5]\n")
        shown, err = self.sweep()
        self.assertEqual(self.complete(), ["0001", "0002"])
        self.assertEqual(os.listdir(self.path("s", "unfinished")), [])
        self.assertIn("2 of 2 rows are complete", err)
        self.assertEqual(shown.strip(), os.path.realpath(self.path("s", "index.html")))
        for number, pace in (("0001", 2), ("0002", 5)):
            self.run_scene(f"by-hand{pace}", "--set", "steps=3", "--set", f"pace={pace}")
            self.assertEqual(self.plys(f"s/rows/{number}"), self.plys(f"by-hand{pace}"))
            self.assertEqual(self.numbers(f"s/rows/{number}"), self.numbers(f"by-hand{pace}"))
        self.assertNotEqual(self.plys("s/rows/0001"), self.plys("s/rows/0002"))

    def test_rows_branch_from_one_frame(self):
        self.singe("run", self.scene, "-o", self.path("whole"), "--no-preview", "--set", "checkpoints.every=2", "-q")
        self.write_plan("from: whole:2\nparameters:\n  pace: [4, 9]\n")
        self.sweep()
        whole, rows = self.plys("whole"), [self.plys(f"s/rows/{row}") for row in self.complete()]
        self.assertEqual(rows[0], whole)
        self.assertEqual([rows[1][name] == whole[name] for name in sorted(whole)], [True, True, False, False])
        self.write_plan("from: whole:3\nparameters:\n  pace: [4, 9]\n")
        self.sweep(expect=2)  # another plan

    def test_again_does_nothing(self):
        self.write_plan("parameters:\n  pace: [2, 5]\n")
        self.sweep()
        before = {p: os.stat(os.path.join(p, f)).st_mtime_ns for p, _, fs in os.walk(self.path("s", "rows")) for f in fs}
        self.sweep()
        after = {p: os.stat(os.path.join(p, f)).st_mtime_ns for p, _, fs in os.walk(self.path("s", "rows")) for f in fs}
        self.assertEqual(before, after)

    def test_one_row(self):
        self.write_plan("parameters:\n  pace: [2, 5, 7]\n")
        self.sweep("--row", "2")
        self.assertEqual(self.complete(), ["0002"])
        self.assertIn("has 3 rows", self.sweep("--row", "4", expect=2)[1])
        lines = self.sweep("--print")[0].splitlines()
        self.assertEqual([re.search(r"--row (\d+)", line).group(1) for line in lines], ["1", "3"])
        # the first by its line, the last as a task of the job that OpenJD would run
        subprocess.run(["sh", "-c", lines[0]], check=True, capture_output=True, timeout=120)
        job = json.loads(self.sweep("--openjd")[0])
        rows, report = job["steps"]
        self.assertEqual((job["specificationVersion"], job["name"]), ("jobtemplate-2023-09", "plan"))
        parameter = rows["parameterSpace"]["taskParameterDefinitions"][0]
        self.assertEqual((parameter["name"], parameter["type"], parameter["range"]), ("Row", "INT", "3"))
        self.assertEqual(report["dependencies"], [{"dependsOn": rows["name"]}])
        for step in rows, report:
            action = step["script"]["actions"]["onRun"]
            args = [arg.replace("{{Task.Param.Row}}", "3") for arg in action["args"]]
            subprocess.run([action["command"], *args], check=True, capture_output=True, timeout=120)
        self.assertEqual(self.complete(), ["0001", "0002", "0003"])
        self.assertEqual(len(self.table("s", "report.csv")), 3)
        self.assertEqual([step["name"] for step in json.loads(self.sweep("--openjd")[0])["steps"]], ["Report"])
        self.assertIn("exclude each other", self.sweep("--openjd", "--print", expect=2)[1])
        self.assertIn("reserves '{{'", self.sweep("--openjd", out="a {{Task.Param.Row}}", expect=2)[1])

    def test_another_plan_or_scene_is_noticed(self):
        self.write_plan("parameters:\n  pace: [2, 5]\n")
        self.sweep("--row", "1")
        self.write_plan("parameters:\n  pace: [2, 6]\n")
        self.assertIn("another plan: line 3 differs", self.sweep(expect=2)[1])
        self.write_plan("parameters:\n  pace: [2, 5]\n")
        self.write_scene(frames=self.FRAMES, steps=3, gas="no")
        self.assertIn("has changed; use", self.sweep(expect=2)[1])
        self.assertEqual(self.complete(), ["0001"])

    def test_two_sweeps_in_one_folder(self):
        self.write_scene(frames=40, gas="no", steps=20)
        self.write_plan("parameters:\n  pace: [2, 5]\n")
        first = self.begin()
        self.wait_for(lambda: os.path.exists(self.path("s", "unfinished", "0001", "stats.csv")))
        self.assertIn("wait for it to end", self.sweep(expect=1)[1])
        first.terminate()
        self.assertEqual(first.wait(timeout=60), 1)

    def test_a_row_that_runs_elsewhere_is_last(self):
        """It keeps no other row waiting, and runs when its process has gone."""
        self.write_plan("parameters:\n  pace: [2, 5, 7]\n")
        os.makedirs(self.path("s", "unfinished", "0001"))
        with open(self.path("s", "unfinished", "0001", "cache.lock"), "w") as lock:
            fcntl.lockf(lock, fcntl.LOCK_EX)
            sweep = self.begin("--jobs", "1")
            self.wait_for(lambda: os.path.isdir(self.path("s", "rows")) and self.complete() == ["0002", "0003"])
            self.assertIsNone(sweep.poll())
        self.assertEqual(sweep.wait(timeout=60), 0)
        self.assertEqual(self.complete(), ["0001", "0002", "0003"])

    # ---- stopped

    def begin(self, *args):
        sweep = self.start("sweep", self.path("plan.yaml"), "-o", self.path("s"), "--no-preview", *args,
                           start_new_session=True)
        self.addCleanup(sweep.stderr.close)
        self.addCleanup(lambda: sweep.poll() is None and sweep.kill())
        return sweep

    def lines(self, row):
        try:
            return Path(self.path("s", "unfinished", row, "stats.csv")).read_bytes().count(b"\n")
        except FileNotFoundError:
            return 0

    def stop_and_continue(self, stop):
        frames = 16 if SANITIZED else 30
        self.write_scene(frames=frames, steps=12, gas="no")
        self.write_plan("parameters:\n  pace: [2, 5, 9]\n")
        self.once("whole", lambda folder: self.sweep(out=folder))
        sweep = self.begin("--jobs", "2")
        self.wait_for(lambda: self.lines("0001") > 3 and self.lines("0002") > 2)
        stop(sweep)
        self.assertNotEqual(sweep.wait(timeout=60), 0)
        self.assertNotIn("0003", self.complete())
        self.sweep()
        for row in "0001", "0002", "0003":
            self.assertEqual(self.plys(f"s/rows/{row}"), self.plys(f"whole/rows/{row}"))
            self.assertEqual(self.numbers(f"s/rows/{row}"), self.numbers(f"whole/rows/{row}"))
        self.assertEqual(os.listdir(self.path("s", "unfinished")), [])

    def test_ctrl_c(self):
        """As a terminal does: the signal reaches the whole group."""
        self.stop_and_continue(lambda sweep: os.killpg(sweep.pid, signal.SIGINT))
        self.assertIn("continuing from frame", Path(self.path("s", "rows", "0001", "log.txt")).read_text())

    @unittest.skipIf(SANITIZED, "the same code as Ctrl-C runs")
    def test_terminate(self):
        self.stop_and_continue(lambda sweep: sweep.terminate())

    @unittest.skipIf(SANITIZED, "test_killed_rows_resume runs the same code")
    def test_kill(self):
        """Its rows go on by themselves; the next sweep waits for them."""
        self.stop_and_continue(lambda sweep: sweep.kill())

    def test_killed_rows_resume(self):
        def stop(sweep):
            sweep.kill()
            found = subprocess.run(["pgrep", "-f", self.path("s")], capture_output=True, text=True).stdout.split()
            for process in found:
                os.kill(int(process), signal.SIGKILL)

        self.stop_and_continue(stop)

    # ---- failed

    def test_failed_rows(self):
        self.write_plan("parameters:\n  sheets.0.material.mass_rate: [4e-3, {from: 1e-3, to: 2e-3, texture: m.png}, 6e-3]\n")
        Path(self.path("m.png")).write_text("no picture")
        _, err = self.sweep(expect=1)
        self.assertIn("row 2: singe run ended with exit code 2", err)
        self.assertIn("--retry", err)
        self.assertEqual(self.complete(), ["0001", "0003"])
        self.assertIn("m.png", Path(self.path("s", "unfinished", "0002", "log.txt")).read_text())
        self.assertEqual([r["state"] for r in self.table("s", "report.csv")], ["complete", "missing", "complete"])
        write_png(self.path("m.png"), GREY)
        self.assertIn("1 failed", self.sweep(expect=1)[1])  # it is not run again by itself
        before = os.stat(self.path("s", "rows", "0001", "stats.csv")).st_mtime_ns
        self.sweep("--retry")
        self.assertEqual(self.complete(), ["0001", "0002", "0003"])
        self.assertEqual(before, os.stat(self.path("s", "rows", "0001", "stats.csv")).st_mtime_ns)

    def test_a_row_killed_by_the_system(self):
        """As for want of memory: it failed, with the signal."""
        self.write_scene(frames=60, steps=40, gas="no")
        self.write_plan("parameters:\n  pace: [2]\n")
        sweep = self.begin()
        self.wait_for(lambda: self.lines("0001") > 2)
        found = subprocess.run(["pgrep", "-f", "singe run.*" + self.path("s")], capture_output=True, text=True).stdout
        os.kill(int(found.split()[0]), signal.SIGKILL)
        _, err = sweep.communicate(timeout=60)
        self.assertEqual(sweep.returncode, 1)
        self.assertIn("stopped by signal 9", err)

    # ---- the report

    def report(self, out="s"):
        page = Path(self.path(out, "index.html")).read_text(encoding="utf-8")
        found = re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.S)
        return page, json.loads(found.group(1))

    def test_report(self):
        self.write_plan("parameters:\n  pace: [2, 9]\n  sheets.0.picture: [grey.png, 'a<b>&\"c.png']\n")
        for name in 'grey.png', 'a<b>&"c.png':
            write_png(self.path(name), GREY)
        self.sweep("--row", "1")
        self.sweep("--report")
        _, data = self.report()
        self.assertEqual([r["complete"] for r in data["rows"]], [True, False, False, False])
        self.sweep()
        page, data = self.report()
        self.assertNotIn("{{", page)
        self.assertNotIn("a<b>", page)
        self.assertEqual(data["parameters"], ["pace", "sheets.0.picture"])
        self.assertEqual(data["rows"][3]["values"], ["9", '"a<b>&\\"c.png"'])
        units = dict(zip(data["columns"], data["units"]))
        self.assertEqual({units["stats." + name] for name in ("burnt_fraction", "pieces", "mass_ledger_error")}, {""})
        self.assertEqual([units["stats." + name] for name in ("mass", "temperature_max", "heat_in", "ms_gas",
                         "front_speed")], ["kg", "K", "J", "ms", "m/s of the fire's time"])
        table = self.table("s", "report.csv")
        for i, row in enumerate(table):
            stats = self.stats(f"s/rows/{i + 1:04}")[-1]
            self.assertEqual(float(row["stats.mass"]), float("%.9g" % float(stats["mass"])))
            column = data["columns"].index("stats.burnt_fraction")
            self.assertEqual(data["rows"][i]["numbers"][column], float(stats["burnt_fraction"]))
            measured = [r["crease_bend_per_m"] for r in self.table("s", f"rows/{i + 1:04}/measure.csv")]
            values = sorted(float(m) for m in measured if m)
            middle = (values[(len(values) - 1) // 2] + values[len(values) // 2]) / 2
            self.assertAlmostEqual(float(row["measure.crease_bend_per_m"]), middle, delta=1e-5 * abs(middle))
        self.assertGreater(float(table[2]["stats.burnt_fraction"]), float(table[0]["stats.burnt_fraction"]))
        sheet = xml.etree.ElementTree.parse(self.path("s", "sheet.svg"))
        words = " ".join(t for t in sheet.getroot().itertext())
        self.assertIn("pace = 9", words)

    def test_pictures(self):
        self.write_plan("parameters:\n  pace: [2, 9]\n")
        self.sweep(preview=True)
        _, data = self.report()
        for row in data["rows"]:
            self.assertTrue(os.path.exists(self.path("s", row["picture"])))
            if HAS_FFMPEG:
                self.assertTrue(os.path.exists(self.path("s", row["video"])))
        sheet = xml.etree.ElementTree.parse(self.path("s", "sheet.svg")).getroot()
        pictures = [e.get("href") for e in sheet.iter("{http://www.w3.org/2000/svg}image")]
        self.assertEqual(len(pictures), 6)
        for picture in pictures:
            self.assertTrue(os.path.exists(self.path("s", picture)), picture)

    # ---- a farm

    def fake_sbatch(self, code=0):
        os.makedirs(self.path("bin"), exist_ok=True)
        with open(self.path("bin", "sbatch"), "w") as file:
            file.write(f'#!/bin/sh\nfor a; do last=$a; done\necho "$@" >> {self.path("asked")}\n'
                       f"grep -h '^#SBATCH' \"$last\" >> {self.path('asked')}\n"
                       f"bash -n \"$last\" || exit 9\n[ {code} = 0 ] || exit {code}\necho $(wc -l < {self.path('asked')})\n")
        os.chmod(self.path("bin", "sbatch"), 0o755)
        return {**os.environ, "PATH": self.path("bin") + os.pathsep + os.environ["PATH"]}

    def test_slurm(self):
        self.write_plan("parameters:\n  pace: [1, 2, 3, 4, 5, 6]\n")
        self.sweep("--row", "3")
        self.sweep("--slurm", "--max-running", "2", "--slurm-option=--partition=low", "--render-frames", "3",
                   env=self.fake_sbatch())
        asked = Path(self.path("asked")).read_text()
        self.assertIn("#SBATCH --array=1-2,4-6%2\n", asked)
        for option in "--requeue", "--open-mode=append", "--signal=B:TERM@10", "--partition=low":
            self.assertIn(f"#SBATCH {option}\n", asked)
        self.assertIn("#SBATCH --array=0-11\n", asked)  # 6 rows of 4 frames, in parts of 3
        self.assertEqual(len(re.findall(r"--dependency=afterany:\d+ ", asked)), 2)
        render = Path(self.path("s", "slurm", "render.sh")).read_text()
        for task, expected in ((0, None), (4, (3, 1, 3)), (5, (3, 4, 4))):
            script = render.replace(os.path.realpath(SINGE), "echo")
            done = subprocess.run(["bash", "-c", script], env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)},
                                  capture_output=True, text=True)
            if expected is None:
                self.assertEqual((done.returncode, done.stdout), (1, "row 0001 is not complete\n"))
            else:
                row, first, last = expected
                self.assertIn(f"rows/{row:04} --frames {first}-{last} ", done.stdout, done.stderr)

    def sbatch_words(self, line):
        """As Slurm's sbatch reads the rest of an #SBATCH line: to the first blank outside quotes."""
        word, quote, at = "", "", 0
        while at < len(line) and (quote or not line[at].isspace()):
            if line[at] == "\\":
                at += 1
                word += line[at]
            elif quote and line[at] == quote:
                quote = ""
            elif not quote and line[at] in "\"'":
                quote = line[at]
            elif not quote and line[at] == "#":
                break
            else:
                word += line[at]
            at += 1
        return word, line[at:].strip()

    def test_slurm_takes_any_folder(self):
        """Blanks, quotes, # and % of its name, and of the plan's."""
        out = "a \"folder\" of #1's 100%a"
        self.write_plan("parameters:\n  pace: [1, 2]\n", "it's mine.yaml")
        self.singe("sweep", self.path("it's mine.yaml"), "-o", self.path(out), "--no-preview", "--slurm",
                   env=self.fake_sbatch())
        for job in "run", "render", "report":
            with open(self.path(out, "slurm", job + ".sh")) as file:
                lines = [line[len("#SBATCH "):-1] for line in file if line.startswith("#SBATCH")]
            words = [self.sbatch_words(line) for line in lines]
            self.assertEqual([rest for _, rest in words], [""] * len(words))
            options = dict(word[2:].split("=", 1) for word, _ in words if "=" in word)
            self.assertEqual(options["job-name"], f"it's mine-{job}")
            log = options["output"].replace("%%", "%")
            self.assertEqual(log, self.path(out, "slurm", job + ("" if job == "report" else "-%a") + ".log"))

    def test_an_option_of_slurm_is_one_line(self):
        self.write_plan("parameters:\n  pace: [1, 2]\n")
        _, err = self.sweep("--slurm", "--slurm-option=--partition=low\ntouch evil", expect=2, env=self.fake_sbatch())
        self.assertIn("--slurm-option: expected one line", err)
        self.assertFalse(os.path.exists(self.path("s")))

    def test_folders_in_which_slurm_writes_no_log_are_refused(self):
        self.write_plan("parameters:\n  pace: [1, 2]\n")
        for name in "back\\slash", "two\nlines":
            _, err = self.sweep("--slurm", out=name, expect=2, env=self.fake_sbatch())
            self.assertIn("--slurm: expected a folder without backslashes and line breaks, got", err)
        self.assertFalse(os.path.exists(self.path("asked")))

    def test_slurm_refuses(self):
        self.write_plan("parameters:\n  pace: [1, 2]\n")
        self.assertIn("sbatch refused the job", self.sweep("--slurm", expect=1, env=self.fake_sbatch(1))[1])

    def test_a_row_stopped_by_its_scheduler(self):
        """The script passes the signal on, the row leaves a checkpoint, and the next start resumes from it."""
        self.write_scene(frames=30, steps=12, gas="no")
        self.write_plan("parameters:\n  pace: [2]\n")
        self.sweep(out="whole")
        self.sweep("--slurm", env=self.fake_sbatch())
        script = self.path("s", "slurm", "run.sh")
        job = subprocess.Popen(["bash", script], env={**os.environ, "SLURM_ARRAY_TASK_ID": "1"},
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wait_for(lambda: self.lines("0001") > 3)
        job.terminate()  # the shell alone, as --signal=B:TERM does
        self.assertEqual(job.wait(timeout=60), 1)
        with open(self.path("s", "unfinished", "0001", "run.json")) as file:
            self.assertEqual(json.load(file)["result"], "interrupted")
        self.assertFalse(os.path.exists(self.path("s", "unfinished", "0001", "failed.txt")))
        subprocess.run(["bash", script], env={**os.environ, "SLURM_ARRAY_TASK_ID": "1"}, check=True,
                       capture_output=True, timeout=120)
        self.assertEqual(self.plys("s/rows/0001"), self.plys("whole/rows/0001"))
