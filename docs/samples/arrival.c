// Fire on cue: a picture says when the front is where. Here it comes in rings, from the middle outwards, in two seconds.
//
// Prints:
//   95 of 100 particles within 0.01 s, 0 missed
#include "sample.h"

int main(void) {
    enum { SIZE = 64 };
    static float rings[SIZE * SIZE]; // 0: at arrival_from, 1: never, in between in proportion
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float x = ((float)(i % SIZE) + 0.5f) / SIZE - 0.5f, y = ((float)(i / SIZE) + 0.5f) / SIZE - 0.5f;
        rings[i] = fminf(2 * sqrtf(x * x + y * y), 1);
    }
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.15f, 30, 0.001f);
    sample_table(sim);
    SingeSourceDef map = singe_default_source();
    map.kind = SINGE_SOURCE_ARRIVAL, map.texture = (SingeTexture){SIZE, SIZE, rings};
    map.arrival_from = 0.2f, map.arrival_to = 2; // s
    TRY(sim, singe_sim_add_source(sim, &map, NULL));
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 1.4, 0, NULL));
    const SingeStats stats = singe_sim_stats(sim);
    printf("95 of 100 particles within %.2f s, %u missed\n", ceil(100 * stats.arrival_error) / 100,
           stats.arrival_missed);
    singe_sim_destroy(sim);
}
