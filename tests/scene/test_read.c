// Good scenes: values arrive, defaults stand, dumps read back, --set and JSON do what the file does.
#include "parsing.h"

#include "scene/schema.h"

static const char full[] =
    "name: all\n"
    "frames: 12\nfps: 25\nsteps: 10\npace: 4\nseed: 18446744073709551615\nambient_temperature: 20 C\n"
    "gravity: [0, 1, -2.5]\nair_density: 1.25\nheat_tolerance: 1e-6\n"
    "sheets:\n"
    "  - name: one\n    mesh: one.obj\n    picture: \"pic \\\"x\\\".png\"\n    colour: [0.5, 1, 0]\n    scale: 0.001\n"
    "    rotate: [90, 0, 45]\n    translate: [0, 1 cm, 2 mm]\n    velocity: [1, 2, 3]\n    drop_pieces_below: 4 mm2\n"
    "    material:\n      grammage: 60 g/m2\n      thickness: {from: 1 mm, to: 2 mm, texture: t.png}\n"
    "      heat_operator: umbrella\n      mass_rate: {to: 0.02, from: 0.01, noise: {scale: 3 mm, octaves: 2, seed: "
    "7}}\n"
    "      mass_loss: {from: 0.1, to: 0.3, attribute: density}\n      ablate: off\n      thickening: 2.5\n"
    "      weight: {red: 0.5, blue: {from: 0, to: 1, texture: w.png}}\n      compliance: {yellow: 1e-4}\n"
    "      drag: {from: 1, to: 2, texture: d.png}\n      rate_ceiling: inf\n"
    "  - grid: {size: [20 cm, 300 mm], cells: [4, 6]}\n"
    "sources:\n"
    "  - {kind: ball, temperature: 1300, path: [{time: 0, position: [0, 0, 1]}, {time: 2, position: [1, 0, 1]}]}\n"
    "  - {kind: ball, position: [1, 2, 3], visible: no}\n"
    "  - {kind: spot, position: [1, 2, 3], start: 1, end: 1250 ms}\n"
    "  - {kind: texture, texture: f.png, flux: 20 kW/m2, strength: [{time: 0, value: 0}, {time: 1, value: 50 %}]}\n"
    "colliders:\n"
    "  - {kind: plane, friction: 0.25}\n"
    "  - {kind: box, half_size: [1, 2, 3], rotation: [0, 90, 0], position: [0, 0, 5], colour: [1, 0, 0]}\n"
    "  - {kind: capsule, radius: 1, height: 2, path: [{time: 1}, {time: 2, rotation: [10, 20, 30]}]}\n"
    "pins:\n"
    "  - {sheet: sheet2, points: [[0, 0, 1], [1 cm, 0, 0]], radius: 3 mm}\n"
    "  - {sheet: 0, vertices: [3, 1, 2], path: [{time: 0}, {time: 1, position: [0, 0, 1]}]}\n"
    "probes:\n"
    "  - {kind: uv, at: [0.25, 0.5], sheet: sheet2, name: \"a, b\"}\n"
    "  - {kind: point, at: [1 cm, 0, 1], sheet: 0}\n"
    "output: {formats: [vtp], events: yes, texture_size: 64}\n"
    "wind: {velocity: [1, 0, 0], gust: 0.5, seed: 4294967295}\n"
    "solver: {substeps: 7, order: [yellow, blue, green, red], regularisation: {red: 0.5}, height_min: 0}\n"
    "gas: {cell_size: 12 mm, conductance: 12, radiated: 25 %, detail: 4}\n"
    "preview:\n  size: [320, 180]\n  samples: 4\n  camera: {eye: [1, 1, 1], fov: 50}\n"
    "  light: {direction: [0, 0, 1], angle: 5, colour: [3, 2, 1]}\n  ground: {height: -0.5}\n  sky: [1, 1, 1]\n";

