// A body that moves: a mesh whose vertices the host sets every frame, as those of a character. It carries a sheet.
//
// Prints:
//   the sheet was lifted with the body, by 60 mm
#include "sample.h"

enum { AROUND = 16, RINGS = 8, VERTICES = AROUND * RINGS + 2, TRIANGLES = 2 * AROUND * RINGS };

/// A ball that grows: the vertices of a frame.
static void pose(float vertices[VERTICES][3], float radius) {
    for (int i = 0; i < VERTICES; i++) {
        const float down = i == 0              ? 0
                           : i == VERTICES - 1 ? 3.1415927f
                                               : 3.1415927f * (float)((i - 1) / AROUND + 1) / (RINGS + 1);
        const float angle = 6.2831853f * (float)((i + AROUND - 1) % AROUND) / AROUND;
        vertices[i][0] = radius * sinf(down) * cosf(angle), vertices[i][1] = radius * sinf(down) * sinf(angle);
        vertices[i][2] = radius * (1 + cosf(down)); // it stands on z = 0
    }
}

int main(void) {
    float vertices[VERTICES][3];
    uint32_t triangles[TRIANGLES][3], count = 0;
    for (uint32_t r = 0; r <= RINGS; r++)
        for (uint32_t k = 0; k < AROUND; k++) {
            const uint32_t a = r ? 1 + (r - 1) * AROUND + k : 0, b = r ? 1 + (r - 1) * AROUND + (k + 1) % AROUND : 0;
            const uint32_t c = r < RINGS ? 1 + r * AROUND + k : VERTICES - 1;
            const uint32_t d = r < RINGS ? 1 + r * AROUND + (k + 1) % AROUND : VERTICES - 1;
            if (c != d) memcpy(triangles[count++], (uint32_t[]){a, c, d}, sizeof *triangles);
            if (a != b) memcpy(triangles[count++], (uint32_t[]){a, d, b}, sizeof *triangles);
        }
    pose(vertices, 0.02f);
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.1f, 14, 0.0415f);
    SingeColliderDef body = singe_default_collider();
    body.kind = SINGE_COLLIDER_DEFORMING, body.vertex_count = VERTICES, body.vertices = &vertices[0][0];
    body.triangle_count = count, body.triangles = &triangles[0][0];
    SingeColliderId id;
    TRY(sim, singe_sim_add_collider(sim, &body, &id));
    TRY(sim, singe_sim_commit(sim));
    for (int frame = 1; frame <= 12; frame++) {
        pose(vertices, 0.02f + 0.03f * (float)frame / 12);
        TRY(sim, singe_sim_set_collider_vertices(sim, id, &vertices[0][0], frame / 24.0)); // where it is then
        TRY(sim, singe_sim_advance(sim, 1.0 / 24, 0, NULL));
    }
    const float top = singe_sim_view(sim).position[7 * 15 + 7][2]; // of the middle vertex
    printf("the sheet was lifted with the body, by %.0f mm\n", 10 * round((double)(top - 0.0415f) * 100));
    singe_sim_destroy(sim);
}
