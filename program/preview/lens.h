// The camera, and the points at which a picture is sampled (lens.c).
#pragma once

#include "preview/noise.h"
#include "preview/preview.h"

typedef struct Camera {
    Float3 eye, right, up, forward; ///< right and up reach the border of the picture at distance 1
    Float3 lens_right, lens_up;     ///< the lens' radius
    float lens, focus;              ///< m, its radius and the distance in focus
    float pixel;                    ///< size of a pixel at distance 1
    float reach;                    ///< m, eye to target
} Camera;

Camera camera_make(const PreviewDef *def);

/// A ray through a point of the lens, `disc` within the unit circle.
void camera_ray(const Camera *camera, float x, float y, const float disc[2], Float3 *origin, Float3 *direction);

/// Radius, in pixels, over which a point at that depth is spread.
float camera_blur(const Camera *camera, float depth);

/// Point `index` of a low-discrepancy sequence in the square, turned by (a, b).
void sample_square(uint32_t index, float a, float b, float out[2]);

/// The same for the lens, and a number for the time, by a pixel's key, independent of the others.
void sample_lens(uint32_t index, uint32_t key, float out[2]);
float sample_time(uint32_t index, uint32_t key);

/// A number from 0 to 1, independent of all of these because it is no multiple of an irrational one: 0, 1/2, 1/4, 3/4, 1/8 ...
float sample_half(uint32_t index);

/// A pixel's own random number.
uint32_t sample_key(int x, int y, uint32_t seed);

/// Two numbers for a pixel that differ strongly from its neighbours'.
void sample_pixel(int x, int y, uint32_t seed, float out[2]);
Float3 sample_cosine(Float3 normal, const float square[2]);
void sample_disc(const float square[2], float out[2]);
