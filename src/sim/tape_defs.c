// Defs in a recording. The fields of the tables (singe/*.def) and the parameters of a material go by the hashes of their
// names, so that tables may change: what an older recording lacks has its default.
#include "sim/tape.h"

#include "sim/sim_internal.h"

#include <string.h>

_Static_assert(sizeof(SingePoseKey) == 8 * sizeof(float), "a key is eight floats");
_Static_assert(sizeof(SingeValueKey) == 2 * sizeof(float), "a key is two floats");
_Static_assert(sizeof(int) == 4, "an int has the same bytes everywhere");

/// Elements of an array that the library reads at most: with more it refuses the Def before it reads any.
static const uint64_t array_max = INT32_MAX;

static size_t field_width(const DefField *field) {
    return field->type == FIELD_UINT64 ? 8 : field->type == FIELD_BOOL ? 1 : 4;
}

/// FNV-1a.
static uint32_t name_hash(const char *name) {
    uint32_t hash = 2166136261u;
    for (; *name; name++) hash = (hash ^ (uint8_t)*name) * 16777619u;
    return hash;
}

/// The stored fields of a table: their number, and of each the hash of its name, its bytes, and these.
static void tape_table(Tape *tape, const DefTable *table, void *def) {
    const bool reads = tape->mode == STREAM_READ;
    uint32_t count = 0;
    for (int i = 0; i < table->count; i++) count += table->fields[i].stored;
    TAPE(tape, count);

    int next = 0;
    for (uint32_t k = 0; k < count && !tape->failed; k++) {
        while (!reads && !table->fields[next].stored) next++;
        const DefField *field = reads ? NULL : &table->fields[next++];
        uint32_t name = field ? name_hash(field->name) : 0;
        uint32_t size = field ? (uint32_t)field->length * (uint32_t)field_width(field) : 0;

        TAPE(tape, name);
        TAPE(tape, size);
        for (int i = 0; reads && i < table->count && !field; i++)
            if (table->fields[i].stored && name_hash(table->fields[i].name) == name) field = &table->fields[i];

        if (!field || size != (uint32_t)field->length * (uint32_t)field_width(field)) { // of another version
            if (size > tape->size - tape->offset) tape->failed = true;
            else tape->offset += size;
        } else if (field->type == FIELD_BOOL) {
            tape_bool(tape, (bool *)((char *)def + field->offset));
        } else {
            tape_data(tape, (char *)def + field->offset, (uint64_t)field->length, field_width(field));
        }
    }
}

void tape_path(Tape *tape, uint32_t *count, const SingePoseKey **path) {
    TAPE(tape, *count);
    tape_array(tape, path, 8 * (uint64_t)*count, sizeof(float));
}

void tape_sim_def(Tape *tape, SingeSimDef *def) {
    tape_table(tape, &sim_table, def);
    tape_table(tape, &wind_table, &def->wind);
    tape_table(tape, &solver_table, &def->solver);
    tape_table(tape, &gas_table, &def->gas);
    tape_table(tape, &contact_table, &def->contact);
}

// ---- materials

static void tape_texture(Tape *tape, SingeTexture *texture) {
    TAPE(tape, texture->width);
    TAPE(tape, texture->height);
    const bool empty = texture->width < 1 || texture->height < 1;
    const uint64_t count = empty ? 0 : (uint64_t)texture->width * (uint64_t)texture->height;
    if (empty) texture->values = NULL; // nobody reads it
    tape_array(tape, &texture->values, count, sizeof(float));
}

static void tape_field(Tape *tape, SingeField *field) {
    int kind = (int)field->kind;
    TAPE(tape, kind);
    field->kind = (SingeFieldKind)kind;
    if (kind == SINGE_FIELD_TEXTURE) tape_texture(tape, &field->texture);
    if (kind == SINGE_FIELD_ATTRIBUTE) tape_text(tape, &field->attribute);
    if (kind != SINGE_FIELD_NOISE) return;

    TAPE(tape, field->noise.scale);
    TAPE(tape, field->noise.octaves);
    TAPE(tape, field->noise.seed);
}

