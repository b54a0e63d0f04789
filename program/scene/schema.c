// The tables of the scene itself, and of maps that it has once.
#include "scene/schema_rows.h"

#include <string.h>

static const char *const method_names[] = {[SINGE_SOLVER_STRAND] = "strand",
                                           [SINGE_SOLVER_PAPER] = "paper",
                                           [SINGE_SOLVER_PAPER_LITERAL] = "paper-literal",
                                           [SINGE_SOLVER_ALL_AT_ONCE] = "all-at-once",
                                           [SINGE_SOLVER_MASS_SPRING] = "mass-spring",
                                           NULL};

static const SchemaRow wind_rows[] = {
    {"velocity", ROW_VECTOR, DIM_SPEED, AT(SingeWindDef, velocity), .length = 3, WITHIN(-1000, 1000),
     .doc = "mean velocity of the air"},
    {"gust", ROW_FLOAT, DIM_SPEED, AT(SingeWindDef, gust), WITHIN(0, 1000), .doc = "how strong gusts are"},
    {"gust_time", ROW_FLOAT, DIM_TIME, AT(SingeWindDef, gust_time), WITHIN(1e-6, 1e6), .doc = "how long a gust lasts"},
    {"gust_size", ROW_FLOAT, DIM_LENGTH, AT(SingeWindDef, gust_size), WITHIN(1e-6, 1e6),
     .doc = "how far a gust reaches"},
    {"seed", ROW_UINT32, DIM_NONE, AT(SingeWindDef, seed), .doc = "seed of the gusts"},
};
static const Schema schema_wind = {
    .title = "the wind", .size = sizeof(SingeWindDef), ROWS(wind_rows), .doc = "The air's motion."};

#define FLOOR(name, colour, text) \
    { name, ROW_FLOAT, DIM_NONE, .offset = (colour) * sizeof(float), WITHIN(1e-6, 1e6), .doc = text }
static const SchemaRow regularisation_rows[] = {
    FLOOR("red", SINGE_RED, "centre to corner"),
    FLOOR("green", SINGE_GREEN, "centre to centre"),
    FLOOR("blue", SINGE_BLUE, "mesh edges"),
    FLOOR("yellow", SINGE_YELLOW, "diagonals"),
};
static const Schema schema_regularisation = {
    .title = "regularisations",
    .size = 4 * sizeof(float),
    ROWS(regularisation_rows),
    .doc =
        "The numerical floor on the solver's diagonal, by colour of spring, relative to w_a + w_b = 2. It acts as a "
        "compliance that grows with the square of the substep. The sheet's stiffness is the material's `compliance`."};

static const SchemaRow solver_rows[] = {
    {"method", ROW_ENUM, DIM_NONE, AT(SingeSolverDef, method), .names = method_names,
     .doc = "in this order: projection along strands; the paper's successive fast projection; the same exactly as "
            "printed, which may fail; all colours in one system; Hooke's law. The defaults below are those of "
            "`strand`"},
    {"substeps", ROW_INT, DIM_NONE, AT(SingeSolverDef, substeps), WITHIN(0, 1000),
     .doc =
         "substeps of a step; stiff, thick sheets of small cells need more ([equations.md](equations.md#stiffness)); "
         "0: as many as the red compliance needs"},
    {"projections", ROW_INT, DIM_NONE, AT(SingeSolverDef, projections), WITHIN(1, 1000),
     .doc = "projections of all colours per substep"},
    {"order", ROW_ORDER, DIM_NONE, AT(SingeSolverDef, order),
     .doc = "order of the springs' colours, each once; the last is satisfied best"},
    {"regularisation", ROW_MAP, DIM_NONE, AT(SingeSolverDef, regularisation), .sub = &schema_regularisation,
     .doc = "by colour of spring"},
    {"attachments", ROW_BOOL, DIM_NONE, AT(SingeSolverDef, attachments),
     .doc = "`strand`: keeps vertices within their geodesic distance of the pins"},
    {"early_exit", ROW_BOOL, DIM_NONE, AT(SingeSolverDef, early_exit),
     .doc = "`paper`, `paper-literal`, `all-at-once`: stops where the error is below `tolerance` of the lengths"},
    {"tolerance", ROW_FLOAT, DIM_NONE, AT(SingeSolverDef, tolerance), WITHIN(1e-12, 1),
     .doc = "the same: of the conjugate gradients and the early exit"},
    {"stiffness", ROW_FLOAT, DIM_STIFFNESS, AT(SingeSolverDef, stiffness), WITHIN(1e-6, 1e9),
     .doc = "`mass-spring`: of every spring"},
    {"smoothing", ROW_FLOAT, DIM_RATE, AT(SingeSolverDef, smoothing), WITHIN(0, 1e6),
     .doc = "internal friction: rate at which second differences of velocity along strands are lost"},
    {"smoothing_length", ROW_FLOAT, DIM_LENGTH, AT(SingeSolverDef, smoothing_length), WITHIN(0, 1000),
     .doc = "distance of the nodes they are taken over; neighbours are always included"},
    {"height_min", ROW_FLOAT, DIM_NONE, AT(SingeSolverDef, height_min), WITHIN(0, 1),
     .doc = "smallest height of a cell's centre over its corners, in thicknesses; 0 is off, and cells may be inverted"},
    {"height_gain", ROW_FLOAT, DIM_FRACTION, AT(SingeSolverDef, height_gain), WITHIN(0, 1),
     .doc = "share of a height's error that is corrected in a substep"},
};
static const Schema schema_solver = {
    .title = "the solver",
    .size = sizeof(SingeSolverDef),
    ROWS(solver_rows),
    .choice = "method",
    .chosen = chosen_solver,
    .doc = "How springs are kept at their lengths. The name of a method is enough: `solver: paper`. Keys that are not "
           "given take the method's defaults ([equations.md](equations.md#the-papers-solver))."};

