// The smooth surface that cells are drawn on: what two cells make of the side that they share.
#include "drawing.h"
#include "common/random.h"
#include "shell/sample_shells.h"

/// A mesh that is bent by long waves, uneven by as much as grids are, and drawn.
typedef struct Bent {
    Memory memory;
    Shell shell;
    State state;
    AblatePlan *plan;
    SingeSurface surface;
    Fine fine;
} Bent;

static const float pi = 3.14159265f;

static void bend(Bent *b, float size) {
    for (uint32_t v = 0; v < b->shell.vertex_count; v++) {
        float *p = b->state.dynamics.position[v];
        for (int k = 0; k < 2; k++) p[k] += 0.1f * size * (random_unit(random_hash(v, (uint32_t)k, 0, 5)) - 0.5f);
        p[2] += 0.9f * size * sinf(2 * pi * (p[0] + 0.7f * p[1]) / (7 * size));
    }
}

/// The arrays of fine_position, as surface_draw_fine lays them out.
static void location(Bent *b) {
    Fine *fine = &b->fine;
    const size_t corners = b->shell.vertex_count, cells = b->shell.cell_count;

    *fine = (Fine){.shell = &b->shell, .state = &b->state, .memory = &b->memory, .bulge_max = INFINITY};
    assert_non_null(NEW(&b->memory, fine->sheets, b->shell.sheet_count));
    assert_non_null(NEW(&b->memory, fine->normal, b->shell.particle_count));
    assert_non_null(NEW(&b->memory, fine->share, corners)), assert_non_null(NEW(&b->memory, fine->max, corners));
    assert_non_null(NEW(&b->memory, fine->corner, corners)), assert_non_null(NEW(&b->memory, fine->sound, cells));
    assert_non_null(NEW(&b->memory, fine->regular, corners));
    assert_non_null(NEW(&b->memory, fine->valence, corners)), assert_non_null(NEW(&b->memory, fine->inner, cells));
    assert_non_null(NEW(&b->memory, fine->rail, b->shell.springs[SINGE_BLUE].count));
    assert_non_null(NEW(&b->memory, fine->limit, corners)), assert_non_null(NEW(&b->memory, fine->shift, corners));
    assert_non_null(NEW(&b->memory, fine->bent, cells));

    fine->sheets[0].splits = 4;
    fine_position(fine);
}

static Bent *bent(QuadMesh mesh, float size) {
    Bent *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->memory = memory_make((SingeAllocator){0});
    b->shell = mesh_shell(&b->memory, &mesh);
    assert_int_equal(state_create(&b->memory, &b->shell, &b->state), SINGE_OK);
    assert_int_equal(ablate_plan_create(&b->memory, &b->shell, &b->plan), SINGE_OK);
    mesh_release(&mesh);
    bend(b, size);
    location(b);

    return b;
}

static void bent_free(Bent *b) {
    Fine *fine = &b->fine;
    const size_t corners = b->shell.vertex_count, cells = b->shell.cell_count;

    FREE(&b->memory, fine->sheets, b->shell.sheet_count), FREE(&b->memory, fine->normal, b->shell.particle_count);
    FREE(&b->memory, fine->share, corners), FREE(&b->memory, fine->max, corners);
    FREE(&b->memory, fine->corner, corners), FREE(&b->memory, fine->sound, cells);
    FREE(&b->memory, fine->valence, corners), FREE(&b->memory, fine->regular, corners);
    FREE(&b->memory, fine->inner, cells);
    FREE(&b->memory, fine->rail, b->shell.springs[SINGE_BLUE].count);
    FREE(&b->memory, fine->limit, corners), FREE(&b->memory, fine->shift, corners);
    FREE(&b->memory, fine->bent, cells);
    ablate_plan_free(&b->memory, b->plan);
    state_free(&b->memory, &b->state);
    shell_free(&b->memory, &b->shell);
    assert_int_equal(b->memory.held, 0);
    free(b);
}

static int side_with(const Shell *shell, uint32_t cell, uint32_t blue) {
    int side = 0;
    while (shell->cell_springs[cell].blue[side] != blue) side++;
    return side;
}

/// Position and normal at `along` of a side, from a cell that has it.
static void at_side(const Fine *fine, uint32_t cell, uint32_t blue, float along, float position[3], float normal[3]) {
    const Shell *shell = fine->shell;
    FinePatch patch = fine_patch(fine, cell);
    int side = side_with(shell, cell, blue);
    bool forwards = shell->springs[SINGE_BLUE].ends[blue][0] == shell->cells[cell][side];
    FineLocation location = {cell, (uint8_t)side, {forwards ? 1 - along : along, forwards ? along : 1 - along, 0}};
    fine_position_at(fine, &patch, &location, position, normal);
}

