"""Scenes from OpenUSD stages: sheets, colliders and a fire, by the paths of their prims.

    python3 -m singe.usd shot.usda --sheets /World/Letter --colliders /World/Table --fire /World/Match -o out/shot

writes a scene, with a PLY of each mesh and a copy of each picture beside it, in metres, z up. Needs PyPI's usd-core.
docs/usd.md says what is read.
"""

from __future__ import annotations

import argparse
import json
import logging
import os
import pathlib
import re
import sys
from typing import Any, Dict, Iterable, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import errors, usd_bodies
from ._library import logger
from ._whole import whole

Path = Union[str, "os.PathLike[str]"]

ENDINGS = (".usd", ".usda", ".usdc", ".usdz")
_PICTURES = (".png", ".jpg", ".jpeg")
# what a PLY's vertex has for itself
_RESERVED = {"x", "y", "z", "nx", "ny", "nz", "s", "t", "u", "v", "texture_u", "texture_v"}
_FRAMES_MAX = 100000
_COPIES_MAX = 1000  # as many objects of a kind a scene has


def _modules() -> Any:
    try:
        import pxr.Gf
        import pxr.Sdf
        import pxr.Tf
        import pxr.Usd
        import pxr.UsdGeom
        import pxr.UsdPhysics
        import pxr.UsdShade
        import pxr.UsdSkel
        import pxr.Ar
    except ImportError as error:
        raise ImportError("OpenUSD's stages need the package usd-core: pip install usd-core") from error
    return pxr


def _fault(where: Any, what: str) -> errors.FormatError:
    return errors.FormatError(f"{where}: {what}", "usd")


class _Mesh(NamedTuple):
    """A mesh in the stage's own units and axes."""

    points: np.ndarray  # [n, 3]
    counts: np.ndarray  # corners of each face
    corners: np.ndarray  # vertices
    uv: Optional[np.ndarray]  # [corners, 2]
    attributes: Dict[str, np.ndarray]  # [n]


def _write_ply(path: pathlib.Path, mesh: _Mesh) -> None:
    names = list(mesh.attributes)
    vertices = np.empty(len(mesh.points), [(name, "<f8") for name in "xyz"] + [(name, "<f4") for name in names])
    for axis, name in enumerate("xyz"):
        vertices[name] = mesh.points[:, axis]
    for name in names:
        vertices[name] = mesh.attributes[name]
    # a face is 32-bit words: a count, its vertices, and with uv another count and the uv
    sizes = 1 + mesh.counts + (1 + 2 * mesh.counts if mesh.uv is not None else 0)
    starts = np.cumsum(sizes) - sizes
    face = np.repeat(np.arange(len(mesh.counts)), mesh.counts)
    corner = np.arange(len(mesh.corners)) - np.repeat(np.cumsum(mesh.counts) - mesh.counts, mesh.counts)
    words = np.empty(int(sizes.sum()), "<u4")
    words[starts] = mesh.counts
    words[starts[face] + 1 + corner] = mesh.corners
    if mesh.uv is not None:
        words[starts + 1 + mesh.counts] = 2 * mesh.counts
        first = starts[face] + 2 + mesh.counts[face] + 2 * corner
        bits = np.ascontiguousarray(mesh.uv, "<f4").view("<u4")
        words[first], words[first + 1] = bits[:, 0], bits[:, 1]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}",
              *(f"property double {name}" for name in "xyz"), *(f"property float {name}" for name in names),
              f"element face {len(mesh.counts)}", "property list uint uint vertex_indices",
              *(["property list uint float texcoord"] if mesh.uv is not None else []), "end_header\n"]
    with whole(path) as draft:
        draft.write_bytes("\n".join(header).encode() + vertices.tobytes() + words.tobytes())


