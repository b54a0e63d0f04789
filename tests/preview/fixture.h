// Shared by the tests of the preview: a small picture from above, a quad of paper, and a ball of gas.
#pragma once

#include "preview/preview.h"
#include "support/test.h"

enum { W = 96, H = 64, BYTES = W * H * 3 };

static const SingeSurface nothing = {0}; ///< for pictures without sheets

/// The light of these tests: a low sun, a bright sky and a table, so that everything in a picture shows.
static inline PreviewDef by_day(void) {
    PreviewDef def = preview_default();
    def.samples = 8;
    def.camera = (PreviewCamera){.eye = {0, -0.42f, 0.34f}, .target = {0, -0.01f, 0}, .up = {0, 0, 1}, .fov = 0.6f};
    const float direction[3] = {-0.55f, 0.45f, 0.62f}, sun[3] = {2.2f, 2.05f, 1.85f}, sky[3] = {0.4f, 0.45f, 0.53f};
    const float ground[3] = {0.235f, 0.145f, 0.085f}, background[3] = {0.16f, 0.15f, 0.145f};
    def.sun_angle = 0.045f;
    for (int k = 0; k < 3; k++) {
        def.sun_direction[k] = direction[k];
        def.sun_colour[k] = sun[k];
        def.sky_colour[k] = sky[k];
        def.ground_colour[k] = ground[k];
        def.background[k] = background[k];
    }

    return def;
}

static inline PreviewDef small(void) {
    PreviewDef def = by_day();
    def.width = W;
    def.height = H;
    return def;
}

/// A camera straight above the origin: the middle of the picture is the origin, x to the right.
static inline PreviewDef above(void) {
    PreviewDef def = small();
    def.camera = (PreviewCamera){.eye = {0, 0, 0.5f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 0.7f};
    def.sun_direction[0] = 0, def.sun_direction[1] = 0.3f, def.sun_direction[2] = 1;
    return def;
}

static inline Preview *preview_open(const PreviewDef *def) {
    Preview *preview = NULL;
    assert_int_equal(preview_create(def, (SingeAllocator){0}, &preview, NULL), SINGE_OK);
    return preview;
}

static inline void preview_end(Preview **preview) { preview_destroy(*preview); }
#define OwnPreview OWNED(preview_end) Preview

/// A picture with gas, which may be NULL.
static inline void draw_gas(const PreviewDef *def, const SingeSurface *surface, const SingeGas *gas, double time,
                            uint8_t *rgb) {
    OwnPreview *preview = preview_open(def);
    SingeError error = {0};
    if (preview_set_gas(preview, gas, &error)) fail_msg("%s", error.message);
    assert_int_equal(preview_draw(preview, surface, time, rgb, NULL), SINGE_OK);
}

static inline void draw(const PreviewDef *def, const SingeSurface *surface, double time, uint8_t *rgb) {
    draw_gas(def, surface, NULL, time, rgb);
}

/// Layers of a picture with gas, which may be NULL.
static inline void draw_layers(const PreviewDef *def, const SingeSurface *surface, const SingeGas *gas, double time,
                               const PreviewLayers *layers) {
    OwnPreview *preview = preview_open(def);
    assert_int_equal(preview_set_gas(preview, gas, NULL), SINGE_OK);
    assert_int_equal(preview_draw_layers(preview, surface, time, NULL, layers, NULL), SINGE_OK);
}

static inline const uint8_t *pixel(const uint8_t *rgb, int x, int y) { return rgb + 3 * (y * W + x); }

static inline float mean(const uint8_t *rgb, int channel) {
    float sum = 0;
    for (int i = 0; i < W * H; i++) sum += rgb[3 * i + channel];
    return sum / (W * H);
}

/// The surface of what has these arrays; `rested` and `peaked` are those of its positions at rest and hottest so far.
#define SURFACE_OF(s, rested, peaked, vertices, faces)                                                       \
    (SingeSurface) {                                                                                         \
        .vertex_count = (vertices), .triangle_count = (faces), .position = (s)->position,                    \
        .rest_position = (s)->rested, .normal = (s)->normal, .uv = (s)->uv, .temperature = (s)->temperature, \
        .temperature_peak = (s)->peaked, .burn = (s)->burn, .burn_rate = (s)->rate, .sheet = (s)->sheet,     \
        .triangles = (s)->triangles                                                                          \
    }

/// One quad of a fresh sheet of half width `half` at height z, facing up; triangles as the lists ask.
typedef struct Float4 {
    float position[4][3], normal[4][3], uv[4][2], rest[4][3], temperature[4], peak[4], burn[4], rate[4];
    int32_t sheet[4];
    uint32_t triangles[2][3];
    SingeSurface surface;
} Float4;

static inline void quad_make(Float4 *q, float half, float z) {
    memset(q, 0, sizeof *q);
    for (int i = 0; i < 4; i++) {
        float x = i == 1 || i == 2 ? half : -half, y = i >= 2 ? half : -half;
        q->position[i][0] = q->rest[i][0] = x, q->position[i][1] = q->rest[i][1] = y, q->position[i][2] = z;
        q->normal[i][2] = 1, q->uv[i][0] = x > 0, q->uv[i][1] = y > 0, q->temperature[i] = q->peak[i] = 293;
    }
    const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    memcpy(q->triangles, triangles, sizeof triangles);
    q->surface = SURFACE_OF(q, rest, peak, 4, 2);
}

enum { GAS_SIDE = 12, GAS_CELLS = GAS_SIDE * GAS_SIDE * GAS_SIDE };

/// A cube of gas of 12 cells of 8 mm about (x, y, z), in which a ball of `radius` m burns or smokes.
typedef struct Ball {
    float temperature[GAS_CELLS], smoke[GAS_CELLS], flame[GAS_CELLS], velocity[GAS_CELLS][3];
    SingeGas gas;
} Ball;

static inline void ball_make(Ball *b, float x, float y, float z, float radius, float flame, float smoke) {
    const float cell = 0.008f, half = 0.5f * GAS_SIDE * cell;
    memset(b, 0, sizeof *b);
    b->gas = (SingeGas){.size = {GAS_SIDE, GAS_SIDE, GAS_SIDE},
                        .origin = {x - half, y - half, z - half},
                        .cell = cell,
                        .temperature = b->temperature,
                        .smoke = b->smoke,
                        .flame = b->flame,
                        .velocity = (const float(*)[3])b->velocity};
    for (int i = 0; i < GAS_CELLS; i++) {
        float at[3] = {(float)(i % GAS_SIDE), (float)(i / GAS_SIDE % GAS_SIDE), (float)(i / GAS_SIDE / GAS_SIDE)},
              r2 = 0;
        for (int c = 0; c < 3; c++) r2 += (at[c] + 0.5f - 0.5f * GAS_SIDE) * (at[c] + 0.5f - 0.5f * GAS_SIDE);
        bool in = r2 * cell * cell < radius * radius;
        b->temperature[i] = in && flame > 0 ? 1400 : 293, b->flame[i] = in ? flame : 0, b->smoke[i] = in ? smoke : 0;
        b->velocity[i][2] = 1;
    }
}
