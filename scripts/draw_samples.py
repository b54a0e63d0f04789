#!/usr/bin/env python3
"""Draws docs/samples/NAME.webp again: what is left when a sample destroys its simulation, seen by singe.draw; if it has
several that end differently, side by side. Needs the static libraries and the Python package of the preset release, a C compiler
and ffmpeg.

usage: draw_samples.py [NAME...]
"""

import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
os.environ.setdefault("SINGE_LIBRARY", str(ROOT / "build/python/singe/libsinge.so"))
sys.path.insert(0, str(ROOT / "bindings/python"))
import singe  # noqa: E402
from singe import picture  # noqa: E402

# in place of singe_sim_destroy: saves the simulation first
HOOK = """
#include <singe/singe.h>
#include <stdio.h>
#include <stdlib.h>
void __real_singe_sim_destroy(SingeSim *sim);
void __wrap_singe_sim_destroy(SingeSim *sim) {
    uint8_t *bytes;
    size_t size;
    if (singe_sim_save(sim, &bytes, &size) == SINGE_OK) {
        static int count;
        char name[600];
        snprintf(name, sizeof name, "%s.%d", getenv("SINGE_SNAPSHOT"), count++);
        FILE *file = fopen(name, "wb");
        if (!file || fwrite(bytes, 1, size, file) != size || fclose(file)) abort();
        singe_sim_free_bytes(sim, bytes, size);
    }
    __real_singe_sim_destroy(sim);
}
"""
SIZE = (320, 240)


def draw(source, work):
    """Builds, runs and draws a sample; False if it has no simulation."""
    program = work / source.stem
    libraries = [ROOT / "build/src/mesh/libsinge_input.a", ROOT / "build/src/libsinge.a"]
    subprocess.run([os.environ.get("CC", "cc"), "-O2", f"-I{ROOT / 'include'}", source, work / "hook.c", *libraries,
                    "-Wl,--wrap=singe_sim_destroy", "-lm", "-pthread", "-o", program], check=True)
    subprocess.run([program], check=True, env={**os.environ, "SINGE_SNAPSHOT": str(program)}, stdout=subprocess.DEVNULL)
    ends = dict.fromkeys(path.read_bytes() for path in sorted(work.glob(f"{source.stem}.[0-9]*")))
    if not ends:
        return False
    panels = []
    for number, end in enumerate(ends):
        width = SIZE[0] * (number + 1) // len(ends) - SIZE[0] * number // len(ends)
        with singe.Sim.load(end) as sim:
            panels.append(singe.draw(sim.surface(), 2 * width, 2 * SIZE[1]))
    pixels = np.concatenate(panels, axis=1)
    small = (pixels[::2, ::2].astype(int) + pixels[1::2, ::2] + pixels[::2, 1::2] + pixels[1::2, 1::2] + 2) // 4
    (work / "picture.png").write_bytes(picture.png(small.astype("uint8")))
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", work / "picture.png", "-quality", "80",
                    ROOT / f"docs/samples/{source.stem}.webp"], check=True)
    return True


def main():
    picture._VIEW[:] = 0.25, -0.8, 0.6  # higher than in notebooks: many samples lie on a table
    names = sys.argv[1:] or [file.stem for file in sorted((ROOT / "docs/samples").glob("*.c")) if file.stem != "live"]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "hook.c").write_text(HOOK)
        for name in names:
            print(name, "drawn" if draw(ROOT / f"docs/samples/{name}.c", work) else "has no picture")


if __name__ == "__main__":
    main()
