// All parameters of a material: numbers, ranges, that each may vary; Defs of other versions.
#include "square.h"

#include "common/def_table.h"

#define AT(member) offsetof(SingeMaterialDef, member)

enum { AT_VERTICES = 1, AT_CENTRES = 2, AT_BOTH = 3 };

#define MATTER(field) offsetof(Matter, field)
#define MATTER_NONE NO_FIELD
enum { NO_FIELD = UINT16_MAX };

/// Every parameter that may vary, where it is evaluated, what it may be, and what reads it: the rows of material.def.
static const struct {
    size_t offset;
    int param, places;
    FieldRange range;
    size_t field; ///< in Matter
} varying[] = {
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    {AT(name), number, where, range, field},
#define SINGE_PARAM_BACK SINGE_PARAM
#define COLOUR(number, name, colour, ...) \
    {AT(name[colour]), number + colour, AT_BOTH, __VA_ARGS__, MATTER(name[colour])},
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) \
    COLOUR(number, name, SINGE_RED, range)                   \
    COLOUR(number, name, SINGE_GREEN, range)                 \
    COLOUR(number, name, SINGE_BLUE, range) COLOUR(number, name, SINGE_YELLOW, range)
#include "singe/material.def"
};
enum { VARYING = sizeof varying / sizeof varying[0] };

/// Every parameter goes through the shell into its own field of Matter, front and back of shrinkage each to its layer.
TEST(every_number_goes_to_its_slot) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(2);
    SingeMaterialDef *m = &square.def.material;
    float numbers[VARYING];
    m->reference_grammage = 0;
    for (int k = 0; k < VARYING; k++) {
        const int param = varying[k].param; // a stated bending would replace the compliance of green springs
        numbers[k] = param == PARAM_TEMPERATURE ? 300 : param == PARAM_BENDING ? 0 : 0.01f * (float)(k + 1);
        const SingeParam number = singe_param(numbers[k]);
        memcpy((char *)m + varying[k].offset, &number, sizeof number);
    }

    SheetSource source = evaluate(&memory, &square.def);
    Shell shell;
    assert_int_equal(shell_create(&memory, &source, 1, &shell, NULL), SINGE_OK);
    const float heat = m->heat_of_combustion.value, capacity = m->specific_heat.value;
    for (int k = 0; k < VARYING; k++) {
        if (varying[k].field == NO_FIELD) continue;
        const Field *field = (const Field *)(const void *)((const char *)&shell.matter + varying[k].field);
        float expected = numbers[k];
        switch (varying[k].param) {
        case PARAM_HEAT_OF_COMBUSTION: expected = heat * (1 - m->heat_share.value); break;
        case PARAM_HEAT_SHARE: expected = m->heat_share.value * heat / capacity; break;
        case PARAM_CHAR_HEAT: expected /= capacity; break;
        case PARAM_CHAR_YIELD: expected = fmaxf(expected, m->mass_min.value); break;
        }
        for (uint32_t p = 0; p < shell.particle_count; p++)
            if (varying[k].places & (p < shell.vertex_count ? AT_VERTICES : AT_CENTRES))
                assert_true(field_at(*field, p) == expected);
    }

    shell_free(&memory, &shell);
    sheet_source_free(&memory, &source);
}

