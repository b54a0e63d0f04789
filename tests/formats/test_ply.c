#include "format_test.h"

// what a case works on
static Polygons mesh;
static SingeError error;

static void expect_error(const char *text, SingeResult code, int64_t line, const char *part) {
    assert_mesh_refused("a.ply", text, strlen(text), code, line, part);
}

#define HEADER "ply\nformat ascii 1.0\n"
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define FACES "property list uchar int vertex_indices\n"
#define SQUARE "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define GOOD_HEADER HEADER "element vertex 4\n" XYZ "element face 1\n" FACES "end_header\n"

TEST(reads_ascii) {
    static const char text[] = "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info x\r\n"
                               "element extra 2\r\nproperty list uchar float things\r\nproperty int k\r\n"
                               "element vertex 4\r\nproperty double z\r\nproperty float32 nx\r\nproperty float x\r\n"
                               "property float y\r\n"
                               "property float v\r\nproperty float u\r\nproperty uchar red\r\nproperty short wet\r\n"
                               "property list uchar int neighbours\r\n"
                               "element face 1\r\nproperty uchar flag\r\nproperty list uint8 uint32 vertex_index\r\n"
                               "end_header\r\n"
                               "2 0.5 1e99 7\r\n0 1\r\n"
                               "0.1 nan 1 2 0.25 0.75 255 -5 0\r\n"
                               "\r\n  -1e-3 0 3 4 0 1 0 32767 2 9 9\r\n"
                               "0 0 5 6 1 1 51 -32768 0\r\n"
                               "0 0 7 8 0 0 102 0 0\r\n"
                               "9 4 3 2 1 0";

    if (read_mesh("a.ply", text, sizeof text - 1, &mesh, &error)) fail_msg("%s", error.message);
    static const float positions[] = {1, 2, 0.1f, 3, 4, -1e-3f, 5, 6, 0, 7, 8, 0};
    static const float uv[] = {0, 0, 1, 1, 1, 0, 0.75f, 0.25f}; // of the face's corners
    static const float red[] = {1, 0, 51 * (1 / 255.0f), 102 * (1 / 255.0f)}, wet[] = {-5, 32767, -32768, 0};
    static const uint32_t cells[] = {3, 2, 1, 0};

    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.face_count, 1);
    assert_int_equal(mesh.attribute_count, 2);
    assert_memory_equal(mesh.positions, positions, sizeof positions);
    assert_memory_equal(mesh.uv, uv, sizeof uv);
    assert_memory_equal(mesh.corners, cells, sizeof cells);

    assert_string_equal(mesh.attributes[0].name, "red");
    assert_memory_equal(mesh.attributes[0].values, red, sizeof red);
    assert_string_equal(mesh.attributes[1].name, "wet");
    assert_memory_equal(mesh.attributes[1].values, wet, sizeof wet);
    polygons_free(&mesh);
}

// ---- binary files made here, in either byte order

typedef struct Maker {
    uint8_t bytes[4096];
    size_t size;
    bool big;
} Maker;

static void put(Maker *maker, uint64_t bits, int size) {
    for (int i = 0; i < size; i++) maker->bytes[maker->size++] = (uint8_t)(bits >> 8 * (maker->big ? size - 1 - i : i));
}
static void put_float(Maker *maker, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(maker, bits, 4);
}
static void put_double(Maker *maker, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(maker, bits, 8);
}
static void put_text(Maker *maker, const char *text) {
    memcpy(maker->bytes + maker->size, text, strlen(text));
    maker->size += strlen(text);
}

static const float corners[4][3] = {{0.1f, -0.2f, 1e-20f}, {1, 0, 3e38f}, {1, 1, -0.0f}, {0, 1, 0.3f}};

static Maker make_binary(bool big) {
    Maker maker = {.big = big};
    put_text(&maker, "ply\nformat ");
    put_text(&maker, big ? "binary_big_endian" : "binary_little_endian");
    put_text(&maker, " 1.0\nelement vertex 4\nproperty double x\nproperty list ushort short junk\n"
                     "property float y\nproperty float z\n"
                     "property char a\nproperty uchar b\nproperty short c\nproperty ushort d\nproperty int e\n"
                     "property uint f\n"
                     "property float texture_u\nproperty float texture_v\n"
                     "element edge 2\nproperty int p\nproperty uchar q\n"
                     "element face 2\nproperty list int ushort vertex_indices\nproperty list uchar double weights\n"
                     "end_header\n");
    for (int v = 0; v < 4; v++) {
        put_double(&maker, corners[v][0]);
        put(&maker, (uint64_t)v, 2);
        for (int i = 0; i < v; i++) put(&maker, 77, 2);
        put_float(&maker, corners[v][1]);
        put_float(&maker, corners[v][2]);
        put(&maker, 0x80, 1), put(&maker, 0x80, 1), put(&maker, 0x8001, 2), put(&maker, 0x8001, 2);
        put(&maker, 0xffffffff, 4), put(&maker, 0xffffff00, 4);
        put_float(&maker, 0.25f * (float)v), put_float(&maker, 1);
    }

    put(&maker, 1, 4), put(&maker, 2, 1), put(&maker, 3, 4), put(&maker, 4, 1);
    put(&maker, 4, 4), put(&maker, 0, 2), put(&maker, 1, 2), put(&maker, 2, 2), put(&maker, 3, 2);
    put(&maker, 0, 1);
    put(&maker, 4, 4), put(&maker, 3, 2), put(&maker, 2, 2), put(&maker, 1, 2), put(&maker, 0, 2);
    put(&maker, 1, 1), put_double(&maker, 0.5);
    return maker;
}

