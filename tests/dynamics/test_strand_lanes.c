// All kernels give the same bytes on meshes of every kind, and the layout that they share is dense.
#include "sample_sheets.h"

#include "common/random.h"
#include "dynamics/dynamics_plan.h"

/// A grid without the cells of a rectangle inside it.
static Quads quads_with_hole(uint32_t nx, uint32_t ny) {
    Quads quads = quads_grid(nx, ny, 0.01f, 0.011f, false);
    uint32_t kept = 0;
    for (uint32_t c = 0; c < quads.cell_count; c++) {
        uint32_t i = c % nx, j = c / nx;
        if (i >= nx / 3 && i < nx / 2 && j >= ny / 4 && j < ny / 2) continue;
        memmove(quads.cells + 4 * kept++, quads.cells + 4 * c, 4 * sizeof *quads.cells);
    }

    quads.cell_count = kept;
    return quads;
}

/// Vertices in an order without meaning.
static Quads quads_shuffled(Quads quads) {
    uint32_t n = quads.vertex_count, *to = malloc(n * sizeof *to);
    float *positions = malloc(3 * n * sizeof *positions);
    for (uint32_t i = 0; i < n; i++) to[i] = i;
    for (uint32_t i = n; i-- > 1;) {
        uint32_t j = (uint32_t)(random_hash(i, 3, 5, 7) % (i + 1)), t = to[i];
        to[i] = to[j], to[j] = t;
    }
    for (uint32_t i = 0; i < n; i++) memcpy(positions + 3 * to[i], quads.positions + 3 * i, 3 * sizeof *positions);
    for (uint32_t k = 0; k < 4 * quads.cell_count; k++) quads.cells[k] = to[quads.cells[k]];
    free(quads.positions), free(to);
    quads.positions = positions;
    return quads;
}

static void add_cell(Quads *quads, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    uint32_t *cell = quads->cells + 4 * quads->cell_count++;
    cell[0] = a, cell[1] = b, cell[2] = c, cell[3] = d;
}

/// Cells halved at random and every triangle cut into three quads: vertices of 2 to 8 cells. Vertices of half the
/// spacing, those of the triangles' sides and corners, then the triangles' centres.
static Quads quads_random_valence(uint32_t n) {
    uint32_t side = 2 * n + 1, corners = side * side;
    Quads quads = {.vertex_count = corners + 2 * n * n};
    quads.positions = calloc(3 * quads.vertex_count, sizeof(float));
    quads.cells = malloc(24 * n * n * sizeof(uint32_t));
    for (uint32_t v = 0; v < corners; v++)
        quads.positions[3 * v] = 0.01f * (float)(v % side), quads.positions[3 * v + 1] = 0.01f * (float)(v / side);
    for (uint32_t c = 0; c < n * n; c++) {
        uint32_t at = 2 * (c / n) * side + 2 * (c % n), right = 2, up = 2 * side;
        uint32_t corner[4] = {at, at + right, at + right + up, at + up}, turn = random_hash(c, 1, 2, 3) & 1;
        for (uint32_t half = 0; half < 2; half++) {
            uint32_t centre = corners + 2 * c + half, t[3];
            for (uint32_t k = 0; k < 3; k++) t[k] = corner[(turn + 2 * half + k) & 3];
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t a = t[k], b = t[(k + 1) % 3], before = t[(k + 2) % 3];
                add_cell(&quads, a, (a + b) / 2, centre, (a + before) / 2);
                for (uint32_t i = 0; i < 2; i++) quads.positions[3 * centre + i] += quads.positions[3 * a + i] / 3;
            }
        }
    }

    return quads;
}

/// Positions off their rest, some crushed to a point or nearly, some pinned; some springs gone.
static void disturb(Bench *bench) {
    for (uint32_t i = 0; i < bench->shell.particle_count; i++) {
        float *x = bench->state.dynamics.position[i];
        for (uint32_t k = 0; k < 3; k++) x[k] += 0.008f * (random_unit(random_hash(i, k, 7, 1)) - 0.5f);
        if (i % 37 == 36) memcpy(x, bench->state.dynamics.position[i - 1], 3 * sizeof *x);
        bench->state.burn.mass[i] = i % 64 < 40 ? 1 : 0.3f + 0.7f * random_unit(random_hash(i, 9, 9, 2));
        bench->state.dynamics.pinned[i] = i % 11 == 3;
    }

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        for (uint32_t k = 0; k < bench->shell.springs[colour].count; k++)
            if (random_hash(k, (uint32_t)colour, 4, 4) % 16 == 0) bench->state.ablate.spring_flags[colour][k] = 0;
    bench_prepare(bench);
}

