# SPDX-License-Identifier: GPL-3.0-or-later
"""Which program a burn runs, and which files it writes and deletes: without Blender."""

import json
import os
import pathlib
import shutil
import stat
import sys
import tempfile
import types
import unittest
from unittest import mock

SOURCE = pathlib.Path(__file__).resolve().parent.parent / "singe_extension"
package = types.ModuleType("singe_extension")  # without its __init__, which needs Blender
package.__path__ = [str(SOURCE)]
sys.modules["singe_extension"] = package
from singe_extension import files, job  # noqa: E402

MADE = """burn.yaml burn.yaml.part log.txt sheet0.ply sheet12-speed.png sheet0-pin.0001.ply collider-0-7f12ab.ply
          collider-3-7f12ab.0120.ply cache/run.json cache/stats.csv cache/events.csv cache/probes.csv cache/burn.usda
          cache/checkpoint.singe cache/checkpoint.previous.singe cache/sheet.png cache/preview.mp4 cache/preview.gif
          cache/cache.lock cache/pictures.lock cache/run.json.12-0.tmp cache/ply/burn.0001.ply
          cache/ply/burn.0002.ply.77-1.tmp cache/ply/burn.12345.ply cache/usd/burn.0001.usdc cache/gas/burn.0001.vdb
          cache/gas_detail/burn.0001.vdb cache/frames/burn.0001.png cache/exr/burn.0001.exr
          cache/checkpoints/burn.0010.singe earlier/run.json earlier/ply/burn.0001.ply""".split()
OTHERS = """notes.txt sheet.ply sheet3.ply sheet3-speed.png collider-0-7f12ac.ply collider-4-7f12ab.0001.ply
            sheet0-pin.12346.ply cache/ply/burn.12346.ply earlier/usd/burn.99999.usdc sheet0.ply.bak mysheet0.ply collider-0.ply cache/notes.txt cache/letter.usda
            cache/run.json.bak cache/ply/letter.0001.ply cache/ply/burn.1.ply cache/ply/burn.0001.usdc
            cache/ply/burn.00012.ply cache/burn.0001.ply cache/old/burn.0001.ply burn.0001.ply""".split()


CACHE = ["cache/run.json", "cache/ply/burn.0001.ply", "cache/checkpoint.singe"]


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="singe-test-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)
        self.folder = self.dir / "cache" / "preview"

    def fill(self, names, frames=12345):
        """Files with these names, in a folder whose run.json and burn.yaml list the inputs and frames of a burn."""
        scene = {"name": "burn", "frames": frames, "sheets": [{"mesh": "sheet0.ply"}, {"mesh": "sheet12.ply"}],
                 "pins": [{"motion": {"mesh": "sheet0-pin.####.ply"}}], "rate": {"texture": "sheet12-speed.png"},
                 "colliders": [{"mesh": "collider-0-7f12ab.ply"}, {"motion": {"mesh": "collider-3-7f12ab.####.ply"}}]}
        for name in names:
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.name == "run.json":
                path.write_text(json.dumps({"frames": frames, "scene": scene}))
            elif name == "burn.yaml":
                path.write_text((files.MARK if path.exists() else "x") + json.dumps(scene))
            else:
                path.write_text("x")

    def left(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if not path.is_dir())