TEST(reads_binary_of_both_orders) {
    for (int big = 0; big < 2; big++) {
        Maker maker = make_binary(big);
        if (read_mesh("a.ply", maker.bytes, maker.size, &mesh, &error)) fail_msg("%s", error.message);
        assert_int_equal(mesh.vertex_count, 4);
        assert_memory_equal(mesh.positions, corners, sizeof corners);

        static const uint32_t cells[] = {0, 1, 2, 3, 3, 2, 1, 0};
        assert_int_equal(mesh.face_count, 2);
        assert_memory_equal(mesh.corners, cells, sizeof cells);
        assert_int_equal(mesh.attribute_count, 6);

        static const float expected[6] = {-128, 128, -32767, 32769, -1, 4294967040.0f};
        for (int i = 0; i < 6; i++) {
            assert_int_equal(mesh.attributes[i].name[0], 'a' + i);
            assert_true(mesh.attributes[i].values[3] == expected[i]);
        }

        assert_true(mesh.uv[6] == 0.75f && mesh.uv[7] == 1 && mesh.uv[8] == 0.75f);
        polygons_free(&mesh);

        // a cut anywhere is noticed
        for (size_t size = 0; size < maker.size; size++) {
            if (read_mesh("a.ply", maker.bytes, size, &mesh, &error) == SINGE_OK)
                fail_msg("cut to %d bytes", (int)size);
            assert_true(error.message[0] != 0);
        }
    }
}

TEST(refuses_bad_headers) {
    expect_error("", SINGE_ERROR_FORMAT, 1, "empty");
    expect_error("plx\nformat ascii 1.0\n", SINGE_ERROR_FORMAT, 1, "not a PLY file");
    expect_error("ply", SINGE_ERROR_FORMAT, 1, "not a PLY file");
    expect_error("ply\n", SINGE_ERROR_FORMAT, 2, "not a line");
    expect_error("ply\nelement vertex 4\nend_header\n", SINGE_ERROR_FORMAT, 3, "no format line");
    expect_error("ply\nformat utf8 1.0\n", SINGE_ERROR_FORMAT, 2, "not a PLY format");
    expect_error("ply\nformat ascii 2.0\n", SINGE_ERROR_FORMAT, 2, "version 1.0");
    expect_error(HEADER "format ascii 1.0\n", SINGE_ERROR_FORMAT, 3, "twice");
    expect_error(HEADER "element vertex\n", SINGE_ERROR_FORMAT, 3, "the line has no count of elements");
    expect_error(HEADER "element vertex -4\n", SINGE_ERROR_FORMAT, 3, "the line has no count of elements");
    expect_error(HEADER "element vertex 4x\n", SINGE_ERROR_FORMAT, 3, "the line has no count of elements");
    expect_error(HEADER "element vertex 4294967296\n", SINGE_ERROR_LIMIT, 3, "too many");
    expect_error(HEADER "element vertex 99999999999999999999999\n", SINGE_ERROR_LIMIT, 3, "too many");
    expect_error(HEADER "element\n", SINGE_ERROR_FORMAT, 3, "name is missing");
    expect_error(HEADER "element vertex 4 5\n", SINGE_ERROR_FORMAT, 3, "too many words");
    expect_error(HEADER "element vertex 4\nelement vertex 4\n", SINGE_ERROR_FORMAT, 4, "twice");
    expect_error(HEADER "property float x\n", SINGE_ERROR_FORMAT, 3, "before any element");
    expect_error(HEADER "element vertex 4\nproperty real x\n", SINGE_ERROR_FORMAT, 4, "a PLY type is missing");
    expect_error(HEADER "element vertex 4\nproperty float x\nproperty int x\n", SINGE_ERROR_FORMAT, 5, "twice");
    expect_error(HEADER "element vertex 4\nproperty float\n", SINGE_ERROR_FORMAT, 4, "name is missing");
    expect_error(HEADER "element face 4\nproperty list float int vertex_indices\n", SINGE_ERROR_FORMAT, 4,
                 "integer type");
    expect_error(HEADER "elephant\n", SINGE_ERROR_FORMAT, 3, "this is not a line of a PLY header");
    expect_error(HEADER "element vertex 4\n" XYZ "element face 1\n" FACES "end_header", SINGE_ERROR_FORMAT, 9,
                 "truncated");
}

