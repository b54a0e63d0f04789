// Save, load and clone: a resumed run has the bytes of an uninterrupted one, and damage is noticed.
#include "scenes.h"

#include "collision/collision_plan.h"
#include "dynamics/dynamics_plan.h"
#include "gas/gas_plan.h"
#include "sim/snapshot_def.h"

static float flux_strength = 2000;

TEST(resumed_runs_are_the_same) {
    static const int saves[] = {0, 1, 17, 45, 80};
    for (size_t k = 0; k < sizeof saves / sizeof *saves; k++) {
        OwnTestScene scene = scene_make(NULL, 14);
        test_steps(scene.sim, saves[k]);

        OwnSim *resumed = test_reload(NULL, scene.sim);
        test_assert_same(scene.sim, resumed);
        test_ok(resumed, singe_sim_set_source_callback(resumed, scene.callback, scene_flux, &flux_strength));

        for (int i = 0; i < 40; i++) {
            test_ok(scene.sim, singe_sim_step(scene.sim));
            test_ok(resumed, singe_sim_step(resumed));
            size_t events, resumed_events;
            singe_sim_events(scene.sim, &events);
            singe_sim_events(resumed, &resumed_events);
            assert_int_equal(events, resumed_events);
        }

        test_assert_same(scene.sim, resumed);
        if (saves[k] == 80) assert_true(singe_sim_stats(resumed).burnt_fraction > 0.2);
    }
}

/// The bytes depend on the simulation alone, not on padding or addresses.
TEST(bytes_are_the_same) {
    TestScene a = scene_make(NULL, 9);
    TestAllocator hook = {0}; // fills fresh blocks with rubbish
    SingeSimDef def;

    memset(&def, 0x5A, sizeof def);
    SingeSimDef standard = scene_def();
    memcpy(&def, &standard, sizeof def);
    def.allocator = test_allocator(&hook);
    TestScene b = scene_make(&def, 9);

    test_steps_alike(a.sim, b.sim, 12);

    TestBytes first = test_save(a.sim);
    test_assert_saved(a.sim, &first);
    SingeSim *loaded = test_load(NULL, &first);
    test_assert_saved(loaded, &first);
    free(first.data);
    singe_sim_destroy(loaded);
    singe_sim_destroy(a.sim);
    singe_sim_destroy(b.sim);
    assert_int_equal(hook.blocks, 0);
}

TEST(handles_keep_their_values) {
    OwnTestScene scene = scene_make(NULL, 8);
    test_ok(scene.sim, singe_sim_remove_source(scene.sim, scene.ball));
    test_ok(scene.sim, singe_sim_remove_collider(scene.sim, scene.sphere));
    test_ok(scene.sim, singe_sim_remove_pin(scene.sim, scene.points));

    SingeSourceId fresh = test_spot(scene.sim, 0, 0, 0, 0.01f, 900, 100);
    TestBytes bytes = test_save(scene.sim);
    TestAllocator hook = {0};
    SingeSimDef hooks = singe_default_sim();
    hooks.allocator = test_allocator(&hook);

    SingeSim *sim;
    test_ok(NULL, singe_sim_load(&hooks, bytes.data, bytes.size, &sim, NULL));

    SingePoseKey key = test_key(0, 0, 0, 0);
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_source(sim, scene.ball));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_collider(sim, scene.sphere));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_pin(sim, scene.points));
    test_ok(sim, singe_sim_move_source(sim, fresh, 1, &key));
    test_ok(sim, singe_sim_move_collider(sim, scene.box, 1, &key));
    test_ok(sim, singe_sim_remove_pin(sim, scene.vertices));

    // what is added next gets the same handle in both
    SingeSourceId next[2] = {test_spot(sim, 0, 0, 0, 0.01f, 900, 100), test_spot(scene.sim, 0, 0, 0, 0.01f, 900, 100)};
    assert_memory_equal(&next[0], &next[1], sizeof next[0]);
    SingeSheetId sheet = scene.sheets[1];
    SingePinDef pin = singe_default_pin();
    const uint32_t vertex = 1;

    pin.sheet = sheet, pin.vertex_count = 1, pin.vertices = &vertex;
    const SingePinId id = test_add_pin(sim, &pin); // into a free slot, which held nothing
    assert_int_equal(id.index, scene.points.index);
    free(bytes.data);
    singe_sim_destroy(sim);
    assert_int_equal(hook.blocks, 0);
}

