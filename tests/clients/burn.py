"""Shared by the clients: a small burn, and the frames of its cache as numpy arrays."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

FRAMES = 24
CHECKED = (1, 10, 20, 24)  # frames of which every value is compared

# a strip that burns, hangs and drops pieces, a ball that moves beside it, a body that
# deforms, gas above; a picture on one of two sheets
SCENE = """\
name: burn
frames: {frames}
fps: 24
steps: 8
pace: 5
detail: 0.8 mm
sheets:
  - name: leaf
    grid: {{size: [8 cm, 12 cm], cells: [32, 48]}}
    picture: print.png
    translate: [0, 0, 6 cm]
  - name: strip
    grid: {{size: [4 cm, 8 cm], cells: [16, 32]}}
    colour: [0.8, 0.75, 0.6]
    translate: [8 cm, 0, 6 cm]
    material: {{moisture: 3 %}}
sources:
  - {{kind: spot, position: [0, -4 cm, 6 cm], radius: 12 mm, falloff: 12 mm, temperature: 1100 K, conductance: 200}}
  - {{kind: spot, position: [8 cm, -3 cm, 6 cm], radius: 12 mm, falloff: 12 mm, temperature: 1100 K, conductance: 200}}
colliders:
  - kind: sphere
    radius: 1 cm
    path:
      - {{time: 0, position: [-8 cm, 0, 3 cm]}}
      - {{time: 1 s, position: [-6 cm, 0, 3 cm]}}
  - {{kind: mesh, motion: {{mesh: body.####.ply}}, position: [-10 cm, 5 cm, 0]}}
pins:
  - {{sheet: leaf, points: [[-4 cm, 6 cm, 6 cm], [4 cm, 6 cm, 6 cm]], radius: 6 mm}}
  - {{sheet: strip, points: [[6 cm, 4 cm, 6 cm], [10 cm, 4 cm, 6 cm]], radius: 6 mm}}
gas: {{cell_size: 6 mm}}
preview:
  size: [480, 270]
  samples: 8
  camera: {{eye: [0.12, -0.34, 0.2], target: [0.02, 0, 0.05], fov: 34}}
  ground: {{height: -6 cm, colour: [0.2, 0.105, 0.052]}}
output: {{formats: [{formats}]}}
"""

# a sheet that is burnt in its second frame
GONE = """\
name: burn
frames: 12
steps: 4
pace: 40
sheets:
  - name: leaf
    grid: {size: [2 cm, 2 cm], cells: [8, 8]}
    drop_pieces_below: 3 cm2
    material: {char_yield: 0, mass_loss: 50 %}
sources: [{kind: spot, position: [0, 0, 0], radius: 5 cm, temperature: 1400 K, conductance: 2000}]
gas: no
output: {}
"""

VECTORS = {"points": "x y z", "velocities": "vx vy vz", "normals": "nx ny nz", "st": "s t", "rest": "rest_x rest_y rest_z"}
VTK_VECTORS = {"normal": "nx ny nz", "uv": "s t", "velocity": "vx vy vz", "rest": "rest_x rest_y rest_z"}
SCALARS = ("temperature temperature_peak mass burn_rate char_fraction ash_fraction burnt time_ignited piece_id vertex_id "
           "sheet water").split()


def write_picture(path, width=96, height=144):
    """Lines of a print, as a PNG by hand."""
    import struct
    import zlib
    y, x = np.mgrid[0:height, 0:width]
    dark = (y % 12 < 4) & (x > 8) & (x < width - 8) & ((x * 7 + y // 12 * 13) % 29 < 22)
    rgb = np.where(dark[..., None], np.uint8([30, 30, 60]), np.uint8([250, 248, 240])).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in rgb)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) +
                           chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def body(frame):
    """An octahedron that grows: its corners (m) in a frame, and its faces."""
    wide, high = 0.012 + 0.0005 * frame, 0.02 + 0.001 * frame
    corners = [(wide, 0, 0), (-wide, 0, 0), (0, wide, 0), (0, -wide, 0), (0, 0, high), (0, 0, -high)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return np.float32(corners), faces


def write_body(folder):
    for frame in range(1, FRAMES + 1):
        corners, faces = body(frame)
        with open(os.path.join(folder, "body.%04d.ply" % frame), "w") as file:
            file.write("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 8\nproperty list uchar int vertex_indices\nend_header\n")
            file.writelines("%.9g %.9g %.9g\n" % tuple(corner) for corner in corners)
            file.writelines("3 %d %d %d\n" % face for face in faces)


def with_package():
    """The arguments SINGE and FOLDER, which is emptied, and the Python package over the library beside SINGE."""
    singe, folder = (os.path.abspath(path) for path in sys.argv[1:3])
    shutil.rmtree(folder, ignore_errors=True)
    os.environ["SINGE_LIBRARY"] = os.path.join(os.path.dirname(singe), "python", "singe", "libsinge.so")
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "bindings", "python"))
    import singe as package
    return singe, folder, package


def make(singe, folder, formats, *extra):
    """Burns the scene in folder/out, and says where its files are."""
    os.makedirs(folder, exist_ok=True)
    write_picture(os.path.join(folder, "print.png"))
    write_body(folder)
    scene = os.path.join(folder, "burn.yaml")
    Path(scene).write_text(SCENE.format(frames=FRAMES, formats=", ".join(formats)))
    out = os.path.join(folder, "out")
    subprocess.run([singe, "run", scene, "-o", out, "--quiet", *extra], check=True, stdout=subprocess.DEVNULL)
    return out


def make_gone(singe, folder, formats):
    """Burns GONE in folder/gone, 12 frames, and says where its files are."""
    scene, out = os.path.join(folder, "gone.yaml"), os.path.join(folder, "gone")
    Path(scene).write_text(GONE.replace("output: {}", "output: {formats: [%s]}" % ", ".join(formats)))
    subprocess.run([singe, "run", scene, "-o", out, "--quiet", "--no-preview"], check=True, stdout=subprocess.DEVNULL)
    return out


class Frame:
    """A PLY of the cache: `column(name)`, `stack("x y z")`, `triangles`; of one sheet, numbered from 0, if asked for."""

    def __init__(self, out, number, name="burn", sheet=None):
        header, body = Path(os.path.join(out, "ply", "%s.%04d.ply" % (name, number))).read_bytes().split(b"end_header\n", 1)
        header = header.decode()
        self.time = float(re.search(r"time (\S+)", header).group(1))
        vertices = int(re.search(r"element vertex (\d+)", header).group(1))
        faces = int(re.search(r"element face (\d+)", header).group(1))
        kinds = {"float": "<f4", "int": "<i4"}
        rows = np.dtype([(word, kinds[kind]) for kind, word in re.findall(r"property (float|int) (\w+)", header)])
        self.rows = np.frombuffer(body, rows, vertices)
        face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
        self.triangles = np.frombuffer(body, face, faces, vertices * rows.itemsize)["corners"]
        if sheet is None:
            return
        mine = self.rows["sheet"] == sheet
        number_of = np.cumsum(mine) - 1
        self.triangles = number_of[self.triangles[mine[self.triangles[:, 0]]]].astype(np.int32).reshape(-1, 3)
        self.rows = self.rows[mine]

    def column(self, name):
        return np.ascontiguousarray(self.rows[name])

    def stack(self, names):
        return np.ascontiguousarray(np.stack([self.rows[name] for name in names.split()], 1))


def same(a, b, what):
    """Bit for bit."""
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    assert a.dtype.itemsize == b.dtype.itemsize, (what, a.dtype, b.dtype)
    assert a.size == b.size and a.tobytes() == b.tobytes(), "%s: %d values of %d differ" % (
        what, (a.ravel() != b.ravel()).sum() if a.size == b.size else -1, b.size)


def same_points(mesh, cache, to_numpy):
    """The points of a mesh of VTK and their arrays, bit for bit."""
    same(to_numpy(mesh.GetPoints().GetData()), cache.stack("x y z"), "points")
    arrays = mesh.GetPointData()
    for name, columns in VTK_VECTORS.items():
        same(to_numpy(arrays.GetArray(name)), cache.stack(columns), name)
    for name in SCALARS:
        same(to_numpy(arrays.GetArray(name)), cache.column(name), name)


def check_burns_away(bpy):
    """In Blender: a sheet that is burnt at the end has no vertices in the last frames."""
    counts = []
    for frame in range(1, 13):
        bpy.context.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        counts.append(len(bpy.data.objects["leaf"].evaluated_get(graph).data.vertices))
    print("vertices of a sheet that burns away:", counts)
    assert counts[0] > 0 and counts[-1] == 0
