#include "synthetic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Corner {
    float rest[3], temperature, peak, mass, rate, ignited;
} Corner;

static const float width = 0.210f, length = 0.297f, mass_min = 0.15f, mass_loss = 0.22f;

static float smooth(float a, float b, float x) {
    float s = (x - a) / (b - a);
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    return s * s * (3 - 2 * s);
}

/// Signed distance (m) outward from the hole's edge.
static float from_edge(SyntheticKind kind, float radius, float x, float y) {
    float cx = kind == SYNTHETIC_HANGING ? 0.01f : 0.012f, cy = kind == SYNTHETIC_HANGING ? -0.5f * length : 0.02f;
    float dx = x - cx, dy = y - cy, angle = atan2f(dy, dx), r = sqrtf(dx * dx + dy * dy);
    float wobble = 1 + 0.09f * sinf(3 * angle + 1) + 0.06f * sinf(5 * angle + 0.4f) + 0.035f * sinf(11 * angle);
    return r - radius * wobble;
}

static Corner corner_at(SyntheticKind kind, float radius, float x, float y) {
    Corner c = {.rest = {x, y, 0}, .temperature = 293, .peak = 293, .mass = 1, .ignited = -1};
    float s = from_edge(kind, radius, x, y), front = 0.0085f;
    float burn = 0.918f * (1 - smooth(-0.25f * front, front, s)) + (s < 0 ? -s * 6 : 0);

    // flakes that went out before they were gone
    float flake = sinf(x * 140 + 1.7f) * sinf(y * 117 + 0.3f) + 0.5f * sinf(x * 260 + y * 90);
    bool ash = s < -0.004f && flake > 0.92f;
    float limit = ash ? 0.90f - 0.2f * smooth(0.92f, 1.4f, flake) : 1;
    burn = burn > limit ? limit : burn;
    c.mass = 1 - burn * (1 - mass_min);
    if (c.mass < mass_min) c.mass = mass_min;
    float ahead = s > 0.0035f ? expf(-(s - 0.0035f) / 0.0042f) : 1 - 0.25f * smooth(0, 0.02f, 0.0035f - s);
    c.temperature = c.peak = 293 + 830 * ahead;
    c.rate = 0.9f * expf(-(s - 0.001f) * (s - 0.001f) / (0.005f * 0.005f));
    if (ash || kind == SYNTHETIC_COLD) c.temperature = 293 + 90 * ahead, c.rate = 0;
    if (burn > 0) c.ignited = 1 - 40 * s;
    return c;
}

static void position(SyntheticKind kind, float radius, const float rest[3], float out[3]) {
    float x = rest[0], y = rest[1], s = from_edge(kind, radius, x, y);
    float near = expf(-(s > 0 ? s : 0) / 0.016f), angle = atan2f(y - 0.02f, x - 0.012f);
    float curl = near * (0.006f + 0.0045f * sinf(6 * angle) + 0.002f * sinf(17 * angle + 2));

    if (s < 0) curl *= expf(s / 0.012f);
    if (kind == SYNTHETIC_HANGING) {
        float low = 0.5f - y / length;
        out[0] = x * (1 - 0.04f * near);
        out[1] = 0.022f * low * sinf(x * 21 + 0.6f) * low + 1.7f * curl - 0.02f * low * low;
        out[2] = 0.36f + y + 0.6f * near * 0.006f;
    } else {
        out[0] = x, out[1] = y;
        float wave = 1 + sinf(x * 31 + 2) * sinf(y * 23), corner = smooth(0.12f, 0.19f, fabsf(x + y * 0.35f));
        out[2] = 0.0012f + curl + 0.0009f * wave + 0.0125f * corner;
    }
}

static void add_vertex(SyntheticKind kind, float radius, SingeSurface *s, const Corner *c) {
    uint32_t i = s->vertex_count++;
    memcpy(s->rest_position[i], c->rest, sizeof c->rest);
    float p[3], px[3], py[3], e = 2e-4f;
    float rx[3] = {c->rest[0] + e, c->rest[1], 0}, ry[3] = {c->rest[0], c->rest[1] + e, 0};
    position(kind, radius, c->rest, p), position(kind, radius, rx, px), position(kind, radius, ry, py);
    float a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = px[k] - p[k], b[k] = py[k] - p[k];
        s->position[i][k] = p[k], s->velocity[i][k] = 0;
    }
    float n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    float l = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) s->normal[i][k] = n[k] / l;
    s->uv[i][0] = c->rest[0] / width + 0.5f, s->uv[i][1] = c->rest[1] / length + 0.5f;
    s->temperature[i] = c->temperature, s->temperature_peak[i] = c->peak;
    s->mass[i] = c->mass, s->burn_rate[i] = c->rate;
    s->burn[i] = (1 - c->mass) / (1 - mass_min), s->time_ignited[i] = c->ignited;
    s->piece[i] = 0, s->source_vertex[i] = -1, s->sheet[i] = 0;
}

