// Save, load and clone: a resumed run is bitwise the run that was not interrupted, and damage is noticed.
#include "step/scenes.h"

#include "base/bytes.h"
#include "step/snapshot_def.h"

#include <stdlib.h>
#include <string.h>

static float flux_strength = 2000;

static SingeSim *load(const TestBytes *bytes) {
    SingeSimDef hooks = singe_default_sim();
    SingeSim *sim;
    SingeError error = {0};
    if (singe_sim_load(&hooks, bytes->data, bytes->size, &sim, &error)) fail_msg("load: %s", error.message);
    return sim;
}

static void resumed_runs_are_the_same(void **state) {
    (void)state;
    static const int saves[] = {0, 1, 17, 45, 80};
    for (size_t k = 0; k < sizeof saves / sizeof *saves; k++) {
        Scene scene = scene_make(NULL, 14);
        test_steps(scene.sim, saves[k]);
        TestBytes bytes = test_save(scene.sim);
        SingeSim *resumed = load(&bytes);
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
        free(bytes.data);
        singe_sim_destroy(resumed);
        singe_sim_destroy(scene.sim);
    }
}

/// The bytes depend on the simulation alone, not on rubbish between fields or on where things lie.
static void bytes_are_the_same(void **state) {
    (void)state;
    Scene a = scene_make(NULL, 9);
    TestAllocator hook = {0}; // fills fresh blocks with rubbish
    SingeSimDef def;
    memset(&def, 0x5A, sizeof def);
    SingeSimDef standard = scene_def();
    memcpy(&def, &standard, sizeof def);
    def.allocator = test_allocator(&hook);
    Scene b = scene_make(&def, 9);
    test_steps(a.sim, 12);
    test_steps(b.sim, 12);
    test_assert_same(a.sim, b.sim);
    TestBytes first = test_save(a.sim), second = test_save(a.sim);
    assert_int_equal(first.size, second.size);
    assert_memory_equal(first.data, second.data, first.size);
    SingeSim *loaded = load(&first);
    TestBytes third = test_save(loaded);
    assert_int_equal(first.size, third.size);
    assert_memory_equal(first.data, third.data, first.size);
    free(first.data), free(second.data), free(third.data);
    singe_sim_destroy(loaded);
    singe_sim_destroy(a.sim);
    singe_sim_destroy(b.sim);
    assert_int_equal(hook.blocks, 0);
}

static void handles_keep_their_values(void **state) {
    (void)state;
    Scene scene = scene_make(NULL, 8);
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
    SingePinId id;
    pin.sheet = sheet, pin.vertex_count = 1, pin.vertices = &vertex;
    test_ok(sim, singe_sim_add_pin(sim, &pin, &id)); // into a free slot, which held nothing
    assert_int_equal(id.index, scene.points.index);
    free(bytes.data);
    singe_sim_destroy(sim);
    assert_int_equal(hook.blocks, 0);
    singe_sim_destroy(scene.sim);
}

static void clones_are_independent(void **state) {
    (void)state;
    Scene scene = scene_make(NULL, 10);
    test_steps(scene.sim, 20);
    SingeSim *copy;
    test_ok(scene.sim, singe_sim_clone(scene.sim, &copy));
    test_assert_same(scene.sim, copy);
    TestBytes before = test_save(scene.sim);
    test_steps(copy, 30); // with its callback source: no need to set it again
    TestBytes after = test_save(scene.sim);
    assert_int_equal(before.size, after.size);
    assert_memory_equal(before.data, after.data, before.size);
    test_steps(scene.sim, 30);
    test_assert_same(scene.sim, copy);
    test_ok(copy, singe_sim_remove_pin(copy, scene.points));
    test_steps(copy, 10);
    test_steps(scene.sim, 10);
    singe_sim_destroy(scene.sim);
    test_steps(copy, 2);
    singe_sim_destroy(copy);
    free(before.data), free(after.data);
}

/// A load of damaged bytes is refused; what it took is given back.
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
    Scene scene = scene_make(NULL, 4);
    test_steps(scene.sim, 6);
    TestBytes bytes = test_save(scene.sim);
    singe_sim_destroy(scene.sim);
    return bytes;
}

static void truncated_snapshots(void **state) {
    (void)state;
    TestBytes bytes = small_snapshot();
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
    free(bytes.data);
}

