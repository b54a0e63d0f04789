// All external heat enters a sheet through one interface: flux q, conductance g and g times the source's temperature,
// summed per particle. A kind of source is one function in the table below.
#include <math.h>
#include <string.h>

#include "common/def_table.h"
#include "common/real.h"
#include "heat/heat_plan.h"
#include "world/air.h"

// --- the kinds

static void source_ball(HeatPass *pass, const Source *source, const SingeView *view);
static void source_texture(HeatPass *pass, const Source *source, const SingeView *view);
static void source_callback(HeatPass *pass, const Source *source, const SingeView *view);
static void source_wets(HeatPass *pass, const Source *source, const SingeView *view);
static void source_blow(HeatPass *pass, const Source *source, const SingeView *view);
static SingeResult source_check_air(const SingeSourceDef *def, SingeError *error);
static SingeResult source_check_ball(const SingeSourceDef *def, SingeError *error);
static SingeResult source_check_texture(const SingeSourceDef *def, SingeError *error);
static SingeResult source_check_arrival(const SingeSourceDef *def, SingeError *error);

/// A kind of source: what it checks besides the ranges of its fields (NULL: nothing), and how it adds its heat (NULL:
/// it does not).
static const struct SourceKind {
    SingeResult (*check)(const SingeSourceDef *def, SingeError *error);
    void (*add)(HeatPass *pass, const Source *source, const SingeView *view);
    bool has_path;
} source_kinds[] = {
    [SINGE_SOURCE_BALL] = {source_check_ball, source_ball, true},
    [SINGE_SOURCE_TEXTURE] = {source_check_texture, source_texture, false},
    [SINGE_SOURCE_SPOT] = {source_check_ball, source_ball, true},
    [SINGE_SOURCE_CALLBACK] = {NULL, source_callback, false},     // its function may be set later
    [SINGE_SOURCE_ARRIVAL] = {source_check_arrival, NULL, false}, // no heat before conduction: arrival.c
    [SINGE_SOURCE_WATER] = {source_check_texture, source_wets, false},
    [SINGE_SOURCE_JET] = {source_check_air, source_blow, true},
    [SINGE_SOURCE_VORTEX] = {source_check_air, source_blow, true},
    [SINGE_SOURCE_ATTRACT] = {source_check_air, source_blow, true},
    [SINGE_SOURCE_TURBULENCE] = {source_check_air, source_blow, false},
};

// --- creating a source ----------------------------------------------------------------------------------

static SingeResult source_bad(SingeError *error, const char *what) {
    return error_set(error, SINGE_ERROR_ARGUMENT, "source", -1, "%s", what);
}

/// Max flux of a texture, W/m2: far beyond any fire, and finite in all computations of a step.
static const float SOURCE_FLUX_MAX = 1e15f;

static SingeResult source_check_strength(const SingeSourceDef *def, SingeError *error) {
    if (def->strength_count && !def->strength) return source_bad(error, "strength is missing");
    for (uint32_t k = 0; k < def->strength_count; k++) {
        const SingeValueKey *key = &def->strength[k];
        if (!isfinite(key->time) || !isfinite(key->value) || (k && !(key->time > key[-1].time)))
            return error_set(error, SINGE_ERROR_ARGUMENT, "source", k,
                             "key %u of strength: times must increase and all be finite", k);
    }
    return SINGE_OK;
}

/// Max speed of air, m/s: ten thousand metres are crossed in many steps.
static const float SOURCE_SPEED_MAX = 1000;

static SingeResult source_check_air(const SingeSourceDef *def, SingeError *error) {
    const float *d = def->direction;
    const bool aims = def->kind == SINGE_SOURCE_JET || def->kind == SINGE_SOURCE_VORTEX;
    if (aims && !(hypot(hypot((double)d[0], (double)d[1]), (double)d[2]) > 1e-9))
        return source_bad(error, "the direction must be longer than 1e-9");
    TRY(source_check_strength(def, error));
    for (uint32_t k = 0; k < def->strength_count; k++)
        if (!(def->speed * fabsf(def->strength[k].value) <= SOURCE_SPEED_MAX))
            return source_bad(error, "speed times strength must be at most 1000 m/s");
    return SINGE_OK;
}