static Corner between(const Corner *a, const Corner *b, float t) {
    Corner c = *a;
    for (int k = 0; k < 3; k++) c.rest[k] += t * (b->rest[k] - a->rest[k]);
    c.temperature += t * (b->temperature - a->temperature), c.peak += t * (b->peak - a->peak),
        c.mass += t * (b->mass - a->mass);
    c.rate += t * (b->rate - a->rate);
    return c;
}

/// Clips the triangle at m = mass_loss and adds what is left as a fan.
static void add_triangle(SyntheticKind kind, float radius, SingeSurface *s, const Corner corners[3]) {
    Corner kept[4];
    int count = 0;
    for (int k = 0; k < 3; k++) {
        const Corner *a = &corners[k], *b = &corners[(k + 1) % 3];
        float da = a->mass - mass_loss, db = b->mass - mass_loss;
        if (da >= 0) kept[count++] = *a;
        if ((da >= 0) != (db >= 0)) kept[count++] = between(a, b, da / (da - db));
    }

    uint32_t first = s->vertex_count;
    for (int k = 0; k < count; k++) add_vertex(kind, radius, s, &kept[k]);
    for (int k = 2; k < count; k++) {
        uint32_t *t = s->triangles[s->triangle_count++];
        t[0] = first, t[1] = first + (uint32_t)k - 1, t[2] = first + (uint32_t)k;
    }
}

static bool reserve(SingeSurface *s, size_t vertices, size_t triangles) {
    memset(s, 0, sizeof *s);
    s->position = malloc(vertices * sizeof *s->position), s->normal = malloc(vertices * sizeof *s->normal);
    s->uv = malloc(vertices * sizeof *s->uv), s->velocity = malloc(vertices * sizeof *s->velocity);
    s->rest_position = malloc(vertices * sizeof *s->rest_position);
    s->temperature = malloc(vertices * sizeof(float)), s->temperature_peak = malloc(vertices * sizeof(float));
    s->mass = malloc(vertices * sizeof(float));
    s->burn_rate = malloc(vertices * sizeof(float)), s->burn = malloc(vertices * sizeof(float));
    s->time_ignited = malloc(vertices * sizeof(float)), s->piece = malloc(vertices * sizeof(int32_t));
    s->source_vertex = malloc(vertices * sizeof(int32_t)), s->sheet = malloc(vertices * sizeof(int32_t));
    s->triangles = malloc(triangles * sizeof *s->triangles);
    return s->position && s->normal && s->uv && s->velocity && s->rest_position && s->temperature &&
           s->temperature_peak && s->mass && s->burn_rate && s->burn && s->time_ignited && s->piece &&
           s->source_vertex && s->sheet && s->triangles;
}

bool synthetic_make(SyntheticKind kind, int cells_x, float radius, SingeSurface *surface) {
    int cells_y = (int)((float)cells_x * length / width + 0.5f);
    size_t cells = (size_t)cells_x * (size_t)cells_y;
    if (!reserve(surface, cells * 16, cells * 8)) {
        synthetic_free(surface);
        return false;
    }
    for (int j = 0; j < cells_y; j++)
        for (int i = 0; i < cells_x; i++) {
            float dx = width / (float)cells_x, dy = length / (float)cells_y;
            float x0 = dx * (float)i - 0.5f * width, x1 = dx * (float)(i + 1) - 0.5f * width;
            float y0 = dy * (float)j - 0.5f * length, y1 = dy * (float)(j + 1) - 0.5f * length;
            Corner c[4] = {corner_at(kind, radius, x0, y0), corner_at(kind, radius, x1, y0),
                           corner_at(kind, radius, x1, y1), corner_at(kind, radius, x0, y1)};
            Corner centre = corner_at(kind, radius, 0.5f * (x0 + x1), 0.5f * (y0 + y1));
            for (int k = 0; k < 4; k++) {
                Corner triangle[3] = {c[k], c[(k + 1) % 4], centre};
                add_triangle(kind, radius, surface, triangle);
            }
        }
    return true;
}

void synthetic_free(SingeSurface *s) {
    free(s->position), free(s->normal), free(s->uv), free(s->velocity), free(s->rest_position), free(s->temperature);
    free(s->temperature_peak), free(s->mass), free(s->burn_rate), free(s->burn), free(s->time_ignited), free(s->piece),
        free(s->source_vertex);
    free(s->sheet), free(s->triangles);
    memset(s, 0, sizeof *s);
}
