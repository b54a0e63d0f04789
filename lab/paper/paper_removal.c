// Section 6: which springs of a partly burnt cell are removed, and how its burnt corners move then.
//
// A strip of four cells is clamped at one end and hangs level under its weight. Its last cell has one corner left; the
// other three and its centre are burnt. The paper removes a spring when both triangles that share it have disappeared.
// One burnt corner then hangs on a single yellow spring. It swings about the corner opposite, and the drawn edge, which
// lies on that cell's sides, goes with it. Here the springs of a cell are removed together, with the cell.
#include <math.h>

#include "paper/paper.h"
#include "paper/paper_states.h"

enum { STRIP_CELLS = 4, PARTICLES = 3 * STRIP_CELLS + 2, SPRINGS = 64, STRIP_STEPS = 100, STRIP_PROJECTIONS = 7 };

static const double strip_cell = 2.5e-3, strip_grammage = 0.08; // m, kg/m2
static const uint32_t burnt_cell = STRIP_CELLS - 1;

static bool particle_burnt(uint32_t particle) {
    const uint32_t row = STRIP_CELLS + 1, centre = 2 * row + burnt_cell;
    return particle == STRIP_CELLS - 1 || particle == STRIP_CELLS || particle == row + STRIP_CELLS ||
           particle == centre;
}

/// Whether both triangles that share a side, or the line from a corner to a centre, have disappeared.
static bool triangles_gone(const SingeView *view, const uint32_t *ends) {
    if (!particle_burnt(ends[0]) || !particle_burnt(ends[1])) return false;

    for (uint32_t c = 0; c < view->cell_count; c++) {
        const uint32_t *corner = view->cells[c], centre = view->vertex_count + c;
        for (int i = 0; i < 4; i++) {
            const uint32_t triangle[3] = {corner[i], corner[(i + 1) & 3], centre};
            int shared = 0, left = 0;
            for (int k = 0; k < 3; k++) {
                shared += triangle[k] == ends[0] || triangle[k] == ends[1];
                left += !particle_burnt(triangle[k]);
            }
            if (shared == 2 && left > 0) return false;
        }
    }

    return true;
}

/// The strip's springs, a set a colour.
static SingeResult strip_network(const SingeView *view, bool by_triangles, SingeNetwork **network, SingeError *error) {
    double positions[3 * PARTICLES], inverse_masses[PARTICLES], lengths[SPRINGS], weights[SPRINGS];
    uint32_t ends[SPRINGS][2], sets[SPRINGS];
    SingeNetworkDef def = singe_default_network();

    for (uint32_t i = 0; i < view->particle_count; i++) {
        for (uint32_t k = 0; k < 3; k++) positions[3 * i + k] = (double)view->position[i][k];
        const bool held = positions[3 * i] < 1.5 * strip_cell;
        inverse_masses[i] = held ? 0 : 2 / (strip_grammage * (double)view->area[i]);
    }

    for (uint32_t c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t s = 0; s < view->spring_count[c]; s++, def.spring_count++) {
            const uint32_t *pair = view->springs[c][s], k = def.spring_count;
            const bool in_triangles = c == SINGE_BLUE || c == SINGE_RED;
            ends[k][0] = pair[0];
            ends[k][1] = pair[1];
            lengths[k] = (double)view->spring_length[c][s];
            weights[k] = by_triangles && in_triangles && triangles_gone(view, pair) ? 0 : 1;
            sets[k] = c;
        }

    def.particle_count = view->particle_count;
    def.positions = positions;
    def.inverse_masses = inverse_masses;
    def.ends = ends[0];
    def.lengths = lengths;
    def.weights = weights;
    def.set_count = SINGE_COLOUR_COUNT;
    def.sets = sets;
    return singe_network_create(&def, network, error);
}

SingeResult paper_longest_side(Lab *lab, bool by_triangles, double *longest, SingeError *error) {
    LabGrid grid = lab_grid(STRIP_CELLS, 1, (float)strip_cell);
    SingeSim *sim;
    SingeNetwork *network;
    TRY(lab_build(lab, &grid, &sim, error));

    const SingeView view = singe_sim_view(sim);
    SingeResult result = strip_network(&view, by_triangles, &network, error);

    // eq 8 to 13
    const double h = (double)PAPER_TIME_STEP, gravity = 9.81;
    double *x = result ? NULL : singe_network_positions(network), before[3 * PARTICLES], velocity[3 * PARTICLES] = {0};
    *longest = 0;
    for (int step = 0; step < STRIP_STEPS && !result; step++) {
        for (uint32_t i = 0; i < 3 * PARTICLES; i++) {
            before[i] = x[i];
            if (before[i - i % 3] < 1.5 * strip_cell) continue;
            if (i % 3 == 2) velocity[i] -= h * gravity;
            x[i] += h * velocity[i];
        }

        for (int k = 0; k < SINGE_COLOUR_COUNT * STRIP_PROJECTIONS && !result; k++)
            result = singe_network_project(network, (uint32_t)k % SINGE_COLOUR_COUNT, NULL);
        for (uint32_t i = 0; i < 3 * PARTICLES; i++) velocity[i] = (x[i] - before[i]) / h;

        // sides of the burnt cell, removed or not, over their length at rest
        const uint32_t *corner = view.cells[burnt_cell];
        for (int i = 0; i < 4; i++) {
            const double *a = x + 3 * corner[i], *b = x + 3 * corner[(i + 1) & 3];
            const double square = pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2);
            *longest = fmax(*longest, sqrt(square) / strip_cell);
        }
    }

    singe_network_destroy(network);
    singe_sim_destroy(sim);
    return result;
}
