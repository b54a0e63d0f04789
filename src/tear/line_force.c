// Line force in a cell of area A, in rest coordinates (the virial of its springs):
//
//   N = (1/A) sum share f L (U x U),   f U L = (f/|d|) (l/L) D,   N = (1/A) sum share pull (l/L) (D x D)   [N/m]
//
//   f     N     force of the spring, positive in tension; pull (l/L) is what the dynamics gives
//   D     m     the spring at rest, in the plane of the sheet; L its length; l its target length
//   share 1     for red and yellow springs, and springs at the border; 1/2 for springs of two cells
//
// Where an edge or a cell's diagonal is EDGE_STRETCH times as long as at rest, as in threads of char that carry more
// than substeps can hold (shell/carried.c), its ends tear, whatever their strength.
//
// Both layers are included: N is that of the sheet. It is filtered over time, so that loads shorter than some
// milliseconds tear nothing,
//
//   N <- N + (1 - exp(-h/tau)) (N_step - N)
//
// with the mean over all substeps of a step for N_step, whatever h; where a sheet is released, N follows at once. N is
// also averaged over a process zone of a fixed length: one pass, 1/8 of each neighbour and 1/2 of the cell itself,
// spreads by s^2/4 (variance, an axis), and so does the mean over the cells at a vertex.
#include "common/float4.h"
#include "common/real.h"
#include "tear/tear_plan.h"

#include <math.h>
#include <string.h>

static const float LINE_FILTER = 5e-3f; ///< tau, s
static const float LINE_ZONE = 1.5e-3f; ///< m, standard deviation of the average
static const float LINE_ASH = 0.05f;    ///< strength of ash over that of char
static const float LINE_CHAR = 0.25f;   ///< max strength of char over that of fresh sheet, in a sheet that must tear
static const float LINE_WET = 0.1f;     ///< strength of soaked over that of dry sheet
static const float EDGE_STRETCH = 1.4f;
static const float EDGE_DOUBTFUL = 0.95f * 1.4f * 1.4f; ///< square of what may be EDGE_STRETCH
static const float WET_FROM = 0.1f, WET_TO = 0.6f;      ///< water over the dry mass: air-dry, and soaked
enum { LINE_PASSES = 12 };

/// Share of a vertex that is ash.
static float ash_of(const Matter *matter, const State *state, uint32_t vertex) {
    const float min = field_at(matter->mass_min, vertex), yield = field_at(matter->char_yield, vertex);
    const float fuel = state->burn.fuel[vertex];
    return yield > min ? 1 - fuel - shell_char(state->burn.mass[vertex], fuel, min, yield) : 0;
}

float tear_strength(const TearPlan *plan, const Shell *shell, const State *state, uint32_t vertex) {
    const Matter *matter = &shell->matter;
    float fresh = field_at(matter->strength, vertex), weakened = plan->weakened[matter->sheet[vertex]];
    float fuel = state->burn.fuel[vertex];

    // water opens the bonds between fibres: paper that is soaked keeps some 10 % of its strength (Hubbe, Mini-Encyclopedia
    // of Papermaking Wet-End Chemistry: more than 10 or 15 % is wet-strength paper)
    const float soaked = state->heat.water ? (state->heat.water[vertex] - WET_FROM) / (WET_TO - WET_FROM) : 0;
    if (soaked > 0) weakened *= real_powf(LINE_WET, float_min(soaked, 1));

    if (fuel >= 1 || isinf(fresh)) return fresh * weakened;
    float burnt = real_powf(field_at(matter->char_strength, vertex) / fresh, 1 - fuel);
    burnt *= 1 + (LINE_ASH - 1) * ash_of(matter, state, vertex);
    if (weakened < 1) weakened *= real_powf(LINE_CHAR, 1 - fuel);
    return fresh * float_min(burnt, weakened);
}

float tear_strength_least(const Shell *shell, uint32_t index, float weakened, float ash) {
    const Matter *matter = &shell->matter;
    const Sheet *sheet = &shell->sheets[index];
    float least = INFINITY;

    if (shell_holds_water(shell)) weakened *= LINE_WET;
    if (weakened < 1) weakened *= LINE_CHAR;

    for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++) {
        const bool leaves_ash = field_at(matter->char_yield, v) > field_at(matter->mass_min, v);
        const float burnt = field_at(matter->char_strength, v) * (leaves_ash ? 1 + (LINE_ASH - 1) * ash : 1);
        least = float_min(least, float_min(burnt, field_at(matter->strength, v) * weakened));
    }

    return least;
}

