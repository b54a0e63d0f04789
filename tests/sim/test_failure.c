// Failed steps leave the last good state; failed allocations leave nothing behind; steps allocate nothing.
#include "scenes.h"

#include <stdatomic.h>

static void poison(void *context, const struct SingeView *view, float *flux, float *conductance,
                   float *conductance_temperature) {
    (void)conductance, (void)conductance_temperature;
    uint32_t particle = *(uint32_t *)context;
    if (particle < view->particle_count) flux[particle] = NAN;
}

TEST(a_failed_step_changes_nothing) {
    TestScene scene = scene_make(NULL, 12), twin = scene_make(NULL, 12);
    SingeSim *sim = scene.sim;
    test_steps(sim, 15);
    test_steps(twin.sim, 15);

    uint32_t particle = 30;
    SingeSourceDef def = singe_default_source();
    def.kind = SINGE_SOURCE_CALLBACK, def.callback = poison, def.callback_context = &particle;

    SingeSourceId id = test_add_source(sim, &def);
    TestBytes before = test_save(sim);
    SingeTimers timers = singe_sim_timers(sim);

    for (int i = 0; i < 3; i++) {
        test_refused(sim, SINGE_ERROR_DIVERGED, singe_sim_step(sim));
        assert_string_equal(singe_sim_error(sim)->stage, "heat");
        assert_true(singe_sim_error(sim)->element >= 0);
        size_t events = 1;
        singe_sim_events(sim, &events);
        assert_int_equal(events, 0);
    }

    test_assert_saved(sim, &before);
    assert_int_equal(singe_sim_timers(sim).steps, timers.steps);
    assert_int_equal(singe_sim_timers(sim).contacts, timers.contacts);
    free(before.data);

    // without the source it continues as if nothing had happened
    test_ok(sim, singe_sim_remove_source(sim, id));
    test_ok(twin.sim, singe_sim_add_source(twin.sim, &def, &id)); // keeps the lists and generations alike
    test_ok(twin.sim, singe_sim_remove_source(twin.sim, id));
    test_steps_alike(sim, twin.sim, 30);
    singe_sim_destroy(sim);
    singe_sim_destroy(twin.sim);
}

/// A pin drags a particle out of the world: the dynamics fails after other stages have run, and their changes are
/// undone.
TEST(a_failure_late_in_the_step_changes_nothing) {
    TestScene scene = scene_make(NULL, 10);
    OwnSim *sim = scene.sim;
    test_steps(sim, 30);

    float now = (float)singe_sim_view(sim).time;
    SingePoseKey path[2] = {test_key(now, 0, 0, 0), test_key(now + 1e-3f, 1e8f, 0, 0)}, still = test_key(0, 0, 0, 0);
    SingeSim *copy;
    test_ok(sim, singe_sim_clone(sim, &copy));
    test_ok(sim, singe_sim_move_pin(sim, scene.points, 2, path));

    SingeTimers timers = singe_sim_timers(sim);
    test_refused(sim, SINGE_ERROR_DIVERGED, singe_sim_step(sim));
    assert_string_equal(singe_sim_error(sim)->stage, "dynamics");

    SingeTimers now_timers = singe_sim_timers(sim);
    assert_memory_equal(&now_timers, &timers, sizeof timers);
    test_ok(sim, singe_sim_move_pin(sim, scene.points, 1, &still));
    test_ok(copy, singe_sim_move_pin(copy, scene.points, 2, path));
    test_ok(copy, singe_sim_move_pin(copy, scene.points, 1, &still));

    test_assert_same(sim, copy);
    test_steps_alike(sim, copy, 20);
    singe_sim_destroy(copy);
}

typedef struct Asked {
    atomic_int count, yes; ///< how often the hook was asked, and from which time on it says yes; 0: never
} Asked;

static bool ask(void *context) {
    Asked *asked = context;
    const int count = atomic_fetch_add(&asked->count, 1) + 1, yes = atomic_load(&asked->yes);
    return yes > 0 && count >= yes;
}

/// Four sheets that fly into each other, two of which cross from the start, over a hot ball; one is burning.
static SingeSim *crowd_make(Asked *asked, int threads) {
    SingeSimDef def = scene_def();
    def.contact.enabled = true, def.thread_count = threads, def.cancel = (SingeCancel){ask, asked};

    SingeSim *sim = test_create(&def);
    for (int s = 0; s < 4; s++) {
        OwnTestMesh mesh = test_grid(9, 9, 0.007f, 0.007f);
        test_mesh_move(&mesh, -0.03f, -0.03f, 0.0015f * (float)(s / 2 + 10));
        for (uint32_t v = 0; v < mesh.vertex_count && s == 1; v++)
            mesh.positions[3 * v + 2] += 0.1f * (mesh.positions[3 * v] + 0.01f);

        SingeSheetDef sheet = test_sheet(&mesh);
        sheet.velocity[2] = s < 2 ? 3 : -3;
        sheet.material.temperature = singe_param(s == 0 ? 800 : 300);
        test_add_sheet(sim, &sheet);
    }

    SingeColliderDef ball = singe_default_collider();
    ball.kind = SINGE_COLLIDER_SPHERE, ball.radius = 0.01f, ball.conductance = 100, ball.temperature = 700;
    test_add_collider(sim, &ball);
    test_ok(sim, singe_sim_commit(sim));
    return sim;
}