class Free(Case):
    def test_all_that_a_burn_writes(self):
        files.take(str(self.folder))
        self.fill(MADE)
        self.assertEqual(files.free(str(self.folder)), len(MADE))
        self.assertFalse(self.folder.exists())
        self.assertTrue(self.folder.parent.exists())

    def test_a_cache_is_set_aside_for_a_branch(self):
        files.take(str(self.folder))
        self.fill(CACHE)
        files.set_aside(str(self.folder))
        self.assertEqual(self.left(), sorted(["burn.yaml"] + [name.replace("cache", "earlier") for name in CACHE]))
        self.fill(["cache/run.json"])  # refused before its first checkpoint
        files.put_back(str(self.folder))
        self.assertEqual(self.left(), sorted(["burn.yaml"] + CACHE))

        files.set_aside(str(self.folder))
        self.fill(CACHE + ["earlier/notes.txt"])  # it has begun
        files.put_back(str(self.folder))
        self.assertEqual(self.left(), sorted(["burn.yaml", "earlier/notes.txt"] + CACHE))

    def test_a_link_is_not_set_aside(self):
        files.take(str(self.folder))
        other = self.dir / "other"
        other.mkdir()
        (other / "run.json").write_text("x")
        for name in "cache", "earlier":
            (self.folder / name).symlink_to(other)
            with self.assertRaisesRegex(files.FolderError, "symbolic link"):
                files.set_aside(str(self.folder))
            files.put_back(str(self.folder))
            (self.folder / name).unlink()
        self.assertEqual((other / "run.json").read_text(), "x")

    def test_nothing_else(self):
        files.take(str(self.folder))
        self.fill(MADE + OTHERS)
        files.free(str(self.folder))
        self.assertEqual(self.left(), sorted(OTHERS))

    def test_a_folder_that_the_user_had(self):
        """Even one whose files have the names that a burn gives."""
        self.fill(MADE + OTHERS)
        self.assertEqual(files.free(str(self.folder)), 0)
        self.assertEqual(self.left(), sorted(MADE + OTHERS))

    def test_what_run_json_does_not_list(self):
        """Frames after the run's last, and all frames and tables of a folder whose run.json lists nothing."""
        for record in ("", "[]", "x", "[" * 100000, '{"scene": 3}', '{"scene": {"name": "burn"}}',
                       '{"scene": {"name": "letter", "frames": 12345}}', '{"scene": {"name": "burn", "frames": "9"}}', None):
            files.take(str(self.folder))
            self.fill([name for name in MADE if not name.startswith("earlier")])
            if record is None:
                (self.folder / "cache" / "run.json").unlink()
            else:
                (self.folder / "cache" / "run.json").write_text(record)
            files.free(str(self.folder))
            left = {name for name in self.left() if name.startswith("cache/ply/burn.") and not name.endswith(".tmp")}
            self.assertEqual(left, {"cache/ply/burn.0001.ply", "cache/ply/burn.12345.ply"}, record)
            self.assertFalse((self.folder / "cache" / "ply" / "burn.0002.ply.77-1.tmp").exists())
            self.assertEqual((self.folder / "cache" / "stats.csv").exists(), '"burn"' not in (record or ""))
            shutil.rmtree(self.folder)

    def test_inputs_that_no_scene_names(self):
        files.take(str(self.folder))
        self.fill(["burn.yaml", "sheet0.ply", "sheet1.ply", "sheet0-pin.0003.ply", "collider-3-7f12ab.0004.ply"], 3)
        self.assertEqual(files.inputs(str(self.folder)), {"sheet0.ply", "sheet0-pin.0003.ply"})
        files.free(str(self.folder))
        self.assertEqual(self.left(), ["collider-3-7f12ab.0004.ply", "sheet1.ply"])

    def test_no_folder(self):
        self.assertEqual(files.free(str(self.dir / "nowhere")), 0)

    def test_folders_with_names_of_files(self):
        files.take(str(self.folder))
        self.fill(["log.txt/mine", "cache/ply/burn.0001.ply/mine"])
        files.free(str(self.folder))
        self.assertEqual(self.left(), ["cache/ply/burn.0001.ply/mine", "log.txt/mine"])

    @unittest.skipIf(sys.platform == "win32", "needs symbolic links")
    def test_links(self):
        """A folder that came with a .blend file may lead elsewhere: only links go."""
        elsewhere = self.dir / "elsewhere"
        (elsewhere / "ply").mkdir(parents=True)
        for name in ("run.json", "ply/burn.0001.ply", "log.txt"):
            (elsewhere / name).write_text("mine")
        for link, target in (("cache", elsewhere), ("cache/ply", elsewhere / "ply")):
            with self.subTest(link):
                files.take(str(self.folder))
                (self.folder / link).parent.mkdir(exist_ok=True)
                (self.folder / link).symlink_to(target)
                (self.folder / "log.txt").symlink_to(elsewhere / "log.txt")
                files.free(str(self.folder))
                self.assertEqual(sum(path.is_file() for path in elsewhere.rglob("*")), 3)
                self.assertFalse(os.path.lexists(self.folder / "log.txt"))
                if (self.folder / link).is_symlink():
                    (self.folder / link).unlink()
        self.folder.mkdir(exist_ok=True)
        (elsewhere / "burn.yaml").write_text(files.MARK)
        shutil.rmtree(self.folder)
        self.folder.symlink_to(elsewhere)
        self.assertEqual(files.free(str(self.folder)), 0)
        self.assertTrue((elsewhere / "log.txt").exists())


