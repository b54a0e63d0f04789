#include "scene/schema.h"

#include <math.h>
#include <string.h>

#define AT(type, member) .offset = offsetof(type, member)
#define EXTRA(type, member) .extra = offsetof(type, member)
#define DEGREE (3.14159265358979323846 / 180)
#define ROWS(table) .rows = (table), .row_count = (int)(sizeof(table) / sizeof *(table))

// ranges, in held units, never wider than what the library takes (tests/scene/test_ranges.c)
#define MUCH 1e9
#define ANY .min = -1e6, .max = 1e6
#define TURN .min = -1e6 * DEGREE, .max = 1e6 * DEGREE
#define KELVIN .min = 1, .max = 1e4
#define OVER(low) .flags = ROW_OPEN_MIN, .min = (low), .max = MUCH
#define FROM(low) .min = (low), .max = MUCH
#define OVER_OR_INF(low) .flags = ROW_OPEN_MIN | ROW_INF, .min = (low), .max = MUCH
#define OVER_UP_TO(low, high) .flags = ROW_OPEN_MIN, .min = (low), .max = (high)
#define WITHIN(low, high) .min = (low), .max = (high)
#define BELOW(low, high) .flags = ROW_OPEN_MAX, .min = (low), .max = (high)

static const char *const operator_names[] = {
    [SINGE_HEAT_SURFACE] = "surface", [SINGE_HEAT_UMBRELLA] = "umbrella", NULL};
static const char *const source_names[] = {
    [SINGE_SOURCE_BALL] = "ball", [SINGE_SOURCE_PICTURE] = "picture", [SINGE_SOURCE_SPOT] = "spot",
    NULL};
static const char *const method_names[] = {
    [SINGE_SOLVER_STRAND] = "strand", [SINGE_SOLVER_PAPER] = "paper", [SINGE_SOLVER_PAPER_LITERAL] = "paper-literal",
    [SINGE_SOLVER_ALL_AT_ONCE] = "all-at-once", [SINGE_SOLVER_MASS_SPRING] = "mass-spring", NULL};
static const char *const sky_names[] = {
    [PREVIEW_SKY_EVEN] = "even", [PREVIEW_SKY_STUDIO] = "studio", [PREVIEW_SKY_OPEN] = "open", NULL};
static const char *const ground_names[] = {
    [PREVIEW_GROUND_WOOD] = "wood", [PREVIEW_GROUND_STONE] = "stone", [PREVIEW_GROUND_PLAIN] = "plain", NULL};
static const char *const units_names[] = {
    [SCENE_UNITS_M] = "m", [SCENE_UNITS_CM] = "cm", [SCENE_UNITS_MM] = "mm", [SCENE_UNITS_IN] = "in",
    [SCENE_UNITS_FT] = "ft", NULL};
static const char *const up_names[] = {[SCENE_UP_Z] = "z", [SCENE_UP_Y] = "y", NULL};
static const char *const quads_names[] = {[MESH_QUADS_PAIR] = "pair", [MESH_QUADS_SPLIT] = "split", NULL};
static const char *const collider_names[] = {
    [SINGE_COLLIDER_PLANE] = "plane", [SINGE_COLLIDER_SPHERE] = "sphere", [SINGE_COLLIDER_BOX] = "box",
    [SINGE_COLLIDER_CAPSULE] = "capsule", [SINGE_COLLIDER_HEIGHTFIELD] = "heightfield", [SINGE_COLLIDER_MESH] = "mesh",
    NULL};
static const char *const sides_names[] = {[SINGE_SIDES_TOUCHING] = "touching", [SINGE_SIDES_BOTH] = "both", NULL};

enum {
    BALL = 1 << SINGE_SOURCE_BALL, PICTURE = 1 << SINGE_SOURCE_PICTURE,
    SPOT = 1 << SINGE_SOURCE_SPOT,
    PLANE = 1 << SINGE_COLLIDER_PLANE, SPHERE = 1 << SINGE_COLLIDER_SPHERE,
    BOX = 1 << SINGE_COLLIDER_BOX, CAPSULE = 1 << SINGE_COLLIDER_CAPSULE,
    HEIGHTFIELD = 1 << SINGE_COLLIDER_HEIGHTFIELD, MESH = 1 << SINGE_COLLIDER_MESH,
    DRAWN = SPHERE | BOX | CAPSULE | HEIGHTFIELD | MESH,
};

// ---- parts that several objects share

