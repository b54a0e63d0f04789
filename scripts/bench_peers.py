#!/usr/bin/env python3
"""Compares `singe bench swing` and `drop` with other solvers of cloth in one run on this machine, and prints two tables.

Bullet is compiled from lab/peers if its headers are there (Debian: libbullet-dev), MuJoCo and Blender run where Python has
them (pip install mujoco, and bpy==4.5.* for Python 3.11), NvCloth is compiled where --nvcloth names the folder of its
sources (github.com/NVIDIAGameWorks/NvCloth). Rapier has no cloth. Any other solver takes part by --peer NAME=PROGRAM:
PROGRAM CELLS FRAMES STEPS ITERATIONS OUT drops a sheet of 1 m x 1 m and 0.1 kg, held at two corners beside each other, from
the horizontal without drag or damping, prints the milliseconds of processor time of each frame of 1/24 s on one thread, and
writes the positions of (CELLS + 1)^2 points, row by row, as floats in the machine's order, after each frame.
lab/peers/bullet.cpp is one, to copy for Jolt. With the word `drop` behind these, the sheet falls from 61 cm on a sphere with
a radius of 30 cm that stands on the ground, and on itself.

Strain is that of the grid's edges over all frames; the height is of the points' mean, and its error the largest at .33,
.50 and .67 s against the right motion. Of the drop it is the p99 at the end, and the largest of a frame.

Usage: scripts/bench_peers.py [SINGE] [--cells N] [--nvcloth FOLDER] [--peer NAME=PROGRAM] [--table]
(--table writes docs/performance.md's)
"""
import argparse
import array
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FRAMES = 16
RIGHT = {8: -0.373, 12: -0.486, 16: -0.299}  # frame: height, m
DROP_FRAMES = 48
WORDS = {"Blender": "{} steps, stiffness {}", "NvCloth": "{} step of {} substeps"}
# steps a frame, iterations; of Blender the stiffness, of NvCloth its substeps
SETTINGS = {"Bullet": ((10, 10), (20, 40)), "MuJoCo": ((10, 50), (40, 50)), "Blender": ((10, 1000), (40, 10000)),
            "NvCloth": ((1, 120), (1, 550), (1, 1000))}
DROP_SETTINGS = {"NvCloth": ((1, 100), (1, 130), (1, 200), (1, 400))}
SWING = ("", "--steps 1 --substeps 9 --start 0.63")  # of Singe: its own, and one that is as loose as games are
DROP = ("--steps 3 --substeps 10", "--steps 3 --substeps 16")


def write_table(name, lines):
    """Puts a table into docs/performance.md, between the comments of its name."""
    path = Path(ROOT, "docs", "performance.md")
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    before, rest = path.read_text(encoding="utf-8").split(begin)
    path.write_text(before + "\n\n".join([begin, "\n".join(lines), end]) + rest.split(end)[1], encoding="utf-8")


def strains_of(cells, at):
    """Of all edges, in order; at: coordinates of a frame's points."""
    side = cells + 1
    edges = [(r * side + c, r * side + c + step) for r in range(side) for c in range(side)
             for step, there in ((1, c < cells), (side, r < cells)) if there]
    return sorted(abs(math.dist(at[3 * a:3 * a + 3], at[3 * b:3 * b + 3]) * cells - 1) for a, b in edges)


def p99(strains):
    return 100 * strains[int(0.99 * (len(strains) - 1))]


def frames_of(cells, frames, raw):
    """The coordinates of each frame's points."""
    side = cells + 1
    floats = array.array("f", raw)
    if len(floats) != frames * side * side * 3:
        raise ValueError(f"{len(floats)} numbers, not {frames} frames of {side * side} points")
    return [floats[k * side * side * 3:(k + 1) * side * side * 3] for k in range(frames)]


def measure_swing(cells, raw):
    """(largest, p99 and mean strain of the edges in %, largest error of the height in cm) of all frames."""
    frames = frames_of(cells, FRAMES, raw)
    strains = sorted(strain for at in frames for strain in strains_of(cells, at))
    off = max(abs(statistics.fmean(frames[number - 1][2::3]) - height) for number, height in RIGHT.items())
    return 100 * strains[-1], p99(strains), 100 * statistics.fmean(strains), 100 * off


def measure_drop(cells, raw):
    """(p99 of the edges' strain at the end, largest of a frame, both in %)."""
    of_frames = [p99(strains_of(cells, at)) for at in frames_of(cells, DROP_FRAMES, raw)]
    return of_frames[-1], max(of_frames)


def run_peer(name, command, cells, steps, iterations, drop=False):
    """A row of the table, or why there is none."""
    frames = DROP_FRAMES if drop else FRAMES
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        done = subprocess.run([*command, str(cells), str(frames), str(steps), str(iterations), out, *["drop"] * drop],
                              capture_output=True, text=True, check=False)
        if done.returncode or not os.path.exists(out):
            return f"{name}: failed: {(done.stderr.strip().splitlines() or ['no word'])[-1]}"
        times = [float(line) for line in done.stdout.split()[-frames:]]
        raw = Path(out).read_bytes()
        words = WORDS.get(name, "{} steps of {} iterations").format(steps, iterations)
        if drop:
            return (f"{name}, {words}", statistics.fmean(times), *measure_drop(cells, raw))
        return f"{name}, {words}", statistics.median(times), *measure_swing(cells, raw)