static const SchemaRow gas_rows[] = {
    {"enabled", ROW_BOOL, DIM_NONE, AT(Scene, sim.gas.enabled), .doc = "no: sheets burn as in still air"},
    {"cell_size", ROW_FLOAT, DIM_LENGTH, AT(Scene, sim.gas.cell_size), WITHIN(0, 1),
     .doc = "side of a cell of its grid; 0: 8.7 mm for a sheet of A4, in proportion to others"},
    {"height", ROW_FLOAT, DIM_LENGTH, AT(Scene, sim.gas.height), WITHIN(0.01, 100),
     .doc = "height of the grid above the sheets at the start"},
    {"conductance", ROW_FLOAT, DIM_CONDUCTANCE, AT(Scene, sim.gas.conductance), FROM(0),
     .doc = "heat transfer to each side of a cooler sheet; a larger value makes fire climb faster"},
    {"radiated", ROW_FLOAT, DIM_FRACTION, AT(Scene, sim.gas.radiated), WITHIN(0, 0.95),
     .doc = "share of the flames' power that leaves as radiation"},
    {"soot", ROW_FLOAT, DIM_FRACTION, AT(Scene, sim.gas.soot), WITHIN(0, 1),
     .doc = "mass of smoke over the mass burnt"},
    {"detail", ROW_INT, DIM_NONE, AT(Scene, gas_detail), WITHIN(1, PREVIEW_BAKE_MAX),
     .doc = "above 1: `gas_detail/` has each frame on cells so many times finer along a side, with the tongues and "
            "streaks of our pictures, for other renderers ([formats.md](formats.md#the-gas))"},
};
static const Schema schema_gas = {
    .title = "the gas",
    .size = sizeof(Scene),
    ROWS(gas_rows),
    .choice = "enabled",
    .doc = "Burning releases hot gas. The gas rises, heats what is above, lifts ash and flakes, and carries flame and "
           "smoke. `gas: no` turns it off."};

static const SchemaRow contact_rows[] = {
    {"enabled", ROW_BOOL, DIM_NONE, AT(SingeContactDef, enabled), .doc = "no: sheets pass through themselves"},
    {"thickness", ROW_FLOAT, DIM_LENGTH, AT(SingeContactDef, thickness), WITHIN(1e-6, 1),
     .doc = "distance kept between surfaces, at most 2/5 of the smallest cell; not the material's thickness, which is "
            "the distance between the model's layers"},
    {"friction", ROW_FLOAT, DIM_NONE, AT(SingeContactDef, friction), WITHIN(0, 1000), .doc = "Coulomb's coefficient"},
};
static const Schema schema_contact = {
    .title = "contact of sheets",
    .size = sizeof(SingeContactDef),
    ROWS(contact_rows),
    .choice = "enabled",
    .doc =
        "Sheets do not pass through themselves or each other. With `contact: no` they do, as in the paper. Colliders "
        "have their own friction."};

static const SchemaRow output_rows[] = {
    {"formats", ROW_FORMATS, DIM_NONE, AT(SceneOutput, formats),
     .doc =
         "of the frames, each in a folder of its own ([formats.md](formats.md)); `ply` is the cache, which is always "
         "written"},
    {"events", ROW_BOOL, DIM_NONE, AT(SceneOutput, events),
     .doc = "`events.csv`: ignitions, holes and pieces that come free, with time and position"},
    {"texture_size", ROW_INT, DIM_NONE, AT(SceneOutput, texture_size), WITHIN(16, 8192),
     .doc = "pixels a side of `textures`"},
};
static const Schema schema_output = {
    .title = "the output",
    .size = sizeof(SceneOutput),
    ROWS(output_rows),
    .doc = "What a run writes for other programs. `singe convert` makes the same formats from a cache."};