/// Every parameter follows a texture, an attribute and noise, each in its own slot: the same field gives every one
/// the values that it gives the thickness, and leaves the others alone.
TEST(every_parameter_can_vary) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(6);
    static const float pixels[] = {0.25f, 1, 0, 0.5f};
    float values[49];

    for (int v = 0; v < 49; v++) values[v] = (float)((v * 5) % 49) / 48;
    SingeAttribute attribute = {"field", values};
    square.def.attribute_count = 1, square.def.attributes = &attribute;

    SheetSource plain = evaluate(&memory, &square.def);
    const uint32_t total = 49 + 36;
    for (int kind = SINGE_FIELD_TEXTURE; kind <= SINGE_FIELD_NOISE; kind++) {
        const SingeField field = {
            .kind = (SingeFieldKind)kind, .texture = {2, 2, pixels}, .attribute = "field", .noise = {0.3f, 2, 3}};
        SingeParam param = singe_param_field(0.5f, 0.9f, &field);
        SingeSheetDef def = square.def;
        def.material.thickness = param;

        SheetSource known = evaluate(&memory, &def);
        for (int k = 0; k < VARYING; k++) {
            const float unit = varying[k].param == PARAM_TEMPERATURE ? 1024 : 1;
            param.value = 0.5f * unit;
            param.to = 0.9f * unit;
            def = square.def;
            memcpy((char *)&def.material + varying[k].offset, &param, sizeof param);

            SheetSource source = evaluate(&memory, &def);
            float low = INFINITY, high = 0;
            for (uint32_t i = 0; i < total; i++) {
                bool here = varying[k].places & (i < 49 ? AT_VERTICES : AT_CENTRES);
                for (int p = 0; p < PARAM_COUNT; p++) {
                    float expected = here && p == varying[k].param ? unit * sheet_param(&known, PARAM_THICKNESS, i)
                                                                   : sheet_param(&plain, p, i);
                    assert_true(sheet_param(&source, p, i) == expected);
                }

                if (!here) continue;
                low = fminf(low, sheet_param(&source, varying[k].param, i));
                high = fmaxf(high, sheet_param(&source, varying[k].param, i));
            }

            assert_true(low >= 0.5f * unit && high <= 0.9f * unit && high - low > 0.1f * unit);
            sheet_source_free(&memory, &source);

            param.to = INFINITY; // no line leads there, not even for a ceiling that may be infinite
            memcpy((char *)&def.material + varying[k].offset, &param, sizeof param);
            refuse(&def, -1, "must vary between two finite numbers");
        }

        sheet_source_free(&memory, &known);
    }

    sheet_source_free(&memory, &plain);
}

/// Mass and capacity where both factors vary, and where their product leaves what a float can hold.
TEST(mass_and_capacity_vary) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(4);
    static const float pixels[] = {0, 1};
    square.def.material.grammage =
        singe_param_field(0.05f, 0.2f, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, pixels}});
    square.def.material.specific_heat =
        singe_param_field(1000, 3000, &(SingeField){.kind = SINGE_FIELD_NOISE, .noise = {0.3f, 2, 3}});

    SheetSource source = evaluate(&memory, &square.def);
    Shell shell;
    assert_int_equal(shell_create(&memory, &source, 1, &shell, NULL), SINGE_OK);

    double ratio = 0;
    for (uint32_t p = 0; p < shell.particle_count; p++) {
        float mass = sheet_param(&source, PARAM_GRAMMAGE, p) / 2 * shell.matter.area[p];
        assert_true(shell.matter.mass[p] == mass);
        assert_true(shell.matter.capacity[p] == mass * sheet_param(&source, PARAM_SPECIFIC_HEAT, p));
        ratio += (double)field_at(shell.matter.capacity_ratio, p) / shell.particle_count;
        double per_area = (double)(shell.matter.capacity[p] / shell.matter.area[p]);
        assert_float_equal(per_area / (double)(shell.matter.capacity[0] / shell.matter.area[0]),
                           field_at(shell.matter.capacity_ratio, p) / field_at(shell.matter.capacity_ratio, 0), 1e-5);
    }

    assert_float_equal(ratio, 1, 1e-6);
    assert_true(shell.matter.mass[4] > 3.9f * shell.matter.mass[0]);
    shell_free(&memory, &shell);
    sheet_source_free(&memory, &source);

    float tiny[25];
    for (int v = 0; v < 25; v++) tiny[v] = v == 18 ? 0 : 1;
    for (int v = 0; v < 25; v++)
        for (int c = 0; c < 3; c++) square.mesh.position[v][c] *= 1e-12f; // cells of a quarter of a picometre

    SingeAttribute attribute = {"thin", tiny};
    square.def.attribute_count = 1, square.def.attributes = &attribute;
    square.def.material.grammage =
        singe_param_field(1e-6f, 0.1f, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "thin"});

    SingeError error = {0};
    assert_int_equal(sheet_source_create(&memory, &square.def, &source, &error), SINGE_ERROR_MESH);
    assert_int_equal(error.element, 10); // the first cell at vertex 18
    assert_non_null(strstr(error.message, "mass or heat capacity"));
    assert_int_equal(memory.held, 0);
}

