// Value noise: its range, its smoothness, the same on every machine.
#include "support/support.h"

#include "common/random.h"

static float coordinate(uint32_t *random) {
    *random = *random * 1664525u + 1013904223u;
    return ((float)(*random >> 8) / 16777216.0f - 0.5f) * 200;
}

TEST(noise_fills_its_range) {
    uint32_t random = 3;
    double mean = 0;
    float min = 1, max = 0;

    for (int i = 0; i < 100000; i++) {
        float x = coordinate(&random), y = coordinate(&random), z = coordinate(&random);
        float n = random_noise(x, y, z, 7);
        assert_true(n >= 0 && n <= 1);
        mean += (double)n / 100000;
        min = fminf(min, n), max = fmaxf(max, n);
    }

    assert_true(fabs(mean - 0.5) < 0.01);
    assert_true(min < 0.05f && max > 0.95f);
}

TEST(fractal_noise_fills_its_range) {
    uint32_t random = 5;
    for (int octaves = 1; octaves <= 8; octaves++) {
        SingeNoise noise = {0.5f, octaves, 11};
        float min = 1, max = 0;
        for (int i = 0; i < 20000; i++) {
            float n = random_fractal(&noise, coordinate(&random), coordinate(&random), coordinate(&random));
            assert_true(n >= 0 && n <= 1);
            min = fminf(min, n), max = fmaxf(max, n);
        }

        assert_true(min < 0.1f && max > 0.9f);
    }
}

/// |n(x + e) - n(x)| <= e max|dn/dx|; the blend's slope is at most 15/8, corner values differ by at most 1.
TEST(noise_is_continuous) {
    uint32_t random = 9;
    const float e = 1.0f / 1024;
    for (int i = 0; i < 50000; i++) {
        float x = coordinate(&random), y = coordinate(&random), z = coordinate(&random);
        if (i % 3 == 0) x = floorf(x) - e / 2; // across the lattice
        float n = random_noise(x, y, z, 1);
        assert_true(fabsf(random_noise(x + e, y, z, 1) - n) <= 1.876f * e + 2e-5f);
        assert_true(fabsf(random_noise(x, y + e, z, 1) - n) <= 1.876f * e + 2e-5f);
        assert_true(fabsf(random_noise(x, y, z + e, 1) - n) <= 1.876f * e + 2e-5f);
    }
}

TEST(noise_has_the_hash_at_lattice_points) {
    for (int x = -3; x < 3; x++)
        for (int y = -3; y < 3; y++)
            assert_true(random_noise((float)x, (float)y, -2, 5) ==
                        random_unit(random_hash((uint32_t)x, (uint32_t)y, (uint32_t)-2, 5)));
}

/// Numbers noted once: they may not change, or saved scenes would.
TEST(hashes_are_those_noted_once) {
    assert_int_equal(random_hash(0, 0, 0, 0), 2456602052u);
    assert_int_equal(random_hash(1, 2, 3, 4), 2523784609u);
    assert_true(random_unit(UINT32_MAX) < 1);
    assert_true(random_unit(0) == 0);
}

TEST(seeds_differ) {
    int equal = 0;
    for (uint32_t seed = 0; seed < 1000; seed++)
        equal += random_noise(0.3f, 0.4f, 0.5f, seed) == random_noise(0.3f, 0.4f, 0.5f, seed + 1);
    assert_true(equal < 3);
}

TEST(any_coordinate_is_defined) {
    static const float coordinates[] = {1e9f, -1e9f, 3e9f, -3e9f, 1e20f, -1e38f, INFINITY, -INFINITY, NAN};
    for (size_t i = 0; i < sizeof coordinates / sizeof *coordinates; i++) {
        float n = random_noise(coordinates[i], 0.5f, coordinates[i], 1);
        assert_true(n >= 0 && n <= 1);
    }
}
