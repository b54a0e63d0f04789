// What a picture shows of its fire: the width of the ember line, how pale and how flat its flames are, and how far these
// stand from what burns.
//
// A pixel glows if its luminance is at least a tenth of that of the brightest hundredth of the glowing pixels. From
// each such pixel, lines in eight directions run both ways to the end of the glow or the sheet. The shortest of the
// eight, measured between its ends in space, is the width of the ember line there; with eight directions its error is
// at most 2 %. The frame's width is the median over its pixels.
//
// A foot is a lowest place of what is seen of the flames, if they rise by FOOT_TALL from there before they join others
// that begin lower, in front of a sheet: so the lower side of a flame that leans has none, nor has one that has torn off.
// Its distance is that, in the picture, to the nearest vertex that gives off fuel and is seen, at that vertex's depth. A
// flame that comes up behind an edge has its foot out of sight.
//
// A flame that is seen in front of whole paper stands on nothing where no fuel is seen below it, within FOOT_FAR or a lean
// of FOOT_LEAN.

#include "preview/internal.h"
#include "common/order.h"

#include <stdlib.h>
#include <string.h>

#define FOOT_TALL 0.004f ///< m
#define FOOT_FAR 0.005f  ///< m
#define FOOT_EDGE 0.005f ///< m, by which what hides a foot is nearer than what is seen above it
#define FOOT_FUEL 0.02f  ///< 1/s, rate at which paper burns that feeds a flame
#define FOOT_SEEN 0.003f ///< m, by which fuel may be behind what is seen
#define FOOT_LEAN 0.5f   ///< to the side, for one up
#define FOOT_WHOLE 0.1f  ///< burnt share, up to which paper is whole

enum { DIRECTIONS = 8, WALK_LIMIT = 96, FLAMES_FEWEST = 100 }; // pixels of which a share is no noise

typedef struct GlowPicture {
    const PreviewLayers *layers;
    Camera camera;
    int width, height;
    float min; ///< min luminance of glow
} GlowPicture;

static float luminance(const GlowPicture *picture, size_t pixel) {
    return picture->layers->sheet[pixel] < 0 ? 0 : float3_luminance(float3_load(picture->layers->glow[pixel]));
}

static Float3 glow_position(const GlowPicture *picture, int x, int y) {
    const Camera *camera = &picture->camera;
    float u = 2 * ((float)x + 0.5f) / (float)picture->width - 1, v = 1 - 2 * ((float)y + 0.5f) / (float)picture->height;
    Float3 ray = float3_mad(float3_mad(camera->forward, camera->right, u), camera->up, v);
    return float3_mad(camera->eye, ray, picture->layers->depth[(size_t)y * (size_t)picture->width + (size_t)x]);
}

static bool glows(const GlowPicture *picture, int x, int y) {
    if (x < 0 || y < 0 || x >= picture->width || y >= picture->height) return false;
    return luminance(picture, (size_t)y * (size_t)picture->width + (size_t)x) >= picture->min;
}

/// The last glowing pixel from (x, y) along (dx, dy).
static void glow_walk(const GlowPicture *picture, int x, int y, float dx, float dy, int end[2]) {
    end[0] = x;
    end[1] = y;
    for (int step = 1; step <= WALK_LIMIT; step++) {
        int to[2] = {x + (int)lroundf((float)step * dx), y + (int)lroundf((float)step * dy)};
        if (!glows(picture, to[0], to[1])) return;
        end[0] = to[0];
        end[1] = to[1];
    }
}

SingeResult preview_glow_width(const PreviewDef *def, const PreviewLayers *layers, double *width, SingeError *error) {
    GlowPicture picture = {.layers = layers, .camera = camera_make(def), .width = def->width, .height = def->height};
    size_t count = (size_t)def->width * (size_t)def->height, lit = 0;
    *width = (double)NAN;
    float *values = malloc(count * sizeof *values);
    if (!values) return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory");
    for (size_t i = 0; i < count; i++) {
        float value = luminance(&picture, i);
        if (value > 1e-3f) values[lit++] = value;
    }

    if (!lit) {
        free(values);
        return SINGE_OK;
    }

    qsort(values, lit, sizeof *values, order_by_float);
    picture.min = 0.1f * values[lit - 1 - lit / 100];

    lit = 0;
    for (size_t pixel = 0; pixel < count; pixel++) {
        int x = (int)(pixel % (size_t)def->width), y = (int)(pixel / (size_t)def->width);
        if (!glows(&picture, x, y)) continue;
        float min = INFINITY;
        for (int k = 0; k < DIRECTIONS; k++) {
            float angle = PI_F * (float)k / DIRECTIONS, dx = cosf(angle), dy = sinf(angle);
            int a[2], b[2];
            glow_walk(&picture, x, y, dx, dy, a);
            glow_walk(&picture, x, y, -dx, -dy, b);

            // between the centres of the end pixels, plus half of each
            Float3 across = float3_sub(glow_position(&picture, a[0], a[1]), glow_position(&picture, b[0], b[1]));
            min = minf(min, float3_length(across) + layers->depth[pixel] * picture.camera.pixel);
        }

        values[lit++] = min;
    }

    qsort(values, lit, sizeof *values, order_by_float);
    *width = (double)values[lit / 2];
    free(values);
    return SINGE_OK;
}

