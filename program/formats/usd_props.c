// The props of a USD root: the ground, and colliders and hot balls with their motion. A deforming collider has its
// vertices for each frame.
#include "formats/usd_text.h"

#include <math.h>

static void put_points(Root *r, const float *vertices, uint32_t count) {
    put(r, "[");
    for (uint32_t i = 0; i < count; i++) {
        put(r, i ? ", " : "");
        put_numbers(r, vertices + 3 * (size_t)i, 3);
    }
    put(r, "]");
}

static void put_box(Root *r, const float *vertices, uint32_t count) {
    float box[2][3] = {{0}};
    for (uint32_t i = 0; i < count; i++) {
        const float *p = vertices + 3 * (size_t)i;
        for (int c = 0; c < 3; c++) {
            box[0][c] = i && box[0][c] < p[c] ? box[0][c] : p[c];
            box[1][c] = i && box[1][c] > p[c] ? box[1][c] : p[c];
        }
    }
    put(r, "[");
    put_numbers(r, box[0], 3), put(r, ", "), put_numbers(r, box[1], 3);
    put(r, "]");
}

/// The number of samples of moving vertices: up to the last frame that differs from the one before it. 1 for a rigid
/// shape.
static int moving_frames(const Root *r, const OutputShape *shape) {
    int last = 0;
    for (int i = 1; shape && i < r->scene->frames; i++)
        if (shape->poses[i].vertices != shape->poses[i - 1].vertices) last = i;
    return last + 1;
}

/// An array derived from the vertices, with a sample per frame if they move.
static void put_samples(Root *r, const char *attribute, const float *vertices, uint32_t count, const OutputShape *shape,
                        void (*array)(Root *, const float *, uint32_t)) {
    const int frames = moving_frames(r, shape);
    put(r, attribute);
    if (frames == 1) {
        put(r, " = ");
        array(r, vertices, count);
        put(r, "\n");
        return;
    }
    put(r, ".timeSamples = {\n");
    for (int i = 0; i < frames; i++) {
        const float *now = shape->poses[i].vertices;
        sink_text(&r->sink, "                %d: ", i + 1);
        array(r, now ? now : vertices, count);
        put(r, ",\n");
    }
    put(r, "            }\n");
}

/// `shape`: its poses may have vertices of their own; NULL: it does not move.
static void put_mesh_arrays(Root *r, const float *vertices, uint32_t vertex_count, const uint32_t *corners,
                            uint32_t face_count, int sides, const OutputShape *shape) {
    put(r, "            uniform token subdivisionScheme = \"none\"\n");
    put_samples(r, "            point3f[] points", vertices, vertex_count, shape, put_points);
    put_samples(r, "            float3[] extent", vertices, vertex_count, shape, put_box);
    put(r, "            int[] faceVertexCounts = [");
    for (uint32_t i = 0; i < face_count; i++) sink_text(&r->sink, "%s%d", i ? ", " : "", sides);
    put(r, "]\n            int[] faceVertexIndices = [");
    for (size_t i = 0; i < (size_t)sides * face_count; i++) sink_text(&r->sink, "%s%u", i ? ", " : "", corners[i]);
    put(r, "]\n");
}

static bool same_pose(const OutputPose *a, const OutputPose *b) {
    bool same = a->visible == b->visible;
    for (int i = 0; i < 3; i++) same = same && a->position[i] == b->position[i];
    for (int i = 0; i < 4; i++) same = same && a->rotation[i] == b->rotation[i];
    return same;
}

static void put_position(Root *r, const OutputPose *pose) { put_numbers(r, pose->position, 3); }

static void put_rotation(Root *r, const OutputPose *pose) {
    const float q[4] = {pose->rotation[3], pose->rotation[0], pose->rotation[1], pose->rotation[2]};
    put_numbers(r, q, 4);
}

static void put_visible(Root *r, const OutputPose *pose) { put(r, pose->visible ? "\"inherited\"" : "\"invisible\""); }

