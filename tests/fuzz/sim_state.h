// The visible state of a simulation, for fuzz targets: it must be finite, and two simulations must agree.
#pragma once

#include <math.h>

#include "input.h"
#include "singe/sim.h"

static inline void demand_state(const SingeSim *sim) {
    SingeView view = singe_sim_view(sim);
    for (uint32_t i = 0; i < view.particle_count; i++) {
        if (!(view.particle_flags[i] & SINGE_ALIVE)) continue;
        for (int k = 0; k < 3; k++) demand(isfinite(view.position[i][k]) && isfinite(view.velocity[i][k]));
        demand(isfinite(view.temperature[i]) && view.temperature[i] >= 0);
        demand(view.mass[i] >= 0 && view.mass[i] <= 1);
    }
}

static inline void demand_surface(SingeSim *sim) {
    SingeSurface surface = {0};
    if (singe_sim_surface(sim, &surface)) abort();
    for (uint32_t i = 0; i < 3 * surface.triangle_count; i++)
        demand(surface.triangles[i / 3][i % 3] < surface.vertex_count);
    singe_surface_free(&surface);
    (void)singe_sim_stats(sim);
}

static inline void digest_add(uint64_t *digest, const void *data, size_t bytes) {
    const uint8_t *at = data;
    for (size_t size; bytes > 0; at += size, bytes -= size) {
        uint64_t word = 0;
        size = bytes < sizeof word ? bytes : sizeof word;
        memcpy(&word, at, size);
        *digest = (*digest ^ word) * 1099511628211u;
        *digest ^= *digest >> 32;
    }
}

/// Of what a caller sees; what contact remembers of its last search may be of a step that failed.
static inline uint64_t digest_view(const SingeSim *sim) {
    SingeView view = singe_sim_view(sim);
    SingeStats stats = singe_sim_stats(sim);
    uint64_t digest = 14695981039346656037u;
    size_t n = view.particle_count;

    digest_add(&digest, &view.step, sizeof view.step);
    digest_add(&digest, &view.topology_version, sizeof view.topology_version);
    digest_add(&digest, &stats.heat_in, sizeof stats.heat_in), digest_add(&digest, &stats.mass, sizeof stats.mass);
    for (size_t i = 0; i < n; i++) digest_add(&digest, view.position[i], 3 * sizeof(float));
    for (size_t i = 0; i < n; i++) digest_add(&digest, view.velocity[i], 3 * sizeof(float));

    digest_add(&digest, view.temperature, n * sizeof(float)), digest_add(&digest, view.mass, n * sizeof(float));
    digest_add(&digest, view.time_ignited, n * sizeof(float)), digest_add(&digest, view.piece, n * sizeof(int32_t));
    digest_add(&digest, view.particle_flags, n), digest_add(&digest, view.cell_flags, view.cell_count);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        digest_add(&digest, view.spring_flags[c], view.spring_count[c]);
        digest_add(&digest, view.spring_length[c], view.spring_count[c] * sizeof(float));
    }

    return digest;
}