typedef struct Measure {
    TearPlan *plan;
    const Shell *shell;
    State *state;
    const float *const *pull;
    float keep; ///< exp(-h/tau)
    int from;   ///< which of plan->smooth is read
} Measure;

/// Length of an edge or a diagonal over its length at rest.
static float edge_stretch(const Shell *shell, const State *state, SingeColour colour, uint32_t spring) {
    const uint32_t *ends = shell->springs[colour].ends[spring];
    const float(*position)[4] = (const float(*)[4])state->dynamics.position;
    float length = float3_length(float3_sub(float3_load(position[ends[0]]), float3_load(position[ends[1]])));
    return length / shell->springs[colour].rest[spring];
}

bool tear_is_stretched(const Shell *shell, const State *state, uint32_t vertex) {
    const float(*x)[4] = (const float(*)[4])state->dynamics.position;
    const float *blue = shell->springs[SINGE_BLUE].rest, *yellow = shell->springs[SINGE_YELLOW].rest;
    for (uint32_t f = shell->fan_first[vertex]; f < shell->fan_first[vertex + 1]; f++) {
        const uint32_t *corner = shell->cells[shell->fan[f]];
        const CellSprings *springs = &shell->cell_springs[shell->fan[f]];
        int i = 0;
        while (corner[i] != vertex) i++;
        const float rest[3] = {blue[springs->blue[i]], yellow[springs->yellow[i & 1]],
                               blue[springs->blue[(i + 3) & 3]]};
        for (int k = 0; k < 3; k++) {
            const Float4 d = float4_load(x[corner[(i + k + 1) & 3]]) - float4_load(x[vertex]);
            if (float4_dot(d, d) >= EDGE_DOUBTFUL * rest[k] * rest[k]) return true;
        }
    }
    return false;
}

/// Whether a line force, by its square, is below the share of the strength of any corner that tears: of dry cells that
/// have not burnt by their sheet's weakest vertex.
static bool measure_is_far(const Measure *job, uint32_t cell, float square) {
    const TearPlan *plan = job->plan;
    const State *state = job->state;
    const uint32_t *corner = job->shell->cells[cell];
    const float *fuel = state->burn.fuel;
    if (state->heat.water) return false;

    for (int i = 0; i < 4; i++)
        if (!(fuel[corner[i]] >= 1)) return false;

    const uint32_t sheet = job->shell->matter.sheet[corner[0]];
    const float hinge = TEAR_HINGE * (plan->fresh[sheet] * plan->weakened[sheet]);
    return square <= hinge * hinge;
}

/// Whether a tensor's norm, which no principal value exceeds, reaches the strength of a corner.
static bool measure_is_near(const Measure *job, uint32_t cell, const float *t) {
    const Shell *shell = job->shell;
    const uint8_t *flags = job->state->ablate.cell_flags;
    float square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2] + 2 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]);
    const float safe = TEAR_HINGE * job->plan->safe, safe_ash = TEAR_HINGE * job->plan->safe_ash;

    // most carry less than what tears anything but ash
    bool weak = square >= safe * safe;
    for (int i = 0; i < 4 && !weak && square >= safe_ash * safe_ash; i++) {
        const float least = safe * (1 + (LINE_ASH - 1) * ash_of(&shell->matter, job->state, shell->cells[cell][i]));
        weak = square >= least * least;
    }
    if (!weak) return false;

    // a share of the strength is enough where a cell at the corner is gone
    const bool far = measure_is_far(job, cell, square);
    for (int i = 0; i < 4 && !far; i++) {
        uint32_t corner = shell->cells[cell][i];
        float strength = tear_strength(job->plan, shell, job->state, corner), hinge = TEAR_HINGE * strength;
        if (square > strength * strength) return true;
        for (uint32_t k = shell->fan_first[corner]; k < shell->fan_first[corner + 1]; k++)
            if (square > hinge * hinge && !(flags[shell->fan[k]] & SINGE_ALIVE)) return true;
    }

    // or an edge or a diagonal of the cell is EDGE_STRETCH times as long as at rest; roots only of those that may be
    const CellSprings *springs = &shell->cell_springs[cell];
    const float *blue = shell->springs[SINGE_BLUE].rest, *yellow = shell->springs[SINGE_YELLOW].rest;
    Float4 x[4];
    for (int i = 0; i < 4; i++) x[i] = float4_load(job->state->dynamics.position[shell->cells[cell][i]]);

    for (int i = 0; i < 4; i++) {
        const Float4 d = x[(i + 1) & 3] - x[i];
        const float rest = blue[springs->blue[i]];
        if (float4_dot(d, d) < EDGE_DOUBTFUL * rest * rest) continue;
        if (edge_stretch(shell, job->state, SINGE_BLUE, springs->blue[i]) > EDGE_STRETCH) return true;
    }

    for (int i = 0; i < 2; i++) {
        const Float4 d = x[i + 2] - x[i];
        const float rest = yellow[springs->yellow[i]];
        if (float4_dot(d, d) < EDGE_DOUBTFUL * rest * rest) continue;
        if (edge_stretch(shell, job->state, SINGE_YELLOW, springs->yellow[i]) > EDGE_STRETCH) return true;
    }

    return false;
}

