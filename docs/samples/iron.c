// A brand: heat drawn as a picture, here a ring, and turned up and down over time.
//
// Prints:
//   peak 1300 K in the ring, 300 K in its middle
#include "sample.h"

int main(void) {
    enum { SIZE = 64 };
    static float ring[SIZE * SIZE]; // 1: the full flux
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float x = (float)(i % SIZE) / SIZE - 0.5f, y = (float)(i / SIZE) / SIZE - 0.5f;
        ring[i] = fabsf(sqrtf(x * x + y * y) - 0.3f) < 0.06f;
    }
    SingeSheetDef cloth = singe_default_sheet();
    SingeError error;
    must(singe_material_preset("cotton", &cloth.material, &error), &error);
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, cloth, 0.12f, 32, 0.001f);
    sample_table(sim);
    SingeSourceDef brand = singe_default_source();
    brand.kind = SINGE_SOURCE_TEXTURE, brand.texture = (SingeTexture){SIZE, SIZE, ring};
    brand.flux = 20e3f; // W/m2 into each side
    const SingeValueKey strength[] = {{0, 0}, {0.1f, 1}, {0.3f, 1}, {0.4f, 0}};
    brand.strength_count = 4, brand.strength = strength;
    TRY(sim, singe_sim_add_source(sim, &brand, NULL));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    double sum[2] = {0}, count[2] = {0};
    for (uint32_t i = 0; i < view.vertex_count; i++) {
        const float r = hypotf(view.rest_position[i][0], view.rest_position[i][1]) / 0.12f;
        const int in = fabsf(r - 0.3f) < 0.04f;
        if (in || r < 0.15f) sum[in] += (double)view.temperature_peak[i], count[in]++;
    }
    printf("peak %.0f K in the ring, %.0f K in its middle\n", 100 * round(sum[1] / count[1] / 100),
           100 * round(sum[0] / count[0] / 100));
    singe_sim_destroy(sim);
}
