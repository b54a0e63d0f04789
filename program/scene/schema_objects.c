// The objects of a scene: sheets, sources, colliders, pins and probes.
#include "scene/schema_rows.h"

#define DRAWN                                                                             \
    (BIT(SINGE_COLLIDER_SPHERE) | BIT(SINGE_COLLIDER_BOX) | BIT(SINGE_COLLIDER_CAPSULE) | \
     BIT(SINGE_COLLIDER_HEIGHTFIELD) | BIT(SINGE_COLLIDER_MESH))

static const char *const surface_names[] = {[PREVIEW_SURFACE_MATT] = "matt",
                                            [PREVIEW_SURFACE_WOOD] = "wood",
                                            [PREVIEW_SURFACE_METAL] = "metal",
                                            [PREVIEW_SURFACE_CLOTH] = "cloth",
                                            NULL};
#define ROW(NAME, word) [PREVIEW_HOLDER_##NAME] = word,
static const char *const holder_names[] = {PREVIEW_HOLDERS(ROW) NULL};
#undef ROW
static const char *const units_names[] = {[SCENE_UNITS_M] = "m",   [SCENE_UNITS_CM] = "cm", [SCENE_UNITS_MM] = "mm",
                                          [SCENE_UNITS_IN] = "in", [SCENE_UNITS_FT] = "ft", NULL};
static const char *const up_names[] = {[SCENE_UP_Z] = "z", [SCENE_UP_Y] = "y", NULL};

// ---- parts that several objects share

static const SchemaRow key_rows[] = {
    {"time", ROW_FLOAT, DIM_TIME, AT(SceneKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED, .doc = "when"},
    {"position", ROW_VECTOR, DIM_LENGTH, AT(SceneKey, position), .length = 3, LOCATION, .doc = "where"},
    {"rotation", ROW_VECTOR, DIM_ANGLE, AT(SceneKey, rotation), .length = 3, TURN,
     .doc = "turned about the x axis, then y, then z, all fixed in the world"},
};
static const Schema schema_key = {
    .title = "a path's entry",
    .size = sizeof(SceneKey),
    ROWS(key_rows),
    .doc = "A pose at one time. Positions are interpolated linearly. They are constant before the first entry and "
           "after the last. Times must increase."};

static const SchemaRow strength_rows[] = {
    {"time", ROW_FLOAT, DIM_TIME, AT(SingeValueKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED, .doc = "when"},
    {"value", ROW_FLOAT, DIM_FRACTION, AT(SingeValueKey, value), .min = 0, .max = 1e6, .flags = ROW_REQUIRED,
     .doc = "how strong, 1 being the full flux"},
};
static const Schema schema_strength = {
    .title = "a strength's entry",
    .size = sizeof(SingeValueKey),
    ROWS(strength_rows),
    .doc = "The strength of a texture source at one time; between entries it is interpolated linearly. Times must "
           "increase."};

static const SchemaRow motion_rows[] = {
    {"mesh", ROW_FILE, DIM_NONE, AT(SceneMotion, mesh), .flags = ROW_REQUIRED | ROW_NUMBERED,
     .doc = "files of one mesh, a frame each, by a name with a run of # for the number: `body.####.ply` is "
            "`body.0001.ply` at frame 1. All have the same vertices and faces in the same order; after the last one it "
            "stands still"},
    {"first", ROW_INT, DIM_NONE, AT(SceneMotion, first), WITHIN(0, 1e6), .doc = "number of the file of frame 1"},
    {"scale", ROW_FLOAT, DIM_NONE, AT(SceneMotion, scale), WITHIN(1e-6, 1e4), .doc = "times `units`"},
    {"units", ROW_ENUM, DIM_NONE, AT(SceneMotion, units), .names = units_names, .doc = "unit of the files' numbers"},
    {"up", ROW_ENUM, DIM_NONE, AT(SceneMotion, up), .names = up_names,
     .doc = "the files' axis that points up; files whose y is up are turned by 90 degrees about x"},
};
static const Schema schema_motion = {
    .title = "a motion",
    .size = sizeof(SceneMotion),
    ROWS(motion_rows),
    .defaults = default_motion,
    .doc = "A mesh that moves frame by frame, as animation programs write it. Vertices go in straight lines from frame "
           "to frame, with the velocity that this takes."};

// ---- sheets

#define OF SceneGrid
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, def.name, length, dimension, kinds, text, range)
#define SINGE_NEEDED(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, def.name, length, dimension, kinds, text, range, .flags = ROW_REQUIRED)
static const SchemaRow grid_rows[] = {
#include "singe/grid.def"
};
#undef OF
static const Schema schema_grid = {.title = "a grid",
                                   .size = sizeof(SceneGrid),
                                   ROWS(grid_rows),
                                   .defaults = default_grid,
                                   .doc = "A rectangle around the origin in the x-y plane, facing up (+z)."};

#define OF SceneRenderMesh
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, def.name, length, dimension, kinds, text, range)
#define SINGE_APART(key, TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(key, TYPE, def.name, length, dimension, kinds, text, range)
static const SchemaRow render_mesh_rows[] = {
    {"mesh", ROW_FILE, DIM_NONE, AT(SceneRenderMesh, mesh), .flags = ROW_REQUIRED,
     .doc = "a file of triangles, quads or polygons, with the `units`, `up` and position of the sheet's own mesh"},
#include "singe/render_mesh.def"
};
#undef OF
static const Schema schema_render_mesh = {
    .title = "a render mesh",
    .size = sizeof(SceneRenderMesh),
    ROWS(render_mesh_rows),
    .doc = "A mesh that is drawn in place of a sheet: finer, thick, with hems, seams and buttons "
           "([render-meshes.md](render-meshes.md)). It is bound to the sheet by positions at rest or by uv, and burns "
           "and tears with it."};

