// From a scene to a simulation and a preview.
#include "parsing.h"

#include <dirent.h>
#include <time.h>
#include <unistd.h>

#include "scene/space.h"
#include "scene/assets.h"
#include "scene/warnings.h"

/// A scene and what it refers to.
typedef struct Loaded {
    Scene *scene;
    SceneAssets assets;
    SingeSim *sim; ///< NULL unless it was built
} Loaded;

/// Parses and loads a good scene, whose files are in `folder`.
static Loaded load(const char *text, const char *folder) {
    Loaded loaded = {0};
    SceneMessages messages = {0};
    SingeResult result = scene_parse("t.yaml", text, strlen(text), folder, NULL, 0, &loaded.scene, &messages);
    if (!result) result = scene_load(loaded.scene, &loaded.assets, &messages);
    scene_messages_print(&messages, stderr);
    assert_int_equal(result, SINGE_OK);
    return loaded;
}

/// The same, and builds its simulation.
static Loaded build(const char *text, const char *folder, SingeLog log) {
    Loaded loaded = load(text, folder);
    SceneMessages messages = {0};
    SingeSimDef hooks = singe_default_sim();
    hooks.log = log;
    SingeResult result = scene_build(loaded.scene, &loaded.assets, &hooks, &loaded.sim, &messages);
    scene_messages_print(&messages, stderr);
    assert_int_equal(result, SINGE_OK);
    return loaded;
}

static void unload(Loaded *loaded) {
    singe_sim_destroy(loaded->sim);
    scene_assets_free(&loaded->assets);
    scene_free(loaded->scene);
}
#define OwnLoaded OWNED(unload) Loaded

/// Loads and builds; the messages of whichever refuses.
static SceneMessages refused(const char *text, const char *folder) {
    Scene *scene;
    SceneAssets assets;
    SceneMessages messages = {0};
    SingeSim *sim = NULL;
    SingeSimDef hooks = singe_default_sim();

    assert_int_equal(scene_parse("t.yaml", text, strlen(text), folder, NULL, 0, &scene, &messages), SINGE_OK);
    SingeResult result = scene_load(scene, &assets, &messages);
    if (!result) {
        result = scene_build(scene, &assets, &hooks, &sim, &messages);
        scene_assets_free(&assets);
    }
    assert_int_not_equal(result, SINGE_OK);
    assert_null(sim);
    scene_free(scene);
    return messages;
}

// ---- tests

static void turn(const float q[4], const double v[3], double out[3]) {
    double x = q[0], y = q[1], z = q[2], w = q[3];
    double t[3] = {2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])};
    out[0] = v[0] + w * t[0] + (y * t[2] - z * t[1]);
    out[1] = v[1] + w * t[1] + (z * t[0] - x * t[2]);
    out[2] = v[2] + w * t[2] + (x * t[1] - y * t[0]);
}

// About x, then y, then z: a quarter turn about x takes y to z, and one about z leaves z. Matrix and quaternion agree.
TEST(rotations_turn_about_x_then_y_then_z) {
    const float quarter = 1.57079633f, angles[3] = {quarter, 0, quarter}, any[3] = {0.3f, -1.2f, 2.5f};
    const double y[3] = {0, 1, 0}, x[3] = {1, 0, 0}, v[3] = {0.2, -0.7, 1.1};
    float q[4];
    double out[3], m[9];

    rotation_quaternion(angles, q);
    turn(q, y, out);
    assert_true(fabs(out[0]) < 1e-6 && fabs(out[1]) < 1e-6 && fabs(out[2] - 1) < 1e-6);
    turn(q, x, out);
    assert_true(fabs(out[0]) < 1e-6 && fabs(out[1] - 1) < 1e-6 && fabs(out[2]) < 1e-6);
    rotation_quaternion(any, q);
    rotation_matrix(any, m);
    turn(q, v, out);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(out[i] - (m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2])) < 1e-6);
}

TEST(a_simulation_has_what_the_scene_says) {
    OwnLoaded at = build("sheets:\n  - grid: {size: [0.2, 0.1], cells: [4, 2]}\n    rotate: [90, 0, 0]\n"
                         "    translate: [0, 0, 1]\n    scale: 2\n"
                         "    material: {mass_rate: {from: 1e-3, to: 2e-3, noise: {seed: 1}}}\n"
                         "  - grid: {size: [1, 1], cells: [3, 3]}\n"
                         "sources: [{kind: spot, position: [0, 0, 1]}, {kind: ball, position: [0, 0, 0]}]\n"
                         "colliders: [{kind: plane, position: [0, 0, -1]}]\n"
                         "pins: [{points: [[-0.2, 0, 1.1]], radius: 0}, {sheet: 1, vertices: [0, 1]}]\n",
                         NULL, (SingeLog){0});
    SingeSim *sim = at.sim;
    SingeCounts counts = singe_sim_counts(sim);
    assert_int_equal(counts.particles, 15 + 8 + 16 + 9);
    SingeView view = singe_sim_view(sim);

    // the first grid, doubled and upright: x from -0.2 to 0.2, z from 0.9 to 1.1
    assert_true(fabsf(view.position[0][0] + 0.2f) < 1e-6f && fabsf(view.position[0][1]) < 1e-6f &&
                fabsf(view.position[0][2] - 0.9f) < 1e-6f);
    int pinned = 0;
    for (uint32_t i = 0; i < view.particle_count; i++) pinned += (view.particle_flags[i] & SINGE_PINNED) != 0;
    assert_int_equal(pinned, 3);
    assert_int_equal(singe_sim_step(sim), SINGE_OK);
}

