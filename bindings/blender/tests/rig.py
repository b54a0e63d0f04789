# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension in a real Blender without a window: usage rig.py PROGRAM FOLDER [EXTENSION.zip]

With a zip it is installed as a user installs it, and its own program burns. Pictures for looking at are in FOLDER.
"""

import math
import os
import shutil
import sys
import time

folder = os.path.abspath(sys.argv[2])
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.environ["BLENDER_USER_RESOURCES"] = os.path.join(folder, "user")

import bpy
import numpy as np

program = os.path.abspath(sys.argv[1])
archive = sys.argv[3] if len(sys.argv) > 3 else None
if not archive:
    os.environ["SINGE_PROGRAM"] = program


def install():
    """The package; registered."""
    if not archive:
        sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
        import singe_extension
        singe_extension.register()
        return singe_extension
    import addon_utils
    addon_utils.enable("bl_pkg")
    done = bpy.ops.extensions.package_install_files(filepath=os.path.abspath(archive), repo="user_default",
                                                    enable_on_install=True)
    assert done == {"FINISHED"}, done
    name = "bl_ext.user_default.singe"
    assert name in bpy.context.preferences.addons, list(bpy.context.preferences.addons.keys())
    return sys.modules[name]


def fresh(frames=12, start=1):
    bpy.ops.wm.read_factory_settings(use_empty=True) if not archive else clear_scene()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = start, start + frames - 1
    scene.render.fps, scene.render.fps_base = 24, 1
    own = scene.singe
    own.folder, own.gas, own.quality, own.pace = os.path.join(folder, "cache"), False, "DRAFT", 8
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "scene.blend"))
    return scene


def clear_scene():
    for candidate in list(bpy.data.objects):
        bpy.data.objects.remove(candidate)
    for collection in list(bpy.data.collections):
        bpy.data.collections.remove(collection)


def group(candidate, name, test):
    made = candidate.vertex_groups.new(name=name)
    chosen = [v.index for v in candidate.data.vertices if test(candidate.matrix_world @ v.co)]
    assert chosen, (candidate.name, name)
    made.add(chosen, 1.0, "REPLACE")
    return name


def add_curtain(size=0.2):
    """Hangs in the x-z plane by its upper side."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=size, location=(0, 0, 0.25),
                                    rotation=(math.pi / 2, 0, 0))
    curtain = bpy.context.object
    curtain.name = "Curtain"
    bpy.context.view_layer.update()
    own = curtain.singe
    own.role, own.material, own.cell_size = "SHEET", "newsprint", 0.007
    own.pin_group = group(curtain, "hook", lambda p: p.z > 0.349)
    own.lit_by, own.lit_group = "GROUP", group(curtain, "match", lambda p: p.z < 0.151 and abs(p.x) < 0.03)
    return curtain


def evaluated(candidate, frame):
    bpy.context.scene.frame_set(frame)
    return candidate.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


def burning():
    return [o for o in bpy.data.objects if any(m.type == "MESH_SEQUENCE_CACHE" for m in o.modifiers)]


def values(mesh, name):
    found = np.empty(len(mesh.attributes[name].data), np.float32)
    mesh.attributes[name].data.foreach_get("value", found)
    return found


