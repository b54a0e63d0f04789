// Cotton in a cone calorimeter: when it ignites, and the heat that it releases.
//
// A bed sheet of cotton lies on calcium silicate under a flux q from above: the Fire Safety Research Institute's
// materials database (github.com/ulfsri/fsri_materials_database, 01_Data/Cotton_Sheet/Cone, 29 April 2022, three runs a
// flux, each with a spark). Without losses a thin sheet ignites after t = C'' (T_ign - T_a)/(eps q). What it lies on takes
// as much heat again: a half-space, touched all over. Which board it was is not said; the measures are taken on one for
// insulation, whose data are complete (MASEA, calcium silicate), and the table has a building board and no board as well.
#include <math.h>

#include "validate/validate.h"

enum { FLUXES = 3, SECONDS = 17 };
static const double cone_flux[FLUXES] = {25, 50, 75};                                                   // kW/m2
static const double cone_ignition[FLUXES][3] = {{8.75, 10.75, 9.75}, {2.75, 3, 3.25}, {2, 2.25, 1.75}}; // s
static const double cone_peak[FLUXES] = {171.7, 195.9, 212.0}; // kW/m2, of the mean of the runs

/// kW/m2 at 50 kW/m2, each second from ignition on, mean of the runs.
static const double cone_release[SECONDS] = {62.5, 106.3, 139.7, 172.0, 194.5, 188.6, 165.4, 140.9, 116.4,
                                             95.1, 79.0,  62.7,  48.7,  38.3,  30.1,  23.9,  18.9};

typedef struct ConeRun {
    double ignition, peak;   ///< s, kW/m2
    double release[SECONDS]; ///< kW/m2, mean over the second around each
    double total;            ///< MJ/m2 within these seconds
} ConeRun;

enum { BOARD_CELLS = 40 };
static const double board_cell = 0.25e-3, ambient = 293.15, STEFAN_BOLTZMANN = 5.670374e-8; // m, K, W/(m2 K4)

/// What the sheet lies on.
typedef struct Board {
    const char *name;
    double conductivity, density, specific_heat; ///< W/(m K), kg/m3, J/(kg K); conductivity 0: air
} Board;

enum { INSULATING, DENSE, AIR, BOARDS };
static const Board boards[BOARDS] = {
    {"insulating board", 0.0623, 270, 1162}, {"building board", 0.2, 870, 1000}, {"air on both sides", 0, 0, 0}};

typedef struct Cone {
    const SingeMaterialDef *cotton;
    const Board *board;
    double temperature[BOARD_CELLS]; ///< K
    double absorbed;                 ///< W/m2
} Cone;

static void cone_heats(void *context, const SingeView *view, float *flux, float *conductance,
                       float *conductance_temperature) {
    const Cone *cone = context;
    const SingeMaterialDef *cotton = cone->cotton;
    const float contact = (float)(2 * cone->board->conductivity / board_cell);
    for (uint32_t v = 0; v < view->vertex_count; v++) flux[v] += (float)cone->absorbed; // from above
    if (contact == 0) return;

    // the other layer touches the board, and loses nothing to the air
    for (uint32_t i = view->vertex_count; i < view->particle_count; i++) {
        const double hot = (double)view->temperature[i], left = fmax((double)view->mass[i], 0.15);
        const double radiates = STEFAN_BOLTZMANN * (double)cotton->emissivity.value * (pow(hot, 4) - pow(ambient, 4));
        flux[i] += (float)((radiates + (double)cotton->convection.value * (hot - ambient)) / left);
        conductance[i] += contact;
        conductance_temperature[i] += contact * (float)cone->temperature[0];
    }
}

/// Cotton as it is, its patches by their means, flat and held, under a flux.
static SingeResult cone_burn(Lab *lab, const SingeMaterialDef *cotton, const Board *board, double kilowatt,
                             ConeRun *run, SingeError *error) {
    LabGrid grid = lab_grid(10, 10, 9.4e-3f); // the specimen, 88.4 cm2
    SingeSim *sim;
    SingeSourceDef source = singe_default_source();
    SingeSourceId id;

    // what the sheet absorbs of the heater's radiation is its emissivity at the heater's temperature: 0.88 at 600 K, 0.77
    // at 1200 K (FSRI); the heater is black and fills 0.8 of the view
    const double heater = pow(1e3 * kilowatt / (0.8 * STEFAN_BOLTZMANN), 0.25);
    Cone cone = {cotton, board, {0}, 1e3 * kilowatt * (0.88 - 0.11 * (heater - 600) / 600)};
    for (int k = 0; k < BOARD_CELLS; k++) cone.temperature[k] = ambient;

    grid.material = *cotton;
    grid.material.mass_loss = singe_param(0);                         // burnt or not, it stays on its plate
    grid.material.thickening = 1;                                     // no front
    if (board->conductivity > 0) grid.material.air_supply.value /= 2; // one face is open to the air
    source.kind = SINGE_SOURCE_CALLBACK;
    source.callback = cone_heats;
    source.callback_context = &cone;

    SingeResult result = lab_build(lab, &grid, &sim, error);
    if (result) return result;
    if ((result = singe_sim_add_source(sim, &source, &id))) *error = *singe_sim_error(sim);
    *run = (ConeRun){.ignition = NAN};

    const double step = (double)grid.time_step, grammage = (double)cotton->grammage.value;
    double before = 1, window = 0;
    for (double time = 0; time < 40 && !result; time += step) {
        result = lab_steps(sim, 1, error);
        SingeView view = singe_sim_view(sim);
        if (board->conductivity > 0) {
            // a time step of the board, under the mean of the layer that lies on it
            const double per_cell = step / (board->density * board->specific_heat * board_cell);
            double mean = 0, flux[BOARD_CELLS + 1] = {0}; // W/m2, into each cell from the one before
            for (uint32_t i = view.vertex_count; i < view.particle_count; i++)
                mean += (double)view.temperature[i] / (view.particle_count - view.vertex_count);
            flux[0] = 2 * board->conductivity / board_cell * (mean - cone.temperature[0]);
            for (int k = 1; k < BOARD_CELLS; k++)
                flux[k] = board->conductivity / board_cell * (cone.temperature[k - 1] - cone.temperature[k]);
            for (int k = 0; k < BOARD_CELLS; k++) cone.temperature[k] += per_cell * (flux[k] - flux[k + 1]);
        }

        double mass = 0;
        for (uint32_t i = 0; i < view.particle_count; i++) mass += (double)view.mass[i] / view.particle_count;
        if (isnan(run->ignition) && mass < 0.9999) run->ignition = time;

        const double heat = before > (double)cotton->char_yield.value ? (double)cotton->heat_of_combustion.value
                                                                      : (double)cotton->char_heat.value;
        const double joule = (before - mass) * grammage * heat; // per square metre
        before = mass;

        const int second = isnan(run->ignition) ? 0 : (int)lround(time - run->ignition);
        if (second >= SECONDS) break;
        run->release[second] += 1e-3 * joule / (second ? 1 : 0.5);
        run->total += 1e-6 * joule;
        window += (1e-3 * joule / step - window) * step / 0.25; // of the calorimeter's time between two readings
        run->peak = fmax(run->peak, window);
    }

    singe_sim_destroy(sim);
    return result;
}

