// How much the folds of a burning sheet follow the mesh: the same burn on a grid and on the grid turned by 45 degrees.
//
// A sheet of 14 cm, a square or a disc, lies on the ground and is lit in its centre; its layers shrink by different
// amounts, by equation 6 near its full strength, and char remains in spots. r is the bending of creases along the
// sheet's axes divided by that along its diagonals (analysis/wrinkles.h), summed over MOMENTS of the second half of the
// burn. If O is the effect of the outline and the fibres, and M that of the mesh, then r_0 = O M on the grid and r_45 =
// O/M on the turned one:
//
//   mesh effect M = sqrt(r_0/r_45),   1 if folds do not depend on the mesh
//
// The same for gentle bends alone, which follow the stiffness of bending, and for sharp ones, where rows of edges give
// way.
//
// Seeds are those of the material's noise: where it burns, shrinks and remains. Both grids of a pair have the same
// seed.
#include "bench/bench.h"

#include <math.h>

#include "analysis/turned_grid.h"
#include "analysis/wrinkles.h"

enum { MOMENTS = 6 };

static const double size = 0.14; // m

typedef struct Burn {
    const BenchOptions *options;
    int cells;
    bool disc, creases;
    double thickness, limit; ///< m, 1/m
    uint32_t seed;
} Burn;

enum { NOISES = 4 };

static SingeResult isotropy_sheet(SingeSim *sim, const Burn *burn, double angle, SingeError *error) {
    SingeSheetDef def = singe_default_sheet();
    SingeSheetId id;
    SingeField noises[NOISES];
    Mesh mesh;
    const TurnedGrid cut = {
        .size = size, .cells = burn->cells, .disc = burn->disc, .angle = angle, .wear = {.jitter = 0.15f, .seed = 1}};
    SingeResult result = turned_grid(&cut, &mesh, error);

    if (result) return result;
    for (uint32_t v = 0; v < mesh.vertex_count; v++) mesh.positions[3 * (size_t)v + 2] = 0.5e-3f;
    def.vertex_count = mesh.vertex_count;
    def.positions = mesh.positions;
    def.uv = mesh.uv;
    def.cell_count = mesh.cell_count;
    def.cells = mesh.cells;

    // office paper that shrinks strongly; it points to `noises`
    SingeMaterialDef *paper = &def.material;
    *paper = singe_default_material();
    const uint32_t seed = 16 * burn->seed;
    const SingeNoise noise[NOISES] = {
        {0.03f, 5, seed + 1}, {0.025f, 5, seed + 7}, {0.015f, 4, seed + 3}, {0.05f, 2, seed + 2}};
    for (int k = 0; k < NOISES; k++) noises[k] = (SingeField){.kind = SINGE_FIELD_NOISE, .noise = noise[k]};
    paper->thickness = singe_param((float)burn->thickness);
    paper->curvature_max = singe_param((float)burn->limit);
    paper->mass_rate = singe_param_field(4e-3f, 10e-3f, &noises[0]);
    paper->mass_loss = singe_param_field(0, 0.3f, &noises[1]);
    paper->char_strength = singe_param_field(1, 10, &noises[2]);
    paper->shrink_front = singe_param_field(0.5f, 1.3f, &noises[3]);
    paper->shrink_back = singe_param(0.65f);
    paper->char_yield = singe_param(0);
    if (burn->options->red > 0) paper->compliance[SINGE_RED] = singe_param((float)burn->options->red);
    paper->heat_share = singe_param(0.2f);
    paper->ash_density = singe_param(0.3f); // eq 4

    def.drop_pieces_below = 4e-6f;
    result = singe_sim_add_sheet(sim, &def, &id);
    if (!result) result = singe_sim_commit(sim);
    if (result) *error = *singe_sim_error(sim);
    mesh_free(&mesh);
    return result;
}

static SingeResult isotropy_build(const Burn *burn, double angle, SingeSim **sim, SingeError *error) {
    SingeSimDef def = singe_default_sim();
    const BenchOptions *options = burn->options;
    def.thread_count = options->threads;
    def.pace = 5;
    def.instructions = options->instructions;
    def.solver.substeps = options->substeps ? options->substeps : 8;
    def.solver.creases = burn->creases;
    def.solver.isotropic = options->isotropic;
    def.solver.tearing = true;
    def.contact.enabled = true;
    TRY(singe_sim_create(&def, sim, error));
    SingeResult result = isotropy_sheet(*sim, burn, angle, error);
    if (!result) {
        const SingePoseKey centre = {0, {0, 0, 0}, {0, 0, 0, 1}};
        SingeColliderDef ground = singe_default_collider();
        SingeSourceDef spot = singe_default_source();
        SingeColliderId collider;
        SingeSourceId source;
        ground.path_count = spot.path_count = 1;
        ground.path = spot.path = &centre;
        spot.radius = 0.01f;
        spot.falloff = 0.015f;
        spot.temperature = 1123.15f;
        spot.end = 1.5f;
        result = singe_sim_add_collider(*sim, &ground, &collider);
        if (!result) result = singe_sim_add_source(*sim, &spot, &source);
        if (result) *error = *singe_sim_error(*sim);
    }

    if (result) singe_sim_destroy(*sim), *sim = NULL;
    return result;
}

static double total(const double *numbers, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += numbers[i];
    return sum;
}

