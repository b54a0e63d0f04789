// A host's own memory: every byte comes from its allocator, steps take none, and running out is an error that it survives.
//
// Prints:
//   30 steps: 0 allocations
//   under a limit: sheet: out of memory for a shell of 400 cells
//   left at the end: 0 bytes
#include "sample.h"

typedef struct Heap {
    size_t bytes, limit, calls;
} Heap;

static void *resize(void *context, void *block, size_t old_size, size_t new_size) {
    Heap *heap = context;
    if (new_size > old_size && heap->bytes + new_size - old_size > heap->limit) return NULL;
    if (new_size) heap->calls++;
    heap->bytes = heap->bytes + new_size - old_size;
    if (new_size) return realloc(block, new_size);
    free(block);
    return NULL;
}

int main(void) {
    Heap heap = {.limit = 1 << 30};
    SingeSimDef def = singe_default_sim();
    def.allocator = (SingeAllocator){resize, &heap};
    SingeSim *sim = sample_sim(def);
    sample_sheet(sim, singe_default_sheet(), 0.12f, 20, 0.001f);
    sample_table(sim);
    sample_match(sim, 0, 0, 0);
    TRY(sim, singe_sim_commit(sim));
    const size_t before = heap.calls;
    for (int i = 0; i < 30; i++) TRY(sim, singe_sim_step(sim));
    printf("30 steps: %zu allocations\n", heap.calls - before);
    singe_sim_destroy(sim);

    sim = sample_sim(def);
    sample_sheet(sim, singe_default_sheet(), 0.12f, 20, 0.001f);
    heap.limit = heap.bytes + 100000;
    if (singe_sim_commit(sim))
        printf("under a limit: %s: %s\n", singe_sim_error(sim)->stage, singe_sim_error(sim)->message);
    singe_sim_destroy(sim);
    printf("left at the end: %zu bytes\n", heap.bytes);
}
