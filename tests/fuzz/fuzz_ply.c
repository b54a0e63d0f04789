#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Polygons mesh;
    SingeError error;
    if (ply_read("fuzz.ply", data, size, (SingeAllocator){0}, &mesh, &error) == SINGE_OK)
        demand_mesh(&mesh), demand_quads(&mesh);
    else demand(error.code && error.message[0] && !mesh.positions);
    polygons_free(&mesh);

    SingeSurface surface;
    double time;
    if (ply_read_surface("fuzz.ply", data, size, (SingeAllocator){0}, &surface, &time, &error) == SINGE_OK) {
        demand(isfinite(time));
        for (size_t i = 0; i < surface.triangle_count; i++)
            for (int k = 0; k < 3; k++) demand(surface.triangles[i][k] < surface.vertex_count);
    } else demand(error.code && error.message[0] && !surface.position);

    singe_surface_free(&surface);
    return 0;
}