TEST(refuses_bad_bodies) {
    expect_error(HEADER "element face 1\n" FACES "end_header\n4 0 1 2 3\n", SINGE_ERROR_FORMAT, -1, "no vertices");
    expect_error(HEADER "element vertex 4\n" XYZ "end_header\n" SQUARE, SINGE_ERROR_FORMAT, -1, "no faces");
    expect_error(HEADER "element vertex 0\n" XYZ "element face 0\n" FACES "end_header\n", SINGE_ERROR_FORMAT, -1,
                 "no vertices");
    expect_error(HEADER "element vertex 4\n" XYZ "element face 0\n" FACES "end_header\n" SQUARE, SINGE_ERROR_FORMAT, -1,
                 "no faces");
    expect_error(HEADER "element vertex 4\nproperty float x\nproperty float y\nelement face 1\n" FACES
                        "end_header\n0 0\n0 0\n0 0\n0 0\n4 0 1 2 3\n",
                 SINGE_ERROR_FORMAT, -1, "no property \"z\"");
    expect_error(HEADER "element vertex 4\n" XYZ "element face 1\nproperty list uchar int corners\nend_header\n" SQUARE
                        "4 0 1 2 3\n",
                 SINGE_ERROR_FORMAT, -1, "no list \"vertex_indices\"");
    expect_error(HEADER "element vertex 4\n" XYZ
                        "element face 1\nproperty list uchar float vertex_indices\nend_header\n" SQUARE "4 0 1 2 3\n",
                 SINGE_ERROR_FORMAT, -1, "integer type");
    expect_error(GOOD_HEADER SQUARE "2 0 1\n", SINGE_ERROR_MESH, 14, "a.ply:14: face has 2 corners; it needs three");
    expect_error(GOOD_HEADER SQUARE "255 0 1 2 3 0\n", SINGE_ERROR_FORMAT, 14, "too few values");
    expect_error(GOOD_HEADER SQUARE "300 0 1 2 3 0\n", SINGE_ERROR_FORMAT, 14, "the value in column 1 is out of range");
    expect_error(GOOD_HEADER SQUARE "-4 0 1 2 3 0\n", SINGE_ERROR_FORMAT, 14, "out of range");
    expect_error(GOOD_HEADER SQUARE "4 0 1 2 4\n", SINGE_ERROR_MESH, 14, "index 4 is out of range");
    expect_error(GOOD_HEADER SQUARE "4 0 1 2 -1\n", SINGE_ERROR_MESH, 14, "index -1 is out of range");
    expect_error(GOOD_HEADER SQUARE "4 0 1 2.5 3\n", SINGE_ERROR_FORMAT, 14, "the value in column 7 is not an integer");
    expect_error(GOOD_HEADER SQUARE "4 0 1 2\n", SINGE_ERROR_FORMAT, 14, "too few values");
    expect_error(GOOD_HEADER SQUARE "4 0 1 2 3 4\n", SINGE_ERROR_FORMAT, 14, "too many values");
    expect_error(GOOD_HEADER SQUARE, SINGE_ERROR_FORMAT, -1, "too short");
    expect_error(GOOD_HEADER "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", SINGE_ERROR_FORMAT, 11,
                 "is not a finite number");
    expect_error(GOOD_HEADER "0 0 0\n1 1e39 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", SINGE_ERROR_FORMAT, 11, "is out of range");
    expect_error(GOOD_HEADER "0 0 0\n1 y 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", SINGE_ERROR_FORMAT, 11, "is not a number");
    expect_error(GOOD_HEADER "0 0 0\n1 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", SINGE_ERROR_FORMAT, 11, "too few values");
}

TEST(refuses_bad_binary_values) {
    static const double bad[] = {NAN, INFINITY, 1e300, -3.5e38};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Maker maker = {0};
        put_text(&maker, "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\nproperty float y\n"
                         "property float z\n"
                         "element face 1\n" FACES "end_header\n");
        size_t body = maker.size;

        put_double(&maker, bad[i]);
        for (int k = 0; k < 40; k++) put(&maker, 0, 1);
        assert_int_equal(read_mesh("a.ply", maker.bytes, maker.size, &mesh, &error), SINGE_ERROR_FORMAT);
        assert_true(error.element >= (int64_t)body && error.element <= (int64_t)body + 8);
    }
}

