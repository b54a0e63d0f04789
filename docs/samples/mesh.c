// A mesh of one's own: a cone of triangles becomes a sheet of quads, and burns from its tip.
//
// Prints:
//   608 triangles became 304 cells
//   the tip is vertex 0, at 100 mm
//   after 2 s 7 of 10 burnt
#include "sample.h"

enum { AROUND = 32, RINGS = 10, VERTICES = 1 + AROUND * RINGS, TRIANGLES = AROUND * (2 * RINGS - 1) };

int main(void) {
    float positions[VERTICES][3] = {{0, 0, 0.1f}}; // m
    uint32_t triangles[TRIANGLES][3], count = 0;
    for (uint32_t i = 0; i < AROUND * RINGS; i++) {
        const float radius = 0.006f * (float)(i / AROUND + 1), angle = 6.2831853f * (float)(i % AROUND) / AROUND;
        positions[1 + i][0] = radius * cosf(angle), positions[1 + i][1] = radius * sinf(angle);
        positions[1 + i][2] = 0.1f - radius;
    }
    for (uint32_t i = 0; i < AROUND * RINGS; i++) { // counter-clockwise seen from outside
        const uint32_t here = 1 + i, next = 1 + i / AROUND * AROUND + (i + 1) % AROUND;
        const uint32_t above = i < AROUND ? 0 : here - AROUND, beside = i < AROUND ? 0 : next - AROUND;
        memcpy(triangles[count++], (uint32_t[]){above, here, next}, sizeof *triangles);
        if (beside) memcpy(triangles[count++], (uint32_t[]){above, next, beside}, sizeof *triangles);
    }

    SingeMeshDef def = singe_default_mesh();
    def.vertex_count = VERTICES, def.positions = &positions[0][0];
    def.face_count = count, def.corners = &triangles[0][0];
    SingeMesh *mesh;
    SingeError error;
    must(singe_mesh_create(&def, &mesh, &error), &error);
    SingeSheetDef sheet = singe_default_sheet();
    singe_mesh_fill_sheet(mesh, &sheet);
    printf("%u triangles became %u cells\n", count, sheet.cell_count);
    const uint32_t tip = singe_mesh_vertex(mesh, 0); // vertices may have new numbers
    printf("the tip is vertex %u, at %.0f mm\n", tip, 1e3 * (double)sheet.positions[3 * tip + 2]);

    SingeSim *sim = sample_sim(singe_default_sim());
    TRY(sim, singe_sim_add_sheet(sim, &sheet, NULL));
    singe_mesh_destroy(mesh); // the simulation has copied it
    SingeColliderDef ground = singe_default_collider();
    ground.position[2] = 0.04f;
    TRY(sim, singe_sim_add_collider(sim, &ground, NULL));
    sample_match(sim, 0, 0, 0.1f);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 2, 0, NULL));
    printf("after 2 s %.0f of 10 burnt\n", 10 * singe_sim_stats(sim).burnt_fraction);
    singe_sim_destroy(sim);
}