TEST(clones_are_independent) {
    OwnTestScene scene = scene_make(NULL, 10);
    test_steps(scene.sim, 20);
    SingeSim *copy;
    test_ok(scene.sim, singe_sim_clone(scene.sim, &copy));
    test_assert_same(scene.sim, copy);

    OwnTestBytes before = test_save(scene.sim);
    test_steps(copy, 30); // with its callback source: no need to set it again
    test_assert_saved(scene.sim, &before);
    test_steps(scene.sim, 30);
    test_assert_same(scene.sim, copy);
    test_ok(copy, singe_sim_remove_pin(copy, scene.points));

    test_steps(copy, 10);
    test_steps(scene.sim, 10);
    test_steps(copy, 2);
    singe_sim_destroy(copy);
}

/// Damaged bytes are refused, and nothing leaks.
static void refuse(uint8_t *bytes, size_t size, const char *what) {
    TestAllocator hook = {0};
    SingeSimDef hooks = singe_default_sim();
    hooks.allocator = test_allocator(&hook);

    SingeSim *sim = (SingeSim *)1;
    SingeError error = {0};
    SingeResult result = singe_sim_load(&hooks, bytes, size, &sim, &error);
    if (result != SINGE_ERROR_FORMAT && result != SINGE_ERROR_VERSION)
        fail_msg("%s: %s", what, singe_result_name(result));

    assert_null(sim);
    assert_int_equal(error.code, result);
    assert_string_equal(error.stage, "load");
    assert_true(error.message[0]);
    assert_int_equal(hook.blocks, 0);
}

static TestBytes small_snapshot(void) {
    OwnTestScene scene = scene_make(NULL, 4);
    test_steps(scene.sim, 6);
    TestBytes bytes = test_save(scene.sim);
    return bytes;
}

/// At the ends of what is legal a step may fail, but what it leaves can be saved and loaded.
TEST(the_state_after_any_step_loads) {
    static const float temperatures[] = {1, 293.15f, 1e4f, 1e15f}, masses[] = {1e-6f, 0.08f, 1e6f};
    static const float heats[] = {1e-3f, 1400, 1e9f}, exchanges[] = {0, 14, 1e30f}, fluxes[] = {-1e15f, 30e3f, 1e15f};
    uint32_t refused = 0, loaded = 0;
    for (int k = 0; k < 4 * 3 * 3 * 3 * 3; k++) {
        SingeSimDef def = singe_default_sim();
        OwnSim *sim = test_create(&def);

        OwnTestMesh mesh = test_grid(3, 3, 0.01f, 0.01f);
        SingeSheetDef sheet = test_sheet(&mesh);
        sheet.material.temperature = singe_param(temperatures[k % 4]);
        sheet.material.grammage = singe_param(masses[k / 4 % 3]);
        sheet.material.specific_heat = singe_param(heats[k / 12 % 3]);
        sheet.material.convection = singe_param(exchanges[k / 36 % 3]);

        float white = 1;
        SingeSourceDef source = singe_default_source();
        source.kind = SINGE_SOURCE_TEXTURE;
        source.texture = (SingeTexture){1, 1, &white};
        source.flux = fluxes[k / 108];

        SingeSourceId id;
        SingeResult result = singe_sim_add_sheet(sim, &sheet, NULL);
        if (!result) result = singe_sim_commit(sim);
        if (!result) result = singe_sim_add_source(sim, &source, &id);
        refused += result != SINGE_OK;
        assert_true(result || temperatures[k % 4] <= 1e4f);

        for (int i = 0; !result && i < 3; i++) {
            (void)(singe_sim_step(sim) == SINGE_OK);
            OwnSim *copy = test_reload(NULL, sim);
            assert_true(isfinite(singe_sim_stats(copy).heat_lost) && isfinite(singe_sim_stats(copy).ledger_error));
            loaded++;
        }
    }
    assert_true(refused >= 81 && loaded > 100); // 1e15 K is no start
}

