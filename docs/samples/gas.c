// The gas above the fire: hot air, flames and smoke on a grid, for a volume renderer.
//
// Prints:
//   1.0 s: gas of more than 700 K rises; flames, smoke
#include "sample.h"

int main(void) {
    SingeSimDef def = singe_default_sim();
    def.gas.enabled = true, def.gas.cell_size = 0.01f, def.gas.height = 0.15f; // m
    SingeSim *sim = sample_sim(def);
    sample_sheet(sim, singe_default_sheet(), 0.12f, 20, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1, 0, NULL));
    const SingeGas gas = singe_sim_gas(sim);
    const uint32_t cells = gas.size[0] * gas.size[1] * gas.size[2];
    uint32_t hottest = 0;
    bool flames = false, smoke = false;
    for (uint32_t i = 0; i < cells; i++) {
        if (gas.temperature[i] > gas.temperature[hottest]) hottest = i;
        flames |= gas.flame[i] > 0, smoke |= gas.smoke[i] > 0;
    }
    printf("1.0 s: gas of %s than 700 K %s; %s, %s\n", gas.temperature[hottest] > 700 ? "more" : "less",
           gas.velocity[hottest][2] > 0 ? "rises" : "falls", flames ? "flames" : "no flames",
           smoke ? "smoke" : "no smoke");
    singe_sim_destroy(sim);
}
