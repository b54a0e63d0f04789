// Springs by Hooke's law, the comparison of section 8, by the semi-implicit Euler method: forces at the positions
// before the substep, then velocities, then positions.
//
//   f   = [k W (|d| - l) + c (v_b - v_a) . u] u,   u = d/|d|,   on a; -f on b
//   c   = 2 zeta sqrt(k W/(w_a + w_b)),   zeta = 0.1 of the damping that is critical for the spring alone
//   x^  = x~ + h^2 w sum f,   and eq 13 gives v^ = v~ + h w sum f
//
// k is `stiffness`, the same for every spring, times its weight W. The method is stable while h times the highest
// frequency is below 2 - about h < sqrt(1/(6 k w)), each particle being in up to twelve springs - and blows up above.
#include "reference/spring_network.h"

#include <math.h>

static const double MASS_SPRING_DAMPING = 0.1;

typedef struct Hooke {
    Network *network;
    const SpringGroup *group;
    const float (*velocity)[4];
    double stiffness, h;
} Hooke;

/// Forces on end b, into `gradient`.
static void hooke_forces(void *task, int begin, int end) {
    const Hooke *job = task;
    const Network *network = job->network;
    for (int k = begin; k < end; k++) {
        const uint32_t *ends = job->group->ends[k];
        const double *xa = network->position[ends[0]], *xb = network->position[ends[1]], *w = network->inverse_mass;
        const float *va = job->velocity[ends[0]], *vb = job->velocity[ends[1]];
        double d[3], square = 0, closing = 0, both = w[ends[0]] + w[ends[1]], *force = network->gradient[k];
        double stiffness = job->stiffness * job->group->weight[k];

        force[0] = force[1] = force[2] = 0;
        if (both <= 0 || stiffness <= 0) continue;

        for (int i = 0; i < 3; i++) {
            double v = (double)vb[i] - (double)va[i];

            // positions before the substep: x~ less the displacement by v~; held particles have v~ too
            d[i] = xb[i] - xa[i] - job->h * v;
            square += d[i] * d[i];
            closing += d[i] * v;
        }

        double distance = sqrt(square);
        if (!(distance > 0)) continue;

        double damping = 2 * MASS_SPRING_DAMPING * sqrt(stiffness / both);
        double size = stiffness * (distance - job->group->length[k]) + damping * closing / distance;
        for (int i = 0; i < 3; i++) force[i] = -size * d[i] / distance;
    }
}

static void hooke_move(void *task, int begin, int end) {
    const Hooke *job = task;
    const SpringGroup *group = job->group;
    for (int i = begin; i < end; i++) {
        double force[3] = {0, 0, 0}, displacement = job->h * job->h * job->network->inverse_mass[i];
        if (displacement == 0) continue;

        for (uint32_t s = group->first[i]; s < group->first[i + 1]; s++) {
            const double *f = job->network->gradient[group->incident[s] / 2];
            double sign = group->incident[s] % 2 ? 1 : -1;
            for (int c = 0; c < 3; c++) force[c] += sign * f[c];
        }

        for (int c = 0; c < 3; c++) job->network->position[i][c] += displacement * force[c];
    }
}

ProjectionReport mass_spring_project(Network *network, double stiffness, const float (*velocity)[4], double h,
                                     Pool *pool) {
    Hooke job = {network, &network->groups[0], velocity, stiffness, h};
    pool_for(pool, (int)job.group->count, POOL_BLOCK, hooke_forces, &job);
    pool_for(pool, (int)network->particle_count, POOL_BLOCK, hooke_move, &job);
    return (ProjectionReport){.flops = 48.0 * job.group->count + 6.0 * network->particle_count,
                              .bytes = 172.0 * job.group->count + 60.0 * network->particle_count};
}
