// Balls, boxes, capsules and solids: rays against them, and their appearance.
//
// Sphere: |o + t d - c|^2 = r^2. Capsule: the segment's cylinder, then its two end spheres. Box: slabs in the
// box's frame (Kay & Kajiya 1986).

#include "preview/internal.h"

static float sphere(Float3 offset, Float3 direction, float radius, float near, float far) {
    float b = float3_dot(offset, direction);
    Float3 foot = float3_mad(offset, direction, -b); // the discriminant without cancellation (Haines et al. 2019)
    float discriminant = radius * radius - float3_dot(foot, foot);
    if (discriminant < 0) return -1;
    float root = sqrtf(discriminant), t = -b - root;
    if (t <= near) t = -b + root;
    return t > near && t < far ? t : -1;
}

static float box(const PreviewShape *shape, Float3 o, Float3 d, float near, float far, Float3 *normal) {
    const float origin[3] = {o.x, o.y, o.z}, direction[3] = {d.x, d.y, d.z};
    float enter = -INFINITY, leave = INFINITY;
    int enter_axis = 0, leave_axis = 0;

    for (int axis = 0; axis < 3; axis++) {
        float h = shape->half_size[axis];
        if (fabsf(direction[axis]) < 1e-12f) {
            if (fabsf(origin[axis]) > h) return -1;
            continue;
        }

        float s = direction[axis] > 0 ? h : -h;
        float t0 = (-s - origin[axis]) / direction[axis], t1 = (s - origin[axis]) / direction[axis];
        if (t0 > enter) {
            enter = t0;
            enter_axis = axis;
        }

        if (t1 < leave) {
            leave = t1;
            leave_axis = axis;
        }
    }

    if (enter > leave) return -1;
    bool outside = enter > near;
    float t = outside ? enter : leave;
    int axis = outside ? enter_axis : leave_axis;
    if (!(t > near && t < far)) return -1;

    float n[3] = {0, 0, 0};
    n[axis] = (direction[axis] > 0) == outside ? -1.0f : 1.0f;
    *normal = float3_load(n);
    return t;
}

static float capsule(const PreviewShape *shape, Float3 o, Float3 d, float near, float far, Float3 *normal) {
    float half = 0.5f * shape->height, r = shape->radius, best = -1;
    float a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - r * r;
    if (a > 1e-12f && b * b - a * c >= 0) {
        float root = sqrtf(b * b - a * c);
        for (int side = -1; side <= 1 && best < 0; side += 2) {
            float t = (-b + (float)side * root) / a, z = o.z + t * d.z;
            if (t > near && t < far && fabsf(z) <= half) {
                best = t;
                *normal = float3_scale(float3(o.x + t * d.x, o.y + t * d.y, 0), 1 / r);
            }
        }
    }

    for (int side = -1; side <= 1; side += 2) {
        Float3 centre = float3(0, 0, (float)side * half), offset = float3_sub(o, centre);
        float t = sphere(offset, d, r, near, best > 0 ? best : far);
        if (t > 0) {
            best = t;
            *normal = float3_scale(float3_mad(offset, d, t), 1 / r);
        }
    }

    return best;
}

Float3 shape_centre(const PreviewShape *shape) {
    Float3 position = float3_load(shape->position);
    return shape->facets ? float3_add(position, quat_rotate(shape->rotation, shape->facets->centre)) : position;
}

float shape_extent(const PreviewShape *shape, float shutter) {
    float travel = shutter > 0 ? 0.5f * shutter * float3_length(float3_load(shape->velocity)) : 0;
    if (shape->facets) return travel + shape->facets->extent;
    if (shape->kind == SINGE_COLLIDER_BOX) return travel + float3_length(float3_load(shape->half_size));
    return travel + shape->radius + (shape->kind == SINGE_COLLIDER_CAPSULE ? 0.5f * shape->height : 0);
}

float shape_intersect(const PreviewShape *shape, float moment, Float3 origin, Float3 direction, float near, float far,
                      Float3 *normal) {
    Float3 offset = float3_mad(float3_sub(origin, float3_load(shape->position)), float3_load(shape->velocity), -moment);
    if (shape->kind == SINGE_COLLIDER_SPHERE) {
        float t = sphere(offset, direction, shape->radius, near, far);
        if (t > 0) *normal = float3_scale(float3_mad(offset, direction, t), 1 / shape->radius);
        return t;
    }

    // outside the sphere around it, and away from it or past it
    if (!shape->facets) {
        float r = shape_extent(shape, 0), b = float3_dot(offset, direction), c = float3_dot(offset, offset) - r * r;
        if (c > 0 && (b > 0 || b * b < c)) return -1;
    }

    Float3 o = quat_unrotate(shape->rotation, offset), d = quat_unrotate(shape->rotation, direction), n = {0, 0, 1};
    float t = -1;
    if (shape->kind == SINGE_COLLIDER_BOX) t = box(shape, o, d, near, far, &n);
    if (shape->kind == SINGE_COLLIDER_CAPSULE) t = capsule(shape, o, d, near, far, &n);
    if (shape->facets) t = facets_intersect(shape->facets, o, d, near, far, &n);
    if (t > 0) *normal = quat_rotate(shape->rotation, n);

    return t;
}

// ---- appearance

// Balls, boxes, capsules and solids: matt when cold; hot, they glow like metal with patches of darker scale. Air that
// rises along them cools them most below, and a limb shows only the scale's peaks, which are cooler. A glow is wide, so
// a film that is set for what it lights would show it as a white disc: it is drawn as bright as lets its colours differ.

#define SHAPE_GAIN 0.122f
#define SHAPE_MIDDLE 170.0f ///< K, by which the middle is drawn hotter: the film shows what is bright paler
#define SHAPE_LIMB 190.0f   ///< K, by which the limb is cooler than the middle
#define SHAPE_BELOW 45.0f   ///< K, by which what faces down is cooler than the middle

void shape_shade(const Preview *preview, const PreviewShape *shape, float moment, Point *point) {
    point->albedo = float3_load(shape->colour);
    point->gloss = 0.12f;
    point->shininess = 40;
    point->mirror = 0.5f;
    if (!(shape->temperature > BLACKBODY_MIN)) return;

    float size = shape->kind == SINGE_COLLIDER_BOX ? shape->half_size[0] : shape->radius;
    if (shape->facets) size = 0.5f * shape->facets->extent;
    Float3 centre = float3_mad(float3_load(shape->position), float3_load(shape->velocity), moment);
    Float3 local = quat_unrotate(shape->rotation, float3_sub(point->position, centre));
    Float3 p = float3_scale(local, 3.5f / maxf(size, 1e-6f));
    float scale =
        0.6f * noise3(p, 41) + 0.3f * noise3(float3_scale(p, 2.7f), 42) + 0.2f * noise3(float3_scale(p, 7.1f), 43);
    const float facing = clampf(float3_dot(point->normal, point->view), 0, 1), aside = 1 - facing;
    const float temperature = shape->temperature * (1 + 0.025f * scale) - SHAPE_LIMB * aside * sqrtf(aside) +
                              SHAPE_BELOW * minf(point->normal.z, 0.5f) + SHAPE_MIDDLE * facing * facing;
    const float limb = 0.25f + 0.75f * facing;
    Float3 glow = blackbody_glow(preview->blackbody, temperature);
    point->glow = float3_scale(glow, SHAPE_GAIN * limb * (1 + 0.3f * scale));
    point->albedo = float3_scale(point->albedo, 0.45f);
    point->mirror = 0.15f;
}
