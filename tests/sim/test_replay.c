// Recordings: what they hold, that a replay gives the same bits, and what it says where it does not.

#include "recording.h"
#include "scenes.h"

static SingeReplay replay_some(const Tape *tape, size_t size, SingeResult expected) {
    SingeSimDef hooks = singe_default_sim();
    SingeReplay replay;
    SingeError error = {0};
    uint8_t *copy = malloc(size ? size : 1); // of its very size, so that a byte too many is seen
    assert_non_null(copy);

    memcpy(copy, tape->bytes, size);
    assert_int_equal(singe_replay(&hooks, copy, size, &replay, &error), expected);
    if (expected) assert_true(error.message[0] && error.code == expected);
    free(copy);
    return replay;
}

static SingeReplay replay_all(const Tape *tape) { return replay_some(tape, tape->size, SINGE_OK); }

// ---- what is recorded

/// Ends the simulation.
static void live(const SingeSimDef *def) {
    OwnTestScene scene = scene_make(def, 10);
    scene_every_call(&scene);
}

static Tape recording(void) {
    Tape tape = {0};
    SingeSimDef def = recorded(scene_def(), &tape);
    live(&def);
    return tape;
}

TEST(a_replay_makes_every_call_and_ends_in_the_same_bits) {
    OwnTape tape = recording();
    SingeReplay replay = replay_all(&tape);
    assert_string_equal(replay.what, "");
    assert_true(replay.same && replay.complete);
    assert_string_equal(replay.version, singe_version());

    // nothing was left out
    assert_true(replay.steps > 15);
    uint64_t calls = 0;
    for (int kind = 16; kind < 256; kind++)
        for (int n = 0; tape_find(&tape, kind, n) < tape.size; n++) calls++;

    assert_int_equal(replay.calls, calls);
    for (int kind = 16; kind <= 40; kind++)
        if (tape_find(&tape, kind, 0) == tape.size) fail_msg("no recording of call %d is tried", kind);
    assert_true(tape_find(&tape, HEAT, 5) < tape.size);
}

TEST(a_recording_changes_nothing) {
    OwnTape tape = {0};
    const SingeSimDef def = scene_def(), with = recorded(def, &tape);
    OwnTestScene a = scene_make(&def, 10), b = scene_make(&with, 10);
    test_ok(a.sim, singe_sim_set_ambient_temperature(a.sim, 280));
    test_ok(b.sim, singe_sim_set_ambient_temperature(b.sim, 280)); // rebuilt, and still recorded

    const size_t before = tape.size;
    test_steps(a.sim, 5);
    test_steps(b.sim, 5);
    assert_true(tape.size > before);
    test_assert_same(a.sim, b.sim);
}

TEST(recordings_differ_only_in_the_number_of_threads) {
    OwnTape one = {0}, three = {0};
    SingeSimDef def = scene_def();
    def.thread_count = 1;
    SingeSimDef with = recorded(def, &one);
    live(&with);
    def.thread_count = 3;
    with = recorded(def, &three);
    live(&with);
    assert_int_equal(one.size, three.size);

    const size_t at = HEADER + HEAD; // first in the first record
    assert_int_equal(one.bytes[at], 1);
    assert_int_equal(three.bytes[at], 3);
    three.bytes[at] = 1;
    assert_memory_equal(one.bytes, three.bytes, one.size);
}

TEST(recordings_may_begin_with_a_snapshot) {
    TestScene scene = scene_make(NULL, 8);
    test_steps(scene.sim, 3);

    OwnTape tape = {0};
    SingeSimDef hooks = recorded(singe_default_sim(), &tape);
    SingeSim *sim = test_reload(&hooks, scene.sim);
    singe_sim_destroy(scene.sim);
    test_steps(sim, 3);
    singe_sim_destroy(sim);

    SingeReplay replay = replay_all(&tape);
    assert_true(replay.same && replay.complete);
    assert_int_equal(replay.steps, 3);
}

static bool yes_if(void *context) { return *(const bool *)context; }

TEST(what_was_given_up_is_given_up_again) {
    OwnTape tape = {0};
    bool gives_up = false;
    SingeSimDef def = recorded(scene_def(), &tape);
    def.cancel = (SingeCancel){yes_if, &gives_up};
    TestScene scene = scene_make(&def, 8);
    test_steps(scene.sim, 3);
    gives_up = true;
    test_refused(scene.sim, SINGE_ERROR_CANCELLED, singe_sim_step(scene.sim));

    uint32_t steps;
    test_refused(scene.sim, SINGE_ERROR_CANCELLED, singe_sim_advance(scene.sim, 0.1, 4, &steps));
    assert_int_equal(steps, 0);
    gives_up = false;
    test_steps(scene.sim, 3);
    singe_sim_destroy(scene.sim);

    SingeReplay replay = replay_all(&tape);
    assert_string_equal(replay.what, "");
    assert_true(replay.same && replay.complete);
    assert_int_equal(replay.steps, 6);

    // and so is the replay itself
    SingeSimDef hooks = singe_default_sim();
    SingeError error = {0};
    gives_up = true;
    hooks.cancel = (SingeCancel){yes_if, &gives_up};
    assert_int_equal(singe_replay(&hooks, tape.bytes, tape.size, &replay, &error), SINGE_ERROR_CANCELLED);
    assert_string_equal(error.stage, "replay");
}