// A refusal of the library is reported at the object it concerns.
TEST(refused_objects_are_named) {
    OwnMessages messages = refused(SHEET "pins:\n  - {vertices: [0]}\n  - {vertices: [99999]}\n", NULL);
    assert_int_equal(messages.count, 1);
    assert_string_equal(messages.items[0].origin, "t.yaml:5:5");
}

// Files of the wrong kind are all reported, each at the line of its name.
TEST(bad_files_are_reported) {
    OwnFolder folder = folder_make();
    folder_file(&folder, "bad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n");
    OwnMessages messages = refused("sheets:\n  - mesh: bad.obj\n    picture: bad.obj\n"
                                   "  - grid: {size: [1, 1], cells: [2, 2]}\n"
                                   "    material: {mass_rate: {from: 1, to: 2, attribute: density}}\n",
                                   folder.path);
    assert_int_equal(messages.count, 3);
    assert_string_equal(messages.items[0].origin, "t.yaml:2:11");
    assert_non_null(strstr(messages.items[0].text, "bad.obj:4"));
    assert_string_equal(messages.items[1].origin, "t.yaml:3:14");
    assert_string_equal(messages.items[2].origin, "t.yaml:5:55");
    assert_non_null(strstr(messages.items[2].text, "no attribute 'density'"));
}

// Meshes that can be read but not burnt are all reported, each with its file and line or face.
TEST(bad_meshes_are_reported) {
    static const struct {
        const char *name, *text, *origin, *fault;
    } meshes[] = {
        {"line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "t.yaml:2:11", "line.obj: no face has an area"},
        {"flat.ply",
         "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n2 0 0\n3 0 0\n4 0 0\n5 0 0\n4 0 1 2 3\n4 1 4 5 2\n",
         "t.yaml:3:11", "flat.ply: no face has an area"},
        {"far.obj", "v 20000 0 0\nv 20001 0 0\nv 20001 1 0\nv 20000 1 0\nf 1 2 3 4\n", "t.yaml:4:11",
         "the sheet reaches beyond 10 km from the origin"},
    };
    OwnFolder folder = folder_make();
    for (int i = 0; i < 3; i++) folder_file(&folder, meshes[i].name, meshes[i].text);
    folder_file(&folder, "words.obj", "v 0 0 x\n");
    for (int reader = 0; reader < 2; reader++) { // without, and with, a mesh that cannot even be read
        char text[400];
        snprintf(text, sizeof text,
                 "sheets:\n  - mesh: line.obj\n  - mesh: flat.ply\n  - mesh: far.obj\n"
                 "  - grid: {size: [1, 1], cells: [2, 2]}\n%s",
                 reader ? "  - mesh: words.obj\n" : "");
        OwnMessages messages = refused(text, folder.path);
        assert_int_equal(messages.count, 3 + reader);
        for (int i = 0; i < 3; i++) {
            assert_string_equal(messages.items[i].origin, meshes[i].origin);
            assert_non_null(strstr(messages.items[i].text, meshes[i].fault));
        }

        if (reader) assert_string_equal(messages.items[3].origin, "t.yaml:6:11");
    }

    SceneMessages messages =
        refused("sheets:\n  - grid: {size: [1e-6, 1e4], cells: [2, 2]}\n  - mesh: line.obj\n", folder.path);
    assert_int_equal(messages.count, 2);
    assert_string_equal(messages.items[0].origin, "t.yaml:2:5");
    assert_non_null(strstr(messages.items[0].text, "the grid cannot be used: cell 0 has"));
    scene_messages_free(&messages);
    messages = refused("sheets:\n  - {grid: {size: [1, 1], cells: [2, 2]}, scale: 1e4, translate: [6000, 0, 0]}\n",
                       folder.path);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.items[0].text, "beyond 10 km"));
    scene_messages_free(&messages);
}

static void keep_line(void *context, SingeLogLevel level, const char *line) {
    char *lines = context;
    if (level == SINGE_LOG_WARNING) strcat(strcat(lines, line), "\n");
}

/// Loads and builds a scene, and keeps its warnings.
static void warnings_of(const char *text, char *lines) {
    lines[0] = 0;
    OwnLoaded at = build(text, NULL, (SingeLog){keep_line, lines});
}

