// Braces: springs between the centres of cells that meet at a vertex and share no side, with `solver.isotropic`. Green
// springs alone resist no shear of their layer. Then bending has nu = 0 along the mesh and almost 1 along its diagonals,
// and twist is borne by red springs only, by s^2. With braces both layers are alike, and stiffness.c makes bending
// isotropic.
//
// Braces are at vertices with four cells around them. They continue across cells and make strands, which are projected
// after those of the green springs. A brace is there while the four green springs around its vertex are. Its target
// length follows from the masses as those of other springs do (shell/target_length.h): a State has none of them. Creases
// lengthen it by the mean of the four green springs' squares, as in a parallelogram.
#include "dynamics/brace.h"

#include "dynamics/dynamics_plan.h"
#include "shell/rest_lengths.h"
#include "shell/strand.h"
#include "shell/target_length.h"

#include <math.h>

/// The cells around a vertex in order, each one's corner there, and the green springs from one to the next.
typedef struct Ring {
    uint32_t cell[4], corner[4], green[4];
} Ring;

/// False unless four cells lie around it.
static bool ring_around(const Shell *shell, uint32_t vertex, Ring *ring) {
    const uint32_t first = shell->fan_first[vertex], count = shell->fan_first[vertex + 1] - first;
    if (count != 4) return false;
    uint32_t cell = shell->fan[first];
    for (int k = 0; k < 4; k++) {
        uint32_t corner = 0;
        while (shell->cells[cell][corner] != vertex) corner++;
        const int side = (int)(corner + 3) & 3;
        ring->cell[k] = cell;
        ring->corner[k] = corner;
        ring->green[k] = shell->cell_springs[cell].green[side];
        cell = shell_neighbour(shell, cell, side);
        if (cell == SHELL_NONE) return false;
    }
    return cell == ring->cell[0];
}

/// Ends, continuations and strands; `at_end` has the end of a brace at each corner of each cell.
static bool brace_strands(Memory *memory, const Shell *shell, Braces *braces, uint32_t *at_end, uint32_t *number) {
    uint32_t count = 0;
    Ring ring;
    for (uint32_t c = 0; c < 4 * shell->cell_count; c++) at_end[c] = SHELL_NONE;
    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        if (!ring_around(shell, v, &ring)) continue;
        for (uint32_t k = 0; k < 4; k++) at_end[4 * ring.cell[k] + ring.corner[k]] = 2 * (count + (k & 1)) + (k >> 1);
        count += 2;
    }

    LooseSprings loose = {.count = count};
    SingeError error;
    bool done = NEW(memory, loose.ends, count) && NEW(memory, loose.mate, 2 * (size_t)count);
    for (uint32_t e = 0; e < 2 * count && done; e++) loose.mate[e] = SHELL_NONE;
    for (uint32_t c = 0; c < 4 * shell->cell_count && done; c++) {
        const uint32_t end = at_end[c], beyond = at_end[c ^ 2];
        if (end == SHELL_NONE) continue;
        loose.ends[end / 2][end & 1] = shell_centre(shell, c / 4);
        if ((c & 2) == 0 && beyond != SHELL_NONE) strand_join(&loose, end, beyond);
    }

    done = done && strand_build(memory, shell->particle_count, &loose, &braces->springs, number, &error) == SINGE_OK;
    FREE(memory, loose.ends, count);
    FREE(memory, loose.mate, 2 * (size_t)count);
    return done;
}

