// Replays a recording. The replayed simulation is recorded in its turn, into nothing: each byte of that recording is
// compared with the given one, but for the calls themselves. So this file only reads what calls need.
#include "singe/replay.h"

#include "common/format.h"
#include "sim/calls.h"

#include <stdatomic.h>
#include <string.h>

/// A handle that the replay has made, where it differs from the recorded one: in a recording from which calls were
/// removed.
typedef struct HandleChange {
    int kind; ///< number of the call that makes such objects
    uint32_t was[2], is[2];
} HandleChange;

typedef struct Player {
    Tape tape;      ///< reads
    uint64_t begin; ///< of the record being read
    uint64_t end;   ///< of the same

    // comparison
    bool compares, differs;
    uint64_t compared;   ///< up to where
    uint64_t difference; ///< where the first one is
    bool call_begins;    ///< what the replay's recording writes next is a call, and was given to it: not compared
    uint64_t call_left;  ///< bytes of that call still to come

    Memory memory;
    SingeSim *sim;
    HandleChange *changes;
    uint32_t change_count, change_capacity;
    SingeSurface surface;
    SingeReplay report;
    uint64_t given_up; ///< the step from which on the recorded call was given up; UINT64_MAX: it was not
    SingeCancel cancel;
    atomic_bool cancelled; ///< the host gives up the replay
} Player;

// ---- records

/// Finds the record at the tape's position; false at the end, and where it is cut short.
static bool player_peek(Player *player, uint8_t *kind) {
    Tape *tape = &player->tape;
    const uint64_t begin = tape->offset;
    if (tape->size - begin < RECORD_HEAD) return false;
    uint64_t size;
    TAPE(tape, *kind);
    TAPE(tape, size);
    if (size > tape->size - tape->offset) {
        tape->offset = begin;
        return false;
    }
    player->begin = begin;
    player->end = tape->offset + size;
    return true;
}

/// Whether a record stands between a call and its answer.
static bool is_of_step(uint8_t kind) { return kind == RECORD_STATE || kind == RECORD_HEAT; }

// ---- comparison

static bool player_compare(void *context, const void *bytes, size_t size) {
    Player *player = context;
    if (!player->compares) return true;
    if (player->call_begins) {
        Tape head = {.mode = STREAM_READ, .bytes = bytes, .size = size, .offset = 1};
        TAPE(&head, player->call_left);
        player->call_left += RECORD_HEAD;
        player->call_begins = false;
    }
    const size_t given = player->call_left < size ? (size_t)player->call_left : size;
    player->call_left -= given;
    bytes = (const uint8_t *)bytes + given;
    size -= given;

    const uint64_t left = player->tape.size - player->compared;
    const size_t common = size < left ? size : (size_t)left; // nothing is known of what a crash has cut off
    const uint8_t *wanted = player->tape.bytes + player->compared, *got = bytes;
    if (!player->differs && memcmp(wanted, got, common) != 0) {
        size_t at = 0;
        while (wanted[at] == got[at]) at++;
        player->differs = true;
        player->difference = player->compared + at;
    }
    player->compared += common;
    return true;
}

/// NULL for what is no call.
static const char *call_name(uint8_t kind) {
    static const char *const names[UINT8_MAX + 1] = {
#define SINGE_CALL(number, name, A, B, C) [number] = #name,
#include "sim/calls.def"
    };
    return names[kind];
}

static void report_what(SingeReplay *report, const char *format, ...) SINGE_PRINTF(2, 3);
static void report_what(SingeReplay *report, const char *format, ...) {
    va_list list;
    va_start(list, format);
    text_print(report->what, sizeof report->what, format, list);
    va_end(list);
}

