"""Converts Python's values to fields of Defs: numbers, names of enumerators, arrays, parameters that vary."""

from __future__ import annotations

import ctypes
import dataclasses
import difflib
import operator
import reprlib
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _abi
from ._library import library

COLOURS = ("red", "green", "blue", "yellow")
# what arrays set, as they do pointers, and fields that Python callers do not need
_HIDDEN = {"struct_size", "user_data", "allocator", "log", "record", "cancel", "tasks", "callback", "callback_context",
           "vertex_count", "triangle_count", "face_count", "attribute_count", "source_count", "cell_count",
           "path_count", "strength_count", "point_count", "rows", "columns"}


@dataclasses.dataclass
class Vary:
    """A material's parameter that varies over a sheet: `value` where the field is 0, `to` where it is 1.

    The field is one of: `attribute`, the name of an attribute of the sheet, or an array [vertices]; `texture`, an array
    [rows, columns] over the uv square, 0 black to 1 white, the first row at the top; `noise`, a size in m, or
    (size, octaves, seed).
    """

    value: float
    to: float
    attribute: Any = None
    texture: Any = None
    noise: Any = None


def default(struct: Any, init: str) -> Any:
    """A Def with the library's defaults."""
    made = struct()
    for name, kind in struct._fields_:
        if isinstance(kind, type) and issubclass(kind, ctypes.Structure) and kind._fields_[0][0] == "struct_size":
            getattr(made, name).struct_size = ctypes.sizeof(kind)
    getattr(library, init)(ctypes.byref(made), ctypes.sizeof(made))
    return made


def numbers(values: Any, what: str, kind: Any = np.float32) -> np.ndarray:
    """A contiguous array of the type `kind`, or of the values' own where it is None; TypeError or ValueError names
    `what`."""
    try:
        if np.iscomplexobj(values):
            raise TypeError
        with np.errstate(over="ignore"):  # infinities are refused where they are used
            return np.ascontiguousarray(values, kind)
    except (TypeError, ValueError, OverflowError) as error:
        refusal = TypeError if isinstance(error, TypeError) else ValueError
        raise refusal(f"{what} must be an array of numbers, not {reprlib.repr(values)}") from None


def floats(values: Any, width: int, what: str) -> np.ndarray:
    """Contiguous float32 [n, width], or [n] if width is 0; ValueError names `what`."""
    array = numbers(values, what)
    if array.ndim != (2 if width else 1) or (width and array.shape[1] != width):
        raise ValueError(f"{what} must have the shape [n{f', {width}' if width else ''}], not {list(array.shape)}")
    return array


def indices(values: Any, what: str) -> np.ndarray:
    """Contiguous uint32 [n] from integers in range; ValueError names `what`."""
    array = numbers(values, what, None)
    if array.size == 0:
        return np.zeros(0, np.uint32)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{what} must be whole numbers, not {array.dtype}")
    if array.min() < 0 or array.max() > 0xFFFFFFFF:
        raise ValueError(f"{what} must lie between 0 and {0xFFFFFFFF}")
    return np.ascontiguousarray(array.reshape(-1), dtype=np.uint32)


def triples(values: Any, what: str) -> np.ndarray:
    """As indices, of rows of three."""
    array = numbers(values, what, None)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{what} must have the shape [n, 3], not {list(array.shape)}")
    return indices(array, what)


def text(value: Any, what: str) -> bytes:
    """A name for C; ValueError names `what`. C would read a name with a NUL character only up to it."""
    name = str(value)
    if "\0" in name:
        raise ValueError(f"{what} must not contain a NUL character: {name!r}")
    try:
        return name.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{what} must be text of whole characters, not {name!r}") from None


def vector(kind: Any, values: Any, what: str, enum: Optional[str] = None) -> Any:
    """A C array of exactly as many values as the type `kind` has; ValueError names `what`."""
    try:
        items = list(values)
    except TypeError:
        raise TypeError(f"{what} must have {kind._length_} values, not be {reprlib.repr(values)}") from None
    if len(items) != kind._length_:
        raise ValueError(f"{what} must have {kind._length_} values, not {len(items)}")
    return kind(*(_enumerator(enum, item, what) if enum else number(kind._type_, item, what) for item in items))


