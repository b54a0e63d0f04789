// Pieces that came free fall as plates do: they glide, flutter and tumble.
//
// Drag of the normal velocity alone (prepare.c, move.c) slides a tilted plate away along its tilt, faster and faster. A
// plate of area A, normal n, chord L = sqrt(A) and mass per area s, which moves at u relative to the air, with
// u_n = u.n, u_t = u - u_n n and q = 1/2 rho, has also, once a step,
//
//   normal   -q C u_n (|u| - |u_n|) n    per area: at a small angle it has lift, in proportion to it
//   along    -q C_f |u| u_t              per area: friction
//   moment   q C A u_n |u_t| L/4         the pressure's centre is a quarter of the chord ahead where u_n << u_t, and in
//                                        the middle where u_t = 0 (Andersen, Pesavento and Wang 2005)
//   wake     q C A |u|^2 L e             e = SWING sin(2 pi SHED w t/L + phase): the vortices that it sheds in turn, at the
//                                        Strouhal number SHED, of its speed of fall w; with some pieces e = TUMBLE,
//                                        as one vortex stays with a plate that turns over
//
// Moments are pressures that grow from the centre of the area, a.r, so that no particle needs to know what is rigid.
// All of it is divided by 1 + 2 q C |u| h/s, and so never reverses a motion.
//
// A piece is free if nothing pins it, and its sheet's largest piece has kept the sheet's number. What is not flat, a ball
// or a roll, feels it by |sum A n| / sum A.
#include "common/float3.h"
#include "common/random.h"
#include "common/real.h"
#include "dynamics/dynamics_plan.h"

#include <string.h>

static const float PLATES_FRICTION = 0.13f; ///< C_f of both sides, laminar flow over some millimetres at half a m/s
static const float SHED = 0.13f;
static const float SWING = 0.055f;
static const float TUMBLE = 0.14f;
static const uint32_t TUMBLERS = 3; ///< one piece of so many tumbles

/// A free piece in the air: sums at first, then means.
struct Plate {
    int32_t piece;
    bool held;
    float mass, area, drag;        ///< kg, m2, and kg/m of q C A; of both layers, so a particle has half of its area
    Float3 centre, motion, normal; ///< m, m/s relative to the air, and unit times flatness; by area
    Float3 edge;                   ///< m, its first particle
    Float3 push, turning;          ///< N s/m2 in a step, and that per m of r
};

/// The plate of a particle, a new one for the first of a piece; NULL if it is not free or there are too many.
static Plate *plate_of(DynamicsPlan *plan, const AblateState *ablate, uint32_t i, uint32_t sheets) {
    const int32_t piece = ablate->piece[i];
    if (piece < (int32_t)sheets) return NULL;
    uint16_t *slot = &plan->plate_slot[piece];
    if (*slot == 0) {
        if (plan->plate_count == PLATE_LIMIT) return NULL;
        plan->plates[plan->plate_count] = (Plate){.piece = piece};
        *slot = (uint16_t)++plan->plate_count;
    }
    return &plan->plates[*slot - 1];
}

static float plate_area(const Shell *shell, uint32_t i) { return 0.5f * shell->matter.area[i]; }

/// Along a, without its part along the unit vector n; 0 if nothing is left.
static Float3 level(Float3 a, Float3 n) { return float3_mad(a, n, -float3_dot(a, n)); }

/// Means, and what the air does in h seconds.
static void plate_push(Plate *plate, const DynamicsSettings *settings, double time, float h) {
    plate->held |= !(plate->area > 0 && plate->drag > 0);
    if (plate->held) return;
    const float inverse = 1 / plate->area, chord = sqrtf(plate->area), c = plate->drag * inverse;
    plate->centre = float3_scale(plate->centre, inverse);
    plate->motion = float3_scale(plate->motion, inverse);
    plate->normal = float3_scale(plate->normal, inverse);

    const Float3 n = float3_unit(plate->normal), u = plate->motion, along = level(u, n);
    const float speed = float3_length(u), across = float3_dot(u, n), density = plate->mass * inverse;
    const float share = float3_length(plate->normal) * h / (1 + 2 * c * speed * h / density);
    const float gravity = float3_length(float3_load(settings->gravity)), fall = sqrtf(gravity * density / c);

    plate->push = float3_scale(n, -share * c * across * (speed - fabsf(across)));
    plate->push = float3_mad(plate->push, along, -share * 0.5f * settings->air_density * PLATES_FRICTION * speed);
    plate->turning = float3_scale(along, -share * 3 * c * across / chord);

    const Float3 arm = float3_unit(level(float3_sub(plate->edge, plate->centre), n));
    const uint32_t hash = random_hash((uint32_t)plate->piece, 0, 0, 5);
    const double turns = (double)(SHED * fall / chord) * time + (double)random_unit(hash);
    const float shed = SWING * real_sinf(6.2831853f * (float)(turns - floor(turns)));
    const float wake = hash % TUMBLERS == 0 ? TUMBLE : shed;
    plate->turning = float3_mad(plate->turning, arm, share * 12 * c * speed * speed * wake / chord);
}

bool plates_create(Memory *memory, DynamicsPlan *plan) {
    return NEW(memory, plan->plates, PLATE_LIMIT) && NEW(memory, plan->plate_slot, plan->particle_count);
}

void plates_free(Memory *memory, DynamicsPlan *plan) {
    FREE(memory, plan->plates, PLATE_LIMIT);
    FREE(memory, plan->plate_slot, plan->particle_count);
}

void dynamics_fly(DynamicsPlan *plan, const Shell *shell, const AblateState *ablate, double time, float h,
                  DynamicsState *dynamics) {
    if (ablate->piece_count <= shell->sheet_count || plan->settings.air_density == 0) return;
    // sums over each plate
    for (uint32_t i = 0; i < shell->particle_count; i++) {
        Plate *plate = plate_of(plan, ablate, i, shell->sheet_count);
        if (!plate) continue;
        plate->held |= plan->inverse_mass[i] == 0;
        if (plate->held) continue;

        const float area = plate_area(shell, i);
        const Float3 at = float3_load(dynamics->position[i]);
        if (plate->area == 0) plate->edge = at;
        plate->mass += 1 / plan->inverse_mass[i];
        plate->area += area;
        plate->drag += 0.5f * plan->settings.air_density * field_at(shell->matter.drag, i) * area;
        plate->centre = float3_mad(plate->centre, at, area);
        plate->motion = float3_mad(
            plate->motion, float3_sub(float3_load(dynamics->velocity[i]), float3_load(plan->air[i & plan->air_mask])),
            area);
        plate->normal = float3_mad(plate->normal, float3_load(plan->normal[i]), area);
    }

    for (uint32_t k = 0; k < plan->plate_count; k++) plate_push(&plan->plates[k], &plan->settings, time, h);

    for (uint32_t i = 0; i < shell->particle_count; i++) {
        const Plate *plate = plate_of(plan, ablate, i, shell->sheet_count);
        if (!plate || plate->held) continue;
        const Float3 n = float3_unit(plate->normal);
        const float r = float3_dot(float3_sub(float3_load(dynamics->position[i]), plate->centre), plate->turning);
        const float share = plate_area(shell, i) * plan->inverse_mass[i];
        float3_store(dynamics->velocity[i],
                     float3_mad(float3_load(dynamics->velocity[i]), float3_mad(plate->push, n, r), share));
    }

    for (uint32_t k = 0; k < plan->plate_count; k++) plan->plate_slot[plan->plates[k].piece] = 0;
    plan->plate_count = 0;
}
