// The front thickening F (thickened flame model: Butler & O'Rourke 1977; Colin, Ducros, Veynante & Poinsot 2000).
//
// Diffusivity times F and every rate over F keep the front's speed and temperatures and make it F times thicker: with
// x' = x/F and t' = t/F the equations are the old ones. The cells then have to resolve F delta instead of delta,
//
//   delta = sqrt(alpha/(mu theta)),   theta = min(eta - (T_ign - T_amb), rate_ceiling)
//   F = max(1, s/(c delta)), refused above 1e6
//
// delta  m          thickness of the front, from the balance of diffusion over delta and burning
// alpha  m2/s       diffusivity, mu 1/(K s) mass rate of eq 4
// theta  K          rise above ignition without losses: eta, less the rise to ignition; at most the ceiling of
//                   eq 4's rate
// s      m          cell size
// c      1          max cell size over F delta: measured on strips of cells from 0.5 to 4 mm, c = 0.75 holds the
//                   speed within 5 % (tests/heat/test_front.c, `singe bench front`)
//
// With Arrhenius kinetics mu theta is A exp(-E/(R (T_ign + theta))), the rate at the highest temperature.
//
// F has one value for a whole sheet, from the means of parameters that vary over it.
#include <math.h>

#include "common/real.h"
#include "heat/heat_plan.h"

static const float THICKEN_CELLS = 0.75f;

float heat_thickening_for(float thickening, const FrontMatter *front, float ambient_temperature, float cell_size) {
    if (thickening > 0) return thickening > 1 ? thickening : 1;

    // without burning or diffusion there is no front
    float rise = front->heating - (front->ignition_temperature - ambient_temperature);
    if (!(rise > 0) || !(front->diffusivity > 0)) return 1;

    rise = float_min(rise, front->rate_ceiling);

    // mu theta, 1/s
    float rate = front->mass_rate * rise;
    if (front->pre_exponential > 0) {
        const float gas_constant = 8.314462618f; // J/(mol K)
        float temperature = front->ignition_temperature + rise;
        rate = front->pre_exponential * real_expf(-front->activation_energy / (gas_constant * temperature));
    }

    if (!(rate > 0)) return 1;

    float needed = cell_size / (THICKEN_CELLS * sqrtf(front->diffusivity / rate));
    return needed > 1 ? needed : 1;
}
