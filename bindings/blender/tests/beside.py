# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame of a cache as `singe render` draws it and, right of it, as Blender does with the extension's materials, lit
and seen as the scene's `preview` says.

usage: beside.py SINGE CACHE FRAME FOLDER [SAMPLES [cycles | eevee]]     CACHE has USD and the finer gas (docs/blender.md)

Leaves FOLDER/preview.png, FOLDER/blender.png and both as FOLDER/beside.png. Needs Blender (PyPI's bpy), and
for Eevee a display.
"""

import json
import math
import os
import subprocess
import sys
import traceback

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import singe_extension
from singe_extension import load, materials

WIDTH, HEIGHT = 640, 360
FILM_SPEED = 0.45  # of the preview: exposed for white paper
VIEW, LOOK = "Filmic", "High Contrast"


def stage(look):
    """Camera, sun, sky and ground of the scene's preview."""
    scene, eye = bpy.context.scene, look["camera"]
    bpy.ops.object.camera_add(location=eye["eye"])
    camera = scene.camera = bpy.context.object
    sight = Vector(eye["target"]) - camera.location
    camera.rotation_euler = sight.to_track_quat("-Z", "Y").to_euler()
    camera.data.sensor_fit, camera.data.angle, camera.data.clip_start = "VERTICAL", math.radians(eye["fov"]), 0.01
    camera.data.dof.use_dof = eye["aperture"] > 0
    camera.data.dof.focus_distance = eye["focus"] or sight.length
    camera.data.dof.aperture_fstop = camera.data.lens / 1000 / max(eye["aperture"], 1e-6)

    bpy.ops.object.light_add(type="SUN")
    sun = bpy.context.object
    sun.rotation_euler = Vector(look["light"]["direction"]).to_track_quat("Z", "Y").to_euler()
    sun.data.energy, sun.data.color = math.pi * FILM_SPEED, look["light"]["colour"]
    sun.visible_glossy = False # the preview's gloss mirrors the sky alone
    sun.data.angle = math.radians(2 * look["light"]["angle"])
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes["Background"].inputs
    sky[0].default_value, sky[1].default_value = (*look["sky"], 1), FILM_SPEED

    if look["ground"]["height"] != "none":
        bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, look["ground"]["height"]))
        table = bpy.data.materials.new("table")
        table.use_nodes = True
        wood = table.node_tree.nodes["Principled BSDF"].inputs
        wood["Base Color"].default_value, wood["Roughness"].default_value = (*look["ground"]["colour"], 1), 0.35
        bpy.context.object.data.materials.append(table)


def source(sheet, folder):
    """An object with the sheet's picture, as a user's own would be."""
    bpy.ops.mesh.primitive_plane_add(size=0.01)
    made = bpy.context.object
    made.singe.role = "SHEET"
    own = bpy.data.materials.new(sheet["name"])
    own.use_nodes = True
    tree = own.node_tree
    base = tree.nodes["Principled BSDF"].inputs["Base Color"]
    base.default_value = (*sheet["colour"], 1)
    if sheet.get("picture"):
        picture = tree.nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images.load(os.path.join(folder, sheet["picture"]))
        tree.links.new(picture.outputs[0], base)
    made.data.materials.append(own)


def pixels(path):
    image = bpy.data.images.load(path)
    array = np.empty(4 * WIDTH * HEIGHT, np.float32)
    image.pixels.foreach_get(array)
    return array.reshape(HEIGHT, WIDTH, 4)


def save(array, path):
    image = bpy.data.images.new("beside", array.shape[1], array.shape[0])
    image.pixels.foreach_set(np.ascontiguousarray(array, np.float32).ravel())
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()


def main(program, cache, frame, folder, samples="24", engine="cycles"):
    cache, folder, frame = os.path.abspath(cache), os.path.abspath(folder), int(frame)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(cache, "run.json"), encoding="utf-8") as file:
        run = json.load(file)
    subprocess.run([program, "render", cache, "-o", folder, "--frames", str(frame), "--quiet", "--set",
                    f"preview.size=[{WIDTH},{HEIGHT}]"], check=True)
    os.replace(os.path.join(folder, "frames", f"{run['name']}.{frame:04}.png"), os.path.join(folder, "preview.png"))

    bpy.ops.wm.read_factory_settings(use_empty=True)
    singe_extension.register()
    scene = bpy.context.scene
    scene.render.fps = run["fps"]
    for sheet in run["scene"]["sheets"]:
        source(sheet, run["scene_folder"])
    load.load(bpy.context, cache)
    stage(run["scene"]["preview"])
    scene.view_settings.view_transform, scene.view_settings.look = VIEW, LOOK
    scene.view_settings.exposure = math.log2(run["scene"]["preview"]["exposure"])
    if engine == "eevee":
        scene.render.engine = "BLENDER_EEVEE" if bpy.app.version >= (5, 0) else "BLENDER_EEVEE_NEXT"
        scene.eevee.taa_render_samples = int(samples)
    else:
        scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", int(samples), True
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.frame_set(frame)
    scene.render.filepath = os.path.join(folder, "blender.png")
    bpy.ops.render.render(write_still=True)
    both = [pixels(os.path.join(folder, name)) for name in ("preview.png", "blender.png")]
    save(np.hstack(both), os.path.join(folder, "beside.png"))


if __name__ == "__main__":
    status = 1
    try:
        main(*sys.argv[1:])
        status = 0
    except Exception:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(status)  # bpy 4.5 may hang as it ends
