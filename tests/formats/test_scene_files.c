// What stands around a burnt sheet in the files that hold a whole scene: shapes and their motion, the ground, and all
// frames in one file.
#include "crate_reader.h"

#include "formats/usd.h"

TEST_IN_FOLDER("scene")

static const OutputPose still[2] = {{.position = {1, 2, 3}, .rotation = {0, 0, 0, 1}, .visible = true},
                                    {.position = {1, 2, 3}, .rotation = {0, 0, 0, 1}, .visible = true}};
static const OutputPose moving[2] = {{.position = {0, 0, 0.5f}, .rotation = {0, 0, 0, 1}, .visible = true},
                                     {.position = {0, 0, 1.5f}, .rotation = {0, 0, 1, 0}, .visible = false}};
static const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, -3};
static const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

static const float grown[12] = {0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, -6};
static const OutputPose breathing[2] = {{.rotation = {0, 0, 0, 1}, .vertices = corners, .visible = true},
                                        {.rotation = {0, 0, 0, 1}, .vertices = grown, .visible = true}};

static const OutputShape shapes[] = {
    {.kind = SINGE_COLLIDER_SPHERE, .radius = 0.25f, .colour = {1, 0, 0}, .temperature = 1100, .poses = still},
    {.kind = SINGE_COLLIDER_BOX, .half_size = {0.5f, 1, 2}, .colour = {0, 1, 0}, .poses = moving},
    {.kind = SINGE_COLLIDER_CAPSULE, .radius = 0.25f, .height = 1, .colour = {0, 0, 1}, .poses = still},
    {.kind = SINGE_COLLIDER_MESH,
     .vertex_count = 4,
     .triangle_count = 4,
     .vertices = corners,
     .triangles = triangles,
     .poses = still},
    {.kind = SINGE_COLLIDER_MESH,
     .vertex_count = 4,
     .triangle_count = 4,
     .vertices = corners,
     .triangles = triangles,
     .poses = breathing},
};

static OutputScene scene_of(const OutputSheet *sheet) {
    return (OutputScene){.name = "shapes",
                         .fps = 24,
                         .frames = 2,
                         .texture_size = 16,
                         .sheet_count = 1,
                         .shape_count = sizeof shapes / sizeof *shapes,
                         .sheets = sheet,
                         .shapes = shapes,
                         .eye = {0, -3, 1},
                         .up = {0, 0, 1},
                         .fov = 0.7f,
                         .aspect = 1.5f,
                         .aperture = 0.01f,
                         .light_direction = {0, 0, 1},
                         .light_colour = {1, 1, 1},
                         .sky = {0.1f, 0.1f, 0.1f},
                         .ground_height = -0.5f,
                         .ground_colour = {0.2f, 0.2f, 0.2f}};
}

static const OutputSheet plain = {.name = "leaf", .colour = {1, 1, 1}};

static const char *root_text(Sink *sink, const OutputScene *scene) {
    *sink = (Sink){0};
    usd_put_root(sink, scene);
    sink_zeros(sink, 1);
    assert_false(sink->failed);
    return (const char *)sink->bytes;
}

/// The text after the prim of a shape, up to the next one.
static void expect_in(const char *text, const char *prim, const char *line) {
    const char *from = strstr(text, prim);
    if (!from) fail_msg("no %s", prim);
    const char *to = strstr(from, "        }\n"), *at = strstr(from, line);
    if (!at || !to || at > to) fail_msg("%s has no \"%s\"", prim, line);
}

TEST(velocities_say_over_which_time_they_are) {
    Sink sink;
    const OutputScene scene = scene_of(&plain);
    expect_in(root_text(&sink, &scene), "def Mesh \"leaf\"",
              "vector3f[] velocities (\n                doc = \"m/s, displacement since the frame before");
    sink_free(&sink);
}

TEST(shapes_stand_where_they_are) {
    Sink sink;
    const OutputScene scene = scene_of(&plain);
    const char *text = root_text(&sink, &scene);
    expect_in(text, "def Sphere \"shape0\"", "double radius = 0.25\n");
    expect_in(text, "def Sphere \"shape0\"", "float3[] extent = [(-0.25, -0.25, -0.25), (0.25, 0.25, 0.25)]");
    expect_in(text, "def Sphere \"shape0\"", "double3 xformOp:translate = (1, 2, 3)\n");
    expect_in(text, "def Sphere \"shape0\"", "quatf xformOp:orient = (1, 0, 0, 0)\n");
    expect_in(text, "def Cube \"shape1\"", "float3 xformOp:scale = (0.5, 1, 2)\n");
    expect_in(text, "def Cube \"shape1\"", "token visibility.timeSamples = {1: \"inherited\", 2: \"invisible\"}");
    expect_in(text, "def Cube \"shape1\"", "xformOp:translate.timeSamples = {1: (0, 0, 0.5), 2: (0, 0, 1.5)}");
    expect_in(text, "def Cube \"shape1\"", "xformOp:orient.timeSamples = {1: (1, 0, 0, 0), 2: (0, 0, 0, 1)}");
    expect_in(text, "def Capsule \"shape2\"", "double height = 1\n");
    expect_in(text, "def Capsule \"shape2\"", "(0.25, 0.25, 0.75)]");
    expect_in(text, "def Mesh \"shape3\"", "points = [(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, -3)]");
    expect_in(text, "def Mesh \"shape3\"", "float3[] extent = [(0, 0, -3), (1, 2, 0)]");
    expect_in(text, "def Mesh \"shape3\"", "int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]");

    text = strstr(text, "def Mesh \"shape4\"");
    assert_non_null(strstr(text, "point3f[] points.timeSamples = {\n"
                                 "                1: [(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, -3)],\n"
                                 "                2: [(0, 0, 0), (2, 0, 0), (0, 4, 0), (0, 0, -6)],\n"));
    assert_non_null(strstr(text, "float3[] extent.timeSamples = {\n"
                                 "                1: [(0, 0, -3), (1, 2, 0)],\n"
                                 "                2: [(0, 0, -6), (2, 4, 0)],\n"));

    text = (const char *)sink.bytes;
    expect_in(text, "def Mesh \"ground\"", "-0.5)");
    assert_non_null(strstr(text, "def Material \"shape0\""));
    assert_non_null(strstr(text, "def Material \"ground\""));
    sink_free(&sink);
}

