// The root of the USD format, as text: a stage that takes sheets from the frames by value clips and gas from the VDB
// files, and has the camera, the lights, the ground, colliders with their motion and materials. The lights have the
// preview's intensities, in units in which white paper under them is nearly white.
#include "common/float3.h"
#include "formats/burn_colour.h"
#include "formats/usd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FILM_SPEED 0.45f ///< of the preview
#define PI 3.14159265358979323846f

// ---- names

const UsdAttribute usd_attributes[USD_OWN] = {
    [USD_POINTS] = {"points", "point3f[]", false},
    [USD_VELOCITIES] = {"velocities", "vector3f[]", false},
    [USD_NORMALS] = {"normals", "normal3f[]", true},
    [USD_ST] = {"primvars:st", "texCoord2f[]", true},
    [USD_REST] = {"primvars:rest", "float3[]", true},
    [USD_COLOUR] = {"primvars:displayColor", "color3f[]", true},
    [USD_COLOUR_INDICES] = {"primvars:displayColor:indices", "int[]", false},
    [USD_EMBER] = {"primvars:ember", "color3f[]", true},
    [USD_EMBER_INDICES] = {"primvars:ember:indices", "int[]", false},
    [USD_COUNTS] = {"faceVertexCounts", "int[]", false},
    [USD_INDICES] = {"faceVertexIndices", "int[]", false},
    [USD_EXTENT] = {"extent", "float3[]", false},
};

void usd_name(const char *name, char prim[USD_NAME]) {
    size_t n = 0;
    if (*name >= '0' && *name <= '9') prim[n++] = '_';
    for (const char *c = name; *c && n < USD_NAME - 16; c++) {
        const bool good = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9');
        prim[n++] = good ? *c : '_';
    }
    if (!n) prim[n++] = '_';
    prim[n] = 0;
}

void usd_sheet_name(const OutputScene *scene, uint32_t sheet, char prim[USD_NAME]) {
    usd_name(scene->sheets[sheet].name, prim);
    const size_t length = strlen(prim);
    for (uint32_t i = 0, tries = 0; i < scene->sheet_count; i++) {
        char other[USD_NAME];
        if (i == sheet) continue;
        usd_name(scene->sheets[i].name, other);
        if (strcmp(other, prim) != 0 || (i > sheet && !tries)) continue;
        snprintf(prim + length, USD_NAME - length, "_%u", (unsigned)(sheet + 1 + 1000 * tries++));
        i = UINT32_MAX; // check all names again
    }
}

// ---- text

typedef struct Root {
    Sink sink;
    const OutputScene *scene;
    char name[USD_NAME];
} Root;

static void put(Root *r, const char *text) { sink_bytes(&r->sink, text, strlen(text)); }

static void put_numbers(Root *r, const float *values, int count) {
    put(r, "(");
    for (int i = 0; i < count; i++) {
        put(r, i ? ", " : "");
        sink_float(&r->sink, values[i]);
    }
    put(r, ")");
}

static void put_float(Root *r, const char *before, float value) {
    put(r, before);
    sink_float(&r->sink, value);
    put(r, "\n");
}

static void put_triple(Root *r, const char *before, float x, float y, float z) {
    const float values[3] = {x, y, z};
    put(r, before);
    put_numbers(r, values, 3);
    put(r, "\n");
}

// ---- names of files

static void put_file(Root *r, const char *folder, int frame, const char *ending) {
    char number[24];
    const char *mark = strchr(r->scene->name, '@') ? "@@@" : "@";
    snprintf(number, sizeof number, ".%04d", frame);
    put(r, mark), put(r, "./"), put(r, folder), put(r, "/"), put(r, r->scene->name), put(r, number), put(r, ending);
    put(r, mark);
}

// ---- sheets

static void put_subset(Root *r, const char *name, const char *material) {
    sink_text(&r->sink,
              "\n            def GeomSubset \"%s\" (\n                prepend apiSchemas = [\"MaterialBindingAPI\"]\n"
              "            )\n            {\n                uniform token elementType = \"face\"\n"
              "                uniform token familyName = \"materialBind\"\n                int[] indices\n"
              "                rel material:binding = </%s/materials/%s>\n            }\n",
              name, r->name, material);
}

