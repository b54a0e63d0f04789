// Where the paper can be read in more than one way, or is misprinted: our reading, and what the other one does.
#include <math.h>

#include "analysis/strip.h"
#include "page/lab.h"
#include "paper/paper.h"
#include "paper/paper_states.h"

/// Mass left of a particle that starts 100 K above ignition and burns by eq 4, its heat by eq 1 with that sign.
static double mass_left(double sign) {
    const double eta = 2286, mu = 9e-3, h = 1e-3;
    double mass = 1, excess = 100;
    for (int step = 0; step < 20000 && excess > 0 && mass > 0.15; step++) {
        double lost = fmin(mass - 0.15, h * mu * excess);
        mass -= lost;
        excess += sign * eta * lost;
    }

    return mass;
}

/// |d - l| of a spring of length 1.2 and target 1 after 7 Newton steps whose displacement is divided by w (sec 7.2) or
/// whose constraint is multiplied by it (eq 19).
static double spring_error(double w, bool divided) {
    double d = 1.2;
    for (int step = 0; step < 7; step++) {
        double full = (d * d - 1) / (2 * d);
        d -= divided ? full / w : full * w;
    }
    return fabs(d - 1);
}

/// How far the common centre of 1 and 9 kg moves when a spring between them is projected, of the way that it closes.
static SingeResult centre_moves(bool with_mass, double *moved, SingeError *error) {
    SingeNetworkDef def = singe_default_network();
    SingeNetwork *network;

    def.particle_count = 2;
    def.positions = (const double[]){0, 0, 0, 1.2, 0, 0};
    def.inverse_masses = with_mass ? (const double[]){1, 1 / 9.0} : NULL;
    def.spring_count = 1, def.ends = (const uint32_t[]){0, 1}, def.lengths = (const double[]){1};
    TRY(singe_network_create(&def, &network, error));

    SingeResult result = singe_network_project(network, 0, NULL);
    const double *x = singe_network_positions(network);
    *moved = fabs((x[0] + 9 * x[3]) / 10 - 0.9 * 1.2) / 0.2;
    singe_network_destroy(network);
    return result;
}

/// Steps that the paper's solver takes until it fails, or `max`.
static SingeResult steps_taken(SingeSolverMethod method, int max, int *steps, SingeError *error) {
    SingeSolverDef solver = singe_default_solver();
    singe_init_solver_method(&solver, sizeof solver, method);
    SingeSim *sim;
    TRY(paper_sim(PAPER_SWING, 8, &solver, 1, &sim, error));

    for (*steps = 0; *steps < max && !singe_sim_step(sim); ++*steps)
        if (fabs((double)singe_sim_view(sim).position[40][2]) > 1e3) break; // thrown away
    singe_sim_destroy(sim);
    return SINGE_OK;
}

/// Springs of a colour that share an end with one of the same colour, at most, and that one itself.
static int row_length(const SingeView *view) {
    int max = 0;
    const uint32_t(*s)[2] = view->springs[SINGE_BLUE];
    for (uint32_t i = 0; i < view->spring_count[SINGE_BLUE]; i++) {
        int count = 0;
        for (uint32_t j = 0; j < view->spring_count[SINGE_BLUE]; j++)
            count += s[i][0] == s[j][0] || s[i][0] == s[j][1] || s[i][1] == s[j][0] || s[i][1] == s[j][1];
        if (count > max) max = count;
    }

    return max;
}

static SingeResult burn_strip(const SingeMaterialDef *material, StripResult *out, SingeError *error) {
    StripSetup setup = strip_setup(material);
    setup.cell = 2e-3f;
    setup.width = 6e-3f;
    return strip_burn(&setup, out, error);
}

/// A spring's length over its initial one, 200 steps after it began to burn to 9/10 of its mass.
static SingeResult length_after(Lab *lab, double *length, SingeError *error) {
    LabGrid grid = lab_grid(2, 2, 0.01f);
    float mass[9];
    for (int i = 0; i < 9; i++) mass[i] = 0.9f;

    SingeSim *sim;
    SingeSurface surface = {0};

    lab_sets_mass(&grid.material);
    SingeResult result = paper_burn_to(lab, &grid, mass, 0, &sim, &surface, error);
    if (!result) {
        const SingeView view = singe_sim_view(sim);
        *length = (double)(view.spring_length[SINGE_BLUE][0] / view.spring_rest[SINGE_BLUE][0]);
    }

    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}

