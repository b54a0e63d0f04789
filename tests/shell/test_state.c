// The start of a simulation, and that a State is one block.

#include "sample_shells.h"

/// A grid with one vertex that no cell uses, moving and with a temperature of its own.
static Shell start_shell(Memory *memory) {
    OwnQuadMesh mesh = mesh_grid(3, 2, 0.01f, 0.01f);
    mesh_add_vertex(&mesh, 9, 9, 9);
    SingeSheetDef def = mesh_sheet(&mesh);
    float warm[13] = {0};
    warm[4] = 1;

    SingeAttribute attribute = {"warm", warm};
    def.attribute_count = 1, def.attributes = &attribute;
    def.material.temperature =
        singe_param_field(300, 340, &(SingeField){.kind = SINGE_FIELD_ATTRIBUTE, .attribute = "warm"});
    def.velocity[0] = 1, def.velocity[2] = -2;

    SheetSource source;
    Shell shell;

    assert_int_equal(sheet_source_create(memory, &def, &source, NULL), SINGE_OK);
    assert_int_equal(shell_create(memory, &source, 1, &shell, NULL), SINGE_OK);
    sheet_source_free(memory, &source);
    return shell;
}

TEST(a_state_starts_at_rest) {
    Memory memory = memory_make((SingeAllocator){0});
    Shell shell = start_shell(&memory);
    State state;

    assert_int_equal(state_create(&memory, &shell, &state), SINGE_OK);
    assert_int_equal(shell.particle_count, 13 + 6);

    for (uint32_t p = 0; p < shell.particle_count; p++) {
        bool alive = p != 12;
        assert_int_equal(state.ablate.particle_flags[p], alive ? SINGE_ALIVE : 0);
        assert_int_equal(state.ablate.piece[p], alive ? 0 : -1);
        assert_true(state.burn.mass[p] == 1 && state.burn.burn_rate[p] == 0);
        assert_true(state.burn.time_ignited[p] == -1 && state.burn.time_burnt[p] == -1);

        for (int k = 0; k < 4; k++) {
            static const float velocity[4] = {1, 0, -2, 0};
            assert_true(state.dynamics.position[p][k] == (k < 3 ? shell.rest_position[p][k] : 0));
            assert_true(state.dynamics.velocity[p][k] == (alive ? velocity[k] : 0));
        }

        assert_int_equal(state.dynamics.pinned[p], 0);

        // the four cells around vertex 5 are 1, 2, 4, 5; vertex 4 touches cells 0 and 3
        bool touches = p == 13 || p == 16;
        float expected = p == 4 ? 340 : touches ? 310 : 300;
        assert_true(state.heat.temperature[p] == expected && state.heat.temperature_peak[p] == expected);
    }

    assert_true(shell.matter.area[12] == 0 && shell.matter.mass[12] == 0);
    assert_int_equal(state.ablate.degree[0], 2 + 1 + 1);
    assert_int_equal(state.ablate.degree[5], 4 + 4 + 4);
    assert_int_equal(state.ablate.degree[12], 0);
    assert_int_equal(state.ablate.degree[13], 4 + 2);

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        for (uint32_t s = 0; s < shell.springs[colour].count; s++) {
            assert_int_equal(state.ablate.spring_flags[colour][s], SINGE_ALIVE);
            assert_true(state.burn.spring_length[colour][s] == shell.springs[colour].rest[s]);
        }
    }

    for (uint32_t c = 0; c < shell.cell_count; c++) assert_int_equal(state.ablate.cell_flags[c], SINGE_ALIVE);
    state_free(&memory, &state);
    shell_free(&memory, &shell);
    assert_int_equal(memory.held, 0);
}

static void check_slice(const State *state, const void *slice, size_t size) {
    size_t offset = (size_t)((const char *)slice - (const char *)state->arena);
    assert_int_equal((uintptr_t)slice % 64, 0);
    assert_true(offset + size <= state->arena_size);
}

/// Where m_min is the last float below 1, its mean over a triangle may be rounded to 1.
TEST(burn_progress_is_always_a_number) {
    assert_float_equal(shell_burn_progress(0.575f, 0.15f), 0.5, 1e-6);
    assert_float_equal(shell_burn_progress(1, 1), 0, 0);
    assert_float_equal(shell_burn_progress(nextafterf(1, 0), 1), 1, 0);
    assert_float_equal(shell_burn_progress(1.01f, 0.15f), 0, 0);
    assert_float_equal(shell_burn_progress(0.1f, 0.15f), 1, 0);
}

TEST(the_arena_holds_the_whole_state) {
    Memory memory = memory_make((SingeAllocator){0});
    Shell shell = start_shell(&memory);
    State a;

    assert_int_equal(state_create(&memory, &shell, &a), SINGE_OK);
    size_t particles = shell.particle_count;
    check_slice(&a, a.dynamics.position, particles * 16);
    check_slice(&a, a.dynamics.velocity, particles * 16);
    check_slice(&a, a.heat.temperature, particles * 4);
    check_slice(&a, a.burn.mass, particles * 4);
    check_slice(&a, a.ablate.degree, particles * 2);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        check_slice(&a, a.burn.spring_length[colour], shell.springs[colour].count * sizeof(float));
        check_slice(&a, a.ablate.spring_flags[colour], shell.springs[colour].count);
    }

    state_free(&memory, &a);
    state_free(&memory, &a); // nothing is left to free
    shell_free(&memory, &shell);
    assert_int_equal(memory.held, 0);
}

// No two arrays of a State overlap: bytes set through one pointer are not seen through another.
TEST(arrays_do_not_overlap) {
    Memory memory = memory_make((SingeAllocator){0});
    Shell shell = start_shell(&memory);
    State s;

    assert_int_equal(state_create(&memory, &shell, &s), SINGE_OK);
    size_t n = shell.particle_count;
    struct {
        void *at;
        size_t size;
    } slices[15 + 2 * SINGE_COLOUR_COUNT] = {
        {s.dynamics.position, 16 * n},
        {s.dynamics.velocity, 16 * n},
        {s.dynamics.pinned, n},
        {s.heat.temperature, 4 * n},
        {s.heat.temperature_peak, 4 * n},
        {s.burn.fuel, 4 * n},
        {s.burn.release, 4 * n},
        {s.burn.mass, 4 * n},
        {s.burn.burn_rate, 4 * n},
        {s.burn.time_ignited, 4 * n},
        {s.burn.time_burnt, 4 * n},
        {s.ablate.particle_flags, n},
        {s.ablate.cell_flags, shell.cell_count},
        {s.ablate.degree, 2 * n},
        {s.ablate.piece, 4 * n},
    };

    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        slices[15 + c].at = s.burn.spring_length[c], slices[15 + c].size = 4 * (size_t)shell.springs[c].count;
        slices[19 + c].at = s.ablate.spring_flags[c], slices[19 + c].size = shell.springs[c].count;
    }

    for (size_t i = 0; i < sizeof slices / sizeof slices[0]; i++) memset(slices[i].at, (int)i + 1, slices[i].size);
    for (size_t i = 0; i < sizeof slices / sizeof slices[0]; i++) {
        const unsigned char *bytes = slices[i].at;
        for (size_t k = 0; k < slices[i].size; k++) assert_int_equal(bytes[k], i + 1);
    }

    state_free(&memory, &s);
    shell_free(&memory, &shell);
}
