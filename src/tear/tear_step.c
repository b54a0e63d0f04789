// Where sheets tear, and in which direction.
//
// A vertex tears if the largest principal value N_1 of the line force exceeds its strength and no vertex of its cells
// is closer to tearing. The cells around it are separated along two of its edges, or along one if the sheet is already
// open there. While a tear runs in a piece, no other begins there; of those that could begin, only one does.
//
// Cells that are connected only by a vertex, as those between them have burnt, separate at TEAR_HINGE of the strength.
//
// A tear should run along t, normal to the direction of N_1, but it can run only along sides of cells, one edge per
// step. So one of the edges e that lead forwards is drawn at random,
//
//   weight = (e . t) (S_min/S_e)^4
//
// with S_e the mean strength of an edge's ends: so on square cells the mean of many edges has the direction t, whatever
// the cells' orientation, and tears prefer weaker parts of the sheet. The random numbers are multiples of the golden
// section, one per split: they are distributed as evenly as possible, so that a tear stays close to its line.
//
// Substeps carry a line force T (shell/carried.c); pulled apart farther, a sheet stretches. If it is held farther apart
// than its geodesic length, by more than paper stretches before it breaks, it must tear though it is stronger: all its
// fresh strengths are then lowered by one factor, so that the smallest is half of T, and char keeps at most a quarter of
// that: real char breaks first, as it is hundreds of times weaker.
#include "common/float4.h"
#include "common/real.h"
#include "common/random.h"
#include "tear/tear_plan.h"

#include <math.h>
#include <string.h>

static const float STRETCH_MAX = 1.03f; ///< paper breaks at 2 to 4 %

/// In TearPlan.leader.
#define LEADER_RUNS (UINT32_MAX - 1)

/// Min line force across an edge that tears, over N_1. Edges within 10 degrees of N_1's direction carry less.
static const float EDGE_MIN = 0.03f;

SingeResult tear_plan_create(Memory *memory, const Shell *shell, float h, TearPlan **out) {
    TearPlan *plan;
    *out = NULL;
    if (!NEW(memory, plan, 1)) return SINGE_ERROR_MEMORY;

    plan->cell_count = shell->cell_count;
    plan->vertex_count = shell->vertex_count;
    plan->particle_count = shell->particle_count;
    plan->sheet_count = shell->sheet_count;
    if (!NEW(memory, plan->centroid, plan->cell_count) || !NEW(memory, plan->smooth[0], plan->cell_count) ||
        !NEW(memory, plan->smooth[1], plan->cell_count) || !NEW(memory, plan->ratio, plan->vertex_count) ||
        !NEW(memory, plan->torn, plan->vertex_count) || !NEW(memory, plan->leader, plan->particle_count) ||
        !NEW(memory, plan->weakened, plan->sheet_count) || !NEW(memory, plan->fresh, plan->sheet_count) ||
        !NEW(memory, plan->min, plan->sheet_count) || !NEW(memory, plan->partial, pool_blocks((int)plan->cell_count))) {
        tear_plan_free(memory, plan);
        return SINGE_ERROR_MEMORY;
    }

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const uint32_t *corner = shell->cells[c];
        const float(*x)[4] = (const float(*)[4])shell->rest_position;
        Float4 a = float4_load(x[corner[0]]) + float4_load(x[corner[1]]);
        float4_store(plan->centroid[c], (a + (float4_load(x[corner[2]]) + float4_load(x[corner[3]]))) * 0.25f);
    }

    plan->safe = plan->safe_ash = INFINITY;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        float fresh = INFINITY;
        for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++)
            fresh = float_min(fresh, field_at(shell->matter.strength, v));

        plan->fresh[s] = fresh;
        plan->min[s] = isinf(fresh) ? 1 : float_min(1, 0.5f * shell_carried(shell, s, h) / fresh);
        plan->safe = float_min(plan->safe, tear_strength_least(shell, s, plan->min[s], 0));
        plan->safe_ash = float_min(plan->safe_ash, tear_strength_least(shell, s, plan->min[s], 1));
        plan->weakened[s] = 1;
    }

    *out = plan;
    return SINGE_OK;
}

void tear_plan_free(Memory *memory, TearPlan *plan) {
    if (!plan) return;

    FREE(memory, plan->centroid, plan->cell_count);
    for (int k = 0; k < 2; k++) FREE(memory, plan->smooth[k], plan->cell_count);

    FREE(memory, plan->ratio, plan->vertex_count);
    FREE(memory, plan->torn, plan->vertex_count);
    FREE(memory, plan->leader, plan->particle_count);
    FREE(memory, plan->weakened, plan->sheet_count);
    FREE(memory, plan->fresh, plan->sheet_count);
    FREE(memory, plan->min, plan->sheet_count);
    FREE(memory, plan->partial, pool_blocks((int)plan->cell_count));
    FREE(memory, plan, 1);
}

