// Signed distances of the primitives in their own frames.
#include "world/collider.h"

static bool in_range(float value, float low, float high) { return value >= low && value <= high; }

SingeResult collider_check(const SingeColliderDef *def, SingeError *error) {
    const char *what = NULL;
    if (def->kind < SINGE_COLLIDER_PLANE || def->kind > SINGE_COLLIDER_CAPSULE) what = "kind is unknown";
    bool round = def->kind == SINGE_COLLIDER_SPHERE || def->kind == SINGE_COLLIDER_CAPSULE;
    if (round && !in_range(def->radius, 1e-6f, 1e6f)) what = "radius must be above 0";
    for (int i = 0; i < 3; i++)
        if (def->kind == SINGE_COLLIDER_BOX && !in_range(def->half_size[i], 1e-6f, 1e6f))
            what = "half_size must be above 0";
    if (def->kind == SINGE_COLLIDER_CAPSULE && !in_range(def->height, 0, 1e6f)) what = "height must be 0 or more";
    if (!in_range(def->friction, 0, 1e3f)) what = "friction must be between 0 and 1000";
    if (!in_range(def->offset, 0, 1e3f)) what = "offset must be 0 or more";
    if (!in_range(def->conductance, 0, 1e9f)) what = "conductance must be 0 or more";
    if (!in_range(def->contact_distance, 0, 1e3f)) what = "contact_distance must be 0 or more";
    if (def->conductance > 0 && !in_range(def->temperature, 1e-3f, 1e5f)) what = "temperature must be above 0 K";
    if (def->path_count == 0) what = "path needs at least one key";
    return what ? error_set(error, SINGE_ERROR_ARGUMENT, "collider", -1, "%s", what) : SINGE_OK;
}

static float collider_round(Vec offset, float radius, Vec *normal) {
    float length = vec_length(offset);
    *normal = length > 0 ? vec_scale(offset, 1 / length) : vec(0, 0, 1);
    return length - radius;
}

static float collider_box(const float half[3], Vec p, Vec *normal) {
    float q[3] = {p.x, p.y, p.z}, out[3], n[3] = {0, 0, 0};
    int nearest = 0;
    bool inside = true;
    for (int i = 0; i < 3; i++) {
        out[i] = fabsf(q[i]) - half[i];
        if (out[i] > 0) inside = false;
        if (out[i] > out[nearest]) nearest = i;
    }
    if (inside) {
        n[nearest] = q[nearest] < 0 ? -1 : 1;
        *normal = vec_load(n);
        return out[nearest];
    }
    for (int i = 0; i < 3; i++) n[i] = out[i] > 0 ? copysignf(out[i], q[i]) : 0;
    return collider_round(vec_load(n), 0, normal);
}

float collider_distance(const SingeColliderDef *def, Vec p, Vec *normal) {
    switch (def->kind) {
    case SINGE_COLLIDER_PLANE: *normal = vec(0, 0, 1); return p.z;
    case SINGE_COLLIDER_SPHERE: return collider_round(p, def->radius, normal);
    case SINGE_COLLIDER_BOX: return collider_box(def->half_size, p, normal);
    case SINGE_COLLIDER_CAPSULE: {
        float half = def->height / 2, along = fminf(fmaxf(p.z, -half), half);
        return collider_round(vec(p.x, p.y, p.z - along), def->radius, normal);
    }
    }
    *normal = vec(0, 0, 1);
    return INFINITY;
}
