"""A simulation: sheets, sources, pins, colliders and steps."""

from __future__ import annotations

import contextlib
import ctypes
import os
import pathlib
import threading
import time
import weakref
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, TypeVar, Union

import numpy as np

from . import _abi, errors
from ._aside import LONG, Aside, is_interruptible
from ._fields import (Attributes, as_dict, assign, default, floats, indices, named, number, numbers, path_keys,
                      pointer, set_texture, text, triples, vector)
from ._library import library, log_callback, raise_for
from ._whole import whole
from .objects import Collider, Pin, Sheet, Source, make_mesh
from .picture import draw_png, html_picture
from .views import Gas, OwnedSurface, StepView, Surface, Views, add_fluxes, shown

Vector = Sequence[float]
Material = Union[str, Mapping[str, Any]]
Result = TypeVar("Result")
Callback = Callable[[StepView], Any]
EVENT = np.dtype(_abi.SingeEvent)
_fields: Any = _abi.SingeRecord._fields_
_WRITE = dict(_fields)["write"]
_SLICE = 16  # steps between which advance() can be interrupted
_SECONDS_MAX = 1e6  # the library's limit for one advance


class _Handle:
    """A simulation of the library, destroyed when no Sim and no array refers to it any more."""

    def __init__(self, pointer_: ctypes.c_void_p, recording: Optional["_Recording"] = None):
        self.pointer = pointer_
        self._recording = recording
        self._destroy = library.singe_sim_destroy

    def __del__(self) -> None:
        self._destroy(self.pointer)
        if self._recording:
            self._recording.close()


class _Recording:
    """A new file to which the library writes a recording, at once."""

    def __init__(self, path: Union[str, "os.PathLike[str]"]):
        self._file = open(os.fspath(path), "wb", buffering=0)
        self.write = _WRITE(self._write)

    def _write(self, _context: object, data: int, size: int) -> bool:
        try:
            return self._file.write(ctypes.string_at(data, size)) == size
        except OSError:
            return False  # the library ends the recording, with a warning

    def close(self) -> None:
        self._file.close()


