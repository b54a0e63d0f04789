"""Sheets that burn in Houdini: a Python SOP, and the digital asset around it. Not run in Houdini.

In Houdini's Python Shell, with this package installed for Houdini's Python (`hython -m pip install ...`):

    import singe.houdini
    singe.houdini.make_asset("singe_burn.hda")

makes and installs the asset *Singe Burn*. Its first input is the sheet, polygons of any number of corners; the point
group `match` is lit, and `held` stays where it is. The second input is what sheets rest on, a closed mesh.
docs/houdini.md has the parameters. Only what SideFX documents of `hou` is called, and tests/python/test_houdini.py
holds it against a stand-in.
"""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Tuple

import numpy as np

from . import errors
from .simulation import Sim

LABEL, NAME = "Singe Burn", "singe_burn"
CODE = "import singe.houdini\nsinge.houdini.cook(hou, hou.pwd())\n"
# name, label, default, smallest, largest; a text has neither
PARAMETERS: Tuple[Tuple[str, str, Any, Any, Any], ...] = (
    ("material", "Material", "office-paper", None, None),
    ("pace", "Pace (s of fire a s)", 8.0, 0.0, 50.0),
    ("thickness", "Thickness (m)", 0.001, 1e-5, 0.01),
    ("detail", "Detail (m)", 0.001, 0.0, 0.01),
    ("heat", "Match (K)", 1200.0, 300.0, 1500.0),
    ("lit", "Match Burns (s)", 0.5, 0.0, 10.0),
    ("wind", "Wind along x (m/s)", 0.0, -10.0, 10.0),
)
_FRAMES = (("start", "Start Frame", "$FSTART"), ("frame", "Frame", "$F"))
# attributes of points: in Houdini, of the drawn surface, values a point
_ATTRIBUTES = (("N", "normal", 3), ("v", "velocity", 3), ("uv", "uv", 3), ("rest", "rest_position", 3),
               ("temperature", "temperature", 1), ("burnt", "burn", 1), ("mass", "mass", 1), ("piece", "piece", 1))


class _Burn(NamedTuple):
    """A simulation that has reached a frame, and what it was made of."""

    sim: Sim
    frame: int
    made_of: Tuple[Any, ...]


_burns: Dict[str, _Burn] = {}  # by the path of the node


def _mesh(geometry: Any) -> Tuple[np.ndarray, List[List[int]]]:
    """Positions, and the points of each polygon, counter-clockwise seen from the front: Houdini's are clockwise."""
    points = np.array(geometry.pointFloatAttribValues("P"), np.float32).reshape(-1, 3)
    return points, [[vertex.point().number() for vertex in prim.vertices()][::-1] for prim in geometry.prims()]


def _group(geometry: Any, name: str) -> List[int]:
    group = geometry.findPointGroup(name)
    return [point.number() for point in group.points()] if group else []


def _begin(values: Dict[str, Any], points: np.ndarray, faces: List[List[int]], groups: Dict[str, List[int]],
           solid: Any) -> Sim:
    sim = Sim(pace=values["pace"], surface_detail=values["detail"], gravity=[0, -9.81, 0])
    sheet = sim.sheet(points, faces, material={"base": values["material"], "thickness": values["thickness"]})
    if groups["held"]:
        sim.pin(sheet, vertices=groups["held"])
    radius = 0.5 * float(np.sqrt(np.median(_areas(points, faces))))
    for number in groups["match"]:
        sim.spot(points[number], radius=radius, falloff=radius, temperature=values["heat"], end=values["lit"])
    if solid is not None:
        corners = [[face[0], face[k], face[k + 1]] for face in solid[1] for k in range(1, len(face) - 1)]
        sim.collider("mesh", vertices=solid[0], triangles=np.array(corners))
    if values["wind"]:
        sim.wind([values["wind"], 0, 0], gust=0.3 * abs(values["wind"]))
    sim.commit()
    return sim


def _areas(points: np.ndarray, faces: List[List[int]]) -> List[float]:
    """m2 of each face, by its first and last corners."""
    return [float(np.linalg.norm(np.cross(points[face[1]] - points[face[0]], points[face[-1]] - points[face[0]])))
            for face in faces]


