// Any bytes as calls: sheets, and steps between which anything is set, added, moved, removed, drawn, saved and loaded.
// Nothing crashes; a call that fails changes nothing; what is left stays finite; a second simulation, with two threads,
// which is loaded or cloned from the first at times, gets the same answers and has the same bytes. Sheets and steps are
// few and small, so that a second has many runs.
//
// With SINGE_RECORD=FILE in the environment, FILE.1 and FILE.2 become recordings of the two (docs/replay.md); the latter
// begins at the last load.
#include <stdio.h>
#include <string.h>

#include "sim_state.h"
#include "singe/mesh.h"

/// Bytes of a call: its number, then what it takes. Sheets have from SIDE_MIN to SIDE_MAX cells a side.
enum { RECORD = 16, CALLS_MAX = 24, STEPS_MAX = 12, SIDE_MIN = 2, SIDE_MAX = 4 };
enum { VERTICES = (SIDE_MAX + 1) * (SIDE_MAX + 1) };

static float input_value(Input *input) {
    static const float values[] = {0,  1e-30f, 1e-6f, 1e-3f, 0.01f, 0.02f, 0.1f,  0.5f,  1,        2,  5,
                                   10, 100,    300,   700,   1000,  1200,  10000, 1e30f, INFINITY, NAN};
    const float value = values[input_pick(input, sizeof values / sizeof *values)];
    return input_rarely(input, 3) ? -value : value;
}

static void input_point(Input *input, float point[3]) {
    for (int k = 0; k < 3; k++) point[k] = input_rarely(input, 16) ? input_value(input) : 0.04f * input_share(input);
}

static SingePoseKey input_pose(Input *input, float time) {
    SingePoseKey pose = {time, {0, 0, 0}, {input_share(input), 0, 0, 1}};
    input_point(input, pose.position);
    return pose;
}

/// One of the handles of a kind, or sometimes an invalid one.
#define INPUT_HANDLE(input, sim, Id, list)                             \
    do {                                                               \
        Id ids[256];                                                   \
        const uint32_t count = list(sim, ids, 256);                    \
        const uint32_t pick = input_byte(input) % (count + 1);         \
        return pick < count && pick < 256 ? ids[pick] : (Id){pick, 1}; \
    } while (0)

static SingeSheetId input_sheet(Input *i, const SingeSim *s) { INPUT_HANDLE(i, s, SingeSheetId, singe_sim_sheets); }
static SingeSourceId input_source(Input *i, const SingeSim *s) { INPUT_HANDLE(i, s, SingeSourceId, singe_sim_sources); }
static SingePinId input_pin(Input *i, const SingeSim *s) { INPUT_HANDLE(i, s, SingePinId, singe_sim_pins); }
static SingeColliderId input_collider(Input *i, const SingeSim *s) {
    INPUT_HANDLE(i, s, SingeColliderId, singe_sim_colliders);
}

/// Seconds from now, or before.
static double input_time(Input *input, const SingeSim *sim) {
    return singe_sim_view(sim).time +
           (input_rarely(input, 8) ? (double)input_value(input) : 0.02 * (double)input_share(input));
}

/// A path, at times of none or one pose.
static uint32_t input_path(Input *input, SingePoseKey path[2]) {
    path[0] = input_pose(input, 0), path[1] = input_pose(input, 0.05f);
    return input_pick(input, 3);
}

// ---- the calls, by the names of calls.def

/// A sheet some mm above the origin.
static SingeResult add_grid(SingeSim *sim, const uint32_t cells[2], float height, float temperature) {
    SingeGridDef grid = singe_default_grid();
    for (int k = 0; k < 2; k++) grid.cells[k] = cells[k], grid.size[k] = 0.012f * (float)cells[k];
    SingeMesh *mesh;
    if (singe_mesh_create_grid(&grid, &mesh, NULL)) abort();

    SingeSheetDef sheet = singe_default_sheet();
    singe_mesh_fill_sheet(mesh, &sheet);
    sheet.material.temperature = singe_param(temperature);

    float raised[VERTICES][3];
    memcpy(raised, sheet.positions, sheet.vertex_count * sizeof *raised);
    for (uint32_t v = 0; v < sheet.vertex_count; v++) raised[v][2] += height;
    sheet.positions = raised[0];

    SingeSheetId id;
    const SingeResult result = singe_sim_add_sheet(sim, &sheet, &id);
    singe_mesh_destroy(mesh);
    return result;
}