static const SchemaRow key_rows[] = {
    {"time", ROW_FLOAT, DIM_TIME, AT(SceneKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED, .doc = "when"},
    {"position", ROW_VECTOR, DIM_LENGTH, AT(SceneKey, position), .length = 3, ANY, .doc = "where"},
    {"rotation", ROW_VECTOR, DIM_ANGLE, AT(SceneKey, rotation), .length = 3, TURN,
     .doc = "turned about the x axis, then y, then z, all fixed in the world"},
};
static const Schema schema_key = {
    .title = "a path's entry", .size = sizeof(SceneKey), ROWS(key_rows),
    .doc = "Where something is at a time. Positions move in straight lines from entry to entry and rest before the "
           "first and after the last; times must increase."};

static const SchemaRow strength_rows[] = {
    {"time", ROW_FLOAT, DIM_TIME, AT(SingeValueKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED, .doc = "when"},
    {"value", ROW_FLOAT, DIM_FRACTION, AT(SingeValueKey, value), .min = 0, .max = 1e6, .flags = ROW_REQUIRED,
     .doc = "how strong, 1 being the full flux"},
};
static const Schema schema_strength = {
    .title = "a strength's entry", .size = sizeof(SingeValueKey), ROWS(strength_rows),
    .doc = "How strong a picture source is at a time; straight lines in between. Times must increase."};

static const SchemaRow noise_rows[] = {
    {"scale", ROW_FLOAT, DIM_LENGTH, AT(SingeNoise, scale), WITHIN(1e-6, 1e6), .doc = "size of the largest features"},
    {"octaves", ROW_INT, DIM_NONE, AT(SingeNoise, octaves), WITHIN(1, 8),
     .doc = "layers of detail, each half the size and half the strength of the one before"},
    {"seed", ROW_UINT32, DIM_NONE, AT(SingeNoise, seed), .doc = "another seed, another noise"},
};
const Schema schema_noise = {
    .title = "a noise", .size = sizeof(SingeNoise), ROWS(noise_rows), .defaults = default_noise,
    .doc = "A random field from 0 to 1, smooth at its scale, fixed to the sheet."};

// ---- sheets

static const SchemaRow grid_rows[] = {
    {"size", ROW_VECTOR, DIM_LENGTH, AT(SceneGrid, size), .length = 2, WITHIN(1e-6, 1e4),
     .flags = ROW_REQUIRED, .doc = "along x and y"},
    {"cells", ROW_INTS, DIM_NONE, AT(SceneGrid, cells), .length = 2, .flags = ROW_REQUIRED, WITHIN(1, 20000),
     .doc = "how many cells along x and y"},
    {"jitter", ROW_FLOAT, DIM_FRACTION, AT(SceneGrid, wear.jitter), WITHIN(0, 0.3),
     .doc = "how far vertices lie off the grid, of a cell: folds and fronts then find no lines to follow; 0 is regular"},
    {"relief", ROW_FLOAT, DIM_LENGTH, AT(SceneGrid, wear.relief), WITHIN(0, 1e3),
     .doc = "root mean square height of the smooth waves in which the sheet lies from the start; 0 is flat"},
    {"seed", ROW_UINT32, DIM_NONE, AT(SceneGrid, wear.seed), .doc = "another seed, another sheet"},
};
static const Schema schema_grid = {
    .title = "a grid", .size = sizeof(SceneGrid), ROWS(grid_rows), .defaults = default_grid,
    .doc = "A rectangle around the origin in the x-y plane, facing up (+z)."};

// A value that may vary over the sheet; its picture's place follows from the member.
#define PARAM(name, member, dim, range_, text)                                                                         \
    {name, ROW_PARAM, dim, AT(SceneMaterial, def.member), EXTRA(SceneMaterial, pictures[SCENE_PARAM_SLOT(member)]),    \
     range_, .doc = text}
static const SchemaRow weight_rows[] = {
    PARAM("red", weight[SINGE_RED], DIM_FRACTION, WITHIN(0, 1), "centre to corner: thickness"),
    PARAM("green", weight[SINGE_GREEN], DIM_FRACTION, WITHIN(0, 1), "centre to centre: stretch of the back layer"),
    PARAM("blue", weight[SINGE_BLUE], DIM_FRACTION, WITHIN(0, 1), "mesh edges: stretch of the front layer"),
    PARAM("yellow", weight[SINGE_YELLOW], DIM_FRACTION, WITHIN(0, 1), "diagonals: shear"),
};
static const Schema schema_weight = {
    .title = "weights", .size = sizeof(SceneMaterial), ROWS(weight_rows),
    .doc = "How firmly springs are held to their length, W of eq 19, by colour of spring: 1 is full, small is soft."};

#define COLOUR_ROW(name, colour, text, dim, ...) \
    {name, ROW_FLOAT, dim, .offset = (colour) * sizeof(float), __VA_ARGS__, .doc = text}
#define PER_COLOUR(dim, ...)                                                \
    COLOUR_ROW("red", SINGE_RED, "centre to corner", dim, __VA_ARGS__),     \
    COLOUR_ROW("green", SINGE_GREEN, "centre to centre", dim, __VA_ARGS__), \
    COLOUR_ROW("blue", SINGE_BLUE, "mesh edges", dim, __VA_ARGS__),         \
    COLOUR_ROW("yellow", SINGE_YELLOW, "diagonals", dim, __VA_ARGS__)
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
    .doc = "How far a spring gives under a force, by colour of spring; 0 is unyielding. What that is for a sheet, and "
           "the substeps that firm sheets need: [equations.md](equations.md#firmness)."};
static const SchemaRow regularisation_rows[] = {PER_COLOUR(DIM_NONE, WITHIN(1e-6, 1e6))};
static const Schema schema_regularisation = {
    .title = "regularisations", .size = 4 * sizeof(float), ROWS(regularisation_rows),
    .doc = "The numerical floor on the solver's diagonal, by colour of spring, relative to w_a + w_b = 2. It gives like "
           "a compliance that grows with the square of the substep; firmness is the material's `compliance`."};

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
     .doc = "`diffusivity`, `layer_exchange` and `mass_rate` are given for this mass per area; on a lighter sheet they "
            "are larger in proportion, and its fire faster. 0: they hold at any. One for the whole sheet"},
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
          "A: above 0 the mass falls by Arrhenius' kinetics in place of `mass_rate`: what can still burn by A exp(-E/(R T)) a "
          "second, to the order `ash_exponent`, from `ignition_temperature` on"),
    PARAM("activation_energy", activation_energy, DIM_MOLAR_ENERGY, FROM(0), "E of these kinetics"),
    PARAM("ash_exponent", ash_exponent, DIM_NONE, FROM(0),
          "p: slows eq 4 near the end by ((m - m_min)/(1 - m_min))^p, so that flakes of ash stay; 0 is the paper"),
    PARAM("mass_min", mass_min, DIM_FRACTION, BELOW(0, 1), "m_min: share that never burns"),
    PARAM("mass_loss", mass_loss, DIM_FRACTION, BELOW(0, 1),
          "m_loss: below this share the sheet is gone; under mass_min it wrinkles but stays whole"),
    PARAM("ash_density", ash_density, DIM_FRACTION, OVER(0),
          "density at mass_min over the density at the start; with mass_min it sets the shrinkage, eq 5"),
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
    {"weight", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_weight, .doc = "firmness by colour of spring"},
    {"compliance", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_compliance, .doc = "give by colour of spring"},
    PARAM("char_weight", char_weight, DIM_FRACTION, WITHIN(0, 1), "factor on the weight of what is burnt to mass_min"),
    PARAM("drag", drag, DIM_NONE, FROM(0), "coefficient of the air's drag, quadratic in the speed along the normal"),
    PARAM("damping", damping, DIM_RATE, FROM(0), "of all motion"),
    PARAM("crease_radius", crease_radius, DIM_LENGTH, FROM(0),
          "with `creases`: of what is bent sharper than this a part stays; 0: never. It is the model's, which is ten "
          "times as thick as the real sheet"),
    PARAM("crease_share", crease_share, DIM_FRACTION, WITHIN(0, 1),
          "how much of the bend beyond that stays; char keeps less, ash nothing"),
    PARAM("strength", strength, DIM_STIFFNESS, OVER_OR_INF(0),
          "line force at which the sheet tears before it burns; a picture may scale it: perforations, folds. The "
          "model's own, far below real paper's ([equations.md](equations.md#tearing))"),
    PARAM("char_strength", char_strength, DIM_STIFFNESS, OVER(0),
          "the same of what is burnt to mass_min; geometric between the two in burn progress"),
    {"measured", ROW_MAP, DIM_NONE, AT(SceneMaterial, measured), EXTRA(SceneMaterial, measured.given),
     .sub = &schema_measured, .doc = "what sources say of its fire"},
};
const Schema schema_material = {
    .title = "a material",
    .size = sizeof(SceneMaterial),
    ROWS(material_rows),
    .choice = "base",
    .finish = finish_material,
    .doc =
        "What a sheet is made of and how it burns. `material: newsprint` takes one as it is, `material: {base: "
        "newsprint, thickness: 2 mm}` changes it; the defaults are those of office-paper, 80 g/m2 at its real pace. Mass is "
        "always a fraction of the mass at the start. A value marked *varies* may also follow a picture, an attribute "
        "or a noise (see *Values that vary*)."};

