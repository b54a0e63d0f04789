#!/usr/bin/env python3
"""Moves what several locks of a folder hold alike, and at length, to shared/NAME-VERSION.txt there, which they include.

usage: share_locks.py FOLDER
"""

import collections
import pathlib
import re
import sys

LONG = 10  # lines: a package with fewer stays where it is needed
HEAD = "# made by scripts/lock.sh\n"


def packages_of(path):
    """The packages of a lock, with their hashes, and of what it includes."""
    found = []
    for package in re.split(r"\n(?=\S)", path.read_text().removeprefix(HEAD).strip()):
        found += packages_of(path.parent / package[3:]) if package.startswith("-r ") else [package]
    return found


def main():
    folder = pathlib.Path(sys.argv[1])
    locks = {path: packages_of(path) for path in folder.glob("*.txt")}
    shared = folder / "shared"
    shared.mkdir(exist_ok=True)
    for old in shared.glob("*.txt"):
        old.unlink()
    users = collections.Counter(package for packages in locks.values() for package in packages)

    for path, packages in locks.items():
        lines = []
        for package in packages:
            if users[package] > 1 and package.count("\n") >= LONG:
                name = "-".join(re.match(r"([\w.-]+)==(\S+)", package).groups()) + ".txt"
                (shared / name).write_text(f"{HEAD}{package}\n")
                package = f"-r shared/{name}"
            lines.append(package)
        path.write_text(HEAD + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
