#!/usr/bin/env python3
"""How long functions are: per folder their number, the median, the 90th percentile and the longest.

usage: measure_functions.py [--over LINES] [FOLDER...]

A function is what the formatted sources begin at the left border and end by a brace there, both lines included. With
--over, lists the functions that are longer and have no comment in their body. Exit status: 1 where the 90th percentile
of a folder is above 20 lines, 0 otherwise.
"""

import argparse
import pathlib
import re
import sys

BOUND = 20


def functions(path):
    """(first line, name, lines) of each function of a file."""
    begin, name = None, None
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines):
        if begin is None and re.match(r"[A-Za-z].*\w\(", line) and not line.startswith(("typedef", "enum", "struct")):
            begin, name = number, re.search(r"(\w+)\(", line).group(1)
        if begin is not None and (line.endswith((";", "};")) and line[:1] not in " }" or line == "};"):
            begin = None  # a declaration or a table
        elif begin is not None and (line == "}" or (line.endswith("}") and line[:1] not in " }")):
            yield begin + 1, name, lines[begin:number + 1]
            begin = None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--over", type=int, metavar="LINES")
    parser.add_argument("folders", nargs="*", default=["src"])
    options = parser.parse_args()
    status = 0
    for folder in options.folders:
        found = [(path, *f) for path in sorted(pathlib.Path(folder).rglob("*.c")) for f in functions(path)]
        lengths = sorted(len(f[3]) for f in found)
        if not lengths:
            continue
        high = lengths[min(len(lengths) - 1, int(0.9 * len(lengths)))]
        print(f"{folder}: {len(lengths)} functions, median {lengths[len(lengths) // 2]} lines, "
              f"90th percentile {high}, longest {lengths[-1]}")
        status |= high > BOUND
        for path, line, name, body in found:
            if options.over and len(body) > options.over and not any(re.match(r"\s+//", text) for text in body):
                print(f"{path}:{line}: {name}, {len(body)} lines")
    return status


if __name__ == "__main__":
    sys.exit(main())
