// Contact of sheets with colliders: nothing thin is passed, friction holds and gives way where it should, and what has
// come to rest lies on meshes and heights without sinking in.
#include "sample_sheets.h"

#include "common/random.h"
#include "dynamics/dynamics_plan.h"
#include "world/solids.h"

static const float STEP = 1.0f / 480;

static Float3 centroid(const Bench *b) {
    Float3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < b->shell.vertex_count; i++)
        sum = float3_add(sum, float3_load(b->state.dynamics.position[i]));
    return float3_scale(sum, 1 / (float)b->shell.vertex_count);
}

static void position(Bench *b, const float rotation[4], Float3 at) {
    for (uint32_t i = 0; i < b->shell.particle_count; i++)
        float3_store(b->state.dynamics.position[i],
                     float3_add(at, quat_rotate(rotation, float3_load(b->shell.rest_position[i]))));
}

// ---- thin things

/// A sheet of 2 mm cells thrown at a plate of 6 cm: how many particles are behind it at last.
static int passed(SingeColliderDef plate, float sheet_speed, float plate_speed, const float rotation[4]) {
    OwnBench bench = bench_open_plain(quads_grid(16, 16, 0.002f, 0.002f, false));
    SingePoseKey keys[2] = {{0, {0, 0, 0}, {0, 0, 0, 1}}, {1, {0, 0, plate_speed}, {0, 0, 0, 1}}};
    for (int k = 0; k < 4; k++) keys[0].rotation[k] = keys[1].rotation[k] = rotation[k];
    bench_add_collider(&bench, plate, 2, keys);
    const float none[4] = {0, 0, 0, 1};
    position(&bench, none, float3(-0.016f, -0.016f, 0.02f));
    for (uint32_t i = 0; i < bench.shell.particle_count; i++) bench.state.dynamics.velocity[i][2] = -sheet_speed;
    for (int step = 0; step < 24; step++) bench_step(&bench, STEP);
    Pose pose = path_pose(&bench.colliders.items[0].path, bench.state.time);
    int count = 0;
    for (uint32_t i = 0; i < bench.shell.particle_count; i++) {
        Float3 local = pose_unapply(&pose, float3_load(bench.state.dynamics.position[i]));
        count += local.z < 0 && fabsf(local.x) < 0.03f && fabsf(local.y) < 0.03f;
    }
    return count;
}

TEST(nothing_passes_thin_plates) {
    const float level[4] = {0, 0, 0, 1}, aslant[4] = {0.1f, 0.15f, 0, 0.9837f};
    for (float thickness = 1e-3f; thickness > 0.2e-3f; thickness /= 2) {
        SingeColliderDef box = singe_default_collider();
        box.kind = SINGE_COLLIDER_BOX;
        box.half_size[0] = box.half_size[1] = 0.03f, box.half_size[2] = thickness / 2;
        OwnTriangles triangles = triangles_box(6, 0.06f, 0.06f, thickness);
        SingeColliderDef mesh = triangles_def(&triangles);
        for (float speed = 0.5f; speed <= 8; speed *= 2) {
            const int behind[6] = {passed(box, speed, 0, level),   passed(box, 0, speed, level),
                                   passed(box, speed, 0, aslant),  passed(mesh, speed, 0, level),
                                   passed(mesh, 0, speed, aslant), passed(mesh, speed / 2, speed / 2, level)};
            for (int k = 0; k < 6; k++)
                if (behind[k])
                    fail_msg("%d particles passed a plate of %g mm at %g m/s (case %d)", behind[k],
                             1e3 * (double)thickness, (double)speed, k);
        }
    }
}

// ---- friction

static SingeColliderDef slab(SingeColliderKind kind, Triangles *triangles, const float *heights) {
    SingeColliderDef def = singe_default_collider();
    if (kind == SINGE_COLLIDER_MESH) def = triangles_def(triangles);
    def.kind = kind;
    def.half_size[0] = def.half_size[1] = 1, def.half_size[2] = 0.05f;
    def.columns = def.rows = 5, def.size[0] = def.size[1] = 2, def.heights = heights;
    def.friction = 0.4f;
    return def;
}

