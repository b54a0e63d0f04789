#include "format_test.h"

// what a case works on
static Polygons mesh;
static SingeError error;

static SingeResult parse(const char *text, Polygons *made, SingeError *why) {
    return read_mesh("a.obj", text, strlen(text), made, why);
}

static void expect_error(const char *text, SingeResult code, int64_t line, const char *part) {
    assert_mesh_refused("a.obj", text, strlen(text), code, line, part);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void expect_mesh(const char *text, uint32_t vertices, const uint32_t *cells, uint32_t cell_count) {
    if (parse(text, &mesh, &error)) fail_msg("%s", error.message);
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(mesh.face_count, cell_count);
    assert_memory_equal(mesh.corners, cells, cell_count * 16);
    polygons_free(&mesh);
    assert_null(mesh.positions);
}

TEST(keeps_order_and_positions) {
    const char *text = "# a comment\n"
                       "mtllib a.mtl\no thing\ng group\ns off\nusemtl paper\n"
                       "v 0.1 -0.2 3e-1\nv 1.25e2 0 .5\nv 1 1. 0 0.5 0.25 1\nv -0 1 0.30000001192092896\n"
                       "v 9 9 9 # not used by a face\n"
                       "vt 0 0.5\nvt 1 0.5 0\nvt 0.25\nvn 0 0 1\n"
                       "l 1 2\np 1\n"
                       "f 1/1/1 2/2/1 3/3/1 4/1/1";

    assert_int_equal(parse(text, &mesh, NULL), SINGE_OK);
    static const float positions[] = {0.1f, -0.2f, 0.3f, 125, 0, 0.5f, 1, 1, 0, -0.0f, 1, 0.3f, 9, 9, 9};
    static const float uv[] = {0, 0.5f, 1, 0.5f, 0.25f, 0, 0, 0.5f};
    static const uint32_t cells[] = {0, 1, 2, 3};

    assert_int_equal(mesh.vertex_count, 5);
    assert_int_equal(mesh.face_count, 1);
    assert_int_equal(mesh.attribute_count, 0);
    assert_memory_equal(mesh.positions, positions, sizeof positions);
    assert_memory_equal(mesh.uv, uv, sizeof uv);
    assert_memory_equal(mesh.corners, cells, sizeof cells);
    polygons_free(&mesh);
}

TEST(reads_every_form) {
    static const uint32_t one[] = {0, 1, 2, 3}, two[] = {0, 1, 2, 3, 1, 4, 5, 2};
    expect_mesh(SQUARE "f 1 2 3 4", 4, one, 1);
    expect_mesh(SQUARE "f 1 2 3 4\n", 4, one, 1);
    expect_mesh(SQUARE "f 1//1 2//1 3//7 4//-1\n", 4, one, 1);
    expect_mesh(SQUARE "vt 0 0\nf 1/1 2/1 3/1 4/1\n", 4, one, 1);
    expect_mesh(SQUARE "vt 0 0\nf 1/1/2 2/1/3 3/-1/4 4/1/5\n", 4, one, 1);
    expect_mesh(SQUARE "f -4 -3 -2 -1\n", 4, one, 1);
    expect_mesh("f 1 2 3 4\n" SQUARE, 4, one, 1); // a face may come before its vertices
    expect_mesh(SQUARE "f -4 -3 -2 -1\nv 2 0 0\nv 2 1 0\nf -5 -2 -1 -4\n", 6, two, 2);
    expect_mesh("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n", 4, one, 1);
    expect_mesh("v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4", 4, one, 1);
    expect_mesh("\t v\t0  0 0 \n\n  v 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\n3 \\\r\n4\n", 4, one, 1);
    expect_mesh(SQUARE "f\\\n1 2 3 4\n", 4, one, 1);
    expect_mesh(SQUARE "f 1 2 3\\\n 4\n", 4, one, 1);
    expect_mesh(SQUARE "l 1 2 \\\n 3 4\nf 1 2 3 4\n", 4, one, 1);
    expect_mesh("\xef\xbb\xbf" SQUARE "f 1 2 3 4#end", 4, one, 1);
    expect_mesh("# ends in a backslash \\\n" SQUARE "f 1 2 3 4\n", 4, one, 1);
}

TEST(refuses_bad_syntax) {
    expect_error("", SINGE_ERROR_FORMAT, 1, "empty");
    expect_error("\n\n", SINGE_ERROR_FORMAT, 3, "no faces");
    expect_error(SQUARE, SINGE_ERROR_FORMAT, 5, "no faces");
    expect_error("v 1 2\n", SINGE_ERROR_FORMAT, 1, "a vertex is v x y z");
    expect_error("v 1 2 3 4 5 6 7 8\n", SINGE_ERROR_FORMAT, 1, "a vertex is v x y z");
    expect_error("v 1 x 3\n", SINGE_ERROR_FORMAT, 1, "a.obj:1:5: this is not a number");
    expect_error("v 1 2,5 3\n", SINGE_ERROR_FORMAT, 1, "a.obj:1:5: this is not a number");
    expect_error("v 1 0x2 3\n", SINGE_ERROR_FORMAT, 1, "a.obj:1:5: this is not a number");
    expect_error("\nv 1 nan 3\n", SINGE_ERROR_FORMAT, 2, "finite");
    expect_error("\nv 1 2 -inf\n", SINGE_ERROR_FORMAT, 2, "finite");
    expect_error("v 1 2 \\\n1e39\n", SINGE_ERROR_FORMAT, 2, "too large");
    expect_error("vt\n", SINGE_ERROR_FORMAT, 1, "texture coordinate is vt u v");
    expect_error("vt 1 2 3 4\n", SINGE_ERROR_FORMAT, 1, "texture coordinate is vt u v");
    expect_error("vt a 2\n", SINGE_ERROR_FORMAT, 1, "a.obj:1:4: this is not a number");
    expect_error(SQUARE "wobble 1\n", SINGE_ERROR_FORMAT, 5, "a.obj:5:1: this is not a directive");
    expect_error("solid thing\n", SINGE_ERROR_FORMAT, 1, "a.obj:1:1: this");
    expect_error("\x89PNG\r\n\x1a\n", SINGE_ERROR_FORMAT, 1, "a.obj:1:1: this is not a directive");
    expect_error(SQUARE "f 1 2 3 4x\n", SINGE_ERROR_FORMAT, 5, "a.obj:5:9: this is not an index");
    expect_error(SQUARE "f 1 2 3 4/\n", SINGE_ERROR_FORMAT, 5, "not an index");
    expect_error(SQUARE "f 1 2 3 4//\n", SINGE_ERROR_FORMAT, 5, "not an index");
    expect_error(SQUARE "f 1 2 3 4//0\n", SINGE_ERROR_FORMAT, 5, "not an index");
    expect_error(SQUARE "vt 0 0\nf 1/1/1/1 2 3 4\n", SINGE_ERROR_FORMAT, 6, "not an index");
    expect_error(SQUARE "f 1.5 2 3 4\n", SINGE_ERROR_FORMAT, 5, "not an index");
    expect_error(SQUARE "f 0 1 2 3\n", SINGE_ERROR_FORMAT, 5, "counts from 1");
}

TEST(refuses_bad_meshes) {
    expect_error(SQUARE "f 1 2\n", SINGE_ERROR_MESH, 5, "a.obj:5: face has 2 corners; it needs three");
    expect_error(SQUARE "f 1\n", SINGE_ERROR_MESH, 5, "face has 1 corner;");
    expect_error(SQUARE "f\n", SINGE_ERROR_MESH, 5, "face has 0 corners");
    expect_error(SQUARE "f 1 2 3 5\n", SINGE_ERROR_MESH, 5, "out of range");
    expect_error(SQUARE "f -5 -3 -2 -1\n", SINGE_ERROR_MESH, 5, "out of range");
    expect_error(SQUARE "f 1 2 3 99999999999\n", SINGE_ERROR_MESH, 5, "out of range");
    expect_error(SQUARE "f 1 2 3 99999999999999999999999\n", SINGE_ERROR_MESH, 5, "out of range");
    expect_error(SQUARE "f 1 2 3 -9223372036854775807\n", SINGE_ERROR_MESH, 5, "out of range");
    expect_error(SQUARE "f 1/1 2/1 3/1 4/1\n", SINGE_ERROR_MESH, 5, "out of range");
    expect_error(SQUARE "vt 0 0\nf 1/1 2/1 3 4/1\n", SINGE_ERROR_MESH, 6, "no texture coordinate");
}

TEST(faces_have_any_number_of_corners) {
    assert_int_equal(parse(SQUARE "v 2 0 0\nf 1 2 3\nf 1 3 4\nf 2 5 3\nf 1 2 5 3 4\nf 1 1 2\n", &mesh, NULL), SINGE_OK);
    static const uint32_t first[] = {0, 3, 6, 9, 14, 17}, lines[] = {6, 7, 8, 9, 10};
    static const uint32_t corners[] = {0, 1, 2, 0, 2, 3, 1, 4, 2, 0, 1, 4, 2, 3, 0, 0, 1};

    assert_int_equal(mesh.face_count, 5);
    assert_int_equal(mesh.corner_count, 17);
    assert_memory_equal(mesh.first, first, sizeof first);
    assert_memory_equal(mesh.corners, corners, sizeof corners);
    assert_memory_equal(mesh.lines, lines, sizeof lines);
    assert_null(mesh.uv);
    polygons_free(&mesh);
}

// A vertex may have another uv in each face: a seam.
TEST(corners_keep_their_uv) {
    assert_int_equal(parse(SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/2 3/1 4/3\n", &mesh, NULL), SINGE_OK);
    static const float uv[] = {0, 0, 1, 0, 1, 1, 1, 0, 0, 0, 1, 1};
    assert_memory_equal(mesh.uv, uv, sizeof uv);
    polygons_free(&mesh);
}

TEST(readers_are_chosen_by_extension) {
    static const char text[] = SQUARE "f 1 2 3 4\n";
    const uint8_t *bytes = (const uint8_t *)text;

    assert_int_equal(polygons_read("A.OBJ", bytes, sizeof text - 1, (SingeAllocator){0}, &mesh, &error), SINGE_OK);
    polygons_free(&mesh);
    assert_int_equal(polygons_read("a.xyz", bytes, sizeof text - 1, (SingeAllocator){0}, &mesh, &error),
                     SINGE_ERROR_FORMAT);
    assert_message(&error, ".obj, .ply");
    assert_int_equal(polygons_read("a.ply", bytes, sizeof text - 1, (SingeAllocator){0}, &mesh, &error),
                     SINGE_ERROR_FORMAT);
    assert_int_equal(polygons_read("obj", bytes, sizeof text - 1, (SingeAllocator){0}, &mesh, NULL),
                     SINGE_ERROR_FORMAT);
}

static const char sample[] = SQUARE "v 2 0 0\nv 2 1 0\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
                                    "f 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 3/3\n";

// A cut file may only be read where the cut leaves whole faces.
TEST(every_cut_is_an_error) {
    Polygons whole, cut;
    assert_int_equal(parse(sample, &whole, &error), SINGE_OK);

    int read = 0;
    for (size_t size = 0; size < sizeof sample - 1; size++) {
        char *text = strdup(sample);
        text[size] = 0;
        if (parse(text, &cut, &error) == SINGE_OK) {
            read++;
            assert_true(cut.face_count <= whole.face_count);
            assert_int_equal(cut.vertex_count, whole.vertex_count);
            assert_memory_equal(cut.positions, whole.positions, whole.vertex_count * 12);
            assert_memory_equal(cut.corners, whole.corners, cut.corner_count * 4);
            polygons_free(&cut);
        } else {
            assert_true(error.message[0] != 0);
        }

        free(text);
    }

    // behind the third corner of a face and the blank; behind the first face: its newline missing or there, an "f"
    // cannot stand alone; the last newline missing
    assert_int_equal(read, 2 + 2 + 2 + 1);
    polygons_free(&whole);
}

TEST(allocation_failure_is_clean) {
    test_allocations_fail(5, obj_read("a.obj", (const uint8_t *)sample, sizeof sample - 1, allocator, &mesh, &error),
                          polygons_free(&mesh));
}

// The example's sheet: A4, in low waves over the table, borders straight from above, at most 30,000 springs
// (4 + 2 + 2 + 2 a cell, fewer at the border).
TEST(the_letter_is_a4) {
    OwnBytes bytes;
    SingeAllocator libc = {0};

    if (file_read("examples/letter/letter.obj", libc, &bytes, &error)) fail_msg("%s", error.message);
    if (polygons_read("letter.obj", bytes.data, bytes.size, libc, &mesh, &error)) fail_msg("%s", error.message);
    assert_int_equal(mesh.vertex_count, 47 * 66);
    assert_int_equal(mesh.face_count, 46 * 65);
    assert_true(10 * mesh.face_count <= 30000);

    double area = 0;
    for (uint32_t c = 0; c < mesh.face_count; c++) {
        const float *p[4];
        for (int k = 0; k < 4; k++) p[k] = mesh.positions + 3 * mesh.corners[4 * c + (uint32_t)k];
        double cell = 0.5 * ((p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]));
        assert_true(cell > 0.5 * 0.21 * 0.297 / 2990);
        area += cell;
    }

    assert_float_equal(area, 0.21 * 0.297, 1e-6);
    int on_border = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        const float *p = mesh.positions + 3 * v;
        assert_true(fabsf(p[0]) <= 0.105f && fabsf(p[1]) <= 0.1485f && p[2] >= 0 && p[2] < 0.016f);
        on_border += fabsf(p[0]) == 0.105f || fabsf(p[1]) == 0.1485f;
    }

    for (uint32_t i = 0; i < mesh.corner_count; i++) {
        const float *p = mesh.positions + 3 * mesh.corners[i];
        assert_float_equal(mesh.uv[2 * i], p[0] / 0.21f + 0.5f, 1e-5f);
        assert_float_equal(mesh.uv[2 * i + 1], p[1] / 0.297f + 0.5f, 1e-5f);
    }

    assert_int_equal(on_border, 2 * (46 + 65));
    polygons_free(&mesh);
}
