// Preview: a small path from a drawn surface to a picture, on Embree. Knows surfaces, not simulations.
#ifndef PREVIEW_PREVIEW_H
#define PREVIEW_PREVIEW_H

#include "formats/formats.h"

typedef struct PreviewCamera {
    float eye[3], target[3], up[3]; ///< m
    float fov;                      ///< vertical, radians
} PreviewCamera;

/// A primitive that is drawn: the scene's colliders and hot balls at the frame's time.
typedef struct PreviewShape {
    SingeColliderKind kind;
    float position[3], rotation[4], radius, half_size[3], height;
    float colour[3];    ///< linear albedo
    float temperature;  ///< K; glows by black-body colour above about 800 K
} PreviewShape;

typedef struct PreviewDef {
    int width, height, samples; ///< samples a pixel, >= 1
    int thread_count;
    PreviewCamera camera;
    float sun_direction[3];  ///< towards the light, any length > 0
    float sun_angle;         ///< radians, apparent radius: how soft shadows are
    float sun_colour[3];     ///< of about 2.2 with a sky of 0.4, white paper comes to 230 of 255
    float sky_colour[3];     ///< ambient light from above
    float ground_height;     ///< m, z of the ground; -INFINITY for none
    float ground_colour[3];  ///< linear
    float background[3];
    float exposure;          ///< multiplies before tone mapping
    uint32_t seed;
    const Image *const *pictures;  ///< [sheet_count] picture on both sides of each sheet, NULL entries are white
    const float (*colours)[3];     ///< [sheet_count] tint of each sheet, linear
    uint32_t sheet_count;
    uint32_t shape_count;
    const PreviewShape *shapes;
} PreviewDef;

PreviewDef preview_default(void);

typedef struct Preview Preview;
/// Sets up the device; `def`'s pointers must outlive the Preview.
SINGE_NODISCARD SingeResult preview_create(const PreviewDef *def, SingeAllocator allocator, Preview **preview,
                                           SingeError *error);
/// Replaces the shapes (they move from frame to frame); the array is copied.
SINGE_NODISCARD SingeResult preview_set_shapes(Preview *preview, const PreviewShape *shapes, uint32_t count,
                                               SingeError *error);
/// Draws one frame into rgb[height * width * 3], 8-bit sRGB, rows from the top. `time` drives what
/// flickers. The picture depends neither on the number of threads nor on the frames drawn before. Triangles of a piece
/// share their vertices: by that its borders are known.
SINGE_NODISCARD SingeResult preview_draw(Preview *preview, const SingeSurface *surface, double time, uint8_t *rgb,
                                         SingeError *error);
void preview_destroy(Preview *preview);

#endif
