// Frames of the USD format: every value comes back by a reader of the tests' own, in the bytes and the time promised.
#include "crate_reader.h"

#include "formats/usd_crate.h"
#include "formats/output.h"

#include <sys/resource.h>

static char folder[] = "/dev/shm/singe-usd-XXXXXX", path[512];

/// A sheet of side x side vertices, half of it burning, as values of its fields; `sheets` of them, vertices in turn.
static void make_sheet(SingeSurface *s, uint32_t side, int32_t sheets) {
    const uint32_t count = side * side;
    *s = (SingeSurface){.vertex_count = count, .triangle_count = 2 * (side - 1) * (side - 1)};
    s->position = malloc(12 * count), s->normal = malloc(12 * count), s->uv = malloc(8 * count);
    s->velocity = malloc(12 * count), s->rest_position = malloc(12 * count);
    s->temperature = malloc(4 * count), s->temperature_peak = malloc(4 * count), s->mass = malloc(4 * count);
    s->burn_rate = malloc(4 * count), s->char_fraction = malloc(4 * count), s->ash_fraction = malloc(4 * count);
    s->burn = malloc(4 * count), s->time_ignited = malloc(4 * count), s->piece = malloc(4 * count);
    s->source_vertex = malloc(4 * count), s->sheet = malloc(4 * count), s->water = malloc(4 * count);
    s->triangles = malloc(12 * s->triangle_count);

    uint32_t seed = 1;
    for (uint32_t v = 0; v < count; v++) {
        const float x = (float)(v % side), y = (float)(v / side), hot = y > 0.5f * (float)side ? y / (float)side : 0;
        for (int c = 0; c < 3; c++) {
            seed = seed * 1664525u + 1013904223u;
            const float noise = (float)(seed >> 8) * 0x1p-24f;
            s->position[v][c] = (c == 0 ? x : c == 1 ? y : 0) * 1e-3f + noise * 1e-4f;
            s->velocity[v][c] = noise - 0.5f, s->normal[v][c] = (float)(c == 2) + 0.01f * noise;
            s->rest_position[v][c] = (c == 0 ? x : c == 1 ? y : 0) * 1e-3f;
        }

        const float noise = (float)(seed >> 8) * 0x1p-24f;
        s->uv[v][0] = x / (float)side, s->uv[v][1] = y / (float)side;
        s->temperature[v] = hot > 0 ? 400 + 800 * noise * hot : 293.15f;
        s->temperature_peak[v] = s->temperature[v] + hot, s->mass[v] = 1 - 0.5f * hot * noise;
        s->burn_rate[v] = hot * noise, s->char_fraction[v] = 0.3f * hot, s->ash_fraction[v] = 0.1f * hot * noise;
        s->burn[v] = 1 - s->mass[v], s->time_ignited[v] = hot > 0 ? 0.5f + noise : -1;
        s->piece[v] = hot > 0.9f ? 1 + (int32_t)(v % 7) : 0, s->source_vertex[v] = v % 5 ? (int32_t)v : -1;
        s->sheet[v] = (int32_t)(v % (uint32_t)sheets), s->water[v] = hot > 0 ? 0 : noise;
    }

    uint32_t t = 0;
    for (uint32_t y = 0; y + 1 < side; y++)
        for (uint32_t x = 0; x + 1 < side; x++) {
            const uint32_t a = y * side + x;
            const uint32_t two[2][3] = {{a, a + 1, a + side + 1}, {a, a + side + 1, a + side}};
            for (int k = 0; k < 2; k++, t++) memcpy(s->triangles[t], two[k], sizeof two[k]);
        }
}

