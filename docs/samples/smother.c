// A lid puts a fire out: what burns beneath a collider that smothers gets no air.
//
// Prints:
//   under the lid 0 particles burn, elsewhere many do
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.15f, 24, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    SingeColliderDef lid = singe_default_collider();
    lid.kind = SINGE_COLLIDER_BOX, lid.smothers = true, lid.contact_distance = 0.004f, lid.conductance = 400;
    lid.half_size[0] = 0.05f, lid.half_size[1] = 0.1f, lid.half_size[2] = 0.01f;
    // from above, down onto the right half, in a tenth of a second
    const SingePoseKey path[] = {{0.6f, {0.05f, 0, 0.1f}, {0, 0, 0, 1}}, {0.7f, {0.05f, 0, 0.012f}, {0, 0, 0, 1}}};
    lid.path_count = 2, lid.path = path;
    TRY(sim, singe_sim_add_collider(sim, &lid, NULL));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1.2, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    int burning[2] = {0};
    for (uint32_t i = 0; i < view.particle_count; i++)
        burning[view.rest_position[i][0] > 0.005f] += view.burn_rate[i] > 0.01f;
    printf("under the lid %d particles burn, elsewhere %s\n", burning[1], burning[0] > 20 ? "many do" : "few do");
    singe_sim_destroy(sim);
}