class Take(Case):
    def test_again(self):
        files.take(str(self.folder))
        self.fill(MADE)
        files.take(str(self.folder))
        self.assertTrue(files.is_own(str(self.folder)))

    def test_a_folder_of_others(self):
        self.fill(["log.txt"])
        with self.assertRaisesRegex(files.FolderError, "did not write"):
            files.take(str(self.folder))
        self.assertEqual(self.left(), ["log.txt"])

    def test_a_file(self):
        self.folder.parent.mkdir()
        self.folder.write_text("mine")
        with self.assertRaisesRegex(files.FolderError, "is not a folder: choose"):
            files.take(str(self.folder))

    @unittest.skipIf(sys.platform == "win32", "needs symbolic links")
    def test_links(self):
        for link in (self.folder, self.folder / "cache", self.folder / "cache" / "ply"):
            with self.subTest(link):
                shutil.rmtree(self.folder, ignore_errors=True)
                link.parent.mkdir(parents=True, exist_ok=True)
                link.symlink_to(self.dir)
                with self.assertRaisesRegex(files.FolderError, "symbolic link"):
                    files.take(str(self.folder))
                link.unlink()

    @unittest.skipIf(sys.platform == "win32", "needs symbolic links")
    def test_writes_through_no_link(self):
        mine = self.dir / "mine"
        mine.write_text("mine")
        (self.dir / "log.txt").symlink_to(mine)
        with files.create(str(self.dir / "log.txt")) as file:
            file.write(b"burning")
        self.assertEqual(mine.read_text(), "mine")
        self.assertEqual((self.dir / "log.txt").read_text(), "burning")

    def test_errors_are_sentences(self):
        (self.dir / "file").write_text("mine")
        for call in (lambda: files.take(str(self.dir / "file" / "burn")),
                     lambda: files.create(str(self.dir / "file" / "log.txt"))):
            with self.assertRaises((files.FolderError, OSError)) as raised:
                call()
            said = files.sentence(raised.exception)
            self.assertEqual(files.sentence(RuntimeError("Error: no such file\n")), "no such file")
            self.assertEqual(files.sentence(ReferenceError()), "ReferenceError")
            self.assertNotIn("Errno", said)
            self.assertRegex(said.lower(), "not a (folder|directory)")


class Read(Case):
    @unittest.skipIf(sys.platform == "win32", "needs pipes")
    def test_no_pipe_is_waited_for(self):
        cache = self.dir / "cache"
        cache.mkdir()
        for name in ("run.json", "stats.csv", "burn.usda", "burn.yaml"):
            os.mkfifo(cache / name)
            with self.assertRaisesRegex(OSError, "not a regular file"):
                files.read(str(cache / name))
        self.assertEqual(job.frames_in(str(cache)), 0)
        self.assertEqual(job.root_frames(str(cache / "burn.usda")), 0)
        self.assertIsNone(job.root_of(str(cache)))
        self.assertFalse(files.is_own(str(cache)))

    def test_nothing_controls_a_terminal(self):
        self.assertEqual(files.sentence(RuntimeError("'\x1b[31mGröße\n'")), "'?[31mGröße\n'")
        self.assertNotIn("\x1b", files.sentence(FileNotFoundError(2, "No such file", "\x1b]0;x\x07")))


