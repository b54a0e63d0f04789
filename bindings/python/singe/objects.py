"""Handles of objects in a simulation: sheets, sources, pins, colliders. Also meshes before they become sheets."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _abi
from ._fields import Attributes, assign, default, floats, indices, number, path_keys, pointer, triples
from ._library import library, log_callback, raise_for
from .views import StepView, shown

if TYPE_CHECKING:
    from .simulation import Sim


class Grid(NamedTuple):
    """Arguments for `Sim.sheet`: `sim.sheet(*singe.grid())`."""

    points: npt.NDArray[np.float32]
    faces: npt.NDArray[np.uint32]
    uv: npt.NDArray[np.float32]


class Mesh:
    """Quads that the library has made from a mesh; freed with the last array that refers to them."""

    def __init__(self, create: Any, made: Any):
        self.pointer = ctypes.c_void_p()
        self._destroy = library.singe_mesh_destroy
        error = _abi.SingeError()
        if create(ctypes.byref(made), ctypes.byref(self.pointer), ctypes.byref(error)):
            raise_for(error)
        self.view = _abi.SingeMeshView()
        library.singe_mesh_read(self.pointer, ctypes.byref(self.view), ctypes.sizeof(self.view))

    def __del__(self) -> None:
        self._destroy(self.pointer)

    def fill(self, sheet: _abi.SingeSheetDef) -> None:
        for name in ("vertex_count", "positions", "cell_count", "cells", "uv", "corner_uv", "attribute_count",
                     "attributes", "source_vertex", "source_count", "corner_source_vertex"):
            setattr(sheet, name, getattr(self.view, name))

    def became(self, count: int) -> npt.NDArray[np.int64]:
        """[vertices of the input] the sheet's vertex for each; -1: not in any face."""
        if not self.view.became:
            return np.where(np.arange(count) < self.view.vertex_count, np.arange(count), -1)
        now = shown(self.view.became, (self.view.source_count,), np.uint32, self).astype(np.int64)
        now[now == 0xFFFFFFFF] = -1
        return now


def grid(size: Tuple[float, float] = (0.2, 0.2), cells: Tuple[int, int] = (50, 50), **options: Any) -> Grid:
    """A flat rectangle of `cells` around the origin of the x-y plane, `size` in m, front upwards.

    Options: `jitter`, of a cell, how far vertices lie off the grid at most (0.15); `displacement`, m, root mean square
    height of waves (0); `seed` (1).
    """
    made = default(_abi.SingeGridDef, "singe_init_grid")
    assign(made, {"size": size, "cells": cells, **options}, [])
    mesh = Mesh(library.singe_mesh_create_grid, made)
    view = mesh.view
    return Grid(shown(view.positions, (view.vertex_count, 3), np.float32, mesh),
                shown(view.cells, (view.cell_count, 4), np.uint32, mesh),
                shown(view.uv, (view.vertex_count, 2), np.float32, mesh))


def make_mesh(points: Any, faces: Any, uv: Any, corner_uv: Any, attributes: Attributes, options: Any,
              keep: List[Any]) -> Mesh:
    """Makes quads from a caller's mesh. `faces` is [n, corners], or a list of faces of any sizes."""
    made = default(_abi.SingeMeshDef, "singe_init_mesh")
    assign(made, options, keep)
    made.log.write = log_callback
    made.vertex_count, made.positions = len(points), pointer(points, ctypes.c_float, keep)
    try:
        faces = faces if isinstance(faces, np.ndarray) else [list(face) for face in faces]
    except TypeError:
        raise TypeError(f"faces must be lists of vertices, or an array [n, corners], not {faces!r}") from None
    if isinstance(faces, np.ndarray) or len({len(face) for face in faces}) <= 1:
        faces = np.asarray(faces)
        if faces.ndim != 2:
            raise ValueError(f"faces must have the shape [n, corners], or be a list of lists, not {list(faces.shape)}")
        sizes = np.full(len(faces), faces.shape[1], np.uint32)
        corners = indices(faces, "faces")
    else:
        sizes = np.array([len(face) for face in faces], np.uint32)
        corners = indices(np.concatenate([np.asarray(face) for face in faces]), "faces")
    made.face_count, made.face_sizes = len(sizes), pointer(sizes, ctypes.c_uint32, keep)
    made.corners = pointer(corners, ctypes.c_uint32, keep)
    for name, values, count in (("uv", uv, len(points)), ("corner_uv", corner_uv, len(corners))):
        if values is None:
            continue
        array = floats(values, 2, name)
        if len(array) != count:
            raise ValueError(f"{name} must have {count} rows, not {len(array)}")
        setattr(made, name, pointer(array, ctypes.c_float, keep))
    made.attribute_count, made.attributes = len(attributes.arrays), attributes.structs(keep)
    return Mesh(library.singe_mesh_create, made)


