#!/usr/bin/env python3
"""The module for Unreal without Unreal: its component, compiled against bindings/unreal/tests/engine, which stands for the
engine, burns a sheet. Exit code 77 where there is no C++ compiler.

usage: unreal.py FOLDER
"""

import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = pathlib.Path(sys.argv[1]).resolve()
UNREAL = ROOT / "bindings/unreal"


def run(*command):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


def main():
    compiler = os.environ.get("CXX") or shutil.which("c++")
    if not compiler:
        print("skipped: no C++ compiler")
        sys.exit(77)
    FOLDER.mkdir(parents=True, exist_ok=True)
    run("cmake", "-S", ROOT, "-B", FOLDER / "build", "-DCMAKE_BUILD_TYPE=Release", "-DSINGE_UNREAL=ON",
        *(f"-DSINGE_{part}=OFF" for part in ("PROGRAM", "TESTS", "PYTHON")))
    run("cmake", "--build", FOLDER / "build", "--target", "singe_unreal", "-j2")
    run(compiler, "-std=c++20", "-O2", "-Wall", "-Wextra", "-Werror", "-I", UNREAL / "tests/engine", "-I",
        UNREAL / "Source/SingeUnreal/Public", "-I", ROOT / "bindings/engines", "-I", ROOT / "include",
        *sorted((UNREAL / "Source/SingeUnreal/Private").glob("*.cpp")), UNREAL / "tests/test.cpp",
        FOLDER / "build/unreal/libsinge_unreal.a", "-lm", "-pthread", "-o", FOLDER / "test")
    print(run(FOLDER / "test"), end="")


if __name__ == "__main__":
    main()