static SingeResult write_as(int format, const SingeSurface *s, uint32_t sheets, const char *picture,
                            SingeError *error) {
    static const OutputSheet pair[2] = {{.name = "a b", .colour = {1, 1, 1}}, {.name = "a/b", .colour = {1, 0, 0}}};
    static const float uv[8] = {0, 0, 1, 0, 1, 1, 0, 1}, corners[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const uint32_t cell[4] = {0, 1, 2, 3};
    OutputSheet list[2] = {pair[0], pair[1]};
    list[0].picture = picture;
    for (int i = 0; i < 2; i++)
        list[i].mesh = (OutputMesh){.vertex_count = 4, .cell_count = 1, .positions = corners, .uv = uv, .cells = cell};

    const OutputScene scene = {
        .name = "7 up", .fps = 24, .texture_size = 32, .wet = s->wet, .sheet_count = sheets, .sheets = list};
    const OutputFrame frame = {.surface = s, .time = 1.5, .number = 37};
    return output_formats[format].write_frame(path, &scene, &frame, error);
}

static SingeResult write_sheet(const SingeSurface *s, uint32_t sheets, const char *picture, SingeError *error) {
    return write_as(OUTPUT_usd, s, sheets, picture, error);
}

static Bytes written(const SingeSurface *s, uint32_t sheets, const char *picture) {
    SingeError error;
    if (write_sheet(s, sheets, picture, &error)) fail_msg("%s", error.message);
    return take_file(path);
}

/// Compares an attribute of a mesh with the values of the vertices that its sheet has.
static void check_attribute(const CrateFile *file, const SingeSurface *s, const char *mesh, int32_t sheet,
                            const char *name, const void *values, int type, int width) {
    char full[300];
    double time;
    size_t count, at = 0;
    snprintf(full, sizeof full, "%s.%s", mesh, name);

    uint32_t *read = crate_samples(file, full, type, width, &time, &count);
    assert_true(time == 37);

    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (s->sheet[v] != sheet) continue;
        assert_true(at < count);
        assert_memory_equal(read + (size_t)width * at++, (const uint32_t *)values + (size_t)width * v,
                            4 * (size_t)width);
    }

    assert_int_equal(at, count);
    free(read);
}

static void check_mesh(const CrateFile *file, const SingeSurface *s, const char *mesh, int32_t sheet) {
    assert_string_equal(crate_text(file, mesh, "typeName"), "Mesh");
    check_attribute(file, s, mesh, sheet, "points", s->position, 24, 3);
    check_attribute(file, s, mesh, sheet, "velocities", s->velocity, 24, 3);
    check_attribute(file, s, mesh, sheet, "normals", s->normal, 24, 3);
    check_attribute(file, s, mesh, sheet, "primvars:st", s->uv, 20, 2);
    check_attribute(file, s, mesh, sheet, "primvars:rest", s->rest_position, 24, 3);

    for (int i = 0; i < surface_field_count(s->wet); i++) {
        char name[80];
        snprintf(name, sizeof name, "primvars:%s", surface_fields[i].name);
        check_attribute(file, s, mesh, sheet, name, surface_field(s, &surface_fields[i]),
                        surface_fields[i].integer ? 3 : 8, 1);
    }
}

static void check_triangles(const CrateFile *file, const SingeSurface *s, const char *mesh) {
    char full[300];
    double time;
    size_t count;
    snprintf(full, sizeof full, "%s.faceVertexIndices", mesh);

    uint32_t *read = crate_samples(file, full, 3, 1, &time, &count);
    assert_int_equal(count, 3 * s->triangle_count);
    assert_memory_equal(read, s->triangles, 4 * count);
    free(read);
    snprintf(full, sizeof full, "%s.faceVertexCounts", mesh);
    read = crate_samples(file, full, 3, 1, &time, &count);
    assert_int_equal(count, s->triangle_count);
    for (size_t i = 0; i < count; i++) assert_int_equal(read[i], 3);
    free(read);
}

TEST(every_value_comes_back) {
    OwnSurface s;
    CrateFile file;

    make_sheet(&s, 40, 1);
    OwnBytes bytes = written(&s, 1, NULL);
    crate_open(&file, bytes.data, bytes.size);
    assert_string_equal(crate_text(&file, "", "upAxis"), "Z");
    assert_string_equal(crate_text(&file, "", "defaultPrim"), "_7_up");
    check_mesh(&file, &s, "/_7_up/sheets/a_b", 0);
    check_triangles(&file, &s, "/_7_up/sheets/a_b");
    crate_close(&file);
}