class _Reader:
    """An open stage, and what is read from it for one scene."""

    def __init__(self, path: Path, folder: pathlib.Path):
        self.pxr = _modules()
        self.path, self.folder = os.fspath(path), folder
        self.notes: List[str] = []
        self.names: List[str] = []
        self.pictures: Dict[str, str] = {}
        if not os.path.isfile(self.path):
            raise _fault(self.path, "cannot read: there is no such file")
        try:
            self.stage = self.pxr.Usd.Stage.Open(self.path)
        except self.pxr.Tf.ErrorException as error:
            # the first error has the file, the line and what was expected
            said = (str(error).strip().splitlines() or [""])[-1].strip()
            raise _fault(self.path, "is not a stage: " + said) from error
        self.up = str(self.pxr.UsdGeom.GetStageUpAxis(self.stage))
        if self.up not in ("Y", "Z"):
            raise _fault(self.path, f"upAxis is {self.up}, expected Y or Z")
        self.unit = float(self.pxr.UsdGeom.GetStageMetersPerUnit(self.stage))
        if not 1e-9 < self.unit < 1e9:
            raise _fault(self.path, f"metersPerUnit is {self.unit:g}, expected a length above 0")
        # columns: from the stage's axes to z up
        self.axes = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]] if self.up == "Y" else np.eye(3), float)
        self._read_range()
        self._bake()

    def _read_range(self) -> None:
        """The time codes of the frames; one of them where the stage says no range."""
        codes = float(self.stage.GetTimeCodesPerSecond())
        has_rate = self.stage.HasAuthoredMetadata("framesPerSecond")
        self.fps = float(self.stage.GetFramesPerSecond()) if has_rate else codes
        start, end = float(self.stage.GetStartTimeCode()), float(self.stage.GetEndTimeCode())
        self.ranged = bool(self.stage.HasAuthoredTimeCodeRange())
        if not (codes > 0 and self.fps > 0 and np.isfinite([codes, self.fps, start, end]).all()):
            raise _fault(self.path, f"timeCodesPerSecond {codes:g} and framesPerSecond {self.fps:g} must be above 0")
        if self.ranged and end < start:
            raise _fault(self.path, f"endTimeCode {end:g} comes before startTimeCode {start:g}")
        step = codes / self.fps
        count = int((end - start) / step + 1e-6) + 1 if self.ranged else 1
        if count > _FRAMES_MAX:
            self.note(self.path, f"{start:g} to {end:g} are {count} frames, which is no shot: all stands as at "
                                 f"{start:g}")
            self.ranged, count = False, 1
        self.times = [self.pxr.Usd.TimeCode(start + step * frame) for frame in range(count)]

    def _bake(self) -> None:
        """Skinned meshes get points, in the session layer: the file stays as it is."""
        skel = self.pxr.UsdSkel
        if not any(prim.IsA(skel.Root) for prim in self.stage.Traverse()):
            return
        self.stage.SetEditTarget(self.stage.GetSessionLayer())
        interval = self.pxr.Gf.Interval(self.times[0].GetValue(), self.times[-1].GetValue())
        if not skel.BakeSkinning(self.pxr.Usd.PrimRange.Stage(self.stage), interval):
            raise _fault(self.path, "its skinned meshes cannot be evaluated")

    def at(self, path: str) -> Any:
        """The prim of a path, or None."""
        good = path.startswith("/") and self.pxr.Sdf.Path.IsValidPathString(path)
        return self.stage.GetPrimAtPath(path) if good else None

    def prims(self, path: str, kinds: Sequence[str], what: str) -> List[Any]:
        """The prims of these kinds at or below a path."""
        root = self.at(path)
        if not root:
            found = [str(prim.GetPath()) for prim in self._below(self.stage.GetPseudoRoot())
                     if prim.IsA(self.pxr.UsdGeom.Mesh)]
            listed = ", ".join(found[:8]) + (f" and {len(found) - 8} more" if len(found) > 8 else "")
            raise _fault(path, f"{self.path} has no such prim; its meshes are {listed}" if found else
                         f"{self.path} has no such prim, and no meshes; references that were not found: "
                         f"{len(self.stage.GetCompositionErrors())}")
        self._expand_instancers(path)
        root = self.at(path)
        found = [prim for prim in self._below(root) if prim.GetTypeName() in kinds]
        if found:
            return found
        kind = root.GetTypeName() or "prim without a type"
        raise _fault(path, f"a {kind}, and nothing at or below it is {what}")

    def _expand_instancers(self, path: str) -> None:
        """Point instancers at or below a path get a prim for each copy, in the session layer, not in the file."""
        kind = self.pxr.UsdGeom.PointInstancer
        done: List[str] = []
        while True:
            found = [prim for prim in self._below(self.at(path))
                     if prim.IsA(kind) and str(prim.GetPath()) not in done]
            if not found:
                return
            prim = self._editable(found[0])
            done.append(str(prim.GetPath()))
            self._expand(kind(prim))

    def _editable(self, prim: Any) -> Any:
        """The prim itself where it is a copy that an instance shares with others."""
        path = prim.GetPath()
        self.stage.SetEditTarget(self.stage.GetSessionLayer())
        while prim.IsInstanceProxy():
            shared = prim
            while not shared.IsInstance():
                shared = shared.GetParent()
            shared.SetInstanceable(False)
            prim = self.stage.GetPrimAtPath(path)
        return prim

    def _expand(self, instancer: Any) -> None:
        prim, first = instancer.GetPrim(), self.times[0]
        prototypes = instancer.GetPrototypesRel().GetForwardedTargets()
        which = np.array(instancer.GetProtoIndicesAttr().Get(first) or [], np.int64)
        if len(which) and not 0 <= which.min() <= which.max() < len(prototypes):
            raise _fault(prim.GetPath(), f"protoIndices has {which.max()}, but there are {len(prototypes)} prototypes")
        shown = instancer.ComputeMaskAtTime(first)
        chosen = [copy for copy in range(len(which)) if not shown or shown[copy]]
        if len(chosen) > _COPIES_MAX:
            raise _fault(prim.GetPath(), f"{len(chosen)} copies, expected at most {_COPIES_MAX}")
        placed = self._placements(instancer, len(which))
        for child in prim.GetAllChildren():
            child.SetActive(False)  # prototypes are not drawn themselves
        for copy in chosen:
            place = self.pxr.UsdGeom.Xform.Define(self.stage, prim.GetPath().AppendChild(f"copy{copy + 1}"))
            operation = place.MakeMatrixXform()
            for time, matrices in placed:
                operation.Set(matrices[copy], time)
            thing = self.stage.DefinePrim(place.GetPath().AppendChild(prototypes[which[copy]].name))
            thing.GetReferences().AddInternalReference(prototypes[which[copy]])
            thing.SetActive(True)

    def _placements(self, instancer: Any, count: int) -> List[Tuple[Any, Any]]:
        """Time codes and the matrices of all copies then; one of them, of all times, where nothing moves."""
        usd, kind = self.pxr.Usd, self.pxr.UsdGeom.PointInstancer
        moving = any(attribute.ValueMightBeTimeVarying() for attribute in (
            instancer.GetPositionsAttr(), instancer.GetOrientationsAttr(), instancer.GetScalesAttr(),
            instancer.GetProtoIndicesAttr()))
        made = []
        for time in self.times if moving else self.times[:1]:
            matrices = instancer.ComputeInstanceTransformsAtTime(time, time, kind.ExcludeProtoXform, kind.IgnoreMask)
            if matrices is None or len(matrices) != count:
                raise _fault(instancer.GetPath(), f"has {len(matrices or [])} places for {count} copies at time code "
                                                  f"{time.GetValue():g}: copies that come and go are not read")
            made.append((time if moving else usd.TimeCode.Default(), matrices))
        return made

    def _below(self, root: Any) -> Iterable[Any]:
        usd, geom = self.pxr.Usd, self.pxr.UsdGeom
        for prim in usd.PrimRange(root, usd.TraverseInstanceProxies()):
            shown = geom.Imageable(prim)
            if not shown or prim == root or shown.ComputePurpose() not in ("guide", "proxy"):
                yield prim

    def name(self, prim: Any) -> str:
        """A name that the scene does not have yet."""
        made = base = re.sub("[^A-Za-z0-9_]", "_", prim.GetName())
        number = 1
        while made in self.names:
            number += 1
            made = f"{base}_{number}"
        self.names.append(made)
        return made

    def note(self, where: Any, what: str) -> None:
        self.notes.append(f"{where}: {what}")

    # ---- where things are

    def matrix(self, prim: Any, time: Any) -> Tuple[np.ndarray, np.ndarray]:
        """Columns of the prim's own axes and its origin, in metres, z up."""
        moved = np.array(self.pxr.UsdGeom.XformCache(time).GetLocalToWorldTransform(prim), float)
        if not np.isfinite(moved).all():
            raise _fault(prim.GetPath(), f"its transform is not finite at time code {time.GetValue():g}")
        return self.unit * self.axes @ moved[:3, :3].T, self.unit * self.axes @ moved[3, :3]

    def moves(self, prim: Any) -> bool:
        while prim and not prim.IsPseudoRoot():
            shape = self.pxr.UsdGeom.Xformable(prim)
            if shape and shape.TransformMightBeTimeVarying():
                return True
            prim = prim.GetParent()
        return False

    def poses(self, prim: Any, turn: np.ndarray) -> Dict[str, Any]:
        """Keys of a scene for a rigid pose, or for a path where the prim moves; `turn`: columns in its own axes."""
        entries = []
        for frame, time in enumerate(self.times if self.moves(prim) else self.times[:1]):
            columns, origin = self.matrix(prim, time)
            columns = columns / np.linalg.norm(columns, axis=0)
            if np.linalg.det(columns) < 0:
                columns[:, 0] *= -1  # every shape here is the same seen in a mirror
            r = columns @ turn
            angles = np.degrees([np.arctan2(r[2, 1], r[2, 2]), np.arcsin(np.clip(-r[2, 0], -1, 1)),
                                 np.arctan2(r[1, 0], r[0, 0])])
            entries.append({"time": round(frame / self.fps, 9), "position": _numbers(origin),
                            "rotation": _numbers(angles)})
        if len(entries) > 1:
            return {"path": entries}
        del entries[0]["time"]
        return entries[0]

    # ---- meshes

    @staticmethod
    def _numbers_of(attribute: Any, time: Any, kind: Any, shape: Tuple[int, ...] = (-1,)) -> np.ndarray:
        try:
            return np.array(attribute.Get(time) or [], kind).reshape(shape)
        except (TypeError, ValueError) as error:
            what = "points" if shape != (-1,) else "numbers"
            raise _fault(attribute.GetPath(), f"its values are no {what}") from error

    def mesh(self, prim: Any, time: Any, uv_name: Optional[str] = None) -> _Mesh:
        path, mesh = prim.GetPath(), self.pxr.UsdGeom.Mesh(prim)
        points = self._numbers_of(mesh.GetPointsAttr(), time, float, (-1, 3))
        counts = self._numbers_of(mesh.GetFaceVertexCountsAttr(), time, np.int64)
        corners = self._numbers_of(mesh.GetFaceVertexIndicesAttr(), time, np.int64)
        if not len(points) or not len(counts):
            raise _fault(path, f"{len(points)} points and {len(counts)} faces at time code {time.GetValue():g}")
        if not np.isfinite(points).all():
            raise _fault(path, f"point {int(np.argmin(np.isfinite(points).all(1)))} is not finite")
        if counts.min() < 3:
            raise _fault(path, f"face {int(np.argmin(counts))} has {counts.min()} corners, expected 3 or more")
        if counts.sum() != len(corners):
            raise _fault(path, f"faceVertexCounts add up to {counts.sum()}, but there are {len(corners)} "
                               "faceVertexIndices")
        if corners.min() < 0 or corners.max() >= len(points):
            wrong = int(np.argmax((corners < 0) | (corners >= len(points))))
            raise _fault(path, f"faceVertexIndices[{wrong}] is {corners[wrong]}, but there are {len(points)} points")
        columns, origin = self.matrix(prim, time)
        uv = self._uv(prim, time, uv_name, counts, corners, len(points))
        left = mesh.GetOrientationAttr().Get() == self.pxr.UsdGeom.Tokens.leftHanded
        ends = np.cumsum(counts)
        face = np.repeat(np.arange(len(counts)), counts)
        order = np.arange(len(corners))
        if left != (np.linalg.det(columns) < 0):
            order = (ends - counts)[face] + ends[face] - 1 - order
        holes = self._numbers_of(mesh.GetHoleIndicesAttr(), time, np.int64)
        kept = np.ones(len(counts), bool)
        kept[holes[(holes >= 0) & (holes < len(counts))]] = False
        order = order[kept[face]]
        return _Mesh(points @ columns.T + origin, counts[kept], corners[order], None if uv is None else uv[order],
                     self._attributes(prim, time, len(points)))

    def _uv(self, prim: Any, time: Any, name: Optional[str], counts: np.ndarray, corners: np.ndarray,
            points: int) -> Optional[np.ndarray]:
        """Of each corner. Too few or too many are an error where a picture needs them (`name`), else left out."""
        variables = self.pxr.UsdGeom.PrimvarsAPI(prim)
        found = [variables.FindPrimvarWithInheritance(one) for one in (name, "st", "uv", "UVMap") if one]
        found += [one for one in variables.GetPrimvars() if one.GetTypeName().role == "TextureCoordinate"]
        for variable in found:
            values = variable.ComputeFlattened(time) if variable and variable.HasValue() else None
            flat = np.array(values if values is not None else [])
            if flat.dtype.kind not in "fiu" or flat.ndim != 2 or flat.shape[1] < 2:
                continue
            at = {"constant": np.zeros(len(corners), np.int64), "uniform": np.repeat(np.arange(len(counts)), counts),
                  "faceVarying": np.arange(len(corners))}.get(str(variable.GetInterpolation()), corners)
            wanted = {"constant": 1, "uniform": len(counts),
                      "faceVarying": len(corners)}.get(str(variable.GetInterpolation()), points)
            if len(flat) == wanted:
                return flat[at, :2].astype(float)
            fault = f"{variable.GetName()} has {len(flat)} values, expected {wanted} ({variable.GetInterpolation()})"
            if name:
                raise _fault(prim.GetPath(), fault)
            self.note(prim.GetPath(), fault + ": the sheet has no uv")
            return None
        return None

    def _attributes(self, prim: Any, time: Any, points: int) -> Dict[str, np.ndarray]:
        """Scalars of the points, which a material's parameters may follow."""
        made: Dict[str, np.ndarray] = {}
        for variable in self.pxr.UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithValues():
            name = variable.GetPrimvarName()
            if str(variable.GetInterpolation()) not in ("vertex", "varying") or name in _RESERVED:
                continue
            values = np.array(variable.ComputeFlattened(time))
            named = re.fullmatch("[A-Za-z_][A-Za-z0-9_]{0,99}", name)
            if values.shape == (points,) and values.dtype.kind in "fiu" and named:
                if not np.isfinite(values).all():
                    raise _fault(prim.GetPath(), f"primvars:{name} has a value that is not finite")
                made[name] = values
        return made

    # ---- how a sheet looks

    def look(self, prim: Any, keys: Dict[str, Any]) -> Tuple[Optional[str], Any]:
        """Fills in `picture` and `colour`; the primvar of its uv, and what turns them into the picture's."""
        shade = self.pxr.UsdShade
        material = shade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
        if not material:
            for subset in self.pxr.UsdGeom.Subset.GetAllGeomSubsets(self.pxr.UsdGeom.Imageable(prim)):
                material = material or shade.MaterialBindingAPI(subset.GetPrim()).ComputeBoundMaterial()[0]
            if material:
                self.note(prim.GetPath(), f"its faces have several materials; all look as {material.GetPath()} does")
        surface = material.ComputeSurfaceSource()[0] if material else None
        if not surface or surface.GetIdAttr().Get() != "UsdPreviewSurface":
            if surface:
                self.note(material.GetPath(), f"its surface is {surface.GetIdAttr().Get()}, not a UsdPreviewSurface")
            colours = self.pxr.UsdGeom.Gprim(prim).GetDisplayColorAttr().Get()
            if colours is not None and len(colours) == 1:
                keys["colour"] = _numbers(np.clip(colours[0], 0, 1))
            return None, None
        texture, colour = self._diffuse(surface)
        if colour is not None:
            keys["colour"] = _numbers(np.clip(colour, 0, 1))
        if texture is None:
            return None, None
        picture = self._picture(texture)
        if picture:
            keys["picture"] = picture
        return self._coordinates(texture)

    def _connected(self, shader: Any, name: str) -> Any:
        """The shader behind an input, through the interfaces of graphs; or the input's value."""
        port = shader.GetInput(name) if shader else None
        sources = self.pxr.UsdShade.Utils.GetValueProducingAttributes(port) if port else []
        if not sources:
            return None, None
        source = self.pxr.UsdShade.Shader(sources[0].GetPrim())
        if source and self.pxr.UsdShade.Output.IsOutput(sources[0]):
            return source, None
        return None, sources[0].Get(self.times[0])

    def _diffuse(self, surface: Any) -> Tuple[Any, Any]:
        shader, colour = self._connected(surface, "diffuseColor")
        if shader is None or shader.GetIdAttr().Get() == "UsdUVTexture":
            return shader, colour
        self.note(shader.GetPath(), f"a {shader.GetIdAttr().Get()} colours the surface, and only a UsdUVTexture is "
                                    "read")
        return None, None

    def _picture(self, texture: Any) -> Optional[str]:
        asset = self._connected(texture, "file")[1]
        where = texture.GetPath()
        if not asset or not asset.path:
            self.note(where, "names no picture")
            return None
        resolved = str(asset.resolvedPath)
        inner = re.sub(r".*\[(.*)\]$", r"\1", resolved) if resolved.endswith("]") else resolved
        if not resolved:
            raise _fault(where, f"its picture {asset.path} cannot be found")
        if not inner.lower().endswith(_PICTURES):
            raise _fault(where, f"its picture {asset.path} is neither PNG nor JPEG")
        if resolved not in self.pictures:
            opened = self.pxr.Ar.GetResolver().OpenAsset(self.pxr.Ar.ResolvedPath(resolved))
            if not opened:
                raise _fault(where, f"its picture {asset.path} cannot be read")
            name = os.path.basename(inner)
            while name in self.pictures.values():
                name = "_" + name
            with whole(self.folder / name) as draft:
                draft.write_bytes(bytes(opened.GetBuffer()))
            self.pictures[resolved] = name
        return self.pictures[resolved]

    def _coordinates(self, texture: Any) -> Tuple[Optional[str], Any]:
        """The primvar behind a texture, and (scale, rotation in degrees, translation) of a UsdTransform2d before it."""
        reader, _ = self._connected(texture, "st")
        change = None
        if reader is not None and reader.GetIdAttr().Get() == "UsdTransform2d":
            values = [self._connected(reader, name)[1] for name in ("scale", "rotation", "translation")]
            change = [default if value is None else value for value, default in zip(values, ((1, 1), 0.0, (0, 0)))]
            reader, _ = self._connected(reader, "in")
        name = self._connected(reader, "varname")[1] if reader is not None else None
        return (str(name) if name else None), change

    # ---- the objects of a scene

    def burning(self, path: str) -> List[Any]:
        """The meshes at or below a path that burn: of a deformable body the simulated one alone."""
        found = self.prims(path, ["Mesh"], "a mesh")
        simulated = [prim for prim in found if usd_bodies.SIMULATED in usd_bodies.applied(prim)]
        bodies = [usd_bodies.body_of(prim) for prim in simulated]
        return [prim for prim in found if prim in simulated
                or not any(body and body == usd_bodies.body_of(prim) for body in bodies)]

    def _looked_at(self, prim: Any, keys: Dict[str, Any]) -> _Mesh:
        """The mesh of a prim, with the uv of its picture."""
        variable, change = self.look(prim, keys)
        mesh = self.mesh(prim, self.times[0], variable)
        if change is not None and mesh.uv is not None:
            (sx, sy), angle, moved = change
            c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
            scaled = mesh.uv * [sx, sy]
            mesh = mesh._replace(uv=scaled @ np.array([[c, s], [-s, c]]) + np.array(moved, float))
        if "picture" in keys and mesh.uv is None:
            self.note(prim.GetPath(), "has a picture and no uv to put it on")
        return mesh

    def _body(self, prim: Any, mesh: _Mesh, keys: Dict[str, Any]) -> None:
        """What a deformable body says beside its mesh: a material's numbers, a velocity, a mesh that is drawn."""
        velocities = np.array(self.pxr.UsdGeom.Mesh(prim).GetVelocitiesAttr().Get(self.times[0]) or [], float)
        if len(velocities) and np.isfinite(velocities).all() and velocities.any():
            keys["velocity"] = _numbers(self.matrix(prim, self.times[0])[0] @ velocities.mean(0))
            if np.ptp(velocities, axis=0).any():
                self.note(prim.GetPath(), "its points have velocities of their own; the sheet starts with their mean")
        if prim.GetAttribute("physics:restShapePoints").HasAuthoredValue():
            self.note(prim.GetPath(), "has a shape at rest, which is not read: the sheet is at rest as it lies")
        material = usd_bodies.material_of(self.pxr, prim, _area(mesh), self.unit,
                                          self.pxr.UsdPhysics.GetStageKilogramsPerUnit(self.stage))
        if material:
            keys["material"] = {name: _number(value) for name, value in material.items()}
        body = usd_bodies.body_of(prim)
        drawn = usd_bodies.drawn_with(prim, list(self._below(body))) if body else []
        if drawn:
            keys["render_mesh"] = {"mesh": self.name(drawn[0]) + ".ply"}
            _write_ply(self.folder / keys["render_mesh"]["mesh"], self._looked_at(drawn[0], keys))
        if len(drawn) > 1:
            self.note(body.GetPath(), f"has {len(drawn)} meshes to draw; {drawn[0].GetPath()} is drawn")

    def sheet(self, prim: Any) -> Dict[str, Any]:
        keys: Dict[str, Any] = {"name": self.name(prim)}
        mesh = self._looked_at(prim, keys)
        if usd_bodies.SIMULATED in usd_bodies.applied(prim):
            self._body(prim, mesh, keys)
        if self.moves(prim) or self.pxr.UsdGeom.Mesh(prim).GetPointsAttr().ValueMightBeTimeVarying():
            self.note(prim.GetPath(), "moves in the stage; the sheet starts as it is at the first frame and then moves "
                                      "freely")
        keys["mesh"] = keys["name"] + ".ply"
        _write_ply(self.folder / keys["mesh"], mesh)
        return keys

    def _mesh_collider(self, prim: Any, keys: Dict[str, Any]) -> None:
        moving = self.moves(prim) or self.pxr.UsdGeom.Mesh(prim).GetPointsAttr().ValueMightBeTimeVarying()
        name = self.name(prim)
        for frame, time in enumerate(self.times if moving else self.times[:1]):
            mesh = self.mesh(prim, time)._replace(uv=None, attributes={})
            _write_ply(self.folder / (f"{name}.{frame + 1:04d}.ply" if moving else f"{name}.ply"), mesh)
        keys.update({"motion": {"mesh": f"{name}.####.ply"}} if moving else {"mesh": f"{name}.ply"})

    def collider(self, prim: Any) -> Dict[str, Any]:
        geom, kind, path = self.pxr.UsdGeom, str(prim.GetTypeName()), prim.GetPath()
        keys: Dict[str, Any] = {"kind": {"Cube": "box"}.get(kind, kind.lower())}
        if kind == "Mesh":
            self._mesh_collider(prim, keys)
            return keys
        columns, _ = self.matrix(prim, self.times[0])
        sizes = np.linalg.norm(columns, axis=0)
        if np.abs(columns.T @ columns - np.diag(sizes**2)).max() > 1e-4 * sizes.max()**2 or not sizes.min() > 0:
            raise _fault(path, f"its transform shears it or makes it flat: a {kind} must stay one. A Mesh may be "
                               "sheared")
        if kind in ("Sphere", "Capsule") and sizes.max() > 1.0001 * sizes.min():
            raise _fault(path, f"is stretched, {sizes.min():g} to {sizes.max():g}: a {kind} must stay one. A Mesh may "
                               "be stretched")
        turn = np.eye(3)
        if kind in ("Capsule", "Plane"):
            axis = "XYZ".index(str(getattr(geom, kind)(prim).GetAxisAttr().Get()))
            turn = np.roll(np.eye(3), axis - 2, axis=0)  # its own z is that axis
        if kind == "Cube":
            keys["half_size"] = _numbers(sizes * geom.Cube(prim).GetSizeAttr().Get() / 2)
        elif kind != "Plane":
            shape = getattr(geom, kind)(prim)
            keys["radius"] = _number(sizes[0] * shape.GetRadiusAttr().Get())
            if kind == "Capsule":
                keys["height"] = _number(sizes[0] * shape.GetHeightAttr().Get())
        keys.update(self.poses(prim, turn))
        return keys

    def fire(self, path: str) -> Dict[str, Any]:
        prim = self.at(path)
        if not prim or not self.pxr.UsdGeom.Xformable(prim):
            raise _fault(path, f"{self.path} has no such prim with a transform")
        keys = self.poses(prim, np.eye(3))
        for entry in keys.get("path", [keys]):
            del entry["rotation"]
        radius = {}
        if prim.IsA(self.pxr.UsdGeom.Sphere):
            scale = np.linalg.norm(self.matrix(prim, self.times[0])[0][:, 0])
            radius["radius"] = _number(scale * self.pxr.UsdGeom.Sphere(prim).GetRadiusAttr().Get())
        return {"kind": "ball" if "path" in keys else "spot", **radius, **keys}


