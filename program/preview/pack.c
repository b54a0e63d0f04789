// A frame for a renderer elsewhere (`singe view`), in little-endian bytes; web/view/frame.js reads them. In this order:
//
//   PackHead
//   PackVertex [vertex_count], PackShape [shape_count], uint32_t triangles [triangle_count][3]
//   uint8_t cells [size[2]][size[1]][size[0]][4]: flame in FLAME_MOST; its height above the paper in FLAME_END times
//                                                 Fire.scale, as far as eddies bring it; smoke in PACK_SMOKE; 0
//
// The gas is cut to the box in which there is something to see.
//
// Stretch is the largest principal stretch of a triangle against its rest shape, less one, so that char that has shrunk is
// negative: of the metric C of its edges in an orthonormal frame at rest, sqrt of the larger eigenvalue. A vertex takes the
// mean of its triangles by area.

#include "preview/internal.h"

#include <stdlib.h>
#include <string.h>

#define PACK_MAGIC 0x31465653u ///< "SVF1"
#define PACK_KELVIN 5000.0f
#define PACK_RATE 64.0f      ///< 1/s
#define PACK_GRADIENT 400.0f ///< 1/m
#define PACK_AGE 655.35f     ///< s
#define PACK_WARMING 1.2e5f  ///< K/m
#define PACK_SPACING 0.0655f ///< m
#define PACK_SMOKE 20.0f     ///< 1/m

typedef struct PackLight {
    float position[3], softness; ///< m, m2: see EmberLights
    float strength[3], unused;
} PackLight;

typedef struct PackHead {
    uint32_t magic, vertex_count, triangle_count, shape_count, light_count;
    uint32_t size[3];      ///< cells of the gas; 0: none
    float time, cell;      ///< s, m
    float corner[3];       ///< m, of its first cell
    float low[3], high[3]; ///< m, of the sheets
    float unused;
    PackLight lights[LIGHT_LIMIT];
} PackHead;

typedef struct PackVertex {
    float position[3];
    int8_t normal[3], sheet; ///< normal in 1/127; a sheet of many is 127
    float rest[3], uv[2];
    uint16_t temperature, peak, rate, warming; ///< of PACK_KELVIN, PACK_RATE and PACK_WARMING
    uint16_t burn, gradient, rim, age;         ///< of 1, PACK_GRADIENT, 1 and PACK_AGE
    uint16_t mass, kind, stretch, spacing;     ///< of 1, 1, from -1 to 3, and PACK_SPACING
    int32_t source; ///< vertex of the input, -1: none. kind: what burns, 0 fuel, 1/2 fuel with char, 1 char alone
} PackVertex;

typedef struct PackShape {
    int32_t kind; ///< SingeColliderKind
    float position[3], rotation[4], half_size[3], radius, height, colour[3], temperature;
    int32_t solid; ///< 1: a mesh that stays the same, 2: one that changes, 0: none
} PackShape;

_Static_assert(sizeof(PackHead) == 80 + 32 * LIGHT_LIMIT && sizeof(PackVertex) == 64 && sizeof(PackShape) == 72,
               "the layout that frame.js reads");

static uint8_t byte_part(float x, float whole) { return (uint8_t)(clampf(x / whole, 0, 1) * 255 + 0.5f); }
static uint16_t part(float x, float whole) { return (uint16_t)(clampf(x / whole, 0, 1) * 65535 + 0.5f); }

/// A triangle's stretch; *area is twice its area at rest, 0 if it has none.
static float triangle_stretch(const SingeSurface *surface, const uint32_t t[3], float *area) {
    Float3 rest[3], position[3];
    for (int k = 0; k < 3; k++) {
        rest[k] = float3_sub(float3_load(surface->rest_position[t[k]]), float3_load(surface->rest_position[t[0]]));
        position[k] = float3_sub(float3_load(surface->position[t[k]]), float3_load(surface->position[t[0]]));
    }
    const float base = float3_length(rest[1]);
    const float twice = float3_length(float3_cross(rest[1], rest[2]));
    *area = 0;
    if (!(twice > 1e-14f) || !(base > 0)) return 0;
    *area = twice;

    // at rest the edges are (base, 0) and (x, y): the deformation's columns are a and b
    const float x = float3_dot(rest[1], rest[2]) / base;
    Float3 a = float3_scale(position[1], 1 / base);
    Float3 b = float3_scale(float3_mad(position[2], a, -x), base / twice);
    const float sum = 0.5f * (float3_dot(a, a) + float3_dot(b, b));
    const float half = 0.5f * (float3_dot(a, a) - float3_dot(b, b));
    const float shear = float3_dot(a, b);
    return clampf(sqrtf(sum + sqrtf(half * half + shear * shear)) - 1, -1, 3);
}