static void check_full(const Scene *scene) {
    assert_string_equal(scene->name, "all");
    assert_int_equal(scene->frames, 12);
    assert_true(scene->fps == 25 && scene->steps == 10 && scene->sim.pace == 4);
    assert_true(scene->sim.seed == UINT64_MAX && scene->sim.wind.seed == UINT32_MAX);
    assert_true(scene->sim.time_step == (float)(1.0 / 250));
    assert_true(scene->sim.ambient_temperature == 293.15f && scene->sim.gravity[2] == -2.5f);
    assert_int_equal(scene->sheet_count, 2);

    const SceneSheet *sheet = &scene->sheets[0];
    assert_string_equal(sheet->picture.name, "pic \"x\".png");
    assert_true(sheet->scale == 0.001f && sheet->translate[1] == 0.01f && sheet->drop_pieces_below == 4e-6f);
    assert_true(fabsf(sheet->rotate[0] - 1.5707964f) < 1e-7f);

    const SingeMaterialDef *material = &sheet->material.def;
    assert_true(material->grammage.value == 0.06f && material->heat_operator == SINGE_HEAT_UMBRELLA &&
                !material->ablate);
    assert_true(material->thickness.field->kind == SINGE_FIELD_TEXTURE && material->thickness.to == 0.002f);
    assert_string_equal(sheet->material.followed[SCENE_PARAM_SLOT(thickness)].texture.name, "t.png");
    assert_string_equal(sheet->material.followed[SCENE_PARAM_SLOT(weight[SINGE_BLUE])].texture.name, "w.png");
    assert_true(material->mass_rate.field->kind == SINGE_FIELD_NOISE && material->mass_rate.value == 0.01f &&
                material->mass_rate.to == 0.02f && material->mass_rate.field->noise.seed == 7);

    assert_string_equal(material->mass_loss.field->attribute, "density");
    assert_true(material->weight[SINGE_RED].value == 0.5f &&
                material->weight[SINGE_BLUE].field->kind == SINGE_FIELD_TEXTURE);
    assert_true(material->compliance[SINGE_YELLOW].value == 1e-4f);
    assert_true(material->drag.field->kind == SINGE_FIELD_TEXTURE && isinf(material->rate_ceiling.value));
    assert_string_equal(sheet->material.followed[SCENE_PARAM_SLOT(drag)].texture.name, "d.png");
    assert_true(scene->sheets[1].grid.given && scene->sheets[1].grid.def.cells[1] == 6);
    assert_string_equal(scene->sheets[1].name, "sheet2");
}

static void check_objects(const Scene *scene) {
    assert_int_equal(scene->source_count, 4);
    assert_true(scene->sources[0].key_count == 2 && scene->sources[0].keys[1].position[0] == 1);
    assert_true(scene->sources[1].key_count == 1 && scene->sources[1].keys[0].position[2] == 3 &&
                !scene->sources[1].visible);
    assert_true(scene->sources[3].def.flux == 20e3f && scene->sources[3].strength[1].value == 0.5f);

    const SingeGasDef *gas = &scene->sim.gas;
    assert_true(gas->enabled && gas->cell_size == 0.012f && gas->conductance == 12 && gas->radiated == 0.25f);
    assert_true(isinf(scene->sources[0].def.end));
    assert_int_equal(scene->collider_count, 3);
    assert_true(scene->colliders[0].key_count == 1 && scene->colliders[0].def.friction == 0.25f);
    assert_true(scene->colliders[1].keys[0].position[2] == 5 && scene->colliders[1].keys[0].rotation[1] > 1.57f);

    assert_int_equal(scene->pin_count, 2);
    assert_true(scene->pins[0].sheet_index == 1 && scene->pins[0].point_count == 2 &&
                scene->pins[0].points[1].position[0] == 0.01f);
    assert_true(scene->pins[1].sheet_index == 0 && scene->pins[1].vertices[0] == 3 && scene->pins[1].key_count == 2);
    assert_int_equal(scene->probe_count, 2);

    const SceneProbe *probe = scene->probes;
    assert_true(probe[0].kind == SCENE_PROBE_UV && probe[0].sheet_index == 1 && probe[0].uv[1] == 0.5f);
    assert_true(probe[1].kind == SCENE_PROBE_POINT && probe[1].sheet_index == 0 && probe[1].point[0] == 0.01f);
    assert_string_equal(probe[0].name, "a, b");
    assert_string_equal(probe[1].name, "probe2");

    assert_true(scene->output.events && scene->output.texture_size == 64 &&
                output_has(scene->output.formats, OUTPUT_vtp));
    assert_true(scene->sim.gas.enabled && scene->sim.gas.radiated == 0.25f && scene->gas_detail == 4);
    assert_int_equal(scene->sim.solver.order[0], SINGE_YELLOW);
    assert_true(scene->sim.solver.regularisation[SINGE_RED] == 0.5f);
    assert_true(scene->preview.def.ground_height == -0.5f && scene->preview.def.sun_colour[0] == 3);
}

