#!/usr/bin/env python3
"""Measures what the goals of speed and memory are about, and prints what was measured beside each goal, in two minutes.

Every row but the letter's is a number of `singe bench`, the smallest of some runs, as other work on the machine only adds;
scripts/measure_performance.sh has the same measurements at more sizes.

Usage: scripts/measure_goals.py [SINGE] [--table]   (--table writes docs/performance.md's)
"""
import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile

from bench_peers import ROOT, write_table

LOOSE, TIGHT = "drop --steps 3 --substeps 10", "drop --steps 3 --substeps 16"

# name, arguments of `singe bench`, column, runs, unit, goal
ROWS = [
    ("swing, 100 x 100 cells, a frame", "swing --cells 100 --thickness 1", "cpu_ms", 3, "ms", 9),
    ("swing, 150 x 150 cells, a frame", "swing --cells 150 --thickness 1", "cpu_ms", 3, "ms", 18),
    ("the same, its largest strain", "swing --cells 150 --thickness 1", "blue_pct_max", 1, "%", 0.5),
    ("swing by one corner, 100 x 100 cells, a frame", "swing --cells 100 --thickness 1 --pins 1", "cpu_ms", 1, "ms", 30),
    ("step of 100,000 springs, one thread", "step --springs 100000", "step_ms", 5, "ms", 2.3),
    ("step of 100,000 springs, two threads", "step --springs 100000 --threads 2", "step_ms", 5, "ms", 1.4),
    ("step of 1,000,000 springs, one thread", "step --springs 1000000", "step_ms", 2, "ms", 25),
    ("step of 1,000,000 springs, two threads", "step --springs 1000000 --threads 2", "step_ms", 2, "ms", 14),
    ("heap, 100,000 springs, two threads, a step", "heap --cells 100 --threads 2", "step_ms", 1, "ms", 3.5),
    ("drop on a sphere, 100 x 100 cells, loose, a frame", LOOSE, "frame_ms", 3, "ms", 60),
    ("the same, p99 of its strain", LOOSE, "strain_pct_p99", 1, "%", 8.3),
    ("the same, tighter, a frame", TIGHT, "frame_ms", 3, "ms", 75),
    ("the same, p99 of its strain", TIGHT, "strain_pct_p99", 1, "%", 2.8),
    ("the same, most memory", TIGHT, "max_mb", 1, "MB", 42),
    ("memory of 1,000,000 springs, each", "memory --springs 1000000", "bytes_spring", 1, "bytes", 250),
]
LETTER = ("letter, 100 frames, one thread, no pictures", "s of the processor", 20)


def letter_seconds(singe):
    """Processor time of the letter's run, of the program and the system."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([singe, "run", os.path.join(ROOT, "examples/letter/letter.yaml"), "--threads", "1", "--no-preview",
                        "-o", os.path.join(folder, "letter")], capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def bench(singe, arguments, column):
    """A number of the only row of `singe bench`."""
    done = subprocess.run([singe, "bench", *arguments.split(), "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["rows"][0][column]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("singe", nargs="?", default=os.path.join(ROOT, "build", "singe"))
    parser.add_argument("--table", action="store_true", help="writes the table of docs/performance.md")
    options = parser.parse_args()

    found = [(LETTER[0], letter_seconds(options.singe), *LETTER[1:])]
    for name, arguments, column, runs, unit, goal in ROWS:
        found.append((name, min(bench(options.singe, arguments, column) for _ in range(runs)), unit, goal))
    lines = ["| what | measured | goal |", "|---|---|---|"]
    lines += [f"| {name} | {value:.3g} {unit} | {goal:g} |" for name, value, unit, goal in found]
    print("\n".join(lines))
    if options.table:
        write_table("goals", lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
