// The mesh formats that have no target of their own, by the first byte: STL, glTF and GLB, and the answer of a reader in
// a child process.
#include "formats/mesh_reader.h"
#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Polygons mesh;
    SingeError error;
    SingeResult result;
    SingeAllocator libc = {0};

    if (size == 0) return 0;
    switch (data[0] % 4) {
    case 1: result = stl_read("fuzz.stl", data + 1, size - 1, libc, &mesh, &error); break;

    // in a folder that is not there, so that no files are opened
    case 2: result = gltf_read("/nowhere/fuzz.gltf", data + 1, size - 1, libc, &mesh, &error); break;
    default: result = mesh_answer_take("fuzz", data + 1, size - 1, libc, &mesh, &error); break;
    }
    if (result == SINGE_OK) demand_mesh(&mesh);
    else demand(error.code && error.message[0] && !mesh.positions);
    polygons_free(&mesh);
    return 0;
}
