// A parameter's value at a particle, by picture, attribute and noise.
#include "square.h"

static const float *centre_uv(const Square *square, uint32_t cell, float uv[2]) {
    uv[0] = uv[1] = 0;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) uv[k] += square->uv[square->mesh.cells[cell][i]][k] / 4;
    return uv;
}

// The top row of the file is at v = 1; between pixel centres the value is linear, beyond them held.
TEST(textures_are_sampled_linearly) {
    static const float values[] = {0, 1, 2, 3, 4, 5};
    SingeTexture picture = {3, 2, values};
    static const float expected[][3] = {
        {1.0f / 6, 0.75f, 0},
        {0.5f, 0.75f, 1},
        {5.0f / 6, 0.25f, 5},
        {0.5f, 0.5f, 2.5f},
        {0, 1, 0},
        {1, 1, 2},
        {0, 0, 3},
        {1, 0, 5},
        {-7, 9, 0},
        {9, -7, 5},
        {1.0f / 3, 0.75f, 0.5f},
        {1e38f, -1e38f, 5},
    };

    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++)
        assert_float_equal(shell_sample_texture(&picture, expected[i][0], expected[i][1]), expected[i][2], 1e-5f);
    SingeTexture dot = {1, 1, values + 4};
    assert_float_equal(shell_sample_texture(&dot, 0.3f, 0.8f), 4, 0);
}

// A picture that is linear in u between its two pixels.
TEST(pictures_are_sampled_by_uv) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(8);
    static const float values[] = {0, 1};
    SingeField field = {.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, values}};

    square.def.material.thickness = singe_param_field(0.001f, 0.003f, &field);
    SheetSource source = evaluate(&memory, &square.def);
    for (uint32_t i = 0; i < 81 + 64; i++) {
        float uv[2], u = i < 81 ? square.uv[i][0] : centre_uv(&square, i - 81, uv)[0];
        float f = fminf(fmaxf(2 * u - 0.5f, 0), 1);
        assert_float_equal(sheet_param(&source, PARAM_THICKNESS, i), 0.001f + 0.002f * f, 1e-8f);
    }

    sheet_source_free(&memory, &source);

    square.def.uv = NULL;
    refuse(&square.def, -1, "no uv");
    square.def.uv = square.uv[0];
    field.texture.width = 0;
    refuse(&square.def, -1, "empty texture");

    static const float broken[] = {0, NAN};
    field.texture = (SingeTexture){2, 1, broken};
    refuse(&square.def, 0, "thickness"); // bilinear: a pixel beside NaN is not known either
}

// Attributes are taken as they are, beyond [0, 1] too; centres take the mean of their corners.
TEST(attributes_are_taken_as_they_are) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(3);
    float values[16];

    for (int v = 0; v < 16; v++) values[v] = 0.25f * (float)v;
    SingeAttribute attributes[2] = {{"other", values + 1}, {"burn", values}};
    attributes[0].values = values;
    square.def.attribute_count = 2, square.def.attributes = attributes;

    SingeField field = {.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "burn"};
    square.def.material.mass_rate = singe_param_field(100, 200, &field);
    SheetSource source = evaluate(&memory, &square.def);
    for (uint32_t v = 0; v < 16; v++)
        assert_float_equal(sheet_param(&source, PARAM_MASS_RATE, v), 100 + 25 * (float)v, 1e-3f);

    for (uint32_t c = 0; c < 9; c++) {
        float mean = 0;
        for (int i = 0; i < 4; i++) mean += 25 * (float)square.mesh.cells[c][i] / 4;
        assert_float_equal(sheet_param(&source, PARAM_MASS_RATE, 16 + c), 100 + mean, 1e-3f);
    }

    sheet_source_free(&memory, &source);

    values[6] = -5; // -400
    refuse(&square.def, 6, "mass_rate must be 0 or more; vertex 6 violates this");
    values[6] = NAN;
    refuse(&square.def, 6, "vertex 6");
    field.attribute = "char";
    refuse(&square.def, -1, "no attribute 'char'");
    field.attribute = NULL;
    refuse(&square.def, -1, "needs the name of an attribute");
}

// Noise lies between the two values, varies, and depends on the seed and on the position alone.
TEST(noise_depends_on_seed_and_position) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnSquare square = square_make(24);
    SingeField field = {.kind = SINGE_FIELD_NOISE, .noise = {0.2f, 3, 5}};
    square.def.material.weight[SINGE_BLUE] = singe_param_field(0.2f, 1, &field);
    SheetSource a = evaluate(&memory, &square.def), b = evaluate(&memory, &square.def);
    field.noise.seed = 6;

    SheetSource c = evaluate(&memory, &square.def);
    uint32_t total = 25 * 25 + 24 * 24, different = 0;
    float low = 1, high = 0;
    for (uint32_t i = 0; i < total; i++) {
        float x = sheet_param(&a, PARAM_WEIGHT + SINGE_BLUE, i);
        assert_true(x >= 0.2f && x <= 1);
        assert_true(x == sheet_param(&b, PARAM_WEIGHT + SINGE_BLUE, i));
        different += x != sheet_param(&c, PARAM_WEIGHT + SINGE_BLUE, i);
        low = fminf(low, x), high = fmaxf(high, x);
    }

    assert_true(high - low > 0.4f);
    assert_true(different > total / 2);
    sheet_source_free(&memory, &a);
    sheet_source_free(&memory, &b);
    sheet_source_free(&memory, &c);
    field.noise.scale = 0;

    refuse(&square.def, -1, "scale");
    field.noise = (SingeNoise){.scale = 1, .octaves = 9};
    refuse(&square.def, -1, "octaves");
    field.kind = (SingeFieldKind)7;
    refuse(&square.def, -1, "unknown kind");
}
