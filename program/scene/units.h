// Quantities: numbers with units, by dimension.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// The dimension of a number. Bare numbers are in the first unit of each, which is SI except for angles (degrees).
typedef enum Dimension {
    DIM_NONE,
    DIM_FRACTION,
    DIM_TEMPERATURE,
    DIM_TEMPERATURE_DIFFERENCE,
    DIM_LENGTH,
    DIM_AREA,
    DIM_TIME,
    DIM_ANGLE, ///< held in radians
    DIM_SPEED,
    DIM_ACCELERATION,
    DIM_GRAMMAGE,
    DIM_DENSITY,
    DIM_FLUX,
    DIM_CONDUCTANCE,
    DIM_SPECIFIC_HEAT,
    DIM_SPECIFIC_ENERGY,
    DIM_DIFFUSIVITY,
    DIM_RATE,
    DIM_RATE_PER_KELVIN,
    DIM_COMPLIANCE,
    DIM_CURVATURE,
    DIM_STIFFNESS,
    DIM_MOLAR_ENERGY,
    DIM_FRAME_RATE,
    DIM_POWER,
    DIM_WETTING,
    DIM_BENDING,
    DIM_COUNT
} Dimension;

typedef enum NumberFault { NUMBER_GOOD, NUMBER_NOT_ONE, NUMBER_BAD_UNIT } NumberFault;

/// Reads all of `text` as a number and perhaps a unit, in the "C" locale's notation. *value is in the
/// dimension's held unit (SI, radians).
NumberFault quantity_read(const char *text, Dimension dimension, double *value);

/// "meter", "kg/m2": the unit of bare numbers; "" for pure numbers.
const char *quantity_unit(Dimension dimension);
const char *quantity_name(Dimension dimension);

/// "a", or "an" before the names that begin with a vowel.
const char *quantity_article(Dimension dimension);

/// All units of a dimension, "K, C, F".
void quantity_units(Dimension dimension, char *buffer, size_t size);

/// The shortest bare number that quantity_read, rounded to float, reads back as `value`.
void quantity_print(float value, Dimension dimension, char *buffer, size_t size);
