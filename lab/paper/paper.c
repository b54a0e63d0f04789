// singe paper: every experiment of the paper, computed here and compared with the paper.
#include "paper/paper.h"

/// In the order of the page.
static const PageItem items[] = {
    {"fig1", "Fig 1, 12: burning paper",
     "Paper starts above its ignition temperature and loses mass at a rate weighted by the texture shown. Burnt "
     "regions bend, and interior regions wrinkle with them.",
     paper_fig1},
    {"fig2", "Fig 2: one layer shrinks, and the shell curls",
     "A linear beam and the BCS shell in 2D: both curve when one layer shrinks.", paper_fig2},
    {"fig3", "Fig 3: the body-centred square",
     "Each cell has a lattice point, offset from the plane, and springs of four colours: 4, 2, 2 and 2 per cell.",
     paper_fig3},
    {"fig4", "Fig 4: a hot sphere crosses a sheet",
     "A sheet held at two corners: (a) boundary change only; (b) shrinkage; (c) both; (d) with a texture for the rate "
     "of mass loss. It separates into two parts, with more detail from column to column.",
     paper_fig4},
    {"fig5", "Fig 5: states of a spring",
     "Springs shrunk to 87.5 %, 62.5 %, 57.5 % and 50 % of their length, the last two partly burnt, and one that is "
     "burnt out.",
     paper_fig5},
    {"fig6", "Fig 6: marching triangles", "The four cases of a triangle, by the number of corners that remain.",
     paper_fig6},
    {"fig7ab", "Fig 7 a, b: a torus on a sphere",
     "A torus falls on a sphere of 1.2 times the radius of its hole. With the paper's method (a) it stays there; with "
     "a mass-spring model (b) it stretches, passes the sphere and meets the ground.",
     paper_fig7ab},
    {"fig7cd", "Fig 7 c, d: uniform shrinkage",
     "The blue springs of a whole shell shrink equally. With the paper's method (c), it forms complicated wrinkles; "
     "with a mass-spring model (d), it loses them.",
     paper_fig7cd},
    {"fig10", "Fig 10: thickness and weights",
     "Ratios of thickness to side of 1:20, 1:80 and 1:400 with weights of 1, and 1:400 with a weight of 0.1 for blue "
     "and yellow springs: from a stiff plate to a limp cloth.",
     paper_fig10},
    {"weights", "Section 7.2: inhomogeneous weights",
     "\"It is also possible to obtain a shell which has inhomogeneous bending stiffness by assigning different weights "
     "to the springs in each subset.\"",
     paper_weights},
    {"fig8", "Fig 8: errors over projection steps",
     "The error of one colour may rise while others are projected; the sum over all \"always decreases\".", paper_fig8},
    {"fig11", "Fig 11: a burning torus", "Any quad mesh can be a shell: a hot ball ignites a torus.", paper_fig11},
    {"whole", "Figs 1, 4, 11: the paper as one system",
     "Umbrella operator, linear loss of mass, shortening by eq 6, and fast projection of red, green, blue and yellow "
     "in turn: all together in the scenes with fire.",
     paper_whole},
    {"heat", "Sections 5, 8: a heat texture",
     "\"We use simpler external heat sources, such as heat balls and heat textures.\"", paper_heat},
    {"alpha", "Section 8: thermal diffusivity by a texture",
     "\"Its randomness [was] controlled by adjusting the rate of mass loss, and the thermal diffusivity, by applying a "
     "texture.\"",
     paper_alpha},
    {"mass-loss", "Section 6: what m_loss does",
     "\"When m_loss is close to m_init, then the shell burns out quickly; but if m_loss is less than m_min, the shell "
     "wrinkles but remains intact.\"",
     paper_mass_loss},
    {"rival", "Sections 2, 3: the rival idea",
     "\"The bending of thin shells during burning is not caused by differences in temperature (Melek et al., Liu et "
     "al.), but by shrinkage.\"",
     paper_rival},
    {"table1", "Fig 9, Table 1: two springs that exclude each other",
     "A particle between two fixed points settles where its two springs balance: ten positions.", paper_table1},
    {"all-at-once", "Section 7.1: all colours at once",
     "More constraints than degrees of freedom, 10 to 6, and gradients that depend on each other: fast projection of "
     "all springs in one system diverges.",
     paper_all_at_once},
    {"table2", "Table 2: time of a step",
     "Time in proportion to the number of springs, with conjugate gradients on an ELLPACK matrix, on a quad-core "
     "machine with 4 GB.",
     paper_table2},
    {"crossing", "Section 8.2: layers that may cross",
     "A point of one layer may move into the other, \"producing sharp crease[s]\"; this is left so \"because it helps "
     "to "
     "create complicated wrinkles on the shell\".",
     paper_crossing},
    {"adaptive", "Section 8.2: adaptivity",
     "\"It is not straightforward to apply our method to adaptive BCS, BCC or irregular meshes.\"", paper_adaptive},
    {"readings", "Ambiguities and misprints",
     "Where the paper can be read in more than one way; docs/equations has them with all the differences that are "
     "choices.",
     paper_readings},
    {"statements", "Sections 5 to 8, statement by statement",
     "What the paper says about its method and its results, and what this program finds.", paper_statements},
};

static const ArgOption paper_options[] = {
    {"output", 'o', "DIR", "folder for the page [out/paper]", .read = args_folder, offsetof(PageRequest, folder)},
    {"quick", 0, NULL, "small sizes, for a quick check", .read = args_switch, offsetof(PageRequest, quick)},
    {ARGS_THREADS(PageRequest)},
};

const ArgCommand paper_command = {
    "paper",
    "WHAT",
    "Runs the paper's experiments and writes a page about them, DIR/index.html.",
    ARGS_OPTIONS(paper_options),
    "WHAT is all, or one of\n"
    "  fig1 fig2 fig3 fig4 fig5 fig6 fig7ab fig7cd fig8 fig10 fig11 table1 table2 whole\n"
    "  heat alpha all-at-once mass-loss weights rival crossing adaptive readings statements   (docs/cli.md "
    "describes them)\n"
    "\n"
    "Exit codes: 0 good, 1 an error, or a measure outside its bars, 2 bad usage.",
    "singe paper fig8 -o out\n"
    "singe paper all --quick",
    .operand_field = offsetof(PageRequest, item)};

static const char *const alone[] = {"table2", "adaptive", "statements", NULL};

static const Page page = {
    items,
    sizeof items / sizeof *items,
    "out/paper",
    "The paper, figure by figure",
    "The experiments of <i>Shrinkage, wrinkling and ablation of burning cloth and paper</i>, as this program runs "
    "them. Each item shows what the paper reports and what the program computes, and compares measures of it with "
    "bars. The scenes are in <code>scenes/</code> next to this page; <code>singe run</code> runs them.",
    alone,
    NULL};

const char *paper_item_word(int index) {
    if (index == 0) return "all";
    return index <= (int)(sizeof items / sizeof *items) ? items[index - 1].name : NULL;
}

int command_paper(int argc, char **argv) { return page_run(&page, &paper_command, argc, argv); }
