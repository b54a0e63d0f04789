#!/usr/bin/env python3
"""Checks that each promise of docs/guarantees.md and docs/SECURITY.md names tests that exist.

usage: check_guarantees.py ROOT BUILD FILE...

A promise is an item of a list and ends with its tests in brackets: [sim_stats: ledgers_close; cli_resume:
kill_and_resume]. Before the colon is the name of a test of ctest, or a target of the Makefile ("make gate"). After it
are cases of that test: TEST(name) in C, or Python methods without their "test_". A promise that no test can show ends
with [not tested: REASON]. Descriptions do not belong in a list.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path


def ctest_names(build):
    """The tests of a build, without those whose tools this machine lacks."""
    shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, capture_output=True, text=True, check=True)
    return {test["name"] for test in json.loads(shown.stdout)["tests"]}


def make_targets(root):
    return {"make " + name for name in re.findall(r"^([a-z-]+):", Path(root, "Makefile").read_text(), re.M)}


def cases(root):
    """The cases in the sources of the tests."""
    found = set()
    for folder, _, files in os.walk(os.path.join(root, "tests")):
        for name in files:
            path = os.path.join(folder, name)
            if name.endswith((".c", ".h")):
                pattern = r"^TEST\((\w+)\)"
            elif name.endswith(".py"):
                pattern = r"\bdef (?:test_)?(\w+)\("
            else:
                continue
            text = Path(path).read_text()
            names = re.findall(pattern, text, re.M)
            found.update(n.removeprefix("test_") for n in names)
    return found


def promises(path):
    """Items of lists: (line, text)."""
    items = []
    with open(path) as file:
        for number, line in enumerate(file, 1):
            if re.match(r"\s*- ", line):
                items.append([number, line.strip()])
            elif items and items[-1] and line.startswith("  ") and line.strip():
                items[-1][1] += " " + line.strip()
            else:
                items.append(None)
    return [item for item in items if item]


def complaints(root, build, files):
    tests = ctest_names(build) | make_targets(root)
    known = cases(root)
    for file in files:
        found = promises(os.path.join(root, file))
        if not found:
            yield f"{file}: no promises"
        for line, text in found:
            last = re.search(r"\[([^\[\]]+)\]$", text)
            if not last:
                yield f"{file}:{line}: this promise does not end with its tests"
            elif not re.match(r"not tested: \S", last.group(1)):
                for name in last.group(1).split(";"):
                    test, _, case = (part.strip() for part in name.partition(":"))
                    if test not in tests:
                        yield f"{file}:{line}: no test '{test}'"
                    for one in filter(None, (c.strip() for c in case.split(","))):
                        if one not in known:
                            yield f"{file}:{line}: no case '{one}'"


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    found = list(complaints(sys.argv[1], sys.argv[2], sys.argv[3:]))
    print("\n".join(found) or "every promise names tests that exist")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
