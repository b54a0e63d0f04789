// A closed mesh: a paper ball of triangles is a sheet without an edge, and burns from its top.
//
// Prints:
//   6 tenths have burnt
#include "sample.h"

enum { AROUND = 32, RINGS = 15, VERTICES = AROUND * RINGS + 2, TRIANGLES = 2 * AROUND * RINGS };

int main(void) {
    float vertices[VERTICES][3] = {{0, 0, 0.121f}};
    uint32_t triangles[TRIANGLES][3], count = 0;
    for (uint32_t i = 1; i < VERTICES - 1; i++) {
        const float down = 3.1415927f * (float)((i - 1) / AROUND + 1) / (RINGS + 1);
        const float angle = 6.2831853f * (float)((i - 1) % AROUND) / AROUND;
        vertices[i][0] = 0.06f * sinf(down) * cosf(angle), vertices[i][1] = 0.06f * sinf(down) * sinf(angle);
        vertices[i][2] = 0.061f + 0.06f * cosf(down);
    }
    vertices[VERTICES - 1][2] = 0.001f;
    for (uint32_t r = 0; r <= RINGS; r++)
        for (uint32_t k = 0; k < AROUND; k++) {
            const uint32_t next = (k + 1) % AROUND, a = r ? 1 + (r - 1) * AROUND + k : 0, c = 1 + r * AROUND + k;
            const uint32_t d = r < RINGS ? 1 + r * AROUND + next : VERTICES - 1;
            if (r < RINGS) memcpy(triangles[count++], (uint32_t[]){a, c, d}, sizeof *triangles);
            if (r) memcpy(triangles[count++], (uint32_t[]){a, d, 1 + (r - 1) * AROUND + next}, sizeof *triangles);
        }
    SingeMeshDef def = singe_default_mesh();
    def.vertex_count = VERTICES, def.positions = &vertices[0][0];
    def.face_count = count, def.corners = &triangles[0][0];
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create(&def, &mesh, &error), &error);
    SingeSheetDef sheet = singe_default_sheet();
    must(singe_material_preset("newsprint", &sheet.material, &error), &error);
    singe_mesh_fill_sheet(mesh, &sheet);
    SingeSim *sim = sample_sim(singe_default_sim());
    TRY(sim, singe_sim_add_sheet(sim, &sheet, NULL));
    singe_mesh_destroy(mesh);
    sample_table(sim);
    sample_match(sim, 0, 0, 0.121f);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1.6, 0, NULL));
    printf("%.0f tenths have burnt\n", 10 * singe_sim_stats(sim).burnt_fraction);
    singe_sim_destroy(sim);
}
