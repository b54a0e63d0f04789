"""A mesh of polygons, and its OBJ, PLY and GLB files."""

import json
import random
import struct


class Mesh:
    """Points, faces with any number of corners, and optionally uv per vertex or per corner."""

    def __init__(self, points=(), faces=(), uv=None, corner_uv=None):
        self.points = [tuple(p) for p in points]
        self.faces = [tuple(f) for f in faces]
        self.uv = uv  # per vertex
        self.corner_uv = corner_uv  # (uv, faces that index them)

    def joined(self, other):
        """Both meshes in one, as separate components."""
        base = len(self.points)
        uv = self.uv + other.uv if self.uv and other.uv else None
        return Mesh(self.points + other.points, self.faces + [tuple(v + base for v in f) for f in other.faces], uv)

    def merged(self, same):
        """The mesh, with same[vertex] in the place of each vertex that is in `same`. Without uv."""
        kept = [v for v in range(len(self.points)) if v not in same]
        number = {v: i for i, v in enumerate(kept)}
        number.update({v: number[w] for v, w in same.items()})
        return Mesh([self.points[v] for v in kept], [tuple(number[v] for v in f) for f in self.faces])

    def moved(self, x=0, y=0, z=0, scale=1):
        return Mesh([(scale * a + x, scale * b + y, scale * c + z) for a, b, c in self.points], self.faces, self.uv)

    def triangles(self, seed=None):
        """The mesh with its quads cut along alternating diagonals, or along random ones if there is a seed."""
        generator = random.Random(seed)
        faces = []
        for i, f in enumerate(self.faces):
            odd = generator.random() < 0.5 if seed is not None else (i + i // 16) % 2
            if len(f) != 4:
                faces.append(f)
            elif odd:
                faces += [(f[0], f[1], f[2]), (f[0], f[2], f[3])]
            else:
                faces += [(f[0], f[1], f[3]), (f[1], f[2], f[3])]
        return Mesh(self.points, faces, self.uv)


def obj_bytes(mesh):
    uv, uv_faces = mesh.corner_uv or (mesh.uv or [], mesh.faces)
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in mesh.points]
    lines += [f"vt {s:.9g} {t:.9g}" for s, t in uv]
    for face, uv_face in zip(mesh.faces, uv_faces):
        corners = (f"{v + 1}/{c + 1}" if uv else f"{v + 1}" for v, c in zip(face, uv_face))
        lines.append("f " + " ".join(corners))
    return "".join(line + "\n" for line in lines).encode()


def ply_bytes(mesh, binary):
    names = "x y z s t".split() if mesh.uv else "x y z".split()
    lines = ["ply", f"format {'binary_little_endian' if binary else 'ascii'} 1.0", f"element vertex {len(mesh.points)}"]
    lines += [f"property float {name}" for name in names]
    lines += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [(*p, *u) for p, u in zip(mesh.points, mesh.uv)] if mesh.uv else mesh.points
    if not binary:
        lines += [" ".join(f"{c:.9g}" for c in row) for row in rows]
        lines += [" ".join(str(c) for c in (len(f), *f)) for f in mesh.faces]
        return "".join(line + "\n" for line in lines).encode()
    data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
    data += b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in mesh.faces)
    return "".join(line + "\n" for line in lines).encode() + data


def glb_bytes(mesh):
    """glTF 2.0, binary: positions, uv with v pointing down, and triangles in one buffer."""
    parts = [b"".join(struct.pack("<3f", *p) for p in mesh.points),
             b"".join(struct.pack("<2f", s, 1 - t) for s, t in mesh.uv),
             b"".join(struct.pack("<3I", *f) for f in mesh.faces)]
    starts = [0, len(parts[0]), len(parts[0]) + len(parts[1])]
    low, high = ([pick(p[k] for p in mesh.points) for k in range(3)] for pick in (min, max))
    count = len(mesh.points)
    text = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": low, "max": high},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5125, "count": 3 * len(mesh.faces), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, parts)],
        "buffers": [{"byteLength": sum(map(len, parts))}]}
    chunk, data = json.dumps(text).encode(), b"".join(parts)
    chunk += b" " * (-len(chunk) % 4)
    size = 12 + 8 + len(chunk) + 8 + len(data)
    return (struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(chunk), b"JSON") + chunk +
            struct.pack("<I4s", len(data), b"BIN\0") + data)


def mesh_bytes(mesh, ending):
    """A file's bytes; `ending` is obj, ply, plyb (binary PLY) or glb."""
    if ending == "obj":
        return obj_bytes(mesh)
    return glb_bytes(mesh) if ending == "glb" else ply_bytes(mesh, ending == "plyb")
