// Plastic creases: a sheet bent sharper than a radius keeps a part of the bend.
//
// Geometry. Two cells meet at an edge, their centroids at the distances p and q from it along the sheet: the bend
// between them is spread over the arc s = p + q. theta is the angle from one cell's normal n to the other's, positive
// where the sheet folds away from the centres:
//
//   theta = atan2((n_1 x n_2) . e, n_1 . n_2),   e the unit edge, turned as it is in the first cell
//
// The distance of centres at the thickness t over their cells is then (p = q; alpha = theta/2)
//
//   l(theta) = s cos alpha + 2 t sin alpha = r cos(alpha - beta),   r^2 = s^2 + 4 t^2,   tan beta = 2 t/s
//
// so that a green spring of the target length l(theta_0 + theta_p), theta_0 the angle at rest, is at rest in a fold of
// theta_p more: longer for folds away from the centres, shorter towards them. The other colours keep their targets. As
// a fraction of the length for theta_0, which eq 6 gives, that is cos(psi_p)/cos(phi) with
//
//   phi = theta_0/2 - beta,   psi_p = phi + theta_p/2,   psi = phi + (present angle)/2
//
// At other angles such a spring bends ever more softly the nearer psi is to 0, where l is largest, and the sheet would
// yield at one edge and spare its neighbours. A creased spring therefore gets the target for which, at its present
// angle, the moment (l - target) dl/dalpha is 4 t^2 times (psi - psi_p), as in a flat sheet:
//
//   f = (cos psi + sin^2 beta (psi - psi_p)/sin psi)/cos phi
//
// with at least CREASE_LEVER of sin beta in place of |sin psi|. A mesh of cells s holds less than 2 beta at an edge
// away from the centres, and less than pi - 2 beta towards them. Creases are limited to CREASE_HOLDS of both angles.
//
// Plasticity, in curvatures k = angle/s (1/m), which mean the same on every mesh. The elastic part is neither crease
// nor due to eq 6, k_e = k - k_6 - k_p, where layers that shrink by ratios a (green) and b (blue) curl by
// cos(phi + theta_6/2) = a/b cos phi. With k_y = 1/crease_radius, c = crease_share,
//
//   |k_e| > k_y + (1/c - 1)|k_p|:   k_p += c (|k_e| - k_y - (1/c - 1)|k_p|) sign k_e
//
// which is linear hardening: a sheet bent from flat to k keeps k_p = c (|k| - k_y), at once and at any step. A released
// sheet has |k_e| = 0 at k = k_p: only a bend by k_y in the opposite direction opens the crease again. k - k_6 passes a
// low-pass filter of CREASE_TIME: trembling does not crease.
//
// Three things keep creases from running along rows of the mesh.
//
// Width. An edge that yields is soft, and would take all of a bend into one row of edges: k - k_6 counts only up to
// CREASE_PEAK of the mean about an edge, of its own bend and half as much of those before and after it along the
// strand. An arc of any length loses nothing by that, a single edge a third.
//
// Direction. A fold of the curvature k whose line is turned by omega from the edge bends it by k cos^2 omega and twists
// it by k sin omega cos omega, like a cylinder, as a sheet does not stretch: the twist tau is the rotation from n_1 to
// n_2 about the direction across the edge. So that a fold keeps the same in any direction, an edge has cos^2 omega k_y
// in place of k_y, where cos^2 omega = theta^2/(theta^2 + (tau - tau_0)^2), theta without theta_0 and eq 6's part, and
// at least CREASE_SLANT. Otherwise creases along the mesh would come at k_y and those along its diagonals at 2 k_y.
//
// Sharpness. Nothing is kept of a bend beyond curvature_max, which the mesh gives back (curvature.c): k - k_6 counts up
// to cos^2 omega of it, so that |k_p| <= c (curvature_max - k_y) cos^2 omega.
//
// Char breaks instead of folding: with the burn progress B of the two cells a crease fades, k_p (1 - B) of it counts,
// and no more than that share of a bend is kept.
#include "common/real.h"
#include "dynamics/dynamics_plan.h"

/// s, how long a bend must last.
static const float CREASE_TIME = 0.02f;

/// Share of the angle where l(theta) is flat or 0 that a crease may have, so that it stays stiff.
static const float CREASE_HOLDS = 0.85f;

/// Min lever of a creased spring, -sin psi, over that in a flat sheet. With less, the force for the same moment would
/// pull the cells into each other.
static const float CREASE_LEVER = 0.5f;

/// Min cos^2 omega that counts: a fold more nearly across an edge bends it little, and its direction is uncertain.
static const float CREASE_SLANT = 0.4f;

