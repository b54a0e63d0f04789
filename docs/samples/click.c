// A click lights it: the ray of a mouse meets the sheet, and a match burns where it does.
//
// Prints:
//   the ray meets the sheet 300 mm away
//   there it burns
#include "sample.h"

/// Where a ray meets a triangle, in units of its direction; -1: it does not.
static float meet(const float *o, const float *d, const float *a, const float *b, const float *c) {
    float e[3], f[3], s[3];
    for (int i = 0; i < 3; i++) e[i] = b[i] - a[i], f[i] = c[i] - a[i], s[i] = o[i] - a[i];
    const float p[3] = {d[1] * f[2] - d[2] * f[1], d[2] * f[0] - d[0] * f[2], d[0] * f[1] - d[1] * f[0]};
    const float q[3] = {s[1] * e[2] - s[2] * e[1], s[2] * e[0] - s[0] * e[2], s[0] * e[1] - s[1] * e[0]};
    const float det = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
    const float u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det,
                v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
    return u >= 0 && v >= 0 && u + v <= 1 ? (f[0] * q[0] + f[1] * q[1] + f[2] * q[2]) / det : -1;
}

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.15f, 20, 0.001f);
    sample_table(sim);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.1, 0, NULL));
    const float eye[3] = {0.02f, -0.18f, 0.241f}, ray[3] = {0, 0.6f, -0.8f};
    SingeSurface surface = {0};
    TRY(sim, singe_sim_surface(sim, &surface));
    float near = INFINITY;
    for (uint32_t t = 0; t < surface.triangle_count; t++) {
        const uint32_t *k = surface.triangles[t];
        const float far = meet(eye, ray, surface.position[k[0]], surface.position[k[1]], surface.position[k[2]]);
        if (far > 0) near = fminf(near, far);
    }
    printf("the ray meets the sheet %.0f mm away\n", 10 * round(100 * (double)near));
    SingeSourceDef match = singe_default_source();
    for (int i = 0; i < 3; i++) match.position[i] = eye[i] + near * ray[i];
    match.radius = match.falloff = 0.01f, match.temperature = 1123;
    match.start = (float)singe_sim_view(sim).time, match.end = match.start + 0.4f;
    TRY(sim, singe_sim_add_source(sim, &match, NULL));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    printf("there it %s\n", singe_sim_stats(sim).temperature_max > 900 ? "burns" : "does not burn");
    singe_surface_free(&surface), singe_sim_destroy(sim);
}
