// Meshes and heights as colliders: distances against all triangles, signs against the solid angle, limits, what is
// refused, and what a distance costs.
#include "support/support.h"
#include "world/collider.h"
#include "solids.h"

static uint32_t random_state = 1;
static float any(float low, float high) {
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(random_state >> 8) / 16777216.0f;
}

static const SingePoseKey STILL = {0, {0, 0, 0}, {0, 0, 0, 1}};

static Collider make(Memory *memory, SingeColliderDef def) {
    Collider collider = {0};
    SingeError error = {0};
    def.path_count = 1, def.path = &STILL;
    if (collider_create(memory, &def, &collider, &error)) fail_msg("%s", error.message);
    return collider;
}

static Collider make_mesh(Memory *memory, const Triangles *mesh) { return make(memory, triangles_def(mesh)); }

// ---- meshes

/// Points all about, and points near the surface; returns how many were inside.
static int compare(const Triangles *mesh, const char *name, int count, float size) {
    Memory memory = memory_make((SingeAllocator){0});
    Collider collider = make_mesh(&memory, mesh);
    double worst = 0;
    int inside = 0;

    for (int k = 0; k < count; k++) {
        float p[3] = {any(-size, size), any(-size, size), any(-size, size)};
        if (k % 2) { // near a vertex
            const float *v = mesh->vertices + 3 * (size_t)(any(0, 0.999f) * (float)mesh->vertex_count);
            for (int i = 0; i < 3; i++) p[i] = v[i] + 0.05f * p[i] * any(0, 1);
        }

        double expected = triangles_distance(mesh, p);
        Float3 normal, at = float3_load(p);
        float found = collider_distance(&collider, at, INFINITY, &normal);
        inside += found < 0;
        worst = fmax(worst, fabs((double)found - expected));
        if (fabs((double)found - expected) > 1e-6 * (double)size)
            fail_msg("%s at (%g, %g, %g): %g, not %g", name, (double)p[0], (double)p[1], (double)p[2], (double)found,
                     expected);
        assert_true(fabsf(float3_length(normal) - 1) < 1e-4f);

        Float3 foot = float3_mad(at, normal, -found), other; // one distance along the normal lies on the surface
        if (fabsf(found) > 1e-4f * size)
            assert_true(fabsf(collider_distance(&collider, foot, INFINITY, &other)) < 1e-5f * size);

        float limit = any(0, 0.2f) * size, near = collider_distance(&collider, at, limit, &normal);
        if (found < limit) assert_true(near == found);
        else assert_true(near >= limit && near <= found * (1 + 1e-5f));
        float sign = collider_distance(&collider, at, 0, &normal);
        assert_true(sign < 0 ? found < 0 : found >= 0);
    }

    printf("%s: %u triangles, %.3g bytes each, %d of %d points inside, off by %.2g of its size\n", name,
           mesh->triangle_count, (double)memory.held / mesh->triangle_count, inside, count, worst / (double)size);
    collider_free(&memory, &collider);
    assert_int_equal(memory.held, 0);
    return inside;
}

TEST(distances_match_a_search_of_all_triangles) {
    Triangles mesh = triangles_sphere(24, 0.05f, 0);
    assert_true(compare(&mesh, "sphere", 1500, 0.1f) > 100);
    triangles_free(&mesh);
    mesh = triangles_sphere(32, 0.05f, 0.15f);
    assert_true(compare(&mesh, "rough sphere", 1500, 0.1f) > 100);
    triangles_free(&mesh);
    mesh = triangles_torus(48, 20, 0.05f, 0.02f);
    triangles_turn(&mesh, 0.7f, 0.01f, -0.02f, 0.005f);
    assert_true(compare(&mesh, "torus", 1500, 0.1f) > 100);
    triangles_free(&mesh);
    mesh = triangles_box(5, 0.1f, 0.06f, 0.0005f); // a plate half a millimetre thick
    triangles_turn(&mesh, 1.1f, 0, 0, 0);
    assert_true(compare(&mesh, "plate", 1500, 0.1f) > 0);
    triangles_free(&mesh);
    mesh = triangles_box(1, 0.1f, 0.06f, 0.04f);
    assert_true(compare(&mesh, "box", 1500, 0.1f) > 100);
    triangles_free(&mesh);
}

