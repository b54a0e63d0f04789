# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a burn, in the scene and in its objects, which the .blend file saves; and the program, which it must not
name: it is in the user's preferences."""

import bpy
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty)

MATERIALS = (
    ("office-paper", "Office paper", "80 g/m²: chars, curls and glows"),
    ("newsprint", "Newsprint", "45 g/m²: fast, grey ash"),
    ("tissue", "Tissue", "Burns at once"),
    ("cotton", "Cotton", "Cloth: slow, falls in folds"),
    ("FILE", "From a file", "Your own material, a YAML file"),
)


class ObjectSettings(bpy.types.PropertyGroup):
    role: EnumProperty(name="Singe", items=(
        ("NONE", "Nothing", "Singe ignores this object"),
        ("SHEET", "Sheet", "Cloth or paper that burns"),
        ("COLLIDER", "Collider", "Sheets rest on it and slide over it; it may move and deform")), default="NONE")
    material: EnumProperty(name="Material", items=MATERIALS, default="office-paper")
    material_file: StringProperty(name="File", subtype="FILE_PATH")
    cell_size: FloatProperty(name="Cell Size", description="The mesh is subdivided until its edges are this long",
                             default=0.005, min=1e-4, soft_min=1e-3, soft_max=0.05, subtype="DISTANCE", precision=4)
    lit_by: EnumProperty(name="Lit By", items=(
        ("NONE", "Nothing", "Only the fire of another sheet may light it"),
        ("GROUP", "Vertex group", "Where the group's weight is above a half"),
        ("OBJECT", "Object", "Where an object comes near, which may move")), default="NONE")
    lit_group: StringProperty(name="Group")
    lit_object: PointerProperty(name="Object", type=bpy.types.Object)
    lit_temperature: FloatProperty(name="Flame", description="Kelvin", default=1200, min=400, max=3000)
    lit_seconds: FloatProperty(name="For", description="Seconds from the first frame", default=1.5, min=0,
                               unit="TIME_ABSOLUTE")
    rate_group: StringProperty(
        name="Speed", description="Vertex group: the sheet burns slowly where its weight is 0, and fast where it is 1")
    rate_image: PointerProperty(
        name="Speed Texture", type=bpy.types.Image,
        description="By the mesh's UV map: the sheet burns slowly where it is black, and fast where it is white")
    rate_low: FloatProperty(name="Slow", description="Mass rate where the weight is 0 or the texture black, 1/(K s)",
                            default=0.002, min=0, precision=4)
    rate_high: FloatProperty(name="Fast", description="Mass rate where the weight is 1 or the texture white, 1/(K s)",
                             default=0.016, min=0, precision=4)
    pin_group: StringProperty(name="Pinned", description="Vertex group that is held and follows the object's animation")
    friction: FloatProperty(name="Friction", default=0.4, min=0, soft_max=1)


class SceneSettings(bpy.types.PropertyGroup):
    folder: StringProperty(name="Cache", subtype="DIR_PATH", default="//singe")
    quality: EnumProperty(name="Quality", items=(
        ("DRAFT", "Draft", "Few steps"), ("NORMAL", "Normal", "Enough for most sheets"),
        ("FINE", "Fine", "For stiff or fast sheets")), default="NORMAL")
    pace: FloatProperty(name="Pace", description="Seconds of fire in each second of the scene", default=4, min=0.01,
                        soft_max=20)
    gas: BoolProperty(name="Flames and Smoke", default=True)
    gas_detail: IntProperty(name="Detail", description="Draws the flames on voxels this many times finer",
                            default=2, min=1, max=4)
    contact: BoolProperty(name="Self Contact", default=True)
    tearing: BoolProperty(name="Tearing", default=True)
    creases: BoolProperty(name="Creases", description="Sharp bends leave creases", default=False)
    # state of a burn; not animated
    progress: FloatProperty(min=0, max=1, options={"SKIP_SAVE"})
    message: StringProperty()
    failed: BoolProperty()
    cache: StringProperty(description="The folder of the last burn")


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", subtype="FILE_PATH",
                            description="The program singe to run instead of the one that came with this extension")

    def draw(self, context):
        self.layout.prop(self, "program")


def chosen_program(context):
    """The program that the user's preferences name, or ''."""
    own = context.preferences.addons.get(__package__)
    return own.preferences.program if own else ""


CLASSES = (ObjectSettings, SceneSettings, Preferences)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.singe = PointerProperty(type=ObjectSettings)
    bpy.types.Scene.singe = PointerProperty(type=SceneSettings)


def unregister():
    del bpy.types.Object.singe, bpy.types.Scene.singe
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
