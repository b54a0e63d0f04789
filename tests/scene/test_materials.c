// Materials that are built in, material files, and what a scene makes of them.
#include "parsing.h"

#include <sys/stat.h>

#include "scene/schema.h"

static SingeResult folder_parse(const Folder *folder, const char *text, const char *const *sets, int count,
                                Scene **scene, SceneMessages *messages) {
    return scene_parse("scene.yaml", text, strlen(text), folder ? folder->path : NULL, sets, count, scene, messages);
}

static Scene *folder_scene(const Folder *folder, const char *text, const char *const *sets, int count) {
    Scene *scene = NULL;
    OwnMessages messages = {0};
    SingeResult result = folder_parse(folder, text, sets, count, &scene, &messages);
    scene_messages_print(&messages, stderr);
    assert_int_equal(result, SINGE_OK);
    return scene;
}

static const SceneMaterial *material_of(const Scene *scene) { return &scene->sheets[0].material; }

static void expect_same_def(const SingeMaterialDef *a, const SingeMaterialDef *b) {
    SingeMaterialDef one = *a, two = *b;
    SceneParam param;
    for (int i = 0; scene_param(i, &param); i++) {
        const SingeParam *p = scene_param_at(&one, &param), *q = scene_param_at(&two, &param);
        const bool same_field =
            p->field && q->field ? memcmp(p->field, q->field, sizeof *p->field) == 0 : p->field == q->field;
        if (p->value != q->value || p->to != q->to || !same_field)
            fail_msg("%s: %g and %g", param.key, (double)p->value, (double)q->value);
    }

    assert_true(one.heat_operator == two.heat_operator && one.thickening == two.thickening &&
                one.reference_grammage == two.reference_grammage && one.ablate == two.ablate);
}

/// Each is valid and has its name and its sources. The first one, which is calibrated, is the program's default.
TEST(built_in_materials_are_good) {
    static const char *const names[] = {"cotton", "newsprint", "office-paper", "one-reaction", "tissue"};
    static const float grammage[] = {0.120f, 0.045f, 0.080f, 0.080f, 0.020f};
    const SingeMaterialDef standard = singe_default_material();
    for (int i = 0; i < 5; i++) {
        char text[200];
        assert_string_equal(scene_material_name(i), names[i]);
        snprintf(text, sizeof text, SHEET "    material: %s\n", names[i]);

        OwnScene *scene = good_scene(text, NULL, 0);
        const SceneMaterial *material = material_of(scene);
        assert_string_equal(material->name, names[i]);
        assert_true(material->def.grammage.value == grammage[i]);
        assert_true(material->def.reference_grammage == 0.080f);
        assert_true(material->measured.given && material->measured.speed[1] > material->measured.speed[0]);
        assert_true(material->measured.calibrated == (i == 2));
        if (i == 2) expect_same_def(&material->def, &standard);
    }

    assert_null(scene_material_name(5));
    assert_null(scene_material_name(400));
}

/// A material with a base and changed keys does not claim the measurements of its base.
TEST(a_base_can_be_changed) {
    Scene *scene = good_scene(SHEET "    material: {thickness: 2 mm, base: newsprint, name: mine}\n", NULL, 0);
    const SceneMaterial *material = material_of(scene);
    assert_string_equal(material->name, "mine");
    assert_true(material->def.thickness.value == 0.002f && material->def.grammage.value == 0.045f);
    assert_false(material->measured.given);

    scene_free(scene);
    scene = good_scene(SHEET "    material: {base: newsprint}\n", NULL, 0);
    assert_true(material_of(scene)->measured.speed[0] == 7.8e-3f);
    scene_free(scene);
    scene = good_scene(SHEET "    material: {base: office-paper, measured: {speed: [1 mm/s, 2 mm/s]}}\n", NULL, 0);

    const SceneMeasured *measured = &material_of(scene)->measured;
    assert_true(measured->given && !measured->calibrated && measured->temperature[1] == 0);
    assert_true(measured->speed[0] == 1e-3f && measured->speed[1] == 2e-3f);
    scene_free(scene);
}