TEST(four_triangles_are_enough) {
    float vertices[] = {0, 0, 0, 0.1f, 0, 0, 0, 0.1f, 0, 0, 0, 0.1f};
    uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    Triangles mesh = {4, 4, vertices, triangles};
    assert_true(compare(&mesh, "tetrahedron", 800, 0.1f) > 5);
}

/// Every box of its tree would be near such a position.
TEST(impossible_positions_are_far) {
    OwnTriangles mesh = triangles_torus(24, 12, 0.1f, 0.04f);
    Memory memory = memory_make((SingeAllocator){0});
    Collider collider = make_mesh(&memory, &mesh);
    const float none[] = {NAN, INFINITY, -INFINITY};

    for (int k = 0; k < 27; k++) {
        float p[3] = {0.01f, 0.01f, 0.01f};
        p[k % 3] = none[k / 3 % 3];
        if (k >= 9) p[(k + 1) % 3] = none[k / 9];
        Float3 normal;
        assert_true(isinf(collider_distance(&collider, float3_load(p), INFINITY, &normal)));
        assert_true(isinf(collider_distance(&collider, float3_load(p), 0.01f, &normal)));
        assert_true(fabsf(float3_length(normal) - 1) < 1e-6f);
    }

    collider_free(&memory, &collider);
}

TEST(inside_out_is_turned) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnTriangles mesh = triangles_sphere(16, 0.05f, 0);
    Collider collider = make_mesh(&memory, &mesh);

    assert_false(collider.mesh.turned);
    collider_free(&memory, &collider);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        uint32_t *corner = mesh.triangles + 3 * (size_t)t, swap = corner[0];
        corner[0] = corner[1], corner[1] = swap;
    }

    collider = make_mesh(&memory, &mesh);
    Float3 normal;

    assert_true(collider.mesh.turned);
    assert_true(collider_distance(&collider, float3(0, 0, 0.02f), INFINITY, &normal) < 0);
    assert_true(collider_distance(&collider, float3(0, 0, 0.08f), INFINITY, &normal) > 0 && normal.z > 0.9f);
    collider_free(&memory, &collider);
}

typedef void Spoil(Triangles *mesh);
static void spoil_hole(Triangles *mesh) { // the last triangle away
    mesh->triangle_count--;
}
static void spoil_turned(Triangles *mesh) {
    uint32_t *corner = mesh->triangles + 3 * 17, swap = corner[0];
    corner[0] = corner[1], corner[1] = swap;
}
static void spoil_index(Triangles *mesh) { mesh->triangles[3 * 5 + 1] = mesh->vertex_count; }
static void spoil_number(Triangles *mesh) { mesh->vertices[3 * 3 + 2] = NAN; }
static void spoil_twice(Triangles *mesh) { memcpy(mesh->triangles + 3 * 9, mesh->triangles + 3 * 8, 12); }
static void spoil_flat(Triangles *mesh) { // three corners in a line
    const uint32_t *corner = mesh->triangles + 3 * 4;
    for (int i = 0; i < 3; i++)
        mesh->vertices[3 * (size_t)corner[0] + (size_t)i] =
            mesh->vertices[3 * (size_t)corner[1] + (size_t)i] +
            2 * (mesh->vertices[3 * (size_t)corner[2] + (size_t)i] - mesh->vertices[3 * (size_t)corner[1] + (size_t)i]);
}
static void spoil_few(Triangles *mesh) { mesh->triangle_count = 3; }
static void spoil_none(Triangles *mesh) { mesh->triangle_count = 0; }

TEST(bad_meshes_are_refused_by_number) {
    static const struct {
        Spoil *spoil;
        int64_t element; ///< -1: none; -2: any
        const char *word;
    } cases[] = {{spoil_hole, -2, "open"},      {spoil_turned, -2, "wrong way"},       {spoil_index, 5, "names vertex"},
                 {spoil_number, 3, "finite"},   {spoil_twice, 9, "triangles 8 and 9"}, {spoil_flat, 4, "no area"},
                 {spoil_few, -1, "at least 4"}, {spoil_none, -1, "at least 4"}};

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Memory memory = memory_make((SingeAllocator){0});
        OwnTriangles mesh = triangles_sphere(8, 0.0625f, 0);
        uint32_t count = mesh.triangle_count;

        if (cases[i].spoil == spoil_flat) mesh.vertices[3 * mesh.triangles[12] + 1] += 0; // exact positions there
        cases[i].spoil(&mesh);
        SingeColliderDef def = triangles_def(&mesh);
        def.path_count = 1, def.path = &STILL;

        Collider collider = {0};
        SingeError error = {0};
        SingeResult result = collider_create(&memory, &def, &collider, &error);
        if (result != SINGE_ERROR_MESH || !strstr(error.message, cases[i].word))
            fail_msg("case %zu: %d, \"%s\"", i, (int)result, error.message);

        assert_string_equal(error.stage, "collider");
        if (cases[i].element > -2) assert_int_equal(error.element, cases[i].element);
        else assert_true(error.element >= 0 && error.element < count);
        assert_int_equal(memory.held, 0);
    }
}