static Float3 flat_normal(const Fine *fine, uint32_t cell, int side) {
    const uint32_t *at = fine->shell->cells[cell];
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) sum = float3_mad(sum, float3_load(fine->corner[at[i]]), 0.25f);
    return float3_unit(float3_cross(float3_sub(float3_load(fine->corner[at[side]]), sum),
                                    float3_sub(float3_load(fine->corner[at[(side + 1) & 3]]), sum)));
}

static float between(Float3 a, Float3 b) {
    return atan2f(float3_length(float3_cross(a, b)), float3_dot(a, b)) * 180 / pi;
}

/// The largest differences across sides: of positions, and of normals in degrees, root mean square, drawn and of flat
/// cells.
typedef struct Steps {
    float location;
    double drawn, flat;
} Steps;

static Steps steps_of(const Bent *b) {
    Steps steps = {0};
    int count = 0;
    for (uint32_t c = 0; c < b->shell.cell_count; c++)
        for (int i = 0; i < 4; i++) {
            uint32_t other = shell_neighbour(&b->shell, c, i), blue = b->shell.cell_springs[c].blue[i];
            if (other == SHELL_NONE || other < c) continue;
            for (float along = 0.125f; along < 1; along += 0.125f, count++) {
                float p[2][3], n[2][3];
                at_side(&b->fine, c, blue, along, p[0], n[0]), at_side(&b->fine, other, blue, along, p[1], n[1]);
                steps.location = fmaxf(steps.location, float3_length(float3_sub(float3_load(p[0]), float3_load(p[1]))));
                steps.drawn += pow((double)between(float3_load(n[0]), float3_load(n[1])), 2);
                Float3 flat = flat_normal(&b->fine, other, side_with(&b->shell, other, blue));
                steps.flat += pow((double)between(flat_normal(&b->fine, c, i), flat), 2);
            }
        }

    steps.drawn = sqrt(steps.drawn / count), steps.flat = sqrt(steps.flat / count);
    return steps;
}

/// Positions agree to rounding where four cells meet everywhere, to thousandths of a cell about irregular vertices;
/// 3e-4 at a corner that stands in is what following each cell's own tangents there would give. Normals agree to tenths
/// of a degree (0.09 to 0.24); those of flat cells are 5 to 18 degrees apart.
TEST(cells_agree_on_their_sides) {
    const struct {
        const char *name;
        QuadMesh mesh;
        float size;
        double max;
    } meshes[] = {
        {"grid", mesh_grid(14, 11, 1, 1), 1, 0.5},
        {"three cells", mesh_polygon(3, 6), 1 / 6.0f, 0.5},
        {"five cells", mesh_polygon(5, 6), 1 / 6.0f, 0.5},
        {"ell", mesh_ell(6), 1, 0.5},
    };

    for (size_t k = 0; k < sizeof meshes / sizeof *meshes; k++) {
        Bent *b = bent(meshes[k].mesh, meshes[k].size);
        Steps steps = steps_of(b);
        print_message("%s: positions %.2g of a cell apart, normals %.3f degrees, flat %.2f\n", meshes[k].name,
                      (double)(steps.location / meshes[k].size), steps.drawn, steps.flat);
        assert_true(steps.location < 1e-4f * meshes[k].size);
        assert_true(steps.drawn < meshes[k].max && steps.flat > 3);
        bent_free(b);
    }
}

/// Bent cells that have not burnt are drawn in parts, the same for any number of threads and without cracks.
TEST(bent_cells_are_split_alike) {
    OwnSurface first = {0};
    for (int threads = 1; threads <= 4; threads++) {
        OwnDrawing *d = fine_drawing(25, 25, 0.004f, 4e-4f, 2e-3f);
        if (threads > 1) assert_int_equal(pool_create(&d->sheet->memory, (SingeTasks){0}, threads, &d->pool), SINGE_OK);
        burn_rings(d, 0.01f);

        for (uint32_t v = 0; v < d->sheet->shell.vertex_count; v++) {
            float *p = d->sheet->state.dynamics.position[v];
            p[2] += 0.004f * sinf(2 * pi * (p[0] + 0.6f * p[1]) / 0.03f);
        }
        draw_fine(d);

        const SingeSurface *s = &d->surface;
        assert_true(s->triangle_count > s->fine_triangle_count + 4 * 4 * 400);

        if (threads == 1) first = *s, d->surface = (SingeSurface){0};
        else {
            assert_int_equal(s->vertex_count, first.vertex_count);
            assert_int_equal(s->triangle_count, first.triangle_count);
            assert_memory_equal(s->triangles, first.triangles, s->triangle_count * sizeof *s->triangles);
            assert_memory_equal(s->position, first.position, s->vertex_count * sizeof *s->position);
            assert_memory_equal(s->normal, first.normal, s->vertex_count * sizeof *s->normal);
        }
    }
}
