// Long-range attachments (Kim, Chentanez and Mueller-Fischer, Long range attachments, 2012). On an inextensible
// sheet the distance in space between two vertices never exceeds the geodesic distance L along the sheet. For
// every vertex i and held vertex p, where |x_i - x_p| > L_ip,
//
//   x_i <- x_p + (x_i - x_p) L_ip / |x_i - x_p|.
//
// Within a projection a strand passes a pull on only to its own other end, so that on a fine sheet stretch would carry
// most of the load at a pin; attachments carry it at once. Centres lie off the mesh, farther away on the outside of a
// bend: they are not attached, or a sheet would not bend.
//
// Sources are up to ATTACH_SOURCES held vertices of a sheet, each as far as possible from those before it. Lengths are
// those of the springs' targets over the cells that are left, measured again every ATTACH_PERIOD steps while a sheet
// burns. A length that has grown, because the fire cut a path, takes effect at once. A length that has shrunk
// approaches its new value step by step until the next measurement, as a sudden change would jerk the vertex. So do the
// lengths of vertices that are too far from a source that replaces a burnt one, and of vertices that moved too far
// while a tight sheet that may tear was left to its springs. Vertices that have come free of a source are released at
// the end of the step. A sheet whose mesh may stretch by its compliance has no attachments.
#include "dynamics/attach.h"

#include "common/float3.h"
#include "common/real.h"

/// A number of vertices that makes whole blocks of lanes for any kernel.
enum { ATTACH_BLOCK = 16 };

/// Max fraction by which a length shortens in a step.
static const float ATTACH_HASTE = 0.003f;

bool attach_create(Memory *memory, const Shell *shell, Attachments *attachments) {
    *attachments = (Attachments){0};
    bool done =
        NEW(memory, attachments->source, shell->sheet_count) && NEW(memory, attachments->spread, shell->sheet_count) &&
        NEW(memory, attachments->length, shell->vertex_count) && NEW(memory, attachments->goal, shell->vertex_count) &&
        NEW(memory, attachments->distance, shell->vertex_count) &&
        geodesic_create(memory, shell->vertex_count, &attachments->search);
    for (uint32_t s = 0; done && s < shell->sheet_count; s++)
        for (int k = 0; k < ATTACH_SOURCES; k++) attachments->source[s][k] = SHELL_NONE;
    return done;
}

void attach_free(Memory *memory, const Shell *shell, Attachments *attachments) {
    FREE(memory, attachments->source, shell->sheet_count);
    FREE(memory, attachments->spread, shell->sheet_count);
    FREE(memory, attachments->length, shell->vertex_count);
    FREE(memory, attachments->goal, shell->vertex_count);
    FREE(memory, attachments->distance, shell->vertex_count);
    geodesic_free(memory, shell->vertex_count, &attachments->search);
}

/// The held vertex that is farthest, at rest, from the sources found so far; the first one if there are none.
/// SHELL_NONE if it is nearer than a tenth of the distance between the first two: it would hardly hold anything else.
static uint32_t attach_farthest(const Shell *shell, const StateInput *state, const Sheet *sheet, const uint32_t *source,
                                int count) {
    uint32_t farthest = SHELL_NONE;
    float max = 0;
    for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++) {
        if (!state->dynamics->pinned[v] || !(state->ablate->particle_flags[v] & SINGE_ALIVE)) continue;

        float nearest = INFINITY;
        for (int k = 0; k < count; k++) {
            Float3 displacement =
                float3_sub(float3_load(shell->rest_position[v]), float3_load(shell->rest_position[source[k]]));
            nearest = float_min(nearest, float3_dot(displacement, displacement));
        }

        if (nearest > max) {
            farthest = v;
            max = nearest;
        }
    }

    if (count < 2 || farthest == SHELL_NONE) return farthest;
    Float3 first =
        float3_sub(float3_load(shell->rest_position[source[1]]), float3_load(shell->rest_position[source[0]]));
    return max < 0.01f * float3_dot(first, first) ? SHELL_NONE : farthest;
}

