"""A burn by Singe as Alembic, by the Python package and PyPI's alembic3d: every value of all frames, and
sheets that are gone. blender_alembic.py reads the same files.

usage: alembic_client.py SINGE FOLDER    FOLDER is emptied; burn.abc and gone.abc are in it
"""

import os

import imath
import numpy as np
from alembic3d import Abc, AbcGeom

from burn import FRAMES, Frame, make, make_gone, same, with_package


def array(values, width, kind):
    if len(values) == 0:
        return np.empty((0, width), kind)
    return np.array([tuple(value) if width > 1 else (value,) for value in values], kind)


def read(path, sheet_names, frames):
    """Of each sheet and frame positions, velocities, corners and their uv, in Singe's axes and sense."""
    archive = Abc.IArchive(path)
    found = {}
    for name in sheet_names:
        schema = AbcGeom.IPolyMesh(archive.getTop(), name).getSchema()
        assert schema.getNumSamples() == frames, (name, schema.getNumSamples())
        uvs = schema.getUVsParam()
        assert uvs.getScope() == AbcGeom.GeometryScope.kFacevaryingScope
        for frame in range(1, frames + 1):
            selector = Abc.ISampleSelector(frame / 24)
            value = schema.getValue(selector)
            down = lambda v: np.ascontiguousarray(np.stack([v[:, 0], -v[:, 2], v[:, 1]], 1))
            corners = array(value.getFaceIndices(), 1, np.int32).reshape(-1, 3)[:, ::-1]
            uv = array(uvs.getExpandedValue(selector).getVals(), 2, np.float32).reshape(-1, 3, 2)[:, ::-1]
            found[name, frame] = (down(array(value.getPositions(), 3, np.float32)),
                                  down(array(value.getVelocities(), 3, np.float32)), corners, uv)
    return found


def main():
    singe, folder, package = with_package()
    out = make(singe, folder, [], "--no-preview", "--set", "gas=no")
    path = package.read_cache(out).write_alembic(os.path.join(folder, "burn.abc"))
    names = ("leaf", "strip")
    for (name, frame), (position, velocity, corners, uv) in read(str(path), names, FRAMES).items():
        cache = Frame(out, frame, sheet=names.index(name))
        same(position + 0.0, cache.stack("x y z") + 0.0, (name, frame, "position"))  # -0 becomes 0
        same(velocity + 0.0, cache.stack("vx vy vz") + 0.0, (name, frame, "velocity"))
        same(corners, cache.triangles, (name, frame, "triangles"))
        same(uv, cache.stack("s t")[cache.triangles], (name, frame, "uv"))
    size = os.path.getsize(path)
    path = package.read_cache(make_gone(singe, folder, [])).write_alembic(os.path.join(folder, "gone.abc"))
    counts = [len(position) for position, *_ in read(str(path), ("leaf",), 12).values()]
    assert counts[0] > 0 and counts[-1] == 0, counts
    print("Alembic: every value of %d frames, %d bytes; vertices of a sheet that burns away: %s" % (FRAMES, size, counts))


main()