static ScenePlace *sheet_place(void *object) { return &((SceneSheet *)object)->place; }
static const SchemaRow sheet_rows[] = {
    {"name", ROW_NAME, DIM_NONE, AT(SceneSheet, name),
     .doc = "for pins and messages; `sheet1`, `sheet2`, ... by default"},
    {"mesh", ROW_FILE, DIM_NONE, AT(SceneSheet, mesh), .doc = "a file of triangles, quads or polygons: OBJ, PLY, or what assimp reads ([meshes.md](meshes.md)); this or "
            "`grid`"},
    {"grid", ROW_MAP, DIM_NONE, AT(SceneSheet, grid), EXTRA(SceneSheet, grid.given), .sub = &schema_grid,
     .doc = "a rectangle made by the program"},
    {"picture", ROW_FILE, DIM_NONE, AT(SceneSheet, picture),
     .doc = "PNG or JPEG, printed on both sides in the preview"},
    {"colour", ROW_VECTOR, DIM_FRACTION, AT(SceneSheet, colour), .length = 3, WITHIN(0, 1),
     .doc = "linear red, green, blue; tints the picture"},
    {"scale", ROW_FLOAT, DIM_NONE, AT(SceneSheet, scale), WITHIN(1e-6, 1e4),
     .doc = "times `units`: how large the mesh file is made"},
    {"units", ROW_ENUM, DIM_NONE, AT(SceneSheet, units), .names = units_names,
     .doc = "what a number in the mesh file is; `ft` is a foot"},
    {"up", ROW_ENUM, DIM_NONE, AT(SceneSheet, up), .names = up_names,
     .doc = "the mesh file's axis that points up; a file whose y is up is turned by 90 degrees about x"},
    {"weld", ROW_FLOAT, DIM_LENGTH, AT(SceneSheet, weld), FROM(0),
     .doc = "vertices on open edges of the mesh that are this near are one, whatever their uv; 0: 1/100000 of its size"},
    {"quads", ROW_ENUM, DIM_NONE, AT(SceneSheet, quads), .names = quads_names,
     .doc = "what becomes of triangles and polygons: `pair` joins triangles two by two; `split` makes n quads of every "
            "face of n corners, with sides half as long"},
    {"rotate", ROW_VECTOR, DIM_ANGLE, AT(SceneSheet, rotate), .length = 3, TURN,
     .doc = "about x, then y, then z, after the scaling and `up`"},
    {"translate", ROW_VECTOR, DIM_LENGTH, AT(SceneSheet, translate), .length = 3, WITHIN(-9000, 9000),
     .doc = "after the rotation; a sheet must lie within 10 km of the origin"},
    {"velocity", ROW_VECTOR, DIM_SPEED, AT(SceneSheet, velocity), .length = 3, ANY, .doc = "at the start"},
    {"drop_pieces_below", ROW_FLOAT, DIM_AREA, AT(SceneSheet, drop_pieces_below), FROM(0),
     .doc = "loose pieces smaller than this vanish; 0 keeps all"},
    {"material", ROW_MAP, DIM_NONE, AT(SceneSheet, material), .sub = &schema_material, .doc = "what it is made of"},
};
static const Schema schema_sheet = {
    .title = "a sheet", .size = sizeof(SceneSheet), ROWS(sheet_rows), .defaults = default_sheet, .finish = finish_sheet,
    .place = sheet_place, .doc = "A piece of cloth or paper: a mesh, or a grid, and a material."};

