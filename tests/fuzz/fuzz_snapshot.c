// Snapshots with right checksums and any content: loading gives a simulation or a reason, and what was loaded steps or
// fails, but neither crashes nor hangs.
//
// The input is a list of changes to one of a few good snapshots, made here, so that it outlives their layout.

#include "common/stream.h"
#include "damage.h"
#include "sim/scenes.h"

enum { SNAPSHOTS = 4, MESHED = 3, HEADER = 56, SIZE_AT = 16, CHECKSUM_AT = 24, CHANGES = 24, STEPS = 2 };

typedef struct Saved {
    uint8_t *bytes;
    size_t size;
} Saved;

static Saved saved[SNAPSHOTS];

/// All sorts of objects; the second with gas, the third with contact, tears and creases, the last with a mesh to
/// collide with, which takes longer to build than all the rest.
static Saved make_snapshot(int which) {
    SingeSimDef def = scene_def();
    def.gas.enabled = which == 1, def.gas.cell_size = 0.05f, def.gas.height = 0.1f;
    def.contact.enabled = def.solver.tearing = def.solver.creases = which == 2;

    TestScene scene;
    if (scene_build(&def, 3, &scene)) abort();
    if (which != MESHED && singe_sim_remove_collider(scene.sim, scene.mesh)) abort();
    for (int i = 0; i < 6; i++)
        if (singe_sim_step(scene.sim)) abort();

    uint8_t *bytes;
    Saved copy;
    if (singe_sim_save(scene.sim, &bytes, &copy.size)) abort();
    copy.bytes = malloc(copy.size);
    demand(copy.bytes);
    memcpy(copy.bytes, bytes, copy.size);
    singe_sim_free_bytes(scene.sim, bytes, copy.size);
    singe_sim_destroy(scene.sim);
    return copy;
}

/// Makes one change at an offset of the body; *size may become less.
static void change(Input *input, uint8_t *body, size_t *size) {
    unsigned how = input_pick(input, 16);
    size_t at = ((size_t)input_byte(input) << 16 | (size_t)input_byte(input) << 8 | input_byte(input)) % (*size - 15);
    if (how < 9) put_word(input, body + at / 4 * 4);
    else if (how < 10) put_word(input, body + at);
    else if (how < 12) put_double(input, body + at / 4 * 4);
    else if (how < 13) memset(body + at, input_byte(input), 1);
    else if (how < 14) memcpy(body + at / 4 * 4, body + (size_t)(input_word(input) % (*size - 15)) / 4 * 4, 4);
    else if (how < 15)
        for (size_t i = 0; i < 15; i++) body[at + i] ^= input_byte(input);
    else if (input_rarely(input, 4)) *size = at + 16;
}

static void try_snapshot(const uint8_t *bytes, size_t size) {
    Limited memory = {.max = (size_t)1 << 29};
    SingeSimDef hooks = singe_default_sim();
    hooks.allocator = (SingeAllocator){limited_resize, &memory};

    SingeSim *sim = NULL;
    SingeError error = {0};
    if (singe_sim_load(&hooks, bytes, size, &sim, &error)) {
        demand(!sim && error.code && error.message[0] && memory.held == 0);
        return;
    }

    bool failed = false;
    for (int step = 0; step < STEPS && !failed; step++) failed = singe_sim_step(sim) != SINGE_OK;

    SingeSurface surface = {0};
    if (singe_sim_surface(sim, &surface) == SINGE_OK)
        for (uint32_t i = 0; i < 3 * surface.triangle_count; i++)
            demand(surface.triangles[i / 3][i % 3] < surface.vertex_count);
    singe_surface_free(&surface);
    (void)singe_sim_stats(sim);
    singe_sim_destroy(sim);
    demand(memory.held == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Input input = {data, data + size};
    unsigned which = input_rarely(&input, 16) ? MESHED : input_pick(&input, MESHED);
    if (!saved[which].bytes) saved[which] = make_snapshot((int)which);
    Saved copy = {malloc(saved[which].size), saved[which].size};
    demand(copy.bytes);
    memcpy(copy.bytes, saved[which].bytes, copy.size);

    size_t body = copy.size - HEADER;
    for (int k = 0; k < CHANGES && input.at < input.end && body > 64; k++) change(&input, copy.bytes + HEADER, &body);

    uint64_t checksum = stream_checksum(copy.bytes + HEADER, body), length = body;
    memcpy(copy.bytes + SIZE_AT, &length, sizeof length);
    memcpy(copy.bytes + CHECKSUM_AT, &checksum, sizeof checksum);
    try_snapshot(copy.bytes, HEADER + body);
    free(copy.bytes);
    return 0;
}