/// m that a sheet of 4 cm slides in 0.5 s on a slab of that slope, and in the second half of it.
static double slide(SingeColliderDef def, float slope, double *late) {
    OwnBench bench = bench_open_plain(quads_grid(8, 8, 0.005f, 0.005f, false));
    SingePoseKey key = {0, {0, 0, 0}, {0, sinf(slope / 2), 0, cosf(slope / 2)}};
    float top = def.kind == SINGE_COLLIDER_BOX || def.kind == SINGE_COLLIDER_MESH ? 0.05f : 0;
    bench_add_collider(&bench, def, 1, &key);
    position(&bench, key.rotation, quat_rotate(key.rotation, float3(0, 0, top + def.offset)));
    Float3 start = centroid(&bench), half = start;
    for (int step = 0; step < 240; step++) {
        bench_step(&bench, STEP);
        if (step == 119) half = centroid(&bench);
    }
    double displacement = (double)float3_length(float3_sub(centroid(&bench), start));
    if (late) *late = (double)float3_length(float3_sub(centroid(&bench), half));
    return displacement;
}

TEST(sheets_slip_above_the_angle_of_friction) {
    OwnTriangles triangles = triangles_box(2, 2, 2, 0.1f);
    const float heights[25] = {0};
    const float angle = atanf(0.4f);

    static const char *const names[] = {"plane", "sphere", "box", "capsule", "heightfield", "mesh"};
    for (int kind = SINGE_COLLIDER_PLANE; kind <= SINGE_COLLIDER_MESH; kind++) {
        if (kind == SINGE_COLLIDER_SPHERE || kind == SINGE_COLLIDER_CAPSULE) continue;
        SingeColliderDef def = slab((SingeColliderKind)kind, &triangles, heights);
        double held = slide(def, 0.98f * angle, NULL), free_displacement = slide(def, 1.1f * angle, NULL);
        double expected = 0.5 * 9.81 * (sin(1.1 * (double)angle) - 0.4 * cos(1.1 * (double)angle)) * 0.25;
        printf("%s: at 0.98 of the angle of friction %.3f mm in 0.5 s, at 1.1 of it %.2f mm (Coulomb: %.2f)\n",
               names[kind], 1e3 * held, 1e3 * free_displacement, 1e3 * expected);
        assert_true(held < 0.5e-3);
        assert_true(fabs(free_displacement - expected) < 0.1 * expected);
    }
}

TEST(resting_sheets_do_not_creep) {
    OwnTriangles triangles = triangles_box(2, 2, 2, 0.1f);
    const float heights[25] = {0};
    for (int kind = SINGE_COLLIDER_PLANE; kind <= SINGE_COLLIDER_MESH; kind++) {
        if (kind == SINGE_COLLIDER_SPHERE || kind == SINGE_COLLIDER_CAPSULE) continue;
        SingeColliderDef def = slab((SingeColliderKind)kind, &triangles, heights);
        double level, slope;
        slide(def, 0, &level);
        slide(def, 0.3f, &slope); // tan 0.31 of 0.4
        printf("kind %d: creeps %.4f mm/s on the level, %.4f mm/s at 0.3 rad\n", kind, 4e3 * level, 4e3 * slope);
        assert_true(4 * level < 0.02e-3 && 4 * slope < 0.2e-3);
    }
}

