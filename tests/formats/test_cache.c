#include "format_test.h"

TEST_IN_FOLDER("a.0001.ply")

// what a case works on
static SingeError error;

enum { VERTICES = 5, TRIANGLES = 3 };

static void fill(void *values, size_t count, uint32_t seed) {
    static const float odd[] = {0x1p-149f, -0.0f, 0x1.fffffep127f, 0x1p-126f, -1.17549e-38f, 0.1f, 1 / 3.0f};
    float *p = values;
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        p[i] = seed >> 29 ? (float)(seed >> 8) * 1e-5f - 40 : odd[(seed >> 8) % 7];
    }
}

enum { FLOATS = 13, FIELDS = 16 };
static const size_t widths[FIELDS] = {3, 3, 2, 3, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};

/// The arrays of the vertices, of 4-byte values.
static void list_fields(const SingeSurface *s, void *fields[FIELDS]) {
    void *const all[FIELDS] = {s->position,
                               s->normal,
                               s->uv,
                               s->velocity,
                               s->rest_position,
                               s->temperature,
                               s->temperature_peak,
                               s->mass,
                               s->burn_rate,
                               s->char_fraction,
                               s->ash_fraction,
                               s->burn,
                               s->time_ignited,
                               s->piece,
                               s->source_vertex,
                               s->sheet};
    memcpy(fields, all, sizeof all);
}

/// A surface of odd values: subnormals, negative zero, the largest float.
static SingeSurface make_sample(void) {
    static const uint32_t triangles[TRIANGLES][3] = {{0, 1, 2}, {2, 3, 4}, {4, 0, 0}};
    SingeSurface s;
    void *fields[FIELDS];
    assert_true(surface_new(&s, VERTICES, TRIANGLES));
    list_fields(&s, fields);
    for (uint32_t i = 0; i < FLOATS; i++) fill(fields[i], VERTICES * widths[i], i + 1);

    for (int i = 0; i < VERTICES; i++) {
        s.piece[i] = i * 1000003;
        s.source_vertex[i] = i % 2 ? -1 : INT32_MAX - i;
        s.sheet[i] = i;
    }

    memcpy(s.triangles, triangles, sizeof triangles);
    return s;
}

static Bytes written(const SingeSurface *surface, double time) {
    if (ply_write_surface(path, surface, time, &error)) fail_msg("%s", error.message);
    return take_file(path);
}

TEST(round_trip_is_bitwise) {
    OwnSurface sample = make_sample();
    OwnBytes bytes = written(&sample, 1 / 24.0 + 7);
    OwnSurface read;
    double time = 0;
    if (ply_read_surface("a.ply", bytes.data, bytes.size, (SingeAllocator){0}, &read, &time, &error))
        fail_msg("%s", error.message);
    assert_true(time == 1 / 24.0 + 7);
    assert_int_equal(read.vertex_count, VERTICES);
    assert_int_equal(read.triangle_count, TRIANGLES);

    void *fields[FIELDS], *wanted[FIELDS];
    list_fields(&read, fields);
    list_fields(&sample, wanted);
    for (int i = 0; i < FIELDS; i++) assert_memory_equal(fields[i], wanted[i], VERTICES * widths[i] * sizeof(float));
    assert_memory_equal(read.triangles, sample.triangles, TRIANGLES * sizeof *read.triangles);

    // and once more through the file gives the same bytes
    OwnBytes again = written(&read, time);
    assert_int_equal(again.size, bytes.size);
    assert_memory_equal(again.data, bytes.data, bytes.size);
}

TEST(header_is_as_documented) {
    OwnSurface sample = make_sample();
    OwnBytes bytes = written(&sample, 0.5);
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
}

TEST(a_column_of_another_name_is_refused) {
    OwnSurface sample = make_sample();
    OwnBytes bytes = written(&sample, 0.5);
    char *at = strstr((char *)bytes.data, "float burnt\n");
    assert_non_null(at);
    memcpy(at, "float coals\n", 12);

    SingeSurface read;
    assert_int_equal(ply_read_surface("a.ply", bytes.data, bytes.size, (SingeAllocator){0}, &read, NULL, &error),
                     SINGE_ERROR_FORMAT);
}

TEST(nothing_left_is_a_surface_too) {
    SingeSurface empty = {0}, read;
    OwnBytes bytes = written(&empty, 12);

    assert_int_equal(ply_read_surface("a.ply", bytes.data, bytes.size, (SingeAllocator){0}, &read, NULL, NULL),
                     SINGE_OK);
    assert_int_equal(read.vertex_count, 0);
    assert_int_equal(read.triangle_count, 0);
    singe_surface_free(&read);
}

static SingeResult read_copy(const uint8_t *data, size_t size, SingeError *why) {
    uint8_t *copy = calloc(size ? size : 1, 1);
    OwnSurface read;
    memcpy(copy, data, size);
    SingeResult result = ply_read_surface("a.ply", copy, size, (SingeAllocator){0}, &read, NULL, why);
    free(copy);
    if (result) assert_null(read.position);
    return result;
}

TEST(damage_is_noticed) {
    OwnSurface sample = make_sample();
    OwnBytes bytes = written(&sample, 3);
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

    static const char mesh[] = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n";
    assert_int_equal(read_copy((const uint8_t *)mesh, sizeof mesh - 1, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "not a cache of Singe");

    static const char other[] = "ply\nformat binary_little_endian 1.0\ncomment singe 9 time 1\nelement vertex 0\n"
                                "property float x\nend_header\n";
    assert_int_equal(read_copy((const uint8_t *)other, sizeof other - 1, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "not a cache of this version");
}

TEST(refuses_to_write_nonsense) {
    OwnSurface sample = make_sample();
    assert_int_equal(ply_write_surface(path, &sample, NAN, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(ply_write_surface("/proc/nowhere/a.ply", &sample, 0, &error), SINGE_ERROR_FILE);
    assert_int_equal(access(path, F_OK), -1);
}

TEST(allocation_failure_is_clean) {
    OwnSurface sample = make_sample();
    Bytes bytes = written(&sample, 3);
    SingeSurface read;
    test_allocations_fail(14, ply_read_surface("a.ply", bytes.data, bytes.size, allocator, &read, NULL, &error),
                          singe_surface_free(&read));
    bytes_free(&bytes);

    TestAllocator counter = {.fail_at = 1, .once = true};
    sample.allocator = test_allocator(&counter);
    assert_int_equal(ply_write_surface(path, &sample, 3, &error), SINGE_ERROR_MEMORY);
    test_allocator_check(&counter);
    sample.allocator = (SingeAllocator){0};
}
