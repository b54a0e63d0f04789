#include "synthetic_gas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MARGIN = 4, ABOVE = 30 };

static float *plane(size_t count) { return calloc(count, sizeof(float)); }

static bool reserve(SyntheticGas *s) {
    size_t count = (size_t)s->gas.size[0] * s->gas.size[1] * s->gas.size[2];
    s->temperature = plane(count), s->smoke = plane(count), s->flame = plane(count), s->velocity = calloc(count, 12);
    s->gas.temperature = s->temperature, s->gas.smoke = s->smoke, s->gas.flame = s->flame;
    s->gas.velocity = (const float(*)[3])s->velocity;
    return s->temperature && s->smoke && s->flame && s->velocity;
}

static void frame(const SingeSurface *surface, float cell, SyntheticGas *s) {
    float low[3] = {1e9f, 1e9f, 1e9f}, high[3] = {-1e9f, -1e9f, -1e9f};
    for (uint32_t v = 0; v < surface->vertex_count; v++)
        for (int c = 0; c < 3; c++) {
            low[c] = fminf(low[c], surface->position[v][c]), high[c] = fmaxf(high[c], surface->position[v][c]);
        }
    s->gas = (SingeGas){.cell = cell};
    for (int c = 0; c < 3; c++) {
        s->gas.origin[c] = low[c] - MARGIN * cell;
        s->gas.size[c] = (uint32_t)((high[c] - low[c]) / cell) + 2 * MARGIN + (c == 2 ? ABOVE : 0);
    }
}

/// Adds the fuel that the sheet gives off to the cells it lies in; kept in `flame` until it burns.
static void add_fuel(const SingeSurface *surface, SyntheticGas *s) {
    const SingeGas *g = &s->gas;
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t v = surface->triangles[t][0];
        if (surface->burn_rate[v] < 0.02f || surface->temperature[v] < 600) continue;
        float patchy = 0.7f + 0.3f * sinf(surface->rest_position[v][0] * 95 + surface->rest_position[v][1] * 60);
        size_t at[3];
        for (int c = 0; c < 3; c++) at[c] = (size_t)((surface->position[v][c] - g->origin[c]) / g->cell);
        size_t i = at[0] + g->size[0] * (at[1] + (size_t)g->size[1] * at[2]);
        s->flame[i] += 0.16f * surface->burn_rate[v] * patchy * patchy;
    }
}

/// Fuel of the layer below at a point that is not a cell's centre, spread over its neighbours.
static float below(const float *fuel, const uint32_t *n, float x, float y) {
    float sum = 0;
    int ix = (int)floorf(x), iy = (int)floorf(y);
    for (int j = -1; j <= 2; j++)
        for (int i = -1; i <= 2; i++) {
            int cx = ix + i, cy = iy + j;
            if (cx < 0 || cy < 0 || cx >= (int)n[0] || cy >= (int)n[1]) continue;
            float dx = x - (float)cx, dy = y - (float)cy;
            sum += fuel[cx + (int)n[0] * cy] * expf(-2.2f * (dx * dx + dy * dy));
        }
    return sum / 1.428f; // of the Gaussian over the plane
}

static void rise(SyntheticGas *s, float time) {
    const uint32_t *n = s->gas.size;
    size_t layer = (size_t)n[0] * n[1];
    float *fuel = plane(layer), *next = plane(layer);

    for (uint32_t z = 0; z < n[2] && fuel && next; z++) {
        float height = (float)z * s->gas.cell;
        for (uint32_t i = 0; i < layer; i++) {
            float x = (float)(i % n[0]), y = (float)(i / n[0]), wx = x * s->gas.cell, wy = y * s->gas.cell;
            float phase = 55 * (height - 0.7f * time);
            float sway_x = 0.45f * sinf(phase + 40 * wx) + 0.2f * sinf(2.3f * phase + 90 * wy);
            float sway_y = 0.4f * sinf(0.8f * phase + 35 * wx + 2);
            size_t k = i + layer * z;
            float have = (z ? below(fuel, n, x - sway_x, y - sway_y) : 0) + s->flame[k];
            float burnt = have * 0.2f / (1 + 0.8f * have);
            next[i] = have - burnt;
            s->flame[k] = 2.2e7f * burnt;
            s->smoke[k] = 4e-4f * have / (1 + have);
            s->temperature[k] = 293 + 1400 * have / (0.2f + have);
            s->velocity[k][0] = sway_x * 0.9f, s->velocity[k][1] = sway_y * 0.9f;
            s->velocity[k][2] = 0.2f + 1.0f * have / (0.1f + have);
        }

        float *swap = fuel;
        fuel = next, next = swap;
    }

    free(fuel), free(next);
}

bool synthetic_gas_make(const SingeSurface *surface, float cell, float time, SyntheticGas *s) {
    memset(s, 0, sizeof *s);
    frame(surface, cell, s);
    if (!reserve(s)) {
        synthetic_gas_free(s);
        return false;
    }
    add_fuel(surface, s);
    rise(s, time);
    return true;
}

void synthetic_gas_free(SyntheticGas *s) {
    free(s->temperature), free(s->smoke), free(s->flame), free(s->velocity);
    memset(s, 0, sizeof *s);
}
