# SPDX-License-Identifier: GPL-3.0-or-later
"""What the extension computes without Blender."""

import os
import sys
import tempfile
import types
import unittest

import numpy as np

package = types.ModuleType("singe_extension")  # without its __init__, which needs Blender
package.__path__ = [os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "singe_extension")]
sys.modules["singe_extension"] = package
from singe_extension import mesh as meshes  # noqa: E402


def square(uv=True):
    corners = [0, 1, 2, 3, 1, 4, 2]
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0]]
    return meshes.Mesh(points, corners, [4, 3], np.array(points)[corners][:, :2] if uv else None,
                       {"w": [0, 1, 1, 0, 0.5]})


class Meshes(unittest.TestCase):
    def test_subdivide(self):
        fine = meshes.subdivide(square())
        self.assertEqual((fine.sizes == 4).all(), True)
        self.assertEqual(len(fine.sizes), 7)
        self.assertEqual(len(fine.points), 5 + 6 + 2)  # corners, edges (one is shared), faces
        # uv stay those of the places, weights straight between
        np.testing.assert_allclose(fine.uv, fine.points[fine.corners][:, :2], atol=1e-12)
        np.testing.assert_allclose(fine.weights["w"][:5], [0, 1, 1, 0, 0.5])
        shared = np.flatnonzero((fine.points == [1, 0.5, 0]).all(1))
        self.assertEqual(len(shared), 1)
        self.assertEqual(fine.weights["w"][shared[0]], 1)

    def test_faces_keep_their_side(self):
        fine = meshes.subdivide(meshes.subdivide(square()))
        area = 0
        for i in range(len(fine.sizes)):
            p = fine.points[fine.corners[4 * i:4 * i + 4]]
            area += (0.5 * np.cross(p[2] - p[0], p[3] - p[1]))[2]
        self.assertAlmostEqual(area, 1.5)

    def test_refine(self):
        fine = meshes.refine(square(), 0.1)
        self.assertLessEqual(fine.edge_length(), 0.105)
        self.assertGreater(fine.edge_length(), 0.045)
        self.assertLessEqual(len(meshes.refine(square(), 1e-9, 1000).sizes), 1000)

    def test_flat_and_closed(self):
        self.assertTrue(square().is_flat())
        self.assertFalse(square().is_closed())
        box = meshes.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2], [3] * 4)
        self.assertTrue(box.is_closed())
        self.assertFalse(box.is_flat())

    def test_spread(self):
        chosen, reach = meshes.spread(np.array([[x, 0.0, 0] for x in range(11)]), 3)
        self.assertEqual(sorted(chosen), [0, 5, 10])
        self.assertLessEqual(reach, 3)

    def test_ply(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "m.ply")
            meshes.write_ply(path, square())
            with open(path, "rb") as file:
                data = file.read()
            head, body = data.split(b"end_header\n", 1)
            self.assertIn(b"property float w", head)
            self.assertEqual(len(body), 5 * 16 + (4 + 16 + 4 + 32) + (4 + 12 + 4 + 24))


if __name__ == "__main__":
    unittest.main()