/// Parameter `index` of a material, and its field unless one before it has the same.
static void tape_param(Tape *tape, SingeParam *const *params, uint32_t index) {
    enum { EVEN, NEW_FIELD, SAME_FIELD };
    SingeParam *param = params[index];
    uint32_t other = 0;
    uint8_t follows = EVEN;

    TAPE(tape, param->value);
    TAPE(tape, param->to);
    if (tape->mode != STREAM_READ && param->field) {
        while (other < index && params[other]->field != param->field) other++;
        follows = other < index ? SAME_FIELD : NEW_FIELD;
    }

    TAPE(tape, follows);
    if (follows == SAME_FIELD) {
        TAPE(tape, other);
        if (other >= index) tape->failed = true;
        else param->field = params[other]->field;
    } else if (follows == NEW_FIELD) {
        SingeField field = tape->mode == STREAM_READ ? (SingeField){0} : *param->field;
        SingeField *copy = tape->mode == STREAM_READ ? tape_new(tape, sizeof *copy) : &field;
        if (!copy) return;
        tape_field(tape, copy);
        if (tape->mode == STREAM_READ) param->field = copy;
    } else if (tape->mode == STREAM_READ) {
        param->field = NULL;
    }
}

static void tape_enum(Tape *tape, void *value) { tape_data(tape, value, 1, sizeof(int)); }
static void tape_float(Tape *tape, float *value) { TAPE(tape, *value); }

/// Parameters of a material, of which an array by colour is four.
enum {
    MATERIAL_PARAMS = 0
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) +1
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) +SINGE_COLOUR_COUNT
#include "singe/material.def"
};

/// Its parameters: their number, and of each the hash of its name, plus the colour, and its value; then, in the same way,
/// what is one number for the whole sheet.
static void tape_material(Tape *tape, SingeMaterialDef *def) {
    SingeParam *params[MATERIAL_PARAMS];
    uint32_t names[MATERIAL_PARAMS], known = 0;
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    names[known] = name_hash(#name), params[known++] = &def->name;
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text)         \
    for (uint32_t colour = 0; colour < SINGE_COLOUR_COUNT; colour++) \
        names[known] = name_hash(#name) + colour, params[known++] = &def->name[colour];
#include "singe/material.def"

    SingeParam *passed[MATERIAL_PARAMS];
    uint32_t count = known;
    TAPE(tape, count);
    if (count > known) tape->failed = true; // of a newer version
    for (uint32_t i = 0; i < count && !tape->failed; i++) {
        uint32_t name = names[i], at = 0;
        TAPE(tape, name);
        while (at < known && names[at] != name) at++;
        passed[i] = params[at < known ? at : 0];
        if (at == known) tape->failed = true; // the same
        else tape_param(tape, passed, i);
    }

#define TAPE_FLOAT tape_float
#define TAPE_BOOL tape_bool
#define TAPE_ENUM(name) tape_enum
    uint32_t scalars = 0;
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) scalars++;
#include "singe/material.def"
    TAPE(tape, scalars);
    if (tape->mode != STREAM_READ) {
        uint32_t hash;
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) \
    hash = name_hash(#name);                                       \
    TAPE(tape, hash);                                              \
    TAPE_##TYPE(tape, &def->name);
#include "singe/material.def"
        return;
    }
    for (; scalars > 0 && !tape->failed; scalars--) {
        uint32_t hash;
        bool found = false;
        TAPE(tape, hash);
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) \
    if (!found && hash == name_hash(#name)) {                      \
        found = true;                                              \
        TAPE_##TYPE(tape, &def->name);                             \
    }
#include "singe/material.def"
        tape->failed |= !found;
    }
}

// ---- the others

/// Reads the caller's Def, or begins with the defaults. Whether there is more of it.
#define TAPE_GIVEN(tape, given, def, defaults)                                                            \
    do {                                                                                                  \
        *(def) = defaults();                                                                              \
        bool good = (tape)->mode != STREAM_READ && sim_read_def((def), sizeof *(def), (given), SIZE_MAX); \
        tape_bool((tape), &good);                                                                         \
        if (!good) {                                                                                      \
            (def)->struct_size = 0;                                                                       \
            return;                                                                                       \
        }                                                                                                 \
    } while (0)

void tape_wind_def(Tape *tape, const SingeWindDef *given, SingeWindDef *def) {
    TAPE_GIVEN(tape, given, def, singe_default_wind);
    tape_table(tape, &wind_table, def);
}

void tape_material_def(Tape *tape, const SingeMaterialDef *given, SingeMaterialDef *def) {
    TAPE_GIVEN(tape, given, def, singe_default_material);
    tape_material(tape, def);
}

