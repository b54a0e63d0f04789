// Bad scenes: each error at its exact location, all at once, and no bytes that crash the reader.
#include "parsing.h"

static SceneMessages failing(const char *text, size_t size, const char *base_dir, const char *const *sets,
                             int set_count, SingeResult expected) {
    Scene *scene = (Scene *)&expected;
    SceneMessages messages = {0};
    SingeResult result = scene_parse("bad.yaml", text, size, base_dir, sets, set_count, &scene, &messages);
    if (result != expected) print_error("in:\n%s\n", text);
    assert_int_equal(result, expected);
    assert_null(scene);
    assert_true(messages.count > 0);
    return messages;
}

static void expect_message(const SceneMessages *messages, uint32_t index, const char *origin, const char *part) {
    assert_true(index < messages->count);
    const SceneMessage *message = &messages->items[index];
    if (strcmp(message->origin, origin) != 0 || !strstr(message->text, part))
        print_error("expected %s ... %s\n", origin, part), scene_messages_print(messages, stderr);
    assert_string_equal(message->origin, origin);
    assert_non_null(strstr(message->text, part));
}

// SHEET with one more line (line 3) that has one mistake.
static void one(const char *line, const char *origin, const char *part) {
    char text[2000];
    snprintf(text, sizeof text, "%s%s\n", SHEET, line);
    OwnMessages messages = failing(text, strlen(text), NULL, NULL, 0, SINGE_ERROR_FORMAT);
    expect_message(&messages, 0, origin, part);
    if (messages.count != 1) scene_messages_print(&messages, stderr);
    assert_int_equal(messages.count, 1);
}

/// A material with one parameter that is wrong.
static void one_of(const char *param, const char *part) {
    char text[400];
    snprintf(text, sizeof text, "sheets: [{grid: {size: [1, 1], cells: [2, 2]}, material: {%s}}]\n", param);
    OwnMessages messages = failing(text, strlen(text), NULL, NULL, 0, SINGE_ERROR_FORMAT);
    if (!strstr(messages.items[0].text, part)) fail_msg("%s", messages.items[0].text);
    assert_int_equal(messages.count, 1);
}