/// Burns the sheet and sums its wrinkles.
static SingeResult isotropy_run(const Burn *burn, double angle, Wrinkles *wrinkles, SingeError *error) {
    const double seconds = burn->options->time > 0 ? burn->options->time : 1.1;
    SingeSim *sim = NULL;
    SingeSurface surface = {0};
    SingeResult result = isotropy_build(burn, angle, &sim, error);

    if (result) return result;
    for (int look = 1; look <= MOMENTS && !result; look++) {
        double until = seconds * (0.5 + 0.5 * look / MOMENTS) - 1e-9;
        while (!result && singe_sim_view(sim).time < until) result = singe_sim_step(sim);
        if (!result) result = singe_sim_surface(sim, &surface);
        if (result) *error = *singe_sim_error(sim);
        else if (!wrinkles_add(&surface, wrinkles)) result = SINGE_ERROR_MEMORY;
    }

    singe_surface_free(&surface);
    singe_sim_destroy(sim);
    return result;
}

/// Sums over seeds, of logarithms of effects.
typedef struct Effects {
    int count;
    double all, squares, gentle, sharp;
} Effects;

static double effect(double r_0, double r_45) { return sqrt(r_0 / r_45); }

/// The row of a seed, which it adds to the sums.
static SingeResult isotropy_compare(const Burn *burn, BenchTable *table, Effects *sum, SingeError *error) {
    Wrinkles straight = {0}, turned = {0};
    SingeResult result = isotropy_run(burn, 0, &straight, error);
    if (!result) result = isotropy_run(burn, acos(-1) / 4, &turned, error);
    if (result) return result;
    const double r_0 = wrinkles_bias(&straight), r_45 = wrinkles_bias(&turned);
    const double bend = total(straight.crease, WRINKLE_BINS) + total(turned.crease, WRINKLE_BINS);
    const double own_effect = log(effect(r_0, r_45));
    sum->count++;
    sum->all += own_effect;
    sum->squares += own_effect * own_effect;
    sum->gentle += log(effect(wrinkles_bias_gentle(&straight), wrinkles_bias_gentle(&turned)));
    sum->sharp += log(effect(wrinkles_bias_sharp(&straight), wrinkles_bias_sharp(&turned)));

    // red springs give by the material's compliance, or by (a + r) h^2/m of the solver where that is more (stiffness.c)
    const SingeSolverDef solver = singe_default_solver();
    const SingeMaterialDef usual = singe_default_material();
    const double red = burn->options->red > 0 ? burn->options->red : (double)usual.compliance[SINGE_RED].value;
    const double h = (double)singe_default_sim().time_step / (burn->options->substeps ? burn->options->substeps : 8);
    const double cell = size / burn->cells, mass = cell * cell * (double)usual.grammage.value / 2;
    const double lean = (cell * cell / 2 + pow(burn->thickness, 2)) / pow(burn->thickness, 2);
    const double own = (2.5 + (double)solver.regularisation[SINGE_RED]) * h * h / mass * lean;
    const double n = sum->count, mean = sum->all / n; // of the seeds so far, as are the three numbers behind it
    table_text(table, "outline", 8, burn->disc ? "disc" : "square");
    table_number(table, "cell_mm", "%.3g", 8, 1e3 * size / burn->cells);
    table_number(table, "thickness_mm", "%.3g", 13, 1e3 * burn->thickness);
    table_number(table, "curvature_max", "%.0f", 14, burn->limit);
    table_text(table, "creases", 8, burn->creases ? "yes" : "no");
    table_number(table, "red_m_n", "%.3g", 8, fmax(red, own)); // compliance, the solver's own softness included
    table_number(table, "seed", "%.0f", 5, burn->seed);
    table_number(table, "r_0", "%.3f", 7, r_0);
    table_number(table, "r_45", "%.3f", 7, r_45);
    table_number(table, "effect", "%.3f", 7, effect(r_0, r_45));
    table_number(table, "mean", "%.3f", 7, exp(mean));
    table_number(table, "error", "%.3f", 7,
                 exp(mean) * sqrt(fmax(sum->squares / n - mean * mean, 0) / (n - 1))); // its standard one
    table_number(table, "gentle", "%.3f", 7, exp(sum->gentle / sum->count));
    table_number(table, "sharp", "%.3f", 7, exp(sum->sharp / sum->count));
    table_number(table, "bend_per_m", "%.2f", 11, bend / (2 * MOMENTS * size * size));
    return table_end_row(table);
}

SingeResult bench_isotropy(const BenchOptions *options, BenchTable *table, SingeError *error) {
    const double cell = 2e-3, sheet = 1e-3, limit = (double)singe_default_material().curvature_max.value;
    const double along = round(size / cell);
    const BenchList cells = bench_list(&options->cells, 1, &along);
    const BenchList thickness = bench_list(&options->thickness, 1, &sheet);
    const BenchList limits = bench_list(&options->curvature, 1, &limit);
    Burn burn = {.options = options, .creases = options->creases};
    SingeResult result = SINGE_OK;
    for (int c = 0; c < cells.count; c++)
        for (int t = 0; t < thickness.count; t++)
            for (int l = 0; l < limits.count && !result; l++) {
                burn.cells = (int)cells.values[c];
                burn.thickness = thickness.values[t];
                burn.limit = limits.values[l];

                result = SINGE_OK;
                for (int disc = 0; disc < 2 && !result; disc++) {
                    burn.disc = disc;
                    if (burn.options->outline != (disc ? BENCH_SQUARE : BENCH_DISC)) {
                        // the same burn over the seeds
                        static const double four[] = {1, 2, 3, 4};
                        const BenchList seeds = bench_list(&burn.options->seeds, burn.options->quick ? 2 : 4, four);
                        Effects sum = {0};
                        result = SINGE_OK;
                        for (int i = 0; i < seeds.count && !result; i++) {
                            burn.seed = (uint32_t)seeds.values[i];
                            result = isotropy_compare(&burn, table, &sum, error);
                        }
                    }
                }
            }
    return result;
}
