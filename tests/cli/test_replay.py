"""Recordings: singe run --record and singe replay."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from support import ROOT, Case

FULL = "/dev/full"
MINIMISE = os.path.join(ROOT, "tests", "fuzz", "minimise.py")


class Replay(Case):
    def recorded(self, name="run.singerec", *args):
        path = self.path(name)
        self.run_scene("out-" + name, "--record", path, *args)
        return path

    def changed(self, path, change):
        data = bytearray(Path(path).read_bytes())
        other = self.path("changed")
        Path(other).write_bytes(change(data))
        return other

    def records(self, data):
        """(offset, kind, size) of each record."""
        at = 32
        while at < len(data):
            size = int.from_bytes(data[at + 1:at + 9], "little")
            yield at, data[at], size
            at += 9 + size

    def test_a_run_is_the_same_with_and_without_and_again(self):
        self.run_scene("plain")
        path = self.recorded()
        self.assertEqual(self.plys("plain"), self.plys("out-run.singerec"))
        os.remove(self.scene)  # the recording is enough
        for threads in "1", "3":
            out, err = self.singe("replay", path, "--threads", threads)
            self.assertRegex(out, r"^the same: 10 steps, \d+ calls\n$")
            self.assertEqual(err.replace(self.dir, "").count("truncated"), 0)

    def test_what_resumes_is_recorded_from_there_on(self):
        self.run_scene("part", "--frames", "4")
        path = self.path("rest")
        self.run_scene("part", "--resume", "--record", path)
        self.assertIn("the same: 4 steps", self.singe("replay", path)[0])

    def test_the_first_step_that_differs_is_named(self):
        def other_hash(data):
            states = [at for at, kind, _ in self.records(data) if kind == 5]
            data[states[7] + 9 + 8] ^= 1  # the first is of the commit
            return data

        out, _ = self.singe("replay", self.changed(self.recorded(), other_hash), expect=1)
        self.assertEqual(out, "differs first: the state after step 7\n")

    def test_a_killed_run_is_replayed_to_its_end(self):
        self.scene = self.write_scene(frames=1000, cells=8, gas="no")
        path = self.path("killed")
        run = self.start("run", self.scene, "-o", self.path("out"), "--no-preview", "--record", path)
        self.wait_for(lambda: os.path.exists(path) and os.path.getsize(path) > 6000)
        run.send_signal(signal.SIGKILL)
        run.communicate()
        out, err = self.singe("replay", path)
        self.assertRegex(out, "the same: [1-9]")
        self.assertIn("truncated", err)

        # the same where it was cut within a record
        out, err = self.singe("replay", self.changed(path, lambda data: data[:-5]))
        self.assertIn("the same:", out)
        self.assertIn("truncated", err)

    def test_calls_that_do_not_matter_are_left_out(self):
        """A command that fails where a source (18) is added and a step (36) follows."""
        path = self.recorded("run.singerec", "--frames", "2")
        command = [sys.executable, "-c", """if True:
            import sys
            data, at, kinds = open(sys.argv[1], "rb").read(), 32, []
            while at < len(data):
                kinds.append(data[at])
                at += 9 + int.from_bytes(data[at + 1:at + 9], "little")
            sys.exit(3 if 18 in kinds and 36 in kinds[kinds.index(18):] else 0)"""]
        call = [sys.executable, MINIMISE, path]
        done = subprocess.run([*call, *command], capture_output=True, text=True)
        self.assertRegex(done.stdout, r": 2 of \d+ calls, ", done.stderr)
        self.assertEqual([kind for _, kind, _ in self.records(Path(path + ".min").read_bytes()) if kind >= 16], [18, 36])
        done = subprocess.run([*call, "true"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("does not fail", done.stderr)

    def test_other_files_are_refused(self):
        path = self.recorded()
        self.assertIn("not a recording", self.singe("replay", self.scene, expect=2)[1])
        self.assertIn("No such file", self.singe("replay", self.path("none"), expect=2)[1])
        self.assertIn("needs FILE", self.singe("replay", expect=2)[1])

        def format_of(number):
            def change(data):
                data[8] = number
                return data
            return change

        def unknown_call(data):
            data[[at for at, kind, _ in self.records(data) if kind == 36][2]] = 250
            return data

        for number in (0, 1, 99): # 1 had other pins
            error = self.singe("replay", self.changed(path, format_of(number)), expect=2)[1]
            self.assertRegex(error, r"the recording has format %d; singe [0-9.]+ reads format 2" % number)
        self.assertRegex(self.singe("replay", self.changed(path, unknown_call), expect=2)[1],
                         r"the recording is damaged: unknown call 250 at byte \d+")

    def test_a_recording_that_cannot_be_written_is_a_failure(self):
        _, err = self.run_scene("nowhere", "--record", self.path("no", "where"), expect=1)
        self.assertIn("cannot write the recording", err)
        self.assertFalse(os.path.exists(self.path("nowhere")))
        if os.path.exists(FULL):
            _, err = self.run_scene("full", "--record", FULL, expect=1)
            self.assertIn("No space left", err)
            self.assertEqual(self.record("full")["result"], "complete")  # the run itself went on
