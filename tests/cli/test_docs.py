"""Numbers and options on the pages are those of the program."""

import json
import os
import re
import shlex
from pathlib import Path

from support import Case

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def page(name):
    return Path(ROOT, "docs", name).read_text(encoding="utf-8")


def documented(text):
    """(material, key, value) of the tables of docs/materials.md, as they are written."""
    rows = []
    for name, section in re.findall(r"^### ([^\n]+)\n(.*?)(?=^##)", text, re.MULTILINE | re.DOTALL):
        material = name.lower().replace(" ", "-")
        for keys, value in re.findall(r"^\| (`[^|]+`) \| ([^|]*?) \| ", section, re.MULTILINE):
            keys = re.findall(r"`([^`]+)`", keys)
            values = value.split(", ")
            unit = re.search(r" [^0-9. ].*$", values[-1])  # that of the last is that of all
            if not value:
                continue  # described elsewhere
            assert len(keys) == len(values), (keys, value)
            for key, one in zip(keys, values):
                rows.append((material, key, one if " " in one or not unit else one + unit.group()))
    return rows


class Tutorials(Case):
    """Commands of all pages are good, as are the scenes of docs/tutorials; their C is that of the samples. test_sim runs
    the Python."""

    def blocks(self, kind):
        folder = os.path.join(ROOT, "docs", "tutorials")
        return [(name, block) for name in sorted(os.listdir(folder))
                for block in re.findall(rf"^```{kind}\n(.*?)^```$", page(os.path.join("tutorials", name)), re.MULTILINE | re.DOTALL)]

    def test_commands(self):
        """Those of all pages: commands and options exist. Options of USD are those of the Python package."""
        root, options, found = Path(ROOT), {}, 0
        pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
        for path in pages:
            text = path.read_text(encoding="utf-8")
            blocks = re.findall(r"^```\w*\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
            lines = re.findall(r"^(?:build/)?singe (.*)$", "\n".join(blocks).replace("\\\n", " "), re.MULTILINE)
            for line in lines + re.findall(r"`(?:build/)?singe ([a-z][^`]*)`", text.replace("\n", " ")):
                words = shlex.split(line, comments=True)
                whose = tuple(words[:2 if words[0] == "bench" and len(words) > 1 and words[1].islower() else 1])
                if not re.fullmatch("[a-z-]+", words[0]) or "--sheets /" in line:
                    continue
                if whose not in options:
                    options[whose] = set(re.findall(r"--?[a-z-]+", self.singe(*whose, "--help")[0]))
                for word in words[1:words.index("|") if "|" in words else None]:
                    found += 1
                    if re.match("--?[a-z]", word):
                        self.assertIn(word.split("=")[0], options[whose], f"{path.relative_to(root)}: singe {line}")
        self.assertGreater(found, 500)

    def test_scenes(self):
        names = []
        for _, block in self.blocks("yaml"):
            names.append(re.match(r"# ([\w.]+)", block).group(1))
            Path(self.path(names[-1])).write_text(block)
        self.singe("check", self.path("strip.yaml"), "--set", "sheets.0.grid.cells=[10, 2]")
        self.singe("sweep", self.path("strips.yaml"), "-o", self.path("out"), "--print")
        self.assertEqual(names, ["strip.yaml", "strips.yaml", "fit.yaml"])

    def test_c(self):
        for name, block in self.blocks("c"):
            file, lines = re.fullmatch(r"// ([\w.]+)\n(.*)", block, re.DOTALL).groups()
            self.assertIn(lines, Path(ROOT, "docs/samples", file).read_text(), f"{name}: {file} has other lines")


class Docs(Case):
    def materials(self, texts):
        """The resolved materials of one sheet each."""
        sheets = [{"grid": {"size": [0.1, 0.1], "cells": [2, 2], "jitter": 0}, "translate": [i, 0, 0], "material": text}
                  for i, text in enumerate(texts)]
        with open(self.path("all.yaml"), "w", encoding="utf-8") as file:
            json.dump({"frames": 1, "gas": False, "contact": False, "sheets": sheets}, file, ensure_ascii=False)
        self.singe("run", self.path("all.yaml"), "-o", self.path("o"), "--no-preview", "--quiet")
        return [sheet["material"] for sheet in self.record("o")["scene"]["sheets"]]

    def test_materials(self):
        rows = documented(page("materials.md"))
        self.assertGreater(len(rows), 40)
        names = sorted({material for material, _, _ in rows})
        self.assertEqual(names, ["cotton", "newsprint", "office-paper", "one-reaction", "tissue"])
        said = []
        for material, key, value in rows:
            patches = re.fullmatch(r"([0-9.]+) to ([0-9.]+)( .+)? in patches of (.*)", value)
            if patches:
                low, high, unit, scale = patches.groups()
                value = {"from": low + (unit or ""), "to": high + (unit or ""), "noise": {"scale": scale, "octaves": 2, "seed": 2}}
            given = {"base": material}
            inner = given
            *outer, last = key.split(".")
            for name in outer:
                inner = inner.setdefault(name, {})
            inner[last] = value.replace(" %", "%") if isinstance(value, str) else value
            said.append(given)
        resolved = self.materials(names + said)
        built_in = dict(zip(names, resolved))
        for (material, key, value), changed in zip(rows, resolved[len(names):]):
            with self.subTest(material=material, key=key, value=value):
                plain = dict(built_in[material])
                plain.pop("measured", None), changed.pop("measured", None)  # a changed material does not inherit these
                for one in plain, changed:  # detail and seed of patches are not reported
                    if isinstance(one.get(key), dict) and "noise" in one[key]:
                        one[key] = dict(one[key], noise=one[key]["noise"]["scale"])
                self.assertEqual(changed, plain)

    def test_grades(self):
        """docs/validation.md has the grades that the command has, and README.md their numbers."""
        self.singe("validate", "--only", "grades", "-o", self.path("page"))
        grades = self.table("page", "grades.csv")
        rows = [[cell.strip(" `") for cell in line.strip().strip("|").split("|")]
                for line in page("validation.md").splitlines() if line.startswith("| `")]
        self.assertEqual(rows, [[g["item"], g["measure"], g["grade"], g["bar"], g["compared with"]] for g in grades])
        count = {grade: sum(g["grade"] == grade for g in grades) for grade in
                 ("independent", "calibrated", "by construction")}
        missing = sum(g["bar"] == "misses" for g in grades)
        said = (f"Of {len(grades)} [checks of the physics](docs/validation.md) {count['independent']} are independent, "
                f"{count['calibrated']} calibrated and {count['by construction']} by construction; {missing} miss.")
        self.assertIn(said, " ".join(Path(ROOT, "README.md").read_text().split()))

    def test_options(self):
        """The synopsis of docs/cli.md has every option of every command, and no other."""
        synopsis = re.search(r"```\n(singe run.*?)```", page("cli.md"), re.DOTALL).group(1)
        synopsis = re.sub(r"\n +", " ", synopsis)
        for command in "run", "check", "render", "measure", "verify", "paper", "validate":
            with self.subTest(command):
                line = re.search(rf"^singe {command} .*$", synopsis, re.MULTILINE).group()
                listed = set(re.findall(r"\[(?:-\w\|)?(--?[a-z-]+)", line))
                help = re.findall(r"^  (?:-(\w), |    )--([a-z-]+)", self.singe(command, "--help")[0], re.MULTILINE)
                for letter, name in help:
                    if name == "help":
                        continue
                    self.assertTrue({f"--{name}", f"-{letter}"} & listed, name)
                    listed -= {f"--{name}", f"-{letter}"}
                self.assertFalse(listed)