/// Values without effect cause warnings with their location.
TEST(values_without_effect_are_warned_of) {
    static const struct {
        const char *more, *warning;
    } cases[] = {
        {"pins: [{points: [[0, 0, 0]], radius: 1 mm}]", NULL},
        {"pins: [{points: [[0, 0, 0]]}]", NULL},
        {"pins: [{points: [[0, 0, 0], [0, 0, 5 cm]], radius: 1 cm}]",
         "pin 0: its point [0, 0, 0.05] m misses sheet \"sheet1\": it holds only the nearest vertex, which is 0.05 m away\n"},
        {"pins: [{points: [[0, 0, 5 cm]], radius: 6 cm}]", NULL},
        {"pins: [{points: [[0, 0, 3 cm]], radius: 0}]", NULL},
        {"pins: [{points: [[0, 0, 5]], radius: 0}]", "pin 0: its point [0, 0, 5] m misses sheet \"sheet1\""},
        {"pins: [{points: [[0, 0, 5]], radius: 0}, {points: [[0, 0, 7]]}]",
         "pin 1: its point [0, 0, 7] m misses sheet \"sheet1\""},
        {"sources: [{kind: spot, position: [0, 0, 0]}]", NULL},
        {"sources: [{kind: spot, position: [0, 0, 0], conductance: 0}]",
         "t.yaml:3:11: the source heats nothing: its conductance is 0\n"},
        {"sources: [{kind: spot, position: [0, 0, 0], radius: 0, falloff: 0}]", "its radius and its falloff are 0\n"},
        {"sources: [{kind: spot, position: [0, 0, 0], start: 1, end: 1}]", "it ends when it starts\n"},
        {"frames: 25\nsources: [{kind: ball, position: [0, 0, 0], start: 1}]",
         "t.yaml:4:11: the source heats nothing: it starts"},
        {"frames: 26\nsources: [{kind: ball, position: [0, 0, 0], start: 1}]", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[400], lines[4000];
        snprintf(text, sizeof text, "%s%s\n", SHEET, cases[i].more);
        warnings_of(text, lines);
        const bool warned = strstr(lines, "misses") || strstr(lines, "heats nothing");
        if (cases[i].warning ? !strstr(lines, cases[i].warning) : warned) fail_msg("%s: %s", cases[i].more, lines);
    }
}

/// A sheet of 10 cm at rest 5 cm above the ground, and a match at it. Each case replaces one line.
TEST(fires_that_miss_are_warned_of) {
    enum { SHEETS, SOURCES, MORE, LINES };
    static const char *const usual[LINES] = {
        "sheets: [{name: a, grid: {size: [10 cm, 10 cm], cells: [20, 20]}, translate: [0, 0, 5 cm]}]",
        "sources: [{kind: spot, position: [-3 cm, 0, 5 cm], radius: 1 cm, falloff: 1 cm, temperature: 850 C, end: 2 s}]",
        "colliders: [{kind: plane}]"};
#define SPOT(...) "sources: [{kind: spot, radius: 1 cm, falloff: 1 cm, " __VA_ARGS__ "}]"
#define GRID(size, more) "sheets: [{name: a, grid: {size: " size ", cells: [20, 20]}, " more "}]"
    static const struct {
        int line;
        const char *text, *warning; ///< NULL: none
    } cases[] = {
        {MORE, "", NULL},
        // a unit is missing
        {SOURCES, SPOT("position: [6, 0, 5 cm]"),
         "t.yaml:4:11: the source misses the sheets: its heat ends 5.93 m short of the nearest, 'a'\n"},
        {SOURCES, SPOT("position: [-3, 0, 5 cm]"), "the source misses the sheets: its heat ends 2.93 m"},
        {SOURCES, SPOT("position: [-3 cm, 0, 5]"), "the source misses the sheets: its heat ends 4.93 m"},
        {SOURCES, SPOT("position: [-3 cm, 0, -5]"), "the source misses the sheets"},
        {SOURCES, SPOT("position: [0, 30, 5 cm]"), "the source misses the sheets: its heat ends 29.9 m"},
        {SOURCES,
         "sources: [{kind: ball, path: [{time: 0, position: [20, 0, 5 cm]}, {time: 1, position: [3, 0, 5 cm]}]}]",
         "the source misses the sheets: its heat ends 2.93 m"},
        {SOURCES, SPOT("position: [-3 cm, 0, 5 cm], end: 1 ms"),
         "t.yaml:4:11: the source lights nothing: it brings a sheet to 22 C at most, which ignites at 240 C\n"},
        {SHEETS, GRID("[10 cm, 10 cm]", "translate: [20, 0, 5 cm]"), "the source misses the sheets"},
        {SHEETS, GRID("[10, 10]", "translate: [0, 0, 5 cm]"), "it reaches 0.02 m, and the cells of sheet 'a' are 0."},
        {SHEETS, GRID("[10 cm, 10 cm]", "translate: [0, 0, 5 cm], material: {grammage: 80}"),
         "the source lights nothing"},
        {SHEETS, GRID("[10 cm, 10 cm]", "translate: [0, 0, 5]") "\npins: [{points: [[0, 0, 5]]}]",
         "the source misses the sheets"},
        {SOURCES, "sources: [{kind: spot, position: [-3 cm, 0, 5 cm], radius: 1, falloff: 1 cm}]",
         "t.yaml:4:11: the source heats all at once: it reaches 1.01 m, and the largest sheet is 0.141 m large\n"},
        {SOURCES, "sources: [{kind: ball, position: [-3 cm, 0, 5 cm], radius: 1 cm, falloff: 15}]",
         "the source heats all at once: it reaches 15 m"},
        // a flame heats what is above it
        {SOURCES, SPOT("position: [-3 cm, 0, -15 cm], power: 100, conductance: 0") "\ngas: yes", NULL},
        {SOURCES, SPOT("position: [-3 cm, 0, -5], power: 100, conductance: 0") "\ngas: yes",
         "the source misses the sheets"},
        // no fire at all, or too cold a one
        {SOURCES, "", "t.yaml: nothing lights the sheets: there is no source of heat"},
        {SOURCES, "sources: [{kind: turbulence, speed: 1}]", "nothing lights the sheets: there is no source of heat"},
        {SOURCES, SPOT("position: [-3 cm, 0, 5 cm], temperature: 120 C"), "at most, which ignites at 240 C"},
        // what comes to the fire, or the fire to it
        {SHEETS, GRID("[10 cm, 10 cm]", "translate: [0, 0, 2 m]"), NULL},
        {SHEETS, GRID("[10 cm, 10 cm]", "translate: [-2 m, 0, 10 cm], velocity: [2, 0, 0]"), NULL},
        {SHEETS, GRID("[10 cm, 10 cm]", "translate: [-2 m, 0, 1 m]") "\nwind: {velocity: [3, 0, 0]}", NULL},
        {SHEETS,
         GRID("[10 cm, 10 cm]", "translate: [1 m, 0, 5 cm]") "\npins: [{points: [[1, 0, 0.05]], path: [{time: 0, "
                                                             "position: [0, 0, 0]}, {time: 1, position: [-1, 0, 0]}]}]",
         NULL},
        {SOURCES,
         "sources: [{kind: ball, path: [{time: 0, position: [-9, 1 cm, 5 cm]}, {time: 1, position: [9, 0, 5 cm]}]}]",
         NULL},
        {MORE, "frames: 2", NULL},
        // lit by something else
        {SHEETS, GRID("[10 cm, 10 cm]", "material: {temperature: 300 C}"), NULL},
        {SOURCES, "ambient_temperature: 600", NULL},
        {SHEETS, GRID("[10 cm, 10 cm]", "material: {mass_rate: 0}"), NULL},
    };
#undef SPOT
#undef GRID
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1000] = "frames: 48\nsteps: 4\n", lines[4000];
        if (strstr(cases[i].text, "frames")) text[0] = 0;
        for (int line = 0; line < LINES; line++)
            strcat(strcat(text, line == cases[i].line ? cases[i].text : usual[line]), "\n");
        warnings_of(text, lines);
        if (cases[i].warning ? !strstr(lines, cases[i].warning) : strstr(lines, "source ") || strstr(lines, "lights"))
            fail_msg("case %zu: %s\n%s", i, cases[i].text, lines);
    }
    char lines[4000];
    warnings_of("frames: 48\nsteps: 4\nsheets: [{grid: {size: [10 cm, 10 cm], cells: [4, 4]}}]\n"
                "colliders: [{kind: sphere, position: [0, 0, -6 cm], temperature: 600 C, conductance: 100}]\n",
                lines);
    assert_null(strstr(lines, "lights"));
}