TEST(truncated_snapshots_are_refused) {
    OwnTestBytes bytes = small_snapshot();
    for (size_t k = 0; k < 300; k++) {
        size_t size = k < 100 ? k : (k - 100) * bytes.size / 200;
        uint8_t *cut = malloc(size ? size : 1);
        assert_non_null(cut);
        memcpy(cut, bytes.data, size);
        refuse(cut, size, "truncated");
        free(cut);
    }

    uint8_t *longer = calloc(bytes.size + 1, 1);
    assert_non_null(longer);
    memcpy(longer, bytes.data, bytes.size);
    refuse(longer, bytes.size + 1, "a byte too many");
    free(longer);
}

TEST(flipped_bits_are_noticed) {
    OwnTestBytes bytes = small_snapshot();
    for (size_t k = 0; k < 1200; k++) {
        size_t bit = k < 512 ? k : (k - 512) * (bytes.size * 8 / 688) + k % 8; // every bit of the header's 64 bytes
        if (bit / 8 >= bytes.size) continue;
        bytes.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
        refuse(bytes.data, bytes.size, "flipped");
        bytes.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }

    OwnSim *sim = test_load(NULL, &bytes);
}

/// Puts a number at an offset of the body, and the checksum right.
static void forge(TestBytes *bytes, size_t at, uint32_t word) {
    enum { HEADER = 56, CHECKSUM_AT = 24 };
    memcpy(bytes->data + HEADER + at, &word, sizeof word);
    uint64_t sum = stream_checksum(bytes->data + HEADER, bytes->size - HEADER);
    memcpy(bytes->data + CHECKSUM_AT, &sum, sizeof sum);
}

/// Forged bodies with correct checksums: loading them neither crashes nor leaks, and a simulation that loads can step.
TEST(forged_snapshots_are_refused) {
    enum { HEADER = 56 };
    static const uint32_t words[] = {0x7FC00000, 0x7F800000, 0xFF800000, 0xBF800000, 0x7F7FFFFF, 0xFFFFFFFF, 0, 1};
    OwnTestBytes good = small_snapshot();
    uint32_t random = 1;
    int refused = 0;
    uint32_t same;
    memcpy(&same, good.data + HEADER, sizeof same);

    TestBytes untouched = {malloc(good.size), good.size};
    assert_non_null(untouched.data);
    memcpy(untouched.data, good.data, good.size);
    forge(&untouched, 0, same);
    assert_memory_equal(untouched.data, good.data, good.size); // the checksum is where it is put
    free(untouched.data);

    for (int k = 0; k < 600; k++) {
        OwnTestBytes bytes = {malloc(good.size), good.size};
        assert_non_null(bytes.data);
        memcpy(bytes.data, good.data, good.size);

        for (int change = 0; change < 2; change++) {
            random = random * 1664525u + 1013904223u;
            size_t body = good.size - HEADER - 3, at = (k < 300 ? (size_t)k * 8 : random >> 4) % body / 4 * 4;
            random = random * 1664525u + 1013904223u;
            forge(&bytes, at, k & 1 ? random : words[random >> 29]);
        }

        TestAllocator hook = {0};
        SingeSimDef hooks = singe_default_sim();
        hooks.allocator = test_allocator(&hook);

        SingeSim *sim;
        SingeError error = {0};
        SingeResult result = singe_sim_load(&hooks, bytes.data, bytes.size, &sim, &error);
        refused += result != SINGE_OK;

        for (int step = 0; !result && step < 2; step++)
            if (singe_sim_step(sim)) break;
        if (!result) singe_sim_destroy(sim);
        else assert_true(error.code == result && error.message[0]);
        assert_int_equal(hook.blocks, 0);
    }

    assert_in_range(refused, 150, 599);
}

/// Lets the first cell intersect a cell that does not exist.
static void one_crossing(Memory *memory, CollisionPlan *plan) {
    assert_true(initial_reserve(memory, plan, 1));
    plan->initial_other[0] = plan->cell_count;
    for (uint32_t c = 1; c <= plan->cell_count; c++) plan->initial_first[c] = 1;
}