/// tensor_add on the two halves of a tensor.
static inline void measure_add(Float4 *along, Float4 *across, Float4 n, float s) {
    const Float4 scaled = s * n;
    *along += scaled * n;
    *across += FLOAT4_SHUFFLE(scaled, scaled, 1, 2, 0, 3) * FLOAT4_SHUFFLE(n, n, 2, 0, 1, 3);
}

static double measure_cells(void *task, int begin, int end) {
    const Measure *job = task;
    const Shell *shell = job->shell;
    const float *const *pull = job->pull;
    const float(*centroid)[4] = (const float(*)[4])job->plan->centroid;
    double near = 0;

    for (uint32_t c = (uint32_t)begin; c < (uint32_t)end; c++) {
        float *held = job->state->tear.line_force[c];
        if (!(job->state->ablate.cell_flags[c] & SINGE_ALIVE)) {
            memset(held, 0, sizeof(Tensor));
            continue;
        }

        // N of this step: xx, yy, zz and yz, zx, xy
        const CellSprings *springs = &shell->cell_springs[c];
        const Float4 centre = float4_load(centroid[c]);
        Float4 p[4], along = float4_all(0), across = along;
        for (int i = 0; i < 4; i++) p[i] = float4_load(shell->rest_position[shell->cells[c][i]]);

        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(shell, c, i);
            measure_add(&along, &across, p[i] - centre, pull[SINGE_RED][springs->red[i]]);
            float share = other == SHELL_NONE ? 1 : 0.5f;
            measure_add(&along, &across, p[(i + 1) & 3] - p[i], share * pull[SINGE_BLUE][springs->blue[i]]);
            if (other == SHELL_NONE) continue;
            measure_add(&along, &across, float4_load(centroid[other]) - centre,
                        0.5f * pull[SINGE_GREEN][springs->green[i]]);
        }

        for (int i = 0; i < 2; i++)
            measure_add(&along, &across, p[i + 2] - p[i], pull[SINGE_YELLOW][springs->yellow[i]]);
        along /= float4_all(shell->matter.area[shell_centre(shell, c)]);
        across /= float4_all(shell->matter.area[shell_centre(shell, c)]);

        // filtered; zz, yz, zx and xy last, as a tensor has no room for two fours
        const Float4 rest = FLOAT4_SHUFFLE(along, across, 2, 4, 5, 6);
        const Float4 held_first = float4_load(held), held_last = float4_load(held + 2);
        const float before = held_first[0] + held_first[1] + held_first[2], after = along[0] + along[1] + along[2];
        const float keep = after < 0.5f * before ? 0 : job->keep;
        float4_store(held, along + keep * (held_first - along));
        float4_store(held + 2, rest + keep * (held_last - rest));
        if (near == 0) near = measure_is_near(job, c, held); // one is enough
    }

    return near;
}

double tear_measure(TearPlan *plan, const Shell *shell, State *state, const float *const pull[SINGE_COLOUR_COUNT],
                    Pool *pool, float h) {
    Measure job = {.plan = plan, .shell = shell, .state = state, .pull = pull, .keep = real_expf(-h / LINE_FILTER)};
    return pool_sum(pool, (int)shell->cell_count, measure_cells, &job, plan->partial);
}

static void smooth_cells(void *task, int begin, int end) {
    const Measure *job = task;
    const Tensor *from = (const Tensor *)job->plan->smooth[job->from];

    for (int c = begin; c < end; c++) {
        float *to = job->plan->smooth[!job->from][c], own = 1;
        Tensor sum = {0};
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(job->shell, (uint32_t)c, i);
            if (other == SHELL_NONE || !(job->state->ablate.cell_flags[other] & SINGE_ALIVE)) continue;
            own -= 0.125f;
            for (int k = 0; k < 6; k++) sum[k] += 0.125f * from[other][k];
        }

        for (int k = 0; k < 6; k++) to[k] = own * from[c][k] + sum[k];
    }
}

