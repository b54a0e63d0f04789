// Fibres: burning paper shrinks more across them than along them.
//
// Prints:
//   fibres along x: narrower in y; along y: narrower in x
#include "sample.h"

/// How much wider than long the sheet is at the end, m.
static float widening(float angle) {
    SingeSheetDef sheet = singe_default_sheet();
    sheet.material.ablate = false, sheet.material.fibre_shrink = singe_param(4);
    sheet.material.fibre_angle = singe_param(angle), sheet.material.shrink_front = sheet.material.shrink_back;
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, sheet, 0.08f, 16, 0.001f);
    sample_table(sim);
    for (int i = 0; i < 4; i++) sample_match(sim, i & 1 ? 0.04f : -0.04f, i & 2 ? 0.04f : -0.04f, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    float width[2] = {0};
    for (uint32_t i = 0; i < view.vertex_count; i++)
        for (int c = 0; c < 2; c++) width[c] = fmaxf(width[c], view.position[i][c]);
    singe_sim_destroy(sim);
    return width[0] - width[1];
}

int main(void) {
    printf("fibres along x: %s in y; along y: %s in x\n", widening(0) > 0 ? "narrower" : "wider",
           widening(1.5707963f) < 0 ? "narrower" : "wider");
}