def _area(mesh: _Mesh) -> float:
    """m2, each face as a fan."""
    ends = np.cumsum(mesh.counts)
    corner = np.arange(len(mesh.corners))
    first = np.repeat(ends - mesh.counts, mesh.counts)
    inner = (corner > first) & (corner < np.repeat(ends, mesh.counts) - 1)
    a, b, c = (mesh.points[mesh.corners[at]] for at in (first[inner], corner[inner], corner[inner] + 1))
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _number(value: Any) -> float:
    return float(f"{float(value):.9g}")


def _numbers(values: Any) -> List[float]:
    return [_number(value) + 0.0 for value in values]


def scene(stage: Path, folder: Path, sheets: Sequence[str], *, colliders: Sequence[str] = (),
          fire: Sequence[str] = (), also: Optional[Path] = None) -> pathlib.Path:
    """Writes a scene of a stage into a folder, and returns the path of its file: NAME.yaml for NAME.usda.

    sheets, colliders: paths of prims; every mesh at or below one is a sheet or a collider of its own, as is each copy
    of a point instancer, and a Sphere, Cube, Capsule or Plane is a collider. fire: paths of prims that are hot balls of
    1200 K, as a null that stands where the match is. also: a file with further keys of the scene, such as `pace` or
    `pins`, which is copied behind.

    FormatError has the path of the prim. What was read otherwise than it looks in the stage is logged as a warning.
    """
    if isinstance(sheets, str) or isinstance(colliders, str) or isinstance(fire, str):
        raise TypeError("sheets, colliders and fire are lists of paths")
    place = pathlib.Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    reader = _Reader(stage, place)
    meshes = [prim for path in sheets for prim in reader.burning(path)]
    solids = [prim for path in colliders for prim in reader.prims(
        path, ["Mesh", "Sphere", "Cube", "Capsule", "Plane"], "a Mesh, Sphere, Cube, Capsule or Plane")]
    if not meshes:
        raise _fault(reader.path, "no sheets: name the meshes that burn, as /World/Letter")
    lines = [f"# from {os.path.basename(reader.path)}: up {reader.up}, {reader.unit:g} m a unit"]
    if reader.ranged:
        lines += [f"fps: {_number(reader.fps):g}", f"frames: {len(reader.times)}"]
    for key, objects in (("sheets", [reader.sheet(prim) for prim in meshes]),
                         ("colliders", [reader.collider(prim) for prim in solids]),
                         ("sources", [reader.fire(path) for path in fire])):
        lines += ([f"{key}:"] if objects else []) + [f"  - {json.dumps(one)}" for one in objects]
    text = "\n".join(lines) + "\n" + (pathlib.Path(also).read_text(encoding="utf-8") if also else "")
    target = place / (re.sub("[^A-Za-z0-9_-]", "_", pathlib.Path(reader.path).stem) + ".yaml")
    with whole(target) as draft:
        draft.write_text(text, encoding="utf-8")
    for note in reader.notes:
        logger.warning("%s", note)
    return target