def run_singe(singe, cells, measurement, options):
    """A row of `singe bench swing` or `drop`."""
    thin = ["--thickness", "1"] * (measurement == "swing")
    done = subprocess.run([singe, "bench", measurement, "--cells", str(cells), *thin, *options.split(), "--json"],
                          capture_output=True, text=True, check=True)
    row = json.loads(done.stdout)["rows"][0]
    name = "Singe" + options.replace(" --", ", ").replace("--", ", ")
    if measurement == "drop":
        return name, row["frame_ms"], row["strain_pct_p99"], row["worst_p99_pct"]
    return name, row["cpu_ms"], row["blue_pct_max"], row["blue_pct_p99"], row["blue_pct_mean"], row["off_cm"]


def find_bullet(folder):
    """Compiles the adapter; None without a compiler or Bullet."""
    compiler = shutil.which("c++")
    if not compiler or not shutil.which("pkg-config"):
        return None
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "bullet"], capture_output=True, text=True, check=False)
    if flags.returncode:
        return None
    program = os.path.join(folder, "bullet")
    built = subprocess.run([compiler, "-O3", "-march=native", "-DNDEBUG", os.path.join(ROOT, "lab/peers/bullet.cpp"),
                            "-o", program, *flags.stdout.split()], check=False)
    return None if built.returncode else [program]


def find_nvcloth(sources, folder):
    """Compiles its sources and the adapter; None without them."""
    if not sources:
        return None
    folders = [Path(sources, "NvCloth", of) for of in ("src", "src/ps/unix", "extensions/src")]
    parts = [str(path) for of in folders for path in of.glob("*.cpp") if path.stem != "PsUnixMutex"]
    include = [f"-I{Path(sources, of)}" for of in ("NvCloth/include", "NvCloth/src", "NvCloth/extensions/include",
                                                   "PxShared/include")]
    program = os.path.join(folder, "nvcloth")
    built = subprocess.run(["c++", "-std=c++17", "-O3", "-march=native", "-DNDEBUG", "-w", "-fno-strict-aliasing",
                            "-DNV_CLOTH_ENABLE_CUDA=0", "-DNV_CLOTH_ENABLE_DX11=0", *include, *parts,
                            os.path.join(ROOT, "lab/peers/nvcloth.cpp"), "-o", program], check=False)
    return None if built.returncode else [program]


def find_module(module, adapter):
    """The command of an adapter in Python; None where there is no such module."""
    there = subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True, check=False)
    return None if there.returncode else [sys.executable, os.path.join(ROOT, "lab/peers", adapter)]


def find_peers(options, folder):
    peers = {"Bullet": find_bullet(folder), "MuJoCo": find_module("mujoco", "mujoco_sheet.py"),
             "Blender": find_module("bpy", "blender_sheet.py"), "NvCloth": find_nvcloth(options.nvcloth, folder)}
    for name, program in options.peer:
        peers[name] = [program]
    return peers


def named_program(text):
    name, _, program = text.partition("=")
    if not name or not shutil.which(program):
        raise argparse.ArgumentTypeError(f"{text}: expected NAME=PROGRAM, a program that can be run")
    return name, program


def compare(peers, settings, first, cells, drop):
    """Rows of Singe, then of the peers, and what the peers that give none say."""
    rows, missing = first, []
    for name, command in peers.items():
        for steps, iterations in settings.get(name, () if drop else ((10, 10),)):
            row = run_peer(name, command, cells, steps, iterations, drop) if command else f"{name}: not here"
            (missing if isinstance(row, str) else rows).append(row)
            if isinstance(row, str):
                break
    return rows, missing


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("singe", nargs="?", default=os.path.join(ROOT, "build", "singe"))
    parser.add_argument("--cells", type=int, default=100)
    parser.add_argument("--nvcloth", metavar="FOLDER", help="sources of NvCloth")
    parser.add_argument("--peer", action="append", default=[], type=named_program, metavar="NAME=PROGRAM")
    parser.add_argument("--table", action="store_true", help="writes the tables of docs/performance.md")
    options = parser.parse_args()
    if not 2 <= options.cells <= 1000:
        parser.error("--cells must be 2 to 1000")

    with tempfile.TemporaryDirectory() as folder:
        peers = find_peers(options, folder)
        own = [run_singe(options.singe, options.cells, "swing", of) for of in SWING]
        swing, missing = compare(peers, SETTINGS, own, options.cells, False)
        own = [run_singe(options.singe, options.cells, "drop", of) for of in DROP]
        drop, none = compare(peers, DROP_SETTINGS, own, options.cells, True)

    size = f"{options.cells} x {options.cells} cells"
    lines = [f"| {size} swing | ms a frame | strain max / p99 / mean, % | height off by, cm |", "|---|---|---|---|"]
    lines += [f"| {name} | {ms:.3g} | {most:.3g} / {middle:.3g} / {mean:.2g} | {off:.2g} |"
              for name, ms, most, middle, mean, off in swing]
    lines += ["", f"| {size} drop | ms a frame | p99 of the strain at the end, % | worst of a frame, % |", "|---|---|---|---|"]
    lines += [f"| {name} | {ms:.3g} | {end:.3g} | {worst:.3g} |" for name, ms, end, worst in drop]
    print("\n".join(lines + missing + none))
    if options.table:
        write_table("bench_peers", lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
