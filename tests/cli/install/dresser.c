// A cape of triangles, of cotton, from what is installed alone.
#include <singe/singe.h>
#include <stdio.h>

int main(void) {
    const float positions[] = {0, 0, 0, 0.1f, 0, 0, 0.1f, 0.1f, 0, 0, 0.1f, 0, 0.2f, 0, 0, 0.2f, 0.1f, 0};
    const uint32_t corners[] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2}, collar[] = {3};
    SingeMeshDef def = singe_default_mesh();
    SingeMesh *mesh;
    SingeError error;

    def.vertex_count = 6, def.positions = positions, def.face_count = 4, def.corners = corners;
    if (singe_mesh_create(&def, &mesh, &error)) return puts(error.message), 1;

    SingeSheetDef sheet = singe_default_sheet();
    singe_mesh_fill_sheet(mesh, &sheet);
    if (singe_material_preset("cotton", &sheet.material, &error)) return puts(error.message), 1;

    SingeSimDef sim_def = singe_default_sim();
    SingePinDef pin = singe_default_pin();
    SingePinId held;
    SingeSim *sim;
    const uint32_t vertex = singe_mesh_vertex(mesh, collar[0]);
    pin.vertex_count = 1, pin.vertices = &vertex;

    if (singe_sim_create(&sim_def, &sim, &error)) return 1;
    if (singe_sim_add_sheet(sim, &sheet, &pin.sheet) || singe_sim_add_pin(sim, &pin, &held) || singe_sim_commit(sim) ||
        singe_sim_step(sim))
        return puts(singe_sim_error(sim)->message), 1;

    printf("%.1f g\n", 1e3 * singe_sim_stats(sim).mass);
    singe_sim_destroy(sim);
    singe_mesh_destroy(mesh);
    return 0;
}
