// Threads change nothing: the same burn on one thread and on three has the same bytes.
//
// Prints:
//   1 and 3 threads: the same bytes
#include "sample.h"

/// The snapshot of a burn; to be freed by free().
static uint8_t *burn(int threads, size_t *size) {
    SingeSimDef def = singe_default_sim();
    def.thread_count = threads;
    SingeSim *sim = sample_sim(def);
    sample_sheet(sim, singe_default_sheet(), 0.15f, 30, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    uint8_t *bytes;
    TRY(sim, singe_sim_save(sim, &bytes, size));
    uint8_t *copy = malloc(*size);
    if (!copy) exit(1);
    memcpy(copy, bytes, *size);
    singe_sim_free_bytes(sim, bytes, *size);
    singe_sim_destroy(sim);
    return copy;
}

int main(void) {
    size_t sizes[2];
    uint8_t *one = burn(1, &sizes[0]), *three = burn(3, &sizes[1]);
    const bool same = sizes[0] == sizes[1] && memcmp(one, three, sizes[0]) == 0;
    printf("1 and 3 threads: %s\n", same ? "the same bytes" : "other bytes");
    free(one), free(three);
}