/// Describes the record in which the first difference lies.
static void player_explain(Player *player, uint64_t first) {
    SingeReplay *report = &player->report;
    Tape *tape = &player->tape;
    report->same = !player->differs;
    if (report->same) return;

    uint8_t kind = 0, call = 0;
    uint64_t step = 0;
    tape->offset = first;
    tape->failed = false;
    while (player_peek(player, &kind) && player->end <= player->difference) {
        if (kind == RECORD_STATE) TAPE(tape, step);
        if (kind >= RECORD_CALL) call = kind;
        tape->offset = player->end;
    }

    report->step = step;
    if (kind == RECORD_STATE) {
        TAPE(tape, report->step);
        if (report->step == 0) report_what(report, "the state after the commit");
        else report_what(report, "the state after step %llu", (unsigned long long)report->step);
    } else if (kind == RECORD_RESULT) {
        report_what(report, "the answer to %s, after step %llu", call_name(call) ? call_name(call) : "no call",
                    (unsigned long long)step);
    } else if (kind == RECORD_HEAT) {
        report->step++;
        report_what(report, "the heat of a callback, after step %llu", (unsigned long long)step);
    } else {
        report_what(report, "the record after step %llu: expected %s", (unsigned long long)step,
                    call_name(kind) ? call_name(kind) : "the end");
    }
}

// ---- callback sources

/// The callback of every source: leaves in the arrays what the recorded one has left.
static void player_heat(void *context, const SingeView *view, float *flux, float *conductance,
                        float *conductance_temperature) {
    Player *player = context;
    Tape *tape = &player->tape;
    float *const arrays[3] = {flux, conductance, conductance_temperature};
    uint8_t kind = 0;
    bool found = false;
    tape->offset = player->end; // behind the call or the last heat
    while (!found && player_peek(player, &kind) && is_of_step(kind)) {
        found = kind == RECORD_HEAT;
        if (!found) tape->offset = player->end;
    }
    if (!found) {
        if (kind && !is_of_step(kind)) { // back to what is not of the step
            player->end = tape->offset = player->begin;
        } else { // cut off: the steps from here on are others
            recorder_flush(player->sim->recorder);
            player->compares = false;
        }
        return;
    }

    uint32_t count = 0;
    TAPE(tape, count);
    if (count == view->particle_count)
        for (int k = 0; k < 3; k++) memset(arrays[k], 0, count * sizeof(float));
    while (count == view->particle_count && tape->offset < player->end) {
        uint32_t first = 0, length = 0;
        TAPE(tape, first);
        TAPE(tape, length);
        if (length == 0 || length > count || first > count - length ||
            12 * (uint64_t)length > player->end - tape->offset) {
            tape->failed = true;
            break;
        }
        for (int k = 0; k < 3; k++) tape_data(tape, arrays[k] + first, length, sizeof(float));
    }
    tape->offset = player->end;
}

// ---- arguments

/// Turns a recorded handle into the replay's.
static void change_handle(const Player *player, int maker, uint32_t *index, uint32_t *generation) {
    for (uint32_t i = player->change_count; i-- > 0;) {
        const HandleChange *change = &player->changes[i];
        if (change->kind != maker || change->was[0] != *index || change->was[1] != *generation) continue;
        *index = change->is[0];
        *generation = change->is[1];
        return;
    }
}

static bool read_asked(Tape *tape) {
    bool asked = false;
    tape_bool(tape, &asked);
    return asked;
}

/// 3 * count floats. Fails unless they are as many as the call will read.
static const float *read_points(Tape *tape, uint32_t needed) {
    uint32_t count = 0;
    const float *points = NULL;
    TAPE(tape, count);
    tape_array(tape, &points, 3 * (uint64_t)count, sizeof(float));
    if (points && count != needed) points = NULL; // refused by the call
    return points;
}

static const float *read_share(Player *player, SingeSheetId id) {
    Tape *tape = &player->tape;
    const SingeSim *sim = player->sim;
    uint32_t count = 0;
    const float *share = NULL;
    TAPE(tape, count);
    tape_array(tape, &share, count, sizeof(float));
    if (share && id.index < sim->sheet_count && sim->sheets[id.index].sheet.vertex_count != count) tape->failed = true;
    return share;
}

/// The number of steps that the recording has of the call being read, and whether the call's answer is that it was given
/// up.
static uint32_t recorded_steps(Player *player, bool *given_up) {
    const uint64_t begin = player->begin, end = player->end, offset = player->tape.offset;
    uint32_t recorded = 0, code = 0;
    uint8_t kind = 0;
    bool there;
    player->tape.offset = end;
    while ((there = player_peek(player, &kind)) && is_of_step(kind)) {
        recorded += kind == RECORD_STATE;
        player->tape.offset = player->end;
    }
    if (there && kind == RECORD_RESULT && player->end - player->tape.offset >= sizeof code) TAPE(&player->tape, code);
    *given_up = code == SINGE_ERROR_CANCELLED;
    player->begin = begin;
    player->end = end;
    player->tape.offset = offset;
    return recorded;
}

