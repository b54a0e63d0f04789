#!/usr/bin/env python3
"""Draws scenes at the limits of what is legal.

extremes.py DRAW_SCENE SEED

Prints one scene as JSON. A small burning sheet is taken to extremes in two ways: values at an end of their range, which
`DRAW_SCENE --ends` reads from the schema's tables, and storms, which are combinations that no single range shows. Even
seeds put one value of one key into an otherwise mild scene, each in turn; odd seeds mix. What only makes a scene long
stays mild: a scene costs little, so that a limit on its time is a bar.
"""

import json
import random
import subprocess
import sys

# keys whose end is a request for more work or memory, each with what it is where a scene is to be run
COSTS = {"frames": 3, "steps": 100, "sheets.0.grid.cells": [14, 1], "solver.substeps": 40, "solver.projections": 40,
         "gas.cell_size": 0.1, "gas.height": 1, "gas.detail": 2, "preview.size": [64, 48], "preview.samples": 2,
         "output.texture_size": 64}
# what nothing is computed from, or what a scene with a grid cannot have
UNUSED = ("sheets.0.material.measured", "sheets.0.weld", "sheets.0.quads", "sheets.0.up", "sheets.0.units",
          "sheets.0.render_mesh")
FILES = ("texture", "heightfield", "mesh", "arrival", "")  # kinds that need a file, or have no word


def read_ends(draw):
    """The keys with a range: dicts of path, kinds, values and length."""
    lines = subprocess.run([draw, "--ends"], stdout=subprocess.PIPE, check=True, text=True).stdout.splitlines()
    rows = []
    for row in map(json.loads, lines):
        kinds = row["kinds"]
        row["kinds"] = [kind for kind in kinds if kind not in FILES]
        row["values"] = [value for value in row["values"] if value not in FILES]
        if kinds and not row["kinds"]:
            continue
        if "motion" not in row["path"] and not row["path"].startswith(UNUSED):
            rows.append(row)
    return rows


MOST_CELLS_OF_SYSTEMS = 8  # along a side


def mild(random_, cells=9):
    """A sheet that burns, falls on a plane and is held at a corner."""
    return {"frames": 3, "steps": 5, "preview": {"size": [32, 32], "samples": 1},
            "sheets": [{"grid": {"size": [0.08, 0.06], "cells": [cells, cells - 2]},
                        "material": {"base": random_.choice(["office-paper", "newsprint", "cotton"])}}],
            "sources": [{"kind": "spot", "position": [0.03, 0.02, 0.001], "radius": 0.01}],
            "colliders": [{"kind": "plane", "position": [0, 0, -0.01]}],
            "pins": [{"vertices": [0]}]}


def put(scene, row, value):
    """Sets the value at a path of keys and numbers of items, and makes what it lies in."""
    keys = [int(key) if key.isdigit() else key for key in row["path"].split(".")]
    at = scene
    for key, following in zip(keys, keys[1:]):
        if isinstance(key, int):
            while len(at) <= key:
                at.append({})
        elif not isinstance(at.get(key), (dict, list)):
            at[key] = [] if isinstance(following, int) else {}
        at = at[key]
        if key == 0 and row["kinds"] and at.get("kind") not in row["kinds"]:
            at.clear()
            at["kind"] = row["kinds"][0]
    if keys[-1] == "kind":
        at.clear()  # the keys of another kind
    at[keys[-1]] = [value] * row["length"] if row["length"] and not isinstance(value, list) else value
    complete(scene)


