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
#include "dynamics/stiffness.h"

#include <math.h>

/// a above, of red springs.
static const float COUPLING = 2.5f;

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

void stiffness_begin(const Shell *shell, SingeColour colour, float h, float regularisation, Stiffness *stiffness) {
    float softness = (colour == SINGE_RED ? COUPLING : 0) + regularisation;
    *stiffness = (Stiffness){.shell = shell, .colour = colour, .softness = softness * h * h, .sheet = UINT32_MAX};
}

float stiffness_compliance(Stiffness *stiffness, uint32_t spring) {
    const Shell *shell = stiffness->shell;
    const uint32_t *ends = shell->springs[stiffness->colour].ends[spring];
    const Field material = shell->matter.compliance[stiffness->colour];
    float compliance = 0.5f * (field_at(material, ends[0]) + field_at(material, ends[1]));
    uint32_t index = shell->matter.sheet[ends[0]];
    const Sheet *sheet = &shell->sheets[index];
    if (index != stiffness->sheet) {
        float mass = stiffness->softness > 0 ? particle_mass(shell, sheet) : 0;
        stiffness->sheet = index;
        stiffness->own = mass > 0 ? stiffness->softness / mass : 0;
    }

    uint32_t centre = ends[0] > ends[1] ? ends[0] : ends[1]; // of a red spring: they come after all vertices
    if (stiffness->colour == SINGE_RED) compliance *= thickness_share(shell, sheet, centre);
    return compliance > stiffness->own ? compliance - stiffness->own : 0;
}

int stiffness_substeps(const Shell *shell, float h, float regularisation) {
    const float softness = COUPLING + regularisation;
    float count = 1;
    for (uint32_t i = 0; i < shell->sheet_count; i++) {
        const Sheet *sheet = &shell->sheets[i];
        float mass = particle_mass(shell, sheet), min = INFINITY;
        for (uint32_t c = sheet->cell_first; c < sheet->cell_first + sheet->cell_count; c++) {
            uint32_t centre = shell_centre(shell, c);
            float compliance = field_at(shell->matter.compliance[SINGE_RED], centre);
            min = fminf(min, compliance * thickness_share(shell, sheet, centre));
        }

        if (sheet->cell_count > 0) count = fmaxf(count, ceilf(h * sqrtf(softness / (min * mass))));
    }

    return count < STIFFNESS_MAX ? (int)count : STIFFNESS_MAX;
}
