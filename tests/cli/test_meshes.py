"""Mesh files that are good, hostile, or refer to other files, as `check` meets them."""

import os
import subprocess
import time
import unittest

from hostile import GOOD, HOSTILE, SQUARE, TWO, gltf, struct
from support import SINGE, Case

HAS_ASSIMP = os.environ["SINGE_ASSIMP"] == "1"
OWN = (".obj", ".ply", ".off", ".stl", ".gltf", ".glb")
SANITIZED = os.environ["SINGE_SANITIZED"] == "1"
SECONDS = 30
MEGABYTES = 4000 if SANITIZED else 750


class Meshes(Case):
    def check(self, *names):
        """The code, what was printed, seconds and megabytes of `check` on a scene with these meshes."""
        scene = self.path("mesh.yaml")
        with open(scene, "w") as file:
            file.write("preview: {size: [16, 16], samples: 1}\nsheets:\n")
            for i, name in enumerate(names):
                file.write(f"  - mesh: {name}\n    scale: 0.1\n    translate: [0, 0, {i} cm]\n")
        with open(self.path("printed"), "w+") as printed:
            begin = time.monotonic()
            singe = subprocess.Popen([SINGE, "check", scene], stdout=printed, stderr=printed)
            _, status, usage = os.wait4(singe.pid, 0)  # children's memory, too
            singe.returncode = os.waitstatus_to_exitcode(status)
            seconds = time.monotonic() - begin
            printed.seek(0)
            text = printed.read()
        return singe.returncode, text, seconds, usage.ru_maxrss // 1024

    def files(self, files):
        return {name: file for name, file in files.items() if HAS_ASSIMP or name.endswith(OWN)}

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content)

    def test_good_files_are_read(self):
        files = self.files(GOOD)
        for name, content in files.items():
            self.write(name, content)
        code, text, _, _ = self.check(*files)
        self.assertEqual(code, 0, text)
        for name in files:
            self.assertIn(f"{name}: ", text)

    def test_hostile_files_are_refused(self):
        for name, (content, part) in self.files(HOSTILE).items():
            with self.subTest(name):
                self.write(name, content)
                code, text, seconds, megabytes = self.check(name)
                self.assertEqual(code, 2, text)
                self.assertIn(name, text)
                self.assertIn(part, text)
                self.assertLess(seconds, SECONDS)
                self.assertLess(megabytes, MEGABYTES)
                os.remove(self.path(name))

    def test_files_beside(self):
        data = SQUARE + struct.pack("<6I", *TWO)
        os.mkdir(self.path("in"))
        os.mkdir(self.path("in", "deep"))
        os.mkfifo(self.path("in", "pipe.bin"))
        for place in "out.bin", "in/beside.bin", "in/deep/below.bin":
            with open(self.path(place), "wb") as file:
                file.write(data)
        os.symlink("../out.bin", self.path("in", "link.bin"))
        os.symlink("deep/below.bin", self.path("in", "good.bin"))
        files = {}
        for uri, good in (
            ("beside.bin", True),
            ("deep/below.bin", True),
            ("good.bin", True),
            ("../out.bin", False),
            ("deep/../../out.bin", False),
            ("deep/../beside.bin", False),
            (self.path("out.bin"), False),
            (self.path("in", "beside.bin"), False),
            ("/dev/zero", False),
            ("link.bin", False),
            ("pipe.bin", False),
            ("deep", False),
            ("missing.bin", False),
            ("", False),
        ):
            name = f"in/{len(files)}.gltf"
            files[name] = good
            self.write(name, gltf(buffers=[{"byteLength": len(data), "uri": uri}]))
            if good:
                continue
            with self.subTest(uri):
                code, text, seconds, _ = self.check(name)
                self.assertEqual(code, 2, text)
                self.assertIn(name, text)
                self.assertLess(seconds, SECONDS)
        code, text, _, _ = self.check(*(name for name, good in files.items() if good))
        self.assertEqual(code, 0, text)


if __name__ == "__main__":
    unittest.main()
