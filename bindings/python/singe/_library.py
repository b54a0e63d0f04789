"""The shared library: found, opened, and its errors turned into exceptions."""

from __future__ import annotations

import ctypes
import logging
import os
import pathlib
import sys
from typing import Any

from . import _abi, errors

_NAMES = {"win32": "libsinge.dll", "darwin": "libsinge.dylib"}
_KINDS = {1: errors.ArgumentError, 2: errors.OutOfMemoryError, 3: errors.MeshError, 4: errors.HandleError,
          5: errors.StateError, 6: errors.DivergedError, 7: errors.FormatError, 8: errors.VersionError,
          10: errors.LimitError}
_LEVELS = {0: logging.INFO, 1: logging.WARNING, 2: logging.ERROR}

logger = logging.getLogger("singe")


def _opened() -> ctypes.CDLL:
    """The library beside this file, or the one that the environment's SINGE_LIBRARY names."""
    path = os.environ.get("SINGE_LIBRARY")
    if not path:
        path = str(pathlib.Path(__file__).with_name(_NAMES.get(sys.platform, "libsinge.so")))
    try:
        opened = ctypes.CDLL(path)  # calls release the interpreter's lock
    except OSError as error:
        raise ImportError(f"singe: cannot open the library: {error}") from error
    for name, (result, arguments) in _abi.FUNCTIONS.items():
        function = getattr(opened, name)
        function.restype, function.argtypes = result, arguments
    version = opened.singe_version().decode()
    if version != _abi.VERSION:
        raise ImportError(f"singe: {path} has version {version}, but this package needs {_abi.VERSION}")
    return opened


library = _opened()


def raise_for(error: _abi.SingeError) -> None:
    """Raises what an error of the library stands for."""
    message = error.message.decode("utf-8", "replace") or library.singe_result_name(error.code).decode()
    raise _KINDS.get(error.code, errors.Error)(message, error.stage.decode("utf-8", "replace"), error.element)


def _log_line(_context: object, level: int, line: bytes) -> None:
    logger.log(_LEVELS.get(level, logging.INFO), "%s", line.decode("utf-8", "replace"))


# lives as long as the process, as simulations do at most
_fields: Any = _abi.SingeLog._fields_
log_callback = dict(_fields)["write"](_log_line)
