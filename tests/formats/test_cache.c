#include "format_test.h"

#include <math.h>
#include <unistd.h>

TEST_IN_FOLDER("a.0001.ply")

enum { VERTICES = 5, TRIANGLES = 3 };

// A surface of odd values: subnormals, negative zero, the largest float.
typedef struct Sample {
    float position[VERTICES][3], normal[VERTICES][3], uv[VERTICES][2], velocity[VERTICES][3], rest[VERTICES][3];
    float temperature[VERTICES], peak[VERTICES], mass[VERTICES], burn_rate[VERTICES], coal[VERTICES], ash[VERTICES],
        burn[VERTICES], time_ignited[VERTICES];
    int32_t piece[VERTICES], source_vertex[VERTICES], sheet[VERTICES];
    uint32_t triangles[TRIANGLES][3];
    SingeSurface surface;
} Sample;

static void fill(void *values, size_t count, uint32_t seed) {
    static const float odd[] = {0x1p-149f, -0.0f, 0x1.fffffep127f, 0x1p-126f, -1.17549e-38f, 0.1f, 1 / 3.0f};
    float *p = values;
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        p[i] = seed >> 29 ? (float)(seed >> 8) * 1e-5f - 40 : odd[(seed >> 8) % 7];
    }
}

static void make_sample(Sample *s) {
    memset(s, 0, sizeof *s);
    float *floats[] = {s->position[0], s->normal[0], s->uv[0], s->velocity[0], s->rest[0], s->temperature, s->peak,
                       s->mass,        s->burn_rate, s->coal,  s->ash,         s->burn,    s->time_ignited};
    size_t widths[] = {3, 3, 2, 3, 3, 1, 1, 1, 1, 1, 1, 1, 1};
    for (uint32_t i = 0; i < 13; i++) fill(floats[i], VERTICES * widths[i], i + 1);
    for (int i = 0; i < VERTICES; i++)
        s->piece[i] = i * 1000003, s->source_vertex[i] = i % 2 ? -1 : INT32_MAX - i, s->sheet[i] = i;
    uint32_t triangles[TRIANGLES][3] = {{0, 1, 2}, {2, 3, 4}, {4, 0, 0}};
    memcpy(s->triangles, triangles, sizeof triangles);
    s->surface = (SingeSurface){.vertex_count = VERTICES,
                                .triangle_count = TRIANGLES,
                                .position = s->position,
                                .normal = s->normal,
                                .uv = s->uv,
                                .velocity = s->velocity,
                                .rest_position = s->rest,
                                .temperature = s->temperature,
                                .temperature_peak = s->peak,
                                .mass = s->mass,
                                .burn_rate = s->burn_rate,
                                .burn = s->burn,
                                .char_fraction = s->coal,
                                .ash_fraction = s->ash,
                                .time_ignited = s->time_ignited,
                                .piece = s->piece,
                                .source_vertex = s->source_vertex,
                                .sheet = s->sheet,
                                .triangles = s->triangles};
}

static Bytes written(const SingeSurface *surface, double time) {
    SingeError error;
    if (ply_write_surface(path, surface, time, &error)) fail_msg("%s", error.message);
    return take_file(path);
}

