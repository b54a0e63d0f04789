"""The examples in Python run, and say what they should; those whose packages are not installed are left out."""

import importlib.util
import os
import re
import subprocess
import sys

from support import ROOT, Case

PACKAGES = {"burn_and_plot": ["matplotlib"], "study": ["matplotlib", "tqdm"], "fit": ["matplotlib", "scipy"]}


def there(example):
    return all(importlib.util.find_spec(name) for name in PACKAGES[example])


class Examples(Case):
    def run_example(self, name):
        """The numbers that it prints; its picture must be a PNG."""
        if not there(name):
            self.skipTest(f"needs {' and '.join(PACKAGES[name])}")
        picture = self.dir / "picture.png"
        done = subprocess.run([sys.executable, str(ROOT / f"docs/samples/{name}.py"), str(picture)], text=True,
                              capture_output=True, timeout=600, env={**os.environ, "PYTHONPATH": str(ROOT / "bindings/python")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
        return [float(number) for number in re.findall(r"[0-9.]+", done.stdout)]

    def test_burn_and_plot(self):
        burnt, hottest = self.run_example("burn_and_plot")
        self.assertTrue(10 < burnt < 40 and 900 < hottest < 1600)

    def test_study(self):
        speeds = self.run_example("study")
        self.assertEqual(len(speeds), 5)
        self.assertEqual(speeds, sorted(speeds, reverse=True))  # a heavier paper burns more slowly
        self.assertTrue(1.5 < speeds[0] / speeds[-1] < 4)

    def test_fit(self):
        found, was, off = self.run_example("fit")
        self.assertAlmostEqual(found, was, delta=0.05 * was)
        self.assertLess(off, 0.05)  # the noise has 0.03 s


if not any(map(there, PACKAGES)):
    sys.exit(77)
