// Compliances of springs from the material's. Blue, green and yellow springs have the material's compliance c, the mean
// of their ends: on square cells the stiffness of stretch, bending and shear is then 1/c, t^2/c and 1/c whatever the
// side s of the cells. Transverse shear by the angle gamma makes a red spring longer by gamma t (s/2)/l; for the
// stiffness S = 1/c, a force per width over gamma, it needs
//
//   c_spring = c t^2/l^2,   l^2 = s^2/2 + t^2,   t the thickness
//
// A solver has a softness of its own, which acts like a further compliance of a spring,
//
//   (a + r) h^2/m,   m = s^2 grammage/2 the mass of an unburnt particle, h the substep
//
// r is its floor, the `regularisation`. a is due to projecting a colour once a substep: the colours interfere with each
// other where forces change from spring to spring, as those of red do under transverse shear: 2.5 (measured) for red
// and 0 for the others. This compliance is subtracted from c_spring, so that the sum does not depend on h, as long as
//
//   h <= sqrt(c_spring m/(a + r))
//
// Sheets have one s and one grammage here, their median and mean.
//
// Isotropic bending. Green springs and braces (brace.c) of stiffness k_G and k_P, with blue springs that keep their
// length, bend with, over t^2,
//
//   D11 = k_G + k_P,   D12 = k_P,   D66 = min over g of k_Y (g - 1/2)^2 + K_r g^2 + k_P (g + 1/2)^2
//
// k_Y of yellow springs, K_r = s^2/(4 t^2 c_R) of red ones: g is the share by which twist tilts centres. Bending is the
// same in all directions if 2 D66 = D11 - D12, which is k_G = 2 D66. A strip then has D11 - D12^2/D11 = 4 D66 (k_P +
// D66)/(k_P + 2 D66), which grows with k_P and is to be the material's 1/c_G.
#include "dynamics/stiffness.h"

#include "common/real.h"

#include <math.h>

/// a above, of red springs.
static const float COUPLING = 2.5f;

/// D66 is to be so many times what isotropy asks for (measured, `singe bench plate`): vertices at a border have no braces.
static const double TWIST_MORE = 1.1;

/// Max k_P over the stiffness of a strip.
static const double BRACE_MAX = 4;

/// Mass of an unburnt particle in the interior of a sheet, kg.
static float particle_mass(const Shell *shell, const Sheet *sheet) {
    double mass = 0, area = 0;
    for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++) {
        mass += (double)shell->matter.mass[shell_centre(shell, c)];
        area += (double)shell->matter.area[shell_centre(shell, c)];
    }

    return area > 0 ? (float)(mass / area) * sheet->cell_size * sheet->cell_size : 0;
}

/// t^2/l^2 at a cell's centre.
static float thickness_share(const Shell *shell, const Sheet *sheet, uint32_t centre) {
    float t = field_at(shell->matter.thickness, centre), s = sheet->cell_size;
    return t * t / (0.5f * s * s + t * t);
}

void stiffness_begin(const Shell *shell, SingeColour colour, float h, const SingeSolverDef *solver,
                     Stiffness *stiffness) {
    const float given = stiffness_given(solver); // a start has its share without the solver's own softness
    const float floor = solver->regularisation[colour], red = solver->regularisation[SINGE_RED];
    const float softness = (colour == SINGE_RED ? COUPLING : 0) + floor;
    *stiffness = (Stiffness){.shell = shell,
                             .colour = colour,
                             .isotropic = solver->isotropic,
                             .softness = given * softness * h * h,
                             .red_softness = {given * (COUPLING + red) * h * h, given * red * h * h},
                             .sheet = UINT32_MAX};
}