def points(mesh):
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def render(path, samples=16, blur=False):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    scene.render.resolution_x, scene.render.resolution_y = 360, 270
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = blur, 1
    scene.render.filepath = os.path.join(folder, path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(4 * 360 * 270, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(270, 360, 4)[..., :3]


def embers(pixels):
    """Which pixels glow: bright, and far redder than lit char, ash or paper are."""
    return (pixels[..., 0] > 0.3) & (pixels[..., 0] > 3 * pixels[..., 2])


def add_view(eye, target, size=1.0):
    """A camera and a lamp for what is `size` of the scene's units large."""
    from mathutils import Vector
    bpy.ops.object.camera_add(location=eye)
    camera = bpy.context.object
    camera.rotation_euler = (Vector(target) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_start, camera.data.lens = 0.01, 50
    bpy.context.scene.camera = camera
    bpy.ops.object.light_add(type="AREA", location=Vector(target) + size * Vector((0.4, -0.5, 0.5)))
    light = bpy.context.object
    light.data.energy, light.data.size = 8 * size**2, 0.5 * size
    light.rotation_euler = (Vector(target) - light.location).to_track_quat("-Z", "Y").to_euler()
    world = bpy.data.worlds.new("w")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.03, 0.035, 0.045, 1)
    bpy.context.scene.world = world


# ---- scenarios

def curtain_burns():
    """Lit by a group, held by a group; comes in by itself, at the scene's frames, and the source is hidden."""
    scene = fresh(frames=20, start=11)
    curtain = add_curtain()
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
    sheet, = burning()
    assert curtain.hide_render and scene.singe.message == "20 frames burnt", scene.singe.message
    first, last = evaluated(sheet, 11), None
    top = points(first)[:, 2].max()
    assert abs(top - 0.35) < 0.01, top
    assert values(first, "burnt").max() < 0.01
    last = evaluated(sheet, 30)
    assert values(last, "temperature_peak").max() > 700, values(last, "temperature_peak").max()
    assert abs(points(last)[:, 2].max() - 0.35) < 0.02, "it is not held"
    before = len(evaluated(sheet, 11).vertices)
    assert before != len(evaluated(sheet, 30).vertices), "it does not change"
    assert len(evaluated(sheet, 5).vertices) == before  # before the first frame it is as at it
    modifier = next(m for m in sheet.modifiers if m.type == "MESH_SEQUENCE_CACHE")
    assert not modifier.use_vertex_interpolation
    assert modifier.cache_file.filepath.startswith("//"), modifier.cache_file.filepath
    return sheet


def burnt_again():
    """What was burnt before into the same folder is not shown, though its object was deleted or kept elsewhere."""
    for keep in (False, True):
        scene = fresh(frames=10)
        curtain = add_curtain()
        assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
        first, = burning()
        assert values(evaluated(first, 10), "temperature_peak").max() > 700
        if keep:
            copy = first.copy()
            scene.collection.objects.link(copy)
        bpy.data.objects.remove(first)
        curtain.singe.lit_by = "NONE"
        assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
        second = next(o for o in burning() if not keep or o != copy)
        assert values(evaluated(second, 10), "temperature_peak").max() < 300, "an earlier burn is shown"


def speed_by_texture():
    """The black half of the sheet's picture stays; the white half burns."""
    scene = fresh(frames=20)
    curtain = add_curtain()
    image = bpy.data.images.new("speed", 8, 8, float_buffer=True)
    pixels = np.zeros((8, 8, 4), np.float32)
    pixels[:, 4:, :3], pixels[..., 3] = 1, 1
    image.pixels.foreach_set(pixels.ravel())
    own = curtain.singe
    own.lit_group = group(curtain, "side to side", lambda p: p.z < 0.151)
    own.rate_image, own.rate_low, own.rate_high = image, 1e-5, 0.016
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
    last = evaluated(burning()[0], 20)
    rest = np.empty(3 * len(last.vertices), np.float32)
    last.attributes["rest"].data.foreach_get("vector", rest)
    x, burnt = rest[::3], values(last, "burnt")
    assert burnt[x < -0.02].max() < 0.1 and burnt[x > 0.02].max() > 0.5, (burnt[x < -0.02].max(), burnt[x > 0.02].max())


def saved_and_moved(extension):
    """Without the extension the file shows the same; it renders, blurred by the cache's velocities."""
    bpy.ops.wm.save_mainfile()
    extension.unregister()
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, "scene.blend"))
    sheet, = burning()
    assert values(evaluated(sheet, 30), "temperature_peak").max() > 700
    add_view((0.05, -0.62, 0.3), (0, 0, 0.25))
    bpy.context.scene.frame_set(11)
    assert not embers(render("whole.png", 16)).any(), "embers on paper that is whole"
    bpy.context.scene.frame_set(27)
    sharp, again = render("curtain.png", 16), render("again.png", 16)
    blurred = render("blur.png", 16, blur=True)
    assert embers(sharp).sum() > 20, "no embers"
    noise, change = np.abs(sharp - again).mean(), np.abs(sharp - blurred).mean()
    assert change > 1e-4 + 5 * noise, (change, noise)
    extension.register()