TEST(round_trip_is_bitwise) {
    Sample sample;
    make_sample(&sample);
    Bytes bytes = written(&sample.surface, 1 / 24.0 + 7);
    SingeSurface read;
    SingeError error;
    double time = 0;
    if (ply_read_surface("a.ply", bytes.data, bytes.size, (SingeAllocator){0}, &read, &time, &error))
        fail_msg("%s", error.message);
    assert_true(time == 1 / 24.0 + 7);
    assert_int_equal(read.vertex_count, VERTICES);
    assert_int_equal(read.triangle_count, TRIANGLES);
    const SingeSurface *s = &sample.surface;
    assert_memory_equal(read.position, s->position, sizeof sample.position);
    assert_memory_equal(read.normal, s->normal, sizeof sample.normal);
    assert_memory_equal(read.uv, s->uv, sizeof sample.uv);
    assert_memory_equal(read.velocity, s->velocity, sizeof sample.velocity);
    assert_memory_equal(read.rest_position, s->rest_position, sizeof sample.rest);
    assert_memory_equal(read.temperature, s->temperature, sizeof sample.temperature);
    assert_memory_equal(read.temperature_peak, s->temperature_peak, sizeof sample.peak);
    assert_memory_equal(read.mass, s->mass, sizeof sample.mass);
    assert_memory_equal(read.burn_rate, s->burn_rate, sizeof sample.burn_rate);
    assert_memory_equal(read.char_fraction, s->char_fraction, sizeof sample.coal);
    assert_memory_equal(read.ash_fraction, s->ash_fraction, sizeof sample.ash);
    assert_memory_equal(read.burn, s->burn, sizeof sample.burn);
    assert_memory_equal(read.time_ignited, s->time_ignited, sizeof sample.time_ignited);
    assert_memory_equal(read.piece, s->piece, sizeof sample.piece);
    assert_memory_equal(read.source_vertex, s->source_vertex, sizeof sample.source_vertex);
    assert_memory_equal(read.sheet, s->sheet, sizeof sample.sheet);
    assert_memory_equal(read.triangles, s->triangles, sizeof sample.triangles);

    // and once more through the file gives the same bytes
    Bytes again = written(&read, time);
    assert_int_equal(again.size, bytes.size);
    assert_memory_equal(again.data, bytes.data, bytes.size);
    bytes_free(&again);
    bytes_free(&bytes);
    singe_surface_free(&read);
}