/// Diffusivity, layer exchange and mass rate are stated for one grammage and are larger where the sheet is lighter; the
/// product of conductance and capacity, a flux per area, is the same everywhere. Heat is stated by its share.
TEST(rates_are_stated_for_a_grammage) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(4);
    static const float pixels[] = {0, 1};
    SingeMaterialDef *m = &square.def.material;
    m->grammage =
        singe_param_field(0.02f, 0.08f, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, pixels}});
    m->specific_heat =
        singe_param_field(1000, 2000, &(SingeField){.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, pixels}});
    m->heat_of_combustion = singe_param(16e6f), m->heat_share = singe_param(0.25f);
    for (int scaled = 0; scaled < 2; scaled++) {
        m->reference_grammage = scaled ? 0.04f : 0;
        SheetSource source = evaluate(&memory, &square.def);
        Shell shell;
        assert_int_equal(shell_create(&memory, &source, 1, &shell, NULL), SINGE_OK);

        const Matter *matter = &shell.matter;
        for (uint32_t p = 0; p < shell.particle_count; p++) {
            float grammage = sheet_param(&source, PARAM_GRAMMAGE, p), ratio = scaled ? 0.04f / grammage : 1;
            assert_float_equal(field_at(matter->diffusivity, p), m->diffusivity.value * ratio, 1e-12f);
            assert_float_equal(field_at(matter->layer_exchange, p), m->layer_exchange.value * ratio, 1e-4f);
            assert_float_equal(field_at(matter->mass_rate, p), m->mass_rate.value * ratio, 1e-8f);
            assert_float_equal(field_at(matter->heating, p), 4e6f / sheet_param(&source, PARAM_SPECIFIC_HEAT, p),
                               1e-3f);
            assert_true(field_at(matter->gas_heat, p) == 12e6f);
        }

        assert_true(matter->mass_rate.mask == (scaled ? UINT32_MAX : 0)); // one value where it does not vary
        assert_true(matter->gas_heat.mask == 0 && matter->heating.mask == UINT32_MAX);
        shell_free(&memory, &shell);
        sheet_source_free(&memory, &source);
    }

    m->reference_grammage = 1e6f;
    m->mass_rate = singe_param(1e35f);
    refuse(&square.def, -1, "mass_rate is too large for its grammage");
    m->reference_grammage = 0, m->heat_of_combustion = singe_param(1e38f), m->specific_heat = singe_param(0.01f);
    refuse(&square.def, -1, "heat_of_combustion is too large for its specific heat");
}

/// A stated bending stiffness D gives green springs the compliance t^2/D, less that of blue ones in series, where it
/// stands and where it varies; without one their own compliance counts.
TEST(bending_is_stated_as_a_stiffness) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(4);
    static const float pixels[] = {0, 1};
    const SingeField texture = {.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, pixels}};
    SingeMaterialDef *m = &square.def.material;
    m->thickness = singe_param(2e-3f);
    m->compliance[SINGE_GREEN] = singe_param(0.1f);
    for (int kind = 0; kind < 4; kind++) {
        m->bending = kind == 2 ? singe_param_field(1e-4f, 3e-4f, &texture) : singe_param(kind ? 3e-4f : 0);
        m->compliance[SINGE_BLUE] = singe_param(kind == 3 ? 1e-3f : 0);

        SheetSource source = evaluate(&memory, &square.def);
        Shell shell;
        assert_int_equal(shell_create(&memory, &source, 1, &shell, NULL), SINGE_OK);
        const Field green = shell.matter.compliance[SINGE_GREEN];
        for (uint32_t p = shell.vertex_count; p < shell.particle_count; p++) {
            const float bending = sheet_param(&source, PARAM_BENDING, p), blue = kind == 3 ? 1e-3f : 0;
            const float expected = kind ? 4e-6f / bending - blue : 0.1f;
            assert_float_equal(field_at(green, p), expected, 1e-6f);
        }

        assert_true(green.mask == (kind == 2 ? UINT32_MAX : 0)); // one value where it does not vary
        shell_free(&memory, &shell);
        sheet_source_free(&memory, &source);
    }

    m->bending = singe_param(1e-38f), m->thickness = singe_param(10);
    refuse(&square.def, -1, "thickness is too large for its bending");
}

