# SPDX-License-Identifier: GPL-3.0-or-later
"""Singe in Blender: sheets of the scene burn in a process of its own, and the cache comes in as it grows."""

from . import operators, panels, properties

MODULES = (properties, operators, panels)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