static SingeResult source_check_texture(const SingeSourceDef *def, SingeError *error) {
    const SingeTexture *texture = &def->texture;
    if (texture->width < 1 || texture->height < 1 || !texture->values) return source_bad(error, "the texture is empty");

    // values of the texture
    float whitest = 0, strongest = def->strength_count ? 0 : 1;
    size_t count = (size_t)texture->width * (size_t)texture->height;
    for (size_t k = 0; k < count; k++) {
        whitest = float_max(whitest, fabsf(texture->values[k]));
        if (!isfinite(texture->values[k]))
            return error_set(error, SINGE_ERROR_ARGUMENT, "source", (int64_t)k,
                             "value %lld of the texture is not finite", (long long)k);
    }

    TRY(source_check_strength(def, error));
    for (uint32_t k = 0; k < def->strength_count; k++) strongest = float_max(strongest, fabsf(def->strength[k].value));

    // the largest flux
    if (def->kind == SINGE_SOURCE_TEXTURE &&
        !((double)fabsf(def->flux) * (double)whitest * (double)strongest <= (double)SOURCE_FLUX_MAX))
        return source_bad(error, "flux times strength and texture must be at most 1e15 W/m2");
    return SINGE_OK;
}

static SingeResult source_check_arrival(const SingeSourceDef *def, SingeError *error) {
    const SingeTexture *map = &def->texture;
    if (map->width < 1 || map->height < 1 || !map->values) return source_bad(error, "the arrival map is empty");
    size_t count = (size_t)map->width * (size_t)map->height;
    for (size_t k = 0; k < count; k++)
        if (!(map->values[k] >= 0 && map->values[k] <= 1))
            return error_set(error, SINGE_ERROR_ARGUMENT, "source", (int64_t)k,
                             "value %lld of the arrival map is not between 0 and 1", (long long)k);
    return SINGE_OK;
}

static SingeResult source_check_ball(const SingeSourceDef *def, SingeError *error) {
    if (def->kind == SINGE_SOURCE_SPOT && def->path_count != 1)
        return source_bad(error, "the path of a spot has exactly one key");
    return SINGE_OK;
}

static SingeResult source_check(const SingeSourceDef *def, SingeError *error) {
    TRY(def_check(&source_table, def, error));
    if (source_kinds[def->kind].has_path && (def->path_count < 1 || !def->path))
        return source_bad(error, "a source of this kind needs a path");
    return source_kinds[def->kind].check ? source_kinds[def->kind].check(def, error) : SINGE_OK;
}

/// An unknown kind has none, and is refused by source_check.
static bool source_has_path(const SingeSourceDef *def) {
    return def_has_value("SingeSourceKind", (int)def->kind) && source_kinds[def->kind].has_path;
}

static size_t texture_size(const SingeTexture *texture) { return (size_t)texture->width * (size_t)texture->height; }

static SingeResult source_no_memory(SingeError *error) {
    return error_set(error, SINGE_ERROR_MEMORY, "source", -1, "out of memory");
}

static SingeResult source_set_texture(Memory *memory, const Shell *shell, const SingeTexture *texture, Source *source,
                                      SingeError *error) {
    bool mapped = false;
    for (uint32_t i = 0; i < shell->particle_count && !mapped; i++)
        mapped = shell->uv[i][0] != 0 || shell->uv[i][1] != 0;
    if (!mapped) return source_bad(error, "a texture needs a sheet with uv");
    if (source->def.kind == SINGE_SOURCE_WATER && !shell_holds_water(shell))
        return source_bad(error, "water needs a sheet whose moisture is above 0; other sheets cannot hold water");
    if (!NEW(memory, source->texture, shell->particle_count)) return source_no_memory(error);
    bool arrives = source->def.kind == SINGE_SOURCE_ARRIVAL;
    for (uint32_t i = 0; i < shell->particle_count; i++)
        source->texture[i] =
            (arrives ? heat_sample_arrival : shell_sample_texture)(texture, shell->uv[i][0], shell->uv[i][1]);

    // sheets without uv have no map
    for (uint32_t s = 0; s < shell->sheet_count && arrives; s++) {
        const Sheet *sheet = &shell->sheets[s];
        bool covered = false;
        for (uint32_t v = 0; v < sheet->vertex_count && !covered; v++)
            covered = shell->uv[sheet->vertex_first + v][0] != 0 || shell->uv[sheet->vertex_first + v][1] != 0;
        for (uint32_t v = 0; v < sheet->vertex_count && !covered; v++)
            source->texture[sheet->vertex_first + v] = SOURCE_UNMAPPED;
        for (uint32_t c = 0; c < sheet->cell_count && !covered; c++)
            source->texture[shell_centre(shell, sheet->cell_first + c)] = SOURCE_UNMAPPED;
    }

    return SINGE_OK;
}