TEST(values_are_read) {
    OwnScene *scene = good_scene(full, NULL, 0);
    check_full(scene);
    check_objects(scene);
}

/// Each parameter of a material that may vary is written under its key, fills its own slot and no other, keeps its
/// texture in a slot of its own, and reads back from a dump.
TEST(every_parameter_that_may_vary_does) {
    static const char *const fields[] = {"texture: p.png", "attribute: burn", "noise: {scale: 2 mm, seed: 9}"};
    SingeMaterialDef standard = singe_default_material();
    SceneParam row;
    int count = 0;
    uint64_t slots = 0;
    for (; scene_param(count, &row); count++) {
        assert_true(row.slot < SCENE_PARAM_SLOTS && !(slots & 1ull << row.slot));
        slots |= 1ull << row.slot;
        for (int f = 0; f < 3; f++) {
            char set[128];
            const char *sets[] = {set};
            float from = strcmp(row.key, "temperature") ? 0.5f : 500, to = 1.5f * from; // allowed by every row
            const char *unit = strcmp(row.key, "fibre_angle") ? "" : " rad";            // a bare angle is degrees
            snprintf(set, sizeof set, "sheets.0.material.%s={from: %g%s, to: %g%s, %s}", row.key, (double)from, unit,
                     (double)to, unit, fields[f]);
            OwnScene *scene = good_scene(SHEET, sets, 1);
            const SceneMaterial *material = &scene->sheets[0].material;
            SingeMaterialDef def = material->def;
            SingeParam *param = scene_param_at(&def, &row);
            assert_true(param->value == from && param->to == to);
            assert_int_equal(param->field->kind, SINGE_FIELD_TEXTURE + f);
            for (size_t slot = 0; slot < SCENE_PARAM_SLOTS; slot++)
                assert_true((material->followed[slot].texture.name != NULL) == (f == 0 && slot == row.slot));
            *param = *scene_param_at(&standard, &row);
            SceneParam other;
            for (int i = 0; scene_param(i, &other); i++)
                assert_memory_equal(scene_param_at(&def, &other), scene_param_at(&standard, &other), sizeof *param);
            char *dump = dump_text(scene, SCENE_YAML);
            OwnScene *again = good_scene(dump, NULL, 0);
            def = again->sheets[0].material.def;
            assert_true(scene_param_at(&def, &row)->to == to);
            free(dump);
        }
    }
    int known = 0
#define SINGE_PARAM(number, NAME, name, ...) +1
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) +SINGE_COLOUR_COUNT
#include "singe/material.def"
        ;
    assert_int_equal(count, known); // all that the library has
    assert_false(scene_param(count, &row));
}

TEST(missing_keys_take_defaults) {
    OwnScene *scene = good_scene(SHEET, NULL, 0);
    assert_string_equal(scene->name, "test");
    SingeMaterialDef material = singe_default_material();
    assert_memory_equal(&scene->sheets[0].material.def, &material, sizeof material);

    SingeSolverDef solver = singe_default_solver();
    assert_memory_equal(&scene->sim.solver, &solver, offsetof(SingeSolverDef, height_gain) + sizeof solver.height_gain);
    assert_int_equal(scene->steps, 20);
    assert_true(scene->sim.time_step == 1.0f / 480);
    assert_true(isinf(scene->preview.def.ground_height) && scene->preview.def.ground_height < 0);
}

