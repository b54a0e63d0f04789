// STL: what is read, and what is refused with its line or byte.
#include "format_test.h"

// what a case works on
static Polygons mesh;
static SingeError error;

static void expect_mesh(const char *name, const char *text, const float *positions, uint32_t vertices,
                        const uint32_t *corners, uint32_t corner_count, uint32_t faces) {
    if (read_mesh(name, text, strlen(text), &mesh, &error)) fail_msg("%s", error.message);
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(mesh.corner_count, corner_count);
    assert_int_equal(mesh.face_count, faces);
    assert_memory_equal(mesh.positions, positions, 12 * vertices);
    assert_memory_equal(mesh.corners, corners, 4 * corner_count);
    assert_int_equal(mesh.first[0], 0);
    assert_int_equal(mesh.first[faces], corner_count);
    polygons_free(&mesh);
}

static const float triangles[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, .5f};
static const uint32_t in_order[] = {0, 1, 2, 3, 4, 5};

#define FACET(a, b, c) \
    " facet normal 0 0 1\n  outer loop\n   vertex " a "\n   vertex " b "\n   vertex " c "\n  endloop\n endfacet\n"

TEST(stl_text_is_read) {
    static const char *const texts[] = {
        "solid a b\n" FACET("0 0 0", "1 0 0", "1 1 0") FACET("0 0 0", "1 1 0", "0 1 .5") "endsolid a b\n",
        "solid\n" FACET("0 0 0", "1 0 0", "1 1 0") "endsolid\nsolid two\nendsolid\nsolid 3\n" FACET(
            "0 0 0", "1 1 0", "0 1 .5") "endsolid",
        "\nSOLID x\r\nFACET NORMAL nan -nan(ind) 0\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\nVERTEX 1 1 0\r\n"
        "ENDLOOP\r\nENDFACET\r\n" FACET("0 0 0", "1 1 0", "0 1 .5") "EndSolid\r\n",
    };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        expect_mesh("a.stl", texts[i], triangles, 6, in_order, 6, 2);
}

static size_t binary(uint8_t *bytes, const char *head, uint32_t count) {
    memset(bytes, 0, 84);
    strcpy((char *)bytes, head);
    for (int i = 0; i < 4; i++) bytes[80 + i] = (uint8_t)(count >> 8 * i);
    for (size_t f = 0; f < 2; f++) {
        memset(bytes + 84 + 50 * f, 0xff, 50); // the normal may be anything
        memcpy(bytes + 96 + 50 * f, triangles + 9 * f, 36);
    }
    return 184;
}

TEST(stl_bytes_are_read) {
    uint8_t bytes[184];

    static const char *const heads[] = {"a program", "solid, though it is not"};
    for (int i = 0; i < 2; i++) {
        size_t size = binary(bytes, heads[i], 2);
        if (read_mesh("a.stl", bytes, size, &mesh, &error)) fail_msg("%s", error.message);
        assert_int_equal(mesh.face_count, 2);
        assert_memory_equal(mesh.positions, triangles, sizeof triangles);
        assert_memory_equal(mesh.corners, in_order, sizeof in_order);
        polygons_free(&mesh);
    }
}

TEST(stl_bytes_are_refused) {
    char bytes[185] = "";
    size_t size = binary((uint8_t *)bytes, "a", 2);

    assert_mesh_refused("a.stl", bytes, 0, SINGE_ERROR_FORMAT, 1, "empty");
    assert_mesh_refused("a.stl", bytes, 83, SINGE_ERROR_FORMAT, 0, "83 bytes are too few");
    assert_mesh_refused("a.stl", bytes, size - 1, SINGE_ERROR_FORMAT, 80,
                        "byte 80: the file's length does not match its number of triangles");
    assert_mesh_refused("a.stl", bytes, size + 1, SINGE_ERROR_FORMAT, 80, "the file's length does not match");

    bytes[83] = (char)0xff;
    assert_mesh_refused("a.stl", bytes, size, SINGE_ERROR_FORMAT, 80, "the file's length does not match");
    binary((uint8_t *)bytes, "a", 0);
    assert_mesh_refused("a.stl", bytes, 84, SINGE_ERROR_FORMAT, 80, "no faces");
    binary((uint8_t *)bytes, "a", 2);
    memset(bytes + 150, 0xff, 4);
    assert_mesh_refused("a.stl", bytes, size, SINGE_ERROR_FORMAT, 150, "byte 150: a position is not finite");
}

TEST(stl_text_is_refused) {
    static const struct {
        const char *text;
        int line;
        const char *part;
    } cases[] = {
        {"solid\n", 2, "\"endsolid\" is missing"},
        {"solid\nendsolid\n", 3, "no faces"},
        {"solid a\nfacet 0 0 1\n", 2, "\"normal\" is missing"},
        {"solid a\nfacet normal 0 0 1\nouter vertex\n", 3, "\"outer loop\" is missing"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n", 4, "too few values"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 x\n", 4, "column 12 is not a number"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 inf\n", 4, "not a finite number"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nendloop", 5, "\"vertex\" is missing"},
        {"solid a\n" FACET("0 0 0", "1 0 0", "1 1 0"), 9, "\"endsolid\" is missing"},
        {"solid a\n" FACET("0 0 0", "1 0 0", "1 1 0") "endsolid\nmore", 10, "\"solid\" is missing"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_mesh_refused("a.stl", cases[i].text, strlen(cases[i].text), SINGE_ERROR_FORMAT, cases[i].line,
                            cases[i].part);
}

static const char good_stl[] =
    "solid a\n" FACET("0 0 0", "1 0 0", "1 1 0") FACET("0 0 0", "1 1 0", "0 1 .5") "endsolid";

TEST(every_cut_is_refused) {
    uint8_t bytes[184];
    for (size_t size = 0; size < sizeof good_stl - 1; size++)
        assert_int_equal(read_mesh("a.stl", good_stl, size, &mesh, &error), SINGE_ERROR_FORMAT);
    for (size_t size = 0; size < binary(bytes, "a", 2); size++)
        assert_int_equal(read_mesh("a.stl", bytes, size, &mesh, &error), SINGE_ERROR_FORMAT);
}

TEST(failing_memory_is_reported) {
    uint8_t bytes[184];
    binary(bytes, "a", 2);

    const struct {
        const char *name;
        const void *data;
        size_t size;
    } files[] = {{"a.stl", good_stl, sizeof good_stl - 1}, {"b.stl", bytes, sizeof bytes}};

    for (int i = 0; i < 2; i++)
        test_allocations_fail(0, polygons_read(files[i].name, files[i].data, files[i].size, allocator, &mesh, &error),
                              polygons_free(&mesh));
}
