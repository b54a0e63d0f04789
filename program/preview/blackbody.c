// The colour of glowing surfaces.
//
// Planck: B(lambda, T) ~ lambda^-5 / (exp(c2/(lambda T)) - 1), c2 = 1.438777e-2 m K. CIE 1931 observer by the
// multi-lobe Gaussians of Wyman, Sloan & Shirley 2013 (JCGT 2(2)), then XYZ to linear Rec. 709 as a camera balanced for
// 3400 K sees it (Bradford's adaptation, then the usual matrix): light of 1900 K is amber. By daylight's white it is red,
// and moonlight makes it pink. Below about 1550 K blue lies outside the gamut: negative values are clipped. The luminance
// of an ember increases 50-fold from 1020 to 1220 K; eye and film compress that, so the table holds chromaticity *
// (Y(T)/Y(1200 K))^0.55.

#include "preview/light.h"

static double lobe(double x, double centre, double left, double right) {
    double t = (x - centre) * (x < centre ? left : right);
    return exp(-0.5 * t * t);
}

static void planck_xyz(double temperature, double xyz[3]) {
    xyz[0] = xyz[1] = xyz[2] = 0;
    for (int nm = 380; nm <= 780; nm += 5) {
        double lambda = nm * 1e-9;
        double radiance = pow(lambda * 1e6, -5) / (exp(1.438777e-2 / (lambda * temperature)) - 1);
        xyz[0] += radiance * (0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
                              0.065 * lobe(nm, 501.1, 0.0490, 0.0382));
        xyz[1] += radiance * (0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322));
        xyz[2] += radiance * (1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725));
    }
}

void blackbody_fill(Float3 table[BLACKBODY_COUNT]) {
    double reference[3], xyz[3];
    planck_xyz(1200, reference);
    for (int i = 0; i < BLACKBODY_COUNT; i++) {
        double temperature = (double)BLACKBODY_MIN + (double)BLACKBODY_STEP * i;
        planck_xyz(temperature, xyz);
        double x = xyz[0] / xyz[1], z = xyz[2] / xyz[1];
        double r = fmax(2.9717 * x - 1.8473 - 0.4908 * z, 0), g = fmax(-1.0277 * x + 2.0626 + 0.0127 * z, 0);
        double b = fmax(0.1167 * x - 0.3019 + 2.3811 * z, 0);
        double strength = pow(xyz[1] / reference[1], 0.55) / (0.2126 * r + 0.7152 * g + 0.0722 * b);
        strength *= (double)stepf(BLACKBODY_MIN, BLACKBODY_MIN + 120, (float)temperature);
        table[i] = float3((float)(r * strength), (float)(g * strength), (float)(b * strength));
    }
}

Float3 blackbody_glow(const Float3 table[BLACKBODY_COUNT], float temperature) {
    float x = (temperature - BLACKBODY_MIN) / BLACKBODY_STEP;
    if (!(x > 0)) return float3(0, 0, 0);
    if (x >= BLACKBODY_COUNT - 1) return table[BLACKBODY_COUNT - 1];
    int i = (int)x;
    return float3_mix(table[i], table[i + 1], x - (float)i);
}
