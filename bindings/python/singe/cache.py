"""The cache of a run: frames of meshes with all their fields, and tables (docs/formats.md)."""

from __future__ import annotations

import csv
import json
import os
import pathlib
import re
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import errors
from .picture import draw_png, html_picture
from .views import Drawn

_TYPES = {"float": "<f4", "int": "<i4", "uchar": "u1"}
_VECTORS = {"position": "x y z", "normal": "nx ny nz", "uv": "s t", "velocity": "vx vy vz",
            "rest_position": "rest_x rest_y rest_z"}
_RENAMED = {"piece_id": "piece", "vertex_id": "source_vertex", "burnt": "burn"}


class Frame(Drawn):
    """A frame of a cache. Its arrays are views of the file's bytes.

    triangles: [triangles, 3]. number: of the frame, from 1. gas: the path of its OpenVDB file, or None.
    """

    triangles: npt.NDArray[np.int32]

    def __init__(self, path: pathlib.Path, number: int):
        self.path, self.number = path, number
        gas = path.parent.parent / "gas" / f"{path.stem}.vdb"
        self.gas: Optional[pathlib.Path] = gas if gas.is_file() else None
        data = path.read_bytes()
        end = data.find(b"end_header\n")
        if not data.startswith(b"ply\nformat binary_little_endian 1.0\n") or end < 0:
            raise errors.FormatError(f"{path} is not a frame of a cache", "ply")
        header = data[:end].decode("ascii", "replace")
        rest = data[end + len(b"end_header\n"):]
        time = re.search(r"^comment singe \S+ time (\S+)$", header, re.M)
        counts = dict(re.findall(r"^element (\w+) (\d+)$", header, re.M))
        fields = re.findall(r"^property (float|int|uchar) (\w+)$", header, re.M)
        if not time or set(counts) != {"vertex", "face"} or not fields:
            raise errors.FormatError(f"{path} is not a frame of a cache", "ply")
        self.time = float(time.group(1))
        row = np.dtype([(name, _TYPES[kind]) for kind, name in fields])
        face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
        vertices, faces = int(counts["vertex"]), int(counts["face"])
        if len(rest) != vertices * row.itemsize + faces * face.itemsize:
            raise errors.FormatError(f"{path} is not as long as its header says", "ply")
        table = np.frombuffer(rest, row, vertices)
        self._fill(table, [name for _, name in fields])
        self.triangles = np.frombuffer(rest, face, faces, vertices * row.itemsize)["corners"]
        if faces and not 0 <= self.triangles.min() <= self.triangles.max() < vertices:
            raise errors.FormatError(f"{path} has a triangle whose vertex is out of range", "ply")

    def _fill(self, table: np.ndarray, names: Sequence[str]) -> None:
        taken = set()
        for vector, parts in _VECTORS.items():
            of = parts.split()
            if all(one in names for one in of):
                first = table.dtype.fields[of[0]][1]  # type: ignore[index]
                view = np.ndarray((len(table), len(of)), "<f4", table if len(table) else None,
                                  first if len(table) else 0, (table.dtype.itemsize, 4))
                view.flags.writeable = False
                setattr(self, vector, view)
                taken.update(of)
        for name in names:
            if name not in taken:
                setattr(self, _RENAMED.get(name, name), table[name])

    def __repr__(self) -> str:
        return f"<singe.Frame {self.number}: {len(self.position)} vertices at {self.time:g} s>"

    def _repr_html_(self) -> str:
        return html_picture(draw_png(self), f"frame {self.number}, {self.time:.3f} s")


