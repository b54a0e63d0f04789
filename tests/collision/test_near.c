// Distances against dense sampling, and sweeps against small steps.
#include "support/test.h"

#include "collision/feature_distance.h"
#include "shell/cross.h"

static uint32_t seed = 1;

static float uniform(void) {
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) * (1.0f / 16777216) * 2 - 1;
}

static Float4 point(float size) { return (Float4){size * uniform(), size * uniform(), size * uniform(), 0}; }

static float length(Float4 a) { return sqrtf(float4_dot(a, a)); }

TEST(triangles_are_as_far_as_samples_show) {
    enum { SPLITS = 60 };
    for (int trial = 0; trial < 2000; trial++) {
        Float4 p = point(1), a = point(1), b = point(1), c = point(1);
        if (trial % 7 == 0) c = a + 1e-4f * point(1); // a sliver

        float weight[3], min = INFINITY, got = length(feature_from_triangle(p, a, b, c, weight));
        assert_true(weight[0] > -1e-3f && weight[1] > -1e-3f && weight[2] > -1e-3f);

        for (int i = 0; i <= SPLITS; i++)
            for (int j = 0; i + j <= SPLITS; j++) {
                float u = (float)i / SPLITS, v = (float)j / SPLITS;
                min = fminf(min, length(p - ((1 - u - v) * a + u * b + v * c)));
            }
        assert_true(got <= min + 1e-3f && got >= min - 4.0f / SPLITS);
    }
}

TEST(segments_are_as_far_as_samples_show) {
    enum { SPLITS = 100 };
    for (int trial = 0; trial < 2000; trial++) {
        Float4 a = point(1), b = point(1), c = point(1), d = point(1);
        if (trial % 5 == 0) d = c + (b - a) * uniform(); // parallel
        if (trial % 11 == 0) b = a;                      // a point
        float s, t, min = INFINITY, got = length(feature_from_segment(a, b, c, d, &s, &t));
        for (int i = 0; i <= SPLITS; i++)
            for (int j = 0; j <= SPLITS; j++)
                min = fminf(min, length(a + (float)i / SPLITS * (b - a) - c - (float)j / SPLITS * (d - c)));
        assert_true(got <= min + 1e-3f && got >= min - 4.0f / SPLITS);
    }
}

/// Over a triangle that is 50 to 5,000 times as long as high, and edges that cross at 1 rad to 1e-4 rad, at a known
/// distance: found to 1e-6 of the length. With weights in float they are off by .24 and 2.5e-4.
TEST(slivers_have_a_distance) {
    float triangles = 0, edges = 0;
    for (int trial = 0; trial < 20000; trial++) {
        const float slim = powf(10, -2.7f + uniform()), far = 1e-3f * (1.1f + uniform()), u = 0.5f + 0.4f * uniform();
        Float4 along = point(1), side = point(1), normal = float4_cross(along, side);
        along = along / length(along), normal = normal / length(normal), side = float4_cross(normal, along);
        Float4 a = point(1), b = a + along, c = a + (0.5f + 0.4f * uniform()) * along + slim * side;
        Float4 p = a + u * (0.5f * (b - a) + 0.5f * (c - a)) + far * normal;
        float weight[3], s, t;
        triangles = fmaxf(triangles, fabsf(length(feature_from_triangle(p, a, b, c, weight)) - far));

        Float4 direction = along + powf(10, -2 + 2 * uniform()) * side, cross = 0.5f * (a + b) + far * normal;
        float got = length(feature_from_segment(a, b, cross - u * direction, cross + 0.4f * direction, &s, &t));
        edges = fmaxf(edges, fabsf(got - far));
    }

    print_message("off by %.2g over triangles, %.2g at edges\n", (double)triangles, (double)edges);
    assert_true(triangles < 1e-6f && edges < 1e-6f);
}

/// The time at which distance first falls below `near`, by small steps; 2 for never.
static float stepped(const FeatureSweep *sweep, float near) {
    enum { STEPS = 2000 };
    for (int k = 0; k <= STEPS; k++) {
        Float4 x[4];
        float s, t, weight[3], time = (float)k / STEPS;
        for (int i = 0; i < 4; i++) x[i] = sweep->position[i] + time * sweep->displacement[i];
        Float4 apart = sweep->edges ? feature_from_segment(x[0], x[1], x[2], x[3], &s, &t)
                                    : feature_from_triangle(x[0], x[1], x[2], x[3], weight);
        if (length(apart) < near) return time;
    }

    return 2;
}

TEST(sweeps_stop_in_time) {
    int met = 0, free_displacements = 0;
    for (int trial = 0; trial < 3000; trial++) {
        FeatureSweep sweep = {.edges = trial & 1};
        for (int i = 0; i < 4; i++) sweep.position[i] = point(1), sweep.displacement[i] = point(1.5f);
        if (stepped(&sweep, 0.05f) == 0) continue; // near from the start
        float hit = feature_sweep(&sweep, 0.01f, 0), first = stepped(&sweep, 0.01f);

        // never later than they are as near as the gap, and only if they come near at all
        if (first <= 1) assert_true(hit <= first);
        if (hit <= 1) assert_true(stepped(&sweep, 0.03f) <= 1);
        met += hit <= 1, free_displacements += hit > 1;
    }

    assert_true(met > 100 && free_displacements > 1000);
}

