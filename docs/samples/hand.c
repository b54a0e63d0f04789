// A hand takes hold: the host says every frame where a pin's particles are, as a player's controller does.
//
// Prints:
//   the corner follows the hand within 0.1 mm
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.12f, 20, 0.001f);
    sample_table(sim);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.1, 0, NULL));
    const SingePinId hand = sample_pin(sim, sheet, 0.06f, 0.06f, 0, 0.012f); // now, in the middle of things
    uint32_t count;
    const uint32_t *held = singe_sim_pin_particles(sim, hand, &count);
    const SingeView view = singe_sim_view(sim);
    float(*place)[3] = malloc(count * sizeof *place);
    if (!place) return 1;
    for (uint32_t i = 0; i < count; i++) memcpy(place[i], view.position[held[i]], sizeof *place);
    for (int frame = 1; frame <= 24; frame++) {
        for (uint32_t i = 0; i < count; i++) // up, and back over the sheet
            place[i][0] -= 0.04f / 24, place[i][1] -= 0.04f / 24, place[i][2] += 0.06f * cosf(0.1f * (float)frame) / 24;
        TRY(sim, singe_sim_set_pin_positions(sim, hand, &place[0][0], view.time + 1.0 / 24));
        TRY(sim, singe_sim_advance(sim, 1.0 / 24, 0, NULL));
    }
    float off = 0;
    for (uint32_t i = 0; i < count; i++) off = fmaxf(off, fabsf(view.position[held[i]][2] - place[i][2]));
    printf("the corner follows the hand %s 0.1 mm\n", off < 1e-4f ? "within" : "by more than");
    free(place);
    singe_sim_destroy(sim);
}
