# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads a cache into the scene: each sheet as a Mesh Sequence Cache of the USD, the gas as a volume. These are features
of Blender itself, so the result renders without this extension."""

import os

import bpy

from . import export, job, materials

COLLECTION = "Singe"


class LoadError(Exception):
    """An error that the user can fix, with a message for the user."""


def relative(path):
    """The path relative to the .blend file, if there is one, so that both can be moved together."""
    try:
        return bpy.path.relpath(path) if bpy.data.filepath else path
    except ValueError:  # another drive
        return path


def collection_of(context, cache):
    """The collection of a cache, created if necessary. It stores the cache's folder."""
    for collection in bpy.data.collections:
        if collection.get("singe_cache") == os.path.abspath(cache):
            return collection
    collection = bpy.data.collections.new(COLLECTION)
    collection["singe_cache"] = os.path.abspath(cache)
    context.scene.collection.children.link(collection)
    return collection


def clear(context, cache):
    """Removes from the scene everything loaded from a cache, and shows all sheets again."""
    for collection in [c for c in bpy.data.collections if c.get("singe_cache") == os.path.abspath(cache)]:
        for loaded in list(collection.objects):
            data = loaded.data
            if not isinstance(data, (bpy.types.Volume, bpy.types.Mesh)):  # a user's lamp, for example
                if loaded.name not in context.scene.collection.objects:
                    context.scene.collection.objects.link(loaded)
                continue
            bpy.data.objects.remove(loaded)
            if data.users == 0:
                (bpy.data.volumes if isinstance(data, bpy.types.Volume) else bpy.data.meshes).remove(data)
        bpy.data.collections.remove(collection)
    _close(context, cache)
    for sheet in export.objects(context.scene, "SHEET"):
        _hide(context, sheet, False)


def _hide(context, sheet, hidden):
    sheet.hide_render = hidden
    if sheet.name in context.view_layer.objects:  # not if its collection is left out of it
        sheet.hide_set(hidden)


def _close(context, cache):
    """OpenUSD shares open files: a file kept open would show frames of an earlier burn in a later one."""
    folder = os.path.abspath(cache)
    for file in list(bpy.data.cache_files):
        if os.path.dirname(os.path.abspath(bpy.path.abspath(file.filepath))) != folder:
            continue
        if file.users == 0:
            bpy.data.batch_remove([file])
        else:  # used by an object that was copied out of the collection, for example
            _reload(context, file)


def _reload(context, file):
    with context.temp_override(edit_cachefile=file):
        bpy.ops.cachefile.reload()


def load(context, cache):
    """Loads a cache anew: makes objects for the sheets and the gas. Returns the number of frames."""
    found = job.root_of(cache)
    if not found:
        raise LoadError(f"{cache} has no USD: run singe convert --to usd, or add usd to the formats of its scene")
    root, gas, fps = found
    scene = context.scene
    if abs(scene.render.fps / scene.render.fps_base - fps) > 1e-3:
        raise LoadError(f"the cache has {fps:g} frames a second: set the scene's frame rate to it")
    clear(context, cache)
    collection = collection_of(context, cache)
    sheets = []
    try:
        sheets = _import_sheets(context, root, collection)
    finally:
        if not sheets:
            bpy.data.collections.remove(collection)
    if not sheets:
        raise LoadError(f"{root} has no sheets")
    _dress(context, sheets)
    if gas:
        _add_gas(context, collection, gas, job.frames_in(cache))
    context.scene.singe.cache = relative(cache)
    return job.frames_in(cache)


def _import_sheets(context, root, collection):
    before, files = set(bpy.data.objects), set(bpy.data.cache_files)
    chosen = context.selected_objects[:]
    active = context.view_layer.objects.active
    start, end = context.scene.frame_start, context.scene.frame_end
    bpy.ops.wm.usd_import(filepath=root, import_cameras=False, import_lights=False, import_materials=False,
                          import_volumes=False, import_curves=False, set_frame_range=False)
    context.scene.frame_start, context.scene.frame_end = start, end
    made = [o for o in bpy.data.objects if o not in before]
    sheets = [o for o in made if any(m.type == "MESH_SEQUENCE_CACHE" for m in o.modifiers)
              and "/sheets/" in next(m.object_path for m in o.modifiers if m.type == "MESH_SEQUENCE_CACHE")]
    unit = context.scene.unit_settings.scale_length
    for o in made:
        if o not in sheets:
            bpy.data.objects.remove(o)
    for sheet in sheets:
        world = sheet.matrix_world.copy()
        sheet.parent = None
        sheet.matrix_world = world
        sheet.scale = [s / unit for s in sheet.scale]
        for user in list(sheet.users_collection):
            user.objects.unlink(sheet)
        collection.objects.link(sheet)
    for file in bpy.data.cache_files:
        if file not in files:
            file.filepath = relative(root)
            # Singe's frame 1 is the scene's first frame
            file.frame_offset = float(context.scene.frame_start - 1)
    for o in chosen:
        o.select_set(True)
    context.view_layer.objects.active = active
    return sheets


def _dress(context, loaded):
    """Gives the loaded sheets materials, made from those of their source objects, and hides the source objects."""
    sources = export.objects(context.scene, "SHEET")
    for i, sheet in enumerate(sorted(loaded, key=lambda o: o.name)):
        source = sources[i] if i < len(sources) else None
        image, colour = materials.base_of(source)
        sheet.name = f"{source.name} burning" if source else "Sheet burning"
        sheet.data.materials.clear()
        sheet.data.materials.append(materials.sheet_material(f"Singe {sheet.name}", image, colour))
        for modifier in sheet.modifiers:
            if modifier.type == "MESH_SEQUENCE_CACHE":
                modifier.use_vertex_interpolation = False  # each frame has its own vertices
        if source:
            _hide(context, source, True)


def _add_gas(context, collection, path, frames):
    volume = bpy.data.volumes.new("Singe Gas")
    volume.filepath = relative(path)
    volume.is_sequence = True
    volume.frame_start, volume.frame_offset = context.scene.frame_start, 0
    volume.frame_duration = max(frames, 1)
    volume.sequence_mode = "CLIP"
    volume.velocity_unit = "SECOND"
    if os.path.basename(os.path.dirname(path)) == "gas":  # the finer gas has no velocity
        volume.velocity_grid = "velocity"
    volume.materials.append(materials.fire_material())
    gas = bpy.data.objects.new("Singe Gas", volume)
    gas.scale = [1 / context.scene.unit_settings.scale_length] * 3
    collection.objects.link(gas)


def grow(context, cache):
    """Loads frames written since: reads the root again, and extends the gas. Returns the number of frames."""
    frames = job.frames_in(cache)
    for collection in bpy.data.collections:
        if collection.get("singe_cache") != os.path.abspath(cache):
            continue
        for loaded in collection.objects:
            if loaded.type == "VOLUME":
                loaded.data.frame_duration = max(frames, 1)
            for modifier in loaded.modifiers:
                if modifier.type == "MESH_SEQUENCE_CACHE" and modifier.cache_file:
                    _reload(context, modifier.cache_file)
    return frames


def is_loaded(cache):
    return any(c.get("singe_cache") == os.path.abspath(cache) and c.objects for c in bpy.data.collections)
