#!/usr/bin/env python3
"""Prints how much of src, program/formats and program/scene the tests reach, as gcov counts it.

coverage.py BUILD [--no-bars | --missing FILE...]

A branch is one way out of a condition as gcc sees it: `a && b` has four. Some lines are compiled several times: those
of headers, and of kernels for several instruction sets. They are reached if any of these copies is. Branches of
assertions, which no test may take, and of exceptions do not count.
"""

import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
from pathlib import Path

FOLDERS = ("src", "program/formats", "program/scene")
LINES, BRANCHES = 95.0, 85.0  # bars, in %


def objects(build):
    """The object files of the folders."""
    for folder in FOLDERS:
        for path, _, names in os.walk(os.path.join(build, folder)):
            yield from (os.path.join(path, name) for name in sorted(names) if name.endswith(".gcno"))


def read_counts(note):
    """The counts of one object file."""
    done = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", os.path.abspath(note)],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"gcov failed on {note}: {done.stderr.strip()}")
    return [file for text in done.stdout.splitlines() if text.strip() for file in json.loads(text)["files"]]


class File:
    """The counts of a source file over all of its objects."""

    def __init__(self, root, name):
        self.name, self.lines, self.branches = name, {}, {}
        self.text = Path(root, name).read_text(encoding="utf-8").split("\n")

    def source(self, number):
        return self.text[number - 1].strip() if number <= len(self.text) else "(changed since the build)"

    def add(self, line):
        number = line["line_number"]
        self.lines[number] = max(self.lines.get(number, 0), line["count"])
        if re.search(r"\bassert\(", self.source(number)):
            return
        counts = [branch["count"] for branch in line["branches"] if not branch["throw"]]
        ways = self.branches.setdefault((number, line.get("function_name")), [])
        ways += [0] * (len(counts) - len(ways))
        for i, count in enumerate(counts):
            ways[i] = max(ways[i], count)

    def line_counts(self):
        return sum(count > 0 for count in self.lines.values()), len(self.lines)

    def branch_counts(self):
        ways = [count for counts in self.branches.values() for count in counts]
        return sum(count > 0 for count in ways), len(ways)

    def show_missing(self):
        untaken = {}
        for (number, _), ways in self.branches.items():
            untaken[number] = untaken.get(number, 0) + sum(count == 0 for count in ways)
        for number, count in sorted(self.lines.items()):
            left = untaken.get(number, 0)
            if count == 0 or left:
                what = "not run" if count == 0 else f"{left} of its branches not taken"
                print(f"{self.name}:{number}: {what}: {self.source(number)}")


def collect(root, build):
    files = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for found in pool.map(read_counts, objects(build)):
            for file in found:
                name = os.path.relpath(os.path.join(build, file["file"]), root)
                if not name.startswith(FOLDERS):
                    continue
                if name not in files:
                    files[name] = File(root, name)
                for line in file["lines"]:
                    files[name].add(line)
    return files


def percent(part, whole):
    return 100.0 * part / whole if whole else 100.0


def total(counts):
    counts = list(counts)
    return sum(part for part, _ in counts), sum(whole for _, whole in counts)


def row(name, files):
    lines, branches = total(f.line_counts() for f in files), total(f.branch_counts() for f in files)
    print(f"{name:24}{lines[0]:>8} of{lines[1]:>7}{percent(*lines):>8.1f} %"
          f"{branches[0]:>9} of{branches[1]:>7}{percent(*branches):>8.1f} %")
    return percent(*lines), percent(*branches)


def show(files):
    print(f"{'':24}{'lines run':>18}{'':10}{'branches taken':>19}")
    parts = {}
    for name, file in files.items():
        parts.setdefault(os.path.dirname(name), []).append(file)
    for part in sorted(parts):
        row(part, parts[part])
    print()
    good = True
    for folder in FOLDERS:
        lines, branches = row(folder, [f for n, f in files.items() if n.startswith(folder)])
        good = good and lines >= LINES and branches >= BRANCHES
    row("all", list(files.values()))
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("build", help="folder of the build in which the tests have run")
    parser.add_argument("--missing", nargs="+", metavar="FILE", help="list the lines of these files and folders that the tests do not reach")
    parser.add_argument("--no-bars", action="store_true", help="do not fail below the bars")
    options = parser.parse_args()
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    files = collect(root, os.path.abspath(options.build))
    if options.missing:
        for name in sorted(files):
            if any(name == wanted or name.startswith(wanted.rstrip("/") + "/") for wanted in options.missing):
                files[name].show_missing()
        return 0
    return 0 if show(files) or options.no_bars else f"below the bars of {LINES:.0f} % of lines and {BRANCHES:.0f} % of branches"


if __name__ == "__main__":
    sys.exit(main())
