// Key-framed paths and poses.
#include "support/support.h"

#include "world/path.h"

typedef struct Fixture {
    TestAllocator hook;
    Memory memory;
    Path path;
    SingeError error;
} Fixture;

static Fixture *fixture(void) {
    static Fixture fixture;
    memset(&fixture, 0, sizeof fixture);
    fixture.memory = memory_make(test_allocator(&fixture.hook));
    return &fixture;
}

static void release(Fixture *f) {
    path_free(&f->path, &f->memory);
    test_allocator_check(&f->hook);
    assert_int_equal(f->memory.held, 0);
}

static void set(Fixture *f, uint32_t count, const SingePoseKey *keys) {
    assert_int_equal(path_set(&f->path, &f->memory, count, keys, "owner", &f->error), SINGE_OK);
}

static void near_float3(Float3 a, float x, float y, float z) {
    assert_true(float3_length(float3_sub(a, float3(x, y, z))) < 1e-5f);
}

TEST(positions_are_linear_and_held) {
    Fixture *f = fixture();
    SingePoseKey keys[] = {test_key(1, 0, 0, 0), test_key(2, 2, 4, -6), test_key(4, 2, 0, -6)};
    set(f, 3, keys);

    near_float3(path_pose(&f->path, -100).position, 0, 0, 0);
    near_float3(path_pose(&f->path, 1).position, 0, 0, 0);
    near_float3(path_pose(&f->path, 1.25).position, 0.5f, 1, -1.5f);
    near_float3(path_pose(&f->path, 2).position, 2, 4, -6);
    near_float3(path_pose(&f->path, 3).position, 2, 2, -6);
    near_float3(path_pose(&f->path, 4).position, 2, 0, -6);
    near_float3(path_pose(&f->path, 1e9).position, 2, 0, -6);
    release(f);
}

TEST(one_key_stands_still) {
    Fixture *f = fixture();
    near_float3(path_pose(&f->path, 3).position, 0, 0, 0);
    assert_true(path_pose(&f->path, 3).rotation[3] == 1);
    set(f, 0, NULL);
    near_float3(path_pose(&f->path, 3).position, 0, 0, 0);

    SingePoseKey key = test_key(5, 1, 2, 3);
    set(f, 1, &key);
    for (int t = 0; t < 10; t++) near_float3(path_pose(&f->path, t).position, 1, 2, 3);
    release(f);
}

TEST(rotations_stay_unit_and_go_the_short_way) {
    Fixture *f = fixture();
    const float s = sqrtf(0.5f);

    // a quarter turn about z, its end given with the other sign; and both of wrong length
    SingePoseKey keys[] = {{0, {0}, {0, 0, 0, 2}}, {1, {0}, {0, 0, -3 * s, -3 * s}}};
    set(f, 2, keys);
    float angle_before = -1;
    for (int i = 0; i <= 100; i++) {
        Pose pose = path_pose(&f->path, i / 100.0);
        const float *q = pose.rotation;
        assert_true(fabsf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-5f);
        Float3 x = quat_rotate(q, float3(1, 0, 0));
        float angle = atan2f(x.y, x.x);
        assert_true(angle > angle_before - 1e-6f);                        // never turns back
        assert_true(fabsf(angle - 1.57079633f * (float)i / 100) < 0.03f); // near the even turn
        angle_before = angle;
    }

    Float3 x = quat_rotate(path_pose(&f->path, 0.5).rotation, float3(1, 0, 0));
    near_float3(x, s, s, 0);
    x = quat_rotate(path_pose(&f->path, 1).rotation, float3(1, 0, 0));
    near_float3(x, 0, 1, 0);
    release(f);
}

TEST(huge_and_tiny_rotations_are_normalised) {
    Fixture *f = fixture();
    SingePoseKey keys[] = {{0, {0}, {1e30f, 0, 0, 0}}, {1, {0}, {0, 1e-5f, 0, 0}}};
    set(f, 2, keys);
    assert_true(fabsf(path_pose(&f->path, 0).rotation[0] - 1) < 1e-6f);
    assert_true(fabsf(path_pose(&f->path, 1).rotation[1] - 1) < 1e-6f);
    release(f);
}

TEST(poses_invert) {
    Fixture *f = fixture();
    SingePoseKey key = {0, {1, -2, 3}, {0.1f, -0.4f, 0.3f, 0.8f}};
    set(f, 1, &key);

    Pose pose = path_pose(&f->path, 0);
    Float3 p = float3(0.3f, -0.7f, 1.1f), world = pose_apply(&pose, p);
    near_float3(pose_unapply(&pose, world), p.x, p.y, p.z);
    assert_true(fabsf(float3_length(float3_sub(world, pose.position)) - float3_length(p)) < 1e-5f);
    near_float3(pose_apply(&pose, float3(0, 0, 0)), 1, -2, 3);
    release(f);
}

static void refused(Fixture *f, uint32_t count, const SingePoseKey *keys, int64_t element) {
    Path before = f->path;
    assert_int_equal(path_set(&f->path, &f->memory, count, keys, "owner", &f->error), SINGE_ERROR_ARGUMENT);
    assert_string_equal(f->error.stage, "owner");
    assert_int_equal(f->error.element, element);
    assert_memory_equal(&f->path, &before, sizeof before);
}

TEST(bad_keys_are_refused) {
    Fixture *f = fixture();
    SingePoseKey good[] = {test_key(0, 0, 0, 0), test_key(1, 1, 0, 0), test_key(2, 2, 0, 0)}, bad[3];
    set(f, 3, good);
    refused(f, 3, NULL, -1);
#define BAD(change, element)       \
    memcpy(bad, good, sizeof bad); \
    change;                        \
    refused(f, 3, bad, element)
    BAD(bad[2].time = 1, 2);
    BAD(bad[1].time = -1, 1);
    BAD(bad[1].time = NAN, 1);
    BAD(bad[2].time = INFINITY, 2);
    BAD(bad[0].position[1] = NAN, 0);
    BAD(bad[0].position[1] = -INFINITY, 0);
    BAD(bad[0].position[1] = 1e30f, 0);
    BAD(bad[2].rotation[0] = NAN, 2);
    BAD(bad[2].rotation[3] = INFINITY, 2);
    BAD(bad[1].rotation[3] = 0, 1);
#undef BAD
    near_float3(path_pose(&f->path, 1.5).position, 1.5f, 0, 0);
    release(f);
}

TEST(without_memory_a_path_stays) {
    Fixture *f = fixture();
    SingePoseKey keys[] = {test_key(0, 7, 0, 0), test_key(1, 1, 0, 0)};
    set(f, 2, keys);
    f->hook.fail_at = f->hook.calls + 1;
    assert_int_equal(path_set(&f->path, &f->memory, 1, keys, "owner", &f->error), SINGE_ERROR_MEMORY);
    near_float3(path_pose(&f->path, 0).position, 7, 0, 0);
    release(f);
}
