// A fire of gas on a floor: what rises on its axis, and how often it puffs.
//
// McCaffrey (Purely Buoyant Diffusion Flames: Some Experimental Results, NBSIR 79-1910, 1979) burnt natural gas on a
// burner of 30 cm at 14 to 58 kW. With y = z/Q^(2/5), z in m and Q in kW, the mean speed and excess of temperature on the
// axis are
//
//   w = k y^n Q^(1/5),   T - Ta = (k/(0.9 sqrt(2 g)))^2 y^(2n - 1) Ta
//   flame y < .08: k = 6.8, n = 1/2;   where it comes and goes: 1.9, 0;   plume y > .2: 1.1, -1/3
//
// Such fires puff 1.5/sqrt(D) times a second (Cetegen and Ahmed 1993, Combustion and Flame 93:157).
#include <math.h>
#include <stdio.h>

#include "validate/validate.h"

enum { ACROSS = 10, PLANES_MAX = 128, RATE = 120, STEPS_MAX = 10 * RATE, DIAMETERS = 3, PLACES = 3 };
static const double diameters[DIAMETERS] = {0.3, 0.1, 0.05}; // m
static const double strength = 292;                          // kW/m^2.5: 14.4 kW on 30 cm
static const double places[PLACES] = {0.06, 0.14, 0.3};      // y: in the flame, where it comes and goes, in the plume
static const double ambient = 293.15, gravity = 9.81;

typedef struct Fire {
    double diameter, power;               ///< m, kW
    double speed[PLACES], excess[PLACES]; ///< on the axis, in the mean, over the law's
    double puffs, sways;                  ///< 1/s; the axis's speed half a diameter up: its deviation over its mean
} Fire;

/// The floor, which does not burn, and the burner: a source in each cell of the gas on a disc.
static SingeResult build(const Fire *fire, SingeSim *sim) {
    const float half = (float)(1.5 * fire->diameter);
    const float corners[4][3] = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    const uint32_t cell[4] = {0, 1, 2, 3};
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;

    sheet.vertex_count = 4;
    sheet.positions = &corners[0][0];
    sheet.cell_count = 1;
    sheet.cells = cell;
    sheet.material.mass_rate = singe_param(0);
    SingeResult result = singe_sim_add_sheet(sim, &sheet, &id);

    const double apart = fire->diameter / ACROSS, middle = 0.5 * (ACROSS - 1);
    int count = 0;
    for (int k = 0; k < ACROSS * ACROSS; k++) count += hypot(k % ACROSS - middle, k / ACROSS - middle) < 0.5 * ACROSS;

    for (int k = 0; k < ACROSS * ACROSS && !result; k++) {
        const double x = k % ACROSS - middle, y = k / ACROSS - middle;
        if (hypot(x, y) >= 0.5 * ACROSS) continue;

        SingeSourceDef source = singe_default_source();
        SingeSourceId flame;

        source.kind = SINGE_SOURCE_BALL;
        source.temperature = (float)ambient; // its gas alone is hot
        source.power = (float)(1e3 * fire->power / count);
        source.position[0] = (float)(apart * x);
        source.position[1] = (float)(apart * y);
        source.position[2] = (float)(0.5 * apart);
        result = singe_sim_add_source(sim, &source, &flame);
    }

    return result ? result : singe_sim_commit(sim);
}

/// The frequency of the largest peak of the spectrum, with a window of one cosine.
static double frequency(const double *series, int count) {
    double mean = 0, most = 0, found = 0;
    for (int s = 0; s < count; s++) mean += series[s] / count;

    for (double f = 0.5; f < 15; f += 0.05) {
        double real = 0, imaginary = 0;
        for (int s = 0; s < count; s++) {
            const double turn = 2 * M_PI * s, x = (1 - cos(turn / count)) * (series[s] - mean);
            real += x * cos(turn * f / RATE);
            imaginary += x * sin(turn * f / RATE);
        }

        const double power = real * real + imaginary * imaginary;
        if (power > most) found = f;
        most = fmax(most, power);
    }

    return found;
}