#define OF SceneSheet
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, name, length, dimension, kinds, text, range)
static const SchemaRow sheet_rows[] = {
    {"name", ROW_NAME, DIM_NONE, AT(SceneSheet, name),
     .doc = "for pins and messages; `sheet1`, `sheet2`, ... by default"},
    {"mesh", ROW_FILE, DIM_NONE, AT(SceneSheet, mesh),
     .doc = "a file of triangles, quads or polygons: OBJ, PLY, glTF and others ([meshes.md](meshes.md)); this or "
            "`grid`"},
    {"grid", ROW_MAP, DIM_NONE, AT(SceneSheet, grid), EXTRA(SceneSheet, grid.given), .sub = &schema_grid,
     .doc = "a rectangle made by the program"},
    {"render_mesh", ROW_MAP, DIM_NONE, AT(SceneSheet, render_mesh), EXTRA(SceneSheet, render_mesh.given),
     .sub = &schema_render_mesh, .doc = "a mesh that is drawn in place of the sheet; the sheet itself by default"},
    {"picture", ROW_FILE, DIM_NONE, AT(SceneSheet, picture),
     .doc = "PNG or JPEG that the preview prints on the side from which it reads the right way round; on cloth, on "
            "both sides"},
    {"back", ROW_FILE, DIM_NONE, AT(SceneSheet, back),
     .doc = "the same for the other side, as seen from there: its left edge lies behind the right edge of `picture`"},
    {"colour", ROW_VECTOR, DIM_FRACTION, AT(SceneSheet, colour), .length = 3, WITHIN(0, 1),
     .doc = "linear red, green, blue; tints the picture"},
    {"transmittance", ROW_FLOAT, DIM_FRACTION, AT(SceneSheet, transmittance), WITHIN(0, 1),
     .doc = "in the preview: share of the light on one side of the fresh sheet that leaves it on the other"},
    {"scale", ROW_FLOAT, DIM_NONE, AT(SceneSheet, scale), WITHIN(1e-6, 1e4),
     .doc = "factor on the mesh file's size, besides `units`"},
    {"units", ROW_ENUM, DIM_NONE, AT(SceneSheet, units), .names = units_names,
     .doc = "unit of the mesh file's numbers; `ft` is a foot"},
    {"up", ROW_ENUM, DIM_NONE, AT(SceneSheet, up), .names = up_names,
     .doc = "the mesh file's axis that points up; a file whose y is up is turned by 90 degrees about x"},
#define SINGE_ROWS_STAY
#include "singe/mesh.def"
#undef SINGE_ROWS_STAY
    {"rotate", ROW_VECTOR, DIM_ANGLE, AT(SceneSheet, rotate), .length = 3, TURN,
     .doc = "about x, then y, then z, after the scaling and `up`"},
    {"translate", ROW_VECTOR, DIM_LENGTH, AT(SceneSheet, translate), .length = 3, WITHIN(-9000, 9000),
     .doc = "after the rotation; a sheet must lie within 10 km of the origin"},
#include "singe/sheet.def"
    {"material", ROW_MAP, DIM_NONE, AT(SceneSheet, material), .sub = &schema_material, .doc = "what it is made of"},
};
#undef OF
const Schema schema_sheet = {.title = "a sheet",
                             .size = sizeof(SceneSheet),
                             ROWS(sheet_rows),
                             .defaults = default_sheet,
                             .finish = finish_sheet,
                             .located = true,
                             .doc = "A piece of cloth or paper: a mesh, or a grid, and a material."};

