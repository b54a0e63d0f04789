// The front thickening F (thickened flame model: Butler & O'Rourke 1977; Colin, Ducros, Veynante & Poinsot 2000).
//
// Diffusivity times F and every rate over F leave the front's speed and temperatures as they are and make it F times
// thicker, for with x' = x/F and t' = t/F the equations are the old ones. The cells then have to resolve F delta
// instead of delta,
//
//   delta = sqrt(alpha/(mu theta)),   theta = min(eta - (T_ign - T_amb), rate_ceiling)
//   F = max(1, s/(c delta)), refused above 1e6
//
// delta  m          thickness of the front, from diffusion over delta against burning
// alpha  m2/s       diffusivity, mu 1/(K s) mass rate of eq 4
// theta  K          rise above ignition without losses: eta, less what it takes to get there; at most the ceiling of
//                   eq 4's rate
// s      m          cell size
// c      1          cells as large as c delta: measured on strips of cells from 0.5 to 4 mm, c = 0.8 holds the speed
//                   within 5 % (tests/heat/test_front.c)
#include <math.h>

#include "heat/plan.h"

static const float THICKEN_CELLS = 0.8f;

float heat_thickening_for(const SingeMaterialDef *material, float diffusivity, float mass_rate, float heating,
                          float ignition_temperature, float ambient_temperature, float cell_size) {
    if (material->thickening > 0) return material->thickening > 1 ? material->thickening : 1;
    float rise = heating - (ignition_temperature - ambient_temperature);
    // what cannot burn, or diffuses nothing, has no front
    if (!(rise > 0) || !(mass_rate > 0) || !(diffusivity > 0)) return 1;
    rise = fminf(rise, material->rate_ceiling);
    float needed = cell_size / (THICKEN_CELLS * sqrtf(diffusivity / (mass_rate * rise)));
    return needed > 1 ? needed : 1;
}