TEST(wrong_values_are_reported) {
    one("fps: fast", "bad.yaml:3:6", "fps must be a frame rate (1/s, fps, Hz), not 'fast'");
    one("fps: [1]", "bad.yaml:3:6", "not a list");
    one("fps: {}", "bad.yaml:3:6", "not a map");
    one("fps:", "bad.yaml:3:1", "not nothing");
    one("gravity: [0, 0, '']", "bad.yaml:3:17", "not ''");
    one("fps: nan", "bad.yaml:3:6", "not 'nan'");
    one("fps: inf", "bad.yaml:3:6", "not 'inf'");
    one("fps: 24 24", "bad.yaml:3:6", "");
    one("fps: 0", "bad.yaml:3:6", "out of range: fps must be 0.001 to 100000");
    one("pace: 0", "bad.yaml:3:7", "'0' is out of range: pace must be 1e-6 to 1000000");
    one("pace: 1e60", "bad.yaml:3:7", "'1e60' is out of range: pace must be 1e-6 to 1000000");
    one("pace: 1e999999", "bad.yaml:3:7", "");
    one("pace: 1e-60", "bad.yaml:3:7", "pace must be 1e-6 to 1000000");
    one_of("drag: [{time: 1, value: 2}, {time: 1, value: 3}]", "times must increase");
    one_of("drag: [{time: 1, value: -2}]", "value must be 0 to");
    one_of("drag: [{time: 1}]", "drag needs 'value'");
    one_of("drag: []", "'drag' is an empty list");
    one_of("drag: [1]", "an entry of 'drag' must be a map");
    one_of("moisture: [{time: 0, value: 0}]", "moisture is fixed at the start: it accepts no keys");
    one_of("moisture: {from: 0, to: 1, texture: a.##.png}",
           "moisture is fixed at the start: it accepts one picture only");
    one_of("drag: {from: 0, to: 1, texture: a.#.#.png}", "one run of #");
    one("pace: []", "bad.yaml:3:7", "'pace' is an empty list: it needs at least one entry");
    one("sources: [{kind: texture, texture: a.png, strength: []}]", "bad.yaml:3:53", "at least one entry");
    one("solver: {method: paper, isotropic: yes}", "bad.yaml:3:25", "'isotropic' needs the solver 'strand'");
    one("frames: 1e3", "bad.yaml:3:9", "whole number");
    one("frames: 2.0", "bad.yaml:3:9", "whole number");
    one("frames: 0", "bad.yaml:3:9", "frames must be 1 to 1000000");
    one("frames: -1", "bad.yaml:3:9", "frames must be 1 to 1000000");
    one("frames: 2000000000", "bad.yaml:3:9", "'2000000000' is out of range: frames must be 1 to 1000000");
    one("frames: 99999999999999999999999", "bad.yaml:3:9", "frames must be 1 to 1000000");
    one("frames: -99999999999999999999999", "bad.yaml:3:9", "out of range");
    one("seed: 18446744073709551616", "bad.yaml:3:7", "seed must be 0 to 18446744073709551615");
    one("seed: -1", "bad.yaml:3:7", "whole number");
    one("preview: {camera: {fov: 30 m}}", "bad.yaml:3:25", "unknown unit for an angle; possible are: deg, rad");
    one("preview: {camera: {fov: wide}}", "bad.yaml:3:25", "an angle (deg, rad)");
    one("ambient_temperature: 20 m", "bad.yaml:3:22", "unknown unit for a temperature; possible are: K, C, F");
    one("ambient_temperature: -300 C", "bad.yaml:3:22", "must be 1 to 10000 K");
    one("gravity: [0, 0]", "bad.yaml:3:10", "a list of 3 numbers");
    one("gravity: [0, 0, down]", "bad.yaml:3:17", "not 'down'");
    one("name: a/b", "bad.yaml:3:7", "name must be");
    one("name: .hidden", "bad.yaml:3:7", "name must be");
    one("solver: {order: [red, green, blue, red]}", "bad.yaml:3:36", "'red' is repeated");
    one("solver: {order: [red, green, blue, yelow]}", "bad.yaml:3:36", "did you mean 'yellow'?");
    one("solver: {order: [red]}", "bad.yaml:3:17", "each once");
    one("wind: 3", "bad.yaml:3:7", "wind must be a map");
    one("preview: {camera: {eye: [0, 0, 0], target: [0, 0, 0]}}", "bad.yaml:3:19", "same point");
    one("preview: {camera: {up: [0, 0, 0]}}", "bad.yaml:3:19", "must be longer than 1e-6");
    one("preview: {camera: {fov: 180}}", "bad.yaml:3:25", "out of range");
    one("preview: {light: {direction: [0, 0, 0]}}", "bad.yaml:3:30", "must be longer than 1e-9");
}

