"""A burn by Singe in a recording of Rerun, by the Python package and PyPI's rerun-sdk, read back: every position and
triangle of all frames, times, plots, events, and a sheet that is gone. No viewer is started.

usage: rerun_client.py SINGE FOLDER    FOLDER is emptied; burn.rrd and gone.rrd are in it
"""

import os

import numpy as np
import rerun
from rerun.chunk import RrdReader

from burn import FRAMES, make, make_gone, same, with_package


def record(package, out, path):
    rerun.init("singe-check")
    rerun.save(path)
    package.log_to_rerun(package.read_cache(out), "burn")
    rerun.disconnect()


def read(path):
    """{(entity, frame): [{component: values}]}; a component is named without its type."""
    found = {}
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        names = {column.name.split(":")[-1]: batch.column(i) for i, column in enumerate(batch.schema)}
        for i in range(batch.num_rows if "frame" in names else 0):
            row = {"time": names["time"][i].value * 1e-9}
            for name in {"vertex_positions", "triangle_indices", "scalars", "text"} & set(names):
                values = names[name][i].values
                flat = name in ("scalars", "text")
                row[name] = values.to_pylist() if flat else values.flatten().to_numpy().reshape(-1, 3)
            found.setdefault((str(chunk.entity_path), names["frame"][i].as_py()), []).append(row)
    return found


def main():
    singe, folder, package = with_package()
    out = make(singe, folder, [], "--no-preview", "--set", "gas=no", "--set", "output.events=yes")
    record(package, out, os.path.join(folder, "burn.rrd"))
    found = read(os.path.join(folder, "burn.rrd"))
    cache = package.read_cache(out)
    for frame in range(1, FRAMES + 1):
        for entity in "surface", "heat":
            (mesh,) = found[f"/burn/{entity}", frame]
            mine = cache[frame]
            same(mesh["vertex_positions"], mine.position, (entity, frame, "position"))
            same(mesh["triangle_indices"], mine.triangles.astype(np.uint32), (entity, frame))
            assert abs(mesh["time"] - mine.time) < 1e-6
        (plot,) = found["/burn/stats/temperature_max", frame]
        assert plot["scalars"] == [cache.stats["temperature_max"][frame - 1]]
    events = sum(len(rows) for (entity, _), rows in found.items() if entity == "/burn/events")
    assert events == len(cache.table("events")["frame"]) > 0
    gone = make_gone(singe, folder, [])
    record(package, gone, os.path.join(folder, "gone.rrd"))
    meshes = sorted((frame, rows) for (entity, frame), rows in read(os.path.join(folder, "gone.rrd")).items()
                    if entity == "/burn/surface")
    counts = [len(rows[0]["vertex_positions"]) for _, rows in meshes]
    assert counts[0] > 0 and counts[-1] == 0, counts
    print(f"Rerun {rerun.__version__}: every position of {FRAMES} frames, {events} events; vertices of a sheet that "
          f"burns away: {counts}")


main()
