#!/usr/bin/env python3
"""Writes the measures in docs/gallery/README.md from the tables next to its pictures, which `singe measure` made.

usage: gallery_table.py [--check]     --check: changes nothing, fails where the table differs
"""

import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).parent.parent / "docs/gallery"
HEAD = ("| example | ember line | curl over 10 mm, median / p90 | normals where burnt | where not "
        "| jitter of the unburnt | flames pale, lemon |\n")
ROW = re.compile(r"(?:\|.*\|\n)+")


def median(name, measure, digits):
    """A measure's median over the frames, or None where it does not exist."""
    text = (FOLDER / f"{name}.txt").read_text(encoding="utf-8")
    value = re.search(rf"^{re.escape(measure)}.*?(\S+) +\S+ +\S+$", text, re.MULTILINE).group(1)
    return None if value == "-" else f"{float(value):.{digits}f}"


def row(name):
    ember, jitter = median(name, "width of the ember line", 2), median(name, "jitter of the unburnt", 1)
    curl = [median(name, f"curl of the rim over 10 mm, {what}", 0) for what in ("median", "p90")]
    normals = [median(name, f"normal at 3-15 mm where {what}", 1) for what in ("burnt", "not")]
    flames = [median(name, f"flames {what}", 0) for what in ("nearly white", "of one clipped yellow")]
    cells = [name, ember and f"{ember} mm", None if None in curl else f"{curl[0]}° / {curl[1]}°",
             *(n and f"{n}°" for n in normals), jitter and f"{jitter} mm/s",
             None if None in flames else f"{flames[0]} %, {flames[1]} %"]
    return "| " + " | ".join(cell or "-" for cell in cells) + " |\n"


def main():
    page = FOLDER / "README.md"
    old = page.read_text(encoding="utf-8")
    names = re.findall(r"^\| \[([a-z-]+)\]\(#", old, re.MULTILINE)
    begin = old.index(HEAD)
    end = ROW.match(old, begin).end()
    new = old[:begin] + HEAD + "|---|---|---|---|---|---|---|\n" + "".join(map(row, names)) + old[end:]
    if "--check" not in sys.argv[1:]:
        page.write_text(new, encoding="utf-8")
    elif new != old:
        print("docs/gallery/README.md: the measures are not those of the tables; run scripts/gallery_table.py")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