// ---- sources, colliders, pins

static ScenePlace *source_place(void *object) { return &((SceneSource *)object)->place; }
#define SOURCE(name, member, dim, kinds_, range_, text) \
    {name, ROW_FLOAT, dim, AT(SceneSource, def.member), .kinds = (kinds_), range_, .doc = text}
static const SchemaRow source_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(SceneSource, def.kind), .names = source_names, .flags = ROW_REQUIRED,
     .doc =
         "`ball`: a hot ball on a path; `spot`: a hot ball that stands still; `picture`: a flux drawn on the sheet"},
    SOURCE("start", start, DIM_TIME, 0, FROM(0), "it heats from here"),
    {"end", ROW_FLOAT, DIM_TIME, AT(SceneSource, def.end), .flags = ROW_INF, FROM(0),
     .doc = "to here; `inf` is for ever"},
    SOURCE("temperature", temperature, DIM_TEMPERATURE, BALL | SPOT, KELVIN, "of the ball or the flame"),
    SOURCE("conductance", conductance, DIM_CONDUCTANCE, BALL | SPOT, FROM(0), "how well its heat reaches the sheet"),
    SOURCE("radius", radius, DIM_LENGTH, BALL | SPOT, FROM(0), "full heat within it"),
    SOURCE("falloff", falloff, DIM_LENGTH, BALL | SPOT, FROM(0),
           "beyond the radius, over which the heat falls to nothing"),
    {"position", ROW_POSITION, DIM_LENGTH, AT(SceneSource, keys), EXTRA(SceneSource, key_count), .length = 3,
     .kinds = SPOT, .flags = ROW_REQUIRED, ANY, .doc = "its centre"},
    {"position", ROW_POSITION, DIM_LENGTH, AT(SceneSource, keys), EXTRA(SceneSource, key_count), .length = 3,
     .kinds = BALL, .flags = ROW_SHORT, ANY, .doc = "its centre, when it does not move; this or `path`"},
    {"path", ROW_LIST, DIM_NONE, AT(SceneSource, keys), EXTRA(SceneSource, key_count), .kinds = BALL,
     .sub = &schema_key, .doc = "its way; this or `position`"},
    {"picture", ROW_FILE, DIM_NONE, AT(SceneSource, picture), .kinds = PICTURE, .flags = ROW_REQUIRED,
     .doc = "PNG or JPEG over the sheets' uv: white is the full flux, black none"},
    SOURCE("flux", flux, DIM_FLUX, PICTURE, FROM(0), "into each of the sheet's two layers where the picture is white"),
    {"strength", ROW_STRENGTH, DIM_FRACTION, AT(SceneSource, strength), EXTRA(SceneSource, strength_count),
     .kinds = PICTURE, .min = 0, .max = 1e6, .sub = &schema_strength,
     .doc = "multiplies the flux over time; 1 when not given"},
    {"visible", ROW_BOOL, DIM_NONE, AT(SceneSource, visible), .kinds = BALL, .doc = "drawn in the preview"},
};
static const Schema schema_source = {
    .title = "a source", .size = sizeof(SceneSource), ROWS(source_rows), .kind_offset = offsetof(SceneSource, def.kind),
    .defaults = default_source, .finish = finish_source, .place = source_place,
    .doc = "Something that heats the sheets. Its `kind` decides which other keys it has."};

static ScenePlace *collider_place(void *object) { return &((SceneCollider *)object)->place; }
#define COLLIDER(name, member, dim, kinds_, range_, text) \
    {name, ROW_FLOAT, dim, AT(SceneCollider, def.member), .kinds = (kinds_), range_, .doc = text}