static void put_sheet(Root *r, uint32_t sheet) {
    char name[USD_NAME];
    usd_sheet_name(r->scene, sheet, name);
    sink_text(&r->sink,
              "\n        def Mesh \"%s\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
              "        {\n            uniform token subdivisionScheme = \"none\"\n"
              "            uniform token orientation = \"rightHanded\"\n            uniform bool doubleSided = 1\n"
              "            rel material:binding = </%s/materials/burning>\n",
              name, r->name);

    for (int i = 0; i < USD_OWN; i++) {
        const char *about =
            usd_attributes[i].vertex ? " (\n                interpolation = \"vertex\"\n            )" : "";
        if (i == USD_VELOCITIES)
            about = " (\n                doc = \"m/s, displacement since the frame before over the time between\"\n"
                    "            )";
        sink_text(&r->sink, "            %s %s%s\n", usd_attributes[i].type, usd_attributes[i].name, about);
    }

    for (int i = 0; i < surface_field_count(r->scene->wet); i++)
        sink_text(&r->sink, "            %s primvars:%s (\n                interpolation = \"vertex\"\n            )\n",
                  surface_fields[i].integer ? "int[]" : "float[]", surface_fields[i].name);

    if (r->scene->sheets[sheet].picture) {
        char print[USD_NAME];
        snprintf(print, sizeof print, "print%u", sheet);
        put(r, "            uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"\n");
        put_subset(r, "burnt", "burning");
        put_subset(r, "fresh", print);
    }

    put(r, "        }\n");
}

// ---- gas

static void put_gas(Root *r) {
    static const char *const fields[] = {"density", "flame", "temperature", "velocity"};
    put(r, "\n    def Volume \"gas\"\n    {\n");
    for (int i = 0; i < 4; i++)
        sink_text(&r->sink, "        rel field:%s = </%s/gas/%s>\n", fields[i], r->name, fields[i]);

    for (int i = 0; i < 4; i++) {
        sink_text(&r->sink, "\n        def OpenVDBAsset \"%s\"\n        {\n            token fieldName = \"%s\"\n",
                  fields[i], fields[i]);
        if (i == 3) put(r, "            token vectorDataRoleHint = \"Vector\"\n");
        put(r, "            asset filePath.timeSamples = {\n");
        for (int frame = 1; frame <= r->scene->frames; frame++) {
            sink_text(&r->sink, "                %d: ", frame);
            put_file(r, r->scene->gas_detail ? "gas_detail" : "gas", frame, ".vdb");
            put(r, ",\n");
        }

        put(r, "            }\n        }\n");
    }

    put(r, "    }\n");
}

// ---- camera and lights

/// A transform at `position` with z axis `back` and an x axis that is level with respect to `up`.
static void put_frame(Root *r, Float3 back, const float up[3], const float position[3]) {
    const Float3 z = float3_length(back) > 0 ? float3_unit(back) : float3(0, 0, 1);
    Float3 x = float3_cross(float3_load(up), z);
    if (float3_dot(x, x) < 1e-12f) x = float3_cross(float3(1, 0, 0), z);
    x = float3_unit(x);

    float rows[4][4] = {{0}};
    float3_store(rows[0], x);
    float3_store(rows[1], float3_cross(z, x));
    float3_store(rows[2], z);
    float3_store(rows[3], float3_load(position));
    rows[3][3] = 1;
    put(r, "        matrix4d xformOp:transform = (");
    for (int i = 0; i < 4; i++) {
        put(r, i ? ", " : " ");
        put_numbers(r, rows[i], 4);
    }
    put(r, " )\n        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n");
}

// ---- props

static void put_points(Root *r, const float *vertices, uint32_t count) {
    put(r, "[");
    for (uint32_t i = 0; i < count; i++) {
        put(r, i ? ", " : "");
        put_numbers(r, vertices + 3 * (size_t)i, 3);
    }
    put(r, "]");
}

static void put_box(Root *r, const float *vertices, uint32_t count) {
    float box[6] = {0};
    for (uint32_t i = 0; i < count; i++) box_grow(box, vertices + 3 * (size_t)i, i == 0);
    put_points(r, box, 2);
}

/// An array derived from the vertices, with a sample per frame if they move.
static void put_samples(Root *r, const char *attribute, const float *vertices, uint32_t count, const OutputShape *shape,
                        void (*array)(Root *, const float *, uint32_t)) {
    // the number of samples of moving vertices: up to the last frame that differs from the one before it. 1 for a rigid shape.
    int last = 0;
    for (int i = 1; shape && i < r->scene->frames; i++)
        if (shape->poses[i].vertices != shape->poses[i - 1].vertices) last = i;

    const int frames = last + 1;

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
    for (int i = 1; i < r->scene->frames; i++) {
        const OutputPose *a = &shape->poses[0], *b = &shape->poses[i];
        still = still && a->visible == b->visible;
        for (int c = 0; c < 3; c++) still = still && a->position[c] == b->position[c];
        for (int c = 0; c < 4; c++) still = still && a->rotation[c] == b->rotation[c];
    }

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
        put(r, "            float3[] extent = ");
        put_points(r, (const float[]){low[0], low[1], low[2], half[0], half[1], half[2]}, 2);
        put(r, "\n");
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

static void put_props(Root *r) {
    put(r, "\n    def Xform \"props\"\n    {");
    if (isfinite(r->scene->ground_height)) {
        const OutputScene *s = r->scene;
        const Float3 away = float3_sub(float3_load(s->eye), float3_load(s->target));
        const float half = 20 * float3_length(away), x = s->target[0], y = s->target[1], z = s->ground_height;
        const float corners[12] = {x - half, y - half, z, x + half, y - half, z,
                                   x + half, y + half, z, x - half, y + half, z};
        static const uint32_t indices[4] = {0, 1, 2, 3};
        sink_text(
            &r->sink,
            "\n        def Mesh \"ground\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
            "        {\n            rel material:binding = </%s/materials/ground>\n",
            r->name);
        put_mesh_arrays(r, corners, 4, indices, 1, 4, NULL);
        put(r, "        }\n");
    }

    for (uint32_t i = 0; i < r->scene->shape_count; i++) put_shape(r, i);
    put(r, "    }\n");
}

// ---- materials

static void put_surface(Root *r, const char *material) {
    sink_text(&r->sink,
              "\n        def Material \"%s\"\n        {\n"
              "            token outputs:surface.connect = </%s/materials/%s/surface.outputs:surface>\n\n"
              "            def Shader \"surface\"\n            {\n"
              "                uniform token info:id = \"UsdPreviewSurface\"\n"
              "                float inputs:roughness = 0.9\n                token outputs:surface\n",
              material, r->name, material);
}

static void put_reader(Root *r, const char *shader, const char *primvar, const char *type, int width) {
    sink_text(&r->sink,
              "\n            def Shader \"%s\"\n            {\n"
              "                uniform token info:id = \"UsdPrimvarReader_float%d\"\n"
              "                string inputs:varname = \"%s\"\n                %s outputs:result\n            }\n",
              shader, width, primvar, type);
}

/// A plain colour and, for hot shapes, their glow.
static void put_plain(Root *r, const char *material, const float colour[3], float temperature) {
    float glow[3];
    ember_colour(EMBER_ALL + ember_step(temperature), glow);
    put_surface(r, material);
    put_triple(r, "                color3f inputs:diffuseColor = ", colour[0], colour[1], colour[2]);
    put_triple(r, "                color3f inputs:emissiveColor = ", glow[0], glow[1], glow[2]);
    put(r, "            }\n        }\n");
}

static void put_materials(Root *r) {
    put(r, "\n    def Scope \"materials\"\n    {");
    put_surface(r, "burning");
    sink_text(&r->sink,
              "                color3f inputs:diffuseColor.connect = </%s/materials/burning/colour.outputs:result>\n"
              "                color3f inputs:emissiveColor.connect = </%s/materials/burning/ember.outputs:result>\n"
              "            }\n",
              r->name, r->name);
    put_reader(r, "colour", "displayColor", "float3", 3);
    put_reader(r, "ember", "ember", "float3", 3);
    put(r, "        }\n");

    for (uint32_t i = 0; i < r->scene->sheet_count; i++)
        if (r->scene->sheets[i].picture) {
            const OutputSheet *s = &r->scene->sheets[i];
            char print[USD_NAME];
            snprintf(print, sizeof print, "print%u", i);
            put_surface(r, print);
            sink_text(&r->sink,
                      "                color3f inputs:diffuseColor.connect = </%s/materials/%s/picture.outputs:rgb>\n"
                      "            }\n\n            def Shader \"picture\"\n            {\n"
                      "                uniform token info:id = \"UsdUVTexture\"\n                asset inputs:file = ",
                      r->name, print);

            // a path in asset delimiters that its characters allow
            const char *mark = strchr(s->picture, '@') ? "@@@" : "@";
            put(r, mark);
            put(r, s->picture);
            put(r, mark);

            const float scale[4] = {0.86f * s->colour[0], 0.852f * s->colour[1], 0.832f * s->colour[2], 1};
            put(r, "\n                float4 inputs:scale = ");
            put_numbers(r, scale, 4);
            sink_text(&r->sink,
                      "\n                float2 inputs:st.connect = </%s/materials/%s/st.outputs:result>\n"
                      "                token inputs:sourceColorSpace = \"sRGB\"\n"
                      "                token inputs:wrapS = \"clamp\"\n                token inputs:wrapT = \"clamp\"\n"
                      "                float3 outputs:rgb\n            }\n",
                      r->name, print);
            put_reader(r, "st", "st", "float2", 2);
            put(r, "        }\n");
        }

    for (uint32_t i = 0; i < r->scene->shape_count; i++) {
        char material[USD_NAME];
        snprintf(material, sizeof material, "shape%u", i);
        put_plain(r, material, r->scene->shapes[i].colour, r->scene->shapes[i].temperature);
    }

    if (isfinite(r->scene->ground_height)) put_plain(r, "ground", r->scene->ground_colour, 0);
    put(r, "    }\n");
}

void usd_put_root(Sink *sink, const OutputScene *scene) {
    Root root = {.sink = *sink, .scene = scene};
    Root *r = &root;
    usd_name(scene->name, r->name);
    sink_text(&r->sink, "#usda 1.0\n(\n    defaultPrim = \"%s\"\n    doc = \"Singe %s\"\n", r->name, SINGE_VERSION);
    sink_text(&r->sink, "    endTimeCode = %d\n", scene->frames);
    put_float(r, "    framesPerSecond = ", scene->fps);
    put(r, "    metersPerUnit = 1\n    startTimeCode = 1\n");
    put_float(r, "    timeCodesPerSecond = ", scene->fps);
    sink_text(&r->sink, "    upAxis = \"Z\"\n)\n\ndef Xform \"%s\" (\n    kind = \"component\"\n)\n{", r->name);

    put(r, "\n    def Xform \"sheets\" (\n");

    const int frames = r->scene->frames;
    put(r, "        clips = {\n            dictionary default = {\n                asset[] assetPaths = [");

    for (int i = 1; i <= frames; i++) {
        put(r, i > 1 ? ", " : "");
        put_file(r, "usd", i, ".usdc");
    }

    put(r, "]\n                double2[] active = [");
    for (int i = 1; i <= frames; i++) sink_text(&r->sink, "%s(%d, %d)", i > 1 ? ", " : "", i, i - 1);
    put(r, "]\n                double2[] times = [");
    for (int i = 1; i <= frames; i++) sink_text(&r->sink, "%s(%d, %d)", i > 1 ? ", " : "", i, i);
    sink_text(&r->sink, "]\n                string primPath = \"/%s/sheets\"\n", r->name);
    put(r, "                asset manifestAssetPath = ");
    put_file(r, "usd", 1, ".usdc");
    put(r, "\n            }\n        }\n");

    put(r, "    )\n    {\n");
    for (uint32_t i = 0; i < r->scene->sheet_count; i++) put_sheet(r, i);
    put(r, "    }\n");

    if (scene->gas) put_gas(r);

    // lens lengths are in millimetres for a film 36 mm wide, as programs expect
    const OutputScene *s = r->scene;
    const float height = 36 / s->aspect, focal = 0.5f * height / tanf(0.5f * s->fov);
    const Float3 back = float3_sub(float3_load(s->eye), float3_load(s->target));
    put(r, "\n    def Camera \"camera\"\n    {\n        float2 clippingRange = (0.01, 1000)\n");
    put_float(r, "        float focalLength = ", focal);
    put(r, "        float horizontalAperture = 36\n");
    put_float(r, "        float verticalAperture = ", height);
    put_float(r, "        float focusDistance = ", s->focus > 0 ? s->focus : float3_length(back));
    put_float(r, "        float fStop = ", s->aperture > 0 ? 1e-3f * focal / s->aperture : 0);
    put_frame(r, back, s->up, s->eye);
    put(r, "    }\n");

    static const float nowhere[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    put(r, "\n    def DistantLight \"sun\"\n    {\n        bool inputs:normalize = 1\n");
    put_float(r, "        float inputs:angle = ", 2 * s->light_angle * 180 / PI);
    put_triple(r, "        color3f inputs:color = ", s->light_colour[0], s->light_colour[1], s->light_colour[2]);
    put_float(r, "        float inputs:intensity = ", PI * FILM_SPEED);
    put_frame(r, float3_load(s->light_direction), up, nowhere);
    put(r, "    }\n\n    def DomeLight \"sky\"\n    {\n");
    put_triple(r, "        color3f inputs:color = ", s->sky[0], s->sky[1], s->sky[2]);
    put_float(r, "        float inputs:intensity = ", FILM_SPEED);
    put(r, "    }\n");

    put_props(r);
    put_materials(r);
    put(r, "}\n");
    *sink = r->sink;
}

SingeResult usd_write_root(const char *path, const OutputScene *scene, SingeError *error) {
    Sink sink = {0};
    usd_put_root(&sink, scene);
    return sink_write(&sink, path, error);
}