def errors():
    """In words, in the scene's message; nothing is started."""
    scene = fresh()
    for prepare, expected in (
        (lambda: None, "no object is a sheet"),
        (lambda: add_curtain(), None),
        (lambda: setattr(bpy.data.objects["Curtain"].singe, "lit_group", "nothing"), "no vertex group 'nothing'"),
        (lambda: setattr(bpy.data.objects["Curtain"].singe, "lit_group", ""), "none is chosen"),
        (lambda: setattr(bpy.data.objects["Curtain"].singe, "lit_by", "OBJECT"), "lit by an object, but none"),
        (lambda: (setattr(bpy.data.objects["Curtain"].singe, "lit_by", "NONE"), open_collider()), "has holes"),
        (lambda: setattr(bpy.data.objects["Curtain"].singe, "rate_image", lost_image()), "cannot be saved"),
        (lambda: (setattr(bpy.data.objects["Curtain"].singe, "rate_image", bpy.data.images.new("speed", 4, 4)),
                  remove_uv(bpy.data.objects["Curtain"].data)), "no UV map"),
        (lambda: (setattr(bpy.data.objects["Curtain"].singe, "rate_image", None),
                  bpy.data.objects.remove(bpy.data.objects["Bowl"]),
                  setattr(bpy.data.objects["Curtain"].singe, "material", "FILE")), "no material file"),
        (lambda: (setattr(bpy.data.objects["Curtain"].singe, "material_file", bad_material()),), "bad.yaml:1"),
    ):
        prepare()
        if expected is None:
            continue
        try:
            result = bpy.ops.singe.burn()
        except RuntimeError as error:  # how a report of an error arrives in a script
            result = str(error)
        assert scene.singe.failed and expected in scene.singe.message, (expected, scene.singe.message, result)


def folders():
    """A burn leaves the folders of others alone, and so does Free Cache; the .blend file names no program."""
    scene = fresh(frames=4)
    add_curtain()
    scene.singe.folder = os.path.join(folder, "others")
    os.makedirs(os.path.join(folder, "others", "preview"))
    mine = os.path.join(folder, "others", "preview", "burn.yaml")
    with open(mine, "w") as file:
        file.write("mine\n")
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
    for call in (lambda: bpy.ops.singe.burn(preview=True), lambda: bpy.ops.singe.free()):
        try:
            call()
        except RuntimeError as error:
            assert "did not write" in str(error), error
    assert os.path.exists(mine) and not os.path.exists(os.path.join(folder, "others", "burn"))
    scene.singe.folder = mine
    try:
        bpy.ops.singe.burn()
        raise AssertionError("a file was taken for a folder")
    except RuntimeError as error:
        assert "Errno" not in str(error) and "ot a " in str(error), error
    assert not hasattr(scene.singe, "program")


def remove_uv(mesh):
    while mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[0])
    mesh.update_tag()


def lost_image():
    image = bpy.data.images.new("lost", 4, 4)
    image.source, image.filepath = "FILE", os.path.join(folder, "nowhere.png")
    return image


def bad_material():
    path = os.path.join(folder, "bad.yaml")
    with open(path, "w") as file:
        file.write("grammage: heavy\n")
    return path


def open_collider():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=6, radius=0.05)
    bowl = bpy.context.object
    bowl.name, bowl.singe.role = "Bowl", "COLLIDER"
    import bmesh
    edit = bmesh.new()
    edit.from_mesh(bowl.data)
    bmesh.ops.delete(edit, geom=[f for f in edit.faces if f.calc_center_median().z > 0.02], context="FACES")
    edit.to_mesh(bowl.data)
    edit.free()