// Counts and list lengths that the file cannot hold are refused before memory is taken for them.
TEST(large_claims_take_no_memory) {
    static const char *const claims[] = {
        "ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\n" XYZ "element face 1\n" FACES "end_header\n"
        "0123456789",
        "ply\nformat ascii 1.0\nelement vertex 2147483647\n" XYZ "element face 1\n" FACES "end_header\n0 0 0\n",
        "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 2147483647\n" FACES "end_header\n0 0 0\n"
        "4 0 0 0 0\n",
        "ply\nformat binary_big_endian 1.0\nelement nothing 2147483647\nelement vertex 1\n" XYZ
        "element face 2147483647\n" FACES "end_header\n0123456789012345",
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty list uint double l\n" XYZ
        "element face 1\n" FACES
        "end_header\n\xff\xff\xff\xff\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01",
    };

    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
        TestAllocator counter = {0};
        assert_int_equal(
            ply_read("a.ply", (const uint8_t *)claims[i], strlen(claims[i]), test_allocator(&counter), &mesh, &error),
            SINGE_ERROR_FORMAT);
        assert_true(counter.largest < 4096);
        test_allocator_check(&counter);
    }
}

// Triangles and polygons, and uv of each face's own (MeshLab), which may come before its corners.
TEST(faces_have_uv_of_their_own) {
    static const char text[] =
        HEADER "element vertex 4\n" XYZ "element face 2\nproperty list uchar float texcoord\n" FACES
               "end_header\n" SQUARE "6 0 0 1 0 1 1 3 0 1 2\n8 0 0 1 1 0 1 .5 .5 4 0 2 3 1\n";

    if (read_mesh("a.ply", text, sizeof text - 1, &mesh, &error)) fail_msg("%s", error.message);
    static const float uv[] = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0.5f, 0.5f};
    static const uint32_t face_corners[] = {0, 1, 2, 0, 2, 3, 1}, first[] = {0, 3, 7};
    assert_int_equal(mesh.face_count, 2);

    assert_memory_equal(mesh.uv, uv, sizeof uv);
    assert_memory_equal(mesh.corners, face_corners, sizeof face_corners);
    assert_memory_equal(mesh.first, first, sizeof first);
    polygons_free(&mesh);
    expect_error(HEADER "element vertex 4\n" XYZ "element face 1\nproperty list uchar float texcoord\n" FACES
                        "end_header\n" SQUARE "4 0 0 1 0 3 0 1 2\n",
                 SINGE_ERROR_MESH, -1, "u and v for each");
}

TEST(every_truncation_of_ascii_is_an_error) {
    static const char text[] = GOOD_HEADER SQUARE "4 0 1 2 3\n";

    // only the last newline may be missing
    for (size_t size = 0; size + 2 < sizeof text; size++)
        assert_int_not_equal(read_mesh("a.ply", text, size, &mesh, &error), SINGE_OK);
    assert_int_equal(read_mesh("a.ply", text, sizeof text - 2, &mesh, &error), SINGE_OK);
    polygons_free(&mesh);
}

TEST(allocation_failure_is_clean) {
    Maker maker = make_binary(false);
    test_allocations_fail(15, ply_read("a.ply", maker.bytes, maker.size, allocator, &mesh, &error),
                          polygons_free(&mesh));
}

/// Their names are compared with each other: many of them would take minutes.
TEST(kinds_of_elements_and_properties_are_limited) {
    enum { LINE = 24, MAX = 1001 };
    static char text[MAX * LINE + 400];
    for (int kinds = 0; kinds < 2; kinds++) {
        size_t length = (size_t)sprintf(text, kinds ? HEADER : HEADER "element a 0\n");
        int count = kinds ? 101 : MAX;
        for (int i = 0; i < count; i++)
            length += (size_t)sprintf(text + length, kinds ? "element e%d 0\n" : "property int p%d\n", i);
        strcpy(text + length, "end_header\n");
        expect_error(text, SINGE_ERROR_LIMIT, kinds ? 103 : 1004,
                     kinds ? "more than 100 kinds of elements" : "more than 1000 properties");
    }
}

/// A count of elements without properties needs no bytes in the file, and must get none in memory.
TEST(counts_without_bytes_take_no_memory) {
    static const char text[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nelement face 1\n" FACES "end_header\n\3";
    TestAllocator counts = {0};

    assert_int_equal(ply_read("a.ply", (const uint8_t *)text, sizeof text - 1, test_allocator(&counts), &mesh, &error),
                     SINGE_ERROR_FORMAT);
    assert_message(&error, "no property \"x\"");
    assert_true(counts.largest < 10000);
    test_allocator_check(&counts);
}
