// The shell: the body-centred square of section 3.2, its material, and its state.
//
// Particles: vertex v is particle v (corner, blue layer); cell c is particle vertex_count + c (centre, green layer).
// Only splits of vertices change a built Shell (shell/split.h); tears make them. Everything else that changes is in
// State.
#pragma once

#include "common/assertion.h"
#include "common/error.h"
#include "shell/field.h"
#include "singe/sim.h"

#define SHELL_NONE UINT32_MAX

/// Springs of one colour, numbered along their strands: strand s is the springs
/// [strand_first[s], strand_first[s + 1]), spring k of it runs from node k to node k + 1, so
/// ends[k][1] == ends[k + 1][0]. A ring's last node is its first. Within a strand no particle occurs
/// twice (but for a ring's closure). Family f is the strands [family_first[f], family_first[f + 1]);
/// strands of one family share no particle.
typedef struct SpringSet {
    uint32_t count;
    uint32_t (*ends)[2];
    float *rest;  ///< m, initial length
    float *grain; ///< cos 2(angle to the fibres) times the square of its share in the sheet; NULL without fibres
    uint32_t strand_count;
    uint32_t *strand_first;
    uint8_t *strand_ring; ///< 1 where the strand is a ring
    uint32_t family_count;
    uint32_t *family_first;
    uint32_t longest; ///< springs in the longest strand
} SpringSet;

/// The springs of a cell with corners 0..3; side i joins corner i and (i + 1) % 4.
typedef struct CellSprings {
    uint32_t red[4];    ///< centre to corner i
    uint32_t blue[4];   ///< along side i
    uint32_t green[4];  ///< across side i, or SHELL_NONE at the boundary
    uint32_t yellow[2]; ///< corners 0-2, corners 1-3
} CellSprings;

/// Material of each particle (its own layer: half the sheet's mass), at its actual grammage. Area, mass and capacity of
/// a vertex without cells are 0; it is never alive.
typedef struct Matter {
    float *area;          ///< m2 at rest
    float *mass;          ///< kg, initial
    float *capacity;      ///< J/K, of the unburnt particle
    Field capacity_ratio; ///< capacity per area over its mean in the sheet; exactly 1 where it is uniform
    // from the rows of singe/material.def: the parameter, or the quantity that matter_value computes from several
#define MATTER(field) Field field;
#define MATTER_NONE
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) field
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) Field name[SINGE_COLOUR_COUNT];
#include "singe/material.def"
#undef MATTER
#undef MATTER_NONE
    uint16_t *sheet;
} Matter;

/// The parameters that have one value for a sheet.
typedef struct SheetMaterial {
#define FLOAT float
#define BOOL bool
#define ENUM(name) name
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) TYPE name;
#include "singe/material.def"
#undef FLOAT
#undef BOOL
#undef ENUM
} SheetMaterial;

/// One sheet's own numbers and ranges.
typedef struct Sheet {
    char name[64];
    uint32_t vertex_first, vertex_count, cell_first, cell_count;
    uint32_t spare_count; ///< at the end of its vertices, without cells until a tear needs them (shell/split.h)
    uint32_t spare_used;
    float cell_size; ///< m, median edge
    SheetMaterial material;
    float velocity[3];
    float drop_pieces_below;             ///< m2
    uint32_t source_first, source_count; ///< range of its vertices in the input
} Sheet;

typedef struct Shell {
    uint32_t particle_count, vertex_count, cell_count, sheet_count;
    uint32_t (*cells)[4];
    CellSprings *cell_springs;
    float (*rest_position)[4];
    float (*uv)[2];
    float (*corner_uv)[4][2];    ///< [cell_count], or NULL where no sheet has seams
    int32_t *source_vertex;      ///< [vertex_count] vertex of the input, numbered over all sheets, or -1
    int32_t (*corner_source)[4]; ///< [cell_count] the same of the cells' corners; NULL without corner_uv
    SpringSet springs[SINGE_COLOUR_COUNT];
    Matter matter;
    Sheet *sheets;
    uint32_t cell_family_count; ///< cells coloured so that cells of one family share no corner
    uint32_t *cell_family_first;
    uint32_t *cell_order; ///< [cell_count] cells, family by family
    uint32_t *fan_first;  ///< [vertex_count + 1] start of each vertex's cells in `fan`
    uint32_t *fan;        ///< [4 cell_count] the cells around each vertex, in order of cell
    bool creases;         ///< creases are on: a State has room for them
    // changes by tears; all 0 where sheets cannot tear
    uint32_t spare_count;                       ///< of all sheets
    uint32_t split_count;                       ///< splits so far; code that caches topology compares it
    uint32_t edge_spare_count, edge_spare_used; ///< blue springs after those of the strands, for a tear's second edge
    uint32_t *edge_origin;                      ///< [edge_spare_count] the blue spring from which it was torn
    uint32_t moved[SINGE_COLOUR_COUNT];         ///< upper bound of the springs that splits gave another end, or created
} Shell;