// ---- sources, colliders, pins

#define OF SceneSource
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, def.name, length, dimension, kinds, text, range)
#define SINGE_APART(key, TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(key, TYPE, def.name, length, dimension, kinds, text, range)
#define PICTURE_OF(kind, text)                                                                          \
    "texture", ROW_FILE, DIM_NONE, AT(SceneSource, texture), .kinds = BIT(kind), .flags = ROW_REQUIRED, \
                                                             .doc = "PNG or JPEG over the sheets' uv: " text
#define STRENGTH_OF(what, kinds_, low)                                                                     \
    "strength", ROW_STRENGTH, DIM_FRACTION, AT(SceneSource, strength), EXTRA(SceneSource, strength_count), \
        .kinds = kinds_, .min = low, .max = 1e6, .sub = &schema_strength,                                  \
        .doc = "multiplies " what " over time; 1 when not given"
static const SchemaRow source_rows[] = {
#include "singe/source.def"
    {"position", ROW_POSITION, DIM_LENGTH, AT(SceneSource, keys), EXTRA(SceneSource, key_count), .length = 3,
     .kinds = BIT(SINGE_SOURCE_SPOT), .flags = ROW_REQUIRED, SPACE, .doc = "its centre"},
    {"position", ROW_POSITION, DIM_LENGTH, AT(SceneSource, keys), EXTRA(SceneSource, key_count), .length = 3,
     .kinds = SOURCES_MOVABLE, .flags = ROW_SHORT, LOCATION,
     .doc = "its centre, when it does not move; this or `path`"},
    {"path", ROW_LIST, DIM_NONE, AT(SceneSource, keys), EXTRA(SceneSource, key_count), .kinds = SOURCES_MOVABLE,
     .sub = &schema_key, .doc = "its trajectory; this or `position`"},
    {PICTURE_OF(SINGE_SOURCE_TEXTURE, "white is the full flux, black none")},
    {PICTURE_OF(SINGE_SOURCE_ARRIVAL,
                "the time of ignition from black, `from`, to the lightest grey, `to`; pure white never ignites")},
    {PICTURE_OF(SINGE_SOURCE_WATER, "it rains where it is white, and nowhere where it is black")},
    {STRENGTH_OF("the rain", BIT(SINGE_SOURCE_WATER), 0)},
    {STRENGTH_OF("the flux", BIT(SINGE_SOURCE_TEXTURE), 0)},
    {STRENGTH_OF("the speed", SINGE_SOURCES_OF_AIR, -1e6)},
    {"visible", ROW_BOOL, DIM_NONE, AT(SceneSource, visible), .kinds = BIT(SINGE_SOURCE_BALL),
     .doc = "drawn in the preview"},
};
#undef OF
const Schema schema_source = {
    .title = "a source",
    .size = sizeof(SceneSource),
    ROWS(source_rows),
    .kind_offset = offsetof(SceneSource, def.kind),
    .defaults = default_source,
    .finish = finish_source,
    .located = true,
    .doc = "Something that heats or wets the sheets, or moves the air. Its `kind` decides which other keys it has."};

