// Balls, boxes, capsules and solids: rays against them.
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
                      Facing *facing) {
    Float3 offset = float3_mad(float3_sub(origin, float3_load(shape->position)), float3_load(shape->velocity), -moment);
    if (shape->kind == SINGE_COLLIDER_SPHERE) {
        float t = sphere(offset, direction, shape->radius, near, far);
        if (t > 0) facing->normal = float3_scale(float3_mad(offset, direction, t), 1 / shape->radius);
        facing->bent = 1 / shape->radius;
        return t;
    }

    // outside the sphere around it, and away from it, past it or not as far
    if (!shape->facets) {
        float r = shape_extent(shape, 0), b = float3_dot(offset, direction), c = float3_dot(offset, offset) - r * r;
        if (c > 0 && (b > 0 || b * b < c || -b - r > far)) return -1;
    }

    Float3 o = quat_unrotate(shape->rotation, offset), d = quat_unrotate(shape->rotation, direction), n = {0, 0, 1};
    float t = -1;
    facing->bent = shape->kind == SINGE_COLLIDER_CAPSULE ? 1 / shape->radius : 0;
    if (shape->kind == SINGE_COLLIDER_BOX) t = box(shape, o, d, near, far, &n);
    if (shape->kind == SINGE_COLLIDER_CAPSULE) t = capsule(shape, o, d, near, far, &n);
    if (shape->facets) t = facets_intersect(shape->facets, o, d, near, far, facing);
    if (shape->facets) n = facing->normal;
    if (t > 0) facing->normal = quat_rotate(shape->rotation, n);

    return t;
}

bool shape_near(const PreviewShape *shape, Float3 o, Float3 d, float far, float near) {
    if (!shape->facets) return true;
    const Float3 from = quat_unrotate(shape->rotation, float3_sub(o, float3_load(shape->position)));
    return bounds_near(shape->facets->bounds, from, quat_unrotate(shape->rotation, d), far,
                       near - shape->facets->extent);
}