/// Max bend of an edge that counts, over the mean about it: that of the last edge of an even arc.
static const float CREASE_PEAK = 4.0f / 3;

static const float CREASE_PI = 3.14159265f;

typedef struct Crease {
    DynamicsPlan *plan;
    const Shell *shell;
    const StateInput *state;
    DynamicsState *dynamics;
    float follows; ///< weight of the present bend in the low-pass filter in this step
    bool burning;  ///< something has burnt
} Crease;

// ---- once

/// The side of a cell across which `other` lies.
static uint8_t hinge_side(const Shell *shell, uint32_t cell, uint32_t other) {
    uint8_t side = 0;
    while (side < 3 && shell_neighbour(shell, cell, side) != other) side++;
    return side;
}

static Float3 hinge_normal(const float (*x)[4], const uint32_t *corner) {
    return float3_unit(float3_cross(float3_sub(float3_load(x[corner[2]]), float3_load(x[corner[0]])),
                                    float3_sub(float3_load(x[corner[3]]), float3_load(x[corner[1]]))));
}

static Float3 hinge_centroid(const float (*x)[4], const uint32_t *corner) {
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) sum = float3_mad(sum, float3_load(x[corner[i]]), 0.25f);
    return sum;
}

/// theta between unit normals; NAN if one of them is zero.
static inline float hinge_angle(Float3 a, Float3 b, Float3 edge) {
    float along = float3_dot(a, b), length = float3_length(edge);
    if (!(length > 0 && float3_dot(a, a) > 0.5f && float3_dot(b, b) > 0.5f)) return NAN;

    float across = float3_dot(float3_cross(a, b), edge) / length;
    if (along < 0.9f) return real_atan2f(across, along);

    float square = across * across; // asin, with a relative error of 1e-4
    return across * (1 + square * (1.0f / 6 + square * (3.0f / 40 + square * (15.0f / 336))));
}

/// tau: the part of the rotation from one unit normal to the other about the direction across the edge.
static float hinge_twist(Float3 a, Float3 b, Float3 edge) {
    const Float3 turn = float3_cross(a, b), across = float3_cross(float3_add(a, b), edge);
    const float sine = float3_length(turn), length = float3_length(across);
    if (!(sine > 0 && length > 0)) return 0;
    return real_atan2f(sine, float3_dot(a, b)) / sine * float3_dot(turn, across) / length;
}

void creases_measure(const Shell *shell, Hinge *hinges) {
    const float(*x)[4] = (const float(*)[4])shell->rest_position;
    const Matter *matter = &shell->matter;
    for (uint32_t k = 0; k < shell->springs[SINGE_GREEN].count; k++) {
        const uint32_t *ends = shell->springs[SINGE_GREEN].ends[k];
        const uint32_t cell[2] = {ends[0] - shell->vertex_count, ends[1] - shell->vertex_count};
        Hinge hinge = {.side = {hinge_side(shell, cell[0], cell[1]), hinge_side(shell, cell[1], cell[0])}};
        const uint32_t *corner = shell->cells[cell[0]], *other = shell->cells[cell[1]];
        const uint32_t first = corner[hinge.side[0]], second = corner[(hinge.side[0] + 1) & 3];

        // the edge, and the arc from centroid to centroid
        Float3 from = float3_load(x[first]), to = float3_load(x[second]);
        Float3 edge = float3_sub(to, from), midpoint = float3_scale(float3_add(from, to), 0.5f);
        hinge.arc = float3_length(float3_sub(hinge_centroid(x, corner), midpoint)) +
                    float3_length(float3_sub(hinge_centroid(x, other), midpoint));

        // angles at rest
        float thickness = 0.5f * (field_at(matter->thickness, ends[0]) + field_at(matter->thickness, ends[1]));
        const Float3 normal = hinge_normal(x, corner), beyond = hinge_normal(x, other);
        float angle = hinge_angle(normal, beyond, edge);
        hinge.angle = isnan(angle) ? 0 : angle;
        hinge.twist = hinge_twist(normal, beyond, edge);
        hinge.max = real_atan2f(2 * thickness, hinge.arc);
        hinge.lean = float_max(-1.5f, float_min(0.5f * hinge.angle - hinge.max, 1.5f)); // so that r cos phi is not 0

        // curvature_max at the midpoint, if both ends have one, and at most what cells of this size can bear
        float a = field_at(matter->curvature_max, first), b = field_at(matter->curvature_max, second);
        hinge.limit = a > 0 && b > 0 ? float_min(0.5f * (a + b), hinge.max / hinge.arc) : INFINITY;
        hinges[k] = hinge;
    }
}

