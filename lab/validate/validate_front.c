// The burning front compared with sources: materials by grammage, direction, resolution and time step; thin PMMA with
// measurements and the formula of de Ris.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "analysis/strip.h"
#include "bench/bench.h"
#include "validate/validate.h"

static const BenchValue *cell(const BenchTable *table, int row, const char *column) {
    for (int c = 0; c < table->column_count; c++)
        if (strcmp(table->columns[c].name, column) == 0) return &table->cells[row * table->column_count + c];
    return NULL;
}

SingeResult validate_front(Lab *lab, SingeError *error) {
    BenchMaterials materials;
    BenchOptions options = bench_options();
    BenchTable table = {0};
    double worst = 0;

    if (bench_materials_open(NULL, &materials)) {
        bench_materials_close(&materials);
        return SINGE_ERROR_FORMAT;
    }

    options.threads = lab->threads;
    options.quick = lab->quick;
    options.material_count = materials.count;
    options.materials = materials.items;

    SingeResult result = bench_front(&options, &table, error);
    if (!result) {
        report_heads(lab->report,
                     "material|g/m2|direction|cell mm|step ms|mm/s|sources|change %|hottest C|basis|finding");

        for (int row = 0; row < table.row_count; row++) {
            const BenchValue *speed = cell(&table, row, "speed_mm_s"), *hottest = cell(&table, row, "hottest_C");
            const char *material = cell(&table, row, "material")->text,
                       *direction = cell(&table, row, "direction")->text;
            double change = cell(&table, row, "change_pct")->number[0];
            report_row(lab->report, "%s|%.0f|%s|%.2g|%.2f|%.3g|%.3g to %.3g|%+.1f|%.0f|%s|%s", material,
                       cell(&table, row, "g_m2")->number[0], direction, cell(&table, row, "cell_mm")->number[0],
                       cell(&table, row, "step_ms")->number[0], speed->number[0], speed->number[1], speed->number[2],
                       change, hottest->number[0], cell(&table, row, "basis")->text,
                       cell(&table, row, "finding")->text);
            if (strcmp(direction, "still") == 0 && isfinite(change)) worst = fmax(worst, fabs(change));
        }

        report_text(lab->report,
                    "One grammage of one material is calibrated; the others are predictions. The "
                    "sources' ranges "
                    "are in docs/materials.md%s.",
                    lab->quick ? "; this quick run has no strips with gas" : "");

        for (int row = 0; row < table.row_count; row++) {
            const char *direction = cell(&table, row, "direction")->text, *basis = cell(&table, row, "basis")->text;
            const char *material = cell(&table, row, "material")->text;
            const BenchValue *speed = cell(&table, row, "speed_mm_s");
            char name[80], what[120];
            bool first = row == 0 || strcmp(material, cell(&table, row - 1, "material")->text) != 0;
            if (first && isfinite(speed->number[1])) {
                snprintf(name, sizeof name, "speed_%s", material);
                snprintf(what, sizeof what, "%s, level: mm/s against the sources' range (%s)", material, basis);
                report_measure(lab->report, name, what, speed->number[0], speed->number[1], speed->number[2]);
            }

            if (strcmp(direction, "up") != 0 || strcmp(material, "cotton") != 0) continue;
            const double down = cell(&table, row - 1, "speed_mm_s")->number[0];
            report_measure(lab->report, "up_cotton", "cotton: up over down, over the measured 9.0/0.2 cm/s",
                           speed->number[0] / down / 45, VALIDATE_LOW, VALIDATE_HIGH);
        }

        report_measure(lab->report, "change", "largest change of speed with half the cell or half the step, %", worst,
                       0, 6);
    }

    table_free(&table);
    bench_materials_close(&materials);
    return result;
}

/// A strip that is three cells wide.
static StripSetup narrow_strip(const Lab *lab, const SingeMaterialDef *material, float length) {
    StripSetup setup = strip_setup(material);
    setup.cell = 2e-3f;
    setup.width = 6e-3f;
    setup.length = length;
    setup.threads = lab->threads;
    return setup;
}