#define POKE(name, ...) \
    static void poke_##name(SingeSim *sim) { __VA_ARGS__; }

// a vertex of the larger sheet and the centre of its first cell; a green spring; all there and not held
enum { VERTEX = 6, CENTRE_CELL = 4, GREEN = 2 };
#define CENTRE (sim->shell.vertex_count + CENTRE_CELL)

POKE(time_step, sim->def.time_step = NAN)
POKE(projections, sim->def.solver.projections = 0)
POKE(method, sim->def.solver.method = (SingeSolverMethod)77)
POKE(order, sim->def.solver.order[0] = sim->def.solver.order[1])
POKE(wind, sim->def.wind.velocity[1] = INFINITY)
POKE(gas_cell, sim->def.gas.cell_size = NAN)
POKE(contact, sim->def.contact.thickness = 0)
POKE(sheet_position, sim->sheets[0].position[3][1] = NAN)
POKE(sheet_cell, sim->sheets[0].cells[1][2] = sim->sheets[0].cells[1][0])
POKE(sheet_param, sim->sheets[0].value[PARAM_GRAMMAGE] = NAN)
POKE(sheet_varied, sim->sheets[0].values[PARAM_MASS_RATE][5] = -1)
POKE(sheet_operator, sim->sheets[0].sheet.material.heat_operator = (SingeHeatOperator)9)
POKE(sheet_velocity, sim->sheets[0].sheet.velocity[2] = NAN)
POKE(sheet_drop, sim->sheets[0].sheet.drop_pieces_below = -1)
POKE(sheet_sources, sim->sheets[0].sheet.source_count = 1u << 30)
POKE(source_heat, sim->sources.items[0].def.conductance = NAN)
POKE(source_kind, sim->sources.items[0].def.kind = (SingeSourceKind)99)
POKE(source_path, sim->sources.items[0].path.keys[1].time = sim->sources.items[0].path.keys[0].time)
POKE(source_position, sim->sources.items[0].path.keys[1].position[0] = NAN)
POKE(source_turn, sim->sources.items[0].path.keys[1].rotation[3] = 3)
POKE(source_texture, sim->sources.items[2].texture[3] = INFINITY)
POKE(source_generation, sim->sources.items[0].generation = sim->next_generation)
POKE(collider_radius, sim->colliders.items[1].def.radius = NAN)
POKE(collider_sides, sim->colliders.items[1].def.sides = (SingeContactSides)5)
POKE(collider_path, sim->colliders.items[1].path.keys[0].rotation[0] = INFINITY)
POKE(collider_mesh, sim->colliders.items[4].mesh.vertices[0][0] = NAN)
POKE(collider_height, sim->colliders.items[5].heights.heights[0] = NAN)
POKE(pin_anchor, sim->pins.items[0].anchors[0][0] = NAN)
POKE(pin_particle, sim->pins.items[0].particles[0] = sim->shell.particle_count)
POKE(pin_twice, sim->pins.items[0].particles[1] = sim->pins.items[0].particles[0])
POKE(pin_end, sim->pins.items[0].end = -1)
POKE(time, sim->state.time = (double)NAN)
POKE(time_of_step, sim->state.time *= 2)
POKE(heat_in, sim->state.heat.heat_in = (double)INFINITY)
POKE(heat_start, sim->heat_start = (double)NAN)
POKE(mass_removed, sim->state.ablate.mass_removed = -1)
POKE(temperature, sim->state.heat.temperature[VERTEX] = NAN)
POKE(temperature_below, sim->state.heat.temperature[VERTEX] = -1)
POKE(temperature_peak, sim->state.heat.temperature_peak[VERTEX] = INFINITY)
POKE(mass, sim->state.burn.mass[VERTEX] = 1.5f)
POKE(mass_nan, sim->state.burn.mass[CENTRE] = NAN)
POKE(burn_rate, sim->state.burn.burn_rate[VERTEX] = NAN)
POKE(time_ignited, sim->state.burn.time_ignited[VERTEX] = -2)
POKE(time_to_come, sim->state.burn.time_burnt[VERTEX] = 1e6f)
POKE(dead_length, sim->state.ablate.spring_flags[SINGE_GREEN][GREEN] = 0;
     for (int k = 0; k < 2; k++) sim->state.ablate.degree[sim->shell.springs[SINGE_GREEN].ends[GREEN][k]]--;
     sim->state.burn.spring_length[SINGE_GREEN][GREEN] = NAN)
