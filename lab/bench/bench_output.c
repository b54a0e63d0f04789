// singe bench output: the cost of a frame's file in each format, for a synthetic sheet that has burnt halfway. Files go
// to a folder in memory if the system has one, so that the writer and its system calls are measured, not the disk. As
// in a run, each frame is written in a thread of its own.
#include "bench/bench.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "bench/machine.h"
#include "cli/text.h"
#include "common/store.h"
#include "formats/output.h"

enum { SIDE = 158, COUNT = SIDE * SIDE, FACES = 2 * (SIDE - 1) * (SIDE - 1), FRAMES = 20, REPEATS = 5 };

typedef struct OutputBench {
    float position[COUNT][3], normal[COUNT][3], uv[COUNT][2], velocity[COUNT][3], rest[COUNT][3];
    float temperature[COUNT], peak[COUNT], mass[COUNT], rate[COUNT], coal[COUNT], ash[COUNT], burn[COUNT],
        ignited[COUNT];
    int32_t piece[COUNT], source[COUNT], sheet[COUNT];
    uint32_t triangles[FACES][3];
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

static void output_fill(OutputBench *b) {
    uint32_t seed = 1, t = 0;
    for (uint32_t v = 0; v < COUNT; v++) {
        const float x = (float)(v % SIDE), y = (float)(v / SIDE), hot = y > 0.5f * SIDE ? y / SIDE : 0;
        const float flat[3] = {1e-3f * x, 1e-3f * y, 0}, noise = output_noise(&seed);
        for (int c = 0; c < 3; c++) {
            b->rest[v][c] = flat[c];
            b->position[v][c] = flat[c] + 1e-4f * output_noise(&seed);
            b->velocity[v][c] = output_noise(&seed) - 0.5f;
            b->normal[v][c] = (float)(c == 2) + 0.01f * output_noise(&seed);
        }

        b->uv[v][0] = x / (SIDE - 1);
        b->uv[v][1] = y / (SIDE - 1);
        b->temperature[v] = hot > 0 ? 400 + 800 * noise * hot : 293.15f;
        b->peak[v] = b->temperature[v] + hot;
        b->mass[v] = 1 - 0.5f * hot * noise;
        b->rate[v] = hot * noise;
        b->coal[v] = 0.3f * hot;
        b->ash[v] = 0.1f * hot * noise;
        b->burn[v] = 1 - b->mass[v];
        b->ignited[v] = hot > 0 ? 0.5f + noise : -1;
        b->piece[v] = hot > 0.9f ? 1 + (int32_t)(v % 7) : 0;
        b->source[v] = v % 5 ? (int32_t)v : -1;
        b->sheet[v] = 0;
    }

    for (uint32_t y = 0; y + 1 < SIDE; y++)
        for (uint32_t x = 0; x + 1 < SIDE; x++, t += 2) {
            const uint32_t a = y * SIDE + x, two[2][3] = {{a, a + 1, a + SIDE + 1}, {a, a + SIDE + 1, a + SIDE}};
            memcpy(b->triangles[t], two, sizeof two);
        }
    b->surface = (SingeSurface){.vertex_count = COUNT,
                                .triangle_count = FACES,
                                .position = b->position,
                                .normal = b->normal,
                                .uv = b->uv,
                                .velocity = b->velocity,
                                .rest_position = b->rest,
                                .temperature = b->temperature,
                                .temperature_peak = b->peak,
                                .mass = b->mass,
                                .burn_rate = b->rate,
                                .char_fraction = b->coal,
                                .ash_fraction = b->ash,
                                .burn = b->burn,
                                .time_ignited = b->ignited,
                                .piece = b->piece,
                                .source_vertex = b->source,
                                .sheet = b->sheet,
                                .triangles = b->triangles};
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
    SingeResult result = b ? SINGE_OK : SINGE_ERROR_MEMORY;
    if (b) {
        output_fill(b);
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
        free(b->path);
    }
    free(b);
    return result;
}