/// Whether a flame is the brightest part of a pixel.
static bool is_flame(const PreviewLayers *layers, const uint8_t *rgb, size_t i) {
    const float fire = float3_luminance(float3_load(layers->fire[i]));
    return pixel_flames(rgb + 3 * i) && fire >= 0.5f * float3_luminance(float3_load(layers->beauty[i]));
}

void preview_flame_shares(const PreviewDef *def, const PreviewLayers *layers, const uint8_t *rgb, FlameShares *shares) {
    const size_t count = (size_t)def->width * (size_t)def->height;
    size_t flame = 0, pale = 0, lemon = 0;

    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = rgb + 3 * i;
        if (!is_flame(layers, rgb, i)) continue;
        flame++;
        pale += pixel_is_pale(p);
        lemon += pixel_is_lemon(p);
    }

    const bool enough = flame >= FLAMES_FEWEST;
    shares->pale = enough ? (double)pale / (double)flame : (double)NAN;
    shares->lemon = enough ? (double)lemon / (double)flame : (double)NAN;
}

// ---- feet

/// Pixels of a row that are flame, and the tongue that they belong to. Of a tongue: where it begins.
typedef struct FlameRun {
    int first, last;
    int tongue; ///< itself, or a run below that stands for it
    int x, y, top;
} FlameRun;

typedef struct FeetPicture {
    const PreviewLayers *layers;
    int width, height, run_count;
    Camera camera;
    FlameRun *runs;
    float (*fuel)[3]; ///< pixels from the upper left, and depth, m
    uint32_t fuel_count;
    float *far; ///< m, of each foot
    int count;
    float *aside; ///< [width]
} FeetPicture;

static int tongue_of(FlameRun *runs, int run) {
    while (runs[run].tongue != run) run = runs[run].tongue = runs[runs[run].tongue].tongue;
    return run;
}

/// A tongue has ended at a row, or joined another.
static void add_foot(FeetPicture *picture, const FlameRun *tongue, int end) {
    const float pixel = picture->camera.pixel;
    const int below = tongue->y + 2;
    if ((float)(tongue->y - end) * pixel * picture->camera.reach < FOOT_TALL || below >= picture->height) return;

    float square = INFINITY;
    for (uint32_t i = 0; i < picture->fuel_count; i++) {
        const float *fuel = picture->fuel[i];
        const float dx = (float)tongue->x + 0.5f - fuel[0], dy = (float)tongue->y + 0.5f - fuel[1];
        square = minf(square, (dx * dx + dy * dy) * fuel[2] * fuel[2]);
    }

    const float far = sqrtf(square) * pixel, *depth = picture->layers->depth + tongue->x;
    const size_t row = (size_t)picture->width;
    if (picture->layers->sheet[row * (size_t)below + (size_t)tongue->x] < 0) return;
    const bool edge = depth[row * (size_t)below] < depth[row * (size_t)tongue->y] - FOOT_EDGE;
    if (edge && far > FOOT_FAR) return;
    picture->far[picture->count++] = far;
}

/// Row after row from below.
static void find_feet(FeetPicture *picture, const uint8_t *rgb) {
    FlameRun *runs = picture->runs;
    int below = 0, count = 0; // the row below begins at `below`
    for (int y = picture->height - 1; y >= 0; y--) {
        const int end = count;
        for (int x = 0; x < picture->width; x++) {
            const size_t row = (size_t)y * (size_t)picture->width;
            if (!is_flame(picture->layers, rgb, row + (size_t)x)) continue;
            const int first = x;
            while (x + 1 < picture->width && is_flame(picture->layers, rgb, row + (size_t)x + 1)) x++;
            runs[count] = (FlameRun){first, x, count, (first + x) / 2, y, y};
            count++;
        }

        // each run joins those below that it touches
        for (int run = end; run < count; run++) {
            for (; below < end && runs[below].last < runs[run].first - 1; below++) {
            }
            for (int next = below; next < end && runs[next].first <= runs[run].last + 1; next++) {
                const int a = tongue_of(runs, next), b = tongue_of(runs, run);
                if (a == b) continue;
                const int low = runs[a].y >= runs[b].y ? a : b, high = low == a ? b : a;
                add_foot(picture, &runs[high], y);
                runs[high].tongue = low;
                runs[low].top = y;
            }
        }
        below = end;
    }

    for (int run = 0; run < count; run++)
        if (runs[run].tongue == run) add_foot(picture, &runs[run], runs[run].top);
}

