// Frames of any length: steps have one length, what is left over waits, and a renderer draws ahead by it.
//
// Prints:
//   8 frames, 12 steps
//   drawn ahead, the motion is even to 1 %
#include "sample.h"

int main(void) {
    SingeSimDef def = singe_default_sim();
    def.time_step = 1.0f / 120, def.gravity[2] = 0;
    SingeSheetDef sheet = singe_default_sheet();
    sheet.velocity[0] = 1, sheet.material.drag = singe_param(0), sheet.material.damping = singe_param(0);
    SingeSim *sim = sample_sim(def);
    sample_sheet(sim, sheet, 0.05f, 4, 0);
    TRY(sim, singe_sim_commit(sim));
    const SingeView view = singe_sim_view(sim);
    const float begin = view.position[0][0];
    uint32_t total = 0;
    double time = 0, worst = 0;
    for (int frame = 0; frame < 8; frame++) {
        const double length = frame % 2 ? 0.009 : 0.016; // s, as long as the last frame took
        uint32_t steps;
        TRY(sim, singe_sim_advance(sim, length, 0, &steps));
        total += steps, time += length;
        const double drawn = (double)view.position[0][0] + (double)view.velocity[0][0] * singe_sim_remainder(sim);
        worst = fmax(worst, fabs((drawn - (double)begin) / time - 1));
    }
    printf("8 frames, %u steps\n", total);
    printf("drawn ahead, the motion is %s\n", worst < 0.01 ? "even to 1 %" : "uneven");
    singe_sim_destroy(sim);
}