/// m that a sheet stays behind a belt in 0.4 s, which starts from rest with this acceleration.
static double behind_belt(SingeColliderDef def, float acceleration) {
    enum { KEYS = 100 };
    OwnBench bench = bench_open_plain(quads_grid(8, 8, 0.005f, 0.005f, false));
    SingePoseKey keys[KEYS];
    for (int k = 0; k < KEYS; k++) {
        float t = 0.45f * (float)k / (KEYS - 1);
        keys[k] = (SingePoseKey){t, {acceleration * t * t / 2, 0, -0.05f - def.offset}, {0, 0, 0, 1}};
    }
    bench_add_collider(&bench, def, KEYS, keys);
    float start = centroid(&bench).x;
    for (int step = 0; step < 192; step++) bench_step(&bench, STEP);
    double displacement = (double)(centroid(&bench).x - start), belt = 0.5 * (double)acceleration * 0.16;
    return belt - displacement;
}

TEST(a_belt_carries_what_friction_allows) {
    OwnTriangles triangles = triangles_box(2, 2, 2, 0.1f);
    SingeColliderDef def = slab(SINGE_COLLIDER_MESH, &triangles, NULL);
    double held = behind_belt(def, 0.9f * 0.4f * 9.81f), left = behind_belt(def, 1.5f * 0.4f * 9.81f);
    double expected = 0.5 * 0.5 * 0.4 * 9.81 * 0.16;
    printf("belt: at 0.9 mu g the sheet stays %.2f mm behind, at 1.5 mu g %.1f mm (Coulomb: %.1f)\n", 1e3 * held,
           1e3 * left, 1e3 * expected);
    assert_true(held < 2.5e-3 && fabs(left - expected) < 0.1 * expected);
}

// ---- at rest

/// How deep the sheet's cells are in the collider at the worst, over a grid of points on each; and how fast it moves.
static double deepest(const Bench *held, double *speed) {
    const float(*x)[4] = (const float(*)[4])held->state.dynamics.position;
    const Collider *collider = held->colliders.items;
    Pose pose = path_pose(&collider->path, held->state.time);
    double worst = -INFINITY, sum = 0;

    for (uint32_t c = 0; c < held->shell.cell_count; c++) {
        const uint32_t *corner = held->shell.cells[c];
        for (int k = 0; k < 25; k++) {
            float u = (float)(k % 5) / 4, v = (float)(k / 5) / 4; // on the two triangles that are drawn
            const float *a = x[corner[0]], *b = x[corner[u > v ? 1 : 3]], *d = x[corner[2]];
            float wide = u > v ? u - v : v - u, far = u > v ? v : u;
            Float3 p = float3_mad(float3_scale(float3_load(a), 1 - wide - far), float3_load(b), wide), normal;
            p = float3_mad(p, float3_load(d), far);
            float distance = collider_distance(collider, pose_unapply(&pose, p), INFINITY, &normal);
            worst = fmax(worst, -(double)distance);
        }
    }

    for (uint32_t i = 0; i < held->shell.particle_count; i++)
        sum += (double)float3_length(float3_load(held->state.dynamics.velocity[i]));
    *speed = sum / held->shell.particle_count;
    return worst;
}

static double rests(SingeColliderDef def, const char *name, float height) {
    enum { CELLS = 40 };
    const float cell = 0.002f;
    SingeMaterialDef material = singe_default_material();
    OwnBench bench = bench_open(quads_grid(CELLS, CELLS, cell, cell, false), &material, 2);
    SingePoseKey key = {0, {0, 0, 0}, {0, 0, 0, 1}};
    bench_add_collider(&bench, def, 1, &key);
    const float turned[4] = {0, 0, 0.2588f, 0.9659f};
    position(&bench, turned, float3_add(float3(0, 0, height), quat_rotate(turned, float3(-0.04f, -0.04f, 0))));
    for (int step = 0; step < 192; step++) bench_step(&bench, STEP);
    double speed, worst = deepest(&bench, &speed);
    printf("%s: after 0.4 s the deepest point of the sheet is %.3f mm in (%.1f %% of a cell), mean speed %.1f mm/s\n",
           name, 1e3 * worst, 100 * worst / (double)cell, 1e3 * speed);
    assert_true(speed < 1e-3); // m/s: one that has fallen past is not in it either
    return worst / (double)cell;
}

