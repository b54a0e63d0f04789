#include "shell/half_edge.h"

static uint32_t half_from(const Shell *shell, uint32_t half) { return shell->cells[half / 4][half & 3]; }
static uint32_t half_to(const Shell *shell, uint32_t half) { return shell->cells[half / 4][(half + 1) & 3]; }

static uint32_t half_low(const Shell *shell, uint32_t half) {
    uint32_t a = half_from(shell, half), b = half_to(shell, half);
    return a < b ? a : b;
}
static uint32_t half_high(const Shell *shell, uint32_t half) {
    uint32_t a = half_from(shell, half), b = half_to(shell, half);
    return a > b ? a : b;
}

/// One stable counting sort of half-edges by a vertex; `slot` has vertex_count + 1 entries.
static void sort_by(const Shell *shell, uint32_t key(const Shell *, uint32_t), const uint32_t *from, uint32_t *to,
                    uint32_t *slot) {
    uint32_t count = 4 * shell->cell_count;
    for (uint32_t v = 0; v <= shell->vertex_count; v++) slot[v] = 0;
    for (uint32_t h = 0; h < count; h++) slot[key(shell, h) + 1]++;
    for (uint32_t v = 0; v < shell->vertex_count; v++) slot[v + 1] += slot[v];
    for (uint32_t k = 0; k < count; k++) {
        uint32_t half = from ? from[k] : k;
        to[slot[key(shell, half)]++] = half;
    }
}

static SingeResult edge_fail(const Shell *shell, uint32_t half, const char *what, SingeError *error) {
    uint32_t cell = half / 4;
    const Sheet *sheet = &shell->sheets[shell->matter.sheet[shell_centre(shell, cell)]];
    uint32_t element = cell - sheet->cell_first;
    return error_set(error, SINGE_ERROR_MESH, "sheet", element, "sheet '%s': the edge from vertex %u to %u %s cell %u",
                     sheet->name, half_from(shell, half) - sheet->vertex_first,
                     half_to(shell, half) - sheet->vertex_first, what, element);
}

/// Sorts the half-edges by their two vertices, so that one or two consecutive ones are an edge, and matches these.
static SingeResult match_edges(Memory *memory, Shell *shell, HalfEdges *mesh, SingeError *error) {
    uint32_t count = 4 * shell->cell_count, slots = shell->vertex_count + 1, *by_high = NULL, *order = NULL;
    uint32_t *slot = NULL;
    SingeResult result = SINGE_OK;

    if (NEW(memory, by_high, count) && NEW(memory, order, count) && NEW(memory, slot, slots)) {
        sort_by(shell, half_high, NULL, by_high, slot);
        sort_by(shell, half_low, by_high, order, slot);
    } else {
        result = error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for the edges of %u cells",
                           shell->cell_count);
    }

    for (uint32_t k = 0, size; k < count && !result; k += size) {
        uint32_t a = order[k], low = half_low(shell, a), high = half_high(shell, a);
        CellSprings *first = &shell->cell_springs[a / 4];
        for (size = 1; k + size < count; size++)
            if (half_low(shell, order[k + size]) != low || half_high(shell, order[k + size]) != high) break;
        first->blue[a & 3] = mesh->edge_count++;

        // a border, or shared by two cells
        if (size == 1) {
            mesh->twin[a] = SHELL_NONE;
            first->green[a & 3] = SHELL_NONE;
            continue;
        }

        uint32_t b = order[k + 1];
        CellSprings *second = &shell->cell_springs[b / 4];

        if (size > 2) result = edge_fail(shell, order[k + 2], "has more than two cells, the third of which is", error);
        else if (half_from(shell, a) == half_from(shell, b))
            result = edge_fail(shell, b, "runs in the same direction in two cells (one is flipped):", error);
        mesh->twin[a] = b;
        mesh->twin[b] = a;
        second->blue[b & 3] = first->blue[a & 3];
        first->green[a & 3] = second->green[b & 3] = mesh->shared_count++;
    }

    FREE(memory, by_high, count);
    FREE(memory, order, count);
    FREE(memory, slot, slots);
    return result;
}

/// Counts the cells of every vertex and finds where its fan starts: at the boundary if it has one.
static SingeResult find_fans(const Shell *shell, HalfEdges *mesh, SingeError *error) {
    for (uint32_t h = 0; h < 4 * shell->cell_count; h++) {
        uint32_t v = half_from(shell, h);
        if (mesh->fan_size[v]++ == 0 || mesh->twin[h] == SHELL_NONE) mesh->fan_start[v] = h;
    }

    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        uint32_t size = mesh->fan_size[v], reached = 0;
        if (size == 0) continue;

        uint32_t h = mesh->fan_start[v];
        do {
            reached++;
            h = half_edge_turn(mesh, h);
        } while (h != SHELL_NONE && h != mesh->fan_start[v]);

        const Sheet *sheet = &shell->sheets[shell->matter.sheet[v]];
        uint32_t element = v - sheet->vertex_first;
        if (reached != size)
            return error_set(error, SINGE_ERROR_MESH, "sheet", element,
                             "sheet '%s': the %u cells at vertex %u meet only in that point, not in one fan",
                             sheet->name, size, element);

        // blue, red and yellow springs must fit AblateState.degree
        if (size > UINT16_MAX / 3 - 1)
            return error_set(error, SINGE_ERROR_LIMIT, "sheet", element,
                             "sheet '%s': vertex %u has %u cells, more than %d", sheet->name, element, size,
                             UINT16_MAX / 3 - 1);
        if (size > mesh->fan_longest) mesh->fan_longest = size;
    }

    return SINGE_OK;
}

SingeResult half_edge_build(Memory *memory, Shell *shell, HalfEdges *mesh, SingeError *error) {
    *mesh = (HalfEdges){.shell = shell};
    if (!NEW(memory, mesh->twin, (size_t)4 * shell->cell_count) || !NEW(memory, mesh->fan_start, shell->vertex_count) ||
        !NEW(memory, mesh->fan_size, shell->vertex_count)) {
        half_edge_free(memory, mesh);
        return error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for the mesh of %u cells",
                         shell->cell_count);
    }

    SingeResult result = match_edges(memory, shell, mesh, error);
    if (result == SINGE_OK) result = find_fans(shell, mesh, error);
    if (result != SINGE_OK) half_edge_free(memory, mesh);
    return result;
}

void half_edge_free(Memory *memory, HalfEdges *mesh) {
    if (!mesh->shell) return;
    FREE(memory, mesh->twin, (size_t)4 * mesh->shell->cell_count);
    FREE(memory, mesh->fan_start, mesh->shell->vertex_count);
    FREE(memory, mesh->fan_size, mesh->shell->vertex_count);
}
