# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a Blender scene as a scene of Singe: meshes as PLY, everything else as JSON (which is YAML).

Singe's frame 1 is the scene's first frame. Lengths are in metres: Blender's units times the scene's unit scale.
"""

import json
import math
import os

import bpy
import numpy as np

from . import files, mesh as meshes

STEPS = {"DRAFT": (8, None), "NORMAL": (16, None), "FINE": (24, 16)}
SPOTS_MAX = 24
GROUPS = ("lit_group", "rate_group", "pin_group")


class ExportError(Exception):
    """An error that the user can fix, with a message for the user."""


def objects(scene, role):
    return [o for o in scene.objects if o.singe.role == role and o.type == "MESH"]


def first_mesh(scene, candidate):
    """The object's mesh at the current frame: modifiers applied, in world coordinates, m; a sheet's with the weights of
    the vertex groups that its settings name."""
    graph = bpy.context.evaluated_depsgraph_get()
    evaluated = candidate.evaluated_get(graph)
    data = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=graph)
    try:
        return _arrays(scene, candidate, evaluated, data)
    finally:
        evaluated.to_mesh_clear()


def _arrays(scene, candidate, evaluated, data):
    unit = scene.unit_settings.scale_length
    points = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", points)
    matrix = np.array(evaluated.matrix_world)
    with np.errstate(all="ignore"):
        points = (points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]) * unit
    if not np.isfinite(points).all():
        raise ExportError(f"'{candidate.name}' has a vertex whose place is no number")
    if not len(data.polygons):
        raise ExportError(f"'{candidate.name}' has no faces")
    corners, sizes = np.empty(len(data.loops), np.int32), np.empty(len(data.polygons), np.int32)
    data.loops.foreach_get("vertex_index", corners)
    data.polygons.foreach_get("loop_total", sizes)
    uv = None
    if data.uv_layers.active:
        uv = np.empty(2 * len(data.loops), np.float32)
        data.uv_layers.active.uv.foreach_get("vector", uv)
    weights = {}
    for setting in GROUPS:
        name = getattr(candidate.singe, setting)
        if name and candidate.singe.role == "SHEET":
            weights[setting] = _weights(candidate, data, name)
    return meshes.Mesh(points, corners, sizes, uv, weights)


def _weights(candidate, data, name):
    group = candidate.vertex_groups.get(name)
    if not group:
        raise ExportError(f"'{candidate.name}' has no vertex group '{name}'")
    values = np.zeros(len(data.vertices))
    for vertex in data.vertices:
        for membership in vertex.groups:
            if membership.group == group.index:
                values[vertex.index] = membership.weight
    return values


def moves(candidate):
    """Whether the object or its mesh may change over time."""
    chain = candidate
    while chain:
        if chain.animation_data and (chain.animation_data.action or chain.animation_data.drivers) or chain.constraints:
            return True
        chain = chain.parent
    data = candidate.data
    keys = data.shape_keys if data else None
    deforming = {"ARMATURE", "LATTICE", "HOOK", "MESH_DEFORM", "MESH_SEQUENCE_CACHE", "NODES", "WAVE", "SHRINKWRAP",
                 "SURFACE_DEFORM", "CURVE", "SIMPLE_DEFORM", "CLOTH", "SOFT_BODY"}
    return bool(keys and keys.animation_data) or any(m.type in deforming and m.show_render for m in candidate.modifiers)


class Exporter:
    """Writes the files of a burn into a folder, in one pass over `frames` for everything that moves."""

    def __init__(self, context, folder, preview=False):
        self.scene, self.folder, self.preview = context.scene, folder, preview
        self.settings = context.scene.singe
        self.unit = context.scene.unit_settings.scale_length
        self.fps = context.scene.render.fps / context.scene.render.fps_base
        self.frames = range(context.scene.frame_start, context.scene.frame_end + 1)
        self.moving, self.followed, self.paths = [], [], []
        self.made = set()  # names of files

    def write(self):
        """Writes all files; those of an earlier burn that are no longer needed go. If it fails, so do those that it has
        made."""
        sheets = objects(self.scene, "SHEET")
        if not sheets:
            raise ExportError("no object is a sheet: set Singe to Sheet in an object's Physics tab")
        files.take(self.folder)
        before = files.inputs(self.folder)
        try:
            self._write(sheets)
        except BaseException:
            self._remove(self.made - before)
            raise
        self._remove(before - self.made)

    def _write(self, sheets):
        now = self.scene.frame_current
        try:
            self.scene.frame_set(self.frames.start)
            document = self._document(sheets)
            self._walk()
        finally:
            self.scene.frame_set(now)
        path = os.path.join(self.folder, files.SCENE)
        with files.create(path + ".part") as file:
            file.write((files.MARK + json.dumps(document, indent=1)).encode())
        os.replace(path + ".part", path)

    def _made(self, name):
        """The path of a file that is about to be made."""
        self.made.add(name)
        return os.path.join(self.folder, name)

    def _remove(self, names):
        for name in names:
            files.remove(os.path.join(self.folder, name))

    def _document(self, sheets):
        settings, scene = self.settings, self.scene
        steps, substeps = STEPS["DRAFT" if self.preview else settings.quality or "NORMAL"]
        document = {"name": "burn", "frames": len(self.frames), "fps": self.fps, "steps": steps, "pace": settings.pace,
                    "gravity": [float(g) for g in scene.gravity] if scene.use_gravity else [0, 0, 0],
                    "contact": {"enabled": settings.contact}, "tearing": settings.tearing,
                    "creases": settings.creases, "output": {"formats": ["ply", "usd"]},
                    "checkpoints": {"every": 10, "megabytes": 1000},
                    "sheets": [], "sources": [], "pins": [], "colliders": []}
        if substeps:
            document["solver"] = {"substeps": substeps}
        gas = settings.gas and not self.preview
        document["gas"] = {"detail": settings.gas_detail} if gas else {"enabled": False}
        for sheet in sheets:
            self._sheet(document, sheet)
        for collider in objects(scene, "COLLIDER"):
            document["colliders"].append(self._collider(collider))
        wind = self._wind()
        if wind:
            document["wind"] = wind
        return document

    def _save_texture(self, image, sheet, name):
        """Saves the image next to the scene file, as a PNG: the image in Blender may be edited, packed or of another
        format."""
        scene = bpy.data.scenes.new("singe texture")  # so that the user's render settings remain
        try:
            scene.view_settings.view_transform = "Raw"
            scene.render.image_settings.file_format = "PNG"
            scene.render.image_settings.color_mode = "RGB"
            path = self._made(name)
            files.remove(path)
            image.save_render(path, scene=scene)
        except RuntimeError as error:
            raise ExportError(f"'{sheet.name}': the speed texture '{image.name}' cannot be saved: {error}") from None
        finally:
            bpy.data.scenes.remove(scene)

    # sheets

    def _sheet(self, document, sheet):
        own = sheet.singe
        mesh = first_mesh(self.scene, sheet)
        mesh = meshes.refine(mesh, (2.5 if self.preview else 1) * own.cell_size * self.unit)
        name = f"sheet{len(document['sheets'])}"
        file = f"{name}.ply"
        entry = {"name": name, "mesh": file, "material": self._material(sheet, mesh, f"{name}-speed.png")}
        if own.lit_by == "GROUP":
            document["sources"] += self._lit_group(sheet, mesh)
        elif own.lit_by == "OBJECT":
            document["sources"].append(self._lit_object(sheet))
        if own.pin_group:
            document["pins"].append(self._pin(sheet, mesh, entry["name"]))
        rate = mesh.weights.get("rate_group")
        mesh.weights = {} if rate is None else {"speed": np.clip(rate, 0, 1)}
        meshes.write_ply(self._made(file), mesh)
        document["sheets"].append(entry)

    def _material(self, sheet, mesh, texture):
        own = sheet.singe
        material = {"base": own.material or "office-paper"}
        if own.material == "FILE":
            path = bpy.path.abspath(own.material_file)
            if not os.path.isfile(path):
                raise ExportError(f"'{sheet.name}' has no material file {path or '(none chosen)'}")
            material["base"] = path
        if "rate_group" in mesh.weights:
            material["mass_rate"] = {"from": own.rate_low, "to": own.rate_high, "attribute": "speed"}
        elif own.rate_image:
            if mesh.uv is None:
                raise ExportError(f"'{sheet.name}' has a speed texture but no UV map: unwrap its mesh")
            material["mass_rate"] = {"from": own.rate_low, "to": own.rate_high,
                                     "texture": texture}
            self._save_texture(own.rate_image, sheet, texture)
        return material

    def _lit_group(self, sheet, mesh):
        if not sheet.singe.lit_group:
            raise ExportError(f"'{sheet.name}' is lit by a vertex group, but none is chosen")
        points = mesh.points[mesh.weights["lit_group"] > 0.5]
        if not len(points):
            raise ExportError(f"no vertex of '{sheet.name}' has a weight above 0.5 in '{sheet.singe.lit_group}'")
        chosen, reach = meshes.spread(points, SPOTS_MAX)
        radius = max(reach, 1.5 * mesh.edge_length(), 0.003)
        return [{"kind": "spot", "position": points[i].tolist(), "radius": radius, "falloff": radius,
                 "temperature": sheet.singe.lit_temperature, "conductance": 300, "end": self._burn_end(sheet)}
                for i in chosen]

    def _burn_end(self, sheet):
        # as Blender scales times by the frame rate, seconds are those of the scene
        return max(float(sheet.singe.lit_seconds), 1e-3)

    def _lit_object(self, sheet):
        lighter = sheet.singe.lit_object
        if not lighter:
            raise ExportError(f"'{sheet.name}' is lit by an object, but none is chosen")
        source = {"kind": "ball", "temperature": sheet.singe.lit_temperature, "conductance": 300,
                  "end": self._burn_end(sheet), "radius": self._radius(lighter)}
        source["falloff"] = max(source["radius"], 0.01)
        if moves(lighter):
            self.paths.append((lighter, source, False))
        else:
            source["position"] = self._position(lighter)
        return source

    def _radius(self, lighter):
        size = [abs(d) for d in lighter.dimensions] if lighter.type == "MESH" else [lighter.empty_display_size * 2] * 3
        return max(0.5 * sum(size) / 3 * self.unit, 1e-3)

    def _position(self, candidate):
        return [self.unit * float(x) for x in candidate.matrix_world.translation]

    def _pin(self, sheet, mesh, name):
        held = np.flatnonzero(mesh.weights["pin_group"] > 0.5)
        if not len(held):
            raise ExportError(f"no vertex of '{sheet.name}' has a weight above 0.5 in '{sheet.singe.pin_group}'")
        pin = {"sheet": name, "vertices": held.tolist()}
        if moves(sheet):
            pin["motion"] = {"mesh": f"{name}-pin.####.ply"}
            self.followed.append((sheet, f"{name}-pin", False))
        return pin

    # colliders and wind

    def _collider(self, collider):
        mesh = first_mesh(self.scene, collider)
        file = f"collider-{len(self.moving) + len(self.paths)}-{collider.as_pointer():x}"
        entry = {"friction": collider.singe.friction}
        if not mesh.is_closed() and mesh.is_flat():
            if moves(collider):
                raise ExportError(f"'{collider.name}' is a flat collider that moves: give it a thickness")
            return {**entry, "kind": "plane", "position": mesh.points.mean(0).tolist(), "rotation": _plane_angles(mesh)}
        if not mesh.is_closed():
            raise ExportError(f"the collider '{collider.name}' has holes: close its mesh, or make it a flat plane")
        entry["kind"] = "mesh"
        if moves(collider):
            entry["motion"] = {"mesh": f"{file}.####.ply"}
            self.moving.append((collider, file))
        else:
            entry["mesh"] = f"{file}.ply"
            meshes.write_ply(self._made(f"{file}.ply"), mesh)
        return entry

    def _wind(self):
        """The sum of the scene's wind force fields. Each blows along its local z axis, with its strength in m/s."""
        velocity, gust = np.zeros(3), 0.0
        for candidate in self.scene.objects:
            field = candidate.field
            if field and field.type == "WIND" and not candidate.hide_render:
                axis = np.array(candidate.matrix_world)[:3, 2]
                velocity += field.strength * axis / max(np.linalg.norm(axis), 1e-12)
                gust = max(gust, field.noise)
        if not velocity.any() and not gust:
            return None
        return {"velocity": velocity.tolist(), "gust": float(gust)}

    # moving objects

    def _walk(self):
        """Writes the meshes and paths of everything that moves, in one pass over the frames."""
        if not (self.moving or self.followed or self.paths):
            return
        keys = {index: [] for index in range(len(self.paths))}
        for number, frame in enumerate(self.frames):
            self.scene.frame_set(frame)
            for candidate, file, *_ in (*self.moving, *self.followed):
                mesh = first_mesh(self.scene, candidate)
                mesh.uv, mesh.weights = None, {}
                meshes.write_ply(self._made(f"{file}.{number + 1:04}.ply"), mesh)
            for index, (candidate, *_) in enumerate(self.paths):
                keys[index].append({"time": number / self.fps, "position": self._position(candidate)})
        for index, (_, entry, _) in enumerate(self.paths):
            entry["path"] = keys[index]


def _plane_angles(mesh):
    """Rotation about x, y, z, degrees, that turns +z to the plane's normal, on the front of its faces."""
    normal = np.zeros(3)
    following = mesh.next_corners()
    for a, b in zip(mesh.points[mesh.corners], mesh.points[mesh.corners[following]]):
        normal += np.cross(a - mesh.points[0], b - mesh.points[0])
    normal /= np.linalg.norm(normal)
    return [math.degrees(math.asin(-normal[1])), math.degrees(math.atan2(normal[0], normal[2])), 0.0]