SingeResult source_create(Memory *memory, const Shell *shell, const SingeSourceDef *given, Source *source,
                          SingeError *error) {
    SingeSourceDef def = *given;
    SingePoseKey still = {.rotation = {0, 0, 0, 1}};
    memcpy(still.position, def.position, sizeof still.position);

    if (def.path_count == 0 && source_has_path(&def)) {
        def.path_count = 1;
        def.path = &still;
    }

    TRY(source_check(&def, error));
    uint32_t generation = source->generation;
    *source = (Source){.generation = generation, .def = def};
    source->def.path = NULL;
    source->def.strength = NULL;
    source->def.texture.values = NULL;

    // copies of its arrays; a texture waits until there are particles
    SingeResult result = SINGE_OK;
    if (source_has_path(&def)) result = path_set(&source->path, memory, def.path_count, def.path, "source", error);
    if (!result && (source_is_drawn(&def) || source_blows(&def))) {
        if (!NEW(memory, source->strength, def.strength_count)) result = source_no_memory(error);
        else source->strength_count = def.strength_count;
        if (source->strength_count) memcpy(source->strength, def.strength, def.strength_count * sizeof *def.strength);
    }

    if (!result && source_is_drawn(&def)) {
        const SingeTexture *texture = &def.texture;
        float *values;
        if (shell->particle_count) {
            result = source_set_texture(memory, shell, texture, source, error);
        } else if (NEW(memory, values, texture_size(texture))) {
            memcpy(values, texture->values, texture_size(texture) * sizeof *values);
            source->waiting = (SingeTexture){texture->width, texture->height, values};
        } else {
            result = source_no_memory(error);
        }
    }

    if (result) source_free(memory, shell, source);
    return result;
}

SingeResult source_settle(Memory *memory, const Shell *shell, Source *source, SingeError *error) {
    return source->waiting.values ? source_set_texture(memory, shell, &source->waiting, source, error) : SINGE_OK;
}

void source_settled(Memory *memory, Source *source) {
    float *values = (float *)(uintptr_t)source->waiting.values; // its own
    FREE(memory, values, texture_size(&source->waiting));
    source->waiting = (SingeTexture){0};
}

void source_unsettle(Memory *memory, const Shell *shell, Source *source) {
    if (source->waiting.values) FREE(memory, source->texture, shell->particle_count);
}

SingeResult source_check_read(const Shell *shell, const Source *source, SingeError *error) {
    SingeSourceDef def = source->def;
    def.path_count = source->path.count;
    def.path = source->path.keys;
    def.strength_count = source->strength_count;
    def.strength = source->strength;
    def.texture = (SingeTexture){(int)shell->particle_count, 1, source->texture};
    bool arrives = def.kind == SINGE_SOURCE_ARRIVAL;
    if (arrives) { // of its particles a map has more values
        TRY(def_check(&source_table, &def, error));
        if (!source->texture) return source_bad(error, "the arrival map is empty");
        for (uint32_t i = 0; i < shell->particle_count; i++)
            if (!(source->texture[i] >= 0 && source->texture[i] <= 1) && source->texture[i] != SOURCE_NEVER &&
                source->texture[i] != SOURCE_UNMAPPED)
                return source_bad(error, "the arrival map must contain times only");
    } else {
        TRY(source_check(&def, error));
    }

    if (def.kind == SINGE_SOURCE_WATER && !shell_holds_water(shell))
        return source_bad(error, "water needs a sheet whose moisture is above 0");
    if (source->texture && !source_is_drawn(&def))
        return source_bad(error, "a texture needs a source of kind texture, arrival or water");

    return path_check(def.path_count, def.path, "source", error);
}

