// The body-centred square of section 3.2: from quads to particles and springs of four colours.
//
//   blue    the mesh's edges                 about 2 N_c
//   green   centres of cells that share an edge    2 N_c
//   red     centre to corners                      4 N_c
//   yellow  both diagonals                         2 N_c
//
// Springs continue in others, their mates, which strand.c follows: a green spring in the one across the opposite side
// of the cell, a red one at the centre in that of the opposite corner, and each one at a vertex in the opposite one in
// the fan of cells, where there is one.
#include "shell/family.h"
#include "shell/half_edge.h"
#include "shell/matter.h"
#include "shell/rest_lengths.h"
#include "shell/split.h"
#include "shell/strand.h"

#include <string.h>

enum { SHEET_LIMIT = UINT16_MAX };

static SingeResult shell_no_memory(const Shell *shell, SingeError *error) {
    return error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for a shell of %u cells",
                     shell->cell_count);
}

/// Counts the vertices and cells of all sheets, and allocates the arrays.
static SingeResult shell_alloc(Memory *memory, const SheetSource *sources, uint32_t source_count, Shell *shell,
                               SingeError *error) {
    uint64_t vertices = 0, cells = 0, numbers = 0;
    bool seams = false;

    for (uint32_t i = 0; i < source_count; i++) {
        vertices += sources[i].sheet.vertex_count + sources[i].sheet.spare_count;
        cells += sources[i].sheet.cell_count;
        numbers += sources[i].sheet.source_count;
        seams |= sources[i].corner_uv != NULL;
    }

    // indices of particles and of the 4 N_c red springs are also counted in int; four times a particle's number, and
    // the springs' slots in lanes, in uint32_t
    if (source_count > SHEET_LIMIT || vertices + cells > INT32_MAX / 4 || numbers > INT32_MAX || cells > INT32_MAX / 16)
        return error_set(error, SINGE_ERROR_LIMIT, "sheet", -1,
                         "%u sheets with %llu vertices and %llu cells are too many", source_count,
                         (unsigned long long)vertices, (unsigned long long)cells);

    uint32_t v = (uint32_t)vertices, c = (uint32_t)cells, p = v + c;
    *shell = (Shell){.vertex_count = v, .cell_count = c, .particle_count = p, .sheet_count = source_count};
    if ((seams && (!NEW(memory, shell->corner_uv, c) || !NEW(memory, shell->corner_source, c))) ||
        !NEW(memory, shell->cells, c) || !NEW(memory, shell->cell_springs, c) ||
        !NEW(memory, shell->rest_position, p) || !NEW(memory, shell->uv, p) ||
        !NEW(memory, shell->sheets, source_count) || !NEW(memory, shell->matter.sheet, p) ||
        !NEW(memory, shell->cell_order, c) || !NEW(memory, shell->source_vertex, v) ||
        !NEW(memory, shell->fan_first, (size_t)v + 1) || !NEW(memory, shell->fan, (size_t)4 * c))
        return shell_no_memory(shell, error);

    return SINGE_OK;
}

void shell_free(Memory *memory, Shell *shell) {
    matter_free(memory, shell);
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) strand_free(memory, &shell->springs[colour]);

    FREE(memory, shell->cells, shell->cell_count);
    FREE(memory, shell->cell_springs, shell->cell_count);
    FREE(memory, shell->rest_position, shell->particle_count);
    FREE(memory, shell->uv, shell->particle_count);
    FREE(memory, shell->corner_uv, shell->cell_count);
    FREE(memory, shell->corner_source, shell->cell_count);
    FREE(memory, shell->source_vertex, shell->vertex_count);
    FREE(memory, shell->sheets, shell->sheet_count);
    FREE(memory, shell->matter.sheet, shell->particle_count);
    FREE(memory, shell->cell_order, shell->cell_count);
    FREE(memory, shell->edge_origin, shell->edge_spare_count);
    FREE(memory, shell->fan_first, (size_t)shell->vertex_count + 1);
    FREE(memory, shell->fan, (size_t)4 * shell->cell_count);
    FREE(memory, shell->cell_family_first, (size_t)shell->cell_family_count + 1);
    *shell = (Shell){0};
}

