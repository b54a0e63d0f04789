# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygon meshes as arrays: subdivision and PLY files. Does not need Blender."""

import numpy as np

from . import files


class Mesh:
    """points [n, 3] m; faces as corners [c] and sizes [f]; uv [c, 2] or None; weights by name [n], from 0 to 1."""

    def __init__(self, points, corners, sizes, uv=None, weights=None):
        self.points = np.asarray(points, np.float64).reshape(-1, 3)
        self.corners = np.asarray(corners, np.int64).ravel()
        self.sizes = np.asarray(sizes, np.int64).ravel()
        self.uv = None if uv is None else np.asarray(uv, np.float64).reshape(-1, 2)
        self.weights = {name: np.asarray(values, np.float64).ravel() for name, values in (weights or {}).items()}

    def next_corners(self):
        """For each corner, the index of the next corner of its face."""
        following = np.arange(1, len(self.corners) + 1)
        ends = np.cumsum(self.sizes)
        following[ends - 1] = ends - self.sizes
        return following

    def edge_length(self):
        """The mean length of a side, m."""
        sides = self.points[self.corners[self.next_corners()]] - self.points[self.corners]
        return float(np.sqrt((sides**2).sum(1)).mean()) if len(sides) else 0.0

    def is_flat(self):
        """Whether all points lie in a plane, to a thousandth of the mesh's size."""
        centred = self.points - self.points.mean(0)
        size = np.linalg.svd(centred, compute_uv=False)
        return len(self.points) >= 3 and size[2] <= 1e-3 * size[0]

    def is_closed(self):
        """Whether each edge belongs to two faces."""
        a, b = self.corners, self.corners[self.next_corners()]
        _, counts = np.unique(np.sort(np.stack((a, b), 1), 1), axis=0, return_counts=True)
        return bool((counts == 2).all())


def _split_edges(mesh):
    """For each corner, the new vertex at the midpoint of the side that begins there, numbered after the old ones; and
    the two ends of each new vertex's side."""
    a, b = mesh.corners, mesh.corners[mesh.next_corners()]
    ends, index = np.unique(np.sort(np.stack((a, b), 1), 1), axis=0, return_inverse=True)
    return len(mesh.points) + index.ravel(), ends


def subdivide(mesh):
    """Splits each face of n corners into n quads with sides half as long, without smoothing."""
    face_of = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    middle, ends = _split_edges(mesh)
    centre = len(mesh.points) + len(ends) + face_of
    following = mesh.next_corners()
    before = np.empty_like(following)
    before[following] = np.arange(len(following))

    def grown(values):
        sums = np.zeros((len(mesh.sizes),) + values.shape[1:])
        np.add.at(sums, face_of, values[mesh.corners])
        sizes = mesh.sizes.reshape((-1,) + (1,) * (values.ndim - 1))
        return np.concatenate((values, values[ends].mean(1), sums / sizes))

    corners = np.stack((mesh.corners, middle, centre, middle[before]), 1)
    uv = None
    if mesh.uv is not None:
        sums = np.zeros((len(mesh.sizes), 2))
        np.add.at(sums, face_of, mesh.uv)
        half = 0.5 * (mesh.uv + mesh.uv[following])
        uv = np.stack((mesh.uv, half, (sums / mesh.sizes[:, None])[face_of], half[before]), 1)
    return Mesh(grown(mesh.points), corners, np.full(len(corners), 4), uv,
                {name: grown(values) for name, values in mesh.weights.items()})


def refine(mesh, cell_size, cells_max=2_000_000):
    """Subdivides until the mean side is at most `cell_size` m, to 5 %; no further than `cells_max` cells."""
    while mesh.edge_length() > cell_size * 1.05 and 4 * len(mesh.sizes) <= cells_max:
        mesh = subdivide(mesh)
    return mesh


def spread(points, count):
    """Chooses at most `count` points far from each other. Returns their indices, and the max distance of a point from
    the nearest of them."""
    chosen = [0]
    distance = ((points - points[0])**2).sum(1)
    while len(chosen) < min(count, len(points)) and distance.max() > 0:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, ((points - points[chosen[-1]])**2).sum(1))
    return chosen, float(np.sqrt(distance.max()))


def write_ply(path, mesh):
    """Writes a binary PLY with the uv of corners, and with the weights as properties of vertices."""
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.points)}"]
    lines += [f"property float {name}" for name in ("x", "y", "z", *mesh.weights)]
    lines += [f"element face {len(mesh.sizes)}", "property list int int vertex_indices"]
    if mesh.uv is not None:
        lines.append("property list int float texcoord")
    table = np.column_stack([mesh.points, *mesh.weights.values()]).astype("<f4")
    faces, at = [], 0
    # faces of one size after each other, as after a subdivision, are one table
    ends = np.flatnonzero(np.diff(mesh.sizes, append=-1)) + 1
    for size, count in zip(mesh.sizes[ends - 1].tolist(), np.diff(ends, prepend=0).tolist()):
        columns = [("size", "<i4"), ("corners", "<i4", (size,))]
        if mesh.uv is not None:
            columns += [("uv_size", "<i4"), ("uv", "<f4", (size, 2))]
        rows = np.empty(count, columns)
        rows["size"], rows["corners"] = size, mesh.corners[at:at + size * count].reshape(count, size)
        if mesh.uv is not None:
            rows["uv_size"], rows["uv"] = 2 * size, mesh.uv[at:at + size * count].reshape(count, size, 2)
        faces.append(rows.tobytes())
        at += size * count
    with files.create(path) as file:
        file.write(("\n".join(lines) + "\nend_header\n").encode("ascii"))
        file.write(table.tobytes())
        file.write(b"".join(faces))
