"""The files of a run, which do not depend on threads."""

import json
import os
import shutil
import unittest
from pathlib import Path

from support import COLUMNS, HAS_FFMPEG, VERSION, Case


class Output(Case):
    def test_all_files(self):
        out, err = self.run_scene("o", preview=True)
        names = ["tiny.%04d" % i for i in range(1, 7)]
        self.assertEqual(list(self.plys("o")), [n + ".ply" for n in names])
        self.assertIn("frame 6/6", err)
        top = {"checkpoint.singe", "checkpoint.previous.singe", "frames", "gas", "ply", "run.json", "stats.csv"}
        self.assertEqual(sorted(os.listdir(self.path("o", "frames"))), [n + ".png" for n in names])
        if HAS_FFMPEG:
            top.add("preview.mp4")
            with open(self.path("o", "preview.mp4"), "rb") as file:
                self.assertEqual(file.read(8)[4:], b"ftyp")
            self.assertIn("preview.mp4", out)
        self.assertEqual(set(os.listdir(self.path("o"))), top)
        self.no_temporaries("o")

    def test_stats(self):
        self.run_scene("o")
        rows = self.stats("o")
        self.assertEqual(list(rows[0])[: len(COLUMNS)], COLUMNS)
        self.assertEqual([int(r["frame"]) for r in rows], [1, 2, 3, 4, 5, 6])
        for i, row in enumerate(rows):
            self.assertAlmostEqual(float(row["time"]), i / 24, places=6)
            for value in row.values():
                float(value)
        self.assertEqual(int(rows[0]["particles"]), 13 * 13 + 12 * 12)
        self.assertEqual(int(rows[0]["springs"]), 1440)
        self.assertEqual(float(rows[0]["burnt_fraction"]), 0)
        self.assertGreater(float(rows[-1]["temperature_max"]), 500)
        self.assertGreater(float(rows[-1]["heat_in"]), 0)
        self.assertLess(float(rows[-1]["ledger_error"]), 1e-5)
        self.assertLess(float(rows[-1]["mass_ledger_error"]), 1e-6)

    def test_a_run_that_ignites_nothing_says_so(self):
        cold = "nothing ignited: hottest 20 C, ignition 240 C"
        for sets, said in ((["frames=6"], False), (["sources.0.position=[6, 0, 5 cm]"], True),
                           (["sources=[]"], True), (["sources=[]", "sheets.0.material.mass_rate=0"], False),
                           (["sources=[]", "sheets.0.material.temperature=300 C"], False)):
            with self.subTest(sets):
                _, err = self.run_scene("o", *(word for text in sets for word in ("--set", text)))
                self.assertEqual(f"warning: {cold}" in err, said, err)
                self.assertEqual("misses the sheets" in err, "6, 0" in sets[0], err)
                self.assertEqual("nothing lights the sheets" in err, said and sets[0] == "sources=[]", err)
                if "sources=[]" in sets:
                    self.assertNotIn("mm/s", err)  # nothing has burnt, or all at once
        _, err = self.run_scene("o", "--quiet", "--set", "sources.0.position=[6, 0, 5 cm]")
        self.assertRegex(err, r"^singe: warning: .*misses the sheets.*\nsinge: warning: nothing ignited: .*\n$")

    def test_a_sheet_far_from_the_origin_is_said(self):
        for place, said in (("[0, 0, 50]", False), ("[0, 2000, 0]", True)):
            _, err = self.singe("check", self.scene, "--set", "sources=[]", "--set", "sheets.0.translate=" + place)
            self.assertEqual("tiny.yaml:6:5: the sheet lies 2e+03 m from the origin, where positions are rounded to 0.24 mm"
                             in err, said, err)

    def test_a_blanket_that_contact_keeps_away_is_said(self):
        """Sheets 2 mm apart: within .5 mm and the burning sheet's thickness, 1 mm, is nothing."""
        for contact, distance, said in (("2 mm", "0.5 mm", True), ("2 mm", "1.5 mm", False), ("1 mm", "0.5 mm", False),
                                        ("2 mm", "0", False)):
            _, err = self.singe("check", self.scene, "--set", f"contact={{enabled: yes, thickness: {contact}}}", "--set",
                                "sheets.0.grid.cells=[9, 9]", "--set", "sheets.0.material.smother_distance=" + distance)
            self.assertEqual("tiny.yaml:6:5: the sheet smothers nothing: its smother_distance, 0.5 mm, is less than the 2 mm"
                             in err, said, err)

    def test_ledgers_that_do_not_close(self):
        _, err = self.run_scene("good")
        self.assertNotIn("ledgers", err)
        _, err = self.run_scene("bad", "--set", "pace=1e-6", "--set", "sheets.0.material.temperature=400 K")
        self.assertIn("warning: the ledgers do not close", err)
        self.assertGreater(float(self.stats("bad")[-1]["ledger_error"]), 1e-3)

    def test_a_storm_ends(self):
        """Cells that meet all others in every step stand still in it: a warning names the frame, a column counts. What
        turns over before that crosses nothing: a side may pass through the cell next to its own and leave it again."""
        scene = {"frames": 3, "steps": 2, "sheets": [{"grid": {"size": [0.06, 0.06], "cells": [36, 36]}}],
                 "wind": {"velocity": [1000, 0, 0], "gust": 1000}, "pins": [{"vertices": [0, 36]}],
                 "tearing": False, "solver": {"substeps": 3}}
        Path(self.path("storm.json")).write_text(json.dumps(scene))
        self.assertIn(": good", self.singe("check", self.path("storm.json"))[0])
        _, err = self.singe("run", self.path("storm.json"), "-o", self.path("o"), "--no-preview")
        self.assertEqual(err.count("so all sheets were held still"), 1)
        self.assertIn("warning: in frame 2 contact was too costly in ", err)
        halts = [int(row["contact_halts"]) for row in self.stats("o")]
        self.assertEqual(halts[0], 0)
        self.assertTrue(0 < halts[1] <= 2 and halts[1] <= halts[2] <= 4, halts)
        found, _ = self.singe("verify", self.path("o"))
        self.assertRegex(found, r"pairs of triangles that cross +0\b")

    def test_what_is_torn_out_of_shape(self):
        """Sheets that a plane throws out by many cells are warned of twice: as they begin, and for what came of it."""
        for depth, reported in (("0 m", False), ("0.6 m", True)):
            with self.subTest(depth):
                _, err = self.run_scene("strained", "--set", "frames=2", "--set", "contact={enabled: no}",
                                        "--set", "tearing=no", "--set", "solver={substeps: 3}", "--set",
                                        "colliders=[{kind: plane, rotation: [0, 40, 0], offset: %s}]" % depth)
                self.assertEqual("begin inside it, up to 0." in err, reported)
                self.assertEqual("one edge in a hundred is strained by" in err, reported)

    def test_record(self):
        self.run_scene("o", "--set", "seed=7", "--threads", "2")
        record = self.record("o")
        self.assertEqual(record["program"], "singe")
        self.assertEqual(record["version"], VERSION)
        self.assertEqual(record["result"], "complete")
        self.assertIsNone(record["error"])
        self.assertEqual(record["seed"], 7)
        self.assertEqual(record["threads"], 2)
        self.assertEqual((record["frames"], record["frames_done"]), (6, 6))
        self.assertEqual(record["totals"]["steps"], 10)
        self.assertEqual(record["scene"]["seed"], 7)
        self.assertEqual(record["scene"]["sheets"][0]["grid"]["cells"], [12, 12])
        seconds = record["seconds"]
        self.assertGreater(seconds["dynamics"], 0)
        self.assertLess(seconds["heat"] + seconds["burn"] + seconds["ablate"] + seconds["dynamics"], seconds["wall"])

    def test_default_folder_and_quiet(self):
        out, err = self.singe("run", "tiny.yaml", "--quiet", "--no-preview", "--frames", "2", cwd=self.dir)
        self.assertEqual((out, err), ("", ""))
        self.assertEqual(list(self.plys("out/tiny")), ["tiny.0001.ply", "tiny.0002.ply"])

    def test_same_bytes_for_any_threads(self):
        for threads in "1", "2", "4":
            self.run_scene("t" + threads, "--threads", threads, "--set", "sheets.0.grid.cells=[40, 40]", "--quiet")
        self.assertEqual(len(self.plys("t1")), 6)
        self.assertEqual(self.plys("t1"), self.plys("t2"))
        self.assertEqual(self.plys("t1"), self.plys("t4"))
        self.assertEqual(self.numbers("t1"), self.numbers("t2"))
        self.assertEqual(self.numbers("t1"), self.numbers("t4"))

    def test_locale(self):
        self.run_scene("a", "--quiet")
        self.run_scene("b", "--quiet", env={**os.environ, "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"})
        self.assertEqual(self.numbers("a"), self.numbers("b"))

    def test_second_run_replaces_the_first(self):
        self.run_scene("o", preview=True)
        os.makedirs(self.path("o", "frames"), exist_ok=True)
        for name in "keep.txt", "ply/other.0001.ply", "ply/tiny.1.ply", "frames/tiny.0001.png.bak":
            Path(self.path("o", name)).write_text("mine")
        Path(self.path("o", "ply", "tiny.0003.ply.123-0.tmp")).write_text("half written by a run that was killed")
        _, err = self.run_scene("o", "--frames", "2")
        self.assertIn("of an earlier run", err)
        self.assertEqual(list(self.plys("o")), ["other.0001.ply", "tiny.0001.ply", "tiny.0002.ply", "tiny.1.ply"])
        self.assertEqual(os.listdir(self.path("o", "frames")), ["tiny.0001.png.bak"])
        self.assertTrue(os.path.exists(self.path("o", "keep.txt")))
        self.assertFalse(os.path.exists(self.path("o", "preview.mp4")))
        self.assertEqual(len(self.stats("o")), 2)

    def test_no_ffmpeg(self):
        _, err = self.run_scene("o", "--frames", "2", preview=True, env={**os.environ, "PATH": self.dir})
        self.assertIn("cannot run ffmpeg", err)
        command = next(line.strip() for line in err.splitlines() if line.startswith("  ffmpeg"))
        self.assertFalse(os.path.exists(self.path("o", "preview.mp4")))
        self.assertFalse(self.record("o")["video"])
        if HAS_FFMPEG:
            self.assertEqual(os.system(command), 0)
            self.assertTrue(os.path.exists(self.path("o", "preview.mp4")))

    def test_ffmpeg_that_fails(self):
        """All else is there, the reason is reported even to the quiet, and the exit code is 1."""
        for number, (script, why) in enumerate((
            ("exit 3", "ffmpeg failed (exit 3)"),
            ("kill -9 $$", "ffmpeg was stopped (signal 9)"),
            ("exit 0", "ffmpeg wrote nothing into preview.mp4"),
        )):
            out, env = f"o{number}", self.fake_ffmpeg(script)
            with self.subTest(script):
                _, err = self.run_scene(out, "--frames", "2", "--quiet", preview=True, expect=1, env=env)
                self.assertIn("error: no video: " + why, err)
                self.assertIn("\n  ffmpeg ", err)
                self.assertEqual(set(os.listdir(self.path(out))),
                                 {"checkpoint.singe", "checkpoint.previous.singe", "frames", "gas", "ply", "run.json",
                                  "stats.csv"})
                self.assertEqual((self.record(out)["result"], self.record(out)["video"]), ("complete", False))
                shown, err = self.singe("render", self.path(out), expect=1, env=env)
                self.assertIn("error: no video: " + why, err)
                self.assertNotIn("preview.mp4", shown)
                self.assertEqual(len(os.listdir(self.path(out, "frames"))), 2)

    def test_no_preview_leaves_no_frames(self):
        self.run_scene("o", "--frames", "2")
        self.assertEqual(set(os.listdir(self.path("o"))),
                         {"checkpoint.singe", "checkpoint.previous.singe", "gas", "ply", "run.json", "stats.csv"})
        self.run_scene("o", "--frames", "3", "--resume")
        self.assertFalse(os.path.exists(self.path("o", "frames")))
        self.run_scene("o", "--frames", "2", preview=True)
        self.assertTrue(os.path.exists(self.path("o", "frames")))
        self.run_scene("o", "--frames", "2")
        self.assertFalse(os.path.exists(self.path("o", "frames")))

    @unittest.skipUnless(HAS_FFMPEG, "needs ffmpeg")
    def test_odd_folder_and_size(self):
        self.run_scene("it's 100% %04d: a b", "--frames", "2", "--set", "preview.size=[65, 49]", preview=True)
        self.assertTrue(os.path.exists(self.path("it's 100% %04d: a b", "preview.mp4")))

    def test_names_that_are_no_utf8(self):
        """run.json is good JSON whatever the folders are called, and is found again by it."""
        folder = os.fsencode(self.dir) + b"/f\xff \xc3"
        os.mkdir(folder)
        scene = os.path.join(folder, b"b\xe4r.yaml")
        shutil.copy(self.scene, scene)
        out = os.path.join(folder, b"o\x80")
        self.singe("run", scene, "-o", out, "--frames", "2", "--no-preview", errors="surrogateescape")
        record = json.loads(Path(os.fsdecode(os.path.join(out, b"run.json"))).read_text(encoding="utf-8"))
        self.assertEqual(os.fsencode(record["scene_file"]), scene)
        self.assertEqual(os.fsencode(record["scene_folder"]), os.path.realpath(folder))
        self.assertEqual(record["name"], "b_r")
        self.assertEqual(os.listdir(os.path.join(out, b"ply"))[0][:4], b"b_r.")
        self.singe("verify", out, errors="surrogateescape")
        self.singe("render", out, errors="surrogateescape")
        self.assertEqual(len(os.listdir(os.path.join(out, b"frames"))), 2)

    def test_files_read_back(self):
        """Header of a PLY, and as many bytes as it announces."""
        self.run_scene("o", "--frames", "2")
        data = Path(self.path("o", "ply", "tiny.0002.ply")).read_bytes()
        header = data[: data.index(b"end_header")].decode().split("\n")
        self.assertEqual(header[0], "ply")
        self.assertIn("binary_little_endian", header[1])
        vertices = next(int(line.split()[2]) for line in header if line.startswith("element vertex"))
        self.assertGreaterEqual(vertices, 169)
        for field in ("temperature", "mass", "time_ignited", "piece"):
            self.assertTrue(any(line.startswith("property") and field in line for line in header), field)
