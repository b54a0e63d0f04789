// A material: values that may vary over the sheet, and what sources say of its fire.
#include "scene/schema_rows.h"

#include <stdio.h>

static const char *const operator_names[] = {
    [SINGE_HEAT_SURFACE] = "surface", [SINGE_HEAT_UMBRELLA] = "umbrella", NULL};

static const SchemaRow noise_rows[] = {
    {"scale", ROW_FLOAT, DIM_LENGTH, AT(SingeNoise, scale), WITHIN(1e-6, 1e6), .doc = "size of the largest features"},
    {"octaves", ROW_INT, DIM_NONE, AT(SingeNoise, octaves), WITHIN(1, 8),
     .doc = "layers of detail, each half the size and half the strength of the one before"},
    {"seed", ROW_UINT32, DIM_NONE, AT(SingeNoise, seed), .doc = "another seed, another noise"},
};
const Schema schema_noise = {
    .title = "a noise", .size = sizeof(SingeNoise), ROWS(noise_rows), .defaults = default_noise,
    .doc = "A random field from 0 to 1, smooth at its scale, fixed to the sheet."};

// A value that may vary over the sheet; its picture's place follows from the member.
#define PARAM(name, member, dim, range_, text)                                                                         \
    {name, ROW_PARAM, dim, AT(SceneMaterial, def.member), EXTRA(SceneMaterial, textures[SCENE_PARAM_SLOT(member)]),    \
     range_, .doc = text}
static const SchemaRow weight_rows[] = {
    PARAM("red", weight[SINGE_RED], DIM_FRACTION, WITHIN(0, 1), "centre to corner: thickness"),
    PARAM("green", weight[SINGE_GREEN], DIM_FRACTION, WITHIN(0, 1), "centre to centre: stretch of the back layer"),
    PARAM("blue", weight[SINGE_BLUE], DIM_FRACTION, WITHIN(0, 1), "mesh edges: stretch of the front layer"),
    PARAM("yellow", weight[SINGE_YELLOW], DIM_FRACTION, WITHIN(0, 1), "diagonals: shear"),
};
static const Schema schema_weight = {
    .title = "weights", .size = sizeof(SceneMaterial), ROWS(weight_rows),
    .doc = "Weight of the springs' constraints, W of eq 19, by colour of spring: 1 is full, smaller is softer."};

static const SchemaRow compliance_rows[] = {
    PARAM("red", compliance[SINGE_RED], DIM_COMPLIANCE, FROM(0), "centre to corner: thickness, shear across it"),
    PARAM("green", compliance[SINGE_GREEN], DIM_COMPLIANCE, FROM(0),
          "centre to centre: bending; the stiffness is thickness^2/compliance, in N m"),
    PARAM("blue", compliance[SINGE_BLUE], DIM_COMPLIANCE, FROM(0),
          "mesh edges: stretch; the stiffness is 1/compliance. Above 0 the sheet has no attachments"),
    PARAM("yellow", compliance[SINGE_YELLOW], DIM_COMPLIANCE, FROM(0),
          "diagonals: shear; the stiffness is 1/compliance"),
};
static const Schema schema_compliance = {
    .title = "compliances", .size = sizeof(SceneMaterial), ROWS(compliance_rows),
    .doc = "Elongation of a spring per force, by colour of spring; 0 is rigid. What it means for a sheet, and "
           "the substeps that stiff sheets need: [equations.md](equations.md#stiffness)."};

#define NUMBER(name, member, dim, range_, text)                                                                        \
    { name, ROW_FLOAT, dim, AT(SceneMaterial, def.member), range_, .doc = text }
static const SchemaRow measured_rows[] = {
    {"calibrated", ROW_BOOL, DIM_NONE, AT(SceneMeasured, calibrated),
     .doc = "the material was made to agree with these; otherwise they are held against what it predicts"},
    {"speed", ROW_VECTOR, DIM_SPEED, AT(SceneMeasured, speed), .length = 2, WITHIN(0, 1e6),
     .doc = "of a front that runs level, from and to"},
    {"temperature", ROW_VECTOR, DIM_TEMPERATURE, AT(SceneMeasured, temperature), .length = 2, WITHIN(0, 1e4),
     .doc = "the hottest, from and to"},
    {"residue", ROW_VECTOR, DIM_FRACTION, AT(SceneMeasured, residue), .length = 2, WITHIN(0, 1),
     .doc = "share of the mass that is left, from and to"},
};
static const Schema schema_measured = {
    .title = "what is measured", .size = sizeof(SceneMeasured), ROWS(measured_rows),
    .defaults = default_measured,
    .doc = "What sources say of the material's fire, for `singe bench front`; nothing is computed from it. 0 and 0 "
           "where they say nothing."};