class Cache:
    """A run's folder. cache[frame] reads a frame by its number, from 1; -1 is the last. Iterating reads one by one."""

    def __init__(self, folder: Union[str, "os.PathLike[str]"]):
        self.folder = pathlib.Path(folder)
        try:
            with open(self.folder / "run.json", encoding="utf-8") as file:
                self.record: Dict[str, Any] = json.load(file)
            self.name: str = self.record["name"]
        except OSError as error:
            raise errors.FormatError(f"{self.folder} is not a cache: {error}", "cache") from error
        except (ValueError, KeyError, TypeError) as error:
            raise errors.FormatError(f"{self.folder / 'run.json'} is damaged: {error}", "cache") from error

    def _path(self, number: int) -> pathlib.Path:
        return self.folder / "ply" / f"{self.name}.{number:04d}.ply"

    @property
    def frames(self) -> List[int]:
        """The numbers of the existing frames, increasing; a run in progress adds to them."""
        pattern = re.compile(re.escape(self.name) + r"\.(\d{4,})\.ply")
        folder = self.folder / "ply"
        found = [pattern.fullmatch(path.name) for path in folder.iterdir()] if folder.is_dir() else []
        return sorted(int(match.group(1)) for match in found if match)

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, number: int) -> Frame:
        there = self.frames
        if number < 0 and -number <= len(there):
            number = there[number]
        if number not in there:
            span = f"{there[0]} to {there[-1]}" if there else "none"
            raise IndexError(f"{self.folder} has no frame {number}; it has {span}")
        return Frame(self._path(number), number)

    def __iter__(self) -> Iterator[Frame]:
        return (Frame(self._path(number), number) for number in self.frames)

    @property
    def scene(self) -> Dict[str, Any]:
        """The scene with every default filled in."""
        return self.record["scene"]

    @property
    def stats(self) -> Dict[str, np.ndarray]:
        """stats.csv: arrays by the names of its columns (docs/formats.md), an entry per frame."""
        return self.table("stats")

    def table(self, name: str) -> Dict[str, np.ndarray]:
        """A table of the folder: "stats", "events" or "probes"."""
        path = self.folder / f"{name}.csv"
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        except OSError as error:
            raise errors.FormatError(f"cannot read {path}: {error}", "cache") from error
        if not rows or any(len(row) != len(rows[0]) for row in rows):
            raise errors.FormatError(f"{path} is damaged", "cache")
        return {title: column(rows[1:], i) for i, title in enumerate(rows[0])}

    def picture(self, number: int = -1) -> Optional[pathlib.Path]:
        """The path of a frame's picture; None if the run has drawn none. -1: the last."""
        numbers = self.frames
        if number < 0:
            number = numbers[number] if -number <= len(numbers) else 0
        path = self.folder / "frames" / f"{self.name}.{number:04d}.png"
        return path if path.is_file() else None

    def write_alembic(self, path: Union[str, "os.PathLike[str]", None] = None,
                      progress: Optional[Callable[[int, int], None]] = None) -> pathlib.Path:
        """Writes all frames as one Alembic file, NAME.abc in the folder by default, and returns its path.

        A mesh a sheet, y up: positions, triangles, uv of corners, and velocities (m/s) for motion blur; no fields.
        Frame f is at f/fps seconds. `progress` is called with (frame, frames). Needs the package alembic3d of PyPI.
        """
        from .alembic import write
        return write(self, path, progress)

    def __repr__(self) -> str:
        return f"<singe.Cache {str(self.folder)!r}: {len(self)} frames, {self.record.get('result')}>"

    def _repr_mimebundle_(self, **chosen: Any) -> Any:
        """In a notebook with anywidget a cache is alive (singe.view). None, where it is not: then it is a picture."""
        try:
            from .notebook import view
            return view(self)._repr_mimebundle_(**chosen)
        except (ImportError, errors.CommandError, OSError):
            return None

    def _repr_html_(self) -> str:
        drawn = self.picture()
        if drawn:
            return html_picture(drawn.read_bytes(), f"{self.name}, frame {self.frames[-1]}")
        return self[-1]._repr_html_() if len(self) else f"<code>{self.name}: no frames</code>"


def column(rows: List[List[str]], index: int) -> np.ndarray:
    """A column of a table: floats, NaN if a cell is empty or "-"; texts if one is not a number."""
    cells = [row[index] for row in rows]
    try:
        return np.array([float(cell) if cell not in ("", "-") else np.nan for cell in cells])
    except ValueError:
        return np.array(cells)


def read_cache(folder: Union[str, "os.PathLike[str]"]) -> Cache:
    """The cache of a run: read_cache("out/letter")[12].temperature."""
    return Cache(folder)
