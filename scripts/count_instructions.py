#!/usr/bin/env python3
"""Counts the instructions of each stage of a step under valgrind and compares them with lab/bench/instructions.csv.

Counts do not depend on the load of the machine, so they show a slower stage where times are too noisy. A stage may be
up to 10 % above or below its baseline. A stage that has become faster fails too, so that its baseline follows and it
cannot become slower again unnoticed. --update writes the baseline. --isotropic shows what isotropic bending costs.

The steps are recorded (SingeSimDef.record). That may cost 2 % of a step's instructions; writing to a disk is not counted.

Exit status: 0 within the bound, 1 outside, 77 if it cannot be measured: valgrind is missing, or the baseline is for
another compiler, processor or build.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

STAGES = ["heat", "burn", "ablate", "dynamics"]
BOUND = 0.10
RECORD_BOUND = 0.02
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BASELINE = os.path.join(ROOT, "lab", "bench", "instructions.csv")


def skip(reason):
    print(f"count_instructions: skipped: {reason}")
    sys.exit(77)


def inclusive(path, functions):
    """Instructions spent in calls of the named functions, from callgrind's file: each call is a line `calls=` under
    the callee's name, and the last number of the next line is the cost of the call. A name is written as `(id) name`
    the first time and as `(id)` afterwards."""
    names, callee, called, costs = {}, None, False, dict.fromkeys(functions, 0)
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            named = re.match(r"c?fn=\((\d+)\)(?: (.*))?", line)
            if named:
                name = names.setdefault(named[1], named[2])
                if line.startswith("cfn="):
                    callee = name
            elif called:
                if callee in costs:
                    costs[callee] += int(line.split()[-1])
                called = False
            called = line.startswith("calls=")
    return costs


def measure(program, *arguments):
    """Instructions per step, by stage; and what recording adds, as a share of the step without it."""
    with tempfile.TemporaryDirectory() as folder:
        counts = os.path.join(folder, "counts")
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=measured_steps", f"--callgrind-out-file={counts}",
             program, *arguments],
            capture_output=True, text=True, check=False)
        steps = re.search(r"^steps (\d+)$", run.stdout, re.M)
        if "lacks the instructions" in run.stderr:
            skip("this processor has no x86-64-v3")
        if run.returncode or not steps:
            sys.exit(f"count_instructions: {program} failed under valgrind:\n{run.stdout}{run.stderr}")
        costs = inclusive(counts, [f"{stage}_step" for stage in [*STAGES, "singe_sim", "call"]] + ["recorder_state"])
    counted = {stage: costs[f"{stage}_step"] // int(steps[1]) for stage in STAGES}
    whole = costs["singe_sim_step"]
    record = whole - costs["call_step"] + costs["recorder_state"]  # around the step, and in it
    return counted, record / (whole - record)


def read_baseline():
    lines = Path(BASELINE).read_text(encoding="utf-8").split("\n")
    rows = [line.split(",") for line in lines if line and not line.startswith("#")][1:]
    return lines[0].removeprefix("# "), {stage: int(count) for stage, count in rows}


def write_baseline(kind, counts):
    with open(BASELINE, "w", encoding="utf-8") as file:
        file.write(f"# {kind}\nstage,instructions\n")
        file.writelines(f"{stage},{counts[stage]}\n" for stage in STAGES)


def compare(counts, baseline, name="baseline", bound=BOUND):
    """Prints a table and returns how many stages are out of bounds; a bound of 0 is none."""
    out = 0
    print(f"{'stage':10} {'instructions':>14} {name:>14} {'change':>8}")
    for stage in STAGES:
        change = counts[stage] / baseline[stage] - 1
        print(f"{stage:10} {counts[stage]:14,} {baseline[stage]:14,} {change:+8.1%}")
        out += abs(change) > bound > 0
    if out:
        print("A stage is more than 10 % off its baseline. If that is intended, write the new baseline:\n"
              "    python3 scripts/count_instructions.py --update")
    return out


def record_too_dear(share):
    print(f"recording: {share:.2%} of a step; at most {RECORD_BOUND:.0%}")
    return not 0 < share <= RECORD_BOUND


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "lab", "bench", "singe_bench_instructions"))
    parser.add_argument("--kind", default="GNU 12, x86_64, Release",
                        help="compiler, processor and build of the program")
    parser.add_argument("--update", action="store_true", help="write the baseline")
    parser.add_argument("--isotropic", action="store_true", help="count with isotropic bending; nothing fails")
    options = parser.parse_args()
    if not shutil.which("valgrind"):
        skip("valgrind is not installed")
    if options.update:
        write_baseline(options.kind, measure(options.program)[0])
        print(f"wrote {os.path.relpath(BASELINE)}")
        return 0
    kind, baseline = read_baseline()
    if kind != options.kind:
        skip(f"the baseline is for {kind}, this is {options.kind}")
    if options.isotropic:
        compare(measure(options.program, "isotropic")[0], measure(options.program)[0], "without", 0)
        return 0
    counts, share = measure(options.program)
    return 1 if compare(counts, baseline) + record_too_dear(share) else 0


if __name__ == "__main__":
    sys.exit(main())
