// Objects added before the commit, objects without a path, lists of handles, and the caller's own data.
#include "scenes.h"

/// The order in which sheets, objects and the commit come does not matter.
TEST(the_order_does_not_matter) {
    SingeSimDef def = scene_def();
    TestScene late, early;
    test_ok(NULL, scene_build(&def, 9, &late));

    SingeResult result = scene_build_early(&def, 9, &early);
    test_ok(early.sim, result);
    assert_memory_equal(&early.ball, &late.ball, sizeof late.ball);
    assert_memory_equal(&early.vertices, &late.vertices, sizeof late.vertices);
    for (int k = 0; k < 2; k++, test_steps(late.sim, 40), test_steps(early.sim, 40)) {
        OwnTestBytes bytes = test_save(late.sim);
        test_assert_saved(early.sim, &bytes);
    }

    test_assert_same(late.sim, early.sim);
    assert_true(singe_sim_stats(early.sim).burnt_fraction > 0.02);
    singe_sim_destroy(late.sim);
    singe_sim_destroy(early.sim);
}

/// An object that is invalid fails at the commit as it would after it, and the commit can be repeated.
TEST(invalid_objects_fail_at_the_commit) {
    SingeSimDef def = singe_default_sim();
    OwnSim *sim = test_create(&def);
    OwnTestMesh mesh = test_grid(4, 4, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    sheet.uv = NULL;

    SingePinDef pin = singe_default_pin();
    const uint32_t vertices[] = {3, 25};
    pin.vertex_count = 2, pin.vertices = vertices;

    SingePinId pin_id;
    test_ok(sim, singe_sim_add_sheet(sim, &sheet, &pin.sheet));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_add_pin(sim, &pin, &pin_id)); // there are 25
    assert_int_equal(singe_sim_error(sim)->element, 1);
    pin.vertex_count = 1;
    test_ok(sim, singe_sim_add_pin(sim, &pin, &pin_id));

    SingeSourceDef picture = singe_default_source();
    const float grey[4] = {0, 1, 0.5f, 1};
    picture.kind = SINGE_SOURCE_TEXTURE;
    picture.texture = (SingeTexture){2, 2, grey};
    SingeSourceId picture_id = test_add_source(sim, &picture);

    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_commit(sim)); // a picture without uv
    assert_string_equal(singe_sim_error(sim)->stage, "source");
    test_ok(sim, singe_sim_remove_source(sim, picture_id));
    test_ok(sim, singe_sim_commit(sim));
    assert_true(singe_sim_view(sim).particle_flags[3] & SINGE_PINNED);

    assert_false(singe_sim_view(sim).particle_flags[4] & SINGE_PINNED);
    test_ok(sim, singe_sim_remove_pin(sim, pin_id));
    assert_false(singe_sim_view(sim).particle_flags[3] & SINGE_PINNED);
}

/// Removed before the commit, an object leaves nothing behind.
TEST(objects_removed_before_the_commit_leave_nothing) {
    TestAllocator hook = {0};
    SingeSimDef def = scene_def();
    def.allocator = test_allocator(&hook);
    SingeSim *sim = test_create(&def);
    TestMesh mesh = test_grid(3, 3, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    SingePinDef pin = singe_default_pin();
    const float point[3] = {0, 0, 0};
    pin.point_count = 1, pin.points = point;

    SingePinId first, second;
    test_ok(sim, singe_sim_add_sheet(sim, &sheet, &pin.sheet));
    test_ok(sim, singe_sim_add_pin(sim, &pin, &first));
    test_ok(sim, singe_sim_add_pin(sim, &pin, &second));
    test_ok(sim, singe_sim_remove_pin(sim, first));
    test_ok(sim, singe_sim_commit(sim));

    SingePinId left[2];
    assert_int_equal(singe_sim_pins(sim, left, 2), 1);
    assert_memory_equal(&left[0], &second, sizeof second);
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_remove_pin(sim, first));
    test_steps(sim, 2);
    test_mesh_free(&mesh);
    singe_sim_destroy(sim);
    test_allocator_check(&hook);
}

/// A source or collider without a path stands where `position` says, as one with a path of one key does.
TEST(without_a_path_it_stands_still) {
    SingeSim *sims[2];
    for (int k = 0; k < 2; k++) {
        sims[k] = test_sim(NULL, test_grid(6, 6, 0.01f, 0.01f), NULL);
        SingeSourceDef spot = singe_default_source();
        SingeColliderDef box = singe_default_collider();
        SingePoseKey there = test_key(0, 0.03f, 0.02f, 0.001f), under = {0, {0.03f, 0.03f, -0.06f}, {0.1f, 0, 0, 1}};

        box.kind = SINGE_COLLIDER_BOX;
        if (k == 0) {
            spot.path_count = 1, spot.path = &there;
            box.path_count = 1, box.path = &under;
        } else {
            memcpy(spot.position, there.position, sizeof spot.position);
            memcpy(box.position, under.position, sizeof box.position);
            memcpy(box.rotation, under.rotation, sizeof box.rotation);
        }

        test_add_source(sims[k], &spot);
        test_add_collider(sims[k], &box);
        test_steps(sims[k], 60);
    }

    test_assert_same(sims[0], sims[1]);
    assert_true(singe_sim_stats(sims[1]).heat_in > 0.1);
    assert_true(singe_sim_timers(sims[1]).contacts > 0);
    singe_sim_destroy(sims[0]);
    singe_sim_destroy(sims[1]);
}