def complete(scene):
    """Adds what the keys that are set require, and takes away what excludes them."""
    for item in scene.get("colliders", []) + scene.get("sources", []) + scene.get("pins", []):
        if "path" in item:
            for key in ("position", "rotation"):
                item.pop(key, None)
            for number, moment in enumerate(item["path"]):
                moment.setdefault("time", float(number))
    for source in scene.get("sources", []):
        if "path" in source:
            source["kind"] = "ball"
        else:
            source.setdefault("kind", "spot")
            source.setdefault("position", [0.03, 0.02, 0.001])
        if source.get("end", 1) != "inf" and source.get("end", 1) <= source.get("start", 0):
            source.pop("end", None)
    for collider in scene.get("colliders", []):
        collider.setdefault("kind", "plane")
    for number, key in enumerate(scene["pace"] if isinstance(scene.get("pace"), list) else []):
        key.setdefault("time", float(number))
        key.setdefault("value", 1)
    for probe in scene.get("probes", []):
        probe.setdefault("kind", "uv")
        probe.setdefault("at", [0.5, 0.5] if probe["kind"] == "uv" else [0, 0, 0])


# ---- storms

def power(random_, low, high):
    """Between two powers of ten, evenly in the exponent."""
    return float(f"{10 ** random_.uniform(low, high):.3g}")


def direction(random_, length):
    return [float(f"{length * random_.uniform(-1, 1):.3g}") for _ in range(3)]


def thick(scene, random_):
    """Sheets thicker than their cells, or thin as a film."""
    scene["sheets"][0].setdefault("material", {})["thickness"] = power(random_, -6, 2)


def gale(scene, random_):
    scene["wind"] = {"velocity": direction(random_, power(random_, 0, 3)), "gust": power(random_, -1, 3),
                     "gust_time": power(random_, -6, 1), "gust_size": power(random_, -6, 1)}


def heavy(scene, random_):
    scene["gravity"] = direction(random_, power(random_, 1, 4))


def whip(scene, random_):
    """Pins that are torn along at up to 100 m/s, and turned."""
    path = [{"time": 0, "position": [0, 0, 0]}]
    for _ in range(random_.randint(1, 4)):
        time = path[-1]["time"] + power(random_, -3, -1)
        way = direction(random_, 100 * (time - path[-1]["time"]))
        path.append({"time": time, "position": [a + b for a, b in zip(path[-1]["position"], way)],
                     "rotation": direction(random_, power(random_, 0, 4))})
    scene["pins"] = [{"vertices": [0, 5], "path": path}]
    if random_.random() < 0.3:  # two that part
        scene["pins"].append({"vertices": [3]})


def plates(scene, random_):
    """Two boxes that close on the sheet, and sometimes through each other."""
    end = random_.choice([0.05, 0.049, 0.0501, 0])
    kind = random_.choice(["box", "sphere", "capsule"])
    size = {"half_size": [0.05, 0.05, 0.05]} if kind == "box" else {"radius": 0.05}
    scene["colliders"] = [{"kind": kind, **size, "friction": power(random_, -2, 3), "path": [
        {"time": 0, "position": [0, 0, sign * 0.07]}, {"time": power(random_, -2, -1), "position": [0, 0, sign * end]}]}
                          for sign in (-1, 1)]


def twins(scene, random_):
    """Sheets that lie in each other: at the same place, turned over, or nearly so."""
    for _ in range(random_.randint(1, 2)):
        twin = json.loads(json.dumps(scene["sheets"][0]))
        twin["rotate"] = random_.choice([[0, 0, 0], [180, 0, 0], [0, 180, 0], [0, 0, 180], [90, 0, 0], [0, 0, 1e-4]])
        twin["translate"] = random_.choice([[0, 0, 0], [0, 0, power(random_, -9, -3)], [1e-9, 0, 0]])
        scene["sheets"].append(twin)


def slivers(scene, random_):
    """Cells up to a million times as long as wide."""
    cells = random_.choice([[1, 40], [60, 1], [2, 2], [1, 1], [30, 3]])
    scene["sheets"][0]["grid"] = {"size": [power(random_, -5, 1), power(random_, -5, 1)], "cells": cells,
                                  "jitter": random_.choice([0, 0.15, 0.3])}