void source_free(Memory *memory, const Shell *shell, Source *source) {
    path_free(&source->path, memory);
    FREE(memory, source->strength, source->strength_count);
    FREE(memory, source->texture, shell->particle_count);
    source_settled(memory, source);
    source->strength_count = 0;
}

// --- the kinds of sources -------------------------------------------------------------------------------

/// A side faces a collider if the cosine between their outward normals is at most this.
static const float SOURCE_LEVEL = 0.1f;

/// Arguments of a task for one source, one collider or the gas.
typedef struct SourceJob {
    HeatPass *pass;
    const Source *source;
    const Collider *collider;
    Pose pose;
    float strength;
} SourceJob;

static inline void source_add(HeatPlan *plan, uint32_t i, float conductance, float temperature) {
    plan->source_conductance[i] += conductance;
    plan->source_temperature[i] += conductance * temperature;
}

/// 1 up to radius, 0 from radius + falloff on, smoothstep between.
static inline float source_falloff(float distance, float radius, float falloff) {
    if (distance <= radius) return 1;
    if (distance >= radius + falloff) return 0;
    float x = (distance - radius) / falloff;
    return 1 - x * x * (3 - 2 * x);
}

static void source_ball_task(void *context, int begin, int end) {
    const SourceJob *job = context;
    HeatPlan *plan = job->pass->plan;
    const SingeSourceDef *def = &job->source->def;
    float reach = def->radius + def->falloff, square = reach * reach;
    const float(*position)[4] = (const float(*)[4])job->pass->state->dynamics->position;

    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        Float3 away = float3_sub(float3_load(position[i]), job->pose.position);
        float d2 = float3_dot(away, away);
        if (!(d2 <= square) || !plan->alive[i]) continue;
        source_add(plan, i, def->conductance * source_falloff(sqrtf(d2), def->radius, def->falloff), def->temperature);
    }
}

static void source_ball(HeatPass *pass, const Source *source, const SingeView *view) {
    (void)view;
    SourceJob job = {.pass = pass, .source = source, .pose = path_pose(&source->path, pass->state->time)};
    pool_for(pass->pool, (int)pass->plan->particles, POOL_GRAIN, source_ball_task, &job);
}

static void source_texture_task(void *context, int begin, int end) {
    const SourceJob *job = context;
    HeatPlan *plan = job->pass->plan;
    for (int i = begin; i < end; i++)
        if (plan->alive[i]) plan->flux[i] += job->strength * job->source->texture[i];
}

static void source_texture(HeatPass *pass, const Source *source, const SingeView *view) {
    (void)view;
    float strength = source_strength(source, pass->state->time);
    SourceJob job = {.pass = pass, .source = source, .strength = source->def.flux * strength};
    if (source->texture && job.strength != 0)
        pool_for(pass->pool, (int)pass->plan->particles, POOL_GRAIN, source_texture_task, &job);
}

/// In the time of motion: a spray is not part of the fire. Each layer takes half of it.
static void source_wet_task(void *context, int begin, int end) {
    const SourceJob *job = context;
    const Matter *matter = &job->pass->shell->matter;
    float *water = job->pass->heat->water;
    for (int i = begin; i < end; i++) {
        const float rain = 0.5f * job->strength * job->source->texture[i] * job->pass->h;
        if (rain > 0 && job->pass->plan->alive[i])
            water[i] =
                float_min(water[i] + rain * matter->area[i] / matter->mass[i], float_max(water[i], HEAT_WATER_MAX));
    }
}

static void source_wets(HeatPass *pass, const Source *source, const SingeView *view) {
    (void)view;
    SourceJob job = {.pass = pass, .source = source};
    job.strength = source->def.wetting * source_strength(source, pass->state->time);
    if (source->texture && job.strength > 0)
        pool_for(pass->pool, (int)pass->plan->particles, POOL_GRAIN, source_wet_task, &job);
}

// Forced convection at a flat plate of length l in laminar flow (Incropera et al., Nu = .664 Re^(1/2) Pr^(1/3)), with
// l = 5 cm and air of 300 K: h = SOURCE_COOLING sqrt(u). Flames are blown off where the air outruns them.
static const float SOURCE_COOLING = 17; // W/(m2 K) (s/m)^(1/2)

