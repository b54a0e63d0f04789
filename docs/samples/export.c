// Meshes for other programs: the drawn surface as an OBJ, with colours of the vertices, which Blender and MeshLab read.
//
// Prints:
//   export.obj: as many faces as triangles are drawn
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.1f, 16, 0);
    sample_pin(sim, sheet, -0.05f, 0.05f, 0, 0.01f);
    sample_pin(sim, sheet, 0.05f, 0.05f, 0, 0.01f);
    sample_match(sim, 0, -0.05f, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.7, 0, NULL));

    SingeSurface surface = {0}; // it grows as needed, and serves for all frames
    TRY(sim, singe_sim_surface(sim, &surface));
    FILE *file = fopen("export.obj", "w+");
    if (!file) return 1;
    for (uint32_t i = 0; i < surface.vertex_count; i++) {
        const float *p = surface.position[i], fresh = 1 - surface.burn[i];
        fprintf(file, "v %g %g %g %g %g %g\n", (double)p[0], (double)p[1], (double)p[2], (double)fresh,
                (double)(fresh * 0.9f), (double)(fresh * 0.8f));
    }
    for (uint32_t i = 0; i < surface.triangle_count; i++)
        fprintf(file, "f %u %u %u\n", surface.triangles[i][0] + 1, surface.triangles[i][1] + 1,
                surface.triangles[i][2] + 1);
    uint32_t faces = 0;
    rewind(file);
    for (char line[200]; fgets(line, sizeof line, file);) faces += line[0] == 'f';
    fclose(file), remove("export.obj");
    printf("export.obj: %s faces as triangles are drawn\n",
           faces == surface.triangle_count ? "as many" : "not as many");
    singe_surface_free(&surface), singe_sim_destroy(sim);
}
