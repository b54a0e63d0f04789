// Recordings with any content: a replay ends with what differs or with a reason, and neither crashes, nor hangs, nor
// takes more memory than there is.
//
// The input is a recording, or a list of changes to a good one, made here, so that it outlives the format.

#include "damage.h"
#include "sim/recording.h"
#include "sim/scenes.h"

enum { RECORDINGS = 4, MESHED = 3, CHANGES = 24, WHOLE_MAX = 1 << 14, ADD_COLLIDER = 21, CALLS = 16, MESH = 4 };

typedef struct Range {
    size_t begin, end;
} Range;

static void take_out(Tape *tape, Range range) {
    memmove(tape->bytes + range.begin, tape->bytes + range.end, tape->size - range.end);
    tape->size -= range.end - range.begin;
}

/// Every call; the second with gas, the third with contact, tears and creases, the last with a mesh to collide with,
/// which takes longer to build than all the rest.
static Tape make_recording(int which) {
    Tape tape = {0};
    SingeSimDef def = recorded(scene_def(), &tape);
    def.gas.enabled = which == 1, def.gas.cell_size = 0.05f, def.gas.height = 0.1f;
    def.solver.substeps = 2;
    def.contact.enabled = def.solver.tearing = def.solver.creases = which == 2;

    TestScene scene;
    if (scene_build(&def, 3, &scene)) abort();
    scene_every_call(&scene);
    singe_sim_destroy(scene.sim);

    const size_t mesh = tape_find(&tape, ADD_COLLIDER, MESH), next = tape_find(&tape, ADD_COLLIDER, MESH + 1);
    demand(next < tape.size);
    if (which != MESHED) take_out(&tape, (Range){mesh, next});
    return tape;
}

/// Gives up a replay that asks for far more than the recordings here: a million projections a step are legal.
static bool is_too_much(void *context) {
    enum { ASKS_MAX = 20000 };
    int *asks = context;
    return ++*asks > ASKS_MAX;
}

/// A replay; the bytes end where their memory does.
static SingeReplay try_recording(const uint8_t *bytes, size_t size) {
    Limited memory = {.max = (size_t)1 << 26};
    SingeSimDef hooks = singe_default_sim();
    int asks = 0;
    hooks.allocator = (SingeAllocator){limited_resize, &memory};
    hooks.cancel = (SingeCancel){is_too_much, &asks};

    uint8_t *copy = malloc(size + !size);
    demand(copy);
    memcpy(copy, bytes, size);

    SingeReplay replay;
    SingeError error = {0};
    const SingeResult result = singe_replay(&hooks, copy, size, &replay, &error);

    demand(memory.held == 0);
    if (result) demand(error.code == result && error.message[0]);
    else demand(replay.same == !replay.what[0]);
    free(copy);
    return replay;
}

/// The record at a byte; none where its head is wrong.
static Range record_at(const Tape *tape, size_t begin) {
    if (tape->size < begin + HEAD) return (Range){0, 0};
    const uint64_t size = tape_number(tape->bytes + begin + 1, 8);
    return size <= tape->size - begin - HEAD ? (Range){begin, begin + HEAD + (size_t)size} : (Range){0, 0};
}

static Range pick_record(Input *input, const Tape *tape) {
    unsigned count = 0, pick = (unsigned)input_byte(input) << 8 | input_byte(input);
    for (Range range = record_at(tape, HEADER); range.end; range = record_at(tape, range.end)) count++;
    pick %= count + !count;
    Range range = record_at(tape, HEADER);
    while (pick-- > 0) range = record_at(tape, range.end);
    return range;
}

static void set_size(Tape *tape, Range range) {
    uint64_t size = range.end - range.begin - HEAD;
    for (int i = 0; i < 8; i++) tape->bytes[range.begin + 1 + (size_t)i] = (uint8_t)(size >> 8 * i);
}

static void change(Input *input, Tape *tape) {
    const unsigned how = input_pick(input, 16);
    Range range = pick_record(input, tape);
    if (!range.end) return;

    const size_t size = range.end - range.begin - HEAD;
    const size_t offset = (size_t)input_byte(input) << 8 | input_byte(input);
    uint8_t *head = tape->bytes + range.begin, *body = head + HEAD;
    if (how < 6 && size >= 4) {
        put_word(input, body + offset % (size - 3));
    } else if (how < 8 && size >= 8) {
        put_double(input, body + offset % (size - 7));
    } else if (how < 9 && size >= 1) {
        body[offset % size] = input_byte(input);
    } else if (how < 10) {
        *head = input_rarely(input, 4) ? (uint8_t)offset : (uint8_t)(CALLS + offset % 26);
    } else if (how < 11) {
        put_word(input, head + 1);
    } else if (how < 13) {
        take_out(tape, range);
    } else if (how < 14) { // once more, behind another
        const size_t to = pick_record(input, tape).end, whole = range.end - range.begin;
        uint8_t *copy = malloc(whole);
        demand(copy);
        memcpy(copy, head, whole);
        if (tape->size + whole <= tape->room) {
            memmove(tape->bytes + to + whole, tape->bytes + to, tape->size - to);
            memcpy(tape->bytes + to, copy, whole);
            tape->size += whole;
        }
        free(copy);
    } else if (how < 15 && size >= 1) { // a shorter one
        const size_t less = 1 + offset % size;
        take_out(tape, (Range){range.end - less, range.end});
        set_size(tape, (Range){range.begin, range.end - less});
    } else if (input_rarely(input, 4)) {
        tape->size = range.begin + offset % (HEAD + size);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size >= 8 && memcmp(data, "SINGEREC", 8) == 0) {
        if (size <= WHOLE_MAX) try_recording(data, size);
        return 0;
    }

    static Tape good[RECORDINGS];
    Input input = {data, data + size};
    const unsigned which = input_rarely(&input, 16) ? MESHED : input_pick(&input, MESHED);
    if (!good[which].bytes) {
        good[which] = make_recording((int)which);
        demand(try_recording(good[which].bytes, good[which].size).complete);
    }

    Tape copy = {.size = good[which].size, .room = 2 * good[which].size};
    copy.bytes = malloc(copy.room);
    demand(copy.bytes);
    memcpy(copy.bytes, good[which].bytes, copy.size);
    for (int k = 0; k < CHANGES && input.at < input.end; k++) change(&input, &copy);
    try_recording(copy.bytes, copy.size);
    free(copy.bytes);
    return 0;
}