def pointer(array: np.ndarray, kind: Any, keep: List[Any]) -> Any:
    """A pointer to an array that `keep` holds during the call."""
    keep.append(array)
    return array.ctypes.data_as(ctypes.POINTER(kind))


def _enumerator(enum: str, value: Any, what: str) -> int:
    values = _abi.ENUMS[enum]
    prefix = ""
    while len({key[len(prefix)] for key in values}) == 1:
        prefix += next(iter(values))[len(prefix)]
    prefix = prefix[:prefix.rfind("_") + 1]
    names = {key[len(prefix):].lower(): number for key, number in values.items() if not key.endswith("_COUNT")}
    if isinstance(value, str):
        if value.replace("-", "_") not in names:
            raise ValueError(f"{what} must be one of {', '.join(names)}, not {value!r}")
        return names[value.replace("-", "_")]
    return number(ctypes.c_int, value, what)


def number(kind: Any, value: Any, what: str) -> Any:
    """A number that fits the C type `kind`; TypeError or ValueError names `what`."""
    if kind in (ctypes.c_float, ctypes.c_double):
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"{what} must be a number, not {reprlib.repr(value)}") from None
    if kind is ctypes.c_bool:
        return bool(value)
    try:
        whole = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} must be a whole number, not {reprlib.repr(value)}") from None
    if kind(whole).value != whole:
        raise ValueError(f"{what} must fit {ctypes.sizeof(kind)} bytes, not be {whole}")
    return whole


def named(values: Any, what: str) -> Mapping[str, Any]:
    """Fields by name; TypeError names `what`."""
    if not isinstance(values, Mapping):
        raise TypeError(f"{what} must be a dict of fields, not {reprlib.repr(values)}")
    return values


def assign(made: Any, values: Mapping[str, Any], keep: List[Any], sheet: Optional["Attributes"] = None) -> None:
    """Sets fields of a Def by name. `sheet` collects arrays of parameters; without it they are refused."""
    kinds = {name: kind for name, kind in made._fields_ if name not in _HIDDEN and not hasattr(kind, "contents")}
    for name, value in values.items():
        if name not in kinds:
            near = difflib.get_close_matches(name, kinds, 1)
            hint = f"; did you mean {near[0]!r}?" if near else f"; choose one of {', '.join(kinds)}"
            raise TypeError(f"there is no {name!r}{hint}")
        _assign_one(made, name, kinds[name], value, keep, sheet)


def _assign_one(made: Any, name: str, kind: Any, value: Any, keep: List[Any], sheet: Optional["Attributes"]) -> None:
    enum = _abi.FIELD_ENUMS.get(f"{type(made).__name__}.{name}")
    if kind is _abi.SingeParam:
        setattr(made, name, _param(value, name, keep, sheet))
    elif issubclass(kind, ctypes.Array):
        if kind._type_ is _abi.SingeParam:
            _colours(getattr(made, name), value, name, keep, sheet)
            return
        setattr(made, name, vector(kind, value, name, enum))
    elif issubclass(kind, ctypes.Structure):
        inner = getattr(made, name)
        if "enabled" in dict(kind._fields_):
            value = {"enabled": value} if isinstance(value, bool) else {"enabled": True, **named(value, name)}
        assign(inner, named(value, name), keep, sheet)
    elif kind is ctypes.c_char_p:
        setattr(made, name, None if value is None else text(value, name))
    else:
        setattr(made, name, _enumerator(enum, value, name) if enum else number(kind, value, name))


def _colours(params: Any, value: Any, name: str, keep: List[Any], sheet: Optional["Attributes"]) -> None:
    """Four parameters by the colour of springs: one value for all, or a dict by colour."""
    if not isinstance(value, Mapping):
        value = dict.fromkeys(COLOURS, value)
    for colour, one in value.items():
        if colour not in COLOURS:
            raise TypeError(f"{name}: there is no colour {colour!r}; choose one of {', '.join(COLOURS)}")
        params[COLOURS.index(colour)] = _param(one, f"{name}.{colour}", keep, sheet)


