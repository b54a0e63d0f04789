// The statements of the paper's sections 5 to 8, the result here, and the measure that shows it.
#include <math.h>

#include "paper/paper.h"

typedef enum Verdict { REPRODUCED, CORRECTED, CHOICE, NOT_REPRODUCED, NOT_FOLLOWED, REFUTED, OURS, VERDICTS } Verdict;
static const char *const verdicts[VERDICTS] = {[REPRODUCED] = "reproduced",
                                               [CORRECTED] = "corrected",
                                               [CHOICE] = "depends on an unstated choice",
                                               [NOT_REPRODUCED] = "not reproduced",
                                               [NOT_FOLLOWED] = "not followed",
                                               [REFUTED] = "refuted",
                                               [OURS] = "ours adds"};

/// A measure of `singe paper`, whose bar and whose failing case stand with its experiment.
typedef struct Statement {
    const char *section, *statement;
    Verdict verdict;
    const char *item, *measure, *found;
} Statement;

static const Statement statements[] = {
    {"5", "heat balls light a shell", REPRODUCED, "fig11", "start", "a torus burns from where the ball was"},
    {"5", "heat textures light a shell", REPRODUCED, "heat", "correlation", "it is hot where the texture is white"},
    {"5", "eq 1: combustion adds eta times the change of mass", CORRECTED, "readings", "eq1_printed",
     "that change is negative: as printed a fire puts itself out"},
    {"5", "eq 1: losses to the air and by radiation, which it lacks", OURS, "readings", "losses",
     "without them the sheet is twice as hot in kelvin"},
    {"5", "the umbrella transfers heat uniformly across irregular meshes", REFUTED, "readings", "umbrella_long",
     "on long cells it conducts several times as well along as across, on squares half of what it should"},
    {"5", "backward Euler takes long steps and stays stable", REPRODUCED, "whole", "reached",
     "the paper's system burns all three figures in steps of 2 ms, 4 to 17 ms of fire"},
    {"6", "m_loss near m_init: the shell burns out quickly", REPRODUCED, "mass-loss", "quick", "a fifth is gone early"},
    {"6", "m_loss below m_min: it wrinkles and stays whole", REPRODUCED, "mass-loss", "whole", "all cells are left"},
    {"6", "springs are shrunk, partly burnt or burnt; eq 5, 6 and Fig 5", REPRODUCED, "fig5", "lengths",
     "all five springs to the last digit"},
    {"6", "m'_1 = m_0 - m_loss", CORRECTED, "fig5", "cuts", "m_1: with m_0 no spring is ever partly burnt"},
    {"6", "eq 6: l_rest on both sides", CORRECTED, "readings", "l_rest",
     "l_init on the right: else a spring shrinks again at every step"},
    {"6", "eq 7 and marching triangles, Fig 6", REPRODUCED, "fig6", "area", "all four cases, and the area of eq 7"},
    {"6", "a spring goes when both triangles that share it have disappeared", NOT_FOLLOWED, "readings", "removal",
     "all springs of a cell go with it: else burnt corners hang on one yellow spring, spin, and stretch the drawn edge"},
    {"7", "eq 9: x + v", CORRECTED, "readings", "literal_steps", "it lacks h: to the letter the sheet is lost at once"},
    {"7", "eq 16: the masses, which it lacks", OURS, "readings", "mass_centre", "with them the centre stays"},
    {"7", "fast projection converges quickly to the target lengths", REPRODUCED, "fig8", "shrunk",
     "where targets agree: 7 projections take all but a hundredth"},
    {"7", "the same while it burns", NOT_REPRODUCED, "whole", "strain_all",
     "burning colours contradict each other: blue gains as the last one, and all four keep 5 % in every order"},
    {"7", "contacts within each projection: a torus stays on a sphere, Fig 7 a", REPRODUCED, "fig7ab", "paper",
     "it stays, by the paper's solver and by strands"},
    {"7.1", "all springs at once are more constraints than their rank", REPRODUCED, "all-at-once", "deficit_all",
     "112 of 360 are too many"},
    {"7.1", "so fast projection of all at once diverges", REPRODUCED, "all-at-once", "all_diverges",
     "with nothing on the diagonal"},
    {"7.1", "more constraints than degrees of freedom prevent a solution", REFUTED, "all-at-once", "floor_converges",
     "a floor of 1e-4 on the diagonal, and all at once converges further than colour after colour with the same"},
    {"7.1", "each colour alone meets the conditions", REPRODUCED, "all-at-once", "deficit_colours", "full rank"},
    {"7.1", "colour after colour converges", REPRODUCED, "all-at-once", "colours_converge", "slowly"},
    {"7.1", "the sum of all errors always decreases, Fig 8", REFUTED, "fig8", "rises",
     "in a third of the states it rises in one of seven steps; with our floor on the diagonal in one of seven"},
    {"7.1", "the error of one colour may rise while the sum falls", REPRODUCED, "fig8", "lower",
     "over seven steps the sum falls in nearly all states"},
    {"7.1", "two springs that exclude each other settle, Table 1", REPRODUCED, "table1", "largest_difference",
     "all ten positions to the last digit"},
    {"7.2", "dividing the displacement by w relaxes a spring", CORRECTED, "readings", "divided",
     "it diverges for w < 1/2"},
    {"7.2", "eq 19: C times w relaxes a spring", REPRODUCED, "readings", "multiplied", "it converges more slowly"},
    {"7.2", "thickness makes a plate of a cloth, Fig 10 a to c", REPRODUCED, "fig10", "bend_b_a",
     "from 1:20 to 1:80 strongly, to 1:400 little more"},
    {"7.2", "weights of 0.1 make it limper, Fig 10 d", REPRODUCED, "fig10", "bend_d_c", "by a fifth"},
    {"7.2", "weights may vary over a shell", REPRODUCED, "weights", "ratio", "the soft half hangs"},
    {"8", "a texture steers the rate of mass loss, Fig 1", REPRODUCED, "fig1", "correlation", "closely"},
    {"8", "a texture steers the diffusivity", REPRODUCED, "alpha", "ratio", "fire runs where heat spreads"},
    {"8", "partly burnt regions bend, Fig 1", REPRODUCED, "fig1", "curl",
     "rims curl; without shrinkage they stay flat"},
    {"8", "interior regions that keep their mass wrinkle too", REPRODUCED, "fig1", "inner", "they bend with the rest"},
    {"8", "the shell of Fig 4 separates into two parts", REPRODUCED, "fig4", "c_parts",
     "(a) and (c) do; in (d) char holds on, and tears"},
    {"8", "shrinkage makes it more detailed, Fig 4 b, c over a", REPRODUCED, "fig4", "c_curl",
     "rims curl dozens of times as far"},
    {"8", "a texture of the rate makes tears, Fig 4 d", REPRODUCED, "fig4", "d_border",
     "longer borders; the texture's mean all over does not"},
    {"8", "any quad mesh makes a shell, Fig 11", REPRODUCED, "fig11", "end", "fire goes both ways around a torus"},
    {"8", "the paper's system as one burns Figs 1, 4 and 11", REPRODUCED, "whole", "curl", "it crumples as drawn"},
    {"8", "a mass-spring torus passes the sphere, Fig 7 b", CHOICE, "fig7ab", "soft",
     "with springs of 1 N/m; with 100 N/m it stays"},
    {"8", "a mass-spring model cannot preserve strain", REFUTED, "fig7ab", "stiff",
     "with springs of 100 N/m the torus stays, for three times the substeps"},
    {"8", "the paper's method creates wrinkles where a sheet shrinks, Fig 7 c", REPRODUCED, "fig7cd", "wrinkles",
     "seven tenths of a millimetre high on 200 mm"},
    {"8", "only the paper's method does, Fig 7 c", CHOICE, "fig7cd", "soft_finer",
     "springs of 1 N/m have none in coarse cells, and higher ones in finer cells"},
    {"8", "a mass-spring sheet that shrinks loses its details, Fig 7 d", CHOICE, "fig7cd", "soft",
     "if its weight presses it flat: springs of 1 N/m in coarse cells, of 0.04 N/m in fine ones; stiffer ones keep them"},
    {"8.1", "dynamics takes most of the time", REPRODUCED, "whole", "dynamics", "nearly all of it"},
    {"8.1", "time is proportional to the number of springs, Table 2", CHOICE, "table2", "capped",
     "with a fixed cap of iterations it is; iterated to 1e-7 their number grows with the sheet"},
    {"8.1", "fully iterated costs 7 to 22 times the early end, Table 2", CHOICE, "table2", "rest",
     "7 times at rest, with a cap of iterations; less than twice while a sheet swings"},
    {"8.1", "a spring has seven neighbours in its matrix", REPRODUCED, "readings", "row", "itself and six, on a grid"},
    {"8.2", "more than six neighbours: the simulation does not converge", REFUTED, "adaptive", "fans",
     "the paper's solver holds discs with 8, 12 and 16 springs of a colour at a point"},
    {"8.2", "not straightforward on adaptive meshes", REFUTED, "adaptive", "graded",
     "strands take graded quads as they are and look alike; it saves too little to be worth it"},
    {"8.2", "layers cross where forces are large", REPRODUCED, "crossing", "turned", "in a good part of the cells"},
    {"8.2", "that helps to create complicated wrinkles", REPRODUCED, "crossing", "added", "about a tenth more"},
};
enum { COUNT = sizeof statements / sizeof *statements };

