// Water: one half of the sheet is wet, and the fire stops there.
//
// Prints:
//   dry half: burnt; wet half: not
#include "sample.h"

int main(void) {
    const float halves[2] = {0, 1}; // dry at the left, wet at the right
    const SingeField wet = {.kind = SINGE_FIELD_TEXTURE, .texture = {2, 1, halves}};
    SingeSheetDef sheet = singe_default_sheet();
    sheet.material.moisture = singe_param_field(0.06f, 1.5f, &wet); // kg of water a kg of paper
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, sheet, 0.15f, 16, 0.001f);
    sample_table(sim);
    sample_match(sim, -0.06f, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 2.5, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    double mass[2] = {0}, count[2] = {0};
    for (uint32_t i = 0; i < view.particle_count; i++)
        if (fabsf(view.rest_position[i][0]) > 0.03f)
            mass[view.rest_position[i][0] > 0] += (double)view.mass[i], count[view.rest_position[i][0] > 0]++;
    printf("dry half: %s; wet half: %s\n", mass[0] < 0.6 * count[0] ? "burnt" : "not",
           mass[1] > 0.95 * count[1] ? "not" : "burnt");
    singe_sim_destroy(sim);
}