class Attributes:
    """The attributes of a sheet: the caller's, and those made from parameters that are arrays."""

    def __init__(self, count: int, given: Mapping[str, Any]):
        self.count = count
        self.arrays: Dict[str, np.ndarray] = {}
        for name, values in given.items():
            self.add(name, values)

    def add(self, name: str, values: Any) -> str:
        array = floats(values, 0, f"attribute {name!r}")
        if len(array) != self.count:
            raise ValueError(f"attribute {name!r} must have {self.count} values, one a vertex, not {len(array)}")
        self.arrays[name] = array
        return name

    def structs(self, keep: List[Any]) -> Any:
        made = (_abi.SingeAttribute * max(len(self.arrays), 1))()
        for struct, (name, array) in zip(made, self.arrays.items()):
            struct.name, struct.values = text(name, "the name of an attribute"), pointer(array, ctypes.c_float, keep)
        keep.append(made)
        return made


def _param(value: Any, name: str, keep: List[Any], sheet: Optional[Attributes]) -> _abi.SingeParam:
    """A parameter from a number, a Vary, or an array with a value per vertex."""
    made = _abi.SingeParam()
    if not isinstance(value, Vary):
        if not np.iterable(value):
            made.value = number(ctypes.c_float, value, name)
            return made
        array = floats(value, 0, name)
        low, high = (float(array.min()), float(array.max())) if len(array) else (0.0, 0.0)
        made.value = low
        if high == low:
            return made
        value = Vary(low, high, attribute=(array - low) / (high - low))
    given = [(kind, getattr(value, kind)) for kind in ("texture", "attribute", "noise")
             if getattr(value, kind) is not None]
    if len(given) != 1:
        raise ValueError(f"{name}: give exactly one of attribute, texture and noise")
    made.value, made.to = number(ctypes.c_float, value.value, name), number(ctypes.c_float, value.to, name)
    _field(made, *given[0], name, keep, sheet)
    return made


def _field(made: _abi.SingeParam, kind: str, given: Any, name: str, keep: List[Any],
           sheet: Optional[Attributes]) -> None:
    field = _abi.SingeField()
    field.kind = _abi.ENUMS["SingeFieldKind"][f"SINGE_FIELD_{kind.upper()}"]
    if kind == "texture":
        set_texture(field.texture, given, name, keep)
    elif kind == "noise":
        parts = list(given) if isinstance(given, (list, tuple)) else [given]
        if not 1 <= len(parts) <= 3:
            raise ValueError(f"{name}: noise must be a size, or (size, octaves, seed), not {given!r}")
        for part, value in zip(("scale", "octaves", "seed"), parts + [4, 1][len(parts) - 1:]):
            setattr(field.noise, part, number(dict(field.noise._fields_)[part], value, f"{name}: the noise's {part}"))
    else:
        if sheet is None:
            raise ValueError(f"{name} cannot follow an attribute here: only a sheet has attributes")
        attribute = given if isinstance(given, str) else sheet.add(f"parameter {name}", given)
        field.attribute = text(attribute, f"{name}: the name of an attribute")
    keep.append(field)
    made.field = ctypes.pointer(field)


def set_texture(texture: _abi.SingeTexture, values: Any, name: str, keep: List[Any]) -> None:
    """A grey picture, [rows, columns], 0 black to 1 white, the first row at the top."""
    array = numbers(values, name)
    if array.ndim != 2 or array.size == 0:
        raise ValueError(f"{name}: a texture must have the shape [rows, columns], not {list(array.shape)}")
    texture.height, texture.width = array.shape
    texture.values = pointer(array, ctypes.c_float, keep)


def path_keys(path: Any, keep: List[Any]) -> Tuple[int, Any]:
    """Key frames: rows (time, x, y, z) or (time, x, y, z, qx, qy, qz, qw), in s and m."""
    rows = numbers(path, "a path", np.float64)
    if rows.ndim != 2 or rows.shape[1] not in (4, 8):
        raise ValueError("a path must have rows (time, x, y, z) or (time, x, y, z, qx, qy, qz, qw)")
    keys = (_abi.SingePoseKey * len(rows))()
    for key, row in zip(keys, rows):
        key.time, key.position = row[0], tuple(row[1:4])
        key.rotation = tuple(row[4:]) if len(row) == 8 else (0, 0, 0, 1)
    keep.append(keys)
    return len(rows), keys


def as_dict(struct: Any) -> Dict[str, Any]:
    """A result's fields as numbers and lists."""
    values = {name: getattr(struct, name) for name, *_ in struct._fields_ if name != "struct_size"}
    return {name: list(value) if isinstance(value, ctypes.Array) else value for name, value in values.items()}
