// Short runs by the public interface, each with a hash of its snapshot: the same lines on every system (check.py).
//
//   hash_runs [--instructions best|plain|v2|v3|v4|neon|simd128] [--threads N] [--record FOLDER]
//   hash_runs --replay FILE
//
// With --record, the runs become FOLDER/NAME.singerec. With --replay, a recording's calls are made and compared, as
// `singe replay` does; the one line says what differs first.
//
// A line is "NAME STEP HASH". The lines of runs are the same for all sets of instructions; that of the snapshot, which
// names the set asked for, is printed for the best alone. The set in use goes to the standard error.
#include <singe/singe.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 24, CORNERS = CELLS + 1, PARTS = 4 };

static float positions[CORNERS][CORNERS][3], uv[CORNERS][CORNERS][2];
static uint32_t cells[CELLS][CELLS][4];

/// A level square of `side` m at height z, with its centre over the origin.
static SingeSheetDef sheet_make(float side, float z) {
    for (uint32_t y = 0; y < CORNERS; y++)
        for (uint32_t x = 0; x < CORNERS; x++) {
            float u = (float)x / CELLS, v = (float)y / CELLS;
            positions[y][x][0] = side * (u - 0.5f), positions[y][x][1] = side * (v - 0.5f), positions[y][x][2] = z;
            uv[y][x][0] = u, uv[y][x][1] = v;
            const uint32_t corner = y * CORNERS + x;
            const uint32_t cell[4] = {corner, corner + 1, corner + 1 + CORNERS, corner + CORNERS};
            if (x < CELLS && y < CELLS) memcpy(cells[y][x], cell, sizeof cell);
        }

    SingeSheetDef sheet = singe_default_sheet();
    sheet.vertex_count = CORNERS * CORNERS, sheet.positions = &positions[0][0][0], sheet.uv = &uv[0][0][0];
    sheet.cell_count = CELLS * CELLS, sheet.cells = &cells[0][0][0];
    return sheet;
}

/// The surroundings of the sheet in a run.
typedef struct Run {
    const char *name;
    int steps;
    bool match, held, ball, gas, tears, windy;
    float side, strength; ///< m; N/m, of the sheet
} Run;

static const Run runs[] = {
    {"fall", 160, .ball = true, .side = 0.3f},
    {"burn", 480, .match = true, .held = true, .windy = true, .side = 0.15f},
    {"tear", 320, .match = true, .held = true, .windy = true, .tears = true, .side = 0.15f, .strength = 0.5f},
    {"gas", 160, .match = true, .held = true, .gas = true, .side = 0.15f},
};

static SingeResult add_objects(SingeSim *sim, const Run *run, SingeSheetId sheet) {
    SingeResult result = SINGE_OK;
    if (run->match) {
        const SingePoseKey edge = {.position = {run->side / 2, 0, 0}, .rotation = {0, 0, 0, 1}};
        SingeSourceDef match = singe_default_source();
        SingeSourceId id;
        match.kind = SINGE_SOURCE_SPOT, match.path_count = 1, match.path = &edge;
        match.radius = 0.01f, match.falloff = 0.01f, match.temperature = 1123, match.end = 0.5f;
        result = singe_sim_add_source(sim, &match, &id);
    }

    if (!result && run->held) {
        const uint32_t corners[2] = {0, CORNERS - 1};
        SingePinDef pin = singe_default_pin();
        SingePinId id;
        pin.sheet = sheet, pin.vertex_count = 2, pin.vertices = corners;
        result = singe_sim_add_pin(sim, &pin, &id);
    }

    if (!result && run->ball) {
        const SingePoseKey below = {.position = {0.01f, 0.02f, -0.09f}, .rotation = {0, 0, 0, 1}};
        SingeColliderDef ball = singe_default_collider();
        SingeColliderId id;
        ball.kind = SINGE_COLLIDER_SPHERE, ball.radius = 0.06f, ball.path_count = 1, ball.path = &below;
        result = singe_sim_add_collider(sim, &ball, &id);
    }

    return result;
}

static SingeResult open_run(const Run *run, const SingeSimDef *base, SingeSim **sim, SingeError *error) {
    SingeSimDef def = *base;
    def.pace = 30;
    def.gas.enabled = run->gas, def.solver.tearing = run->tears, def.contact.enabled = true;
    if (run->windy) def.wind.velocity[1] = 1, def.wind.gust = 0.5f;
    SingeResult result = singe_sim_create(&def, sim, error);
    if (result) return result;

    SingeSheetDef sheet = sheet_make(run->side, 0);
    SingeSheetId id;

    if (run->strength > 0) sheet.material.strength = singe_param(run->strength);
    if ((result = singe_sim_add_sheet(*sim, &sheet, &id)) || (result = singe_sim_commit(*sim)) ||
        (result = add_objects(*sim, run, id)))
        *error = *singe_sim_error(*sim);
    return result;
}

/// FNV-1a.
static uint64_t hash_bytes(const uint8_t *bytes, size_t size) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