/// Gives up the next step at each of some times of asking; nothing changes, in the state and in the timers.
static int give_up(SingeSim *sim, Asked *asked) {
    SingeSim *copy;
    int given_up = 0;
    atomic_store(&asked->count, 0);
    atomic_store(&asked->yes, 0);
    test_ok(sim, singe_sim_clone(sim, &copy));
    test_ok(copy, singe_sim_step(copy));

    const int polls = atomic_load(&asked->count);
    singe_sim_destroy(copy);
    assert_true(polls > 5);

    OwnTestBytes before = test_save(sim);
    const SingeTimers timers = singe_sim_timers(sim);
    for (int n = 1; n <= polls; n += 1 + polls / 9, given_up++) {
        atomic_store(&asked->count, 0);
        atomic_store(&asked->yes, n);
        test_refused(sim, SINGE_ERROR_CANCELLED, singe_sim_step(sim));
        const SingeTimers now = singe_sim_timers(sim);
        assert_memory_equal(&now, &timers, sizeof timers);
        test_assert_saved(sim, &before);
    }
    atomic_store(&asked->yes, 0);

    return given_up;
}

/// A step that is given up, wherever that is, changes nothing: neither what is saved nor what follows.
TEST(a_step_that_is_given_up_changes_nothing) {
    for (int threads = 1; threads <= 2; threads++) {
        Asked asked = {0}, never = {0};
        OwnSim *sim = crowd_make(&asked, threads), *twin = crowd_make(&never, 1);
        int given_up = 0;
        for (int step = 0; step < 30; step++) {
            given_up += give_up(sim, &asked);
            test_ok(sim, singe_sim_step(sim));
            test_ok(twin, singe_sim_step(twin));
            test_assert_same(sim, twin);
        }

        const SingeTimers timers = singe_sim_timers(sim), other = singe_sim_timers(twin);
        print_message("given up %d times; %llu collisions stopped, %u cells crossed from the start\n", given_up,
                      (unsigned long long)timers.contact_stops, singe_sim_stats(sim).intersecting_cells);
        assert_true(given_up > 150 && timers.contact_stops > 0 && singe_sim_stats(sim).intersecting_cells > 0);
        assert_int_equal(timers.contact_stops, other.contact_stops);
        assert_int_equal(timers.contact_pairs, other.contact_pairs);
    }
}

TEST(steps_allocate_nothing) {
    TestAllocator hook = {0};
    SingeSimDef def = scene_def();
    def.allocator = test_allocator(&hook);

    TestScene scene = scene_make(&def, 14);
    long calls = hook.calls, frees = hook.frees;
    size_t events = 0;
    for (int i = 0; i < 100; i++) {
        size_t count;
        test_ok(scene.sim, singe_sim_step(scene.sim));
        singe_sim_events(scene.sim, &count);
        events += count;
        singe_sim_stats(scene.sim);
        assert_int_equal(hook.calls, calls);
        assert_int_equal(hook.frees, frees);
    }

    SingeStats stats = singe_sim_stats(scene.sim);
    assert_true(events > 20 && stats.mass_removed > 0 && singe_sim_timers(scene.sim).contacts > 0);
    singe_sim_destroy(scene.sim);
    assert_int_equal(hook.blocks, 0);
}

static SingeResult whole_life(const SingeSimDef *def, TestScene *scene, SingeSurface *surface) {
#define LIFE(call)                    \
    do {                              \
        SingeResult result_ = (call); \
        if (result_) return result_;  \
    } while (0)
    LIFE(scene_build(def, 3, scene));
    for (int i = 0; i < 5; i++) LIFE(singe_sim_step(scene->sim));
    LIFE(singe_sim_surface(scene->sim, surface));
    SingePoseKey key = test_key(0, 0, 0, 1);
    LIFE(singe_sim_move_pin(scene->sim, scene->points, 1, &key));
    LIFE(singe_sim_move_collider(scene->sim, scene->box, 1, &key));
    LIFE(singe_sim_remove_collider(scene->sim, scene->sphere));
    for (int i = 0; i < 4; i++) {
        SingeColliderDef collider = singe_default_collider();
        SingeColliderId id;
        collider.path_count = 1, collider.path = &key;
        LIFE(singe_sim_add_collider(scene->sim, &collider, &id));
    }
    uint8_t *bytes;
    size_t size;
    LIFE(singe_sim_save(scene->sim, &bytes, &size));
    SingeSim *loaded = NULL;
    SingeError error = {0};
    SingeResult result = singe_sim_load(def, bytes, size, &loaded, &error);
    singe_sim_free_bytes(scene->sim, bytes, size);
    if (result) {
        assert_null(loaded);
        assert_int_equal(error.code, result);
        return result;
    }
    singe_sim_destroy(loaded);
    return singe_sim_step(scene->sim);
#undef LIFE
}

