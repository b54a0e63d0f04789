"""Standard streams that are closed, full or gone: no file of the run takes the place of one, and a result that cannot be
printed is a failure."""

import itertools
import os
import subprocess

from support import SINGE, Case


def closed(*descriptors):
    def close():
        for fd in descriptors:
            os.close(fd)
    return close


class Streams(Case):
    def code(self, *args, **options):
        options.setdefault("stdin", subprocess.DEVNULL)
        options.setdefault("stdout", subprocess.DEVNULL)
        options.setdefault("stderr", subprocess.DEVNULL)
        return subprocess.run([SINGE, *args], timeout=120, **options).returncode

    def test_a_table_into_a_pipe(self):
        """A pipe without a reader is not waited for; one with a reader gets the table."""
        self.run_scene("o", "--quiet", "--frames", "2")
        pipe = self.path("pipe")
        os.mkfifo(pipe)
        _, err = self.singe("verify", self.path("o"), "--csv", pipe, expect=1, timeout=20)
        self.assertIn("cannot write", err)
        reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, reader)
        self.singe("verify", self.path("o"), "--csv", pipe, timeout=20)
        self.assertTrue(os.read(reader, 4096).startswith(b"frame,vertices"))

    def test_every_combination(self):
        self.scene = self.write_scene(frames=3)
        self.run_scene("whole", "--quiet", preview=True)
        for count in range(4):
            for fds in itertools.combinations(range(3), count):
                with self.subTest(closed=fds):
                    out = "o" + "".join(map(str, fds))
                    code = self.code("run", self.scene, "-o", self.path(out), preexec_fn=closed(*fds))
                    # the folder's name, which run prints at its end, has nowhere to go
                    self.assertEqual(code, 1 if 1 in fds else 0)
                    self.assertEqual(self.record(out)["result"], "complete")
                    self.assertEqual(self.plys(out), self.plys("whole"))
                    self.assertEqual(self.numbers(out), self.numbers("whole"))
                    self.assertEqual(sorted(os.listdir(self.path(out, "frames"))),
                                     sorted(os.listdir(self.path("whole", "frames"))))
                    self.assertEqual(self.code("run", self.scene, "-o", self.path(out), "--quiet", "--resume",
                                               "--no-preview", preexec_fn=closed(*fds)), 0)

    def test_results_that_cannot_be_written(self):
        self.run_scene("o", "--quiet", "--frames", "2")
        commands = [["--version"], ["run", "--help"], ["check", self.scene], ["verify", self.path("o")],
                    ["measure", self.path("o"), "--frames", "1"],
                    ["run", self.scene, "-o", self.path("p"), "--no-preview", "--frames", "1"],
                    ["render", self.path("o"), "--sheet", "2x1"]]
        for args in commands:
            with self.subTest(args=args):
                self.assertEqual(self.code(*args, preexec_fn=closed(1)), 1)
                with open("/dev/full", "w") as full:
                    self.assertEqual(self.code(*args, stdout=full), 1)

    def test_messages_that_cannot_be_written(self):
        """Lost messages change nothing else."""
        with open("/dev/full", "w") as full:
            self.assertEqual(self.code("run", self.scene, "-o", self.path("o"), "--no-preview", stderr=full), 0)
            self.assertEqual(self.code("run", self.path("nothing.yaml"), stderr=full), 2)
        self.assertEqual(len(self.plys("o")), 6)
        self.assertEqual(self.code("run", self.path("nothing.yaml"), preexec_fn=closed(2)), 2)