/// The examples burn, and none of them is suspected of not doing so.
TEST(fires_of_the_examples_miss_nothing) {
    DIR *folder = opendir("examples");
    uint32_t count = 0;
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[600], lines[4000] = "";
        snprintf(path, sizeof path, "examples/%.200s/%.200s.yaml", entry->d_name, entry->d_name);
        if (access(path, R_OK) != 0) continue;
        OwnMessages messages = {0};
        SceneAssets assets;
        Scene *scene;
        const SingeLog log = {keep_line, lines};
        assert_int_equal(scene_read(path, NULL, 0, &scene, &messages), SINGE_OK);
        assert_int_equal(scene_load(scene, &assets, &messages), SINGE_OK);
        scene_warn(scene, &assets, &log);
        if (lines[0]) fail_msg("%s", lines);
        scene_assets_free(&assets);
        scene_free(scene);
        count++;
    }
    closedir(folder);
    assert_true(count >= 13);
}

static const char cube[] = "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\nv 0 0 20\nv 20 0 20\nv 20 20 20\nv 0 20 20\n"
                           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n%s";

/// An L that stands up: its ends are polygons of eight corners that are not convex, its sides triangles and quads.
static const char nut[] = "v -2 -2 0\nv 2 -2 0\nv 2 0 0\nv 1 0 0\nv 1 -1 0\nv -1 -1 0\nv -1 2 0\nv -2 2 0\n"
                          "v -2 -2 1\nv 2 -2 1\nv 2 0 1\nv 1 0 1\nv 1 -1 1\nv -1 -1 1\nv -1 2 1\nv -2 2 1\n"
                          "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\nf 1 2 10\nf 1 10 9\nf 2 3 11 10\nf 3 4 12 11\n"
                          "f 4 5 13 12\nf 5 6 14 13\nf 6 7 15 14\nf 7 8 16 15\nf 8 1 9 16\n";

/// A mesh in place of a sheet is placed as the sheet is, triangulated, and one vertex for each uv; one that does not fit
/// is refused at its file.
TEST(render_meshes_are_bound) {
    static const char mesh[] = "v -50 0 0\nv 50 0 0\nv 50 50 0\nv 0 90 0\nv -50 50 0\nv -50 -50 0\nv 50 -50 0\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                               "f 1/1 2/2 3/3 4/4 5/4\nf 6/1 7/2 2/3 1/4\n";
    OwnFolder folder = folder_make();
    folder_file(&folder, "a.obj", mesh);
    for (int far = 0; far < 2; far++) {
        char text[400];
        snprintf(text, sizeof text,
                 "sheets:\n  - grid: {size: [100 mm, 100 mm], cells: [10, 10], jitter: 0}\n    units: mm\n"
                 "    render_mesh: {mesh: a.obj, reach: %s}\n",
                 far ? "1 mm" : "50 mm");
        OwnLoaded at = load(text, folder.path);
        OwnMessages messages = {0};
        SingeSimDef hooks = singe_default_sim();
        const RenderFile *file = &at.assets.renders[0];
        assert_int_equal(file->def.vertex_count, 9);
        assert_int_equal(file->def.triangle_count, 5);
        assert_true(fabsf(file->positions[0] + 0.05f) < 1e-7f);
        const SingeResult result = scene_build(at.scene, &at.assets, &hooks, &at.sim, &messages);
        assert_int_equal(result, far ? SINGE_ERROR_MESH : SINGE_OK);
        assert_int_equal(messages.count, far);
        if (far) assert_string_equal(messages.items[0].origin, "t.yaml:4:25");
        if (far) assert_non_null(strstr(messages.items[0].text, "vertices are farther from the sheet than its reach"));
    }
}