POKE(position, sim->state.dynamics.position[VERTEX][2] = NAN)
POKE(velocity, sim->state.dynamics.velocity[CENTRE][0] = -INFINITY)
POKE(earlier, sim->state.dynamics.earlier[VERTEX][1] = NAN)
POKE(earlier_time, sim->state.dynamics.earlier_time = sim->state.time + 1)
POKE(inverse_mass, sim->state.dynamics.position[VERTEX][3] = -1)
POKE(bend, sim->state.dynamics.bend[GREEN] = NAN)
POKE(crease, sim->state.dynamics.crease[GREEN] = INFINITY)
POKE(pinned, sim->state.dynamics.pinned[VERTEX]++)
POKE(pinned_flag, sim->state.ablate.particle_flags[VERTEX] |= SINGE_PINNED)
POKE(flag, sim->state.ablate.particle_flags[VERTEX] |= 64)
POKE(cell_flag, sim->state.ablate.cell_flags[1] = 3)
POKE(spring_gone, sim->state.ablate.spring_flags[SINGE_GREEN][GREEN] = 0)
POKE(spring_spare, uint32_t last = sim->shell.springs[SINGE_BLUE].count - 1;
     sim->state.ablate.spring_flags[SINGE_BLUE][last] = SINGE_ALIVE;
     for (int k = 0; k < 2; k++) sim->state.ablate.degree[sim->shell.springs[SINGE_BLUE].ends[last][k]]++)
POKE(degree, sim->state.ablate.degree[VERTEX]++)
POKE(piece_none, sim->state.ablate.piece[VERTEX] = -1)
POKE(piece_far, sim->state.ablate.piece[VERTEX] = INT32_MAX)
POKE(piece_other, sim->state.ablate.piece[VERTEX] ^= 1)
POKE(pieces_to_come, sim->state.ablate.next_piece = sim->shell.particle_count)
POKE(piece_count, sim->state.ablate.piece_count++)
POKE(line_force, sim->state.tear.line_force[1][4] = NAN)
POKE(split_count, sim->state.tear.split_count = UINT32_MAX)
POKE(split, sim->state.tear.split_count = 1; sim->state.tear.splits[0] = (ShellSplit){UINT32_MAX, 1, 0})
POKE(attach_source, sim->dynamics->attachments.source[0][0] = sim->shell.vertex_count - 1)
POKE(attach_gap, sim->dynamics->attachments.source[0][0] = SHELL_NONE)
POKE(attach_length, sim->dynamics->attachments.length[VERTEX][0] = NAN)
POKE(attach_goal, sim->dynamics->attachments.goal[VERTEX][0] = -1)
POKE(collision_position, sim->dynamics->collision->position[VERTEX][0] = NAN)
POKE(collision_speed, sim->dynamics->collision->speed[VERTEX][0] = INFINITY)
POKE(collision_alive, sim->dynamics->collision->alive[1] = 0)
POKE(initial_crossing, sim->dynamics->collision->initial_first[1] = 9)
POKE(initial_cell, one_crossing(&sim->memory, sim->dynamics->collision))
POKE(gas_field, sim->gas->turn[sim->state.gas.turn].field[GAS_LIGHTNESS][99] = NAN)
POKE(gas_air, sim->gas->turn[sim->state.gas.turn].air[VERTEX][1] = INFINITY)

