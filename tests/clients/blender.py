"""A burn by Singe in Blender (PyPI's bpy, 4.5 to 5.2): every value, the camera, blur from velocities, and pictures to look at.

usage: blender.py SINGE FOLDER    FOLDER is emptied; its pictures are sheet.png, gas-flame.png, gas-blackbody.png,
night.png and preview.png, Singe's own
"""

import math
import os
import shutil
import sys

import bpy
import numpy as np

from burn import CHECKED, FRAMES, SCALARS, Frame, body, check_burns_away, make, make_gone, same

SHEETS = ("leaf", "strip")


def open_root(root):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Blender takes a distant light four times as bright as OpenUSD says
    bpy.ops.wm.usd_import(filepath=root, light_intensity_scale=0.25)
    scene = bpy.context.scene
    scene.camera = bpy.data.objects["camera"]
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 8, False
    scene.render.resolution_x, scene.render.resolution_y = 480, 270
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.08, 0.095, 0.12, 1)
    return scene


def values(mesh, name, width, kind):
    """An attribute as an array; vectors by their components."""
    attribute = mesh.attributes[name]
    array = np.empty(width * len(attribute.data), kind)
    attribute.data.foreach_get("vector" if width > 1 else "value", array)
    return array.reshape(-1, width) if width > 1 else array


def check_values(scene, out):
    for frame in range(1, FRAMES + 1):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for sheet, name in enumerate(SHEETS):
            mesh = bpy.data.objects[name].evaluated_get(graph).data
            cache = Frame(out, frame, sheet=sheet)
            assert len(mesh.vertices) == len(cache.rows) and len(mesh.polygons) == len(cache.triangles), (name, frame)
            if frame not in CHECKED:
                continue
            for attribute in SCALARS:
                kind = np.int32 if attribute in ("piece_id", "vertex_id", "sheet") else np.float32
                same(values(mesh, attribute, 1, kind), cache.column(attribute), (name, frame, attribute))
            same(values(mesh, "position", 3, np.float32), cache.stack("x y z"), (name, frame, "position"))
            same(values(mesh, "velocity", 3, np.float32), cache.stack("vx vy vz"), (name, frame, "velocity"))
            same(values(mesh, "rest", 3, np.float32), cache.stack("rest_x rest_y rest_z"), (name, frame, "rest"))
            corners = np.empty(3 * len(mesh.polygons), np.int32)
            mesh.loops.foreach_get("vertex_index", corners)
            assert (corners.reshape(-1, 3) == cache.triangles).all(), (name, frame, "triangles")
            uv = np.empty(2 * len(mesh.loops), np.float32)
            mesh.attributes["st"].data.foreach_get("vector", uv)
            same(uv.reshape(-1, 2), cache.stack("s t")[corners], (name, frame, "uv"))
        moving = bpy.data.objects["shape1"].evaluated_get(graph)
        same(values(moving.data, "position", 3, np.float32), body(frame)[0], ("body", frame))
    print("every value of frames %s, counts of %d" % (CHECKED, FRAMES))