float preview_stretch(const SingeSurface *surface, uint32_t vertex) {
    float sum = 0, total = 0;
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        const uint32_t *t = surface->triangles[i];
        if (t[0] != vertex && t[1] != vertex && t[2] != vertex) continue;
        float area, stretch = triangle_stretch(surface, t, &area);
        sum += area * stretch;
        total += area;
    }
    return total > 0 ? sum / total : 0;
}

static void pack_vertices(const PreviewScene *scene, const SingeSurface *surface, float (*stretch)[2],
                          PackVertex *out) {
    for (uint32_t i = 0; i < scene->vertex_count; i++, out++) {
        const PaperVertex *v = &scene->vertices[i];
        *out = (PackVertex){
            .sheet = (int8_t)(v->sheet < 0 || v->sheet > 127 ? 127 : v->sheet),
            .temperature = part(v->temperature, PACK_KELVIN),
            .peak = part(v->peak, PACK_KELVIN),
            .rate = part(v->burn_rate, PACK_RATE),
            .warming = part(v->heat_gradient, PACK_WARMING),
            .burn = part(v->burn, 1),
            .gradient = part(v->gradient, PACK_GRADIENT),
            .rim = part(v->rim, 1),
            .age = part(v->age, PACK_AGE),
            .mass = part(surface->mass ? surface->mass[i] : 1, 1),
            .kind = part(v->flaming > 0 ? (v->starved > 0 ? 0.5f : 0) : 1, 1),
            .stretch = part(1 + (stretch[i][1] > 0 ? stretch[i][0] / stretch[i][1] : 0), 4),
            .spacing = part(v->spacing, PACK_SPACING),
            .source = surface->source_vertex ? surface->source_vertex[i] : -1,
        };
        for (int c = 0; c < 3; c++) {
            out->position[c] = scene->positions[i][c];
            out->normal[c] = (int8_t)(127 * clampf(v->normal[c], -1, 1));
            out->rest[c] = v->rest[c];
        }
        memcpy(out->uv, v->uv, sizeof out->uv);
    }
}

/// The box of cells that are seen, within the border, in the head; and its first cell.
static void pack_box(const Fire *fire, PackHead *head, int first[3]) {
    float low[3], high[3], origin[3];
    float3_store(low, fire->low);
    float3_store(high, fire->high);
    float3_store(origin, fire->origin);
    head->cell = fire->cell;
    for (int c = 0; c < 3; c++) {
        const int from = (int)floorf((low[c] - origin[c]) / fire->cell) - 1;
        const int to = (int)ceilf((high[c] - origin[c]) / fire->cell) + 1;
        const int last = to < fire->size[c] - 1 ? to : fire->size[c] - 1;
        first[c] = from > 0 ? from : 0;
        head->size[c] = last >= first[c] ? (uint32_t)(last - first[c] + 1) : 0;
        head->corner[c] = origin[c] + ((float)first[c] - 0.5f) * fire->cell;
    }
}

static void pack_shapes(const Preview *preview, PackShape *out) {
    for (uint32_t k = 0; k < preview->shape_count; k++, out++) {
        const PreviewShape *shape = &preview->shapes[k];
        *out = (PackShape){.kind = (int32_t)shape->kind,
                           .radius = shape->radius,
                           .height = shape->height,
                           .temperature = shape->temperature,
                           .solid = !shape->solid           ? 0
                                    : shape->solid->passing ? 2
                                                            : 1};
        memcpy(out->position, shape->position, sizeof out->position);
        memcpy(out->rotation, shape->rotation, sizeof out->rotation);
        memcpy(out->half_size, shape->half_size, sizeof out->half_size);
        memcpy(out->colour, shape->colour, sizeof out->colour);
    }
}

