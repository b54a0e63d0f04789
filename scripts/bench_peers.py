#!/usr/bin/env python3
"""Compares `singe bench swing` with other solvers of cloth in one run on this machine, and prints one table.

Bullet is compiled from lab/peers if its headers are there (Debian: libbullet-dev), MuJoCo runs where Python has it (pip
install mujoco). Rapier has no cloth. Any other solver takes part by --peer NAME=PROGRAM: PROGRAM CELLS FRAMES STEPS
ITERATIONS OUT drops a sheet of 1 m x 1 m and 0.1 kg, held at two corners beside each other, from the horizontal without
drag or damping, prints the milliseconds of processor time of each frame of 1/24 s on one thread, and writes the
positions of (CELLS + 1)^2 points, row by row, as floats in the machine's order, after each frame. lab/peers/bullet.cpp is
one, to copy for NvCloth or Jolt.

Strain is that of the grid's edges over all frames; the height is of the points' mean, and its error the largest at .33,
.50 and .67 s against the right motion.

Usage: scripts/bench_peers.py [SINGE] [--cells N] [--peer NAME=PROGRAM] [--table]   (--table writes docs/performance.md's)
"""
import argparse
import array
import json
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
SETTINGS = {"Bullet": ((10, 10), (20, 40)), "MuJoCo": ((10, 50), (40, 50))}  # steps a frame, iterations


def write_table(name, lines):
    """Puts a table into docs/performance.md, between the comments of its name."""
    path = Path(ROOT, "docs", "performance.md")
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    before, rest = path.read_text(encoding="utf-8").split(begin)
    path.write_text(before + "\n\n".join([begin, "\n".join(lines), end]) + rest.split(end)[1], encoding="utf-8")


def measure(cells, raw):
    """(largest, p99 and mean strain of the edges in %, largest error of the height in cm) of all frames."""
    side = cells + 1
    strains, off = [], 0.0
    floats = array.array("f", raw)
    if len(floats) != FRAMES * side * side * 3:
        raise ValueError(f"{len(floats)} numbers, not {FRAMES} frames of {side * side} points")
    edges = [(r * side + c, r * side + c + step) for r in range(side) for c in range(side)
             for step, there in ((1, c < cells), (side, r < cells)) if there]
    for frame in range(1, FRAMES + 1):
        at = floats[(frame - 1) * side * side * 3:frame * side * side * 3]
        strains += [abs(((at[3 * a] - at[3 * b]) ** 2 + (at[3 * a + 1] - at[3 * b + 1]) ** 2 +
                         (at[3 * a + 2] - at[3 * b + 2]) ** 2) ** 0.5 * cells - 1) for a, b in edges]
        if frame in RIGHT:
            off = max(off, abs(statistics.fmean(at[2::3]) - RIGHT[frame]))
    strains.sort()
    return (100 * strains[-1], 100 * strains[int(0.99 * (len(strains) - 1))], 100 * statistics.fmean(strains),
            100 * off)


def run_peer(name, command, cells, steps, iterations):
    """A row of the table, or why there is none."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        done = subprocess.run([*command, str(cells), str(FRAMES), str(steps), str(iterations), out],
                              capture_output=True, text=True, check=False)
        if done.returncode or not os.path.exists(out):
            return f"{name}: failed: {(done.stderr.strip().splitlines() or ['no word'])[-1]}"
        times = [float(line) for line in done.stdout.split()]
        return (f"{name}, {steps} steps of {iterations} iterations", statistics.median(times),
                *measure(cells, Path(out).read_bytes()))


def run_singe(singe, cells):
    """The row of `singe bench swing`."""
    done = subprocess.run([singe, "bench", "swing", "--cells", str(cells), "--thickness", "1", "--json"],
                          capture_output=True, text=True, check=True)
    row = json.loads(done.stdout)["rows"][0]
    return ("Singe, 38 substeps", row["cpu_ms"], row["blue_pct_max"], row["blue_pct_p99"], row["blue_pct_mean"],
            row["off_cm"])


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


def find_mujoco():
    """The command of its adapter; None where Python has no MuJoCo."""
    there = subprocess.run([sys.executable, "-c", "import mujoco"], capture_output=True, check=False)
    return None if there.returncode else [sys.executable, os.path.join(ROOT, "lab/peers/mujoco_sheet.py")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("singe", nargs="?", default=os.path.join(ROOT, "build", "singe"))
    parser.add_argument("--cells", type=int, default=50)
    parser.add_argument("--peer", action="append", default=[], metavar="NAME=PROGRAM")
    parser.add_argument("--table", action="store_true", help="writes the table of docs/performance.md")
    options = parser.parse_args()
    if not 2 <= options.cells <= 1000:
        parser.error("--cells must be 2 to 1000")

    rows, missing = [run_singe(options.singe, options.cells)], []
    with tempfile.TemporaryDirectory() as folder:
        peers = {"Bullet": find_bullet(folder), "MuJoCo": find_mujoco()}
        for peer in options.peer:
            name, _, program = peer.partition("=")
            if not name or not shutil.which(program):
                parser.error(f"--peer {peer}: expected NAME=PROGRAM, a program that can be run")
            peers[name] = [program]
        for name, command in peers.items():
            for steps, iterations in SETTINGS.get(name, ((10, 10),)):
                row = run_peer(name, command, options.cells, steps, iterations) if command else f"{name}: not here"
                (missing if isinstance(row, str) else rows).append(row)
                if isinstance(row, str):
                    break

    lines = ["| solver | ms a frame | strain max / p99 / mean, % | height off by, cm |", "|---|---|---|---|"]
    lines += [f"| {name} | {ms:.3g} | {most:.3g} / {p99:.3g} / {mean:.2g} | {off:.2g} |"
              for name, ms, most, p99, mean, off in rows]
    print("\n".join(lines + missing))
    if options.table:
        write_table("bench_peers", lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
