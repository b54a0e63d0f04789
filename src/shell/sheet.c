// A sheet's Def: read in any version, checked, copied.
#include "shell/sheet.h"

#include "common/def_table.h"
#include "common/store.h"
#include "shell/rest_lengths.h"

/// A cell is degenerate if a side, or its area, is at most this fraction of its longest side (squared).
static const double thin = 1e-6;
/// Coordinates (m) up to this size keep squared lengths within float.
static const float position_max = 1e15f;
/// Areas, masses and heat capacities within this range (and its inverse) stay normal floats.
static const double measure_max = 1e30;

static size_t sheet_min(size_t a, size_t b) { return a < b ? a : b; }

// The material is embedded and has grown on its own, so the fields after it are located by the size that the caller's
// header gave it.
bool sheet_read_def(const SingeSheetDef *def, SingeSheetDef *out) {
    const size_t head = offsetof(SingeSheetDef, material), tail = offsetof(SingeSheetDef, velocity);
    const char *bytes = (const char *)def;
    size_t size = def->struct_size, inner;
    *out = singe_default_sheet();
    if (!struct_size_is_possible(size)) return false;

    memcpy(out, bytes, sheet_min(size, head));
    if (size > head) {
        if (size - head < sizeof inner) return false;
        memcpy(&inner, bytes + head, sizeof inner);
        if (!struct_size_is_possible(inner) || inner > size - head) return false;
        memcpy(&out->material, bytes + head, sheet_min(inner, sizeof out->material));
        memcpy((char *)out + tail, bytes + head + inner, sheet_min(size - head - inner, sizeof *out - tail));
    }

    out->struct_size = sizeof *out;
    out->material.struct_size = sizeof out->material;
    return true;
}

static SingeResult argument(const char *name, const char *what, SingeError *error) {
    return error_set(error, SINGE_ERROR_ARGUMENT, "sheet", -1, "sheet '%s': %s", name, what);
}

/// Copies a name, cut between characters of UTF-8 where it is too long.
static void copy_name(const char *name, char *copy, size_t size) {
    size_t length = strlen(name);
    if (length > size - 1) {
        length = size - 1;
        while (length > 0 && ((unsigned char)name[length] & 0xC0) == 0x80) length--;
    }
    memcpy(copy, name, length);
    copy[length] = 0;
}

static SingeResult check_def(const SingeSheetDef *def, const char *name, SingeError *error) {
    if (def->vertex_count == 0 || def->cell_count == 0)
        return error_set(error, SINGE_ERROR_MESH, "sheet", -1, "sheet '%s' has no cells", name);
    if ((uint64_t)def->vertex_count + def->cell_count > INT32_MAX || def->cell_count > INT32_MAX / 4)
        return error_set(error, SINGE_ERROR_LIMIT, "sheet", -1, "sheet '%s': %u vertices and %u cells are too many",
                         name, def->vertex_count, def->cell_count);

    // arrays
    if (!def->positions || !def->cells) return argument(name, "positions or cells are NULL", error);
    if (def->corner_uv && !def->uv) return argument(name, "corner_uv needs uv", error);
    if (def->corner_source_vertex && (!def->corner_uv || !def->source_vertex))
        return argument(name, "corner_source_vertex needs corner_uv and source_vertex", error);
    if (def->source_vertex && def->source_count > INT32_MAX) return argument(name, "source_count is too large", error);
    if (def->attribute_count && !def->attributes) return argument(name, "attributes are NULL", error);

    for (uint32_t i = 0; i < def->attribute_count; i++)
        if (!def->attributes[i].name || !def->attributes[i].values)
            return argument(name, "an attribute has no name or no values", error);

    TRY(def_check(&sheet_table, def, error));
    return material_check_scalars(&def->material, name, error);
}

/// An error at a vertex or cell; `what` ends the sentence that begins with it.
static SingeResult element_fail(const char *name, const char *kind, uint32_t element, const char *what,
                                SingeError *error) {
    return error_set(error, SINGE_ERROR_MESH, "sheet", element, "sheet '%s': %s %u %s", name, kind, element, what);
}

