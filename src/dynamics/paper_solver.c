// Successive fast projection as in the paper (section 7.1): each of `projections` steps projects the colours one after
// another, each to the solution of its linear system, and then moves particles out of colliders.
//
// With early_exit the projection steps also end after one in which every colour began with a residual below `tolerance`
// of its target lengths, so that there was nothing to solve.
#include "common/assertion.h"
#include "dynamics/paper_solver.h"

#include "common/clock.h"
#include "dynamics/stiffness.h"

/// A system of n rows takes some hundreds of iterations at most; a singular one would not end.
enum { PAPER_ITERATIONS = 5000 };

struct Paper {
    SingeSolverDef solver;
    Network network;
    uint32_t particle_count;
    double (*predicted)[3];              ///< m, x~
    uint32_t *order[SINGE_COLOUR_COUNT]; ///< the springs of each colour in the order of the network's rows
    uint32_t spring_count[SINGE_COLOUR_COUNT];
};

static bool paper_one_system(SingeSolverMethod method) {
    return method == SINGE_SOLVER_ALL_AT_ONCE || method == SINGE_SOLVER_MASS_SPRING;
}

/// Spring `slot` of a cell, of the slots of its colour in the order in which they are numbered.
static uint32_t paper_slot(const CellSprings *cell, SingeColour colour, uint32_t slot) {
    SINGE_ASSERT((unsigned)colour < SINGE_COLOUR_COUNT);
    static const uint32_t sides[] = {0, 3, 1, 2}; // on a grid the first two sides of all cells are nearly all edges
    switch (colour) {
    case SINGE_RED: return cell->red[slot];
    case SINGE_GREEN: return cell->green[sides[slot]];
    case SINGE_BLUE: return cell->blue[sides[slot]];
    default: return slot < 2 ? cell->yellow[slot] : SHELL_NONE;
    }
}

/// Numbers a colour's springs slot by slot, and within a slot cell by cell. Then the neighbours of springs in a row are
/// in a row themselves, along the lines of a grid, and the matrix is read in runs. `ends`: of the springs, by row.
static bool paper_number(Memory *memory, const Shell *shell, SingeColour colour, Paper *paper, uint32_t (*ends)[2]) {
    SINGE_ASSERT((unsigned)colour < SINGE_COLOUR_COUNT);
    const SpringSet *set = &shell->springs[colour];
    uint8_t *seen;
    paper->spring_count[colour] = set->count;
    if (!NEW(memory, paper->order[colour], set->count) || !NEW(memory, seen, set->count)) return false;
    uint32_t row = 0;
    for (uint32_t slot = 0; slot < 4; slot++)
        for (uint32_t cell = 0; cell < shell->cell_count; cell++) {
            uint32_t k = paper_slot(&shell->cell_springs[cell], colour, slot);
            if (k == SHELL_NONE || seen[k]) continue;
            seen[k] = 1;
            uint32_t a = set->ends[k][0], b = set->ends[k][1];
            ends[row][0] = a < b ? a : b;
            ends[row][1] = a < b ? b : a;
            paper->order[colour][row++] = k;
        }
    FREE(memory, seen, set->count);
    return true;
}

static SingeResult paper_create_network(Memory *memory, const Shell *shell, Paper *paper) {
    NetworkSprings springs[SINGE_COLOUR_COUNT];
    uint32_t total = 0, (*ends)[2];
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) total += shell->springs[c].count;
    bool ok = NEW(memory, ends, total);
    for (uint32_t c = 0, first = 0; ok && c < SINGE_COLOUR_COUNT; first += springs[c++].count) {
        springs[c] = (NetworkSprings){shell->springs[c].count, (const uint32_t(*)[2])(ends + first)};
        ok = paper_number(memory, shell, (SingeColour)c, paper, ends + first);
    }
    bool one = paper_one_system(paper->solver.method), matrix = paper->solver.method != SINGE_SOLVER_MASS_SPRING;
    if (one) springs[0].count = total;
    SingeResult result = SINGE_ERROR_MEMORY;
    if (ok)
        result = network_create(memory, shell->particle_count, one ? 1 : SINGE_COLOUR_COUNT, springs, matrix,
                                &paper->network);
    FREE(memory, ends, total);
    return result;
}