/// Finds the sources, and measures their distances. `at_once`: all lengths follow; else those that have grown.
static void attach_measure(Attachments *attachments, const Shell *shell, const StateInput *state, bool at_once) {
    const float(*position)[4] = (const float(*)[4])state->dynamics->position;
    const int32_t *piece = state->ablate->piece;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        const uint32_t first = sheet->vertex_first, last = first + sheet->vertex_count;
        uint32_t *source = attachments->source[s];

        // a mesh that may stretch anywhere has no sources
        bool more = true;
        for (uint32_t v = first; v < last && more; v++) more = !(field_at(shell->matter.compliance[SINGE_BLUE], v) > 0);

        for (int k = 0; k < ATTACH_SOURCES; k++) {
            const uint32_t before = source[k];
            source[k] = more ? attach_farthest(shell, state, sheet, source, k) : SHELL_NONE;
            more = source[k] != SHELL_NONE;
            if (!more) continue;
            geodesic_from(&attachments->search, shell, state, source[k], first, last, attachments->distance);

            // a new source starts with the present distances, so that it pulls nothing at first: vertices that are too
            // far approach gradually
            const Float3 from = float3_load(position[source[k]]);
            for (uint32_t v = first; v < last && source[k] != before && !at_once; v++)
                attachments->length[v][k] = float3_length(float3_sub(float3_load(position[v]), from));

            // cells may share a vertex where no spring joins them any more: another piece is out of reach, whatever was
            // measured
            for (uint32_t v = first; v < last; v++) {
                const float measured = piece[v] == piece[source[k]] ? attachments->distance[v] : INFINITY;
                float *length = &attachments->length[v][k];
                attachments->goal[v][k] = measured;
                if (at_once || isinf(*length) || measured > *length) *length = measured;
            }
            attachments->settled = false;
        }
    }
}

void attach_update(Attachments *attachments, const Shell *shell, const StateInput *state, bool pins_changed) {
    // pieces never join again: a vertex in another piece than a source is out of its reach for good
    const int32_t *piece = state->ablate->piece;
    const bool parted = attachments->topology != state->ablate->topology_version;
    attachments->topology = state->ablate->topology_version;

    for (uint32_t v = 0; parted && v < shell->vertex_count; v++) {
        const uint32_t *source = attachments->source[shell->matter.sheet[v]];
        for (int k = 0; k < ATTACH_SOURCES && source[k] != SHELL_NONE; k++)
            if (piece[v] != piece[source[k]]) attachments->length[v][k] = attachments->goal[v][k] = INFINITY;
    }

    // lengths shorten, so that they reach their goals when the next measurement is due, or at the max rate: at once would
    // jerk the vertices
    if (!pins_changed) {
        const float share = 1 / (float)(ATTACH_PERIOD - state->step % ATTACH_PERIOD);
        const bool settled = attachments->settled;
        attachments->settled = true;
        for (uint32_t v = 0; !settled && v < shell->vertex_count; v++)
            for (int k = 0; k < ATTACH_SOURCES; k++) {
                float *length = &attachments->length[v][k], goal = attachments->goal[v][k];
                if (!(goal < *length)) continue;
                *length -= float_min((*length - goal) * share, ATTACH_HASTE * *length);
                attachments->settled = false;
            }
    }

    // lengths of a resting sheet grow to the present distances; those of held vertices tell whether it is tight, and stay
    const float(*position)[4] = (const float(*)[4])state->dynamics->position;
    for (uint32_t s = 0; s < shell->sheet_count && !pins_changed; s++) {
        const uint32_t first = shell->sheets[s].vertex_first, *source = attachments->source[s];
        if (!attach_rests(shell, &attachments->spread[s])) continue;
        for (int k = 0; k < ATTACH_SOURCES && source[k] != SHELL_NONE; k++)
            for (uint32_t v = first; v < first + shell->sheets[s].vertex_count; v++) {
                Float3 displacement = float3_sub(float3_load(position[v]), float3_load(position[source[k]]));
                float *length = &attachments->length[v][k];
                if (position[v][3] == 0 || !(float3_dot(displacement, displacement) > *length * *length)) continue;
                *length = float3_length(displacement);
                attachments->settled = false;
            }
    }

    // measure again where pins, the fire or a tear have changed the distances
    bool changed = attachments->mass_burnt != state->burn->mass_burnt && (state->step + 1) % ATTACH_PERIOD == 0;
    bool torn = attachments->split_count != shell->split_count && (state->step + 1) % ATTACH_TORN_PERIOD == 0;
    if (!pins_changed && !changed && !torn) return;

    attach_measure(attachments, shell, state, pins_changed);
    attachments->mass_burnt = state->burn->mass_burnt;
    attachments->split_count = shell->split_count;
}

void attach_split(Attachments *attachments, uint32_t vertex, uint32_t spare) {
    for (int k = 0; k < ATTACH_SOURCES; k++) {
        attachments->length[spare][k] = attachments->length[vertex][k];
        attachments->goal[spare][k] = attachments->goal[vertex][k];
    }
}

