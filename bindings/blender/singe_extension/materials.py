# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of burning paper and cloth, from the cache's attributes, and of the gas. Their nodes need no extension."""

import math

import bpy

# paper browns by its peak temperature from BROWN to CHAR, K, in the logarithm of what it is above the room's
ROOM, BROWN, CHAR = 293.0, 348.0, 653.0
# how much of each colour is left as paper scorches, from fresh to charred (program/formats/burn_colour.c)
SCORCH = ((0, (1, 1, 1)), (0.14, (0.965, 0.90, 0.74)), (0.32, (0.85, 0.655, 0.36)), (0.50, (0.55, 0.315, 0.105)),
          (0.69, (0.225, 0.098, 0.032)), (0.86, (0.062, 0.031, 0.018)), (1, (0.020, 0.016, 0.014)))
SOOT, INK_ON_CHAR, ASH = (0.012, 0.0105, 0.0095, 1), (0.05, 0.048, 0.046, 1), (0.34, 0.33, 0.315, 1)
# the flame's emission per metre where `flame` is 1 (docs/blender.md), and how much more its hottest core emits
FLAME_LIGHT, FLAME_CORE = 218.0, 7.0
# strength of `ember` in its cracks, whose skin is some 110 K hotter than the sheet's mean, and between them
EMBER_CRACKS, EMBER_CRUST = 14.0, 0.3


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


def _ramp(tree, value, stops, location):
    node = _node(tree, "ShaderNodeValToRGB", location)
    ramp = node.color_ramp
    while len(ramp.elements) < len(stops):
        ramp.elements.new(1.0)
    for element, (position, colour) in zip(ramp.elements, stops):
        element.position, element.color = position, (*colour, 1)
    tree.links.new(value, node.inputs[0])
    return node.outputs[0]


def _noise(tree, rest, scale, detail, location):
    node = _node(tree, "ShaderNodeTexNoise", location, Scale=scale, Detail=detail, Roughness=0.6)
    tree.links.new(rest, node.inputs["Vector"])
    return node.outputs[0]


def _scorched(tree, peak, burnt, noise):
    """0 fresh to 1 charred, by the peak temperature and the burnt share, as in program/formats/burn_colour.c."""
    above = _math(tree, "MAXIMUM", (-1500, 100), _math(tree, "SUBTRACT", (-1650, 100), peak, ROOM), BROWN - ROOM)
    by_heat = _math(tree, "LOGARITHM", (-1350, 100), _math(tree, "DIVIDE", (-1500, 0), above, BROWN - ROOM), math.e)
    by_heat = _range(tree, by_heat, 0, math.log((CHAR - ROOM) / (BROWN - ROOM)), (-1200, 100))
    by_heat = _math(tree, "MULTIPLY", (-1050, 100), by_heat, 0.76)
    left = _math(tree, "EXPONENT", (-1200, -50), _math(tree, "MULTIPLY", (-1350, -50), burnt, -7.5))
    scorched = _math(tree, "SUBTRACT", (-750, 50), 1.0,
                     _math(tree, "MULTIPLY", (-900, 0), _math(tree, "SUBTRACT", (-900, 100), 1.0, by_heat), left))
    # uneven where it is browning, not where it is fresh
    uneven = _math(tree, "ADD", (-750, -100), _math(tree, "MULTIPLY", (-900, -150), noise, 0.7), 0.65)
    return _math(tree, "MINIMUM", (-600, 50), _math(tree, "MULTIPLY", (-650, 0), scorched, uneven), 1.0)