TEST(set_changes_materials) {
    static const char *const texts[] = {SHEET, SHEET "    material: office-paper\n",
                                        SHEET "    material: {base: newsprint}\n", SHEET "    material: {}\n"};
    for (int i = 0; i < 4; i++) {
        const char *sets[] = {"sheets.0.material.base=tissue", "sheets.0.material.thickness=3 mm"};
        OwnScene *scene = good_scene(texts[i], sets, 2);
        assert_string_equal(material_of(scene)->name, "tissue");
        assert_true(material_of(scene)->def.grammage.value == 0.020f);
        assert_true(material_of(scene)->def.thickness.value == 0.003f);
    }

    // what the scene itself says of its material stays
    const char *sets[] = {"sheets.0.material.base=tissue"}, *word[] = {"sheets.0.material=cotton"};
    Scene *scene = good_scene(SHEET "    material: {grammage: 60 g/m2}\n", sets, 1);
    assert_true(material_of(scene)->def.grammage.value == 0.060f && material_of(scene)->def.mass_min.value == 0.03f);
    scene_free(scene);
    scene = good_scene(SHEET "    material: {grammage: 60 g/m2}\n", word, 1);
    assert_true(material_of(scene)->def.grammage.value == 0.120f);
    scene_free(scene);

    const char *solver[] = {"solver.substeps=3"}; // another map that a word may stand for
    scene = good_scene(SHEET "solver: paper\n", solver, 1);
    assert_true(scene->sim.solver.method == SINGE_SOLVER_PAPER && scene->sim.solver.substeps == 3);
    scene_free(scene);
}

/// Material files in the scene's folder or below it, one based on another. Names in them are relative to them. The
/// resolved scene does not need them.
TEST(material_files_are_found) {
    OwnFolder folder = folder_make();
    char below[100];
    snprintf(below, sizeof below, "%s/below", folder.path);
    assert_int_equal(mkdir(below, 0700), 0);

    folder_file(&folder, "below/deep.yaml",
                "base: newsprint\nmass_rate: {from: 1e-3, to: 2e-3, texture: rate.png}\n"
                "thickness: {from: 1 mm, to: 2 mm, texture: t.png}\n");
    folder_file(&folder, "below/mine.yml", "base: deep.yaml\nname: my paper\ndrag: 2\nthickness: 3 mm\n");
    folder_file(&folder, "below/rate.png", "");
    folder_file(&folder, "below/t.png", "");

    OwnScene *scene = folder_scene(&folder, SHEET "    material: below/mine.yml\n", NULL, 0);
    const SceneMaterial *material = material_of(scene);
    assert_string_equal(material->name, "my paper");
    assert_true(material->def.grammage.value == 0.045f && material->def.drag.value == 2);

    const SceneFile *rate = &material->followed[SCENE_PARAM_SLOT(mass_rate)].texture;
    const SceneFile *thickness = &material->followed[SCENE_PARAM_SLOT(thickness)].texture;
    assert_string_equal(rate->name, "below/rate.png");
    assert_memory_equal(rate->path, folder.path, strlen(folder.path));
    assert_true(!material->def.thickness.field && !thickness->name); // the number replaced it

    char *yaml = dump_text(scene, SCENE_YAML), *json = dump_text(scene, SCENE_JSON);
    assert_null(strstr(yaml, "base:"));

    for (int k = 0; k < 2; k++) {
        OwnScene *again = folder_scene(NULL, k ? json : yaml, NULL, 0);
        char *text = dump_text(again, SCENE_YAML);
        assert_string_equal(text, yaml);
        expect_same_def(&material_of(again)->def, &material->def);
        free(text);
    }

    free(yaml), free(json);
}

