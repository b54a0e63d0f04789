// The grade of each measure of `singe validate`: how far its source is from what the parameters were set by.
#include <math.h>
#include <string.h>

#include "validate/validate.h"

typedef enum Grade { INDEPENDENT, CALIBRATED, BY_CONSTRUCTION, GRADES } Grade;
static const char *const grade_words[GRADES] = {
    [INDEPENDENT] = "independent", [CALIBRATED] = "calibrated", [BY_CONSTRUCTION] = "by construction"};

typedef struct Graded {
    const char *item, *measure;
    Grade grade;
    bool misses;          ///< known not to hold
    const char *compared; ///< with what; where it misses, how far it is off
} Graded;

static const Graded graded[] = {
    {"heat", "order_space", INDEPENDENT, false, "a slab's exact mode, by cells"},
    {"heat", "order_time", INDEPENDENT, false, "a slab's exact mode, by steps"},
    {"heat", "error", INDEPENDENT, false, "a slab's exact mode"},
    {"umbrella", "surface", INDEPENDENT, false, "a hot spot's exact spread"},
    {"umbrella", "umbrella_squares", BY_CONSTRUCTION, false, "the factor that follows from eq 3"},
    {"umbrella", "umbrella_long", BY_CONSTRUCTION, false, "the factor that follows from eq 3"},
    {"front", "speed_office-paper", CALIBRATED, false, "Thomas and Law 1965; the parameters were set by it"},
    {"front", "speed_one-reaction", CALIBRATED, false, "the same; the same parameters"},
    {"front", "speed_cotton", BY_CONSTRUCTION, false, "its range is mostly office paper's over its mass"},
    {"front", "speed_newsprint", BY_CONSTRUCTION, false, "its range is office paper's over its mass, as the model is"},
    {"front", "speed_tissue", BY_CONSTRUCTION, false, "its range is office paper's over its mass, as the model is"},
    {"front", "up_cotton", INDEPENDENT, true, "Mathur, Vikas and Kale 2011; fire climbs a fifth as fast as it should"},
    {"front", "change", BY_CONSTRUCTION, false, "itself, in smaller cells and steps"},
    {"pmma", "power", BY_CONSTRUCTION, false, "-1, as the model is and as de Ris 1969 has it"},
    {"pmma", "power_measured", INDEPENDENT, false, "BASS-II"},
    {"pmma", "mean", INDEPENDENT, false, "BASS-II"},
    {"pmma", "worst", INDEPENDENT, false, "BASS-II"},
    {"cone", "ignition_25", CALIBRATED, false, "FSRI, cone calorimeter; the board was chosen by it"},
    {"cone", "ignition_50", CALIBRATED, false, "FSRI, cone calorimeter; the board was chosen by it"},
    {"cone", "ignition_75", CALIBRATED, false, "FSRI, cone calorimeter; the board was chosen by it"},
    {"cone", "power", INDEPENDENT, true, "FSRI, cone calorimeter; on that board -1.8 where -1.4 was measured"},
    {"cone", "peak", INDEPENDENT, false, "FSRI, cone calorimeter"},
    {"cone", "total", INDEPENDENT, false, "FSRI, cone calorimeter"},
    {"oxygen", "limit", INDEPENDENT, false, "an extinction oxygen index of cotton"},
    {"damp", "slowing", INDEPENDENT, false, "197 fires in beds of excelsior, Catchpole et al. 1998"},
    {"damp", "delay", BY_CONSTRUCTION, false, "water's latent and specific heat; Rothermel 1972 adds as much"},
    {"damp", "preignition", INDEPENDENT, true, "Rothermel 1972, wood to 320 C; dry cotton ignites at 305 C with less"},
    {"damp", "limit", INDEPENDENT, false, "level cotton cloth, Textile Research Journal 2018"},
    {"damp", "quenching", INDEPENDENT, false, "Hansen 2012, in Penney et al. 2019"},
    {"damp", "fastest", INDEPENDENT, true,
     "Textile Research Journal 2018; 2 % of water makes a flame larger, here water only cools"},
    {"plume", "speed_flame", INDEPENDENT, true, "McCaffrey 1979; half as fast, as the flame is too wide and cool"},
    {"plume", "speed_between", INDEPENDENT, false, "McCaffrey 1979"},
    {"plume", "speed_plume", INDEPENDENT, false, "McCaffrey 1979"},
    {"plume", "excess_flame", INDEPENDENT, true, "McCaffrey 1979; 300 K where he has 850"},
    {"plume", "excess_between", INDEPENDENT, false, "McCaffrey 1979"},
    {"plume", "excess_plume", INDEPENDENT, true, "McCaffrey 1979; twice as warm, as it mixes too little"},
    {"plume", "puffs", INDEPENDENT, true, "Cetegen and Ahmed 1993; there is no beat"},
    {"plume", "sways", INDEPENDENT, true, "a fire that puffs; ours stands nearly still at ten cells a diameter"},
    {"beam", "sag", INDEPENDENT, false, "plate theory"},
    {"disc", "stiffness", BY_CONSTRUCTION, false, "the lattice of springs"},
    {"disc", "poisson_grid", BY_CONSTRUCTION, false, "the lattice of springs"},
    {"disc", "poisson_diagonal", BY_CONSTRUCTION, false, "the lattice of springs"},
    {"disc", "bowl", INDEPENDENT, false, "an isotropic plate; its shear was set on strips, not on discs"},
    {"disc", "rolls", BY_CONSTRUCTION, false, "the lattice of springs: its soft direction"},
    {"disc", "cylinder", INDEPENDENT, false, "plate theory (arXiv 1509.05259) with the nu of a pull"},
    {"kinetics", "peak", BY_CONSTRUCTION, false, "the same reaction, finely integrated"},
    {"kinetics", "residue", BY_CONSTRUCTION, false, "the same reaction, finely integrated"},
    {"kinetics", "three", INDEPENDENT, false, "three reactions (Kashiwagi and Nambu 1992), of which the run has one"},
    {"kinetics", "shift", BY_CONSTRUCTION, false, "the reaction's activation energy"},
    {"kinetics", "threshold", INDEPENDENT, false, "Kashiwagi and Nambu 1992; eq 4's threshold is from elsewhere"},
    {"ledgers", "heat", BY_CONSTRUCTION, false, "conservation"},
    {"ledgers", "mass", BY_CONSTRUCTION, false, "conservation"},
};
enum { COUNT = sizeof graded / sizeof *graded };

