// Pins hold a sheet, carry it along a path, and let go.
//
// Prints:
//   0.5 s: lowest at -140 mm
//   1.0 s: lowest at -30 mm
//   1.5 s: lowest at -720 mm
#include "sample.h"

static void print_lowest(const SingeSim *sim) {
    const SingeView view = singe_sim_view(sim);
    float lowest = INFINITY;
    for (uint32_t i = 0; i < view.particle_count; i++)
        if (view.particle_flags[i] & SINGE_ALIVE) lowest = fminf(lowest, view.position[i][2]);
    printf("%.1f s: lowest at %.0f mm\n", view.time, 10 * round(100 * (double)lowest));
}

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.15f, 20, 0);
    const SingePinId left = sample_pin(sim, sheet, -0.075f, 0.075f, 0, 0.01f);
    const SingePinId right = sample_pin(sim, sheet, 0.075f, 0.075f, 0, 0.01f);
    sample_match(sim, 0, 0.075f, -0.05f); // comes to the sheet when it hangs
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    print_lowest(sim);

    // both go up by 100 mm; a path is relative to the pose of its first key
    const SingePoseKey path[] = {{0.5f, {0, 0, 0}, {0, 0, 0, 1}}, {1, {0, 0, 0.1f}, {0, 0, 0, 1}}};
    TRY(sim, singe_sim_move_pin(sim, left, 2, path));
    TRY(sim, singe_sim_move_pin(sim, right, 2, path));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    print_lowest(sim);

    TRY(sim, singe_sim_remove_pin(sim, left));
    TRY(sim, singe_sim_remove_pin(sim, right));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    print_lowest(sim);
    singe_sim_destroy(sim);
}
