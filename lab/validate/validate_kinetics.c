// Cellulose by Arrhenius kinetics, compared with the threshold of eq 4; and the ledgers of heat and mass.
//
// Kashiwagi & Nambu (1992), as FDS has them: cellulose becomes char and gas without air (1) and with it (2), char
// becomes ash (3). With x the share of the initial mass of each, in air at a steady rate of heating b:
//
//     dx1/dt = -(k1 x1^1.8 + k2 x1^1.3),   dx2/dt = 0.24 k1 x1^1.8 + 0.21 k2 x1^1.3 - k3 x2,   dx3/dt = 0.03 k3 x2
//     k = A exp(-E/(R T)),   T = 300 K + b t
//
// The simulation has one reaction (`pre_exponential`, `activation_energy`): it gets (2), with char as the residue.
#include <math.h>

#include "validate/validate.h"

typedef struct Kinetics {
    double cellulose, char_mass, ash;
} Kinetics;

static Kinetics kinetics_rate(const Kinetics *x, double temperature) {
    const double r = 8.314462618, at = 1 / (r * temperature);
    const double k1 = 1.803e15 * exp(-220e3 * at), k2 = 4.276e11 * exp(-160e3 * at), k3 = 5.667e9 * exp(-160e3 * at);
    const double c = fmax(x->cellulose, 0), pyrolysis = k1 * pow(c, 1.8), oxidation = k2 * pow(c, 1.3);
    const double glow = k3 * fmax(x->char_mass, 0);
    return (Kinetics){-(pyrolysis + oxidation), 0.24 * pyrolysis + 0.21 * oxidation - glow, 0.03 * glow};
}

static Kinetics plus(const Kinetics *x, const Kinetics *rate, double h) {
    return (Kinetics){x->cellulose + h * rate->cellulose, x->char_mass + h * rate->char_mass, x->ash + h * rate->ash};
}

typedef struct KineticsRun {
    double peak, peak_rate, residue, half;
} KineticsRun;

/// The classical Runge-Kutta method in steps of so many kelvin, from 300 K to 1000 K. Returns the temperatures of the
/// peak and of the half.
static KineticsRun kinetics_run(double kelvin_per_minute, double step, double *rate_at, int looks) {
    const double b = kelvin_per_minute / 60, h = step / b;
    Kinetics x = {1, 0, 0};
    KineticsRun run = {0};
    const int steps = (int)lround(700 / step);

    for (int i = 0; i < steps; i++) {
        double t = 300 + i * step, mass = x.cellulose + x.char_mass + x.ash;
        Kinetics a = kinetics_rate(&x, t), y = plus(&x, &a, h / 2), c = kinetics_rate(&y, t + step / 2);
        y = plus(&x, &c, h / 2);
        Kinetics d = kinetics_rate(&y, t + step / 2);
        y = plus(&x, &d, h);

        Kinetics e = kinetics_rate(&y, t + step);
        Kinetics sum = {a.cellulose + 2 * c.cellulose + 2 * d.cellulose + e.cellulose,
                        a.char_mass + 2 * c.char_mass + 2 * d.char_mass + e.char_mass,
                        a.ash + 2 * c.ash + 2 * d.ash + e.ash};
        double loss = -(a.cellulose + a.char_mass + a.ash) / b;

        x = plus(&x, &sum, h / 6);
        if (loss > run.peak_rate) {
            run.peak_rate = loss;
            run.peak = t;
        }

        if (mass < 0.5 && run.half <= 0) run.half = t;
        if (rate_at && i % (steps / looks) == 0 && i / (steps / looks) < looks) rate_at[i / (steps / looks)] = loss;
    }

    run.residue = x.cellulose + x.char_mass + x.ash;
    return run;
}

// ---- one reaction, in the simulation

static const double char_left = 0.21, one_a = 4.276e11, one_e = 160e3, one_order = 1.3;