#define OF SceneCollider
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, def.name, length, dimension, kinds, text, range)
static const SchemaRow collider_rows[] = {
#include "singe/collider.def"
    {"mesh", ROW_FILE, DIM_NONE, AT(SceneCollider, mesh), .kinds = BIT(SINGE_COLLIDER_MESH),
     .doc = "a closed mesh of triangles or polygons: OBJ, PLY, glTF and others, whose faces turn "
            "counter-clockwise seen from outside and do not pass through each other; one that is inside out is "
            "turned; this or `motion`"},
    {"motion", ROW_MAP, DIM_NONE, AT(SceneCollider, motion), EXTRA(SceneCollider, motion.given),
     .kinds = BIT(SINGE_COLLIDER_MESH), .sub = &schema_motion,
     .doc =
         "a mesh that deforms, such as a character, in the collider's own frame; sheets are pushed and carried along "
         "by it"},
    {"scale", ROW_FLOAT, DIM_NONE, AT(SceneCollider, scale), .kinds = BIT(SINGE_COLLIDER_MESH), WITHIN(1e-6, 1e4),
     .doc = "factor on the mesh file's size, besides `units`"},
    {"units", ROW_ENUM, DIM_NONE, AT(SceneCollider, units), .kinds = BIT(SINGE_COLLIDER_MESH), .names = units_names,
     .doc = "unit of the mesh file's numbers: `m`, `cm`, `mm`, `in` or `ft`"},
    {"picture", ROW_FILE, DIM_NONE, AT(SceneCollider, picture), .kinds = BIT(SINGE_COLLIDER_HEIGHTFIELD),
     .flags = ROW_REQUIRED,
     .doc = "PNG or JPEG of the heights seen from above, x to the right and y up: a height at each pixel's centre, "
            "linear in between"},
    {"heights", ROW_VECTOR, DIM_LENGTH, AT(SceneCollider, heights), .length = 2,
     .kinds = BIT(SINGE_COLLIDER_HEIGHTFIELD), WITHIN(-1e3, 1e3), .doc = "local z of black, and of white"},
    {"position", ROW_POSITION, DIM_LENGTH, AT(SceneCollider, keys), EXTRA(SceneCollider, key_count), .length = 3,
     .flags = ROW_SHORT, LOCATION, .doc = "of its centre, if it does not move; instead of `path`"},
    {"rotation", ROW_ROTATION, DIM_ANGLE, AT(SceneCollider, keys), EXTRA(SceneCollider, key_count), .length = 3,
     .flags = ROW_SHORT, TURN, .doc = "about x, then y, then z, when it does not move; instead of `path`"},
    {"path", ROW_LIST, DIM_NONE, AT(SceneCollider, keys), EXTRA(SceneCollider, key_count), .sub = &schema_key,
     .doc = "its trajectory"},
    {"colour", ROW_VECTOR, DIM_FRACTION, AT(SceneCollider, colour), .length = 3, .kinds = DRAWN, WITHIN(0, 1),
     .doc = "linear red, green, blue in the preview"},
    {"surface", ROW_ENUM, DIM_NONE, AT(SceneCollider, surface), .kinds = DRAWN, .names = surface_names,
     .doc = "what it is made of in the preview, in its colour: `matt`; `wood`, cut along its longest side; `metal`, "
            "brushed, with temper colours when it is hot; or `cloth`, stretched over it"},
    {"visible", ROW_BOOL, DIM_NONE, AT(SceneCollider, visible), .kinds = DRAWN, .doc = "drawn in the preview"},
};
#undef OF
const Schema schema_collider = {
    .title = "a collider",
    .size = sizeof(SceneCollider),
    ROWS(collider_rows),
    .kind_offset = offsetof(SceneCollider, def.kind),
    .defaults = default_collider,
    .finish = finish_collider,
    .located = true,
    .doc = "A solid that sheets rest on and slide over. Its `kind` decides which keys it has."};