static void round_trip(SceneSyntax syntax) {
    OwnScene *scene = good_scene(full, NULL, 0);
    char *dump = dump_text(scene, syntax);
    OwnScene *again = good_scene(dump, NULL, 0);

    check_full(again);
    check_objects(again);

    char *second = dump_text(again, syntax);
    assert_string_equal(dump, second);
    assert_memory_equal(&scene->preview, &again->preview, sizeof scene->preview);
    assert_memory_equal(&scene->sim.solver, &again->sim.solver, sizeof scene->sim.solver);
    assert_memory_equal(scene->colliders[2].keys, again->colliders[2].keys, 2 * sizeof *scene->colliders[2].keys);
    free(second);
    free(dump);
}

TEST(a_yaml_dump_reads_back) { round_trip(SCENE_YAML); }

TEST(a_json_dump_reads_back) { round_trip(SCENE_JSON); }

TEST(json_is_read) {
    OwnScene *scene =
        good_scene("{\"sheets\": [{\"grid\": {\"size\": [\"20 cm\", 0.3], \"cells\": [2, 3]},\n"
                   "\t\"material\": {\"ignition_temperature\": \"240 C\", \"ablate\": false}}], \"frames\": 7}",
                   NULL, 0);
    assert_true(scene->sheets[0].material.def.ignition_temperature.value == 513.15f);
    assert_false(scene->sheets[0].material.def.ablate);
    assert_int_equal(scene->frames, 7);
}

/// Quoted texts in every style of YAML, read as the name of an attribute, which may be any text.
TEST(quoted_texts_are_read) {
    static const struct {
        const char *written, *read;
    } texts[] = {
        {"'it''s'", "it's"},
        {"''''", "'"},
        {"''''''", "''"},
        {"'a''''b'", "a''b"},
        {"'''''''''''''''''''''''''''''''''''''''''''''''''''''''''ime'", "''''''''''''''''''''''''''''ime"},
        {"' a  '", " a  "},
        {"'one  \n          two'", "one two"},
        {"'one\r\n  \n\n          two''\n          ''three '", "one\n\ntwo' 'three "},
        {"'\n          x\n          '", " x "},
        {"'\303\251''\303\251'", "\303\251'\303\251"},
        {"\"a\\tb\\u00e9 ''\"", "a\tb\303\251 ''"},
        {"\"one\n          two \\\n          three\"", "one two three"},
        {"it's a 'b''c'", "it's a 'b''c'"},
    };

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "name: 'a''''b'\n" SHEET "    material:\n      mass_loss: {from: 0.1, to: 0.3, 'attribute': %s}\n",
                 texts[i].written);

        OwnScene *scene = good_scene(text, NULL, 0);
        assert_string_equal(scene->name, "a''b");
        assert_string_equal(scene->sheets[0].material.def.mass_loss.field->attribute, texts[i].read);

        char *dump = dump_text(scene, SCENE_YAML);
        OwnScene *again = good_scene(dump, NULL, 0);
        assert_string_equal(again->sheets[0].material.def.mass_loss.field->attribute, texts[i].read);
        free(dump);
    }

    const char *set = "name='x''''y'";
    OwnScene *scene = good_scene(SHEET, &set, 1);
    assert_string_equal(scene->name, "x''y");
}

