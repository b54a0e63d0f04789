// Splits a surface by sheet, for formats with a mesh for each.
#ifndef FORMATS_SHEET_PARTS_H
#define FORMATS_SHEET_PARTS_H

#include "formats/formats.h"

/// Vertices and triangles by sheet, each in the surface's order.
typedef struct SheetParts {
    const SingeSurface *surface;
    uint32_t sheet_count;
    uint32_t *vertex_first, *triangle_first; ///< [sheet_count + 1]
    uint32_t *vertices, *triangles;          ///< by sheet
    uint32_t *local;                         ///< [vertex_count] a vertex's number in its sheet
} SheetParts;

/// The part of one sheet.
typedef struct SheetPart {
    uint32_t sheet, count, triangle_count;
    const uint32_t *vertices, *triangles;
} SheetPart;

/// Sorts a surface whose sheets are 0 to sheet_count - 1. SINGE_ERROR_FORMAT if they are not, or if a triangle belongs
/// to two. Free it also after failure.
SINGE_NODISCARD SingeResult sheet_parts_make(SheetParts *parts, const SingeSurface *surface, uint32_t sheet_count,
                                             const char *path, SingeError *error);
void sheet_parts_free(SheetParts *parts);

static inline SheetPart sheet_part(const SheetParts *p, uint32_t sheet) {
    return (SheetPart){sheet, p->vertex_first[sheet + 1] - p->vertex_first[sheet],
                       p->triangle_first[sheet + 1] - p->triangle_first[sheet], p->vertices + p->vertex_first[sheet],
                       p->triangles + p->triangle_first[sheet]};
}

#endif
