// Shared declarations of the stage: the grid, its fields, and the passes that gas_step calls in order.
//
// The gas is air at ambient pressure, so its density is rho = 353/T kg K/m3, and a volume of any temperature holds the
// same rho cp T. Its heat above the ambient is written as lightness
//
//   L = 1 - Ta/T = 1 - rho/rho_a,   heat per volume = GAS_HEAT L,   GAS_HEAT = 353 cp = 355 kJ/m3
//
// which is advected like a density, gives the buoyancy g L, and grows by q/GAS_HEAT where q W/m3 are released, while
// the gas expands by the same amount: div u = q/GAS_HEAT (low Mach number, ideal gas).
#pragma once

#include "gas/gas.h"
#include "world/smother.h"

#define GAS_HEAT (353 * 1005.f) ///< J/m3

#define GAS_HOTTEST 1450.f ///< K, of a flame
#define GAS_LIGHTEST 0.85f ///< max L

enum {
    GAS_GHOSTS = 2, ///< cells around the grid that stay 0: still air of the ambient temperature
    GAS_LEVELS = 12,
    GAS_BOXES = 4,
};

/// Fields of a cell. The first ones are advected. GAS_THROUGH + d is the speed through its lower face along axis d,
/// averaged over the whole face, of which a sheet may cover a part.
typedef enum GasField {
    GAS_LIGHTNESS, ///< L
    GAS_FUEL,      ///< J/m3 of unburnt gas
    GAS_SMOKE,     ///< kg/m3
    GAS_VELOCITY,  ///< three, m/s, relative to the wind
    GAS_CARRIED = GAS_VELOCITY + 3,
    GAS_THROUGH = GAS_CARRIED,      ///< three
    GAS_PRESSURE = GAS_THROUGH + 3, ///< m/s: times rho_a cell/dt it is Pa
    GAS_FLAME,                      ///< W/m3 released, at the pace of the motion
    GAS_FIELDS,
} GasField;

/// Cells with their ghosts, x fastest.
typedef struct GasGrid {
    int n[3]; ///< cells without ghosts
    size_t stride[3];
    size_t cells; ///< with ghosts
} GasGrid;

static inline size_t gas_at(const GasGrid *grid, int i, int j, int k) {
    return (size_t)(i + GAS_GHOSTS) + grid->stride[1] * (size_t)(j + GAS_GHOSTS) +
           grid->stride[2] * (size_t)(k + GAS_GHOSTS);
}

/// Cells [low, high) along each axis.
typedef struct GasBox {
    int low[3], high[3];
} GasBox;

/// Columns [low, high) of a row of cells: low > high if there are none.
typedef struct GasRange {
    int low, high;
} GasRange;

static inline size_t gas_row(const GasGrid *grid, int j, int k) {
    return (size_t)(j + GAS_GHOSTS) + (size_t)(grid->n[1] + 2 * GAS_GHOSTS) * (size_t)(k + GAS_GHOSTS);
}

#define GAS_NO_BOX ((GasBox){{1 << 30, 1 << 30, 1 << 30}, {0, 0, 0}})

/// Extends a box to contain another one.
static inline void gas_box_add(GasBox *box, GasBox other) {
    for (int d = 0; d < 3; d++) {
        if (other.low[d] < box->low[d]) box->low[d] = other.low[d];
        if (other.high[d] > box->high[d]) box->high[d] = other.high[d];
    }
}

/// A level of the pressure's equation (multigrid.c): sum over faces of weight (p_beyond - p) = rhs.
typedef struct GasLevel {
    GasGrid grid;
    float *weight[3]; ///< of a cell's lower faces
    float *inverse;   ///< 1/sum of a cell's weights; 0 where there is no gas
    float *p, *rhs;
} GasLevel;

/// One of the two sets of the persistent fields.
typedef struct GasTurn {
    float *field[GAS_FIELDS];
    float *conductance, *temperature, *fuel; ///< [particles]
    float (*air)[4];                         ///< [particles]
} GasTurn;

struct Sweep;

struct GasPlan {
    GasSettings settings;
    void (*rows)(const struct Sweep *sweep, int task, int first, int count); ///< advect_axis.h
    GasGrid grid;
    float cell;      ///< m
    float origin[3]; ///< m
    uint64_t every;  ///< steps of the simulation in one of the gas
    int parts;       ///< steps of the gas in one of its calls, if those of the simulation are long
    float dt;        ///< s
    uint32_t particles, cell_count;