void attach_stream(Attachments *attachments, const Shell *shell, Stream *stream) {
    STREAM(stream, attachments->topology);
    STREAM(stream, attachments->mass_burnt);
    STREAM(stream, attachments->split_count);
    stream_data(stream, attachments->source, shell->sheet_count * sizeof *attachments->source);
    stream_data(stream, attachments->length, shell->vertex_count * sizeof *attachments->length);
    stream_data(stream, attachments->goal, shell->vertex_count * sizeof *attachments->goal);
    if (stream->mode != STREAM_READ) return;

    // the data read back must be what attach_measure may have left
    for (uint32_t s = 0; s < shell->sheet_count; s++)
        for (int k = 0; k < ATTACH_SOURCES; k++) {
            const Sheet *sheet = &shell->sheets[s];
            uint32_t source = attachments->source[s][k];
            if (source == SHELL_NONE) continue;
            if (source < sheet->vertex_first || source - sheet->vertex_first >= sheet->vertex_count)
                stream->failed = true;
            if (k > 0 && attachments->source[s][k - 1] == SHELL_NONE) stream->failed = true;
        }
    for (uint32_t v = 0; v < shell->vertex_count; v++) // infinity is out of reach
        for (int k = 0; k < ATTACH_SOURCES; k++)
            if (!(attachments->length[v][k] >= 0) || !(attachments->goal[v][k] >= 0)) stream->failed = true;
    if (!isfinite(attachments->mass_burnt) || attachments->split_count > shell->split_count) stream->failed = true;
}

void attach_position(Attachments *attachments, const Shell *shell, const DynamicsState *dynamics) {
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const uint32_t *source = attachments->source[s];
        AttachSpread *spread = &attachments->spread[s];
        *spread = (AttachSpread){0};

        // positions, distances, and their ratios to the lengths of the sheet between the sources
        for (int p = 0; p < ATTACH_SOURCES && source[p] != SHELL_NONE; p++, spread->count++) {
            const Float3 position = float3_load(dynamics->position[source[p]]);
            float3_store(spread->position[p], position);
            for (int q = 0; q < p; q++) {
                float apart = float3_length(float3_sub(position, float3_load(spread->position[q])));
                spread->apart[p][q] = apart;
                spread->ratio[p][q] = apart / attachments->length[source[p]][q];
                spread->max = float_max(spread->max, isfinite(spread->ratio[p][q]) ? spread->ratio[p][q] : 0);
                // sources held at their own distance are not pulled apart
                spread->tight |= spread->ratio[p][q] > ATTACH_TIGHT;
                if (shell->spare_count > 0) spread->ratio[p][q] = float_max(spread->ratio[p][q] / ATTACH_EASE, 1);
            }
        }

        // springs take over evenly in the logarithm of the share
        const float beyond = (spread->max - ATTACH_EASE) / (ATTACH_LOOSE - ATTACH_EASE);
        const bool eases = shell->spare_count > 0 && beyond > 0;
        spread->share = eases ? real_expf(-9 * beyond) : 1;
        spread->gives = eases || spread->tight;
        if (attach_rests(shell, spread)) spread->count = 0;
    }
}

void attach_range(const Attachments *attachments, const Shell *shell, AttachHold *hold, DynamicsState *dynamics,
                  int begin, int end) {
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const AttachSpread *spread = &attachments->spread[s];
        int first = (int)shell->sheets[s].vertex_first, last = first + (int)shell->sheets[s].vertex_count;
        first = first > begin ? first : begin;
        last = last < end ? last : end;
        if (spread->count == 0 || first >= last) continue;

        int whole = (last - first) / ATTACH_BLOCK * ATTACH_BLOCK, rest = first + whole;
        hold(spread, attachments->length[first], dynamics->position[first], whole);
        attach_hold_plain(spread, attachments->length[rest], dynamics->position[rest], last - rest);
    }
}

typedef struct Attach {
    const Attachments *attachments;
    const Shell *shell;
    AttachHold *hold;
    DynamicsState *dynamics;
} Attach;

static void attach_task(void *task, int begin, int end) {
    const Attach *job = task;
    attach_range(job->attachments, job->shell, job->hold, job->dynamics, begin, end);
}

void attach_project(Attachments *attachments, const Shell *shell, AttachHold *hold, Pool *pool,
                    DynamicsState *dynamics) {
    attach_position(attachments, shell, dynamics);
    Attach job = {attachments, shell, hold, dynamics};
    pool_for(pool, (int)shell->vertex_count, POOL_GRAIN, attach_task, &job);
}
