// glTF: kinds of numbers and primitives, transforms, and what is refused. What lies beside it is in cli_meshes.
#include "format_test.h"

/// Four corners of a square as floats, as shorts of quarters, and six indices.
static const float square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const uint32_t two[] = {0, 1, 2, 0, 2, 3};

typedef struct Data {
    float positions[12];   // 0
    uint16_t quarters[16]; // 48: VEC3 with gaps of one
    uint32_t indices[6];   // 80
    uint8_t bytes[8];      // 104: 0 1 2 3, and two sparse indices
    float sparse[6];       // 112
    uint16_t uv[8];        // 136: normalized
} Data;                    // 152

static Data data(void) {
    Data d = {
        .bytes = {0, 1, 2, 3, 1, 3}, .sparse = {5, 0, 0, 0, 5, 0}, .uv = {0, 0, 65535, 0, 65535, 65535, 0, 65535}};
    memcpy(d.positions, square, sizeof square);
    memcpy(d.indices, two, sizeof two);
    for (int i = 0; i < 16; i++) d.quarters[i] = i % 4 == 3 ? 9 : (uint16_t)(4 * square[i / 4 * 3 + i % 4]);
    return d;
}

/// A GLB of a JSON without blanks at its end and of these data.
static size_t make_glb(const char *json, const Data *d, uint8_t *file) {
    uint32_t length = (uint32_t)strlen(json), padded = (length + 3) / 4 * 4;
    uint32_t head[] = {0x46546c67, 2, 28 + padded + (uint32_t)sizeof *d, padded, 0x4e4f534a};
    uint32_t chunk[] = {sizeof *d, 0x004e4942};

    memcpy(file, head, 20);
    memset(file + 20, ' ', padded);
    memcpy(file + 20, json, length);
    memcpy(file + 20 + padded, chunk, 8);
    memcpy(file + 28 + padded, d, sizeof *d);
    return head[2];
}

#define LISTS                                                                                         \
    "\"buffers\":[{\"byteLength\":152}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"           \
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32,\"byteStride\":8},"                            \
    "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":72}],"                                            \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"         \
    "{\"bufferView\":1,\"componentType\":5123,\"count\":4,\"type\":\"VEC3\"},"                        \
    "{\"bufferView\":2,\"componentType\":5125,\"count\":6,\"type\":\"SCALAR\"},"                      \
    "{\"bufferView\":2,\"byteOffset\":24,\"componentType\":5121,\"count\":4,\"type\":\"SCALAR\"},"    \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":2," \
    "\"indices\":{\"bufferView\":2,\"byteOffset\":28,\"componentType\":5121},"                        \
    "\"values\":{\"bufferView\":2,\"byteOffset\":32}}},"                                              \
    "{\"bufferView\":2,\"byteOffset\":56,\"componentType\":5123,\"normalized\":true,\"count\":4,\"type\":\"VEC2\"}]"
#define SCENE "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}]," LISTS
#define NODE ",\"nodes\":[{\"mesh\":0}]"
#define MESH(primitive) ",\"meshes\":[{\"primitives\":[" primitive "]}]}"

static SingeResult parse(const char *json, const Data *d, SingeAllocator allocator, Polygons *mesh, SingeError *error) {
    static uint8_t file[8000];
    size_t size = make_glb(json, d, file);
    uint8_t *copy = malloc(size); // a sanitizer sees a read behind the end
    memcpy(copy, file, size);
    memset(error, 0, sizeof *error);
    SingeResult result = polygons_read("a.glb", copy, size, allocator, mesh, error);
    free(copy);
    return result;
}

static Polygons expect(const char *json, const uint32_t *corners, uint32_t corner_count) {
    Data d = data();
    Polygons mesh;
    SingeError error;

    if (parse(json, &d, (SingeAllocator){0}, &mesh, &error)) fail_msg("%s", error.message);
    assert_int_equal(mesh.corner_count, corner_count);
    assert_int_equal(mesh.face_count, corner_count / 3);
    assert_memory_equal(mesh.corners, corners, 4 * corner_count);
    for (uint32_t f = 0; f <= mesh.face_count; f++) assert_int_equal(mesh.first[f], 3 * f);
    return mesh;
}

static void expect_positions(Polygons *mesh, const float *positions, uint32_t count) {
    assert_int_equal(mesh->vertex_count, count);
    for (uint32_t i = 0; i < 3 * count; i++) assert_float_equal(mesh->positions[i], positions[i], 1e-6);
    polygons_free(mesh);
}