static void project(Bench *bench, SingeInstructions instructions, Pool *pool, const float *start, float *result) {
    size_t bytes = (bench->shell.particle_count + 1) * 4 * sizeof *result;
    DynamicsCounters counters = {0};
    float *position = bench->state.dynamics.position[0];

    memcpy(position, start, bytes);
    bench->plan->kernels = kernels_choose(instructions);
    bench->plan->strands.solve = bench->plan->kernels->solve;
    for (int i = 0; i < 3 * SINGE_COLOUR_COUNT; i++) {
        SingeColour colour = (SingeColour)(i % SINGE_COLOUR_COUNT);
        strand_project(bench->plan, colour, pool, 1e-3f, &bench->state.dynamics, &counters);
        curvature_project(bench->plan, pool, &bench->state.dynamics);
    }

    memcpy(result, position, bytes);
}

/// Compliances of every spring from the lanes' array, where they differ if `vary`.
static void read_compliances(Bench *bench, bool vary) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        StrandSet *set = &bench->plan->strands.sets[colour];
        for (uint32_t i = 0; vary && i < set->row_count * STRAND_LANES; i++)
            set->compliance[i] *= random_unit(random_hash(i, 0, 6, 6));
        set->compliance_all = -1;
    }
}

/// Every kernel against the plain one. What compliances do is the same however they are read.
static void compare_kernels(Quads quads, bool vary) {
    SingeMaterialDef material = singe_default_material();
    material.curvature_max = singe_param(vary ? 100 : 0);
    OwnBench bench = bench_open(quads, &material, 2);
    disturb(&bench);
    if (vary) read_compliances(&bench, true);
    size_t bytes = (bench.shell.particle_count + 1) * 4 * sizeof(float);
    float *start = malloc(bytes), *plain = malloc(bytes), *other = malloc(bytes);
    memcpy(start, bench.state.dynamics.position, bytes);
    project(&bench, SINGE_INSTRUCTIONS_PLAIN, NULL, start, plain);
    assert_memory_not_equal(start, plain, bytes);
    for (uint32_t i = 0; i < 4 * bench.shell.particle_count; i++) assert_true(isfinite(plain[i]));
    for (int i = SINGE_INSTRUCTIONS_X86_V2; i <= SINGE_INSTRUCTIONS_X86_V4; i++) {
        if (!kernels_choose((SingeInstructions)i)) continue;
        project(&bench, (SingeInstructions)i, bench.pool, start, other);
        assert_memory_equal(plain, other, bytes);
    }

    read_compliances(&bench, false);
    project(&bench, SINGE_INSTRUCTIONS_BEST, NULL, start, other);
    assert_memory_equal(plain, other, bytes);
    free(start), free(plain), free(other);
}

TEST(kernels_agree) {
    for (int vary = 0; vary < 2; vary++) {
        compare_kernels(quads_grid(37, 23, 0.01f, 0.01f, false), vary);
        compare_kernels(quads_grid(3, 2, 0.01f, 0.01f, false), vary);
        compare_kernels(quads_with_hole(41, 38), vary);
        compare_kernels(quads_grid(40, 19, 0.01f, 0.01f, true), vary);
        compare_kernels(quads_shuffled(quads_grid(21, 20, 0.01f, 0.01f, false)), vary);
        compare_kernels(quads_random_valence(9), vary);
    }
}

typedef struct Density {
    uint64_t springs, slots, rows, beside;
} Density;

/// Checks that every strand lies whole in a lane of its group and that nothing lies on something else.
static void check_lanes(const SpringSet *springs, const StrandSet *set, Density *density) {
    uint8_t *taken = calloc((size_t)set->row_count * STRAND_LANES, 1);
    for (uint32_t s = 0; s < set->strand_count; s++) {
        uint32_t slot = set->strand_slot[s];
        for (uint32_t k = springs->strand_first[s]; k <= springs->strand_first[s + 1]; k++, slot += STRAND_LANES) {
            uint32_t last = k == springs->strand_first[s + 1];
            assert_true(slot < set->row_count * STRAND_LANES && !taken[slot]++);
            assert_int_equal(set->node[slot], 4 * springs->ends[k - last][last]);
        }
    }

    free(taken);
    density->springs += springs->count;
    for (uint32_t g = 0; g < set->group_count; g++) {
        const StrandGroup *group = &set->groups[g];
        assert_true(group->columns > 0 && group->columns <= group->width && group->rows <= set->longest);
        density->slots += (uint64_t)group->rows * group->width, density->rows += group->rows + 1;
        for (uint32_t row = group->row; row <= group->row + group->rows; row++) {
            const uint32_t *node = set->node + row * STRAND_LANES;
            if (set->contiguous[row] == STRAND_GATHERED) continue;
            density->beside++;
            for (uint32_t c = 0; c < group->width; c++)
                assert_int_equal(node[strand_lane(group->width, c)], set->contiguous[row] + 4 * c);
        }
    }
}