def sizes(scene, random_):
    """Sheets of a millimetre and of a hundred metres, alone or together."""
    scales = random_.choice([[1e-2], [1e3], [1e-2, 1e3], [1e-4, 1], [1e4]])
    grids = [json.loads(json.dumps(scene["sheets"][0])) for _ in scales]
    for sheet, scale in zip(grids, scales):
        sheet["grid"]["size"] = [float(f"{min(max(scale * x, 1e-6), 1e4):.3g}") for x in sheet["grid"]["size"]]
        if scale > 1 and len(scales) > 1:
            sheet["translate"] = [0, 0, random_.choice([0, 0.01, -1])]
    scene["sheets"] = grids


def far(scene, random_):
    scene["sheets"][0]["translate"] = direction(random_, power(random_, 1, 3.95))
    scene["pins"][0].pop("path", None)


def hot(scene, random_):
    scene["sources"] = [{"kind": "spot", "position": [0, 0, 0], "radius": power(random_, -3, 0), "temperature":
                         random_.choice([1, 1e4]), "conductance": power(random_, 0, 9)}]
    scene["ambient_temperature"] = random_.choice([1, 293, 1e4])
    scene["sheets"][0].setdefault("material", {})["temperature"] = random_.choice([1, 293, 1e4])


def pace(scene, random_):
    scene["pace"] = power(random_, -6, 6)
    scene["fps"] = power(random_, -1.6, 5)


def thrown(scene, random_):
    for sheet in scene["sheets"]:
        sheet["velocity"] = direction(random_, power(random_, 0, 6))


def method(scene, random_):
    kind = random_.choice(["strand", "paper", "all-at-once", "mass-spring"])
    scene["solver"] = {"method": kind, "substeps": random_.randint(1, 20)}
    scene["creases"] = kind == "strand"
    if kind != "strand":
        scene["tearing"] = False


def brittle(scene, random_):
    scene["sheets"][0].setdefault("material", {}).update(
        strength=power(random_, -30, 1), char_strength=power(random_, -30, 0), mass_loss=random_.choice([0, 0.5, 0.99]))


def fields(scene, random_, rows):
    """Parameters of the material that go from one end of their range to the other within a few cells."""
    for row in random_.sample([row for row in rows if row["varies"]], random_.randint(1, 3)):
        low, high = random_.sample([value for value in row["values"] if value != "inf"], 2)
        put(scene, row, {"from": low, "to": high, "noise": {"scale": power(random_, -3, -1), "octaves": 3, "seed": 1}})


STORMS = [thick, gale, heavy, whip, plates, twins, slivers, sizes, far, hot, pace, thrown, method, brittle]


def draw_scene(rows, seed):
    """The scene of a seed, and whether it is to be run: if not, it is large, and `check` says so."""
    random_ = random.Random(seed)
    single = [(row, value) for row in rows for value in row["values"]]
    if seed % 2 == 0:
        row, value = single[seed // 2 % len(single)]
        scene = mild(random_)
        put(scene, row, value)
        return scene, row["path"] not in COSTS
    scene = mild(random_, random_.choice([4, 9, 14]))
    for storm in random_.sample(STORMS, random_.randint(1, 3)):
        storm(scene, random_)
    if random_.random() < 0.4:
        fields(scene, random_, rows)
    if random_.random() < 0.4:
        scene["contact"] = {"enabled": False}  # what crosses freely gets farther
    for row, value in random_.sample(single, random_.choice([0, 0, 1, 2, 4])):
        put(scene, row, COSTS.get(row["path"], value))
    if scene.get("solver", {}).get("method", "strand") != "strand":  # systems of a whole sheet: seconds a step
        for sheet in scene["sheets"]:
            sheet["grid"]["cells"] = [min(cells, MOST_CELLS_OF_SYSTEMS) for cells in sheet["grid"]["cells"]]
    return scene, True


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    print(json.dumps(draw_scene(read_ends(sys.argv[1]), int(sys.argv[2]))[0]))


if __name__ == "__main__":
    main()
