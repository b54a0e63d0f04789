// Colliders whose vertices move and pins that follow positions: a character whose cape burns.
#include "scenes.h"

static const float TOP = 0.1f;

/// A box of triangles, its faces divided in n by n.
typedef struct Block {
    float vertices[6 * 36][3];
    uint32_t triangles[6 * 50][3];
    uint32_t vertex_count, triangle_count;
} Block;

static void block_make(Block *block, const float half[3], const float centre[3]) {
    enum { N = 5 };
    *block = (Block){0};
    for (int face = 0; face < 6; face++) {
        int d = face / 2, e = (d + 1) % 3, f = (d + 2) % 3;
        float side = face & 1 ? 1 : -1;
        uint32_t first = block->vertex_count;

        for (int j = 0; j <= N; j++)
            for (int i = 0; i <= N; i++) {
                float *v = block->vertices[block->vertex_count++];
                v[d] = centre[d] + side * half[d];
                v[e] = centre[e] + half[e] * (2 * (float)i / N - 1);
                v[f] = centre[f] + half[f] * (2 * (float)j / N - 1);
            }

        for (uint32_t j = 0; j < N; j++)
            for (uint32_t i = 0; i < N; i++) {
                uint32_t a = first + j * (N + 1) + i, b = a + 1, c = a + N + 2, d4 = a + N + 1;
                uint32_t two[2][3] = {{a, b, c}, {a, c, d4}}, back[2][3] = {{a, c, b}, {a, d4, c}};
                memcpy(block->triangles[block->triangle_count], side > 0 ? two : back, sizeof two);
                block->triangle_count += 2;
            }
    }
}

static SingeColliderDef block_def(const Block *block, SingeColliderKind kind) {
    SingeColliderDef def = singe_default_collider();
    def.kind = kind;
    def.vertex_count = block->vertex_count, def.vertices = block->vertices[0];
    def.triangle_count = block->triangle_count, def.triangles = block->triangles[0];
    return def;
}

static SingeSimDef quiet(void) {
    SingeSimDef def = singe_default_sim();
    def.contact.enabled = true;
    return def;
}

/// A sheet of 10 cm over the origin at this height.
static SingeSim *sheet_at(const SingeSimDef *def, float height) {
    TestMesh mesh = test_grid(20, 20, 0.005f, 0.005f);
    test_mesh_move(&mesh, -0.05f, -0.05f, height);
    return test_sim(def, mesh, NULL);
}

static void shifted(const Block *block, float dx, float dy, float dz, float out[][3]) {
    for (uint32_t v = 0; v < block->vertex_count; v++) {
        out[v][0] = block->vertices[v][0] + dx, out[v][1] = block->vertices[v][1] + dy;
        out[v][2] = block->vertices[v][2] + dz;
    }
}

static double mean_of(SingeSim *sim, int axis) {
    SingeView view = singe_sim_view(sim);
    double sum = 0;
    for (uint32_t v = 0; v < view.vertex_count; v++) sum += (double)view.position[v][axis];
    return sum / view.vertex_count;
}

/// Unmoved, a deforming collider acts as a mesh; moved as a whole, as a mesh on a path: sheets ride on both alike.
TEST(moved_as_a_whole_it_is_a_mesh_on_a_path) {
    const float half[3] = {0.08f, 0.08f, 0.02f}, centre[3] = {0, 0, TOP - 0.02f};
    Block block;
    block_make(&block, half, centre);

    SingeSimDef def = quiet();
    SingeSim *sims[2];
    SingeColliderId ids[2];
    const double frame = 1.0 / 48;

    for (int k = 0; k < 2; k++) {
        sims[k] = sheet_at(&def, TOP + 0.003f);
        SingeColliderDef collider = block_def(&block, k ? SINGE_COLLIDER_DEFORMING : SINGE_COLLIDER_MESH);

        // up and to the side, so that friction counts
        SingePoseKey path[2] = {test_key(0.25f, 0, 0, 0), test_key(0.75f, 0.05f, 0, 0.05f)};
        if (k == 0) collider.path_count = 2, collider.path = path;
        test_ok(sims[k], singe_sim_add_collider(sims[k], &collider, &ids[k]));
    }

    double worst = 0;
    for (int f = 0; f < 48; f++) {
        float to[6 * 36][3];
        double end = (f + 1) * frame, way = fmin(fmax((end - 0.25) / 0.5, 0), 1) * 0.05;
        shifted(&block, (float)way, 0, (float)way, to);
        test_ok(sims[1], singe_sim_set_collider_vertices(sims[1], ids[1], to[0], end));
        for (int k = 0; k < 2; k++) test_steps(sims[k], 10);
        SingeView a = singe_sim_view(sims[0]), b = singe_sim_view(sims[1]);
        for (uint32_t v = 0; v < a.vertex_count; v++)
            for (int i = 0; i < 3; i++) worst = fmax(worst, fabs((double)(a.position[v][i] - b.position[v][i])));
    }

    print_message("carried to x %.4f, z %.4f; at most %.2g m from the rigid one\n", mean_of(sims[1], 0),
                  mean_of(sims[1], 2), worst);
    assert_true(mean_of(sims[1], 0) > 0.045 && fabs(mean_of(sims[1], 2) - 0.15) < 0.004);
    assert_true(worst < 1e-3);
    assert_true(singe_sim_timers(sims[1]).contacts > 1000);
    singe_sim_destroy(sims[0]);
    singe_sim_destroy(sims[1]);
}