def branch():
    """Frames up to the branch stay; a change after it shows; what cannot change leaves the burn as it was."""
    scene = fresh(frames=20, start=11)
    curtain = add_curtain()
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
    ply = os.path.join(folder, "cache", "burn", "cache", "ply", "burn.%04d.ply")
    before = [open(ply % frame, "rb").read() for frame in (6, 20)]
    scene.frame_set(16)
    assert bpy.ops.singe.burn(branch=True) == {"FINISHED"}, scene.singe.message
    assert before == [open(ply % frame, "rb").read() for frame in (6, 20)], "unchanged, it differs"
    scene.gravity = (1, 0, -9.81)
    assert bpy.ops.singe.burn(branch=True) == {"FINISHED"}, scene.singe.message
    after = [open(ply % frame, "rb").read() for frame in (6, 20)]
    assert before[0] == after[0] and before[1] != after[1]
    sheet, = burning()
    assert len(evaluated(sheet, 30).vertices)
    assert not os.path.exists(os.path.join(folder, "cache", "burn", "earlier"))
    curtain.singe.cell_size = 0.02
    for frame, expected in (16, "has changed since"), (30, "has no frame 30"):
        scene.frame_set(frame)
        try:
            bpy.ops.singe.burn(branch=True)
            raise AssertionError("it was branched")
        except RuntimeError:
            assert expected in scene.singe.message, scene.singe.message
        assert after == [open(ply % frame, "rb").read() for frame in (6, 20)]


def cancel_and_resume(extension):
    """A burn that is stopped leaves frames; resumed it has those of one that never was."""
    scene = fresh(frames=30)
    add_curtain()
    scene.singe.quality = "FINE"
    operators, job = extension.operators, extension.job

    class Hand(operators.Burning):
        pass

    hand = Hand()
    hand.begin_job(bpy.context, False, False)
    while hand.look(bpy.context) and hand.job.frames_done() < 6:
        time.sleep(0.02)
    bpy.ops.singe.cancel()
    assert not hand.end_job(bpy.context)
    done = job.frames_in(hand.job.cache)
    assert 6 <= done < 30 and "Resume continues" in scene.singe.message, (done, scene.singe.message)
    sheet, = burning()
    assert len(evaluated(sheet, done).vertices)
    assert job.can_resume(hand.job.cache, 30)
    assert bpy.ops.singe.burn(resume=True) == {"FINISHED"}, scene.singe.message
    assert job.frames_in(hand.job.cache) == 30
    resumed = values(evaluated(burning()[0], 30), "temperature_peak").copy()
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
    whole = values(evaluated(burning()[0], 30), "temperature_peak")
    assert (resumed == whole).all()
    bpy.ops.singe.free()
    assert not os.path.exists(hand.job.folder) and not burning() and not bpy.data.objects["Curtain"].hide_render


