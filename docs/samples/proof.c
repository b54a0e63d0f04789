// A material changes while it burns: one half is made fireproof, and the fire stops there.
//
// Prints:
//   the dry half burns on, the proofed half went out
#include "sample.h"

int main(void) {
    enum { SIDE = 25, COUNT = SIDE * SIDE };
    static float share[COUNT]; // of each vertex: 0 as it was, 1 the new material
    for (int i = 0; i < COUNT; i++) share[i] = i % SIDE >= SIDE / 2;
    SingeSheetDef dry = singe_default_sheet();
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, dry, 0.15f, SIDE - 1, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    SingeMaterialDef proofed = dry.material;
    proofed.ignition_temperature = singe_param(5000), proofed.char_rate = singe_param(0); // nothing lights it
    TRY(sim, singe_sim_set_material(sim, sheet, &proofed, share));
    TRY(sim, singe_sim_advance(sim, 0.7, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    int burning[2] = {0};
    for (uint32_t i = 0; i < view.particle_count; i++)
        burning[view.rest_position[i][0] > 0.004f] += view.burn_rate[i] > 0.01f;
    printf("the dry half %s, the proofed half %s\n", burning[0] > 10 ? "burns on" : "went out",
           burning[1] > 0 ? "burns on" : "went out");
    singe_sim_destroy(sim);
}
