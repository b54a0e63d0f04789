#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the extension's file, which Blender installs: bindings/blender/build.py [--wheels FOLDER] [--out FOLDER]

--wheels: wheels of bindings/python/build_wheels.py, put inside unmodified; the program comes with those of Linux. One file a
platform, named singe-VERSION-PLATFORM.zip; without wheels singe-VERSION.zip, which needs a program that is installed.
"""

import argparse
import pathlib
import re
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE / "singe_extension"
PLATFORMS = {"manylinux_2_28_x86_64": "linux-x64", "manylinux_2_28_aarch64": "linux-arm64", "win_amd64": "windows-x64",
             "macosx_13_0_arm64": "macos-arm64", "macosx_13_0_x86_64": "macos-x64"}
LICENCE = pathlib.Path("/usr/share/common-licenses/GPL-3")


def pack(out, version, platform=None, wheel=None):
    manifest = (SOURCE / "blender_manifest.toml").read_text()
    head, permissions = manifest.split("[permissions]")
    if wheel:
        head += f'platforms = ["{platform}"]\nwheels = ["./wheels/{wheel.name}"]\n\n'
    path = out / (f"singe-{version}-{platform}.zip" if wheel else f"singe-{version}.zip")
    out.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        def add(name, data):
            packed.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)

        add("blender_manifest.toml", head + "[permissions]" + permissions)
        for file in sorted(SOURCE.glob("*.py")):
            add(file.name, file.read_bytes())
        add("LICENSE", (HERE / "LICENSE").read_bytes())
        if LICENCE.exists():
            add("GPL-3.txt", LICENCE.read_bytes())
        if wheel:
            add(f"wheels/{wheel.name}", wheel.read_bytes())
    print(path)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--wheels", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=HERE.parents[1] / "build" / "blender")
    options = parser.parse_args()
    version = re.search(r'^version = "(.*)"', (SOURCE / "blender_manifest.toml").read_text(), re.M).group(1)
    wheels = sorted(options.wheels.glob("singe-*.whl")) if options.wheels else []
    for wheel in wheels:
        tag = wheel.stem.split("-")[-1]
        if tag in PLATFORMS:
            pack(options.out, version, PLATFORMS[tag], wheel)
    if not wheels:
        pack(options.out, version)


if __name__ == "__main__":
    main()
