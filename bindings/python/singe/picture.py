"""A quick picture of a surface for a notebook, using only numpy: flat light, the colours of burning paper, embers."""

from __future__ import annotations

import base64
import ctypes
import struct
import zlib
from typing import Any, Tuple

import numpy as np

from ._fields import number

# burn progress and sRGB: paper, brown, char, ash
_BURN = np.array([0, 0.15, 0.45, 0.8, 1])
_COLOUR = np.array([[238, 232, 220], [150, 100, 55], [28, 24, 22], [60, 58, 56], [150, 148, 145]], float)
# K and light
_HEAT = np.array([700, 850, 1000, 1200])
_GLOW = np.array([[0, 0, 0], [150, 25, 0], [255, 110, 10], [255, 220, 120]], float)
_VIEW = np.array([0.35, -1.0, 0.45])  # from where it is seen
_LIGHT = np.array([0.3, -0.5, 0.81])
_GROUND = np.array([40, 42, 46], float)


def _axes() -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Right, up and towards the viewer."""
    towards = _VIEW / np.linalg.norm(_VIEW)
    right = np.cross([0, 0, 1], towards)
    right /= np.linalg.norm(right)
    return right, np.cross(towards, right), towards


def _samples(surface: Any, pixels: np.ndarray, most: int = 8_000_000) -> Tuple[np.ndarray, np.ndarray]:
    """Points that cover the triangles densely: (triangle, barycentric coordinates)."""
    corners = pixels[surface.triangles]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    n = np.clip(np.ceil(1.5 * sides), 1, 1024).astype(int)
    while (n.astype(np.int64) * (n + 1) // 2).sum() > most:
        n = np.maximum(n // 2, 1)
    triangles, weights = [], []
    for size in np.unique(n):
        chosen = np.flatnonzero(n == size)
        i, j = np.nonzero(np.add.outer(np.arange(size), np.arange(size)) < size)
        one = np.stack([(i + 1 / 3) / size, (j + 1 / 3) / size], axis=1)
        triangles.append(np.repeat(chosen, len(one)))
        weights.append(np.tile(one, (len(chosen), 1)))
    which, two = np.concatenate(triangles), np.concatenate(weights)
    return which, np.column_stack([two, 1 - two.sum(axis=1)])


def colours(burn: np.ndarray, temperature: np.ndarray, shade: Any = 1.0) -> np.ndarray:
    """sRGB [n, 3], 0 to 255, of burning paper: `burn` from 0 fresh to 1 ash, temperature in K, light on it."""
    colour = np.stack([np.interp(burn, _BURN, _COLOUR[:, c]) * shade + np.interp(temperature, _HEAT, _GLOW[:, c])
                       for c in range(3)], axis=1)
    return np.minimum(colour, 255).astype(np.uint8)


def draw(surface: Any, width: int = 480, height: int = 360) -> np.ndarray:
    """A picture [height, width, 3] of 8 bits; the remaining surface fills it."""
    width, height = number(ctypes.c_uint32, width, "width"), number(ctypes.c_uint32, height, "height")
    if not width or not height:
        raise ValueError(f"width and height must be at least 1, not {width} and {height}")
    picture = np.broadcast_to(_GROUND, (height * width, 3)).copy()
    if not len(surface.triangles):
        return picture.reshape(height, width, 3).astype(np.uint8)
    right, up, towards = _axes()
    flat = surface.position @ np.stack([right, -up], axis=1)
    low, high = flat.min(axis=0), flat.max(axis=0)
    scale = 0.9 * min(width / max(high[0] - low[0], 1e-9), height / max(high[1] - low[1], 1e-9))
    pixels = (flat - (low + high) / 2) * scale + np.array([width, height]) / 2
    which, weights = _samples(surface, pixels)
    corners = surface.triangles[which]

    def at(values: np.ndarray) -> np.ndarray:
        return np.einsum("nk,nk...->n...", weights, values[corners])

    x, y = at(pixels).astype(int).T
    cell = np.clip(y, 0, height - 1) * width + np.clip(x, 0, width - 1)
    depth = at(surface.position @ towards)
    order = np.argsort(depth, kind="stable")  # the last to be written is the nearest
    burn, heat = at(surface.burn), at(surface.temperature)
    shade = 0.35 + 0.65 * np.abs(at(surface.normal) @ (_LIGHT / np.linalg.norm(_LIGHT)))
    picture[cell[order]] = colours(burn, heat, shade)[order]
    return picture.reshape(height, width, 3).astype(np.uint8)


def png(picture: np.ndarray) -> bytes:
    """PNG bytes of a picture [height, width, 3] of 8 bits."""
    height, width, _ = picture.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), picture.reshape(height, -1)], axis=1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


def draw_png(surface: Any, width: int = 480, height: int = 360) -> bytes:
    """PNG bytes of `draw`."""
    return png(draw(surface, width, height))


def html_picture(data: bytes, caption: str) -> str:
    """HTML that contains the picture."""
    code = base64.b64encode(data).decode()
    return f'<figure><img src="data:image/png;base64,{code}"/><figcaption>{caption}</figcaption></figure>'
