#include "bench/burning.h"

#include "bench/hung_sheet.h"

#define TRY(call)                     \
    do {                              \
        SingeResult result_ = (call); \
        if (result_) return result_;  \
    } while (0)

static SingeResult burning_fill(SingeSim *sim, const BenchOptions *options, double springs) {
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId sheet_id;
    const SingeField noise = {.kind = SINGE_FIELD_NOISE, .noise = {0.05f, 4, 1}};
    const float rate = sheet.material.mass_rate.value;
    sheet.material.mass_rate = singe_param_field(rate, 2 * rate, &noise);
    if (options->curvature.count) sheet.material.curvature_max = singe_param((float)options->curvature.values[0]);
    TRY(sheet_add(sim, &sheet, options_cells(springs), 0.3f, true, &sheet_id));
    TRY(singe_sim_commit(sim));

    SingePinDef pin = singe_default_pin();
    SingePinId pin_id;
    const float corners[6] = {0, 0, 0.3f, 0.3f, 0, 0.3f};
    pin.sheet = sheet_id;
    pin.point_count = 2;
    pin.points = corners;
    pin.radius = 0.01f;
    TRY(singe_sim_add_pin(sim, &pin, &pin_id));

    const SingePoseKey across[2] = {{0, {0.05f, 0, 0.1f}, {0, 0, 0, 1}}, {2, {0.25f, 0, 0.1f}, {0, 0, 0, 1}}};
    SingeSourceDef ball = singe_default_source();
    SingeSourceId source_id;
    ball.kind = SINGE_SOURCE_BALL;
    ball.radius = 0.04f;
    ball.falloff = 0.02f;
    ball.path_count = 2;
    ball.path = across;
    ball.conductance = 1000;
    TRY(singe_sim_add_source(sim, &ball, &source_id));

    const SingePoseKey ground = {0, {0, 0, 0.005f}, {0, 0, 0, 1}}; // the sheet's lower edge lies on it
    const SingePoseKey centre = {0, {0.15f, 0.048f, 0.12f}, {0, 0, 0, 1}};
    SingeColliderDef plane = singe_default_collider(), sphere = singe_default_collider();
    SingeColliderId id;
    plane.path_count = 1;
    plane.path = &ground;
    TRY(singe_sim_add_collider(sim, &plane, &id));
    sphere.kind = SINGE_COLLIDER_SPHERE;
    sphere.radius = 0.05f;
    sphere.path_count = 1;
    sphere.path = &centre;
    return singe_sim_add_collider(sim, &sphere, &id);
}

SingeResult burning_build(const BenchOptions *options, const SingeAllocator *allocator, double springs, float pace,
                          SingeSim **sim, SingeError *error) {
    BenchSetup setup = sheet_setup(options, BENCH_SWING, 20);
    SingeSimDef def = singe_default_sim();
    def.thread_count = options->threads;
    def.instructions = options->instructions;
    def.solver = setup.solver;
    def.pace = pace;
    def.surface_detail = (float)options->detail;
    def.contact.enabled = options->contact;
    if (allocator) def.allocator = *allocator;
    SingeResult result = singe_sim_create(&def, sim, error);
    if (result) return result;
    result = burning_fill(*sim, options, springs);
    return result ? bench_give_up(sim, result, error) : SINGE_OK;
}
