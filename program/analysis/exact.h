// Signs of determinants of points, exact for all magnitudes.
#pragma once

/// The sign of |a-d b-d c-d|: 1 if a, b, c turn clockwise as seen from d (d is below their plane), -1 if
/// counter-clockwise, 0 if the four lie in a plane. Coordinates must be finite.
int exact_orient3(const float a[3], const float b[3], const float c[3], const float d[3]);

/// The sign of |a-c b-c| of the coordinates x and y (0, 1 or 2): 1 if a, b, c turn counter-clockwise.
int exact_orient2(const float a[3], const float b[3], const float c[3], int x, int y);

/// Whether the three lie on a line.
int exact_collinear(const float a[3], const float b[3], const float c[3]);