void tear_stretched(TearPlan *plan, uint32_t sheet, float stretch) {
    plan->weakened[sheet] = stretch > STRETCH_MAX ? plan->min[sheet] : 1;
}

/// Whether no vertex that shares a cell with this one is closer to tearing. For a vertex at a tear only others at tears
/// count.
static bool is_weakest(const TearPlan *plan, const Shell *shell, uint32_t vertex) {
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++)
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell->cells[shell->fan[k]][i];
            if (plan->torn[vertex] && !plan->torn[other]) continue;
            if (plan->ratio[other] > plan->ratio[vertex] ||
                (plan->ratio[other] == plan->ratio[vertex] && other < vertex))
                return false;
        }

    return true;
}

/// The cells of a fan that are connected with the first, in turning order; empty for a fan without cells.
typedef struct Turn {
    int count, at[SPLIT_FAN];
    bool closed;
} Turn;

static Turn turn_order(const Fan *fan) {
    Turn turn = {0};
    int start = 0;

    if (fan->count == 0) return turn;
    for (int k = 0; k < fan->count && fan->before[start] >= 0; k++) start = fan->before[start];
    turn.closed = fan->before[start] >= 0;
    if (turn.closed) start = 0;
    for (int k = start; k >= 0 && turn.count < fan->count && (turn.count == 0 || k != start); k = fan->after[k])
        turn.at[turn.count++] = k;

    return turn;
}

/// An edge of a vertex along which it may tear.
typedef struct TearEdge {
    Float3 along;   ///< from the vertex, at rest
    float strength; ///< N/m, sum of both ends'; INFINITY if too little of N_1 is across
    bool solid;     ///< the cells on both sides are left
} TearEdge;

static bool is_left(const State *state, const Fan *fan, int k) {
    return state->ablate.cell_flags[fan->cell[k]] & SINGE_ALIVE;
}

/// Picks one of the edges [begin, count) along which a tear continues in `direction`; -1 if there is none. `draw` is 0
/// to 1.
static int pick_edge(const TearEdge *edges, int begin, int count, Float3 direction, float draw) {
    float weight[SPLIT_FAN], min = INFINITY, sum = 0;
    for (int j = begin; j < count; j++)
        if (edges[j].solid && float3_dot(edges[j].along, direction) > 0) min = float_min(min, edges[j].strength);
    if (isinf(min)) return -1;

    for (int j = begin; j < count; j++) {
        float weaker = min / edges[j].strength;
        weight[j] = edges[j].solid
                        ? float_max(0, float3_dot(edges[j].along, direction)) * weaker * weaker * weaker * weaker
                        : 0;
        sum += weight[j];
    }

    int last = -1;
    for (int j = begin; j < count; j++) {
        if (weight[j] <= 0) continue;
        last = j;
        if ((draw -= weight[j] / sum) < 0) break;
    }

    return last;
}

/// The cells [first, last) of the turn, or the others if they are fewer.
static uint32_t smaller_part(const Fan *fan, const Turn *turn, int first, int last) {
    uint32_t inside = 0, outside = UINT32_MAX >> (32 - fan->count);
    for (int j = first; j < last; j++) inside |= 1u << turn->at[j];
    outside &= ~inside;
    return __builtin_popcount(inside) <= __builtin_popcount(outside) ? inside : outside;
}

static bool any_alive(const State *state, const Fan *fan, uint32_t cells, bool those) {
    for (int k = 0; k < fan->count; k++)
        if (((cells >> k & 1) != 0) == those && state->ablate.cell_flags[fan->cell[k]] & SINGE_ALIVE) return true;
    return false;
}

/// Cells that are connected with others only by the vertex, as those between them have burnt; 0 if there are none.
static uint32_t hinge_part(const State *state, const Fan *fan, const Turn *turn) {
    int start[2] = {-1, -1};
    for (int j = 0; j < turn->count; j++) {
        bool first = j == 0 && !turn->closed;
        if (!is_left(state, fan, turn->at[j])) continue;
        if (!first && is_left(state, fan, turn->at[j > 0 ? j - 1 : turn->count - 1])) continue;
        if (start[0] < 0) start[0] = j;
        else if (start[1] < 0) start[1] = j;
    }

    return start[1] < 0 ? 0 : smaller_part(fan, turn, start[0], start[1]);
}

