// A fold that stays: with creases, paper that was bent sharply does not open again; without, it springs back.
//
// Prints:
//   elastic: flat again
//   creased: still folded
#include "sample.h"

static double folded(bool creases) {
    SingeSimDef def = singe_default_sim();
    def.solver.creases = creases, def.solver.substeps = 0, def.gravity[2] = 0;
    SingeSheetDef sheet = singe_default_sheet();
    sheet.material.bending = singe_param(1e-3f), sheet.material.thickness = singe_param(3e-3f);
    sheet.material.damping = singe_param(5), sheet.material.crease_radius = singe_param(0.05f);
    SingeSim *sim = sample_sim(def);
    const SingeSheetId strip = sample_sheet(sim, sheet, 0.08f, 16, 0);
    sample_pin(sim, strip, -0.08f, 0, 0, 0.06f); // the left half is held
    SingePinDef hand = singe_default_pin();      // the right edge is folded over it, and let go
    hand.sheet = strip, hand.radius = 0.045f, hand.point_count = 1, hand.points = (const float[]){0.06f, 0, 0};
    SingePoseKey path[9];
    for (int i = 0; i < 9; i++) {
        const float a = 2.4f * (float)i / 8; // about the y axis, through the middle
        path[i] = (SingePoseKey){0.05f * (float)i, {0, 0, 0}, {0, -sinf(a / 2), 0, cosf(a / 2)}};
    }
    hand.path_count = 9, hand.path = path;
    SingePinId id;
    TRY(sim, singe_sim_add_pin(sim, &hand, &id));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    TRY(sim, singe_sim_remove_pin(sim, id));
    TRY(sim, singe_sim_advance(sim, 1, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    const float *edge = view.position[16], *middle = view.position[11]; // along the first row
    const double angle = atan2((double)(edge[2] - middle[2]), -(double)(edge[0] - middle[0])) * 57.2958;
    singe_sim_destroy(sim);
    return fabs(angle);
}

int main(void) {
    for (int creases = 0; creases < 2; creases++)
        printf("%s: %s\n", creases ? "creased" : "elastic", folded(creases) > 140 ? "flat again" : "still folded");
}