// ---- what differs

TEST(the_first_step_that_differs_is_named) {
    OwnTape tape = recording();
    const size_t state = tape_find(&tape, STATE, 7);
    const uint64_t step = tape_number(tape.bytes + state + HEAD, 8);

    tape.bytes[state + HEAD + 8] ^= 1;
    SingeReplay replay = replay_all(&tape);
    char expected[64];
    snprintf(expected, sizeof expected, "the state after step %d", (int)step);
    assert_string_equal(replay.what, expected);
    assert_false(replay.same);
    assert_true(replay.complete);
    assert_int_equal(replay.step, step);
}

TEST(another_argument_shows_in_the_next_step) {
    OwnTape tape = recording();
    const size_t gravity = tape_find(&tape, 31, 0);
    tape.bytes[gravity + HEAD + 4 + 3] ^= 0x80; // the sign of its y
    SingeReplay replay = replay_all(&tape);
    assert_string_equal(replay.what, "the state after step 5");
    assert_int_equal(replay.step, 5);
}

TEST(another_answer_is_named) {
    OwnTape tape = recording();
    const size_t pace = tape_find(&tape, 32, 1); // the one that was refused
    const size_t answer = pace + HEAD + (size_t)tape_number(tape.bytes + pace + 1, 8);
    assert_int_equal(tape.bytes[answer], RESULT);
    tape.bytes[answer + HEAD] = 0;
    SingeReplay replay = replay_all(&tape);
    assert_string_equal(replay.what, "the answer to set_pace, after step 4");
}

// ---- other versions

/// Overwrites a number of 4 or 8 bytes.
static void put_number(uint8_t *at, uint64_t number, int size) {
    for (int i = 0; i < size; i++) at[i] = (uint8_t)(number >> 8 * i);
}

/// The wind's fields behind whether there are any and their number: each the hash of its name, its bytes, and these.
TEST(fields_that_an_older_recording_lacks_have_their_defaults) {
    OwnTape tape = recording();
    const size_t wind = tape_find(&tape, 30, 0), count = wind + HEAD + 1, first = count + 4;
    const size_t size = (size_t)tape_number(tape.bytes + wind + 1, 8), end = wind + HEAD + size;
    const size_t second = first + 8 + (size_t)tape_number(tape.bytes + first + 4, 4);
    assert_true(tape_number(tape.bytes + count, 4) > 1 && second < end);
    memmove(tape.bytes + second, tape.bytes + end, tape.size - end);
    tape.size -= end - second;
    put_number(tape.bytes + count, 1, 4);
    put_number(tape.bytes + wind + 1, size - (end - second), 8);

    SingeReplay replay = replay_all(&tape);
    assert_string_equal(replay.what, ""); // only the velocity was another
    assert_true(replay.same && replay.complete);

    // of a newer version: passed over, with what it held
    put_number(tape.bytes + first, 12345, 4);
    replay = replay_all(&tape);
    assert_string_equal(replay.what, "the state after step 5");
}

// ---- what is cut short or damaged

TEST(a_recording_cut_short_is_replayed_to_its_end) {
    OwnTape tape = recording();
    for (size_t size = HEADER; size < tape.size; size += 1 + size / 4) {
        const bool whole = size > tape_find(&tape, 1, 0) + HEAD + tape_number(tape.bytes + HEADER + 1, 8);
        SingeReplay replay = replay_some(&tape, size, whole ? SINGE_OK : SINGE_ERROR_FORMAT);
        assert_string_equal(replay.what, "");
        assert_false(replay.complete);
        assert_int_equal(replay.same, whole);
    }

    // in the middle of a step: the call without an answer is made
    const size_t step = tape_find(&tape, STEP, 3), end = step + HEAD;
    SingeReplay replay = replay_some(&tape, end, SINGE_OK);
    assert_int_equal(replay.steps, 4);
    assert_true(replay.same && !replay.complete);
}

TEST(damage_is_an_error_or_a_difference) {
    OwnTape tape = recording();
    uint32_t random = 1;
    int errors = 0, differences = 0;
    for (int i = 0; i < 24; i++) {
        // any byte, or one of a record's kind and size
        random = random * 1664525u + 1013904223u;
        size_t at = (size_t)(random >> 8) % tape.size;
        if (i % 2) at = tape_find(&tape, i % 4 == 1 ? RESULT : STEP, i / 8) + (size_t)(random >> 8) % HEAD;
        const uint8_t before = tape.bytes[at];
        tape.bytes[at] ^= (uint8_t)(1u << (random >> 5) % 8);

        SingeSimDef hooks = singe_default_sim();
        SingeReplay replay;
        SingeError error = {0};
        if (singe_replay(&hooks, tape.bytes, tape.size, &replay, &error)) errors++;
        else if (!replay.same || !replay.complete) differences++;
        tape.bytes[at] = before;
    }

    assert_true(errors > 0 && differences > 0);
}

