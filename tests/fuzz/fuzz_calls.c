// Any bytes as calls: sheets, and steps between which anything is set, added, moved, removed, saved and loaded.
// Nothing crashes; a call that fails changes nothing; what is left stays finite; a second simulation, with two threads,
// which is loaded or cloned from the first at times, gets the same answers and has the same bytes.
//
// With SINGE_RECORD=FILE in the environment, FILE.1 and FILE.2 become recordings of the two (docs/replay.md); the latter
// begins at the last load.
#include <stdio.h>
#include <string.h>

#include "sim_state.h"
#include "singe/mesh.h"

/// Bytes of a call: its number, then what it takes.
enum { RECORD = 16, CALLS_MAX = 24, SIDE = 5, VERTICES = (SIDE + 1) * (SIDE + 1), STEPS_MAX = 24 };

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

// ---- the calls

static SingeResult call_gravity(Input *input, SingeSim *sim) {
    const float gravity[3] = {0, input_value(input), input_value(input)};
    return singe_sim_set_gravity(sim, gravity);
}

static SingeResult call_pace(Input *input, SingeSim *sim) { return singe_sim_set_pace(sim, input_value(input)); }

static SingeResult call_ambient(Input *input, SingeSim *sim) {
    return singe_sim_set_ambient_temperature(sim, input_value(input));
}

static SingeResult call_wind(Input *input, SingeSim *sim) {
    SingeWindDef wind = singe_default_wind();
    wind.velocity[input_pick(input, 3)] = input_value(input), wind.gust = input_value(input);
    return singe_sim_set_wind(sim, &wind);
}

static SingeResult call_velocity(Input *input, SingeSim *sim) {
    float velocity[4][3];
    for (int i = 0; i < 4; i++) input_point(input, velocity[i]), velocity[i][2] *= 100;
    const SingeSheetId sheet = input_sheet(input, sim);
    return singe_sim_set_velocity(sim, sheet, input_byte(input), input_pick(input, 5), velocity[0]);
}

static SingeResult call_material(Input *input, SingeSim *sim) {
    SingeMaterialDef material = singe_default_material();
    SingeParam *const params[] = {
        &material.mass_rate, &material.ignition_temperature, &material.strength, &material.drag, &material.damping,
        &material.mass_min,  &material.temperature,          &material.grammage};
    *params[input_pick(input, sizeof params / sizeof *params)] = singe_param(input_value(input));
    float share[VERTICES];
    for (int v = 0; v < VERTICES; v++) share[v] = (float)(v % 4) / 3;
    if (input_rarely(input, 8)) share[7] = input_value(input);
    const SingeSheetId sheet = input_sheet(input, sim);
    return singe_sim_set_material(sim, sheet, &material, input_pick(input, 2) ? share : NULL);
}

static SingeResult call_add_source(Input *input, SingeSim *sim) {
    SingeSourceDef def = singe_default_source();
    SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.05f)};
    def.kind = input_pick(input, 2) ? SINGE_SOURCE_BALL : SINGE_SOURCE_SPOT;
    if (input_pick(input, 2)) def.path = path, def.path_count = def.kind == SINGE_SOURCE_BALL ? 2 : 1;
    def.radius = input_rarely(input, 4) ? input_value(input) : 0.02f;
    def.temperature = input_rarely(input, 4) ? input_value(input) : 1200;
    SingeSourceId id;
    return singe_sim_add_source(sim, &def, &id);
}

static SingeResult call_move_source(Input *input, SingeSim *sim) {
    const SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.05f)};
    const SingeSourceId source = input_source(input, sim);
    return singe_sim_move_source(sim, source, input_pick(input, 3), path);
}

static SingeResult call_remove_source(Input *input, SingeSim *sim) {
    return singe_sim_remove_source(sim, input_source(input, sim));
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
    SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.05f)};
    if (input_pick(input, 2)) def.path = path, def.path_count = 2;
    float vertices[6][3];
    input_octahedron(input, vertices);
    def.vertex_count = 6, def.vertices = vertices[0], def.triangle_count = 8, def.triangles = triangles;
    def.radius = 0.01f, def.half_size[0] = def.half_size[1] = def.half_size[2] = 0.01f, def.conductance = 100;
    SingeColliderId id;
    return singe_sim_add_collider(sim, &def, &id);
}

static SingeResult call_deform(Input *input, SingeSim *sim) {
    float vertices[6][3];
    const SingeColliderId collider = input_collider(input, sim);
    const double time = input_time(input, sim);
    input_octahedron(input, vertices);
    return singe_sim_set_collider_vertices(sim, collider, vertices[0], time);
}

static SingeResult call_move_collider(Input *input, SingeSim *sim) {
    const SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.05f)};
    const SingeColliderId collider = input_collider(input, sim);
    return singe_sim_move_collider(sim, collider, input_pick(input, 3), path);
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
    SingePinId id;
    return singe_sim_add_pin(sim, &def, &id);
}

