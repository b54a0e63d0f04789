# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of burning paper and cloth, from the cache's attributes, and of the gas. Their nodes need no extension."""

import bpy

# `temperature_peak` at which paper begins to brown, and at which it is black, K
BROWN, BLACK = 470.0, 640.0
# the flame's emission per metre where `flame` is 1 (docs/blender.md)
FLAME_LIGHT = 118.0
# strength of `ember`, high enough for embers to be visible next to a lit sheet
EMBER_LIGHT = 1.5


def _node(tree, kind, location, **values):
    node = tree.nodes.new(kind)
    node.location = location
    for name, value in values.items():
        if name in node.inputs:
            node.inputs[name].default_value = value
        else:
            setattr(node, name, value)
    return node


def _attribute(tree, name, location):
    return _node(tree, "ShaderNodeAttribute", location, attribute_name=name)


def _math(tree, operation, location, *operands):
    node = _node(tree, "ShaderNodeMath", location, operation=operation)
    for i, operand in enumerate(operands):
        if isinstance(operand, (int, float)):
            node.inputs[i].default_value = operand
        else:
            tree.links.new(operand, node.inputs[i])
    return node.outputs[0]


def _range(tree, value, low, high, location):
    node = _node(tree, "ShaderNodeMapRange", location)
    node.inputs[1].default_value, node.inputs[2].default_value = low, high
    tree.links.new(value, node.inputs[0])
    return node.outputs[0]


def _mix(tree, share, a, b, location):
    node = _node(tree, "ShaderNodeMix", location, data_type="RGBA")
    tree.links.new(share, node.inputs[0])
    for socket, value in ((node.inputs[6], a), (node.inputs[7], b)):
        if isinstance(value, tuple):
            socket.default_value = value
        else:
            tree.links.new(value, socket)
    return node.outputs[2]


def base_of(sheet):
    """The picture and the colour of an object's own material: (image or None, (r, g, b, 1))."""
    for slot in sheet.material_slots if sheet else ():
        if not slot.material or not slot.material.node_tree:
            continue
        for node in slot.material.node_tree.nodes:
            if node.type != "BSDF_PRINCIPLED":
                continue
            socket = node.inputs["Base Color"]
            for link in socket.links:
                if link.from_node.type == "TEX_IMAGE" and link.from_node.image:
                    return link.from_node.image, (1, 1, 1, 1)
            return None, tuple(socket.default_value)
    return None, (0.86, 0.82, 0.74, 1)


def sheet_material(name, image, colour):
    """Paper or cloth: its picture or colour, browned and blackened by its peak temperature, grey ash, and embers."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    links = tree.links

    fresh = colour
    if image:
        picture = _node(tree, "ShaderNodeTexImage", (-900, 300), image=image)
        links.new(_attribute(tree, "st", (-1100, 300)).outputs["Vector"], picture.inputs["Vector"])
        fresh = picture.outputs["Color"]

    peak = _attribute(tree, "temperature_peak", (-1100, 0)).outputs["Fac"]
    burnt = _attribute(tree, "burnt", (-1100, -200)).outputs["Fac"]
    ash = _attribute(tree, "ash_fraction", (-1100, -400)).outputs["Fac"]
    brown = _mix(tree, _range(tree, peak, BROWN, 0.5 * (BROWN + BLACK), (-700, 0)), fresh, (0.10, 0.042, 0.014, 1),
                 (-500, 200))
    black = _mix(tree, _range(tree, peak, 0.5 * (BROWN + BLACK), BLACK, (-700, -150)), brown, (0.012, 0.010, 0.009, 1),
                 (-300, 200))
    fine = _node(tree, "ShaderNodeTexNoise", (-900, -600), Scale=900.0, Detail=4.0)
    links.new(_attribute(tree, "rest", (-1100, -600)).outputs["Vector"], fine.inputs["Vector"])
    speckled = _math(tree, "MULTIPLY", (-700, -450), ash, _math(tree, "ADD", (-700, -600), fine.outputs[0], 0.5))
    grey = _range(tree, speckled, 0.05, 0.16, (-500, -400))
    coloured = _mix(tree, grey, black, (0.30, 0.29, 0.28, 1), (-100, 200))

    # embers: hot char glows in patches, where air reaches it. `ember` is the cache's colour of that glow. The attribute
    # `temperature` cannot be used: Cycles reserves the name for volumes, and reads 0 for meshes
    ember = _attribute(tree, "ember", (-1100, -800)).outputs["Color"]
    patches = _node(tree, "ShaderNodeTexNoise", (-900, -900), Scale=220.0, Detail=5.0, Roughness=0.7)
    links.new(_attribute(tree, "rest", (-1100, -1000)).outputs["Vector"], patches.inputs["Vector"])
    glow = _math(tree, "MULTIPLY", (-300, -900), _range(tree, burnt, 0.15, 0.4, (-700, -750)),
                 _range(tree, patches.outputs[0], 0.46, 0.68, (-500, -900)))

    paper = _node(tree, "ShaderNodeBsdfPrincipled", (150, 200), Roughness=0.85)
    paper.inputs["Specular IOR Level"].default_value = 0.1
    links.new(coloured, paper.inputs["Base Color"])
    links.new(ember, paper.inputs["Emission Color"])
    links.new(_math(tree, "MULTIPLY", (-100, -800), glow, EMBER_LIGHT), paper.inputs["Emission Strength"])
    through = _node(tree, "ShaderNodeBsdfTranslucent", (150, -150))
    links.new(coloured, through.inputs["Color"])
    mixed = _node(tree, "ShaderNodeMixShader", (400, 200))
    # burnt parts transmit no light
    links.new(_math(tree, "MULTIPLY", (150, 400), _math(tree, "SUBTRACT", (-50, 400), 1.0, burnt), 0.22),
              mixed.inputs["Fac"])
    links.new(paper.outputs[0], mixed.inputs[1])
    links.new(through.outputs[0], mixed.inputs[2])
    output = _node(tree, "ShaderNodeOutputMaterial", (600, 200))
    links.new(mixed.outputs[0], output.inputs["Surface"])
    return material


def fire_material():
    """Smoke from `density`, light from `flame`. All burns of a file share this material."""
    material = bpy.data.materials.get("Singe Fire")
    if material:
        return material
    material = bpy.data.materials.new("Singe Fire")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    volume = _node(tree, "ShaderNodeVolumePrincipled", (200, 0))
    volume.inputs["Color"].default_value = (0.05, 0.05, 0.05, 1)
    flame = _attribute(tree, "flame", (-600, -100)).outputs["Fac"]
    # orange at the edge, yellow inside
    hue = _node(tree, "ShaderNodeMix", (-150, -250), data_type="RGBA")
    hue.inputs[6].default_value, hue.inputs[7].default_value = (1, 0.22, 0.03, 1), (1, 0.45, 0.12, 1)
    tree.links.new(_range(tree, flame, 0.0, 0.5, (-350, -250)), hue.inputs[0])
    tree.links.new(hue.outputs[2], volume.inputs["Emission Color"])
    tree.links.new(_math(tree, "MULTIPLY", (-350, -100), flame, FLAME_LIGHT), volume.inputs["Emission Strength"])
    output = _node(tree, "ShaderNodeOutputMaterial", (500, 0))
    tree.links.new(volume.outputs[0], output.inputs["Volume"])
    return material
