"""A gas written by Singe, read by OpenVDB's own library: names, kinds, positions and every value."""

import os
import struct
import subprocess
import sys
import tempfile

try:
    import pyopenvdb as openvdb
except ImportError:
    print("skipped: no pyopenvdb; scripts/setup.sh installs it (Debian's python3-openvdb)")
    sys.exit(77)



def nearest_half(value):
    value, = struct.unpack("<f", struct.pack("<f", value))  # 9 digits may lie beside a tie
    return struct.unpack("<e", struct.pack("<e", min(max(value, -65504), 65504)))[0]


CLASSES = {"density": "fog volume", "flame": "fog volume", "temperature": "fog volume"}


def check(size, half=False):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "gas.vdb")
        text = subprocess.run([sys.argv[1], path, *map(str, size), *(["half"] if half else [])], check=True, capture_output=True, text=True).stdout
        lines = text.splitlines()
        grids, metadata = openvdb.readAll(path)
        # each by its own name too, as programs do that load what they need
        alone = {name: openvdb.read(path, name) for name in ("density", "flame", "temperature", "velocity", "vel")}
    head = [float(word) for word in lines[0].split()]
    origin, cell = head[3:6], head[6]
    assert metadata["time"] == 0.125 and tuple(metadata["size"]) == size, metadata
    assert metadata["extinction_of_soot"] == 8700 and metadata.get("flame_unit") == (None if half else 1e7), metadata
    assert metadata["creator"].startswith("Singe "), metadata
    assert sorted(grid.name for grid in grids) == ["density", "flame", "temperature", "vel", "velocity"]
    for grid in list(grids) + list(alone.values()):
        assert grid.saveFloatAsHalf == half
        if grid.name in CLASSES:
            assert grid.gridClass == CLASSES[grid.name], grid.gridClass
        else:
            assert grid["vector_type"] == "contravariant relative"
        middle = grid.transform.indexToWorld((0, 0, 0))
        assert all(abs(m - o - 0.5 * cell) < 1e-9 for m, o in zip(middle, origin)), (middle, origin, cell)
        assert all(abs(v - cell) < 1e-9 for v in grid.transform.voxelSize()), grid.transform.voxelSize()
        assert grid["file_voxel_count"] == grid.activeVoxelCount(), (grid.name, grid.activeVoxelCount())
    cells = size[0] * size[1] * size[2]
    assert 0 < alone["density"].activeVoxelCount() <= cells
    assert alone["density"].background == 0 and alone["vel"].background == (0, 0, 0)
    access = {name: grid.getConstAccessor() for name, grid in alone.items()}
    for i in range(cells):
        at = (i % size[0], i // size[0] % size[1], i // size[0] // size[1])
        want = [float(word) for word in lines[1 + i].split()]
        got = [access[name].getValue(at) for name in ("density", "flame", "temperature")]
        got += access["velocity"].getValue(at)
        # 9 digits name a float; Python prints and reads doubles. Half floats are as near as they can be
        if half:
            want = [nearest_half(w) for w in want]
        assert all(abs(g - w) <= 1e-8 * abs(w) for g, w in zip(got, want)), (at, got, want)
        assert access["vel"].getValue(at) == access["velocity"].getValue(at), at
    print("%d x %d x %d: %d active of %d cells" % (*size, alone["density"].activeVoxelCount(), cells))
    return alone["density"].activeVoxelCount() < cells


SPARSE = [check(size) for size in ((1, 1, 1), (8, 8, 8), (37, 21, 60), (9, 140, 17), (40, 33, 140))]
assert any(SPARSE)
check((37, 21, 60), half=True)
check((9, 140, 17), half=True)
