// A game's loop about a burning sheet: frames of varying length, steps of a fixed one, the game's own scheduler and
// allocator. Nothing is allocated in a step; the program says so itself.
#include <singe/singe.h>

#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { CELLS = 24, CORNERS = CELLS + 1, FRAMES = 120, STEPS_MAX = 8, THREADS = 2 };

// ---- the game's allocator: counts what it gives

typedef struct Heap {
    size_t bytes, calls;
} Heap;

static void *heap_resize(void *context, void *block, size_t old_size, size_t new_size) {
    Heap *heap = context;
    heap->calls++, heap->bytes += new_size - old_size;
    if (new_size) return realloc(block, new_size);
    free(block);
    return NULL;
}

// ---- the game's scheduler: half of the work goes to a thread, the other half is done by whoever asks

typedef struct Share {
    SingeTaskFn *run;
    void *task;
    int begin, end;
} Share;

typedef struct Scheduler {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    Share share;
    bool given, quit;
} Scheduler;

static void *scheduler_work(void *argument) {
    Scheduler *s = argument;
    pthread_mutex_lock(&s->mutex);
    while (!s->quit) {
        if (s->given) {
            s->share.run(s->share.task, s->share.begin, s->share.end);
            s->given = false;
            pthread_cond_broadcast(&s->changed);
        } else {
            pthread_cond_wait(&s->changed, &s->mutex);
        }
    }
    pthread_mutex_unlock(&s->mutex);
    return NULL;
}

static void *scheduler_enqueue(void *context, SingeTaskFn *run, void *task, int count, int grain) {
    Scheduler *s = context;
    int half = count < 2 * grain ? count : count / 2;
    if (half < count) {
        pthread_mutex_lock(&s->mutex);
        s->share = (Share){run, task, half, count}, s->given = true;
        pthread_cond_broadcast(&s->changed);
        pthread_mutex_unlock(&s->mutex);
    }
    run(task, 0, half);
    return s;
}

static void scheduler_finish(void *context, void *token) {
    Scheduler *s = context;
    (void)token;
    pthread_mutex_lock(&s->mutex);
    while (s->given) pthread_cond_wait(&s->changed, &s->mutex);
    pthread_mutex_unlock(&s->mutex);
}

// ---- the game

static double now(void) {
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static SingeSim *make_cape(const SingeSimDef *def) {
    static float positions[CORNERS][CORNERS][3]; // m
    static uint32_t cells[CELLS][CELLS][4];
    for (uint32_t y = 0; y < CORNERS; y++)
        for (uint32_t x = 0; x < CORNERS; x++) {
            positions[y][x][0] = 0.4f * (float)x / CELLS, positions[y][x][2] = 0.4f * (float)y / CELLS;
            uint32_t corner = y * CORNERS + x, cell[4] = {corner, corner + 1, corner + 1 + CORNERS, corner + CORNERS};
            for (int i = 0; i < 4 && x < CELLS && y < CELLS; i++) cells[y][x][i] = cell[i];
        }
    SingeSheetDef sheet = singe_default_sheet();
    sheet.vertex_count = CORNERS * CORNERS, sheet.positions = &positions[0][0][0];
    sheet.cell_count = CELLS * CELLS, sheet.cells = &cells[0][0][0];
    const SingePoseKey hem = {.position = {0.2f, 0, 0}, .rotation = {0, 0, 0, 1}};
    SingeSourceDef torch = singe_default_source();
    torch.kind = SINGE_SOURCE_SPOT, torch.path_count = 1, torch.path = &hem;
    torch.radius = torch.falloff = 0.03f, torch.temperature = 1200, torch.end = 1;
    const float collar[6] = {0, 0, 0.4f, 0.4f, 0, 0.4f};
    SingePinDef pin = singe_default_pin();
    pin.point_count = 2, pin.points = collar, pin.radius = 0.03f;

    SingeSim *sim;
    SingeError error;
    SingeSourceId source;
    SingePinId held;
    if (singe_sim_create(def, &sim, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return NULL;
    }
    if (singe_sim_add_sheet(sim, &sheet, &pin.sheet) || singe_sim_commit(sim) ||
        singe_sim_add_source(sim, &torch, &source) || singe_sim_add_pin(sim, &pin, &held)) {
        fprintf(stderr, "%s\n", singe_sim_error(sim)->message);
        singe_sim_destroy(sim);
        return NULL;
    }
    return sim;
}

int main(void) {
    Heap heap = {0};
    Scheduler scheduler = {.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    if (pthread_create(&scheduler.thread, NULL, scheduler_work, &scheduler)) return 1;
    SingeSimDef def = singe_default_sim();
    def.allocator = (SingeAllocator){heap_resize, &heap};
    def.tasks = (SingeTasks){scheduler_enqueue, scheduler_finish, &scheduler};
    def.thread_count = THREADS;
    def.time_step = 1.0f / 240, def.pace = 8;
    SingeSim *sim = make_cape(&def);
    if (!sim) return 1;

    size_t calls = heap.calls;
    double left = 0, begun = now();
    int steps = 0;
    for (int frame = 0; frame < FRAMES; frame++) {
        left += frame % 3 ? 1.0 / 60 : 1.0 / 45; // as long as the last frame took
        // what does not fit a step stays for the next frame; a game that falls behind slows down
        for (int i = 0; left >= (double)def.time_step && i < STEPS_MAX; i++, steps++) {
            if (singe_sim_step(sim)) {
                fprintf(stderr, "%s\n", singe_sim_error(sim)->message);
                return 1;
            }
            left -= (double)def.time_step;
        }
        // here a game hands singe_sim_view(sim).position, or a drawn surface, to its renderer
    }
    const SingeStats stats = singe_sim_stats(sim);
    printf("%d frames, %d steps, %.1f ms a frame, %.1f MiB, %zu allocations in steps, %.0f %% burnt\n", FRAMES, steps,
           1e3 * (now() - begun) / FRAMES, (double)heap.bytes / (1 << 20), heap.calls - calls,
           100 * stats.burnt_fraction);
    singe_sim_destroy(sim);
    pthread_mutex_lock(&scheduler.mutex);
    scheduler.quit = true;
    pthread_cond_broadcast(&scheduler.changed);
    pthread_mutex_unlock(&scheduler.mutex);
    pthread_join(scheduler.thread, NULL);
    printf("%zu bytes left\n", heap.bytes);
    return heap.bytes != 0;
}