// ---- PMMA

enum { SHEETS = 6 };
static const double bass_um[SHEETS] = {25, 45, 77, 100, 200, 402};             // thickness
static const double bass_mm_s[SHEETS] = {8.96, 6.52, 3.88, 2.06, 0.88, 0.435}; // downward, BASS-II

/// Density and specific heat of PMMA, its temperature of vaporising, the flame's, the gas' conductivity at the former.
static const double pmma_rho = 1190, pmma_c = 1465, pmma_vapour = 670, pmma_flame = 2200, gas_k = 0.05, ambient = 298;

static double slope(const double *x, const double *y, int n) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < n; i++)
        sx += log(x[i]), sy += log(y[i]), sxx += log(x[i]) * log(x[i]), sxy += log(x[i]) * log(y[i]);
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

SingeResult validate_pmma(Lab *lab, SingeError *error) {
    double ours[SHEETS], formula[SHEETS], ratio = 0, spread = 0;
    report_heads(lab->report, "um|g/m2|BASS-II mm/s|de Ris|here|here over BASS-II");

    for (int i = 0; i < SHEETS; i++) {
        SingeMaterialDef material = singe_default_material();
        StripResult strip;

        // known values of PMMA; parameters of the flame are those of office paper
        material.grammage = singe_param((float)(pmma_rho * bass_um[i] * 1e-6));
        material.specific_heat = singe_param((float)pmma_c);
        material.ignition_temperature = singe_param((float)pmma_vapour);
        material.heat_of_combustion = singe_param(25e6f);
        material.mass_min = singe_param(0.01f);
        material.mass_loss = singe_param(0.1f);
        material.char_yield = singe_param(0);
        material.heat_share = singe_param(0.2f); // no char: one reaction

        StripSetup setup = narrow_strip(lab, &material, 0.12f);
        setup.time_step *= (float)(bass_um[i] / 100); // in proportion to the grammage, as the fire is
        TRY(strip_burn(&setup, &strip, error));

        // de Ris (1969), thermally thin: V = sqrt(2) k_g F/(rho c tau), tau half of the thickness, F = (Tf - Tv)/(Tv -
        // Ta)
        const double um = bass_um[i];
        double flame = (pmma_flame - pmma_vapour) / (pmma_vapour - ambient);
        const double ris = 1e3 * sqrt(2) * gas_k * flame / (pmma_rho * pmma_c * um / 2 * 1e-6);

        ours[i] = 1e3 * strip.speed;
        formula[i] = ris;
        report_row(lab->report, "%.0f|%.0f|%.3g|%.3g|%.3g|%.2f", bass_um[i], 1e3 * (double)material.grammage.value,
                   bass_mm_s[i], formula[i], ours[i], ours[i] / bass_mm_s[i]);
        ratio += log(ours[i] / bass_mm_s[i]) / SHEETS;
        spread = fmax(spread, fabs(log(ours[i] / bass_mm_s[i])));
    }

    Plot plot = {
        .title = "PMMA sheets, downward", .x_label = "thickness, um", .y_label = "mm/s", .log_x = true, .log_y = true};
    plot_add(&plot, (PlotLine){"BASS-II", "#111", bass_um, bass_mm_s, SHEETS, true, false});
    plot_add(&plot, (PlotLine){"de Ris", "#999", bass_um, formula, SHEETS, false, true});
    plot_add(&plot, (PlotLine){"here", "#b2182b", bass_um, ours, SHEETS, false, false});
    report_plot(lab->report, &plot);

    const double measured = slope(bass_um, bass_mm_s, SHEETS), here = slope(bass_um, ours, SHEETS);
    report_text(lab->report,
                "A prediction: density, specific heat, vaporisation temperature (670 K) and heat of combustion are "
                "those of PMMA, and the parameters of the flame are the calibrated ones of office paper. Measured, the "
                "speed goes with the thickness to the power %.2f; theory and this model have -1, and so are too fast "
                "where it is thick. de Ris with gas of %.2g W/(m K), air at 670 K, and a flame of %.0f K.",
                measured, gas_k, pmma_flame);

    report_measure(lab->report, "power", "exponent of the speed over the thickness; -1 by theory", here, -1.05, -0.95);
    report_measure(lab->report, "power_measured", "the same exponent, minus the measured one", here - measured, -0.25,
                   0.25);
    report_measure(lab->report, "mean", "geometric mean of the ratio to BASS-II", exp(ratio), 0.5, 2);
    report_measure(lab->report, "worst", "the same ratio at the worst thickness", exp(spread), 1, 2.5);
    return SINGE_OK;
}

