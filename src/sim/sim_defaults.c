// The default Defs. Where the numbers come from: docs/materials.md, Office paper, and docs/equations/parameters.md.
#include "singe/types.h"

#include <math.h>
#include <string.h>

SingeParam singe_param(float value) { return (SingeParam){.value = value, .to = value}; }

/// Fields that the parameters of the default material follow; zeroed if there is none.
static const struct {
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) SingeField name;
#define SINGE_PARAM_BACK SINGE_PARAM
#include "singe/material.def"
} standard_fields = {
#define EVEN(value) .kind = SINGE_FIELD_NONE
#define NOISE(from, to, scale, octaves, seed) .kind = SINGE_FIELD_NOISE, .noise = {scale, octaves, seed}
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) .name = {standard},
#define SINGE_PARAM_BACK SINGE_PARAM
#include "singe/material.def"
#undef EVEN
#undef NOISE
};

static SingeParam standard_param(float from, float to, const SingeField *field) {
    return (SingeParam){from, to, field->kind == SINGE_FIELD_NONE ? NULL : field};
}

static SingeMaterialDef standard_material(void) {
    SingeMaterialDef def = {
        .struct_size = sizeof def,
#define EVEN(value) value, value
#define NOISE(from, to, scale, octaves, seed) from, to
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    .name = standard_param(standard, &standard_fields.name),
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_SCALAR(type, name, standard, text) .name = standard,
#include "singe/material.def"
    };
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        def.weight[colour] = singe_param(1);
        def.compliance[colour] = singe_param(0);
    }
    def.compliance[SINGE_RED] = singe_param(1);
    def.compliance[SINGE_GREEN] = singe_param(0.1f);
    def.compliance[SINGE_YELLOW] = singe_param(0.02f);
    return def;
}

static SingeSheetDef standard_sheet(void) {
    return (SingeSheetDef){.struct_size = sizeof(SingeSheetDef), .material = standard_material()};
}

static SingeSourceDef standard_source(void) {
    return (SingeSourceDef){
        .struct_size = sizeof(SingeSourceDef),
        .kind = SINGE_SOURCE_SPOT,
        .start = 0,
        .end = INFINITY,
        .temperature = 1200,
        .conductance = 150,
        .radius = 0.005f,
        .falloff = 0.01f,
        .flux = 30e3f,
    };
}

static SingeColliderDef standard_collider(void) {
    return (SingeColliderDef){
        .struct_size = sizeof(SingeColliderDef),
        .kind = SINGE_COLLIDER_PLANE,
        .radius = 0.05f,
        .half_size = {0.05f, 0.05f, 0.05f},
        .height = 0.1f,
        .friction = 0.4f,
        .offset = 0.0005f,
        .temperature = 293.15f,
        .contact_distance = 0.002f,
        .size = {0.2f, 0.2f},
        .rotation = {0, 0, 0, 1},
    };
}

static SingePinDef standard_pin(void) { return (SingePinDef){.struct_size = sizeof(SingePinDef), .radius = 0.005f}; }

static SingeWindDef standard_wind(void) {
    return (SingeWindDef){.struct_size = sizeof(SingeWindDef), .gust_time = 0.5f, .gust_size = 0.3f, .seed = 1};
}

static SingeSolverDef standard_solver(void) {
    return (SingeSolverDef){
        .struct_size = sizeof(SingeSolverDef),
        .method = SINGE_SOLVER_STRAND,
        .substeps = 3,
        .projections = 1,
        .order = {SINGE_GREEN, SINGE_RED, SINGE_YELLOW, SINGE_BLUE},
        .regularisation = {[SINGE_RED] = 2, [SINGE_GREEN] = 0.1f, [SINGE_BLUE] = 1e-3f, [SINGE_YELLOW] = 0.01f},
        .attachments = true,
        .early_exit = true,
        .tolerance = 1e-7f,
        .stiffness = 1000,
        .smoothing = 170,
        .smoothing_length = 0.02f,
        .height_min = 0.3f,
        .height_gain = 0.5f,
    };
}

static SingeSolverDef method_solver(SingeSolverMethod method) {
    SingeSolverDef def = standard_solver();
    if (method == SINGE_SOLVER_STRAND) return def;
    const SingeColour order[] = {SINGE_RED, SINGE_GREEN, SINGE_BLUE, SINGE_YELLOW};
    def.method = method;
    def.substeps = method == SINGE_SOLVER_MASS_SPRING ? 200 : 1;
    def.projections = method == SINGE_SOLVER_MASS_SPRING ? 1 : 7;
    def.smoothing = def.height_min = 0; // the paper has neither
    def.attachments = false;
    memcpy(def.order, order, sizeof order);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) def.regularisation[colour] = 1e-4f;
    return def;
}

static SingeGasDef standard_gas(void) {
    return (SingeGasDef){
        .struct_size = sizeof(SingeGasDef),
        .height = 0.25f,
        .conductance = 10,
        .radiated = 0.3f,
        .soot = 0.01f,
    };
}

