#!/usr/bin/env python3
"""Runs the samples: each must print what its first comment says, and be short. With --python those in Python, whose
first comments are those of their twins in C; with --scenes the scenes, a frame of each, without a warning.

usage: check.py FOLDER_OF_PROGRAMS NAME...
       check.py --python            needs numpy; the environment names the package and its library
       check.py --scenes SINGE
"""

import concurrent.futures
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
LINES_MAX = 60


def head(source, mark):
    """The first comment without its marks, what the sample prints, and its lines."""
    text = source.read_text(encoding="utf-8")
    said = re.match(f"(?:{mark}[^\n]*\n)+", text)
    comment = re.sub(f"^{mark} ?", "", said.group() if said else "", flags=re.MULTILINE)
    prints = re.fullmatch(r"[^\n]+\n\nPrints:\n((?:  [^\n]*\n)+)", comment)
    return comment, re.sub("^  ", "", prints.group(1), flags=re.MULTILINE) if prints else None, text.count("\n")


def check_scene(source, command):
    """The same of a scene, which prints nothing."""
    text = source.read_text(encoding="utf-8")
    if text.split("\n")[0][1:] != source.with_suffix(".c").read_text(encoding="utf-8").split("\n")[0][2:]:
        return "does not begin as its twin in C does"
    if text.count("\n") > LINES_MAX:
        return f"has more than {LINES_MAX} lines"
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([*command, "-o", folder, "--frames", "1", "--no-preview"], capture_output=True, text=True,
                              timeout=60)
    # some samples are about motion alone
    wrong = [line for line in done.stderr.splitlines() if "warning" in line and "nothing lights the sheets" not in line]
    return f"exit code {done.returncode}\n{done.stderr}" if done.returncode or wrong else None


def check(source, command):
    """What is wrong with a sample; None: nothing."""
    if source.suffix == ".yaml":
        return check_scene(source, command)
    comment, wanted, lines = head(source, "#" if source.suffix == ".py" else "//")
    if wanted is None:
        return "does not begin with what it shows, and what it prints"
    if source.suffix == ".py" and comment != head(source.with_suffix(".c"), "//")[0]:
        return "does not begin as its twin in C does"
    if lines > LINES_MAX:
        return f"has more than {LINES_MAX} lines"
    done = subprocess.run([*command], capture_output=True, text=True, timeout=60)
    if done.returncode or done.stdout != wanted:
        return f"exit code {done.returncode}, and it prints\n{done.stdout}{done.stderr}"
    return None


def main():
    if sys.argv[1:] == ["--python"]:
        if not importlib.util.find_spec("numpy"):
            print("skipped: no numpy")
            return 77
        sources = [file for file in sorted(HERE.glob("*.py")) if file.with_suffix(".c").exists()]
        runs = [(source, [sys.executable, source]) for source in sources]
    elif sys.argv[1:2] == ["--scenes"]:
        runs = [(source, [sys.argv[2], "run", source]) for source in sorted(HERE.glob("*.yaml"))]
    else:
        runs = [(HERE / f"{name}.c", [pathlib.Path(sys.argv[1]) / name]) for name in sys.argv[2:]]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = pool.map(lambda run: check(*run), runs)
    names = [source.name for source, _ in runs]
    wrong = {name: fault for name, fault in zip(names, found) if fault}
    for name, fault in wrong.items():
        print(f"{name}: {fault}")
    print(f"{len(names)} samples, {len(wrong)} wrong")
    return 1 if wrong or not names else 0


if __name__ == "__main__":
    sys.exit(main())
