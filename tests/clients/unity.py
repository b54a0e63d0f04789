#!/usr/bin/env python3
"""The plug-in for Unity without Unity: its script, compiled by Mono against bindings/unity/tests/Engine.cs, which stands for the
engine, burns a sheet by the native library. Exit code 77 where there is no Mono.

usage: unity.py FOLDER
"""

import os
import pathlib
import shutil
import sys

from plugin import ROOT, build, run

FOLDER = pathlib.Path(sys.argv[1]).resolve()


def main():
    if not shutil.which("mcs") or not shutil.which("mono"):
        print("skipped: no Mono (packages mono-mcs, mono-runtime)")
        sys.exit(77)
    FOLDER.mkdir(parents=True, exist_ok=True)
    library = build(FOLDER, "unity")
    unity = ROOT / "bindings/unity"
    run("mcs", "-langversion:7", "-warnaserror", f"-out:{FOLDER / 'test.exe'}", unity / "SingeSheet.cs",
        *sorted((unity / "tests").glob("*.cs")))
    print(run("mono", FOLDER / "test.exe", env={**os.environ, "LD_LIBRARY_PATH": str(library)}), end="")


if __name__ == "__main__":
    main()