TEST(kinds_of_numbers_are_read) {
    static const float fours[] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0}, moved[] = {0, 0, 0, 5, 0, 0, 1, 1, 0, 0, 5, 0};
    Polygons mesh = expect(SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"indices\":2}"), two, 6);
    assert_null(mesh.uv);
    expect_positions(&mesh, square, 4);
    mesh = expect(SCENE NODE MESH("{\"attributes\":{\"POSITION\":1},\"indices\":2}"), two, 6);
    expect_positions(&mesh, fours, 4);
    mesh = expect(SCENE NODE MESH("{\"attributes\":{\"POSITION\":4},\"indices\":2}"), two, 6);
    expect_positions(&mesh, moved, 4);
    mesh = expect(SCENE NODE MESH("{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":5},\"mode\":6}"), two, 6);

    static const float uv[] = {0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0}; // v runs up
    assert_memory_equal(mesh.uv, uv, sizeof uv);
    expect_positions(&mesh, square, 4);
    mesh = expect(SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"indices\":3,\"mode\":1},"
                                  "{\"attributes\":{\"POSITION\":0},\"indices\":3,\"mode\":6},{\"attributes\":{}}"),
                  (const uint32_t[]){4, 5, 6, 4, 6, 7}, 6);
    assert_int_equal(mesh.vertex_count, 8);

    polygons_free(&mesh);
    mesh = expect(SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"indices\":3,\"mode\":5}"),
                  (const uint32_t[]){0, 1, 2, 2, 1, 3}, 6);
    polygons_free(&mesh);
}

TEST(transforms_are_applied) {
    static const float turned[] = {1, 2, 3, 1, 4, 3, -1, 4, 3, -1, 2, 3};
    Polygons mesh = expect(SCENE ",\"nodes\":[{\"children\":[1],\"translation\":[1,2,3]},"
                                 "{\"mesh\":0,\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":[2,2,2]}]" MESH(
                                     "{\"attributes\":{\"POSITION\":0},\"indices\":2}"),
                           two, 6);

    expect_positions(&mesh, turned, 4);
    static const float mirrored[] = {7, 0, 0, 6, 0, 0, 6, 1, 0, 7, 1, 0};
    mesh = expect(SCENE ",\"nodes\":[{\"mesh\":0,\"matrix\":[-1,0,0,0,0,1,0,0,0,0,1,0,7,0,0,1]}]" MESH(
                      "{\"attributes\":{\"POSITION\":0},\"indices\":2}"),
                  (const uint32_t[]){2, 1, 0, 3, 2, 0}, 6);
    expect_positions(&mesh, mirrored, 4);
}

#define PRIMITIVE "{\"attributes\":{\"POSITION\":0},\"indices\":2}"

TEST(bad_files_are_refused) {
    static const struct {
        const char *json;
        SingeResult code;
        const char *part;
    } cases[] = {
        {"", SINGE_ERROR_FORMAT, "unexpected end"},
        {"[1]", SINGE_ERROR_FORMAT, "not glTF"},
        {"{\"a\":[1,2}", SINGE_ERROR_FORMAT, "byte 9 of its JSON: expected a comma or the end"},
        {"{\"a\" 1}", SINGE_ERROR_FORMAT, "expected a colon"},
        {"{\"a\":\"b}", SINGE_ERROR_FORMAT, "unterminated string"},
        {"{} {}", SINGE_ERROR_FORMAT, "data after the end"},
        {"{}", SINGE_ERROR_FORMAT, "no scene"},
        {SCENE MESH(PRIMITIVE), SINGE_ERROR_FORMAT, "only 0 nodes"},
        {SCENE NODE ",\"meshes\":[]}", SINGE_ERROR_FORMAT, "\"mesh\" is not a number below 0"},
        {SCENE ",\"nodes\":[{\"children\":[1,1]},{\"mesh\":0}]" MESH(PRIMITIVE), SINGE_ERROR_FORMAT,
         "nodes[1]: it contains itself"},
        {SCENE ",\"nodes\":[{\"mesh\":0,\"scale\":[1,1]}]" MESH(PRIMITIVE), SINGE_ERROR_FORMAT,
         "nodes[0]: its transform"},
        {SCENE ",\"nodes\":[{\"mesh\":0,\"scale\":[1,1,1e300]}]" MESH(PRIMITIVE), SINGE_ERROR_FORMAT, "nodes[0]"},
        {SCENE ",\"nodes\":[{\"mesh\":0.5}]" MESH(PRIMITIVE), SINGE_ERROR_FORMAT, "\"mesh\" is not a number below 1"},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":99},\"indices\":2}"), SINGE_ERROR_FORMAT, "\"POSITION\""},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":2},\"indices\":2}"), SINGE_ERROR_FORMAT, "not VEC3"},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"indices\":0}"), SINGE_ERROR_FORMAT, "unsigned integers"},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"indices\":3}"), SINGE_ERROR_MESH, "4 corners"},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"mode\":7}"), SINGE_ERROR_FORMAT, "mode is not known"},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":0},\"mode\":0}"), SINGE_ERROR_MESH, "no faces"},
        {SCENE NODE MESH("{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":0}}"), SINGE_ERROR_FORMAT, "not VEC2"},
        {SCENE ",\"nodes\":[{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{}}}]" MESH(PRIMITIVE),
         SINGE_ERROR_FORMAT, "nodes[0]: EXT_mesh_gpu_instancing is not supported"},
    };

    Data d = data();
    Polygons mesh;
    SingeError error;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        SingeResult result = parse(cases[i].json, &d, (SingeAllocator){0}, &mesh, &error);
        if (result != cases[i].code) fail_msg("%d for %s: %s", result, cases[i].json, error.message);
        assert_message(&error, cases[i].part);
        assert_message(&error, "a.glb");
        assert_null(mesh.positions);
    }

    d.indices[4] = 4;
    assert_int_equal(parse(SCENE NODE MESH(PRIMITIVE), &d, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_MESH);
    assert_message(&error, "meshes[0]: primitive 0: index 4 (from 0): vertex 4 is out of range: there are 4");
    d = data(), d.positions[5] = NAN;
    assert_int_equal(parse(SCENE NODE MESH(PRIMITIVE), &d, (SingeAllocator){0}, &mesh, &error), SINGE_ERROR_MESH);
    assert_message(&error, "vertex 1 (from 0) has a position that is not finite");
}