static SingeResult burn(const Lab *lab, Fire *fire, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    SingeSim *sim;

    def.time_step = 1.0f / RATE;
    def.gravity[2] = -(float)gravity;
    def.ambient_temperature = (float)ambient;
    def.thread_count = lab->threads;
    def.gas.enabled = true;
    def.gas.cell_size = (float)(fire->diameter / ACROSS);
    def.gas.height = (float)(4 * fire->diameter);

    SingeResult result = singe_sim_create(&def, &sim, error);
    if (result) return result;
    if ((result = build(fire, sim))) *error = *singe_sim_error(sim);

    // on the axis, after the first third
    const int steps = (lab->quick ? 4 : 9) * RATE, from = steps / 3;
    double speed[PLANES_MAX] = {0}, kelvin[PLANES_MAX] = {0}, series[STEPS_MAX];
    double mean = 0;
    double square = 0;
    SingeGas gas = {.size = {0}};
    for (int s = 0; s < steps && !result; s++) {
        result = lab_steps(sim, 1, error);
        gas = singe_sim_gas(sim);
        const size_t plane = (size_t)gas.size[0] * gas.size[1];
        const size_t axis = (size_t)gas.size[0] * (gas.size[1] / 2) + gas.size[0] / 2;
        const size_t low = (size_t)((0.5 * fire->diameter - (double)gas.origin[2]) / (double)gas.cell);
        if (s < from) continue;

        series[s - from] = (double)gas.velocity[axis + plane * low][2];
        mean += series[s - from] / (steps - from);
        square += series[s - from] * series[s - from] / (steps - from);

        for (uint32_t k = 0; k < gas.size[2] && k < PLANES_MAX; k++) {
            speed[k] += (double)gas.velocity[axis + plane * k][2] / (steps - from);
            kelvin[k] += (double)gas.temperature[axis + plane * k] / (steps - from);
        }
    }

    for (int p = 0; p < PLACES && !result; p++) {
        const double y = places[p], z = y * pow(fire->power, 0.4);
        const size_t k = (size_t)((z - (double)gas.origin[2]) / (double)gas.cell);
        const double factor = y < 0.08 ? 6.8 : y < 0.2 ? 1.9 : 1.1, power = y < 0.08 ? 0.5 : y < 0.2 ? 0 : -1.0 / 3;
        fire->speed[p] = speed[k] / (factor * pow(y, power) * pow(fire->power, 0.2));
        fire->excess[p] =
            (kelvin[k] - ambient) / (pow(factor / (0.9 * sqrt(2 * gravity)), 2) * pow(y, 2 * power - 1) * ambient);
    }

    if (!result) {
        fire->puffs = frequency(series, steps - from);
        fire->sways = sqrt(fmax(square - mean * mean, 0)) / mean;
    }
    singe_sim_destroy(sim);
    return result;
}

SingeResult validate_plume(Lab *lab, SingeError *error) {
    Fire fires[DIAMETERS];
    double least = INFINITY;
    SingeResult result = SINGE_OK;
    report_heads(lab->report, "cm|kW|speed over McCaffrey's: flame|between|plume|excess of temperature over his: flame|"
                              "between|plume|puffs, 1/s|1.5/sqrt(D)|sways by");

    for (int i = 0; i < DIAMETERS && !result; i++) {
        Fire *fire = &fires[i];
        *fire = (Fire){.diameter = diameters[i], .power = strength * pow(diameters[i], 2.5)};
        result = burn(lab, fire, error);
        if (!result)
            report_row(lab->report, "%.0f|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f|%.2f|%.3f", 1e2 * fire->diameter,
                       fire->power, fire->speed[0], fire->speed[1], fire->speed[2], fire->excess[0], fire->excess[1],
                       fire->excess[2], fire->puffs, 1.5 / sqrt(fire->diameter), fire->sways);
        least = fmin(least, fire->sways);
    }
    if (result) return result;

    report_text(
        lab->report,
        "Cells are a tenth of the burner. Fuel is heat that waits in the air of a cell, and burns as soon as it "
        "is there: the flame stands on the floor instead of around a core of gas, is cool and wide, and the "
        "plume above it sways too little to mix with air as turbulent ones do.");

    static const char *const names[2][PLACES] = {{"speed_flame", "speed_between", "speed_plume"},
                                                 {"excess_flame", "excess_between", "excess_plume"}};
    static const char *const wheres[PLACES] = {"in the flame", "where it comes and goes", "in the plume"};
    for (int k = 0; k < 2; k++)
        for (int p = 0; p < PLACES; p++) {
            char what[100];
            snprintf(what, sizeof what, "%s %s over McCaffrey's, 30 cm", k ? "excess of temperature" : "speed",
                     wheres[p]);
            report_measure(lab->report, names[k][p], what, k ? fires[0].excess[p] : fires[0].speed[p], VALIDATE_LOW,
                           VALIDATE_HIGH);
        }

    report_measure(lab->report, "puffs", "puffs a second over 1.5/sqrt(D), 30 cm",
                   fires[0].puffs * sqrt(fires[0].diameter) / 1.5, 0.85, 1.15);
    report_measure(lab->report, "sways", "deviation of the speed half a diameter up over its mean, the least", least,
                   0.1, INFINITY);
    return SINGE_OK;
}
