// Two sheets in contact: one falls onto the other, and the fire of the lower one lights it.
//
// Prints:
//   0.4 s: the upper sheet is above the lower one
//   1.2 s: both burn
#include "sample.h"

int main(void) {
    SingeSimDef def = singe_default_sim();
    def.contact.enabled = true; // without it sheets pass through each other
    SingeSim *sim = sample_sim(def);
    const SingeSheetId lower = sample_sheet(sim, singe_default_sheet(), 0.12f, 16, 0.001f);
    const SingeSheetId upper = sample_sheet(sim, singe_default_sheet(), 0.10f, 16, 0.01f);
    sample_table(sim);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.4, 0, NULL));

    const SingeView view = singe_sim_view(sim);
    const SingeSheetRange below = singe_sim_sheet_range(sim, lower), above = singe_sim_sheet_range(sim, upper);
    double height[2] = {0};
    for (uint32_t i = 0; i < below.vertex_count; i++) height[0] += (double)view.position[below.vertex_first + i][2];
    for (uint32_t i = 0; i < above.vertex_count; i++) height[1] += (double)view.position[above.vertex_first + i][2];
    const bool on_top = height[1] / above.vertex_count > height[0] / below.vertex_count;
    printf("0.4 s: the upper sheet is %s the lower one\n", on_top ? "above" : "below");

    SingeSourceDef match = singe_default_source(); // under the lower sheet's corner
    match.position[0] = match.position[1] = 0.05f, match.temperature = 1123;
    TRY(sim, singe_sim_add_source(sim, &match, NULL));
    TRY(sim, singe_sim_advance(sim, 0.8, 0, NULL));
    int ignited[2] = {0};
    for (uint32_t i = 0; i < below.vertex_count; i++) ignited[0] += view.time_ignited[below.vertex_first + i] >= 0;
    for (uint32_t i = 0; i < above.vertex_count; i++) ignited[1] += view.time_ignited[above.vertex_first + i] >= 0;
    printf("1.2 s: %s burn\n", ignited[0] && ignited[1] ? "both" : "not both");
    singe_sim_destroy(sim);
}
