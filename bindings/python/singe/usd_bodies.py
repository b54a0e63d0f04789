"""Sheets as deformable bodies of OpenUSD, by a proposed schema: OpenUSD-proposals, pull request 111, commit 63c74d79.

    python3 -m singe.usd_bodies out/letter --frame 24 -o letter.usda

writes the sheets of a frame as bodies that another simulator takes on, such as Newton 1.8. `singe.usd` reads such
bodies as sheets. OpenUSD does not have these schemas yet, so they are read and written by name. Needs PyPI's usd-core.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import re
import sys
from typing import Any, Dict, List, Mapping, Optional, Sequence, Set, Union

import numpy as np

from . import errors
from ._whole import whole
from .cache import Cache, Frame, read_cache

Path = Union[str, "os.PathLike[str]"]

BODY = "PhysicsDeformableBodyAPI"
SIMULATED = "PhysicsSurfaceDeformableSimAPI"
COLLIDES = "PhysicsCollisionAPI"
MATERIAL = "PhysicsSurfaceDeformableMaterialAPI"
# what the proposal assumes where a material says nothing, in SI units
_POISSON, _THICKNESS = 0.3, 1e-3


def applied(prim: Any) -> Set[str]:
    """The names of the schemas that are applied to a prim, also of those that this OpenUSD does not know."""
    return set(prim.GetPrimTypeInfo().GetAppliedAPISchemas())


def body_of(prim: Any) -> Any:
    """The deformable body that a prim belongs to: itself or the nearest above; or None."""
    while prim and not prim.IsPseudoRoot():
        if BODY in applied(prim):
            return prim
        prim = prim.GetParent()
    return None


def drawn_with(prim: Any, below: Sequence[Any]) -> List[Any]:
    """Of the prims below a body, the meshes that are drawn in place of its simulated one, `prim`."""
    return [one for one in below if one != prim and one.GetTypeName() == "Mesh" and body_of(one) == body_of(prim)
            and not applied(one) & {SIMULATED, COLLIDES}]


def _value(prim: Any, name: str) -> Any:
    attribute = prim.GetAttribute("physics:" + name) if prim else None
    return attribute.Get() if attribute and attribute.HasAuthoredValue() else None


def _positive(prim: Any, name: str) -> Optional[float]:
    value = _value(prim, name)
    return float(value) if value is not None and 0 < float(value) < np.inf else None


def _positive_array(prim: Any, name: str) -> np.ndarray:
    values = np.array(_value(prim, name) if _value(prim, name) is not None else [], float)
    return values if len(values) and (values > 0).all() and np.isfinite(values).all() else np.empty(0)


def material_of(pxr: Any, prim: Any, area: float, unit: float, mass_unit: float) -> Dict[str, float]:
    """Keys of a scene's material, in SI units, that a simulated mesh of an area in m2 states.

    Mass comes from the masses of the mesh, else the body's mass, the body's density, the material's density, in this
    order, as the proposal has it. What the stage does not say, the scene's material decides.
    """
    body = body_of(prim)
    binding = pxr.UsdShade.MaterialBindingAPI(prim)
    bound = binding.ComputeBoundMaterial("physics")[0]
    stuff = bound.GetPrim() if bound else None
    thicknesses = _positive_array(prim, "thicknesses")
    thickness = unit * float(thicknesses.mean()) if len(thicknesses) else None
    masses, mass = _positive_array(prim, "masses"), _positive(body, "mass")
    density = _positive(body, "density") or _positive(stuff, "density")

    keys: Dict[str, float] = {}
    if len(masses):
        keys["grammage"] = mass_unit * float(masses.sum()) / area
    elif mass:
        keys["grammage"] = mass_unit * mass / area
    elif density:
        keys["grammage"] = density * mass_unit / unit**3 * (thickness or _THICKNESS)

    bending, young = _positive(stuff, "surfaceBendStiffness"), _positive(stuff, "youngsModulus")
    if bending:
        keys["bending"] = bending * mass_unit * unit**2
    elif young:
        poisson = _value(stuff, "poissonsRatio")
        poisson = _POISSON if poisson is None else float(poisson)
        keys["bending"] = young * mass_unit / unit * (thickness or _THICKNESS)**3 / (12 * (1 - poisson**2))
    return keys


# ---- written

def _mean(value: Any) -> float:
    """A number of a scene's material, or the middle of one that varies."""
    return 0.5 * (float(value["from"]) + float(value["to"])) if isinstance(value, Mapping) else float(value)


def _bending(material: Mapping[str, Any]) -> float:
    """N m. docs/scene.md, `bending` and `compliance.green`."""
    green = _mean(material["compliance"]["green"]) - _mean(material["compliance"]["blue"])
    return _mean(material["bending"]) or _mean(material["thickness"])**2 / max(green, 1e-12)


