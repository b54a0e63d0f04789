// A heat matrix that follows tears row by row is the one that is built again, to the bit.
#include "rig.h"

#include "heat/heat_plan.h"
#include "support/support.h"
#include "tear/tear_plan.h"

enum { COLUMNS = 14, ROWS = 11, VERTICES = (COLUMNS + 1) * (ROWS + 1), CELLS = COLUMNS * ROWS, SPARES = 60 };

typedef struct Torn {
    Memory memory;
    SheetSource source;
    Shell shell;
    State state;
    HeatPlan *by_rows, *anew;
    uint32_t random;
} Torn;

static uint32_t any(Torn *t, uint32_t count) {
    t->random = t->random * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(t->random >> 8) * count >> 24);
}

/// Leaning cells off the grid, so that some do not go by linear elements alone.
static void make(Torn *t) {
    TestMesh mesh = test_grid(COLUMNS, ROWS, 1, 1);
    float *positions = mesh.positions;
    for (uint32_t v = 0; v < VERTICES; v++) {
        float x = (float)(v % (COLUMNS + 1)), y = (float)(v / (COLUMNS + 1));
        positions[3 * v] = 1e-3f * (x + 0.8f * y + 1e-3f * (float)any(t, 300));
        positions[3 * v + 1] = 1e-3f * (y + 1e-3f * (float)any(t, 300));
    }

    SingeSheetDef def = test_sheet(&mesh);
    def.material.thickening = 2;

    HeatSettings settings = {.ambient_temperature = 293, .tolerance = 1e-7f, .pace = 1};
    t->memory = memory_make((SingeAllocator){0});
    assert_int_equal(sheet_source_create(&t->memory, &def, &t->source, NULL), SINGE_OK);
    test_mesh_free(&mesh);
    t->source.sheet.spare_count = SPARES;
    assert_int_equal(shell_create(&t->memory, &t->source, 1, &t->shell, NULL), SINGE_OK);
    assert_int_equal(state_create(&t->memory, &t->shell, &t->state), SINGE_OK);
    assert_int_equal(heat_plan_create(&t->memory, &t->shell, &settings, &t->by_rows, NULL), SINGE_OK);
    assert_int_equal(heat_plan_create(&t->memory, &t->shell, &settings, &t->anew, NULL), SINGE_OK);
}

static void end(Torn *t) {
    heat_plan_free(&t->memory, t->by_rows);
    heat_plan_free(&t->memory, t->anew);
    state_free(&t->memory, &t->state);
    shell_free(&t->memory, &t->shell);
    sheet_source_free(&t->memory, &t->source);
    assert_int_equal(t->memory.held, 0);
}

/// Splits a vertex in some way, if there is one.
static void tear_somewhere(Torn *t) {
    Fan fan;
    SplitResult result;
    ShellSplit split = {.vertex = any(t, VERTICES)};
    split_fan(&t->shell, split.vertex, &fan);
    split.cells = any(t, 1u << fan.count);
    if (split_is_possible(&t->shell, &fan, &split)) tear_split(&t->shell, &t->state, &fan, &split, &result);
}

static void burn_somewhere(Torn *t) {
    int colour = (int)any(t, SINGE_COLOUR_COUNT);
    t->state.ablate.spring_flags[colour][any(t, t->shell.springs[colour].count)] &= (uint8_t)~SINGE_ALIVE;
    if (any(t, 4) == 0) t->state.ablate.particle_flags[any(t, t->shell.particle_count)] &= (uint8_t)~SINGE_ALIVE;
}

static void check_alike(const HeatPlan *a, const HeatPlan *b) {
    const HeatMatrix *m = &a->matrix, *n = &b->matrix;
    assert_memory_equal(a->measure, b->measure, a->particles * sizeof *a->measure);
    assert_memory_equal(a->alive, b->alive, a->particles);
    assert_memory_equal(m->column, n->column, m->entries * sizeof *m->column);
    assert_memory_equal(m->inverse, n->inverse, a->particles * sizeof *m->inverse);
    for (uint32_t e = 0; e < m->entries; e++) assert_true(m->value[e] == n->value[e] && m->value[e] >= 0);
    assert_memory_equal(a->rest.near_count, b->rest.near_count, a->rest.groups);
    for (uint32_t g = 0; g < a->rest.groups; g++)
        assert_memory_equal(a->rest.near[g], b->rest.near[g], a->rest.near_count[g] * sizeof a->rest.near[g][0]);
}

TEST(rows_are_as_if_built_anew) {
    uint32_t by_rows = 0;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        Torn t = {.random = seed};
        uint32_t mixed = 0;

        make(&t);
        for (uint32_t c = 0; c < CELLS; c++) mixed += heat_operator_may_change(&t.shell, c);
        assert_true(mixed > 10);

        heat_matrix_follow(t.by_rows, &t.shell, &t.state.ablate, 1e-3f);
        heat_matrix_follow(t.anew, &t.shell, &t.state.ablate, 1e-3f);
        for (int step = 0; step < 60; step++) {
            bool tears = any(&t, 3) > 0;
            for (int k = 0; tears && k < 1; k++) tear_somewhere(&t);
            for (int k = 0; k < 5; k++) burn_somewhere(&t);

            uint32_t before = t.by_rows->split_count;
            t.anew->matrix.full = true; // which it cannot follow by rows
            heat_plan_follow(t.by_rows, &t.shell, STATE_INPUT(&t.state));
            heat_plan_follow(t.anew, &t.shell, STATE_INPUT(&t.state));
            by_rows += t.by_rows->split_count > before && t.by_rows->matrix.dt > 0;
            assert_true(t.anew->split_count == before || t.anew->matrix.dt == 0);
            heat_matrix_follow(t.by_rows, &t.shell, &t.state.ablate, 1e-3f);
            heat_matrix_follow(t.anew, &t.shell, &t.state.ablate, 1e-3f);
            check_alike(t.by_rows, t.anew);
        }

        end(&t);
    }

    // not by rows where one had no room
    assert_true(by_rows > 150);
}