/// Two sheets whose vertices take turns, with names that become one.
TEST(sheets_are_meshes_of_their_own) {
    OwnSurface s;
    CrateFile file;
    SingeError error;

    make_sheet(&s, 12, 2);
    s.triangle_count = 0, s.wet = true;

    OwnBytes bytes = written(&s, 2, NULL);
    crate_open(&file, bytes.data, bytes.size);
    check_mesh(&file, &s, "/_7_up/sheets/a_b", 0);
    check_mesh(&file, &s, "/_7_up/sheets/a_b_2", 1);
    crate_close(&file);

    s.triangle_count = 1; // of vertices 0, 1 and 13
    assert_int_equal(write_sheet(&s, 2, NULL, &error), SINGE_ERROR_FORMAT);
    assert_non_null(strstr(error.message, "triangle 0 belongs to two sheets"));
    s.triangle_count = 0, s.sheet[5] = 2;
    assert_int_equal(write_sheet(&s, 2, NULL, &error), SINGE_ERROR_FORMAT);
    assert_non_null(strstr(error.message, "vertex 5 belongs to sheet 2"));
}

/// With a picture every face is in one of two subsets: those that look as at the start, and the others.
TEST(pictured_sheets_have_subsets) {
    OwnSurface s;
    CrateFile file;
    double time;
    size_t fresh, burnt;

    make_sheet(&s, 30, 1);
    OwnBytes bytes = written(&s, 1, "./a.png");
    crate_open(&file, bytes.data, bytes.size);
    uint32_t *a = crate_samples(&file, "/_7_up/sheets/a_b/fresh.indices", 3, 1, &time, &fresh);
    uint32_t *b = crate_samples(&file, "/_7_up/sheets/a_b/burnt.indices", 3, 1, &time, &burnt);

    assert_int_equal(fresh + burnt, s.triangle_count);
    assert_true(fresh > s.triangle_count / 3 && burnt > s.triangle_count / 3);
    for (size_t i = 0; i < fresh; i++) assert_true(s.temperature_peak[s.triangles[a[i]][0]] < 300);
    free(a), free(b);
    crate_close(&file);
}

TEST(nothing_left_is_a_frame_too) {
    const SingeSurface none = {0};
    CrateFile file;
    OwnBytes bytes = written(&none, 1, "a.png");
    crate_open(&file, bytes.data, bytes.size);
    check_mesh(&file, &none, "/_7_up/sheets/a_b", 0);
    check_triangles(&file, &none, "/_7_up/sheets/a_b");
    crate_close(&file);
}

/// The tests' reader unpacks the output of lz4_pack; repeats are short.
TEST(packed_bytes_come_back) {
    static const size_t sizes[] = {0, 1, 12, 13, 14, 15, 16, 255, 270, 271, 5000, 70000, 300000};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int kind = 0; kind < 4; kind++) {
            const size_t size = sizes[k];
            uint8_t *in = malloc(size + 1), *packed = malloc(lz4_size_max(size) + 1), *out = malloc(size + 1);
            uint32_t seed = 7;
            for (size_t i = 0; i < size; i++) {
                seed = seed * 1664525u + 1013904223u;
                in[i] = (uint8_t)(kind == 0   ? 0
                                  : kind == 1 ? seed >> 24
                                  : kind == 2 ? i % 37
                                  : i % 1000  ? i / 3
                                              : seed >> 20);
            }
            packed[0] = 0;
            const size_t length = lz4_pack(in, size, packed + 1);
            assert_true(length <= lz4_size_max(size));
            assert_int_equal(crate_unpack(packed, length + 1, out, size), size);
            assert_memory_equal(out, in, size);
            if (kind == 0 && size == 5000) assert_true(length < 60);
            if (kind == 2 && size == 70000) assert_true(length < 400);
            free(in), free(packed), free(out);
        }
}

static size_t out_of_memory_countdown;
static void *stingy(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context, (void)old_size;
    if (!new_size) {
        free(block);
        return NULL;
    }
    return out_of_memory_countdown-- ? realloc(block, new_size) : NULL;
}

/// Each allocation fails once, in every format: an error and no file, unless it can do without.
static void check_memory(int format) {
    OwnSurface s;
    size_t failures = 0;

    make_sheet(&s, 20, 1);
    for (size_t n = 0; n < 1000; n++) {
        SingeError error = {0};
        s.allocator.resize = stingy;
        out_of_memory_countdown = n;

        const SingeResult result = write_as(format, &s, 1, "a.png", &error);
        const bool all = out_of_memory_countdown < 1000000;

        s.allocator.resize = NULL;
        assert_int_equal(access(path, F_OK) == 0, result == SINGE_OK);
        unlink(path);
        if (result) assert_int_equal(error.code, SINGE_ERROR_MEMORY), failures++;
        else if (all) break;
    }

    assert_true(failures > 0 && failures < 900);
}

