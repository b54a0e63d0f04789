#!/usr/bin/env python3
"""Runs the samples: each must print what its first comment says, and be short.

usage: check.py FOLDER_OF_PROGRAMS NAME...
"""

import concurrent.futures
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
LINES_MAX = 60


def check(source, program):
    """What is wrong with a sample; None: nothing."""
    text = source.read_text(encoding="utf-8")
    said = re.search(r"\A// [^\n]+\n//\n// Prints:\n((?://   [^\n]*\n)+)", text)
    if not said:
        return "does not begin with what it shows, and what it prints"
    if text.count("\n") > LINES_MAX:
        return f"has more than {LINES_MAX} lines"
    done = subprocess.run([program], capture_output=True, text=True, timeout=60)
    if done.returncode or done.stdout != re.sub(r"^//   ", "", said.group(1), flags=re.MULTILINE):
        return f"exit code {done.returncode}, and it prints\n{done.stdout}{done.stderr}"
    return None


def main():
    folder, names = pathlib.Path(sys.argv[1]), sys.argv[2:]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = pool.map(lambda name: check(HERE / f"{name}.c", folder / name), names)
    wrong = {name: fault for name, fault in zip(names, found) if fault}
    for name, fault in wrong.items():
        print(f"{name}: {fault}")
    print(f"{len(names)} samples, {len(wrong)} wrong")
    return 1 if wrong or not names else 0


if __name__ == "__main__":
    sys.exit(main())
