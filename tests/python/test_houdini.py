"""The Python SOP for Houdini against a stand-in of ours for what it calls of `hou`: not run in Houdini."""

import sys
import types
import unittest
import unittest.mock

import numpy as np

from support import ROOT, Case

import singe
from singe import houdini

SIDE, CELLS = 0.1, 16


class NodeError(Exception):
    pass


HOU = types.SimpleNamespace(NodeError=NodeError, attribType=types.SimpleNamespace(Point="point"), fps=lambda: 24.0)


class Geometry:
    """Points, polygons whose corners are clockwise seen from the front, groups, attributes of points."""

    def __init__(self, points, faces, groups):
        self.points, self.faces, self.groups = [list(map(float, p)) for p in points], [list(f) for f in faces], groups
        self.attributes, self.started = {}, {}

    def pointFloatAttribValues(self, name):
        assert name == "P"
        return tuple(x for point in self.points for x in point)

    def prims(self):
        def vertex(number):
            return types.SimpleNamespace(point=lambda: types.SimpleNamespace(number=lambda: number))
        return tuple(types.SimpleNamespace(vertices=lambda face=face: tuple(map(vertex, face))) for face in self.faces)

    def findPointGroup(self, name):
        if name not in self.groups:
            return None
        return types.SimpleNamespace(points=lambda: tuple(types.SimpleNamespace(number=lambda n=n: n)
                                                          for n in self.groups[name]))

    def clear(self):
        self.points, self.faces, self.groups, self.attributes, self.started = [], [], {}, {}, {}

    def createPoints(self, positions):
        assert all(type(x) is float for x in positions[0])
        self.points += positions

    def createPolygons(self, faces):
        assert all(type(n) is int for n in faces[0])
        self.faces += faces

    def addAttrib(self, kind, name, default):
        assert kind == "point" and name not in self.started
        self.started[name] = 1 if isinstance(default, float) else len(default)

    def setPointFloatAttribValues(self, name, values):
        assert len(values) == self.started[name] * len(self.points)
        self.attributes[name] = np.array(values).reshape(len(self.points), -1).squeeze()


class Node:
    """The node that cooks: its input is copied into its geometry before, as Houdini does."""

    def __init__(self, make, **values):
        self.make, self.solid = make, None
        self.values = {name: default for name, _, default, *_ in houdini.PARAMETERS}
        self.values.update({"start": 1, "frame": 1}, **values)

    def evalParm(self, name):
        return self.values[name]

    def path(self):
        return f"/obj/{id(self)}"

    def inputs(self):
        return (None, self.solid) if self.solid else (None,)

    def geometry(self):
        return self.now

    def cook(self, frame):
        self.values["frame"], self.now = frame, self.make()
        houdini.cook(HOU, self)
        return self.now


def paper():
    """A sheet in the x-z plane, y up, 20 cm above the floor, its front up."""
    points, faces, _ = singe.grid((SIDE, SIDE), (CELLS, CELLS))
    lifted = np.stack([points[:, 0], 0.2 + points[:, 2], -points[:, 1]], axis=1)
    return Geometry(lifted, faces[:, ::-1], {"match": [CELLS // 2], "held": [0, CELLS, len(points) - CELLS - 1,
                                                                            len(points) - 1]})


class Houdini(Case):
    def test_a_sheet_burns_from_its_match_and_hangs_from_what_is_held(self):
        node = Node(paper)
        first = node.cook(1)
        self.assertEqual(len(first.faces), 4 * CELLS * CELLS)
        self.assertLess(np.ptp(np.array(first.points)[:, 1]), 2e-3)
        a, b, c = (np.array([first.points[face[k]] for face in first.faces]) for k in range(3))
        self.assertTrue((np.cross(b - a, c - a)[:, 1] < 0).all())  # clockwise seen from above, where the front is
        self.assertTrue((first.attributes["N"][:, 1] > 0.9).all())
        later = node.cook(24)
        self.assertGreater(later.attributes["temperature"].max(), 800)
        self.assertGreater(later.attributes["burnt"].max(), 0.3)
        lowest = np.array(later.points)[:, 1].min()
        self.assertTrue(0.15 < lowest < 0.1995, lowest)  # it sags, and would be 4 m lower without what is held

    def test_scrubbing_back_and_steps_over_frames_give_the_same_sheet(self):
        one, other = Node(paper), Node(paper)
        for frame in range(1, 9):
            last = one.cook(frame)
        self.assertTrue(np.allclose(other.cook(8).points, last.points, atol=1e-6))
        again = one.cook(3)
        self.assertEqual(again.points, Node(paper).cook(3).points)

    def test_another_parameter_begins_again(self):
        node = Node(paper)
        calm = node.cook(8).points
        node.values["wind"] = 3.0
        self.assertNotEqual(node.cook(8).points, calm)

    def test_it_rests_on_the_second_input(self):
        node = Node(lambda: Geometry(paper().points, paper().faces, {}))
        box = np.array([[x, y, z] for x in (-0.2, 0.2) for y in (0.1, 0.18) for z in (-0.2, 0.2)])
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        node.solid = types.SimpleNamespace(geometry=lambda: Geometry(box, [face[::-1] for face in faces], {}))
        lowest = np.array(node.cook(12).points)[:, 1].min()
        self.assertTrue(0.179 < lowest < 0.19, lowest)

    def test_the_asset_has_a_parameter_for_each_that_the_node_reads(self):
        with unittest.mock.patch.dict(sys.modules, hou=unittest.mock.MagicMock()) as modules:
            houdini.make_asset("singe_burn.hda")
            hou = modules["hou"]
        named = [call.args[0] for kind in ("String", "Float", "Int")
                 for call in getattr(hou, kind + "ParmTemplate").call_args_list]
        node = Node(paper)
        self.assertEqual(sorted(named), sorted(2 * list(node.values)))  # of the asset, and of the node inside
        subnet = hou.node.return_value.createNode.return_value.createNode.return_value
        self.assertEqual(subnet.createDigitalAsset.call_args.args[1], "singe_burn.hda")
        compile(houdini.CODE, "code", "exec")

    def test_what_is_wrong_is_an_error_of_the_node(self):
        with self.assertRaisesRegex(NodeError, "no polygons"):
            Node(lambda: Geometry([], [], {})).cook(1)
        with self.assertRaisesRegex(NodeError, "there is no material of this name"):
            Node(paper, material="asbestos").cook(1)