static SingeResult readings_of_motion(Lab *lab, SingeError *error) {
    double with_mass = NAN, without = NAN;
    int literal = 0, ours = 0, row;
    SingeResult result = centre_moves(true, &with_mass, error);

    if (!result) result = centre_moves(false, &without, error);
    if (!result) result = steps_taken(SINGE_SOLVER_PAPER_LITERAL, 200, &literal, error);
    if (!result) result = steps_taken(SINGE_SOLVER_PAPER, 200, &ours, error);
    if (result) return result;

    LabGrid grid = lab_grid(6, 6, 0.01f);
    SingeSim *sim;
    if ((result = lab_build(lab, &grid, &sim, error))) return result;

    SingeView view = singe_sim_view(sim);
    row = row_length(&view);
    singe_sim_destroy(sim);
    grid = lab_grid(6, 1, 0.01f);
    if ((result = lab_build(lab, &grid, &sim, error))) return result;

    view = singe_sim_view(sim);
    const int narrow = row_length(&view);
    singe_sim_destroy(sim);
    double by_triangles, by_cells;
    if ((result = paper_longest_side(lab, true, &by_triangles, error))) return result;
    if ((result = paper_longest_side(lab, false, &by_cells, error))) return result;

    const double divided = spring_error(0.1, true), multiplied = spring_error(0.1, false);
    report_heads(lab->report, "where|the paper|our reading|the other reading");

    report_row(lab->report,
               "eq 6|l_rest|l_init, which is the same length|compounded, a spring of v = 0.9 is at %.0e of its length "
               "after 100 steps",
               pow(0.9, 100));
    report_row(lab->report,
               "section 6|m'_1 = m_0 - m_loss|m_1 - m_loss|m'_0 = m'_1 always: no spring is ever partly burnt; two of "
               "Fig 5's five are");
    report_row(lab->report, "eq 9|x + v|x + h v|to the letter the sheet is lost after %d steps of 200", literal);
    report_row(lab->report,
               "eq 16|J J^T|J M^-1 J^T|the centre of 1 and 9 kg moves by %.0f %% of what their spring closes, with M "
               "by %.0e",
               100 * without, with_mass);
    report_row(lab->report,
               "section 7.2|the displacement is divided by w|eq 19: C is multiplied|a spring of w = 0.1 that is 20 %% "
               "too long: after 7 projections off by %.1e if divided, by %.2f if multiplied, which is softer, as in "
               "Fig 10",
               divided, multiplied);
    report_row(
        lab->report,
        "section 6|a spring goes when both triangles that share it have disappeared|all springs of a cell go with "
        "it|a burnt corner hangs on one yellow spring and swings: sides of a cell that is partly left reach %.2f "
        "of their length, here %.2f",
        by_triangles, by_cells);
    report_row(lab->report,
               "Table 2|10,000 springs in the last row|100,000|7412.92 ms at 0.074 ms each are %.0f springs",
               7412.92 / 0.074);
    report_row(lab->report,
               "section 8.1|N_s = 7|N_n = 7|N_s is the number of springs; a row of the matrix on a grid has %d", row);
    report_row(lab->report,
               "sections 5, 8|balls in Figs 1, 11, textures in 4; or a hot start in 1, balls in 4, 11|section 8|all of "
               "these sources are there");

    report_bar(lab->report, "literal_steps", "eq 9 to the letter: steps that the sheet lasts", literal, 0, 100, ours,
               "with h, as read here");
    report_bar(lab->report, "ours_steps", "as read: steps of 200", ours, 200, 200, literal, "to the letter");
    report_bar(lab->report, "mass_centre", "eq 16 with M: how far the centre moves", with_mass, 0, 1e-6, without,
               "without M");
    report_bar(lab->report, "divided", "section 7.2's division: error after 7 projections over that before",
               divided / 0.2, 10, INFINITY, multiplied / 0.2, "eq 19");
    report_bar(lab->report, "multiplied", "eq 19: the same", multiplied / 0.2, 0.2, 0.8, divided / 0.2,
               "section 7.2's division");
    report_bar(lab->report, "removal", "longest side of a cell with one corner left, over that at rest", by_cells, 0.9,
               1.1, by_triangles, "by section 6's rule of triangles");
    report_bar(lab->report, "row", "entries in a row of the matrix", row, 7, 7, narrow, "a strip one cell wide");

    return SINGE_OK;
}

