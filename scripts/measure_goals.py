#!/usr/bin/env python3
"""Measures what the goals of speed and memory are about, and prints what was measured beside each goal, in six minutes.

Every number is the median of three runs of `singe bench`, or of the letter's; those that cannot vary come from one run.
scripts/measure_performance.sh has the same measurements at more sizes, scripts/bench_peers.py those of other solvers.
--crowd adds fifty sheets of 70 x 70 cells until they rest, which take ten minutes more.

Usage: scripts/measure_goals.py [SINGE] [--crowd] [--table]   (--table writes docs/performance.md's)
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

from bench_peers import ROOT, write_table

SWING, CORNER = "swing --cells 100 --thickness 1", "swing --cells 100 --thickness 1 --pins 1"
GAME = SWING + " --steps 1 --substeps 9 --start 0.63"
WIDE = "swing --cells 150 --thickness 1"
LOOSE, TIGHT = "drop --steps 3 --substeps 10", "drop --steps 3 --substeps 16"
WIND = "wind --cells 60"
SIZES = "dynamics --springs 1000,4000,16000,100000,1000000,10000000 --substeps 1 --projections 7 --quick"
CROWD = "stack --sheets 50 --cells 70 --time 1 --threads 2"


def of_first(column):
    return lambda rows: rows[0][column]


def spread(rows):
    cost = [row["ns_spring_sweep"] for row in rows]
    return max(cost) / min(cost)


# name, arguments of `singe bench`, what of its rows, runs, unit, goal
ROWS = [
    ("swing, 100 x 100 cells, a frame", SWING, of_first("cpu_ms"), 3, "ms", 9),
    ("the same, loose, a frame", GAME, of_first("cpu_ms"), 3, "ms", 3),
    ("the same, loose, p99 of its strain", GAME, of_first("blue_pct_p99"), 1, "%", 4),
    ("swing, 150 x 150 cells, a frame", WIDE, of_first("cpu_ms"), 3, "ms", 18),
    ("the same, its largest strain", WIDE, of_first("blue_pct_max"), 1, "%", 0.5),
    ("swing by one corner, 100 x 100 cells, a frame", CORNER, of_first("cpu_ms"), 3, "ms", 30),
    ("the same, its largest strain", CORNER, of_first("blue_pct_max"), 1, "%", 1),
    ("step of 100,000 springs, one thread", "step --springs 100000", of_first("step_ms"), 3, "ms", 2.3),
    ("step of 100,000 springs, two threads", "step --springs 100000 --threads 2", of_first("step_ms"), 3, "ms", 1.4),
    ("step of 1,000,000 springs, one thread", "step --springs 1000000", of_first("step_ms"), 3, "ms", 25),
    ("step of 1,000,000 springs, two threads", "step --springs 1000000 --threads 2", of_first("step_ms"), 3, "ms", 14),
    ("time of a spring, 1,000 to 10,000,000 springs, most over least", SIZES, spread, 1, "times", 1.6),
    ("heap, 100,000 springs, two threads, a step", "heap --cells 100 --threads 2", of_first("step_ms"), 3, "ms", 3.5),
    ("drop on a sphere, 100 x 100 cells, loose, a frame", LOOSE, of_first("frame_ms"), 3, "ms", 60),
    ("the same, p99 of its strain", LOOSE, of_first("strain_pct_p99"), 1, "%", 8.3),
    ("the same, tighter, a frame", TIGHT, of_first("frame_ms"), 3, "ms", 75),
    ("the same, p99 of its strain", TIGHT, of_first("strain_pct_p99"), 1, "%", 2.8),
    ("the same, most memory", TIGHT, of_first("max_mb"), 1, "MB", 42),
    ("wind of 15 m/s, over one of 5 m/s", WIND, lambda rows: rows[1]["of_first"], 3, "times", 4),
    ("memory of 1,000,000 springs, each", "memory --springs 1000000", of_first("bytes_spring"), 1, "bytes", 250),
]
CROWD_ROWS = [
    ("fifty sheets of 70 x 70 cells until they rest, two threads, a step", CROWD, of_first("step_ms"), 1, "ms", 300),
    ("the same, its worst step", CROWD, of_first("worst_ms"), 1, "ms", 800),
    ("the same, p99 of its strain in the worst frame", CROWD, of_first("worst_p99_pct"), 1, "%", 5),
    ("the same, crossings", CROWD, of_first("crossing"), 1, "", 0),
    ("the same, most memory", CROWD, of_first("max_mb"), 1, "MB", 1000),
]
LETTER = ("letter, 100 frames, one thread, no pictures", "s of the processor", 20)
HALVED = ("the same with its cells halved, over that", "times", 4.3)
PICTURE = ("picture of the letter, 960 x 540, with flames, two threads", "s", 0.25)
HALF_CELLS = "sheets.0.grid.cells=[168, 238]"


def letter_seconds(singe, folder, *options):
    """Processor time of the letter's run, of the program and the system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([singe, "run", os.path.join(ROOT, "examples/letter/letter.yaml"), "--threads", "1", "--no-preview",
                    "--force", "-o", folder, *options], capture_output=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def picture_seconds(singe, folder):
    """Of each of three pictures after the first, which also draws the table."""
    def seconds(frames):
        begun = time.monotonic()
        subprocess.run([singe, "render", folder, "--frames", frames, "--threads", "2", "--set", "preview.size=[960,540]",
                        "-o", folder + "-pictures"], capture_output=True, check=True)
        return time.monotonic() - begun
    first = seconds("87")
    return (seconds("87-90") - first) / 3


def letter_rows(singe):
    with tempfile.TemporaryDirectory() as folder:
        letter = os.path.join(folder, "letter")
        whole = statistics.median(letter_seconds(singe, letter) for _ in range(3))
        picture = statistics.median(picture_seconds(singe, letter) for _ in range(3))
        halved = letter_seconds(singe, letter, "--set", HALF_CELLS)
    return [(LETTER[0], whole, *LETTER[1:]), (HALVED[0], halved / whole, *HALVED[1:]), (PICTURE[0], picture, *PICTURE[1:])]


def bench(singe, arguments):
    """The rows of `singe bench`."""
    done = subprocess.run([singe, "bench", *arguments.split(), "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["rows"]


def bench_rows(singe, rows):
    """Of each row what was measured; rows with the same arguments share their runs."""
    found, runs_of = [], {}
    for name, arguments, pick, runs, unit, goal in rows:
        done = runs_of.setdefault(arguments, [])
        done += [bench(singe, arguments) for _ in range(len(done), runs)]
        found.append((name, statistics.median(pick(of) for of in done), unit, goal))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("singe", nargs="?", default=os.path.join(ROOT, "build", "singe"))
    parser.add_argument("--crowd", action="store_true", help="also fifty sheets that fall on each other")
    parser.add_argument("--table", action="store_true", help="writes the table of docs/performance.md")
    options = parser.parse_args()

    found = letter_rows(options.singe) + bench_rows(options.singe, ROWS + CROWD_ROWS * options.crowd)
    lines = ["| what | measured | goal |", "|---|---|---|"]
    lines += [f"| {name} | {value:.3g} {unit}".rstrip() + f" | {goal:g} |" for name, value, unit, goal in found]
    print("\n".join(lines))
    if options.table:
        write_table("goals", lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