TEST(near_cells_may_only_separate) {
    FeatureSweep sweep = {.position = {{0, 0, 1e-3f, 0}, {-1, -1, 0, 0}, {1, -1, 0, 0}, {0, 1, 0, 0}}};
    sweep.displacement[0] = (Float4){0, 0, 1e-2f, 0};
    assert_true(feature_sweep(&sweep, 1e-3f, 0) > 1);
    sweep.displacement[0] = (Float4){0, 0, -1e-4f, 0};
    assert_true(feature_sweep(&sweep, 1e-3f, 0) == 0);
    sweep.displacement[0] = (Float4){0, 0, -1e-2f, 0}; // right through
    assert_true(feature_sweep(&sweep, 1e-3f, 0) == 0);
    for (int i = 0; i < 4; i++) sweep.displacement[i] = (Float4){5, 6, 7, 0}; // all together
    assert_true(feature_sweep(&sweep, 1e-3f, 1e-6f) > 1);
}

/// A point that came from afar and stops a few gaps away, where impacts leave it, is free; so is one that slides past.
TEST(fast_displacements_are_free) {
    const float gap = 1e-3f;
    FeatureSweep fall = {.position = {{0, 0, 0.3f, 0}, {-1, -1, 0, 0}, {1, -1, 0, 0}, {0, 1, 0, 0}}};
    fall.displacement[0] = (Float4){0, 0, -0.295f, 0};
    assert_true(feature_sweep(&fall, gap, 0) > 1);
    fall.displacement[0] = (Float4){0, 0, -0.305f, 0}; // and through
    float hit = feature_sweep(&fall, gap, 0);
    assert_true(hit <= 1 && hit * 0.305f < 0.299f && hit * 0.305f > 0.29f);

    FeatureSweep slide = {.position = {{-1, -5, 5e-3f, 0}, {1, -5, 5e-3f, 0}, {0, -1, 0, 0}, {0, 1, 0, 0}},
                          .edges = true};
    slide.displacement[0] = slide.displacement[1] = (Float4){0.1f, 10, 0, 0};
    assert_true(feature_sweep(&slide, gap, 0) > 1);
    slide.displacement[0][2] = slide.displacement[1][2] = -0.01f; // and through
    hit = feature_sweep(&slide, gap, 0);
    assert_true(hit <= 0.4f && hit > 0.3f);
}

/// The middle of four corners for a fifth node.
static void close_cell(Float4 node[5]) { node[4] = 0.25f * ((node[0] + node[1]) + (node[2] + node[3])); }

/// Whether edges of one cell pass through triangles of the other that have none of their nodes.
static bool cells_pierce(const Float4 a[5], const Float4 b[5], const unsigned shared[2]) {
    static const int edge[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
    for (int e = 0; e < 8; e++)
        for (int t = 0; t < 4; t++) {
            const int corner[3] = {t, (t + 1) & 3, 4};
            bool joined = false;
            for (int k = 0; k < 2; k++)
                for (int i = 0; i < 3; i++)
                    joined |= (shared[0] >> edge[e][k] & 1) && (shared[1] >> corner[i] & 1) &&
                              length(a[edge[e][k]] - b[corner[i]]) == 0;
            if (!joined && cross_pierces(a[edge[e][0]], a[edge[e][1]], b[corner[0]], b[corner[1]], b[corner[2]]))
                return true;
        }

    return false;
}

/// Cells that are proven apart do not cross: two cells at a side, and two at a corner with one between that shares a
/// side with each, bent and sheared at random.
TEST(cells_proven_apart_do_not_cross) {
    int level[2] = {0}, parted[2] = {0}, crossed[2] = {0};
    for (int trial = 0; trial < 200000; trial++) {
        Float4 grid[3][3], cell[3][5];
        const float bend = 0.2f + 0.4f * (float)(trial % 4);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) grid[i][j] = (Float4){(float)i, (float)j, 0, 0} + point(bend);

        for (int c = 0; c < 3; c++) { // at the corner 1, 1: below to the left, to the right of that, above that
            const int x = c > 0, y = c > 1;
            cell[c][0] = grid[x][y], cell[c][1] = grid[x + 1][y], cell[c][2] = grid[x + 1][y + 1];
            cell[c][3] = grid[x][y + 1];
            close_cell(cell[c]);
        }

        Float4 normals[3], normal;
        for (int c = 0; c < 3; c++) normals[c] = feature_normals(cell[c]);

        const unsigned side[2] = {2 | 4, 1 | 8}, corner[2] = {4, 1};
        for (int kind = 0; kind < 2; kind++) {
            const Float4 *a = cell[0], *b = cell[kind ? 2 : 1];
            const unsigned *shared = kind ? corner : side;
            bool crosses = cells_pierce(a, b, shared) || cells_pierce(b, a, (const unsigned[2]){shared[1], shared[0]});
            bool within = kind ? feature_is_within(normals[0], normals[1], FEATURE_CONE_CORNER) &&
                                     feature_is_within(normals[2], normals[1], FEATURE_CONE_CORNER)
                               : feature_is_within(normals[0], normals[1], FEATURE_CONE_SIDE);
            bool part = feature_is_separated(a, b, shared, 5e-3f, &normal);
            assert_false(crosses && (within || part));
            level[kind] += within, parted[kind] += part, crossed[kind] += crosses;
        }
    }

    print_message("level %d and %d, parted %d and %d, crossed %d and %d\n", level[0], level[1], parted[0], parted[1],
                  crossed[0], crossed[1]);
    assert_true(level[0] > 1000 && level[1] > 100 && parted[0] > 10000 && parted[1] > 10000);
    assert_true(crossed[0] > 10000 && crossed[1] > 10000);
}