/// The hook of the replay: gives up what was given up, and all if the host asks for that.
static bool player_gives_up(void *context) {
    Player *player = context;
    if (player->cancel.asked && player->cancel.asked(player->cancel.context)) atomic_store(&player->cancelled, true);
    return atomic_load(&player->cancelled) || (player->sim && player->sim->state.step >= player->given_up);
}

/// Bounds the steps of an advance that would make more than were recorded, and one more: a hostile recording may ask for
/// any number.
static uint32_t bound_steps(Player *player, double seconds, uint32_t steps_max) {
    const SingeSim *sim = player->sim;
    bool given_up;
    const uint32_t recorded = recorded_steps(player, &given_up);
    const double all = (sim->remainder + seconds) / (double)sim->def.time_step;
    if (!(all > (double)recorded + 1) || (steps_max && steps_max <= recorded)) return steps_max;
    return recorded + 1;
}

/// Notes the handle of what a call has made, whose recorded answer comes next.
static void note_handle(Player *player, int maker, uint32_t index, uint32_t generation) {
    Tape *tape = &player->tape;
    uint8_t kind;
    uint32_t code = 0, was[2] = {0, 0};
    tape->offset = player->end;
    if (!player_peek(player, &kind) || kind != RECORD_RESULT) {
        player->end = tape->offset;
        return;
    }
    TAPE(tape, code);
    TAPE(tape, was[0]);
    TAPE(tape, was[1]);
    if (tape->failed || code || !generation || (was[0] == index && was[1] == generation)) return;
    if (player->change_count == player->change_capacity) {
        const uint32_t grown = player->change_capacity ? 2 * player->change_capacity : 16;
        if (!memory_grow(&player->memory, &player->changes, player->change_capacity, grown, sizeof *player->changes)) {
            tape->failed = tape->no_memory = true;
            return;
        }
        player->change_capacity = grown;
    }
    player->changes[player->change_count++] = (HandleChange){maker, {was[0], was[1]}, {index, generation}};
}

// How each kind of arguments is read, passed on, and what is done after the call.
#define READ_NOTHING
#define PASS_NOTHING
#define AFTER_NOTHING (void)result;

enum {
#define SINGE_CALL(number, name, A, B, C) CALL_##name = number,
#include "sim/calls.def"
};
#define READ_DEF(Type, name) \
    Singe##Type##Def def;    \
    tape_##name##_def(tape, NULL, &def);
#define PASS_DEF(Type, name) , &def
#define READ_PIN_DEF   \
    READ_DEF(Pin, pin) \
    change_handle(player, CALL_add_sheet, &def.sheet.index, &def.sheet.generation);
