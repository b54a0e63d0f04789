// The paper's methods, on a Network in double precision: its own (eq 16 to 19), the same to the letter, all springs in
// one system, and the mass-spring model of section 8.
//
// Successive fast projection as in the paper (section 7.1): each of `projections` steps projects the colours one after
// another, each to the solution of its linear system, and then moves particles out of colliders.
//
// With early_exit the projection steps also end after one in which every colour began with a residual below `tolerance`
// of its target lengths, so that there was nothing to solve.
#include "common/clock.h"
#include "dynamics/dynamics_plan.h"
#include "dynamics/stiffness.h"
#include "reference/spring_network.h"

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

static bool paper_create(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    static const uint32_t sides[] = {0, 3, 1, 2}; // on a grid the first two sides of all cells are nearly all edges
    Paper *paper;
    if (!NEW(memory, plan->paper, 1)) return false;

    paper = plan->paper;
    paper->solver = plan->settings.solver;
    paper->particle_count = shell->particle_count;
    if (!NEW(memory, paper->predicted, shell->particle_count)) return false;

    // a network of the springs in their order
    NetworkSprings springs[SINGE_COLOUR_COUNT];
    uint32_t total = 0, (*ends)[2];
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) total += shell->springs[c].count;
    bool ok = NEW(memory, ends, total);

    for (uint32_t c = 0, first = 0; ok && c < SINGE_COLOUR_COUNT; first += springs[c++].count) {
        springs[c] = (NetworkSprings){shell->springs[c].count, (const uint32_t(*)[2])(ends + first)};

        // number them slot by slot, and within a slot cell by cell. Then the neighbours of springs in a row are in a
        // row themselves, along the lines of a grid, and the matrix is read in runs
        const SpringSet *set = &shell->springs[c];
        uint8_t *seen = NULL;
        paper->spring_count[c] = set->count;
        ok = NEW(memory, paper->order[c], set->count) && NEW(memory, seen, set->count);

        uint32_t(*const rows)[2] = ends + first;
        for (uint32_t slot = 0, row = 0; ok && slot < 4; slot++)
            for (uint32_t cell = 0; cell < shell->cell_count; cell++) {
                const CellSprings *around = &shell->cell_springs[cell];
                uint32_t k = c == SINGE_RED     ? around->red[slot]
                             : c == SINGE_GREEN ? around->green[sides[slot]]
                             : c == SINGE_BLUE  ? around->blue[sides[slot]]
                             : slot < 2         ? around->yellow[slot]
                                                : SHELL_NONE;
                if (k == SHELL_NONE || seen[k]) continue;
                seen[k] = 1;
                uint32_t a = set->ends[k][0], b = set->ends[k][1];
                rows[row][0] = a < b ? a : b;
                rows[row][1] = a < b ? b : a;
                paper->order[c][row++] = k;
            }
        FREE(memory, seen, set->count);
    }

    bool one = paper_one_system(paper->solver.method), matrix = paper->solver.method != SINGE_SOLVER_MASS_SPRING;
    if (one) springs[0].count = total;
    ok = ok && network_create(memory, shell->particle_count, one ? 1 : SINGE_COLOUR_COUNT, springs, matrix,
                              &paper->network) == SINGE_OK;
    FREE(memory, ends, total);
    if (ok) paper->network.kernel = conjugate_choose(plan->settings.instructions);
    return ok;
}

static void paper_release(Memory *memory, const Shell *shell, DynamicsPlan *plan) {
    (void)shell;
    Paper *paper = plan->paper;
    if (!paper) return;

    FREE(memory, paper->predicted, paper->particle_count);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) FREE(memory, paper->order[c], paper->spring_count[c]);
    network_free(memory, &paper->network);
    FREE(memory, plan->paper, 1);
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
    Stiffness stiffness;
    stiffness_begin(job->shell, job->colour, 0, &job->plan->settings.solver, &stiffness);
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

static void paper_prepare(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool,
                          const DynamicsState *dynamics) {
    (void)dynamics;
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
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) job->dynamics->position[i][c] = (float)job->paper->network.position[i][c];
}

/// Takes over positions that changed since paper_put; the others keep their double precision.
static void paper_take(void *task, int begin, int end) {
    const Exchange *job = task;
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) {
            double *x = &job->paper->network.position[i][c];
            if (job->dynamics->position[i][c] != (float)*x) *x = (double)job->dynamics->position[i][c];
        }
}