/// Meshes and height fields become colliders and shapes; an open mesh is reported at its collider.
TEST(solids_become_colliders_and_shapes) {
    OwnFolder folder = folder_make();
    char text[600], path[100];
    folder_file(&folder, "nut.obj", nut);
    snprintf(text, sizeof text, cube, "f 4 1 5 8\n");
    folder_file(&folder, "cube.obj", text);
    snprintf(text, sizeof text, cube, "");
    folder_file(&folder, "open.obj", text);
    snprintf(path, sizeof path, "%s/heights.png", folder.path);

    // three columns and two rows: above, black, white, black; below, white, black, black
    const uint8_t pixels[18] = {0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 255, 255};
    assert_int_equal(png_write(path, 3, 2, pixels, NULL), SINGE_OK);
    const char *const good = SHEET "colliders:\n  - {kind: mesh, mesh: cube.obj, units: mm, position: [0, 0, 1 m]}\n"
                                   "  - {kind: heightfield, picture: heights.png, size: [30 cm, 20 cm],\n"
                                   "     heights: [1 cm, 3 cm]}\n"
                                   "  - {kind: mesh, mesh: nut.obj, units: cm, scale: 0.5}\n";
    const char *const bad = SHEET "colliders:\n  - {kind: plane}\n  - {kind: mesh, mesh: open.obj}\n";
    Loaded at = build(good, folder.path, (SingeLog){0});
    const SceneSolid *mesh = &at.assets.solids[0], *field = &at.assets.solids[1];
    assert_true(mesh->surface.vertex_count == 8 && mesh->surface.triangle_count == 12);
    assert_true(fabsf(mesh->surface.vertices[3] - 0.02f) < 1e-7f);
    assert_true(field->columns == 3 && field->rows == 2 && field->surface.triangle_count == 4 + 12);
    assert_true(fabsf(field->heights[0] - 0.03f) < 1e-6f && fabsf(field->heights[1] - 0.01f) < 1e-6f); // least y first
    assert_true(fabsf(field->heights[3] - 0.01f) < 1e-6f && fabsf(field->heights[4] - 0.03f) < 1e-6f);
    assert_true(fabsf(field->surface.vertices[0] + 0.15f) < 1e-6f && fabsf(field->surface.vertices[1] + 0.1f) < 1e-6f);
    assert_int_equal(at.assets.solids[2].surface.triangle_count, 2 * 6 + 8 * 2);
    assert_true(fabsf(at.assets.solids[2].surface.vertices[0] + 0.01f) < 1e-7f);
    PreviewShape shapes[3];
    assert_int_equal(scene_shapes(at.scene, &at.assets, 0, shapes, 3), 3);
    assert_true(shapes[0].solid == &mesh->surface && shapes[1].solid == &field->surface);
    unload(&at);

    OwnMessages messages = refused(bad, folder.path);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.items[0].text, "has no neighbour along"));
    assert_string_equal(messages.items[0].origin, "t.yaml:5:5");
}

/// Steps from frame 1 to `frames`, and notes what has burnt at each, on the left half of the sheet and on the right.
static void burn_frames(const char *text, const char *folder, int frames, double burnt[][2]) {
    OwnLoaded at = build(text, folder, (SingeLog){0});
    SingeSim *sim = at.sim;
    for (int frame = 1; frame <= frames; frame++) {
        assert_int_equal(scene_follow(at.scene, &at.assets, sim, frame, NULL), SINGE_OK);
        for (int step = 0; step < at.scene->steps; step++) assert_int_equal(singe_sim_step(sim), SINGE_OK);
        const SingeView view = singe_sim_view(sim);
        burnt[frame][0] = burnt[frame][1] = 0;
        for (uint32_t i = 0; i < view.vertex_count; i++)
            burnt[frame][view.rest_position[i][0] > 0] += 1 - (double)view.mass[i];
    }
}

// A sheet that begins hot burns where and while its material does.
/// A comb and a disc of 4096 corners are cut into triangles that turn their way and have their area, in the time of
/// looking at each pair of corners a few times: clipping that looks at every triple takes a minute.
TEST(faces_of_many_corners_are_cut) {
    enum { CORNERS = 4096 };
    static float vertices[CORNERS][3];
    static uint32_t left[CORNERS], triangles[CORNERS][3];
    static SolidEar ears[CORNERS];
    for (int comb = 0; comb < 2; comb++) {
        for (uint32_t i = 0; i < CORNERS; i++) {
            const float turn = 6.2831853f * (float)i / CORNERS, radius = comb && i % 2 ? 0.5f : 1;
            vertices[i][0] = radius * cosf(turn), vertices[i][1] = radius * sinf(turn);
            left[i] = i;
        }
        double area = 0, covered = 0;
        for (uint32_t i = 0; i < CORNERS; i++) {
            const float *a = vertices[i], *b = vertices[(i + 1) % CORNERS];
            area += ((double)a[0] * (double)b[1] - (double)a[1] * (double)b[0]) / 2;
        }
        const clock_t begun = clock();
        solid_cut_face(vertices[0], left, ears, CORNERS, triangles[0]);
        const double seconds = (double)(clock() - begun) / CLOCKS_PER_SEC;
        for (uint32_t t = 0; t < CORNERS - 2; t++) {
            const float *a = vertices[triangles[t][0]], *b = vertices[triangles[t][1]], *c = vertices[triangles[t][2]];
            const double turn = ((double)b[0] - (double)a[0]) * ((double)c[1] - (double)a[1]) -
                                ((double)b[1] - (double)a[1]) * ((double)c[0] - (double)a[0]);
            assert_true(turn > 0);
            covered += turn / 2;
        }
        print_message("%d corners: %.2f s\n", CORNERS, seconds);
        assert_true(fabs(covered - area) < 1e-9 * area && seconds < 10);
    }
}