static SingeResult call_follow(Input *input, SingeSim *sim) {
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
    const SingePoseKey path[2] = {input_pose(input, 0), input_pose(input, 0.05f)};
    const SingePinId pin = input_pin(input, sim);
    return singe_sim_move_pin(sim, pin, input_pick(input, 3), path);
}

static SingeResult call_remove_pin(Input *input, SingeSim *sim) {
    return singe_sim_remove_pin(sim, input_pin(input, sim));
}

static SingeResult call_commit(Input *input, SingeSim *sim) {
    (void)input;
    return singe_sim_commit(sim);
}

typedef SingeResult CallFn(Input *, SingeSim *);
static CallFn *const calls[] = {call_gravity,       call_pace,
                                call_ambient,       call_wind,
                                call_velocity,      call_material,
                                call_add_source,    call_move_source,
                                call_remove_source, call_add_collider,
                                call_deform,        call_deform,
                                call_move_collider, call_remove_collider,
                                call_add_pin,       call_follow,
                                call_follow,        call_move_pin,
                                call_remove_pin,    call_commit};

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

/// Two sheets, 1 mm from each other; or five in one place, for whose contacts the lists must grow.
static SingeSim *make(Input input, int which) {
    SingeSimDef def = singe_default_sim();
    const unsigned choices = input_byte(&input);
    const bool crowded = choices & 64;
    def.record = record(which);
    def.cancel = (SingeCancel){is_out_of_patience, &patience[which]};
    def.thread_count = 1 + which, def.contact.enabled = choices & 1;
    def.solver.creases = choices & 2, def.solver.tearing = choices & 4, def.pace = 4;
    def.gas.enabled = choices & 8, def.gas.cell_size = 0.02f, def.gas.height = 0.05f;
    SingeSim *sim;
    SingeError error;
    if (singe_sim_create(&def, &sim, &error)) abort();
    SingeGridDef grid = singe_default_grid();
    grid.size[0] = grid.size[1] = 0.06f, grid.cells[0] = grid.cells[1] = SIDE;
    SingeMesh *mesh;
    if (singe_mesh_create_grid(&grid, &mesh, &error)) abort();
    SingeSheetDef sheet = singe_default_sheet();
    singe_mesh_fill_sheet(mesh, &sheet);
    sheet.material.temperature = singe_param(choices & 16 ? 700 : 300);
    float raised[VERTICES][3];
    memcpy(raised, sheet.positions, sizeof raised);
    for (int s = 0; s < (crowded ? 5 : 2); s++) {
        for (int v = 0; v < VERTICES && !crowded; v++) raised[v][2] += 0.001f * (float)s;
        sheet.positions = raised[0];
        SingeSheetId id;
        if (singe_sim_add_sheet(sim, &sheet, &id)) abort();
    }

    singe_mesh_destroy(mesh);
    if (!(choices & 32) && singe_sim_commit(sim)) abort();
    return sim;
}

/// A call that fails changes nothing, and both simulations answer the same.
static void call_both(CallFn *call, Input input, SingeSim *const sims[2]) {
    SingeResult result[2];
    for (int k = 0; k < 2; k++) {
        Input own = input;
        const uint64_t before = digest_view(sims[k]);
        result[k] = call(&own, sims[k]);
        if (result[k]) demand(digest_view(sims[k]) == before);
    }

    demand(result[0] == result[1]);
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

/// Returns the steps made; a step that fails changes nothing.
static uint32_t step_both(Input input, SingeSim *const sims[2]) {
    SingeResult result[2];
    uint32_t made[2] = {0, 0};
    const double seconds = input_rarely(&input, 8) ? (double)input_value(&input) : 0.004 * input_pick(&input, 4);

    for (int k = 0; k < 2; k++) {
        result[k] = singe_sim_advance(sims[k], seconds, 4, &made[k]);
        demand_state(sims[k]);
    }
    demand(result[0] == result[1] && made[0] == made[1] && digest_view(sims[0]) == digest_view(sims[1]));
    return made[0];
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length) {
    Input input = {data, data + length};
    SingeSim *sims[2] = {make(input, 0), make(input, 1)};
    (void)input_byte(&input);
    uint32_t steps = 0;
    for (int i = 0; i < CALLS_MAX && input.at < input.end && steps < STEPS_MAX; i++) {
        Input record = {input.at, input.end - input.at > RECORD ? input.at + RECORD : input.end};
        input.at = record.end;
        const unsigned kind = input_pick(&record, 32);
        if (kind < sizeof calls / sizeof *calls) call_both(calls[kind], record, sims);
        else if (kind == 31) copy_over(input_pick(&record, 2), sims);
        else if (kind == 30) give_up_both(record, sims);
        else steps += step_both(record, sims);
    }

    for (int k = 0; k < 2; k++) {
        if (singe_sim_view(sims[k]).particle_count > 0) demand_surface(sims[k]);
        singe_sim_destroy(sims[k]);
    }
    return 0;
}