def draw(scene, path, blur):
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = blur, 1
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    pixels = np.empty(4 * 480 * 270, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(270, 480, 4)


def gas_material(**inputs):
    """Principled Volume as it comes, but for these inputs."""
    material = bpy.data.materials.new("gas")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    volume, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    for name, value in inputs.items():
        volume.inputs[name.replace("_", " ")].default_value = value
    links.new(volume.outputs[0], output.inputs["Volume"])
    materials = bpy.data.objects["gas"].data.materials
    materials.clear()
    materials.append(material)
    return nodes, links, volume


def light_by_flame():
    """The flame for its light."""
    nodes, links, volume = gas_material(Color=(0.05, 0.05, 0.05, 1), Emission_Color=(1, 0.33, 0.07, 1))
    flame, times = nodes.new("ShaderNodeAttribute"), nodes.new("ShaderNodeMath")
    flame.attribute_name, times.operation, times.inputs[1].default_value = "flame", "MULTIPLY", 218
    links.new(flame.outputs["Fac"], times.inputs[0])
    links.new(times.outputs[0], volume.inputs["Emission Strength"])


def check_gas(scene, folder, sharp):
    """Smoke and flame by the node, and by a black body without any: both where the strip's flame is, orange, and alike."""
    above = (slice(150, 200), slice(290, 345), slice(0, 3))
    clear = (slice(40, 130), slice(20, 130), slice(0, 3))  # where neither is
    adds = []
    for name in ("flame", "blackbody"):
        if name == "flame":
            light_by_flame()
        else:
            gas_material(Temperature=1, Blackbody_Intensity=1, Blackbody_Tint=(309, 309, 309, 1))
        lit = draw(scene, os.path.join(folder, "gas-%s.png" % name), False) - sharp
        red, green, blue = lit[above].mean((0, 1))
        print("the flame by %s adds %.3f, %.3f, %.3f there" % (name, red, green, blue))
        assert red > 0.05 and red > green > blue and abs(lit[clear].mean()) < 0.01
        adds.append(lit[above].sum(2).ravel())
    alike = float(np.corrcoef(*adds)[0, 1])
    print("both pictures of it agree by a correlation of %.2f" % alike)
    assert alike > 0.7


def check_gas_by_night(scene, folder):
    """A Principled Volume with its own tint: in a room that only the fire lights, exposed for it."""
    sky, sun, gas = scene.world.node_tree.nodes["Background"].inputs[1], bpy.data.objects["sun"], bpy.data.objects["gas"]
    gas_material(Temperature=1, Blackbody_Intensity=1)
    sky.default_value, sun.hide_render, scene.view_settings.exposure = 0, True, 8
    flame = (slice(150, 200), slice(290, 345), slice(0, 3))
    gas.hide_render = True
    dark = draw(scene, os.path.join(folder, "night-without.png"), False)[flame].mean((0, 1))
    gas.hide_render = False
    red, green, blue = draw(scene, os.path.join(folder, "night.png"), False)[flame].mean((0, 1)) - dark
    print("by night, at exposure 7, the flame adds %.3f, %.3f, %.3f there" % (red, green, blue))
    assert red > 0.05 and red > green > blue
    sky.default_value, sun.hide_render, scene.view_settings.exposure = 1, False, 0


def check_gas_blur(scene, folder):
    """Flames are blurred by the velocity of the gas: all else that moves is blurred in both pictures."""
    gas = bpy.data.objects["gas"].data
    gas.velocity_grid, gas.velocity_unit = "velocity", "SECOND"
    pictures = []
    for scale in (0, 1, 1):
        gas.velocity_scale = scale
        pictures.append(draw(scene, os.path.join(folder, "gas-blur%d.png" % len(pictures)), True))
    difference, noise = (float(np.abs(picture - pictures[1]).mean()) for picture in (pictures[0], pictures[2]))
    print("the velocity of the gas changes the picture by %.6f; drawing it again by %.6f" % (difference, noise))
    assert difference > 1e-4 + 20 * noise


def main():
    singe, folder = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    out = make(singe, folder, ["usd"], "--set", "gas.detail=2")
    shutil.copy(os.path.join(out, "frames", "burn.0018.png"), os.path.join(folder, "preview.png"))
    scene = open_root(os.path.join(out, "burn.usda"))
    assert (scene.frame_start, scene.frame_end) == (1, FRAMES)
    camera = scene.camera
    assert np.allclose(camera.matrix_world.translation, (0.12, -0.34, 0.2), atol=1e-6)
    assert abs(math.degrees(2 * math.atan(0.5 * camera.data.sensor_width * 9 / 16 / camera.data.lens)) - 34) < 0.01
    check_values(scene, out)
    gas = bpy.data.objects["gas"]
    scene.frame_set(18)
    assert gas.data.grids.load() and gas.data.grids.frame_filepath.endswith(os.path.join("gas_detail", "burn.0018.vdb"))
    gas.hide_render = True
    sharp = draw(scene, os.path.join(folder, "sheet.png"), False)
    blurred = draw(scene, os.path.join(folder, "blur.png"), True)
    difference = float(np.abs(blurred - sharp)[..., :3].mean())
    again = float(np.abs(draw(scene, os.path.join(folder, "again.png"), False) - sharp)[..., :3].mean())
    print("motion blur changes the picture by %.6f on average; drawing it again by %.6f" % (difference, again))
    assert difference > 1e-4 + 20 * again
    gas.hide_render = False
    check_gas(scene, folder, sharp)
    check_gas_by_night(scene, folder)
    light_by_flame()
    check_gas_blur(scene, folder)
    open_root(os.path.join(make_gone(singe, folder, ["usd"]), "burn.usda"))
    check_burns_away(bpy)
    print("Blender %s: pictures in %s" % (bpy.app.version_string, folder))


main()
sys.stdout.flush()
os._exit(0)  # bpy 4.5 may hang while it is taken down