class Object:
    """The handle of an object. Handles of removed objects, or of another simulation, are refused."""

    _name = ""

    def __init__(self, sim: "Sim", id_: Any):
        self._sim, self.id = sim, id_

    def __repr__(self) -> str:
        return f"<singe.{type(self).__name__} {self.id.index}>"

    def __eq__(self, other: object) -> bool:
        return (type(self) is type(other) and self._sim is other._sim  # type: ignore[attr-defined]
                and (self.id.index, self.id.generation) == (other.id.index, other.id.generation))  # type: ignore

    def __hash__(self) -> int:
        return hash((type(self), id(self._sim), self.id.index, self.id.generation))


class Placed(Object):
    """An object that can be moved and removed."""

    def remove(self) -> None:
        """Removes it from the simulation."""
        self._sim._call(f"singe_sim_remove_{self._name}", self.id)

    def move(self, path: Sequence[Any]) -> None:
        """Replaces its path: rows (time, x, y, z) or (time, x, y, z, qx, qy, qz, qw), in s of the simulation and m."""
        keep: List[Any] = []
        count, keys = path_keys(path, keep)
        self._sim._call(f"singe_sim_move_{self._name}", self.id, count, keys)


class Source(Placed):
    """A heat source."""

    _name = "source"

    def set_callback(self, callback: Optional[Callable[[StepView], Any]]) -> None:
        """Sets the function of a `callback` source; None: no heat. Also necessary after a load: snapshots lack it.

        It is called in each step with a StepView, whose arrays show the particles as they are in it, and returns the
        flux into each layer in W/m2, a number or [particles], or (flux, conductance, temperature): conductance in
        W/(m2 K) towards temperature in K. What it returns must follow from the StepView alone. If it raises, the step
        fails and changes nothing, and step() or advance() raises the same.
        """
        self._sim._set_callback(self.id, callback)

    def remove(self) -> None:
        """Removes it from the simulation."""
        super().remove()
        self._sim._forget_callback(self.id)


class Collider(Placed):
    """A solid that sheets rest on and slide over."""

    _name = "collider"

    def set_vertices(self, vertices: Any, time: float) -> None:
        """Sets the positions of a deforming collider's vertices at `time` (s): [vertices, 3] m in its own frame."""
        keep: List[Any] = []
        array = floats(vertices, 3, "vertices")
        wanted = self._sim._collider_sizes.get((self.id.index, self.id.generation))
        if wanted is not None and len(array) != wanted:
            raise ValueError(f"the collider has {wanted} vertices, not {len(array)}")
        if wanted is None:
            raise ValueError("set_vertices needs a deforming collider that this Sim added")
        self._sim._call("singe_sim_set_collider_vertices", self.id, pointer(array, ctypes.c_float, keep),
                        number(ctypes.c_double, time, "time"))