def suzanne():
    """Two sheets, a picture, a moving lighter, a deforming collider, wind, units in centimetres, and gas."""
    scene = fresh(frames=20)
    scene.unit_settings.scale_length = 0.01
    scene.singe.gas, scene.singe.gas_detail = True, 2
    bpy.ops.mesh.primitive_monkey_add(size=12, location=(0, 0, 8))
    monkey = bpy.context.object
    bpy.context.view_layer.update()
    own = monkey.singe
    own.role, own.material, own.cell_size = "SHEET", "office-paper", 0.5
    own.lit_by, own.rate_group = "OBJECT", group(monkey, "speed", lambda p: p.x > 0)
    own.pin_group = group(monkey, "held", lambda p: p.z < 4)
    picture = bpy.data.images.new("checks", 64, 64)
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[:, :, 1:3] = (np.indices((64, 64)).sum(0) // 8 % 2)[..., None] * 0.5 + 0.4
    picture.pixels.foreach_set(pixels.ravel())
    picture.pack()
    material = bpy.data.materials.new("print")
    material.use_nodes = True
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture
    material.node_tree.links.new(texture.outputs[0], material.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    monkey.data.materials.append(material)

    bpy.ops.object.empty_add(type="SPHERE", location=(7, -5, 6))
    match = bpy.context.object
    match.empty_display_size = 1.2
    match.keyframe_insert("location", frame=1)
    match.location = (3, -5, 9)
    match.keyframe_insert("location", frame=10)
    own.lit_object = match

    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=8, location=(0, 0, 16))
    leaf = bpy.context.object
    leaf.name, leaf.singe.role, leaf.singe.material, leaf.singe.cell_size = "Leaf", "SHEET", "tissue", 0.8
    bpy.ops.mesh.primitive_cube_add(size=4, location=(12, 0, 3))
    cube = bpy.context.object
    cube.singe.role = "COLLIDER"
    cube.shape_key_add(name="rest")
    key = cube.shape_key_add(name="tall")
    for point in key.data:
        point.co.z *= 2
    key.keyframe_insert("value", frame=1)
    key.value = 1
    key.keyframe_insert("value", frame=20)
    bpy.ops.mesh.primitive_plane_add(size=60, location=(0, 0, 0))
    bpy.context.object.singe.role = "COLLIDER"
    bpy.ops.object.effector_add(type="WIND", rotation=(0, math.pi / 2, 0), location=(-20, 0, 0))
    bpy.context.object.field.strength = 0.4
    assert bpy.ops.singe.burn() == {"FINISHED"}, scene.singe.message
    import json
    with open(os.path.join(folder, "cache", "burn", "burn.yaml")) as file:
        file.readline()  # the extension's mark
        written = json.load(file)
    path = written["sources"][0]["path"]
    assert len(path) == 20 and abs(path[9]["position"][2] - 0.09) < 1e-6
    assert abs(written["wind"]["velocity"][0] - 0.4) < 1e-3
    kinds = sorted(c["kind"] for c in written["colliders"])
    assert kinds == ["mesh", "plane"] and "motion" in next(c for c in written["colliders"] if c["kind"] == "mesh")
    sheets = burning()
    assert sorted(s.name for s in sheets) == ["Leaf burning", "Suzanne burning"], [s.name for s in sheets]
    paper = next(s for s in sheets if "Suzanne" in s.name)
    size = (np.array(paper.matrix_world)[:3, :3] @ points(evaluated(paper, 1)).T).max(1)
    assert 10 < size[2] < 16, size  # centimetres
    peak = values(evaluated(paper, 20), "temperature_peak")
    assert peak.max() > 700
    volume = next(o for o in bpy.data.objects if o.type == "VOLUME")
    bpy.context.scene.frame_set(15)
    grids = volume.data.grids
    assert grids.load() and "gas_detail" in grids.frame_filepath, (grids.frame_filepath, grids.error_message)
    add_view((16, -34, 18), (0, 0, 6), 60)
    bpy.context.scene.frame_set(18)
    render("suzanne.png", 12)


def preview_and_load():
    """A preview leaves the burn's folder alone; a cache made elsewhere is loaded alone."""
    scene = fresh(frames=10)
    add_curtain()
    assert bpy.ops.singe.burn(preview=True) == {"FINISHED"}, scene.singe.message
    assert os.path.exists(os.path.join(folder, "cache", "preview", "cache")), "no preview"
    cache = os.path.join(folder, "cache", "preview", "cache")
    scene = fresh(frames=10)
    assert bpy.ops.singe.load(directory=cache) == {"FINISHED"}
    assert len(evaluated(burning()[0], 10).vertices) > 0
    scene.render.fps = 30
    try:
        bpy.ops.singe.load(directory=cache)
        raise AssertionError("another frame rate was accepted")
    except RuntimeError as error:
        assert "24 frames a second" in str(error), error


def main():
    extension = install()
    for scenario in (curtain_burns, lambda: saved_and_moved(extension), errors, folders, burnt_again, speed_by_texture,
                     lambda: cancel_and_resume(extension), branch, preview_and_load, suzanne):
        begun = time.monotonic()
        scenario()
        name = scenario.__name__ if scenario.__name__ != "<lambda>" else "saved, cancelled or resumed"
        print(f"passed: {name} ({time.monotonic() - begun:.1f} s)", flush=True)
    print(f"Blender {bpy.app.version_string}: pictures in {folder}")


def run(scenarios):
    """Ends the process: with 1 if one of them fails."""
    try:
        scenarios()
        # bpy 4.5 may hang as it ends, after a volume was drawn
        sys.stdout.flush()
        os._exit(0)
    except Exception:
        import traceback
        traceback.print_exc()
        sys.stdout.flush()
        os._exit(1)


if __name__ == "__main__":
    run(main)