static uint32_t input_side(Input *input) { return SIDE_MIN + input_pick(input, SIDE_MAX - SIDE_MIN + 1); }

static SingeResult call_add_sheet(Input *input, SingeSim *sim) {
    const uint32_t cells[2] = {input_side(input), input_side(input)};
    return add_grid(sim, cells, 0.01f * input_share(input), input_value(input));
}

static SingeResult call_set_gravity(Input *input, SingeSim *sim) {
    const float gravity[3] = {0, input_value(input), input_value(input)};
    return singe_sim_set_gravity(sim, gravity);
}

static SingeResult call_set_pace(Input *input, SingeSim *sim) { return singe_sim_set_pace(sim, input_value(input)); }

static SingeResult call_set_ambient_temperature(Input *input, SingeSim *sim) {
    return singe_sim_set_ambient_temperature(sim, input_value(input));
}

static SingeResult call_set_wind(Input *input, SingeSim *sim) {
    SingeWindDef wind = singe_default_wind();
    wind.velocity[input_pick(input, 3)] = input_value(input), wind.gust = input_value(input);
    return singe_sim_set_wind(sim, &wind);
}

static SingeResult call_set_velocity(Input *input, SingeSim *sim) {
    float velocity[4][3];
    for (int i = 0; i < 4; i++) input_point(input, velocity[i]), velocity[i][2] *= 100;
    const SingeSheetId sheet = input_sheet(input, sim);
    return singe_sim_set_velocity(sim, sheet, input_byte(input), input_pick(input, 5), velocity[0]);
}

static SingeResult call_set_material(Input *input, SingeSim *sim) {
    SingeMaterialDef material = singe_default_material();
#define SINGE_PARAM(number, NAME, name, ...) &material.name,
    SingeParam *const params[] = {
#include "singe/material.def"
    };
    *params[input_pick(input, sizeof params / sizeof *params)] = singe_param(input_value(input));
    float share[VERTICES];
    for (int v = 0; v < VERTICES; v++) share[v] = (float)(v % 4) / 3;
    if (input_rarely(input, 8)) share[7] = input_value(input);
    const SingeSheetId sheet = input_sheet(input, sim);
    return singe_sim_set_material(sim, sheet, &material, input_pick(input, 2) ? share : NULL);
}

/// The same into every particle.
static void warm(void *context, const SingeView *view, float *flux, float *conductance,
                 float *conductance_temperature) {
    (void)context;
    for (uint32_t i = 0; i < view->particle_count; i++)
        flux[i] += 1e4f, conductance[i] += 10, conductance_temperature[i] += 7000;
}

static SingeResult call_add_source(Input *input, SingeSim *sim) {
    static const float picture[4] = {0, 0.3f, 0.6f, 1};
    static const SingeSourceKind kinds[] = {SINGE_SOURCE_SPOT,    SINGE_SOURCE_BALL,       SINGE_SOURCE_SPOT,
                                            SINGE_SOURCE_BALL,    SINGE_SOURCE_TEXTURE,    SINGE_SOURCE_ARRIVAL,
                                            SINGE_SOURCE_WATER,   SINGE_SOURCE_JET,        SINGE_SOURCE_VORTEX,
                                            SINGE_SOURCE_ATTRACT, SINGE_SOURCE_TURBULENCE, SINGE_SOURCE_CALLBACK};
    SingeSourceDef def = singe_default_source();
    SingePoseKey path[2];
    def.path = path, def.path_count = input_path(input, path);
    def.kind = kinds[input_pick(input, sizeof kinds / sizeof *kinds)];
    if (def.kind == SINGE_SOURCE_SPOT && def.path_count == 2) def.path_count = 1;

    def.texture = (SingeTexture){2, 2, picture};
    def.radius = input_rarely(input, 4) ? input_value(input) : 0.02f;
    def.temperature = input_rarely(input, 4) ? input_value(input) : 1200;
    if (def.kind == SINGE_SOURCE_CALLBACK) def.callback = warm;

    SingeSourceId id;
    return singe_sim_add_source(sim, &def, &id);
}

