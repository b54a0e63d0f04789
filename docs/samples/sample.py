"""What the samples in Python share, as sample.h those in C: paper, pins and matches are a call."""

import numpy as np

import singe


def fire(**options):
    """A simulation whose fire runs eight times as fast as a real one, and whose drawn surface is fine."""
    return singe.Sim(pace=8, surface_detail=1e-3, **options)


def square(side, cells, height=0.0):
    """Points, faces and uv of `cells` x `cells` cells and `side` m about the origin, `height` m above it."""
    points, faces, uv = singe.grid((side, side), (cells, cells))
    return points + np.float32([0, 0, height]), faces, uv


def pin(sim, sheet, *point, radius=0.01, path=None):
    """Holds what lies within `radius` m of a point."""
    return sim.pin(sheet, points=[point], radius=radius, path=path)


def match(sim, *point):
    """A match that burns at a point for half a second."""
    return sim.spot(point, radius=0.01, falloff=0.01, temperature=1123, end=0.5)
