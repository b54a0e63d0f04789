"""Meshes that Blender (PyPI's bpy) exports, taken by Singe: whatever the format splits comes together again.

usage: blender_meshes.py SINGE FOLDER    FOLDER is emptied
"""

import os
import shutil
import subprocess
import sys

import bpy
import bmesh  # comes with bpy

SINGE, FOLDER = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])


def export(name):
    """The object at hand in every format, z up but for glTF: names of files."""
    path, axes = os.path.join(FOLDER, name), {"forward_axis": "Y", "up_axis": "Z"}
    bpy.ops.wm.ply_export(filepath=path + "-split.ply", export_uv=True, export_normals=True, **axes)
    bpy.ops.wm.ply_export(filepath=path + "-text.ply", export_uv=True, export_normals=False, ascii_format=True, **axes)
    bpy.ops.wm.ply_export(filepath=path + "-plain.ply", export_uv=False, export_normals=False, **axes)
    bpy.ops.wm.obj_export(filepath=path + ".obj", **axes)
    bpy.ops.wm.stl_export(filepath=path + ".stl", **axes)
    bpy.ops.export_scene.gltf(filepath=path + ".glb", export_format="GLB")
    return [name + ending for ending in ("-split.ply", "-text.ply", "-plain.ply", ".obj", ".stl", ".glb")]


def check(name):
    """Singe's report about it, and its numbers of particles and cells."""
    scene = os.path.join(FOLDER, "scene.yaml")
    with open(scene, "w") as file:
        file.write("sheets: [{mesh: %s, up: %s}]\ngas: no\n" % (name, "y" if name.endswith(".glb") else "z"))
    text = subprocess.run([SINGE, "check", scene, "--frames", "1"], check=True, capture_output=True, text=True).stdout
    words = {line.split()[0]: line.split()[1] for line in text.splitlines() if line.split()}
    return text.split(name + ": ", 1)[1].split("\n", 1)[0], int(words["particles"]), int(words["cells"])


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # a box of sharp edges, unwrapped side by side: 98 vertices, which a PLY with uv and normals splits
    bpy.ops.mesh.primitive_cube_add(size=0.1)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=3)
    bpy.ops.uv.cube_project(cube_size=0.1)
    bpy.ops.object.mode_set(mode="OBJECT")
    for name in export("box"):
        report, particles, cells = check(name)
        print("%-16s %s" % (name, report))
        assert (particles, cells) == (98 + 96, 96) and "1 component" in report, (name, particles, cells)
    assert "130 vertices" in check("box-split.ply")[0]
    bpy.ops.object.delete()
    # a grid of which faces are dissolved into polygons, one of them not convex
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=0.1)
    mesh = bmesh.new()
    mesh.from_mesh(bpy.context.object.data)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.dissolve_faces(mesh, faces=[mesh.faces[i] for i in (9, 10, 17)])
    mesh.faces.ensure_lookup_table()
    bmesh.ops.dissolve_faces(mesh, faces=[mesh.faces[i] for i in (40, 41)])
    mesh.to_mesh(bpy.context.object.data)
    counts = {}
    for name in export("polygons"):
        report, particles, cells = check(name)
        print("%-16s %s" % (name, report))
        assert "1 component" in report, (name, report)
        counts[name] = (particles, cells)
    same = {counts[name] for name in counts if not name.endswith((".stl", ".glb"))}  # those are triangles
    assert len(same) == 1, counts
    print("Blender %s" % bpy.app.version_string)


main()
sys.stdout.flush()
os._exit(0)  # bpy 4.5 may hang while it is taken down
