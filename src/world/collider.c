// Signed distances in the colliders' own frames: of the primitives here, of the others from their solids.
#include "world/collider.h"

#include "common/def_table.h"
#include "common/real.h"

static float collider_round(Float3 offset, float radius, Float3 *normal) {
    float length = float3_length(offset);
    *normal = length > 0 ? float3_scale(offset, 1 / length) : float3(0, 0, 1);
    return length - radius;
}

static float collider_box(const float half[3], Float3 p, Float3 *normal) {
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
        *normal = float3_load(n);
        return out[nearest];
    }

    for (int i = 0; i < 3; i++) n[i] = out[i] > 0 ? copysignf(out[i], q[i]) : 0;
    return collider_round(float3_load(n), 0, normal);
}

SingeResult collider_create(Memory *memory, const SingeColliderDef *def, Collider *collider, SingeError *error) {
    TRY(def_check(&collider_table, def, error));
    SingePoseKey still = {0};
    memcpy(still.position, def->position, sizeof still.position);
    memcpy(still.rotation, def->rotation, sizeof still.rotation);
    const bool stands = def->path_count == 0;

    // the Def without its arrays
    collider->def = *def;
    collider->def.path_count = stands ? 1 : def->path_count;
    collider->def.path = NULL;
    collider->def.vertices = NULL;
    collider->def.triangles = NULL;
    collider->def.heights = NULL;

    // its path and its solid
    SingeResult result =
        path_set(&collider->path, memory, collider->def.path_count, stands ? &still : def->path, "collider", error);
    if (!result && def->kind == SINGE_COLLIDER_MESH)
        result = mesh_solid_create(memory, def->vertex_count, def->vertices, def->triangle_count, def->triangles,
                                   &collider->mesh, error);
    if (!result && def->kind == SINGE_COLLIDER_DEFORMING)
        result = deform_create(memory, def->vertex_count, def->vertices, def->triangle_count, def->triangles,
                               &collider->deform, error);
    if (!result && def->kind == SINGE_COLLIDER_HEIGHTFIELD)
        result =
            height_solid_create(memory, def->columns, def->rows, def->heights, def->size, &collider->heights, error);
    if (result) collider_free(memory, collider);

    return result;
}

void collider_free(Memory *memory, Collider *collider) {
    path_free(&collider->path, memory);
    mesh_solid_free(memory, &collider->mesh);
    height_solid_free(memory, &collider->heights);
    deform_free(memory, &collider->deform);
    *collider = (Collider){0};
}

void collider_at(const Collider *collider, double time) {
    if (collider->def.kind == SINGE_COLLIDER_DEFORMING) deform_at(&collider->deform, time);
}

float collider_distance(const Collider *collider, Float3 p, float limit, Float3 *normal) {
    const SingeColliderDef *def = &collider->def;
    switch (def->kind) {
    case SINGE_COLLIDER_PLANE: *normal = float3(0, 0, 1); return p.z;
    case SINGE_COLLIDER_SPHERE: return collider_round(p, def->radius, normal);
    case SINGE_COLLIDER_BOX: return collider_box(def->half_size, p, normal);
    case SINGE_COLLIDER_CAPSULE: {
        float half = def->height / 2, along = float_min(float_max(p.z, -half), half);
        return collider_round(float3(p.x, p.y, p.z - along), def->radius, normal);
    }
    case SINGE_COLLIDER_HEIGHTFIELD: return height_solid_distance(&collider->heights, p, limit, normal);
    case SINGE_COLLIDER_MESH: return mesh_solid_distance(&collider->mesh, p, limit, normal);
    case SINGE_COLLIDER_DEFORMING: return mesh_solid_distance(deform_solid(&collider->deform), p, limit, normal);
    }

    *normal = float3(0, 0, 1);
    return INFINITY;
}

void collider_bounds(const Collider *collider, Float3 *low, Float3 *high) {
    const SingeColliderDef *def = &collider->def;
    Float3 half = float3(INFINITY, INFINITY, INFINITY);
    switch (def->kind) {
    case SINGE_COLLIDER_PLANE:
        *low = float3_scale(half, -1);
        *high = float3(INFINITY, INFINITY, 0);
        return;
    case SINGE_COLLIDER_SPHERE: half = float3(def->radius, def->radius, def->radius); break;
    case SINGE_COLLIDER_BOX: half = float3_load(def->half_size); break;
    case SINGE_COLLIDER_CAPSULE: half = float3(def->radius, def->radius, def->radius + def->height / 2); break;
    case SINGE_COLLIDER_HEIGHTFIELD: {
        const HeightSolid *heights = &collider->heights;
        *low = float3(-heights->half[0], -heights->half[1], -INFINITY);
        *high = float3(heights->half[0], heights->half[1], heights->high);
        return;
    }
    case SINGE_COLLIDER_MESH:
        *low = collider->mesh.low;
        *high = collider->mesh.high;
        return;
    case SINGE_COLLIDER_DEFORMING: deform_bounds(&collider->deform, low, high); return;
    }

    *low = float3_scale(half, -1);
    *high = half;
}
