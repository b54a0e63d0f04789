# SPDX-License-Identifier: GPL-3.0-or-later
"""The object's panel, in the Physics tab, and the burn's panel, there and in the sidebar."""

import os

import bpy

from . import export, files, job, operators


def draw_sheet(layout, candidate):
    own = candidate.singe
    layout.prop(own, "material")
    if own.material == "FILE":
        layout.prop(own, "material_file")
    layout.prop(own, "cell_size")
    layout.prop(own, "lit_by")
    if own.lit_by == "GROUP":
        layout.prop_search(own, "lit_group", candidate, "vertex_groups")
    elif own.lit_by == "OBJECT":
        layout.prop(own, "lit_object")
    if own.lit_by != "NONE":
        layout.prop(own, "lit_temperature")
        layout.prop(own, "lit_seconds")
    layout.prop_search(own, "rate_group", candidate, "vertex_groups")
    if not own.rate_group:
        layout.prop(own, "rate_image")
    if own.rate_group or own.rate_image:
        row = layout.row(align=True)
        row.prop(own, "rate_low")
        row.prop(own, "rate_high")
    layout.prop_search(own, "pin_group", candidate, "vertex_groups")


def draw_burn(layout, context):
    scene = context.scene
    own = scene.singe
    running = bool(job.RUNNING)
    column = layout.column()
    column.enabled = not running
    for name in ("folder", "quality", "pace", "gas"):
        column.prop(own, name)
    if own.gas:
        column.prop(own, "gas_detail")
    row = column.row()
    for name in ("contact", "tearing", "creases"):
        row.prop(own, name)
    sheets = len(export.objects(scene, "SHEET"))
    layout.label(text=f"{sheets} sheet{'' if sheets == 1 else 's'}, frames {scene.frame_start} to {scene.frame_end}")
    if running:
        layout.progress(factor=own.progress, text=own.message)
        layout.operator("singe.cancel", icon="CANCEL")
    else:
        row = layout.row(align=True)
        row.operator("singe.burn", icon="PLAY")
        row.operator("singe.burn", text="Preview").preview = True
        draw_resume(layout, scene)
        draw_branch(layout, scene)
        row = layout.row(align=True)
        row.operator("singe.load", icon="FILE_FOLDER")
        row.operator("singe.free", icon="TRASH")
        for i, line in enumerate(own.message.splitlines()):
            layout.label(text=line, icon="ERROR" if own.failed and i == 0 else "NONE")


def draw_resume(layout, scene):
    try:
        cache = os.path.join(operators.burn_folder(scene), "cache")
    except export.ExportError:
        return
    if files.is_own(os.path.dirname(cache)) and job.can_resume(cache, operators.frame_count(scene)):
        layout.operator("singe.burn", text=f"Resume from Frame {job.frames_in(cache)}").resume = True


def draw_branch(layout, scene):
    try:
        folder = operators.burn_folder(scene)
    except export.ExportError:
        return
    there = job.can_branch(os.path.join(folder, files.CACHE), operators.branch_frame(scene), operators.frame_count(scene))
    if there and files.is_own(folder):
        layout.operator("singe.burn", text="Branch Here", icon="PLAY").branch = True


class SINGE_PT_object(bpy.types.Panel):
    bl_label = "Singe"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "physics"

    @classmethod
    def poll(cls, context):
        return context.object and context.object.type == "MESH"

    def draw(self, context):
        self.layout.use_property_split = True
        own = context.object.singe
        self.layout.prop(own, "role")
        if own.role == "SHEET":
            draw_sheet(self.layout, context.object)
        elif own.role == "COLLIDER":
            self.layout.prop(own, "friction")


class SINGE_PT_burn(bpy.types.Panel):
    bl_label = "Burn"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "physics"
    bl_parent_id = "SINGE_PT_object"

    def draw(self, context):
        self.layout.use_property_split = True
        draw_burn(self.layout, context)


class SINGE_PT_sidebar(bpy.types.Panel):
    bl_label = "Burn"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Singe"

    def draw(self, context):
        self.layout.use_property_split = True
        draw_burn(self.layout, context)


CLASSES = (SINGE_PT_object, SINGE_PT_burn, SINGE_PT_sidebar)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
