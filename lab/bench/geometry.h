// Measures of a square sheet with `cells` per side, from its vertices.
#pragma once

#include <stdbool.h>

#include "bench/table.h"
#include "singe/singe.h"

/// The cells of a grid of across x along cells, whose vertices lie in rows of across + 1: cells[4 * across * along].
void geometry_grid(uint32_t across, uint32_t along, uint32_t *cells);

/// J/kg, kinetic plus potential energy, weighted by particle mass; heights are measured from z = 0.
double geometry_energy(const SingeView *view, double gravity);

/// m, mean height of all mass.
double geometry_height(const SingeView *view);

/// m/s, the max; NaN if one is NaN.
double geometry_speed(const SingeView *view);

/// m, root mean square distance of the particles from their centre.
double geometry_gyration(const SingeView *view);

/// The cross product of a cell's diagonals.
void geometry_normal(const SingeView *view, uint32_t cell, double *normal);

/// Share of the inner edges whose two cells' normals are more than a right angle apart.
double geometry_folded(const SingeView *view, int cells);

/// Cells whose centre is not in front of their corners; cells without area do not count.
double geometry_inverted(const SingeView *view);

/// Pairs of triangles of the drawn surface that cross.
SingeResult geometry_crossings(SingeSim *sim, uint64_t *count, SingeError *error);

/// The max ratio of a particle's distance from a point on the sheet to that at rest, for particles more than 0.2 m from
/// it at rest.
double geometry_reach(const SingeView *view, const float *position);

/// The surface z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2 through the vertices that lie within `radius` of a point at
/// rest, in least squares: its curvatures, 1/m, in `principal` with that of the larger size first, positive where both bend
/// to one side. Returns the angle to x of the direction that rolls up, rad, from 0 to pi.
double geometry_curvatures(const SingeView *view, double x, double y, double radius, double principal[2]);

/// Removes mean and slope of a line of samples and applies a Hann window. Returns the mean square before the window.
double geometry_window(double *line, int count);

/// Its power at k waves over its length.
double geometry_power(const double *line, int count, int k);

// ---- strain of springs, |length/target - 1|, over any number of samples: max, mean, 99th percentile.

/// A histogram over the top bits of the strain as a float, without the sign: 8 of the exponent and 7 of the mantissa,
/// so that a percentile has a relative error of 1/128.
enum { STRAIN_BINS = 1 << 15 };

typedef struct Strain {
    uint64_t count, bins[STRAIN_BINS];
    double sum, max;
    bool finite; ///< no length was NaN or infinite
} Strain;

void strain_clear(Strain *strain);

/// Adds every remaining spring of a colour, except springs between two held particles: no solver can change them.
void strain_add(Strain *strain, const SingeView *view, SingeColour colour);

/// Adds the samples of another.
void strain_merge(Strain *strain, const Strain *other);

/// Max, p99 and mean in percent: of the samples, and of a simulation.
BenchValue strain_percent(const Strain *strain);
BenchValue strain_of(const SingeStats *stats);
