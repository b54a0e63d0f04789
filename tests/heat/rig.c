#include "rig.h"

#include "common/random.h"
#include "support/support.h"

RigDef rig_default(int nx, int ny, float dx, float dy) {
    RigDef def = {.nx = nx, .ny = ny, .dx = dx, .dy = dy, .material = singe_default_material()};
    def.material.diffusivity = singe_param(1e-4f);
    def.material.convection = singe_param(0);
    def.material.emissivity = singe_param(0);
    def.material.thickening = 1;
    def.settings = (HeatSettings){.ambient_temperature = 293, .tolerance = 1e-7f, .pace = 1};
    return def;
}

Rig rig_open(const RigDef *def) {
    Rig rig = {.memory = memory_make((SingeAllocator){0}),
               .nx = def->nx,
               .ny = def->ny,
               .settings = def->settings,
               .h = 0.002f};

    TestMesh mesh = test_grid((uint32_t)def->nx, (uint32_t)def->ny, def->dx, def->dy);
    for (int j = 0; def->shape && j <= def->ny; j++)
        for (int i = 0; i <= def->nx; i++) def->shape(mesh.positions + 3 * (j * (def->nx + 1) + i), i, j);
    SingeSheetDef sheet = test_sheet(&mesh);
    sheet.material = def->material;

    SheetSource source;
    if (sheet_source_create(&rig.memory, &sheet, &source, &rig.error) ||
        shell_create(&rig.memory, &source, 1, &rig.shell, &rig.error))
        fail_msg("%s", rig.error.message);

    sheet_source_free(&rig.memory, &source);
    test_mesh_free(&mesh);
    assert_int_equal(state_create(&rig.memory, &rig.shell, &rig.state), SINGE_OK);
    assert_int_equal(heat_plan_create(&rig.memory, &rig.shell, &rig.settings, &rig.plan, &rig.error), SINGE_OK);
    rig.sources = (SourceList){.capacity = 2, .items = calloc(2, sizeof(Source))};
    rig.colliders = (ColliderList){.capacity = 1, .items = calloc(1, sizeof(Collider))};
    return rig;
}

void rig_close(Rig *rig) {
    for (uint32_t k = 0; k < rig->sources.count; k++) source_free(&rig->memory, &rig->shell, &rig->sources.items[k]);
    for (uint32_t k = 0; k < rig->colliders.count; k++) path_free(&rig->colliders.items[k].path, &rig->memory);
    free(rig->sources.items), free(rig->colliders.items);
    pool_destroy(&rig->memory, rig->pool);
    heat_plan_free(&rig->memory, rig->plan);
    state_free(&rig->memory, &rig->state);
    shell_free(&rig->memory, &rig->shell);
    assert_int_equal(rig->memory.held, 0);
}

SingeResult rig_try_step(Rig *rig) {
    SingeView view = {.time = rig->state.time,
                      .particle_count = rig->shell.particle_count,
                      .temperature = rig->state.heat.temperature};
    StepContext context = {.shell = &rig->shell,
                           .state = state_input(&rig->state),
                           .colliders = &rig->colliders,
                           .sources = &rig->sources,
                           .view = &view,
                           .pool = rig->pool,
                           .error = &rig->error,
                           .h = rig->h};
    context.state.heat = NULL;
    return heat_step(rig->plan, &context, &rig->state.heat, &rig->counters);
}

void rig_step(Rig *rig) {
    if (rig_try_step(rig)) fail_msg("%s", rig->error.message);
    rig->state.time += (double)rig->h;
    rig->state.step++;
}

void rig_source(Rig *rig, const SingeSourceDef *def) {
    Source *source = &rig->sources.items[rig->sources.count];
    if (source_create(&rig->memory, &rig->shell, def, source, &rig->error)) fail_msg("%s", rig->error.message);
    source->generation = 1;
    rig->sources.count++;
}

void rig_remove(Rig *rig, uint32_t particle) {
    AblateState *ablate = &rig->state.ablate;
    if (!(ablate->particle_flags[particle] & SINGE_ALIVE)) return;
    ablate->particle_flags[particle] = 0;

    double capacity = (double)rig->shell.matter.capacity[particle];
    rig->removed += capacity * ((double)rig->state.heat.temperature[particle] - 293);
    for (int c = 0; c < SINGE_COLOUR_COUNT; c++)
        for (uint32_t k = 0; k < rig->shell.springs[c].count; k++)
            if (rig->shell.springs[c].ends[k][0] == particle || rig->shell.springs[c].ends[k][1] == particle)
                ablate->spring_flags[c][k] = 0;
}

double rig_content(const Rig *rig, int weight) {
    double sum = 0;
    const float *weights = weight ? rig->shell.matter.capacity : rig->shell.matter.area;
    for (uint32_t i = 0; i < rig->shell.particle_count; i++)
        if (rig->state.ablate.particle_flags[i] & SINGE_ALIVE)
            sum += (double)weights[i] * ((double)rig->state.heat.temperature[i] - 293);
    return sum;
}

float rig_random(uint32_t a, uint32_t b) { return random_unit(random_hash(a, b, 17, 4)); }