TEST(materials_follow_keys_and_numbered_pictures) {
#define HOT                                                                                                                                                          \
    "fps: 10\nsteps: 4\npace: 5\ngas: no\nsheets:\n  - grid: {size: [0.1, 0.1], cells: [6, 6]}\n    material: {temperature: 300 C, convection: 0, emissivity: 0, \n" \
    "        diffusivity: 0, air_supply: inf, "
    double burnt[7][2] = {{0}};
    burn_frames(HOT "ignition_temperature: [{time: 0.1, value: 240 C}, {time: 0.2, value: 9000 C}]}\n", NULL, 4, burnt);
    assert_true(burnt[1][0] > 0.1 && burnt[2][0] > burnt[1][0] + 0.1); // frame 2 is at 0.1 s
    assert_true(burnt[3][0] == burnt[2][0] && burnt[4][0] == burnt[3][0] && burnt[4][1] == burnt[3][1]);

    // white on the left, and from the third frame on on the right; the last picture stays
    static const char text[] = "frames: 6\n" HOT "mass_rate: {from: 0, to: 9e-3, texture: matte.####.png}}\n";
    const uint8_t sides[2][6] = {{255, 255, 255, 0, 0, 0}, {0, 0, 0, 255, 255, 255}};
    OwnFolder folder = folder_make();
    char path[3][100];
    for (int n = 0; n < 3; n++) {
        snprintf(path[n], sizeof path[n], "%s/matte.%04d.png", folder.path, n + 1);
        assert_int_equal(png_write(path[n], 2, 1, sides[n > 1], NULL), SINGE_OK);
    }
    burn_frames(text, folder.path, 5, burnt);
    assert_true(burnt[2][0] > 4 * burnt[2][1]); // 16.5 and 3.5
    assert_true(burnt[3][1] > burnt[2][1] + 8 && burnt[5][1] > burnt[3][1] + 0.5);

    // the second is missing
    remove(path[1]);
    OwnMessages messages = refused(text, folder.path);
    assert_non_null(strstr(messages.items[0].text, "matte.0002.png: there is no such file, but the next one exists"));
    assert_int_equal(messages.items[0].location.line, 9);
}

TEST(the_preview_has_what_the_scene_says) {
    OwnLoaded at = load(
        SHEET "    colour: [0.5, 0.25, 1]\n"
              "sources:\n"
              "  - {kind: ball, radius: 2 cm, temperature: 1300, start: 1, end: 3,\n"
              "     path: [{time: 1, position: [0, 0, 0]}, {time: 3, position: [2, 0, 4]}]}\n"
              "  - {kind: ball, position: [0, 0, 0], visible: no}\n"
              "colliders:\n  - {kind: plane}\n  - {kind: sphere, radius: 1, position: [1, 2, 3], temperature: 900}\n"
              "preview: {size: [64, 32], ground: {height: 1 cm}, camera: {fov: 60}}\n",
        NULL);
    const Scene *scene = at.scene;
    const SceneAssets *assets = &at.assets;
    PreviewDef def;
    scene_preview(scene, assets, &def);
    assert_true(def.width == 64 && def.height == 32 && def.sheet_count == 1 && def.colours[0][1] == 0.25f);
    assert_true(def.ground_height == 0.01f && fabsf(def.camera.fov - 1.04719755f) < 1e-6f && !def.pictures[0]);
    PreviewShape shapes[2];
    assert_int_equal(scene_shapes(scene, assets, 0.5, NULL, 0), 1); // before the ball's start
    assert_int_equal(scene_shapes(scene, assets, 2, shapes, 2), 2);
    assert_true(shapes[0].kind == SINGE_COLLIDER_SPHERE && shapes[0].position[1] == 2);
    assert_true(shapes[0].temperature == scene->sim.ambient_temperature); // it gives no heat
    assert_true(shapes[1].position[0] == 1 && shapes[1].position[2] == 2 && shapes[1].temperature == 1300);
    assert_true(shapes[1].radius == 0.02f && shapes[1].rotation[3] == 1);
    assert_int_equal(scene_shapes(scene, assets, 2, shapes, 1), 2);
}

TEST(the_examples_build) {
    static const char *const paths[] = {"examples/letter/letter.yaml", "examples/letter-hanging/letter-hanging.yaml",
                                        "examples/hot-sphere/hot-sphere.yaml"};
    for (int i = 0; i < 3; i++) {
        Scene *scene;
        SceneAssets assets;
        SceneMessages messages = {0};
        SingeSim *sim;
        SingeSimDef hooks = singe_default_sim();
        SingeResult result = scene_read(paths[i], NULL, 0, &scene, &messages);
        if (!result) result = scene_load(scene, &assets, &messages);
        if (!result) {
            result = scene_build(scene, &assets, &hooks, &sim, &messages);
            scene_assets_free(&assets);
        }
        scene_messages_print(&messages, stderr);
        assert_int_equal(result, SINGE_OK);
        SingeView view = singe_sim_view(sim);
        uint32_t pinned = 0;
        for (uint32_t p = 0; p < view.particle_count; p++) pinned += (view.particle_flags[p] & SINGE_PINNED) != 0;
        assert_true(scene->pin_count ? pinned >= 4 * scene->pins[0].point_count : pinned == 0);
        singe_sim_destroy(sim);
        scene_free(scene);
    }
}

