// Long-range attachments (Kim, Chentanez and Mueller-Fischer, Long range attachments, 2012). On an inextensible
// sheet the distance in space between two vertices never exceeds the geodesic distance L along the sheet. For
// every vertex i and held vertex p, where |x_i - x_p| > L_ip,
//
//   x_i <- x_p + (x_i - x_p) L_ip / |x_i - x_p|.
//
// A strand passes a pull on only to the other end of itself within a projection, so that on a fine sheet most of
// the load at a pin would be carried by stretch; these carry it at once. Centres lie off the mesh, farther away on
// the outside of a bend: they are not attached, or a sheet would not bend.
//
// Sources are up to ATTACH_SOURCES held vertices of a sheet, each as far as possible from those before it. Ways lead
// over cells that have not begun to burn: char shrinks and stretches, and a length that grows shorter would jerk
// what hangs on it. So lengths only ever grow, as the fire cuts ways off; they are measured again from time to time.
// What has come free of a source is let go at once. A sheet whose mesh may stretch by its compliance has none.
#include "dynamics/attach.h"

#include "base/quad.h"
#include "base/vec.h"

/// Steps between two measurements while a sheet burns: a search costs as much as several steps.
enum { ATTACH_PERIOD = 32 };

/// Of a source that is not held any more: no particle's.
enum { ATTACH_NO_PIECE = -2 };

bool attach_create(Memory *memory, const Shell *shell, Attachments *attachments) {
    *attachments = (Attachments){0};
    bool done = NEW(memory, attachments->source, shell->sheet_count) &&
                NEW(memory, attachments->spread, shell->sheet_count) &&
                NEW(memory, attachments->length, shell->vertex_count) &&
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
    FREE(memory, attachments->distance, shell->vertex_count);
    geodesic_free(memory, shell->vertex_count, &attachments->search);
}

static bool attach_may_hold(const State *state, uint32_t v) {
    return state->dynamics.pinned[v] && (state->ablate.particle_flags[v] & SINGE_ALIVE);
}

/// The held vertex that is farthest, at rest, from the sources found so far; the first one for none. None where it is
/// nearer than a tenth of the way between the first two: it would hardly hold anything else.
static uint32_t attach_farthest(const Shell *shell, const State *state, const Sheet *sheet, const uint32_t *source,
                                int count) {
    uint32_t farthest = SHELL_NONE;
    float most = 0;
    for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++) {
        if (!attach_may_hold(state, v)) continue;
        float nearest = INFINITY;
        for (int k = 0; k < count; k++) {
            Vec way = vec_sub(vec_load(shell->rest_position[v]), vec_load(shell->rest_position[source[k]]));
            nearest = fminf(nearest, vec_dot(way, way));
        }
        if (nearest > most) farthest = v, most = nearest;
    }
    if (count < 2 || farthest == SHELL_NONE) return farthest;
    Vec first = vec_sub(vec_load(shell->rest_position[source[1]]), vec_load(shell->rest_position[source[0]]));
    return most < 0.01f * vec_dot(first, first) ? SHELL_NONE : farthest;
}

/// Whether nothing in a sheet's mesh may stretch.
static bool attach_is_inextensible(const Shell *shell, const Sheet *sheet) {
    for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++)
        if (field_at(shell->matter.compliance[SINGE_BLUE], v) > 0) return false;
    return true;
}

static void attach_measure(Attachments *attachments, const Shell *shell, const State *state) {
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        uint32_t *source = attachments->source[s];
        bool more = attach_is_inextensible(shell, sheet);
        for (int k = 0; k < ATTACH_SOURCES; k++) {
            source[k] = more ? attach_farthest(shell, state, sheet, source, k) : SHELL_NONE;
            more = source[k] != SHELL_NONE;
            if (!more) continue;
            geodesic_from(&attachments->search, shell, &state->burn, &state->ablate, source[k], sheet->vertex_first,
                          sheet->vertex_first + sheet->vertex_count, attachments->distance);
            for (uint32_t v = sheet->vertex_first; v < sheet->vertex_first + sheet->vertex_count; v++)
                attachments->length[v][k] = attachments->distance[v];
        }
    }
}

void attach_update(Attachments *attachments, const Shell *shell, const State *state, bool pins_changed) {
    bool changed = attachments->topology != state->ablate.topology_version ||
                   attachments->mass_burnt != state->burn.mass_burnt;
    if (!pins_changed && !(changed && (state->step + 1) % ATTACH_PERIOD == 0)) return;
    attach_measure(attachments, shell, state);
    attachments->topology = state->ablate.topology_version;
    attachments->mass_burnt = state->burn.mass_burnt;
}

void attach_stream(Attachments *attachments, const Shell *shell, Stream *stream) {
    STREAM(stream, attachments->topology);
    STREAM(stream, attachments->mass_burnt);
    stream_data(stream, attachments->source, shell->sheet_count * sizeof *attachments->source);
    stream_data(stream, attachments->length, shell->vertex_count * sizeof *attachments->length);
    for (uint32_t s = 0; stream->mode == STREAM_READ && s < shell->sheet_count; s++)
        for (int k = 0; k < ATTACH_SOURCES; k++) {
            uint32_t source = attachments->source[s][k];
            stream->failed |= source != SHELL_NONE && source >= shell->vertex_count;
        }
}