TEST(sheets_rest_on_meshes_and_heights) {
    OwnTriangles torus = triangles_torus(64, 32, 0.03f, 0.012f);
    SingeColliderDef def = triangles_def(&torus);
    assert_true(rests(def, "torus", 0.016f) < 0.05);
    enum { N = 65 };
    static float heights[N * N];
    for (int k = 0; k < N * N; k++)
        heights[k] = 0.006f * (1 + sinf(0.2f * (float)(k % N)) * sinf(0.25f * (float)(k / N)));
    def = singe_default_collider();
    def.kind = SINGE_COLLIDER_HEIGHTFIELD;
    def.columns = def.rows = N, def.heights = heights;
    assert_true(rests(def, "heights", 0.014f) < 0.05);
}

/// Spheres of several sizes under a sheet: how deep the smallest that still hold reach in.
TEST(small_spheres_hold) {
    for (float radius = 8e-3f; radius > 0.4e-3f; radius /= 2) {
        SingeMaterialDef material = singe_default_material();
        OwnBench bench = bench_open(quads_grid(16, 16, 0.002f, 0.002f, false), &material, 1);
        SingeColliderDef def = singe_default_collider();
        def.kind = SINGE_COLLIDER_SPHERE, def.radius = radius;
        SingePoseKey key = {0, {0.0153f, 0.0147f, -radius - 0.002f}, {0, 0, 0, 1}}; // below the inside of a cell
        bench_add_collider(&bench, def, 1, &key);
        double speed, worst = -INFINITY;
        for (int step = 0; step < 40; step++) {
            bench_step(&bench, STEP);
            worst = fmax(worst, deepest(&bench, &speed));
        }
        printf("sphere of %.1f mm under cells of 2 mm: %.2f mm in at the worst\n", 1e3 * (double)radius, 1e3 * worst);
        if (radius > 1.5e-3f) assert_true(worst < 0);
    }
}

// ---- presses and swats

/// m/s that the particles move at most, and how many are under the plane z = 0.
static double fastest(const Bench *b, int *under) {
    double max = 0;
    *under = 0;
    for (uint32_t i = 0; i < b->shell.particle_count; i++) {
        max = fmax(max, (double)float3_length(float3_load(b->state.dynamics.velocity[i])));
        *under += b->state.dynamics.position[i][2] < -1e-5f;
    }
    return max;
}

/// A block comes down on a sheet that lies on a plate, nearer than sheet and offsets are thick, and is lifted again.
TEST(pressed_sheets_stay_and_rest) {
    for (float gap = 2e-3f; gap > 0.2e-3f; gap /= 2) {
        SingeMaterialDef material = singe_default_material();
        OwnBench bench = bench_open(quads_grid(16, 16, 0.002f, 0.002f, false), &material, 1);
        OwnTriangles triangles = triangles_box(4, 0.02f, 0.02f, 0.01f);
        SingeColliderDef def = triangles_def(&triangles), plate = singe_default_collider();
        const float high = 0.005f + 0.006f, low = 0.005f + gap, x = 0.016f;
        SingePoseKey keys[] = {{0, {x, x, high}, {0, 0, 0, 1}},
                               {0.05f, {x, x, low}, {0, 0, 0, 1}},
                               {0.25f, {x, x, low}, {0, 0, 0, 1}},
                               {0.3f, {x, x, high}, {0, 0, 0, 1}},
                               {0.31f, {x, x, 2 * high}, {0, 0, 0, 1}}};
        bench_add_collider(&bench, def, 5, keys);
        Collider *both = calloc(2, sizeof *both);
        both[0] = bench.colliders.items[0];
        free(bench.colliders.items);
        SingePoseKey key = {0, {x, x, -0.01f}, {0, 0, 0, 1}};
        plate.kind = SINGE_COLLIDER_BOX, plate.half_size[2] = 0.01f, plate.path_count = 1, plate.path = &key;
        assert_int_equal(collider_create(&bench.memory, &plate, &both[1], &bench.error), SINGE_OK);
        both[1].generation = 2;
        bench.colliders = (ColliderList){2, 2, both};
        assert_true(dynamics_plan_reserve(&bench.memory, bench.plan, 2));
        const float none[4] = {0, 0, 0, 1};
        position(&bench, none, float3(0, 0, plate.offset));
        int under, ever = 0;
        double max = 0;
        for (int step = 0; step < 480; step++) {
            bench_step(&bench, STEP);
            max = fmax(max, fastest(&bench, &under));
            ever += under;
        }

        double last = fastest(&bench, &under);
        printf("pressed to %.2f mm: at most %.2f m/s, %.4f m/s after 1 s, %d times under the plate\n",
               1e3 * (double)gap, max, last, ever);
        assert_true(ever == 0 && max < 2 && last < 0.02);
        collider_free(&bench.memory, &both[1]);
    }
}