/// Eq 13: v^ = v~ + (x^ - x~)/h.
static void paper_finish(void *task, int begin, int end) {
    const Exchange *job = task;
    for (int i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) {
            double moved = job->paper->network.position[i][c] - job->paper->predicted[i][c];
            job->dynamics->velocity[i][c] = (float)((double)job->dynamics->velocity[i][c] + moved / job->h);
        }
    paper_put(task, begin, end);
}

/// One projection step (eq 18): *solved says whether any system had something to solve.
static SingeResult paper_step(Paper *paper, Pool *pool, DynamicsCounters *counters, bool *solved, SingeError *error) {
    static const char *const names[] = {"red", "green", "blue", "yellow"};
    bool one = paper_one_system(paper->solver.method);
    *solved = false;
    for (int i = 0; i < (one ? 1 : SINGE_COLOUR_COUNT); i++) {
        uint32_t group = one ? 0 : (uint32_t)paper->solver.order[i];
        ProjectionReport report = network_project(&paper->network, group, pool);
        counters->springs += paper->network.groups[group].count;
        counters->iterations += report.iterations;
        counters->flops += report.flops;
        counters->bytes += report.bytes;
        if (report.broken)
            return error_set(error, SINGE_ERROR_DIVERGED, "dynamics", -1,
                             "the system of %s springs is singular or not finite, and conjugate gradients broke down; "
                             "a smaller time_step, more substeps or the method paper may help",
                             one ? "all" : names[group]);
        if (report.iterations) *solved = true;
    }

    return SINGE_OK;
}

static SingeResult paper_project(DynamicsPlan *plan, const Substep *substep) {
    Paper *paper = plan->paper;
    const SingeSolverDef *solver = &paper->solver;
    Pool *pool = substep->pool;
    DynamicsState *dynamics = substep->dynamics;
    DynamicsCounters *counters = substep->counters;
    const int particles = (int)substep->shell->particle_count;
    const double h = (double)substep->h;
    Exchange exchange = {paper, plan, dynamics, h};

    // to double precision
    paper->network.rules = (ProjectionRules){.literal = solver->method == SINGE_SOLVER_PAPER_LITERAL,
                                             .early_exit = solver->early_exit,
                                             .tolerance = (double)solver->tolerance,
                                             .iterations = PAPER_ITERATIONS,
                                             .inverse_h2 = 1 / (h * h)};
    pool_for(pool, particles, POOL_BLOCK, paper_begin, &exchange);

    // projections, each followed by contact
    const bool hooke = solver->method == SINGE_SOLVER_MASS_SPRING;
    bool solved = true;
    int max = hooke ? 1 : solver->projections; // forces act once a substep
    for (int projection = 0; projection < max && (solved || !solver->early_exit); projection++) {
        double start = clock_seconds();
        if (hooke) {
            ProjectionReport report = mass_spring_project(&paper->network, (double)solver->stiffness,
                                                          (const float(*)[4])dynamics->velocity, h, pool);
            counters->flops += report.flops;
            counters->bytes += report.bytes;
            counters->springs += paper->network.groups[0].count;
        } else {
            TRY(paper_step(paper, pool, counters, &solved, substep->error));
        }
        TRY(pool_check_cancelled(pool, "dynamics", substep->error));

        counters->seconds += clock_seconds() - start;
        if (substep->collider_count == 0) continue;
        pool_for(pool, particles, POOL_BLOCK, paper_put, &exchange);
        counters->contacts += contact_project(plan, substep->collider_count, pool, substep->h, dynamics);
        pool_for(pool, particles, POOL_BLOCK, paper_take, &exchange);
    }

    // heights of centres, and back to single precision
    if (solver->height_min > 0) {
        pool_for(pool, particles, POOL_BLOCK, paper_put, &exchange);
        height_project(plan, substep->shell, substep->state->ablate, pool, dynamics);
        pool_for(pool, particles, POOL_BLOCK, paper_take, &exchange);
    }

    pool_for(pool, particles, POOL_BLOCK, paper_finish, &exchange);
    return SINGE_OK;
}

const Solver paper_solver = {
    .create = paper_create, .release = paper_release, .prepare = paper_prepare, .project = paper_project};
