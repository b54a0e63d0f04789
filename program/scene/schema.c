// The tables of the scene itself, and of maps that it has once.
#include "scene/schema_rows.h"

#include <string.h>

#define OF SingeWindDef
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, name, length, dimension, kinds, text, range)
static const SchemaRow wind_rows[] = {
#include "singe/wind.def"
};
#undef OF
static const Schema schema_wind = {
    .title = "the wind", .size = sizeof(SingeWindDef), ROWS(wind_rows), .doc = "The air's motion."};

#define FLOOR(name, colour, text, ...) {name, ROW_FLOAT, .offset = (colour) * sizeof(float), __VA_ARGS__, .doc = text},
#define FLOORS_regularisation(...)                               \
    FLOOR("red", SINGE_RED, "centre to corner", __VA_ARGS__)     \
    FLOOR("green", SINGE_GREEN, "centre to centre", __VA_ARGS__) \
    FLOOR("blue", SINGE_BLUE, "mesh edges", __VA_ARGS__)         \
    FLOOR("yellow", SINGE_YELLOW, "diagonals", __VA_ARGS__)
#define FLOORS_tearing(...)
#define SINGE_HIDDEN(TYPE, name, length, dimension, standard, range, kinds, text) FLOORS_##name(range)
static const SchemaRow regularisation_rows[] = {
#include "singe/solver.def"
};
static const Schema schema_regularisation = {
    .title = "regularisations",
    .size = 4 * sizeof(float),
    ROWS(regularisation_rows),
    .doc =
        "The numerical floor on the solver's diagonal, by colour of spring, relative to w_a + w_b = 2. It acts as a "
        "compliance that grows with the square of the substep. The sheet's stiffness is the material's `compliance`."};

#define OF SingeSolverDef
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, name, length, dimension, kinds, text, range)
static const SchemaRow solver_rows[] = {
#include "singe/solver.def"
    {"regularisation", ROW_MAP, DIM_NONE, AT(SingeSolverDef, regularisation), .sub = &schema_regularisation,
     .doc = "by colour of spring"},
};
#undef OF
static const Schema schema_solver = {
    .title = "the solver",
    .size = sizeof(SingeSolverDef),
    ROWS(solver_rows),
    .choice = "method",
    .chosen = chosen_solver,
    .doc = "How springs are kept at their lengths. The name of a method is enough: `solver: paper`. Keys that are not "
           "given take the method's defaults ([paper-solver.md](equations/paper-solver.md))."};

#define OF Scene
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, sim.gas.name, length, dimension, kinds, text, range)
static const SchemaRow gas_rows[] = {
#include "singe/gas.def"
    {"detail", ROW_INT, DIM_NONE, AT(Scene, gas_detail), WITHIN(1, PREVIEW_BAKE_MAX),
     .doc = "above 1: `gas_detail/` has each frame on cells finer by this factor along a side, with the tongues and "
            "streaks of our pictures, for other renderers ([formats.md](formats.md#the-gas))"},
};
#undef OF
static const Schema schema_gas = {
    .title = "the gas",
    .size = sizeof(Scene),
    ROWS(gas_rows),
    .choice = "enabled",
    .doc = "Burning releases hot gas. The gas rises, heats what is above, lifts ash and flakes, and carries flame and "
           "smoke. `gas: no` turns it off."};

#define OF SingeContactDef
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, name, length, dimension, kinds, text, range)
static const SchemaRow contact_rows[] = {
#include "singe/contact.def"
};
#undef OF
static const Schema schema_contact = {
    .title = "contact of sheets",
    .size = sizeof(SingeContactDef),
    ROWS(contact_rows),
    .choice = "enabled",
    .doc =
        "Sheets do not pass through themselves or each other. With `contact: no` they do, as in the paper. Colliders "
        "have their own friction."};

