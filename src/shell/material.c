// The parameters of a sheet: a number, or an interpolation between two numbers by a texture, attribute or noise.
//
//   value(x) = (1 - f) value + f to,   f = texture(u, v), attribute or noise(rest position)
//
// At a centre f is the texture at the mean uv, the mean of the corners' attribute, or the noise at the
// mean of the corners.
#include "shell/sheet.h"

#include "common/def_table.h"
#include "common/random.h"
#include "shell/matter.h"

#include <math.h>
#include <string.h>

enum { AT_VERTICES = 1, AT_CENTRES = 2, AT_BOTH = 3 };

/// A parameter's offset in the material, and its range.
typedef struct ParamRule {
    const char *name;
    size_t offset;
    int param;
    int positions;
    FieldRange range;
} ParamRule;

static const ParamRule param_rules[] = {
#define RULE(member, param, where, ...) {#member, offsetof(SingeMaterialDef, member), param, where, __VA_ARGS__},
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) RULE(name, number, where, range)
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text)      \
    RULE(name[SINGE_RED], number + SINGE_RED, AT_BOTH, range)     \
    RULE(name[SINGE_GREEN], number + SINGE_GREEN, AT_BOTH, range) \
    RULE(name[SINGE_BLUE], number + SINGE_BLUE, AT_BOTH, range)   \
    RULE(name[SINGE_YELLOW], number + SINGE_YELLOW, AT_BOTH, range)
#include "singe/material.def"
};
enum { RULE_COUNT = sizeof param_rules / sizeof param_rules[0] };

/// The parameters that a sheet has one value of.
static const struct ScalarRule {
    const char *name;
    FieldRange range;
    size_t offset;
} scalar_rules[] = {
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) {#name, range, offsetof(SingeMaterialDef, name)},
#include "singe/material.def"
};

SingeResult material_check_scalars(const SingeMaterialDef *material, const char *sheet, SingeError *error) {
    for (size_t i = 0; i < sizeof scalar_rules / sizeof *scalar_rules; i++) {
        const struct ScalarRule *rule = &scalar_rules[i];
        float value;
        memcpy(&value, (const char *)material + rule->offset, rule->range.words ? sizeof value : 0);
        if (rule->range.words && !range_has(&rule->range, value))
            return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': %s must be %s", sheet, rule->name,
                             rule->range.words);
    }

    if (material->thickening > 0 && material->thickening < 1)
        return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': thickening must be 0, or 1 or more",
                         sheet);
    if (!def_has_value("SingeHeatOperator", (int)material->heat_operator))
        return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': heat operator %d is unknown", sheet,
                         (int)material->heat_operator);

    return SINGE_OK;
}

float shell_sample_texture(const SingeTexture *texture, float u, float v) {
    double limit[2] = {texture->width - 1.0, texture->height - 1.0};
    double at[2] = {(double)u * texture->width - 0.5, (1 - (double)v) * texture->height - 0.5}, part[2];
    size_t low[2], high[2];

    for (int k = 0; k < 2; k++) {
        at[k] = !(at[k] > 0) ? 0 : at[k] < limit[k] ? at[k] : limit[k];
        low[k] = (size_t)at[k];
        high[k] = at[k] < limit[k] ? low[k] + 1 : low[k];
        part[k] = at[k] - (double)low[k];
    }

    const float *top = texture->values + low[1] * (size_t)texture->width;
    const float *bottom = texture->values + high[1] * (size_t)texture->width;
    double upper = (1 - part[0]) * (double)top[low[0]] + part[0] * (double)top[high[0]];
    double lower = (1 - part[0]) * (double)bottom[low[0]] + part[0] * (double)bottom[high[0]];
    return (float)((1 - part[1]) * upper + part[1] * lower);
}

/// Inputs of a parameter's evaluation.
typedef struct ParamField {
    const SingeParam *param;
    const SingeField *follows; ///< NULL: `value` everywhere
    const float *attribute;    ///< [vertex_count] or NULL
    const SheetSource *source;
} ParamField;

static SingeResult field_fail(const SheetSource *source, const ParamRule *rule, const char *what, SingeError *error) {
    return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': %s %s", source->sheet.name, rule->name,
                     what);
}

static SingeResult field_open(const SingeSheetDef *def, const ParamRule *rule, ParamField *field, SingeError *error) {
    const SingeField *follows = field->follows;
    if (!follows) return SINGE_OK;
    if (!isfinite(field->param->value) || !isfinite(field->param->to)) // an infinity cannot be interpolated
        return field_fail(field->source, rule, "must vary between two finite numbers", error);

    switch ((int)follows->kind) {
    case SINGE_FIELD_TEXTURE:
        if (!def->uv) return field_fail(field->source, rule, "has a texture, but the sheet has no uv", error);
        if (follows->texture.width < 1 || follows->texture.height < 1 || !follows->texture.values)
            return field_fail(field->source, rule, "has an empty texture", error);
        return SINGE_OK;
    case SINGE_FIELD_ATTRIBUTE:
        if (!follows->attribute) return field_fail(field->source, rule, "needs the name of an attribute", error);
        for (uint32_t i = 0; i < def->attribute_count; i++)
            if (strcmp(def->attributes[i].name, follows->attribute) == 0) field->attribute = def->attributes[i].values;
        if (!field->attribute)
            return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': %s: the mesh has no attribute '%s'",
                             field->source->sheet.name, rule->name, follows->attribute);
        return SINGE_OK;
    case SINGE_FIELD_NOISE:
        if (!range_has(&(const FieldRange)OVER(0), follows->noise.scale))
            return field_fail(field->source, rule, "needs noise with a scale above 0", error);
        if (follows->noise.octaves < 1 || follows->noise.octaves > 8)
            return field_fail(field->source, rule, "needs noise with 1 to 8 octaves", error);
        return SINGE_OK;
    default: return field_fail(field->source, rule, "has an unknown kind of field", error);
    }
}

