#!/usr/bin/env python3
"""The binary interface: what the libraries export, and sizes, offsets and enumerators of the public headers.

usage: abi.py --cc CC --include DIR [--update] FILE ARCHIVE...

Compares with FILE, or writes it. What is in FILE and missing or different now breaks programs that were linked before.
"""

import argparse
import difflib
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def exported(archive):
    """Defined names with default visibility."""
    shown = subprocess.run(["readelf", "-sW", archive], capture_output=True, text=True, check=True).stdout
    names = set()
    for line in shown.splitlines():
        words = line.split()
        if len(words) == 8 and words[4] in ("GLOBAL", "WEAK") and words[5] == "DEFAULT" and words[6] != "UND":
            names.add(words[7])
    return sorted(names)


def declared(cc, include):
    """Structs with their fields, and enumerators, of singe/singe.h without its macros."""
    text = subprocess.run([cc, "-E", "-P", "-I", include, "-include", "singe/singe.h", "-x", "c", "/dev/null"],
                          capture_output=True, text=True, check=True).stdout
    structs, enumerators = [], []
    for fields, name in re.findall(r"typedef struct \w*\s*\{([^{}]*)\}\s*(Singe\w+);", text):
        names = []
        for field in fields.split(";"):
            field = re.sub(r"\([^()]*\)\s*$", "", field.strip())  # a function's arguments
            if not field:
                continue
            inner = re.search(r"\(\s*\*\s*(\w+)", field)
            if inner:
                names.append(inner.group(1))
            else:
                names += [re.search(r"(\w+)\s*(\[[^\]]*\]\s*)*$", part.strip()).group(1) for part in field.split(",")]
        structs.append((name, names))
    for body in re.findall(r"enum \w*\s*\{([^{}]*)\}", text):
        enumerators += [e for e in re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", body.strip()) if e.startswith("SINGE_")]
    return structs, enumerators


def measured(cc, include):
    structs, enumerators = declared(cc, include)
    lines = ['#include <singe/singe.h>', '#include <stdio.h>', 'int main(void) {']
    for name, fields in sorted(structs):
        lines.append(f'printf("struct {name} %zu\\n", sizeof({name}));')
        for field in fields:
            lines.append(f'printf("  {name}.{field} %zu\\n", offsetof({name}, {field}));')
    for name in sorted(enumerators):
        lines.append(f'printf("enum {name} %d\\n", (int){name});')
    lines.append("return 0; }")
    with tempfile.TemporaryDirectory() as folder:
        source, program = os.path.join(folder, "abi.c"), os.path.join(folder, "abi")
        Path(source).write_text("\n".join(lines), encoding="utf-8")
        subprocess.run([cc, "-I", include, source, "-o", program], check=True)
        return subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--include", required=True)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("file")
    parser.add_argument("archives", nargs="+")
    options = parser.parse_args()
    found = []
    for archive in options.archives:
        name = os.path.basename(archive)
        strangers = [s for s in exported(archive) if not s.startswith("singe_")]
        if strangers:
            sys.exit(f"{name} exports names that do not begin with singe_: {' '.join(strangers)}")
        found += [f"{name} {symbol}" for symbol in exported(archive)]
    found += measured(options.cc, options.include)
    if options.update:
        Path(options.file).write_text("\n".join(found) + "\n", encoding="utf-8")
        return
    kept = Path(options.file).read_text(encoding="utf-8").splitlines()
    changes = [line for line in difflib.unified_diff(kept, found, options.file, "now", lineterm="", n=0)]
    if changes:
        print("\n".join(changes))
        sys.exit("the binary interface has changed: CONTRIBUTING.md, Versions, says what to do")
    print(f"{len(found)} symbols, sizes, offsets and enumerators are as they were")


if __name__ == "__main__":
    main()