SingeResult validate_cone(Lab *lab, SingeError *error) {
    SingeMaterialDef cotton = singe_default_material();
    if (singe_material_preset("cotton", &cotton, error)) return error->code;

    ConeRun all[BOARDS][FLUXES], *runs = all[INSULATING];
    double measured[FLUXES], seconds[SECONDS], total = 0;
    SingeResult result = SINGE_OK;
    report_heads(lab->report,
                 "on|kW/m2|ignites after s|measured s|here over measured|peak kW/m2|measured|here over measured");

    for (int b = 0; b < BOARDS; b++)
        for (int i = 0; i < FLUXES && !result; i++) {
            ConeRun *run = &all[b][i];
            result = cone_burn(lab, &cotton, &boards[b], cone_flux[i], run, error);
            measured[i] = (cone_ignition[i][0] + cone_ignition[i][1] + cone_ignition[i][2]) / 3;
            if (!result)
                report_row(lab->report, "%s|%.0f|%.2f|%.2f|%.2f|%.0f|%.0f|%.2f", boards[b].name, cone_flux[i],
                           run->ignition, measured[i], run->ignition / measured[i], run->peak, cone_peak[i],
                           run->peak / cone_peak[i]);
        }

    SingeMaterialDef fierce = cotton;
    fierce.air_supply = singe_param(INFINITY);
    ConeRun most;
    if (!result) result = cone_burn(lab, &fierce, &boards[INSULATING], cone_flux[1], &most, error);
    if (result) return result;

    for (int i = 0; i < SECONDS; i++) {
        seconds[i] = i;
        total += 1e-3 * cone_release[i] * (i && i < SECONDS - 1 ? 1 : 0.5);
    }

    Plot plot = {.title = "Cotton under 50 kW/m2", .x_label = "s after ignition", .y_label = "kW/m2"};
    plot_add(&plot, (PlotLine){"FSRI", "#111", seconds, cone_release, SECONDS, true, false});
    plot_add(&plot, (PlotLine){"here", "#b2182b", seconds, runs[1].release, SECONDS, false, false});
    report_plot(lab->report, &plot);

    report_text(
        lab->report,
        "Nothing was set by these runs but the sheet's mass per area (1.06 g on 88.4 cm²). Its rates are those of a "
        "<em>front</em>, within which a strip of a millimetre burns in a fraction of a second, as far as air "
        "reaches it: a whole sheet that is heated at once burns by <code>air_supply</code>, on its one open "
        "face. Times to ignition depend on the board as much as on the sheet; which one it was is not "
        "reported.");

    static const char *const names[FLUXES] = {"ignition_25", "ignition_50", "ignition_75"};
    for (int i = 0; i < FLUXES; i++)
        report_bar(lab->report, names[i], "time to ignition over the measured one", runs[i].ignition / measured[i],
                   VALIDATE_LOW, VALIDATE_HIGH, all[AIR][i].ignition / measured[i], "without the board");

    const double power = log(runs[2].ignition / runs[0].ignition) / log(cone_flux[2] / cone_flux[0]);
    report_measure(lab->report, "power", "exponent of the time to ignition over the flux, less the measured one",
                   power - log(measured[2] / measured[0]) / log(cone_flux[2] / cone_flux[0]), -0.25, 0.25);
    report_bar(lab->report, "peak", "peak of the heat release at 50 kW/m² over the measured one",
               runs[1].peak / cone_peak[1], VALIDATE_LOW, VALIDATE_HIGH, most.peak / cone_peak[1],
               "with as much air as in a front");
    report_measure(lab->report, "total", "heat released at 50 kW/m² within 16 s over the measured one",
                   runs[1].total / total, VALIDATE_LOW, VALIDATE_HIGH);
    return SINGE_OK;
}