/// Where a sheet's sources are now, how far apart, and how that compares with what the sheet reaches between them.
static void attach_spread(const Attachments *attachments, const AblateState *ablate, const float (*position)[4],
                          const uint32_t *source, AttachSpread *spread) {
    *spread = (AttachSpread){0};
    for (int p = 0; p < ATTACH_SOURCES && source[p] != SHELL_NONE; p++, spread->count++) {
        bool held = position[source[p]][3] == 0;
        spread->piece[p] = held ? ablate->piece[source[p]] : ATTACH_NO_PIECE;
        vec_store(spread->place[p], vec_load(position[source[p]]));
        for (int q = 0; q < p; q++) {
            float apart = vec_length(vec_sub(vec_load(spread->place[p]), vec_load(spread->place[q])));
            spread->apart[p][q] = apart;
            spread->ratio[p][q] = apart / attachments->length[source[p]][q];
            spread->tight |= spread->ratio[p][q] > 1.001f; // what is held at its own distance is not pulled apart
        }
    }
}

/// Where sources p and q are farther apart than the sheet between them, by the ratio f, no place satisfies both
/// spheres of what lies near the line between them: there both lengths grow, as if the sheet were stretched, by at
/// most f and so far that the spheres overlap by a margin. `length` is by source, of four particles.
static void attach_stretch(const AttachSpread *spread, Quad length[ATTACH_SOURCES]) {
    const float margin = 1.15f;
    Quad factor[ATTACH_SOURCES];
    for (int p = 0; p < spread->count; p++) factor[p] = quad_all(1);
    for (int p = 0; p < spread->count; p++)
        for (int q = 0; q < p; q++) {
            Quad enough = margin * spread->apart[p][q] / (length[p] + length[q]);
            enough = quad_min(enough, quad_all(spread->ratio[p][q]));
            factor[p] = quad_max(factor[p], enough);
            factor[q] = quad_max(factor[q], enough);
        }
    for (int p = 0; p < spread->count; p++) length[p] *= factor[p];
}

typedef struct Attach {
    const Attachments *attachments;
    const Shell *shell;
    const int32_t *piece;
    float (*position)[4];
} Attach;

/// Up to four particles, source after source, without branches.
static void attach_four(const Attach *job, const AttachSpread *spread, int first, int count) {
    float *position = job->position[first];
    Quad x[4] = {{0}}, length[4] = {{0}}; // by particle, then by coordinate and by source
    int32_t pieces[4] = {0};
    for (int i = 0; i < count; i++) {
        x[i] = quad_load(position + 4 * i);
        length[i] = quad_load(job->attachments->length[first + i]);
        pieces[i] = job->piece[first + i];
    }
    quad_transpose(x);
    quad_transpose(length);
    if (spread->tight) attach_stretch(spread, length);
    QuadMask piece = quad_load_ints(pieces), free = x[3] > 0;
    for (int k = 0; k < spread->count; k++) {
        const float *anchor = spread->place[k];
        Quad dx = x[0] - anchor[0], dy = x[1] - anchor[1], dz = x[2] - anchor[2];
        Quad square = dx * dx + dy * dy + dz * dz, most = length[k] * length[k];
        QuadMask far = (square > most) & free & (piece == spread->piece[k]);
        Quad factor = quad_sqrt(quad_select(far, most / square, quad_all(1)));
        x[0] = quad_select(far, anchor[0] + dx * factor, x[0]);
        x[1] = quad_select(far, anchor[1] + dy * factor, x[1]);
        x[2] = quad_select(far, anchor[2] + dz * factor, x[2]);
    }
    quad_transpose(x);
    for (int i = 0; i < count; i++) quad_store(position + 4 * i, x[i]);
}

static void attach_range(void *task, int begin, int end) {
    const Attach *job = task;
    const Shell *shell = job->shell;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        const Sheet *sheet = &shell->sheets[s];
        const AttachSpread *spread = &job->attachments->spread[s];
        if (spread->count == 0) continue;
        int first = (int)sheet->vertex_first, last = first + (int)sheet->vertex_count;
        int i = first > begin ? first : begin, stop = last < end ? last : end;
        for (; i < stop; i += 4) attach_four(job, spread, i, stop - i < 4 ? stop - i : 4);
    }
}

void attach_project(Attachments *attachments, const Shell *shell, const AblateState *ablate, Pool *pool,
                    DynamicsState *dynamics) {
    bool any = false;
    for (uint32_t s = 0; s < shell->sheet_count; s++) {
        attach_spread(attachments, ablate, (const float(*)[4])dynamics->position, attachments->source[s],
                      &attachments->spread[s]);
        any |= attachments->spread[s].count > 0;
    }
    if (!any) return;
    Attach job = {attachments, shell, ablate->piece, dynamics->position};
    pool_for(pool, (int)shell->vertex_count, POOL_BLOCK, attach_range, &job);
}
