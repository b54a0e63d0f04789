// A material: values that may vary over the sheet, and its fire according to its sources.
#include "scene/schema_rows.h"

#include <stdio.h>
#include <string.h>

static const SchemaRow noise_rows[] = {
    {"scale", ROW_FLOAT, DIM_LENGTH, AT(SingeNoise, scale), WITHIN(1e-6, 1e6), .doc = "size of the largest features"},
    {"octaves", ROW_INT, DIM_NONE, AT(SingeNoise, octaves), WITHIN(1, 8),
     .doc = "layers of detail, each half the size and half the strength of the one before"},
    {"seed", ROW_UINT32, DIM_NONE, AT(SingeNoise, seed), .doc = "seed of the noise"},
};
const Schema schema_noise = {.title = "a noise",
                             .size = sizeof(SingeNoise),
                             ROWS(noise_rows),
                             .defaults = default_noise,
                             .doc = "A random field from 0 to 1, smooth at its scale, fixed to the sheet."};

// A value that may vary over the sheet; the slot of its texture follows from the member.
#define PARAM(name, member, dim, text, ...)                                                                            \
    {                                                                                                                  \
        name, ROW_PARAM, dim, AT(SceneMaterial, def.member), EXTRA(SceneMaterial, followed[SCENE_PARAM_SLOT(member)]), \
            .doc = text, __VA_ARGS__                                                                                   \
    }
static const SchemaRow weight_rows[] = {
    PARAM("red", weight[SINGE_RED], DIM_FRACTION, "centre to corner: thickness", WITHIN(0, 1)),
    PARAM("green", weight[SINGE_GREEN], DIM_FRACTION, "centre to centre: stretch of the back layer", WITHIN(0, 1)),
    PARAM("blue", weight[SINGE_BLUE], DIM_FRACTION, "mesh edges: stretch of the front layer", WITHIN(0, 1)),
    PARAM("yellow", weight[SINGE_YELLOW], DIM_FRACTION, "diagonals: shear", WITHIN(0, 1)),
};
static const Schema schema_weight = {
    .title = "weights",
    .size = sizeof(SceneMaterial),
    ROWS(weight_rows),
    .doc = "Weight of the springs' constraints, W of eq 19, by colour of spring: 1 is full, smaller is softer."};

static const SchemaRow compliance_rows[] = {
    PARAM("red", compliance[SINGE_RED], DIM_COMPLIANCE, "centre to corner: thickness, shear across it", FROM(0)),
    PARAM("green", compliance[SINGE_GREEN], DIM_COMPLIANCE,
          "centre to centre: bending; the stiffness is thickness^2/compliance, in N m", FROM(0)),
    PARAM("blue", compliance[SINGE_BLUE], DIM_COMPLIANCE,
          "mesh edges: stretch; the stiffness is 1/compliance. Above 0 the sheet has no attachments", FROM(0)),
    PARAM("yellow", compliance[SINGE_YELLOW], DIM_COMPLIANCE, "diagonals: shear; the stiffness is 1/compliance",
          FROM(0)),
};
static const Schema schema_compliance = {
    .title = "compliances",
    .size = sizeof(SceneMaterial),
    ROWS(compliance_rows),
    .doc = "Elongation of a spring per force, by colour of spring; 0 is rigid. What it means for a sheet, and "
           "the substeps that stiff sheets need: [stiffness.md](equations/stiffness.md)."};

static const SchemaRow measured_rows[] = {
    {"calibrated", ROW_BOOL, DIM_NONE, AT(SceneMeasured, calibrated),
     .doc = "yes: the material was calibrated with these values; no: its predictions are compared with them"},
    {"speed", ROW_VECTOR, DIM_SPEED, AT(SceneMeasured, speed), .length = 2, WITHIN(0, 1e6),
     .doc = "speed of a level front, min and max"},
    {"temperature", ROW_VECTOR, DIM_TEMPERATURE, AT(SceneMeasured, temperature), .length = 2, WITHIN(0, 1e4),
     .doc = "highest temperature, min and max"},
    {"residue", ROW_VECTOR, DIM_FRACTION, AT(SceneMeasured, residue), .length = 2, WITHIN(0, 1),
     .doc = "share of the mass that remains, min and max"},
};
static const Schema schema_measured = {
    .title = "what is measured",
    .size = sizeof(SceneMeasured),
    ROWS(measured_rows),
    .defaults = default_measured,
    .doc = "Published measurements of the material's fire, for `singe bench front`. They do not affect the "
           "simulation. 0 and 0: unknown."};