def sheet_material(name, image, colour):
    """Paper or cloth: its picture or colour, scorched, black char on which ink is still seen, grey ash, and embers."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    links = tree.links

    fresh, ink = colour, None
    if image:
        picture = _node(tree, "ShaderNodeTexImage", (-900, 500), image=image)
        links.new(_attribute(tree, "st", (-1100, 500)).outputs["Vector"], picture.inputs["Vector"])
        fresh = picture.outputs["Color"]
        grey = _node(tree, "ShaderNodeRGBToBW", (-700, 600))
        links.new(fresh, grey.inputs[0])
        ink = _range(tree, grey.outputs[0], 0.55, 0.1, (-500, 600))

    rest = _attribute(tree, "rest", (-1900, -500)).outputs["Vector"]
    peak = _attribute(tree, "temperature_peak", (-1900, 100)).outputs["Fac"]
    burnt = _attribute(tree, "burnt", (-1900, -100)).outputs["Fac"]
    ash = _attribute(tree, "ash_fraction", (-1900, -300)).outputs["Fac"]
    medium = _noise(tree, rest, 220.0, 5.0, (-1600, -500))
    fine = _noise(tree, rest, 1500.0, 4.0, (-1600, -700))

    scorch = _ramp(tree, _scorched(tree, peak, burnt, medium), SCORCH, (-450, 100))
    brown = _node(tree, "ShaderNodeMix", (-150, 300), data_type="RGBA", blend_type="MULTIPLY")
    brown.inputs[0].default_value = 1
    for socket, value in ((brown.inputs[6], fresh), (brown.inputs[7], scorch)):
        if isinstance(value, tuple):
            socket.default_value = value
        else:
            links.new(value, socket)

    # char, paler where there was ink; then ash, in flakes
    char = _range(tree, burnt, 0.12, 0.46, (-300, -50))
    soot = _mix(tree, ink, SOOT, INK_ON_CHAR, (-150, 50)) if ink else SOOT
    black = _mix(tree, char, brown.outputs[2], soot, (50, 200))
    speckled = _math(tree, "MULTIPLY", (-600, -350), ash,
                     _math(tree, "ADD", (-750, -450), _math(tree, "MULTIPLY", (-900, -450), medium, 1.6), -0.1))
    coloured = _mix(tree, _range(tree, speckled, 0.05, 0.14, (-300, -350)), black, ASH, (250, 200))

    # embers: hot char glows in its cracks, where air reaches it. `ember` is the cache's colour of that glow. The
    # attribute `temperature` cannot be used: Cycles reserves the name for volumes, and reads 0 for meshes
    ember = _attribute(tree, "ember", (-1100, -900)).outputs["Color"]
    bent = _node(tree, "ShaderNodeVectorMath", (-1350, -900), operation="MULTIPLY_ADD")
    wander = _node(tree, "ShaderNodeTexNoise", (-1600, -1000), Scale=450.0, Detail=3.0)
    links.new(rest, wander.inputs["Vector"])
    links.new(wander.outputs["Color"], bent.inputs[0])
    bent.inputs[1].default_value = (0.0022, 0.0022, 0.0022)
    links.new(rest, bent.inputs[2])
    plates = _node(tree, "ShaderNodeTexVoronoi", (-1150, -1050), feature="DISTANCE_TO_EDGE", Scale=520.0)
    links.new(bent.outputs[0], plates.inputs["Vector"])
    cracks = _range(tree, plates.outputs["Distance"], 0.13, 0.0, (-950, -1050))
    patches = _range(tree, medium, 0.42, 0.62, (-950, -1250))
    open_ = _math(tree, "MULTIPLY", (-750, -1100), _math(tree, "POWER", (-850, -1050), cracks, 2.0), patches)
    strength = _math(tree, "ADD", (-400, -1100), _math(tree, "MULTIPLY", (-600, -1100), open_, EMBER_CRACKS),
                     EMBER_CRUST)
    glow = _math(tree, "MULTIPLY", (-200, -1000), _range(tree, burnt, 0.15, 0.5, (-600, -900)), strength)

    # char is brittle and rough
    bump = _node(tree, "ShaderNodeBump", (50, -200), Distance=0.0004)
    links.new(char, bump.inputs["Strength"])
    links.new(_math(tree, "ADD", (-150, -250), medium, _math(tree, "MULTIPLY", (-300, -250), fine, 0.4)),
              bump.inputs["Height"])

    paper = _node(tree, "ShaderNodeBsdfPrincipled", (450, 200), Roughness=0.85)
    paper.inputs["Specular IOR Level"].default_value = 0.1
    links.new(coloured, paper.inputs["Base Color"])
    links.new(bump.outputs[0], paper.inputs["Normal"])
    # Blender's view bleaches bright red to pink: embers are orange
    red = _node(tree, "ShaderNodeSeparateColor", (-400, -850))
    links.new(ember, red.inputs[0])
    orange = _node(tree, "ShaderNodeCombineColor", (0, -850))
    links.new(red.outputs[0], orange.inputs[0])
    links.new(_math(tree, "MULTIPLY_ADD", (-200, -850), red.outputs[0], 0.1, red.outputs[1]), orange.inputs[1])
    links.new(red.outputs[2], orange.inputs[2])
    links.new(orange.outputs[0], paper.inputs["Emission Color"])
    links.new(glow, paper.inputs["Emission Strength"])
    through = _node(tree, "ShaderNodeBsdfTranslucent", (450, -150))
    links.new(coloured, through.inputs["Color"])
    mixed = _node(tree, "ShaderNodeMixShader", (700, 200))
    # burnt parts transmit no light
    links.new(_math(tree, "MULTIPLY", (450, 400), _math(tree, "SUBTRACT", (250, 400), 1.0, char), 0.3),
              mixed.inputs["Fac"])
    links.new(paper.outputs[0], mixed.inputs[1])
    links.new(through.outputs[0], mixed.inputs[2])
    output = _node(tree, "ShaderNodeOutputMaterial", (900, 200))
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
    # red at the edge, orange, and a pale core that is far brighter
    hue = _ramp(tree, _range(tree, flame, 0.0, 0.6, (-450, -300)),
                ((0, (1, 0.14, 0.0)), (0.35, (1, 0.30, 0.0)), (1, (1, 0.55, 0.05))), (-250, -300))
    tree.links.new(hue, volume.inputs["Emission Color"])
    core = _math(tree, "MULTIPLY_ADD", (-300, -50), flame, FLAME_CORE, 1.0)
    tree.links.new(_math(tree, "MULTIPLY", (-100, -100), _math(tree, "MULTIPLY", (-200, 50), flame, core), FLAME_LIGHT),
                   volume.inputs["Emission Strength"])
    output = _node(tree, "ShaderNodeOutputMaterial", (500, 0))
    tree.links.new(volume.outputs[0], output.inputs["Volume"])
    return material