class Pin(Placed):
    """Holds particles of a sheet."""

    _name = "pin"

    @property
    def particles(self) -> npt.NDArray[np.uint32]:
        """[held] the held particles, increasing; none before the commit."""
        count = ctypes.c_uint32()
        with self._sim._locked() as handle:
            held = library.singe_sim_pin_particles(handle.pointer, self.id, ctypes.byref(count))
            return shown(held, (count.value,), np.uint32, handle).copy()  # freed with the pin

    def set_positions(self, positions: Any, time: float) -> None:
        """Sets the positions of its particles at `time` (s): [len(particles), 3] m, in their order."""
        keep: List[Any] = []
        array = floats(positions, 3, "positions")
        if len(array) != len(self.particles):
            raise ValueError(f"the pin holds {len(self.particles)} particles, not {len(array)}")
        self._sim._call("singe_sim_set_pin_positions", self.id, pointer(array, ctypes.c_float, keep),
                        number(ctypes.c_double, time, "time"))


class Sheet(Object):
    """A sheet. `became` maps the caller's vertices to those of the sheet, -1 for none; it is None after a load."""

    _name = "sheet"

    def __init__(self, sim: "Sim", id_: Any, became: Optional[npt.NDArray[np.int64]] = None):
        super().__init__(sim, id_)
        self.became = became

    def _range(self) -> _abi.SingeSheetRange:
        made = _abi.SingeSheetRange()
        with self._sim._locked() as handle:
            library.singe_sim_read_sheet_range(handle.pointer, self.id, ctypes.byref(made), ctypes.sizeof(made))
        return made

    @property
    def vertices(self) -> slice:
        """Indices of its vertices, including those made by tears: sim.position[sheet.vertices].

        Empty before the commit."""
        r = self._range()
        return slice(r.vertex_first, r.vertex_first + r.vertex_count + r.torn_count)

    @property
    def cells(self) -> slice:
        """Indices of its cells: sim.cells[sheet.cells]."""
        r = self._range()
        return slice(r.cell_first, r.cell_first + r.cell_count)

    @property
    def centres(self) -> slice:
        """Indices of its cells' centres, which are particles: sim.position[sheet.centres]."""
        r = self._range()
        return slice(r.centre_first, r.centre_first + r.cell_count)

    def set_velocity(self, velocity: Any, first: int = 0) -> None:
        """Sets the velocities of its vertices from `first` on: [n, 3] m/s. Takes effect in the next step."""
        keep: List[Any] = []
        array = floats(velocity, 3, "velocity")
        self._sim._call("singe_sim_set_velocity", self.id, number(ctypes.c_uint32, first, "first"), len(array),
                        pointer(array, ctypes.c_float, keep))

    def render_mesh(self, points: Any, triangles: Any, uv: Any = None, **options: Any) -> None:
        """Draws a mesh in place of the sheet from now on: finer, thick, with hems, seams and buttons.

        `points` [n, 3] in m, where the sheet is at rest; `triangles` [m, 3]; `uv` [n, 2] or the sheet's.
        Options: `reach`, m, how far a point may be from the sheet (the side of a cell); `edge_max`, m, longer
        edges are halved (half a cell's side); `rigid`, m, parts at most this large keep their shape, as buttons
        do (0: none); `beside`: the sheet is drawn, too; `by_uv`: points lie on the sheet where that has their uv,
        wherever they are given. After the commit. Saved simulations and copies are without it.
        """
        keep: List[Any] = []
        made = default(_abi.SingeRenderMeshDef, "singe_init_render_mesh")
        assign(made, options, keep)
        corners, positions = triples(triangles, "triangles"), floats(points, 3, "points")
        made.vertex_count, made.triangle_count = len(positions), len(corners) // 3
        made.positions = pointer(positions, ctypes.c_float, keep)
        made.triangles = pointer(corners, ctypes.c_uint32, keep)
        if uv is not None:
            array = floats(uv, 2, "uv")
            if len(array) != len(positions):
                raise ValueError(f"uv must have {len(positions)} rows, not {len(array)}")
            made.uv = pointer(array, ctypes.c_float, keep)
        self._sim._call("singe_sim_add_render_mesh", self.id, ctypes.byref(made))

    def set_material(self, material: Any, share: Any = None) -> None:
        """Changes the material of a region: share[vertices of the sheet], 0 (unchanged) to 1 (`material`).

        The simulation is rebuilt; earlier arrays keep their values.
        """
        self._sim._set_material(self, material, share)