SingeResult paper_create(Memory *memory, const Shell *shell, const DynamicsSettings *settings, Paper **out) {
    *out = NULL;
    Paper *paper = memory_new(memory, 1, sizeof *paper);
    if (!paper) return SINGE_ERROR_MEMORY;
    paper->solver = settings->solver;
    paper->particle_count = shell->particle_count;
    if (!NEW(memory, paper->predicted, shell->particle_count) || paper_create_network(memory, shell, paper)) {
        paper_free(memory, paper);
        return SINGE_ERROR_MEMORY;
    }
    paper->network.kernel = conjugate_choose(settings->instructions);
    *out = paper;
    return SINGE_OK;
}

void paper_free(Memory *memory, Paper *paper) {
    if (!paper) return;
    FREE(memory, paper->predicted, paper->particle_count);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) FREE(memory, paper->order[c], paper->spring_count[c]);
    network_free(memory, &paper->network);
    FREE(memory, paper, 1);
}

// ---- a step's masses, weights and lengths

typedef struct Fill {
    Paper *paper;
    const DynamicsPlan *plan;
    const Shell *shell;
    const StateInput *state;
    SpringGroup *group;
    uint32_t offset; ///< of the colour's springs in the group
    SingeColour colour;
} Fill;

static void paper_fill_particles(void *task, int begin, int end) {
    const Fill *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end && (uint32_t)end <= job->shell->particle_count);
    Network *network = &job->paper->network;
    bool literal = job->paper->solver.method == SINGE_SOLVER_PAPER_LITERAL;
    for (int i = begin; i < end; i++) {
        network->inverse_mass[i] = (double)job->plan->inverse_mass[i];
        // to the letter: M = I, and held particles are put back afterwards
        if (literal) network->inverse_mass[i] = job->state->ablate->particle_flags[i] & SINGE_ALIVE ? 1 : 0;
        network->held[i] = job->plan->inverse_mass[i] == 0;
    }
}

static void paper_fill_springs(void *task, int begin, int end) {
    const Fill *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    Stiffness stiffness;
    stiffness_begin(job->shell, job->colour, 0, 0, &stiffness);
    const float *length = job->state->burn->spring_length[job->colour];
    const Field material = job->shell->matter.weight[job->colour];
    const uint8_t *flags = job->state->ablate->spring_flags[job->colour];
    for (uint32_t k = (uint32_t)begin; k < (uint32_t)end; k++) {
        uint32_t spring = job->paper->order[job->colour][k], row = job->offset + k;
        const uint32_t *ends = job->group->ends[row];
        job->group->length[row] = (double)length[spring];
        job->group->compliance[row] = (double)stiffness_compliance(&stiffness, spring);
        bool alive = flags[spring] & SINGE_ALIVE;
        job->group->weight[row] = alive ? (double)dynamics_weight(material, job->plan->soft, ends[0], ends[1]) : 0;
    }
}

void paper_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool) {
    Paper *paper = plan->paper;
    Fill job = {.paper = paper, .plan = plan, .shell = shell, .state = state, .group = paper->network.groups};
    pool_for(pool, (int)shell->particle_count, POOL_BLOCK, paper_fill_particles, &job);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        job.colour = (SingeColour)c;
        pool_for(pool, (int)shell->springs[c].count, POOL_BLOCK, paper_fill_springs, &job);
        bool plain = paper->solver.method == SINGE_SOLVER_ALL_AT_ONCE; // the floor would make it converge
        job.group->regularisation = plain ? 0 : (double)paper->solver.regularisation[c];
        if (paper_one_system(paper->solver.method)) job.offset += shell->springs[c].count;
        else job.group++;
    }
}

// ---- a substep

typedef struct Exchange {
    Paper *paper;
    const DynamicsPlan *plan;
    DynamicsState *dynamics;
    double h;
} Exchange;

static void paper_begin(void *task, int begin, int end) {
    const Exchange *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    bool literal = job->paper->solver.method == SINGE_SOLVER_PAPER_LITERAL;
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) {
            double x = (double)job->dynamics->position[i][c];
            // eq 9 to the letter is x~ = x + v~; the prediction has made it x + h v~
            if (literal && job->plan->inverse_mass[i] > 0) x += (1 - job->h) * (double)job->dynamics->velocity[i][c];
            job->paper->network.position[i][c] = job->paper->predicted[i][c] = x;
        }
}

/// Positions to single precision: for the contacts, and for the state.
static void paper_put(void *task, int begin, int end) {
    const Exchange *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) job->dynamics->position[i][c] = (float)job->paper->network.position[i][c];
}

/// Takes over positions that changed since paper_put; the others keep their double precision.
static void paper_take(void *task, int begin, int end) {
    const Exchange *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) {
            double *x = &job->paper->network.position[i][c];
            if (job->dynamics->position[i][c] != (float)*x) *x = (double)job->dynamics->position[i][c];
        }
}