SingeResult paper_statements(Lab *lab, SingeError *error) {
    int counts[VERDICTS] = {0}, taken = 0, holding = 0;
    report_heads(lab->report, "section|the paper states|verdict|measure|is|found|fails for");

    for (const Statement *s = statements; s < statements + COUNT; s++) {
        const ReportTaken *found = report_find(lab->report, s->item, s->measure);
        const bool fails = found && found->verdict == REPORT_FAILS;
        counts[s->verdict]++;
        taken += found != NULL;
        holding += found && !fails;
        report_row(lab->report, "%s|%s|%s|%s: %s|%.4g|%s|%s", s->section, s->statement,
                   fails ? "its measure fails" : verdicts[s->verdict], s->item, s->measure,
                   found ? found->value : (double)NAN, s->found, found ? found->bad_what : "");
    }

    SingeResult result = report_table(lab->report, "statements", error);
    report_text(
        lab->report,
        "%d reproduced, %d corrected, %d depend on an unstated choice, %d not reproduced, %d not followed, %d refuted, %d "
        "ours. A statement's measure has its bar with its experiment: of a refuted one it is what refutes it.",
        counts[REPRODUCED], counts[CORRECTED], counts[CHOICE], counts[NOT_REPRODUCED], counts[NOT_FOLLOWED],
        counts[REFUTED], counts[OURS]);

    if (taken)
        report_bar(lab->report, "measures", "share of these measures that hold, of those taken",
                   (double)holding / taken, 1, 1, (double)(holding - 1) / taken, "one that does not");

    return result;
}
