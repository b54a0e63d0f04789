// The sweeps of conjugate gradients that have a version for each instruction set.
#pragma once

#include "reference/spring_network.h"

typedef struct Conjugate {
    const SpringGroup *group;
    const double *value;
    double *x, *r, *p, *q;
    double alpha, beta;
} Conjugate;

/// Each works on the rows [begin, end) of a Conjugate, which are whole slices.
typedef struct ConjugateKernel {
    PoolSumFn *multiply;  ///< q = A p and p . q
    PoolSumFn *reduce;    ///< r -= alpha q and r . r
    SingeTaskFn *advance; ///< x += alpha p, p = r + beta p
} ConjugateKernel;

extern const ConjugateKernel conjugate_plain, conjugate_v3;