/// Copies the sheets one after another, and lists the cells around every vertex. Spares have the position of their
/// sheet's first vertex.
static void bcs_lay_sheets(Shell *shell, const SheetSource *sources) {
    uint32_t vertex = 0, cell = 0, input = 0, *first = shell->fan_first;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const SheetSource *source = &sources[s];
        Sheet *sheet = &shell->sheets[s];
        uint32_t count = source->sheet.vertex_count, centre = shell_centre(shell, cell);

        memcpy(sheet, &source->sheet, sizeof *sheet);
        sheet->vertex_first = vertex;
        sheet->cell_first = cell;
        sheet->source_first = input;
        sheet->vertex_count += sheet->spare_count;
        shell->spare_count += sheet->spare_count;

        // vertices, and spares
        for (uint32_t i = 0; i < sheet->vertex_count; i++, vertex++) {
            uint32_t v = i < count ? i : 0;
            for (int k = 0; k < 3; k++) shell->rest_position[vertex][k] = source->position[v][k];
            for (int k = 0; k < 2; k++) shell->uv[vertex][k] = source->uv[v][k];
            shell->matter.sheet[vertex] = (uint16_t)s;
            int32_t from = i >= count ? -1 : source->source_vertex ? source->source_vertex[v] : (int32_t)v;
            shell->source_vertex[vertex] = from < 0 ? -1 : (int32_t)input + from;
        }

        // cells: corners, their uv and sources
        for (uint32_t c = 0; c < sheet->cell_count; c++, cell++) {
            float *uv = shell->uv[centre + c];
            shell->matter.sheet[centre + c] = (uint16_t)s;
            for (int i = 0; i < 4; i++) {
                uint32_t corner = shell->cells[cell][i] = sheet->vertex_first + source->cells[c][i];
                const float *corner_uv = sheet_corner_uv(source, c, i);
                for (int k = 0; k < 2; k++) uv[k] += corner_uv[k] / 4;
                if (!shell->corner_uv) continue;
                memcpy(shell->corner_uv[cell][i], corner_uv, 2 * sizeof *corner_uv);
                int32_t from = source->corner_source ? source->corner_source[c][i] : -1;
                shell->corner_source[cell][i] = from < 0 ? shell->source_vertex[corner] : (int32_t)input + from;
            }
        }

        input += sheet->source_count;
    }

    // fans by counting; filling moves each start to the next one, so they are moved back
    for (uint32_t c = 0; c < shell->cell_count; c++)
        for (int i = 0; i < 4; i++) first[shell->cells[c][i] + 1]++;
    for (uint32_t v = 0; v < shell->vertex_count; v++) first[v + 1] += first[v];
    for (uint32_t c = 0; c < shell->cell_count; c++)
        for (int i = 0; i < 4; i++) shell->fan[first[shell->cells[c][i]]++] = c;
    memmove(first + 1, first, shell->vertex_count * sizeof *first);
    first[0] = 0;
}

/// Ends of springs in the order of their numbers in cell_springs, before the strands are known.
static void list_ends(const HalfEdges *mesh, int colour, LooseSprings *loose) {
    const Shell *shell = mesh->shell;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const uint32_t *corner = shell->cells[c], centre = shell_centre(shell, c);
        const CellSprings *springs = &shell->cell_springs[c];
        for (int i = 0; i < 4; i++) {
            uint32_t a = corner[i], b = corner[(i + 1) & 3], *ends;
            if (colour == SINGE_RED) {
                ends = loose->ends[springs->red[i]];
                ends[0] = centre;
                ends[1] = a;
            } else if (colour == SINGE_BLUE) {
                ends = loose->ends[springs->blue[i]];
                ends[0] = a < b ? a : b;
                ends[1] = a < b ? b : a;
            } else if (colour == SINGE_GREEN && springs->green[i] != SHELL_NONE && c < half_edge_across(mesh, c, i)) {
                ends = loose->ends[springs->green[i]];
                ends[0] = centre;
                ends[1] = shell_centre(shell, half_edge_across(mesh, c, i));
            } else if (colour == SINGE_YELLOW && i < 2) {
                ends = loose->ends[springs->yellow[i]];
                ends[0] = a;
                ends[1] = corner[i + 2];
            }
        }
    }
}