// The ends of every range, as its row states them: the last number that is allowed and the first that is not.
TEST(ranges_end_where_stated) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(1);
    for (int i = 0; i < VARYING; i++) {
        const FieldRange *range = &varying[i].range;
        const float low = range->low, high = range->high;
        const bool endless = isinf(high) && range->high_open;
        const struct {
            float value;
            bool good;
        } cases[] = {
            {isinf(low)        ? -1e6f
             : range->low_open ? fmaxf(nextafterf(low, INFINITY), 1e-6f)
                               : low,
             true},
            {endless            ? 1e6f
             : range->high_open ? nextafterf(high, -INFINITY)
                                : high,
             true},
            {range->low_open ? low : nextafterf(low, -INFINITY), false},
            {range->high_open ? high : nextafterf(high, INFINITY), !range->high_open && isinf(high)},
            {NAN, false},
            {-INFINITY, false},
        };

        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            SingeSheetDef def = square.def;
            SingeParam filled = singe_param(cases[k].value);
            memcpy((char *)&def.material + varying[i].offset, &filled, sizeof filled);
            if (cases[k].good) {
                SheetSource source = evaluate(&memory, &def);
                sheet_source_free(&memory, &source);
            } else {
                refuse(&def, 0, range->words); // at the first particle it is for: vertex 0 or, for the back, cell 0
            }
        }
    }

    static const float thickening[] = {0.5f, -1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        SingeSheetDef def = square.def;
        def.material.thickening = thickening[k];
        refuse(&def, -1, "thickening");
    }

    static const float reference[] = {-0.01f, NAN, INFINITY};
    for (int k = 0; k < 3; k++) {
        SingeSheetDef def = square.def;
        def.material.reference_grammage = reference[k];
        refuse(&def, -1, "reference_grammage");
    }

    SingeSheetDef def = square.def;
    def.material.heat_operator = (SingeHeatOperator)3;
    refuse(&def, -1, "heat operator");
}

// A caller's header had fewer fields in the material and in the sheet: the rest take their defaults, and
// the sheet's fields after the material are found where that caller has them.
TEST(older_defs_take_defaults) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(1);
    square.def.material.grammage = singe_param(0.2f);
    square.def.material.damping = singe_param(77); // beyond the older material
    square.def.velocity[0] = 3;

    const size_t head = offsetof(SingeSheetDef, material), inner = offsetof(SingeMaterialDef, damping);
    const size_t cut = inner & ~(sizeof(void *) - 1), tail = 2 * sizeof(size_t);
    unsigned char *old = malloc(head + cut + tail); // exactly: reading more is an error
    assert_non_null(old);
    square.def.struct_size = head + cut + tail;
    square.def.material.struct_size = cut;
    memcpy(old, &square.def, head + cut);
    memcpy(old + head + cut, square.def.velocity, tail);

    SheetSource source = evaluate(&memory, (const SingeSheetDef *)(const void *)old);
    assert_true(sheet_param(&source, PARAM_GRAMMAGE, 0) == 0.2f);
    assert_true(sheet_param(&source, PARAM_DAMPING, 0) == singe_default_material().damping.value);
    assert_true(source.sheet.velocity[0] == 3);
    assert_true(source.sheet.drop_pieces_below == singe_default_sheet().drop_pieces_below);
    sheet_source_free(&memory, &source);

    // without a material at all
    old = realloc(old, head);
    assert_non_null(old);
    memcpy(old, &head, sizeof head);
    source = evaluate(&memory, (const SingeSheetDef *)(const void *)old);
    assert_true(sheet_param(&source, PARAM_GRAMMAGE, 0) == singe_default_material().grammage.value);
    assert_true(source.sheet.material.reference_grammage == singe_default_material().reference_grammage);
    sheet_source_free(&memory, &source);

    // and one that claims more than there is
    square.def.struct_size = sizeof square.def;
    square.def.material.struct_size = sizeof square.def;
    refuse(&square.def, -1, "struct_size");
    free(old);
}

// Long names are cut at a character, and the sheet keeps a copy.
TEST(long_names_are_cut) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(1);
    char name[80];

    memset(name, 'a', sizeof name);
    memcpy(name + 62, "\xC3\xA9\xC3\xA9", 5);
    square.def.name = name;

    SheetSource source = evaluate(&memory, &square.def);
    assert_int_equal(strlen(source.sheet.name), 62);
    sheet_source_free(&memory, &source);
    square.def.name = NULL;
    source = evaluate(&memory, &square.def);
    assert_string_equal(source.sheet.name, "sheet");
    sheet_source_free(&memory, &source);
}
