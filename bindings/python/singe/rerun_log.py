"""A cache in the viewer Rerun: the burn on a timeline, beside plots of its numbers.

Needs the package rerun-sdk of PyPI.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Iterable, Optional

import numpy as np

from .picture import colours

if TYPE_CHECKING:
    from .cache import Cache

_PLOTS = ("temperature_max", "burnt_fraction", "mass", "strain_p99", "pieces")


def log_to_rerun(cache: "Cache", entity: str = "singe", frames: Optional[Iterable[int]] = None,
                 progress: Optional[Callable[[int, int], None]] = None) -> None:
    """Logs a cache to Rerun: `log_to_rerun(singe.read_cache("out/letter"))` opens its viewer with the burn.

    If the caller has begun a recording (`rerun.init`, then `rerun.save`, `connect_grpc`, ...), it goes there, below
    `entity`: the mesh as it looks in `surface`, by its temperature in `heat`; columns of stats.csv as plots in `stats`;
    ignitions, holes and pieces as texts in `events`, where the run wrote them. Timelines are `frame`, and `time` in s.
    `frames` are numbers of frames, all of them by default. `progress` is called with (frame, frames). ImportError: the
    package rerun-sdk of PyPI is not installed; IndexError: there is no such frame.
    """
    try:
        import rerun
    except ImportError as error:
        raise ImportError("log_to_rerun needs the package rerun-sdk: pip install rerun-sdk") from error
    if rerun.get_data_recording() is None:
        rerun.init("singe", spawn=True)

    def at(number: int, time: float) -> None:
        rerun.set_time("frame", sequence=number)
        rerun.set_time("time", duration=time)

    rerun.log(entity, rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    numbers = list(cache.frames if frames is None else frames)
    stats = cache.stats
    for number in numbers:
        frame = cache[number]
        at(number, frame.time)
        mesh: Any = {"vertex_positions": frame.position, "triangle_indices": frame.triangles,
                     "vertex_normals": frame.normal}
        rerun.log(f"{entity}/surface", rerun.Mesh3D(vertex_colors=colours(frame.burn, frame.temperature), **mesh))
        heat = np.clip((frame.temperature - 290) / 1000, 0, 1)[:, None] * np.array([255, 160, 60])
        rerun.log(f"{entity}/heat", rerun.Mesh3D(vertex_colors=heat.astype(np.uint8), **mesh))
        row = np.flatnonzero(stats["frame"] == number)
        for name in _PLOTS if len(row) else ():
            if name in stats:
                rerun.log(f"{entity}/stats/{name}", rerun.Scalars([float(stats[name][row[0]])]))
        if progress:
            progress(number, len(numbers))

    if (cache.folder / "events.csv").is_file():
        events = cache.table("events")
        for frame_of, time, kind, x, y, z in zip(*(events[name] for name in ("frame", "time", "event", "x", "y", "z"))):
            if int(frame_of) in numbers:
                at(int(frame_of), float(time))
                rerun.log(f"{entity}/events", rerun.TextLog(f"{kind} at {x:.3f} {y:.3f} {z:.3f} m"))