class Sim(Views):
    """A simulation. Units are SI and kelvin.

    Options are the fields of SingeSimDef (include/singe/types.h): `pace`, seconds of fire per second of motion (1);
    `time_step`, s (1/480); `threads` (1); `gravity`, m/s2; `ambient_temperature`, K; `seed`; `surface_detail`, m;
    `gas` and `contact`, True or a dict of their fields; `wind` and `solver`, dicts: `solver={"tearing": True}`.
    `record`, the path of a recording, which `singe replay` repeats (docs/replay.md); OSError if it cannot be opened.

    Steps release the interpreter's lock: simulations in several threads run at once. One simulation does one call at a
    time; a second thread waits. The library's messages go to the logger "singe".
    """

    _handle: Optional[_Handle]

    def __init__(self, **options: Any):
        self._setup(None)
        if "threads" in options:
            options["thread_count"] = options.pop("threads")
        path = options.pop("record", None)
        keep: List[Any] = []
        made = default(_abi.SingeSimDef, "singe_init_sim")
        assign(made, options, keep)
        made.log.write = log_callback
        recording = _Recording(path) if path is not None else None
        if recording:
            made.record.write = recording.write
        out, error = ctypes.c_void_p(), _abi.SingeError()
        if library.singe_sim_create(ctypes.byref(made), ctypes.byref(out), ctypes.byref(error)):
            if recording:
                recording.close()
            raise_for(error)
        self._handle = _Handle(out, recording)
        self._time_step = made.time_step

    def _setup(self, handle: Optional[_Handle]) -> None:
        self._handle = handle
        self._lock, self._owner = threading.Lock(), 0
        self._time_step = 0.0  # not known after a load
        self._events = np.zeros(0, EVENT)
        self._collider_sizes: Dict[Tuple[int, int], int] = {}
        self._callbacks: Dict[Tuple[int, int], Tuple[Callback, Any]] = {}  # of sources: Python's, and C's for it
        self._raised: Optional[BaseException] = None  # by a callback, for the call that it is in
        self._seconds: Optional[float] = None  # that the last step or slice took; None: not known

    @classmethod
    def _of(cls, out: ctypes.c_void_p) -> "Sim":
        made = cls.__new__(cls)
        made._setup(_Handle(out))
        return made

    # calls

    @contextlib.contextmanager
    def _locked(self) -> Iterator[_Handle]:
        """The handle, for one thread at a time."""
        if self._owner == threading.get_ident():
            raise errors.StateError("a simulation cannot be called from within one of its own calls")
        with self._lock:
            self._owner = threading.get_ident()
            try:
                if self._handle is None:
                    raise errors.StateError("the simulation is closed")
                yield self._handle
            finally:
                self._owner = 0

    def _call(self, name: str, *arguments: Any) -> None:
        with self._locked() as handle:
            self._checked(handle, getattr(library, name)(handle.pointer, *arguments))

    @staticmethod
    def _checked(handle: _Handle, result: int) -> None:
        if result:
            raise_for(library.singe_sim_error(handle.pointer).contents)

    def _stepped(self, call: Callable[[_Handle], Result]) -> Result:
        """Runs `call`, steps or the commit; in another thread if it may take long and Ctrl-C can interrupt this one."""
        def timed(handle: _Handle) -> Result:
            begun, self._raised = time.perf_counter(), None
            try:
                return call(handle)
            finally:
                self._seconds = time.perf_counter() - begun
                raised, self._raised = self._raised, None
                if raised is not None:
                    raise raised

        if is_interruptible() and (self._seconds is None or self._seconds >= LONG):
            return Aside(self._locked, timed).wait()
        with self._locked() as handle:
            return timed(handle)

    def _read(self, struct: type, name: str) -> Any:
        made = struct()
        with self._locked() as handle:
            getattr(library, name)(handle.pointer, ctypes.byref(made), ctypes.sizeof(made))
        return made

    def _view(self) -> Tuple[_abi.SingeView, object]:
        made = _abi.SingeView()
        with self._locked() as handle:
            library.singe_sim_read_view(handle.pointer, ctypes.byref(made), ctypes.sizeof(made))
            return made, handle

    # objects

    def sheet(self, points: Any, faces: Any, uv: Any = None, material: Material = "office-paper", *,
              corner_uv: Any = None, name: Optional[str] = None, velocity: Vector = (0, 0, 0),
              drop_pieces_below: float = 0, mesh: Optional[Mapping[str, Any]] = None, **attributes: Any) -> Sheet:
        """Adds a sheet, before the commit.

        points: [vertices, 3] m. faces: [n, corners], or a list of faces of any sizes, counter-clockwise seen from the
        front; triangles become quads. uv: [vertices, 2], or corner_uv [corners, 2] if the mesh has seams.
        material: a name (singe.materials()), or a dict of parameters that override those of `base`; each is a
        number, an array [vertices] or a singe.Vary. attributes: arrays [vertices] that parameters may follow by name.
        velocity: m/s at the start. drop_pieces_below: m2, smaller loose pieces are removed. mesh: options of the
        repair: {"quads": "split", "weld": 1e-4}.
        """
        keep: List[Any] = []
        points = floats(points, 3, "points")
        all_ = Attributes(len(points), attributes)
        made = default(_abi.SingeSheetDef, "singe_init_sheet")
        assign(made, {"name": name, "velocity": velocity, "drop_pieces_below": drop_pieces_below}, keep)
        made.material = _material(material, keep, all_)
        options = {} if mesh is None else named(mesh, "mesh")
        quads = make_mesh(points, faces, uv, corner_uv, all_, options, keep)
        quads.fill(made)
        id_ = _abi.SingeSheetId()
        self._call("singe_sim_add_sheet", ctypes.byref(made), ctypes.byref(id_))
        return Sheet(self, id_, quads.became(len(points)))

    def commit(self) -> None:
        """Builds the shell and all buffers. No sheet can be added afterwards."""
        self._stepped(lambda handle: self._checked(handle, library.singe_sim_commit(handle.pointer)))
        self._seconds = None  # not the time of a step

    def source(self, kind: str = "spot", *, path: Any = None, texture: Any = None, strength: Any = None,
               callback: Optional[Callback] = None, **fields: Any) -> Source:
        """Adds a heat source: `spot`, `ball` (on a path), `texture` (a flux over uv) or `callback`.

        Fields are those of SingeSourceDef. path: rows (time, x, y, z) in s and m. texture: [rows, columns] 0 to 1.
        strength: rows (time, factor). callback: see Source.set_callback.
        """
        if (callback is not None) != (isinstance(kind, str) and kind == "callback"):
            raise ValueError("a source of the kind 'callback' needs a callback, and no other kind takes one")
        keep: List[Any] = []
        made = default(_abi.SingeSourceDef, "singe_init_source")
        assign(made, {"kind": kind, **fields}, keep)
        if path is not None:
            made.path_count, made.path = path_keys(path, keep)
        if texture is not None:
            set_texture(made.texture, texture, "texture", keep)
        if strength is not None:
            rows = numbers(strength, "strength", np.float64)
            if rows.ndim != 2 or rows.shape[1] != 2:
                raise ValueError("strength must have rows (time, factor)")
            made.strength = (_abi.SingeValueKey * len(rows))(*(_abi.SingeValueKey(t, v) for t, v in rows))
            made.strength_count = len(rows)
        id_ = _abi.SingeSourceId()
        self._call("singe_sim_add_source", ctypes.byref(made), ctypes.byref(id_))
        if callback is not None:
            self._set_callback(id_, callback)
        return Source(self, id_)

    def _set_callback(self, id_: _abi.SingeSourceId, callback: Optional[Callback]) -> None:
        if callback is None:
            self._call("singe_sim_set_source_callback", id_, _abi.SingeFluxFn(), None)
            self._forget_callback(id_)
            return
        if not callable(callback):
            raise TypeError(f"callback must be a function or None, not {callback!r}")
        own = weakref.ref(self)  # so that a Sim is freed when nobody holds it

        def heat(_context: object, view: int, *sums: Any) -> None:
            sim = own()
            if sim is None:
                return
            seen = StepView(ctypes.cast(view, ctypes.POINTER(_abi.SingeView)).contents, sim._handle)
            try:
                add_fluxes(callback(seen), sums, len(seen.mass))
            except BaseException as error:
                sim._raised = error
                np.ctypeslib.as_array(sums[0], (len(seen.mass),))[:] = np.nan  # the step fails and changes nothing

        called = _abi.SingeFluxFn(heat)
        self._call("singe_sim_set_source_callback", id_, called, None)
        self._callbacks[id_.index, id_.generation] = callback, called

    def _forget_callback(self, id_: _abi.SingeSourceId) -> None:
        self._callbacks.pop((id_.index, id_.generation), None)

    def _take_callbacks(self, other: "Sim") -> None:
        """Takes the callbacks of another Sim with the same sources; C's copies still call the other one's."""
        for (index, generation), (callback, _) in list(other._callbacks.items()):
            self._set_callback(_abi.SingeSourceId(index, generation), callback)

    def spot(self, position: Vector, radius: float = 0.005, temperature: float = 1200, **fields: Any) -> Source:
        """Adds a hot spot at rest, at any time: position and radius in m, temperature in K.

        Fields: `start` and `end` in s, `conductance` in W/(m2 K) (150), `falloff` in m (0.01).
        """
        return self.source("spot", position=position, radius=radius, temperature=temperature, **fields)

    def pin(self, sheet: Sheet, points: Any = None, vertices: Any = None, radius: float = 0.005,
            path: Any = None, end: float = np.inf) -> Pin:
        """Holds vertices of the caller's mesh, and particles within `radius` (m) of points [n, 3] (m, at rest), until
        `end` (s).

        path: rows (time, x, y, z) or (time, x, y, z, qx, qy, qz, qw), relative to the pose at the time it is added.
        """
        keep: List[Any] = []
        made = default(_abi.SingePinDef, "singe_init_pin")
        if not isinstance(sheet, Sheet):
            raise TypeError(f"sheet must be a singe.Sheet, not {sheet!r}")
        made.sheet, made.radius = sheet.id, number(ctypes.c_float, radius, "radius")
        made.end = number(ctypes.c_float, end, "end")
        if sheet._sim is not self:
            raise errors.HandleError("the sheet belongs to another simulation")
        if points is not None:
            array = floats(points, 3, "points")
            made.point_count, made.points = len(array), pointer(array, ctypes.c_float, keep)
        if vertices is not None:
            held = indices(_now(sheet, indices(vertices, "vertices")), "vertices")
            made.vertex_count, made.vertices = len(held), pointer(held, ctypes.c_uint32, keep)
        if path is not None:
            made.path_count, made.path = path_keys(path, keep)
        id_ = _abi.SingePinId()
        self._call("singe_sim_add_pin", ctypes.byref(made), ctypes.byref(id_))
        return Pin(self, id_)

    def collider(self, kind: str = "plane", *, vertices: Any = None, triangles: Any = None, heights: Any = None,
                 path: Any = None, **fields: Any) -> Collider:
        """Adds a solid: `plane`, `sphere`, `box`, `capsule`, `heightfield`, `mesh` or `deforming`.

        Fields are those of SingeColliderDef: `position` (m), `rotation` (x, y, z, w), `radius`, `half_size`, `height`,
        `friction`, `temperature` (K), `conductance` (W/(m2 K)), ... vertices: [n, 3] m and triangles: [n, 3], closed.
        heights: [rows, columns] m. path: as a pin's.
        """
        keep: List[Any] = []
        made = default(_abi.SingeColliderDef, "singe_init_collider")
        assign(made, {"kind": kind, **fields}, keep)
        if vertices is not None:
            array = floats(vertices, 3, "vertices")
            made.vertex_count, made.vertices = len(array), pointer(array, ctypes.c_float, keep)
        if triangles is not None:
            corners = triples(triangles, "triangles")
            made.triangle_count, made.triangles = len(corners) // 3, pointer(corners, ctypes.c_uint32, keep)
        if heights is not None:
            array = numbers(heights, "heights")
            if array.ndim != 2:
                raise ValueError(f"heights must have the shape [rows, columns], not {list(array.shape)}")
            made.rows, made.columns = array.shape
            made.heights = pointer(array, ctypes.c_float, keep)
        if path is not None:
            made.path_count, made.path = path_keys(path, keep)
        id_ = _abi.SingeColliderId()
        self._call("singe_sim_add_collider", ctypes.byref(made), ctypes.byref(id_))
        self._collider_sizes[id_.index, id_.generation] = made.vertex_count
        return Collider(self, id_)

    def wind(self, velocity: Vector = (0, 0, 0), **fields: Any) -> None:
        """Replaces the wind: m/s. Fields: `gust` (m/s), `gust_time` (s), `gust_size` (m), `seed`."""
        made = default(_abi.SingeWindDef, "singe_init_wind")
        assign(made, {"velocity": velocity, **fields}, [])
        self._call("singe_sim_set_wind", ctypes.byref(made))

    def set_gravity(self, gravity: Vector) -> None:
        """Sets gravity, m/s2, from the next step on."""
        self._call("singe_sim_set_gravity", vector(ctypes.c_float * 3, gravity, "gravity"))

    def set_pace(self, pace: float) -> None:
        """Sets the seconds of fire per second of motion, from the next step on."""
        self._call("singe_sim_set_pace", number(ctypes.c_double, pace, "pace"))

    def set_ambient_temperature(self, temperature: float) -> None:
        """Sets the temperature, K. The simulation is rebuilt; earlier arrays keep their values."""
        self._rebuilt("singe_sim_set_ambient_temperature", number(ctypes.c_double, temperature, "temperature"))

    def _set_material(self, sheet: Sheet, material: Material, share: Any) -> None:
        keep: List[Any] = []
        made = _material(material, keep, None)
        array = None
        if share is not None:
            values, wanted = floats(share, 0, "share"), sheet._range().vertex_count
            if len(values) != wanted:
                raise ValueError(f"share must have a value for each of {wanted} vertices, not {len(values)} values")
            array = pointer(values, ctypes.c_float, keep)
        self._rebuilt("singe_sim_set_material", sheet.id, ctypes.byref(made), array)

    def _rebuilt(self, name: str, *arguments: Any) -> None:
        """A call that frees memory of views, made on a clone, so that arrays of the old simulation remain valid."""
        copy = self.clone() if self.committed else self
        copy._call(name, *arguments)
        if copy is not self:
            with self._locked():
                self._handle = copy._handle
            self._take_callbacks(self)

    # time

    def step(self, n: int = 1) -> None:
        """Makes `n` steps of `time_step`. A step that fails changes nothing.

        Ctrl-C ends the call at once. A step in progress then ends by itself, and later calls wait for it.
        """
        found: List[np.ndarray] = []

        def one(handle: _Handle) -> None:
            self._checked(handle, library.singe_sim_step(handle.pointer))
            found.extend(self._new_events(handle))

        try:
            for _ in range(number(ctypes.c_uint32, n, "n")):
                self._stepped(one)
        finally:
            self._events = np.concatenate(found) if found else np.zeros(0, EVENT)

    def advance(self, seconds: float, steps_max: int = 0) -> int:
        """Makes as many steps as fit in `seconds` plus the remainder of earlier calls; returns their number.

        Whole steps beyond `steps_max` are dropped. Ctrl-C ends the call at once; the rest of `seconds` is lost, except
        for steps in progress, at most 16 without `steps_max`, which end by themselves.
        """
        whole = number(ctypes.c_double, seconds, "seconds")
        most = number(ctypes.c_uint32, steps_max, "steps_max")
        part = whole if steps_max else _SLICE * (self._time_step or self._mean_step() or 1e-3)
        done = 0
        found: List[np.ndarray] = []

        def some(handle: _Handle) -> int:
            count = ctypes.c_uint32()
            result = library.singe_sim_advance(handle.pointer, now, most, ctypes.byref(count))
            found.extend(self._new_events(handle))
            self._checked(handle, result)
            return count.value

        try:
            while True:
                # seconds that the library refuses, such as NaN and infinity, go to it undivided
                now = part if part < whole <= _SECONDS_MAX else whole
                done, whole = done + self._stepped(some), whole - now
                if not whole > 0:
                    return done
        finally:
            self._events = np.concatenate(found) if found else np.zeros(0, EVENT)

    def _mean_step(self) -> float:
        view, _ = self._view()
        return view.time / view.step if view.step else 0.0

    @staticmethod
    def _new_events(handle: _Handle) -> List[np.ndarray]:
        count = ctypes.c_size_t()
        first = library.singe_sim_events(handle.pointer, ctypes.byref(count))
        return [shown(first, (count.value,), EVENT, handle).copy()] if count.value else []

    @property
    def events(self) -> np.ndarray:
        """The events of the last step() or advance(), a structured array: `kind` (singe.IGNITED, HOLE_OPENED,
        PIECE_FREED), `element` (the particle, or the piece's id), `time` (s), `position` ([3] m). A copy."""
        return self._events.copy()

    # reading

    @property
    def time(self) -> float:
        """Time of the simulation, s."""
        return self._view()[0].time

    @property
    def steps(self) -> int:
        """Number of steps done."""
        return self._view()[0].step

    @property
    def remainder(self) -> float:
        """The remainder of the last advance(), s."""
        with self._locked() as handle:
            return library.singe_sim_remainder(handle.pointer)

    @property
    def topology_version(self) -> int:
        """Increases whenever something is removed or torn."""
        return self._view()[0].topology_version

    @property
    def committed(self) -> bool:
        """Whether it has been committed."""
        return self._view()[0].particle_count > 0

    @property
    def alive(self) -> np.ndarray:
        """[particles] bool: whether a particle is still part of a sheet. A copy."""
        return (self.particle_flags & 1) != 0

    def stats(self) -> Dict[str, Any]:
        """Statistics of the current state, by the names of SingeStats (include/singe/sim.h)."""
        return as_dict(self._read(_abi.SingeStats, "singe_sim_read_stats"))

    def counts(self) -> Dict[str, Any]:
        """Counts of elements, and memory, by the names of SingeCounts."""
        return as_dict(self._read(_abi.SingeCounts, "singe_sim_read_counts"))

    def timers(self) -> Dict[str, Any]:
        """Seconds and work by stage since the commit or load, by the names of SingeTimers."""
        return as_dict(self._read(_abi.SingeTimers, "singe_sim_read_timers"))

    def surface(self) -> Surface:
        """The current drawn surface: a mesh of its own, cut where the sheets have burnt."""
        owner = OwnedSurface()
        self._call("singe_sim_draw", ctypes.byref(owner.struct), ctypes.sizeof(owner.struct))
        return Surface(owner, self.time)

    def gas(self) -> Gas:
        """The current gas; without `gas` it has no cells."""
        made = _abi.SingeGas()
        with self._locked() as handle:
            library.singe_sim_read_gas(handle.pointer, ctypes.byref(made), ctypes.sizeof(made))
            return Gas(made, handle)

    def _objects(self, kind: type, id_: type, name: str) -> List[Any]:
        with self._locked() as handle:
            function = getattr(library, name)
            ids = (id_ * function(handle.pointer, None, 0))()
            function(handle.pointer, ids, len(ids))
        return [kind(self, one) for one in ids]

    @property
    def sheets(self) -> List[Sheet]:
        return self._objects(Sheet, _abi.SingeSheetId, "singe_sim_sheets")

    @property
    def sources(self) -> List[Source]:
        return self._objects(Source, _abi.SingeSourceId, "singe_sim_sources")

    @property
    def colliders(self) -> List[Collider]:
        return self._objects(Collider, _abi.SingeColliderId, "singe_sim_colliders")

    @property
    def pins(self) -> List[Pin]:
        return self._objects(Pin, _abi.SingePinId, "singe_sim_pins")

    # copies

    def save(self, path: Union[str, "os.PathLike[str]", None] = None) -> bytes:
        """The whole simulation as bytes; with `path` also written to a file, which is replaced whole or not at all."""
        data, size = ctypes.POINTER(ctypes.c_uint8)(), ctypes.c_size_t()
        with self._locked() as handle:
            self._checked(handle, library.singe_sim_save(handle.pointer, ctypes.byref(data), ctypes.byref(size)))
            try:
                saved = ctypes.string_at(data, size.value)
            finally:
                library.singe_sim_free_bytes(handle.pointer, data, size)
        if path is not None:
            with whole(pathlib.Path(path)) as part:
                part.write_bytes(saved)
        return saved

    @classmethod
    def load(cls, saved: Union[bytes, str, "os.PathLike[str]"], threads: int = 1) -> "Sim":
        """Loads a simulation from saved bytes or a file. Its steps give the same bits as those of the saved one."""
        data = saved if isinstance(saved, (bytes, bytearray, memoryview)) else pathlib.Path(saved).read_bytes()
        hooks = default(_abi.SingeSimDef, "singe_init_sim")
        hooks.log.write = log_callback
        assign(hooks, {"thread_count": threads}, [])
        array = np.frombuffer(data, np.uint8)
        out, error = ctypes.c_void_p(), _abi.SingeError()
        if library.singe_sim_load(ctypes.byref(hooks), array.ctypes.data_as(ctypes.POINTER(ctypes.c_uint8)), len(array),
                                  ctypes.byref(out), ctypes.byref(error)):
            raise_for(error)
        return cls._of(out)

    def clone(self) -> "Sim":
        """A second simulation in the same state. Objects keep their handles: copy.sheets[0] is that of self."""
        out = ctypes.c_void_p()
        self._call("singe_sim_clone", ctypes.byref(out))
        made = self._of(out)
        made._time_step, made._collider_sizes = self._time_step, dict(self._collider_sizes)
        made._take_callbacks(self)
        return made

    def __reduce__(self) -> Any:
        return Sim.load, (self.save(),)

    def close(self) -> None:
        """Releases the simulation. Its memory is freed with the last array that refers to it."""
        with self._lock:
            self._handle = None

    def __enter__(self) -> "Sim":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._handle is None:
            return "<singe.Sim: closed>"
        view, _ = self._view()
        return f"<singe.Sim: {view.cell_count} cells at {view.time:g} s>"

    def _repr_html_(self) -> str:
        if self._handle is None or not self.committed:
            return f"<code>{self!r}</code>".replace("<singe", "&lt;singe")
        return html_picture(draw_png(self.surface()), f"{self.time:.3f} s, "
                            f"{100 * self.stats()['burnt_fraction']:.1f} % burnt")


def _now(sheet: Sheet, vertices: np.ndarray) -> np.ndarray:
    """Maps vertices of the caller's mesh to the sheet; vertices without a face are left out."""
    if sheet.became is None:
        return vertices
    if len(vertices) and vertices.max() >= len(sheet.became):
        raise ValueError(f"vertex {vertices.max()} is out of range: the mesh has {len(sheet.became)} vertices")
    now = sheet.became[vertices]
    return now[now >= 0]


def _material(material: Material, keep: List[Any], sheet: Optional[Attributes]) -> _abi.SingeMaterialDef:
    values = {"base": material} if isinstance(material, str) else dict(named(material, "material"))
    made = default(_abi.SingeMaterialDef, "singe_init_material")
    error = _abi.SingeError()
    base = text(values.pop("base", "office-paper"), "the name of a material").replace(b"_", b"-")
    if library.singe_material_preset(base, ctypes.byref(made), ctypes.byref(error)):
        raise_for(error)
    assign(made, values, keep, sheet)
    return made


def materials() -> List[str]:
    """The names of the built-in materials."""
    names: List[str] = []
    while True:
        name = library.singe_material_preset_name(len(names))
        if name is None:
            return names
        names.append(name.decode())