// ---- heights

static float hill(float x, float y) { return 0.01f * sinf(60 * x) * cosf(45 * y) + 0.1f * x; }

/// The top of a heightfield and far walls and a floor: closed, for the comparison near its surface.
static Triangles column(uint32_t columns, uint32_t rows, const float *heights, const float size[2], float floor_z) {
    uint32_t nodes = columns * rows;
    Triangles mesh = {.vertices = calloc(6 * (size_t)nodes, sizeof(float)),
                      .triangles = calloc(3 * (size_t)(4 * nodes + 4 * (columns + rows)), sizeof(uint32_t))};

    for (uint32_t k = 0; k < 2 * nodes; k++) {
        float *v = mesh.vertices + 3 * (size_t)k;
        v[0] = size[0] * ((float)(k % columns) / (float)(columns - 1) - 0.5f);
        v[1] = size[1] * ((float)(k % nodes / columns) / (float)(rows - 1) - 0.5f);
        v[2] = k < nodes ? heights[k] : floor_z;
    }

    uint32_t *t = mesh.triangles;
    for (uint32_t j = 0; j + 1 < rows; j++)
        for (uint32_t i = 0; i + 1 < columns; i++) {
            uint32_t a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
            const uint32_t new[12] = {a,         b,         c,         a,         c,         d,
                                      a + nodes, c + nodes, b + nodes, a + nodes, d + nodes, c + nodes};
            memcpy(t, new, sizeof new), t += 12;
        }

    for (uint32_t side = 0; side < 4; side++) {
        uint32_t count = side & 1 ? rows : columns, step = side & 1 ? columns : 1;
        uint32_t first = side == 1 ? columns - 1 : side == 2 ? nodes - columns : 0;
        for (uint32_t k = 0; k + 1 < count; k++) {
            uint32_t a = first + k * step, b = a + step;
            if (side >= 2) a = b, b = first + k * step;
            const uint32_t new[6] = {a, a + nodes, b + nodes, a, b + nodes, b};
            memcpy(t, new, sizeof new), t += 6;
        }
    }

    mesh.vertex_count = 2 * nodes, mesh.triangle_count = (uint32_t)((t - mesh.triangles) / 3);
    return mesh;
}

TEST(heights_match_their_triangles) {
    enum { COLUMNS = 31, ROWS = 22 };
    static float heights[COLUMNS * ROWS];
    const float size[2] = {0.2f, 0.14f};
    for (int k = 0; k < COLUMNS * ROWS; k++)
        heights[k] = hill(size[0] * ((float)(k % COLUMNS) / (COLUMNS - 1) - 0.5f),
                          size[1] * ((float)(k / COLUMNS) / (ROWS - 1) - 0.5f)) +
                     any(0, 0.002f);

    OwnTriangles mesh = column(COLUMNS, ROWS, heights, size, -1);
    SingeColliderDef def = singe_default_collider();
    def.kind = SINGE_COLLIDER_HEIGHTFIELD;
    def.columns = COLUMNS, def.rows = ROWS, def.heights = heights;
    memcpy(def.size, size, sizeof size);

    Memory memory = memory_make((SingeAllocator){0});
    Collider solid = make_mesh(&memory, &mesh); // is what it says it is
    collider_free(&memory, &solid);

    Collider collider = make(&memory, def);
    double worst = 0;
    int inside = 0;
    for (int k = 0; k < 3000; k++) {
        float p[3] = {any(-0.16f, 0.16f), any(-0.12f, 0.12f), 0}, off = k % 3 ? 0.002f : 0.06f;
        p[2] = hill(p[0], p[1]) + any(-off, off);
        double expected = triangles_distance(&mesh, p);
        Float3 normal, at = float3_load(p);
        float found = collider_distance(&collider, at, INFINITY, &normal);
        inside += found < 0;
        worst = fmax(worst, fabs((double)found - expected));
        if (fabs((double)found - expected) > 1e-6)
            fail_msg("at (%g, %g, %g): %g, not %g", (double)p[0], (double)p[1], (double)p[2], (double)found, expected);

        if (fabsf(found) > 1e-4f) {
            Float3 foot = float3_mad(at, normal, -found), other;
            float rest = collider_distance(&collider, foot, INFINITY, &other);
            if (fabsf(rest) > 1e-6f)
                fail_msg("at (%g, %g, %g): %g, and %g at the foot", (double)p[0], (double)p[1], (double)p[2],
                         (double)found, (double)rest);
        }

        float limit = any(0, 0.03f), near = collider_distance(&collider, at, limit, &normal);
        if (found < limit) assert_true(fabsf(near - found) < 1e-7f);
        else assert_true(near >= limit && near <= found * (1 + 1e-5f));
        assert_true((collider_distance(&collider, at, 0, &normal) < 0) == (found < 0));
    }

    printf("heights: %d of 3000 points inside, off by %.2g m\n", inside, worst);
    assert_true(inside > 500);
    collider_free(&memory, &collider);
    assert_int_equal(memory.held, 0);
}