/// How far from the picture's middle the sheets reach at most, 1 being its border; infinite when behind the camera.
static double reach_in_picture(const Scene *scene, const SceneAssets *assets) {
    const PreviewCamera *c = &scene->preview.def.camera;
    double view[3], right[3], top[3], max = 0, lengths[2] = {0, 0};
    for (int i = 0; i < 3; i++) view[i] = (double)c->target[i] - (double)c->eye[i];
    for (int i = 0; i < 3; i++)
        right[i] = view[(i + 1) % 3] * (double)c->up[(i + 2) % 3] - view[(i + 2) % 3] * (double)c->up[(i + 1) % 3];
    for (int i = 0; i < 3; i++)
        top[i] = right[(i + 1) % 3] * view[(i + 2) % 3] - right[(i + 2) % 3] * view[(i + 1) % 3];
    for (int i = 0; i < 3; i++) lengths[0] += view[i] * view[i], lengths[1] += right[i] * right[i];
    double half = tan(0.5 * (double)c->fov), aspect = (double)scene->preview.def.width / scene->preview.def.height;
    for (uint32_t s = 0; s < assets->sheet_count; s++)
        for (uint32_t v = 0; v < assets->meshes[s].vertex_count; v++) {
            double along = 0, x = 0, y = 0;
            for (int i = 0; i < 3; i++) {
                double d = (double)assets->meshes[s].positions[3 * v + (uint32_t)i] - (double)c->eye[i];
                along += d * view[i], x += d * right[i], y += d * top[i];
            }
            if (along <= 0) return INFINITY;
            along /= sqrt(lengths[0]);
            x /= sqrt(lengths[1]), y /= sqrt(lengths[0] * lengths[1]);
            max = fmax(max, fmax(fabs(x) / (along * half * aspect), fabs(y) / (along * half)));
        }
    return max;
}

/// The usual forgotten unit: an object file in centimetres is read as metres.
TEST(large_mesh_files_are_warned_of) {
    OwnFolder folder = folder_make();
    folder_file(&folder, "a.obj", "v 0 0 0\nv 30 0 0\nv 30 20 0\nv 0 20 0\nf 1 2 3 4\n");
    static const char *const texts[] = {"", ", scale: 0.01", ", units: cm"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char text[100], lines[4000] = "";
        snprintf(text, sizeof text, "sheets: [{mesh: a.obj%s}]\n", texts[i]);
        Loaded at = build(text, folder.path, (SingeLog){keep_line, lines});
        unload(&at);
        const char *said = "t.yaml:1:17: the mesh is 30 x 20 x 0 m large: are its numbers cm or mm? (units: cm)\n";
        if (!strstr(lines, said) == (i == 0)) fail_msg("%s%s", text, lines);
    }
}

// A file of triangles, in millimetres and y up. A pin takes the file's vertex numbers, also that of a welded vertex.
TEST(mesh_files_are_scaled_and_welded) {
    OwnFolder folder = folder_make();
    folder_file(&folder, "a.obj",
                "v 5 5 5\nv 0 0 0\nv 100 0 0\nv 100 200 -300\nv 0 0 0\nv 100 200 -300\nv 0 200 -300\n"
                "f 2 3 4\nf 5 6 7\n");
    static const char text[] = "sheets: [{mesh: a.obj, units: mm, up: y, scale: 2, translate: [0, 0, 1]}]\n"
                               "pins: [{vertices: [4, 6]}]\ntearing: no\n"; // no vertices in reserve
    Loaded at = build(text, folder.path, (SingeLog){0});
    assert_int_equal(at.assets.reports[0].count[MESH_WELDED], 2);
    SingeView view = singe_sim_view(at.sim);
    assert_int_equal(view.vertex_count, 4);
    assert_int_equal(view.cell_count, 1);
    int held = 0;
    for (uint32_t v = 0; v < 4; v++) {
        const float *p = view.position[v];
        bool corner = p[0] == 0; // at x = 0: the file's vertices 1 or 4, and 6
        assert_true(fabsf(p[0]) < 1e-6f || fabsf(p[0] - 0.2f) < 1e-6f);
        assert_true((fabsf(p[1]) < 1e-6f && fabsf(p[2] - 1) < 1e-6f) ||
                    (fabsf(p[1] - 0.6f) < 1e-6f && fabsf(p[2] - 1.4f) < 1e-6f));
        assert_int_equal((view.particle_flags[v] & SINGE_PINNED) != 0, corner);
        held += corner;
    }

    assert_int_equal(held, 2);
    unload(&at);
    OwnMessages messages = refused("sheets: [{mesh: a.obj, units: mm}]\npins: [{vertices: [0]}]\n", folder.path);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.items[0].text, "vertex 0 is out of range or belongs to no face"));
}