    GasTurn turn[2];
    float *block[2];   ///< all arrays of a set
    size_t block_size; ///< floats

    // scratch
    float *spare[3];
    float *open[3]; ///< uncovered share of a cell's lower face
    uint8_t *solid; ///< inside a collider
    GasLevel level[GAS_LEVELS];
    int levels;
    float *mixing;                   ///< half the share of a difference that mixes through a face of the cell
    float *expansion;                ///< L that a step adds
    double *partial;                 ///< [planes]
    GasBox (*plane_busy)[GAS_BOXES]; ///< [planes] where there is heat, fuel, smoke, momentum to carry
    GasRange *row_busy[2];           ///< [rows] of the field that is carried, before and after a sweep
    float (*normal)[3];              ///< [particles] unit
    Smother smother;
    int *hot;       ///< [planes] whether anything there is warmer than the air around
    float *scratch; ///< all of them but the normals
    size_t scratch_size;

    // for readers: without ghosts
    float *view[3]; ///< temperature, smoke, flame
    float (*view_velocity)[3];
    size_t view_cells;
};

/// Input of the passes of a step.
typedef struct GasPass {
    GasPlan *plan;
    const Shell *shell;
    const StateInput *state;
    const ColliderList *colliders;
    const SourceList *sources; ///< may be NULL
    Pool *pool;
    const GasTurn *from;
    GasTurn *to;
    float wind[3]; ///< m/s, at the centre of the grid
    float dt;      ///< s
    float fire;    ///< s of fire since the last step
    // of one pass
    float courant; ///< dt/cell of one part of the step
    int field;
    GasBox busy[GAS_BOXES];
    GasLevel *level;
    int colour;
} GasPass;

/// Points a state's arrays at the current turn.
void gas_plan_expose(const GasPlan *plan, GasState *gas);

/// Calls run over the planes of the grid, or of a level's.
void gas_planes(const GasPass *pass, const GasGrid *grid, SingeTaskFn *run);

/// The share of each face that sheets and colliders leave open (blocked.c).
void gas_blocked(GasPass *pass);

/// Normals of all particles (gas_sheets.c).
void gas_normals(GasPass *pass);

/// Whether anything burnt since the gas's last step, or a source's flame does.
bool gas_fed(const GasPass *pass);

/// Adds the gas of the burnt material, and of the flames of sources, as fuel.
void gas_feed(GasPass *pass);

/// Effect of the gas on each particle until its next step, and the heat that the gas loses.
void gas_meet(GasPass *pass);

/// Advects all fields (advect.c).
void gas_advect(GasPass *pass);

/// Burns the fuel (flame.c).
void gas_burn(GasPass *pass);

/// Buoyancy, and the unrest of the air (force.c).
void gas_force(GasPass *pass);

/// Projects the flow so that its divergence is that of the expansion (project.c).
void gas_project(GasPass *pass);

/// Solves for the pressure (multigrid.c).
void gas_solve(GasPass *pass, int cycles);

/// Fills in the view for readers (gas.c).
void gas_show(GasPass *pass, const GasTurn *turn);

/// A position in cells, from the centre of cell (0, 0, 0). False if it is outside the grid or not finite.
static inline bool gas_position(const GasPlan *plan, Float3 x, float position[3]) {
    const float at[3] = {x.x, x.y, x.z};
    for (int d = 0; d < 3; d++) {
        position[d] = (at[d] - plan->origin[d]) / plan->cell - 0.5f;
        if (!(position[d] > -1 && position[d] < (float)plan->grid.n[d])) return false;
    }
    return true;
}

/// Linear between the centres of cells, at a position from gas_position.
static inline float gas_sample(const GasGrid *grid, const float *field, const float position[3]) {
    int i[3];
    float part[3];
    for (int d = 0; d < 3; d++) {
        i[d] = (int)(position[d] + 1) - 1;
        part[d] = position[d] - (float)i[d];
    }
    const float *q = field + gas_at(grid, i[0], i[1], i[2]);
    size_t y = grid->stride[1], z = grid->stride[2];
    float a = q[0] + part[0] * (q[1] - q[0]), b = q[y] + part[0] * (q[y + 1] - q[y]);
    float c = q[z] + part[0] * (q[z + 1] - q[z]), e = q[y + z] + part[0] * (q[y + z + 1] - q[y + z]);
    a += part[1] * (b - a);
    c += part[1] * (e - c);
    return a + part[2] * (c - a);
}
