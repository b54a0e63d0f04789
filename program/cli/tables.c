#include "cli/tables.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text.h"
#include "common/store.h"

static const char events_header[] = "frame,time,event,element,x,y,z,u,v\n";
static const char probes_header[] =
    "frame,time,probe,sheet,there,x,y,z,temperature,temperature_peak,mass,burn_rate,time_ignited,piece\n";

static SingeResult tables_no_memory(SingeError *error) {
    *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "output", .element = -1};
    return SINGE_ERROR_MEMORY;
}

SingeResult tables_open(Tables *tables, const Folder *folder, const Scene *scene, const SceneAssets *assets,
                        SingeError *error) {
    *tables = (Tables)TABLES_CLOSED;
    tables->scene = scene;
    tables->assets = assets;
    SingeResult result = scene->output.events ? lines_open(&tables->events, folder->events, error) : SINGE_OK;
    if (!result && scene->probe_count) result = lines_open(&tables->probes, folder->probes, error);
    return result;
}

SingeResult tables_begin(Tables *tables, SingeError *error) {
    SingeResult result = tables->events.fd >= 0 ? lines_begin(&tables->events, events_header, error) : SINGE_OK;
    if (!result && tables->probes.fd >= 0) result = lines_begin(&tables->probes, probes_header, error);
    return result;
}

/// The lines of a frame are consecutive, one per probe.
static bool is_of_frame(uint64_t line, const char *text, size_t size, void *context) {
    const Tables *tables = context;
    char number[24];
    const size_t length =
        (size_t)snprintf(number, sizeof number, "%" PRIu64 ",", line / tables->scene->probe_count + 1);
    return size >= length && memcmp(text, number, length) == 0;
}

SingeResult tables_cut(Tables *tables, int frames, const Totals *totals, SingeError *error) {
    char what[80];
    SingeResult result = SINGE_OK;
    const uint64_t events = totals->ignited + totals->holes_opened + totals->pieces_freed;
    snprintf(what, sizeof what, "the %" PRIu64 " events up to frame %d", events, frames);
    if (tables->events.fd >= 0) result = lines_cut(&tables->events, events_header, events, NULL, NULL, what, error);
    snprintf(what, sizeof what, "frames 1 to %d", frames);
    if (!result && tables->probes.fd >= 0)
        result = lines_cut(&tables->probes, probes_header, (uint64_t)frames * tables->scene->probe_count, is_of_frame,
                           tables, what, error);
    return result;
}

// ---- events

SingeResult tables_take_step(Tables *tables, const SingeSim *sim, SingeError *error) {
    size_t count;
    const SingeEvent *events = singe_sim_events(sim, &count);
    if (tables->events.fd < 0 || !count) return SINGE_OK;
    if (!store_grow((SingeAllocator){0}, &tables->held, &tables->held_capacity, tables->held_count + count,
                    sizeof *tables->held))
        return tables_no_memory(error);
    const SingeView view = singe_sim_view(sim);
    for (size_t i = 0; i < count; i++) {
        HeldEvent *held = &tables->held[tables->held_count++];
        *held = (HeldEvent){.event = events[i]};
        if (events[i].kind != SINGE_EVENT_PIECE_FREED) memcpy(held->uv, view.uv[events[i].element], sizeof held->uv);
    }
    return SINGE_OK;
}

static void put_event(FILE *file, const HeldEvent *held, int frame) {
    static const char *const names[] = {
        [SINGE_EVENT_IGNITED] = "ignited", [SINGE_EVENT_HOLE_OPENED] = "hole", [SINGE_EVENT_PIECE_FREED] = "piece"};
    const SingeEvent *e = &held->event;
    fprintf(file, "%d,%.9g,%s,%" PRId32 ",%.9g,%.9g,%.9g,", frame, e->time, names[e->kind], e->element,
            (double)e->position[0], (double)e->position[1], (double)e->position[2]);
    if (e->kind == SINGE_EVENT_PIECE_FREED) fputs(",\n", file);
    else fprintf(file, "%.9g,%.9g\n", (double)held->uv[0], (double)held->uv[1]);
}

