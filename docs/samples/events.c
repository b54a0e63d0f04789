// What happens, as it happens: ignitions, holes and pieces, for sounds and sparks; and a probe at one point.
//
// Prints:
//   0.01 s: first ignition
//   0.87 s: first hole
//   the probe was hottest with 1100 K at 0.5 s
#include "sample.h"

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.12f, 18, 0);
    for (int i = 0; i < 4; i++) sample_pin(sim, sheet, i & 1 ? 0.06f : -0.06f, i & 2 ? 0.06f : -0.06f, 0, 0.01f);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    const SingeView view = singe_sim_view(sim); // its arrays stay where they are
    uint32_t probe = 0;                         // the vertex nearest to (20, 0) mm
    for (uint32_t i = 0; i < view.vertex_count; i++)
        if (hypotf(view.rest_position[i][0] - 0.02f, view.rest_position[i][1]) <
            hypotf(view.rest_position[probe][0] - 0.02f, view.rest_position[probe][1]))
            probe = i;

    bool seen[3] = {0};
    float hottest = 0;
    double when = 0;
    for (int frame = 1; frame <= 30; frame++) {
        TRY(sim, singe_sim_advance(sim, 1.0 / 24, 0, NULL));
        size_t count;
        const SingeEvent *events = singe_sim_events(sim, &count); // of all steps of the frame
        for (size_t i = 0; i < count; i++) {
            if (seen[events[i].kind] || events[i].kind == SINGE_EVENT_PIECE_FREED) continue;
            seen[events[i].kind] = true;
            printf("%.2f s: first %s\n", events[i].time, events[i].kind == SINGE_EVENT_IGNITED ? "ignition" : "hole");
        }
        if (view.temperature[probe] > hottest) hottest = view.temperature[probe], when = frame / 24.0;
    }
    printf("the probe was hottest with %.0f K at %.1f s\n", 100 * round((double)hottest / 100), when);
    singe_sim_destroy(sim);
}
