// Vertex colours of burning paper and cloth, for programs that draw them.
#pragma once

#include "formats/output.h"

/// Below these a vertex looks unburnt: peak temperature, K; burn progress.
#define BURN_COLOUR_PEAK 348.0f
#define BURN_COLOUR_MIN 1e-3f

/// Linear colour of the surface, without emission.
void burn_colour(const OutputSheet *sheet, const SingeSurface *surface, uint32_t vertex, float colour[3]);

/// Steps of ember_colour: of the temperature, 0 is dark, the others from 800 K to 1400 K; of the part that glows, to all.
enum { EMBER_STEPS = 64, EMBER_PARTS = 16, EMBER_ALL = EMBER_STEPS * (EMBER_PARTS - 1) };
static inline uint16_t ember_step(float temperature) {
    if (!(temperature >= 800)) return 0;
    const float step = 1 + (temperature - 800) / 600 * (EMBER_STEPS - 2);
    return (uint16_t)(step < EMBER_STEPS - 1 ? step : EMBER_STEPS - 1);
}
/// The red component of a vertex, without steps; 0 below 800 K.
float ember_light(const SingeSurface *surface, uint32_t vertex);
/// The step of a vertex, below EMBER_STEPS * EMBER_PARTS.
uint16_t ember_vertex(const SingeSurface *surface, uint32_t vertex);
/// Linear emission, 2.5 in red at 1200 K where all glows, in its blackbody colour. EMBER_ALL + ember_step(T): that at T.
void ember_colour(uint16_t step, float colour[3]);
