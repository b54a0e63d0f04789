"""Data read from a simulation: arrays that are views of its memory, the drawn surface, the gas.

Every array is read-only and copies nothing. It keeps its memory alive: it may be used after `Sim.close()` and after the
simulation is gone. Its contents change with every step; `.copy()` keeps the current ones.
"""

from __future__ import annotations

import ctypes
from typing import Any, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _abi
from ._library import library

Floats = npt.NDArray[np.float32]
Integers = npt.NDArray[np.int32]


def shown(address: Any, shape: Tuple[int, ...], dtype: Any, keeper: object) -> np.ndarray:
    """A read-only array over memory that `keeper` owns."""
    count = int(np.prod(shape))
    place = ctypes.cast(address, ctypes.c_void_p).value
    if not place or count == 0:
        empty = np.empty(shape if count == 0 else (0, *shape[1:]), dtype)
        empty.flags.writeable = False
        return empty
    memory = (ctypes.c_char * (count * np.dtype(dtype).itemsize)).from_address(place)
    memory.keeper = keeper  # the array's base holds it
    return np.frombuffer(memoryview(memory).toreadonly(), dtype).reshape(shape)


class Views:
    """The arrays of a simulation. Particles: first all vertices of all sheets, then a centre for each cell."""

    def _view(self) -> Tuple[_abi.SingeView, object]:
        raise NotImplementedError

    def _array(self, name: str, dtype: Any, width: int = 0, counted: str = "particle_count") -> np.ndarray:
        view, keeper = self._view()
        count = getattr(view, counted)
        return shown(getattr(view, name), (count, width) if width else (count,), dtype, keeper)

    @property
    def position(self) -> Floats:
        """[particles, 3] m. Rows are 16 bytes apart."""
        return self._array("position", np.float32, 4)[:, :3]

    @property
    def velocity(self) -> Floats:
        """[particles, 3] m/s. Rows are 16 bytes apart."""
        return self._array("velocity", np.float32, 4)[:, :3]

    @property
    def rest_position(self) -> Floats:
        """[particles, 3] m, at the start. Rows are 16 bytes apart."""
        return self._array("rest_position", np.float32, 4)[:, :3]

    @property
    def uv(self) -> Floats:
        """[particles, 2] texture coordinates; centres at the mean of their corners."""
        return self._array("uv", np.float32, 2)

    @property
    def area(self) -> Floats:
        """[particles] m2 at rest, of the particle's own layer."""
        return self._array("area", np.float32)

    @property
    def mass(self) -> Floats:
        """[particles] fraction of the initial mass: 1 unburnt."""
        return self._array("mass", np.float32)

    @property
    def fuel(self) -> Floats:
        """[particles] 1 unburnt, 0 fully pyrolysed to char and ash."""
        return self._array("fuel", np.float32)

    @property
    def temperature(self) -> Floats:
        """[particles] K."""
        return self._array("temperature", np.float32)

    @property
    def temperature_peak(self) -> Floats:
        """[particles] K, peak so far."""
        return self._array("temperature_peak", np.float32)

    @property
    def burn_rate(self) -> Floats:
        """[particles] 1/s, mass fraction lost per second."""
        return self._array("burn_rate", np.float32)

    @property
    def time_ignited(self) -> Floats:
        """[particles] time of ignition, s; -1 before."""
        return self._array("time_ignited", np.float32)

    @property
    def time_burnt(self) -> Floats:
        """[particles] s, time at which the mass fell below m_loss; -1 before."""
        return self._array("time_burnt", np.float32)

    @property
    def piece(self) -> Integers:
        """[particles] id of the connected piece; -1 if the particle is gone."""
        return self._array("piece", np.int32)

    @property
    def particle_flags(self) -> npt.NDArray[np.uint8]:
        """[particles] bits: singe.ALIVE, singe.PINNED."""
        return self._array("particle_flags", np.uint8)

    @property
    def cell_flags(self) -> npt.NDArray[np.uint8]:
        """[cells] bits: singe.ALIVE."""
        return self._array("cell_flags", np.uint8, counted="cell_count")

    @property
    def cells(self) -> npt.NDArray[np.uint32]:
        """[cells, 4] corners, which are particles, counter-clockwise seen from the front."""
        return self._array("cells", np.uint32, 4, "cell_count")

    @property
    def line_force(self) -> Optional[Floats]:
        """[cells, 6] N/m, line force for tears, in rest coordinates: xx, yy, zz, yz, zx, xy. None without tears."""
        view, keeper = self._view()
        return shown(view.line_force, (view.cell_count, 6), np.float32, keeper) if view.line_force else None

    @property
    def source_vertex(self) -> Integers:
        """[vertices] the vertex of the input, numbered over all sheets; -1: new, or in reserve for tears."""
        return self._array("source_vertex", np.int32, counted="vertex_count")

    def springs(self, colour: int) -> npt.NDArray[np.uint32]:
        """[springs, 2] ends of the springs of a colour: singe.RED, GREEN, BLUE, YELLOW."""
        view, keeper = self._view()
        return shown(view.springs[colour], (view.spring_count[colour], 2), np.uint32, keeper)

    def spring_length(self, colour: int) -> Floats:
        """[springs] m, target lengths of the springs of a colour."""
        view, keeper = self._view()
        return shown(view.spring_length[colour], (view.spring_count[colour],), np.float32, keeper)

    def spring_rest(self, colour: int) -> Floats:
        """[springs] m, initial lengths of the springs of a colour."""
        view, keeper = self._view()
        return shown(view.spring_rest[colour], (view.spring_count[colour],), np.float32, keeper)

    def spring_flags(self, colour: int) -> npt.NDArray[np.uint8]:
        """[springs] bits of the springs of a colour: singe.ALIVE."""
        view, keeper = self._view()
        return shown(view.spring_flags[colour], (view.spring_count[colour],), np.uint8, keeper)


