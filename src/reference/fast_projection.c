// One projection of a group of springs: Newton's step of the fast projection method (Goldenthal et al. 2007) as in eq
// 16 to 19, with masses.
//
// A spring of target length l from a to b, d = x_b - x_a, has the row (row-normalised: eq 10 over the length of its
// gradient, eq 11)
//
//   C = (|d|^2 - l^2) / (2 |d|),   g = dC/dx_b = d/|d| = -dC/dx_a
//
// or to the letter of the paper C = |d|^2/l - l, g = 2 d/l. With w = 1/m
//
//   (J M^-1 J^T + S) lambda = W C,   x_a += w_a g lambda,   x_b -= w_b g lambda
//   S = compliance/h^2 + regularisation (w_a + w_b)/2
//
// is solved for mu = D^(1/2) lambda, D the diagonal:  D^(-1/2) (J M^-1 J^T + S) D^(-1/2) mu = D^(-1/2) W C.
#include "common/real.h"
#include "reference/spring_network.h"

#include <math.h>

typedef struct Rows {
    Network *network;
    const SpringGroup *group;
} Rows;

typedef struct Row {
    double gradient[3], constraint;
} Row;

static Row projection_row(const Network *network, const SpringGroup *group, uint32_t k) {
    const double *a = network->position[group->ends[k][0]], *b = network->position[group->ends[k][1]];
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, l = group->length[k];
    double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], distance = sqrt(square);
    if (network->rules.literal) return (Row){{2 * d[0] / l, 2 * d[1] / l, 2 * d[2] / l}, square / l - l};

    // a spring crushed below half its length has hardly a direction: its row's request is limited
    double inverse = 1 / double_max(distance, 1e-30), divisor = 2 * double_max(distance, 0.5 * l);
    return (Row){{d[0] * inverse, d[1] * inverse, d[2] * inverse}, (square - l * l) / divisor};
}

double network_constraint(const Network *network, uint32_t group, uint32_t spring) {
    return projection_row(network, &network->groups[group], spring).constraint;
}

/// Gradients, scales and right-hand sides of [begin, end); returns the sum of squares of the right-hand sides.
static double projection_rows(void *task, int begin, int end) {
    const Rows *job = task;
    Network *network = job->network;
    const SpringGroup *group = job->group;
    const double *w = network->inverse_mass;
    double sum = 0;

    for (int k = begin; k < end; k++) {
        double *g = network->gradient[k];
        g[0] = g[1] = g[2] = network->scale[k] = network->residual[k] = 0;
        if (group->weight[k] <= 0) continue;

        Row row = projection_row(network, group, (uint32_t)k);

        // diagonal of J M^-1 J^T, with regularisation and compliance
        double both = w[group->ends[k][0]] + w[group->ends[k][1]];
        double square =
            row.gradient[0] * row.gradient[0] + row.gradient[1] * row.gradient[1] + row.gradient[2] * row.gradient[2];
        double diagonal = both * square;
        if (!network->rules.literal)
            diagonal += 0.5 * group->regularisation * both + group->compliance[k] * network->rules.inverse_h2;
        if (!(diagonal > 0) || both <= 0) continue; // held at both ends, or no direction at all

        // the row, scaled to a diagonal of 1
        for (int i = 0; i < 3; i++) g[i] = row.gradient[i];
        network->scale[k] = 1 / sqrt(diagonal);
        network->residual[k] = network->scale[k] * group->weight[k] * row.constraint;
        sum += network->residual[k] * network->residual[k];
    }

    return sum;
}

double network_rows(Network *network, uint32_t group, Pool *pool) {
    Rows job = {network, &network->groups[group]};
    return pool_sum(pool, (int)job.group->padded, projection_rows, &job, network->partial);
}

/// The target lengths in the norm of the residual: the reference of its tolerance for the early exit.
static double projection_lengths(void *task, int begin, int end) {
    const Rows *job = task;
    double sum = 0;
    for (int k = begin; k < end; k++) {
        double l = job->network->scale[k] * job->group->length[k];
        sum += l * l;
    }

    return sum;
}

/// Eq 17, particle by particle: each gathers from its springs.
static void projection_move(void *task, int begin, int end) {
    const Rows *job = task;
    Network *network = job->network;
    const SpringGroup *group = job->group;

    for (int i = begin; i < end; i++) {
        double push[3] = {0, 0, 0}, w = network->held[i] ? 0 : network->inverse_mass[i];
        if (w == 0) continue;

        for (uint32_t s = group->first[i]; s < group->first[i + 1]; s++) {
            uint32_t k = group->incident[s] / 2;
            double lambda = network->scale[k] * network->solution[k];
            if (group->incident[s] % 2) lambda = -lambda;
            for (int c = 0; c < 3; c++) push[c] += network->gradient[k][c] * lambda;
        }

        for (int c = 0; c < 3; c++) network->position[i][c] += w * push[c];
    }
}

ProjectionReport network_project(Network *network, uint32_t group, Pool *pool) {
    Rows job = {network, &network->groups[group]};
    const ProjectionRules *rules = &network->rules;
    int rows = (int)job.group->padded;
    double entries = (double)ellpack_entries(job.group), particles = network->particle_count;
    double square = network_rows(network, group, pool), enough = rules->tolerance * rules->tolerance * square;

    // the error at which to stop
    if (rules->early_exit) {
        double lengths = pool_sum(pool, rows, projection_lengths, &job, network->partial);
        enough = double_max(enough, rules->tolerance * rules->tolerance * lengths);
    }

    // assemble, solve and move
    ProjectionReport report = {.broken = !isfinite(square)};
    if (!report.broken && square > enough) {
        ellpack_assemble(network, group, pool);
        report = conjugate_gradient(network, group, pool, square, enough);
        report.flops += 8 * entries;
        report.bytes += 13 * entries + 32.0 * rows;
        if (!report.broken) pool_for(pool, (int)network->particle_count, POOL_BLOCK, projection_move, &job);
        report.flops += 16.0 * rows + 6 * particles;
        report.bytes += 48.0 * rows + 56 * particles;
    }

    report.flops += 34.0 * rows;
    report.bytes += 120.0 * rows;
    return report;
}