/// A material file may be one that the reader of the messages must not see: no message repeats any of its text.
TEST(messages_quote_no_other_file) {
    static const char *const secrets[] = {
        "SECRET:$6$SECRET:19000:0:99999:7:::\n",
        "SECRET\nSECRET\n",
        "SECRET: SECRET\n",
        "- SECRET\n",
        "grammage: SECRET\n",
        "grammage: 3 SECRET\n",
        "grammage: {SECRET: 1}\n",
        "grammage: {from: SECRET, to: 1, SECRET: 2}\n",
        "heat_operator: SECRET\n",
        "base: SECRET\n",
        "base: ./SECRET\n",
        "base: SECRET.yaml\n",
        "grammage: [SECRET\n",
        "%SECRET\n",
        "SECRET\x01\n",
        "? [SECRET]\n",
        "&SECRET a\n",
        "!SECRET a\n",
        "\"SECRET\n",
        "grammage: 1\nSECRET\n",
        "weight: SECRET\n",
        "measured: {speed: [SECRET, 1]}\n",
        "thickness: {from: 1, to: 2, texture: SECRET}\n",
        "ablate: SECRET\n",
        "'SECRET': *SECRET\n",
        "SECRET: |0\n  SECRET\n",
    };

    OwnFolder folder = folder_make();
    for (size_t i = 0; i < sizeof secrets / sizeof *secrets; i++) {
        Scene *scene = NULL;
        OwnMessages messages = {0};
        folder_file(&folder, "other.yaml", secrets[i]);
        SingeResult result = folder_parse(&folder, SHEET "    material: other.yaml\n", NULL, 0, &scene, &messages);
        assert_int_equal(result, SINGE_ERROR_FORMAT);
        assert_true(messages.count > 0);

        for (uint32_t m = 0; m < messages.count; m++) {
            const SceneMessage *message = &messages.items[m];
            if (strstr(message->text, "SECRET") || message->source) fail_msg("%s: %s", secrets[i], message->text);
            assert_null(strstr(message->origin, "SECRET"));
            if (message->location.line <= 0 || message->location.column <= 0)
                fail_msg("%s: %s: %s\n", secrets[i], message->origin, message->text);
            assert_non_null(strstr(message->origin, "other.yaml:"));
        }
    }
}

/// One error, with its location and its line.
static void expect_mistake(const Folder *folder, const char *line, const char *origin, const char *says, int count) {
    char text[400];
    Scene *scene = NULL;
    OwnMessages messages = {0};

    snprintf(text, sizeof text, SHEET "%s", line);
    SingeResult result = folder_parse(folder, text, NULL, 0, &scene, &messages);
    if (result != SINGE_ERROR_FORMAT || (int)messages.count != count)
        print_error("%s: result %d\n", line, (int)result), scene_messages_print(&messages, stderr);
    assert_int_equal(result, SINGE_ERROR_FORMAT);
    assert_int_equal(messages.count, count);

    const char *found = messages.items[0].origin, *slash = strrchr(found, '/'); // the folder's name is any
    if (strcmp(slash ? slash + 1 : found, origin) != 0 || !strstr(messages.items[0].text, says))
        fail_msg("%s: %s", found, messages.items[0].text);
    scene_free(scene);
}

