// Rays against triangles, compared with a search through all of them.
#include "common/allocator.h"
#include "preview/bvh_packets.h"
#include "preview/noise_cell.h"
#include "support/test.h"

enum { SOUP = 700, PACKETS = 60, GRID = 20 };

typedef float Corner[3];
typedef struct Soup {
    Corner ends[2][3 * SOUP]; ///< corners when the exposure begins and ends
    uint32_t triangles[SOUP][3];
} Soup;

static float chance(void) { return (float)rand() / (float)RAND_MAX; }

static Soup *soup_make(void) {
    Soup *soup = malloc(sizeof *soup);
    srand(7);
    for (int t = 0; t < SOUP; t++) {
        const float middle[3] = {chance(), chance(), chance()};
        for (int c = 0; c < 3; c++) {
            soup->triangles[t][c] = (uint32_t)(3 * t + c);
            for (int k = 0; k < 3; k++) {
                soup->ends[0][3 * t + c][k] = middle[k] + 0.2f * chance();
                soup->ends[1][3 * t + c][k] = soup->ends[0][3 * t + c][k] + 0.1f * chance();
            }
        }
    }
    return soup;
}

static BvhMesh soup_mesh(const Soup *soup, bool moves) {
    return (BvhMesh){.positions = {soup->ends[0][0], soup->ends[moves ? 1 : 0][0]},
                     .stride = 3,
                     .triangles = soup->triangles,
                     .triangle_count = SOUP,
                     .threads = moves ? 3 : 1};
}

/// Rays from outside through the middle; one lane in five rests.
static void random_rays(Rays *rays) {
    for (int i = 0; i < LANES; i++) {
        const Float3 from = float3(4 * chance() - 2, 4 * chance() - 2, -1);
        const Float3 to = float3_sub(float3(chance(), chance(), chance()), from);
        if (i % 5 == 4) rest_ray(rays, i);
        else aim_ray(rays, i, from, float3_scale(to, 1 / float3_length(to)), 0, 10, chance());
    }
}

/// Distance to a triangle, or infinity, in double precision (Möller and Trumbore 1997).
static double distance_to(const Soup *soup, bool moves, int triangle, const Rays *rays, int lane) {
    double p[3][3], e[2][3], d[3], h[3], s[3], q[3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            const double from = soup->ends[0][3 * triangle + c][k], to = soup->ends[moves ? 1 : 0][3 * triangle + c][k];
            p[c][k] = from + rays->time[lane] * (to - from);
        }
    for (int k = 0; k < 3; k++) {
        e[0][k] = p[1][k] - p[0][k];
        e[1][k] = p[2][k] - p[0][k];
        d[k] = rays->direction[k][lane];
        s[k] = rays->origin[k][lane] - p[0][k];
    }
    double a = 0, u = 0, v = 0, t = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        h[k] = d[i] * e[1][j] - d[j] * e[1][i];
        q[k] = s[i] * e[0][j] - s[j] * e[0][i];
    }
    for (int k = 0; k < 3; k++) {
        a += e[0][k] * h[k];
        u += s[k] * h[k];
        v += d[k] * q[k];
        t += e[1][k] * q[k];
    }
    u /= a, v /= a, t /= a;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : INFINITY;
}

/// Nearest hits by a search; returns how many lanes meet something.
static int expect_nearest(const Soup *soup, bool moves, const Bvh *bvh) {
    int met = 0;
    for (int packet = 0; packet < PACKETS; packet++) {
        Rays rays;
        Hits hits;
        random_rays(&rays);
        const Rays asked = rays;
        bvh_nearest(bvh, &rays, &hits);
        for (int i = 0; i < LANES; i++) {
            double nearest = INFINITY;
            for (int t = 0; t < SOUP && asked.far[i] >= 0; t++)
                nearest = fmin(nearest, distance_to(soup, moves, t, &asked, i));
            assert_int_equal(hits.triangle[i] != BVH_NONE, isfinite(nearest));
            if (!isfinite(nearest)) continue;
            met++;
            assert_true(fabs(rays.far[i] - nearest) < 1e-5);
            assert_true(fabs(distance_to(soup, moves, (int)hits.triangle[i], &asked, i) - nearest) < 1e-5);
        }
    }
    return met;
}

