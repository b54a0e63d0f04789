// A sheet for the tests of materials, and what the library makes of its parameters.
#pragma once

#include "support/test.h"

#include "sample_shells.h"
#include "shell/sheet.h"

/// A unit square of n x n cells with uv = (x, y).
typedef struct Square {
    QuadMesh mesh;
    float (*uv)[2];
    SingeSheetDef def;
} Square;

static inline Square square_make(uint32_t n) {
    Square square = {.mesh = mesh_grid(n, n, 1.0f / (float)n, 1.0f / (float)n)};
    square.uv = malloc(square.mesh.vertex_count * sizeof *square.uv);
    assert_non_null(square.uv);
    for (uint32_t v = 0; v < square.mesh.vertex_count; v++)
        memcpy(square.uv[v], square.mesh.position[v], sizeof *square.uv);
    square.def = mesh_sheet(&square.mesh);
    square.def.uv = square.uv[0];
    return square;
}

static inline void square_free(Square *square) {
    mesh_release(&square->mesh);
    free(square->uv);
}
#define OwnSquare OWNED(square_free) Square

static inline SheetSource evaluate(Memory *memory, const SingeSheetDef *def) {
    SheetSource source;
    SingeError error = {0};
    if (sheet_source_create(memory, def, &source, &error)) fail_msg("%s", error.message);
    return source;
}

static inline void refuse(const SingeSheetDef *def, int64_t element, const char *says) {
    Memory memory = memory_make((SingeAllocator){0});
    SheetSource source;
    SingeError error = {0};
    assert_int_equal(sheet_source_create(&memory, def, &source, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(error.element, element);
    if (!strstr(error.message, says)) fail_msg("%s", error.message);
    assert_int_equal(memory.held, 0);
}
