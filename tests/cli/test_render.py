"""Pictures drawn again from a cache."""

import hashlib
import json
import os
import resource
import shutil
import struct
import subprocess
import unittest
from pathlib import Path

import exr
from support import HAS_EXR, HAS_FFMPEG, SANITIZED, SINGE, Case, at_most


def png_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", head[16:24])


def digest(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def murmur(text):
    """MurmurHash3, 32 bits, seed 0 (Appleby), with an exponent that is neither 0 nor 255, as Cryptomatte asks."""
    data, mask, h = text.encode(), 0xffffffff, 0
    whole = len(data) // 4 * 4
    for at in range(0, len(data), 4):
        k = int.from_bytes(data[at : at + 4], "little") * 0xcc9e2d51 & mask
        h ^= ((k << 15 | k >> 17) & mask) * 0x1b873593 & mask
        if at < whole:
            h = ((h << 13 | h >> 19) & mask) * 5 + 0xe6546b64 & mask
    h ^= len(data)
    h = (h ^ h >> 16) * 0x85ebca6b & mask
    h = (h ^ h >> 13) * 0xc2b2ae35 & mask
    h ^= h >> 16
    return h ^ 1 << 23 if h >> 23 & 255 in (0, 255) else h


class Render(Case):
    def png(self, frame, out="o"):
        return self.path(out, "frames", "tiny.%04d.png" % frame)

    def setUp(self):
        super().setUp()
        self.once("o", lambda out: self.run_scene(out, "--quiet", preview=True), changes=True)

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
        self.singe("render", self.path("o"), "--frames", "2-3", "--exr", "--set", "preview.camera.aperture=10 cm",
                   "--set", "preview.shutter=0.5", "--set", "preview.ground.kind=stone")
        self.assertEqual(sorted(os.listdir(self.path("o", "exr"))), ["tiny.0002.exr", "tiny.0003.exr"])
        with open(self.path("o", "exr", "tiny.0002.exr"), "rb") as file:
            head = file.read(4000)
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

    @unittest.skipUnless(HAS_EXR and not SANITIZED, "no limit of memory under sanitizers")
    def test_memory_of_layers_is_foreseen(self):
        """17 million pixels take 2.7 GB, and 5.4 with their layers."""
        limited = at_most(resource.RLIMIT_DATA, 4 << 30)
        wide = ("--set", "preview.size=[4096, 4096]", "--set", "preview.samples=1")
        for command in (["render", self.path("o"), *wide], ["run", self.path("o"), "-o", self.path("p"), *wide]):
            _, err = self.singe(*command, "--exr", expect=2, preexec_fn=limited)
            self.assertIn("needs about 5.5 GB of memory, and there are 4.3 GB: give its pictures fewer pixels than 4096 x "
                          "4096 (preview.size), or leave out --exr", err)
        self.assertFalse(os.path.exists(self.path("o", "exr")) or os.path.exists(self.path("p")))
        command = [SINGE, "render", self.path("o"), *wide, "--frames", "1", "-o", self.path("p")]
        with subprocess.Popen(command, preexec_fn=limited, stderr=subprocess.PIPE, text=True) as drawing:
            with self.assertRaises(subprocess.TimeoutExpired):  # it draws
                drawing.wait(1)
            drawing.kill()

    @unittest.skipUnless(HAS_EXR, "built without EXR")
    def test_mattes(self):
        """Cryptomatte layers: numbers of names that the manifest has, whose shares are what sheets cover of a pixel."""
        self.assertEqual(murmur("hello"), 0x248bfa47)
        self.singe("render", self.path("o"), "--frames", "2", "--exr", "--set", "preview.samples=16")
        path = self.path("o", "exr", "tiny.0002.exr")
        _, _, image = exr.read(path)
        _, _, attributes = exr.header(path)
        partly = 0
        for layer in ("CryptoSheet", "CryptoPiece"):
            key = "cryptomatte/%07x/" % (murmur(layer) >> 4)
            self.assertEqual(attributes[key + "name"], layer.encode())
            self.assertEqual(attributes[key + "hash"], b"MurmurHash3_32")
            self.assertEqual(attributes[key + "conversion"], b"uint32_to_float32")
            names = json.loads(attributes[key + "manifest"])
            self.assertTrue(names)
            for name, number in names.items():
                self.assertEqual(int(number, 16), murmur(name), name)
                self.assertEqual("/" in name, layer == "CryptoPiece", name)
            known, met = {int(number, 16) for number in names.values()}, set()
            pairs = [(layer + "%02d." % (k // 2) + "RB"[k % 2], layer + "%02d." % (k // 2) + "GA"[k % 2]) for k in range(4)]
            for i, covered in enumerate(image["coverage.Y"]):
                shares = [image[share][i] for _, share in pairs]
                self.assertEqual(shares, sorted(shares, reverse=True))
                self.assertAlmostEqual(sum(shares), covered, delta=2e-3)  # a half
                partly += 0 < shares[0] < 1
                for number, share in pairs:
                    if image[share][i] > 0:
                        met.add(struct.unpack("<I", struct.pack("<f", image[number][i]))[0])
            self.assertEqual(met, known)
        self.assertGreater(partly, 20)  # edges are smooth

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
        Path(self.path("empty", "run.json")).write_text("{}")
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