// ---- limiting oxygen

/// K, by which a flame is hotter than air that has this share of oxygen by mass: 13.1 MJ a kilogram of oxygen (Huggett
/// 1980), 1.19 kg of it a kilogram of cellulose, products of 1.2 kJ/(kg K).
static double flame_rise(double oxygen) { return 13.1e6 * oxygen / ((1 + oxygen / 1.19) * 1200); }

/// The least percentage of oxygen in which a strip burns through, `cooler` with flames that are cooler for the nitrogen in
/// them.
static SingeResult oxygen_least(Lab *lab, const SingeMaterialDef *usual, bool cooler, double *least,
                                SingeError *error) {
    const double cold = 293.15 - (double)usual->ignition_temperature.value; // K
    double low = 0;                                                         // it goes out
    SingeResult result = SINGE_OK;

    *least = 20.95;
    for (int i = 0; i < 6 && !result; i++) {
        // where air limits a rate, by rate_ceiling and char_rate, the rate is in proportion to oxygen; the heat that a
        // flame gives to the sheet is in proportion to the difference of their temperatures, as de Ris (1969) has it
        const double oxygen = (low + *least) / 2, share = oxygen / 20.95;
        const double flame = (cold + flame_rise(0.232 * share)) / (cold + flame_rise(0.232));
        SingeMaterialDef material = *usual;
        StripResult strip;

        if (cooler) material.heat_share.value *= (float)fmax(flame, 0);
        material.rate_ceiling.value *= (float)share;
        material.char_rate = singe_param((float)(1.6 * share)); // the middle of its patches
        const StripSetup setup = narrow_strip(lab, &material, 0.08f);
        result = strip_burn(&setup, &strip, error);

        const bool burns = strip.end == STRIP_THROUGH;
        *(burns ? least : &low) = oxygen;
        if (!result)
            report_row(lab->report, "%s|%.1f|%.2f|%.3g|%.0f|%s", cooler ? "cooler" : "as hot", oxygen,
                       cooler ? flame : 1, 1e3 * strip.speed, strip.hottest - 273.15, burns ? "burns" : "goes out");
    }

    return result;
}

SingeResult validate_oxygen(Lab *lab, SingeError *error) {
    SingeMaterialDef cotton = singe_default_material();
    if (singe_material_preset("cotton", &cotton, error)) return error->code;

    double least, as_hot;
    report_heads(lab->report, "flame|oxygen %|its heat, of that in air|mm/s|hottest C|");
    SingeResult result = oxygen_least(lab, &cotton, true, &least, error);
    if (!result) result = oxygen_least(lab, &cotton, false, &as_hot, error);
    if (result) return result;

    report_text(
        lab->report,
        "Oxygen is no quantity of the model. Here it scales what air limits, and the heat that the flame gives "
        "to the sheet, <code>heat_share</code>, as the flame's temperature above that of ignition: oxygen gives "
        "13.1 MJ/kg (Huggett 1980), which heats the products. Nothing was set by the measured limit.");
    report_bar(lab->report, "limit", "least oxygen in which cotton burns, over the measured 13.5 %", least / 13.5,
               VALIDATE_LOW, VALIDATE_HIGH, as_hot / 13.5, "with a flame as hot as in air");
    return SINGE_OK;
}

// ---- damp cloth

