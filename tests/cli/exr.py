"""EXR files of scan lines, not packed or by ZIP, read by Python's standard library."""

import struct
import zlib
from pathlib import Path


def unpack(data, size):
    """ZIP of EXR: the bytes' differences, those of even offsets first."""
    if len(data) == size:
        return data
    raw = bytearray(zlib.decompress(data))
    for i in range(1, len(raw)):
        raw[i] = (raw[i] + raw[i - 1] - 128) & 255
    half = (len(raw) + 1) // 2
    out = bytearray(len(raw))
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


def header(path):
    """(the file's bytes, where its header ends, {attribute: bytes})."""
    data = Path(path).read_bytes()
    assert data[:4] == b"\x76\x2f\x31\x01", path
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name, kind = data[at:end].decode(), data.index(b"\0", end + 1)
        size, = struct.unpack_from("<I", data, kind + 1)
        attributes[name] = data[kind + 5 : kind + 5 + size]
        at = kind + 5 + size
    return data, at + 1, attributes


def read(path):
    """(width, height, {channel: values of the pixels, rows from the top})."""
    data, at, attributes = header(path)
    channels, start, listed = [], 0, attributes["channels"]
    while listed[start]:
        end = listed.index(b"\0", start)
        channels.append((listed[start:end].decode(), "Ief"[struct.unpack_from("<I", listed, end + 1)[0]]))
        start = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = {0: 1, 2: 1, 3: 16}[attributes["compression"][0]]
    line = sum(width * struct.calcsize(kind) for _, kind in channels)
    image = {name: [] for name, _ in channels}
    for chunk in range((height + lines - 1) // lines):
        offset, = struct.unpack_from("<Q", data, at + 8 * chunk)
        _, size = struct.unpack_from("<iI", data, offset)
        rows = min(lines, height - chunk * lines)
        block, start = unpack(data[offset + 8 : offset + 8 + size], rows * line), 0
        for _ in range(rows):
            for name, kind in channels:
                image[name] += struct.unpack_from("<%d%s" % (width, kind), block, start)
                start += width * struct.calcsize(kind)
    return width, height, image
