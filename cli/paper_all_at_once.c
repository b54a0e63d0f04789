// Section 7.1's reason for projecting colour after colour: all springs in one system have more constraints than there
// are degrees of freedom, 10 to 6, so the matrix is singular, and fast projection diverges. Here both are looked at on
// a sheet that has swung for a while: ranks and singular values of J M^-1/2, and errors over projection steps.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/paper.h"
#include "cli/paper_states.h"
#include "cli/singular.h"

enum { CELLS = 6, WARM_STEPS = 200, STEPS = 7, SMALLEST = 4 };

static const double zero_share = 1e-10; // of the largest singular value: below it one is 0

/// Prints a line about one set: constraints, rank, the largest and the smallest singular values.
static SingeResult set_print(SingeNetwork *network, uint32_t set, const char *name, uint32_t particles) {
    size_t rows = singe_network_set_size(network, set), columns = 3 * (size_t)particles;
    size_t count = rows < columns ? rows : columns, rank = 0;
    double *jacobian = malloc(rows * columns * sizeof *jacobian), *values = malloc(count * sizeof *values);
    SingeResult result = SINGE_ERROR_MEMORY;
    if (jacobian && values) {
        singe_network_jacobian(network, set, jacobian);
        if (singular_values(jacobian, rows, columns, values) == 0) result = SINGE_OK;
    }
    if (!result) {
        while (rank < count && values[rank] > zero_share * values[0]) rank++;
        printf("%-7s %11zu %6zu %9zu   1 ", name, rows, rank, rows - rank);
        for (size_t i = rank > SMALLEST ? rank - SMALLEST : 0; i < rank; i++) printf(" %.2e", values[i] / values[0]);
        printf("\n");
    }
    free(jacobian);
    free(values);
    return result;
}

static SingeResult ranks_print(const SingeSim *sim, SingeNetwork *all, SingeNetwork *colours) {
    static const char *const names[] = {"red", "green", "blue", "yellow"};
    SingeView view = singe_sim_view(sim);
    uint32_t free_count = 0, springs = singe_network_set_size(all, 0);
    for (uint32_t i = 0; i < view.particle_count; i++) free_count += !(view.particle_flags[i] & SINGE_PINNED);
    printf("%d x %d cells: %u constraints, %u degrees of freedom (10 to %.2f; 10 to 6 on a sheet without end)\n\n"
           "springs constraints   rank  too many   singular values of J M^-1/2 over the largest: that, and the smallest "
           "above 0\n",
           CELLS, CELLS, springs, 3 * free_count, 10.0 * 3 * free_count / springs);
    SingeResult result = set_print(all, 0, "all", view.particle_count);
    for (uint32_t c = 0; c < SINGE_COLOUR_COUNT && !result; c++)
        result = set_print(colours, c, names[c], view.particle_count);
    return result;
}

typedef struct Contender {
    SingeNetwork *network;
    uint32_t sets;
} Contender;

/// Takes a projection step, but for step 0, and prints the error after it.
static void contender_print(const Contender *contender, int step) {
    double errors[SINGE_COLOUR_COUNT], square = 0;
    uint32_t iterations = 0;
    bool broken = false;
    for (uint32_t set = 0; set < contender->sets && step > 0; set++) {
        SingeNetworkReport report = {0};
        if (singe_network_project(contender->network, set, &report)) broken = true;
        iterations += report.iterations;
    }
    paper_errors(contender->network, contender->sets, errors);
    for (uint32_t set = 0; set < contender->sets; set++) square += errors[set] * errors[set];
    printf("  %-9.3g %5u%-12s", sqrt(square), iterations, broken ? " broke down" : "");
}

static SingeResult all_at_once_run(const SingeSim *sim, SingeError *error) {
    const double floor = singe_default_network().regularisation;
    // plain, successive, and plain with the floor on the diagonal that solver: paper has
    Contender contenders[] = {{.sets = 1}, {.sets = SINGE_COLOUR_COUNT}, {.sets = 1}};
    const double floors[] = {0, floor, floor};
    enum { COUNT = sizeof contenders / sizeof *contenders };
    SingeResult result = SINGE_OK;
    for (int i = 0; i < COUNT && !result; i++)
        result = paper_network(sim, PAPER_SWING, contenders[i].sets == 1, floors[i], &contenders[i].network, error);
    if (!result) result = ranks_print(sim, contenders[0].network, contenders[1].network);
    if (!result) {
        printf("\nerror |C| of all springs in m after each projection step, and iterations of conjugate gradients (at "
               "most %u a system)\n\n"
               "step  all at once                  colour after colour          all at once, with a floor\n"
               "                                                                of %g on the diagonal\n",
               singe_network_set_size(contenders[0].network, 0), floor);
        for (int step = 0; step <= STEPS; step++) {
            printf("%4d", step);
            for (int i = 0; i < COUNT; i++) contender_print(&contenders[i], step);
            printf("\n");
        }
    }
    for (int i = 0; i < COUNT; i++) singe_network_destroy(contenders[i].network);
    return result;
}

ExitCode paper_all_at_once(const PaperOptions *options) {
    (void)options;
    SingeSolverDef solver = singe_default_solver();
    singe_init_solver_method(&solver, sizeof solver, SINGE_SOLVER_PAPER);
    SingeError error = {0};
    SingeSim *sim;
    SingeResult result = paper_sim(PAPER_SWING, CELLS, &solver, 1, &sim, &error);
    if (result) return paper_fail(&error);
    for (int step = 0; step < WARM_STEPS && !result; step++)
        if ((result = singe_sim_step(sim))) error = *singe_sim_error(sim);
    if (!result) result = all_at_once_run(sim, &error);
    singe_sim_destroy(sim);
    if (!result) return EXIT_GOOD;
    if (!error.code) error.code = result;
    return paper_fail(&error);
}