static long allocations(void) {
    TestAllocator hook = {0};
    SingeSimDef def = scene_def();
    def.allocator = test_allocator(&hook);

    TestScene scene;
    SingeSurface surface = {.allocator = def.allocator};
    test_ok(scene.sim, whole_life(&def, &scene, &surface));
    singe_surface_free(&surface);
    singe_sim_destroy(scene.sim);
    assert_int_equal(hook.blocks, 0);
    assert_int_equal(hook.bytes, 0);
    assert_int_equal(hook.faults, 0);
    return hook.calls;
}

/// Every call for memory fails once, and once with all after it.
TEST(every_allocation_fails_once) {
    long calls = allocations();
    assert_true(calls > 50);

    for (long n = 1; n <= 2 * calls; n++) {
        TestAllocator hook = {.fail_at = (n + 1) / 2, .once = n & 1};
        SingeSimDef def = scene_def();
        def.allocator = test_allocator(&hook);

        TestScene scene;
        SingeSurface surface = {.allocator = def.allocator};
        SingeResult result = whole_life(&def, &scene, &surface);
        if (result != SINGE_ERROR_MEMORY)
            fail_msg("call %ld of %ld: %s", hook.fail_at, calls, singe_result_name(result));

        singe_surface_free(&surface);
        singe_sim_destroy(scene.sim);
        if (hook.blocks || hook.bytes || hook.faults)
            fail_msg("call %ld: %ld blocks, %zu bytes left, %ld faults", hook.fail_at, hook.blocks, hook.bytes,
                     hook.faults);
    }
}

/// A call that failed for lack of memory can be repeated on the same simulation.
TEST(failed_calls_can_be_repeated) {
    TestAllocator hook = {0};
    SingeSimDef def = scene_def();
    def.allocator = test_allocator(&hook);
    SingeSim *sim = test_create(&def);
    OwnTestMesh mesh = test_grid(5, 5, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    SingeSheetId sheet_id;
    SingePoseKey key = test_key(0, 0, 0, 0);
    SingeSourceDef source = singe_default_source();
    SingeSourceId source_id;
    const float grey = 1;
    source.kind = SINGE_SOURCE_TEXTURE, source.texture = (SingeTexture){1, 1, &grey};
    SingeColliderDef collider = singe_default_collider();
    SingeColliderId collider_id;
    collider.path_count = 1, collider.path = &key;
    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    const float point[3] = {0, 0, 0};
    pin.point_count = 1, pin.points = point, pin.path_count = 1, pin.path = &key;
#define REPEAT(call)                                                                          \
    for (long n = 1;; n++) {                                                                  \
        hook.fail_at = hook.calls + n, hook.once = true;                                      \
        size_t held_ = hook.bytes;                                                            \
        long faults_ = hook.faults;                                                           \
        SingeResult result_ = (call);                                                         \
        hook.fail_at = 0;                                                                     \
        assert_int_equal(hook.faults, faults_);                                               \
        if (result_ == SINGE_OK) break;                                                       \
        assert_int_equal(result_, SINGE_ERROR_MEMORY);                                        \
        assert_int_equal(singe_sim_error(sim)->code, SINGE_ERROR_MEMORY);                     \
        if (hook.bytes > held_ + 8192) fail_msg(#call " kept %zu bytes", hook.bytes - held_); \
    }
    REPEAT(singe_sim_add_sheet(sim, &sheet, &sheet_id));
    REPEAT(singe_sim_commit(sim));
    pin.sheet = sheet_id;
    REPEAT(singe_sim_add_source(sim, &source, &source_id));
    REPEAT(singe_sim_add_collider(sim, &collider, &collider_id));
    REPEAT(singe_sim_add_pin(sim, &pin, &pin_id));
    uint8_t *bytes;
    size_t size;
    REPEAT(singe_sim_save(sim, &bytes, &size));
    singe_sim_free_bytes(sim, bytes, size);
    SingeSim *copy;
    REPEAT(singe_sim_clone(sim, &copy));
    singe_sim_destroy(copy);
#undef REPEAT
    assert_int_equal(source_id.index, 0); // failed tries used up no slots
    assert_int_equal(collider_id.index, 0);
    assert_int_equal(pin_id.index, 0);
    test_steps(sim, 3);
    singe_sim_destroy(sim);
    assert_int_equal(hook.blocks, 0);
}