static const SchemaRow collider_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(SceneCollider, def.kind), .names = collider_names, .flags = ROW_REQUIRED,
     .doc = "`plane` (its normal is its own z axis), `sphere`, `box`, `capsule` (along its own z axis), `heightfield` "
            "(solid below heights over a rectangle of its own x-y plane) or `mesh` (what a closed mesh encloses)"},
    COLLIDER("radius", radius, DIM_LENGTH, SPHERE | CAPSULE, WITHIN(1e-6, 1e6), "of the sphere or the capsule"),
    {"half_size", ROW_VECTOR, DIM_LENGTH, AT(SceneCollider, def.half_size), .length = 3, .kinds = BOX,
     WITHIN(1e-6, 1e6), .doc = "half of the box's lengths along its own axes"},
    COLLIDER("height", height, DIM_LENGTH, CAPSULE, WITHIN(0, 1e6), "between the centres of the capsule's caps"),
    {"mesh", ROW_FILE, DIM_NONE, AT(SceneCollider, mesh), .kinds = MESH, .flags = ROW_REQUIRED,
     .doc = "a closed mesh of triangles or polygons: OBJ, PLY, or what assimp reads, whose faces turn counter-clockwise seen from outside and do not pass through "
            "each other; one that is inside out is turned"},
    {"scale", ROW_FLOAT, DIM_NONE, AT(SceneCollider, scale), .kinds = MESH, WITHIN(1e-6, 1e4),
     .doc = "times `units`: how large the mesh file is made"},
    {"units", ROW_ENUM, DIM_NONE, AT(SceneCollider, units), .kinds = MESH, .names = units_names,
     .doc = "what the numbers of the mesh file are: `m`, `cm`, `mm`, `in` or `ft`"},
    {"picture", ROW_FILE, DIM_NONE, AT(SceneCollider, picture), .kinds = HEIGHTFIELD, .flags = ROW_REQUIRED,
     .doc = "PNG or JPEG of the heights seen from above, x to the right and y up: a height at each pixel's middle, "
            "straight between"},
    {"size", ROW_VECTOR, DIM_LENGTH, AT(SceneCollider, def.size), .length = 2, .kinds = HEIGHTFIELD, WITHIN(1e-6, 1e4),
     .doc = "of the rectangle, from the first pixels' middles to the last's, along x and y"},
    {"heights", ROW_VECTOR, DIM_LENGTH, AT(SceneCollider, heights), .length = 2, .kinds = HEIGHTFIELD,
     WITHIN(-1e3, 1e3), .doc = "own z where the picture is black, and where it is white"},
    {"position", ROW_POSITION, DIM_LENGTH, AT(SceneCollider, keys), EXTRA(SceneCollider, key_count), .length = 3,
     .flags = ROW_SHORT, ANY, .doc = "of its centre, when it does not move; instead of `path`"},
    {"rotation", ROW_ROTATION, DIM_ANGLE, AT(SceneCollider, keys), EXTRA(SceneCollider, key_count), .length = 3,
     .flags = ROW_SHORT, TURN, .doc = "about x, then y, then z, when it does not move; instead of `path`"},
    {"path", ROW_LIST, DIM_NONE, AT(SceneCollider, keys), EXTRA(SceneCollider, key_count), .sub = &schema_key,
     .doc = "its way"},
    COLLIDER("friction", friction, DIM_NONE, 0, WITHIN(0, 1000), "Coulomb's coefficient"),
    COLLIDER("offset", offset, DIM_LENGTH, 0, WITHIN(0, 1000), "distance that sheets keep from the surface"),
    COLLIDER("temperature", temperature, DIM_TEMPERATURE, 0, KELVIN, "matters when `conductance` is not 0"),
    COLLIDER("conductance", conductance, DIM_CONDUCTANCE, 0, FROM(0), "heat exchanged in contact; 0 for none"),
    COLLIDER("contact_distance", contact_distance, DIM_LENGTH, 0, WITHIN(0, 1000), "how near counts as contact for heat"),
    {"sides", ROW_ENUM, DIM_NONE, AT(SceneCollider, def.sides), .names = sides_names,
     .doc = "of a sheet's two layers in contact, `touching`: that which faces the collider exchanges heat; `both`: the "
            "one behind it as well, as if heat were through the sheet at once"},
    {"colour", ROW_VECTOR, DIM_FRACTION, AT(SceneCollider, colour), .length = 3, .kinds = DRAWN,
     WITHIN(0, 1), .doc = "linear red, green, blue in the preview"},
    {"visible", ROW_BOOL, DIM_NONE, AT(SceneCollider, visible), .kinds = DRAWN,
     .doc = "drawn in the preview"},
};
static const Schema schema_collider = {
    .title = "a collider",
    .size = sizeof(SceneCollider),
    ROWS(collider_rows),
    .kind_offset = offsetof(SceneCollider, def.kind),
    .defaults = default_collider,
    .finish = finish_collider,
    .place = collider_place,
    .doc = "A rigid thing that sheets rest on and slide over. Its `kind` decides which keys it has."};

static ScenePlace *pin_place(void *object) { return &((ScenePin *)object)->place; }
static const SchemaRow pin_rows[] = {
    {"sheet", ROW_TEXT, DIM_NONE, AT(ScenePin, sheet),
     .doc = "name of the sheet, or its number from 0; the first by default"},
    {"points", ROW_POINTS, DIM_LENGTH, AT(ScenePin, points), EXTRA(ScenePin, point_count), .length = 3, ANY,
     .doc = "places [x, y, z] in the world at the start"},
    {"radius", ROW_FLOAT, DIM_LENGTH, AT(ScenePin, radius), WITHIN(0, 1e6),
     .doc = "what is this near to one of the points is held; 0 holds the nearest vertex of each"},
    {"vertices", ROW_INDICES, DIM_NONE, AT(ScenePin, vertices), EXTRA(ScenePin, vertex_count), WITHIN(0, 4294967294.0),
     .doc = "numbers of the mesh's vertices, from 0"},
    {"path", ROW_LIST, DIM_NONE, AT(ScenePin, keys), EXTRA(ScenePin, key_count), .sub = &schema_key,
     .doc = "how what is held moves, relative to the path's place at the start; held still without"},
};
static const Schema schema_pin = {
    .title = "a pin", .size = sizeof(ScenePin), ROWS(pin_rows), .defaults = default_pin, .finish = finish_pin,
    .place = pin_place, .doc = "Holds part of a sheet."};

// ---- wind, solver, gas, preview

static const SchemaRow wind_rows[] = {
    {"velocity", ROW_VECTOR, DIM_SPEED, AT(SingeWindDef, velocity), .length = 3, WITHIN(-1000, 1000),
     .doc = "mean of the air's motion"},
    {"gust", ROW_FLOAT, DIM_SPEED, AT(SingeWindDef, gust), WITHIN(0, 1000), .doc = "how strong gusts are"},
    {"gust_time", ROW_FLOAT, DIM_TIME, AT(SingeWindDef, gust_time), WITHIN(1e-6, 1e6), .doc = "how long a gust lasts"},
    {"gust_size", ROW_FLOAT, DIM_LENGTH, AT(SingeWindDef, gust_size), WITHIN(1e-6, 1e6), .doc = "how far a gust reaches"},
    {"seed", ROW_UINT32, DIM_NONE, AT(SingeWindDef, seed), .doc = "another seed, other gusts"},
};
static const Schema schema_wind = {
    .title = "the wind", .size = sizeof(SingeWindDef), ROWS(wind_rows), .doc = "The air's motion."};

