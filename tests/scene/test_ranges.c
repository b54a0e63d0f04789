// The schema's ranges and the library's: what a row allows is accepted by the library (and the preview), and what lies
// just beyond is refused by the reader, with its location. Every number of the schema is walked to both its ends.
#include "parsing.h"

#include <float.h>
#include <math.h>
#include <unistd.h>

#include "scene/schema.h"

// An object of every kind, so that every row has a path. Steps: such that all fps are allowed. The front's thickening
// is given: what it would be for the extremes of one row alone is refused.
static const char base[] = "steps: 1000\n"
                           "sheets:\n"
                           "  - grid: {size: [0.2, 0.2], cells: [2, 2]}\n"
                           "    material: {thickening: 2, diffusivity: {from: 1e-6, to: 2e-6, noise: {scale: 0.1}}}\n"
                           "sources:\n"
                           "  - {kind: ball, path: [{time: 0, position: [0, 0, 0]}]}\n"
                           "  - {kind: texture, texture: flux.png, strength: [{time: 0, value: 1}]}\n"
                           "  - {kind: spot, position: [0, 0, 0]}\n"
                           "colliders:\n"
                           "  - {kind: plane, conductance: 10, path: [{time: 0}]}\n"
                           "  - {kind: sphere, conductance: 10, path: [{time: 0}]}\n"
                           "  - {kind: box, conductance: 10, path: [{time: 0}]}\n"
                           "  - {kind: capsule, conductance: 10, path: [{time: 0}]}\n"
                           "  - {kind: heightfield, picture: heights.png, conductance: 10, path: [{time: 0}]}\n"
                           "  - {kind: mesh, motion: {mesh: cube.#.obj}, conductance: 10, path: [{time: 0}]}\n"
                           "pins:\n"
                           "  - {points: [[0, 0, 0]], vertices: [0], path: [{time: 0}]}\n"
                           "  - {points: [[0, 0, 0]], vertices: [0], motion: {mesh: cube.#.obj}}\n"
                           "probes:\n"
                           "  - {kind: uv, at: [0, 0]}\n"
                           "  - {kind: point, at: [0, 0, 0]}\n";

/// A cube of half a unit about its middle.
static const char cube_file[] = "v -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 .5 -.5\nv -.5 .5 -.5\n"
                                "v -.5 -.5 .5\nv .5 -.5 .5\nv .5 .5 .5\nv -.5 .5 .5\n"
                                "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

typedef struct Walk {
    char folder[40];
    int rows; ///< numbers seen
} Walk;

/// Of so many numbers one is tried: a sanitizer, with which every try takes ten times as long, looks at a part.
#ifdef __SANITIZE_ADDRESS__
enum { ONE_OF = 4 };
#else
enum { ONE_OF = 1 };
#endif

static bool allows(const SchemaRow *row, float value) {
    return (row->flags & ROW_OPEN_MIN ? value > (float)row->min : value >= (float)row->min) &&
           (row->flags & ROW_OPEN_MAX ? value < (float)row->max : value <= (float)row->max);
}

/// A run writes its first frame, and draws that one and a later one.
static SingeResult try_first_frame(const Scene *scene, const SceneAssets *assets, SingeSim *sim) {
    SingeError error = {0};
    SingeGas gas = singe_sim_gas(sim);
    Gas copy = {0};
    SingeResult result = gas_copy(&gas, (SingeAllocator){0}, &copy, &error);
    gas_free(&copy);
#ifdef HAVE_PREVIEW
    PreviewDef def;
    Preview *preview = NULL;
    PreviewShape shapes[16];
    scene_preview(scene, assets, &def);
    def.width = def.height = 16; // the largest picture is not what this is about
    if (!result) result = preview_create(&def, (SingeAllocator){0}, &preview, &error);
    static const double times[] = {0, 1e-3, 1, 1e6};
    for (int i = 0; i < 4 && !result; i++) {
        uint32_t count = scene_shapes(scene, assets, times[i], shapes, 16);
        assert_true(count <= 16);
        result = preview_set_shapes(preview, shapes, count, &error);
    }
    preview_destroy(preview);
#endif
    if (error.code) print_error("first frame: %s\n", error.message);
    return result;
}