/// A thin plate that is swept through a hanging sheet takes it along, however fast it is; put there at once, it does
/// not.
static void sweep(double speed, bool at_once, double *behind, double *ahead) {
    const float half[3] = {0.002f, 0.15f, 0.15f}, centre[3] = {-0.1f, 0, 0};
    Block block;
    block_make(&block, half, centre);
    SingeSimDef def = quiet();
    def.gravity[2] = 0;
    def.time_step = 1.0f / 480;

    TestMesh mesh = test_grid(20, 20, 0.005f, 0.005f);
    test_mesh_raise(&mesh);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) { // in the plane x = 0
        float *p = mesh.positions + 3 * (size_t)v, x = p[0];
        p[0] = p[1], p[1] = x - 0.05f, p[2] -= 0.05f;
    }

    OwnSim *sim = test_sim(&def, mesh, NULL);
    SingeColliderDef collider = block_def(&block, SINGE_COLLIDER_DEFORMING);
    SingeColliderId id = test_add_collider(sim, &collider);
    const double end = 0.2 / speed; // to x = 0.1
    float to[6 * 36][3];
    shifted(&block, 0.2f, 0, 0, to);
    test_ok(sim, singe_sim_set_collider_vertices(sim, id, to[0], at_once ? 0 : end));
    test_steps(sim, (int)ceil(end * 480) + 2);

    SingeView view = singe_sim_view(sim);
    *behind = INFINITY, *ahead = -INFINITY;
    for (uint32_t v = 0; v < view.vertex_count; v++) {
        *behind = fmin(*behind, (double)view.position[v][0]);
        *ahead = fmax(*ahead, (double)view.position[v][0]);
    }
}

TEST(nothing_passes_a_thin_plate) {
    static const double speeds[] = {0.5, 5, 20, 60};
    for (size_t k = 0; k < sizeof speeds / sizeof *speeds; k++) {
        double behind, ahead;
        sweep(speeds[k], false, &behind, &ahead);
        print_message("at %g m/s the sheet is from x = %.4f on\n", speeds[k], behind);
        assert_true(behind > 0.1); // its front ended at 0.102
        sweep(speeds[k], true, &behind, &ahead);
        assert_true(ahead < 0.05);
    }
}

/// A block that swells lifts what lies on it; its top moves, its bottom does not.
TEST(a_swelling_block_lifts) {
    const float half[3] = {0.08f, 0.08f, 0.05f}, centre[3] = {0, 0, TOP - 0.05f};
    Block block;
    block_make(&block, half, centre);

    SingeSimDef def = quiet();
    OwnSim *sim = sheet_at(&def, TOP + 0.002f);
    SingeColliderDef collider = block_def(&block, SINGE_COLLIDER_DEFORMING);
    SingeColliderId id = test_add_collider(sim, &collider);
    test_steps(sim, 120);

    float to[6 * 36][3];
    shifted(&block, 0, 0, 0, to);
    for (uint32_t v = 0; v < block.vertex_count; v++)
        if (to[v][2] > TOP - 1e-4f) to[v][2] += 0.04f;
    test_ok(sim, singe_sim_set_collider_vertices(sim, id, to[0], 0.5));

    test_steps(sim, 120);
    assert_true(fabs(mean_of(sim, 2) - (double)TOP - 0.04) < 0.003);
    test_steps(sim, 120); // and it stays
    assert_true(fabs(mean_of(sim, 2) - (double)TOP - 0.04) < 0.002);
}