TEST(the_nearest_of_all_triangles_is_found) {
    Soup *soup = soup_make();
    Bvh bvh = {0};
    for (int moves = 0; moves < 2; moves++) {
        BvhMesh mesh = soup_mesh(soup, moves);
        assert_true(bvh_build(&bvh, (SingeAllocator){0}, &mesh));
        const int met = expect_nearest(soup, moves, &bvh);
        assert_in_range(met, PACKETS * LANES / 3, PACKETS * LANES * 4 / 5 - 1); // neither none nor all
    }
    bvh_free(&bvh, (SingeAllocator){0});
    free(soup);
}

static bool count_and_go_on(void *context, int lane, uint32_t triangle, float u, float v) {
    (void)triangle, (void)u, (void)v;
    ((int *)context)[lane]++;
    return false;
}

static bool stop_at_second(void *context, int lane, uint32_t triangle, float u, float v) {
    (void)triangle, (void)u, (void)v;
    return ++((int *)context)[lane] == 2;
}

TEST(rays_pass_all_triangles_until_one_stops_them) {
    Soup *soup = soup_make();
    Bvh bvh = {0};
    BvhMesh mesh = soup_mesh(soup, true);
    assert_true(bvh_build(&bvh, (SingeAllocator){0}, &mesh));
    int stopped = 0;
    for (int packet = 0; packet < PACKETS; packet++) {
        Rays all, some;
        int passed[LANES] = {0}, seen[LANES] = {0};
        random_rays(&all);
        some = all;
        const Rays asked = all;
        bvh_pass(&bvh, &all, count_and_go_on, passed);
        bvh_pass(&bvh, &some, stop_at_second, seen);
        assert_memory_equal(&all, &asked, sizeof all);
        for (int i = 0; i < LANES; i++) {
            int expected = 0;
            for (int t = 0; t < SOUP && asked.far[i] >= 0; t++)
                expected += isfinite(distance_to(soup, true, t, &asked, i));
            assert_int_equal(passed[i], expected);
            assert_int_equal(seen[i], expected < 2 ? expected : 2);
            assert_true(some.far[i] == (expected < 2 ? asked.far[i] : -1));
            stopped += expected >= 2;
        }
    }
    assert_true(stopped > PACKETS);
    bvh_free(&bvh, (SingeAllocator){0});
    free(soup);
}

/// A wavy grid with rays straight at its vertices and the middles of its edges: edges tested triangle by triangle leave
/// holes there.
TEST(no_ray_slips_through_an_edge) {
    Corner positions[(GRID + 1) * (GRID + 1)];
    uint32_t triangles[2 * GRID * GRID][3];
    for (int y = 0; y <= GRID; y++)
        for (int x = 0; x <= GRID; x++) {
            float *p = positions[y * (GRID + 1) + x];
            p[0] = 0.1f * (float)x + 0.01f * sinf((float)(3 * y));
            p[1] = 0.1f * (float)y + 0.01f * sinf((float)(5 * x));
            p[2] = 0.1f * sinf((float)x) * cosf((float)y);
        }
    for (uint32_t k = 0; k < GRID * GRID; k++) {
        const uint32_t a = k / GRID * (GRID + 1) + k % GRID, b = a + 1, c = a + GRID + 1, d = c + 1;
        memcpy(triangles[2 * k], (uint32_t[3]){a, b, d}, sizeof *triangles);
        memcpy(triangles[2 * k + 1], (uint32_t[3]){a, d, c}, sizeof *triangles);
    }

    Bvh bvh = {0};
    BvhMesh mesh = {{positions[0], positions[0]}, 3, triangles, 2 * GRID * GRID, 1};
    assert_true(bvh_build(&bvh, (SingeAllocator){0}, &mesh));
    const Float3 eye = float3(0.3f, 0.7f, 2);
    for (int y = 1; y + 1 < GRID; y++)
        for (int x = 1; x + 1 < GRID; x++)
            for (int kind = 0; kind < 4; kind++) {
                const int from = y * (GRID + 1) + x, to = from + (const int[]){0, 1, GRID + 1, GRID + 2}[kind];
                const Float3 p = float3_load(positions[from]), q = float3_load(positions[to]);
                const Float3 way = float3_sub(float3_scale(float3_add(p, q), 0.5f), eye);
                Rays rays;
                Hits hits;
                for (int i = 0; i < LANES; i++) rest_ray(&rays, i);
                aim_ray(&rays, 5, eye, way, 0, 2, 0);
                bvh_nearest(&bvh, &rays, &hits);
                assert_true(hits.triangle[5] != BVH_NONE);
                assert_true(fabsf(rays.far[5] - 1) < 1e-5f);
            }
    bvh_free(&bvh, (SingeAllocator){0});
}

