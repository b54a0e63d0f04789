"""Alembic from a cache, for pipelines without USD: shape, uv and velocity.

Needs the package alembic3d of PyPI.
USD and PLY keep every field; Alembic's readers drop scalars of vertices, so none are written (docs/formats.md).
"""

from __future__ import annotations

import os
import pathlib
import re
from typing import TYPE_CHECKING, Any, Callable, List, Optional, Union

import numpy as np

from . import errors
from ._whole import whole

if TYPE_CHECKING:
    from .cache import Cache, Frame


def _modules() -> Any:
    try:
        import alembic3d.Abc
        import alembic3d.AbcCoreAbstract
        import alembic3d.AbcGeom
        import imath
    except ImportError as error:
        raise ImportError("Alembic needs the package alembic3d: pip install alembic3d") from error
    return alembic3d, imath


def _names(cache: "Cache") -> List[str]:
    """A unique name for each sheet: letters, digits and underscores."""
    names: List[str] = []
    for number, sheet in enumerate(cache.scene["sheets"]):
        name = re.sub("[^A-Za-z0-9_]", "_", sheet["name"]) or "_"
        while name in names:
            name += f"_{number + 1}"
        names.append(name)
    return names


def _up(vectors: np.ndarray) -> np.ndarray:
    """Rotates to Alembic's y up."""
    return np.ascontiguousarray(np.stack([vectors[:, 0], vectors[:, 2], -vectors[:, 1]], 1), np.float32)


class _Writer:
    def __init__(self, cache: "Cache", path: str):
        alembic3d, self.imath = _modules()
        self.geom = alembic3d.AbcGeom
        step = 1 / cache.scene["fps"]
        # frame f is at f/fps, as in other programs; the DCC's rate is only information
        self.archive = alembic3d.Abc.CreateArchiveWithInfo(path, float(cache.scene["fps"]), "Singe", cache.name)
        sampling = self.archive.addTimeSampling(alembic3d.AbcCoreAbstract.TimeSampling(step, step))
        self.meshes = [self.geom.OPolyMesh(self.archive.getTop(), name) for name in _names(cache)]
        for mesh in self.meshes:
            mesh.getSchema().setTimeSampling(sampling)

    def _array(self, kind: str, values: np.ndarray) -> Any:
        if not len(values):
            return getattr(self.imath, kind + "Array")(0)
        return getattr(self.imath, kind + "ArrayFromBuffer")(np.ascontiguousarray(values))

    def add(self, frame: "Frame") -> None:
        for sheet, mesh in enumerate(self.meshes):
            mine = frame.sheet == sheet
            numbers = np.cumsum(mine) - 1
            corners = frame.triangles[mine[frame.triangles[:, 0]]] if len(frame.triangles) else frame.triangles
            # a reader's corners turn clockwise seen from the front
            corners = corners[:, ::-1].ravel()
            uv = self.geom.OV2fGeomParamSample(self._array("V2f", frame.uv[corners].astype(np.float32)),
                                               self.geom.GeometryScope.kFacevaryingScope)
            sample = self.geom.OPolyMeshSchemaSample(
                self._array("V3f", _up(frame.position[mine])), self._array("Int", numbers[corners].astype(np.int32)),
                self._array("Int", np.full(len(corners) // 3, 3, np.int32)), uv)
            sample.setVelocities(self._array("V3f", _up(frame.velocity[mine])))
            mesh.getSchema().set(sample)


def write(cache: "Cache", path: Union[str, "os.PathLike[str]", None] = None,
          progress: Optional[Callable[[int, int], None]] = None) -> pathlib.Path:
    """See Cache.write_alembic."""
    frames = cache.frames
    if frames != list(range(1, len(frames) + 1)) or not frames:
        raise errors.FormatError(f"{cache.folder} lacks frames: Alembic needs all from 1", "alembic")
    target = pathlib.Path(path) if path is not None else cache.folder / f"{cache.name}.abc"
    if not target.parent.is_dir():
        raise errors.FormatError(f"cannot write {target}: there is no folder {target.parent}", "alembic")
    with whole(target) as draft:
        try:
            writer = _Writer(cache, str(draft))
        except RuntimeError as error:
            raise errors.FormatError(f"cannot write {target}: {error}", "alembic") from error
        for number in frames:
            writer.add(cache[number])
            if progress:
                progress(number, len(frames))
        del writer  # the file is whole when nothing holds it
    return target