/// The library's word on a scene that the reader has accepted.
static void expect_built(const Scene *scene, const char *set) {
    SceneAssets assets;
    SceneMessages messages = {0};
    SingeSim *sim = NULL;
    SingeSimDef hooks = singe_default_sim();
    SingeResult result = scene_load(scene, &assets, &messages);
    if (!result) result = scene_build(scene, &assets, &hooks, &sim, &messages);
    if (!result) result = try_first_frame(scene, &assets, sim);
    if (result) print_error("--set %s is allowed, but:\n", set), scene_messages_print(&messages, stderr);
    assert_int_equal(result, SINGE_OK);
    singe_sim_destroy(sim);
    scene_assets_free(&assets);
    scene_messages_free(&messages);
}

static void try_value(const Walk *walk, const char *path, const char *value, bool good) {
    char set[400];
    const char *sets[] = {set};
    Scene *scene = NULL;
    SceneMessages messages = {0};
    snprintf(set, sizeof set, "%s=%s", path, value);
    SingeResult result = scene_parse("t.yaml", base, sizeof base - 1, walk->folder, sets, 1, &scene, &messages);
    if ((result == SINGE_OK) != good)
        print_error("--set %s must be %s\n", set, good ? "good" : "refused"), scene_messages_print(&messages, stderr);
    assert_int_equal(result, good ? SINGE_OK : SINGE_ERROR_FORMAT);
    for (uint32_t i = 0; i < messages.count; i++) {
        assert_int_equal(messages.items[i].location.set, 1);
        assert_non_null(strstr(messages.items[i].text, " is out of range: "));
        assert_non_null(strstr(messages.items[i].text, " to "));
        assert_int_not_equal(messages.items[i].text[strlen(messages.items[i].text) - 1], ' ');
    }
    if (good) expect_built(scene, set);
    scene_messages_free(&messages);
    scene_free(scene);
}

/// The number for every component of the row, at the depth that it has.
static void try_number(const Walk *walk, const SchemaRow *row, const char *path, const char *number, bool good) {
    char value[200] = "";
    bool list = row->type == ROW_POINTS;
    if (walk->rows % ONE_OF) return;
    if (row->type == ROW_INDICES) snprintf(value, sizeof value, "[%s]", number);
    else if (row->type == ROW_INTS) // the maximum of both is more than all cells may be
        snprintf(value, sizeof value, "[%s, %.0f]", number, row->min > 2 ? row->min : 2);
    else if (row->length == 2) snprintf(value, sizeof value, "[%s, %s]", number, number);
    else if (row->length == 3)
        snprintf(value, sizeof value, "%s[%s, %s, %s]%s", list ? "[" : "", number, number, number, list ? "]" : "");
    else snprintf(value, sizeof value, "%s", number);
    try_value(walk, path, value, good);
}

static void walk_whole(const Walk *walk, const SchemaRow *row, const char *path) {
    char number[40];
    double end[] = {row->min, row->max};
    for (int i = 0; i < 2; i++) {
        snprintf(number, sizeof number, "%.0f", end[i]);
        if (row->type != ROW_INDICES || i == 0) // which vertices there are, only the mesh knows
            try_number(walk, row, path, number, true);
        snprintf(number, sizeof number, "%.0f", end[i] + (i ? 1 : -1));
        if (number[0] != '-' || row->type == ROW_INT || row->type == ROW_INTS)
            try_number(walk, row, path, number, false);
    }
}

static void walk_float(const Walk *walk, const SchemaRow *row, const char *path) {
    char number[40];
    assert_true(isfinite(row->min) && isfinite(row->max) && row->min < row->max);
    for (int i = 0; i < 2; i++) {
        float outwards = i ? INFINITY : -INFINITY, value = (float)(i ? row->max : row->min);
        while (!allows(row, value)) value = nextafterf(value, -outwards);
        quantity_print(value, row->dimension, number, sizeof number);
        try_number(walk, row, path, number, true);
        while (allows(row, value)) value = nextafterf(value, outwards);
        quantity_print(value, row->dimension, number, sizeof number);
        try_number(walk, row, path, number, false);
    }
}