static SingeResult call_move_source(Input *input, SingeSim *sim) {
    SingePoseKey path[2];
    const uint32_t count = input_path(input, path);
    const SingeSourceId source = input_source(input, sim);
    return singe_sim_move_source(sim, source, count, path);
}

static SingeResult call_remove_source(Input *input, SingeSim *sim) {
    return singe_sim_remove_source(sim, input_source(input, sim));
}

static SingeResult call_set_source_callback(Input *input, SingeSim *sim) {
    const SingeSourceId source = input_source(input, sim);
    return singe_sim_set_source_callback(sim, source, input_pick(input, 2) ? warm : NULL, NULL);
}

/// An octahedron's vertices, each where the bytes say.
static void input_octahedron(Input *input, float vertices[6][3]) {
    memset(vertices, 0, 6 * sizeof *vertices);
    for (int v = 0; v < 6; v++) {
        vertices[v][v / 2] = (v % 2 ? -0.01f : 0.01f) * (1 + input_share(input));
        if (input_rarely(input, 16)) vertices[v][2] += input_value(input);
    }
}

static SingeResult call_add_collider(Input *input, SingeSim *sim) {
    static const uint32_t triangles[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    SingeColliderDef def = singe_default_collider();
    def.kind = (SingeColliderKind)input_pick(input, SINGE_COLLIDER_DEFORMING + 1);
    if (input_pick(input, 2)) def.kind = SINGE_COLLIDER_DEFORMING;
    SingePoseKey path[2];
    def.path = path, def.path_count = input_path(input, path);

    float vertices[6][3];
    input_octahedron(input, vertices);
    def.vertex_count = 6, def.vertices = vertices[0], def.triangle_count = 8, def.triangles = triangles;
    def.radius = 0.01f, def.half_size[0] = def.half_size[1] = def.half_size[2] = 0.01f, def.conductance = 100;
    SingeColliderId id;
    return singe_sim_add_collider(sim, &def, &id);
}

static SingeResult call_set_collider_vertices(Input *input, SingeSim *sim) {
    float vertices[6][3];
    const SingeColliderId collider = input_collider(input, sim);
    const double time = input_time(input, sim);
    input_octahedron(input, vertices);
    return singe_sim_set_collider_vertices(sim, collider, vertices[0], time);
}

static SingeResult call_move_collider(Input *input, SingeSim *sim) {
    SingePoseKey path[2];
    const uint32_t count = input_path(input, path);
    const SingeColliderId collider = input_collider(input, sim);
    return singe_sim_move_collider(sim, collider, count, path);
}

static SingeResult call_remove_collider(Input *input, SingeSim *sim) {
    return singe_sim_remove_collider(sim, input_collider(input, sim));
}

static SingeResult call_add_pin(Input *input, SingeSim *sim) {
    SingePinDef def = singe_default_pin();
    float point[3];
    input_point(input, point);
    point[2] = 0;

    const uint32_t vertices[2] = {input_pick(input, VERTICES + 1), input_pick(input, VERTICES)};
    def.sheet = input_sheet(input, sim);
    if (input_pick(input, 2)) def.points = point, def.point_count = 1, def.radius = 0.01f;
    else def.vertices = vertices, def.vertex_count = 2;
    if (input_pick(input, 2)) def.end = (float)input_time(input, sim);

    SingePoseKey path[2];
    def.path = path, def.path_count = input_path(input, path);
    SingePinId id;
    return singe_sim_add_pin(sim, &def, &id);
}

static SingeResult call_set_pin_positions(Input *input, SingeSim *sim) {
    uint32_t count;
    const SingePinId pin = input_pin(input, sim);
    const double time = input_time(input, sim);
    const uint32_t *particles = singe_sim_pin_particles(sim, pin, &count);
    const SingeView view = singe_sim_view(sim);
    float(*positions)[3] = calloc((size_t)count + 1, sizeof *positions), shift[3];

    if (!positions) abort();
    input_point(input, shift);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) positions[i][k] = view.position[particles[i]][k] + 0.2f * shift[k];

    const SingeResult result = singe_sim_set_pin_positions(sim, pin, positions[0], time);
    free(positions);
    return result;
}