static const SchemaRow solver_rows[] = {
    {"method", ROW_ENUM, DIM_NONE, AT(SingeSolverDef, method), .names = method_names,
     .doc = "strand after strand; successive fast projection as the paper has it, or to its letter, which may fail; all "
            "colours in one system; or Hooke's law. The defaults below are those of `strand`"},
    {"substeps", ROW_INT, DIM_NONE, AT(SingeSolverDef, substeps), WITHIN(0, 1000),
     .doc = "parts of a step; firm, thick sheets of small cells need more ([equations.md](equations.md#firmness)); 0: "
            "as many as these need, by their red compliance"},
    {"projections", ROW_INT, DIM_NONE, AT(SingeSolverDef, projections), WITHIN(1, 1000),
     .doc = "of all colours, a substep"},
    {"order", ROW_ORDER, DIM_NONE, AT(SingeSolverDef, order),
     .doc = "of the springs' colours, each once; the last is held best"},
    {"regularisation", ROW_MAP, DIM_NONE, AT(SingeSolverDef, regularisation), .sub = &schema_regularisation,
     .doc = "by colour of spring"},
    {"attachments", ROW_BOOL, DIM_NONE, AT(SingeSolverDef, attachments),
     .doc = "`strand`: keeps vertices within their distance along the sheet from what is pinned"},
    {"early_exit", ROW_BOOL, DIM_NONE, AT(SingeSolverDef, early_exit),
     .doc = "`paper`, `paper-literal`, `all-at-once`: stops where the error is below `tolerance` of the lengths"},
    {"tolerance", ROW_FLOAT, DIM_NONE, AT(SingeSolverDef, tolerance), WITHIN(1e-12, 1),
     .doc = "the same: of the conjugate gradients and the early exit"},
    {"stiffness", ROW_FLOAT, DIM_STIFFNESS, AT(SingeSolverDef, stiffness), WITHIN(1e-6, 1e9),
     .doc = "`mass-spring`: of every spring"},
    {"smoothing", ROW_FLOAT, DIM_RATE, AT(SingeSolverDef, smoothing), WITHIN(0, 1e6),
     .doc = "internal friction: rate at which second differences of velocity along strands are lost"},
    {"smoothing_length", ROW_FLOAT, DIM_LENGTH, AT(SingeSolverDef, smoothing_length), WITHIN(0, 1000),
     .doc = "distance of the places they are taken over, and over neighbours besides"},
    {"height_min", ROW_FLOAT, DIM_NONE, AT(SingeSolverDef, height_min), WITHIN(0, 1),
     .doc = "smallest height of a cell's centre over its corners, in thicknesses; 0 is off, and cells may be inverted"},
    {"height_gain", ROW_FLOAT, DIM_FRACTION, AT(SingeSolverDef, height_gain), WITHIN(0, 1),
     .doc = "share of a height's error that is mended in a substep"},
};
static const Schema schema_solver = {.title = "the solver",
                                     .size = sizeof(SingeSolverDef),
                                     ROWS(solver_rows),
                                     .choice = "method",
                                     .chosen = chosen_solver,
                                     .doc = "How springs are kept at their lengths. Only the name of a method will do: "
                                            "`solver: paper`. Keys that are not given suit the method "
                                            "([equations.md](equations.md#the-papers-solver))."};

static const SchemaRow gas_rows[] = {
    {"enabled", ROW_BOOL, DIM_NONE, AT(SingeGasDef, enabled), .doc = "no: sheets burn as in still air"},
    {"cell_size", ROW_FLOAT, DIM_LENGTH, AT(SingeGasDef, cell_size), WITHIN(0, 1),
     .doc = "side of a cell of its grid; 0: 8 mm for a sheet of A4, in proportion to others"},
    {"height", ROW_FLOAT, DIM_LENGTH, AT(SingeGasDef, height), WITHIN(0.01, 100),
     .doc = "room for it above the sheets as they start"},
    {"conductance", ROW_FLOAT, DIM_CONDUCTANCE, AT(SingeGasDef, conductance), FROM(0),
     .doc = "how well it heats each side of a sheet that is cooler; more makes fire climb faster"},
    {"radiated", ROW_FLOAT, DIM_FRACTION, AT(SingeGasDef, radiated), WITHIN(0, 0.95),
     .doc = "share of the flames' power that leaves as radiation"},
    {"soot", ROW_FLOAT, DIM_FRACTION, AT(SingeGasDef, soot), WITHIN(0, 1), .doc = "mass of smoke over the mass burnt"},
};
static const Schema schema_gas = {.title = "the gas",
                                  .size = sizeof(SingeGasDef),
                                  ROWS(gas_rows),
                                  .choice = "enabled",
                                  .doc = "What burns sends hot gas up. It heats what is above, lifts ash and flakes, "
                                         "and carries flame and smoke. `gas: no` is without."};

static const SchemaRow contact_rows[] = {
    {"enabled", ROW_BOOL, DIM_NONE, AT(SingeContactDef, enabled), .doc = "no: sheets pass through themselves"},
    {"thickness", ROW_FLOAT, DIM_LENGTH, AT(SingeContactDef, thickness), WITHIN(1e-6, 1),
     .doc = "distance that is kept between surfaces, and 2/5 of the smallest cell at most; not the material's "
            "thickness, which is that of the model"},
    {"friction", ROW_FLOAT, DIM_NONE, AT(SingeContactDef, friction), WITHIN(0, 1000), .doc = "Coulomb's coefficient"},
};
static const Schema schema_contact = {.title = "contact of sheets",
                                      .size = sizeof(SingeContactDef),
                                      ROWS(contact_rows),
                                      .choice = "enabled",
                                      .doc = "Sheets do not pass through themselves nor each other. `contact: no` is "
                                             "the paper, where they do. Colliders have a friction of their own."};