/// Messages state both bounds and the unit of bare numbers, and end without a blank.
TEST(messages_name_both_bounds) {
    static const struct {
        const char *line, *text;
    } rows[] = {
        {"fps: 0", "'0' is out of range: fps must be 0.001 to 100000 1/s"},
        {"heat_tolerance: 2", "'2' is out of range: heat_tolerance must be 1e-9 to 1"},
        {"steps: 0", "'0' is out of range: steps must be 1 to 100000"},
        {"wind: {velocity: [1e5, 0, 0]}", "'1e5' is out of range: velocity must be -1000 to 1000 m/s"},
        {"preview: {camera: {fov: 180}}", "'180' is out of range: fov must be 0.1 to 175 deg"},
        {"preview: {ground: {height: -1e30}}", "'-1e30' is out of range: height must be -10000 to 10000 m"},
        {"    material: {drag: 1e30}", "'1e30' is out of range: drag must be 0 to 1e9"},
        {"    material: {loss_mass_floor: 0}", "'0' is out of range: loss_mass_floor must be > 0 to 1"},
        {"    material: {mass_min: 1}", "'1' is out of range: mass_min must be 0 to < 1"},
        {"    material: {temperature: 1e30}", "'1e30' is out of range: temperature must be 1 to 10000 K"},
        {"    rotate: [0, 0, 1e9]", "'1e9' is out of range: rotate must be -1000000 to 1000000 deg"},
        {"pins: [{points: [[0, 0, 1e9]]}]", "'1e9' is out of range: points must be -1000000 to 1000000 m"},
        {"pins: [{vertices: [4294967295]}]", "'4294967295' is out of range: vertices must be 0 to 4294967294"},
        {"wind: {seed: 4294967296}", "'4294967296' is out of range: seed must be 0 to 4294967295"},
        {"colliders: [{kind: plane, position: [0, 0, 1e9]}]",
         "'1e9' is out of range: position must be -10000 to 10000 m"},
        {"sources: [{kind: texture, texture: x.png, strength: 1e9}]",
         "'1e9' is out of range: strength must be 0 to 1000000"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[400];
        snprintf(text, sizeof text, "%s%s\n", SHEET, rows[i].line);
        OwnMessages messages = failing(text, strlen(text), NULL, NULL, 0, SINGE_ERROR_FORMAT);
        assert_int_equal(messages.count, 1);
        assert_string_equal(messages.items[0].text, rows[i].text);
        assert_int_equal(messages.items[0].location.line, 3);
    }
}

/// Values that the library would refuse one at a time and without a location are all reported at once.
TEST(all_ranges_are_reported_at_once) {
    static const char text[] = SHEET "pace: 1e9\ngravity: [0, 0, -1e5]\nambient_temperature: 1e9\nair_density: 1e9\n"
                                     "heat_tolerance: 1e-30\nsolver: {substeps: 10001, regularisation: {red: 1e9}}\n"
                                     "wind: {velocity: [1e5, 0, 0]}\nfps: 0.001\n";

    static const char *const origins[] = {"bad.yaml:3:7",  "bad.yaml:4:17", "bad.yaml:5:22",
                                          "bad.yaml:6:14", "bad.yaml:7:17", "bad.yaml:8:20",
                                          "bad.yaml:8:49", "bad.yaml:9:19", "bad.yaml:10:6"};
    OwnMessages messages = failing(text, sizeof text - 1, NULL, NULL, 0, SINGE_ERROR_FORMAT);
    assert_int_equal(messages.count, 9);
    for (uint32_t i = 0; i < 9; i++)
        expect_message(&messages, i, origins[i], i < 8 ? "is out of range" : "0.02 steps a second");
}

TEST(impossible_steps_are_reported) {
    static const char words[] = "steps a second, which must be 0.1 to 1e9";
    one("fps: 0.001", "bad.yaml:3:6", "0.001 frames a second of 20 steps each are 0.02 steps a second");
    one("steps: 100000\nfps: 1e5", "bad.yaml:4:6", words);
    one("fps: 0.001\nsteps: 1", "bad.yaml:3:6", words);
    static const char *const good[] = {"fps: 0.1\nsteps: 1\n", "fps: 1e4\nsteps: 100000\n", "fps: 0.001\nsteps: 100\n"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        char text[200];
        Scene *scene;
        SingeSim *sim;
        SceneMessages messages = {0};
        snprintf(text, sizeof text, "%s%s", SHEET, good[i]);
        assert_int_equal(scene_parse("t", text, strlen(text), NULL, NULL, 0, &scene, &messages), SINGE_OK);
        assert_int_equal(singe_sim_create(&scene->sim, &sim, NULL), SINGE_OK);
        singe_sim_destroy(sim);
        scene_free(scene);
    }
}

TEST(unknown_keys_are_reported) {
    one("frame: 3", "bad.yaml:3:1", "unknown key 'frame' in the scene; did you mean 'frames'?");
    one("Sources: []", "bad.yaml:3:1", "did you mean 'sources'?");
    one("zzzzzzzz: 3", "bad.yaml:3:1", "unknown key 'zzzzzzzz' in the scene");
    one("fps: 24\nfps: 25", "bad.yaml:4:1", "'fps' is given twice");
    one("preview: {cmaera: {}}", "bad.yaml:3:11", "did you mean 'camera'?");
    one("preview: {light: {colour: [1, 1, 1], color: [1, 1, 1]}}", "bad.yaml:3:38", "did you mean 'colour'?");
}

TEST(wrong_objects_are_reported) {
    one("sources: [{}]", "bad.yaml:3:11", "needs 'kind'");
    one("sources: [3]", "bad.yaml:3:11", "must be a map, not '3'");
    one("sources: {kind: ball}", "bad.yaml:3:10", "a list of maps");
    one("sources: [{kind: bal, position: [0, 0, 0]}]", "bad.yaml:3:18", "did you mean 'ball'?");
    one("sources: [{kind: ball}]", "bad.yaml:3:11", "a source of this kind needs 'path' or 'position'");
    one("sources: [{kind: ball, path: []}]", "bad.yaml:3:30", "at least one entry");
    one("sources: [{kind: ball, path: [{time: 0}], position: [0, 0, 0]}]", "bad.yaml:3:43", "stands for a path");
    one("sources: [{kind: ball, path: [{position: [0, 0, 0]}]}]", "bad.yaml:3:31", "needs 'time'");
    one("sources: [{kind: ball, path: [{time: 1}, {time: 1}]}]", "bad.yaml:3:49", "times must increase");
    one("sources: [{flux: 3, kind: spot, position: [0, 0, 0]}]", "bad.yaml:3:12", "a spot has no 'flux'");
    one("sources: [{kind: spot}]", "bad.yaml:3:11", "needs 'position'");
    one("sources: [{kind: spot, position: [0, 0, 0], path: []}]", "bad.yaml:3:45", "a spot has no 'path'");
    one("sources: [{kind: spot, position: [0, 0, 0], start: 2, end: 1}]", "bad.yaml:3:60", "end before its start");
    one("sources: [{kind: texture}]", "bad.yaml:3:11", "needs 'texture'");
    one("sources: [{kind: texture, texture: ''}]", "bad.yaml:3:36", "name of a file");
    one("colliders: [{kind: sphere, half_size: [1, 1, 1]}]", "bad.yaml:3:28", "a sphere has no 'half_size'");
    one("colliders: [{kind: box, half_size: [1, 0, 1]}]", "bad.yaml:3:40", "half_size must be 1e-6 to 10000 m");
    one("pins: [{}]", "bad.yaml:3:8", "a pin needs 'points' or 'vertices'");
    one("pins: [{points: []}]", "bad.yaml:3:17", "at least one");
    one("pins: [{points: [[0, 0]]}]", "bad.yaml:3:18", "a list of 3");
    one("pins: [{vertices: [-1]}]", "bad.yaml:3:20", "whole number");
    one("pins: [{points: [[0, 0, 0]], holder: pegs}]", "bad.yaml:3:38", "did you mean 'peg'?");
    one("pins: [{points: [[0, 0, 0]], holder: clip, motion: {mesh: a.###.ply}}]", "bad.yaml:3:44",
        "cannot have a 'holder'");
    one("pins: [{sheet: shet1, vertices: [1]}]", "bad.yaml:3:16", "there is no sheet 'shet1'; did you mean 'sheet1'?");
    one("pins: [{sheet: 1, vertices: [1]}]", "bad.yaml:3:16", "there is no sheet '1'");
    one("probes: [{}]", "bad.yaml:3:10", "needs 'kind'");
    one("probes: [{kind: uv, at: [0]}]", "bad.yaml:3:25", "a list of 2");
    one("probes: [{kind: point, at: [0, 0, 0], name: a/b}]", "bad.yaml:3:45", "name");
    one("probes: [{kind: uv, at: [0, 0], sheet: x}]", "bad.yaml:3:40", "there is no sheet 'x'");
    one("probes: [{kind: uv, at: [0, 0], name: a}, {kind: uv, at: [0, 0], name: a}]", "bad.yaml:3:72",
        "two probes are called 'a'");
}

TEST(wrong_sheets_are_reported) {
    one("    mesh: x.obj", "bad.yaml:2:5", "exclude each other");
    one("  - name: x", "bad.yaml:3:5", "needs 'mesh' (a file) or 'grid'");
    one("  - {grid: {size: [1, 1], cells: [1, 1]}, name: sheet1}", "bad.yaml:3:49", "two sheets are called 'sheet1'");
    one("  - {grid: {size: [1, 1], cells: [0, 1]}}", "bad.yaml:3:35", "cells must be 1 to 20000");
    one("  - {grid: {size: [1, 1], cells: [20000, 20000]}}", "bad.yaml:3:12", "100 million");
    one("  - {grid: {size: [1, 1]}}", "bad.yaml:3:12", "needs 'cells'");
    one("    material: {rate_ceiling: {from: inf, to: 9, noise: {}}}", "bad.yaml:3:37", "not 'inf'");
    one("    material: {grammage: 80 mm}", "bad.yaml:3:26", "possible are: kg/m2, g/m2");
    one("    material: {thickening: 0.5}", "bad.yaml:3:28", "0 (as little as the cells need), or at least 1");
    one("    material: {ablate: maybe}", "bad.yaml:3:24", "true or false");
    one("    material: {mass_rate: {from: 1}}", "bad.yaml:3:27", "needs 'from', 'to' and one of");
    one("    material: {mass_rate: {from: 1, to: 2}}", "bad.yaml:3:27", "needs 'from', 'to' and one of");
    one("    material: {mass_rate: {from: 1, to: 2, texture: a, attribute: b}}", "bad.yaml:3:27", "one of");
    one("    material: {mass_rate: {from: 1, to: -2, attribute: b}}", "bad.yaml:3:41", "mass_rate must be 0 to 1e9");
    one("    material: {mass_rate: {from: 1, to: 2, attribute: b, atribute: c}}", "bad.yaml:3:58",
        "did you mean 'attribute'?");
    one("    material: {mass_rate: {from: 1, to: 2, noise: {octaves: 9}}}", "bad.yaml:3:61", "octaves must be 1 to 8");
    one("    material: {mass_rate: {from: 1, to: 2, noise: 4}}", "bad.yaml:3:51", "noise must be a map");
    one("    material: {mass_min: 1}", "bad.yaml:3:26", "0 to < 1");
    one("    material: {weight: {purple: 1}}", "bad.yaml:3:25", "unknown key 'purple'");
}

static void whole(const char *text, const char *origin, const char *part) {
    OwnMessages messages = failing(text, strlen(text), NULL, NULL, 0, SINGE_ERROR_FORMAT);
    expect_message(&messages, 0, origin, part);
}

TEST(wrong_syntax_is_reported) {
    whole("", "bad.yaml:1:1", "empty");
    whole("# nothing\n", "bad.yaml:1:1", "empty");
    whole("- 1\n", "bad.yaml:1:1", "a scene must be a map");
    whole("hello", "bad.yaml:1:1", "a scene must be a map");
    whole("frames: 3\n", "bad.yaml:1:1", "needs 'sheets'");
    whole("sheets: []\n", "bad.yaml:1:9", "at least one sheet");
    char many[40000] = "sheets: [{grid: {size: [1, 1], cells: [1, 1]}}]\nsources: [";
    for (int i = 0; i <= 1000; i++) strcat(many, "{kind: spot, position: [0, 0, 0]},");
    many[strlen(many) - 1] = ']';
    whole(many, "bad.yaml:2:10", "at most 1000 sources");
    whole("frames: [1, 2\n", "bad.yaml:2:1", "not valid YAML");
    whole("frames: \"abc\n", "bad.yaml:1:10", "not valid YAML");
    whole("a: &x 1\n", "bad.yaml:1:7", "anchors and aliases");
    whole("a: *x\n", "bad.yaml:1:4", "anchors and aliases");
    whole("a: !!int 1\n", "bad.yaml:1:10", "tags");
    whole("? [a, b]\n: 1\n", "bad.yaml:1:3", "a key must be a single word");
    whole("a: 1\n---\nb: 2\n", "bad.yaml:2:1", "second document");
    whole("a: \"\\0\"\n", "bad.yaml:1:4", "zero character");
    whole("%YAML 1.2\n---\nframes: 3\n", "bad.yaml:1:1", "directives");

    // libfyaml 0.7 does not return from these two
    whole("\r%\xe0\x99\x8e", "bad.yaml:1:2", "directives");
    whole("\xef\xbb\xbf%\xe0\x99\x8e", "bad.yaml:1:2", "directives");
    whole("frames: 3\x01\n", "bad.yaml:1:10", "not text");
    whole("frames: 3\nname: \xff\n", "bad.yaml:2:7", "not text");
}

/// All messages as one text.
static char *printed(const SceneMessages *messages) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    scene_messages_print(messages, file);
    fclose(file);
    return text;
}

