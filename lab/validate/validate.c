// singe validate: compares the physics with independent sources.
#include "validate/validate.h"

static const PageItem items[] = {
    {"heat", "The heat equation, eq 2", "A slab's mode, insulated at both ends, decays as exp(-alpha k² t).",
     validate_heat},
    {"umbrella", "The umbrella's factor, eq 3", "A hot spot's variance grows by 2 alpha t in every direction.",
     validate_umbrella},
    {"front", "Speed of the front",
     "Office paper of 80 g/m²: 4.4 to 7.0 mm/s; speed in proportion to 1/grammage (Thomas &amp; Law, Fire Research "
     "Note 584). Cotton cloth burns up at 9.0 cm/s and down at 0.2 (Mathur, Vikas &amp; Kale).",
     validate_front},
    {"pmma", "Sheets of PMMA, downward",
     "8.96 mm/s at 25 um to 0.435 mm/s at 402 um (BASS-II); de Ris (1969): V = sqrt 2 k_g (T_f - T_v)/(T_v - T_a)/(rho "
     "c tau).",
     validate_pmma},
    {"cone", "Cotton in a cone calorimeter",
     "A cotton sheet of 120 g/m2 ignites after 9.75, 3 and 2 s under 25, 50 and 75 kW/m2, and gives 172, 196 and 212 "
     "kW/m2 at most (FSRI materials database, Cotton Sheet).",
     validate_cone},
    {"oxygen", "Limiting oxygen",
     "Cotton burns in 13.5 % of oxygen and more at 20 C, whatever its weave (extinction oxygen index, after Horrocks, "
     "Price &amp; Tunc 1987).",
     validate_oxygen},
    {"damp", "Damp cotton",
     "Fire spreads over level cotton cloth with 0 to 34 % of water, and fastest with 2 % (Textile Research Journal 2018, "
     "10.1177/0040517518807450). In beds of excelsior the speed is as exp(-3.22 M) of its share M of water (Catchpole "
     "et al. 1998).",
     validate_damp},
    {"plume", "A fire on a floor",
     "On the axis of a fire of 30 cm speed and temperature follow its power and the height (McCaffrey 1979, NBSIR "
     "79-1910); fires puff 1.5/sqrt(D) times a second (Cetegen &amp; Ahmed 1993).",
     validate_plume},
    {"beam", "A clamped strip", "Plate theory: w = rho g l&#8308;/(8 D) + rho g l²/(2 S).", validate_beam},
    {"disc", "A bilayer disc",
     "A strongly bent disc of two layers is a cylinder whose curvature is (1 + nu)/2 times its natural one, 3/4 at nu "
     "= 1/2 (arXiv 1509.05259).",
     validate_disc},
    {"kinetics", "Kinetics of cellulose",
     "Kashiwagi &amp; Nambu (1992), as in FDS: pyrolysis, oxidation and glow of cellulose in air at 1, 3 and 5 K/min.",
     validate_kinetics},
    {"ledgers", "Ledgers of heat and mass", "Energy and mass are conserved.", validate_ledgers},
    {"grades", "Grades", "How far each measure is from what the parameters were set by.", validate_grades},
};

static const ArgOption validate_options[] = {
    {"output", 'o', "DIR", "folder for the page [out/validate]", .read = args_folder, offsetof(PageRequest, folder)},
    {"only", 0, "NAME",
     "one of heat, umbrella, front, pmma, cone, oxygen, damp, plume, beam, disc, kinetics, ledgers, grades",
     .read = args_text, offsetof(PageRequest, only)},
    {"quick", 0, NULL, "small sizes, for a quick check", .read = args_switch, offsetof(PageRequest, quick)},
    {ARGS_THREADS(PageRequest)},
};

const ArgCommand validate_command = {
    "validate",
    NULL,
    "Compares the physics with independent sources and writes a page about it, DIR/index.html.",
    ARGS_OPTIONS(validate_options),
    .footer = "Exit codes: 0 good, 1 an error, or a measure outside its bars, 2 bad usage.",
    .examples = "singe validate -o out\n"
                "singe validate --only heat"};

static const Page page = {
    items,
    sizeof items / sizeof *items,
    "out/validate",
    "The physics, compared with independent sources",
    "This program's results beside solutions, formulas and measurements from elsewhere. Each item shows what the "
    "source says, what the program computes, and whether the measures are within their bars.",
    (const char *const[]){"grades", NULL}, // needs the others' measures
    validate_grade};

int command_validate(int argc, char **argv) { return page_run(&page, &validate_command, argc, argv); }