#define OF ScenePin
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, name, length, dimension, kinds, text, range)
static const SchemaRow pin_rows[] = {
    {"sheet", ROW_TEXT, DIM_NONE, AT(ScenePin, sheet),
     .doc = "name of the sheet, or its number from 0; the first by default"},
    {"points", ROW_POINTS, DIM_LENGTH, AT(ScenePin, points), EXTRA(ScenePin, point_count), .length = 3, SPACE,
     .doc = "points [x, y, z] in the world at the start"},
#include "singe/pin.def"
    {"vertices", ROW_INDICES, DIM_NONE, AT(ScenePin, vertices), EXTRA(ScenePin, vertex_count), WITHIN(0, 4294967294.0),
     .doc = "numbers of the mesh's vertices, from 0"},
    {"path", ROW_LIST, DIM_NONE, AT(ScenePin, keys), EXTRA(ScenePin, key_count), .sub = &schema_key,
     .doc = "motion of the held part, relative to the path's pose at the start; without a path it is held still"},
    {"motion", ROW_MAP, DIM_NONE, AT(ScenePin, motion), EXTRA(ScenePin, motion.given), .sub = &schema_motion,
     .doc = "a moving mesh in world coordinates that the held part follows: each particle follows the triangle that is "
            "nearest to it at frame 1; instead of `path`"},
    {"holder", ROW_ENUM, DIM_NONE, AT(ScenePin, holder), .names = holder_names,
     .doc =
         "what holds the sheet's edge in the preview, at each part of it that the pin holds; nothing else depends on "
         "it. `none`; `peg`, clothes-pegs on a cord; `clip`, clips of bent steel, each at the end of a rod, and one for sheets that lie one before the other; `ring`, curtain "
         "rings on the nearest `capsule` within 6 cm, even an invisible one, or else on a rod of brass. Not with "
         "`motion`"},
};
#undef OF
const Schema schema_pin = {.title = "a pin",
                           .size = sizeof(ScenePin),
                           ROWS(pin_rows),
                           .defaults = default_pin,
                           .finish = finish_pin,
                           .located = true,
                           .doc = "Holds part of a sheet."};

static const char *const probe_names[] = {[SCENE_PROBE_UV] = "uv", [SCENE_PROBE_POINT] = "point", NULL};
static const SchemaRow probe_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(SceneProbe, kind), .names = probe_names, .flags = ROW_REQUIRED,
     .doc = "how its position is given: `uv`, the sheet's texture coordinates, or `point`, the world at the start"},
    {"name", ROW_NAME, DIM_NONE, AT(SceneProbe, name), .doc = "in `probes.csv`; `probe1`, `probe2`, ... by default"},
    {"sheet", ROW_TEXT, DIM_NONE, AT(SceneProbe, sheet),
     .doc = "name of the sheet, or its number from 0; the first by default"},
    {"at", ROW_VECTOR, DIM_NONE, AT(SceneProbe, uv), .length = 2, .kinds = 1u << SCENE_PROBE_UV, .flags = ROW_REQUIRED,
     SPACE, .doc = "[u, v]; the nearest point of the sheet is taken, with a warning where the sheet has no such uv"},
    {"at", ROW_VECTOR, DIM_LENGTH, AT(SceneProbe, point), .length = 3, .kinds = 1u << SCENE_PROBE_POINT,
     .flags = ROW_REQUIRED, SPACE,
     .doc = "[x, y, z]; the nearest point of the sheet is taken, with a warning where it is far off"},
};
const Schema schema_probe = {.title = "a probe",
                             .size = sizeof(SceneProbe),
                             ROWS(probe_rows),
                             .kind_offset = offsetof(SceneProbe, kind),
                             .located = true,
                             .doc =
                                 "A point of a sheet, whose temperature, mass and position are written every frame."};
