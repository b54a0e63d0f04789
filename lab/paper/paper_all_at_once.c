// Section 7.1's reason for projecting one colour after another: all springs in one system give more constraints than
// degrees of freedom, 10 to 6, so the matrix is singular, and fast projection diverges. Both are tested on a sheet that
// has swung for a while: ranks and singular values of J M^-1/2, and errors over projection steps.
#include <math.h>
#include <stdlib.h>

#include "paper/paper.h"
#include "paper/paper_states.h"
#include "analysis/numbers.h"

enum { CELLS = 6, WARM_STEPS = 200, STEPS = 7 };

static const double zero_share = 1e-10; // of the largest singular value; smaller values count as 0

/// The row of a set; *spare is the number of its redundant constraints.
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
                "6. The singular values are those of J M<sup>-1/2</sup>; %g of the largest counts as 0.",
                CELLS, CELLS, springs, 3 * free_count, 10.0 * 3 * free_count / springs, zero_share);
    report_heads(lab->report, "springs|constraints|rank|too many|smallest above 0, over the largest");

    SingeResult result = set_print(lab, all, 0, "all", view.particle_count, &spare);
    for (uint32_t c = 0; c < SINGE_COLOUR_COUNT && !result; c++) {
        double more = 0;
        result = set_print(lab, colours, c, names[c], view.particle_count, &more);
        colour_spare += more;
    }

    report_bar(lab->report, "ratio", "constraints over degrees of freedom, all at once", springs / (3.0 * free_count),
               1.0001, INFINITY, singe_network_set_size(colours, SINGE_BLUE) / (1.5 * free_count),
               "blue springs over those of the corners");
    report_bar(lab->report, "deficit_all", "constraints beyond the rank, all at once", spare, 1, INFINITY, colour_spare,
               "of the four colours, each in a system of its own");
    report_bar(lab->report, "deficit_colours", "the same of the four colours, each in a system of its own",
               colour_spare, 0, 0, spare, "all at once");
    return result;
}

typedef struct Contender {
    SingeNetwork *network;
    uint32_t sets;
} Contender;

/// Makes a projection step, except for step 0, and returns the error after it.
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

enum { CONTENDERS = 4 };
static const char *const names[CONTENDERS] = {"all at once", "colour after colour", "all at once, floor",
                                              "colour after colour, floor"};

SingeResult paper_all_at_once(Lab *lab, SingeError *error) {
    SingeSolverDef solver = singe_default_solver();
    singe_init_solver_method(&solver, sizeof solver, SINGE_SOLVER_PAPER);
    SingeSim *sim;
    TRY(paper_sim(PAPER_SWING, CELLS, &solver, 1, &sim, error));

    SingeResult result = lab_steps(sim, WARM_STEPS, error);
    if (!result) {
        const double floor = singe_default_network().regularisation;
        Contender contenders[CONTENDERS] = {
            {.sets = 1}, {.sets = SINGE_COLOUR_COUNT}, {.sets = 1}, {.sets = SINGE_COLOUR_COUNT}};

        result = SINGE_OK;
        for (int i = 0; i < CONTENDERS && !result; i++)
            result = paper_network(sim, PAPER_SWING, contenders[i].sets == 1, i < 2 ? 0 : floor, 0,
                                   &contenders[i].network, error);
        if (!result) result = ranks_print(lab, sim, contenders[0].network, contenders[1].network);

        if (!result) {
            static const char *const inks[CONTENDERS] = {"#b2182b", "#2166ac", "#e08214", "#5aae61"};
            double errors[CONTENDERS][STEPS + 1], ends[CONTENDERS];
            uint32_t iterations[CONTENDERS] = {0};
            bool broken[CONTENDERS] = {false};

            report_text(
                lab->report,
                "Error |C| of all springs in m after each projection step, with nothing on the diagonal and with a floor "
                "of %g, as <code>solver: paper</code> has.",
                floor);
            report_heads(lab->report,
                         "step|all at once|colour after colour|all at once, floor|colour after colour, floor");

            for (int step = 0; step <= STEPS; step++) {
                for (int i = 0; i < CONTENDERS; i++)
                    errors[i][step] = contender_step(&contenders[i], step, &iterations[i], &broken[i]);
                report_row(lab->report, "%d|%.3g|%.3g|%.3g|%.3g", step, errors[0][step], errors[1][step],
                           errors[2][step], errors[3][step]);
            }

            report_row(lab->report, "iterations|%u%s|%u%s|%u%s|%u%s", iterations[0], broken[0] ? ", broke down" : "",
                       iterations[1], broken[1] ? ", broke down" : "", iterations[2], broken[2] ? ", broke down" : "",
                       iterations[3], broken[3] ? ", broke down" : "");

            Plot plot = {.title = "All colours in one system, and one after another",
                         .x_label = "projection step",
                         .y_label = "|C|, m",
                         .log_y = true};
            for (int i = 0; i < CONTENDERS; i++) {
                plot_add(&plot, (PlotLine){.name = names[i], .colour = inks[i], .y = errors[i], .count = STEPS + 1});
                ends[i] = broken[i] ? 1e9 : errors[i][STEPS] / errors[i][0];
            }

            report_plot(lab->report, &plot);
            report_text(
                lab->report,
                "So the paper's reason holds as it stands: with nothing on the diagonal all at once diverges and colour "
                "after colour does not. But it is the rank that is at fault, and not the number of constraints: a floor "
                "mends it, and all at once then ends at %.2g of the error that colour after colour ends at with the same "
                "floor, for %.1f times the iterations.",
                ends[2] / ends[3], (double)iterations[2] / iterations[3]);

            report_bar(lab->report, "all_diverges", "no floor: error after 7 steps over that before, all at once",
                       ends[0], 1, INFINITY, ends[1], names[1]);
            report_bar(lab->report, "colours_converge", "no floor: the same, colour after colour", ends[1], 0, 0.9,
                       ends[0], names[0]);
            report_bar(lab->report, "floor_converges", "with a floor: the same, all at once", ends[2], 0, 0.5, ends[0],
                       "all at once without");
            report_bar(lab->report, "floor_colours", "with a floor: the same, colour after colour", ends[3], 0, 0.9,
                       ends[0], "all at once without");
        }

        for (int i = 0; i < CONTENDERS; i++) singe_network_destroy(contenders[i].network);
    }

    singe_sim_destroy(sim);
    return result;
}
