// A flat grid sheet with its shell, state and events, for the tests of burn and ablate.
#pragma once

#include "support/support.h"

#include "ablate/ablate.h"
#include "burn/burn.h"
#include "shell/shell.h"

typedef struct BurningSheet {
    Memory memory;
    Shell shell;
    State state;
    BurnAir air;
    EventList events;
    SingeError error;
    uint32_t nx, ny;
} BurningSheet;

/// One step of a stage on the sheet, with nothing around it.
static inline StepContext sheet_context(BurningSheet *b, Pool *pool, float h, float pace) {
    return (StepContext){.shell = &b->shell,
                         .state = state_input(&b->state),
                         .pool = pool,
                         .events = &b->events,
                         .error = &b->error,
                         .h = h,
                         .pace = pace,
                         .ambient_temperature = 293};
}

static inline SingeResult sheet_burn(BurningSheet *b, Pool *pool, float h, float pace, const float *thickening,
                                     double *partial) {
    StepContext context = sheet_context(b, pool, h, pace);
    context.state.burn = NULL;
    return burn_step(&context, thickening, partial, &b->air, &b->state.burn);
}

static inline void sheet_ablate(BurningSheet *b, AblatePlan *plan) {
    StepContext context = sheet_context(b, NULL, 0, 1);
    context.state.ablate = NULL;
    ablate_step(plan, &context, &b->state.ablate);
}

/// m_min 0.15, m_loss 0.25, p = 0, mu = 1e-3 1/(K s), T_ign 500 K, constant density, the paper's shrinkage; its
/// burning does not heat it.
static inline SingeMaterialDef plain_material(void) {
    SingeMaterialDef material = singe_default_material();
    material.mass_min = singe_param(0.15f), material.char_yield = singe_param(0);
    material.mass_loss = singe_param(0.25f);
    material.ash_exponent = singe_param(0);
    material.mass_rate = singe_param(1e-3f);
    material.heat_share = singe_param(0);
    material.rate_ceiling = material.air_supply = singe_param(INFINITY);
    material.ignition_temperature = singe_param(500);
    material.temperature = singe_param(300);
    material.ash_density = singe_param(1);
    material.shrink_front = material.shrink_back = singe_param(1);
    material.fibre_shrink = singe_param(1);
    return material;
}

/// A source of nx by ny square cells with side `cell` (m) in the plane z = 0, its corner at x = `left`.
static inline SheetSource grid_source(Memory *memory, uint32_t nx, uint32_t ny, float cell, float left,
                                      const SingeMaterialDef *material, float drop_pieces_below) {
    SheetSource source;
    TestMesh mesh = test_grid(nx, ny, cell, cell);
    test_mesh_move(&mesh, left, 0, 0);
    SingeSheetDef def = test_sheet(&mesh);
    def.material = *material;
    def.drop_pieces_below = drop_pieces_below;
    assert_int_equal(sheet_source_create(memory, &def, &source, NULL), SINGE_OK);
    test_mesh_free(&mesh);
    return source;
}

/// `sheets` equal grids side by side, a metre apart, with vertices in reserve for tears.
static inline BurningSheet *burning_spare_sheets(uint32_t sheets, uint32_t nx, uint32_t ny, float cell,
                                                 const SingeMaterialDef *material, float drop_pieces_below,
                                                 uint32_t spares) {
    BurningSheet *b = calloc(1, sizeof *b);
    SheetSource sources[4];

    b->memory = memory_make((SingeAllocator){0});
    b->nx = nx, b->ny = ny;
    for (uint32_t k = 0; k < sheets; k++)
        sources[k] = grid_source(&b->memory, nx, ny, cell, (float)k, material, drop_pieces_below);
    for (uint32_t k = 0; k < sheets; k++) sources[k].sheet.spare_count = spares;

    assert_int_equal(shell_create(&b->memory, sources, sheets, &b->shell, &b->error), SINGE_OK);
    assert_int_equal(state_create(&b->memory, &b->shell, &b->state), SINGE_OK);
    assert_int_equal(burn_air_create(&b->memory, &b->shell, &b->air), SINGE_OK);
    for (uint32_t k = 0; k < sheets; k++) sheet_source_free(&b->memory, &sources[k]);
    b->events.capacity = 4096;
    b->events.items = calloc(b->events.capacity, sizeof *b->events.items);
    return b;
}

static inline BurningSheet *burning_sheets(uint32_t sheets, uint32_t nx, uint32_t ny, float cell,
                                           const SingeMaterialDef *material, float drop_pieces_below) {
    return burning_spare_sheets(sheets, nx, ny, cell, material, drop_pieces_below, 0);
}

static inline BurningSheet *burning_sheet(uint32_t nx, uint32_t ny, float cell, const SingeMaterialDef *material) {
    return burning_sheets(1, nx, ny, cell, material, 0);
}

/// A field of the sheet with a value at every particle, for a test to set.
static inline float *burning_sheet_vary(BurningSheet *b, Field *field) {
    assert_true(field_vary(&b->memory, field, b->shell.particle_count));
    return field->values;
}

static inline void burning_sheet_free(BurningSheet *b) {
    burn_air_free(&b->memory, &b->air);
    state_free(&b->memory, &b->state);
    shell_free(&b->memory, &b->shell);
    assert_int_equal(b->memory.held, 0);
    free(b->events.items);
    free(b);
}

static inline void burning_sheet_end(BurningSheet **b) { burning_sheet_free(*b); }
#define OwnBurningSheet OWNED(burning_sheet_end) BurningSheet

static inline uint32_t corner_at(const BurningSheet *b, uint32_t i, uint32_t j) { return j * (b->nx + 1) + i; }
static inline uint32_t cell_at(const BurningSheet *b, uint32_t i, uint32_t j) { return j * b->nx + i; }
static inline uint32_t centre_at(const BurningSheet *b, uint32_t i, uint32_t j) {
    return shell_centre(&b->shell, cell_at(b, i, j));
}

/// Mass of particles alive, kg.
static inline double mass_left(const BurningSheet *b) {
    double mass = 0;
    for (uint32_t i = 0; i < b->shell.particle_count; i++)
        if (b->state.ablate.particle_flags[i] & SINGE_ALIVE)
            mass += (double)b->state.burn.mass[i] * (double)b->shell.matter.mass[i];
    return mass;
}