/// Characters that control a terminal or are invisible are escaped wherever they stand in a scene.
TEST(unprintable_characters_are_escaped) {
    static const struct {
        const char *bytes, *escaped;
    } characters[] = {
        {"\xc2\x9b", "\\u009b"},     {"\xc2\x85", "\\u0085"},     {"\x7f", "\\x7f"},
        {"\xe2\x80\xae", "\\u202e"}, {"\xe2\x81\xa6", "\\u2066"}, {"\xe2\x80\x8d", "\\u200d"},
        {"\xef\xbb\xbf", "\\ufeff"}, {"\xe2\x80\xa8", "\\u2028"}, {"\xe2\x80\xa9", "\\u2029"},
        {"\xe2\x80\x8f", "\\u200f"}, {"\xc2\xad", "\\u00ad"},     {"\xf3\xa0\x81\x81", "\\U000e0041"},
    };
    static const char *const lines[] = {"k%s: 1",
                                        "fps: a%sb",
                                        "name: a%sb",
                                        "sources: [{kind: s%s}]",
                                        "pins: [{sheet: a%sb, vertices: [1]}]",
                                        "    material: n%s",
                                        "    material: {mass_rate: {f%s: 1}}",
                                        "  - {name: a%sb}",
                                        "a: \"\\x%s\"",
                                        "fps: 3 m%s"};
    for (size_t c = 0; c < sizeof characters / sizeof *characters; c++)
        for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
            char line[200], text[400];
            snprintf(line, sizeof line, lines[i], characters[c].bytes);
            snprintf(text, sizeof text, "%s%s\n", SHEET, line);
            SceneMessages messages = failing(text, strlen(text), NULL, NULL, 0, SINGE_ERROR_FORMAT);
            char *all = printed(&messages);
            assert_null(strstr(all, characters[c].bytes));
            if (i < 8) assert_non_null(strstr(all, characters[c].escaped));
            free(all);
            scene_messages_free(&messages);
            const char *set[] = {line + strspn(line, " -{")}; // "fps: a" is no PATH=VALUE, and reported as it is
            messages = failing(SHEET, strlen(SHEET), NULL, set, 1, SINGE_ERROR_FORMAT);
            all = printed(&messages);
            assert_null(strstr(all, characters[c].bytes));
            free(all);
            scene_messages_free(&messages);
        }
}

