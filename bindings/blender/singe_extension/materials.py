# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of burning paper and cloth, from the cache's attributes, and of the gas. Their nodes need no extension."""

import math

import bpy

# paper browns by its peak temperature from BROWN to CHAR, K, in the logarithm of what it is above the room's
ROOM, BROWN, CHAR = 293.0, 348.0, 653.0
# how much of each colour is left as paper scorches, from fresh to charred (program/formats/burn_colour.c)
SCORCH = ((0, (1, 1, 1)), (0.09, (0.975, 0.93, 0.81)), (0.21, (0.84, 0.68, 0.44)), (0.57, (0.53, 0.34, 0.165)),
          (0.68, (0.32, 0.165, 0.068)), (0.77, (0.14, 0.062, 0.026)), (0.86, (0.056, 0.030, 0.018)),
          (1, (0.020, 0.016, 0.014)))
SOOT, INK_ON_CHAR, ASH = (0.012, 0.0105, 0.0095, 1), (0.05, 0.048, 0.046, 1), (0.34, 0.33, 0.315, 1)
# the flame's emission per metre where `flame` is 1 (docs/blender.md), and how much more its hottest core emits
FLAME_LIGHT, FLAME_CORE = 300.0, 3.0
# how much brighter it is as a lamp than in the picture
FLAME_LAMP = 4.0
# its colours by `flame`: red at the edge, orange, and a pale core
FLAME_COLOURS = ((0, (1, 0.12, 0.0)), (0.2, (1, 0.22, 0.004)), (0.45, (1, 0.36, 0.035)), (0.9, (1, 0.52, 0.13)))
# embers: c2 of a black body, um K; the light of 0.6 um to the power of 0.55, as film sees it, by -EMBER_FALL / T; strength
C2 = 14388.0
EMBER_FALL, EMBER_GAIN = 0.55 * C2 / 0.6, 1.8


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

    # embers, as in program/preview/shade_paper.c: char glows as a black body, hotter here and cooler there. `ember` is the
    # part that glows times 2.5 exp(c2 / (0.61 um 1200 K) - c2 / (l T)), l 0.61 um in red and 0.55 um in green: their
    # ratio gives the temperature, and then red gives the part.
    # The attribute `temperature` cannot be used: Cycles reserves the name for volumes, and reads 0 for meshes
    colours = _node(tree, "ShaderNodeSeparateColor", (-1800, -1000))
    links.new(_attribute(tree, "ember", (-1900, -1000)).outputs["Color"], colours.inputs[0])
    red = _math(tree, "MAXIMUM", (-1650, -1000), colours.outputs[0], 1e-6)
    ratio = _math(tree, "DIVIDE", (-1550, -1100), red, _math(tree, "MAXIMUM", (-1650, -1100), colours.outputs[1], 1e-7))
    inverse = _math(tree, "MULTIPLY", (-1400, -1000), _math(tree, "LOGARITHM", (-1500, -1100), ratio, math.e),
                    1 / (C2 * (1 / 0.55 - 1 / 0.61)))
    mean = _math(tree, "DIVIDE", (-1300, -1000), 1.0, inverse)
    whole = _math(tree, "EXPONENT", (-1200, -1500), _math(tree, "MULTIPLY_ADD", (-1300, -1500), inverse, -C2 / 0.61,
                                                          C2 / 0.61 / 1200 + math.log(2.5)))
    active = _math(tree, "MINIMUM", (-1000, -1500), _math(tree, "DIVIDE", (-1100, -1500), red, whole), 1.0)
    life = _range(tree, _noise(tree, rest, 340.0, 5.0, (-1600, -1200)), 0.40, 0.66, (-1400, -1200))
    varied = _math(tree, "MULTIPLY_ADD", (-1200, -1200), life, 150.0, 10.0)
    varied = _math(tree, "MULTIPLY_ADD", (-1100, -1300), fine, 160.0, _math(tree, "SUBTRACT", (-1100, -1200), varied, 50.0))
    hot = _math(tree, "MINIMUM", (-900, -1100), _math(tree, "ADD", (-1000, -1100), mean, varied), 1380.0)
    light = _math(tree, "EXPONENT", (-600, -1100), _math(
        tree, "MULTIPLY_ADD", (-700, -1100), _math(tree, "DIVIDE", (-800, -1100), 1.0, hot), -EMBER_FALL, EMBER_FALL / 1200))
    air = _math(tree, "MULTIPLY_ADD", (-600, -1300), _math(tree, "POWER", (-700, -1300), life, 2.5), 0.94, 0.06)
    glow = _math(tree, "MULTIPLY", (-400, -1100), light, _math(tree, "MULTIPLY", (-500, -1300), air, active))
    glow = _math(tree, "MULTIPLY", (-300, -1100), glow, _range(tree, colours.outputs[0], 0.0, 0.01, (-500, -1000)))
    glow = _math(tree, "MULTIPLY", (-200, -1100), glow, EMBER_GAIN)
    glowing = _node(tree, "ShaderNodeBlackbody", (-600, -950))
    links.new(hot, glowing.inputs[0])

    # char is brittle and rough
    bump = _node(tree, "ShaderNodeBump", (50, -200), Distance=0.0004)
    links.new(char, bump.inputs["Strength"])
    links.new(_math(tree, "ADD", (-150, -250), medium, _math(tree, "MULTIPLY", (-300, -250), fine, 0.4)),
              bump.inputs["Height"])

    paper = _node(tree, "ShaderNodeBsdfPrincipled", (450, 200), Roughness=0.85)
    paper.inputs["Specular IOR Level"].default_value = 0.1
    links.new(coloured, paper.inputs["Base Color"])
    links.new(bump.outputs[0], paper.inputs["Normal"])
    links.new(glowing.outputs[0], paper.inputs["Emission Color"])
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
    hue = _ramp(tree, flame, FLAME_COLOURS, (-250, -300))
    tree.links.new(hue, volume.inputs["Emission Color"])
    core = _math(tree, "MULTIPLY_ADD", (-300, -50), flame, FLAME_CORE, 1.0)
    strength = _math(tree, "MULTIPLY", (-100, -100), _math(tree, "MULTIPLY", (-200, 50), flame, core), FLAME_LIGHT)
    # what film holds of a flame is less than what lights the room
    seen = _node(tree, "ShaderNodeLightPath", (-300, 200)).outputs["Is Camera Ray"]
    lit = _math(tree, "MULTIPLY_ADD", (-100, 200), seen, 1 - FLAME_LAMP, FLAME_LAMP)
    tree.links.new(_math(tree, "MULTIPLY", (50, 0), strength, lit), volume.inputs["Emission Strength"])
    output = _node(tree, "ShaderNodeOutputMaterial", (500, 0))
    tree.links.new(volume.outputs[0], output.inputs["Volume"])
    return material
