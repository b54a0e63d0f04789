#!/usr/bin/env python3
"""Checks that every relative link of the Markdown files leads to a file and, where it names one, to a heading there;
that source files which they name exist; and that every folder of C sources has a README.md, which says what it is for.

usage: check_links.py ROOT
"""

import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)\s]+)\)")
SOURCE = re.compile(r"`((?:[\w-]+/)*[a-z][a-z0-9_]*\.(?:c|h|def|py|sh))`")  # `_v3.c` and `formats/NAME.c` are no names
CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
SKIPPED = re.compile(r"^(build.*|out|\..*|node_modules)$")


def anchors(text):
    """The names that GitHub gives headings: lower case, spaces as hyphens, no other punctuation."""
    found = set()
    for heading in re.findall(r"^#+ +(.*?)\s*$", CODE.sub("", text), re.MULTILINE):
        name = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "", heading).lower()).replace(" ", "-")
        found.add(name if name not in found else next(f"{name}-{i}" for i in range(1, 99) if f"{name}-{i}" not in found))
    return found


def silent_folders(root):
    """Folders of C sources without a README.md, but for tests, examples, and parts of another folder."""
    folders = {f.relative_to(root).parent for part in ("src/*/*.c", "program/*/*.c", "lab/*/*.c") for f in root.glob(part)}
    return [f for f in sorted(folders) if not SKIPPED.match(f.parts[0]) and f.parts[0] not in ("tests", "examples")
            and not (root / f / "README.md").exists()]


def sources(root):
    """Source files by their names, and by every end of their paths."""
    found = set()
    for file in root.rglob("*.*"):
        parts = file.relative_to(root).parts
        if file.suffix in (".c", ".h", ".def", ".py", ".sh") and not any(SKIPPED.match(part) for part in parts[:-1]):
            found.update("/".join(parts[i:]) for i in range(len(parts)))
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    files = [f for f in sorted(root.rglob("*.md")) if not any(SKIPPED.match(p) for p in f.relative_to(root).parts[:-1])]
    texts = {f.resolve(): f.read_text(encoding="utf-8") for f in files}
    bad = links = 0
    known = sources(root)
    for file in files:
        body = CODE.sub(lambda match: "\n" * match.group().count("\n"), texts[file.resolve()])
        for number, line in enumerate(body.split("\n"), 1):
            for name in SOURCE.findall(line):
                if name not in known and file.name != "CHANGELOG.md":
                    print(f"{file.relative_to(root)}:{number}: there is no {name}")
                    bad += 1
            for link in LINK.findall(re.sub(r"`[^`]*`", "", line)):
                if re.match(r"[a-z]+:", link):
                    continue
                links += 1
                path, _, anchor = link.partition("#")
                target = (file.parent / path).resolve() if path else file.resolve()
                if not target.exists():
                    print(f"{file.relative_to(root)}:{number}: there is no {link}")
                elif anchor and target in texts and anchor not in anchors(texts[target]):
                    print(f"{file.relative_to(root)}:{number}: {path or 'the page'} has no heading #{anchor}")
                else:
                    continue
                bad += 1
    for folder in silent_folders(root):
        print(f"{folder}: has no README.md")
        bad += 1
    print(f"{links} links in {len(files)} files, {bad} bad")
    return 1 if bad or not links else 0


if __name__ == "__main__":
    sys.exit(main())