/// dx/dt = -A exp(-E/(R T)) x^1.3 of the burnable rest, by Runge-Kutta as above; returns the peak of the mass loss.
static KineticsRun one_reaction(double kelvin_per_minute, double step) {
    const double b = kelvin_per_minute / 60, h = step / b, r = 8.314462618;
    double x = 1;
    KineticsRun run = {0};

    for (int i = 0; i < (int)lround(700 / step); i++) {
        double t = 300 + i * step, f[4], at[4] = {t, t + step / 2, t + step / 2, t + step};
        for (int k = 0; k < 4; k++) {
            double y = k ? x + (k == 3 ? h : h / 2) * f[k - 1] : x;
            f[k] = -one_a * exp(-one_e / (r * at[k])) * pow(fmax(y, 0), one_order);
        }

        if (-f[0] / b > run.peak_rate) {
            run.peak_rate = -f[0] / b;
            run.peak = t;
        }
        x += h / 6 * (f[0] + 2 * f[1] + 2 * f[2] + f[3]);
    }

    run.residue = char_left + (1 - char_left) * x;
    return run;
}

/// A furnace: it sets the temperature everywhere.
typedef struct Furnace {
    double pace, rate;
} Furnace;

static void furnace_flux(void *context, const SingeView *view, float *flux, float *conductance,
                         float *conductance_temperature) {
    const Furnace *furnace = context;
    const float firm = 1e9f, temperature = (float)(400 + furnace->rate * furnace->pace * view->time);
    (void)flux;
    for (uint32_t i = 0; i < view->particle_count; i++)
        conductance[i] += firm, conductance_temperature[i] += firm * temperature;
}

/// The simulation heats a patch from 400 K to 800 K, a kelvin a step.
static SingeResult one_simulated(Lab *lab, double kelvin_per_minute, KineticsRun *run, SingeError *error) {
    LabGrid grid = lab_grid(2, 2, 0.01f);
    Furnace furnace = {.rate = kelvin_per_minute / 60};
    furnace.pace = 1 / furnace.rate / (double)grid.time_step;
    grid.pace = (float)furnace.pace;
    grid.material.temperature = singe_param(400);
    grid.material.ignition_temperature = singe_param(350);
    grid.material.rate_ceiling = singe_param(INFINITY);
    grid.material.pre_exponential = singe_param((float)one_a);
    grid.material.activation_energy = singe_param((float)one_e);
    grid.material.ash_exponent = singe_param((float)one_order);
    grid.material.mass_min = singe_param((float)char_left);
    grid.material.mass_loss = singe_param(0);
    grid.material.char_yield = singe_param(0);
    grid.material.shrink_front = grid.material.shrink_back = singe_param(0);

    SingeSim *sim;
    SingeSourceDef source = singe_default_source();
    SingeSourceId id;
    source.kind = SINGE_SOURCE_CALLBACK;
    source.callback = furnace_flux;
    source.callback_context = &furnace;

    SingeResult result = lab_build(lab, &grid, &sim, error);
    if (result) return result;

    if ((result = singe_sim_add_source(sim, &source, &id))) *error = *singe_sim_error(sim);
    *run = (KineticsRun){0};
    for (int step = 0; step < 400 && !result; step++) {
        double before = (double)singe_sim_view(sim).mass[0];
        result = lab_steps(sim, 1, error);

        SingeView view = singe_sim_view(sim);
        double loss = (before - (double)view.mass[0]) / (1 - char_left);
        if (loss > run->peak_rate) {
            run->peak_rate = loss;
            run->peak = (double)view.temperature[0];
        }

        run->residue = (double)view.mass[0];
    }

    singe_sim_destroy(sim);
    return result;
}

