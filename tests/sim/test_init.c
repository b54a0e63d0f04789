// Defs filled for callers of older and newer headers.
#include "singe/singe.h"

#include "support/test.h"

enum { UNTOUCHED = 0xA5, LONGER = 32, MAX = sizeof(SingeSheetDef) + sizeof(SingeSimDef) + LONGER };

/// Without the padding at its end.
enum { SOLVER_SIZE = offsetof(SingeSolverDef, creases) + sizeof(bool) };

typedef union Bytes {
    unsigned char at[MAX];
    SingeMaterialDef material;
    SingeSheetDef sheet;
    SingeSourceDef source;
    SingeColliderDef collider;
    SingePinDef pin;
    SingeWindDef wind;
    SingeSolverDef solver;
    SingeSimDef sim;
} Bytes;

static Bytes untouched(void) {
    Bytes bytes;
    memset(&bytes, UNTOUCHED, sizeof bytes);
    return bytes;
}

static void assert_bytes(const Bytes *bytes, size_t begin, size_t end, unsigned char value) {
    for (size_t i = begin; i < end; i++)
        if (bytes->at[i] != value) fail_msg("byte %zu is %d, not %d", i, bytes->at[i], value);
}

/// `filled` was filled for `size` bytes: begins as the standard Def, of which `used` bytes are no padding, then
/// zeros, then what was there.
static void assert_filled(const Bytes *filled, size_t size, const void *standard, size_t known, size_t used) {
    size_t both = size < used ? size : used, held;
    memcpy(&held, filled->at, sizeof held);
    assert_int_equal(held, size);
    assert_memory_equal(filled->at + sizeof held, (const char *)standard + sizeof held, both - sizeof held);
    if (size > known) assert_bytes(filled, known, size, 0);
    assert_bytes(filled, size, MAX, UNTOUCHED);
}

/// Every size from the smallest to one of a newer header.
#define EVERY_SIZE(member, Def, known)                                               \
    do {                                                                             \
        Def standard_ = singe_default_##member();                                    \
        assert_int_equal(standard_.struct_size, sizeof standard_);                   \
        for (size_t size = sizeof size; size <= sizeof standard_ + LONGER; size++) { \
            Bytes bytes_ = untouched();                                              \
            singe_init_##member(&bytes_.member, size);                               \
            assert_filled(&bytes_, size, &standard_, sizeof standard_, known);       \
        }                                                                            \
        Bytes none_ = untouched();                                                   \
        singe_init_##member(&none_.member, sizeof(size_t) - 1);                      \
        assert_bytes(&none_, 0, MAX, UNTOUCHED);                                     \
    } while (0)

TEST(no_byte_beyond_the_size_is_written) {
    EVERY_SIZE(material, SingeMaterialDef, sizeof(SingeMaterialDef));
    EVERY_SIZE(source, SingeSourceDef, sizeof(SingeSourceDef));
    EVERY_SIZE(collider, SingeColliderDef, sizeof(SingeColliderDef));
    EVERY_SIZE(pin, SingePinDef, sizeof(SingePinDef));
    EVERY_SIZE(wind, SingeWindDef, sizeof(SingeWindDef));
    EVERY_SIZE(solver, SingeSolverDef, SOLVER_SIZE);
}

/// A sheet's Def cut anywhere, whatever the size of the material that it says to hold.
TEST(a_sheets_def_may_have_any_size) {
    const size_t head = offsetof(SingeSheetDef, material);
    const size_t inner[] = {0, 7, 8, sizeof(SingeMaterialDef), sizeof(SingeMaterialDef) + LONGER, SIZE_MAX};
    for (size_t i = 0; i < sizeof inner / sizeof *inner; i++)
        for (size_t size = 0; size <= sizeof(SingeSheetDef) + LONGER; size++) {
            Bytes bytes = untouched();
            memcpy(bytes.at + head, &inner[i], sizeof inner[i]);
            Bytes before = bytes;
            singe_init_sheet(&bytes.sheet, size);
            assert_memory_equal(bytes.at + size, before.at + size, MAX - size);
        }

    SingeSheetDef def = singe_default_sheet();
    SingeMaterialDef material = singe_default_material();

    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.material.struct_size, sizeof def.material);
    assert_true(def.material.grammage.value == material.grammage.value &&
                def.material.damping.value == material.damping.value);
    assert_null(def.name);
    assert_true(def.drop_pieces_below == 0);
}

TEST(a_sims_def_may_have_any_size) {
    const size_t head = offsetof(SingeSimDef, wind), second = offsetof(SingeSimDef, solver);
    const size_t inner[] = {0, 7, 8, sizeof(SingeWindDef), sizeof(SingeSolverDef) + LONGER, SIZE_MAX};
    enum { COUNT = sizeof inner / sizeof *inner };
    for (size_t i = 0; i < COUNT * COUNT; i++)
        for (size_t size = 0; size <= sizeof(SingeSimDef) + LONGER; size++) {
            Bytes bytes = untouched();
            memcpy(bytes.at + head, &inner[i % COUNT], sizeof(size_t));
            memcpy(bytes.at + second, &inner[i / COUNT], sizeof(size_t));
            Bytes before = bytes;
            singe_init_sim(&bytes.sim, size);
            assert_memory_equal(bytes.at + size, before.at + size, MAX - size);
        }

    SingeSimDef def = singe_default_sim();
    SingeWindDef wind = singe_default_wind();
    SingeSolverDef solver = singe_default_solver();

    assert_int_equal(def.struct_size, sizeof def);
    assert_true(def.thread_count == 1 && def.gravity[2] < -9);
    assert_memory_equal(&def.wind, &wind, sizeof wind);
    assert_memory_equal(&def.solver, &solver, SOLVER_SIZE);
}