/// The cells of a vertex that separate from the others; 0 if no edge is loaded enough.
static uint32_t choose_part(const TearPlan *plan, const Shell *shell, const State *state, const TearPull *pull,
                            uint32_t vertex, const Fan *fan) {
    Turn turn = turn_order(fan);

    // cells that only the vertex connects
    if (turn.count < fan->count) return smaller_part(fan, &turn, 0, turn.count);

    const uint32_t hinge = hinge_part(state, fan, &turn);
    if (hinge) return hinge;

    // edges along which it may tear: each is the one that a cell shares with the cell before it
    const Float3 normal = tear_normal(shell, fan), here = float3_load(shell->rest_position[vertex]);
    TearEdge edges[SPLIT_FAN];
    Float3 forward = {0, 0, 0};
    const int begin = turn.closed ? 0 : 1, count = turn.count;
    for (int j = begin; j < count; j++) {
        const int k = turn.at[j];
        uint32_t end = shell->cells[fan->cell[k]][(fan->corner[k] + 1) & 3];
        TearEdge *edge = &edges[j];
        edge->along = float3_unit(float3_sub(float3_load(shell->rest_position[end]), here));
        edge->strength = INFINITY;
        edge->solid = is_left(state, fan, k) && is_left(state, fan, turn.at[j > 0 ? j - 1 : count - 1]);

        float across = tensor_across(pull->force, float3_unit(float3_cross(normal, edge->along)));
        if (across > EDGE_MIN * tensor_across(pull->force, pull->across))
            edge->strength = tear_strength(plan, shell, state, vertex) + tear_strength(plan, shell, state, end);
        if (edge->solid) forward = float3_add(forward, edge->along);
    }

    // the tear's direction: normal to the pull, forwards
    Float3 direction = float3_cross(normal, pull->across);
    if (float3_dot(direction, forward) < 0) direction = float3_scale(direction, -1);
    const float draw = random_unit(state->tear.split_count * 2654435769u); // multiples of the golden section

    // one edge where the sheet is open
    int first = pick_edge(edges, begin, count, direction, draw), second = -1;
    if (first < 0) return 0;
    if (!turn.closed) return smaller_part(fan, &turn, first, count);

    // else two: the open edge that continues the first one the straightest, or one picked backwards
    for (int j = 0; j < count; j++)
        if (!edges[j].solid && (second < 0 || float3_dot(edges[j].along, edges[first].along) <
                                                  float3_dot(edges[second].along, edges[first].along)))
            second = j;
    if (second < 0) second = pick_edge(edges, 0, count, float3_scale(direction, -1), draw);
    if (second < 0 || second == first) return 0;

    return smaller_part(fan, &turn, first < second ? first : second, first < second ? second : first);
}

/// The same; 0 unless cells of both parts are left.
static uint32_t choose_cells(const TearPlan *plan, const Shell *shell, const State *state, const TearPull *pull,
                             uint32_t vertex, const Fan *fan) {
    uint32_t cells = choose_part(plan, shell, state, pull, vertex, fan);
    return cells && any_alive(state, fan, cells, true) && any_alive(state, fan, cells, false) ? cells : 0;
}

typedef struct Ratios {
    TearPlan *plan;
    const Shell *shell;
    const State *state;
} Ratios;

/// Whether the line forces of all cells at a vertex are below `limit` N/m by their norms, which no principal value of
/// their mean exceeds.
static inline bool carries_less(const Ratios *job, uint32_t vertex, float limit) {
    const Shell *shell = job->shell;
    for (uint32_t k = shell->fan_first[vertex]; k < shell->fan_first[vertex + 1]; k++) {
        const float *t = job->plan->smooth[0][shell->fan[k]];
        float norm = t[0] * t[0] + t[1] * t[1] + t[2] * t[2] + 2 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]);
        if (!(norm < limit * limit)) return false;
    }

    return true;
}

/// Whether a vertex cannot tear: what its cells carry is well below its strength even for a hinge, and below what lets a
/// stretched edge tear it, or there is none.
static inline bool is_far_from_tearing(const Ratios *job, uint32_t vertex) {
    const TearPlan *plan = job->plan;
    const float margin = 0.9f, hinge = margin * TEAR_HINGE;
    if (carries_less(job, vertex, hinge * plan->safe_ash)) return true; // as the strength is at least that
    if (!carries_less(job, vertex, hinge * tear_strength(plan, job->shell, job->state, vertex))) return false;
    return carries_less(job, vertex, margin * plan->safe) || !tear_is_stretched(job->shell, job->state, vertex);
}