/// A plate that turns about its edge hits a sheet in flight: nothing gets through.
TEST(swung_plates_let_nothing_through) {
    OwnBench bench = bench_open_plain(quads_grid(16, 16, 0.002f, 0.002f, false));
    OwnTriangles triangles = triangles_box(6, 0.1f, 0.1f, 0.0005f);
    for (uint32_t v = 0; v < triangles.vertex_count; v++) triangles.vertices[3 * (size_t)v] += 0.06f; // about its edge
    enum { KEYS = 40 };
    SingePoseKey keys[KEYS];
    for (int k = 0; k < KEYS; k++) { // 40 rad/s upwards about -y, from 0.6 rad below
        float angle = -0.6f + 1.2f * (float)k / (KEYS - 1);
        keys[k] = (SingePoseKey){0.03f * (float)k / (KEYS - 1), {0, 0, 0}, {0, -sinf(angle / 2), 0, cosf(angle / 2)}};
    }

    bench_add_collider(&bench, triangles_def(&triangles), KEYS, keys);
    const float none[4] = {0, 0, 0, 1};
    position(&bench, none, float3(0.04f, -0.016f, 0.004f));
    for (int step = 0; step < 15; step++) bench_step(&bench, STEP);
    Pose pose = path_pose(&bench.colliders.items[0].path, bench.state.time);
    int through = 0, hit = 0;
    for (uint32_t i = 0; i < bench.shell.particle_count; i++) {
        Float3 local = pose_unapply(&pose, float3_load(bench.state.dynamics.position[i]));
        through += local.z < 0 && local.x > 0.011f && local.x < 0.109f && fabsf(local.y) < 0.049f;
        hit += bench.state.dynamics.velocity[i][2] > 1;
    }

    printf("swat: %d of %u particles hit, %d through\n", hit, bench.shell.particle_count, through);
    assert_true(hit > 400 && through == 0);
}

// ---- in lanes