/// Of all that changes: the snapshot of a copy would name the instructions that were asked for.
static uint64_t hash_view(const SingeSim *sim) {
    const SingeView view = singe_sim_view(sim);
    uint64_t hash = hash_bytes((const uint8_t *)view.position, view.particle_count * sizeof *view.position);
    hash = hash * 31 + hash_bytes((const uint8_t *)view.velocity, view.particle_count * sizeof *view.velocity);
    hash = hash * 31 + hash_bytes((const uint8_t *)view.temperature, view.particle_count * sizeof *view.temperature);
    hash = hash * 31 + hash_bytes((const uint8_t *)view.mass, view.particle_count * sizeof *view.mass);
    return hash * 31 + hash_bytes(view.particle_flags, view.particle_count);
}

static const char *const sets[] = {"best", "plain", "v2", "v3", "v4", "neon", "simd128"};
enum { SETS = sizeof sets / sizeof sets[0] };

// ---- recordings

static bool record_write(void *file, const void *bytes, size_t size) { return fwrite(bytes, 1, size, file) == size; }

/// NULL without a folder, and after a message.
static FILE *record_open(const char *folder, const Run *run) {
    char path[4096];
    if (!folder) return NULL;
    snprintf(path, sizeof path, "%s/%s.singerec", folder, run->name);
    FILE *file = fopen(path, "wb");
    if (!file) perror(path);
    return file;
}

static int replay(const char *path, const SingeSimDef *hooks) {
    FILE *file = fopen(path, "rb");
    long size = -1;
    if (file && fseek(file, 0, SEEK_END) == 0) size = ftell(file);

    uint8_t *bytes = size > 0 ? malloc((size_t)size) : NULL;
    if (bytes) rewind(file);
    const bool read = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size;
    if (!read) perror(path);
    if (file) fclose(file);

    SingeReplay found = {0};
    SingeError error = {0};
    if (read && singe_replay(hooks, bytes, (size_t)size, &found, &error)) fprintf(stderr, "%s\n", error.message);
    else if (read && !found.same) printf("differs first: %s\n", found.what);
    else if (read && found.complete) printf("the same: %d steps\n", (int)found.steps);
    free(bytes);
    return !(found.complete && found.same);
}

// ----

static SingeResult hash_run(const Run *run, const SingeSimDef *def, const char *folder, SingeError *error) {
    SingeSim *sim = NULL;
    SingeSimDef recorded = *def, *base = &recorded;
    FILE *file = record_open(folder, run);
    if (file) recorded.record = (SingeRecord){record_write, file};

    SingeResult result = open_run(run, base, &sim, error);
    if (!result && run == runs) fprintf(stderr, "instructions: %s\n", sets[singe_sim_counts(sim).instructions]);

    for (int step = 1; step <= run->steps && !result; step++) {
        result = singe_sim_step(sim);
        if (!result && step % (run->steps / PARTS) == 0)
            printf("%s %d %016" PRIx64 "\n", run->name, step, hash_view(sim));
        if (result) *error = *singe_sim_error(sim);
    }

    if (!result) { // so that a run in which nothing happens is seen
        SingeStats stats = singe_sim_stats(sim);
        printf("%s counts %u particles, %u tears, %d permille burnt\n", run->name, stats.particles, stats.tears,
               (int)(1000 * stats.burnt_fraction));
    }

    uint8_t *bytes;
    size_t size;
    if (!result && base->instructions == SINGE_INSTRUCTIONS_BEST) {
        if ((result = singe_sim_save(sim, &bytes, &size))) *error = *singe_sim_error(sim);
        else {
            printf("%s snapshot %016" PRIx64 " %zu bytes\n", run->name, hash_bytes(bytes, size), size);
            singe_sim_free_bytes(sim, bytes, size);
        }
    }

    singe_sim_destroy(sim);
    if (file) fclose(file);
    return result;
}

/// SETS for what is no set.
static int find_set(const char *name) {
    int set = 0;
    while (set < SETS && strcmp(sets[set], name)) set++;
    return set;
}

int main(int count, char **arguments) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = 1;

    const char *folder = NULL, *recording = NULL;
    for (int i = 1; i < count; i++) {
        const char *value = i + 1 < count ? arguments[i + 1] : "";
        int set = strcmp(arguments[i], "--instructions") == 0 ? find_set(value) : SETS;
        if (set < SETS) def.instructions = (SingeInstructions)set, i++;
        else if (strcmp(arguments[i], "--threads") == 0 && *value) def.thread_count = atoi(value), i++;
        else if (strcmp(arguments[i], "--record") == 0 && *value) folder = value, i++;
        else if (strcmp(arguments[i], "--replay") == 0 && *value) recording = value, i++;
        else {
            fprintf(stderr, "usage: hash_runs [--instructions best|plain|v2|v3|v4|neon|simd128] [--threads N]"
                            " [--record FOLDER | --replay FILE]\n");
            return 2;
        }
    }

    if (recording) return replay(recording, &def);
    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
        SingeError error;
        if (!hash_run(&runs[i], &def, folder, &error)) continue;
        fprintf(stderr, "%s: %s: %s\n", runs[i].name, error.stage, error.message);
        return 1;
    }

    return 0;
}
