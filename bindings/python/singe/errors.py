"""Exceptions, each with the message of the library or of the command."""

from __future__ import annotations

import re
from typing import NamedTuple, Optional


class Error(Exception):
    """An error of the library. `str()` of it is the library's message.

    `stage` says where it happened ("sheet", "heat", "dynamics", ...), `element` is the index of the cell, vertex or
    particle concerned, or -1.
    """

    def __init__(self, message: str, stage: str = "", element: int = -1):
        super().__init__(f"{stage}: {message}" if stage else message)
        self.stage, self.element = stage, element


class ArgumentError(Error, ValueError):
    """A value is out of its range."""


class OutOfMemoryError(Error, MemoryError):
    """There is not enough memory."""


class MeshError(Error, ValueError):
    """A mesh is degenerate, non-manifold or indexes out of range."""


class HandleError(Error, LookupError):
    """The object has been removed."""


class StateError(Error, RuntimeError):
    """The call is not allowed now: a sheet after the commit, anything after close()."""


class DivergedError(Error, ArithmeticError):
    """A stage of a step produced a value that is not finite. The simulation is unchanged by that step."""


class FormatError(Error, ValueError):
    """Bytes or a file do not follow their format."""


class VersionError(FormatError):
    """A snapshot of another version or kind of machine."""


class LimitError(Error, ValueError):
    """An input is larger than its format or index allows."""


class Problem(NamedTuple):
    """One error of a scene: its location, counted from 1, and its message."""

    file: str
    line: int
    column: int
    message: str


class CommandError(Error, RuntimeError):
    """The command `singe` failed. `str()` of it is what the command printed, with file:line:column and the line.

    `returncode` is 1 where a run failed or was interrupted, 2 for bad input. `problems` lists the errors that have a
    location in a file.
    """

    def __init__(self, text: str, returncode: Optional[int] = None):
        super().__init__(text)
        self.returncode = returncode
        found = re.findall(r"^(.+?):(\d+):(\d+): error: (.*)$", text, re.M)
        self.problems = [Problem(file, int(line), int(column), message) for file, line, column, message in found]


class SceneError(CommandError, ValueError):
    """A scene, a mesh, a cache or an option is refused (the command's exit code 2)."""


class CommandMissingError(CommandError):
    """This installation has no command `singe`: see singe.command_path()."""
