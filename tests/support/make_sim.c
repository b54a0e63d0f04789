#include "support.h"

void test_sim_end(SingeSim **sim) { singe_sim_destroy(*sim); }

void test_bytes_free(TestBytes *bytes) { free(bytes->data); }

void test_ok_at(const SingeSim *sim, SingeResult result, const char *call, const char *file, int line) {
    if (result == SINGE_OK) return;
    const SingeError *error = sim ? singe_sim_error(sim) : NULL;
    print_error("%s: %s [%s %lld: %s]\n", call, singe_result_name(result), error ? error->stage : "",
                error ? (long long)error->element : 0, error ? error->message : "");
    _fail(file, line);
}

void test_refused_at(const SingeSim *sim, SingeResult expected, SingeResult result, const char *call, const char *file,
                     int line) {
    const SingeError *error = singe_sim_error(sim);
    bool noted = error->code == result && error->stage[0] && error->message[0];
    if (result == expected && noted) return;
    print_error("%s: %s where %s was expected; noted: %s [%s: %s]\n", call, singe_result_name(result),
                singe_result_name(expected), singe_result_name(error->code), error->stage, error->message);
    _fail(file, line);
}

SingeSheetDef test_sheet(const TestMesh *mesh) {
    SingeSheetDef def = singe_default_sheet();
    def.vertex_count = mesh->vertex_count;
    def.positions = mesh->positions;
    def.cell_count = mesh->cell_count;
    def.cells = mesh->cells;
    def.uv = mesh->uv;
    return def;
}

SingeSim *test_create(const SingeSimDef *def) {
    SingeSim *sim;
    SingeError error = {0};
    if (singe_sim_create(def, &sim, &error)) fail_msg("create: %s", error.message);
    return sim;
}

#define ADD(Kind, kind)                                                           \
    Singe##Kind##Id test_add_##kind(SingeSim *sim, const Singe##Kind##Def *def) { \
        Singe##Kind##Id id;                                                       \
        test_ok(sim, singe_sim_add_##kind(sim, def, &id));                        \
        return id;                                                                \
    }

ADD(Sheet, sheet)
ADD(Source, source)
ADD(Collider, collider)
ADD(Pin, pin)

SingeSim *test_sim(const SingeSimDef *def, TestMesh mesh, const SingeMaterialDef *material) {
    SingeSimDef standard = singe_default_sim();
    SingeSim *sim = test_create(def ? def : &standard);
    SingeSheetDef sheet = test_sheet(&mesh);
    if (material) sheet.material = *material;
    test_add_sheet(sim, &sheet);
    test_ok(sim, singe_sim_commit(sim));
    test_mesh_free(&mesh);
    return sim;
}

void test_steps(SingeSim *sim, int count) {
    for (int i = 0; i < count; i++) test_ok(sim, singe_sim_step(sim));
}

SingeResult test_life(SingeSimDef def, SingeAllocator allocator) {
    OwnTestMesh mesh = test_grid(4, 4, 0.01f, 0.01f);
    const SingeSheetDef sheet = test_sheet(&mesh);
    const TestAllocator *counter = allocator.context;
    SingeSheetId id;
    SingeSim *sim;

    def.allocator = allocator;
    SingeResult result = singe_sim_create(&def, &sim, NULL);
    if (!result) result = singe_sim_add_sheet(sim, &sheet, &id);
    if (!result) result = singe_sim_commit(sim);

    const long calls = counter->calls;
    if (!result) result = singe_sim_step(sim);
    assert_int_equal(counter->calls, calls);
    singe_sim_destroy(sim);
    return result;
}

SingePoseKey test_key(float time, float x, float y, float z) { return (SingePoseKey){time, {x, y, z}, {0, 0, 0, 1}}; }