static const SchemaRow camera_rows[] = {
    {"eye", ROW_VECTOR, DIM_LENGTH, AT(PreviewCamera, eye), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "where it stands; with neither eye nor target it is placed so that the sheets fill the picture"},
    {"target", ROW_VECTOR, DIM_LENGTH, AT(PreviewCamera, target), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "what it looks at"},
    {"up", ROW_VECTOR, DIM_NONE, AT(PreviewCamera, up), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "which way is up in the picture"},
    {"fov", ROW_FLOAT, DIM_ANGLE, AT(PreviewCamera, fov), WITHIN(0.1 * DEGREE, 175 * DEGREE),
     .doc = "angle of view from bottom to top"},
    {"aperture", ROW_FLOAT, DIM_LENGTH, AT(PreviewCamera, aperture), WITHIN(0, 10),
     .doc = "diameter of the lens: the wider, the more blurs what is nearer or farther than the focus; 0: nothing does"},
    {"focus", ROW_FLOAT, DIM_LENGTH, AT(PreviewCamera, focus), WITHIN(0, 1e4),
     .doc = "distance that is sharp, along the line of sight; 0: the target's"},
};
static const Schema schema_camera = {.title = "the camera",
                                     .size = sizeof(PreviewCamera),
                                     ROWS(camera_rows),
                                     .finish = finish_camera,
                                     .doc = "From where the preview is drawn."};

static const SchemaRow light_rows[] = {
    {"direction", ROW_VECTOR, DIM_NONE, AT(ScenePreview, light_direction), .length = 3, ANY,
     .doc = "towards the light, any length"},
    {"angle", ROW_FLOAT, DIM_ANGLE, AT(ScenePreview, light_angle), WITHIN(0, 85 * DEGREE),
     .doc = "its apparent radius: larger is softer"},
    {"colour", ROW_VECTOR, DIM_NONE, AT(ScenePreview, light_colour), .length = 3, .min = 0, .max = 1e4,
     .doc = "linear red, green, blue; may exceed 1"},
};
static const Schema schema_light = {
    .title = "the light", .size = sizeof(ScenePreview), ROWS(light_rows), .doc = "One distant light."};

static const SchemaRow environment_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, environment), .names = sky_names,
     .doc = "`even`: the same from everywhere above; `studio`: a dim room with a tall window across from the light and a "
            "lamp; `open`: a clear day"},
    {"picture", ROW_FILE, DIM_NONE, AT(ScenePreview, environment_picture),
     .doc = "PNG or JPEG of all around, in place of a kind: twice as wide as high, its middle towards +y, its top up"},
    {"turn", ROW_FLOAT, DIM_ANGLE, AT(ScenePreview, environment_turn), WITHIN(-1000, 1000),
     .doc = "about the z axis, counted from above; kinds follow the light without it"},
};
static const Schema schema_environment = {
    .title = "the environment", .size = sizeof(ScenePreview), ROWS(environment_rows),
    .doc = "Where the light of `sky` comes from, and what shiny things mirror. It is scaled so that what faces up gets "
           "as much of it as from an even sky."};

static const SchemaRow ground_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, ground), .names = ground_names,
     .doc = "`wood`: planks along x; `stone`: a honed slab; `plain`: one colour"},
    {"height", ROW_FLOAT, DIM_LENGTH, AT(ScenePreview, ground_height), .flags = ROW_NONE, WITHIN(-1e4, 1e4),
     .doc = "its z; `none`: no ground is drawn"},
    {"colour", ROW_VECTOR, DIM_FRACTION, AT(ScenePreview, ground_colour), .length = 3, WITHIN(0, 1),
     .doc = "linear red, green, blue"},
};
static const Schema schema_ground = {
    .title = "the ground", .size = sizeof(ScenePreview), ROWS(ground_rows),
    .doc = "A floor that is drawn. To let sheets rest on it, add a plane to `colliders` as well."};

static const SchemaRow preview_rows[] = {
    {"size", ROW_INTS, DIM_NONE, AT(ScenePreview, size), .length = 2, WITHIN(16, 16384),
     .doc = "width and height in pixels, even numbers for video"},
    {"samples", ROW_INT, DIM_NONE, AT(ScenePreview, samples), WITHIN(1, 4096),
     .doc = "rays a pixel: more is smoother and slower"},
    {"camera", ROW_MAP, DIM_NONE, AT(ScenePreview, camera), .sub = &schema_camera, .doc = "from where"},
    {"light", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_light, .doc = "the one light"},
    {"sky", ROW_VECTOR, DIM_NONE, AT(ScenePreview, sky), .length = 3, .min = 0, .max = 1e4,
     .doc = "light from all around, linear red, green, blue"},
    {"environment", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_environment, .doc = "from where the sky's light comes"},
    {"ground", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_ground, .doc = "the floor"},
    {"background", ROW_VECTOR, DIM_NONE, AT(ScenePreview, background), .length = 3, .min = 0, .max = 1e4,
     .doc = "behind everything, linear red, green, blue"},
    {"exposure", ROW_FLOAT, DIM_NONE, AT(ScenePreview, exposure), WITHIN(1e-6, 1000), .doc = "multiplies all light"},
    {"shutter", ROW_FLOAT, DIM_FRACTION, AT(ScenePreview, shutter), WITHIN(0, 1),
     .doc = "share of a frame's time during which what moves leaves its trace: film has 0.5; 0: nothing blurs"},
};
static const Schema schema_preview = {
    .title = "the preview", .size = sizeof(ScenePreview), ROWS(preview_rows), .finish = finish_preview,
    .doc = "How frames are drawn. Nothing here changes the simulation."};