def _list(values: np.ndarray) -> str:
    rows = np.asarray(values)
    if rows.ndim == 1:
        return "[" + ", ".join(f"{v:.9g}" for v in rows) + "]"
    return "[" + ", ".join("(" + ", ".join(f"{v:.9g}" for v in row) + ")" for row in rows) + "]"


def _masses(positions: np.ndarray, triangles: np.ndarray, grammage: float, left: np.ndarray) -> np.ndarray:
    """kg of each vertex: a third of the sheet at rest around it, less what has burnt."""
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    shares = np.bincount(triangles.ravel(), np.repeat(areas / 3, 3), len(positions))
    return grammage * shares * np.asarray(left, float)


def _sheet(frame: Frame, number: int, name: str, material: Mapping[str, Any], thickness: float) -> str:
    triangles = frame.triangles[frame.sheet[frame.triangles[:, 0]] == number]
    chosen, triangles = np.unique(triangles, return_inverse=True)  # no vertex without a triangle
    triangles = triangles.reshape(-1, 3)
    rest = frame.rest_position[chosen]
    masses = _masses(rest, triangles, _mean(material["grammage"]), frame.mass[chosen])
    masses = np.maximum(masses, 1e-3 * masses.mean())  # the schema forbids a mass of 0
    kinds = [("texCoord2f[]", "st", "uv"), ("float[]", "temperature", "temperature"), ("float[]", "burnt", "burn")]
    fields = "".join(f"""
        {kind} primvars:{key} = {_list(getattr(frame, attribute)[chosen])} (interpolation = "vertex")"""
                     for kind, key, attribute in kinds if hasattr(frame, attribute))
    return f"""
    def Mesh "{name}" (prepend apiSchemas = ["{BODY}", "{SIMULATED}", "{COLLIDES}", "MaterialBindingAPI"])
    {{
        uniform token subdivisionScheme = "none"
        point3f[] points = {_list(frame.position[chosen])}
        vector3f[] velocities = {_list(frame.velocity[chosen])}
        int[] faceVertexCounts = {_list(np.full(len(triangles), 3))}
        int[] faceVertexIndices = {_list(triangles.ravel())}{fields}
        point3f[] physics:restShapePoints = {_list(rest)}
        uniform token physics:restBendAnglesDefault = "restShape"
        float[] physics:masses = {_list(masses)}
        uniform token physics:masses:elementType = "point"
        float[] physics:thicknesses = [{thickness:.9g}]
        uniform token physics:thicknesses:elementType = "constant"
        rel material:binding:physics = </World/Materials/{name}>
    }}
"""


def write(cache: Cache, path: Path, frame: int = -1) -> None:
    """Writes the sheets of a cache's frame as deformable bodies: a .usda in metres, kilograms and z up.

    Each sheet is a mesh of triangles with positions, velocities, its shape at rest, the mass that the fire has left of
    each vertex, and the bending stiffness of its material. Its thickness is the distance that contact keeps. Its
    stretch is left to the simulator: our sheets do not stretch.
    """
    shot = cache[frame]
    scene = cache.scene
    thickness = float(scene.get("contact", {}).get("thickness", 5e-4))
    there = sorted(set(shot.sheet[shot.triangles[:, 0]].tolist()))
    if not there:
        raise errors.FormatError(f"{cache.folder}: frame {shot.number} has no sheets left", "usd")
    names = {number: re.sub("[^A-Za-z0-9_]", "_", scene["sheets"][number].get("name", f"sheet{number + 1}"))
             for number in there}
    stuff = "".join(f"""
        def Material "{names[number]}" (prepend apiSchemas = ["{MATERIAL}"])
        {{
            float physics:surfaceBendStiffness = {_bending(scene["sheets"][number]["material"]):.9g}
        }}
""" for number in there)
    sheets = "".join(_sheet(shot, number, names[number], scene["sheets"][number]["material"], thickness)
                     for number in there)
    text = f"""#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    kilogramsPerUnit = 1
    upAxis = "Z"
    doc = "frame {shot.number} of {cache.name}, burnt by Singe"
)

def Xform "World"
{{{sheets}
    def Scope "Materials"
    {{{stuff}    }}
}}
"""
    with whole(pathlib.Path(path)) as draft:
        draft.write_text(text, encoding="utf-8")


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m singe.usd_bodies",
                                     description="Writes the sheets of a frame as deformable bodies of OpenUSD.")
    parser.add_argument("folder", help="of a run")
    parser.add_argument("--frame", type=int, default=-1, help="the last one without it")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.usda")
    known = parser.parse_args(arguments)
    try:
        write(read_cache(known.folder), known.output, known.frame)
    except (errors.Error, IndexError, OSError) as error:
        print(f"singe: error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