void tear_smooth(TearPlan *plan, const Shell *shell, const State *state, Pool *pool) {
    float size = shell->sheets[0].cell_size;
    for (uint32_t s = 1; s < shell->sheet_count; s++) size = float_min(size, shell->sheets[s].cell_size);
    float passes = floorf(4 * LINE_ZONE * LINE_ZONE / (size * size)) - 1;
    int count = passes < 0 ? 0 : passes > LINE_PASSES ? LINE_PASSES : (int)passes;
    count += count & 1; // even, so that the result is in smooth[0]
    memcpy(plan->smooth[0], state->tear.line_force, shell->cell_count * sizeof(Tensor));

    Measure job = {.plan = plan, .shell = shell, .state = (State *)(uintptr_t)state};
    for (int k = 0; k < count; k++) {
        job.from = k & 1;
        pool_for(pool, (int)shell->cell_count, POOL_GRAIN, smooth_cells, &job);
    }
}

Float3 tear_normal(const Shell *shell, const Fan *fan) {
    Float3 sum = {0, 0, 0};
    for (int k = 0; k < fan->count; k++) {
        const uint32_t *corner = shell->cells[fan->cell[k]];
        Float3 p[4];
        for (int i = 0; i < 4; i++) p[i] = float3_load(shell->rest_position[corner[i]]);
        sum = float3_add(sum, float3_cross(float3_sub(p[2], p[0]), float3_sub(p[3], p[1])));
    }

    return float3_unit(sum);
}

TearPull tear_pull(const TearPlan *plan, const Shell *shell, const State *state, uint32_t vertex) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    const uint8_t *flags = state->ablate.cell_flags;
    TearPull pull = {0};
    Fan fan;
    if (!(state->ablate.particle_flags[vertex] & SINGE_ALIVE) || state->dynamics.pinned[vertex]) return pull;
    if (state->ablate.piece[vertex] < 0) return pull;

    split_fan(shell, vertex, &fan);
    if (fan.count < 2) return pull;

    // the mean over the vertex's cells; at the tip of a tear over the cells ahead of it, if there are any: those without
    // a torn edge, or an edge of the sheet, at the vertex
    float weight = 0;
    for (int turn = plan->torn[vertex] ? 0 : 1; turn < 2 && weight == 0; turn++)
        for (int k = 0; k < fan.count; k++) {
            bool behind = fan.after[k] < 0 || fan.before[k] < 0;
            if (!(flags[fan.cell[k]] & SINGE_ALIVE) || (turn == 0 && behind)) continue;
            float area = shell->matter.area[shell_centre(shell, fan.cell[k])];
            for (int i = 0; i < 6; i++) pull.force[i] += area * plan->smooth[0][fan.cell[k]][i];
            weight += area;
        }
    if (!(weight > 0)) return pull;

    for (int i = 0; i < 6; i++) pull.force[i] /= weight;

    // its larger principal value in the plane of the sheet
    Float3 normal = tear_normal(shell, &fan), side = fabsf(normal.x) < 0.7f ? float3(1, 0, 0) : float3(0, 1, 0);
    Float3 e1 = float3_unit(float3_cross(normal, side)), e2 = float3_cross(normal, e1);
    float a = tensor_across(pull.force, e1), b = tensor_across(pull.force, e2);
    float c = (tensor_across(pull.force, float3_add(e1, e2)) - a - b) / 2;
    float mean = (a + b) / 2, radius = sqrtf((a - b) * (a - b) / 4 + c * c), angle = real_atan2f(c, (a - b) / 2) / 2;
    pull.across = float3_add(float3_scale(e1, real_cosf(angle)), float3_scale(e2, real_sinf(angle)));
    pull.ratio = float_max(0, (mean + radius) / tear_strength(plan, shell, state, vertex));

    // the largest stretch of the edges and diagonals at the vertex
    float stretch = 0;
    for (int k = 0; k < fan.count && mean + radius > plan->safe; k++) {
        const CellSprings *springs = &shell->cell_springs[fan.cell[k]];
        const int corner = fan.corner[k];
        if (!(flags[fan.cell[k]] & SINGE_ALIVE)) continue;
        stretch = float_max(stretch, edge_stretch(shell, state, SINGE_BLUE, springs->blue[corner]));
        stretch = float_max(stretch, edge_stretch(shell, state, SINGE_BLUE, springs->blue[(corner + 3) & 3]));
        stretch = float_max(stretch, edge_stretch(shell, state, SINGE_YELLOW, springs->yellow[corner & 1]));
    }

    if (stretch > EDGE_STRETCH) pull.ratio = float_max(pull.ratio, stretch / EDGE_STRETCH);
    return pull;
}
