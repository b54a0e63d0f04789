#include "burning_sheet.h"

#include <singe/mesh.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// ---- memory, which is counted. What a frame frees is kept for the next one, in sizes of a power of two

enum { BLOCK_HEADER = 64, BLOCK_LEAST = 4096 };

/// The bytes that a block has room for stand in front of it.
static size_t *block_room(void *block) { return (size_t *)(void *)((char *)block - BLOCK_HEADER); }

/// A kept block that is large enough, the smallest; NULL: there is none.
static void *burning_take(BurningSheet *sheet, size_t size) {
    void **best = NULL;
    for (int i = 0; i < BURNING_KEPT; i++) {
        void **kept = &sheet->kept[i];
        if (*kept && *block_room(*kept) >= size && (!best || *block_room(*kept) < *block_room(*best))) best = kept;
    }
    void *block = best ? *best : NULL;
    if (best) *best = NULL;
    return block;
}

static void *burning_new(BurningSheet *sheet, size_t size) {
    void *block = sheet->burns ? burning_take(sheet, size) : NULL;
    if (block) return block;
    size_t room = sheet->burns ? BLOCK_LEAST : size;
    while (room < size) room *= 2;
    char *made = malloc(BLOCK_HEADER + room);
    if (!made) return NULL;
    sheet->allocations++;
    *block_room(made + BLOCK_HEADER) = room;
    return made + BLOCK_HEADER;
}

static void burning_free(BurningSheet *sheet, void *block) {
    for (int i = 0; i < BURNING_KEPT && block && sheet->burns; i++)
        if (!sheet->kept[i]) {
            sheet->kept[i] = block;
            return;
        }
    if (block) free(block_room(block));
}

static void *burning_resize(void *context, void *block, size_t old_size, size_t new_size) {
    BurningSheet *sheet = context;
    if (block && new_size && new_size <= *block_room(block)) return block;
    void *made = new_size ? burning_new(sheet, new_size) : NULL;
    if (new_size && !made) return NULL;
    if (made && block) memcpy(made, block, old_size < new_size ? old_size : new_size);
    burning_free(sheet, block);
    return made;
}

// ---- life

BurningSheet burning_default(void) {
    return (BurningSheet){.size = {0.2f, 0.2f},
                          .cells = {32, 32},
                          .material = "office-paper",
                          .pace = 8,
                          .threads = 1,
                          .gravity = {0, -9.81f, 0}};
}

void burning_stop(BurningSheet *sheet) {
    singe_sim_destroy(sheet->sim);
    sheet->sim = NULL;
    singe_surface_free(&sheet->surface);
    sheet->burns = false;
    for (int i = 0; i < BURNING_KEPT; i++) {
        burning_free(sheet, sheet->kept[i]);
        sheet->kept[i] = NULL;
    }
}

/// Whether a call on the simulation was good.
static bool burning_good(BurningSheet *sheet, SingeResult result) {
    if (result) sheet->error = *singe_sim_error(sheet->sim);
    return !result;
}

static bool burning_build(BurningSheet *sheet) {
    SingeGridDef grid = singe_default_grid();
    SingeSimDef def = singe_default_sim();
    SingeSheetDef made = singe_default_sheet();
    memcpy(grid.size, sheet->size, sizeof grid.size);
    memcpy(grid.cells, sheet->cells, sizeof grid.cells);
    memcpy(def.gravity, sheet->gravity, sizeof def.gravity);
    def.allocator = (SingeAllocator){burning_resize, sheet};
    sheet->surface.allocator = (SingeAllocator){burning_resize, sheet};
    def.pace = sheet->pace;
    def.surface_detail = sheet->detail;
    def.thread_count = sheet->threads;
    def.time_step = 1.0f / 120;
    if (singe_material_preset(sheet->material, &made.material, &sheet->error)) return false;
    SingeMesh *mesh = NULL;
    if (singe_mesh_create_grid(&grid, &mesh, &sheet->error)) return false;
    singe_mesh_fill_sheet(mesh, &made);
    bool good = !singe_sim_create(&def, &sheet->sim, &sheet->error);
    good = good && burning_good(sheet, singe_sim_add_sheet(sheet->sim, &made, &sheet->id)) &&
           burning_good(sheet, singe_sim_commit(sheet->sim)) &&
           burning_good(sheet, singe_sim_advance(sheet->sim, 0, 0, NULL)) &&
           burning_good(sheet, singe_sim_surface(sheet->sim, &sheet->surface));
    singe_mesh_destroy(mesh);
    return good;
}