/// Very long texts are cut between characters.
TEST(long_texts_are_cut) {
    static const char *const lines[] = {"%s: 1",
                                        "fps: %s",
                                        "name: %s",
                                        "steps: %s",
                                        "gas: {%s: 1}",
                                        "pins: [{sheet: %s, vertices: [1]}]",
                                        "sources: [{kind: %s}]"};
    static const char *const pieces[] = {"k", "\u00e9", "\u20ac", "\U0001f525", "\xc2\x9b"};
    size_t room = 500000;
    char *word = malloc(room), *text = malloc(2 * room);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++) {
            size_t length = strlen(pieces[k]), count = 400000 / length;
            for (size_t n = 0; n <= count; n++) memcpy(word + n * length, pieces[k], length + 1);
            int used = snprintf(text, 2 * room, "%s", SHEET);
            snprintf(text + used, 2 * room - (size_t)used, lines[i], word);
            SceneMessages messages = failing(text, strlen(text), NULL, NULL, 0, SINGE_ERROR_FORMAT);
            for (uint32_t m = 0; m < messages.count; m++) {
                assert_true(strlen(messages.items[m].text) < 1500);
                assert_true(strlen(messages.items[m].origin) < 100);
                assert_true(!messages.items[m].source || strlen(messages.items[m].source) < 1500);
                assert_null(strstr(messages.items[m].text, "\\x")); // no half characters
                assert_true(!messages.items[m].source || !strstr(messages.items[m].source, "\\x"));
            }

            scene_messages_free(&messages);
            const char *set[] = {text + used};
            messages = failing(SHEET, strlen(SHEET), NULL, set, 1, SINGE_ERROR_FORMAT);
            assert_true(strlen(messages.items[0].text) < 1500 && strlen(messages.items[0].origin) < 1100);
            scene_messages_free(&messages);
        }
    free(word), free(text);
}

