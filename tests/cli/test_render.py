"""Pictures drawn again from a cache."""

import hashlib
import os
import shutil
import struct
import unittest

from support import HAS_EXR, HAS_FFMPEG, HAS_PREVIEW, Case


def png_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", head[16:24])


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


@unittest.skipUnless(HAS_PREVIEW, "built without the preview")
class Render(Case):
    def png(self, frame, out="o"):
        return self.path(out, "frames", "tiny.%04d.png" % frame)

    def setUp(self):
        super().setUp()
        self.run_scene("o", "--quiet", preview=True)

    def test_same_pictures_again(self):
        before = [digest(self.png(i)) for i in range(1, 7)]
        shutil.rmtree(self.path("o", "frames"))
        if HAS_FFMPEG:
            os.remove(self.path("o", "preview.mp4"))
        self.singe("render", self.path("o"), "--threads", "2")
        self.assertEqual([digest(self.png(i)) for i in range(1, 7)], before)
        self.assertEqual(os.path.exists(self.path("o", "preview.mp4")), HAS_FFMPEG)

    def test_set_and_range(self):
        before = [digest(self.png(i)) for i in range(1, 7)]
        self.singe("render", self.path("o"), "--frames", "2-3", "--set", "preview.size=[80, 40]")
        self.assertEqual(png_size(self.png(2)), (80, 40))
        self.assertEqual(png_size(self.png(3)), (80, 40))
        self.assertEqual([digest(self.png(i)) for i in (1, 4, 5, 6)], [before[i - 1] for i in (1, 4, 5, 6)])

    def test_sheet(self):
        self.singe("render", self.path("o"), "--sheet", "3x2", "--quiet")
        self.assertEqual(png_size(self.path("o", "sheet.png")), (192, 96))

    def test_only_sheet(self):
        shutil.rmtree(self.path("o", "frames"))
        self.singe("render", self.path("o"), "--only-sheet", "--sheet", "2x1", "--set", "preview.size=[2000, 100]")
        self.assertEqual(png_size(self.path("o", "sheet.png")), (2 * 666, 33))
        self.assertFalse(os.path.exists(self.path("o", "frames")))

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_exr(self):
        self.singe("render", self.path("o"), "--frames", "2-3", "--exr", "--set", "preview.camera.aperture=1 cm",
                   "--set", "preview.shutter=0.5", "--set", "preview.ground.kind=stone")
        self.assertEqual(sorted(os.listdir(self.path("o", "exr"))), ["tiny.0002.exr", "tiny.0003.exr"])
        with open(self.path("o", "exr", "tiny.0002.exr"), "rb") as file:
            head = file.read(1000)
        self.assertEqual(head[:4], b"\x76\x2f\x31\x01")
        for name in (b"R", b"Z", b"glow.R", b"normal.X", b"temperature.K", b"char.Y", b"coverage.Y", b"id.sheet",
                     b"id.piece"):
            self.assertIn(b"\0" + name + b"\0", b"\0" + head)
        before = [digest(self.png(i)) for i in range(1, 7)]
        self.run_scene("o", "--quiet", "--exr", preview=True)
        self.assertEqual(len(os.listdir(self.path("o", "exr"))), 6)
        self.assertNotEqual([digest(self.png(i)) for i in range(1, 7)], before)
        self.run_scene("o", "--quiet", preview=True)  # an earlier run's layers go with it
        self.assertFalse(os.path.exists(self.path("o", "exr")))

    @unittest.skipUnless(HAS_FFMPEG, "no ffmpeg")
    def test_gif(self):
        out, _ = self.singe("render", self.path("o"), "--frames", "2-5", "--gif")
        self.assertIn("preview.gif", out)
        with open(self.path("o", "preview.gif"), "rb") as file:
            head = file.read(10)
        self.assertEqual(head[:6], b"GIF89a")
        self.assertEqual(struct.unpack("<HH", head[6:]), (64, 48))

    def test_only_sheet_is_alone(self):
        for option in ("--exr", "--gif"):
            self.assertIn("not with " + option,
                          self.singe("render", self.path("o"), "--only-sheet", option, expect=2)[1])

    def test_from_elsewhere(self):
        shutil.move(self.path("o"), self.path("moved"))
        self.singe("render", "moved", "--frames", "1", cwd=self.dir)

        # into a folder of its own, which is made; the cache's pictures stay
        before = [digest(self.png(i, "moved")) for i in range(1, 7)]
        self.singe("render", "moved", "--frames", "2", "-o", "a/shot", "--set", "preview.size=[80, 40]", cwd=self.dir)
        self.assertEqual(os.listdir(self.path("a", "shot")), ["frames"])
        self.assertEqual(png_size(self.png(2, "a/shot")), (80, 40))
        self.assertEqual([digest(self.png(i, "moved")) for i in range(1, 7)], before)
        self.assertIn("expected a folder", self.singe("render", "moved", "-o", "", cwd=self.dir, expect=2)[1])

    def test_bad_caches(self):
        self.assertIn("run.json", self.singe("render", self.path("none"), expect=2)[1])
        os.mkdir(self.path("empty"))
        with open(self.path("empty", "run.json"), "w") as file:
            file.write("{}")
        self.assertIn("not the record of a run", self.singe("render", self.path("empty"), expect=2)[1])
        self.assertIn("1-6", self.singe("render", self.path("o"), "--frames", "5-9", expect=2)[1])
        with open(self.path("o", "ply", "tiny.0004.ply"), "r+b") as file:
            file.truncate(500)
        self.assertIn("tiny.0004.ply", self.singe("render", self.path("o"), expect=2)[1])
        shutil.rmtree(self.path("o", "ply"))
        self.assertIn("no frames", self.singe("render", self.path("o"), expect=2)[1])

    def test_bad_set(self):
        for bad, word in (("samples=0", "samples"), ("camera.aperture=-1", "aperture"), ("shutter=1.5", "shutter"),
                          ("ground.kind=lava", "wood"), ("environment.kind=disco", "studio"),
                          ("environment.picture=none.png", "none.png")):
            self.assertIn(word, self.singe("render", self.path("o"), "--set", "preview." + bad, expect=2)[1])


class NoRender(Case):
    @unittest.skipIf(HAS_PREVIEW, "built with the preview")
    def test_says_so(self):
        self.run_scene("o", "--quiet")
        self.assertIn("without the preview", self.singe("render", self.path("o"), expect=1)[1])


if __name__ == "__main__":
    unittest.main()