/// Heat a kilogram of dry cloth until it ignites, J/kg, under 40 kW/m2 and without losses.
static SingeResult preignition(Lab *lab, const SingeMaterialDef *material, double *heat, SingeError *error) {
    static const float white = 1;
    LabGrid grid = lab_grid(2, 2, 0.01f);
    SingeSim *sim;
    SingeSourceDef source = singe_default_source();
    SingeSourceId id;

    grid.material = *material;
    grid.material.convection = grid.material.emissivity = singe_param(0);
    grid.material.thickening = 1; // no front
    source.kind = SINGE_SOURCE_TEXTURE;
    source.texture = (SingeTexture){1, 1, &white};
    source.flux = 20e3f; // into either layer

    SingeResult result = lab_build(lab, &grid, &sim, error);
    if (result) return result;

    if ((result = singe_sim_add_source(sim, &source, &id))) *error = *singe_sim_error(sim);
    while (!result && singe_sim_view(sim).time_ignited[0] < 0 && singe_sim_view(sim).time < 60)
        result = lab_steps(sim, 1, error);
    *heat = 2 * (double)source.flux * (double)singe_sim_view(sim).time_ignited[0] / (double)material->grammage.value;
    singe_sim_destroy(sim);
    return result;
}

/// The least water, kg/(m2 s) on either face, that puts out a sheet that burns all over: falling from when a tenth of the
/// mass has burnt, it leaves half of it.
static SingeResult quenching(const Lab *lab, const SingeMaterialDef *material, double *least, SingeError *error) {
    static const float white = 1;
    SingeResult result = SINGE_OK;
    double low = 1e-3;
    *least = 1;

    while (*least > 1.02 * low && !result) {
        const double flux = sqrt(low * *least);
        LabGrid grid = lab_grid(10, 10, 0.01f);
        SingeSim *sim;
        SingeSourceDef heater = singe_default_source(), rain = heater;
        SingeSourceId id;

        grid.material = *material;
        grid.material.moisture = singe_param(1e-3f); // else it takes up none
        grid.material.thickening = 1;                // no front
        heater.kind = SINGE_SOURCE_TEXTURE;
        heater.texture = (SingeTexture){1, 1, &white};
        heater.flux = 20e3f; // into either layer

        rain.kind = SINGE_SOURCE_WATER;
        rain.texture = heater.texture;
        rain.wetting = (float)(2 * flux);
        if ((result = lab_build(lab, &grid, &sim, error))) return result;

        result = singe_sim_add_source(sim, &heater, &id);
        const int patience = (int)(60 / grid.time_step); // a sheet that does not ignite must not hang the page
        for (int step = 0; !result && step < patience && singe_sim_stats(sim).burnt_fraction < 0.1; step++)
            result = lab_steps(sim, 1, error);
        if (!result) result = singe_sim_remove_source(sim, id);
        if (!result) result = singe_sim_add_source(sim, &rain, &id);

        // until nothing has burnt for half a second
        const int steps = (int)(0.5f / grid.time_step);
        double before = 0, burnt = singe_sim_stats(sim).burnt_fraction;
        while (!result && burnt > before) {
            before = burnt;
            result = lab_steps(sim, steps, error);
            burnt = singe_sim_stats(sim).burnt_fraction;
        }

        *(burnt > 0.5 ? &low : least) = flux;
        if (result) *error = *singe_sim_error(sim);
        singe_sim_destroy(sim);
    }

    return result;
}

/// The heat of preignition of fine fuels, J/kg: 250 + 1116 M Btu/lb, M the share of water (Rothermel 1972, eq 12).
static double rothermel(double water) { return 2326 * (250 + 1116 * water); }