void tape_sheet_def(Tape *tape, const SingeSheetDef *given, SingeSheetDef *def) {
    *def = singe_default_sheet();
    bool good = tape->mode != STREAM_READ && given && sheet_read_def(given, def);
    tape_bool(tape, &good);
    if (!good) {
        def->struct_size = 0;
        return;
    }

    // the mesh; too many elements are refused before any is read
    tape_text(tape, &def->name);
    TAPE(tape, def->vertex_count);
    TAPE(tape, def->cell_count);

    const uint64_t vertices = def->vertex_count, cells = def->cell_count;
    const bool many = vertices + cells > array_max || cells > array_max / 4;
    if (many) {
        def->positions = NULL;
        def->cells = NULL;
        def->uv = def->corner_uv = NULL;
        def->source_vertex = def->corner_source_vertex = NULL;
    }

    tape_array(tape, &def->positions, 3 * vertices, sizeof(float));
    tape_array(tape, &def->cells, 4 * cells, sizeof(uint32_t));
    tape_array(tape, &def->uv, 2 * vertices, sizeof(float));
    tape_array(tape, &def->corner_uv, 8 * cells, sizeof(float));
    tape_array(tape, &def->source_vertex, vertices, sizeof(int32_t));
    tape_array(tape, &def->corner_source_vertex, 4 * cells, sizeof(int32_t));
    TAPE(tape, def->source_count);

    // attributes
    bool named = tape->mode != STREAM_READ && def->attributes && !many;
    TAPE(tape, def->attribute_count);
    tape_bool(tape, &named);

    SingeAttribute *read = NULL;
    if (tape->mode == STREAM_READ) {
        tape->failed |= named && def->attribute_count > tape->size - tape->offset;
        if (named && !tape->failed) read = tape_new(tape, def->attribute_count * (uint64_t)sizeof *read);
        def->attributes = read;
    }

    for (uint32_t i = 0; named && i < def->attribute_count && !tape->failed; i++) {
        SingeAttribute attribute = read ? (SingeAttribute){0} : def->attributes[i];
        tape_text(tape, &attribute.name);
        tape_array(tape, &attribute.values, vertices, sizeof(float));
        if (read) read[i] = attribute;
    }

    tape_table(tape, &sheet_table, def);
    tape_material(tape, &def->material);
}

void tape_source_def(Tape *tape, const SingeSourceDef *given, SingeSourceDef *def) {
    TAPE_GIVEN(tape, given, def, singe_default_source);
    tape_table(tape, &source_table, def);
    tape_data(tape, def->position, 3, sizeof(float));

    const bool textured = source_is_drawn(def);
    if (textured) def->path = NULL; // nobody reads it
    else if (!source_blows(def)) def->strength = NULL;
    tape_array(tape, &def->path, 8 * (uint64_t)def->path_count, sizeof(float));
    TAPE(tape, def->strength_count);
    tape_array(tape, &def->strength, 2 * (uint64_t)def->strength_count, sizeof(float));
    if (textured) tape_texture(tape, &def->texture);

    bool called = tape->mode != STREAM_READ && def->callback;
    tape_bool(tape, &called);
    if (tape->mode != STREAM_READ) return;
    def->callback = called ? tape->callback : NULL;
    def->callback_context = tape->callback_context;
}

void tape_collider_def(Tape *tape, const SingeColliderDef *given, SingeColliderDef *def) {
    TAPE_GIVEN(tape, given, def, singe_default_collider);
    tape_table(tape, &collider_table, def);
    tape_data(tape, def->position, 3, sizeof(float));
    tape_data(tape, def->rotation, 4, sizeof(float));

    // the arrays that its kind has
    const bool mesh = def->kind == SINGE_COLLIDER_MESH || def->kind == SINGE_COLLIDER_DEFORMING;
    const bool field = def->kind == SINGE_COLLIDER_HEIGHTFIELD && def->columns <= 32768 && def->rows <= 32768;
    if (!mesh || def->vertex_count > array_max / 3) def->vertices = NULL;
    if (!mesh || def->triangle_count > array_max / 3) def->triangles = NULL;
    if (!field) def->heights = NULL;

    tape_array(tape, &def->path, 8 * (uint64_t)def->path_count, sizeof(float));
    tape_array(tape, &def->vertices, 3 * (uint64_t)def->vertex_count, sizeof(float));
    tape_array(tape, &def->triangles, 3 * (uint64_t)def->triangle_count, sizeof(uint32_t));
    tape_array(tape, &def->heights, field ? (uint64_t)def->columns * def->rows : 0, sizeof(float));
}

void tape_pin_def(Tape *tape, const SingePinDef *given, SingePinDef *def) {
    TAPE_GIVEN(tape, given, def, singe_default_pin);
    tape_table(tape, &pin_table, def);
    TAPE(tape, def->sheet.index);
    TAPE(tape, def->sheet.generation);
    TAPE(tape, def->point_count);
    tape_array(tape, &def->points, 3 * (uint64_t)def->point_count, sizeof(float));
    TAPE(tape, def->vertex_count);
    tape_array(tape, &def->vertices, def->vertex_count, sizeof(uint32_t));
    tape_path(tape, &def->path_count, &def->path);
}