/// The parameters that vary over a sheet, in the order of SheetSource.value, which is that of snapshots.
typedef enum ShellParam {
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) PARAM_##NAME = number,
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) PARAM_##NAME = number, // four, by colour
#include "singe/material.def"
} ShellParam;
enum {
    PARAM_COUNT = 0
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) +1
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) +SINGE_COLOUR_COUNT
#include "singe/material.def"
};

/// A sheet as it was added: the mesh and its evaluated material, kept for saving and for the build. In `sheet` firsts
/// and cell_size are 0; the shell sets its own.
typedef struct SheetSource {
    Sheet sheet;
    float (*position)[3];        ///< [vertex_count]
    uint32_t (*cells)[4];        ///< [cell_count], of this sheet's vertices
    float (*uv)[2];              ///< [vertex_count], zero without
    float (*corner_uv)[4][2];    ///< [cell_count] or NULL
    int32_t *source_vertex;      ///< [vertex_count] or NULL
    int32_t (*corner_source)[4]; ///< [cell_count] or NULL
    float value[PARAM_COUNT];    ///< each parameter, where it has one value for the sheet
    float *values[PARAM_COUNT];  ///< [vertex_count + cell_count] where it varies, vertices first; else NULL
    void *user_data;             ///< the caller's
} SheetSource;

/// The cell's own uv of its corner i.
static inline const float *sheet_corner_uv(const SheetSource *source, uint32_t cell, int i) {
    return source->corner_uv ? source->corner_uv[cell][i] : source->uv[source->cells[cell][i]];
}

/// A parameter at a particle of the sheet: its vertices, then its cells.
static inline float sheet_param(const SheetSource *source, int param, uint32_t i) {
    return source->values[param] ? source->values[param][i] : source->value[param];
}

/// Copies a Def of any version over the defaults. False when a struct_size is not set.
bool sheet_read_def(const SingeSheetDef *given, SingeSheetDef *def);

/// Checks a sheet's Def, copies its mesh (sheet.c) and evaluates its material (material.c). Errors name the
/// sheet's own vertex or cell.
SingeResult sheet_source_create(Memory *memory, const SingeSheetDef *def, SheetSource *source, SingeError *error);
void sheet_source_free(Memory *memory, SheetSource *source);

/// Makes the checks of sheet_source_create on a sheet that was read back.
SingeResult sheet_source_check(const SheetSource *source, SingeError *error);

/// The texture at (u, v): bilinear between pixel centres, clamped at the border, row 0 at v = 1 (material.c).
float shell_sample_texture(const SingeTexture *texture, float u, float v);

/// Builds the shell of all sheets (bcs.c, strand.c). Errors: SINGE_ERROR_MESH for a non-manifold or
/// inconsistently turned edge or a vertex whose cells are not one fan, naming the sheet and element;
/// SINGE_ERROR_LIMIT for more than the index types hold.
SingeResult shell_create(Memory *memory, const SheetSource *sources, uint32_t source_count, Shell *shell,
                         SingeError *error);
void shell_free(Memory *memory, Shell *shell);

// ---------------------------------------------------------------------------------------------------
// State: what changes from step to step. Each stage writes its own part only.

/// The most water that a sheet holds, over the mass before it burns.
#define HEAT_WATER_MAX 3.0f

typedef struct HeatState {
    float *temperature;      ///< [particles] K
    float *temperature_peak; ///< [particles] K, highest so far
    float *water;            ///< [particles] over the mass before it burns, or NULL (shell_holds_water)
    double heat_in, heat_lost, heat_of_combustion; ///< J, cumulative
} HeatState;

typedef struct BurnState {
    float *mass;         ///< [particles] fraction of the initial mass
    float *fuel;         ///< [particles] share that can still pyrolyse, 1 to 0; with the mass it gives char and ash
    float *burn_rate;    ///< [particles] 1/s of the step just done
    float *release;      ///< [particles] K/s, heating by the step just done
    float *time_ignited; ///< [particles] s, -1 before
    float *time_burnt;   ///< [particles] s, -1 before; when m fell below m_loss
    float *spring_length[SINGE_COLOUR_COUNT]; ///< target lengths, eq 6
    float *ash, *volume;    ///< [particles] share that has become ash, and volume ratio, eq 5: by mass and fuel
    _Atomic uint8_t *burns; ///< [cells] 1: one of its particles has lost mass in this step
    double mass_burnt;      ///< kg gone as gas
} BurnState;

