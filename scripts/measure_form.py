#!/usr/bin/env python3
"""Prints the form of the C sources by folder: lines, blank lines, static functions that are named once, assignments
that are joined by commas, and assertions.

usage: measure_form.py [--bars] [--list statics|commas] [FOLDER...]          (default: src program lab)
       measure_form.py --code          lines of C in the tree, without blank ones and comments, by folder

A static function is named once if its file mentions it in one place besides its definition and declarations. Many of
them mean that readers have to put together what was one thought. An assignment is joined by a comma if it shares its
statement with another one: `a = 1, b = 2;`. Declarations and the heads of loops do not count.

With --bars, exits with 1 if more static functions are named once, or more assignments are joined, than the bars allow.
"""

import argparse
import collections
import pathlib
import re
import sys

# the bars: static functions that are named once, in % of all, and assignments that are joined by commas
ONCE, JOINED = 40.0, 20

DEFINITION = re.compile(r"^static (?!inline\b)(?:[\w]+[ *]+)+?\**(\w+)\(", re.MULTILINE)
WORD = r"[\w\]\[.>)(*-]"
ASSIGNMENT = re.compile(r"(?<![=!<>])(?:[-+*/|&^]|<<|>>)?=(?!=)")


def without_comments(text):
    """The text with comments and the insides of strings blanked; line numbers stay."""
    def blank(match):
        found = match.group()
        return found[0] + "_" * (len(found) - 2) + found[0] if found[0] in "\"'" else re.sub(r"[^\n]", " ", found)
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', blank, text, flags=re.DOTALL)


def statics(text):
    """(name, whether it is named once) of each static function that a text defines."""
    words = collections.Counter(re.findall(r"\w+", text))
    heads = collections.Counter(re.findall(r"^static [^;{}=]*?\b(\w+)\(", text, re.MULTILINE))
    for name in sorted(set(DEFINITION.findall(text))):
        yield name, words[name] - heads[name] == 1


def pieces(statement):
    """The parts of a statement between commas that no brackets hold."""
    depth, begin = 0, 0
    for i, c in enumerate(statement):
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            yield statement[begin:i]
            begin = i + 1
    yield statement[begin:]


def without_brackets(text):
    """The text without what brackets hold."""
    inner = re.sub(r"\([^()\[\]{}]*\)|\[[^()\[\]{}]*\]|\{[^()\[\]{}]*\}", "", text)
    return text if inner == text else without_brackets(inner)


def commas(text):
    """(line, statement) of each statement that joins assignments by commas."""
    for match in re.finditer(r"[^;{}]+;", text):
        statement = match.group().strip()
        number = text.count("\n", 0, match.start() + len(match.group()) - len(match.group().lstrip())) + 1
        statement = re.sub(r"^(?:(?:else|do)\s+|(?:if|for|while|switch)\s*\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)\s*|case [^:]*:\s*)+",
                           "", statement)
        if re.match(r"(for|if|while)\b|#|\\|,\s*\w+ =|return\b|typedef\b|static\b|const\b|enum\b|struct\b", statement):
            continue
        if re.match(r"\w+ ?\*restrict\b|\w+ ?\(\*\w+\)\[", statement):
            continue  # a declaration, as the next
        if re.match(r"[A-Za-z_]\w*(?: \w+)* ?\**(?:const )?\**[A-Za-z_]\w*\s*(?:\[[^]]*\]\s*)*(=|,)", statement) and re.match(
                r"[A-Za-z_]\w*[ *]+[*A-Za-z_]", statement):
            continue  # a declaration
        count = sum(1 for piece in pieces(statement) if ASSIGNMENT.search(without_brackets(piece)))
        if count > 1:
            yield number, " ".join(statement.split())


def count_code(root):
    """Prints the lines of C below a folder that hold more than blanks and comments, by the first part of the path."""
    count = {}
    for file in sorted(path for end in ("c", "h", "def") for path in root.rglob(f"*.{end}")):
        part = file.relative_to(root).parts[0]
        if not re.match(r"build|out$|\.", part):
            lines = without_comments(file.read_text(encoding="utf-8")).splitlines()
            count[part] = count.get(part, 0) + sum(1 for line in lines if line.strip())
    for part, lines in (*sorted(count.items()), ("all", sum(count.values()))):
        print(f"{part:20} {lines:7}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--list", choices=("statics", "commas"))
    parser.add_argument("--bars", action="store_true")
    parser.add_argument("folders", nargs="*", default=["src", "program", "lab"])
    parser.add_argument("--code", action="store_true")
    options = parser.parse_args()
    if options.code:
        count_code(pathlib.Path(__file__).resolve().parents[1])
        return 0
    print(f"{'folder':20} {'files':>6} {'lines':>7} {'blank':>6} {'statics':>8} {'once':>6} {'commas':>7} {'asserts':>8}")
    total = [0] * 7
    for top in options.folders:
        files = sorted(pathlib.Path(top).rglob("*.[ch]"))
        for folder in sorted({file.parent for file in files}):
            row = [0] * 7
            for file in (f for f in files if f.parent == folder):
                lines = file.read_text(encoding="utf-8")
                text = without_comments(lines)
                found, joined = list(statics(text)), list(commas(text))
                if options.list == "statics":
                    for name, once in found:
                        if once:
                            print(f"{file}: {name}")
                if options.list == "commas":
                    for number, statement in joined:
                        print(f"{file}:{number}: {statement}")
                row = [a + b for a, b in zip(row, (1, lines.count("\n"), len(re.findall(r"^$", lines, re.MULTILINE)),
                       len(found), sum(once for _, once in found), len(joined),
                       len(re.findall(r"\bSINGE_ASSERT\(", text))))]
            total = [a + b for a, b in zip(total, row)]
            show(str(folder), row)
    show("all", total)
    once, joined = 100 * total[4] / max(total[3], 1), total[5]
    if options.bars and (once > ONCE or joined > JOINED):
        return f"more than the bars of {ONCE:.0f} % of static functions named once and {JOINED} joined assignments"
    return 0


def show(name, row):
    files, lines, blank, count, once, joined, asserts = row
    print(f"{name:20} {files:6} {lines:7} {100 * blank / max(lines, 1):5.0f}% {count:8} {100 * once / max(count, 1):5.0f}% "
          f"{joined:7} {asserts:8}")


if __name__ == "__main__":
    sys.exit(main())