ReportGrade validate_grade(const char *item, const char *measure) {
    for (const Graded *g = graded; g < graded + COUNT; g++)
        if (strcmp(g->item, item) == 0 && strcmp(g->measure, measure) == 0)
            return (ReportGrade){grade_words[g->grade], g->misses};
    return (ReportGrade){NULL, false};
}

SingeResult validate_grades(Lab *lab, SingeError *error) {
    int counts[GRADES] = {0}, missing = 0;
    report_heads(lab->report, "item|measure|grade|is|bar|compared with");

    for (const Graded *g = graded; g < graded + COUNT; g++) {
        const ReportTaken *taken = report_find(lab->report, g->item, g->measure);
        counts[g->grade]++;
        missing += g->misses;
        report_row(lab->report, "%s|%s|%s|%.3g|%s|%s", g->item, g->measure, grade_words[g->grade],
                   taken ? taken->value : (double)NAN,
                   taken && taken->verdict == REPORT_FAILS ? "fails"
                   : g->misses                             ? "misses"
                                                           : "holds",
                   g->compared);
    }

    report_text(lab->report,
                "Of %d measures %d are independent, %d calibrated and %d by construction; %d of the independent ones "
                "miss. Independent: no parameter was set by its source, or by anything that follows from it. "
                "Calibrated: parameters were set so that it holds. By construction: it follows from the model's own "
                "equations, so that only a fault could break it.",
                COUNT, counts[INDEPENDENT], counts[CALIBRATED], counts[BY_CONSTRUCTION], missing);
    return report_table(lab->report, "grades", error);
}
