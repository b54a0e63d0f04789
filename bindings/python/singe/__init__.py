"""Singe burns cloth and paper::

    import singe
    sim = singe.Sim(pace=5)
    sheet = sim.sheet(*singe.grid((0.15, 0.15), (40, 40)))
    sim.pin(sheet, points=[[-0.075, 0.075, 0], [0.075, 0.075, 0]])
    sim.spot([0.075, 0, 0], radius=0.01, end=0.5)
    sim.commit()
    sim.advance(2)
    print(sim.temperature.max())

Units are SI and kelvin. Arrays of a simulation are read-only views of its memory: they are not copied, and each step
changes them. docs/python.md is the guide. Names of fields have the meaning that the C headers give them.
"""

from ._abi import VERSION as __version__
from ._fields import Vary
from .cache import Cache, Frame, read_cache
from .command import branch, check, command_path, measure, render, run
from .errors import (ArgumentError, CommandError, CommandMissingError, DivergedError, Error, FormatError, HandleError,
                     LimitError, MeshError, OutOfMemoryError, Problem, SceneError, StateError, VersionError)
from .objects import Collider, Grid, Pin, Sheet, Source, grid
from .picture import draw, draw_png
from .rerun_log import log_to_rerun
from .simulation import Sim, materials
from .notebook import view
from .views import Gas, StepView, Surface

# bits of flags
ALIVE, PINNED = 1, 2
# colours of springs
RED, GREEN, BLUE, YELLOW = range(4)
# kinds of events
IGNITED, HOLE_OPENED, PIECE_FREED = range(3)

__all__ = [name for name in dir() if not name.startswith("_") and name not in
           ("alembic", "cache", "command", "errors", "notebook", "objects", "picture", "rerun_log", "simulation",
            "views")]
