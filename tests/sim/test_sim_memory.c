// A million springs take at most 155 bytes each, by the counts and by the allocator's own count.
#include "support/support.h"

TEST(a_million_springs_take_few_bytes) {
    TestAllocator hook = {0};
    SingeSimDef def = singe_default_sim();
    def.allocator = test_allocator(&hook);

    SingeSim *sim = test_sim(&def, test_grid(317, 316, 0.001f, 0.001f), NULL);
    SingeCounts counts = singe_sim_counts(sim);
    uint64_t springs = 0;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) springs += counts.springs[colour];
    print_message("%llu springs: %.0f MB held, %.0f MB at the most\n", (unsigned long long)springs,
                  (double)counts.memory / 1e6, (double)hook.peak / 1e6);
    assert_true(springs >= 1000000);
    assert_int_equal(counts.memory, hook.bytes);
    print_message("%.1f bytes a spring\n", (double)counts.memory / (double)springs);

    // of it 1.6 the fuel and the heat that burning gives, 2.4 noises of the default material, 1.6 the limit of
    // curvature
    assert_true(counts.memory <= 155 * springs);
    assert_true(hook.peak <= 250 * springs); // while the sheet and the shell are built
    test_ok(sim, singe_sim_step(sim));
    assert_int_equal(counts.memory, hook.bytes);
    singe_sim_destroy(sim);
    assert_int_equal(hook.blocks, 0);
}