static SingeContactDef standard_contact(void) {
    return (SingeContactDef){.struct_size = sizeof(SingeContactDef), .thickness = 0.5e-3f, .friction = 0.3f};
}

static SingeSimDef standard_sim(void) {
    return (SingeSimDef){
        .struct_size = sizeof(SingeSimDef),
        .thread_count = 1,
        .seed = 1,
        .time_step = 1.0f / 480,
        .pace = 1,
        .gravity = {0, 0, -9.81f},
        .ambient_temperature = 293.15f,
        .air_density = 1.2f,
        .heat_tolerance = 1e-5f,
        .wind = standard_wind(),
        .solver = standard_solver(),
        .surface_detail = 0,
        .surface_raggedness = 2e-3f,
        .gas = standard_gas(),
        .contact = standard_contact(),
    };
}

/// Fills a caller's part of `size` bytes with our `known` bytes; zero where it is longer.
static void defaults_fill(void *part, size_t size, const void *standard, size_t known) {
    memset(part, 0, size);
    memcpy(part, standard, size < known ? size : known);
}

static void fill_def(void *def, size_t size, const void *standard, size_t known) {
    if (size < sizeof size) return;
    defaults_fill(def, size, standard, known);
    memcpy(def, &size, sizeof size);
}

/// The size stored in a Def inside another, at most the bytes left.
static size_t inner_size(const void *inner, size_t left) {
    size_t size = 0;
    if (left >= sizeof size) memcpy(&size, inner, sizeof size);
    return size < left ? size : left;
}

void singe_init_material(SingeMaterialDef *def, size_t struct_size) {
    const SingeMaterialDef standard = standard_material();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_source(SingeSourceDef *def, size_t struct_size) {
    const SingeSourceDef standard = standard_source();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_collider(SingeColliderDef *def, size_t struct_size) {
    const SingeColliderDef standard = standard_collider();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_pin(SingePinDef *def, size_t struct_size) {
    const SingePinDef standard = standard_pin();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_wind(SingeWindDef *def, size_t struct_size) {
    const SingeWindDef standard = standard_wind();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_solver(SingeSolverDef *def, size_t struct_size) {
    singe_init_solver_method(def, struct_size, SINGE_SOLVER_STRAND);
}

void singe_init_gas(SingeGasDef *def, size_t struct_size) {
    const SingeGasDef standard = standard_gas();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_contact(SingeContactDef *def, size_t struct_size) {
    const SingeContactDef standard = standard_contact();
    fill_def(def, struct_size, &standard, sizeof standard);
}

void singe_init_solver_method(SingeSolverDef *def, size_t struct_size, SingeSolverMethod method) {
    const SingeSolverDef standard = method_solver(method);
    fill_def(def, struct_size, &standard, sizeof standard);
}

// The Defs inside these have grown separately: the field after one is found by the size that the caller's header gave
// it.

void singe_init_sheet(SingeSheetDef *def, size_t struct_size) {
    const SingeSheetDef standard = standard_sheet();
    const size_t head = offsetof(SingeSheetDef, material), tail = offsetof(SingeSheetDef, velocity);
    char *bytes = (char *)def;
    if (struct_size <= head) {
        fill_def(def, struct_size, &standard, head);
        return;
    }
    size_t inner = inner_size(bytes + head, struct_size - head);
    fill_def(def, head, &standard, head);
    memcpy(def, &struct_size, sizeof struct_size);
    fill_def(bytes + head, inner, &standard.material, sizeof standard.material);
    defaults_fill(bytes + head + inner, struct_size - head - inner, (const char *)&standard + tail,
                  sizeof standard - tail);
}

void singe_init_sim(SingeSimDef *def, size_t struct_size) {
    const SingeSimDef standard = standard_sim();
    const size_t head = offsetof(SingeSimDef, wind);
    char *bytes = (char *)def;
    if (struct_size <= head) {
        fill_def(def, struct_size, &standard, head);
        return;
    }

    // sizes of the Defs inside
    size_t wind = inner_size(bytes + head, struct_size - head), left = struct_size - head - wind;
    size_t solver = inner_size(bytes + head + wind, left);
    size_t gas = inner_size(bytes + head + wind + solver, left - solver);

    // fill each by its size
    fill_def(def, head, &standard, head);
    memcpy(def, &struct_size, sizeof struct_size);
    fill_def(bytes + head, wind, &standard.wind, sizeof standard.wind);
    fill_def(bytes + head + wind, solver, &standard.solver, sizeof standard.solver);
    fill_def(bytes + head + wind + solver, gas, &standard.gas, sizeof standard.gas);
    left -= solver + gas;
    bytes += head + wind + solver + gas;
    size_t contact = inner_size(bytes, left);
    fill_def(bytes, contact, &standard.contact, sizeof standard.contact);
    memset(bytes + contact, 0, left - contact);
}