SingeResult validate_kinetics(Lab *lab, SingeError *error) {
    enum { RATES = 3, LOOKS = 140 };
    static const double rates[RATES] = {1, 3, 5};
    static const char *const names[RATES] = {"1 K/min", "3 K/min", "5 K/min"};
    static const char *const inks[RATES] = {"#2166ac", "#e08214", "#b2182b"};
    static double loss[RATES][LOOKS], temperature[LOOKS];
    double off = 0, residue = 0, apart = 0, first = 0, rising = INFINITY;

    for (int i = 0; i < LOOKS; i++) temperature[i] = 300 + 5 * i - 273.15;
    report_heads(lab->report,
                 "heated by|three reactions: peak C|residue %|one reaction, fine: peak C|residue %|simulated: peak "
                 "C|residue %");

    for (int i = 0; i < RATES; i++) {
        KineticsRun three = kinetics_run(rates[i], 0.05, NULL, 0), one = one_reaction(rates[i], 0.05), sim;
        kinetics_run(rates[i], 0.5, loss[i], LOOKS);
        TRY(one_simulated(lab, rates[i], &sim, error));

        report_row(lab->report, "%s|%.1f|%.2f|%.1f|%.2f|%.1f|%.2f", names[i], three.peak - 273.15, 100 * three.residue,
                   one.peak - 273.15, 100 * one.residue, sim.peak - 273.15, 100 * sim.residue);
        off = fmax(off, fabs(sim.peak - one.peak));
        residue = fmax(residue, fabs(sim.residue - one.residue));
        apart = fmax(apart, fabs(sim.peak - three.peak));
        if (i == 0) first = sim.peak;
        else rising = fmin(rising, sim.peak - first);
    }

    Plot plot = {.title = "Cellulose in air: mass lost per kelvin, three reactions", .x_label = "C", .y_label = "1/K"};
    for (int i = 0; i < RATES; i++)
        plot_add(&plot, (PlotLine){names[i], inks[i], temperature, loss[i], LOOKS, false, false});
    report_plot(lab->report, &plot);

    const double ignition = (double)singe_default_material().ignition_temperature.value;
    report_text(lab->report,
                "Three reactions: Kashiwagi and Nambu's, integrated here by themselves. The simulation has one, the "
                "oxidation of cellulose, and keeps its char, which in the three glows away in the end. It is a choice "
                "of the material (<code>pre_exponential</code>, <code>activation_energy</code>); by default it burns "
                "by eq 4, from %.0f C on.",
                ignition - 273.15);

    report_measure(lab->report, "peak",
                   "simulated at one kelvin per step: distance of the peak from the fine reference, K", off, 0, 2);
    report_measure(lab->report, "residue", "the same: difference in the residue", residue, 0, 1e-3);
    report_measure(lab->report, "three", "simulated: distance of the peak from that of the three reactions, K", apart,
                   0, 10);
    report_measure(lab->report, "shift", "simulated: smallest shift of the peak from 1 to 3 and 5 K/min, K", rising, 10,
                   40);
    report_measure(lab->report, "threshold", "peak at 1 K/min less eq 4's ignition temperature, K", first - ignition, 0,
                   80);

    return SINGE_OK;
}

// ---- ledgers

SingeResult validate_ledgers(Lab *lab, SingeError *error) {
    static const char *const cases[][2] = {{"a hole burns", "adaptive.yaml"},
                                           {"the same, with gas", "adaptive.yaml"},
                                           {"a hot sphere crosses", "fig4c.yaml"},
                                           {"a torus", "fig11.yaml"}};
    double heat = 0, mass = 0;
    SingeResult result = SINGE_OK;

    report_heads(lab->report,
                 "scene|heat in J|combustion J|lost J|stored J|heat ledger|mass ledger|kinetic mJ|elastic mJ|gravity "
                 "mJ|lost mJ");

    for (int i = 0; i < 4 && !result; i++) {
        const char *sets[] = {i == 1 ? "gas=yes" : "", i == 3 ? "sheets.0.mesh=torus-small.obj" : "",
                              i == 2 ? "sheets.0.grid.cells=[30, 42]" : "", NULL};
        Play play;
        result = play_open(&play, lab, cases[i][1], sets, error);
        if (!result) result = play_until(&play, lab->quick ? 1 : 2, error);

        if (!result) {
            SingeStats s = singe_sim_stats(play.sim);
            report_row(lab->report, "%s|%.3g|%.3g|%.3g|%.3g|%.1e|%.1e|%.3g|%.3g|%.3g|%.3g", cases[i][0], s.heat_in,
                       s.heat_of_combustion, s.heat_lost, s.heat_stored, s.ledger_error, s.mass_ledger_error,
                       1e3 * s.energy_kinetic, 1e3 * s.energy_elastic, 1e3 * s.energy_gravity, 1e3 * s.energy_lost);
            heat = fmax(heat, s.ledger_error);
            mass = fmax(mass, s.mass_ledger_error);
        }

        play_close(&play);
    }

    if (result) return result;
    report_measure(lab->report, "heat", "largest error of the heat ledger, over its largest entry", heat, 0, 1e-5);
    report_measure(lab->report, "mass", "largest error of the mass ledger, over the mass at the start", mass, 0, 1e-6);
    return SINGE_OK;
}