typedef struct AblateState {
    uint8_t *particle_flags; ///< SINGE_ALIVE; SINGE_PINNED repeats dynamics.pinned for views (sim/objects.c sets both)
    uint8_t *cell_flags;     ///< SINGE_ALIVE while any of its triangles is
    uint8_t *spring_flags[SINGE_COLOUR_COUNT];
    uint16_t *degree; ///< [particles] springs alive at the particle
    int32_t *piece;   ///< [particles] id, -1 when gone
    uint32_t next_piece, piece_count;
    uint64_t topology_version;
    double heat_removed; ///< J, enthalpy of removed particles
    double mass_removed; ///< kg
} AblateState;

typedef struct DynamicsState {
    float (*position)[4]; ///< [particles + shell_nowhere_count] m; fourth: 1/kg, inverse mass in this step
    float (*velocity)[4]; ///< m/s, of the last substep: the next one starts with it
    float (*earlier)[4];  ///< [vertices] m, positions at `earlier_time`; fourth is unused
    double earlier_time;  ///< s, when the last `velocity_steps` began
    uint8_t *pinned;      ///< [particles] number of pins that hold it
    float *bend;          ///< [green springs] 1/m, curvature beyond rest and curl, low-pass filtered; NULL without
    float *crease;        ///< [green springs] 1/m, its plastic part; NULL without
} DynamicsState;

/// Effect of the gas on the sheets, from one of its steps to the next. The arrays belong to the gas plan, which has two
/// sets and alternates between them, so that restoring the pointers rolls back a failed step; NULL without gas.
typedef struct GasState {
    bool awake;               ///< some of it is hot
    bool warm;                ///< some conductance is not 0
    const float *conductance; ///< [particles] W/(m2 K), to `temperature` if that is higher
    const float *temperature; ///< [particles] K
    const float (*air)[4];    ///< [particles] m/s of the air there, relative to the wind; fourth is unused
    const float *fuel;        ///< [particles] share left at the gas's last step
    uint64_t steps;           ///< of the gas
    int turn;                 ///< which of the two sets is current
} GasState;

/// A vertex that a tear has split: some cells of its fan went to the next spare vertex of its sheet.
typedef struct ShellSplit {
    uint32_t vertex;
    uint32_t cells; ///< bit k: the cell fan[fan_first[vertex] + k]
    uint32_t spare; ///< the vertex they went to
} ShellSplit;

_Static_assert(sizeof(ShellSplit) == 12, "snapshots hold splits as they are");

/// Empty where sheets cannot tear.
typedef struct TearState {
    float (*line_force)[6]; ///< [cells] N/m in rest coordinates, filtered: xx, yy, zz, yz, zx, xy
    ShellSplit *splits;     ///< [spare_count] in order of time; they determine the Shell
    uint32_t split_count;
} TearState;

typedef struct State {
    double time; ///< s
    uint64_t step;
    HeatState heat;
    BurnState burn;
    AblateState ablate;
    DynamicsState dynamics;
    GasState gas;
    TearState tear;
    void *arena; ///< all arrays above except the gas's lie in one block
    size_t arena_size;
    size_t saved_size; ///< of the arena's start: all that snapshots hold
    size_t basic_size; ///< of the arena's start: all except the springs' lengths, which follow from the rest
} State;

/// What a stage reads of the State: all parts except the one that it writes. That part is NULL here and a separate
/// argument, so that no part is accessed through two pointers of which one writes.
typedef struct StateInput {
    double time; ///< s
    uint64_t step;
    const HeatState *heat;
    const BurnState *burn;
    const AblateState *ablate;
    const DynamicsState *dynamics;
    const GasState *gas;
    const TearState *tear;
} StateInput;

/// All parts of a State, while none is written.
static inline StateInput state_input(const State *state) {
    return (StateInput){state->time,    state->step,      &state->heat, &state->burn,
                        &state->ablate, &state->dynamics, &state->gas,  &state->tear};
}

/// The same as an argument of a call: const StateInput *.
#define STATE_INPUT(state) ((const StateInput[]){state_input(state)})

/// Events of one step. The capacity is fixed; events beyond it are dropped and counted.
typedef struct EventList {
    SingeEvent *items;
    size_t count, capacity, dropped;
} EventList;

