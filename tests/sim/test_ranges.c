// The public calls refuse what the tables of Defs say (singe/*.def, and so the headers and docs), and nothing else: each
// field, just inside and just outside of its range, of every kind of object that has it.

#include "common/def_table.h"
#include "support/support.h"

/// A call that takes a Def with one field changed. `kind` is the object's.
typedef SingeResult TryFn(SingeSim *sim, void *def);

static const float heights[4] = {0, 0.01f, 0.02f, 0}, texel = 1;
static const float corners[12] = {-0.1f, -0.1f, 0, 0.1f, -0.1f, 0, 0.1f, 0.1f, 0, -0.1f, 0.1f, 0};
static const uint32_t cell[4] = {0, 1, 2, 3}, vertex = 0;
static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
static const float tetrahedron[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

static SingeResult try_sim(SingeSim *sim, void *def) {
    (void)sim;
    SingeSim *made;
    SingeError error;
    SingeResult result = singe_sim_create(def, &made, &error);
    singe_sim_destroy(made);
    if (result) memcpy((SingeError *)(uintptr_t)singe_sim_error(sim), &error, sizeof error);
    return result;
}

static SingeResult try_solver(SingeSim *sim, void *part) {
    SingeSimDef def = singe_default_sim();
    memcpy(&def.solver, part, sizeof def.solver);
    return try_sim(sim, &def);
}

static SingeResult try_gas(SingeSim *sim, void *part) {
    SingeSimDef def = singe_default_sim();
    memcpy(&def.gas, part, sizeof def.gas);
    return try_sim(sim, &def);
}

static SingeResult try_contact(SingeSim *sim, void *part) {
    SingeSimDef def = singe_default_sim();
    memcpy(&def.contact, part, sizeof def.contact);
    return try_sim(sim, &def);
}

static SingeResult try_wind(SingeSim *sim, void *def) { return singe_sim_set_wind(sim, def); }
static SingeResult try_source(SingeSim *sim, void *def) { return singe_sim_add_source(sim, def, NULL); }
static SingeResult try_collider(SingeSim *sim, void *def) { return singe_sim_add_collider(sim, def, NULL); }
static SingeResult try_pin(SingeSim *sim, void *def) { return singe_sim_add_pin(sim, def, NULL); }
static SingeResult try_sheet(SingeSim *sim, void *def) { return singe_sim_add_sheet(sim, def, NULL); }

static SingeResult try_render_mesh(SingeSim *sim, void *def) {
    return singe_sim_add_render_mesh(sim, (SingeSheetId){0, 1}, def);
}

static void put(void *def, const DefField *field, int index, float value) {
    const int whole = (int)value;
    const void *from = field->type == FIELD_FLOAT ? (const void *)&value : (const void *)&whole;
    memcpy((char *)def + field->offset + (size_t)index * 4, from, 4);
}

/// Tries both ends of every range. Returns how many fields have one.
static int try_table(SingeSim *sim, const DefTable *table, const void *standard, size_t size, TryFn *call) {
    union {
        SingeSimDef sim;
        SingeSheetDef sheet;
        SingeColliderDef collider;
    } def;

    assert_true(size <= sizeof def);
    memcpy(&def, standard, size);
    assert_int_equal(call(sim, &def), SINGE_OK);

    int kind = 0, tried = 0;
    if (table->kind) memcpy(&kind, (const char *)standard + table->kind, sizeof kind);

    for (int i = 0; i < table->count; i++) {
        const DefField *field = &table->fields[i];
        const FieldRange *range = &field->range;
        const bool has = !field->kinds || (field->kinds >> kind & 1);
        if (!range->words) continue;

        const bool whole = field->type == FIELD_INT;
        for (int k = 0; k < field->length; k++) {
            const float below = whole             ? range->low - 1
                                : range->low_open ? range->low
                                                  : nextafterf(range->low, -INFINITY);
            const float above = whole              ? range->high + 1
                                : range->high_open ? range->high
                                                   : nextafterf(range->high, INFINITY);
            const float outside[] = {below, above, NAN};
            for (int o = 0; o < (whole ? 2 : 3); o++) {
                if (range_has(range, outside[o])) continue; // an infinity that is allowed
                memcpy(&def, standard, size);
                put(&def, field, k, outside[o]);
                assert_int_equal(call(sim, &def), has ? SINGE_ERROR_ARGUMENT : SINGE_OK);
                if (!has) continue;

                const char *message = singe_sim_error(sim)->message;
                assert_string_equal(singe_sim_error(sim)->stage, table->stage);
                if (!strstr(message, field->name) || !strstr(message, range->words))
                    fail_msg("%s of %g: \"%s\" lacks \"%s\"", field->name, (double)outside[o], message, range->words);
            }

            const float inside[] = {range->low_open ? 1e-3f : range->low, isinf(range->high) ? 1e6f : range->high};
            for (int o = 0; o < 2; o++) {
                if (!has || isinf(inside[o])) continue;
                memcpy(&def, standard, size);
                put(&def, field, k, inside[o]);
                const SingeResult result = call(sim, &def);
                if (result) fail_msg("%s of %g: %s", field->name, (double)inside[o], singe_sim_error(sim)->message);
            }
        }

        tried++;
    }

    return tried;
}

TEST(ranges_match_the_tables) {
    SingeSimDef def = singe_default_sim();
    OwnSim *sim = test_create(&def);
    int tried = try_table(sim, &sim_table, &def, sizeof def, try_sim);
    tried += try_table(sim, &solver_table, &def.solver, sizeof def.solver, try_solver);
    tried += try_table(sim, &gas_table, &def.gas, sizeof def.gas, try_gas);
    tried += try_table(sim, &contact_table, &def.contact, sizeof def.contact, try_contact);
    tried += try_table(sim, &wind_table, &def.wind, sizeof def.wind, try_wind);
    for (int kind = 0; def_has_value("SingeSourceKind", kind); kind++) {
        SingeSourceDef source = singe_default_source();
        source.kind = (SingeSourceKind)kind;
        source.texture = (SingeTexture){1, 1, &texel};
        tried += try_table(sim, &source_table, &source, sizeof source, try_source);
    }

    for (int kind = 0; def_has_value("SingeColliderKind", kind); kind++) {
        SingeColliderDef collider = singe_default_collider();
        collider.kind = (SingeColliderKind)kind;
        collider.columns = collider.rows = 2;
        collider.heights = heights;
        collider.vertex_count = collider.triangle_count = 4;
        collider.vertices = tetrahedron;
        collider.triangles = faces;
        tried += try_table(sim, &collider_table, &collider, sizeof collider, try_collider);
    }

    SingeSheetDef sheet = singe_default_sheet();
    sheet.vertex_count = 4;
    sheet.positions = corners;
    sheet.cell_count = 1;
    sheet.cells = cell;
    tried += try_table(sim, &sheet_table, &sheet, sizeof sheet, try_sheet);

    SingePinDef pin = singe_default_pin();
    pin.sheet = (SingeSheetId){0, 1};
    pin.vertex_count = 1;
    pin.vertices = &vertex;
    tried += try_table(sim, &pin_table, &pin, sizeof pin, try_pin);

    OwnSim *drawn = test_sim(NULL, test_grid(4, 4, 0.05f, 0.05f), NULL);
    const float triangle[9] = {0.05f, 0.05f, 0, 0.1f, 0.05f, 0, 0.05f, 0.1f, 0};
    SingeRenderMeshDef render = singe_default_render_mesh();
    render.vertex_count = 3, render.triangle_count = 1;
    render.positions = triangle, render.triangles = (const uint32_t[3]){0, 1, 2};
    tried += try_table(drawn, &render_mesh_table, &render, sizeof render, try_render_mesh);

    print_message("%d ranges\n", tried);
    assert_true(tried >= 100);
}

/// An enum's values are 0, 1, 2, ... : tables are indexed by them.
TEST(enums_have_no_holes) {
    static const char *const enums[] = {"SingeSourceKind",   "SingeColliderKind", "SingeContactSides",
                                        "SingeSolverMethod", "SingeInstructions", "SingeColour",
                                        "SingeHeatOperator"};
    for (size_t i = 0; i < sizeof enums / sizeof *enums; i++) {
        assert_true(def_has_value(enums[i], 0) && def_has_value(enums[i], 1) && !def_has_value(enums[i], -1));
        for (int value = 1; value < 32; value++)
            if (def_has_value(enums[i], value)) assert_true(def_has_value(enums[i], value - 1));
    }
}