static void source_blow_task(void *context, int begin, int end) {
    const SourceJob *job = context;
    HeatPlan *plan = job->pass->plan;
    const StateInput *state = job->pass->state;
    const float *temperature = job->pass->heat->temperature, *burn_rate = state->burn->burn_rate;
    const SingeSourceDef *def = &job->source->def;
    const float ambient = plan->settings.ambient_temperature;

    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        if (!plan->alive[i] || (temperature[i] == ambient && burn_rate[i] == 0)) continue;
        const Float3 air = source_air(job->source, float3_load(state->dynamics->position[i]), state->time);
        if (float3_dot(air, air) == 0) continue;
        const float u = float3_length(float3_sub(air, float3_load(state->dynamics->velocity[i])));
        source_add(plan, i, SOURCE_COOLING * sqrtf(u), ambient);
        const float share = def->kind == SINGE_SOURCE_JET ? 2 * u / def->blow_out - 1 : 0;
        plan->put_out[i] = float_max(plan->put_out[i], float_min(share, 1));
    }
}

static void source_blow(HeatPass *pass, const Source *source, const SingeView *view) {
    (void)view;
    SourceJob job = {.pass = pass, .source = source};
    pool_for(pass->pool, (int)pass->plan->particles, POOL_GRAIN, source_blow_task, &job);
}

static void source_callback(HeatPass *pass, const Source *source, const SingeView *view) {
    HeatPlan *plan = pass->plan;
    if (!source->def.callback) return;
    source->def.callback(source->def.callback_context, view, plan->flux, plan->source_conductance,
                         plan->source_temperature);
    if (pass->heard) pass->heard(pass->hearer, view, plan->flux, plan->source_conductance, plan->source_temperature);
}

/// A particle is in contact within contact_distance if its side of the sheet faces the collider. The particle behind it
/// is a thickness farther; it counts if both sides do. A sheet that stands on its edge is in contact with both sides.
static void source_contact_task(void *context, int begin, int end) {
    const SourceJob *job = context;
    HeatPlan *plan = job->pass->plan;
    const Shell *shell = job->pass->shell;
    const SingeColliderDef *def = &job->collider->def;
    const Field thickness = shell->matter.thickness;
    const float(*x)[4] = (const float(*)[4])job->pass->state->dynamics->position;

    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        if (!plan->alive[i]) continue;
        Float3 normal, local = pose_unapply(&job->pose, float3_load(x[i]));

        // distances at which a layer is in contact, and at which it gets no air
        float behind = def->contact_distance + (def->sides == SINGE_SIDES_BOTH ? field_at(thickness, i) : 0);
        float reach = def->smothers ? def->contact_distance + field_at(thickness, i) : behind;
        float limit = nextafterf(reach, INFINITY), distance = collider_distance(job->collider, local, limit, &normal);
        if (!(distance <= reach)) continue;

        if (def->smothers) plan->put_out[i] = HEAT_SMOTHERED;
        if (!(distance <= behind) || !(def->conductance > 0)) continue;

        // of two layers only the one that faces the collider, by the sum of the normals of the cells at the particle
        if (def->sides != SINGE_SIDES_BOTH || distance > def->contact_distance) {
            bool corner = shell_is_corner(shell, i);
            uint32_t first = corner ? shell->fan_first[i] : 0, last = corner ? shell->fan_first[i + 1] : 1;
            Float3 sheet = {0, 0, 0}, away = quat_rotate(job->pose.rotation, normal);
            for (uint32_t k = first; k < last; k++) {
                uint32_t cell = corner ? shell->fan[k] : i - shell->vertex_count;
                if (!(job->pass->state->ablate->cell_flags[cell] & SINGE_ALIVE)) continue;
                const uint32_t *at = shell->cells[cell];
                Float3 a = float3_sub(float3_load(x[at[2]]), float3_load(x[at[0]]));
                Float3 b = float3_sub(float3_load(x[at[3]]), float3_load(x[at[1]]));
                sheet = float3_add(sheet, float3_cross(a, b));
            }

            float outward = corner ? -1 : 1;
            bool faces = outward * float3_dot(sheet, away) <= SOURCE_LEVEL * float3_length(sheet);
            if (def->sides != SINGE_SIDES_BOTH ? !faces : faces) continue;
        }

        source_add(plan, i, def->conductance, def->temperature);
    }
}