SingeSourceId test_spot(SingeSim *sim, float x, float y, float z, float radius, float temperature, float conductance) {
    SingeSourceDef def = singe_default_source();
    SingePoseKey key = test_key(0, x, y, z);

    def.kind = SINGE_SOURCE_SPOT;
    def.path_count = 1;
    def.path = &key;
    def.radius = radius;
    def.falloff = radius;
    def.temperature = temperature;
    def.conductance = conductance;
    return test_add_source(sim, &def);
}

static void assert_same_stats(const SingeStats *a, const SingeStats *b) {
#define SAME(field) assert_memory_equal(&a->field, &b->field, sizeof a->field)
    SAME(time), SAME(particles), SAME(springs), SAME(cells), SAME(pieces);
    SAME(mass), SAME(mass_initial), SAME(mass_burnt), SAME(mass_removed), SAME(burnt_fraction);
    SAME(temperature_max), SAME(heat_in), SAME(heat_lost), SAME(heat_of_combustion), SAME(heat_stored);
    SAME(ledger_error), SAME(mass_ledger_error), SAME(strain_mean), SAME(strain_p99), SAME(strain_max);
    SAME(inverted_cells), SAME(speed_rms_unburnt), SAME(thickening), SAME(front_speed);
#undef SAME
}

void test_assert_same(SingeSim *a, SingeSim *b) {
    SingeView v = singe_sim_view(a), w = singe_sim_view(b);
    assert_int_equal(v.particle_count, w.particle_count);
    assert_int_equal(v.cell_count, w.cell_count);
    assert_true(v.time == w.time && v.step == w.step && v.topology_version == w.topology_version);
    size_t n = v.particle_count;
#define SAME(array, count) assert_memory_equal(v.array, w.array, (count) * sizeof *v.array)
    SAME(position, n), SAME(velocity, n), SAME(rest_position, n), SAME(uv, n), SAME(area, n), SAME(mass, n);
    SAME(temperature, n), SAME(temperature_peak, n), SAME(burn_rate, n), SAME(fuel, n), SAME(time_ignited, n),
        SAME(time_burnt, n), SAME(piece, n);
    SAME(particle_flags, n), SAME(cell_flags, v.cell_count), SAME(cells, v.cell_count);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++) {
        assert_int_equal(v.spring_count[c], w.spring_count[c]);
        SAME(springs[c], v.spring_count[c]), SAME(spring_length[c], v.spring_count[c]);
        SAME(spring_rest[c], v.spring_count[c]), SAME(spring_flags[c], v.spring_count[c]);
    }
#undef SAME
    SingeStats s = singe_sim_stats(a), t = singe_sim_stats(b);
    assert_same_stats(&s, &t);
    OwnTestBytes bytes = test_save(a);
    test_assert_saved(b, &bytes);
}

void test_steps_alike(SingeSim *a, SingeSim *b, int count) {
    test_steps(a, count);
    test_steps(b, count);
    test_assert_same(a, b);
}

TestBytes test_save(SingeSim *sim) {
    uint8_t *bytes;
    TestBytes copy;
    test_ok(sim, singe_sim_save(sim, &bytes, &copy.size));
    copy.data = malloc(copy.size);
    assert_non_null(copy.data);
    memcpy(copy.data, bytes, copy.size);
    singe_sim_free_bytes(sim, bytes, copy.size);
    return copy;
}

SingeSim *test_load(const SingeSimDef *hooks, const TestBytes *bytes) {
    SingeSimDef standard = singe_default_sim();
    SingeSim *sim;
    SingeError error = {0};
    if (singe_sim_load(hooks ? hooks : &standard, bytes->data, bytes->size, &sim, &error))
        fail_msg("load: %s", error.message);
    return sim;
}

SingeSim *test_reload(const SingeSimDef *hooks, SingeSim *sim) {
    OwnTestBytes bytes = test_save(sim);
    return test_load(hooks, &bytes);
}

void test_assert_saved(SingeSim *sim, const TestBytes *bytes) {
    OwnTestBytes now = test_save(sim);
    assert_int_equal(now.size, bytes->size);
    assert_memory_equal(now.data, bytes->data, now.size);
}