static void flipped_bits(void **state) {
    (void)state;
    TestBytes bytes = small_snapshot();
    for (size_t k = 0; k < 1200; k++) {
        size_t bit = k < 512 ? k : (k - 512) * (bytes.size * 8 / 688) + k % 8; // every bit of the header's 64 bytes
        if (bit / 8 >= bytes.size) continue;
        bytes.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
        refuse(bytes.data, bytes.size, "flipped");
        bytes.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
    SingeSim *sim = load(&bytes);
    singe_sim_destroy(sim);
    free(bytes.data);
}

/// Bytes that lie about the body but carry its right checksum: whatever the load says, it neither crashes nor leaks.
static void forged_snapshots(void **state) {
    (void)state;
    enum { HEADER = 64, CHECKSUM_AT = 24 };
    TestBytes good = small_snapshot();
    uint32_t random = 1;
    int refused = 0;
    for (int k = 0; k < 600; k++) {
        TestBytes bytes = {malloc(good.size), good.size};
        assert_non_null(bytes.data);
        memcpy(bytes.data, good.data, good.size);
        for (int change = 0; change < 2; change++) {
            random = random * 1664525u + 1013904223u;
            size_t at = HEADER + (k < 400 ? (size_t)k * 4 + (random >> 8) % 4 : (random >> 8) % (good.size - HEADER));
            random = random * 1664525u + 1013904223u;
            bytes.data[at] = (uint8_t)(k & 1 ? random >> 24 : 0xFF);
        }
        uint64_t sum = stream_checksum(bytes.data + HEADER, bytes.size - HEADER);
        memcpy(bytes.data + CHECKSUM_AT, &sum, sizeof sum);
        TestAllocator hook = {0};
        SingeSimDef hooks = singe_default_sim();
        hooks.allocator = test_allocator(&hook);
        SingeSim *sim;
        SingeError error = {0};
        SingeResult result = singe_sim_load(&hooks, bytes.data, bytes.size, &sim, &error);
        refused += result != SINGE_OK;
        if (!result) singe_sim_destroy(sim);
        else assert_true(error.code == result && error.message[0]);
        assert_int_equal(hook.blocks, 0);
        free(bytes.data);
    }
    assert_true(refused > 50);
    free(good.data);
}

static void other_versions(void **state) {
    (void)state;
    TestBytes bytes = small_snapshot();
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
    free(bytes.data);
}

/// Time step, gravity and the rest come from the bytes, not from the hooks.
static void hooks_are_only_hooks(void **state) {
    (void)state;
    Scene scene = scene_make(NULL, 8);
    test_steps(scene.sim, 5);
    TestBytes bytes = test_save(scene.sim);
    SingeSimDef hooks = singe_default_sim();
    hooks.time_step = 0.001f, hooks.gravity[2] = 5, hooks.pace = 3, hooks.solver.substeps = 1, hooks.thread_count = 2;
    SingeSim *sim;
    assert_int_equal(singe_sim_load(&hooks, bytes.data, bytes.size, &sim, NULL), SINGE_OK);
    test_ok(sim, singe_sim_set_source_callback(sim, scene.callback, scene_flux, &flux_strength));
    test_steps(sim, 5);
    test_steps(scene.sim, 5);
    test_assert_same(sim, scene.sim);
    free(bytes.data);
    singe_sim_destroy(sim);
    singe_sim_destroy(scene.sim);
}

/// Bytes of a Def that are not saved: struct_size, pointers, hooks, thread count, instructions, what the shell sets,
/// padding. A new field that is not in snapshot_def.c makes one of these numbers grow.
static void every_field_is_saved(void **state) {
    (void)state;
    if (sizeof(void *) != 8) skip();
    Stream measure = {.mode = STREAM_MEASURE};
    SingeSimDef sim = singe_default_sim();
    snapshot_sim_def(&measure, &sim);
    assert_int_equal(sizeof sim - measure.offset, 126);
    Sheet sheet = {0};
    measure.offset = 0;
    snapshot_sheet_def(&measure, &sheet);
    assert_int_equal(sizeof sheet - measure.offset, 1303);
    SingeSourceDef source = singe_default_source();
    measure.offset = 0;
    snapshot_source_def(&measure, &source);
    assert_int_equal(sizeof source - measure.offset, 60);
    SingeColliderDef collider = singe_default_collider();
    measure.offset = 0;
    snapshot_collider_def(&measure, &collider);
    assert_int_equal(sizeof collider - measure.offset, 44);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(resumed_runs_are_the_same),
        cmocka_unit_test(every_field_is_saved), cmocka_unit_test(bytes_are_the_same),
        cmocka_unit_test(handles_keep_their_values), cmocka_unit_test(clones_are_independent),
        cmocka_unit_test(truncated_snapshots),       cmocka_unit_test(flipped_bits),
        cmocka_unit_test(forged_snapshots),          cmocka_unit_test(other_versions),
        cmocka_unit_test(hooks_are_only_hooks),
    };
    return cmocka_run_group_tests_name("step_snapshot", tests, NULL, NULL);
}