/// Gas that is hotter than a particle heats it. The particle then loses nothing to still air, so the convective part of
/// the losses is given back, but not beyond heating it to the gas's temperature. A particle hotter than the gas only
/// has the losses to still air.
static void source_gas_task(void *context, int begin, int end) {
    const SourceJob *job = context;
    HeatPlan *plan = job->pass->plan;
    const GasState *gas = job->pass->state->gas;
    const float *temperature = job->pass->heat->temperature, ambient = plan->settings.ambient_temperature;
    const float *mass = job->pass->state->burn->mass, *fuel = job->pass->state->burn->fuel;
    const Matter *matter = &job->pass->shell->matter;

    for (int i = begin; i < end; i++)
        if (gas->conductance[i] > 0 && gas->temperature[i] > temperature[i] && plan->alive[i]) {
            source_add(plan, (uint32_t)i, gas->conductance[i], gas->temperature[i]);
            float convection = field_at(matter->convection, (uint32_t)i), hot = gas->temperature[i], T = temperature[i];
            float slower = shell_glow_slowing(matter, (uint32_t)i, fuel[i]);
            float back = convection * (T - ambient) / slower;

            // the convective loss: at most what heats the particle to the gas's temperature; or the convective gain, if
            // it is colder than the ambient air
            float left = float_max(mass[i], field_at(matter->loss_mass_floor, (uint32_t)i));
            float real = convection / (left * plan->thickening[matter->sheet[i]] * slower);
            float max = (hot - T) * (matter->capacity[i] / matter->area[i]) / job->pass->dt + real * (hot - ambient);
            plan->flux[i] += T > ambient ? float_min(back, max) : float_max(back, real * (T - ambient));
        }
}

static void source_smother_task(void *context, int begin, int end) {
    const HeatPass *pass = context;
    const HeatPlan *plan = pass->plan;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++)
        if (plan->alive[i] && pass->state->burn->release[i] > 0 &&
            smother_covers(&plan->smother, pass->shell, pass->state, i))
            plan->put_out[i] = HEAT_SMOTHERED;
}

void heat_gather(HeatPass *pass, const SourceList *sources, const ColliderList *colliders, const SingeView *view) {
    HeatPlan *plan = pass->plan;
    double time = pass->state->time;
    memset(plan->flux, 0, plan->particles * sizeof *plan->flux);
    memset(plan->source_conductance, 0, plan->particles * sizeof *plan->source_conductance);
    memset(plan->source_temperature, 0, plan->particles * sizeof *plan->source_temperature);

    plan->puts_out = air_of(sources, time) != NULL || plan->smother.count > 0;
    for (uint32_t k = 0; colliders && k < colliders->count; k++)
        plan->puts_out |= colliders->items[k].generation && colliders->items[k].def.smothers;
    if (plan->puts_out) memset(plan->put_out, 0, plan->particles * sizeof *plan->put_out);

    for (uint32_t k = 0; sources && k < sources->count; k++) {
        const Source *source = &sources->items[k];
        const struct SourceKind *kind = &source_kinds[source->def.kind];
        if (kind->add && source_is_lit(source, time)) kind->add(pass, source, view);
    }

    // sheets that smother
    bool burns = false;
    for (uint32_t i = 0; i < plan->particles && !burns; i++) burns = pass->state->burn->release[i] > 0;
    if (burns && smother_place(&plan->smother, pass->shell, pass->state, pass->pool))
        pool_for(pass->pool, (int)plan->particles, POOL_BLOCK, source_smother_task, pass);

    // colliders that conduct or smother, and the gas
    for (uint32_t k = 0; colliders && k < colliders->count; k++) {
        const Collider *collider = &colliders->items[k];
        if (collider->generation == 0 || (!(collider->def.conductance > 0) && !collider->def.smothers)) continue;
        SourceJob job = {.pass = pass, .collider = collider, .pose = path_pose(&collider->path, time)};
        pool_for(pass->pool, (int)plan->particles, POOL_GRAIN, source_contact_task, &job);
    }

    if (pass->state->gas->warm)
        pool_for(pass->pool, (int)plan->particles, POOL_GRAIN, source_gas_task, &(SourceJob){.pass = pass});
}
