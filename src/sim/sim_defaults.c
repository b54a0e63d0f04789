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

static SingeMaterialDef standard_material(void) {
    SingeMaterialDef def = {
        .struct_size = sizeof def,
#define EVEN(value) value, value
#define NOISE(from, to, scale, octaves, seed) from, to
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    .name = {standard, standard_fields.name.kind == SINGE_FIELD_NONE ? NULL : &standard_fields.name},
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) .name = standard,
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

// The defaults of the tables' rows (singe/*.def). Defs inside others are filled in by singe_init_...
#define BRACED(...) \
    { __VA_ARGS__ }
#define SINGE_ROWS_STAY
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) .name = standard,
#define SINGE_APART(key, type, name, length, dimension, standard, range, kinds, text) .name = standard,
#define SINGE_OTHER(declaration, name, standard, text) .name = standard,
#define SINGE_HIDDEN SINGE_FIELD
#define SINGE_HOOK SINGE_FIELD

static const SingeSheetDef standard_sheet = {
    .struct_size = sizeof(SingeSheetDef),
#include "singe/sheet.def"
};

static const SingeSourceDef standard_source = {
    .struct_size = sizeof(SingeSourceDef),
#include "singe/source.def"
};

static const SingeColliderDef standard_collider = {
    .struct_size = sizeof(SingeColliderDef),
#include "singe/collider.def"
};

static const SingePinDef standard_pin = {
    .struct_size = sizeof(SingePinDef),
#include "singe/pin.def"
};

static const SingeWindDef standard_wind = {
    .struct_size = sizeof(SingeWindDef),
#include "singe/wind.def"
};

static const SingeSolverDef standard_solver = {
    .struct_size = sizeof(SingeSolverDef),
#include "singe/solver.def"
};

static const SingeGasDef standard_gas = {
    .struct_size = sizeof(SingeGasDef),
#include "singe/gas.def"
};

static const SingeContactDef standard_contact = {
    .struct_size = sizeof(SingeContactDef),
#include "singe/contact.def"
};

static const SingeSimDef standard_sim = {
    .struct_size = sizeof(SingeSimDef),
#include "singe/sim.def"
};

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
    fill_def(def, struct_size, &standard_source, sizeof standard_source);
}

void singe_init_collider(SingeColliderDef *def, size_t struct_size) {
    fill_def(def, struct_size, &standard_collider, sizeof standard_collider);
}

void singe_init_pin(SingePinDef *def, size_t struct_size) {
    fill_def(def, struct_size, &standard_pin, sizeof standard_pin);
}

void singe_init_wind(SingeWindDef *def, size_t struct_size) {
    fill_def(def, struct_size, &standard_wind, sizeof standard_wind);
}

void singe_init_solver(SingeSolverDef *def, size_t struct_size) {
    singe_init_solver_method(def, struct_size, SINGE_SOLVER_STRAND);
}

void singe_init_gas(SingeGasDef *def, size_t struct_size) {
    fill_def(def, struct_size, &standard_gas, sizeof standard_gas);
}

void singe_init_contact(SingeContactDef *def, size_t struct_size) {
    fill_def(def, struct_size, &standard_contact, sizeof standard_contact);
}

void singe_init_solver_method(SingeSolverDef *def, size_t struct_size, SingeSolverMethod method) {
    if (method == SINGE_SOLVER_STRAND) {
        fill_def(def, struct_size, &standard_solver, sizeof standard_solver);
        return;
    }

    SingeSolverDef other = standard_solver;
    static const SingeColour order[] = {SINGE_RED, SINGE_GREEN, SINGE_BLUE, SINGE_YELLOW};

    other.method = method;
    other.substeps = method == SINGE_SOLVER_MASS_SPRING ? 200 : 1;
    other.projections = method == SINGE_SOLVER_MASS_SPRING ? 1 : 7;
    other.smoothing = 0;  // the paper has neither this
    other.height_min = 0; // nor this
    other.attachments = false;
    memcpy(other.order, order, sizeof order);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) other.regularisation[colour] = 1e-4f;
    fill_def(def, struct_size, &other, sizeof other);
}

// The Defs inside these have grown separately: the field after one is found by the size that the caller's header gave
// it.

void singe_init_sheet(SingeSheetDef *def, size_t struct_size) {
    const SingeMaterialDef material = standard_material();
    const size_t head = offsetof(SingeSheetDef, material), tail = offsetof(SingeSheetDef, velocity);
    char *bytes = (char *)def;
    if (struct_size <= head) {
        fill_def(def, struct_size, &standard_sheet, head);
        return;
    }
    size_t inner = inner_size(bytes + head, struct_size - head);
    fill_def(def, head, &standard_sheet, head);
    memcpy(def, &struct_size, sizeof struct_size);
    fill_def(bytes + head, inner, &material, sizeof material);
    defaults_fill(bytes + head + inner, struct_size - head - inner, (const char *)&standard_sheet + tail,
                  sizeof standard_sheet - tail);
}

void singe_init_sim(SingeSimDef *def, size_t struct_size) {
    const size_t head = offsetof(SingeSimDef, wind);
    char *bytes = (char *)def;

    if (struct_size <= head) {
        fill_def(def, struct_size, &standard_sim, head);
        return;
    }

    // sizes of the Defs inside
    size_t wind = inner_size(bytes + head, struct_size - head), left = struct_size - head - wind;
    size_t solver = inner_size(bytes + head + wind, left);
    size_t gas = inner_size(bytes + head + wind + solver, left - solver);

    // fill each by its size
    fill_def(def, head, &standard_sim, head);
    memcpy(def, &struct_size, sizeof struct_size);
    fill_def(bytes + head, wind, &standard_wind, sizeof standard_wind);
    fill_def(bytes + head + wind, solver, &standard_solver, sizeof standard_solver);
    fill_def(bytes + head + wind + solver, gas, &standard_gas, sizeof standard_gas);
    left -= solver + gas;
    bytes += head + wind + solver + gas;

    size_t contact = inner_size(bytes, left);
    fill_def(bytes, contact, &standard_contact, sizeof standard_contact);
    memset(bytes + contact, 0, left - contact);
}
