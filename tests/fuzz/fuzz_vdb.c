#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Gas gas;
    double time;
    SingeError error;

    if (vdb_read_gas("fuzz.vdb", data, size, (SingeAllocator){0}, &gas, &time, &error) == SINGE_OK) {
        const uint32_t *n = gas.view.size;
        demand(isfinite(time) && gas.view.cell > 0 && n[0] && n[1] && n[2]);
        size_t count = (size_t)n[0] * n[1] * n[2];
        demand(count <= GAS_CELL_LIMIT);
        for (size_t i = 0; i < count; i += count / 4096 + 1)
            demand(isfinite(gas.temperature[i]) && isfinite(gas.smoke[i]) && isfinite(gas.velocity[i][2]));
    } else demand(error.code && error.message[0] && !gas.smoke);

    gas_free(&gas);
    return 0;
}