_LISTS = {"--sheets": "prims whose meshes burn", "--colliders": "prims that sheets rest on",
          "--fire": "prims that are hot, as a match is"}


def command(arguments: Sequence[str]) -> List[str]:
    """The command's own arguments for `run STAGE --sheets PATHS ...`: the stage becomes a scene, out/NAME-scene."""
    given: Dict[str, str] = {}
    rest: List[str] = []
    words = iter(arguments[1:])
    for word in words:
        name, equals, value = word.partition("=")
        if name in _LISTS or name == "--also":
            given[name] = value if equals else next(words, "")
        elif "stage" not in given and word.lower().endswith(ENDINGS):
            given["stage"] = word
        else:
            rest.append(word)
    if "stage" not in given:
        raise _fault("--sheets", "names prims of an OpenUSD stage, and there is no file that ends in "
                                 + ", ".join(ENDINGS))
    lists = {name[2:]: [path for path in given.get(name, "").split(",") if path] for name in _LISTS}
    folder = pathlib.Path("out") / (pathlib.Path(given["stage"]).stem + "-scene")
    return [arguments[0], str(scene(given["stage"], folder, also=given.get("--also"), **lists)), *rest]


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m singe.usd", description="Writes a scene of an OpenUSD stage.")
    parser.add_argument("stage")
    for name, what in _LISTS.items():
        parser.add_argument(name, default=[], metavar="PATH,...", help=what, type=lambda text: text.split(","))
    parser.add_argument("--also", metavar="FILE", help="further keys of the scene, in YAML")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER", help="where the scene is written")
    known = parser.parse_args(arguments)
    print(scene(known.stage, known.output, known.sheets, colliders=known.colliders, fire=known.fire, also=known.also))
    return 0


def told(call: Any, *arguments: Any) -> Any:
    """What a function returns; warnings go to standard error, and an error ends the program."""
    logging.basicConfig(format="singe: warning: %(message)s", level=logging.WARNING)
    try:
        return call(*arguments)
    except (errors.Error, ImportError, OSError) as error:
        print(f"singe: error: {str(error)[5:] if str(error).startswith('usd: ') else error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    sys.exit(told(main))