static const SchemaRow scene_rows[] = {
    {"name", ROW_NAME, DIM_NONE, AT(Scene, name),
     .doc = "name of the outputs; by default the scene file's name without its extension"},
    {"frames", ROW_INT, DIM_NONE, AT(Scene, frames), WITHIN(1, 1000000),
     .doc = "number of frames; the first is the start, so N frames span (N - 1)/fps"},
    {"fps", ROW_FLOAT, DIM_FRAME_RATE, AT(Scene, fps), .min = 1e-3, .max = 1e5, .doc = "frames per second"},
    {"steps", ROW_INT, DIM_NONE, AT(Scene, steps), WITHIN(1, 100000), .doc = "simulation steps per frame"},
    {"pace", ROW_FLOAT, DIM_NONE, AT(Scene, sim.pace), WITHIN(1e-6, 1e6),
     .doc = "seconds of fire per second of motion; 1 is real, 4 burns four times as fast"},
    {"seed", ROW_UINT64, DIM_NONE, AT(Scene, sim.seed),
     .doc = "seed of ragged edges and of the preview; noise and wind have their own seeds"},
    {"ambient_temperature", ROW_FLOAT, DIM_TEMPERATURE, AT(Scene, sim.ambient_temperature), KELVIN,
     .doc = "temperature of the air and the surroundings"},
    {"gravity", ROW_VECTOR, DIM_ACCELERATION, AT(Scene, sim.gravity), .length = 3, WITHIN(-1e4, 1e4), .doc = "z is up"},
    {"air_density", ROW_FLOAT, DIM_DENSITY, AT(Scene, sim.air_density), WITHIN(0, 1000), .doc = "for drag and wind"},
    {"heat_tolerance", ROW_FLOAT, DIM_NONE, AT(Scene, sim.heat_tolerance), WITHIN(1e-9, 1),
     .doc = "relative tolerance of the heat equation; a step stops after 200 iterations and warns once"},
    {"detail", ROW_FLOAT, DIM_LENGTH, AT(Scene, sim.surface_detail), WITHIN(0, 1000),
     .doc =
         "resolution of the drawn mesh near the front: distance of the sample points, at least 1/23 of a cell's side. "
         "Bent cells are drawn on a smooth surface. 0: flat cells, sampled at their corners and centres, as in the "
         "paper"},
    {"raggedness", ROW_FLOAT, DIM_LENGTH, AT(Scene, sim.surface_raggedness), WITHIN(0, 1000),
     .doc = "maximum depth of noise at burnt edges, at most half a cell; needs `detail`"},
    {"sheets", ROW_LIST, DIM_NONE, AT(Scene, sheets), EXTRA(Scene, sheet_count), .sub = &schema_sheet,
     .flags = ROW_REQUIRED, .doc = "sheets that burn, at least one"},
    {"sources", ROW_LIST, DIM_NONE, AT(Scene, sources), EXTRA(Scene, source_count), .sub = &schema_source,
     .doc = "heat sources"},
    {"colliders", ROW_LIST, DIM_NONE, AT(Scene, colliders), EXTRA(Scene, collider_count), .sub = &schema_collider,
     .doc = "solids that sheets collide with"},
    {"pins", ROW_LIST, DIM_NONE, AT(Scene, pins), EXTRA(Scene, pin_count), .sub = &schema_pin,
     .doc = "constraints that hold parts of a sheet"},
    {"probes", ROW_LIST, DIM_NONE, AT(Scene, probes), EXTRA(Scene, probe_count), .sub = &schema_probe,
     .doc = "points of sheets that `probes.csv` follows, at most 1000"},
    {"wind", ROW_MAP, DIM_NONE, AT(Scene, sim.wind), .sub = &schema_wind, .doc = "the air's motion"},
    {"solver", ROW_MAP, DIM_NONE, AT(Scene, sim.solver), .sub = &schema_solver,
     .doc = "how springs are kept at their lengths"},
    {"creases", ROW_BOOL, DIM_NONE, AT(Scene, sim.solver.creases),
     .doc = "yes: sharp bending is partly plastic, by the material's `crease_radius` and `crease_share` (solver "
            "`strand`); no: bending is elastic, as in the paper"},
    {"tearing", ROW_BOOL, DIM_NONE, AT(Scene, tearing),
     .doc = "sheets tear where the line force exceeds the material's `strength`; needs the method `strand`"},
    {"gas", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_gas, .doc = "hot gas, flames and smoke"},
    {"contact", ROW_MAP, DIM_NONE, AT(Scene, sim.contact), .sub = &schema_contact,
     .doc = "contact of sheets with themselves and each other"},
    {"preview", ROW_MAP, DIM_NONE, AT(Scene, preview), .sub = &schema_preview, .doc = "how frames are drawn"},
    {"output", ROW_MAP, DIM_NONE, AT(Scene, output), .sub = &schema_output, .doc = "what is written of them"},
};
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