/// A file of text with one triangle in `buffer`, and an accessor of its positions with `accessor`.
#define TEXT(buffer, view, accessor)                                                                       \
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"              \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"buffers\":[{\"byteLength\":36,"   \
    "\"uri\":\"" buffer "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36" view "}],\"accessors\":[{" \
    "\"bufferView\":0" accessor "}]}"
#define ZEROS "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
#define POSITIONS ",\"componentType\":5126,\"count\":3,\"type\":\"VEC3\""
#define SPARSE(count, index, indices) \
    POSITIONS ",\"sparse\":{\"count\":" count ",\"indices\":{" index "},\"values\":{" indices "}}"

TEST(bad_buffers_are_refused) {
    static const struct {
        const char *json, *part; // NULL: it is read
    } cases[] = {
        {TEXT(ZEROS, "", POSITIONS), NULL},
        {TEXT("data:,abc", "", POSITIONS), "buffers[0]: its data is not base64"},
        {TEXT("data:;base64,A*AA", "", POSITIONS), "buffers[0]: its data is not base64"},
        {TEXT("none%2Ebin", "", POSITIONS), "buffers[0]: it may refer only to files in its folder or below"},
        {TEXT("none%2ebin", "", POSITIONS), "buffers[0]: it may refer only to files in its folder or below"},
        {TEXT("%2e%2e/none", "", POSITIONS), "buffers[0]: it may refer only to files in its folder or below"},
        {TEXT("a%00b", "", POSITIONS), "buffers[0]: it may refer only to files in its folder or below"},
        {TEXT("a\\u0041", "", POSITIONS), "buffers[0]: it may refer only to files in its folder or below"},
        {TEXT(ZEROS, ",\"extensions\":{\"EXT_meshopt_compression\":{}}", POSITIONS),
         "compressed data is not supported"},
        {TEXT(ZEROS, ",\"byteStride\":4", POSITIONS), "accessors[0]: its elements overlap"},
        {TEXT(ZEROS, ",\"byteStride\":999", POSITIONS), "bufferViews[0]"},
        {TEXT(ZEROS, "", POSITIONS ",\"byteOffset\":-1"), "accessors[0]: its byteOffset must be a whole number from 0"},
        {TEXT(ZEROS, "", ",\"componentType\":5126,\"count\":3,\"type\":\"VEC9\""), "accessors[0]: it has no type"},
        {TEXT(ZEROS, "", ",\"componentType\":5124,\"count\":3,\"type\":\"VEC3\""), "accessors[0]: it has no type"},
        {TEXT(ZEROS, "", ",\"componentType\":5126,\"count\":-3,\"type\":\"VEC3\""), "accessors[0]: it has no type"},
        {TEXT(ZEROS, "", SPARSE("9", "\"bufferView\":0,\"componentType\":5121", "\"bufferView\":0")),
         "its sparse elements have no count or type"},
        {TEXT(ZEROS, "", SPARSE("1", "\"bufferView\":0,\"componentType\":5126", "\"bufferView\":0")),
         "its sparse elements have no count or type"},
        {TEXT(ZEROS, ",\"byteStride\":12", SPARSE("1", "\"bufferView\":0,\"componentType\":5121", "\"bufferView\":0")),
         "sparse indices must be contiguous"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Polygons mesh;
        SingeError error = {0};
        const SingeResult result = polygons_read("/tmp/a.gltf", (const uint8_t *)cases[i].json, strlen(cases[i].json),
                                                 (SingeAllocator){0}, &mesh, &error);
        if (!cases[i].part != !result) fail_msg("%s: %s", cases[i].json, error.message);
        if (result) assert_message(&error, cases[i].part);
        else polygons_free(&mesh);
    }
}

/// Normalized and plain numbers of every width are what the format says.
TEST(numbers_of_every_width_are_read) {
    static const struct {
        const char *accessor;
        float x; // of the second vertex: the bytes at 12, or behind the width
    } cases[] = {
        {",\"componentType\":5120,\"count\":3,\"type\":\"VEC3\"", 0},
        {",\"componentType\":5121,\"count\":3,\"type\":\"VEC3\",\"normalized\":true", 0},
        {",\"componentType\":5122,\"count\":3,\"type\":\"VEC3\"", 0},
        {",\"componentType\":5125,\"count\":3,\"type\":\"VEC3\"", 1065353216},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[2000];
        snprintf(json, sizeof json, "%s%s}]}", TEXT(ZEROS, "", "") "", "");
        char *end = strstr(json, "\"accessors\":[{\"bufferView\":0");
        sprintf(end, "\"accessors\":[{\"bufferView\":0%s}]}", cases[i].accessor);

        OWNED(polygons_free) Polygons mesh;
        SingeError error = {0};
        if (polygons_read("a.gltf", (const uint8_t *)json, strlen(json), (SingeAllocator){0}, &mesh, &error))
            fail_msg("%s: %s", json, error.message);
        assert_true(mesh.positions[3] == cases[i].x);
    }
}

/// A small file of many nodes, or primitives, that use one mesh comes to much more than its size.
TEST(copies_are_limited) {
    enum { COPIES = 700, VERTICES = 3000 };
    size_t size = 100000 + VERTICES * 16 + COPIES * 100, length;
    char *text = malloc(size);
    length = (size_t)sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0");
    for (int i = 1; i < COPIES; i++) length += (size_t)sprintf(text + length, ",%d", i);
    length += (size_t)sprintf(text + length, "]}],\"nodes\":[{\"mesh\":0}");
    for (int i = 1; i < COPIES; i++) length += (size_t)sprintf(text + length, ",{\"mesh\":0}");

    length +=
        (size_t)sprintf(text + length,
                        "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
                        "\"bufferView\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"}],"
                        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%d}],\"buffers\":[{\"uri\":\"data:;base64,",
                        VERTICES, 12 * VERTICES);
    memset(text + length, 'A', 16 * VERTICES), length += 16 * VERTICES;
    length += (size_t)sprintf(text + length, "\"}]}");

    TestAllocator counts = {0};
    Polygons mesh;
    SingeError error;
    assert_int_equal(polygons_read("a.gltf", (const uint8_t *)text, length, test_allocator(&counts), &mesh, &error),
                     SINGE_ERROR_LIMIT);
    assert_message(&error, "repeat meshes");
    assert_true(counts.peak < 20 * length);
    test_allocator_check(&counts);
    free(text);
}

TEST(every_cut_and_failure_of_memory_is_clean) {
    static uint8_t file[8000];
    static const char json[] = SCENE NODE MESH("{\"attributes\":{\"POSITION\":4,\"TEXCOORD_0\":5},\"indices\":2}");
    Data d = data();
    Polygons mesh;
    SingeError error;
    size_t size = make_glb(json, &d, file);

    for (size_t cut = 0; cut < size; cut++) {
        uint8_t *copy = malloc(cut ? cut : 1);
        memcpy(copy, file, cut);
        assert_int_not_equal(polygons_read("a.glb", copy, cut, (SingeAllocator){0}, &mesh, &error), SINGE_OK);
        free(copy);
    }

    for (size_t cut = 0; cut < sizeof json - 1; cut++) // as text, without data
        assert_int_not_equal(polygons_read("a.gltf", (const uint8_t *)json, cut, (SingeAllocator){0}, &mesh, &error),
                             SINGE_OK);
    test_allocations_fail(0, parse(json, &d, allocator, &mesh, &error), polygons_free(&mesh));
}