/// m/N, of the green spring or brace between two centres: k_G or k_P for isotropic bending of a strip by the material's
/// 1/c_green. k_P is at most BRACE_MAX of that, where yellow springs are too soft for it, and 0 where red ones are too
/// stiff.
static float shared_compliance(const Stiffness *stiffness, const uint32_t *ends) {
    const Shell *shell = stiffness->shell;
    const Matter *matter = &shell->matter;
    double stiff = 0;
    for (int end = 0; end < 2; end++) {
        const uint32_t centre = ends[end];
        const float green = field_at(matter->compliance[SINGE_GREEN], centre);
        if (green == 0) return 0;
        const double wanted = 1 / (double)green, s = (double)shell->sheets[stiffness->sheet].cell_size;
        const double t = (double)field_at(matter->thickness, centre), l2 = s * s / 2 + t * t;

        // what a red spring gives in twist: its compliance less what is subtracted for shear, and the solver's own
        const double own = (double)stiffness->red_softness[0] / (double)stiffness->mass;
        const double twist = (double)stiffness->red_softness[1] / (double)stiffness->mass;
        const double given = (double)field_at(matter->compliance[SINGE_RED], centre) * t * t / l2;
        const double red = s * s / (4 * l2) / double_max(double_max(given - own, 0) + twist, 1e-12);
        const double yellow = 1 / double_max((double)field_at(matter->compliance[SINGE_YELLOW], centre), 1e-12);

        double low = 0, high = BRACE_MAX * wanted;
        for (int i = 0; i < 40; i++) {
            const double brace = 0.5 * (low + high), g = 0.5 * (yellow - brace) / (yellow + red + brace);
            const double sum = yellow * (g - 0.5) * (g - 0.5) + red * g * g + brace * (g + 0.5) * (g + 0.5);
            const double half = sum / TWIST_MORE; // of k_G
            if (4 * half * (brace + half) / (brace + 2 * half) < wanted) low = brace;
            else high = brace;
        }

        // as stiff as wanted along the mesh in any case: k_G (k_G + 2 k_P) = wanted (k_G + k_P)
        const double less = 2 * low - wanted;
        stiff += 0.5 * (stiffness->braces ? low : 0.5 * (sqrt(less * less + 4 * wanted * low) - less));
    }
    return (float)(1 / double_max(stiff, 1e-12));
}

float stiffness_compliance(Stiffness *stiffness, uint32_t spring) {
    const Shell *shell = stiffness->shell;
    const uint32_t *ends = (stiffness->braces ? stiffness->braces : shell->springs[stiffness->colour].ends)[spring];
    const Field material = shell->matter.compliance[stiffness->colour];
    float compliance = 0.5f * (field_at(material, ends[0]) + field_at(material, ends[1]));
    uint32_t index = shell->matter.sheet[ends[0]];
    const Sheet *sheet = &shell->sheets[index];
    if (index != stiffness->sheet) {
        const float mass = stiffness->softness > 0 ? particle_mass(shell, sheet) : 0;
        stiffness->sheet = index;
        stiffness->mass = mass;
        stiffness->own = mass > 0 ? stiffness->softness / mass : 0;
    }

    uint32_t centre = ends[0] > ends[1] ? ends[0] : ends[1]; // of a red spring: they come after all vertices
    if (stiffness->colour == SINGE_RED) compliance *= thickness_share(shell, sheet, centre);
    if (stiffness->colour == SINGE_GREEN && stiffness->isotropic) compliance = shared_compliance(stiffness, ends);
    return compliance > stiffness->own ? compliance - stiffness->own : 0;
}

int stiffness_carrying(const Shell *shell, float h) {
    float count = 1;
    for (uint32_t i = 0; i < shell->sheet_count; i++)
        if (shell->sheets[i].cell_count)
            count = float_max(count, ceilf(sqrtf(shell_load(shell, i) / shell_carried(shell, i, h))));

    return count < STIFFNESS_MAX ? (int)count : STIFFNESS_MAX;
}

int stiffness_substeps(const Shell *shell, float h, float regularisation) {
    const float softness = COUPLING + regularisation;
    float count = (float)stiffness_carrying(shell, h);
    for (uint32_t i = 0; i < shell->sheet_count; i++) {
        const Sheet *sheet = &shell->sheets[i];
        float mass = particle_mass(shell, sheet), min = INFINITY;
        for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++) {
            uint32_t centre = shell_centre(shell, c);
            float compliance = field_at(shell->matter.compliance[SINGE_RED], centre);
            min = float_min(min, compliance * thickness_share(shell, sheet, centre));
        }

        if (sheet->cell_count == 0) continue;
        count = float_max(count, ceilf(h * sqrtf(softness / (min * mass))));
    }

    return count < STIFFNESS_MAX ? (int)count : STIFFNESS_MAX;
}