static SingeResult check_vertices(const SingeSheetDef *def, const char *name, SingeError *error) {
    for (uint32_t v = 0; v < def->vertex_count; v++) {
        for (size_t k = 0; k < 3; k++)
            if (!(fabsf(def->positions[3 * (size_t)v + k]) <= position_max))
                return element_fail(name, "vertex", v, "has a position that is not finite or beyond 1e15 m", error);
        for (size_t k = 0; k < 2 && def->uv; k++)
            if (!isfinite(def->uv[2 * (size_t)v + k]))
                return element_fail(name, "vertex", v, "has a uv that is not finite", error);
        if (def->source_vertex && (def->source_vertex[v] < -1 || def->source_vertex[v] >= (int64_t)def->source_count))
            return element_fail(name, "vertex", v, "has a source_vertex that is not below source_count", error);
    }

    for (size_t i = 0; i < 4 * (size_t)def->cell_count && def->corner_source_vertex; i++)
        if (def->corner_source_vertex[i] < -1 || def->corner_source_vertex[i] >= (int64_t)def->source_count)
            return element_fail(name, "cell", (uint32_t)(i / 4), "has a source vertex that is not below source_count",
                                error);
    for (size_t i = 0; i < 8 * (size_t)def->cell_count && def->corner_uv; i++)
        if (!isfinite(def->corner_uv[i]))
            return element_fail(name, "cell", (uint32_t)(i / 8), "has a uv that is not finite", error);
    return SINGE_OK;
}

static bool in_float(double x) { return x >= 1 / measure_max && x <= measure_max; }

static SingeResult check_cells(const SingeSheetDef *def, const char *name, SingeError *error) {
    for (uint32_t c = 0; c < def->cell_count; c++) {
        const uint32_t *corners = def->cells + 4 * (size_t)c;
        for (int i = 0; i < 4; i++) {
            if (corners[i] >= def->vertex_count)
                return error_set(error, SINGE_ERROR_MESH, "sheet", c, "sheet '%s': cell %u uses vertex %u of %u", name,
                                 c, corners[i], def->vertex_count);
            for (int j = 0; j < i; j++)
                if (corners[i] == corners[j])
                    return error_set(error, SINGE_ERROR_MESH, "sheet", c, "sheet '%s': cell %u uses vertex %u twice",
                                     name, c, corners[i]);
        }

        const float *p[4];
        for (int i = 0; i < 4; i++) p[i] = def->positions + 3 * (size_t)corners[i];

        const CellShape shape = cell_shape(p);
        if (!(shape.shortest > thin * shape.longest))
            return element_fail(name, "cell", c, "has a side without length", error);
        if (!(shape.vector_area > thin * shape.longest * shape.longest))
            return element_fail(name, "cell", c, "has no area", error);
        if (!in_float(shape.area)) return element_fail(name, "cell", c, "has an area outside 1e-30 to 1e30", error);
    }

    return SINGE_OK;
}

/// The masses and heat capacities that each cell would have with the grammage of its particle, and of each corner's.
static SingeResult check_masses(const SheetSource *source, SingeError *error) {
    const uint32_t vertices = source->sheet.vertex_count;
    for (uint32_t c = 0; c < source->sheet.cell_count; c++) {
        const uint32_t *corners = source->cells[c];
        const float *p[4];
        for (int i = 0; i < 4; i++) p[i] = source->position[corners[i]];

        const double area = cell_shape(p).area;
        for (int i = 0; i < 5; i++) {
            const uint32_t particle = i < 4 ? corners[i] : vertices + c;
            const double mass = area * (double)sheet_param(source, PARAM_GRAMMAGE, particle);
            if (!in_float(mass) || !in_float(mass * (double)sheet_param(source, PARAM_SPECIFIC_HEAT, particle)))
                return element_fail(source->sheet.name, "cell", c, "has a mass or heat capacity outside 1e-30 to 1e30",
                                    error);
        }
    }

    return SINGE_OK;
}