bool braces_create(Memory *memory, const Shell *shell, Braces *braces) {
    uint32_t *at_end = NULL, *number = NULL;
    const size_t corners = 4 * (size_t)shell->cell_count;
    SpringSet *springs = &braces->springs;
    bool done = NEW(memory, at_end, corners) && NEW(memory, number, corners) &&
                brace_strands(memory, shell, braces, at_end, number);
    done = done && NEW(memory, braces->green, springs->count);
    if (done && shell->springs[SINGE_GREEN].grain) done = NEW(memory, springs->grain, springs->count) != NULL;

    // the green springs around each, rest lengths, directions to the fibres
    Ring ring;
    for (uint32_t v = 0, next = 0; v < shell->vertex_count && done; v++) {
        if (!ring_around(shell, v, &ring)) continue;
        for (int k = 0; k < 2; k++) {
            const uint32_t brace = number[next++], *ends = springs->ends[brace];
            const Float3 along =
                float3_sub(float3_load(shell->rest_position[ends[1]]), float3_load(shell->rest_position[ends[0]]));
            springs->rest[brace] = float3_length(along);
            for (int i = 0; i < 4; i++) braces->green[brace][i] = ring.green[i];
            for (int i = 0; i < 4 && springs->grain; i++)
                springs->grain[brace] += 0.25f * cell_grain(shell, ring.cell[i], along);
        }
    }

    FREE(memory, at_end, corners);
    FREE(memory, number, corners);
    return done && strand_set_create(memory, springs, shell->particle_count, false, &braces->set);
}

void braces_free(Memory *memory, Braces *braces) {
    FREE(memory, braces->green, braces->springs.count);
    strand_free(memory, &braces->springs);
    strand_set_free(memory, &braces->set);
}

float brace_length(const Braces *braces, const DynamicsPlan *plan, const Shell *shell, const StateInput *state,
                   const DynamicsState *dynamics, uint32_t brace) {
    const uint32_t *ends = braces->springs.ends[brace], *green = braces->green[brace];
    const SpringEnds both =
        spring_ends(&shell->matter, state->burn, (const uint32_t[4]){ends[0], ends[1], ends[0], ends[1]});
    const uint32_t same[4] = {brace, brace, brace, brace};
    const float length = target_lengths(&braces->springs, same, both, spring_ends_turned(both), NULL)[0];
    if (!plan->creased) return length;

    float flat = 0, creased = 0;
    for (int i = 0; i < 4; i++) {
        const float target = state->burn->spring_length[SINGE_GREEN][green[i]];
        const float held = target * crease_factor(plan, shell, state, dynamics, green[i]);
        flat += target * target;
        creased += held * held;
    }
    return flat > 0 ? length * sqrtf(creased / flat) : length;
}

bool brace_is_there(const Braces *braces, const AblateState *ablate, uint32_t brace) {
    uint8_t flags = SINGE_ALIVE;
    for (int i = 0; i < 4; i++) flags &= ablate->spring_flags[SINGE_GREEN][braces->green[brace][i]];
    return flags & SINGE_ALIVE;
}

typedef struct BracePass {
    Braces *braces;
    const DynamicsPlan *plan;
    const Shell *shell;
    const StateInput *state;
    const DynamicsState *dynamics;
} BracePass;

static void prepare_strands(void *task, int begin, int end) {
    const BracePass *pass = task;
    const SpringSet *springs = &pass->braces->springs;
    StrandSet *set = &pass->braces->set;
    const Field weight = pass->shell->matter.weight[SINGE_GREEN];
    for (int s = begin; s < end; s++) {
        size_t slot = set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k < springs->strand_first[s + 1]; k++, slot += STRAND_LANES) {
            const uint32_t *ends = springs->ends[k];
            const bool there = brace_is_there(pass->braces, pass->state->ablate, k);
            set->weight[slot] = there ? 0.5f * dynamics_weight(weight, pass->plan->soft, ends[0], ends[1]) : 0;
            const float length = brace_length(pass->braces, pass->plan, pass->shell, pass->state, pass->dynamics, k);
            set->target[slot] = length * length;
        }
    }
}

void braces_prepare(Braces *braces, const DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                    const DynamicsState *dynamics) {
    BracePass pass = {braces, plan, shell, state, dynamics};
    const SpringSet *springs = &braces->springs;
    const int grain = 1 + (int)((uint64_t)POOL_BLOCK * springs->strand_count / (springs->count + 1));
    pool_for(pool, (int)springs->strand_count, grain, prepare_strands, &pass);
}
