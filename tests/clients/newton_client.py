"""Newton (PyPI's newton) takes on a frame of a burn as deformable bodies, and the stages of its package and of Warp's burn
and come back: every mesh as a sheet, burnt for two frames, whose first frame as USD is that mesh again.

usage: newton_client.py SINGE FOLDER    FOLDER is emptied
"""

import contextlib
import io
import logging
import pathlib
import subprocess
import warnings

import numpy as np
from pxr import Usd, UsdGeom

import newton
import warp

from burn import make, with_package

STAGES_LEAST = 10


def taken_on(package, bodies, singe, folder):
    """Positions, triangles, masses and stiffness of two sheets, one of which has burnt in part."""
    cache = package.read_cache(make(singe, folder, [], "--no-preview", "--set", "gas=no"))
    target = folder / "bodies.usda"
    bodies.write(cache, target, 12)
    frame = cache[12]
    builder = newton.ModelBuilder()
    with warnings.catch_warnings(record=True) as said, contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("always")
        builder.add_usd(Usd.Stage.Open(str(target)))
    said = sorted({str(one.message).split(": ")[-1] for one in said})
    assert said == ["authored velocities are not imported; the deformable starts at rest."], said
    assert builder.tri_count == len(frame.triangles)
    order = np.argsort(frame.sheet[frame.triangles[:, 0]], kind="stable")
    positions = np.array(builder.particle_q)[np.array(builder.tri_indices)]
    assert np.abs(positions - frame.position[frame.triangles[order]]).max() < 1e-6
    fresh = sum(a * b for a, b in ((0.08, 0.12), (0.04, 0.08))) * cache.scene["sheets"][0]["material"]["grammage"]
    mass = sum(builder.particle_mass)
    assert 0.3 * fresh < mass < 0.99 * fresh, (mass, fresh)
    bending = {round(row[0], 9) for row in builder.edge_bending_properties}
    assert len(bending) == 1 and abs(bending.pop() - 1e-5) < 1e-9
    print(f"a frame: {builder.particle_count} particles, {builder.tri_count} triangles, {1e3 * mass:.3f} g of "
          f"{1e3 * fresh:.3f} g")


def meshes(path):
    """The paths of the meshes of a stage; none if it does not open."""
    try:
        stage = Usd.Stage.Open(str(path))
    except Exception:
        return []
    return [str(prim.GetPath()) for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies())
            if prim.IsA(UsdGeom.Mesh) and UsdGeom.Imageable(prim).ComputePurpose() not in ("guide", "proxy")]


def corners(package_usd, stage, folder, sheets):
    """Bounds and area of each sheet that a stage makes, in metres."""
    made = package_usd.scene(stage, folder, sheets)
    found = {}
    for path in sorted(folder.glob("*.ply")):
        header, body = path.read_bytes().split(b"end_header\n", 1)
        count = int(header.split(b"element vertex ")[1].split()[0])
        width = 24 + 4 * header.count(b"property float ")
        rows = np.frombuffer(body[:count * width], np.uint8).reshape(count, width)
        points = np.ascontiguousarray(rows[:, :24]).view("<f8")
        found[path.stem] = (points.min(0), points.max(0))
    return made, found


def come_back(package_usd, singe, folder):
    places = [pathlib.Path(module.__file__).parent for module in (newton, warp)]
    stages = {path.read_bytes(): path for place in places for path in sorted(place.glob("**/assets/**/*.usd*"))}
    burnt = 0
    for path in sorted(stages.values()):
        if not meshes(path) or "/kamino/" in str(path):
            continue
        work = folder / f"{path.stem}-{burnt}"
        scene, first = corners(package_usd, path, work / "in", ["/"])
        size = max(np.linalg.norm(high - low) for low, high in first.values())
        done = subprocess.run([singe, "run", str(scene), "-o", str(work / "out"), "--quiet", "--no-preview", "--frames", "2",
                               "--set", "steps=1", "--set", "detail=0", "--set", "tearing=no", "--set",
                               "output.formats=[ply,usd]"], capture_output=True, text=True, timeout=100)
        if done.returncode:
            print(f"{path.name}: {done.stderr.strip().splitlines()[-1]}")
            continue
        stage = next((work / "out").glob("*.usda"))
        _, second = corners(package_usd, stage, work / "again", [f"/{stage.stem}/sheets"])
        assert set(first) == set(second), (path, set(first) ^ set(second))
        error = max(np.abs(np.array(first[name]) - second[name]).max() for name in first)
        assert error < 1e-5 * size, (path, error, size)
        burnt += 1
        print(f"{path.name}: {len(first)} meshes, {size:.3g} m, back within {error:.1e} m")
    assert burnt >= STAGES_LEAST, burnt


def main():
    singe, folder, package = with_package()
    folder = pathlib.Path(folder)
    logging.disable(logging.WARNING)  # what is read otherwise than it looks; usd_in.py tests what is said
    from singe import usd, usd_bodies
    taken_on(package, usd_bodies, singe, folder)
    come_back(usd, singe, folder)


if __name__ == "__main__":
    main()