TEST(header_is_as_documented) {
    Sample sample;
    make_sample(&sample);
    Bytes bytes = written(&sample.surface, 0.5);
    static const char header[] =
        "ply\nformat binary_little_endian 1.0\ncomment singe " SINGE_VERSION " time 0.5\nelement vertex 5\n"
        "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
        "property float nz\n"
        "property float s\nproperty float t\nproperty float vx\nproperty float vy\nproperty float vz\n"
        "property float rest_x\nproperty float rest_y\nproperty float rest_z\nproperty float temperature\n"
        "property float temperature_peak\nproperty float mass\n"
        "property float burn_rate\nproperty float char_fraction\nproperty float ash_fraction\nproperty float burnt\n"
        "property float time_ignited\nproperty int piece_id\n"
        "property int vertex_id\nproperty int sheet\nelement face 3\nproperty list uchar int vertex_indices\n"
        "end_header\n";
    assert_memory_equal(bytes.data, header, sizeof header - 1);
    assert_int_equal(bytes.size, sizeof header - 1 + VERTICES * 25 * 4 + TRIANGLES * 13);

    // the first vertex's x and the first face, by hand
    uint32_t bits;
    memcpy(&bits, &sample.position[0][0], 4);
    const uint8_t *p = bytes.data + sizeof header - 1;
    assert_int_equal(p[0] | p[1] << 8 | p[2] << 16 | (uint32_t)p[3] << 24, bits);
    static const uint8_t face[] = {3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
    assert_memory_equal(p + VERTICES * 25 * 4, face, sizeof face);
    bytes_free(&bytes);
}

TEST(the_old_name_of_burnt_is_read) {
    Sample sample;
    make_sample(&sample);
    Bytes bytes = written(&sample.surface, 0.5);
    const char name[] = "float burnt\n", old[] = "float char\n", none[] = "float coal\n";
    char *at = strstr((char *)bytes.data, name);
    assert_non_null(at);
    const size_t before = (size_t)((uint8_t *)at - bytes.data), after = bytes.size - before - strlen(name);
    memcpy(at, old, strlen(old));
    memmove(at + strlen(old), at + strlen(name), after);
    SingeSurface read;
    SingeError error;
    assert_int_equal(ply_read_surface("a.ply", bytes.data, bytes.size - 1, (SingeAllocator){0}, &read, NULL, &error),
                     SINGE_OK);
    assert_memory_equal(read.burn, sample.surface.burn, sizeof sample.burn);
    singe_surface_free(&read);
    memcpy(at, none, strlen(none));
    assert_int_equal(ply_read_surface("a.ply", bytes.data, bytes.size - 1, (SingeAllocator){0}, &read, NULL, &error),
                     SINGE_ERROR_FORMAT);
    bytes_free(&bytes);
}

TEST(nothing_left_is_a_surface_too) {
    SingeSurface empty = {0}, read;
    Bytes bytes = written(&empty, 12);
    SingeError error;

    assert_int_equal(ply_read_surface("a.ply", bytes.data, bytes.size, (SingeAllocator){0}, &read, NULL, &error),
                     SINGE_OK);
    assert_int_equal(read.vertex_count, 0);
    assert_int_equal(read.triangle_count, 0);
    singe_surface_free(&read);
    bytes_free(&bytes);
}

static SingeResult read_copy(const uint8_t *data, size_t size, SingeError *error) {
    uint8_t *copy = calloc(size ? size : 1, 1);
    SingeSurface read;
    memcpy(copy, data, size);
    SingeResult result = ply_read_surface("a.ply", copy, size, (SingeAllocator){0}, &read, NULL, error);
    free(copy);
    if (result) assert_null(read.position);
    singe_surface_free(&read);
    return result;
}

TEST(damage_is_noticed) {
    Sample sample;
    make_sample(&sample);
    Bytes bytes = written(&sample.surface, 3);
    SingeError error;
    for (size_t size = 0; size < bytes.size; size++)
        if (read_copy(bytes.data, size, &error) == SINGE_OK) fail_msg("cut to %d bytes", (int)size);
    assert_int_equal(read_copy(bytes.data, bytes.size, &error), SINGE_OK);
    size_t faces = bytes.size - TRIANGLES * 13;
    bytes.data[faces] = 4;
    assert_int_equal(read_copy(bytes.data, bytes.size, &error), SINGE_ERROR_MESH);
    bytes.data[faces] = 3;
    bytes.data[faces + 1] = VERTICES;
    assert_int_equal(read_copy(bytes.data, bytes.size, &error), SINGE_ERROR_MESH);
    bytes.data[faces + 4] = 0xff;
    assert_int_equal(read_copy(bytes.data, bytes.size, &error), SINGE_ERROR_MESH);
    assert_message(&error, "out of range");
    bytes.data[faces + 1] = bytes.data[faces + 4] = 0;
    uint8_t *x = bytes.data + faces - VERTICES * 25 * 4;
    x[2] = 0xc0, x[3] = 0x7f;
    assert_int_equal(read_copy(bytes.data, bytes.size, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "x of vertex 0");
    bytes_free(&bytes);
    static const char mesh[] = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n";
    assert_int_equal(read_copy((const uint8_t *)mesh, sizeof mesh - 1, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "not a cache of Singe");
    static const char other[] = "ply\nformat binary_little_endian 1.0\ncomment singe 9 time 1\nelement vertex 0\n"
                                "property float x\nend_header\n";
    assert_int_equal(read_copy((const uint8_t *)other, sizeof other - 1, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "not a cache of this version");
}

TEST(refuses_to_write_nonsense) {
    Sample sample;
    make_sample(&sample);
    SingeError error;
    assert_int_equal(ply_write_surface(path, &sample.surface, NAN, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(ply_write_surface("/proc/nowhere/a.ply", &sample.surface, 0, &error), SINGE_ERROR_FILE);
    assert_int_equal(access(path, F_OK), -1);
}

TEST(allocation_failure_is_clean) {
    Sample sample;
    make_sample(&sample);
    Bytes bytes = written(&sample.surface, 3);
    SingeSurface read;
    SingeError error;
    test_allocations_fail(14, ply_read_surface("a.ply", bytes.data, bytes.size, allocator, &read, NULL, &error),
                          singe_surface_free(&read));
    bytes_free(&bytes);
    TestAllocator counter = {.fail_at = 1, .once = true};
    sample.surface.allocator = test_allocator(&counter);
    assert_int_equal(ply_write_surface(path, &sample.surface, 3, &error), SINGE_ERROR_MEMORY);
    test_allocator_check(&counter);
}
