# SPDX-License-Identifier: GPL-3.0-or-later
"""Singe in Blender: burns sheets of the scene in a separate process, and loads the cache as it grows."""

from . import operators, panels, properties

MODULES = (properties, operators, panels)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