static Density measure_lanes(const char *name, Quads quads) {
    Density density = {0};
    OwnBench bench = bench_open(quads, NULL, 1);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        check_lanes(&bench.shell.springs[colour], &bench.plan->strands.sets[colour], &density);
    print_message("%s: %.1f %% of the slots empty, %.0f %% of the rows beside each other\n", name,
                  100 - 100 * (double)density.springs / (double)density.slots,
                  100 * (double)density.beside / (double)density.rows);
    return density;
}

TEST(lanes_are_full) {
    Density grid = measure_lanes("grid", quads_grid(100, 60, 0.01f, 0.01f, false));
    assert_true((double)grid.springs > 0.93 * (double)grid.slots);
    assert_true((double)grid.beside > 0.6 * (double)grid.rows);
    Density hole = measure_lanes("hole", quads_with_hole(90, 80));
    assert_true((double)hole.springs > 0.8 * (double)hole.slots);
    assert_true((double)hole.beside > 0.4 * (double)hole.rows);
    Density cylinder = measure_lanes("cylinder", quads_grid(100, 40, 0.01f, 0.01f, true));
    assert_true((double)cylinder.springs > 0.9 * (double)cylinder.slots);
    assert_true((double)cylinder.beside > 0.6 * (double)cylinder.rows);
    Density shuffled = measure_lanes("shuffled", quads_shuffled(quads_grid(80, 80, 0.01f, 0.01f, false)));
    assert_true((double)shuffled.springs > 0.9 * (double)shuffled.slots);
    Density valence = measure_lanes("random valence", quads_random_valence(30));
    assert_true((double)valence.springs > 0.6 * (double)valence.slots);
}

/// Velocities of a disturbed sheet after internal friction. `apart`: strand by strand, not in lanes.
static void rub(Bench *bench, SingeInstructions instructions, bool apart, float *result) {
    static const SingeColour layers[] = {SINGE_BLUE, SINGE_GREEN};
    float(*velocity)[4] = bench->state.dynamics.velocity;
    bool kept[2][256];
    bench->plan->kernels = kernels_choose(instructions);
    for (uint32_t i = 0; i < 4 * bench->shell.particle_count; i++)
        velocity[i / 4][i % 4] = i % 4 < 3 ? random_unit(random_hash(i, 1, 5, 2)) - 0.5f : 0;
    for (int i = 0; i < 2; i++) {
        StrandSet *set = &bench->plan->strands.sets[layers[i]];
        assert_true(set->group_count <= 256);
        for (uint32_t g = 0; g < set->group_count; g++) {
            kept[i][g] = set->groups[g].apart;
            set->groups[g].apart |= apart;
        }
    }

    dynamics_smooth(bench->plan, &bench->shell, &bench->state.ablate, bench->pool, 1 / 480.0f, &bench->state.dynamics);
    memcpy(result, velocity, bench->shell.particle_count * sizeof *velocity);
    for (int i = 0; i < 2; i++)
        for (uint32_t g = 0; g < bench->plan->strands.sets[layers[i]].group_count; g++)
            bench->plan->strands.sets[layers[i]].groups[g].apart = kept[i][g];
}

/// Internal friction in lanes of every width, against that of single strands. Returns the number of groups in lanes.
static uint32_t compare_friction(Quads quads) {
    uint32_t groups = 0;
    OwnBench bench = bench_open(quads, NULL, 2);
    disturb(&bench);
    const size_t bytes = bench.shell.particle_count * 4 * sizeof(float);
    float *single = malloc(bytes), *lanes = malloc(bytes);
    rub(&bench, SINGE_INSTRUCTIONS_PLAIN, true, single);
    for (int i = SINGE_INSTRUCTIONS_PLAIN; i <= SINGE_INSTRUCTIONS_X86_V4; i++) {
        if (!kernels_choose((SingeInstructions)i)) continue;
        rub(&bench, (SingeInstructions)i, false, lanes);
        assert_memory_equal(single, lanes, bytes);
    }

    const StrandSet *blue = &bench.plan->strands.sets[SINGE_BLUE];
    for (uint32_t g = 0; g < blue->group_count; g++) groups += !blue->groups[g].apart;
    free(single), free(lanes);
    return groups;
}

TEST(friction_is_the_same_in_lanes) {
    assert_true(compare_friction(quads_grid(47, 31, 0.01f, 0.01f, false)) > 3);
    assert_true(compare_friction(quads_grid(60, 50, 0.003f, 0.003f, false)) > 3); // smoothing_length is seven springs
    compare_friction(quads_with_hole(41, 38));
    compare_friction(quads_grid(40, 19, 0.01f, 0.01f, true));
    compare_friction(quads_shuffled(quads_grid(21, 20, 0.01f, 0.01f, false)));
    compare_friction(quads_random_valence(9));
}