TEST(bad_heights_are_refused) {
    float heights[6] = {0, 0, 0, 0, INFINITY, 0};
    Memory memory = memory_make((SingeAllocator){0});
    Collider collider = {0};
    SingeError error = {0};
    SingeColliderDef def = singe_default_collider();
    def.kind = SINGE_COLLIDER_HEIGHTFIELD, def.path_count = 1, def.path = &STILL;
    def.columns = 3, def.rows = 2, def.size[0] = def.size[1] = 0.1f;
    assert_int_equal(collider_create(&memory, &def, &collider, &error), SINGE_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "heights"));

    def.heights = heights;
    assert_int_equal(collider_create(&memory, &def, &collider, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(error.element, 4);
    heights[4] = 0;

    def.size[1] = 0;
    assert_int_equal(collider_create(&memory, &def, &collider, &error), SINGE_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "size"));
    def.size[1] = 0.1f, def.rows = 1;
    assert_int_equal(collider_create(&memory, &def, &collider, &error), SINGE_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "rows"));
    assert_int_equal(memory.held, 0);
}

// ---- cost

/// Nanoseconds for a distance at points up to `off` from the surface, with a limit of 2 mm.
static double cost(const Collider *collider, const Triangles *mesh, float off) {
    enum { COUNT = 10000 };
    static Float3 points[COUNT];
    for (int k = 0; k < COUNT; k++) {
        const uint32_t *t = mesh->triangles + 3 * (size_t)(any(0, 0.9999f) * (float)mesh->triangle_count);
        Float3 a = float3_load(mesh->vertices + 3 * (size_t)t[0]), b = float3_load(mesh->vertices + 3 * (size_t)t[1]);
        points[k] = float3_add(float3_mad(a, float3_sub(b, a), any(0, 1)),
                               float3(any(-off, off), any(-off, off), any(-off, off)));
    }

    float sum = 0;
    double best = INFINITY;
    for (int repeat = 0; repeat < 7; repeat++) {
        double start = test_seconds();
        Float3 normal;
        for (int k = 0; k < COUNT; k++) sum += collider_distance(collider, points[k], 0.002f, &normal) + normal.x;
        best = fmin(best, test_seconds() - start);
    }

    assert_true(isfinite(sum));
    return 1e9 * best / COUNT;
}

TEST(ten_thousand_triangles_are_quick) {
    Memory memory = memory_make((SingeAllocator){0});
    OwnTriangles mesh = triangles_torus(125, 40, 0.06f, 0.025f);
    double start = test_seconds();
    Collider collider = make_mesh(&memory, &mesh);
    start = test_seconds() - start;

    double touching = cost(&collider, &mesh, 0.0005f), near = cost(&collider, &mesh, 0.005f);
    double far = cost(&collider, &mesh, 0.05f);
    printf("%u triangles: %.0f ms to add, %.2f MB; ns a particle: %.0f within 0.5 mm, %.0f within 5 mm, %.0f within 50 "
           "mm\n",
           mesh.triangle_count, 1e3 * start, 1e-6 * (double)memory.held, touching, near, far);
    assert_true(memory.held < 10e6 && touching < 20000);
    collider_free(&memory, &collider);
}
