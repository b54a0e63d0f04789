/// Singe: a free network of springs in double precision, for research into the constraint solver.
///
/// A network is particles, springs and sets of springs. Projecting a set is one Newton step of fast projection, eq 16
/// to 19 of the paper. It uses the code of SINGE_SOLVER_PAPER, on any network and in any order of the sets. The errors,
/// gradients and matrix of a set's system can be read.
///
/// One thread at a time may call into one network; different networks are independent.
#ifndef SINGE_RESEARCH_H
#define SINGE_RESEARCH_H

#include "singe/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SingeNetwork SingeNetwork;

/// A network. All arrays are copied.
/// Defaults: thread_count 1, set_count 1, regularisation 1e-4, time_step 1.0 / 480, tolerance 1e-7, iterations 5000;
/// all else 0 or NULL.
typedef struct SingeNetworkDef {
    size_t struct_size;
    SingeAllocator allocator;     ///< zeroed: libc's
    SingeTasks tasks;             ///< zeroed: the network's own threads
    int thread_count;             ///< 1 to 64; results do not depend on it
    uint32_t particle_count;      ///< at least 1
    const double *positions;      ///< [3 * particle_count] m, -1e9 to 1e9; needed
    const double *inverse_masses; ///< [particle_count] 0 to 1e30; 1/kg; NULL: 1 each
    /// [particle_count] or NULL: none. A held particle takes part in the system by its inverse mass, and is put back
    /// afterwards. This differs from an inverse mass of 0, with which the system knows that it cannot move.
    const uint8_t *held;
    uint32_t spring_count;     ///< at least 1
    const uint32_t *ends;      ///< [2 * spring_count] two different particles each
    const double *lengths;     ///< [spring_count] m, 1e-12 to 1e9; targets; needed
    const double *weights;     ///< [spring_count] 0 to 1; W of eq 19; 0: absent; NULL: 1 each
    const double *compliances; ///< [spring_count] m/N, 0 to 1e9; NULL: 0 each
    uint32_t set_count;        ///< 1 to spring_count
    const uint32_t *sets;      ///< [spring_count] the set of each spring, or NULL: all are in set 0
    /// C = |d|^2/l - l as in eq 10, without regularisation and compliance; else C = (|d|^2 - l^2)/(2 |d|)
    bool literal;
    double regularisation; ///< 0 to 1e6; added to the diagonal, relative to the mean of w_a and w_b
    double time_step;      ///< s, 1e-9 to 10; h in compliance/h^2
    double tolerance;      ///< above 0, to 1; residual of the conjugate gradients, relative to the right-hand side
    int iterations;        ///< 1 to 1000000; max of the conjugate gradients
} SingeNetworkDef;

SINGE_API void singe_init_network(SingeNetworkDef *def, size_t struct_size);

static inline SingeNetworkDef singe_default_network(void) {
    SingeNetworkDef def;
    singe_init_network(&def, sizeof def);
    return def;
}

/// Makes a network. On failure *network is NULL and *error (may be NULL) says why.
SINGE_API SINGE_NODISCARD SingeResult singe_network_create(const SingeNetworkDef *def, SingeNetwork **network,
                                                           SingeError *error);

/// Frees a network; NULL is allowed.
SINGE_API void singe_network_destroy(SingeNetwork *network);

/// The positions, [3 * particle_count] m, to be read and written. The network owns them; valid until it is destroyed.
SINGE_API double *singe_network_positions(SingeNetwork *network);

/// The number of springs of a set; 0 if there is no such set. Below, row i of a set is its i-th spring in the order of
/// the Def.
SINGE_API uint32_t singe_network_set_size(const SingeNetwork *network, uint32_t set);

/// The cost of a projection.
typedef struct SingeNetworkReport {
    uint32_t iterations; ///< of the conjugate gradients
    double residual;     ///< at their end, relative to the right-hand side; 0 if that was 0
} SingeNetworkReport;

/// Projects one set: J M^-1 J^T lambda = W C, x -= M^-1 J^T lambda. Allocates nothing. *report may be NULL.
/// SINGE_ERROR_ARGUMENT: there is no such set. SINGE_ERROR_DIVERGED: conjugate gradients met a system that is not
/// positive definite, or numbers that are not finite; nothing was moved.
SINGE_API SINGE_NODISCARD SingeResult singe_network_project(SingeNetwork *network, uint32_t set,
                                                            SingeNetworkReport *report);

/// C of every spring of a set at the present positions, in m, into [set size]. Returns their Euclidean norm. `errors`
/// may be NULL.
SINGE_API double singe_network_errors(const SingeNetwork *network, uint32_t set, double *errors);

/// J M^-1/2 of a set at the present positions, into [set size][3 * particle_count]: its singular values squared are
/// the eigenvalues of J M^-1 J^T, and its rank is that of the system.
SINGE_API void singe_network_jacobian(SingeNetwork *network, uint32_t set, double *jacobian);

/// The matrix of a set's system at the present positions, regularisation and compliance included, into
/// [set size][set size], as the conjugate gradients have it. Springs of weight 0 have empty rows.
SINGE_API void singe_network_matrix(SingeNetwork *network, uint32_t set, double *matrix);

#ifdef __cplusplus
}
#endif
#endif
