#include "world/deform.h"

#include "common/real.h"
#include "world/triangle.h"

static SingeResult deform_no_memory(SingeError *error) {
    return error_set(error, SINGE_ERROR_MEMORY, "collider", -1, "out of memory for the mesh");
}

SingeResult deform_create(Memory *memory, uint32_t vertex_count, const float *vertices, uint32_t triangle_count,
                          const uint32_t *triangles, Deform *deform, SingeError *error) {
    *deform = (Deform){0};
    if (!NEW(memory, deform->pose, 1)) return deform_no_memory(error);

    MeshSolid *first = &deform->pose->solid[0], *second = &deform->pose->solid[1];
    SingeResult result =
        mesh_solid_create_moving(memory, vertex_count, vertices, triangle_count, triangles, first, error);
    if (!result) {
        // the second solid has its own vertices and boxes, and shares the rest
        *second = *first;
        second->vertices = NULL;
        second->leaves = NULL;
        second->nodes = NULL;
        if (!motion_create(memory, vertex_count, vertices, &deform->motion) ||
            !NEW(memory, deform->rest, vertex_count) || !NEW(memory, second->vertices, second->vertex_count) ||
            !NEW(memory, second->leaves, second->leaf_count) || !NEW(memory, second->nodes, second->node_count))
            result = deform_no_memory(error);
    }

    if (result) {
        deform->motion.count = vertex_count; // length of those of its arrays that exist
        deform_free(memory, deform);
        return result;
    }

    memcpy(second->vertices, first->vertices, first->vertex_count * sizeof *first->vertices);
    memcpy(second->leaves, first->leaves, first->leaf_count * sizeof *first->leaves);
    memcpy(second->nodes, first->nodes, first->node_count * sizeof *first->nodes);
    memcpy(deform->rest, vertices, vertex_count * sizeof *deform->rest);
    deform_forget(deform);
    return SINGE_OK;
}

void deform_free(Memory *memory, Deform *deform) {
    if (deform->pose) {
        MeshSolid *second = &deform->pose->solid[1];
        FREE(memory, deform->rest, deform->motion.count);
        FREE(memory, second->vertices, second->vertex_count);
        FREE(memory, second->leaves, second->leaf_count);
        FREE(memory, second->nodes, second->node_count);
        mesh_solid_free(memory, &deform->pose->solid[0]);
        motion_free(memory, &deform->motion);
        FREE(memory, deform->pose, 1);
    }

    *deform = (Deform){0};
}

void deform_forget(const Deform *deform) { deform->pose->time[0] = deform->pose->time[1] = (double)NAN; }

static void deform_make(const Deform *deform, int which, double time) {
    MeshSolid *solid = &deform->pose->solid[which];
    const float share = motion_share(&deform->motion, time);
    for (uint32_t v = 0; v < solid->vertex_count; v++)
        float3_store(solid->vertices[v], motion_point(&deform->motion, v, share));
    mesh_tree_refit(solid);
    deform->pose->time[which] = time;
}

void deform_at(const Deform *deform, double time) {
    DeformPose *pose = deform->pose;
    if (pose->time[pose->now] != time) deform_make(deform, pose->now, time);
}

void deform_between(const Deform *deform, double before, double after) {
    DeformPose *pose = deform->pose;
    if (pose->time[pose->now] == before) pose->now = 1 - pose->now;
    if (pose->time[1 - pose->now] != before) deform_make(deform, 1 - pose->now, before);
    deform_make(deform, pose->now, after);

    float farthest = 0;
    for (uint32_t v = 0; v < deform->motion.count; v++) {
        Float3 displacement = float3_sub(float3_load(pose->solid[pose->now].vertices[v]),
                                         float3_load(pose->solid[1 - pose->now].vertices[v]));
        farthest = float_max(farthest, float3_dot(displacement, displacement));
    }

    pose->farthest = sqrtf(farthest);
}

Float3 deform_drift(const Deform *deform, Float3 p) {
    const MeshSolid *before = &deform->pose->solid[1 - deform->pose->now], *after = deform_solid(deform);
    float square = INFINITY;
    const uint32_t t = mesh_tree_nearest(before, p, &square);

    if (t == UINT32_MAX) return float3(0, 0, 0);

    const uint32_t *corner = before->triangles[t];
    Float3 v[3], drift = {0, 0, 0};
    for (int i = 0; i < 3; i++) v[i] = float3_load(before->vertices[corner[i]]);

    const TriangleClosest foot = triangle_closest(p, v[0], v[1], v[2]);
    const float weights[3] = {(float)(1 - foot.s - foot.t), (float)foot.s, (float)foot.t};
    for (int i = 0; i < 3; i++)
        drift = float3_mad(drift, float3_sub(float3_load(after->vertices[corner[i]]), v[i]), weights[i]);

    return drift;
}

void deform_bounds(const Deform *deform, Float3 *low, Float3 *high) {
    const MeshSolid *a = &deform->pose->solid[0], *b = &deform->pose->solid[1];
    *low = float3(float_min(a->low.x, b->low.x), float_min(a->low.y, b->low.y), float_min(a->low.z, b->low.z));
    *high = float3(float_max(a->high.x, b->high.x), float_max(a->high.y, b->high.y), float_max(a->high.z, b->high.z));
}
