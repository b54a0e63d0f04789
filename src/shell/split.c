#include "shell/split.h"

#include "shell/matter.h"
#include "shell/rest_lengths.h"

/// The side of a cell that leads to the next cell around the vertex, clockwise, and counter-clockwise.
static int side_before(int corner) { return corner; }
static int side_after(int corner) { return (corner + 3) & 3; }

void split_fan(const Shell *shell, uint32_t vertex, Fan *fan) {
    SINGE_ASSERT(vertex < shell->vertex_count);
    uint32_t first = shell->fan_first[vertex], count = shell->fan_first[vertex + 1] - first;
    fan->count = count <= SPLIT_FAN ? (int)count : 0;
    for (int k = 0; k < fan->count; k++) {
        uint32_t cell = fan->cell[k] = shell->fan[first + (uint32_t)k];
        int corner = 0;
        while (shell->cells[cell][corner] != vertex) corner++;
        fan->corner[k] = (uint8_t)corner;
    }

    for (int k = 0; k < fan->count; k++) {
        uint32_t after = shell_neighbour(shell, fan->cell[k], side_after(fan->corner[k]));
        uint32_t before = shell_neighbour(shell, fan->cell[k], side_before(fan->corner[k]));
        fan->after[k] = fan->before[k] = -1;
        for (int j = 0; j < fan->count; j++) {
            if (fan->cell[j] == after) fan->after[k] = (int8_t)j;
            if (fan->cell[j] == before) fan->before[k] = (int8_t)j;
        }
    }
}

bool split_reserve(Memory *memory, Shell *shell) {
    SpringSet *blue = &shell->springs[SINGE_BLUE];
    uint32_t more = SPLIT_EDGES * shell->spare_count, count = blue->count + more;

    if (more == 0) return true;

    uint32_t(*ends)[2] = memory_new(memory, count, sizeof *ends);
    float *rest = memory_new(memory, count, sizeof *rest);
    if (!ends || !rest) {
        FREE(memory, ends, count);
        FREE(memory, rest, count);
        return false;
    }

    memcpy(ends, blue->ends, blue->count * sizeof *ends);
    memcpy(rest, blue->rest, blue->count * sizeof *rest);
    FREE(memory, blue->ends, blue->count);
    FREE(memory, blue->rest, blue->count);
    blue->ends = ends;
    blue->rest = rest;
    blue->count = count;
    shell->edge_spare_count = more;
    return NEW(memory, shell->edge_origin, more) != NULL;
}

static bool goes(const ShellSplit *split, int k) { return k >= 0 && split->cells >> k & 1; }

bool split_is_possible(const Shell *shell, const Fan *fan, const ShellSplit *split) {
    const Sheet *sheet = &shell->sheets[shell->matter.sheet[split->vertex]];
    uint32_t all = fan->count > 0 ? UINT32_MAX >> (32 - fan->count) : 0, max = SPLIT_MOVED * shell->spare_count;
    uint32_t moves = (uint32_t)__builtin_popcount(split->cells) + 3; // of any colour

    if (split->cells == 0 || (split->cells & ~all) || split->cells == all) return false;

    // edges between cells that go and cells that stay
    int torn = 0;
    for (int k = 0; k < fan->count; k++)
        if (goes(split, k))
            torn += (fan->after[k] >= 0 && !goes(split, fan->after[k])) +
                    (fan->before[k] >= 0 && !goes(split, fan->before[k]));
    if (sheet->spare_used == sheet->spare_count || torn > SPLIT_EDGES) return false;

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        if (shell->moved[colour] + moves > max) return false;

    return true;
}

static void move_end(Shell *shell, SingeColour colour, uint32_t spring, uint32_t from, uint32_t to) {
    uint32_t *ends = shell->springs[colour].ends[spring];
    for (int k = 0; k < 2; k++)
        if (ends[k] == from) ends[k] = to;
}

