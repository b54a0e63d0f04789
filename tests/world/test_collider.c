// Signed distances: against hand values, and normals against numeric gradients at random points.
#include "support/support.h"

#include "world/collider.h"

static uint32_t random_state = 1;
static float any(float scale) {
    random_state = random_state * 1664525u + 1013904223u;
    return ((float)(random_state >> 8) / 16777216.0f - 0.5f) * 2 * scale;
}

static SingeColliderDef make(SingeColliderKind kind) {
    SingeColliderDef def = singe_default_collider();
    def.kind = kind;
    def.radius = 0.7f;
    def.half_size[0] = 0.5f, def.half_size[1] = 1, def.half_size[2] = 1.5f;
    def.height = 2;
    return def;
}

static float distance_at(const SingeColliderDef *def, Float3 p, Float3 *normal) {
    Collider collider = {.def = *def};
    return collider_distance(&collider, p, INFINITY, normal);
}

static double distance(const SingeColliderDef *def, Float3 p) {
    Float3 normal;
    return (double)distance_at(def, p, &normal);
}

TEST(normals_are_gradients) {
    const float e = 1e-3f;
    for (int kind = SINGE_COLLIDER_PLANE; kind <= SINGE_COLLIDER_CAPSULE; kind++) {
        SingeColliderDef def = make((SingeColliderKind)kind);
        int checked = 0;
        for (int i = 0; i < 5000; i++) {
            Float3 p = float3(any(3), any(3), any(3)), normal;
            double d = (double)distance_at(&def, p, &normal);
            assert_true(isfinite(d) && fabsf(float3_length(normal) - 1) < 1e-5f);

            double gradient[3] = {
                (distance(&def, float3(p.x + e, p.y, p.z)) - distance(&def, float3(p.x - e, p.y, p.z))) /
                    (2 * (double)e),
                (distance(&def, float3(p.x, p.y + e, p.z)) - distance(&def, float3(p.x, p.y - e, p.z))) /
                    (2 * (double)e),
                (distance(&def, float3(p.x, p.y, p.z + e)) - distance(&def, float3(p.x, p.y, p.z - e))) /
                    (2 * (double)e),
            };

            double length = sqrt(gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2]);
            if (length < 0.99) continue; // on the medial axis

            checked++;
            double off = fabs(gradient[0] - (double)normal.x) + fabs(gradient[1] - (double)normal.y) +
                         fabs(gradient[2] - (double)normal.z);
            if (off > 0.02)
                fail_msg("kind %d at (%g, %g, %g): the normal is off by %g", kind, (double)p.x, (double)p.y,
                         (double)p.z, off);

            // one step of the distance along the normal ends on the surface
            Float3 surface = float3_mad(p, normal, -(float)d);
            assert_true(fabs(distance(&def, surface)) < 1e-5);
        }

        assert_true(checked > 4800);
    }
}

static void expect(SingeColliderKind kind, Float3 p, float d, Float3 n) {
    SingeColliderDef def = make(kind);
    Float3 normal;
    float found = distance_at(&def, p, &normal);
    if (fabsf(found - d) > 1e-6f || float3_length(float3_sub(normal, n)) > 1e-6f)
        fail_msg("kind %d: %g (%g, %g, %g)", (int)kind, (double)found, (double)normal.x, (double)normal.y,
                 (double)normal.z);
}

TEST(distances_match_those_by_hand) {
    expect(SINGE_COLLIDER_PLANE, float3(5, -7, 0.25f), 0.25f, float3(0, 0, 1));
    expect(SINGE_COLLIDER_PLANE, float3(5, -7, -2), -2, float3(0, 0, 1));
    expect(SINGE_COLLIDER_SPHERE, float3(0, -1, 0), 0.3f, float3(0, -1, 0));
    expect(SINGE_COLLIDER_SPHERE, float3(0.1f, 0, 0), -0.6f, float3(1, 0, 0));
    expect(SINGE_COLLIDER_SPHERE, float3(0, 0, 0), -0.7f, float3(0, 0, 1));
    expect(SINGE_COLLIDER_BOX, float3(0.75f, 0, 0), 0.25f, float3(1, 0, 0));
    expect(SINGE_COLLIDER_BOX, float3(0, -0.9f, 0), -0.1f, float3(0, -1, 0));
    expect(SINGE_COLLIDER_BOX, float3(-0.45f, 0.5f, 1), -0.05f, float3(-1, 0, 0));
    expect(SINGE_COLLIDER_BOX, float3(3.5f, 5, 0), 5, float3(0.6f, 0.8f, 0));
    expect(SINGE_COLLIDER_BOX, float3(0.5f + 1, -1 - 2, 1.5f + 2), 3, float3(1 / 3.0f, -2 / 3.0f, 2 / 3.0f));
    expect(SINGE_COLLIDER_CAPSULE, float3(1, 0, 0.9f), 0.3f, float3(1, 0, 0));
    expect(SINGE_COLLIDER_CAPSULE, float3(0, 0, 2), 0.3f, float3(0, 0, 1));
    expect(SINGE_COLLIDER_CAPSULE, float3(0, 0, -2), 0.3f, float3(0, 0, -1));
    expect(SINGE_COLLIDER_CAPSULE, float3(0, 0.6f, 1.8f), 0.3f, float3(0, 0.6f, 0.8f));
}

TEST(surfaces_are_round_inside) {
    SingeColliderDef def = make(SINGE_COLLIDER_BOX);
    Float3 normal;
    assert_true(distance_at(&def, float3(0.5f, 1, 1.5f), &normal) == 0); // a corner
    assert_true(fabsf(float3_length(normal) - 1) < 1e-6f);
    def = make(SINGE_COLLIDER_CAPSULE);
    assert_true(distance_at(&def, float3(0, 0, 0.3f), &normal) == -0.7f); // on the axis
    assert_true(fabsf(float3_length(normal) - 1) < 1e-6f);
}
