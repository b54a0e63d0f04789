// Cellulose by Arrhenius kinetics, beside the threshold of eq 4; and the ledgers of heat and mass.
//
// Kashiwagi & Nambu (1992), as FDS has them: cellulose becomes char and gas without air (1) and with it (2), char becomes
// ash (3). With x the share of the initial mass of each, in air at a steady rate of heating b:
//
//     dx1/dt = -(k1 x1^1.8 + k2 x1^1.3),   dx2/dt = 0.24 k1 x1^1.8 + 0.21 k2 x1^1.3 - k3 x2,   dx3/dt = 0.03 k3 x2
//     k = A exp(-E/(R T)),   T = 300 K + b t
#include <math.h>
#include <stdio.h>

#include "cli/validate.h"

typedef struct Kinetics { double cellulose, char_mass, ash; } Kinetics;

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

typedef struct KineticsRun { double peak, peak_rate, residue, half; } KineticsRun;

/// The classical Runge-Kutta method in steps of so many kelvin, from 300 K to 1000 K. Peak and half by temperature.
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
        if (loss > run.peak_rate) run.peak_rate = loss, run.peak = t;
        if (mass < 0.5 && run.half <= 0) run.half = t;
        if (rate_at && i % (steps / looks) == 0 && i / (steps / looks) < looks) rate_at[i / (steps / looks)] = loss;
    }
    run.residue = x.cellulose + x.char_mass + x.ash;
    return run;
}

SingeResult validate_kinetics(Lab *lab, SingeError *error) {
    enum { RATES = 3, LOOKS = 140 };
    static const double rates[RATES] = {1, 3, 5};
    static const char *const names[RATES] = {"1 K/min", "3 K/min", "5 K/min"};
    static const char *const inks[RATES] = {"#2166ac", "#e08214", "#b2182b"};
    static double loss[RATES][LOOKS], temperature[LOOKS];
    double off = 0, first = 0, rising = INFINITY;
    (void)error;
    for (int i = 0; i < LOOKS; i++) temperature[i] = 300 + 5 * i - 273.15;
    report_heads(lab->report, "heated by|peak C|loss there %/K|half gone C|residue %|peak, fine C|residue, fine %");
    for (int i = 0; i < RATES; i++) {
        KineticsRun run = kinetics_run(rates[i], 0.5, loss[i], LOOKS), fine = kinetics_run(rates[i], 0.05, NULL, 0);
        report_row(lab->report, "%s|%.1f|%.2f|%.1f|%.2f|%.1f|%.2f", names[i], run.peak - 273.15, 100 * run.peak_rate,
                   run.half - 273.15, 100 * run.residue, fine.peak - 273.15, 100 * fine.residue);
        off = fmax(off, fmax(fabs(run.peak - fine.peak), 1e3 * fabs(run.residue - fine.residue)));
        if (i == 0) first = fine.peak - 273.15;
        else rising = fmin(rising, fine.peak - 273.15 - first);
    }
    Plot plot = {.title = "Cellulose in air, mass lost a kelvin", .x_label = "C", .y_label = "1/K"};
    for (int i = 0; i < RATES; i++)
        plot_add(&plot, (PlotLine){names[i], inks[i], temperature, loss[i], LOOKS, false, false});
    report_plot(lab->report, &plot);
    const double ignition = (double)singe_default_material().ignition_temperature.value - 273.15;
    report_text(lab->report, "The simulation has no Arrhenius kinetics: this is what they say of cellulose that is heated slowly, "
                "integrated here by itself. Eq 4 burns from %.0f C on, where these lose their first mass.", ignition);
    report_measure(lab->report, "fine", "difference from ten times finer steps: K of the peak, or 0.1 % of residue", off, 0,
                   1.0);
    report_measure(lab->report, "shift", "least shift of the peak at 3 and 5 K/min from that at 1, K", rising, 5, 60);
    report_measure(lab->report, "threshold", "peak at 1 K/min less eq 4's ignition temperature, K", first - ignition, 0, 80);
    return SINGE_OK;
}

// ---- ledgers

SingeResult validate_ledgers(Lab *lab, SingeError *error) {
    static const char *const cases[][2] = {{"a hole burns", "adaptive.yaml"},
                                           {"the same, with gas", "adaptive.yaml"},
                                           {"a hot sphere crosses", "fig4.yaml"},
                                           {"a torus", "fig11.yaml"}};
    double heat = 0, mass = 0;
    SingeResult result = SINGE_OK;
    report_heads(lab->report, "scene|heat in J|combustion J|lost J|stored J|heat ledger|mass ledger");
    for (int i = 0; i < 4 && !result; i++) {
        const char *sets[] = {i == 1 ? "gas=yes" : "", i == 3 ? "sheets.0.mesh=torus-small.obj" : "",
                              i == 2 ? "sheets.0.grid.cells=[30, 42]" : "", NULL};
        Play play;
        result = play_open(&play, lab, cases[i][1], sets, error);
        if (!result) result = play_until(&play, lab->quick ? 1 : 2, error);
        if (!result) {
            SingeStats s = singe_sim_stats(play.sim);
            report_row(lab->report, "%s|%.3g|%.3g|%.3g|%.3g|%.1e|%.1e", cases[i][0], s.heat_in, s.heat_of_combustion,
                       s.heat_lost, s.heat_stored, s.ledger_error, s.mass_ledger_error);
            heat = fmax(heat, s.ledger_error), mass = fmax(mass, s.mass_ledger_error);
        }
        play_close(&play);
    }
    if (result) return result;
    report_measure(lab->report, "heat", "largest error of the heat ledger, over its largest entry", heat, 0, 1e-5);
    report_measure(lab->report, "mass", "largest error of the mass ledger, over the mass at the start", mass, 0, 1e-6);
    return SINGE_OK;
}
