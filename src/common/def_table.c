#include "common/def_table.h"

#include "common/error.h"

#include <string.h>

// ---- words

typedef struct DefWord {
    const char *of;
    int value;
} DefWord;

#define SINGE_ROWS_STAY
#define SINGE_WORD(Enum, NAME, value, word, text) {#Enum, NAME},
static const DefWord words[] = {
#include "singe/source.def"
#include "singe/collider.def"
#include "singe/solver.def"
#include "singe/sim.def"
#include "singe/material.def"
};
#undef SINGE_ROWS_STAY
#include "singe/rows_end.def"

bool def_has_value(const char *of, int value) {
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (words[i].value == value && strcmp(words[i].of, of) == 0) return true;
    return false;
}

// ---- tables

#define ALWAYS 0
#define BIT(KIND) (1u << (KIND))

enum {
#define SINGE_DIMENSION(NAME, name, unit) DIM_##NAME,
#include "singe/dimensions.def"
};
static const char *const units[] = {
#define SINGE_DIMENSION(NAME, name, unit) unit,
#include "singe/dimensions.def"
};

#define FLOAT FIELD_FLOAT, NULL
#define VECTOR FIELD_FLOAT, NULL
#define INT FIELD_INT, NULL
#define UINT32 FIELD_UINT32, NULL
#define UINT64 FIELD_UINT64, NULL
#define BOOL FIELD_BOOL, NULL
#define ORDER FIELD_ENUM, "SingeColour"
#define ENUM(name) FIELD_ENUM, #name
#define KIND ENUM
#define SINGE_ROWS_STAY
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) \
    {#name, type, length, offsetof(OF, name), dimension, range, kinds, true},
#define SINGE_APART(key, type, name, length, dimension, standard, range, kinds, text) \
    {#name, type, length, offsetof(OF, name), dimension, range, kinds, true},
#define SINGE_HOOK(type, name, length, dimension, standard, range, kinds, text) \
    {#name, type, length, offsetof(OF, name), dimension, range, kinds, false},
#define SINGE_COUNT(name, text) {#name, UINT32, 1, offsetof(OF, name), DIM_NONE, ANY, ALWAYS, true},
#define SINGE_HIDDEN SINGE_FIELD
#define TABLE(fields) (fields), sizeof(fields) / sizeof *(fields)

#define OF SingeSheetDef
static const DefField sheet_fields[] = {
#include "singe/sheet.def"
};
const DefTable sheet_table = {"sheet", "", TABLE(sheet_fields), 0};
#undef OF

#define OF SingeSourceDef
static const DefField source_fields[] = {
#include "singe/source.def"
};
const DefTable source_table = {"source", "", TABLE(source_fields), offsetof(SingeSourceDef, kind)};
#undef OF

#define OF SingeColliderDef
static const DefField collider_fields[] = {
#include "singe/collider.def"
};
const DefTable collider_table = {"collider", "", TABLE(collider_fields), offsetof(SingeColliderDef, kind)};
#undef OF

#define OF SingePinDef
static const DefField pin_fields[] = {
#include "singe/pin.def"
};
const DefTable pin_table = {"pin", "", TABLE(pin_fields), 0};
#undef OF

#define OF SingeWindDef
static const DefField wind_fields[] = {
#include "singe/wind.def"
};
const DefTable wind_table = {"wind", "", TABLE(wind_fields), 0};
#undef OF

#define OF SingeSolverDef
static const DefField solver_fields[] = {
#include "singe/solver.def"
};
const DefTable solver_table = {"simulation", "solver.", TABLE(solver_fields), 0};
#undef OF

#define OF SingeGasDef
static const DefField gas_fields[] = {
#include "singe/gas.def"
};
const DefTable gas_table = {"simulation", "gas.", TABLE(gas_fields), 0};
#undef OF

#define OF SingeContactDef
static const DefField contact_fields[] = {
#include "singe/contact.def"
};
const DefTable contact_table = {"contact", "", TABLE(contact_fields), 0};
#undef OF

#define OF SingeSimDef
static const DefField sim_fields[] = {
#include "singe/sim.def"
};
const DefTable sim_table = {"simulation", "", TABLE(sim_fields), 0};
#undef OF

#define OF SingeRenderMeshDef
static const DefField render_mesh_fields[] = {
#include "singe/render_mesh.def"
};
const DefTable render_mesh_table = {"render mesh", "", TABLE(render_mesh_fields), 0};
#undef OF

// ---- what follows from them

/// Whether all elements of a field, at `bytes`, are in its range.
static bool field_fits(const DefField *field, const void *bytes) {
    for (int i = 0; i < field->length; i++) {
        if (field->type == FIELD_ENUM) {
            int value;
            memcpy(&value, (const char *)bytes + i * (int)sizeof value, sizeof value);
            if (!def_has_value(field->words, value)) return false;
        }
        if (!field->range.words) continue;

        float number = 0;
        if (field->type == FIELD_FLOAT) memcpy(&number, (const char *)bytes + i * (int)sizeof number, sizeof number);
        if (field->type == FIELD_INT) {
            int value;
            memcpy(&value, (const char *)bytes + i * (int)sizeof value, sizeof value);
            number = (float)value;
        }
        if (!range_has(&field->range, number)) return false;
    }

    return true;
}

static SingeResult field_fail(const DefTable *table, const DefField *field, const char *stage, SingeError *error) {
    if (field->type == FIELD_ENUM)
        return error_set(error, SINGE_ERROR_ARGUMENT, stage, -1, "%s%s is not one of %s", table->prefix, field->name,
                         field->words);
    const char *unit = units[field->dimension];
    return error_set(error, SINGE_ERROR_ARGUMENT, stage, -1, "%s%s must be %s%s%s", table->prefix, field->name,
                     field->range.words, unit[0] ? " " : "", unit);
}

SingeResult def_check(const DefTable *table, const void *def, SingeError *error) {
    int kind = 0;
    if (table->kind) memcpy(&kind, (const char *)def + table->kind, sizeof kind);

    for (int i = 0; i < table->count; i++) {
        const DefField *field = &table->fields[i];
        const bool has = !field->kinds || (kind >= 0 && kind < 32 && (field->kinds >> kind & 1));
        if (has && !field_fits(field, (const char *)def + field->offset))
            return field_fail(table, field, table->stage, error);
    }

    return SINGE_OK;
}

SingeResult def_check_field(const DefTable *table, const char *name, const void *value, const char *stage,
                            SingeError *error) {
    for (int i = 0; i < table->count; i++) {
        const DefField *field = &table->fields[i];
        if (strcmp(field->name, name) == 0)
            return field_fits(field, value) ? SINGE_OK : field_fail(table, field, stage, error);
    }
    return error_set(error, SINGE_ERROR_ARGUMENT, stage, -1, "there is no %s", name);
}

void def_stream(Stream *stream, const DefTable *table, void *def, size_t first, size_t end) {
    static const size_t sizes[] = {
        [FIELD_FLOAT] = sizeof(float),     [FIELD_INT] = sizeof(int),      [FIELD_UINT32] = sizeof(uint32_t),
        [FIELD_UINT64] = sizeof(uint64_t), [FIELD_BOOL] = sizeof(uint8_t), [FIELD_ENUM] = sizeof(int)};
    for (int i = 0; i < table->count; i++) {
        const DefField *field = &table->fields[i];
        char *at = (char *)def + field->offset;
        if (!field->stored || field->offset < first || field->offset >= end) continue;

        if (field->type == FIELD_BOOL) {
            uint8_t byte = *(bool *)at;
            STREAM(stream, byte);
            if (stream->mode == STREAM_READ) *(bool *)at = byte != 0;
        } else {
            stream_data(stream, at, (size_t)field->length * sizes[field->type]);
        }
    }
}