bool burning_start(BurningSheet *sheet) {
    burning_stop(sheet);
    const bool good = burning_build(sheet);
    if (!good) burning_stop(sheet);
    // what drawing needs once for a frame, it has from then on
    sheet->burns = good && burning_good(sheet, singe_sim_surface(sheet->sim, &sheet->surface));
    sheet->allocations = 0;
    return good;
}

static double burning_now(void) {
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

/// Whether it has started.
static bool burning_lives(BurningSheet *sheet) {
    if (!sheet->sim) snprintf(sheet->error.message, sizeof sheet->error.message, "the sheet has not started");
    return sheet->sim != NULL;
}

bool burning_advance(BurningSheet *sheet, double seconds) {
    enum { STEPS_MAX = 4 };
    if (!burning_lives(sheet)) return false;
    const double before = burning_now();
    const clock_t used = clock();
    const bool good = burning_good(sheet, singe_sim_advance(sheet->sim, seconds, STEPS_MAX, NULL)) &&
                      burning_good(sheet, singe_sim_surface(sheet->sim, &sheet->surface));
    sheet->milliseconds = burning_now() - before;
    sheet->processor_time = 1e3 * (double)(clock() - used) / CLOCKS_PER_SEC;
    return good;
}

// ---- objects

bool burning_pin(BurningSheet *sheet, const float point[3], float radius) {
    SingePinDef pin = singe_default_pin();
    pin.sheet = sheet->id;
    pin.point_count = 1;
    pin.points = point;
    pin.radius = radius;
    return burning_lives(sheet) && burning_good(sheet, singe_sim_add_pin(sheet->sim, &pin, NULL));
}

bool burning_ignite(BurningSheet *sheet, const float point[3], float radius, float seconds) {
    if (!burning_lives(sheet)) return false;
    SingeSourceDef match = singe_default_source();
    memcpy(match.position, point, sizeof match.position);
    match.radius = match.falloff = radius;
    match.temperature = 1123;
    match.start = (float)singe_sim_view(sheet->sim).time;
    match.end = match.start + seconds;
    return burning_good(sheet, singe_sim_add_source(sheet->sim, &match, NULL));
}

bool burning_blow(BurningSheet *sheet, const float velocity[3], float gust) {
    SingeWindDef wind = singe_default_sim().wind;
    memcpy(wind.velocity, velocity, sizeof wind.velocity);
    wind.gust = gust;
    return burning_lives(sheet) && burning_good(sheet, singe_sim_set_wind(sheet->sim, &wind));
}

bool burning_add_sphere(BurningSheet *sheet, const float centre[3], float radius) {
    SingeColliderDef ball = singe_default_collider();
    ball.kind = SINGE_COLLIDER_SPHERE;
    ball.radius = radius;
    memcpy(ball.position, centre, sizeof ball.position);
    return burning_lives(sheet) && burning_good(sheet, singe_sim_add_collider(sheet->sim, &ball, NULL));
}

bool burning_add_plane(BurningSheet *sheet, const float point[3], const float normal[3]) {
    SingeColliderDef plane = singe_default_collider();
    memcpy(plane.position, point, sizeof plane.position);
    // the shortest turn from z to the normal; half a turn about x where it is opposite
    const float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const float w = length + normal[2], scale = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + w * w);
    const float turn[4] = {-normal[1] / scale, normal[0] / scale, 0, w / scale}, over[4] = {1, 0, 0, 0};
    memcpy(plane.rotation, scale > 1e-6f * length ? turn : over, sizeof plane.rotation);
    return burning_lives(sheet) && burning_good(sheet, singe_sim_add_collider(sheet->sim, &plane, NULL));
}

// ---- looks

static uint8_t byte_of(float value) { return (uint8_t)(fminf(fmaxf(value, 0), 1) * 255); }

void burning_colour(float temperature, float peak, float burn, uint8_t colour[4]) {
    static const float fresh[3] = {1, 1, 1}, scorched[3] = {0.45f, 0.26f, 0.1f}, charred[3] = {0.02f, 0.018f, 0.016f},
                       ash[3] = {0.35f, 0.34f, 0.33f};
    const float brown = fminf(fmaxf((peak - 430) / 200, 0), 1), black = fminf(3 * burn, 1);
    const float grey = fmaxf(2 * burn - 1, 0);
    for (int c = 0; c < 3; c++) {
        float value = fresh[c] + brown * (scorched[c] - fresh[c]);
        value += black * (charred[c] - value);
        value += grey * (ash[c] - value);
        colour[c] = byte_of(value);
    }
    colour[3] = byte_of((temperature - 900) / 500);
}