TEST(without_a_ground_there_is_none) {
    Sink sink;
    OutputScene scene = scene_of(&plain);
    scene.ground_height = -INFINITY, scene.shape_count = 0;
    memcpy(scene.eye, (float[]){0, 0, 3}, sizeof scene.eye); // looks along `up`

    const char *text = root_text(&sink, &scene);
    assert_null(strstr(text, "ground"));
    assert_null(strstr(text, "shape0"));
    assert_null(strstr(text, "nan"));
    sink_free(&sink);
}

/// A triangle that loses a corner's worth of area in frame 2, and is gone in frame 3.
static SingeResult read_frame(void *context, int number, OutputFrame *frame, SingeError *error) {
    (void)error;
    SingeSurface *s = context;
    s->vertex_count = number == 3 ? 0 : 3, s->triangle_count = number == 3 ? 0 : 1;
    for (int v = 0; v < 3; v++) s->position[v][2] = (float)number;
    *frame = (OutputFrame){.surface = s, .time = number / 24.0, .number = number};
    return SINGE_OK;
}

typedef struct Leaf {
    SingeSurface surface;
    float three[4][3][3], two[3][2], one[7][3];
    int32_t numbers[3][3];
    uint32_t triangle[1][3];
} Leaf;

static void make_leaf(Leaf *l) {
    *l = (Leaf){.triangle = {{0, 1, 2}}, .two = {{0, 0}, {1, 0}, {0, 1}}};
    memcpy(l->three[0], (float[3][3]){{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, sizeof l->three[0]);
    memcpy(l->three[3], l->three[0], sizeof l->three[0]);

    l->surface = (SingeSurface){.position = l->three[0],
                                .normal = l->three[1],
                                .velocity = l->three[2],
                                .rest_position = l->three[3],
                                .uv = l->two,
                                .temperature = l->one[0],
                                .temperature_peak = l->one[1],
                                .mass = l->one[2],
                                .burn_rate = l->one[3],
                                .char_fraction = l->one[4],
                                .ash_fraction = l->one[5],
                                .burn = l->one[6],
                                .time_ignited = NULL,
                                .piece = l->numbers[0],
                                .source_vertex = l->numbers[1],
                                .sheet = l->numbers[2],
                                .triangles = l->triangle};

    static float never[3] = {-1, -1, -1};
    l->surface.time_ignited = never;
}

/// The value of a frame in an attribute of all frames: where it lies, or 0.
static uint64_t series_value(const CrateFile *file, const char *attribute, uint64_t count, uint64_t index) {
    const uint64_t value = crate_field(file, attribute, "timeSamples");
    const size_t at = (size_t)(value & 0xffffffffffff);
    const uint64_t times = crate_number(file, at + 8, 8);
    assert_int_equal(crate_number(file, (size_t)(times & 0xffffffffffff), 8), count);
    assert_int_equal(crate_number(file, at + 24, 8), count);
    return crate_number(file, at + 32 + 8 * index, 8) & 0xffffffffffff;
}

TEST(one_file_has_all_frames) {
    Leaf leaf;
    make_leaf(&leaf);
    OutputScene scene = scene_of(&plain);
    scene.frames = 3, scene.shape_count = 0;

    const OutputCache cache = {.frames = 3, .read = read_frame, .context = &leaf.surface};
    SingeError error = {0};
    if (usd_write_single(path, &scene, &cache, &error)) fail_msg("%s", error.message);

    Bytes bytes = take_file(path);
    CrateFile file;
    crate_open(&file, bytes.data, bytes.size);
    for (uint64_t i = 0; i < 2; i++) {
        const size_t at = (size_t)series_value(&file, "/shapes/sheets/leaf.points", 3, i);
        float z;
        assert_int_equal(crate_number(&file, at, 8), 3);
        memcpy(&z, bytes.data + at + 8 + 8, 4);
        assert_true(z == (float)(i + 1));
    }

    assert_int_equal(series_value(&file, "/shapes/sheets/leaf.points", 3, 2), 0); // nothing is left
    crate_close(&file), bytes_free(&bytes);
}

static SingeResult fail_frame(void *context, int number, OutputFrame *frame, SingeError *error) {
    if (number == 2) return refuse(error, SINGE_ERROR_FORMAT, "ply", -1, "frame 2 is damaged");
    return read_frame(context, number, frame, error);
}

/// A frame that cannot be read leaves no file of any kind.
TEST(a_bad_frame_leaves_no_file) {
    Leaf leaf;
    make_leaf(&leaf);
    OutputScene scene = scene_of(&plain);
    scene.frames = 3, scene.shape_count = 0;

    const OutputCache cache = {.frames = 3, .read = fail_frame, .context = &leaf.surface};
    OutputWriteSingle *const writers[] = {usd_write_single, usdz_write, glb_write_single};
    for (size_t i = 0; i < sizeof writers / sizeof *writers; i++) {
        SingeError error = {0};
        assert_int_equal(writers[i](path, &scene, &cache, &error), SINGE_ERROR_FORMAT);
        assert_string_equal(error.message, "frame 2 is damaged");
        assert_int_not_equal(access(path, F_OK), 0);
    }
}
