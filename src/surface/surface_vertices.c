// The vertices of the drawn mesh: corners, virtual centres, and points cut by eq 7:
//
//   x = x0 + (x1 - x0) t,   t = m'0 / (m'0 - m'1)
//
// with end 0 inside (m' >= 0) and end 1 outside, for the position and every other field alike. A virtual
// centre lies at the mean of its cell's four corners, in space, at rest and in velocity; temperature,
// mass and times are those of the cell's centre particle.
#include "ablate/ablate_plan.h"
#include "common/float3.h"

#include <math.h>

float surface_cut(float inside, float outside, float nearest) {
    float t = inside / (inside - outside);
    return t < nearest ? 0 : t > 1 - nearest ? 1 - nearest : t;
}

int surface_fan(const float level[3], float nearest) {
    for (int outside = 0; outside < 3; outside++) {
        int a = (outside + 1) % 3, b = (outside + 2) % 3;
        if (level[outside] >= 0 || level[a] < 0 || level[b] < 0) continue;
        float cut_a = surface_cut(level[a], level[outside], nearest);
        return cut_a < surface_cut(level[b], level[outside], nearest) ? b : a;
    }
    return 0;
}

typedef struct Sample {
    Float3 position, velocity, rest;
    float u, v, temperature, temperature_peak, mass, burn_rate, coal, ash, burn, time_ignited;
    int32_t piece, sheet;
} Sample;

static Float3 mean_of_corners(const uint32_t corners[4], const float (*field)[4]) {
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) sum = float3_add(sum, float3_load(field[corners[i]]));
    return float3_scale(sum, 0.25f);
}

static Sample sample_particle(const Shell *shell, const State *state, uint32_t particle) {
    const float(*position)[4] = (const float(*)[4])state->dynamics.position;
    const float(*velocity)[4] = (const float(*)[4])state->dynamics.velocity;
    const float(*rest)[4] = (const float(*)[4])shell->rest_position;
    const BurnState *burn = &state->burn;
    float min = field_at(shell->matter.mass_min, particle), yield = field_at(shell->matter.char_yield, particle);
    float coal = yield * shell_char(burn->mass[particle], burn->fuel[particle], min, yield);
    Sample sample = {
        .u = shell->uv[particle][0],
        .v = shell->uv[particle][1],
        .temperature = state->heat.temperature[particle],
        .temperature_peak = state->heat.temperature_peak[particle],
        .mass = burn->mass[particle],
        .burn_rate = burn->burn_rate[particle],
        .coal = coal,
        .ash = fmaxf(burn->mass[particle] - burn->fuel[particle] - coal, 0),
        .burn = shell_burn_progress(burn->mass[particle], min),
        .time_ignited = burn->time_ignited[particle],
        .piece = state->ablate.piece[particle],
        .sheet = shell->matter.sheet[particle],
    };

    // a vertex, or a virtual centre
    if (shell_is_corner(shell, particle)) {
        sample.position = float3_load(position[particle]);
        sample.velocity = float3_load(velocity[particle]);
        sample.rest = float3_load(rest[particle]);
    } else {
        const uint32_t *corners = shell->cells[particle - shell->vertex_count];
        sample.position = mean_of_corners(corners, position);
        sample.velocity = mean_of_corners(corners, velocity);
        sample.rest = mean_of_corners(corners, rest);
    }
    return sample;
}

static float mix(float a, float b, float t) { return a + (b - a) * t; }
static Float3 mix_float3(Float3 a, Float3 b, float t) { return float3_mad(a, float3_sub(b, a), t); }

/// Interpolates between two times; if one is -1, never, returns the other.
static float mix_times(float a, float b, float t) { return a < 0 ? b : b < 0 ? a : mix(a, b, t); }

/// Interpolates from the inside end, t = 0; piece and sheet are those of that end.
static Sample mix_samples(const Sample *a, const Sample *b, float t) {
    return (Sample){
        .position = mix_float3(a->position, b->position, t),
        .velocity = mix_float3(a->velocity, b->velocity, t),
        .rest = mix_float3(a->rest, b->rest, t),
        .u = mix(a->u, b->u, t),
        .v = mix(a->v, b->v, t),
        .temperature = mix(a->temperature, b->temperature, t),
        .temperature_peak = mix(a->temperature_peak, b->temperature_peak, t),
        .mass = mix(a->mass, b->mass, t),
        .burn_rate = mix(a->burn_rate, b->burn_rate, t),
        .coal = mix(a->coal, b->coal, t),
        .ash = mix(a->ash, b->ash, t),
        .burn = mix(a->burn, b->burn, t),
        .time_ignited = mix_times(a->time_ignited, b->time_ignited, t),
        .piece = a->piece,
        .sheet = a->sheet,
    };
}

static Sample sample_cut(const AblatePlan *plan, const Shell *shell, const State *state, const uint32_t ends[2]) {
    bool first_inside = plan->level[ends[0]] >= 0;
    uint32_t inside = ends[first_inside ? 0 : 1], outside = ends[first_inside ? 1 : 0];
    Sample a = sample_particle(shell, state, inside), b = sample_particle(shell, state, outside);
    return mix_samples(&a, &b, surface_cut(plan->level[inside], plan->level[outside], SURFACE_NEAREST));
}

static Sample sample_key(const AblatePlan *plan, const Shell *shell, const State *state, uint32_t key) {
    const SurfaceKeys *keys = &plan->keys;
    if (key < keys->blue) return sample_particle(shell, state, key);
    if (key < keys->red) return sample_cut(plan, shell, state, shell->springs[SINGE_BLUE].ends[key - keys->blue]);
    return sample_cut(plan, shell, state, shell->springs[SINGE_RED].ends[key - keys->red]);
}

void surface_vertex(const AblatePlan *plan, const Shell *shell, const State *state, uint32_t key, uint32_t index,
                    SingeSurface *surface) {
    Sample sample = sample_key(plan, shell, state, key);
    float3_store(surface->position[index], sample.position);
    float3_store(surface->velocity[index], sample.velocity);
    float3_store(surface->rest_position[index], sample.rest);
    surface->uv[index][0] = sample.u;
    surface->uv[index][1] = sample.v;
    surface->temperature[index] = sample.temperature;
    surface->temperature_peak[index] = sample.temperature_peak;
    surface->mass[index] = sample.mass;
    surface->burn_rate[index] = sample.burn_rate;
    surface->char_fraction[index] = sample.coal;
    surface->ash_fraction[index] = sample.ash;
    surface->burn[index] = sample.burn;
    surface->time_ignited[index] = sample.time_ignited;
    surface->piece[index] = sample.piece;
    surface->sheet[index] = sample.sheet;
    surface->source_vertex[index] = key < plan->keys.centre ? shell->source_vertex[key] : -1;
}