/// An older header's smaller wind and material move what comes after them.
TEST(defs_inside_may_have_any_size) {
    Bytes bytes = untouched();
    const size_t head = offsetof(SingeSimDef, wind), wind = offsetof(SingeWindDef, gust_time) / 8 * 8;
    const SingeSolverDef standard = singe_default_solver();

    memcpy(bytes.at + head, &wind, sizeof wind);
    memcpy(bytes.at + head + wind, &standard.struct_size, sizeof(size_t));
    singe_init_sim(&bytes.sim, head + wind + sizeof standard);
    assert_memory_equal(bytes.at + head, &wind, sizeof wind);
    assert_memory_equal(bytes.at + head + wind, &standard, SOLVER_SIZE);
    assert_bytes(&bytes, head + wind + sizeof standard, MAX, UNTOUCHED);

    bytes = untouched();
    const size_t start = offsetof(SingeSheetDef, material), material = offsetof(SingeMaterialDef, weight) / 8 * 8;
    const size_t tail = sizeof(SingeSheetDef) - offsetof(SingeSheetDef, velocity);

    memcpy(bytes.at + start, &material, sizeof material);
    singe_init_sheet(&bytes.sheet, start + material + tail);
    assert_memory_equal(bytes.at + start, &material, sizeof material);
    assert_bytes(&bytes, start + material, start + material + tail, 0); // velocity, drop_pieces_below
    assert_bytes(&bytes, start + material + tail, MAX, UNTOUCHED);
}

/// A simulation of one cell after a step.
static SingeSim *one_cell(void) {
    const float positions[] = {0, 0, 0, 0.01f, 0, 0, 0.01f, 0.01f, 0, 0, 0.01f, 0};
    const uint32_t cell[] = {0, 1, 2, 3};
    SingeSimDef def = singe_default_sim();
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;
    SingeSim *sim;

    sheet.vertex_count = 4, sheet.positions = positions, sheet.cell_count = 1, sheet.cells = cell;
    assert_int_equal(singe_sim_create(&def, &sim, NULL), SINGE_OK);
    assert_int_equal(singe_sim_add_sheet(sim, &sheet, &id), SINGE_OK);
    assert_int_equal(singe_sim_commit(sim), SINGE_OK);
    assert_int_equal(singe_sim_step(sim), SINGE_OK);
    return sim;
}

/// Results fill as many bytes as a caller's header has: the first ones of an older, and 0 behind ours of a newer.
TEST(results_may_have_any_size) {
    SingeSim *sim = one_cell();
    union {
        unsigned char at[1024];
        SingeView view;
        SingeStats stats;
        SingeTimers timers;
        SingeCounts counts;
        SingeGas gas;
    } given;
#define READ(Type, name)                                                                                 \
    do {                                                                                                 \
        const Type whole = singe_sim_##name(sim);                                                        \
        const size_t sizes[] = {sizeof whole / 2, sizeof whole, sizeof whole + LONGER};                  \
        for (int k = 0; k < 3; k++) {                                                                    \
            memset(&given, UNTOUCHED, sizeof given);                                                     \
            singe_sim_read_##name(sim, &given.name, sizes[k]);                                           \
            const size_t known = sizes[k] < sizeof whole ? sizes[k] : sizeof whole;                      \
            const size_t first = sizeof(void *); /* a view's struct_size differs */                      \
            assert_memory_equal(given.at + first, (const unsigned char *)&whole + first, known - first); \
            for (size_t i = known; i < sizes[k]; i++) assert_int_equal(given.at[i], 0);                  \
            for (size_t i = sizes[k]; i < sizeof given; i++) assert_int_equal(given.at[i], UNTOUCHED);   \
        }                                                                                                \
    } while (0)
    READ(SingeView, view);
    READ(SingeStats, stats);
    READ(SingeTimers, timers);
    READ(SingeCounts, counts);
    READ(SingeGas, gas);
    singe_sim_read_view(sim, &given.view, 64);
    assert_int_equal(given.view.struct_size, 64);
    assert_int_equal(singe_sim_view(sim).struct_size, sizeof(SingeView));
    struct {
        SingeSurface surface;
        unsigned char more[LONGER];
    } newer = {0};
    assert_int_equal(singe_sim_draw(sim, &newer.surface, sizeof newer.surface - 1), SINGE_ERROR_ARGUMENT);
    assert_int_equal(singe_sim_draw(sim, &newer.surface, sizeof newer), SINGE_OK);
    assert_int_equal(newer.surface.triangle_count, 4);
    memset(newer.more, UNTOUCHED, sizeof newer.more);
    singe_surface_release(&newer.surface, sizeof newer);
    assert_null(newer.surface.position);
    assert_int_equal(newer.more[LONGER - 1], 0);
    singe_sim_destroy(sim);
}