TEST(other_bytes_are_no_recording) {
    enum { FORMAT = 2 };
    Tape tape = {.bytes = (uint8_t[64]){"SINGESIM"}, .size = 64};
    replay_some(&tape, 0, SINGE_ERROR_FORMAT);
    replay_some(&tape, 64, SINGE_ERROR_FORMAT);
    memcpy(tape.bytes, "SINGEREC", 8);

    const uint8_t others[] = {0, FORMAT - 1, FORMAT + 1, 200};
    for (size_t k = 0; k < sizeof others; k++) {
        tape.bytes[8] = others[k];
        replay_some(&tape, 64, SINGE_ERROR_VERSION);
    }

    tape.bytes[8] = FORMAT;
    replay_some(&tape, 64, SINGE_ERROR_FORMAT);
}

/// A recording may ask for any number of steps; a replay makes those that it holds, and one more.
TEST(a_small_recording_cannot_ask_for_endless_work) {
    OwnTape tape = {0};
    SingeSimDef def = recorded(singe_default_sim(), &tape);
    SingeSim *sim = test_sim(&def, test_grid(3, 3, 0.01f, 0.01f), NULL);
    test_ok(sim, singe_sim_advance(sim, 0.0101, 0, NULL));
    singe_sim_destroy(sim);

    const size_t advance = tape_find(&tape, 37, 0);
    const double long_time = 1e6;
    memcpy(tape.bytes + advance + HEAD, &long_time, sizeof long_time);

    SingeReplay replay = replay_all(&tape);
    assert_int_equal(replay.steps, 5);
    assert_false(replay.same);
}

/// As after a test that leaves out calls of a recording in search of the one that matters.
TEST(handles_are_followed_where_a_call_was_taken_out) {
    OwnTape tape = {0};
    SingeSimDef def = recorded(singe_default_sim(), &tape);
    SingeSim *sim = test_sim(&def, test_grid(3, 3, 0.01f, 0.01f), NULL);
    SingeSourceId first = test_spot(sim, 0, 0, 0, 0.01f, 400, 100), second = test_spot(sim, 0, 0, 0, 0.01f, 500, 100);
    (void)first;
    test_ok(sim, singe_sim_remove_source(sim, second));
    singe_sim_destroy(sim);

    const size_t from = tape_find(&tape, 18, 0), to = tape_find(&tape, 18, 1);
    memmove(tape.bytes + from, tape.bytes + to, tape.size - to);
    tape.size -= to - from;
    SingeReplay replay = replay_all(&tape);
    assert_string_equal(replay.what, "the answer to add_source, after step 0"); // not that to remove_source
    assert_true(replay.complete);
}

// ---- writers

static void count_warning(void *context, SingeLogLevel level, const char *line) {
    if (level == SINGE_LOG_WARNING && strstr(line, "recording")) ++*(int *)context;
}

TEST(a_failing_writer_ends_only_the_recording) {
    OwnTape tape = {.refuse_at = 20000};
    int warnings = 0;
    SingeSimDef def = recorded(scene_def(), &tape);
    def.log = (SingeLog){count_warning, &warnings};

    TestScene scene = scene_make(&def, 10);
    test_steps(scene.sim, 3);
    singe_sim_destroy(scene.sim);
    assert_int_equal(warnings, 1);
    assert_true(tape.size <= 20000);
}

static SingeResult create_and_destroy(const SingeSimDef *def, SingeSim **sim) {
    return singe_sim_create(def, sim, NULL);
}

TEST(a_recorder_for_which_there_is_no_memory_is_an_error) {
    OwnTape tape = {0};
    SingeSim *sim = NULL;
    SingeSimDef def = recorded(singe_default_sim(), &tape);
    test_allocations_fail(1, (def.allocator = allocator, create_and_destroy(&def, &sim)), singe_sim_destroy(sim));
}

TEST(a_replay_without_memory_is_an_error) {
    OwnTape tape = {0};
    SingeSimDef def = recorded(singe_default_sim(), &tape), hooks = singe_default_sim();
    SingeSim *sim = test_sim(&def, test_grid(3, 3, 0.01f, 0.01f), NULL);
    test_steps(sim, 1);
    singe_sim_destroy(sim);

    TestAllocator counter = {.fail_at = 4};
    hooks.allocator = test_allocator(&counter);

    SingeReplay replay;
    SingeError error;
    assert_int_equal(singe_replay(&hooks, tape.bytes, tape.size, &replay, &error), SINGE_ERROR_MEMORY);
    test_allocator_check(&counter);
}
