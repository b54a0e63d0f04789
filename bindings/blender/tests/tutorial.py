# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorial of docs/blender-extension.md, done by a script: usage tutorial.py PROGRAM FOLDER

Leaves FOLDER/curtain.blend and the page's pictures. Needs Blender (PyPI's bpy).
"""

import math
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import singe_extension

FRAMES, SHOWN = 60, (12, 20)


def group(candidate, name, test):
    made = candidate.vertex_groups.new(name=name)
    made.add([v.index for v in candidate.data.vertices if test(candidate.matrix_world @ v.co)], 1.0, "REPLACE")
    return name


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    singe_extension.register()
    scene = bpy.context.scene
    scene.frame_end = FRAMES
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "curtain.blend"))

    bpy.ops.mesh.primitive_grid_add(x_subdivisions=20, y_subdivisions=20, size=0.2, location=(0, 0, 0.2),
                                    rotation=(math.pi / 2, 0, 0))
    curtain = bpy.context.object
    bpy.context.view_layer.update()
    own = curtain.singe
    own.role, own.material, own.cell_size = "SHEET", "newsprint", 0.003
    own.pin_group = group(curtain, "held", lambda p: p.z > 0.299 and abs(abs(p.x) - 0.05) < 0.051)
    own.lit_by, own.lit_group = "GROUP", group(curtain, "match", lambda p: p.z < 0.105 and p.x < -0.06)
    os.environ["SINGE_PROGRAM"] = os.path.abspath(program)
    scene.singe.pace, scene.singe.gas_detail = 6, 4
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message

    bpy.ops.object.camera_add(location=(0.1, -0.5, 0.22))
    camera = bpy.context.object
    camera.rotation_euler = (Vector((0, 0, 0.2)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_start = 0.01
    scene.camera = camera
    bpy.ops.object.light_add(type="AREA", location=(0.35, -0.45, 0.55))
    light = bpy.context.object
    light.data.energy, light.data.size = 3, 0.3
    light.rotation_euler = (Vector((0, 0, 0.2)) - light.location).to_track_quat("-Z", "Y").to_euler()
    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.03, 0.035, 0.05, 1)
    scene.view_settings.view_transform, scene.view_settings.look = "Filmic", "High Contrast"  # AgX bleaches flames
    scene.render.engine, scene.cycles.samples = "CYCLES", 32
    scene.cycles.use_denoising = True
    scene.render.resolution_x, scene.render.resolution_y = 400, 480
    for frame in SHOWN:
        scene.frame_set(frame)
        scene.render.filepath = os.path.join(folder, f"frame{frame}.png")
        bpy.ops.render.render(write_still=True)
    bpy.ops.wm.save_mainfile()
    sys.stdout.flush()
    os._exit(0)  # bpy 4.5 may hang as it ends


main(sys.argv[1], sys.argv[2])
