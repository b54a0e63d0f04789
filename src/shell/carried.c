// What substeps carry, and what a sheet must.
//
// A sheet under tension T vibrates transversely at 4 T/(rho s^2) at most, in (1/s)^2, which substeps of h resolve while
// it is below about 1/h^2. Projections hold a sheet that is pulled apart farther only to
//
//   T = 0.2 rho s^2/h^2     (measured: 0.19 to 0.35, from 20 to 3 substeps of 1/480 s)
//
// with its mass per area rho, and it stretches. What hangs in a fire's plume must carry about
//
//   L (rho g + q),   L^2 its area
//
// with the pressure q of air at 1.3 m/s, half of its density times the square. So thin sheets of small cells need many
// substeps: 20 cm of tissue in cells of 2.5 mm six or seven of a step of 1/480 s.
#include "shell/shell.h"

#include <math.h>

static const double CARRIES = 0.2;
static const double PLUME = 1; ///< q, Pa

/// g, m/s2. A caller may set another gravity in any step; what depends on loads is chosen once, at the commit, and again
/// when a snapshot is loaded, with the same result.
static const double GRAVITY = 9.81;

/// Mass per area at the start, kg/m2, and the area, m2. The sheet has cells.
static double sheet_density(const Shell *shell, uint32_t index, double *area) {
    const Sheet *sheet = &shell->sheets[index];
    double mass = *area = 0;
    for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++) {
        mass += 2 * (double)shell->matter.mass[shell_centre(shell, c)];
        *area += (double)shell->matter.area[shell_centre(shell, c)];
    }
    return mass / *area;
}

float shell_carried(const Shell *shell, uint32_t index, float h) {
    double area, density = sheet_density(shell, index, &area), side = (double)shell->sheets[index].cell_size;
    return (float)(CARRIES * density * side * side / ((double)h * (double)h));
}

float shell_load(const Shell *shell, uint32_t index) {
    double area, density = sheet_density(shell, index, &area);
    return (float)(sqrt(area) * (density * GRAVITY + PLUME));
}
