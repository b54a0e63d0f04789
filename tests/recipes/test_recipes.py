#!/usr/bin/env python3
"""The recipes of docs/extending.md, done exactly as they stand there in a scratch copy of the tree: a solver method,
a kind of source, a kind of collider, a material parameter, a format of frames.

usage: test_recipes.py [--keep FOLDER]

A block of code whose first line is `// FILE, WHERE TEXT` is an edit. WHERE is `in place of`, or says that its lines go
behind the last line, or in front of the first line, that contains TEXT. `// FILE, new` is a file.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EDIT = re.compile(r"```c\n// ([\w/.]+), (in place of|behind the last|in front of) ([^\n]+)\n(.*?)```", re.DOTALL)
NEW = re.compile(r"```c\n// ([\w/.]+), new\n(.*?)```", re.DOTALL)
SCENE = """frames: 12
pace: 4
gas: no
output: {formats: [xyz]}
sheets:
  - grid: {size: [10 cm, 10 cm], cells: [10, 10]}
    translate: [0, 0, 6 cm]
    material: {base: newsprint, char_drag: 4}
sources: [{kind: lamp, flux: 60000}]
colliders: [{kind: pillar, radius: 3 cm, rotation: [90, 0, 0]}]
"""


def apply(text, where, anchor, lines):
    if where == "in place of":
        assert text.count(anchor) >= 1, f"no {anchor}"
        return text.replace(anchor, lines.rstrip("\n"))
    parts = text.splitlines(keepends=True)
    found = [i for i, line in enumerate(parts) if anchor in line]
    assert found, f"no {anchor}"
    at = found[-1] + 1 if where == "behind the last" else found[0]
    return "".join(parts[:at]) + lines + "".join(parts[at:])


def run(*command, cwd, code=0):
    done = subprocess.run([str(part) for part in command], cwd=cwd, capture_output=True, text=True)
    if done.returncode != code:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout + done.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--keep", type=pathlib.Path, help="do it in this folder, and leave it")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        tree = options.keep or pathlib.Path(temporary) / "singe"
        tree.mkdir(parents=True, exist_ok=True)
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
        archive = subprocess.run(["tar", "-c", "--null", "-T", "-"], cwd=ROOT, input=listed, capture_output=True,
                                 check=True).stdout
        subprocess.run(["tar", "-x"], cwd=tree, input=archive, check=True)

        edits = EDIT.findall((ROOT / "docs/extending.md").read_text(encoding="utf-8"))
        new = NEW.findall((ROOT / "docs/extending.md").read_text(encoding="utf-8"))
        for file, lines in new:
            assert not (tree / file).exists(), f"{file} is there already"
            (tree / file).write_text(lines, encoding="utf-8")
        touched = {}
        for file, where, anchor, lines in edits:
            path = tree / file
            path.write_text(apply(path.read_text(encoding="utf-8"), where, anchor, lines), encoding="utf-8")
            touched.setdefault(file, 0)
        print(f"{len(edits)} edits in {len(touched)} files: {', '.join(touched)}")
        print(f"{len(new)} new files: {', '.join(file for file, _ in new)}")
        assert len(touched) <= 11 and len(new) == 2, "a source, a collider, a parameter or a format is two files edited"

        # build without what the recipes do not concern, and write again what follows
        run(sys.executable, "scripts/write_types.py", cwd=tree)
        run("cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DSINGE_TESTS=OFF",
            "-DSINGE_CCACHE=ON", cwd=tree)
        warnings = re.findall(r"warning:.*", run("cmake", "--build", "build", cwd=tree))
        assert not warnings, warnings
        run(sys.executable, "scripts/write_types.py", "--check", cwd=tree)
        run(sys.executable, "bindings/python/generate.py", cwd=tree)
        assert "SINGE_SOURCE_LAMP" in (tree / "bindings/python/singe/_abi.py").read_text(encoding="utf-8")
        document = run("build/singe", "scene-doc", cwd=tree)
        for word in ("`lamp`", "`pillar`", "| `char_drag` |", "`relax`"):
            assert word in document, f"docs/scene.md lacks {word}"

        # burn with them; wrong values are refused with their ranges and words
        (tree / "scene.yaml").write_text(SCENE, encoding="utf-8")
        assert "the source" not in run("build/singe", "check", "scene.yaml", cwd=tree), "the lamp is warned of"
        run("build/singe", "run", "scene.yaml", "-o", "out", "--quiet", "--no-preview", cwd=tree)
        rows = (tree / "out/stats.csv").read_text(encoding="utf-8").splitlines()
        column = rows[0].split(",").index("temperature_max")
        hottest = float(rows[-1].split(",")[column])
        print(f"the lamp heats the sheet to {hottest:.0f} K")
        assert hottest > 400, rows[-1]
        for change, words in (("sheets.0.material.char_drag=-1", "char_drag must be 0 to 1e9"),
                              ("colliders.0.radius=0", "radius must be 1e-6 to 10000"),
                              ("sources.0.kind=lump", "did you mean 'lamp'?"),
                              ("solver=relaxed", "did you mean 'relax'?"),
                              ("output.formats=[xyy]", "did you mean 'xyz'?")):
            found = run("build/singe", "check", "scene.yaml", "--set", change, cwd=tree, code=2)
            assert words in found, f"{change}: {found}"
        run("build/singe", "verify", "out", cwd=tree)
        written = (tree / "out/xyz/scene.0012.xyz").read_bytes()
        assert len(written.splitlines()) >= 121 and len(written.split()) == 3 * len(written.splitlines())
        (tree / "out/xyz/scene.0012.xyz").unlink()
        run("build/singe", "convert", "out", "--to", "xyz", "--quiet", cwd=tree)
        assert (tree / "out/xyz/scene.0012.xyz").read_bytes() == written, "singe convert writes other bytes"

        # the method keeps springs at their lengths
        run("build/singe", "run", "scene.yaml", "-o", "relaxed", "--set", "solver=relax", "--quiet", "--no-preview", cwd=tree)
        rows = (tree / "relaxed/stats.csv").read_text(encoding="utf-8").splitlines()
        strain = float(rows[-1].split(",")[rows[0].split(",").index("strain_mean")])
        print(f"the relaxed springs are {100 * strain:.1f} % off their lengths")
        assert 0 < strain < 0.02, rows[-1]
    return 0


if __name__ == "__main__":
    sys.exit(main())