/// The parameter at the mean of `count` vertices: one vertex, or those of a cell with the cell's own uv.
static float field_value(const ParamField *field, const uint32_t *vertices, int count, uint32_t cell) {
    const SingeParam *param = field->param;
    const SingeField *follows = field->follows;
    if (!follows) return param->value;

    double uv[2] = {0}, position[3] = {0}, f = 0;
    for (int i = 0; i < count; i++) {
        uint32_t v = vertices[i];
        for (int k = 0; k < 2; k++)
            uv[k] += (double)(count == 1 ? field->source->uv[v] : sheet_corner_uv(field->source, cell, i))[k] / count;
        for (int k = 0; k < 3; k++) position[k] += (double)field->source->position[v][k] / count;
        if (field->attribute) f += (double)field->attribute[v] / count;
    }

    if (follows->kind == SINGE_FIELD_TEXTURE)
        f = (double)shell_sample_texture(&follows->texture, (float)uv[0], (float)uv[1]);
    if (follows->kind == SINGE_FIELD_NOISE)
        f = (double)random_fractal(&follows->noise, (float)position[0], (float)position[1], (float)position[2]);
    return (float)((1 - f) * (double)param->value + f * (double)param->to);
}

/// The particles of a sheet to which a rule applies.
static void rule_range(const ParamRule *rule, const Sheet *sheet, uint32_t *begin, uint32_t *end) {
    *begin = rule->positions & AT_VERTICES ? 0 : sheet->vertex_count;
    *end = rule->positions & AT_CENTRES ? sheet->vertex_count + sheet->cell_count : sheet->vertex_count;
}

static SingeResult check_value(const ParamRule *rule, const Sheet *sheet, uint32_t i, float value, SingeError *error) {
    if (range_has(&rule->range, value)) return SINGE_OK;
    bool corner = i < sheet->vertex_count;
    uint32_t element = corner ? i : i - sheet->vertex_count;
    return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", element, "sheet '%s': %s must be %s; %s %u violates this",
                     sheet->name, rule->name, rule->range.words, corner ? "vertex" : "cell", element);
}

/// A quantity computed from several parameters may exceed the range of float.
static SingeResult check_matter(const SheetSource *source, SingeError *error) {
    static const struct {
        int param;
        const char *name, *than;
    } made[] = {{PARAM_DIFFUSIVITY, "diffusivity", "grammage"},
                {PARAM_LAYER_EXCHANGE, "layer_exchange", "grammage"},
                {PARAM_MASS_RATE, "mass_rate", "grammage"},
                {PARAM_HEAT_SHARE, "heat_of_combustion", "specific heat"},
                {PARAM_CHAR_HEAT, "char_heat", "specific heat"},
                {PARAM_CHAR_RATE, "char_rate", "grammage"},
                {PARAM_COMPLIANCE + SINGE_GREEN, "thickness", "bending"}};
    uint32_t total = source->sheet.vertex_count + source->sheet.cell_count;
    for (size_t k = 0; k < sizeof made / sizeof *made; k++)
        for (uint32_t i = 0; i < total; i++)
            if (!isfinite(matter_value(source, made[k].param, i)))
                return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': %s is too large for its %s",
                                 source->sheet.name, made[k].name, made[k].than);

    return SINGE_OK;
}

SingeResult material_check_values(const SheetSource *source, SingeError *error) {
    for (int r = 0; r < RULE_COUNT; r++) {
        const ParamRule *rule = &param_rules[r];
        const float *values = source->values[rule->param];
        uint32_t begin, end;
        rule_range(rule, &source->sheet, &begin, &end);
        if (!values) TRY(check_value(rule, &source->sheet, begin, source->value[rule->param], error));
        for (uint32_t i = begin; values && i < end; i++) TRY(check_value(rule, &source->sheet, i, values[i], error));
    }

    return check_matter(source, error);
}

SingeResult material_evaluate(Memory *memory, const SingeSheetDef *def, SheetSource *source, SingeError *error) {
    size_t total = (size_t)source->sheet.vertex_count + source->sheet.cell_count;
    for (int r = 0; r < RULE_COUNT; r++) {
        const ParamRule *rule = &param_rules[r];
        float **values = &source->values[rule->param];
        const SingeParam *param = (const void *)((const char *)&def->material + rule->offset);
        const bool varies = param->field && param->field->kind != SINGE_FIELD_NONE;
        ParamField field = {.param = param, .follows = varies ? param->field : NULL, .source = source};

        if (!*values && !NEW(memory, *values, total))
            return error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for sheet '%s'",
                             source->sheet.name);
        TRY(field_open(def, rule, &field, error));

        uint32_t begin, end;
        rule_range(rule, &source->sheet, &begin, &end);
        for (uint32_t i = begin; i < end; i++) {
            const uint32_t cell = i - source->sheet.vertex_count;
            (*values)[i] = i < source->sheet.vertex_count ? field_value(&field, &i, 1, 0)
                                                          : field_value(&field, source->cells[cell], 4, cell);
            TRY(check_value(rule, &source->sheet, i, (*values)[i], error));
        }

        // the rules of one parameter, one per layer, are consecutive; a single value is kept if all are the same to the
        // bit
        if (r + 1 < RULE_COUNT && param_rules[r + 1].param == rule->param) continue;
        source->value[rule->param] = (*values)[0];
        if (memcmp(*values, *values + 1, (total - 1) * sizeof **values) == 0) FREE(memory, *values, total);
    }

    return check_matter(source, error);
}