/// Two corners go round; frame by frame they are where they were set.
static void round_trip(SingeSim *sim, SingePinId pin, SingeColliderId body, const Block *block, int first, int last) {
    for (int f = first; f < last; f++) {
        const double end = (f + 1) / 48.0;
        float to[2][3], moved[6 * 36][3];
        for (int k = 0; k < 2; k++) {
            float angle = 3 * (float)end;
            to[k][0] = (k ? 0.05f : -0.05f) * cosf(angle), to[k][1] = (k ? 0.05f : -0.05f) * sinf(angle);
            to[k][2] = 0.2f + 0.1f * (float)end;
        }

        test_ok(sim, singe_sim_set_pin_positions(sim, pin, to[0], end));
        shifted(block, 0.02f * sinf(8 * (float)end), 0, 0, moved);
        test_ok(sim, singe_sim_set_collider_vertices(sim, body, moved[0], end));
        test_steps(sim, 10);
        if (first) continue;

        SingeView view = singe_sim_view(sim);
        uint32_t count;
        const uint32_t *held = singe_sim_pin_particles(sim, pin, &count);

        assert_int_equal(count, 2);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < 3; i++) assert_true(fabsf(view.position[held[k]][i] - to[k][i]) < 1e-5f);
        assert_true(fabsf(view.velocity[held[0]][2] - 0.1f) < 0.02f || f == 0);
    }
}

static SingeSim *cape(const SingeSimDef *def, SingePinId *pin, SingeColliderId *body, Block *block) {
    const float half[3] = {0.03f, 0.03f, 0.08f}, centre[3] = {0, 0, 0.05f};
    block_make(block, half, centre);

    SingeSim *sim = test_create(def);
    OwnTestMesh mesh = test_grid(16, 16, 0.1f / 16, 0.1f / 16);
    test_mesh_move(&mesh, -0.05f, 0, 0.2f);
    SingeSheetDef sheet_def = test_sheet(&mesh);
    sheet_def.material = scene_quick_material();
    SingeSheetId sheet = test_add_sheet(sim, &sheet_def);

    const uint32_t corners[2] = {0, 16};
    SingePinDef pin_def = singe_default_pin();
    pin_def.sheet = sheet, pin_def.vertex_count = 2, pin_def.vertices = corners;
    test_ok(sim, singe_sim_add_pin(sim, &pin_def, pin));

    SingeColliderDef collider = block_def(block, SINGE_COLLIDER_DEFORMING);
    collider.conductance = 20, collider.temperature = 350;
    test_ok(sim, singe_sim_add_collider(sim, &collider, body));
    test_ok(sim, singe_sim_commit(sim));
    test_spot(sim, 0.05f, 0.1f, 0.2f, 0.02f, 1200, 800);
    return sim;
}

TEST(pins_follow_and_runs_resume) {
    SingeSimDef def = quiet();
    SingePinId pin;
    SingeColliderId body;
    Block block;
    SingeSim *sim = cape(&def, &pin, &body, &block), *threads;

    round_trip(sim, pin, body, &block, 0, 12);

    // any number of threads
    def.thread_count = 2;
    threads = cape(&def, &pin, &body, &block);
    round_trip(threads, pin, body, &block, 0, 12);
    test_assert_same(sim, threads);

    // a load in the middle of a frame
    float to[2][3] = {{-0.02f, 0, 0.2f}, {0.03f, 0, 0.25f}};
    test_ok(sim, singe_sim_set_pin_positions(sim, pin, to[0], 13 / 48.0));
    float moved[6 * 36][3];
    shifted(&block, 0.03f, 0.01f, 0, moved);
    test_ok(sim, singe_sim_set_collider_vertices(sim, body, moved[0], 13 / 48.0));
    test_steps(sim, 4);

    OwnTestBytes bytes = test_save(sim);
    SingeSimDef hooks = singe_default_sim();
    SingeError error = {0};
    OwnSim *resumed = test_load(NULL, &bytes);
    test_assert_same(sim, resumed);

    test_steps_alike(sim, resumed, 6);
    round_trip(sim, pin, body, &block, 13, 20);
    round_trip(resumed, pin, body, &block, 13, 20);
    test_assert_same(sim, resumed);

    SingeStats stats = singe_sim_stats(sim);
    assert_true(stats.burnt_fraction > 0.001 && singe_sim_timers(sim).contacts > 50);
    print_message("%.3f burnt, %u contacts\n", stats.burnt_fraction, (unsigned)singe_sim_timers(sim).contacts);

    // every truncation is refused
    for (size_t k = 0; k < 60; k++) {
        SingeSim *cut;
        assert_int_not_equal(singe_sim_load(&hooks, bytes.data, bytes.size - 1 - 7 * k, &cut, &error), SINGE_OK);
        assert_null(cut);
    }

    // a path again
    SingePoseKey still = test_key(0, 0, 0, 0);
    uint32_t count, corner = singe_sim_pin_particles(sim, pin, &count)[0];
    float before = singe_sim_view(sim).position[corner][2];

    test_ok(sim, singe_sim_move_pin(sim, pin, 1, &still));
    test_steps(sim, 3);
    assert_true(fabsf(singe_sim_view(sim).position[corner][2] - before) < 1e-6f);
    singe_sim_destroy(threads);
    singe_sim_destroy(sim);
}