TEST(instruction_sets_find_the_same_bytes) {
    static const SingeInstructions sets[] = {SINGE_INSTRUCTIONS_PLAIN, SINGE_INSTRUCTIONS_X86_V3};
    Soup *soup = soup_make();
    Bvh bvh = {0};
    BvhMesh mesh = soup_mesh(soup, true);
    assert_true(bvh_build(&bvh, (SingeAllocator){0}, &mesh));
    for (int packet = 0; packet < PACKETS; packet++) {
        Rays asked, best;
        Hits hits[2];
        memset(hits, 0, sizeof hits);
        random_rays(&asked);
        best = asked;
        bvh_nearest(&bvh, &best, &hits[0]);
        for (int set = 0; set < 2; set++) {
            if (!bvh_walk(sets[set])) continue;
            Rays rays = asked;
            for (int i = 0; i < LANES; i++) hits[1].triangle[i] = BVH_NONE;
            bvh_walk(sets[set])(&bvh, &(BvhQuery){.rays = &rays, .hits = &hits[1]});
            assert_memory_equal(&rays, &best, sizeof best);
            assert_memory_equal(&hits[1], &hits[0], sizeof *hits);
        }
    }
    bvh_free(&bvh, (SingeAllocator){0});
    free(soup);
}

/// Triangles that no plane parts, one, and none.
TEST(meshes_of_any_kind_are_built) {
    enum { SAME = 1000 };
    const Corner positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static uint32_t triangles[SAME][3];
    for (int t = 0; t < SAME; t++) memcpy(triangles[t], (uint32_t[3]){0, 1, 2}, sizeof *triangles);

    Bvh bvh = {0};
    for (int kind = 0; kind < 3; kind++) {
        const uint32_t count = (const uint32_t[]){SAME, 1, 0}[kind];
        BvhMesh mesh = {{positions[0], positions[0]}, 3, (const uint32_t(*)[3])triangles, count, 2};
        assert_true(bvh_build(&bvh, (SingeAllocator){0}, &mesh));
        Rays rays;
        int passed[LANES] = {0};
        for (int i = 0; i < LANES; i++) aim_ray(&rays, i, float3(0.2f, 0.2f, 1), float3(0, 0, -1), 0, 2, 0);
        bvh_pass(&bvh, &rays, count_and_go_on, passed);
        for (int i = 0; i < LANES; i++) assert_int_equal(passed[i], count);
    }
    bvh_free(&bvh, (SingeAllocator){0});
}

static int allocations_left, blocks;

static void *few(void *context, void *block, size_t old_size, size_t new_size) {
    (void)context, (void)old_size;
    if (new_size && allocations_left-- <= 0) return NULL;
    blocks += (new_size != 0) - (block != NULL);
    return allocator_libc(NULL, block, 0, new_size);
}

TEST(without_memory_it_stays_empty) {
    Soup *soup = soup_make();
    BvhMesh mesh = soup_mesh(soup, true);
    SingeAllocator allocator = {few, NULL};
    Bvh bvh = {0};
    int tries = 0;
    do {
        assert_int_equal(bvh.triangle_count, 0);
        allocations_left = tries++;
    } while (!bvh_build(&bvh, allocator, &mesh));
    assert_int_equal(tries, 6); // five blocks: two while it is built
    bvh_free(&bvh, allocator);
    assert_int_equal(blocks, 0);
    free(soup);
}

/// What the facets of crumpled paper are found by, on any machine.
TEST(cells_are_the_same_for_each_instruction_set) {
    for (uint32_t k = 0; k < 4000; k++) {
        const Float3 p = {100 * hash_unit(3 * k) - 50, 100 * hash_unit(3 * k + 1) - 50,
                          100 * hash_unit(3 * k + 2) - 50};
        uint32_t plain, best, other;
        const float wall = noise_cell_plain(p, k % 64, &plain);
        assert_true(noise_cell_best()(p, k % 64, &best) == wall && best == plain);
        noise_cell_plain(p, k % 64 + 1, &other);
        assert_int_not_equal(other, plain);
    }
}
