#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Polygons mesh;
    SingeError error;
    if (obj_read("fuzz.obj", data, size, (SingeAllocator){0}, &mesh, &error) == SINGE_OK)
        demand_mesh(&mesh), demand_quads(&mesh);
    else demand(error.code && error.message[0] && !mesh.positions);
    polygons_free(&mesh);
    return 0;
}