class StepView(Views):
    """The view of a source's callback: the arrays of a simulation within a step, and `time` in s."""

    def __init__(self, view: _abi.SingeView, keeper: object):
        self._shown = view, keeper
        self.time: float = view.time

    def _view(self) -> Tuple[_abi.SingeView, object]:
        return self._shown


def add_fluxes(returned: Any, sums: Any, count: int) -> None:
    """Adds a callback's result to the library's sums: flux, conductance, conductance times temperature."""
    parts = returned if isinstance(returned, tuple) else (returned, 0, 0)
    if len(parts) != 3:
        raise ValueError(f"a callback must return a flux, or (flux, conductance, temperature), not {len(parts)} parts")
    if any(part is None for part in parts):  # NumPy would make NaN of it
        raise TypeError("a callback returned None: it must return a flux, or (flux, conductance, temperature)")
    flux, conductance, temperature = (np.broadcast_to(np.asarray(part, np.float32), count) for part in parts)
    if np.any(conductance < 0):
        raise ValueError("a callback's conductance must not be below 0")
    for sum_, value in zip(sums, (flux, conductance, conductance * temperature)):
        array = np.ctypeslib.as_array(sum_, (count,))
        array += value


class Drawn:
    """A drawn surface at one time, of a simulation or a cache. Its arrays are read-only.

    position, rest_position: [vertices, 3] m. normal: [vertices, 3] unit. uv: [vertices, 2]. velocity: [vertices, 3]
    m/s. temperature, temperature_peak: [vertices] K. mass, char_fraction, ash_fraction: [vertices] fractions of the
    initial mass. burn_rate: [vertices] 1/s. burn: [vertices] 0 fresh to 1 ash. time_ignited: [vertices] s, -1 not yet.
    piece, sheet: [vertices]. source_vertex: [vertices] of the input, -1 for a new one. time: s.
    """

    position: Floats
    normal: Floats
    uv: Floats
    velocity: Floats
    rest_position: Floats
    temperature: Floats
    temperature_peak: Floats
    mass: Floats
    burn_rate: Floats
    char_fraction: Floats
    ash_fraction: Floats
    burn: Floats
    time_ignited: Floats
    piece: Integers
    source_vertex: Integers
    sheet: Integers
    time: float


class Surface(Drawn):
    """The drawn surface of a simulation, as in the cache. Its arrays do not change.

    triangles: [triangles, 3], counter-clockwise seen from the front.
    """

    triangles: npt.NDArray[np.uint32]

    def __init__(self, owner: "OwnedSurface", time: float):
        made = owner.struct
        self.time = time
        fields: Any = made._fields_
        for name, kind in fields:
            if name == "allocator" or not hasattr(kind, "contents"):
                continue
            one, width = kind._type_, 0
            if issubclass(one, ctypes.Array):
                one, width = one._type_, one._length_
            count = made.triangle_count if name == "triangles" else made.vertex_count
            setattr(self, name, shown(getattr(made, name), (count, width) if width else (count,), np.dtype(one), owner))

    def __repr__(self) -> str:
        return f"<singe.Surface: {len(self.position)} vertices, {len(self.triangles)} triangles at {self.time:g} s>"


class OwnedSurface:
    """A surface of the library, freed with the last array that refers to it."""

    def __init__(self) -> None:
        self.struct = _abi.SingeSurface()
        self._release = library.singe_surface_release

    def __del__(self) -> None:
        self._release(ctypes.byref(self.struct), ctypes.sizeof(self.struct))


class Gas:
    """The gas around the sheets: cubes of side `cell` (m); the first has its lower corner at `origin` (m).

    Arrays are indexed [z, y, x]. temperature: K. smoke: kg/m3 of soot. flame: W/m3. velocity: [z, y, x, 3] m/s. They
    are the simulation's, and the next step writes to them: read them before it, or copy.
    """

    def __init__(self, made: _abi.SingeGas, keeper: object):
        shape = tuple(reversed(made.size))
        self.origin = np.array(made.origin, np.float32)
        self.cell: float = made.cell
        self.temperature: Floats = shown(made.temperature, shape, np.float32, keeper)
        self.smoke: Floats = shown(made.smoke, shape, np.float32, keeper)
        self.flame: Floats = shown(made.flame, shape, np.float32, keeper)
        self.velocity: Floats = shown(made.velocity, (*shape, 3), np.float32, keeper)

    def __repr__(self) -> str:
        z, y, x = self.temperature.shape
        return f"<singe.Gas: {x} x {y} x {z} cells of {self.cell:g} m>"
