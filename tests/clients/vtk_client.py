"""A burn by Singe, read by VTK (PyPI's vtk, which is what ParaView reads with): every value, times, triangles.

usage: vtk_client.py SINGE FOLDER    FOLDER is emptied
"""

import os
import shutil
import sys
import xml.etree.ElementTree as xml

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from burn import CHECKED, FRAMES, Frame, make, make_gone, same_points


def main():
    singe, folder = sys.argv[1:3]
    shutil.rmtree(folder, ignore_errors=True)
    out = make(singe, folder, ["vtp"], "--no-preview", "--set", "gas=no")
    sets = list(xml.parse(os.path.join(out, "burn.pvd")).iter("DataSet"))
    assert len(sets) == FRAMES
    for frame, item in enumerate(sets, 1):
        assert abs(float(item.get("timestep")) - (frame - 1) / 24) < 1e-12
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(out, item.get("file")))
        reader.Update()
        assert reader.GetErrorCode() == 0
        mesh, cache = reader.GetOutput(), Frame(out, frame)
        assert mesh.GetNumberOfPoints() == len(cache.rows) and mesh.GetNumberOfPolys() == len(cache.triangles)
        if frame not in CHECKED:
            continue
        same_points(mesh, cache, vtk_to_numpy)
        arrays = mesh.GetPointData()
        corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray())
        assert (corners == cache.triangles.ravel()).all()
        assert arrays.GetScalars().GetName() == "temperature" and arrays.GetVectors().GetName() == "velocity"
        assert abs(mesh.GetFieldData().GetArray("TimeValue").GetValue(0) - cache.time) == 0
    gone = make_gone(singe, folder, ["vtp"])
    counts = []
    for frame in range(1, 13):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(gone, "vtp", "burn.%04d.vtp" % frame))
        reader.Update()
        assert reader.GetErrorCode() == 0
        counts.append(reader.GetOutput().GetNumberOfPoints())
    print("vertices of a sheet that burns away:", counts)
    assert counts[0] > 0 and counts[-1] == 0
    print("VTK %s: every value of frames %s, counts of %d" % (vtkVersion.GetVTKVersion(), CHECKED, FRAMES))


main()