/// Planes, spheres, boxes and capsules, at rest, turned and moving: particles outside, in the skin, deep inside and on
/// their way through.
TEST(particles_move_in_lanes_as_one_by_one) {
    const SingeColliderKind kinds[] = {SINGE_COLLIDER_PLANE, SINGE_COLLIDER_SPHERE, SINGE_COLLIDER_BOX,
                                       SINGE_COLLIDER_CAPSULE};
    const SingePoseKey keys[2] = {{0, {0.03f, 0.02f, 0.01f}, {0.1f, 0.2f, 0.3f, 0.9f}},
                                  {(double)STEP, {0.031f, 0.0205f, 0.0098f}, {0.12f, 0.19f, 0.3f, 0.9f}}};
    const float h = STEP / 3;
    uint64_t all = 0;

    for (int trial = 0; trial < 12; trial++) {
        // at rest as it is, at rest but turned, moving
        OwnBench bench =
            bench_open_plain(quads_grid(29, 31, 0.002f, 0.002f, false)); // 1859 particles: lanes leave some
        SingeColliderDef def = singe_default_collider();
        def.kind = kinds[trial % 4];
        def.radius = 0.01f;
        def.height = 0.02f;
        def.friction = 0.1f; // some stick, some slide
        memcpy(def.half_size, (float[]){0.01f, 0.012f, 0.008f}, sizeof def.half_size);
        bench_add_collider(&bench, def, trial < 4 ? 0 : trial < 8 ? 1 : 2, trial < 4 ? NULL : keys);

        const uint32_t count = bench.shell.particle_count;
        DynamicsState *dynamics = &bench.state.dynamics;
        float(*one)[4] = malloc(count * sizeof *one);
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t k = 0; k < 3; k++) {
                const uint32_t draw = 8 * i + k;
                const float centre = trial < 4 ? 0 : keys[0].position[k];
                dynamics->position[i][k] = centre + 0.03f * (random_unit(random_hash(draw, 0, 0, 1)) - 0.5f);
                dynamics->velocity[i][k] =
                    (i % 5 == 0 ? 8.0f : 0.5f) * (random_unit(random_hash(draw + 4, 0, 0, 1)) - 0.5f);
            }
            dynamics->position[i][3] = i % 7 == 0 ? 0 : 1;
            memcpy(bench.plan->predicted[i], dynamics->position[i], sizeof *one);
            memcpy(one[i], dynamics->position[i], sizeof *one);
        }

        MovingCollider *collider = bench.plan->colliders;
        *collider = contact_collider(bench.colliders.items, 0, (double)h);
        uint64_t contacts = 0;
        for (uint32_t i = 0; i < count; i++) {
            Float3 before = float3_mad(float3_load(one[i]), float3_load(dynamics->velocity[i]), -h);
            if (one[i][3] != 0) contacts += contact_particle(collider, def.offset, before, one[i]);
        }
        for (int i = SINGE_INSTRUCTIONS_PLAIN; i <= SINGE_INSTRUCTIONS_X86_V4; i++) {
            const Kernels *kernels = kernels_choose((SingeInstructions)i);
            if (!kernels) continue;
            bench.plan->kernels = kernels;
            memcpy(dynamics->position, bench.plan->predicted, count * sizeof *one);
            assert_int_equal(contact_project(bench.plan, 1, NULL, h, dynamics), contacts);
            assert_memory_equal(dynamics->position, one, count * sizeof *one);
        }
        all += contacts;
        free(one);
    }

    assert_true(all > 1000);
}

