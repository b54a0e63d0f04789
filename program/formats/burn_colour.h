// Vertex colours of burning paper and cloth, for programs that draw them.
#pragma once

#include "formats/output.h"

/// Below these a vertex looks unburnt: peak temperature, K; burn progress.
#define BURN_COLOUR_PEAK 348.0f
#define BURN_COLOUR_MIN 1e-3f

/// Linear colour of the surface, without emission.
void burn_colour(const OutputSheet *sheet, const SingeSurface *surface, uint32_t vertex, float colour[3]);

/// Steps of ember_colour: 0 is dark, the others from 800 K to 1400 K.
enum { EMBER_STEPS = 64 };
static inline uint8_t ember_step(float temperature) {
    if (!(temperature >= 800)) return 0;
    const float step = 1 + (temperature - 800) / 600 * (EMBER_STEPS - 2);
    return (uint8_t)(step < EMBER_STEPS - 1 ? step : EMBER_STEPS - 1);
}
/// A vertex that has burnt less does not glow: it is in a flame.
#define EMBER_BURNT 0.15f
/// The red component, without steps; 0 below 800 K.
float ember_light(float temperature);
/// Linear emission of an ember, 2.5 in red at 1200 K, in its blackbody colour.
void ember_colour(uint8_t step, float colour[3]);