/// A name is not empty, and short enough for the names of files.
TEST(impossible_names_are_reported) {
    static const struct {
        const char *piece;
        int count;
        bool good;
    } names[] = {{"n", 100, true},       {"n", 101, false},    {"\u00e9", 100, true},
                 {"\u00e9", 101, false}, {"\u20ac", 66, true}, {"\u20ac", 67, false},
                 {"\u200b", 1, false},   {"\u202e", 1, false}, {"\xc2\x85", 2, false}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text[1000] = SHEET "name: ";
        for (int n = 0; n < names[i].count; n++) strcat(text, names[i].piece);
        Scene *scene = NULL;
        OwnMessages messages = {0};
        SingeResult result = scene_parse("t", text, strlen(text), NULL, NULL, 0, &scene, &messages);
        assert_int_equal(result, names[i].good ? SINGE_OK : SINGE_ERROR_FORMAT);
        if (!names[i].good) assert_non_null(strstr(messages.items[0].text, "at most 100 characters and 200 bytes"));
        scene_free(scene);
    }
}

static void expect_origin_prefix(const SceneMessages *messages, const char *prefix) {
    assert_true(messages->count > 0);
    assert_memory_equal(messages->items[0].origin, prefix, strlen(prefix));
}

TEST(large_texts_are_refused) {
    size_t size = (1 << 20) + 1;
    char *text = malloc(size + 1);
    memset(text, ' ', size);
    text[size] = 0;
    SceneMessages messages = failing(text, size, NULL, NULL, 0, SINGE_ERROR_LIMIT);
    expect_message(&messages, 0, "bad.yaml:1:1", "at most 1 MiB");
    scene_messages_free(&messages);
    memset(text, '[', 100000); // nested far too deep
    messages = failing(text, 100000, NULL, NULL, 0, SINGE_ERROR_FORMAT);
    expect_origin_prefix(&messages, "bad.yaml:1:");
    scene_messages_free(&messages);
    for (unsigned i = 0; i < 50000; i++) // unknown keys without end: the first 200 are reported, the rest counted
        snprintf(text + 10 * i, 11, "k%07u:\n", i % 10000000);
    messages = failing(text, 500000, NULL, NULL, 0, SINGE_ERROR_FORMAT);
    assert_int_equal(messages.count, 200);
    assert_true(messages.left_out >= 49800);
    scene_messages_free(&messages);
    free(text);
}