/// Writes the first of the held events, and drops them.
static SingeResult write_events(Tables *tables, size_t count, int frame, SingeError *error) {
    char *text = NULL;
    size_t size = 0;
    if (!count) return SINGE_OK;
    FILE *file = open_memstream(&text, &size);
    for (size_t i = 0; file && i < count; i++) put_event(file, &tables->held[i], frame);
    SingeResult result =
        text_stream_end(file, &text) ? lines_append(&tables->events, text, size, error) : tables_no_memory(error);
    free(text);
    tables->held_count -= count;
    memmove(tables->held, tables->held + count, tables->held_count * sizeof *tables->held);
    return result;
}

// ---- probes

static double weighted(const SceneProbePoint *point, const uint32_t corner[4], const float *values, size_t stride) {
    double sum = 0;
    for (int i = 0; i < 4; i++) sum += point->weight[i] * (double)values[stride * corner[i]];
    return sum;
}

/// Time at which the fire arrived, interpolated between corners that it has reached; -1 before.
static double ignited_at(const SceneProbePoint *point, const uint32_t corner[4], const float *times) {
    for (int i = 0; i < 4; i++)
        if (point->weight[i] > 0 && times[corner[i]] < 0) return -1;
    return weighted(point, corner, times, 1);
}

static void put_probe(FILE *file, const SingeView *view, const SceneProbe *probe, const SceneProbePoint *point,
                      int frame) {
    const bool there = view->cell_flags[point->cell] & SINGE_ALIVE;
    const char *quote = strchr(probe->name, ',') ? "\"" : ""; // names contain no quotes
    fprintf(file, "%d,%.9g,%s%s%s,%" PRIu32 ",%d,", frame, view->time, quote, probe->name, quote, probe->sheet_index,
            there);
    if (!there) {
        fputs(",,,,,,,,\n", file);
        return;
    }
    const uint32_t *corner = view->cells[point->cell];
    for (int c = 0; c < 3; c++) fprintf(file, "%.9g,", weighted(point, corner, &view->position[0][c], 4));
    fprintf(file, "%.9g,%.9g,%.9g,%.9g,%.9g,%" PRId32 "\n", weighted(point, corner, view->temperature, 1),
            weighted(point, corner, view->temperature_peak, 1), weighted(point, corner, view->mass, 1),
            weighted(point, corner, view->burn_rate, 1), ignited_at(point, corner, view->time_ignited),
            view->piece[view->vertex_count + point->cell]);
}

SingeResult tables_take_frame(Tables *tables, const SingeSim *sim, int frame, SingeError *error) {
    tables->due = tables->held_count;
    free(tables->lines);
    tables->lines = NULL;
    if (tables->probes.fd < 0) return SINGE_OK;
    const SingeView view = singe_sim_view(sim);
    size_t size = 0;
    FILE *file = open_memstream(&tables->lines, &size);
    for (uint32_t i = 0; file && i < tables->scene->probe_count; i++)
        put_probe(file, &view, &tables->scene->probes[i], &tables->assets->probes[i], frame);
    return text_stream_end(file, &tables->lines) ? SINGE_OK : tables_no_memory(error);
}

// ---- both

SingeResult tables_write_frame(Tables *tables, int frame, SingeError *error) {
    SingeResult result = write_events(tables, tables->due, frame, error);
    tables->due = 0;
    if (!result && tables->lines) result = lines_append(&tables->probes, tables->lines, strlen(tables->lines), error);
    free(tables->lines);
    tables->lines = NULL;
    return result;
}

SingeResult tables_write_steps(Tables *tables, int frame, SingeError *error) {
    return write_events(tables, tables->held_count, frame, error);
}

SingeResult tables_sync(Tables *tables, SingeError *error) {
    SingeResult result = tables->events.fd >= 0 ? lines_sync(&tables->events, error) : SINGE_OK;
    if (!result && tables->probes.fd >= 0) result = lines_sync(&tables->probes, error);
    return result;
}

void tables_close(Tables *tables) {
    lines_close(&tables->events);
    lines_close(&tables->probes);
    store_free((SingeAllocator){0}, tables->held, tables->held_capacity, sizeof *tables->held);
    free(tables->lines);
    *tables = (Tables)TABLES_CLOSED;
}
