// Section 7.1's reason for projecting colour after colour: all springs in one system have more constraints than there
// are degrees of freedom, 10 to 6, so the matrix is singular, and fast projection diverges. Here both are looked at on
// a sheet that has swung for a while: ranks and singular values of J M^-1/2, and errors over projection steps.
#include <math.h>
#include <stdlib.h>

#include "cli/lab/paper.h"
#include "cli/lab/paper_states.h"
#include "cli/singular.h"

enum { CELLS = 6, WARM_STEPS = 200, STEPS = 7 };

static const double zero_share = 1e-10; // of the largest singular value: below it one is 0

/// A row about one set; *spare is how many of its constraints are too many.
static SingeResult set_print(Lab *lab, SingeNetwork *network, uint32_t set, const char *name, uint32_t particles,
                             double *spare) {
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
        report_row(lab->report, "%s|%zu|%zu|%zu|%.2e", name, rows, rank, rows - rank,
                   rank ? values[rank - 1] / values[0] : (double)NAN);
    }
    *spare = (double)(rows - rank);
    free(jacobian);
    free(values);
    return result;
}

static SingeResult ranks_print(Lab *lab, const SingeSim *sim, SingeNetwork *all, SingeNetwork *colours) {
    static const char *const names[] = {"red", "green", "blue", "yellow"};
    SingeView view = singe_sim_view(sim);
    uint32_t free_count = 0, springs = singe_network_set_size(all, 0);
    double spare, colour_spare = 0;
    for (uint32_t i = 0; i < view.particle_count; i++) free_count += !(view.particle_flags[i] & SINGE_PINNED);
    report_text(lab->report,
                "%d x %d cells: %u constraints, %u degrees of freedom: 10 to %.2f. On a sheet without end it is 10 to "
                "6. The singular values are those of J M<sup>-1/2</sup>; %g of the largest counts as 0.", CELLS, CELLS,
                springs, 3 * free_count, 10.0 * 3 * free_count / springs, zero_share);
    report_heads(lab->report, "springs|constraints|rank|too many|smallest above 0, over the largest");
    SingeResult result = set_print(lab, all, 0, "all", view.particle_count, &spare);
    for (uint32_t c = 0; c < SINGE_COLOUR_COUNT && !result; c++) {
        double more = 0;
        result = set_print(lab, colours, c, names[c], view.particle_count, &more);
        colour_spare += more;
    }
    report_measure(lab->report, "ratio", "constraints over degrees of freedom, all at once",
                   springs / (3.0 * free_count), 1.0001, INFINITY);
    report_measure(lab->report, "deficit_all", "constraints beyond the rank, all at once", spare, 1, INFINITY);
    report_measure(lab->report, "deficit_colours", "the same of the four colours, each in a system of its own",
                   colour_spare, 0, 0);
    return result;
}

typedef struct Contender {
    SingeNetwork *network;
    uint32_t sets;
} Contender;

/// Takes a projection step, but for step 0, and returns the error after it.
static double contender_step(const Contender *contender, int step, uint32_t *iterations, bool *broken) {
    double errors[SINGE_COLOUR_COUNT], square = 0;
    for (uint32_t set = 0; set < contender->sets && step > 0; set++) {
        SingeNetworkReport report = {0};
        if (singe_network_project(contender->network, set, &report)) *broken = true;
        *iterations += report.iterations;
    }
    paper_errors(contender->network, contender->sets, errors);
    for (uint32_t set = 0; set < contender->sets; set++) square += errors[set] * errors[set];
    return sqrt(square);
}

static void contenders_run(Lab *lab, const Contender *contenders, int count, double floor) {
    static const char *const names[] = {"all at once", "colour after colour", "all at once, with a floor"};
    static const char *const inks[] = {"#b2182b", "#2166ac", "#999999"};
    double errors[3][STEPS + 1];
    uint32_t iterations[3] = {0};
    bool broken[3] = {false};
    report_text(lab->report,
                "Error |C| of all springs in m after each projection step. The third has a floor of %g on its "
                "diagonal, as <code>solver: paper</code> has.", floor);
    report_heads(lab->report, "step|all at once|colour after colour|all at once, floor");
    for (int step = 0; step <= STEPS; step++) {
        for (int i = 0; i < count; i++)
            errors[i][step] = contender_step(&contenders[i], step, &iterations[i], &broken[i]);
        report_row(lab->report, "%d|%.3g|%.3g|%.3g", step, errors[0][step], errors[1][step], errors[2][step]);
    }
    report_row(lab->report, "iterations|%u%s|%u|%u", iterations[0], broken[0] ? ", broke down" : "", iterations[1],
               iterations[2]);
    Plot plot = {.title = "All colours in one system, and one after another", .x_label = "projection step",
                 .y_label = "|C|, m", .log_y = true};
    for (int i = 0; i < count; i++)
        plot_add(&plot, (PlotLine){.name = names[i], .colour = inks[i], .y = errors[i], .count = STEPS + 1});
    report_plot(lab->report, &plot);
    report_measure(lab->report, "all_diverges", "error after 7 steps over that before, all at once",
                   broken[0] ? 1e9 : errors[0][STEPS] / errors[0][0], 1, INFINITY);
    report_measure(lab->report, "colours_converge", "the same, colour after colour", errors[1][STEPS] / errors[1][0], 0,
                   0.9);
    report_measure(lab->report, "floor_converges", "the same, all at once with a floor",
                   errors[2][STEPS] / errors[2][0], 0, 0.5);
}

static SingeResult all_at_once_run(Lab *lab, const SingeSim *sim, SingeError *error) {
    const double floor = singe_default_network().regularisation;
    // plain, successive, and plain with the floor on the diagonal that solver: paper has
    Contender contenders[] = {{.sets = 1}, {.sets = SINGE_COLOUR_COUNT}, {.sets = 1}};
    const double floors[] = {0, floor, floor};
    enum { COUNT = sizeof contenders / sizeof *contenders };
    SingeResult result = SINGE_OK;
    for (int i = 0; i < COUNT && !result; i++)
        result = paper_network(sim, PAPER_SWING, contenders[i].sets == 1, floors[i], &contenders[i].network, error);
    if (!result) result = ranks_print(lab, sim, contenders[0].network, contenders[1].network);
    if (!result) contenders_run(lab, contenders, COUNT, floor);
    for (int i = 0; i < COUNT; i++) singe_network_destroy(contenders[i].network);
    return result;
}

SingeResult paper_all_at_once(Lab *lab, SingeError *error) {
    SingeSolverDef solver = singe_default_solver();
    singe_init_solver_method(&solver, sizeof solver, SINGE_SOLVER_PAPER);
    SingeSim *sim;
    SingeResult result = paper_sim(PAPER_SWING, CELLS, &solver, 1, &sim, error);
    if (result) return result;
    result = lab_steps(sim, WARM_STEPS, error);
    if (!result) result = all_at_once_run(lab, sim, error);
    singe_sim_destroy(sim);
    return result;
}
