// Paper browns with its peak temperature P, linearly in ln(P - 293 K), and with its burnt fraction; char is black, ash
// grey. The colour stops are the preview's, without the detail that the preview adds below a vertex's size.
//
// An ember of temperature T emits, at a wavelength l, exp(-c2 / (l T)) with c2 = 14388 um K (Wien): red 0.61 um, green
// 0.55 um, blue 0.465 um.
#include "formats/burn_colour.h"
#include "formats/ember.h"

#include <math.h>

void burn_colour(const OutputSheet *sheet, const SingeSurface *s, uint32_t v, float colour[3]) {
    static const float white[3] = {0.86f, 0.852f, 0.832f};
    static const float soot[3] = {0.018f, 0.016f, 0.015f}, grey[3] = {0.42f, 0.41f, 0.40f};
    static const float stops[8][4] = {{0.00f, 1.00f, 1.00f, 1.00f},    {0.09f, 0.975f, 0.93f, 0.81f},
                                      {0.21f, 0.84f, 0.68f, 0.44f},    {0.57f, 0.53f, 0.34f, 0.165f},
                                      {0.68f, 0.32f, 0.165f, 0.068f},  {0.77f, 0.14f, 0.062f, 0.026f},
                                      {0.86f, 0.056f, 0.030f, 0.018f}, {1.00f, 0.020f, 0.016f, 0.014f}};

    // fresh: white paper in the sheet's colour and picture
    const Image *image = sheet->image;
    for (int c = 0; c < 3; c++) colour[c] = white[c] * sheet->colour[c];

    if (image && image->rgb) {
        const float x = s->uv[v][0] * (float)image->width, y = (1 - s->uv[v][1]) * (float)image->height;
        const int column = x > 0 ? (int)fminf(x, (float)(image->width - 1)) : 0;
        const int row = y > 0 ? (int)fminf(y, (float)(image->height - 1)) : 0;
        const uint8_t *texel = image->rgb + 3 * ((size_t)row * (size_t)image->width + (size_t)column);
        for (int c = 0; c < 3; c++) {
            const float e = (float)texel[c] / 255;
            colour[c] *= e * (e * (e * 0.305306011f + 0.682171111f) + 0.012522878f); // from sRGB, to a thousandth
        }
    }

    if (s->burn[v] < BURN_COLOUR_MIN && s->temperature_peak[v] <= BURN_COLOUR_PEAK) return;

    // browns: scorched 0 fresh to 1 charred
    const float above = s->temperature_peak[v] - 293, first = BURN_COLOUR_PEAK - 293, last = 360;
    const float by_heat = above > first ? 0.76f * fminf(logf(above / first) / logf(last / first), 1) : 0;
    const float by_burn = 1 - expf(-7.5f * fmaxf(s->burn[v], 0));
    const float scorched = 1 - (1 - by_heat) * (1 - by_burn);
    int i = 1;

    while (i < 7 && scorched > stops[i][0]) i++;
    const float f = (scorched - stops[i - 1][0]) / (stops[i][0] - stops[i - 1][0]);
    for (int c = 0; c < 3; c++) colour[c] *= stops[i - 1][c + 1] + f * (stops[i][c + 1] - stops[i - 1][c + 1]);

    // chars, and turns to ash
    const float black = stepf(0.12f, 0.46f, s->burn[v]);
    const float residue = s->char_fraction[v] + s->ash_fraction[v];
    const float ash = residue > 0 ? stepf(0.25f, 0.85f, s->ash_fraction[v] / residue) : 0;

    for (int c = 0; c < 3; c++) {
        const float burnt = soot[c] + ash * (grey[c] - soot[c]);
        colour[c] += black * (burnt - colour[c]);
    }
}

float ember_light(const SingeSurface *s, uint32_t v) {
    const float temperature = s->temperature[v];
    return temperature >= 800 ? 2.5f * ember_share(s, v) * expf(14388 / 0.61f * (1 / 1200.0f - 1 / temperature)) : 0;
}

uint16_t ember_vertex(const SingeSurface *s, uint32_t v) {
    const uint16_t step = ember_step(s->temperature[v]);
    const float part = step ? ember_share(s, v) * EMBER_PARTS : 0;
    return part > 0.5f ? (uint16_t)(step + EMBER_STEPS * (int)(part - 0.5f)) : 0;
}

void ember_colour(uint16_t step, float colour[3]) {
    static const float wavelength[3] = {0.61f, 0.55f, 0.465f}; // um
    const int hot = step % EMBER_STEPS;
    const float part = (float)(step / EMBER_STEPS + 1) / EMBER_PARTS;
    const float temperature = 800 + 600 * ((float)hot - 0.5f) / (EMBER_STEPS - 2);
    for (int c = 0; c < 3; c++)
        colour[c] = hot ? part * 2.5f * expf(14388 / 0.61f / 1200 - 14388 / wavelength[c] / temperature) : 0;
}