/// Its trajectory: one value if it does not move.
static void put_poses(Root *r, const char *attribute, const OutputShape *shape,
                      void (*value)(Root *, const OutputPose *)) {
    bool still = true;
    for (int i = 1; i < r->scene->frames; i++) still = still && same_pose(&shape->poses[0], &shape->poses[i]);
    put(r, attribute);
    put(r, still ? " = " : ".timeSamples = {");
    for (int i = 0; i < (still ? 1 : r->scene->frames); i++) {
        if (!still) sink_text(&r->sink, "%s%d: ", i ? ", " : "", i + 1);
        value(r, &shape->poses[i]);
    }
    put(r, still ? "\n" : "}\n");
}

static void put_shape(Root *r, uint32_t index) {
    const OutputShape *s = &r->scene->shapes[index];
    static const char *const kinds[] = {[SINGE_COLLIDER_SPHERE] = "Sphere",
                                        [SINGE_COLLIDER_BOX] = "Cube",
                                        [SINGE_COLLIDER_CAPSULE] = "Capsule",
                                        [SINGE_COLLIDER_HEIGHTFIELD] = "Mesh",
                                        [SINGE_COLLIDER_MESH] = "Mesh"};
    sink_text(&r->sink,
              "\n        def %s \"shape%u\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
              "        {\n            rel material:binding = </%s/materials/shape%u>\n",
              kinds[s->kind], index, r->name, index);
    float half[3] = {s->radius, s->radius, s->radius};
    if (s->kind == SINGE_COLLIDER_CAPSULE) {
        put(r, "            uniform token axis = \"Z\"\n");
        put_float(r, "            double height = ", s->height);
        half[2] += 0.5f * s->height;
    }
    if (s->kind == SINGE_COLLIDER_BOX) {
        put(r, "            double size = 2\n");
        for (int c = 0; c < 3; c++) half[c] = 1;
    } else if (s->kind == SINGE_COLLIDER_SPHERE || s->kind == SINGE_COLLIDER_CAPSULE) {
        put_float(r, "            double radius = ", s->radius);
    } else {
        put_mesh_arrays(r, s->vertices, s->vertex_count, s->triangles, s->triangle_count, 3, s);
    }
    if (!s->vertex_count) {
        const float low[3] = {-half[0], -half[1], -half[2]};
        put(r, "            float3[] extent = [");
        put_numbers(r, low, 3), put(r, ", "), put_numbers(r, half, 3);
        put(r, "]\n");
    }
    put_poses(r, "            token visibility", s, put_visible);
    put_poses(r, "            double3 xformOp:translate", s, put_position);
    put_poses(r, "            quatf xformOp:orient", s, put_rotation);
    const bool scaled = s->kind == SINGE_COLLIDER_BOX;
    if (scaled) {
        put(r, "            float3 xformOp:scale = ");
        put_numbers(r, s->half_size, 3);
        put(r, "\n");
    }
    sink_text(&r->sink,
              "            uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"%s]\n        }\n",
              scaled ? ", \"xformOp:scale\"" : "");
}

static void put_ground(Root *r) {
    const OutputScene *s = r->scene;
    if (!isfinite(s->ground_height)) return;
    float far_off[3];
    for (int i = 0; i < 3; i++) far_off[i] = s->eye[i] - s->target[i];
    const float half = 20 * sqrtf(usd_dot(far_off, far_off)), x = s->target[0], y = s->target[1], z = s->ground_height;
    const float corners[12] = {x - half, y - half, z, x + half, y - half, z,
                               x + half, y + half, z, x - half, y + half, z};
    static const uint32_t indices[4] = {0, 1, 2, 3};
    sink_text(&r->sink,
              "\n        def Mesh \"ground\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
              "        {\n            rel material:binding = </%s/materials/ground>\n",
              r->name);
    put_mesh_arrays(r, corners, 4, indices, 1, 4, NULL);
    put(r, "        }\n");
}

void usd_put_props(Root *r) {
    put(r, "\n    def Xform \"props\"\n    {");
    put_ground(r);
    for (uint32_t i = 0; i < r->scene->shape_count; i++) put_shape(r, i);
    put(r, "    }\n");
}