TEST(bad_positions_are_refused) {
    SingeSimDef def = quiet();
    SingePinId pin;
    SingeColliderId body, box;
    Block block;
    OwnSim *sim = cape(&def, &pin, &body, &block), *twin = cape(&def, &pin, &body, &block);
    SingeColliderDef rigid = singe_default_collider();
    rigid.kind = SINGE_COLLIDER_SPHERE;
    rigid.position[2] = -5;
    test_ok(sim, singe_sim_add_collider(sim, &rigid, &box));
    test_ok(twin, singe_sim_add_collider(twin, &rigid, &box));

    float to[2][3] = {{0, 0, 0}, {0, NAN, 0}}, moved[6 * 36][3];
    shifted(&block, 0, 0, 0, moved);
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_pin_positions(sim, pin, to[0], 1));
    assert_int_equal(singe_sim_error(sim)->element, 1);
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_pin_positions(sim, pin, NULL, 1));

    to[1][1] = 0;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_pin_positions(sim, pin, to[0], (double)NAN));
    test_refused(sim, SINGE_ERROR_HANDLE, singe_sim_set_pin_positions(sim, (SingePinId){4, 4}, to[0], 1));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_collider_vertices(sim, box, moved[0], 1));
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_collider_vertices(sim, body, moved[0], INFINITY));
    moved[17][2] = 2e4f;
    test_refused(sim, SINGE_ERROR_ARGUMENT, singe_sim_set_collider_vertices(sim, body, moved[0], 1));
    assert_int_equal(singe_sim_error(sim)->element, 17);

    uint32_t count = 5;
    assert_null(singe_sim_pin_particles(sim, (SingePinId){9, 9}, &count));
    assert_int_equal(count, 0);

    SingeColliderDef open = block_def(&block, SINGE_COLLIDER_DEFORMING);
    open.triangle_count--;
    test_refused(sim, SINGE_ERROR_MESH, singe_sim_add_collider(sim, &open, &box));
    test_steps_alike(sim, twin, 20);
}

/// Makes a simulation of the block alone.
static SingeResult with_block(const SingeSimDef *def, const Block *block, SingeSim **sim) {
    const SingeColliderDef collider = block_def(block, SINGE_COLLIDER_DEFORMING);
    SingeColliderId id;
    SingeResult result = singe_sim_create(def, sim, NULL);
    if (!result) result = singe_sim_add_collider(*sim, &collider, &id);
    if (result) singe_sim_destroy(*sim);
    return result;
}

/// A mesh that collapses to a plane, to a line and to a point on its way leaves numbers finite; nothing is allocated. Every
/// allocation of such a collider fails once.
TEST(a_mesh_may_collapse) {
    TestAllocator hook = {0};
    SingeSimDef def = quiet();
    def.allocator = test_allocator(&hook);

    SingePinId pin;
    SingeColliderId body;
    Block block;
    SingeSim *sim = cape(&def, &pin, &body, &block);
    long calls = hook.calls;

    for (int axis = 0; axis < 4; axis++) {
        float to[6 * 36][3];
        shifted(&block, 0, 0, 0.1f, to);
        for (uint32_t v = 0; v < block.vertex_count; v++)
            for (int i = 0; i < axis; i++) to[v][i] = i == 2 ? 0.15f : 0;
        test_ok(sim, singe_sim_set_collider_vertices(sim, body, to[0], singe_sim_view(sim).time + 1.0 / 24));
        test_steps(sim, 24); // it has this shape after 20
    }

    assert_int_equal(hook.calls, calls);
    assert_true(isfinite(mean_of(sim, 2)));
    singe_sim_destroy(sim);
    test_allocator_check(&hook);

    SingeSim *made;
    test_allocations_fail(10, (def.allocator = allocator, with_block(&def, &block, &made)), singe_sim_destroy(made));
}