// ---- the scene

static const SchemaRow scene_rows[] = {
    {"name", ROW_NAME, DIM_NONE, AT(Scene, name),
     .doc = "of the outputs; the scene file's name without its ending by default"},
    {"frames", ROW_INT, DIM_NONE, AT(Scene, frames), WITHIN(1, 1000000),
     .doc = "how many to make; the first is the start, so that N frames span (N - 1)/fps"},
    {"fps", ROW_FLOAT, DIM_FRAME_RATE, AT(Scene, fps), .min = 1e-3, .max = 1e5, .doc = "frames a second"},
    {"steps", ROW_INT, DIM_NONE, AT(Scene, steps), WITHIN(1, 100000), .doc = "steps of the simulation a frame"},
    {"pace", ROW_FLOAT, DIM_NONE, AT(Scene, sim.pace), WITHIN(1e-6, 1e6),
     .doc = "seconds of fire per second of motion; 1 is real, 4 burns four times as fast"},
    {"seed", ROW_UINT64, DIM_NONE, AT(Scene, sim.seed), 
     .doc = "of ragged edges, and for the preview; noise and wind have seeds of their own"},
    {"ambient_temperature", ROW_FLOAT, DIM_TEMPERATURE, AT(Scene, sim.ambient_temperature), KELVIN,
     .doc = "of the air and all around"},
    {"gravity", ROW_VECTOR, DIM_ACCELERATION, AT(Scene, sim.gravity), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "z is up"},
    {"air_density", ROW_FLOAT, DIM_DENSITY, AT(Scene, sim.air_density), WITHIN(0, 1000), .doc = "for drag and wind"},
    {"heat_tolerance", ROW_FLOAT, DIM_NONE, AT(Scene, sim.heat_tolerance), WITHIN(1e-9, 1),
     .doc = "to which the heat equation is solved, relative; a step stops after 200 iterations and warns once"},
    {"detail", ROW_FLOAT, DIM_LENGTH, AT(Scene, sim.surface_detail), WITHIN(0, 1000),
     .doc = "how finely the drawn mesh is cut near the front: distance of the points that are asked what has burnt, a "
            "cell's side over 23 at least; 0: the cells' own corners and centres, as in the paper"},
    {"raggedness", ROW_FLOAT, DIM_LENGTH, AT(Scene, sim.surface_raggedness), WITHIN(0, 1000),
     .doc = "how far noise eats into burnt edges at most, and no farther than half a cell; acts with `detail` only"},
    {"sheets", ROW_LIST, DIM_NONE, AT(Scene, sheets), EXTRA(Scene, sheet_count), .sub = &schema_sheet,
     .flags = ROW_REQUIRED, .doc = "what burns, at least one"},
    {"sources", ROW_LIST, DIM_NONE, AT(Scene, sources), EXTRA(Scene, source_count), .sub = &schema_source,
     .doc = "what heats"},
    {"colliders", ROW_LIST, DIM_NONE, AT(Scene, colliders), EXTRA(Scene, collider_count), .sub = &schema_collider,
     .doc = "what is in the way"},
    {"pins", ROW_LIST, DIM_NONE, AT(Scene, pins), EXTRA(Scene, pin_count), .sub = &schema_pin, .doc = "what holds"},
    {"wind", ROW_MAP, DIM_NONE, AT(Scene, sim.wind), .sub = &schema_wind, .doc = "the air's motion"},
    {"solver", ROW_MAP, DIM_NONE, AT(Scene, sim.solver), .sub = &schema_solver,
     .doc = "how springs are kept at their lengths"},
    {"creases", ROW_BOOL, DIM_NONE, AT(Scene, sim.solver.creases),
     .doc = "yes: sharp bends stay, by the material's `crease_radius` and `crease_share` (solver `strand`); no: sheets "
            "spring back, as in the paper"},
    {"tearing", ROW_BOOL, DIM_NONE, AT(Scene, tearing),
     .doc = "sheets tear where they are pulled at with more than the material's `strength`; needs the method `strand`"},
    {"gas", ROW_MAP, DIM_NONE, AT(Scene, sim.gas), .sub = &schema_gas, .doc = "hot gas, flames and smoke"},
    {"contact", ROW_MAP, DIM_NONE, AT(Scene, sim.contact), .sub = &schema_contact,
     .doc = "contact of sheets with themselves and each other"},
    {"preview", ROW_MAP, DIM_NONE, AT(Scene, preview), .sub = &schema_preview, .doc = "how frames are drawn"},
};
const Schema schema_scene = {
    .title = "the scene", .size = sizeof(Scene), ROWS(scene_rows), .defaults = default_scene, .finish = finish_scene,
    .doc = "The whole file is one map."};

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
        param->slot = (row->extra - offsetof(SceneMaterial, pictures)) / sizeof(SceneFile);
        return true;
    }
    return false;
}

bool scene_param(int index, SceneParam *param) { return param_in(&schema_material, "", &index, param); }

unsigned schema_kind(const Schema *schema, const void *object) {
    if (!schema->kind_offset)
        return ~0u;
    int kind;
    memcpy(&kind, (const char *)object + schema->kind_offset, sizeof kind);
    return 1u << kind;
}
