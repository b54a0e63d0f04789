// Rotations in scenes: about the world's fixed x, then y, then z axis. R = Rz Ry Rx.
#pragma once

/// A row-major 3 × 3 matrix from angles in radians.
void rotation_matrix(const float angles[3], double matrix[9]);

/// The unit quaternion x, y, z, w of the same rotation.
void rotation_quaternion(const float angles[3], float quaternion[4]);
