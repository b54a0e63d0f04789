"""The PVD of vtk_client.py in ParaView (pvpython): times, every value of some frames, counts of all, and a picture.

usage: xvfb-run pvpython paraview_client.py SINGE FOLDER    reads FOLDER/../vtk/out; FOLDER is emptied, frame.png is in it
"""

import os
import shutil
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np
from paraview import servermanager
from paraview.simple import (ColorBy, CreateView, GetColorTransferFunction, GetDisplayProperties, GetParaViewVersion,
                             PVDReader, Render, SaveScreenshot, Show)
from vtkmodules.util.numpy_support import vtk_to_numpy

from burn import CHECKED, FRAMES, Frame, same_points


def check(reader, out):
    times = list(reader.TimestepValues)
    assert np.allclose(times, np.arange(FRAMES) / 24, atol=1e-12, rtol=0), times
    for frame, time in enumerate(times, 1):
        reader.UpdatePipeline(time)
        mesh, cache = servermanager.Fetch(reader), Frame(out, frame)
        if mesh.IsA("vtkMultiBlockDataSet"):
            mesh = mesh.GetBlock(0)
        assert mesh.GetNumberOfPoints() == len(cache.rows) and mesh.GetNumberOfCells() == len(cache.triangles), frame
        if frame not in CHECKED:
            continue
        same_points(mesh, cache, vtk_to_numpy)


def draw(reader, folder, time):
    view = CreateView("RenderView")
    view.ViewSize, view.ViewTime, view.Background = [480, 270], time, [0.15, 0.16, 0.18]
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0.12, -0.34, 0.2], [0.02, 0, 0.05], [0, 0, 1]
    view.UseColorPaletteForBackground = 0
    Show(reader, view)
    ColorBy(GetDisplayProperties(reader, view), ("POINTS", "temperature"))
    GetColorTransferFunction("temperature").RescaleTransferFunction(300, 1100)
    Render(view)
    path = os.path.join(folder, "frame.png")
    SaveScreenshot(path, view, ImageResolution=[480, 270])
    return path


def main():
    folder = os.path.abspath(sys.argv[2])
    out = os.path.join(os.path.dirname(folder), "vtk", "out")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    reader = PVDReader(FileName=os.path.join(out, "burn.pvd"))
    check(reader, out)
    path = draw(reader, folder, 17 / 24)
    print("ParaView %s: times, every value of frames %s, counts of %d; %s" % ("%d.%d" % (GetParaViewVersion().major, GetParaViewVersion().minor), CHECKED, FRAMES, path))


main()