/// How close each vertex is to tearing; 0 if it would tear but can along none of its edges, or is far from it.
static void fill_ratios(void *task, int begin, int end) {
    const Ratios *job = task;
    for (uint32_t v = (uint32_t)begin; v < (uint32_t)end; v++) {
        job->plan->ratio[v] = 0;
        if (is_far_from_tearing(job, v)) continue;

        TearPull pull = tear_pull(job->plan, job->shell, job->state, v);
        Fan fan;
        if (pull.ratio > TEAR_HINGE) {
            split_fan(job->shell, v, &fan);
            Turn turn = turn_order(&fan);
            if (turn.count == fan.count && hinge_part(job->state, &fan, &turn)) pull.ratio /= TEAR_HINGE;
        }

        if (pull.ratio > 1 && !choose_cells(job->plan, job->shell, job->state, &pull, v, &fan)) pull.ratio = 0;
        job->plan->ratio[v] = pull.ratio;
    }
}

/// Separates cells that are connected only by a vertex.
static void separate(Shell *shell, State *state, uint32_t vertex) {
    for (;;) {
        Fan fan;
        SplitResult result;
        split_fan(shell, vertex, &fan);
        Turn turn = turn_order(&fan);
        if (turn.count == fan.count || state->dynamics.pinned[vertex]) return;

        ShellSplit split = {vertex, smaller_part(&fan, &turn, 0, turn.count), SHELL_NONE};
        if (!split_is_possible(shell, &fan, &split)) return;
        tear_split(shell, state, &fan, &split, &result);
        if (!(split.cells & 1u << turn.at[0])) return; // the rest went, and may be connected only by the new vertex
    }
}

/// Splits a vertex, if it can. Keeps two spare vertices for the ends of the edges that it tears.
static void tear_vertex(TearPlan *plan, Shell *shell, State *state, uint32_t vertex, bool *short_of_spares) {
    TearPull pull = tear_pull(plan, shell, state, vertex);
    const Sheet *sheet = &shell->sheets[shell->matter.sheet[vertex]];
    Fan fan;
    SplitResult result;

    split_fan(shell, vertex, &fan);
    ShellSplit split = {vertex, choose_cells(plan, shell, state, &pull, vertex, &fan), SHELL_NONE};
    if (split.cells == 0) return;
    if (sheet->spare_used + 1 + SPLIT_EDGES > sheet->spare_count || !split_is_possible(shell, &fan, &split)) {
        *short_of_spares = true;
        return;
    }

    // the new tear no longer carries the line force across it
    for (int k = 0; k < fan.count; k++) {
        float *force = state->tear.line_force[fan.cell[k]], carried = tensor_across(force, pull.across);
        if (carried > 0) tensor_add(force, pull.across, -carried);
    }

    tear_split(shell, state, &fan, &split, &result);
    for (int k = 0; k < result.torn_count; k++) separate(shell, state, result.torn[k].far);
}

uint32_t tear_step(TearPlan *plan, Shell *shell, State *state, const float *const pull[SINGE_COLOUR_COUNT], Pool *pool,
                   float h, bool *short_of_spares) {
    uint32_t before = state->tear.split_count;
    *short_of_spares = false;
    if (tear_measure(plan, shell, state, pull, pool, h) == 0) return 0;

    // ends of torn edges
    if (plan->split_count != shell->split_count) {
        const SpringSet *blue = &shell->springs[SINGE_BLUE];
        uint32_t first = blue->count - shell->edge_spare_count;
        plan->split_count = shell->split_count;
        memset(plan->torn, 0, plan->vertex_count);
        for (uint32_t k = 0; k < shell->edge_spare_used; k++)
            for (int end = 0; end < 2; end++)
                plan->torn[blue->ends[first + k][end]] = plan->torn[blue->ends[shell->edge_origin[k]][end]] = 1;
    }

    // how close each vertex is to tearing
    Ratios job = {plan, shell, state};
    tear_smooth(plan, shell, state, pool);
    pool_for(pool, (int)plan->vertex_count, POOL_GRAIN, fill_ratios, &job);

    // of every piece, that a tear runs in it, or the vertex where one may begin
    memset(plan->leader, 0xff, plan->particle_count * sizeof *plan->leader);
    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        if (!(plan->ratio[v] > 1)) continue;
        SINGE_ASSERT(state->ablate.piece[v] >= 0); // only what is left can tear
        uint32_t *leader = &plan->leader[state->ablate.piece[v]];
        if (plan->torn[v]) *leader = LEADER_RUNS;
        else if (*leader == SHELL_NONE || (*leader != LEADER_RUNS && plan->ratio[v] > plan->ratio[*leader]))
            *leader = v;
    }

    for (uint32_t v = 0; v < plan->vertex_count; v++) {
        if (!(plan->ratio[v] > 1)) continue;
        uint32_t leader = plan->leader[state->ablate.piece[v]];
        bool may = leader == LEADER_RUNS ? plan->torn[v] : leader == v;
        if (may && is_weakest(plan, shell, v)) tear_vertex(plan, shell, state, v, short_of_spares);
    }

    return state->tear.split_count - before;
}
