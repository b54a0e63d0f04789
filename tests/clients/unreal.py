#!/usr/bin/env python3
"""The module for Unreal without Unreal: its component, compiled against bindings/unreal/tests/engine, which stands for the
engine, burns a sheet. Exit code 77 where there is no C++ compiler.

usage: unreal.py FOLDER
"""

import os
import pathlib
import shutil
import sys

from plugin import ROOT, build, run

FOLDER = pathlib.Path(sys.argv[1]).resolve()
UNREAL = ROOT / "bindings/unreal"


def main():
    compiler = os.environ.get("CXX") or shutil.which("c++")
    if not compiler:
        print("skipped: no C++ compiler")
        sys.exit(77)
    FOLDER.mkdir(parents=True, exist_ok=True)
    library = build(FOLDER, "unreal") / "libsinge_unreal.a"
    run(compiler, "-std=c++20", "-O2", "-Wall", "-Wextra", "-Werror", "-I", UNREAL / "tests/engine", "-I",
        UNREAL / "Source/SingeUnreal/Public", "-I", ROOT / "bindings/engines", "-I", ROOT / "include",
        *sorted((UNREAL / "Source/SingeUnreal/Private").glob("*.cpp")), UNREAL / "tests/test.cpp",
        library, "-lm", "-pthread", "-o", FOLDER / "test")
    print(run(FOLDER / "test"), end="")


if __name__ == "__main__":
    main()