TEST(without_memory_there_is_no_file) {
    for (int format = 0; format < OUTPUT_COUNT; format++)
        if (format != OUTPUT_textures || exr_available()) check_memory(format);
}

/// A fully burnt sheet still yields a valid file in every format.
TEST(every_format_has_empty_frames) {
    const SingeSurface none = {0};
    for (int format = 0; format < OUTPUT_COUNT; format++) {
        if (format == OUTPUT_textures && !exr_available()) continue;
        assert_int_equal(write_as(format, &none, 2, "a.png", NULL), SINGE_OK);
        assert_int_equal(access(path, F_OK), 0);
        unlink(path);
    }
}

/// Seconds that the program itself has used, and the system for it (memory, the file).
static double time_used(double *system) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    *system = (double)usage.ru_stime.tv_sec + 1e-6 * (double)usage.ru_stime.tv_usec;
    return (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec;
}

/// Seconds of a fixed piece of work, eight million multiplications that follow each other: how fast the machine is now.
static double yardstick(void) {
    double system;
    const double begun = time_used(&system);
    volatile uint64_t start = 14695981039346656037u;
    uint64_t hash = start;
    for (uint32_t i = 0; i < 8000000; i++) hash = (hash ^ i) * 1099511628211u;
    start = hash;
    return time_used(&system) - begun;
}

/// At 25,000 vertices a frame takes at most 5 ms of the program's time and 75 % of the bytes of the PLY.
TEST(is_fast_and_small) {
    OwnSurface s;
    Bytes ply;
    make_sheet(&s, 158, 1);
    enum { FRAMES = 20, TIMES = 20 };
    const double usual = 5.5e-3; // s of the yardstick on an idle Zen 3 core; the bar grows where it takes longer
    double system[2], ply_system[2], mean = 1, yard = 1;
    for (int times = 0; times < TIMES && mean > 4e-3; times++) { // the least of some: others use the machine, too
        const double own = time_used(&system[0]);
        for (int i = 0; i < FRAMES; i++) assert_int_equal(write_sheet(&s, 1, NULL, NULL), SINGE_OK);
        mean = fmin(mean, (time_used(&system[1]) - own) / FRAMES);
        yard = fmin(yard, yardstick());
    }
    for (int times = 0; times < TIMES && yard > usual; times++) yard = fmin(yard, yardstick());
    const double begun = time_used(&ply_system[0]);
    for (int i = 0; i < FRAMES; i++) assert_int_equal(ply_write_surface(path, &s, 1.5, NULL), SINGE_OK);
    const double ply_mean = (time_used(&ply_system[1]) - begun) / FRAMES;
    Bytes usd = written(&s, 1, NULL);
    assert_int_equal(ply_write_surface(path, &s, 1.5, NULL), SINGE_OK);
    ply = take_file(path);
    const double share = (double)usd.size / (double)ply.size;
    const double bar = 5e-3 * fmax(1, yard / usual);
    printf(
        "%u vertices: %.2f ms a frame (bar %.2f, yardstick %.2f) and %.2f of the system, PLY %.2f and %.2f; %.0f %% of "
        "its bytes (bar 75)\n",
        s.vertex_count, 1e3 * mean, 1e3 * bar, 1e3 * yard, 1e3 * (system[1] - system[0]) / FRAMES, 1e3 * ply_mean,
        1e3 * (ply_system[1] - ply_system[0]) / FRAMES, 100 * share);
    assert_true(share <= 0.75);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__OPTIMIZE__)
    assert_true(mean <= bar);
#endif
    bytes_free(&usd), bytes_free(&ply);
}

static void make_path(int argc, char **argv) {
    (void)argc;
    (void)argv;
    // in memory where that can be: what is timed is the writer, not the disk
    if (access("/dev/shm", W_OK)) strcpy(folder, "/tmp/singe-usd-XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/frame.usdc", folder);
}

static int remove_folder(void) { return rmdir(folder) != 0; }

TEST_AROUND(make_path, remove_folder)