SingeResult preview_pack(Preview *preview, const SingeSurface *surface, double time, uint8_t **bytes, size_t *size,
                         SingeError *error) {
    *bytes = NULL;
    preview->time = time;
    TRY(mesh_load(preview, surface, error));
    fire_raise(preview);
    light_gather(preview);

    const PreviewScene *scene = &preview->scene;
    const Fire *fire = &preview->fire;
    PackHead head = {.magic = PACK_MAGIC,
                     .vertex_count = scene->vertex_count,
                     .triangle_count = scene->triangle_count,
                     .shape_count = preview->shape_count,
                     .light_count = (uint32_t)scene->light_count,
                     .time = (float)time,
                     .low = {scene->low.x, scene->low.y, scene->low.z},
                     .high = {scene->high.x, scene->high.y, scene->high.z}};
    int first[3] = {0, 0, 0};
    if (fire->size[0] && fire->visible) pack_box(fire, &head, first);

    const EmberLights *lights = &scene->lights;
    for (int k = 0; k < scene->light_count; k++)
        head.lights[k] = (PackLight){{lights->x[k], lights->y[k], lights->z[k]},
                                     lights->softness[k],
                                     {lights->strength[0][k], lights->strength[1][k], lights->strength[2][k]},
                                     0};

    const size_t cells = (size_t)head.size[0] * head.size[1] * head.size[2];
    const size_t vertices = sizeof(PackVertex) * head.vertex_count, shapes = sizeof(PackShape) * head.shape_count;
    const size_t triangles = sizeof *scene->triangles * head.triangle_count;
    *size = sizeof head + vertices + shapes + triangles + 4 * cells;
    uint8_t *out = malloc(*size);
    float(*stretch)[2] = calloc((size_t)head.vertex_count + 1, sizeof *stretch);
    if (!out || !stretch) {
        free(out);
        free(stretch);
        return preview_fail(error, SINGE_ERROR_MEMORY, -1, "out of memory for a frame of %u vertices",
                            head.vertex_count);
    }

    for (uint32_t t = 0; t < head.triangle_count; t++) {
        float area, most = triangle_stretch(surface, scene->triangles[t], &area);
        for (int k = 0; k < 3; k++) {
            stretch[scene->triangles[t][k]][0] += area * most;
            stretch[scene->triangles[t][k]][1] += area;
        }
    }
    *bytes = out;
    memcpy(out, &head, sizeof head);
    pack_vertices(scene, surface, stretch, (PackVertex *)(void *)(out + sizeof head));
    pack_shapes(preview, (PackShape *)(void *)(out + sizeof head + vertices));
    if (triangles) memcpy(out + sizeof head + vertices + shapes, scene->triangles, triangles);

    uint8_t *cell_out = out + sizeof head + vertices + shapes + triangles;
    for (size_t i = 0; i < cells; i++, cell_out += 4) {
        const size_t x = i % head.size[0] + (size_t)first[0];
        const size_t y = i / head.size[0] % head.size[1] + (size_t)first[1];
        const size_t z = i / head.size[0] / head.size[1] + (size_t)first[2];
        const size_t at = x + (size_t)fire->size[0] * (y + (size_t)fire->size[1] * z);
        const FireCell *cell = &fire->cells[at];
        cell_out[0] = byte_part(cell->flame, FLAME_MOST);
        cell_out[1] = byte_part(fire->sway[at][2], FLAME_END * fire->scale);
        cell_out[2] = byte_part(cell->smoke, PACK_SMOKE);
        cell_out[3] = 0;
    }
    free(stretch);
    return SINGE_OK;
}

void preview_light(const Preview *preview, float sun[3], float towards[3], float ambient[9][3]) {
    float3_store(sun, preview->sun_light);
    float3_store(towards, preview->sun);
    for (int k = 0; k < 9; k++) float3_store(ambient[k], preview->sky.ambient[k]);
}
