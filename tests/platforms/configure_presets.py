#!/usr/bin/env python3
"""Configures every CMake preset into a folder of its own: configure_presets.py SOURCE FOLDER

A preset whose compiler is missing is skipped, with a message. Fails if another one cannot be configured.
"""
import json
import pathlib
import shutil
import subprocess
import sys

COMPILERS = {"windows": "x86_64-w64-mingw32-gcc-win32", "arm64": "aarch64-linux-gnu-gcc", "fuzz": "clang", "wasm": "wasm-ld"}


def compiler_missing(name):
    if name == "macos":
        done = subprocess.run([sys.executable, "-m", "ziglang", "version"], capture_output=True)
        return "PyPI's ziglang" if done.returncode else None
    compiler = COMPILERS.get(name)
    return compiler if compiler and not shutil.which(compiler) else None


def main():
    source, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    presets = json.loads((source / "CMakePresets.json").read_text())["configurePresets"]
    names = [preset["name"] for preset in presets if not preset.get("hidden")]
    bad = []
    for name in names:
        lack = compiler_missing(name)
        if lack:
            print(f"skipped {name}: there is no {lack}")
            continue
        shutil.rmtree(work / name, ignore_errors=True)
        done = subprocess.run(["cmake", "--preset", name, "-S", source, "-B", work / name], capture_output=True,
                              text=True, cwd=source)
        print(f"{name}: {'configured' if done.returncode == 0 else 'failed'}")
        if done.returncode:
            bad.append(name)
            print(done.stderr[-2000:])
        shutil.rmtree(work / name, ignore_errors=True)
    if bad:
        print(f"{len(bad)} of {len(names)} presets cannot be configured: {', '.join(bad)}")
    return 1 if bad or not names else 0


sys.exit(main())