/// Eq 13: v^ = v~ + (x^ - x~)/h.
static void paper_finish(void *task, int begin, int end) {
    const Exchange *job = task;
    SINGE_ASSERT(begin >= 0 && begin <= end);
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) {
            double moved = job->paper->network.position[i][c] - job->paper->predicted[i][c];
            job->dynamics->velocity[i][c] = (float)((double)job->dynamics->velocity[i][c] + moved / job->h);
        }
    paper_put(task, begin, end);
}

static SingeResult paper_broken(const Paper *paper, SingeColour colour, SingeError *error) {
    SINGE_ASSERT((unsigned)colour < SINGE_COLOUR_COUNT);
    static const char *const names[] = {"red", "green", "blue", "yellow"};
    return error_set(
        error, SINGE_ERROR_DIVERGED, "dynamics", -1,
        "the system of %s springs is singular or not finite, and conjugate gradients broke down; a smaller "
        "time_step, more substeps or the method paper may help",
        paper_one_system(paper->solver.method) ? "all" : names[colour]);
}

/// One projection step (eq 18): *solved says whether any system had something to solve.
static SingeResult paper_step(Paper *paper, Pool *pool, DynamicsCounters *counters, bool *solved, SingeError *error) {
    bool one = paper_one_system(paper->solver.method);
    *solved = false;
    for (int i = 0; i < (one ? 1 : SINGE_COLOUR_COUNT); i++) {
        uint32_t group = one ? 0 : (uint32_t)paper->solver.order[i];
        ProjectionReport report = network_project(&paper->network, group, pool);
        counters->springs += paper->network.groups[group].count;
        counters->iterations += report.iterations;
        counters->flops += report.flops;
        counters->bytes += report.bytes;
        if (report.broken) return paper_broken(paper, (SingeColour)group, error);
        if (report.iterations) *solved = true;
    }
    return SINGE_OK;
}

static void paper_hooke(Paper *paper, Pool *pool, float h, const DynamicsState *dynamics, DynamicsCounters *counters) {
    SINGE_ASSERT(h > 0);
    ProjectionReport report = mass_spring_project(&paper->network, (double)paper->solver.stiffness,
                                                  (const float(*)[4])dynamics->velocity, (double)h, pool);
    counters->flops += report.flops;
    counters->bytes += report.bytes;
    counters->springs += paper->network.groups[0].count;
}

SingeResult paper_project(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, uint32_t collider_count,
                          Pool *pool, float h, DynamicsState *dynamics, DynamicsCounters *counters, SingeError *error) {
    SINGE_ASSERT(h > 0);
    Paper *paper = plan->paper;
    const SingeSolverDef *solver = &paper->solver;
    int particles = (int)shell->particle_count;
    Exchange exchange = {paper, plan, dynamics, (double)h};

    // to double precision
    paper->network.rules = (ProjectionRules){.literal = solver->method == SINGE_SOLVER_PAPER_LITERAL,
                                             .early_exit = solver->early_exit,
                                             .tolerance = (double)solver->tolerance,
                                             .iterations = PAPER_ITERATIONS,
                                             .inverse_h2 = 1 / ((double)h * (double)h)};
    pool_for(pool, particles, POOL_BLOCK, paper_begin, &exchange);

    // projections, each followed by contact
    bool solved = true;
    int max = solver->method == SINGE_SOLVER_MASS_SPRING ? 1 : solver->projections; // forces act once a substep
    for (int projection = 0; projection < max && (solved || !solver->early_exit); projection++) {
        double start = clock_seconds();
        if (solver->method == SINGE_SOLVER_MASS_SPRING) paper_hooke(paper, pool, h, dynamics, counters);
        else TRY(paper_step(paper, pool, counters, &solved, error));
        counters->seconds += clock_seconds() - start;
        if (collider_count == 0) continue;
        pool_for(pool, particles, POOL_BLOCK, paper_put, &exchange);
        counters->contacts += contact_project(plan, collider_count, pool, h, dynamics);
        pool_for(pool, particles, POOL_BLOCK, paper_take, &exchange);
    }

    // heights of centres, and back to single precision
    if (solver->height_min > 0) {
        pool_for(pool, particles, POOL_BLOCK, paper_put, &exchange);
        height_project(plan, shell, ablate, pool, dynamics);
        pool_for(pool, particles, POOL_BLOCK, paper_take, &exchange);
    }
    pool_for(pool, particles, POOL_BLOCK, paper_finish, &exchange);
    return SINGE_OK;
}