/// A simulation with numbers that no step produces can be saved but not loaded.
TEST(impossible_numbers_are_refused) {
// clang-format off
#define ROW(name) {#name, poke_##name}
    static const struct { const char *what; void (*poke)(SingeSim *sim); } rows[] = {
        ROW(time_step), ROW(projections), ROW(method), ROW(order), ROW(wind), ROW(gas_cell), ROW(contact),
        ROW(sheet_position), ROW(sheet_cell), ROW(sheet_param), ROW(sheet_varied), ROW(sheet_operator),
        ROW(sheet_velocity), ROW(sheet_drop), ROW(sheet_sources), ROW(source_heat), ROW(source_kind), ROW(source_path),
        ROW(source_position), ROW(source_turn), ROW(source_texture), ROW(source_generation), ROW(collider_radius),
        ROW(collider_sides), ROW(collider_path), ROW(collider_mesh), ROW(collider_height), ROW(pin_anchor),
        ROW(pin_particle), ROW(pin_twice), ROW(pin_end), ROW(time), ROW(time_of_step), ROW(heat_in), ROW(heat_start),
        ROW(mass_removed), ROW(temperature), ROW(temperature_below), ROW(temperature_peak), ROW(mass), ROW(mass_nan),
        ROW(burn_rate), ROW(time_ignited), ROW(time_to_come), ROW(dead_length), ROW(position), ROW(velocity),
        ROW(earlier), ROW(earlier_time), ROW(inverse_mass), ROW(bend), ROW(crease), ROW(pinned), ROW(pinned_flag), ROW(flag), ROW(cell_flag),
        ROW(spring_gone), ROW(spring_spare), ROW(degree), ROW(piece_none), ROW(piece_far), ROW(piece_other),
        ROW(pieces_to_come), ROW(piece_count), ROW(line_force), ROW(split_count), ROW(split), ROW(attach_source),
        ROW(attach_gap), ROW(attach_length), ROW(attach_goal), ROW(collision_position), ROW(collision_speed),
        ROW(collision_alive), ROW(initial_crossing), ROW(initial_cell), ROW(gas_field), ROW(gas_air)};
    // clang-format on
#undef ROW
    SingeSimDef def = scene_def();
    def.contact.enabled = def.solver.tearing = def.solver.creases = true;
    OwnTestScene scene = scene_make(&def, 5);
    test_steps(scene.sim, 6);
    assert_true(scene.sim->state.ablate.spring_flags[SINGE_GREEN][GREEN] && !scene.sim->state.dynamics.pinned[VERTEX]);
    OwnTestBytes good = test_save(scene.sim);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        OwnSim *sim = test_load(NULL, &good);
        test_assert_saved(sim, &good);
        rows[k].poke(sim);
        OwnTestBytes bytes = test_save(sim);
        refuse(bytes.data, bytes.size, rows[k].what);
    }
}

TEST(other_versions_are_refused) {
    OwnTestBytes bytes = small_snapshot();
    SingeSimDef hooks = singe_default_sim();
    SingeSim *sim;
    SingeError error;

    bytes.data[8]++;
    assert_int_equal(singe_sim_load(&hooks, bytes.data, bytes.size, &sim, &error), SINGE_ERROR_VERSION);
    bytes.data[8]--;
    bytes.data[0] = 'X';
    assert_int_equal(singe_sim_load(&hooks, bytes.data, bytes.size, &sim, &error), SINGE_ERROR_FORMAT);
    assert_int_equal(singe_sim_load(&hooks, NULL, 0, &sim, NULL), SINGE_ERROR_FORMAT);
    hooks.thread_count = 0;

    bytes.data[0] = 'S';
    assert_int_equal(singe_sim_load(&hooks, bytes.data, bytes.size, &sim, &error), SINGE_ERROR_ARGUMENT);
}

/// Time step, gravity and the rest come from the bytes, not from the hooks.
TEST(hooks_are_only_hooks) {
    OwnTestScene scene = scene_make(NULL, 8);
    test_steps(scene.sim, 5);

    SingeSimDef hooks = singe_default_sim();
    hooks.time_step = 0.001f, hooks.gravity[2] = 5, hooks.pace = 3, hooks.solver.substeps = 1, hooks.thread_count = 2;
    OwnSim *sim = test_reload(&hooks, scene.sim);
    test_ok(sim, singe_sim_set_source_callback(sim, scene.callback, scene_flux, &flux_strength));
    test_steps_alike(sim, scene.sim, 5);
}
