// Signs of determinants of points, exact whatever the points' magnitudes.
#ifndef ANALYSIS_EXACT_H
#define ANALYSIS_EXACT_H

/// The sign of |a-d b-d c-d|: 1 where d sees a, b, c turn clockwise (d is below their plane), -1 counter-clockwise, 0
/// where the four lie in a plane. Coordinates must be finite.
int exact_orient3(const float a[3], const float b[3], const float c[3], const float d[3]);

/// The sign of |a-c b-c| of the coordinates x and y (0, 1 or 2): 1 where a, b, c turn counter-clockwise.
int exact_orient2(const float a[3], const float b[3], const float c[3], int x, int y);

/// Whether the three lie on a line.
int exact_collinear(const float a[3], const float b[3], const float c[3]);

#endif
