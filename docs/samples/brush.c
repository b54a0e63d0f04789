// Writing with fire: a hot ball on a path, as a pen. A path has times, and is straight in between.
//
// Prints:
//   scorched along the stroke, fresh beside it
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.16f, 32, 0.001f);
    sample_table(sim);
    static const float zigzag[5][2] = {{-0.06f, 0.05f}, {-0.03f, -0.05f}, {0, 0.05f}, {0.03f, -0.05f}, {0.06f, 0.05f}};
    SingePoseKey path[5];
    for (int i = 0; i < 5; i++)
        path[i] = (SingePoseKey){0.08f * (float)i, {zigzag[i][0], zigzag[i][1], 0}, {0, 0, 0, 1}};
    SingeSourceDef pen = singe_default_source();
    pen.kind = SINGE_SOURCE_BALL, pen.path_count = 5, pen.path = path;
    pen.temperature = 1300, pen.conductance = 1500, pen.radius = 0.004f, pen.falloff = 0.003f;
    pen.end = path[4].time;
    TRY(sim, singe_sim_add_source(sim, &pen, NULL));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.36, 0, NULL));
    const SingeView view = singe_sim_view(sim);
    float on = 1e4f, beside = 0; // K
    for (uint32_t i = 0; i < view.vertex_count; i++) {
        const float x = view.rest_position[i][0], y = view.rest_position[i][1];
        for (int k = 0; k < 5; k++)
            if (hypotf(x - zigzag[k][0], y - zigzag[k][1]) < 0.003f) on = fminf(on, view.temperature_peak[i]);
        if (x > 0.076f) beside = fmaxf(beside, view.temperature_peak[i]);
    }
    printf("%s along the stroke, %s beside it\n", on > 450 ? "scorched" : "fresh", beside < 350 ? "fresh" : "scorched");
    singe_sim_destroy(sim);
}
