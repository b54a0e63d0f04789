// Splitting a vertex: the only change of a Shell after its build (src/tear decides where).
//
// A vertex v gives some cells of its fan to a spare vertex v'. v' becomes a corner of these cells, and springs that lie
// only in them end at v' from then on. Cells stay whole. Where a cell of v' is next to a cell of v, their edge is torn:
// the two are no longer neighbours (their green spring no longer belongs to a cell), and the cell of v' gets its own
// blue spring, a spare one after those of the strands. v' has v's rest position, uv and material; area, mass and
// capacity are divided in the ratio of the corners' areas. The list of ShellSplit records all splits, so that they can
// be repeated.
#pragma once

#include "shell/shell.h"

enum {
    SPLIT_FAN = 24,  ///< max cells around a vertex that can be split
    SPLIT_EDGES = 2, ///< max edges that a split tears
    SPLIT_MOVED = 8, ///< max springs of a colour that splits give another end, per spare vertex
};

/// The cells around a vertex and their neighbours there.
typedef struct Fan {
    int count;                ///< number of cells in the arrays below; 0 if there are too many
    uint32_t cell[SPLIT_FAN]; ///< in the order of shell->fan
    uint8_t corner[SPLIT_FAN];
    int8_t after[SPLIT_FAN];  ///< the one counter-clockwise of it, across side corner - 1; -1 where there is none
    int8_t before[SPLIT_FAN]; ///< the one clockwise of it, across side corner
} Fan;

void split_fan(const Shell *shell, uint32_t vertex, Fan *fan);

/// An edge that a split tore: `edge` stays with the cells of v, `spare` is its twin at v'.
typedef struct TornEdge {
    uint32_t edge, spare, green;
    uint32_t far; ///< its other end
} TornEdge;

typedef struct SplitResult {
    uint32_t spare; ///< v'
    int torn_count;
    TornEdge torn[SPLIT_EDGES];
} SplitResult;

/// Gives a built shell its spare blue springs. False when out of memory.
bool split_reserve(Memory *memory, Shell *shell);

/// Whether there is room for this split and it tears no more than SPLIT_EDGES edges.
bool split_is_possible(const Shell *shell, const Fan *fan, const ShellSplit *split);

/// Splits; it must be possible.
SplitResult split_vertex(Shell *shell, const Fan *fan, const ShellSplit *split);

/// Repeats the splits of another shell of the same sheets. False if they do not fit it.
bool split_replay(Shell *shell, const ShellSplit *splits, uint32_t count);