static SingeResult call_move_pin(Input *input, SingeSim *sim) {
    SingePoseKey path[2];
    const uint32_t count = input_path(input, path);
    const SingePinId pin = input_pin(input, sim);
    return singe_sim_move_pin(sim, pin, count, path);
}

static SingeResult call_remove_pin(Input *input, SingeSim *sim) {
    return singe_sim_remove_pin(sim, input_pin(input, sim));
}

static SingeResult call_commit(Input *input, SingeSim *sim) {
    (void)input;
    return singe_sim_commit(sim);
}

static SingeResult call_step(Input *input, SingeSim *sim) {
    (void)input;
    return singe_sim_step(sim);
}

static SingeResult call_advance(Input *input, SingeSim *sim) {
    const double seconds = input_rarely(input, 8) ? (double)input_value(input) : 0.004 * input_pick(input, 4);
    uint32_t made;
    return singe_sim_advance(sim, seconds, 3, &made);
}

static SingeResult call_draw(Input *input, SingeSim *sim) {
    (void)input;
    SingeSurface surface = {0};
    const SingeResult result = singe_sim_surface(sim, &surface);
    singe_surface_free(&surface);
    return result;
}

static SingeResult call_save(Input *input, SingeSim *sim) {
    (void)input;
    uint8_t *bytes;
    size_t size;
    const SingeResult result = singe_sim_save(sim, &bytes, &size);
    if (!result) singe_sim_free_bytes(sim, bytes, size);
    return result;
}

/// What a clone does is its own.
static SingeResult call_clone(Input *input, SingeSim *sim) {
    SingeSim *copy;
    const SingeResult result = singe_sim_clone(sim, &copy);
    if (result) return result;
    demand(digest_view(copy) == digest_view(sim));
    const SingeResult stepped = input_pick(input, 2) ? singe_sim_step(copy) : SINGE_OK;
    (void)stepped; // the copy's failure is not the simulation's
    singe_sim_destroy(copy);
    return SINGE_OK;
}

static SingeResult call_add_render_mesh(Input *input, SingeSim *sim) {
    static const uint32_t triangles[] = {0, 1, 2, 2, 1, 3};
    float vertices[4][3];
    for (int v = 0; v < 4; v++) input_point(input, vertices[v]), vertices[v][2] *= 0.1f;
    SingeRenderMeshDef def = singe_default_render_mesh();
    def.vertex_count = 4, def.triangle_count = 2, def.positions = vertices[0], def.triangles = triangles;
    def.beside = input_pick(input, 2);
    const SingeSheetId sheet = input_sheet(input, sim);
    return singe_sim_add_render_mesh(sim, sheet, &def);
}

typedef SingeResult CallFn(Input *, SingeSim *);

/// Every call that a recording may hold, and what else changes what is drawn; COMMON more often.
static CallFn *const calls[] = {
#define SINGE_CALL(number, name, A, B, C) call_##name,
#include "sim/calls.def"
    call_add_render_mesh};

enum { CALLS = sizeof calls / sizeof *calls, COMMON = 12 };

// ---- recordings

static FILE *recordings[2];

static bool record_write(void *file, const void *bytes, size_t size) { return fwrite(bytes, 1, size, file) == size; }

/// Begins a recording, if any are asked for; the one before has ended.
static SingeRecord record(int which) {
    const char *name = getenv("SINGE_RECORD");
    if (!name) return (SingeRecord){NULL, NULL};

    char path[4096];
    snprintf(path, sizeof path, "%s.%d", name, which + 1);
    if (recordings[which]) fclose(recordings[which]);
    recordings[which] = fopen(path, "wb");
    if (!recordings[which]) {
        perror(path);
        exit(1);
    }

    setvbuf(recordings[which], NULL, _IONBF, 0); // a crash loses nothing
    return (SingeRecord){record_write, recordings[which]};
}

// ---- two simulations

/// How often a simulation is asked whether to give up a step before it says yes; less than 0: it does not. A clone has
/// the hook of the simulation that it was made from.
static _Atomic int patience[2] = {-1, -1};

static bool is_out_of_patience(void *context) {
    _Atomic int *left = context;
    if (*left < 0) return false;
    if (*left == 0) return true;
    (*left)--;
    return false;
}