// ---- a step

/// phi + angle/2, limited to a crease that the mesh holds.
static float crease_lean(const Hinge *hinge, float angle) {
    float away = -(1 - CREASE_HOLDS) * hinge->max, towards = -CREASE_HOLDS * CREASE_PI / 2;
    float lean = hinge->lean + 0.5f * angle;
    if (angle > 0) return float_min(lean, float_max(away, hinge->lean));
    return float_max(lean, float_min(towards, hinge->lean));
}

float crease_ratio(const Hinge *hinge, float stays, float now) {
    float kept = crease_lean(hinge, stays), lean = crease_lean(hinge, now), flat = real_sinf(hinge->max);
    float moment = flat * flat * (lean - kept) / float_min(real_sinf(lean), -CREASE_LEVER * flat);
    return float_max(real_cosf(lean) + moment, 0.05f) / real_cosf(hinge->lean);
}

float crease_kept(const Shell *shell, const StateInput *state, uint32_t green) {
    const uint32_t *ends = shell->springs[SINGE_GREEN].ends[green];
    float kept = 1;
    for (int k = 0; k < 2; k++) {
        float mass = state->burn->mass[ends[k]];
        if (mass < 1) kept -= 0.5f * shell_burn_progress(mass, field_at(shell->matter.mass_min, ends[k]));
    }

    return kept;
}

float crease_factor(const DynamicsPlan *plan, const Shell *shell, const StateInput *state,
                    const DynamicsState *dynamics, uint32_t green) {
    if (!plan->hinges || dynamics->crease[green] == 0) return 1;
    const Hinge *hinge = &plan->hinges[green];
    const float stays = dynamics->crease[green] * hinge->arc * crease_kept(shell, state, green);
    return crease_ratio(hinge, stays, dynamics->bend[green] * hinge->arc);
}

static Float3 crease_edge(const Crease *job, const uint32_t *ends, const Hinge *hinge) {
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    const uint32_t *corner = job->shell->cells[ends[0] - job->shell->vertex_count];
    return float3_sub(float3_load(x[corner[(hinge->side[0] + 1) & 3]]), float3_load(x[corner[hinge->side[0]]]));
}

/// The present k - k_6, in rad; NAN where it is not known. `last` is the previous one.
static float crease_turned(const Crease *job, uint32_t k, float last) {
    const uint32_t *ends = job->shell->springs[SINGE_GREEN].ends[k];
    const Hinge *hinge = &job->plan->hinges[k];
    const float(*normal)[4] = (const float(*)[4])job->plan->cell_normal;
    const uint32_t first = ends[0] - job->shell->vertex_count, second = ends[1] - job->shell->vertex_count;

    // the angle by which layers that have shrunk differently curl by themselves
    float curl = 0;
    if (job->burning && crease_kept(job->shell, job->state, k) != 1) {
        const float *length = job->state->burn->spring_length[SINGE_BLUE], *rest = job->shell->springs[SINGE_BLUE].rest;
        float blue = 0; // length of the mesh along the spring over that at rest: the mean of its cells' four springs
        for (int end = 0; end < 2; end++)
            for (int i = 1; i < 4; i += 2) {
                const CellSprings *cell = &job->shell->cell_springs[ends[end] - job->shell->vertex_count];
                const uint32_t spring = cell->blue[(hinge->side[end] + i) & 3];
                blue += 0.25f * length[spring] / rest[spring];
            }
        const float green = job->state->burn->spring_length[SINGE_GREEN][k] / job->shell->springs[SINGE_GREEN].rest[k];
        const float ratio = green / blue * real_cosf(hinge->lean), lean = real_acosf(ratio < 1 ? ratio : 1);
        curl = 2 * ((hinge->lean > 0 ? lean : -lean) - hinge->lean);
    }

    float angle = hinge_angle(float3_load(normal[first]), float3_load(normal[second]), crease_edge(job, ends, hinge));

    // a sheet folded flat on itself has both signs: the angle keeps the sign that it had
    const float before = last + curl + hinge->angle;
    if (angle - before > CREASE_PI) angle = CREASE_PI * -1;
    else if (angle - before < -CREASE_PI) angle = CREASE_PI;
    return angle - hinge->angle - curl;
}