// Speeds of damp fuel: exp(-3.22 M), fitted to 197 fires in 44 groups of equal excelsior, packing, depth and wind, which
// differ in water, 2.7 to 27 % (Catchpole et al. 1998, by the table in FDS's validation).
SingeResult validate_damp(Lab *lab, SingeError *error) {
    static const float shares[] = {0, 0.02f, 0.05f, 0.15f, 0.25f, 0.34f, 0.7f}; // of the mass
    enum { COUNT = sizeof shares / sizeof *shares, ROOM = 2, DAMP = 4, WET = 5 };
    SingeMaterialDef cotton = singe_default_material();
    if (singe_material_preset("cotton", &cotton, error)) return error->code;

    double speed[COUNT], dry_heat = 0, fastest = 0, top = 0, added = 0, worst = 1;
    report_heads(lab->report, "water, % of the mass|mm/s||heat until it ignites, kJ/kg|of fine fuels|here over them");

    for (int k = 0; k < COUNT; k++) {
        StripResult strip;
        double heat;
        SingeMaterialDef material = cotton;
        material.moisture = singe_param(shares[k]);
        const StripSetup setup = narrow_strip(lab, &material, 0.08f);
        SingeResult result = strip_burn(&setup, &strip, error);
        if (!result) result = preignition(lab, &material, &heat, error);
        if (result) return result;

        const double water = (double)shares[k], ratio = heat / rothermel(water);
        speed[k] = strip.end == STRIP_THROUGH ? strip.speed : 0;
        if (speed[k] > top) fastest = 100 * water;
        top = fmax(top, speed[k]);
        if (k == 0) dry_heat = heat;
        else added = (heat - dry_heat) / (rothermel(water) - rothermel(0));
        if (fabs(log(ratio)) > fabs(log(worst))) worst = ratio;
        report_row(lab->report, "%.0f|%.3g|%s|%.0f|%.0f|%.2f", 100 * water, 1e3 * speed[k],
                   speed[k] > 0 ? "burns" : "goes out", 1e-3 * heat, 1e-3 * rothermel(water), ratio);
    }

    // water on a sheet that burns all over: with the air that it has, and with all of it
    SingeMaterialDef fierce = cotton;
    fierce.air_supply = singe_param(INFINITY);
    double water, fiercely;
    SingeResult result = quenching(lab, &cotton, &water, error);
    if (!result) result = quenching(lab, &fierce, &fiercely, error);
    if (result) return result;

    report_text(
        lab->report,
        "Water must boil off ahead of the front, and does nothing else. Measured, fire spreads over cloth with as "
        "much as 34 %% of water, and fastest with 2 %%, where water makes the flame larger: that is not in the "
        "model. Only the abstract could be read, which has no speeds. Speeds that could be read are those of fires in "
        "beds of excelsior, shavings of wood as thick as cloth: exp(-3.22 M), M the share of water (standard error "
        ".18; a fire scatters by 14 %%).");
    report_text(
        lab->report,
        "Water that falls on a sheet that burns all over puts it out from %.0f g/(m2 s) on either face. Burning "
        "surfaces without heat from elsewhere take 12.9 (Hansen 2012, in Penney, Habibi and Cattani 2019).",
        1e3 * water);

    const double slowing = speed[DAMP] / speed[ROOM] / exp(-3.22 * (double)(shares[DAMP] - shares[ROOM]));
    report_measure(lab->report, "slowing", "speed with 25 % of water over that with 5 %, over excelsior's .53", slowing,
                   0.8, 1.2);
    report_measure(lab->report, "delay", "heat that water adds until ignition, over fine fuels' 2.6 MJ/kg", added, 0.8,
                   1.2);
    report_measure(lab->report, "preignition", "all heat until ignition over fine fuels', where it is farthest off",
                   worst, 0.8, 1.2);
    report_measure(lab->report, "limit", "cotton with 34 % of water burns through; 1: it does", speed[WET] > 0, 1, 1);

    report_bar(lab->report, "quenching",
               "least water that puts out a sheet that burns all over, over 12.9 g/(m2 s) on a burning face",
               water / 12.9e-3, 0.8, 1.2, fiercely / 12.9e-3, "with as much air as in a front");
    report_measure(lab->report, "fastest", "water with which the front is fastest, %; 2 was measured", fastest, 1, 3);

    return SINGE_OK;
}