/// Mates the ends at each vertex, its spokes in turning order. At an inner vertex, if the number n of spokes is even, k
/// pairs with k + n/2; if n is odd, none pair. At the boundary k pairs with k + 2, skipping the spoke between them.
static void join_at_vertices(const HalfEdges *mesh, int colour, LooseSprings *loose, uint32_t *ends) {
    const Shell *shell = mesh->shell;
    for (uint32_t v = 0; v < shell->vertex_count; v++) {
        uint32_t half = mesh->fan_start[v], last = half, count = 0;

        // of each half-edge that leaves v, the edge itself, the red spring to the corner or the diagonal from it
        for (uint32_t k = 0; k < mesh->fan_size[v]; k++) {
            const CellSprings *springs = &shell->cell_springs[half / 4];
            uint32_t i = half & 3, next = shell->cells[half / 4][(i + 1) & 3];
            ends[count++] = colour == SINGE_RED      ? 2 * springs->red[i] + 1
                            : colour == SINGE_YELLOW ? 2 * springs->yellow[i & 1] + (i >> 1)
                                                     : 2 * springs->blue[i] + (v > next);
            last = half;
            half = half_edge_turn(mesh, half);
        }

        bool inside = half_edge_is_inside(mesh, v);
        if (colour == SINGE_BLUE && count && !inside) {
            // the other boundary edge precedes the corner in the last cell
            uint32_t before = half_edge_previous(last);
            uint32_t other = shell->cells[before / 4][before & 3];
            ends[count++] = 2 * shell->cell_springs[before / 4].blue[before & 3] + (v > other);
        }

        for (uint32_t k = 0; inside && count % 2 == 0 && k < count / 2; k++)
            strand_join(loose, ends[k], ends[k + count / 2]);
        for (uint32_t k = 0; !inside && k + 2 < count; k++)
            if (loose->mate[ends[k]] == SHELL_NONE) strand_join(loose, ends[k], ends[k + 2]);
    }
}

/// The springs of one colour: their ends, pairs that continue each other, strands.
static SingeResult spring_colour(Memory *memory, const HalfEdges *mesh, Shell *shell, int colour, uint32_t count,
                                 SingeError *error) {
    LooseSprings loose = {.count = count};
    uint32_t *number = NULL, *ends = NULL;
    SingeResult result = SINGE_OK;

    if (!NEW(memory, loose.ends, count) || !NEW(memory, loose.mate, (size_t)2 * count) || !NEW(memory, number, count) ||
        !NEW(memory, ends, (size_t)mesh->fan_longest + 1))
        result = error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for %u springs", count);

    if (!result) {
        for (uint32_t e = 0; e < 2 * count; e++) loose.mate[e] = SHELL_NONE;
        list_ends(mesh, colour, &loose);
        if (colour != SINGE_GREEN) join_at_vertices(mesh, colour, &loose, ends);

        // across the centre of each cell
        for (uint32_t c = 0; c < shell->cell_count; c++) {
            const CellSprings *springs = &shell->cell_springs[c];
            const uint32_t *red = springs->red, *green = springs->green;
            for (int i = 0; i < 2; i++) {
                if (colour == SINGE_RED) strand_join(&loose, 2 * red[i], 2 * red[i + 2]);
                if (colour == SINGE_GREEN && green[i] != SHELL_NONE && green[i + 2] != SHELL_NONE)
                    strand_join(&loose, 2 * green[i] + (c > half_edge_across(mesh, c, i)),
                                2 * green[i + 2] + (c > half_edge_across(mesh, c, i + 2)));
            }
        }

        result = strand_build(memory, shell->particle_count, &loose, &shell->springs[colour], number, error);
    }

    // numbers along strands replace the loose ones
    for (uint32_t c = 0; !result && c < shell->cell_count; c++) {
        CellSprings *springs = &shell->cell_springs[c];
        uint32_t *slot = colour == SINGE_RED     ? springs->red
                         : colour == SINGE_GREEN ? springs->green
                         : colour == SINGE_BLUE  ? springs->blue
                                                 : springs->yellow;
        for (int i = 0; i < (colour == SINGE_YELLOW ? 2 : 4); i++)
            if (slot[i] != SHELL_NONE) slot[i] = number[slot[i]];
    }

    FREE(memory, loose.ends, count);
    FREE(memory, loose.mate, (size_t)2 * count);
    FREE(memory, number, count);
    FREE(memory, ends, (size_t)mesh->fan_longest + 1);
    return result;
}