static const SchemaRow checkpoints_rows[] = {
    {"every", ROW_INT, DIM_NONE, AT(SceneCheckpoints, every), WITHIN(0, 1000000),
     .doc = "keeps the checkpoints of frames N, 2N, 3N, ... in `checkpoints/`; 0: none"},
    {"megabytes", ROW_FLOAT, DIM_NONE, AT(SceneCheckpoints, megabytes), WITHIN(0, 1e9),
     .doc =
         "disk limit in MB; above it, every second checkpoint is deleted. 0: no limit. Given alone, every 10th frame "
         "is kept at first"},
};
static const Schema schema_checkpoints = {
    .title = "checkpoints",
    .size = sizeof(SceneCheckpoints),
    ROWS(checkpoints_rows),
    .doc = "A run always keeps its last two checkpoints, to resume from. With more, a branch begins at once "
           "([directing.md](directing.md)); otherwise it first simulates the earlier frames again."};

static const SchemaRow output_rows[] = {
    {"formats", ROW_FORMATS, DIM_NONE, AT(SceneOutput, formats),
     .doc = "formats of the frames, each in its own folder ([formats.md](formats.md)); `ply` is the cache, which is "
            "always written"},
    {"events", ROW_BOOL, DIM_NONE, AT(SceneOutput, events),
     .doc = "`events.csv`: ignitions, holes and pieces that come free, with time and position"},
    {"texture_size", ROW_INT, DIM_NONE, AT(SceneOutput, texture_size), WITHIN(16, 8192),
     .doc = "width and height of `textures` in pixels"},
};
static const Schema schema_output = {
    .title = "the output",
    .size = sizeof(SceneOutput),
    ROWS(output_rows),
    .finish = finish_output,
    .doc = "What a run writes for other programs. `singe convert` makes the same formats from a cache."};

