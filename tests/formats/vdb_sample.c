// Writes a gas made by formula as a VDB file, and its values as text for test_vdb_library.py to compare: size,
// origin and cell, then of each cell the fields. Usage: vdb_sample FILE.vdb NX NY NZ [half]

#include "gas_sample.h"

#include <stdio.h>

int main(int argc, char **argv) {
    GasSample sample;
    Gas gas = {0};
    SingeError error = {0};

    if (argc != 5 && argc != 6) return 2;
    uint32_t n[3];
    for (int c = 0; c < 3; c++) n[c] = (uint32_t)atoi(argv[2 + c]);
    if (!gas_sample_make(&sample, n[0], n[1], n[2])) return 1;

    SingeResult result = gas_copy(&sample.gas, (SingeAllocator){0}, &gas, &error);
    if (!result) result = (argc == 6 ? vdb_write_fine : vdb_write_gas)(argv[1], &gas, 0.125, &error);
    if (result) fprintf(stderr, "%s\n", error.message);

    const float *o = gas.view.origin;
    printf("%u %u %u %.9g %.9g %.9g %.9g\n", n[0], n[1], n[2], o[0], o[1], o[2], gas.view.cell);
    for (size_t i = 0; !result && i < (size_t)n[0] * n[1] * n[2]; i++)
        printf("%.9g %.9g %.9g %.9g %.9g %.9g\n", gas.extinction[i], gas.flame_share[i], gas.temperature[i],
               gas.velocity[i][0], gas.velocity[i][1], gas.velocity[i][2]);
    gas_free(&gas);
    gas_sample_free(&sample);
    return result != 0;
}