/// Separates two neighbours: `cell` goes to the spare; the other one, across `side`, stays.
static TornEdge tear_edge(Shell *shell, uint32_t cell, int side, uint32_t vertex) {
    uint32_t other = shell_neighbour(shell, cell, side);
    SINGE_ASSERT(other != SHELL_NONE && shell->edge_spare_used < shell->edge_spare_count);

    CellSprings *goer = &shell->cell_springs[cell], *stayer = &shell->cell_springs[other];
    SpringSet *blue = &shell->springs[SINGE_BLUE];
    uint32_t edge = goer->blue[side], spare = blue->count - shell->edge_spare_count + shell->edge_spare_used;
    const uint32_t *ends = blue->ends[edge];
    TornEdge torn = {edge, spare, goer->green[side], ends[0] == vertex ? ends[1] : ends[0]};

    // a second blue spring for the cell that goes
    memcpy(blue->ends[spare], ends, sizeof blue->ends[spare]);
    blue->rest[spare] = blue->rest[edge];
    if (blue->grain) blue->grain[spare] = blue->grain[edge];
    uint32_t origin = edge, ordinary = blue->count - shell->edge_spare_count;
    shell->edge_origin[shell->edge_spare_used++] = origin < ordinary ? origin : shell->edge_origin[origin - ordinary];

    // the two cells are no longer neighbours
    for (int i = 0; i < 4; i++)
        if (stayer->green[i] == torn.green) stayer->green[i] = SHELL_NONE;
    goer->green[side] = SHELL_NONE;
    goer->blue[side] = spare;
    return torn;
}

SplitResult split_vertex(Shell *shell, const Fan *fan, const ShellSplit *split) {
    Sheet *sheet = &shell->sheets[shell->matter.sheet[split->vertex]];
    uint32_t first_spare = sheet->vertex_first + sheet->vertex_count - sheet->spare_count;
    SINGE_ASSERT(split_is_possible(shell, fan, split));
    uint32_t v = split->vertex, to = first_spare + sheet->spare_used++;
    SplitResult result = {.spare = to};

    // the new vertex copies the old one
    memcpy(shell->rest_position[to], shell->rest_position[v], sizeof shell->rest_position[to]);
    memcpy(shell->uv[to], shell->uv[v], sizeof shell->uv[to]);
    shell->source_vertex[to] = shell->source_vertex[v];

    // and takes the share of its area that lies in the cells that go
    double gone = 0, all = 0;
    for (int k = 0; k < fan->count; k++) {
        const float *corners[4];
        for (int i = 0; i < 4; i++) corners[i] = shell->rest_position[shell->cells[fan->cell[k]][i]];
        double area = cell_shape(corners).corner_area[fan->corner[k]];
        all += area;
        if (goes(split, k)) gone += area;
    }

    matter_split(shell, v, to, (float)(gone / all) * shell->matter.area[v]);

    // cells that go take their edges and springs along
    for (int k = 0; k < fan->count; k++) {
        if (!goes(split, k)) continue;

        uint32_t cell = fan->cell[k];
        int corner = fan->corner[k], after = side_after(corner), before = side_before(corner);
        if (fan->after[k] >= 0 && !goes(split, fan->after[k]))
            result.torn[result.torn_count++] = tear_edge(shell, cell, after, v);
        if (fan->before[k] >= 0 && !goes(split, fan->before[k]))
            result.torn[result.torn_count++] = tear_edge(shell, cell, before, v);

        const CellSprings *springs = &shell->cell_springs[cell];
        move_end(shell, SINGE_RED, springs->red[corner], v, to);
        move_end(shell, SINGE_YELLOW, springs->yellow[corner & 1], v, to);
        move_end(shell, SINGE_BLUE, springs->blue[after], v, to);
        move_end(shell, SINGE_BLUE, springs->blue[before], v, to);
        shell->cells[cell][corner] = to;
    }

    // fans and counts
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        shell->moved[colour] += (uint32_t)__builtin_popcount(split->cells) + 3;

    // cells move to the fan of the new vertex, which is empty; entries between move up
    uint32_t *first = shell->fan_first, keep = first[v], moved = 0, cells[SPLIT_FAN];
    for (int k = 0; k < fan->count; k++)
        if (goes(split, k)) cells[moved++] = fan->cell[k];
        else shell->fan[keep++] = fan->cell[k];
    memmove(shell->fan + keep, shell->fan + first[v + 1], (first[to] - first[v + 1]) * sizeof *shell->fan);
    for (uint32_t u = v + 1; u <= to; u++) first[u] -= moved;
    memcpy(shell->fan + first[to], cells, moved * sizeof *cells);
    shell->split_count++;
    return result;
}

bool split_replay(Shell *shell, const ShellSplit *splits, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        Fan fan;
        if (splits[k].vertex >= shell->vertex_count) return false;
        split_fan(shell, splits[k].vertex, &fan);
        if (!split_is_possible(shell, &fan, &splits[k])) return false;
        if (split_vertex(shell, &fan, &splits[k]).spare != splits[k].spare) return false;
    }

    return true;
}