SingeResult sheet_source_create(Memory *memory, const SingeSheetDef *given, SheetSource *source, SingeError *error) {
    SingeSheetDef def;
    memset(source, 0, sizeof *source);
    if (!given || !sheet_read_def(given, &def))
        return argument("sheet", STRUCT_SIZE_UNKNOWN(singe_default_sheet), error);
    Sheet *sheet = &source->sheet;
    copy_name(def.name ? def.name : "sheet", sheet->name, sizeof sheet->name);
    TRY(check_def(&def, sheet->name, error));
    TRY(check_vertices(&def, sheet->name, error));
    TRY(check_cells(&def, sheet->name, error));

    sheet->vertex_count = def.vertex_count;
    sheet->cell_count = def.cell_count;
    sheet->drop_pieces_below = def.drop_pieces_below;
    sheet->source_count = def.source_vertex ? def.source_count : def.vertex_count;
    memcpy(sheet->velocity, def.velocity, sizeof sheet->velocity);
    source->user_data = def.user_data;
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) sheet->material.name = def.material.name;
#include "singe/material.def"
    const bool room = NEW(memory, source->position, def.vertex_count) && NEW(memory, source->cells, def.cell_count) &&
                      NEW(memory, source->uv, def.vertex_count) &&
                      (!def.corner_uv || NEW(memory, source->corner_uv, def.cell_count)) &&
                      (!def.source_vertex || NEW(memory, source->source_vertex, def.vertex_count)) &&
                      (!def.corner_source_vertex || NEW(memory, source->corner_source, def.cell_count));
    if (!room) {
        SingeResult result =
            error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for sheet '%s'", sheet->name);
        sheet_source_free(memory, source);
        return result;
    }
    memcpy(source->position, def.positions, sizeof *source->position * def.vertex_count);
    memcpy(source->cells, def.cells, sizeof *source->cells * def.cell_count);
    if (def.uv) memcpy(source->uv, def.uv, sizeof *source->uv * def.vertex_count);
    if (def.corner_uv) memcpy(source->corner_uv, def.corner_uv, sizeof *source->corner_uv * def.cell_count);
    if (def.corner_source_vertex)
        memcpy(source->corner_source, def.corner_source_vertex, sizeof *source->corner_source * def.cell_count);
    if (def.source_vertex)
        memcpy(source->source_vertex, def.source_vertex, sizeof *source->source_vertex * def.vertex_count);
    SingeResult result = material_evaluate(memory, &def, source, error);
    if (result == SINGE_OK) result = check_masses(source, error);
    if (result != SINGE_OK) sheet_source_free(memory, source);
    return result;
}

SingeResult sheet_source_check(const SheetSource *source, SingeError *error) {
    const Sheet *sheet = &source->sheet;
    SingeSheetDef def = {.struct_size = sizeof def,
                         .vertex_count = sheet->vertex_count,
                         .cell_count = sheet->cell_count,
                         .positions = (const float *)source->position,
                         .cells = (const uint32_t *)source->cells,
                         .uv = (const float *)source->uv,
                         .drop_pieces_below = sheet->drop_pieces_below,
                         .corner_uv = (const float *)source->corner_uv,
                         .source_vertex = source->source_vertex,
                         .source_count = sheet->source_count,
                         .corner_source_vertex = (const int32_t *)source->corner_source};
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) def.material.name = sheet->material.name;
#include "singe/material.def"
    memcpy(def.velocity, sheet->velocity, sizeof def.velocity);
    TRY(check_def(&def, sheet->name, error));
    if (!source->source_vertex && sheet->source_count != sheet->vertex_count)
        return argument(sheet->name, "source_count is not the number of vertices", error);
    TRY(check_vertices(&def, sheet->name, error));
    TRY(check_cells(&def, sheet->name, error));
    TRY(material_check_values(source, error));
    return check_masses(source, error);
}

void sheet_source_free(Memory *memory, SheetSource *source) {
    size_t vertices = source->sheet.vertex_count, cells = source->sheet.cell_count;
    FREE(memory, source->position, vertices);
    FREE(memory, source->cells, cells);
    FREE(memory, source->uv, vertices);
    FREE(memory, source->corner_uv, cells);
    FREE(memory, source->source_vertex, vertices);
    FREE(memory, source->corner_source, cells);
    for (int p = 0; p < PARAM_COUNT; p++) FREE(memory, source->values[p], vertices + cells);
    memset(source, 0, sizeof *source);
}
