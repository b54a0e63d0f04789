"""The commands that torture.py runs, on a tiny scene that has everything, and their results if nothing fails."""

import csv
import dataclasses
import io
import json
import os
import re
import struct
import zlib
from pathlib import Path

HAS_EXR = os.environ.get("SINGE_EXR", "1") == "1"

# burns through at once, tears at a touch; a mesh with a picture on it, a collider of a mesh, gas
SCENE = """\
frames: 3
fps: 24
steps: 2
pace: 40
sheets:
  - grid: {size: [4 cm, 4 cm], cells: [6, 6]}
    rotate: [90, 0, 0]
    translate: [0, 0, 5 cm]
    material: {base: newsprint, strength: 1e-4}
  - mesh: square.obj
    translate: [0, 8 cm, 5 cm]
    material: {thickness: {from: 0.5 mm, to: 1 mm, texture: dots.png}}
pins:
  - sheet: 0
    points: [[-2 cm, 0, 7 cm], [2 cm, 0, 7 cm]]
    radius: 8 mm
colliders:
  - {kind: mesh, mesh: block.obj, position: [0, 0, -10 cm]}
sources:
  - {kind: spot, position: [-2 cm, 0, 5 cm], temperature: 1200 K, conductance: 300, radius: 1 cm}
preview: {size: [16, 16], samples: 1}
gas: {cell_size: 2 cm}
"""


def square():
    """3 × 3 quads in the x-y plane, with uv."""
    lines = [f"v {x / 75} {y / 75} 0" for y in range(4) for x in range(4)]
    lines += [f"vt {x / 3} {y / 3}" for y in range(4) for x in range(4)]
    for y in range(3):
        for x in range(3):
            a = 4 * y + x + 1
            lines.append("f " + " ".join(f"{v}/{v}" for v in (a, a + 1, a + 5, a + 4)))
    return "\n".join(lines) + "\n"


def block():
    """A closed cube of 2 cm."""
    lines = [f"v {x * .02} {y * .02} {z * .02}" for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
    return "\n".join(lines + ["f " + " ".join(map(str, f)) for f in faces]) + "\n"


def picture(side=8):
    """A grey PNG of stripes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes((x * 37 + y * 11) % 256 for x in range(side)) for y in range(side))
    header = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_scene(folder):
    for name, data in (("tiny.yaml", SCENE.encode()), ("square.obj", square().encode()),
                       ("block.obj", block().encode()), ("dots.png", picture())):
        Path(folder, name).write_bytes(data)


def write_ffmpeg(folder):
    """A program of that name that is quick and always makes the same of the same pictures."""
    path = os.path.join(folder, "ffmpeg")
    with open(path, "w") as file:
        file.write('#!/bin/sh\nwhile [ $# -gt 1 ]; do\n  [ "$1" = -i ] && input=${2#file:}\n  shift\ndone\n'
                   'cat "${input%/*}"/*.png > "${1#file:}"\n')
    os.chmod(path, 0o755)


@dataclasses.dataclass(frozen=True)
class Scenario:
    name: str
    command: tuple  # FOLDER is the folder of the cache
    before: tuple   # commands that make what lies there before; () for nothing
    goes_on: tuple = ()  # how the run is made up afterwards; () for what is no run
    kinds: tuple = ()    # what fails; () for all
    slow: bool = False   # takes seconds: less of it in a sample


def run(*more):
    return ("run", "tiny.yaml", "-o", "FOLDER", "--threads", "1", *more)


def scenarios():
    plain, early = run("--no-preview"), run("--no-preview", "--frames", "2")
    resume = run("--no-preview", "--resume")
    found = [
        Scenario("run", plain, (), resume),
        Scenario("run over another", plain, (run("--no-preview", "--set", "pace=20", "--frames", "5"),), resume),
        Scenario("resume", resume, (early,), resume),
        Scenario("run on threads", (*plain[:-2], "3", "--no-preview"), (), resume, ("thread",)),
        Scenario("check", ("check", "tiny.yaml", "--threads", "1"), (), slow=True),
        Scenario("verify", ("verify", "FOLDER", "--csv", "FOLDER/verify.csv"), (plain,)),
        Scenario("measure", ("measure", "FOLDER", "--csv", "FOLDER/measure.csv"), (plain,)),
    ]
    layers = ("--exr",) if HAS_EXR else ()
    whole = run(*layers)
    found += [
        Scenario("run with pictures", whole, (), (*whole, "--resume")),
        Scenario("render", ("render", "FOLDER", "--threads", "1", "--sheet", "2x2", "--gif"), (plain,)),
    ]
    return found


# ---- what is left, in a form that can be compared

def read(path):
    return Path(path).read_bytes()


def stats_rows(data):
    """Rows without what a clock measured. Raises ValueError where a line is not whole."""
    text = data.decode()
    if text and not text.endswith("\n"):
        raise ValueError("a line is cut")
    rows = list(csv.reader(io.StringIO(text)))
    if not rows:
        return []
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith("ms_")]
    if any(len(row) != len(rows[0]) for row in rows):
        raise ValueError("a line is cut")
    return [[row[i] for i in kept] for row in rows]


def record_fields(data):
    record = json.loads(data)
    # counts and drawn: of the sheets as the run began, or went on, to burn them
    for key in ("seconds", "started", "resumed_from", "threads", "scene_folder", "drawn", "counts"):
        record.pop(key, None)
    return record


# A checkpoint, and the one before it: when each was written depends on where a run was interrupted.
CHECKPOINTS = ("checkpoint.singe", "checkpoint.previous.singe")


def comparable(name, data):
    if name == "stats.csv":
        return stats_rows(data)
    if name == "run.json":
        return record_fields(data)
    if name in CHECKPOINTS:
        return None  # it holds times, so its bytes differ; that a run resumes from it is checked elsewhere
    return zlib.crc32(data), len(data)


def contents(folder):
    """Every file of the folder by its name in it."""
    found = {}
    for path, _, names in os.walk(folder):
        for name in names:
            whole = os.path.join(path, name)
            found[os.path.relpath(whole, folder)] = read(whole)
    return found


def printed(text):
    """The output of a command without measured times."""
    return re.sub(r"^(time|memory) .*$", "", text, flags=re.M)
