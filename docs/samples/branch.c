// One burn, two ends: a snapshot is loaded twice, and one of them gets wind. Equal ends have equal bytes.
//
// Prints:
//   left alone: the same bytes
//   with wind: other bytes
#include "sample.h"

/// Loads a snapshot, goes on for half a second, and saves.
static SingeSim *go_on(const uint8_t *bytes, size_t size, float wind_y, uint8_t **end, size_t *end_size) {
    const SingeSimDef hooks = singe_default_sim(); // allocator, threads, log; all else comes from the bytes
    SingeSim *sim;
    SingeError error;
    must(singe_sim_load(&hooks, bytes, size, &sim, &error), &error);
    SingeWindDef wind = singe_default_wind();
    wind.velocity[1] = wind_y;
    if (wind_y != 0) TRY(sim, singe_sim_set_wind(sim, &wind));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    TRY(sim, singe_sim_save(sim, end, end_size));
    return sim;
}

int main(void) {
    SingeSim *sim = sample_sim(singe_default_sim());
    const SingeSheetId sheet = sample_sheet(sim, singe_default_sheet(), 0.15f, 20, 0);
    sample_pin(sim, sheet, -0.075f, 0.075f, 0, 0.01f);
    sample_pin(sim, sheet, 0.075f, 0.075f, 0, 0.01f);
    sample_match(sim, 0.075f, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    uint8_t *middle, *end, *other;
    size_t middle_size, end_size, other_size;
    TRY(sim, singe_sim_save(sim, &middle, &middle_size));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    TRY(sim, singe_sim_save(sim, &end, &end_size));

    for (int windy = 0; windy < 2; windy++) {
        SingeSim *again = go_on(middle, middle_size, windy ? 1.5f : 0, &other, &other_size);
        const bool same = other_size == end_size && memcmp(other, end, end_size) == 0;
        printf("%s: %s bytes\n", windy ? "with wind" : "left alone", same ? "the same" : "other");
        singe_sim_free_bytes(again, other, other_size);
        if (windy) singe_sim_destroy(sim), sim = again;
        else singe_sim_destroy(again);
    }
    singe_sim_free_bytes(sim, middle, middle_size);
    singe_sim_free_bytes(sim, end, end_size);
    singe_sim_destroy(sim);
}