#define PASS_PIN_DEF , &def
#define READ_HANDLE(Type, name) \
    Singe##Type##Id id;         \
    TAPE(tape, id.index);       \
    TAPE(tape, id.generation);  \
    change_handle(player, CALL_add_##name, &id.index, &id.generation);
#define PASS_HANDLE(Type, name) , id
#define READ_NEW(Type)           \
    Singe##Type##Id id = {0, 0}; \
    const bool asked = read_asked(tape);
#define PASS_NEW(Type) , asked ? &id : NULL
#define AFTER_NEW(Type) note_handle(player, kind, id.index, id.generation);
#define READ_CALLBACK const bool called = read_asked(tape);
#define PASS_CALLBACK , called ? player_heat : NULL, player
#define READ_COLLIDER_VERTICES const float *points = read_points(tape, call_collider_points(player->sim, id));
#define PASS_COLLIDER_VERTICES , points
#define READ_PIN_POSITIONS const float *points = read_points(tape, call_pin_points(player->sim, id));
#define PASS_PIN_POSITIONS , points
#define READ_PATH             \
    uint32_t path_count = 0;  \
    const SingePoseKey *path; \
    tape_path(tape, &path_count, &path);
#define PASS_PATH , path_count, path
#define READ_GRAVITY  \
    float gravity[3]; \
    tape_data(tape, gravity, 3, sizeof *gravity);
#define PASS_GRAVITY , gravity
#define READ_NUMBER \
    float number;   \
    TAPE(tape, number);
#define PASS_NUMBER , number
#define READ_SECONDS \
    double seconds;  \
    TAPE(tape, seconds);
#define PASS_SECONDS , seconds
#define AFTER_SECONDS
#define READ_VELOCITIES             \
    uint32_t first = 0, count = 0;  \
    const float *velocities = NULL; \
    TAPE(tape, first);              \
    TAPE(tape, count);              \
    tape_array(tape, &velocities, 3 * (uint64_t)count, sizeof(float));
#define PASS_VELOCITIES , first, count, velocities
#define READ_SHARE const float *share = read_share(player, id);
#define PASS_SHARE , share
#define AFTER_SHARE
#define READ_STEPS             \
    uint32_t steps_max, steps; \
    TAPE(tape, steps_max);     \
    const bool asked = read_asked(tape);
#define PASS_STEPS , bound_steps(player, seconds, steps_max), asked ? &steps : NULL
#define AFTER_STEPS
#define READ_SURFACE \
    uint64_t size;   \
    TAPE(tape, size);
#define PASS_SURFACE , &player->surface, size < sizeof player->surface ? (size_t)size : sizeof player->surface
#define AFTER_SURFACE
#define READ_SNAPSHOT \
    uint8_t *saved;   \
    size_t saved_size;
#define PASS_SNAPSHOT , &saved, &saved_size
#define AFTER_SNAPSHOT singe_sim_free_bytes(sim, saved, saved_size);
#define READ_COPY SingeSim *copy = NULL;
#define PASS_COPY , &copy
#define AFTER_COPY singe_sim_destroy(copy);

/// Makes the call of a record.
static void player_call(Player *player, uint8_t kind) {
    Tape *tape = &player->tape;
    SingeSim *sim = player->sim;
    const uint64_t before = sim->state.step;
    SingeResult result = SINGE_OK;
    bool given_up;
    const uint32_t recorded = recorded_steps(player, &given_up);
    player->given_up = given_up ? before + recorded : UINT64_MAX;
    recorder_flush(sim->recorder); // what follows is the call
    player->compared = player->end;
    player->call_begins = true;
    switch (kind) {
#define SINGE_CALL(number, name, A, B, C)                                       \
    case number: {                                                              \
        READ_##A READ_##B READ_##C tape->failed |= tape->offset != player->end; \
        if (tape->failed) break;                                                \
        result = singe_sim_##name(sim PASS_##A PASS_##B PASS_##C);              \
        AFTER_##C                                                               \
    } break;
#include "sim/calls.def"
    default: tape->failed = true; break;
    }
    (void)result; // it is in the replay's own recording
    if (!tape->failed) player->report.calls++;
    player->report.steps += sim->state.step - before;
    tape_release(tape);
}

// ---- the whole

/// The record of a kind at a byte cannot be used.
static SingeResult player_fail(const Player *player, uint8_t kind, uint64_t at, SingeError *error) {
    const unsigned long long byte = at;
    const char *name = call_name(kind);
    if (player->tape.no_memory) return error_set(error, SINGE_ERROR_MEMORY, "replay", -1, "out of memory");
    if (name)
        return error_set(error, SINGE_ERROR_FORMAT, "replay", (int64_t)at,
                         "the recording is damaged: the arguments of %s at byte %llu are wrong", name, byte);
    if (kind >= RECORD_CALL)
        return error_set(error, SINGE_ERROR_FORMAT, "replay", (int64_t)at,
                         "the recording is damaged: unknown call %d at byte %llu", kind, byte);
    return error_set(error, SINGE_ERROR_FORMAT, "replay", (int64_t)at,
                     "the recording is damaged: the record at byte %llu is wrong or misplaced", byte);
}

/// Makes the simulation by the first record.
static SingeResult player_begin(Player *player, const SingeSimDef *hooks, SingeError *error) {
    Tape *tape = &player->tape;
    RecordHeader header = {0};
    record_header(tape, &header);
    if (tape->failed || memcmp(header.magic, "SINGEREC", sizeof header.magic) != 0)
        return error_set(error, SINGE_ERROR_FORMAT, "replay", 0, "not a recording");
    header.singe[sizeof header.singe - 1] = 0;
    memcpy(player->report.version, header.singe, sizeof header.singe);
    if (header.version != RECORD_VERSION)
        return error_set(error, SINGE_ERROR_VERSION, "replay", 0,
                         "the recording has format %u; singe %s reads format %d", header.version, singe_version(),
                         RECORD_VERSION);

    uint8_t kind = 0;
    if (!player_peek(player, &kind) || (kind != RECORD_CREATE && kind != RECORD_LOAD))
        return error_set(error, SINGE_ERROR_FORMAT, "replay", (int64_t)tape->offset,
                         "a recording must begin with the creation of a simulation, not with what is at byte %llu",
                         (unsigned long long)tape->offset);
    SingeSimDef def = singe_default_sim(), given;
    if (!sim_read_sim_def(hooks, &given))
        return error_set(error, SINGE_ERROR_ARGUMENT, "replay", -1,
                         "struct_size is not set; start from singe_default_sim()");
    int recorded[2]; // threads and instructions: of interest to a reader, not to a replay
    tape_data(tape, recorded, 2, sizeof *recorded);
    if (kind == RECORD_CREATE) tape_sim_def(tape, &def);
    if (tape->failed || tape->offset > player->end || (kind == RECORD_CREATE && tape->offset != player->end))
        return player_fail(player, kind, player->begin, error);
    def.allocator = given.allocator;
    def.log = given.log;
    def.tasks = given.tasks;
    def.thread_count = given.thread_count;
    def.instructions = given.instructions;
    def.record = (SingeRecord){player_compare, player};
    def.cancel = (SingeCancel){player_gives_up, player};
    player->cancel = given.cancel;

    const size_t saved = (size_t)(player->end - tape->offset);
    SingeResult result = kind == RECORD_CREATE
                             ? singe_sim_create(&def, &player->sim, error)
                             : singe_sim_load(&def, tape->bytes + tape->offset, saved, &player->sim, error);
    if (!result && !sim_recorder(player->sim)) {
        singe_sim_destroy(player->sim);
        player->sim = NULL;
        result = error_set(error, SINGE_ERROR_STATE, "replay", -1, "this library was built without SINGE_RECORDING");
    }
    tape->offset = player->compared = player->end;
    player->compares = !result;
    return result;
}

SingeResult singe_replay_read(const SingeSimDef *hooks, const uint8_t *bytes, size_t size, SingeReplay *replay,
                              size_t struct_size, SingeError *error) {
    Player player = {.tape = {.mode = STREAM_READ, .bytes = bytes, .size = size, .callback = player_heat},
                     .given_up = UINT64_MAX};
    Tape *tape = &player.tape;
    player.memory = memory_make(hooks->allocator);
    player.report.struct_size = struct_size;
    player.surface.allocator = hooks->allocator;
    tape->callback_context = &player;
    tape->memory = &player.memory;

    SingeResult result = player_begin(&player, hooks, error);
    const uint64_t first = tape->offset;
    uint8_t kind = 0;
    while (!result && !player.report.complete && player_peek(&player, &kind)) {
        const uint64_t begin = player.begin;
        if (kind >= RECORD_CALL) player_call(&player, kind);
        player.report.complete = kind == RECORD_END;
        if (atomic_load(&player.cancelled))
            result =
                error_set(error, SINGE_ERROR_CANCELLED, "replay", -1, "the replay was given up, as the host has asked");
        else if (kind == RECORD_CREATE || kind == RECORD_LOAD || tape->failed)
            result = player_fail(&player, kind, begin, error);
        tape->offset = player.end;
    }
    if (!result && player.report.complete && tape->offset != size)
        result = player_fail(&player, 0, tape->offset, error);

    // what a crash has cut off is not compared
    if (player.sim) recorder_flush(player.sim->recorder);
    player.compares &= player.report.complete;
    singe_sim_destroy(player.sim);
    if (player.compares || player.differs || !result) player_explain(&player, first);
    tape_release(tape);
    FREE(&player.memory, player.changes, player.change_capacity);
    singe_surface_free(&player.surface);
    sim_write_result(replay, struct_size, &player.report, sizeof player.report);
    return result;
}
