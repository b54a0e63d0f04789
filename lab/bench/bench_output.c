// singe bench output: the cost of a frame's file in each format, for a synthetic sheet that has burnt halfway. Files go
// to a folder in memory if the system has one, so that the writer and its system calls are measured, not the disk. As
// in a run, each frame is written in a thread of its own.
#include "bench/bench.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "bench/machine.h"
#include "cli/text.h"
#include "formats/output.h"

enum { SIDE = 158, COUNT = SIDE * SIDE, FACES = 2 * (SIDE - 1) * (SIDE - 1), FRAMES = 20, REPEATS = 5 };

typedef struct OutputBench {
    SingeSurface surface;
    char *path;
    int format;
    const OutputScene *scene;
    SingeResult result;
    SingeError error;
} OutputBench;

/// Digits that cannot be compressed.
static float output_noise(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) * 0x1p-24f;
}

static void output_fill(SingeSurface *s) {
    uint32_t seed = 1, t = 0;
    for (uint32_t v = 0; v < COUNT; v++) {
        const float x = (float)(v % SIDE), y = (float)(v / SIDE), hot = y > 0.5f * SIDE ? y / SIDE : 0;
        const float flat[3] = {1e-3f * x, 1e-3f * y, 0}, noise = output_noise(&seed);
        for (int c = 0; c < 3; c++) {
            s->rest_position[v][c] = flat[c];
            s->position[v][c] = flat[c] + 1e-4f * output_noise(&seed);
            s->velocity[v][c] = output_noise(&seed) - 0.5f;
            s->normal[v][c] = (float)(c == 2) + 0.01f * output_noise(&seed);
        }

        s->uv[v][0] = x / (SIDE - 1);
        s->uv[v][1] = y / (SIDE - 1);
        s->temperature[v] = hot > 0 ? 400 + 800 * noise * hot : 293.15f;
        s->temperature_peak[v] = s->temperature[v] + hot;
        s->mass[v] = 1 - 0.5f * hot * noise;
        s->burn_rate[v] = hot * noise;
        s->char_fraction[v] = 0.3f * hot;
        s->ash_fraction[v] = 0.1f * hot * noise;
        s->burn[v] = 1 - s->mass[v];
        s->time_ignited[v] = hot > 0 ? 0.5f + noise : -1;
        s->piece[v] = hot > 0.9f ? 1 + (int32_t)(v % 7) : 0;
        s->source_vertex[v] = v % 5 ? (int32_t)v : -1;
    }

    for (uint32_t y = 0; y + 1 < SIDE; y++)
        for (uint32_t x = 0; x + 1 < SIDE; x++, t += 2) {
            const uint32_t a = y * SIDE + x, two[2][3] = {{a, a + 1, a + SIDE + 1}, {a, a + SIDE + 1, a + SIDE}};
            memcpy(s->triangles[t], two, sizeof two);
        }
}

static void *output_write(void *argument) {
    OutputBench *b = argument;
    const OutputFrame frame = {.surface = &b->surface, .time = 1.5, .number = 37};
    if (!b->result) b->result = output_formats[b->format].write_frame(b->path, b->scene, &frame, &b->error);
    return NULL;
}

static double seconds_of(struct timeval t) { return (double)t.tv_sec + 1e-6 * (double)t.tv_usec; }

static SingeResult output_row(OutputBench *b, BenchTable *table, double *ply, SingeError *error) {
    double min[3];
    Bytes bytes = {0};

    // seconds per frame: of the program, of the system and by the clock; the fastest of several repetitions
    const int frames = b->format == OUTPUT_textures ? 1 : FRAMES; // textures take a hundred times as long
    for (int k = 0; k < 3; k++) min[k] = INFINITY;
    for (int times = 0; times < REPEATS && !b->result; times++) {
        struct rusage before, after;
        const double clock = machine_clock();
        getrusage(RUSAGE_SELF, &before);

        for (int i = 0; i < frames; i++) {
            pthread_t thread;
            if (pthread_create(&thread, NULL, output_write, b)) output_write(b);
            else pthread_join(thread, NULL);
        }

        getrusage(RUSAGE_SELF, &after);
        const double user = (seconds_of(after.ru_utime) - seconds_of(before.ru_utime)) / frames;
        const double system = (seconds_of(after.ru_stime) - seconds_of(before.ru_stime)) / frames;
        if (user + system >= min[0] + min[1]) continue;

        min[0] = user;
        min[1] = system;
        min[2] = (machine_clock() - clock) / frames;
    }

    if (!b->result) b->result = file_read(b->path, (SingeAllocator){0}, &bytes, &b->error);
    const double size = (double)bytes.size;
    bytes_free(&bytes);
    unlink(b->path);
    *error = b->error;
    if (b->result) return b->result;

    if (b->format == OUTPUT_ply) *ply = size;
    table_text(table, "format", 9, output_formats[b->format].name);
    table_number(table, "vertices", "%.0f", 9, COUNT);
    table_number(table, "user_ms", "%.2f", 8, 1e3 * min[0]);
    table_number(table, "system_ms", "%.2f", 10, 1e3 * min[1]);
    table_number(table, "both_ms", "%.2f", 8, 1e3 * (min[0] + min[1]));
    table_number(table, "wall_ms", "%.2f", 8, 1e3 * min[2]);
    table_number(table, "bytes", "%.0f", 9, size);
    table_number(table, "of_ply_pct", "%.0f", 11, 100 * size / *ply);

    return table_end_row(table);
}

SingeResult bench_output(const BenchOptions *options, BenchTable *table, SingeError *error) {
    (void)options;
    static const float corners[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t cell[4] = {0, 1, 2, 3};
    const OutputSheet sheet = {
        .name = "sheet",
        .colour = {1, 1, 1},
        .mesh = {.vertex_count = 4, .cell_count = 1, .positions = corners, .uv = uv, .cells = cell}};
    const OutputScene scene = {.name = "bench", .fps = 24, .texture_size = 1024, .sheet_count = 1, .sheets = &sheet};
    char folder[] = "/dev/shm/singe-bench-XXXXXX"; // of a name that nobody can know beforehand
    OutputBench *b = calloc(1, sizeof *b);
    double ply = 0;
    SingeResult result = b && surface_new(&b->surface, COUNT, FACES) ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (!result) {
        output_fill(&b->surface);
        b->scene = &scene;
        if (access("/dev/shm", W_OK)) strcpy(folder, "/tmp/singe-bench-XXXXXX");
        if (!mkdtemp(folder))
            result = refuse(error, SINGE_ERROR_FILE, "bench", -1, "cannot make a folder in %s", folder);
        b->path = text_format("%s/frame", folder);
    }

    for (int i = 0; i < OUTPUT_COUNT && !result; i++) {
        if (i == OUTPUT_textures && !exr_available()) continue;
        b->format = i;
        result = output_row(b, table, &ply, error);
    }

    if (b) {
        rmdir(folder);
        singe_surface_free(&b->surface);
        free(b->path);
    }
    free(b);
    return result;
}
