"""Folders that cannot be written and disks that are full: exit 1, a message, and what was written stays good."""

import json
import os
import resource
import subprocess
import unittest
from pathlib import Path

from support import SANITIZED, SINGE, Case, at_most


class Failure(Case):
    def test_file_in_the_way(self):
        Path(self.path("file")).write_text("x")
        for out in "file", "file/inside":
            with self.subTest(out):
                _, err = self.run_scene(out, expect=1)
                self.assertIn("file", err)
                self.assertIn("Not a directory", err)

    def test_file_for_ply_folder(self):
        os.mkdir(self.path("o"))
        open(self.path("o", "ply"), "w").close()
        self.assertIn("o/ply", self.run_scene("o", expect=1)[1])

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_unwritable_folder(self):
        os.mkdir(self.path("locked"), 0o555)
        _, err = self.run_scene("locked/o", expect=1)
        self.assertIn("locked/o", err)
        self.assertIn("Permission denied", err)

    def test_read_only_file_system(self):
        if os.path.isdir("/proc/self"):
            _, err = self.singe("run", self.scene, "-o", "/proc/singe-test", "--no-preview", expect=1)
            self.assertIn("/proc/singe-test", err)

    @unittest.skipIf(SANITIZED, "a sanitizer needs files and memory of its own")
    def test_limits_of_a_process_are_named(self):
        """Low limits of open files and of the stack are not blamed on the scene, and low memory is given in MB."""
        def limited(kind, most, expect, *args):
            return self.singe("check", self.scene, *args, expect=expect, preexec_fn=at_most(kind, most))[1]

        for most in 4, 15:
            err = limited(resource.RLIMIT_NOFILE, most, 1)
            self.assertEqual(err, "singe: error: this process may have %d open files (ulimit -n), but singe needs 16\n" % most)
        limited(resource.RLIMIT_NOFILE, 16, 0)
        err = limited(resource.RLIMIT_STACK, 64 << 10, 1)
        self.assertEqual(err, "singe: error: this process may have 64 KiB of stack (ulimit -s), but singe needs 256\n")
        limited(resource.RLIMIT_STACK, 256 << 10, 0)
        err = limited(resource.RLIMIT_DATA, 40 << 20, 2)
        self.assertRegex(err, r"tiny.yaml:6:5: error: the scene needs about \d\d+ MB of memory, but only 42 MB are available")

    def test_stats_in_the_way(self):
        os.makedirs(self.path("o", "stats.csv"))
        self.assertIn("stats.csv", self.run_scene("o", expect=1)[1])

    def limited(self, out, size, *args):
        """Runs with files limited to `size` bytes, as on a disk that fills up."""
        return self.singe("run", self.scene, "-o", self.path(out), "--no-preview", *args, expect=1,
                          preexec_fn=at_most(resource.RLIMIT_FSIZE, size))

    def test_no_space_for_a_frame(self):
        self.run_scene("whole", "--quiet")
        _, err = self.limited("o", 9000)
        self.assertIn("tiny.0001.ply", err)
        self.assertIn("File too large", err)
        self.no_temporaries("o")
        record = self.record("o")
        self.assertEqual(record["result"], "failed")
        self.assertIn("tiny.0001.ply", record["error"]["message"])
        self.assertEqual(self.plys("o"), {})
        # once there is space again, the run can be completed
        self.run_scene("o", "--resume")
        self.assertEqual(self.plys("o"), self.plys("whole"))

    def test_no_space_for_a_line(self):
        """Frames fit, but stats.csv grows too large: its last line is complete."""
        self.scene = self.write_scene(frames=200, steps=1, cells=2, gas="no")
        self.run_scene("whole", "--quiet")
        largest = max(os.path.getsize(self.path("whole", "ply", n)) for n in self.plys("whole"))
        limit = max(largest, os.path.getsize(self.path("whole", "checkpoint.singe")),
                    os.path.getsize(self.path("whole", "run.json")) + 500) + 4096
        self.assertGreater(os.path.getsize(self.path("whole", "stats.csv")), limit + 500, "the test's own premise")
        _, err = self.limited("o", limit)
        self.assertIn("stats.csv", err)
        text = Path(self.path("o", "stats.csv")).read_text()
        self.assertTrue(text.endswith("\n"))
        done = self.record("o")["frames_done"]
        self.assertEqual(len(text.splitlines()), done + 1)
        self.assertEqual(self.record("o")["result"], "failed")
        # the whole frames are those of a run with space, and it can go on
        whole = self.plys("whole")
        for name, digest in list(self.plys("o").items())[:done]:
            self.assertEqual(digest, whole[name])
        self.run_scene("o", "--resume", "--quiet")
        self.assertEqual(self.plys("o"), whole)
        self.assertEqual(self.numbers("o"), self.numbers("whole"))

    def test_full_disk(self):
        """On a small file system, where one can be mounted (as root of a mount namespace of its own)."""
        folder = self.path("small")
        os.mkdir(folder)
        script = (f'mount -t tmpfs -o size=256k none "{folder}" || exit 77; '
                  f'"{SINGE}" run "{self.scene}" -o "{folder}/o" --no-preview --quiet '
                  f'--set "sheets.0.grid.cells=[20, 20]"; '
                  f'code=$?; cat "{folder}/o/run.json"; ls "{folder}/o/ply" >&2; exit $code')
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, timeout=120)
        if done.returncode in (77, 126, 127) or "unshare" in done.stderr:
            self.skipTest("cannot mount a small file system here")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("No space left on device", done.stderr)
        self.assertNotIn(".tmp", done.stderr)
        json.loads(done.stdout)

    def test_closed_standard_error(self):
        """A reader that goes away must not end the run."""
        read, write = os.pipe()
        os.close(read)
        run = subprocess.Popen([SINGE, "run", self.scene, "-o", self.path("o"), "--no-preview"], stderr=write,
                               stdout=subprocess.DEVNULL)
        os.close(write)
        self.assertEqual(run.wait(timeout=60), 0)
        self.assertEqual(len(self.plys("o")), 6)

    def test_a_limit_of_file_sizes_is_a_message(self):
        """The error is reported; the signal that comes with it (SIGXFSZ) does not end the command."""
        limited = at_most(resource.RLIMIT_FSIZE, 0)
        self.run_scene("o", "--quiet")
        self.singe("clean", self.path("o"), "--keep-every", "2", preexec_fn=limited)  # its locks cannot name it
        _, err = self.singe("new", "letter", "-o", self.path("new"), expect=1, preexec_fn=limited)
        self.assertIn("File too large", err)