/// Callers may omit handles that they do not need; the objects exist nevertheless.
TEST(handles_may_be_left_out) {
    SingeSim *sims[2];
    for (int k = 0; k < 2; k++) {
        SingeSimDef def = singe_default_sim();
        test_ok(NULL, singe_sim_create(&def, &sims[k], NULL));

        OwnTestMesh mesh = test_grid(4, 4, 0.01f, 0.01f);
        SingeSheetDef sheet = test_sheet(&mesh);
        SingePinDef pin = singe_default_pin();
        SingeSourceDef spot = singe_default_source();
        SingeColliderDef plane = singe_default_collider();
        SingeSourceId source;
        SingeColliderId collider;
        SingePinId pin_id;
        const uint32_t corner = 0;
        pin.vertex_count = 1, pin.vertices = &corner;
        plane.position[2] = -0.02f;

        test_ok(sims[k], singe_sim_add_sheet(sims[k], &sheet, k ? NULL : &pin.sheet));
        test_ok(sims[k], singe_sim_add_sheet(sims[k], &sheet, &pin.sheet));
        assert_int_equal(pin.sheet.index, 1);
        test_ok(sims[k], singe_sim_add_pin(sims[k], &pin, k ? NULL : &pin_id));
        test_ok(sims[k], singe_sim_add_source(sims[k], &spot, k ? NULL : &source));
        test_ok(sims[k], singe_sim_add_collider(sims[k], &plane, k ? NULL : &collider));

        pin.vertex_count = 0;
        test_refused(sims[k], SINGE_ERROR_ARGUMENT, singe_sim_add_pin(sims[k], &pin, k ? NULL : &pin_id));
        test_ok(sims[k], singe_sim_commit(sims[k]));
        test_steps(sims[k], 10);
    }

    test_assert_same(sims[0], sims[1]);
    assert_true(singe_sim_stats(sims[1]).heat_in > 0);
    singe_sim_destroy(sims[0]);
    singe_sim_destroy(sims[1]);
}

TEST(user_data_is_the_callers) {
    int ours[5];
    SingeSim *sim, *copy;
    SingeSimDef def = singe_default_sim();

    test_ok(NULL, singe_sim_create(&def, &sim, NULL));
    OwnTestMesh mesh = test_grid(2, 2, 0.01f, 0.01f);
    SingeSheetDef sheet = test_sheet(&mesh);
    SingeSourceDef source = singe_default_source();
    SingeColliderDef collider = singe_default_collider();
    SingePinDef pin = singe_default_pin();
    const uint32_t vertex = 0;

    sheet.user_data = &ours[0], source.user_data = &ours[1], collider.user_data = &ours[2], pin.user_data = &ours[3];
    pin.vertex_count = 1, pin.vertices = &vertex;
    test_ok(sim, singe_sim_add_sheet(sim, &sheet, &pin.sheet));

    SingeSourceId source_id = test_add_source(sim, &source);
    SingeColliderId collider_id = test_add_collider(sim, &collider);
    SingePinId pin_id = test_add_pin(sim, &pin);

    test_ok(sim, singe_sim_commit(sim));
    test_ok(sim, singe_sim_set_source_user_data(sim, source_id, &ours[4]));
    test_ok(sim, singe_sim_clone(sim, &copy));
    for (int k = 0; k < 2; k++) {
        assert_ptr_equal(singe_sim_sheet_user_data(k ? copy : sim, pin.sheet), &ours[0]);
        assert_ptr_equal(singe_sim_source_user_data(k ? copy : sim, source_id), &ours[4]);
        assert_ptr_equal(singe_sim_collider_user_data(k ? copy : sim, collider_id), &ours[2]);
        assert_ptr_equal(singe_sim_pin_user_data(k ? copy : sim, pin_id), &ours[3]);
    }

    SingeSheetId sheets[2];
    assert_int_equal(singe_sim_sheets(copy, sheets, 2), 1);
    assert_memory_equal(&sheets[0], &pin.sheet, sizeof pin.sheet);
    assert_int_equal(singe_sim_sources(copy, NULL, 0), 1);

    SingeColliderId there;
    assert_int_equal(singe_sim_colliders(copy, &there, 1), 1);
    assert_memory_equal(&there, &collider_id, sizeof there);
    test_ok(sim, singe_sim_remove_collider(sim, collider_id));
    assert_null(singe_sim_collider_user_data(sim, collider_id));
    assert_null(singe_sim_sheet_user_data(sim, (SingeSheetId){1, 1}));

    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_collider_user_data(sim, collider_id, ours));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_pin_user_data(sim, (SingePinId){5, 5}, ours));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_sheet_user_data(sim, (SingeSheetId){5, 1}, ours));
    singe_sim_destroy(sim);
    singe_sim_destroy(copy);
}

/// Every call for memory up to the commit fails once; the commit works when it is called again.
TEST(every_allocation_fails_once) {
    TestAllocator count = {0};
    SingeSimDef def = scene_def();
    TestScene scene;
    def.allocator = test_allocator(&count);
    test_ok(NULL, scene_build_early(&def, 3, &scene));
    singe_sim_destroy(scene.sim);

    long repeated = 0;
    for (long n = 1; n <= count.calls; n++) {
        TestAllocator hook = {.fail_at = n, .once = true};
        def.allocator = test_allocator(&hook);
        assert_int_equal(scene_build_early(&def, 3, &scene), SINGE_ERROR_MEMORY);

        SingePinId pin;
        if (scene.sim && singe_sim_pins(scene.sim, &pin, 1) == 2) { // all was there but the commit
            repeated++;
            test_ok(scene.sim, singe_sim_commit(scene.sim));
            test_steps(scene.sim, 1);
        }

        singe_sim_destroy(scene.sim);
        test_allocator_check(&hook);
    }

    assert_true(repeated > 50);
}
