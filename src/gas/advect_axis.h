// Advection of advect.c along one axis: the loops over cells, with one file per instruction set.
#pragma once

#include "gas/gas_plan.h"

enum { SWEEP_RUN = 128, SWEEP_LANES = 8 }; ///< cells in a row at a time, and at once

typedef struct Sweep Sweep;

/// Columns [first, first + count) of the box in the rows of one task, from the first along the axis to the last.
typedef void SweepFn(const Sweep *sweep, int task, int first, int count);

/// One axis of one field's displacement.
struct Sweep {
    const GasPass *pass;
    const GasBox *box;
    const float *from, *start; ///< before this axis, before the first one
    const GasRange *busy;      ///< of each row: outside of it `from` and `start` are +0
    GasRange *busy_after;      ///< and `to`, besides what the box has around it
    float *to;
    size_t beyond;    ///< from a row to the next one along the axis; 0 along the rows
    int axis, across; ///< `across`: the axis that the tasks are cut along
    bool last;        ///< removes what the divergence added
    SweepFn *rows;
};

extern SweepFn sweep_plain, sweep_v3;

/// The sweep for these instructions.
SweepFn *sweep_choose(SingeInstructions instructions);