def _write(hou: Any, geometry: Any, sim: Sim) -> None:
    surface = sim.surface()
    geometry.clear()
    geometry.createPoints(surface.position.astype(float).tolist())
    geometry.createPolygons(surface.triangles[:, ::-1].tolist())
    for name, field, width in _ATTRIBUTES:
        values = np.asarray(getattr(surface, field), np.float32)
        if width == 3 and values.shape[1] == 2:  # Houdini's uv have three
            values = np.concatenate([values, np.zeros_like(values[:, :1])], axis=1)
        geometry.addAttrib(hou.attribType.Point, name, 0.0 if width == 1 else (0.0,) * width)
        geometry.setPointFloatAttribValues(name, values.ravel().tolist())


def cook(hou: Any, node: Any) -> None:
    """Replaces a node's geometry by the sheet as it is at the node's frame.

    Frames are computed one after another: a frame that comes before the last one, or another input or parameter, begins
    again. hou.NodeError says what is wrong.
    """
    values = {name: node.evalParm(name) for name, *_ in PARAMETERS}
    start, frame = (int(node.evalParm(name)) for name, *_ in _FRAMES)
    geometry = node.geometry()
    points, faces = _mesh(geometry)
    if not faces:
        raise hou.NodeError("the first input has no polygons")
    groups = {name: _group(geometry, name) for name in ("match", "held")}
    inputs = node.inputs()
    solid = _mesh(inputs[1].geometry()) if len(inputs) > 1 and inputs[1] else None
    made_of = (start, hou.fps(), repr(values), points.tobytes(), repr(faces), repr(groups),
               None if solid is None else (solid[0].tobytes(), repr(solid[1])))
    burn = _burns.get(node.path())
    try:
        if burn is None or burn.made_of != made_of or burn.frame > frame:
            burn = _Burn(_begin(values, points, faces, groups, solid), start, made_of)
        if frame > burn.frame:
            burn.sim.advance((frame - burn.frame) / hou.fps())
        _burns[node.path()] = burn._replace(frame=max(frame, start))
        _write(hou, geometry, burn.sim)
    except errors.Error as error:
        _burns.pop(node.path(), None)
        raise hou.NodeError(str(error)) from error


def make_asset(path: str) -> Any:
    """Makes the digital asset in a file and installs it, inside Houdini; returns its definition."""
    import hou  # Houdini's own

    place = hou.node("/obj").createNode("geo", "singe_asset")
    try:
        subnet = place.createNode("subnet", NAME)
        burn = subnet.createNode("python", "burn")
        burn.parm("python").set(CODE)
        for index in range(2):
            burn.setInput(index, subnet.indirectInputs()[index])
        template = burn.parmTemplateGroup()
        for one in _templates(hou):
            template.append(one)
        burn.setParmTemplateGroup(template)
        burn.setDisplayFlag(True)
        asset = subnet.createDigitalAsset(NAME, path, LABEL, min_num_inputs=1, max_num_inputs=2)
        definition = asset.type().definition()
        template = definition.parmTemplateGroup()
        for one in _templates(hou):
            template.append(one)
        definition.setParmTemplateGroup(template)
        inner = asset.node("burn")
        for name in [name for name, *_ in PARAMETERS] + [name for name, *_ in _FRAMES]:
            inner.parm(name).setExpression(f'ch{"s" if name == "material" else ""}("../{name}")')
        definition.updateFromNode(asset)
        return definition
    finally:
        place.destroy()


def _templates(hou: Any) -> List[Any]:
    made = []
    for name, label, value, low, high in PARAMETERS:
        if isinstance(value, str):
            made.append(hou.StringParmTemplate(name, label, 1, default_value=(value,)))
        else:
            made.append(hou.FloatParmTemplate(name, label, 1, default_value=(value,), min=low, max=high))
    for name, label, expression in _FRAMES:
        made.append(hou.IntParmTemplate(name, label, 1, default_expression=(expression,)))
    return made
