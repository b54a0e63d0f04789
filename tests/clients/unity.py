#!/usr/bin/env python3
"""The plug-in for Unity without Unity: its script, compiled by Mono against bindings/unity/tests/Engine.cs, which stands for the
engine, burns a sheet by the native library. Exit code 77 where there is no Mono.

usage: unity.py FOLDER
"""

import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = pathlib.Path(sys.argv[1]).resolve()


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


def main():
    if not shutil.which("mcs") or not shutil.which("mono"):
        print("skipped: no Mono (packages mono-mcs, mono-runtime)")
        sys.exit(77)
    FOLDER.mkdir(parents=True, exist_ok=True)
    run("cmake", "-S", ROOT, "-B", FOLDER / "build", "-DCMAKE_BUILD_TYPE=Release", "-DSINGE_UNITY=ON",
        *(f"-DSINGE_{part}=OFF" for part in ("PROGRAM", "TESTS", "PYTHON")))
    run("cmake", "--build", FOLDER / "build", "--target", "singe_unity", "-j2")
    unity = ROOT / "bindings/unity"
    run("mcs", "-langversion:7", "-warnaserror", f"-out:{FOLDER / 'test.exe'}", unity / "SingeSheet.cs",
        *sorted((unity / "tests").glob("*.cs")))
    print(run("mono", FOLDER / "test.exe", env={**os.environ, "LD_LIBRARY_PATH": str(FOLDER / "build/unity")}), end="")


if __name__ == "__main__":
    main()