static const SchemaRow look_rows[] = {
    {"weave", ROW_FLOAT, DIM_LENGTH, AT(SceneMaterial, look.weave), WITHIN(0, 0.1),
     .doc = "distance between the threads of cloth, along u and along v; 0: paper"},
    {"coating", ROW_FLOAT, DIM_NONE, AT(SceneMaterial, look.coating), WITHIN(0, 1),
     .doc = "gloss of a coating, which blisters before the paper chars; 0: bare paper; 0.3: card; 1: a photo print"},
};
static const Schema schema_look = {.title = "a look",
                                   .size = sizeof(SceneMaterial),
                                   ROWS(look_rows),
                                   .doc = "How a material looks in pictures. It does not affect the simulation."};

static const SchemaRow material_rows[] = {
    {"base", ROW_BASE, DIM_NONE, .offset = 0, .flags = ROW_SHORT,
     .doc = "the material that the other keys change: a built-in one, or a file of the same keys "
            "([materials.md](materials.md))"},
    {"name", ROW_TEXT, DIM_NONE, AT(SceneMaterial, name), .doc = "for messages; that of `base` by default"},
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    PARAM(#name, name, dimension, text, range),
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) \
    {#name, ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_##name, .doc = text},
#define OF SceneMaterial
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) \
    AS_ROW_AT(#name, TYPE, def.name, 1, dimension, ALWAYS, text, range)
#include "singe/material.def"
    {"measured", ROW_MAP, DIM_NONE, AT(SceneMaterial, measured), EXTRA(SceneMaterial, measured.given),
     .sub = &schema_measured, .doc = "published measurements of its fire"},
    {"look", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_look, .doc = "what pictures show of it"},
};
const Schema schema_material = {
    .title = "a material",
    .size = sizeof(SceneMaterial),
    ROWS(material_rows),
    .choice = "base",
    .finish = finish_material,
    .doc = "What a sheet is made of and how it burns. `material: newsprint` takes one as it is, `material: {base: "
           "newsprint, thickness: 2 mm}` changes it; the defaults are those of office-paper, 80 g/m2 at its real pace. "
           "Mass is always a fraction of the mass at the start. A value marked *varies* may also follow a texture, an "
           "attribute, a noise or keys over time (see *Values that vary*)."};

static bool param_in(const Schema *schema, const char *prefix, int *index, SceneParam *param) {
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        char inner[32];
        snprintf(inner, sizeof inner, "%s.", row->key);
        if (row->type == ROW_MAP && param_in(row->sub, inner, index, param)) return true;
        if (row->type != ROW_PARAM || (*index)--) continue;

        snprintf(param->key, sizeof param->key, "%s%s", prefix, row->key);
        param->offset = row->offset - offsetof(SceneMaterial, def);
        param->slot = (row->extra - offsetof(SceneMaterial, followed)) / sizeof(SceneFollowed);
        return true;
    }

    return false;
}

bool scene_param_lasts(const char *key) {
    static const char *const lasting[] = {"grammage", "specific_heat", "thickness", "temperature", "moisture"};
    for (size_t i = 0; i < sizeof lasting / sizeof *lasting; i++)
        if (strcmp(key, lasting[i]) == 0) return true;
    return false;
}

bool scene_param(int index, SceneParam *param) { return param_in(&schema_material, "", &index, param); }

bool scene_material_same(const SceneMaterial *a, const SceneMaterial *b) {
    SceneMaterial one = *a, two = *b;
    SceneParam which;
    for (int i = 0; scene_param(i, &which); i++) {
        SingeParam *p = scene_param_at(&one.def, &which), *q = scene_param_at(&two.def, &which);
        if (p->field && q->field && memcmp(p->field, q->field, sizeof *p->field) == 0) q->field = p->field;
    }
    return memcmp(&one, &two, sizeof one) == 0;
}
