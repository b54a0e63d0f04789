#!/usr/bin/env python3
"""Measures the rows of a farm on this machine: rows per hour, one or several at a time; the cost of preemption; and the
size of a row's files.

    tests/farm/measure_farm.py PROGRAM [--repeat N]

Numbers are medians of N repeats [3]. Rows are letters as in examples/letter/sweep.yaml.
"""

import argparse
import os
import shutil
import signal
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

LETTER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "letter", "letter.yaml")
CELLS = "[42, 60]"
FRAMES = 49
PLAN = """\
scene: {scene}
method: list
set: {{frames: {frames}, sheets.0.grid.cells: {cells}}}
parameters:
  pace: [4, 6, 8, 12]
"""


def run(*command, **options):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options)


def seconds(function):
    begun = time.monotonic()
    function()
    return time.monotonic() - begun


def rows_an_hour(program, folder, jobs):
    plan = os.path.join(folder, "plan.yaml")
    Path(plan).write_text(PLAN.format(scene=os.path.abspath(LETTER), frames=FRAMES, cells=CELLS))
    out = os.path.join(folder, "sweep")
    shutil.rmtree(out, ignore_errors=True)
    took = seconds(lambda: run(program, "sweep", plan, "-o", out, "--no-preview", "--jobs", str(jobs)))
    assert len(os.listdir(os.path.join(out, "rows"))) == 4
    return 4 * 3600 / took


def row_command(program, out):
    return [program, "run", LETTER, "-o", out, "--no-preview", "-q", "--threads", "1", "--set", f"frames={FRAMES}",
            "--set", f"sheets.0.grid.cells={CELLS}", "--set", "pace=8", "--resume"]


def whole_row(program, out):
    shutil.rmtree(out, ignore_errors=True)
    return seconds(lambda: run(*row_command(program, out)))


def preempted_row(program, out, number, after):
    """Seconds that a row takes if it is stopped twice, each time `after` seconds from where it started or went on."""
    shutil.rmtree(out, ignore_errors=True)
    begun = time.monotonic()
    for _ in range(2):
        process = subprocess.Popen(row_command(program, out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(after)
        process.send_signal(number)
        assert process.wait() != 0, "the row was complete before it was preempted"
    run(*row_command(program, out))
    return time.monotonic() - begun


def sizes(out):
    """MB by kind of file."""
    found = {}
    for folder, _, names in os.walk(out):
        for name in names:
            kind = os.path.splitext(name)[1][1:]
            found[kind] = found.get(kind, 0) + os.path.getsize(os.path.join(folder, name)) / 1e6
    return found


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--repeat", type=int, default=3)
    given = arguments.parse_args()
    program, cores = os.path.abspath(given.program), os.cpu_count()
    median = lambda function: statistics.median(function() for _ in range(given.repeat))
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "row")
        print(f"letters of {CELLS} cells, {FRAMES} frames with gas, without pictures; {cores} cores\n")
        for jobs in range(1, cores + 1):
            rate = median(lambda: rows_an_hour(program, folder, jobs))
            print(f"rows an hour, {jobs} at a time: {rate:.0f}", flush=True)
        whole = median(lambda: whole_row(program, out))
        print(f"one row: {whole:.1f} s")
        for kind, megabytes in sorted(sizes(out).items()):
            print(f"  {kind}: {megabytes:.1f} MB")
        for number in signal.SIGTERM, signal.SIGKILL:
            lost = (median(lambda: preempted_row(program, out, number, whole / 3)) - whole) / 2
            print(f"a row that gets {number.name} and is resumed: {lost:.2f} s more")


if __name__ == "__main__":
    main()
