// The default camera: the sheets fill the picture.
#include "scene/scene.h"

#include <math.h>

/// Max distance of a camera from the origin, m.
static const double farthest = 1e4;

typedef struct Box {
    double low[3], high[3];
} Box;

static bool sheets_box(const SceneAssets *assets, Box *box) {
    *box = (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t s = 0; s < assets->sheet_count; s++)
        for (size_t v = 0; v < 3 * (size_t)assets->meshes[s].vertex_count; v++) {
            double x = (double)assets->meshes[s].positions[v];
            box->low[v % 3] = fmin(box->low[v % 3], x);
            box->high[v % 3] = fmax(box->high[v % 3], x);
        }
    double size = 0;
    for (int i = 0; i < 3; i++) size += box->high[i] - box->low[i];
    return isfinite(size) && size > 0;
}

static double dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross3(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static void unit3(double v[3]) {
    double length = sqrt(dot3(v, v));
    for (int i = 0; i < 3; i++) v[i] /= length;
}

/// Unit vectors from the box to the camera, and to the right and up in the picture. Flat sheets are seen from above,
/// upright ones from the front (-y), a little from the side.
static void camera_look(const Box *box, const float up[3], double back[3], double right[3], double top[3]) {
    double vertical[3] = {(double)up[0], (double)up[1], (double)up[2]}, front[3] = {0, -1, 0}, height = 0, max = 0;
    unit3(vertical);
    if (fabs(vertical[1]) > 0.9) {
        front[1] = 0;
        front[2] = 1;
    }
    for (int i = 0; i < 3; i++) {
        height += fabs(vertical[i]) * (box->high[i] - box->low[i]);
        max = fmax(max, box->high[i] - box->low[i]);
    }
    double lift = 0.15 + 0.85 * (1 - fmin(height / max, 1));
    cross3(vertical, front, right); // to the right in the picture, seen from the front
    unit3(right);
    cross3(right, vertical, front);
    for (int i = 0; i < 3; i++) back[i] = front[i] + 0.25 * right[i] + lift * vertical[i];
    unit3(back);
    cross3(vertical, back, right);
    unit3(right);
    cross3(back, right, top);
}

void scene_frame(Scene *scene, const SceneAssets *assets) {
    PreviewCamera *camera = &scene->preview.camera;
    Box box;
    if (scene->preview.camera_given || !sheets_box(assets, &box)) return;
    double back[3], right[3], top[3], distance = 0;
    camera_look(&box, camera->up, back, right, top);
    double half = tan(0.5 * (double)camera->fov), aspect = (double)scene->preview.size[0] / scene->preview.size[1];
    for (int corner = 0; corner < 8; corner++) {
        double d[3]; // from the centre to the corner
        for (int i = 0; i < 3; i++) d[i] = 0.5 * (box.high[i] - box.low[i]) * (corner >> i & 1 ? 1 : -1);
        double across = fmax(fabs(dot3(d, right)) / aspect, fabs(dot3(d, top)));
        distance = fmax(distance, dot3(d, back) + 1.15 * across / half); // a margin of 15 %
    }
    double target[3], eye[3];
    for (int i = 0; i < 3; i++) {
        target[i] = 0.5 * (box.low[i] + box.high[i]);
        eye[i] = target[i] + distance * back[i];
        if (fabs(eye[i]) > farthest) return;
    }
    for (int i = 0; i < 3; i++) {
        camera->target[i] = (float)target[i];
        camera->eye[i] = (float)eye[i];
    }
}