static const SchemaRow material_rows[] = {
    {"base", ROW_BASE, DIM_NONE, .offset = 0, .flags = ROW_SHORT,
     .doc = "the material that it begins as, and which the other keys change: one that is built in, or a file of the "
            "same keys ([materials.md](materials.md))"},
    {"name", ROW_TEXT, DIM_NONE, AT(SceneMaterial, name), .doc = "for messages; that of `base` by default"},
    PARAM("grammage", grammage, DIM_GRAMMAGE, WITHIN(1e-6, 1e6), "mass per area before it burns"),
    {"reference_grammage", ROW_FLOAT, DIM_GRAMMAGE, AT(SceneMaterial, def.reference_grammage), WITHIN(0, 1e6),
     .doc = "`diffusivity`, `layer_exchange`, `mass_rate` and `char_rate` are given for this mass per area; on a lighter "
            "sheet they are larger in proportion, and its fire faster. 0: they hold at any. One for the whole sheet"},
    PARAM("specific_heat", specific_heat, DIM_SPECIFIC_HEAT, WITHIN(1e-3, MUCH), "heat to warm a kilogram by a kelvin"),
    PARAM("thickness", thickness, DIM_LENGTH, WITHIN(1e-6, 100),
          "distance of the model's two layers; it sets the size of the wrinkles, and is larger than the real sheet's"),
    {"heat_operator", ROW_ENUM, DIM_NONE, AT(SceneMaterial, def.heat_operator), .names = operator_names,
     .doc = "`surface`: finite volumes in each layer; `umbrella`: the paper's eq 3"},
    PARAM("diffusivity", diffusivity, DIM_DIFFUSIVITY, FROM(0), "alpha of eq 2: how fast heat spreads in the sheet"),
    PARAM("layer_exchange", layer_exchange, DIM_RATE, FROM(0),
          "rate at which the two layers' temperatures even out (`surface` only)"),
    PARAM("convection", convection, DIM_CONDUCTANCE, FROM(0), "heat lost to still air, a side"),
    PARAM("emissivity", emissivity, DIM_FRACTION, WITHIN(0, 1), "share of a black body's radiation"),
    PARAM("loss_mass_floor", loss_mass_floor, DIM_FRACTION, OVER_UP_TO(0, 1),
          "heat losses divide by the mass that is left, but by no less than this share of it"),
    NUMBER("thickening", thickening, DIM_NONE, FROM(0),
           "widens the burning front this many times (1 or more) at the same speed, so that cells can hold it; 0: as "
           "little as the cells need; one number for the whole sheet"),
    PARAM("temperature", temperature, DIM_TEMPERATURE, KELVIN, "at the start"),
    PARAM("ignition_temperature", ignition_temperature, DIM_TEMPERATURE, OVER(0), "above it the sheet burns"),
    PARAM("heat_of_combustion", heat_of_combustion, DIM_SPECIFIC_ENERGY, FROM(0),
          "heat that a kilogram gives as it burns"),
    PARAM("heat_share", heat_share, DIM_FRACTION, WITHIN(0, 1),
          "share of it that stays in the sheet; the rest goes up in the flame. eta of eq 1, the warming when all of "
          "the mass burns with no losses, is heat_share heat_of_combustion/specific_heat"),
    PARAM("mass_rate", mass_rate, DIM_RATE_PER_KELVIN, FROM(0),
          "mu of eq 4: mass lost per second and kelvin above ignition"),
    PARAM("rate_ceiling", rate_ceiling, DIM_TEMPERATURE_DIFFERENCE, OVER_OR_INF(0),
          "kelvins above ignition where the rate of burning stops growing, for want of air; inf is the paper"),
    PARAM("pre_exponential", pre_exponential, DIM_RATE, FROM(0),
          "A: above 0 the mass falls by Arrhenius' kinetics in place of `mass_rate`: what can still burn by "
          "A exp(-E/(R T)) a second, to the order `ash_exponent`, from `ignition_temperature` on"),
    PARAM("activation_energy", activation_energy, DIM_MOLAR_ENERGY, FROM(0), "E of these kinetics"),
    PARAM("ash_exponent", ash_exponent, DIM_NONE, FROM(0),
          "p: slows eq 4 near the end by ((m - m_min)/(1 - m_min))^p, so that flakes of ash stay; 0 is the paper"),
    PARAM("mass_min", mass_min, DIM_FRACTION, BELOW(0, 1), "m_min: share that never burns"),
    PARAM("mass_loss", mass_loss, DIM_FRACTION, BELOW(0, 1),
          "m_loss: below this share the sheet is gone; under mass_min it wrinkles but stays whole"),
    PARAM("ash_density", ash_density, DIM_FRACTION, OVER(0),
          "density at mass_min over the density at the start; with mass_min it sets the shrinkage, eq 5"),
    PARAM("char_yield", char_yield, DIM_FRACTION, BELOW(0, 1),
          "share that pyrolysis leaves as char, black and weak, which then glows away to grey ash, mass_min, where it is "
          "hot and air comes to it. At mass_min or below there is no char: one reaction, the paper's eq 4"),
    PARAM("char_density", char_density, DIM_FRACTION, OVER(0), "density of char over the density at the start"),
    PARAM("char_heat", char_heat, DIM_SPECIFIC_ENERGY, FROM(0),
          "heat that a kilogram of char gives as it glows away to CO2, all of it in the sheet; hot embers make CO and give less"),
    PARAM("char_rate", char_rate, DIM_RATE, FROM(0),
          "share of hot char that the air at an edge burns in a second; noise makes embers die here and live there"),
    PARAM("char_air", char_air, DIM_FRACTION, WITHIN(0, 1),
          "share of `char_rate` within a leaf of char, away from edges and ash: less, and embers keep to edges"),
    PARAM("shrink_front", shrink_front, DIM_FRACTION, WITHIN(0, 2),
          "share of the shrinkage that the front layer takes (the side that a grid turns up)"),
    PARAM("shrink_back", shrink_back, DIM_FRACTION, WITHIN(0, 2),
          "the same for the back layer; 5 to 10 % of difference curls the sheet, towards the side that shrinks more"),
    PARAM("fibre_angle", fibre_angle, DIM_ANGLE, TURN,
          "direction of the fibres: from that of growing u (along x on a grid) towards growing v; without uv from the "
          "first side of each cell"),
    PARAM("fibre_shrink", fibre_shrink, DIM_NONE, WITHIN(0.1, 10),
          "shrinkage across the fibres over that along them; 1: the same in all directions"),
    {"ablate", ROW_BOOL, DIM_NONE, AT(SceneMaterial, def.ablate), .doc = "no: nothing is removed (Fig 4 b)"},
    {"weight", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_weight, .doc = "weight by colour of spring"},
    {"compliance", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_compliance, .doc = "compliance by colour of spring"},
    PARAM("char_weight", char_weight, DIM_FRACTION, WITHIN(0, 1), "factor on the weight of what is burnt to mass_min"),
    PARAM("drag", drag, DIM_NONE, FROM(0), "coefficient of the air's drag, quadratic in the speed along the normal"),
    PARAM("damping", damping, DIM_RATE, FROM(0), "of all motion"),
    PARAM("crease_radius", crease_radius, DIM_LENGTH, FROM(0),
          "with `creases`: of what is bent sharper than this a part stays; 0: never. It is the model's, which is ten "
          "times as thick as the real sheet"),
    PARAM("crease_share", crease_share, DIM_FRACTION, WITHIN(0, 1),
          "how much of the bend beyond that stays; char keeps less, ash nothing"),
    PARAM("curvature_max", curvature_max, DIM_CURVATURE, FROM(0),
          "sharpest bend beyond the rest shape that unburnt mesh takes (solver `strand`); 0: any. Thin sheets that "
          "shrink fold along rows of cells without it"),
    PARAM("strength", strength, DIM_STIFFNESS, OVER_OR_INF(0),
          "line force at which the sheet tears before it burns; a texture may scale it: perforations, folds. The "
          "model's own, far below real paper's ([equations.md](equations.md#tearing))"),
    PARAM("char_strength", char_strength, DIM_STIFFNESS, OVER(0),
          "the same of char, and without char of what is burnt to mass_min; geometric between the two. Ash has a "
          "twentieth of it"),
    {"measured", ROW_MAP, DIM_NONE, AT(SceneMaterial, measured), EXTRA(SceneMaterial, measured.given),
     .sub = &schema_measured, .doc = "what sources say of its fire"},
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
           "attribute or a noise (see *Values that vary*)."};

static bool param_in(const Schema *schema, const char *prefix, int *index, SceneParam *param) {
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        char inner[32];
        snprintf(inner, sizeof inner, "%s.", row->key);
        if (row->type == ROW_MAP && param_in(row->sub, inner, index, param))
            return true;
        if (row->type != ROW_PARAM || (*index)--)
            continue;
        snprintf(param->key, sizeof param->key, "%s%s", prefix, row->key);
        param->offset = row->offset - offsetof(SceneMaterial, def);
        param->slot = (row->extra - offsetof(SceneMaterial, textures)) / sizeof(SceneFile);
        return true;
    }
    return false;
}

bool scene_param(int index, SceneParam *param) { return param_in(&schema_material, "", &index, param); }