/// The camera passes its path's entries at their times, smoothly: its speed at an entry does not jump, as on straight
/// lines. It stands still before and after, and pulls its focus.
TEST(a_camera_follows_its_path) {
    OwnScene *scene =
        good_scene("{sheets: [{grid: {size: [1, 1], cells: [2, 2]}}], preview: {camera: {fov: 40}, camera_path: ["
                   "{time: 1, eye: [0, -2, 1], target: [0, 0, 1]},"
                   "{time: 2, eye: [1, -2, 1], target: [0, 0, 1], fov: 20, focus: 1},"
                   "{time: 4, eye: [1, -4, 1], target: [0, 0, 1]}]}}",
                   NULL, 0);
    PreviewCamera camera, before, after;
    scene_camera(scene, 0, &camera);
    assert_true(camera.eye[0] == 0 && camera.eye[1] == -2 && camera.focus == 2);
    scene_camera(scene, 2, &camera);
    assert_true(camera.eye[0] == 1 && camera.eye[1] == -2 && camera.focus == 1);
    assert_float_equal(camera.fov, 0.34906585, 1e-6);
    scene_camera(scene, 9, &camera);
    assert_true(camera.eye[0] == 1 && camera.eye[1] == -4);
    assert_float_equal(camera.focus, 4.1231056, 1e-6);
    assert_float_equal(camera.fov, 0.6981317, 1e-6);
    scene_camera(scene, 1.99, &before);
    scene_camera(scene, 2, &camera);
    scene_camera(scene, 2.01, &after);
    for (int c = 0; c < 2; c++) {
        float in = (camera.eye[c] - before.eye[c]) / 0.01f, out = (after.eye[c] - camera.eye[c]) / 0.01f;
        print_message("speed along %c into the entry %.2f, out of it %.2f m/s\n", "xy"[c], (double)in, (double)out);
        assert_float_equal(in, out, 0.1); // straight lines: 1 and 0, 0 and -1
    }
}

/// Half of what the default camera shows in height at its target, m, of an upright sheet of 20 x 30 cm.
static double half_shown(const char *more) {
    char text[400];
    snprintf(text, sizeof text, "{sheets: [{grid: {size: [0.2, 0.3], cells: [4, 6]}, rotate: [90, 0, 0]}]%s}", more);
    OwnLoaded at = load(text, NULL);
    scene_frame(at.scene, &at.assets);
    const PreviewCamera *camera = &at.scene->preview.def.camera;
    double square = 0;
    for (int k = 0; k < 3; k++) square += pow((double)camera->eye[k] - (double)camera->target[k], 2);
    const double half = sqrt(square) * tan(0.5 * (double)camera->fov);
    return half;
}

TEST(the_camera_leaves_room_for_flames) {
    const double with_flames = 0.5 * (0.3 + 0.08);
    assert_true(half_shown(", sources: [{kind: spot, position: [0, 0, -0.15]}]") > with_flames);
    assert_true(half_shown("") < with_flames); // without a source the sheet alone fills the picture
}

TEST(the_camera_finds_the_sheets) {
    static const char *const scenes[] = {
        "sheets: [{grid: {size: [0.2, 0.3], cells: [4, 6]}}]",
        "sheets: [{grid: {size: [0.2, 0.3], cells: [4, 6]}, rotate: [90, 0, 0], translate: [3, 0, 1]}]",
        "sheets: [{grid: {size: [20, 1], cells: [40, 2]}}, {grid: {size: [1, 1], cells: [2, 2]}, translate: [0, 0, "
        "9]}]",
        "{sheets: [{grid: {size: [1, 1], cells: [2, 2]}}], preview: {size: [90, 200], camera: {up: [0, 1, 0], fov: "
        "60}}}",
    };
    for (size_t i = 0; i <= sizeof scenes / sizeof *scenes; i++) {
        bool given = i == sizeof scenes / sizeof *scenes;
        OwnLoaded at = load(given ? "{sheets: [{grid: {size: [1, 1], cells: [2, 2]}}], "
                                    "preview: {camera: {eye: [5, 5, 5]}}}"
                                  : scenes[i],
                            NULL);
        scene_frame(at.scene, &at.assets);
        const PreviewCamera *camera = &at.scene->preview.def.camera;
        const double reach = reach_in_picture(at.scene, &at.assets);
        if (given) assert_true(camera->eye[0] == 5 && camera->target[0] == 0);
        else assert_true(reach > 0.55 && reach < 1);
    }

    // sheets that are nearly a point: the camera still has a direction
    static const char *const points[] = {
        "sheets: [{grid: {size: [0.08, 0.06], cells: [4, 6]}, scale: 1e-6}]",
        "sheets: [{grid: {size: [2 mm, 2 mm], cells: [4, 6]}, translate: [8000, -7000, 900]}]",
    };
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        OwnLoaded at = load(points[i], NULL);
        scene_frame(at.scene, &at.assets);
        const PreviewCamera *camera = &at.scene->preview.def.camera;
        double square = 0;
        for (int k = 0; k < 3; k++) square += pow((double)camera->eye[k] - (double)camera->target[k], 2);
        print_message("%g m from the sheet\n", sqrt(square));
        assert_true(sqrt(square) > 9e-6 && sqrt(square) < 0.1);
    }

    // too far for a camera: the default one stays
    OwnLoaded at = load("sheets: [{grid: {size: [9000, 9000], cells: [2, 2]}}]", NULL);
    PreviewCamera before = at.scene->preview.def.camera;
    scene_frame(at.scene, &at.assets);
    assert_memory_equal(&at.scene->preview.def.camera, &before, sizeof before);

    // an up along the default line of sight is good where that is not used
    scene_free(good_scene(SHEET "preview: {camera: {up: [0, 0.5, -0.4]}}\n", NULL, 0));
}