/// The share of the flames in front of whole paper that stand on nothing.
static double find_astray(FeetPicture *picture, const uint8_t *rgb) {
    const PreviewLayers *layers = picture->layers;
    const int width = picture->width, height = picture->height;
    const float near = FOOT_FAR / (picture->camera.pixel * picture->camera.reach);
    float *row = picture->aside; // pixels aside of flames that stand on fuel, at the row below
    int flames = 0, astray = 0;
    for (int x = 0; x < width; x++) row[x] = INFINITY;

    for (int y = height - 1; y >= 0; y--) {
        for (uint32_t i = 0; i < picture->fuel_count; i++) {
            const float *fuel = picture->fuel[i];
            if ((int)minf(fuel[1] + near / FOOT_LEAN, (float)height - 1) == y)
                row[(int)fuel[0]] = minf(row[(int)fuel[0]], 0);
        }
        for (int x = 1; x < width; x++) row[x] = minf(row[x], row[x - 1] + 1);
        for (int x = width - 2; x >= 0; x--) row[x] = minf(row[x], row[x + 1] + 1);
        for (int x = 0; x < width; x++) {
            const size_t i = (size_t)y * (size_t)width + (size_t)x;
            const bool counts = layers->sheet[i] >= 0 && layers->burn[i] < FOOT_WHOLE && is_flame(layers, rgb, i);
            flames += counts, astray += counts && row[x] > 0;
            row[x] -= FOOT_LEAN;
        }
    }

    return flames >= FLAMES_FEWEST ? (double)astray / flames : (double)NAN;
}

SingeResult preview_flame_feet(const PreviewDef *def, const PreviewLayers *layers, const uint8_t *rgb,
                               const SingeSurface *surface, FlameFeet *feet, SingeError *error) {
    FeetPicture picture = {.layers = layers, .width = def->width, .height = def->height, .camera = camera_make(def)};
    const size_t most = ((size_t)def->width / 2 + 1) * (size_t)def->height;
    *feet = (FlameFeet){(double)NAN, (double)NAN, (double)NAN};
    picture.runs = malloc(most * sizeof *picture.runs);
    picture.far = malloc(most * sizeof *picture.far);
    picture.fuel = malloc(((size_t)surface->vertex_count + 1) * sizeof *picture.fuel);
    picture.aside = malloc((size_t)def->width * sizeof *picture.aside);
    const bool room = picture.runs && picture.far && picture.fuel && picture.aside;

    // where vertices that give off fuel are seen in the picture
    const Camera camera = picture.camera;
    const float across = float3_dot(camera.right, camera.right), up = float3_dot(camera.up, camera.up);
    for (uint32_t i = 0; room && i < surface->vertex_count; i++) {
        if (!(ember_at(surface, i, 0, surface->burn_rate[i]).flaming >= FOOT_FUEL)) continue;
        const Float3 to = float3_sub(float3_load(surface->position[i]), camera.eye);
        const float depth = float3_dot(to, camera.forward);
        if (!(depth > 1e-3f)) continue;
        const float x = 0.5f * (float)picture.width * (1 + float3_dot(to, camera.right) / (across * depth));
        const float y = 0.5f * (float)picture.height * (1 - float3_dot(to, camera.up) / (up * depth));
        if (!(x >= 0 && y >= 0 && x < (float)picture.width && y < (float)picture.height)) continue;
        if (picture.layers->depth[(size_t)picture.width * (size_t)y + (size_t)x] < depth - FOOT_SEEN) continue;
        memcpy(picture.fuel[picture.fuel_count++], (const float[3]){x, y, depth}, sizeof *picture.fuel);
    }

    if (room) {
        find_feet(&picture, rgb);
        feet->astray = find_astray(&picture, rgb);
        qsort(picture.far, (size_t)picture.count, sizeof *picture.far, order_by_float);
        if (picture.count && picture.fuel_count) {
            feet->median = (double)picture.far[picture.count / 2];
            feet->most = (double)picture.far[9 * picture.count / 10];
        }
    }

    free(picture.aside);
    free(picture.runs);
    free(picture.far);
    free(picture.fuel);
    return room ? SINGE_OK : preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory");
}