/// Families of cells without a common corner.
static bool colour_cells(Memory *memory, Shell *shell) {
    uint32_t count = shell->cell_count, *family = NULL, families = 0;
    ItemNodes items = {.node_count = shell->vertex_count, .item_count = count, .nodes = count ? shell->cells[0] : NULL};

    if (NEW(memory, items.first, (size_t)count + 1) && NEW(memory, family, count)) {
        for (uint32_t c = 0; c <= count; c++) items.first[c] = 4 * c;
        families = family_colour(memory, &items, family);
    }

    shell->cell_family_count = count ? families : 0;
    bool done = families && NEW(memory, shell->cell_family_first, (size_t)shell->cell_family_count + 1);
    if (done) family_sort(count, family, shell->cell_family_count, shell->cell_family_first, shell->cell_order);
    FREE(memory, items.first, (size_t)count + 1);
    FREE(memory, family, count);
    return done;
}

SingeResult shell_create(Memory *memory, const SheetSource *sources, uint32_t source_count, Shell *shell,
                         SingeError *error) {
    *shell = (Shell){0};

    // cells, fans, families, matter
    SingeResult result = shell_alloc(memory, sources, source_count, shell, error);
    if (!result) {
        bcs_lay_sheets(shell, sources);
        if (!colour_cells(memory, shell) || !matter_create(memory, shell, sources))
            result = shell_no_memory(shell, error);
    }

    // springs, colour after colour
    HalfEdges mesh = {0};
    if (!result) result = half_edge_build(memory, shell, &mesh, error);
    uint32_t counts[SINGE_COLOUR_COUNT] = {[SINGE_RED] = 4 * shell->cell_count,
                                           [SINGE_GREEN] = mesh.shared_count,
                                           [SINGE_BLUE] = mesh.edge_count,
                                           [SINGE_YELLOW] = 2 * shell->cell_count};

    for (uint32_t c = 0; !result && c < shell->cell_count; c++) {
        for (uint32_t i = 0; i < 4; i++) shell->cell_springs[c].red[i] = 4 * c + i;
        for (uint32_t i = 0; i < 2; i++) shell->cell_springs[c].yellow[i] = 2 * c + i;
    }

    for (int colour = 0; colour < SINGE_COLOUR_COUNT && !result; colour++)
        result = spring_colour(memory, &mesh, shell, colour, counts[colour], error);
    half_edge_free(memory, &mesh);

    // their measures
    if (!result) {
        measure_particles(shell);
        matter_weigh(shell, sources);
        result = measure_springs(shell, error);
    }

    // reserves of tears, directions of fibres
    if (!result && (!split_reserve(memory, shell) || !measure_fibres(memory, shell)))
        result = shell_no_memory(shell, error);
    if (result) shell_free(memory, shell);
    return result;
}