TEST(set_overrides_values) {
    static const char *const sets[] = {
        "sheets.0.material.grammage=60 g/m2",
        "sheets[0].material.weight.red=0.25",
        "frames=3",
        "sources[0].start=2 s",
        "preview.camera.eye=[0, -1, 0.5]",
        "frames=4",
        "sheets.0.grid.cells.1=31",
        "solver={substeps: 9}",
        "sources.0.position.2=7 mm",
        "sheets.0.material.mass_rate={from: 1, to: 2, noise: {seed: 3}}",
        "name=a=b",
        "sheets.0.material.mass_rate.to=5",
    };

    OwnScene *scene = good_scene(SHEET "sources: [{kind: spot, position: [1, 2, 3]}]\nframes: 2\n", sets, 12);
    assert_true(scene->sheets[0].material.def.grammage.value == 0.06f);
    assert_true(scene->sheets[0].material.def.weight[SINGE_RED].value == 0.25f);
    assert_int_equal(scene->frames, 4); // the last one counts
    assert_true(scene->sources[0].def.start == 2);
    assert_true(scene->preview.def.camera.eye[1] == -1);

    assert_int_equal(scene->sheets[0].grid.def.cells[1], 31);
    assert_int_equal(scene->sim.solver.substeps, 9);
    assert_true(scene->sources[0].keys[0].position[2] == 0.007f);
    assert_true(scene->sheets[0].material.def.mass_rate.to == 5);
    assert_string_equal(scene->name, "a=b");
}

// A scene has gas unless it switches it off, by `gas: no` or inside the map.
TEST(gas_is_there_unless_switched_off) {
    const struct {
        const char *text, *set;
        bool enabled;
        float height;
    } cases[] = {
        {"", NULL, true, 0.25f},
        {"gas: no\n", NULL, false, 0.25f},
        {"gas: yes\n", NULL, true, 0.25f},
        {"gas: {height: 50 cm}\n", NULL, true, 0.5f},
        {"gas: {height: 50 cm, enabled: no}\n", NULL, false, 0.5f},
        {"gas: {height: 50 cm}\n", "gas=no", false, 0.25f},
        {"gas: {height: 50 cm}\n", "gas.enabled=no", false, 0.5f},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[400];
        snprintf(text, sizeof text, "%s%s", SHEET, cases[i].text);
        OwnScene *scene = good_scene(text, &cases[i].set, cases[i].set ? 1 : 0);
        assert_int_equal(scene->sim.gas.enabled, cases[i].enabled);
        assert_true(scene->sim.gas.height == cases[i].height);
    }

    assert_false(singe_default_sim().gas.enabled);
}

// The solver's method, alone or with keys in any order: the defaults of missing keys suit the method.
TEST(defaults_suit_the_method) {
    static const char sheet[] = "sheets: [{grid: {size: [1, 1], cells: [1, 1]}}]\n";
    static const struct {
        const char *text, *set;
        SingeSolverMethod method;
        int projections;
    } cases[] = {
        {"", NULL, SINGE_SOLVER_STRAND, 1},
        {"solver: paper\n", NULL, SINGE_SOLVER_PAPER, 7},
        {"solver: {projections: 3, method: paper-literal}\n", NULL, SINGE_SOLVER_PAPER_LITERAL, 3},
        {"solver: {method: all-at-once, tolerance: 1e-5}\n", NULL, SINGE_SOLVER_ALL_AT_ONCE, 7},
        {"solver: {projections: 2}\n", "solver=mass-spring", SINGE_SOLVER_MASS_SPRING, 1},
        {"solver: {projections: 2}\n", "solver.method=paper", SINGE_SOLVER_PAPER, 2},
        {"", "solver.method=paper", SINGE_SOLVER_PAPER, 7},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[200];
        snprintf(text, sizeof text, "%s%s", sheet, cases[i].text);

        OwnScene *scene = good_scene(text, &cases[i].set, cases[i].set != NULL);
        const SingeSolverDef *solver = &scene->sim.solver;
        SingeSolverDef standard;
        singe_init_solver_method(&standard, sizeof standard, cases[i].method);
        assert_int_equal(solver->method, cases[i].method);
        assert_int_equal(solver->projections, cases[i].projections);
        assert_int_equal(solver->substeps, standard.substeps);
        assert_memory_equal(solver->order, standard.order, sizeof standard.order);
    }
}