/// A sheet among pegs, some of which it overlaps: its blocks list colliders by their boxes, or take all where they are
/// many, and particles are pushed from one into the next.
TEST(of_many_colliders_none_is_missed) {
    enum { MOST = 600 };
    const float h = STEP / 3, none[4] = {0, 0, 0, 1};
    for (int trial = 0; trial < 6; trial++) {
        const uint32_t near = trial < 3 ? 40 : 400, count = near + 200;
        OwnBench bench = bench_open_plain(quads_grid(40, 40, 0.002f, 0.002f, false));
        assert_true(dynamics_plan_reserve(&bench.memory, bench.plan, MOST));
        Collider *colliders = calloc(MOST, sizeof *colliders);
        for (uint32_t c = 0; c < count; c++) {
            float draw[8];
            for (uint32_t k = 0; k < 8; k++) draw[k] = random_unit(random_hash(c, k, 0, (uint32_t)trial)) - 0.5f;
            SingeColliderDef def = singe_default_collider();
            const SingeColliderKind kinds[] = {SINGE_COLLIDER_SPHERE, SINGE_COLLIDER_BOX, SINGE_COLLIDER_CAPSULE};
            def.kind = kinds[c % 3];
            def.radius = def.height = 0.004f;
            def.half_size[0] = def.half_size[1] = def.half_size[2] = 0.003f;
            const float far = c < near ? 0.09f : 3;
            const float side = sqrtf(1 - draw[3] * draw[3]);
            SingePoseKey keys[2] = {
                {0, {0.04f + far * draw[0], 0.04f + far * draw[1], 0.01f * draw[2]}, {0, side, 0, draw[3]}}};
            keys[1] = keys[0];
            keys[1].time = h;
            keys[1].position[2] += 0.01f * draw[4];
            def.path = keys;
            def.path_count = 2;
            assert_int_equal(collider_create(&bench.memory, &def, &colliders[c], &bench.error), SINGE_OK);
            bench.plan->colliders[c] = contact_collider(&colliders[c], 0, (double)h);
        }

        DynamicsState *dynamics = &bench.state.dynamics;
        const uint32_t particles = bench.shell.particle_count;
        position(&bench, none, float3(0, 0, 0));
        float(*one)[4] = malloc(particles * sizeof *one);
        for (uint32_t i = 0; i < particles; i++) {
            dynamics->position[i][3] = 1;
            dynamics->velocity[i][2] = i % 3 == 0 ? -4.0f : 0.5f;
            memcpy(bench.plan->predicted[i], dynamics->position[i], sizeof *one);
            memcpy(one[i], dynamics->position[i], sizeof *one);
        }

        uint64_t contacts = 0;
        for (uint32_t i = 0; i < particles; i++) {
            Float3 before = float3_mad(float3_load(one[i]), float3_load(dynamics->velocity[i]), -h);
            for (uint32_t c = 0; c < count; c++)
                contacts += contact_particle(&bench.plan->colliders[c], colliders[c].def.offset, before, one[i]);
        }
        assert_true(contacts > 500);
        assert_int_equal(contact_project(bench.plan, count, NULL, h, dynamics), contacts);
        assert_memory_equal(dynamics->position, one, particles * sizeof *one);

        free(one);
        for (uint32_t c = 0; c < count; c++) collider_free(&bench.memory, &colliders[c]);
        free(colliders);
    }
}

// ---- cost

/// ns a particle for one look at the collider, with the sheet there.
static double look(Bench *b, Float3 at, uint64_t *contacts) {
    const float none[4] = {0, 0, 0, 1};
    DynamicsPlan *plan = b->plan;
    double best = INFINITY;

    for (int repeat = 0; repeat < 7; repeat++) {
        position(b, none, at);
        for (uint32_t i = 0; i < b->shell.particle_count; i++) {
            b->state.dynamics.position[i][3] = 1;
            memcpy(plan->predicted[i], b->state.dynamics.position[i], sizeof plan->predicted[i]);
        }
        plan->colliders[0] = contact_collider(b->colliders.items, 0, (double)STEP / 3);
        double start = test_seconds();
        *contacts = contact_project(plan, 1, NULL, STEP / 3, &b->state.dynamics);
        best = fmin(best, test_seconds() - start);
    }

    return 1e9 * best / b->shell.particle_count;
}

/// A mesh of 10,000 triangles: a sheet that is far from it, above it, and one of which all particles touch it.
TEST(far_colliders_cost_almost_nothing) {
    SingeMaterialDef material = bench_plain_material();
    material.thickness = singe_param(0.0004f); // both layers in reach
    OwnBench bench = bench_open(quads_grid(70, 70, 0.001f, 0.001f, false), &material, 1);
    OwnTriangles triangles = triangles_box(29, 0.1f, 0.1f, 0.02f);
    SingePoseKey key = {0, {0.035f, 0.035f, -0.01f}, {0, 0, 0, 1}};
    bench_add_collider(&bench, triangles_def(&triangles), 1, &key);
    uint64_t none, some, all;
    double far = look(&bench, float3(0, 0, 0.1f), &none), above = look(&bench, float3(0, 0, 0.005f), &some);
    double touching = look(&bench, float3(0, 0, 0.00005f), &all);
    printf("%u particles and %u triangles: %.1f ns a particle where far, %.0f ns 5 mm above, %.0f ns in contact\n",
           bench.shell.particle_count, triangles.triangle_count, far, above, touching);
    assert_true(none == 0 && some == 0 && all == bench.shell.particle_count);
    assert_true(far < touching / 20);
}