/// Two sheets, 1 mm from each other; or three in one place, for whose contacts the lists must grow.
static SingeSim *make(Input input, int which) {
    SingeSimDef def = singe_default_sim();
    const unsigned choices = input_byte(&input);
    const bool crowded = choices & 64;

    def.record = record(which);
    def.cancel = (SingeCancel){is_out_of_patience, &patience[which]};
    def.thread_count = 1 + which, def.contact.enabled = choices & 1;
    def.solver.creases = choices & 2, def.solver.tearing = choices & 4, def.pace = 4;
    def.solver.substeps = choices & 128 ? 0 : 2;
    def.gas.enabled = choices & 8, def.gas.cell_size = 0.02f, def.gas.height = 0.05f;

    SingeSim *sim;
    if (singe_sim_create(&def, &sim, NULL)) abort();

    const uint32_t cells[2] = {input_side(&input), input_side(&input)};
    for (int s = 0; s < (crowded ? 3 : 2); s++)
        if (add_grid(sim, cells, crowded ? 0 : 0.001f * (float)s, choices & 16 ? 700 : 300)) abort();
    if (!(choices & 32) && singe_sim_commit(sim)) abort();
    return sim;
}

/// A call that fails changes nothing, but for the steps that it has made before, and both simulations answer the same.
static void call_both(CallFn *call, Input input, SingeSim *const sims[2]) {
    SingeResult result[2];
    for (int k = 0; k < 2; k++) {
        Input own = input;
        const uint64_t before = digest_view(sims[k]), step = singe_sim_view(sims[k]).step;
        result[k] = call(&own, sims[k]);
        if (result[k]) demand(digest_view(sims[k]) == before || singe_sim_view(sims[k]).step > step);
        demand_state(sims[k]);
    }

    demand(result[0] == result[1] && digest_view(sims[0]) == digest_view(sims[1]));
}

/// Puts a copy of the first simulation in place of the second. A clone records nothing.
static void copy_over(bool load, SingeSim *sims[2]) {
    uint8_t *bytes;
    size_t size;
    if (singe_sim_save(sims[0], &bytes, &size)) return; // not committed
    singe_sim_destroy(sims[1]);

    SingeSimDef hooks = singe_default_sim();
    hooks.thread_count = 2;
    hooks.cancel = (SingeCancel){is_out_of_patience, &patience[1]};
    if (load || getenv("SINGE_RECORD")) {
        hooks.record = record(1);
        if (singe_sim_load(&hooks, bytes, size, &sims[1], NULL)) abort();
    } else if (singe_sim_clone(sims[0], &sims[1])) {
        abort();
    }
    singe_sim_free_bytes(sims[0], bytes, size);
}

/// A step that is given up changes nothing; each step asks three times at least.
static void give_up_both(Input input, SingeSim *const sims[2]) {
    const int asks = (int)input_pick(&input, 3);
    for (int k = 0; k < 2; k++) {
        const uint64_t before = digest_view(sims[k]);
        patience[0] = patience[1] = asks;
        const SingeResult result = singe_sim_step(sims[k]);
        patience[0] = patience[1] = -1;
        demand(result != SINGE_OK && digest_view(sims[k]) == before);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length) {
    enum { HEADER = 3 };
    Input input = {data, data + length};
    SingeSim *sims[2] = {make(input, 0), make(input, 1)};

    for (int i = 0; i < HEADER; i++) (void)input_byte(&input);
    for (int i = 0; i < CALLS_MAX && input.at < input.end && singe_sim_view(sims[0]).step < STEPS_MAX; i++) {
        Input record = {input.at, input.end - input.at > RECORD ? input.at + RECORD : input.end};
        input.at = record.end;
        const unsigned kind = input_pick(&record, CALLS + COMMON + 2);
        if (kind < CALLS) call_both(calls[kind], record, sims);
        else if (kind < CALLS + COMMON) call_both(call_advance, record, sims);
        else if (kind == CALLS + COMMON) copy_over(input_pick(&record, 2), sims);
        else give_up_both(record, sims);
    }

    for (int k = 0; k < 2; k++) {
        if (singe_sim_view(sims[k]).particle_count > 0) demand_surface(sims[k]);
        singe_sim_destroy(sims[k]);
    }

    return 0;
}
