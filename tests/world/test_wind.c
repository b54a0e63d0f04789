// Wind: the mean, the gusts' bound, seed and smoothness. Air that sources move.
#include "support/support.h"

#include "world/air.h"
#include "world/wind.h"

static Float3 at(const SingeWindDef *def, int i) {
    return wind_velocity(def, float3((float)(i % 13) * 0.11f, (float)(i % 7) * 0.23f, (float)(i % 5) * 0.31f),
                         i * 0.037);
}

TEST(no_gust_is_uniform) {
    SingeWindDef def = singe_default_wind();
    def.velocity[0] = 1, def.velocity[1] = -2, def.velocity[2] = 0.5f;
    for (int i = 0; i < 100; i++) {
        Float3 v = at(&def, i);
        assert_true(v.x == 1 && v.y == -2 && v.z == 0.5f);
    }
}

TEST(gusts_have_their_mean_and_bound) {
    SingeWindDef def = singe_default_wind();
    def.velocity[0] = 3;
    def.gust = 2;

    enum { COUNT = 50000 };
    double mean[3] = {0}, square = 0;
    for (int i = 0; i < COUNT; i++) {
        Float3 v = at(&def, i);
        assert_true(fabsf(v.x - 3) <= 2 && fabsf(v.y) <= 2 && fabsf(v.z) <= 2);
        mean[0] += (double)v.x / COUNT, mean[1] += (double)v.y / COUNT, mean[2] += (double)v.z / COUNT;
        square += (double)(v.y * v.y) / COUNT;
    }

    assert_true(fabs(mean[0] - 3) < 0.1 && fabs(mean[1]) < 0.1 && fabs(mean[2]) < 0.1);
    assert_true(sqrt(square) > 0.3 && sqrt(square) < 1.2); // it does blow
}

TEST(gusts_follow_their_seed) {
    SingeWindDef a = singe_default_wind();
    a.gust = 1;
    SingeWindDef b = a;
    int equal = 0;

    for (int i = 0; i < 1000; i++) {
        Float3 v = at(&a, i), w = at(&b, i);
        assert_memory_equal(&v, &w, sizeof v);
    }

    b.seed++;
    for (int i = 0; i < 1000; i++) equal += at(&a, i).x == at(&b, i).x;
    assert_true(equal < 5);
}

TEST(gusts_are_smooth_in_time_and_space) {
    SingeWindDef def = singe_default_wind();
    def.gust = 1;
    for (int i = 0; i < 2000; i++) {
        double time = i * 0.013;
        Float3 p = float3((float)i * 0.01f, 0.2f, 0.3f), v = wind_velocity(&def, p, time);

        // slopes: the noise's is 2 * 15/8 per lattice cell and direction
        Float3 later = wind_velocity(&def, p, time + 1e-3),
               there = wind_velocity(&def, float3(p.x + 1e-3f, p.y, p.z), time);
        assert_true(float3_length(float3_sub(later, v)) < 1.75f * 3.75f * 1.8f * 1e-3f / def.gust_time + 1e-4f);
        assert_true(float3_length(float3_sub(there, v)) < 1.75f * 3.75f * 1e-3f / def.gust_size + 1e-4f);
    }
}

/// The air of one source at the origin, whose axis is z.
static Float3 moved(SingeSourceKind kind, Float3 position, double time) {
    SingePoseKey key = {.rotation = {0, 0, 0, 1}};
    SingeValueKey strength[] = {{1, 0}, {2, 1}};
    Source source = {.generation = 1, .def = singe_default_source(), .path = {1, &key}, 2, strength};
    source.def.kind = kind;
    source.def.radius = 0.01f;
    source.def.speed = 8;
    source.def.direction[2] = 5; // its length does not matter
    return air_velocity(&(SourceList){1, 1, &source}, position, time);
}

// The jet has its speed at the nozzle, half of it at twice 11.6 radii, and half of that at its half-width there.
TEST(sources_move_air) {
    assert_true(moved(SINGE_SOURCE_JET, float3(0, 0, 0.05f), 2).z == 8);
    assert_true(fabsf(moved(SINGE_SOURCE_JET, float3(0, 0, 0.05f), 1.5).z - 4) < 1e-5f); // half of its strength
    assert_true(fabsf(moved(SINGE_SOURCE_JET, float3(0, 0, 0.232f), 2).z - 4) < 1e-3f);
    assert_true(fabsf(moved(SINGE_SOURCE_JET, float3(0, 0.232f * 0.096f, 0.232f), 2).z - 2) < 1e-3f);
    assert_true(moved(SINGE_SOURCE_JET, float3(0, 0, -0.001f), 2).z == 0);
    assert_true(moved(SINGE_SOURCE_JET, float3(0, 0, 0.05f), 0.5).z == 0);

    // fastest at the radius, and still at the axis or the point
    const Float3 turned = moved(SINGE_SOURCE_VORTEX, float3(0.01f, 0, 0.3f), 2);
    assert_true(fabsf(turned.y - 8) < 1e-4f && turned.x == 0 && turned.z == 0);
    assert_true(float3_length(moved(SINGE_SOURCE_VORTEX, float3(0, 0, 0.3f), 2)) == 0);
    assert_true(fabsf(moved(SINGE_SOURCE_ATTRACT, float3(0, 0, 0.01f), 2).z + 8) < 1e-4f);
    assert_true(fabsf(moved(SINGE_SOURCE_ATTRACT, float3(0, -0.03f, 0), 2).y - 4.8f) < 1e-4f);

    double square = 0;
    for (int i = 0; i < 1000; i++) {
        const Float3 u = moved(SINGE_SOURCE_TURBULENCE, float3(0.003f * (float)i, 0, 0), 2 + 0.01 * i);
        assert_true(fabsf(u.x) <= 8 && fabsf(u.y) <= 8 && fabsf(u.z) <= 8);
        square += (double)(u.x * u.x) / 1000;
    }

    assert_true(sqrt(square) > 1 && sqrt(square) < 5);
    assert_true(float3_length(moved(SINGE_SOURCE_WATER, float3(0, 0, 0.05f), 2)) == 0);
}
