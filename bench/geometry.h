// What a square sheet of `cells` a side looks like, from its vertices.
#ifndef BENCH_GEOMETRY_H
#define BENCH_GEOMETRY_H

#include "singe/singe.h"

/// J/kg of motion and weight together, each particle with its mass; heights are measured from z = 0.
double geometry_energy(const SingeView *view, double gravity);

/// m, mean height of all mass.
double geometry_height(const SingeView *view);

/// m/s, the greatest; NaN where one is.
double geometry_speed(const SingeView *view);

/// m, root mean square distance of the particles from their centre.
double geometry_gyration(const SingeView *view);

/// Share of the inner edges whose two cells' normals are more than a right angle apart.
double geometry_folded(const SingeView *view, int cells);

/// Cells whose centre is not on the front of their corners; such as have no area are in order.
double geometry_inverted(const SingeView *view);

/// The max ratio of a particle's distance from a point on the sheet to that at rest, of particles farther from
/// it than 0.2 m at rest.
double geometry_reach(const SingeView *view, const float *position);

/// The sheet's point at (u, v) in [0, 1] of the square, bilinear between vertices.
void geometry_point(const SingeView *view, int cells, double u, double v, double *point);

#endif