TEST(all_mistakes_are_reported_at_once) {
    static const char text[] = "frames: x\n"
                               "sheets:\n"
                               "  - gird: {}\n"
                               "    material: {gramage: 3, thickness: 3 K}\n"
                               "sources: [{kind: ball}]\n"
                               "steps: 0\n";

    static const char *const sets[] = {"fps=-1", "nme=x", "sources.3.kind=ball", "steps.x=1", "novalue", "=3",
                                       "pace=[", "a..b=1"};
    OwnMessages messages = failing(text, strlen(text), NULL, sets, 8, SINGE_ERROR_FORMAT);
    expect_message(&messages, 0, "bad.yaml:1:9", "frames must be a whole number, not 'x'");
    expect_message(&messages, 1, "bad.yaml:3:5", "did you mean 'grid'?");
    expect_message(&messages, 2, "bad.yaml:3:5", "needs 'mesh'");
    expect_message(&messages, 3, "bad.yaml:4:16", "did you mean 'grammage'?");
    expect_message(&messages, 4, "bad.yaml:4:39", "possible are: m, cm, mm, um, in");
    expect_message(&messages, 5, "bad.yaml:5:11", "a source of this kind needs");
    expect_message(&messages, 6, "bad.yaml:6:8", "steps must be 1 to 100000");
    expect_message(&messages, 7, "--set fps=-1", "out of range");
    expect_message(&messages, 8, "--set nme=x", "did you mean 'name'?");
    expect_message(&messages, 9, "--set sources.3.kind=ball", "no entry '3': the list has only entry 0");
    expect_message(&messages, 10, "--set steps.x=1", "'0' has no 'x' in it");
    expect_message(&messages, 11, "--set novalue", "expected PATH=VALUE");
    expect_message(&messages, 12, "--set =3", "expected PATH=VALUE");
    expect_message(&messages, 13, "--set pace=[", "not valid YAML");
    expect_message(&messages, messages.count - 1, "--set a..b=1", "expected PATH=VALUE");
    assert_string_equal(messages.items[4].source, "    material: {gramage: 3, thickness: 3 K}");
    assert_int_equal(messages.items[4].caret, 39);
}