static inline void event_push(EventList *list, SingeEventKind kind, int32_t element, double time,
                              const float *position) {
    if (list->count == list->capacity) {
        list->dropped++;
        return;
    }
    list->items[list->count++] = (SingeEvent){kind, element, time, {position[0], position[1], position[2]}};
}

/// Number of massless nodes after the last particle, for lanes without a strand: the max number of strands in a family.
uint32_t shell_nowhere_count(const Shell *shell);

/// Lays out a State for the shell and fills it with the initial state: rest positions, initial temperatures, mass 1,
/// all alive, target lengths = rest lengths (state.c).
SingeResult state_create(Memory *memory, const Shell *shell, State *state);
void state_free(Memory *memory, State *state);

/// The vertices' positions in `arena`, a copy of the state's from when this step began, become the `earlier` ones.
void state_remember(const Shell *shell, State *state, const void *arena);

/// True for a spare vertex, which no tear has used yet.
static inline bool shell_is_spare(const Shell *shell, uint32_t vertex) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    const Sheet *sheet = &shell->sheets[shell->matter.sheet[vertex]];
    return vertex - sheet->vertex_first >= sheet->vertex_count - sheet->spare_count + sheet->spare_used;
}

/// True for a vertex of a mesh (corner layer), even if no cell uses it; false for a cell's centre.
static inline bool shell_is_corner(const Shell *shell, uint32_t particle) { return particle < shell->vertex_count; }
static inline const float *shell_corner_uv(const Shell *shell, uint32_t cell, int i) {
    SINGE_ASSERT(cell < shell->cell_count);
    return shell->corner_uv ? shell->corner_uv[cell][i] : shell->uv[shell->cells[cell][i]];
}
static inline uint32_t shell_centre(const Shell *shell, uint32_t cell) { return shell->vertex_count + cell; }

// carried.c, of a sheet with cells
/// N/m, the max line force that substeps of h hold; above it the sheet stretches.
float shell_carried(const Shell *shell, uint32_t sheet, float h);

/// N/m, the line force of its weight on Earth and of a plume where it hangs.
float shell_load(const Shell *shell, uint32_t sheet);

/// Number of springs of a colour that are in strands. They come first, followed by the spares of tears.
static inline uint32_t shell_strand_springs(const Shell *shell, int colour) {
    return shell->springs[colour].count - (colour == SINGE_BLUE ? shell->edge_spare_count : 0);
}

/// The cell across side i, at the other end of the green spring; SHELL_NONE at the boundary.
static inline uint32_t shell_neighbour(const Shell *shell, uint32_t cell, int i) {
    SINGE_ASSERT(cell < shell->cell_count);
    uint32_t spring = shell->cell_springs[cell].green[i], centre = shell_centre(shell, cell);
    if (spring == SHELL_NONE) return SHELL_NONE;
    const uint32_t *ends = shell->springs[SINGE_GREEN].ends[spring];
    return (ends[0] == centre ? ends[1] : ends[0]) - shell->vertex_count;
}

/// Char over the char that pyrolysis of all the fuel leaves, c/nu, from mass and fuel: 0 to 1. 0 if there is no char:
/// `yield` is not above mass_min (burn/glow.c).
static inline float shell_char(float mass, float fuel, float mass_min, float yield) {
    float span = yield - mass_min, max = 1 - fuel;
    if (!(span > 0)) return 0;
    float share = (mass - fuel - mass_min * max) / span;
    return share < 0 ? 0 : share > max ? max : share;
}

/// The factor below where all of the fuel is gone.
#define GLOW_SLOWEST 4.0f

/// Factor by which char burns and cools more slowly than the flame front: 1 while there is fuel, and always 1 if
/// pyrolysis leaves no char (burn/glow.c).
static inline float shell_glow_slowing(const Matter *matter, uint32_t i, float fuel) {
    float burnt = (1 - fuel) * (1 - fuel);
    if (!(field_at(matter->char_yield, i) > field_at(matter->mass_min, i))) return 1;
    burnt *= burnt;
    return 1 + (GLOW_SLOWEST - 1) * burnt * burnt;
}

/// Burn progress (1 - m)/(1 - m_min), 0 fresh to 1 ash. A mean of m_min below 1 may be rounded to 1: then nothing burns.
static inline float shell_burn_progress(float mass, float mass_min) {
    float progress = (1 - mass) / (1 - mass_min);
    return progress > 1 ? 1 : progress > 0 ? progress : 0;
}

/// Whether a sheet had water at the start: then every particle has room for it in the State, and otherwise none.
static inline bool shell_holds_water(const Shell *shell) {
    return shell->matter.moisture.mask || shell->matter.moisture.values[0] > 0;
}
