"""The Alembic files of alembic_client.py in Blender (PyPI's bpy): every value, blur from velocities, an empty last frame.

usage: blender_alembic.py SINGE FOLDER    the files are in FOLDER/../alembic; FOLDER is emptied, its pictures are in it
"""

import os
import shutil
import sys

import bpy
import numpy as np

from burn import CHECKED, FRAMES, Frame, check_burns_away, same


def read(mesh, name, key, width, kind=np.float32):
    data = mesh.attributes[name].data if name else mesh.loops
    values = np.empty(width * len(data), kind)
    data.foreach_get(key, values)
    return values.reshape(-1, width)


def check(folder):
    scene = bpy.context.scene
    for frame in range(1, FRAMES + 1):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for sheet, name in enumerate(("leaf", "strip")):
            mesh = bpy.data.objects[name].evaluated_get(graph).data
            cache = Frame(os.path.join(folder, "out"), frame, sheet=sheet)
            assert len(mesh.vertices) == len(cache.rows) and len(mesh.polygons) == len(cache.triangles), (name, frame)
            if frame not in CHECKED:
                continue
            same(read(mesh, "position", "vector", 3) + 0.0, cache.stack("x y z") + 0.0, (name, frame, "position"))
            same(read(mesh, "velocity", "vector", 3) + 0.0, cache.stack("vx vy vz") + 0.0, (name, frame, "velocity"))
            corners = read(mesh, None, "vertex_index", 1, np.int32).ravel()
            same(corners, cache.triangles.ravel(), (name, frame, "triangles"))
            same(read(mesh, mesh.uv_layers[0].name, "vector", 2), cache.stack("s t")[corners], (name, frame, "uv"))
    print("every value of frames %s, counts of %d" % (CHECKED, FRAMES))


def draw(path, blur):
    scene = bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter, scene.render.filepath = blur, 1, path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    pixels = np.empty(4 * 240 * 136, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels


def main():
    folder = os.path.abspath(sys.argv[2])
    files = os.path.join(os.path.dirname(folder), "alembic")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.wm.alembic_import(filepath=os.path.join(files, "burn.abc"))
    assert (scene.frame_start, scene.frame_end) == (1, FRAMES)
    check(files)
    scene.frame_set(18)
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 4, False
    scene.render.resolution_x, scene.render.resolution_y = 240, 136
    scene.world = bpy.data.worlds.new("sky")
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0.03, -0.4, 0.05), (1.5708, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    light = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    light.rotation_euler = (0.8, 0, -0.4)
    scene.collection.objects.link(light)
    sharp, blurred, again = (draw(os.path.join(folder, name), blur) for name, blur in
                             (("sharp.png", False), ("blur.png", True), ("again.png", False)))
    difference, noise = float(np.abs(blurred - sharp).mean()), float(np.abs(again - sharp).mean())
    print("motion blur changes the picture by %.6f on average; drawing it again by %.6f" % (difference, noise))
    assert difference > 1e-4 + 20 * noise
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.alembic_import(filepath=os.path.join(files, "gone.abc"))
    check_burns_away(bpy)
    print("Blender %s" % bpy.app.version_string)


main()
sys.stdout.flush()
os._exit(0)  # bpy 4.5 may hang while it is taken down