SingeResult paper_readings(Lab *lab, SingeError *error) {
    report_heads(lab->report, "where|the paper|our reading|the other reading");
    SingeMaterialDef usual = singe_default_material(), lossless, still;
    StripResult ours, hot, radiating;

    usual.char_yield = singe_param(0);
    usual.mass_loss = singe_param(0.25f);
    usual.heat_share = singe_param(0.2f);
    lossless = usual;
    lossless.convection = lossless.emissivity = singe_param(0);

    SingeResult result = burn_strip(&usual, &ours, error);
    if (!result) result = burn_strip(&lossless, &hot, error);
    still = usual;
    still.convection = singe_param(0);
    if (!result) result = burn_strip(&still, &radiating, error);
    if (result) return result;

    static const SpotMesh meshes[] = {{"2 : 1", {36, 72}, {.144f, .144f}, 0}, {"squares", {60, 60}, {.12f, .12f}, 0}};
    double spread[2][2];
    for (int i = 0; i < 2; i++)
        if ((result = spot_spread(lab, &meshes[i], SINGE_HEAT_UMBRELLA, spread[i], error))) return result;

    const double aspect = spread[0][0] / spread[0][1], square = spread[1][0] / spread[1][1];
    const double printed = mass_left(-1), read = mass_left(1);
    report_row(lab->report,
               "eq 1|+ eta dm, where dm is negative|- eta dm: burning heats|as printed a fire puts itself out with "
               "%.0f %% of its mass left; ours goes to m_min, %.0f %%",
               100 * printed, 100 * read);
    report_row(lab->report, "eq 1, text|\"the ratio of heat to mass, mu\"|eta; mu is eq 4's rate|-");
    report_row(lab->report,
               "eq 1|no losses|convection and radiation|without them the front is at %.0f C, with them at %.0f C",
               hot.hottest - 273.15, ours.hottest - 273.15);
    report_row(lab->report, "eq 2|alpha nabla^2|alpha nabla^2 T|a misprint");
    report_row(lab->report,
               "eq 3|lengths of the moment|initial lengths|weights go with 1/d^2: a spring at half its length conducts "
               "4 times as much, at the least length of 5 %% 400 times");
    report_row(lab->report,
               "eq 3|taken for nabla^2|used only where asked for|on squares it is half of nabla^2 (singe validate)");
    report_row(lab->report,
               "eq 4|a straight line to m_min|slower near the end, p = 0.5|the last tenth above m_min takes 10 %% of "
               "the time by the line, %.0f %% by ours: ash is seen before it goes",
               100 * sqrt(0.1));

    report_bar(lab->report, "eq1_printed", "eq 1 as printed: share of mass at which fire puts itself out", printed, 0.9,
               1, read, "with the sign turned, as read here");
    report_bar(lab->report, "eq1_read", "eq 1 as read: share of mass left", read, 0.149, 0.151, printed, "as printed");
    report_bar(lab->report, "losses", "K of the hottest without losses over that with them", hot.hottest / ours.hottest,
               1.1, INFINITY, radiating.hottest / ours.hottest, "without convection alone");

    double stays = NAN;
    if ((result = length_after(lab, &stays, error))) return result;

    report_bar(lab->report, "l_rest", "eq 6 from l_init: share of its length after 200 steps at v = 0.9", stays, 0.8999,
               0.9001, pow(0.9, 200), "from the length that it has");
    report_bar(lab->report, "umbrella_long", "the umbrella on cells of 2 : 1, along x over along y", aspect, 1.2,
               INFINITY, square, "on squares");
    return readings_of_motion(lab, error);
}