TEST(messages_print_with_their_line) {
    static const char bad[] = SHEET "\tx: 1\nfps: \u00e9\u00e9 9\nname: [\u00e9, 1]\n";
    Scene *scene;
    SceneMessages messages = {0};
    static const char text[] = SHEET "name: x\nfps: {\u00e9: 9, \u00e9b: 3}\n";

    assert_int_equal(scene_parse("t.yaml", text, strlen(text), NULL, NULL, 0, &scene, &messages), SINGE_ERROR_FORMAT);
    char *printed = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&printed, &size);
    scene_messages_print(&messages, file);
    fclose(file);
    assert_string_equal(printed, "t.yaml:4:6: error: fps must be a frame rate (1/s, fps, Hz), not a map\n"
                                 "    fps: {\u00e9: 9, \u00e9b: 3}\n"
                                 "         ^\n");
    free(printed);
    scene_messages_free(&messages);
    assert_int_not_equal(scene_parse("t.yaml", bad, strlen(bad), NULL, NULL, 0, &scene, &messages), SINGE_OK);
    scene_messages_free(&messages);
}

TEST(missing_files_are_reported) {
    static const char text[] = "sheets:\n  - {mesh: missing.obj, picture: src, back: none.png}\n";
    SceneMessages messages = failing(text, strlen(text), ".", NULL, 0, SINGE_ERROR_FORMAT);
    expect_message(&messages, 0, "bad.yaml:2:12", "mesh: there is no such file (./missing.obj)");
    expect_message(&messages, 1, "bad.yaml:2:34", "picture: this is a folder (./src)");
    expect_message(&messages, 2, "bad.yaml:2:45", "back: there is no such file (./none.png)");
    scene_messages_free(&messages);
    Scene *scene;
    assert_int_equal(scene_read("tests/scene/none.yaml", NULL, 0, &scene, &messages), SINGE_ERROR_FILE);
    assert_null(scene);
    assert_non_null(strstr(messages.items[0].text, "none.yaml"));
    scene_messages_free(&messages);
    assert_int_equal(scene_read("tests/scene", NULL, 0, &scene, &messages), SINGE_ERROR_FILE);
    scene_messages_free(&messages);
}

// Every prefix of a scene in flow style is incomplete and must be refused.
TEST(truncated_flow_scenes_are_refused) {
    static const char text[] =
        "{frames: 20, 'name': \"a\\u00e9\", sheets: [{grid: {size: [20 cm, 0.3], cells: [2, 3]}, material: {mass_rate:"
        " {from: 1, to: 2, noise: {seed: 3}}}}], sources: [{kind: spot, position: [0, 0, 0]}], # c\n preview: {size: "
        "[32, 32]}}";
    size_t size = strlen(text);
    Scene *scene = good_scene(text, NULL, 0);

    scene_free(scene);
    for (size_t length = 0; length < size; length++) {
        char *prefix = malloc(length + 1); // its end is the end of a block, for the sanitizer
        memcpy(prefix, text, length);
        prefix[length] = 0;
        OwnMessages messages = {0};
        assert_int_equal(scene_parse("t", prefix, length, NULL, NULL, 0, &scene, &messages), SINGE_ERROR_FORMAT);
        assert_true(messages.count > 0);
        free(prefix);
    }
}

// Prefixes in block style may be scenes of their own; then they must read back from their dump.
TEST(truncated_block_scenes_read_back) {
    static const char text[] =
        SHEET "    material:\n      grammage: 80 g/m2\n      mass_rate:\n        from: 1\n        to: 2\n"
              "        attribute: x\nsources:\n  - kind: ball\n    position: [1, 2, 3]\nframes: 1234\n";
    int good = 0;

    for (size_t length = 0; length <= strlen(text); length++) {
        Scene *scene;
        OwnMessages messages = {0};
        char *prefix = malloc(length + 1);
        memcpy(prefix, text, length);
        prefix[length] = 0;
        SingeResult result = scene_parse("t", prefix, length, NULL, NULL, 0, &scene, &messages);
        assert_true(result == SINGE_OK || (result == SINGE_ERROR_FORMAT && messages.count > 0));
        if (result == SINGE_OK) {
            good++;
            char *dump = dump_text(scene, SCENE_YAML);
            OwnScene *again = good_scene(dump, NULL, 0);
            free(dump);
        }

        scene_free(scene);
        free(prefix);
    }

    // Whole at: the grid's line and blanks behind it (6), grammage 8, 80, "80 ", 80 g/m2 and blanks (11), the
    // attribute's line (2), the position's (2), frames 1 to 1234 (5).
    assert_int_equal(good, 26);
}