static const SchemaRow pace_rows[] = {
    {"time", ROW_FLOAT, DIM_TIME, AT(SingeValueKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED,
     .doc = "when, in seconds of motion"},
    {"value", ROW_FLOAT, DIM_NONE, AT(SingeValueKey, value), .min = 0, .max = 1e6, .flags = ROW_REQUIRED,
     .doc = "seconds of fire per second of motion"},
};
static const Schema schema_pace = {.title = "a pace's entry",
                                   .size = sizeof(SingeValueKey),
                                   ROWS(pace_rows),
                                   .doc = "The pace of the fire at one time; between entries it is interpolated "
                                          "linearly. Times must increase."};

static const SchemaRow burn_by_rows[] = {
    {"fraction", ROW_FLOAT, DIM_FRACTION, AT(SceneBurnBy, fraction), .flags = ROW_REQUIRED, .min = 1e-3, .max = 1,
     .doc = "share of the initial mass that is burnt or gone (`burnt_fraction` of `stats.csv`)"},
    {"frame", ROW_INT, DIM_NONE, AT(SceneBurnBy, frame), .flags = ROW_REQUIRED, .min = 2, .max = 1e6,
     .doc = "by this frame"},
};
static const Schema schema_burn_by = {
    .title = "burn_by",
    .size = sizeof(SceneBurnBy),
    ROWS(burn_by_rows),
    .doc = "Adjusts the pace from frame to frame, from a thousandth of `pace` to a thousand times `pace`, so that this "
           "share has burnt by that frame. After it, the pace is `pace` again."};

#define OF Scene
#define SINGE_FIELD(TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(#name, TYPE, sim.name, length, dimension, kinds, text, range)
#define SINGE_APART(key, TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(key, TYPE, sim.name, length, dimension, kinds, text, range)
static const SchemaRow scene_rows[] = {
    {"name", ROW_NAME, DIM_NONE, AT(Scene, name),
     .doc = "name of the outputs; by default the scene file's name without its extension"},
    {"frames", ROW_INT, DIM_NONE, AT(Scene, frames), WITHIN(1, 1000000),
     .doc = "number of frames; the first is the start, so N frames span (N - 1)/fps"},
    {"fps", ROW_FLOAT, DIM_FRAME_RATE, AT(Scene, fps), .min = 1e-3, .max = 1e5, .doc = "frames per second"},
    {"steps", ROW_INT, DIM_NONE, AT(Scene, steps), WITHIN(1, 100000), .doc = "simulation steps per frame"},
    {"pace", ROW_LIST, DIM_NONE, AT(Scene, paces), EXTRA(Scene, pace_count), .sub = &schema_pace, .flags = ROW_KEYED,
     .doc = "over time, or a number: below 1 slow motion, above 1 fast; 0 freezes the fire"},
    {"burn_by", ROW_MAP, DIM_NONE, AT(Scene, burn_by), EXTRA(Scene, burn_by.given), .sub = &schema_burn_by,
     .doc = "how much of the mass burns by a given frame"},
#include "singe/sim.def"
    {"sheets", ROW_LIST, DIM_NONE, AT(Scene, sheets), EXTRA(Scene, sheet_count), .sub = &schema_sheet,
     .flags = ROW_REQUIRED, .doc = "sheets that burn, at least one"},
    {"sources", ROW_LIST, DIM_NONE, AT(Scene, sources), EXTRA(Scene, source_count), .sub = &schema_source,
     .doc = "heat sources"},
    {"colliders", ROW_LIST, DIM_NONE, AT(Scene, colliders), EXTRA(Scene, collider_count), .sub = &schema_collider,
     .doc = "solids that sheets collide with"},
    {"pins", ROW_LIST, DIM_NONE, AT(Scene, pins), EXTRA(Scene, pin_count), .sub = &schema_pin,
     .doc = "constraints that hold parts of a sheet"},
    {"probes", ROW_LIST, DIM_NONE, AT(Scene, probes), EXTRA(Scene, probe_count), .sub = &schema_probe,
     .doc = "points of sheets that `probes.csv` follows; at most 1000, as in every list of objects"},
    {"wind", ROW_MAP, DIM_NONE, AT(Scene, sim.wind), .sub = &schema_wind, .doc = "the air's motion"},
    {"solver", ROW_MAP, DIM_NONE, AT(Scene, sim.solver), .sub = &schema_solver,
     .doc = "how springs are kept at their lengths"},
#define SINGE_APART(key, TYPE, name, length, dimension, standard, range, kinds, text) \
    AS_ROW_AT(key, TYPE, sim.solver.name, length, dimension, kinds, text, range)
#include "singe/solver.def"
    {"tearing", ROW_BOOL, DIM_NONE, AT(Scene, tearing),
     .doc = "sheets tear where the line force exceeds the material's `strength`; needs the method `strand`"},
    {"gas", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_gas, .doc = "hot gas, flames and smoke"},
    {"contact", ROW_MAP, DIM_NONE, AT(Scene, sim.contact), .sub = &schema_contact,
     .doc = "contact of sheets with themselves and each other"},
    {"preview", ROW_MAP, DIM_NONE, AT(Scene, preview), .sub = &schema_preview, .doc = "how frames are drawn"},
    {"checkpoints", ROW_MAP, DIM_NONE, AT(Scene, checkpoints), .sub = &schema_checkpoints,
     .doc = "which checkpoints are kept"},
    {"output", ROW_MAP, DIM_NONE, AT(Scene, output), .sub = &schema_output, .doc = "files for other programs"},
};
#undef OF
const Schema schema_scene = {.title = "the scene",
                             .size = sizeof(Scene),
                             ROWS(scene_rows),
                             .defaults = default_scene,
                             .finish = finish_scene,
                             .doc = "The whole file is one map."};

unsigned schema_kind(const Schema *schema, const void *object) {
    if (!schema->kind_offset) return ~0u;
    int kind;
    memcpy(&kind, (const char *)object + schema->kind_offset, sizeof kind);
    return 1u << kind;
}
