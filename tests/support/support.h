// Helpers of the tests: meshes, simulations made through the public header, and a counting allocator.
#pragma once

#include "singe/singe.h"
#include "support/test.h"

// ---- meshes (make_mesh.c)

/// A quad mesh whose arrays come from malloc. uv runs over [0, 1] squared.
typedef struct TestMesh {
    uint32_t vertex_count, cell_count;
    float *positions; ///< [3 * vertex_count]
    float *uv;        ///< [2 * vertex_count]
    uint32_t *cells;  ///< [4 * cell_count]
} TestMesh;

/// A flat sheet in z = 0, front upwards, with a corner at the origin: vertex (i, j) is j (nx + 1) + i and
/// cell (i, j) is j nx + i.
TestMesh test_grid(uint32_t nx, uint32_t ny, float dx, float dy);

/// A tube along z, front outwards: vertex (i, j) is j around + i, j up to `along`.
TestMesh test_cylinder(uint32_t around, uint32_t along, float radius, float length);

/// A torus around z, front outwards.
TestMesh test_torus(uint32_t around, uint32_t tube, float radius, float tube_radius);

/// Appends a vertex that no cell uses.
void test_mesh_add_vertex(TestMesh *mesh, float x, float y, float z);
void test_mesh_move(TestMesh *mesh, float x, float y, float z);
/// Turns a flat grid upright: y becomes z, and the front looks to -y.
void test_mesh_raise(TestMesh *mesh);
void test_mesh_free(TestMesh *mesh);
#define OwnTestMesh OWNED(test_mesh_free) TestMesh

// ---- simulations (make_sim.c)

void test_sim_end(SingeSim **sim);
#define OwnSim OWNED(test_sim_end) SingeSim

/// Fails the test with the simulation's error unless the call succeeded.
#define test_ok(sim, call) test_ok_at((sim), (call), #call, __FILE__, __LINE__)
void test_ok_at(const SingeSim *sim, SingeResult result, const char *call, const char *file, int line);

/// Fails the test unless the call gave `expected`, noted it in the simulation's error, and that says something.
#define test_refused(sim, expected, call) test_refused_at((sim), (expected), (call), #call, __FILE__, __LINE__)
void test_refused_at(const SingeSim *sim, SingeResult expected, SingeResult result, const char *call, const char *file,
                     int line);

/// The default sheet on a mesh.
SingeSheetDef test_sheet(const TestMesh *mesh);

/// A committed simulation of one sheet; NULL stands for the default Def or material. Frees the mesh.
SingeSim *test_sim(const SingeSimDef *def, TestMesh mesh, const SingeMaterialDef *material);

/// Calls that must succeed.
SingeSim *test_create(const SingeSimDef *def);
SingeSheetId test_add_sheet(SingeSim *sim, const SingeSheetDef *def);
SingeSourceId test_add_source(SingeSim *sim, const SingeSourceDef *def);
SingeColliderId test_add_collider(SingeSim *sim, const SingeColliderDef *def);
SingePinId test_add_pin(SingeSim *sim, const SingePinDef *def);
void test_steps(SingeSim *sim, int count);

/// A key that only places.
SingePoseKey test_key(float time, float x, float y, float z);

/// Adds a spot at a point.
SingeSourceId test_spot(SingeSim *sim, float x, float y, float z, float radius, float temperature, float conductance);

/// The life of a simulation of one sheet: its commit, a step, which must allocate nothing, and its end.
SingeResult test_life(SingeSimDef def, SingeAllocator allocator);

/// Fails unless all arrays, stats and saved bytes of two simulations are bitwise equal.
void test_assert_same(SingeSim *a, SingeSim *b);
/// Runs both for as many steps, and fails unless they are equal then.
void test_steps_alike(SingeSim *a, SingeSim *b, int count);

/// Saved bytes as a block from malloc.
typedef struct TestBytes {
    uint8_t *data;
    size_t size;
} TestBytes;
void test_bytes_free(TestBytes *bytes);
#define OwnTestBytes OWNED(test_bytes_free) TestBytes
TestBytes test_save(SingeSim *sim);
/// A simulation loaded from saved bytes; NULL stands for the default hooks.
SingeSim *test_load(const SingeSimDef *hooks, const TestBytes *bytes);
/// The simulation, saved and loaded.
SingeSim *test_reload(const SingeSimDef *hooks, SingeSim *sim);
/// Fails unless the simulation's saved bytes are these.
void test_assert_saved(SingeSim *sim, const TestBytes *bytes);

// ---- locales (locale.c)

/// Sets a locale whose decimal point is a comma, which setlocale(LC_ALL, "C") undoes. Without one it says so and
/// returns false. Tests that call it are named in `locale_tests` of tests/CMakeLists.txt.
bool test_comma_locale(void);

// ---- memory (allocator.c)

/// Counts everything, and fails from the fail_at-th call for memory on (1 is the first; 0 never), or at that
/// one only.
typedef struct TestAllocator {
    long calls; ///< for memory, frees not counted
    long frees;
    long fail_at;
    bool once;   ///< fail at that call only
    long blocks; ///< now held
    size_t bytes, peak;
    size_t largest; ///< block asked for so far
    long faults;    ///< calls with a wrong old size, or with a pointer to no block
} TestAllocator;

/// `allocator` is then its context.
SingeAllocator test_allocator(TestAllocator *allocator);

/// Fails the test unless every block came back, with its true size.
void test_allocator_check(const TestAllocator *allocator);

/// Lets each allocation of a call fail in turn, until the call succeeds after at least `least` failures. It takes its
/// memory from `allocator`. A failed call returns SINGE_ERROR_MEMORY and leaves nothing behind; `release` frees what a
/// successful one has made.
#define test_allocations_fail(least, call, release)                 \
    for (long at_ = 1;; at_++) {                                    \
        TestAllocator counter_ = {.fail_at = at_, .once = true};    \
        const SingeAllocator allocator = test_allocator(&counter_); \
        const SingeResult result_ = (call);                         \
        if (result_ == SINGE_OK) release;                           \
        else assert_int_equal(result_, SINGE_ERROR_MEMORY);         \
        test_allocator_check(&counter_);                            \
        if (result_ == SINGE_OK) {                                  \
            assert_true(at_ > (least));                             \
            break;                                                  \
        }                                                           \
    }