static void walk_schema(Walk *walk, const Schema *schema, const char *prefix, unsigned kind);

static void walk_row(Walk *walk, const SchemaRow *row, const char *path) {
    char inner[240];
    switch (row->type) {
    case ROW_INT:
    case ROW_INTS:
    case ROW_INDICES: walk->rows++, walk_whole(walk, row, path); return;
    case ROW_FLOAT:
    case ROW_VECTOR:
    case ROW_POSITION:
    case ROW_ROTATION:
    case ROW_POINTS:
    case ROW_PARAM:
        walk->rows++, walk_float(walk, row, path);
        snprintf(inner, sizeof inner, "%s.noise.", path);
        if (strcmp(row->key, "diffusivity") == 0) walk_schema(walk, &schema_noise, inner, ~0u);
        return;
    case ROW_STRENGTH: walk->rows++, walk_float(walk, row, path); // falls through
    case ROW_LIST: {
        int kinds = 1;
        while (row->sub->kind_offset && row->sub->rows[0].names[kinds]) kinds++;
        for (int i = 0; i < kinds; i++) {
            snprintf(inner, sizeof inner, "%s.%d.", path, i);
            walk_schema(walk, row->sub, inner, row->sub->kind_offset ? 1u << i : ~0u);
        }
        return;
    }
    case ROW_MAP:
        snprintf(inner, sizeof inner, "%s.", path);
        walk_schema(walk, row->sub, inner, ~0u);
        return;
    default: return; // no number, or any that its type holds
    }
}

static void walk_schema(Walk *walk, const Schema *schema, const char *prefix, unsigned kind) {
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        char path[200];
        // the short forms stand for an entry of a path, which is walked
        if (!row_allowed(row, kind) || (row->flags & ROW_SHORT)) continue;
        snprintf(path, sizeof path, "%s%s", prefix, row->key);
        if (strcmp(path, "pins.0.motion") == 0) // which excludes a path: the second pin has it
            strcpy(path, "pins.1.motion");
        walk_row(walk, row, path);
    }
}

static void every_row_keeps_its_range(void **state) {
    (void)state;
    Walk walk = {.folder = "/tmp/singe-ranges-XXXXXX"};
    char picture[64];
    SingeError error;
    assert_non_null(mkdtemp(walk.folder));
    snprintf(picture, sizeof picture, "%s/flux.png", walk.folder);
    assert_int_equal(png_write(picture, 1, 1, (const uint8_t[]){255, 255, 255}, &error), SINGE_OK);
    char heights[64], cube[64];
    snprintf(heights, sizeof heights, "%s/heights.png", walk.folder);
    snprintf(cube, sizeof cube, "%s/cube.obj", walk.folder);
    assert_int_equal(png_write(heights, 2, 2, (const uint8_t[12]){0, 0, 0, 255, 255, 255}, &error), SINGE_OK);
    assert_int_equal(file_write(cube, cube_file, sizeof cube_file - 1, &error), SINGE_OK);
    static const int numbers[] = {0, 1, 1000000}; // first frames of motions
    char moving[3][64];
    for (int i = 0; i < 3; i++) {
        snprintf(moving[i], sizeof moving[i], "%s/cube.%d.obj", walk.folder, numbers[i]);
        assert_int_equal(file_write(moving[i], cube_file, sizeof cube_file - 1, &error), SINGE_OK);
    }
    walk_schema(&walk, &schema_scene, "", ~0u);
    assert_true(walk.rows > 110);
    unlink(picture);
    unlink(heights);
    unlink(cube);
    for (int i = 0; i < 3; i++) unlink(moving[i]);
    rmdir(walk.folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_row_keeps_its_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