TEST(wrong_materials_are_reported) {
    OwnFolder folder = folder_make();
    const Folder *in = &folder;
    char long_file[100];

    folder_file(in, "key.yaml", "grammage: 70 g/m2\nthikness: 1 mm\n");
    folder_file(in, "value.yaml", "grammage: 70 mm\n");
    folder_file(in, "list.yaml", "- grammage\n");
    folder_file(in, "word.yaml", "newsprint\n");
    folder_file(in, "empty.yaml", "# nothing\n");
    folder_file(in, "broken.yaml", "grammage: [1, 2\n");
    folder_file(in, "self.yaml", "drag: 1\nbase: self.yaml\n");
    folder_file(in, "one.yaml", "base: two.yaml\n");
    folder_file(in, "two.yaml", "base: ./one.yaml\n");
    folder_file(in, "picture.yaml", "thickness: {from: 1, to: 2, texture: none.png}\n");
    folder_file(in, "unknown.yaml", "base: newsprnt\n");
    folder_file(in, "range.yaml", "measured: {speed: [2, 1]}\n");

    for (int i = 0; i < 20; i++) {
        char name[40], text[40];
        snprintf(name, sizeof name, "deep%d.yaml", i), snprintf(text, sizeof text, "base: deep%d.yaml\n", i + 1);
        folder_file(in, name, i < 19 ? text : "drag: 1\n");
    }

    snprintf(long_file, sizeof long_file, "%s/long.yaml", folder.path);
    FILE *file = fopen(long_file, "w");
    assert_non_null(file);
    for (int i = 0; i < 1 << 17; i++) fputs("# 8 byte", file);
    fputc('\n', file);
    assert_int_equal(fclose(file), 0);

    expect_mistake(in, "    material: newsprnt\n", "scene.yaml:3:15", "did you mean 'newsprint'?", 1);
    expect_mistake(in, "    material: silk\n", "scene.yaml:3:15",
                   "the built-in ones are cotton, newsprint, office-paper, one-reaction, tissue", 1);
    expect_mistake(in, "    material: {base: [1]}\n", "scene.yaml:3:22", "base must be a material (cotton", 1);
    expect_mistake(in, "    material: [1]\n", "scene.yaml:3:15", "material must be a map (key: value) or a material (",
                   1);
    expect_mistake(in, "    material: {base: newsprint, base: tissue}\n", "scene.yaml:3:16", "is given twice", 1);
    expect_mistake(in, "    material: gone.yaml\n", "scene.yaml:3:15", "there is no such file", 1);
    expect_mistake(in, "    material: ./\n", "scene.yaml:3:15", "this is a folder", 1);
    expect_mistake(in, "    material: key.yaml\n", "key.yaml:2:1", "did you mean 'thickness'?", 1);
    expect_mistake(in, "    material: value.yaml\n", "value.yaml:1:11", "possible are: kg/m2, g/m2", 1);
    expect_mistake(in, "    material: list.yaml\n", "list.yaml:1:1", "a material must be a map", 1);
    expect_mistake(in, "    material: word.yaml\n", "word.yaml:1:1",
                   "a material must be a map (key: value), not this value", 1);
    expect_mistake(in, "    material: empty.yaml\n", "empty.yaml:1:1", "the file is empty", 1);
    expect_mistake(in, "    material: broken.yaml\n", "broken.yaml:2:1", "not valid YAML", 1);
    expect_mistake(in, "    material: self.yaml\n", "self.yaml:2:7", "is based on itself", 1);
    expect_mistake(in, "    material: one.yaml\n", "two.yaml:1:7", "one.yaml is based on itself, through", 1);
    expect_mistake(in, "    material: picture.yaml\n", "picture.yaml:1:38", "there is no such file", 1);
    expect_mistake(in, "    material: unknown.yaml\n", "unknown.yaml:1:7", "did you mean 'newsprint'?", 1);
    expect_mistake(in, "    material: range.yaml\n", "range.yaml:1:19", "must be a range from low to high", 1);
    expect_mistake(in, "    material: deep0.yaml\n", "deep15.yaml:1:7", "more than 16 materials", 1);
    expect_mistake(in, "    material: long.yaml\n", "scene.yaml:3:15", "larger than 1 MiB", 1);

    // reported once however many sheets are made of it, and behind those of the scene
    expect_mistake(in,
                   "    material: key.yaml\n  - {grid: {size: [1, 1], cells: [1, 1]}, material: key.yaml}\npac: 2\n",
                   "scene.yaml:5:1", "did you mean 'pace'?", 2);

    char fifo[100];
    snprintf(fifo, sizeof fifo, "%s/fifo.yaml", folder.path);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    expect_mistake(in, "    material: fifo.yaml\n", "scene.yaml:3:15", "not a regular file", 1);
    expect_mistake(in, "    material: /dev/zero\n", "scene.yaml:3:15", "not a regular file", 1);

    // without a folder files are not looked for, but what is built in is there
    OwnScene *scene = folder_scene(NULL, SHEET "    material: gone.yaml\n", NULL, 0);
    expect_mistake(NULL, "    material: silk\n", "scene.yaml:3:15", "the built-in ones are", 1);
}

/// A look is a part of the material that pictures alone show: it comes with the base, may be changed, and leaves what was
/// measured of the fire.
TEST(looks_come_with_their_base) {
    const char *const head = "sheets:\n  - grid: {size: [1, 1], cells: [2, 2]}\n    material: ";
    const struct {
        const char *material;
        float weave;
        bool measured;
    } cases[] = {{"cotton", 0.4e-3f, true},
                 {"office-paper", 0, true},
                 {"{base: cotton, look: {weave: 1 mm}}", 1e-3f, true},
                 {"{base: cotton, thickness: 1 mm}", 0.4e-3f, false},
                 {"{base: tissue, look: {weave: 0.2 mm}}", 0.2e-3f, true}};

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[200];
        snprintf(text, sizeof text, "%s%s\n", head, cases[i].material);
        OwnScene *scene = folder_scene(NULL, text, NULL, 0);
        assert_float_equal(material_of(scene)->look.weave, cases[i].weave, 1e-7);
        assert_int_equal(material_of(scene)->measured.speed[1] > 0, cases[i].measured);
    }
}