class Program(Case):
    def setUp(self):
        super().setUp()
        self.program = self.dir / ("singe.exe" if sys.platform == "win32" else "singe")
        self.program.write_text("#!/bin/sh\n")
        self.program.chmod(0o755)
        find = mock.patch.object(job.importlib.util, "find_spec", lambda name: None)
        find.start()
        self.addCleanup(find.stop)
        self.addCleanup(os.chdir, os.getcwd())

    def find(self, chosen="", **environment):
        with mock.patch.dict(os.environ, {"PATH": "", **environment}):
            if "SINGE_PROGRAM" not in environment:
                os.environ.pop("SINGE_PROGRAM", None)
            return job.find_program(chosen)

    def test_chosen(self):
        self.assertEqual(self.find(str(self.program)), str(self.program))
        self.assertEqual(self.find(SINGE_PROGRAM=str(self.program)), str(self.program))
        self.assertEqual(self.find(PATH=str(self.dir)), str(self.program))

    def test_no_folder_of_the_blend_file(self):
        """The folder of the .blend file may be the current one, and // is short for it."""
        os.chdir(self.dir)
        for chosen, environment in (("singe", {}), ("//singe", {}),
                                    ("", {"PATH": os.pathsep.join(("", "."))}),
                                    ("", {})):
            with self.subTest(chosen, **environment), self.assertRaises(job.ProgramError):
                self.find(chosen, **environment)

    def test_no_value_of_a_blend_file(self):
        """The settings that a .blend file saves name no program."""
        settings = (SOURCE / "properties.py").read_text()
        scene, preferences = settings.split("class Preferences(bpy.types.AddonPreferences)")
        self.assertNotIn("program:", scene)
        self.assertIn("program:", preferences)
        for path in SOURCE.glob("*.py"):
            self.assertNotRegex(path.read_text(), r"scene\.singe\.program|rmtree|removedirs|shell=True", path.name)

    def test_wheel(self):
        inside = self.dir / "bin"
        inside.mkdir()
        self.program.rename(inside / "singe").chmod(0o644)
        found = types.SimpleNamespace(origin=str(self.dir / "__init__.py"))
        with mock.patch.object(job.importlib.util, "find_spec", lambda name: found):
            self.assertEqual(self.find(), str(inside / "singe"))
        self.assertTrue(os.stat(inside / "singe").st_mode & stat.S_IXUSR)


class Root(Case):
    def test_record(self):
        """A cache is data of strangers, too: it names no file outside, and damage is no traceback."""
        cache = self.dir / "cache"
        cache.mkdir()
        (self.dir / "evil.usda").write_text("#usda 1.0")
        (cache / "burn.usda").write_text("#usda 1.0")
        good = {"scene": {"name": "burn", "fps": 24}}
        bad = [{"name": "../evil", "fps": 24}, {"name": "burn"}, {"name": 3, "fps": 24}, {"name": "burn", "fps": []},
               {}, None]
        for record, found in ((good, True), ([], False), ({}, False), *(({"scene": scene}, False) for scene in bad)):
            with self.subTest(record):
                (cache / "run.json").write_text(json.dumps(record))
                self.assertEqual(job.root_of(str(cache)) is not None, found)
        deep, whole = "[" * 100000, '{"scene": {"name": "burn", "fps": %s}}'
        for text in (deep, '{"scene": ' + deep, whole % ("9" * 400), whole % "1e999", whole % "NaN", whole % -24, "\xff"):
            with self.subTest(text[:40]):
                (cache / "run.json").write_text(text, encoding="latin-1")
                self.assertIsNone(job.root_of(str(cache)))


if __name__ == "__main__":
    unittest.main()