/// Filters the bends of green springs, without the curl of their layers.
static void crease_bends(void *task, int begin, int end) {
    const Crease *job = task;
    const uint8_t *flags = job->state->ablate->spring_flags[SINGE_GREEN];
    for (uint32_t k = (uint32_t)begin; k < (uint32_t)end; k++) {
        if (!(flags[k] & SINGE_ALIVE)) continue;

        float *bend = &job->dynamics->bend[k], arc = job->plan->hinges[k].arc;
        float turned = crease_turned(job, k, *bend * arc);
        if (!isnan(turned)) *bend += job->follows * (turned / arc - *bend);
    }
}

/// Lets creases grow. Returns how many there are.
static double crease_springs(void *task, int begin, int end) {
    const Crease *job = task;
    const uint8_t *flags = job->state->ablate->spring_flags[SINGE_GREEN];
    const SpringSet *green = &job->shell->springs[SINGE_GREEN];
    const float *bends = job->dynamics->bend;
    const Matter *matter = &job->shell->matter;
    double creased = 0;
    for (uint32_t k = (uint32_t)begin; k < (uint32_t)end; k++) {
        if (!(flags[k] & SINGE_ALIVE)) continue;

        const uint32_t *ends = green->ends[k];
        float *crease = &job->dynamics->crease[k];

        // the part of the bend that counts next to those of its neighbours along the strand
        float sum = bends[k], weight = 1;
        if (k > 0 && flags[k - 1] & SINGE_ALIVE && green->ends[k - 1][1] == ends[0]) {
            sum += 0.5f * bends[k - 1];
            weight += 0.5f;
        }
        if (k + 1 < green->count && flags[k + 1] & SINGE_ALIVE && green->ends[k + 1][0] == ends[1]) {
            sum += 0.5f * bends[k + 1];
            weight += 0.5f;
        }
        const float peak = CREASE_PEAK * fabsf(sum) / weight;
        const float bend = sum * bends[k] > 0 ? float_max(-peak, float_min(bends[k], peak)) : 0;
        float radius = 0.5f * (field_at(matter->crease_radius, ends[0]) + field_at(matter->crease_radius, ends[1]));
        if (fabsf(bend) * radius < CREASE_SLANT && *crease == 0) continue; // the usual case

        float kept = job->burning ? crease_kept(job->shell, job->state, k) : 1;
        float share = 0.5f * (field_at(matter->crease_share, ends[0]) + field_at(matter->crease_share, ends[1]));
        if (radius > 0 && share > 0 && kept > 0) {
            // growth of |k_p|, with the sign of the bend that causes it
            // cos^2 omega. The bend is the larger of the present and the filtered one: no edge seems oblique while its
            // fold opens
            const Hinge *hinge = &job->plan->hinges[k];
            uint32_t first = ends[0] - job->shell->vertex_count, second = ends[1] - job->shell->vertex_count;
            const float(*normal)[4] = (const float(*)[4])job->plan->cell_normal;
            const float lasting = job->dynamics->bend[k] * hinge->arc, now = crease_turned(job, k, lasting);
            const float turn = float_max(fabsf(lasting), fabsf(now)); // also where now is NAN
            float twist =
                hinge_twist(float3_load(normal[first]), float3_load(normal[second]), crease_edge(job, ends, hinge));
            twist -= hinge->twist;
            const float slant = float_max(turn * turn / float_max(turn * turn + twist * twist, 1e-20f), CREASE_SLANT);
            const float held = kept * *crease;
            const float max = slant * job->plan->hinges[k].limit,
                        elastic = float_max(-max, float_min(bend, max)) - held;
            const float excess = fabsf(elastic) - slant / radius - (1 / share - 1) * fabsf(held);
            *crease += kept * (excess > 0 ? copysignf(share * excess, elastic) : 0);
        }

        creased += *crease != 0;
    }

    return creased;
}

static void crease_normals(void *task, int begin, int end) {
    const Crease *job = task;
    const float(*x)[4] = (const float(*)[4])job->dynamics->position;
    for (int c = begin; c < end; c++) float3_store(job->plan->cell_normal[c], hinge_normal(x, job->shell->cells[c]));
}

void dynamics_crease(DynamicsPlan *plan, const Shell *shell, const StateInput *state, Pool *pool, float h,
                     DynamicsState *dynamics) {
    if (!plan->hinges) return;

    Crease job = {plan, shell, state, dynamics, 1 - real_expf(-h / CREASE_TIME), state->burn->mass_burnt > 0};
    pool_for(pool, (int)shell->cell_count, POOL_GRAIN, crease_normals, &job);
    pool_for(pool, (int)shell->springs[SINGE_GREEN].count, POOL_GRAIN, crease_bends, &job);
    double creased = pool_sum(pool, (int)shell->springs[SINGE_GREEN].count, crease_springs, &job, plan->partial);
    plan->creased = creased > 0;
}
