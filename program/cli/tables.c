// Numbers are printed by printf: the program never calls setlocale, so the decimal point is a point.
#include "cli/tables.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/text.h"
#include "common/store.h"
#include "formats/formats.h"

static const char *const headers[TABLE_COUNT] = {
    [TABLE_STATS] =
        "frame,time,particles,springs,triangles,pieces,mass,burnt_fraction,temperature_max,heat_in,heat_lost,"
        "heat_of_combustion,heat_stored,ledger_error,strain_mean,strain_p99,strain_max,inverted_cells,ms_heat,ms_burn,"
        "ms_ablate,ms_dynamics,ms_gas,ms_output,speed_rms_unburnt,mass_ledger_error,ignited,holes_opened,pieces_freed,"
        "front_speed,triangles_fine,ms_surface,tears,contact_halts,arrival_error,arrival_missed,pace,water,ms_contact,"
        "energy_kinetic,energy_elastic,energy_gravity,energy_lost\n",
    [TABLE_PROBES] =
        "frame,time,probe,sheet,there,x,y,z,temperature,temperature_peak,mass,burn_rate,time_ignited,piece\n",
    [TABLE_EVENTS] = "frame,time,event,element,x,y,z,u,v\n",
};

const char *tables_unit(const char *column) {
    static const struct {
        const char *begins, *unit;
    } units[] = {
        {"time", "s"},          {"mass_ledger", ""}, {"mass", "kg"},    {"temperature_", "K"},
        {"heat_", "J"},         {"ms_", "ms"},       {"speed_", "m/s"}, {"front_speed", "m/s of the fire's time"},
        {"arrival_error", "s"}, {"water", "kg"},     {"energy_", "J"}};

    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strncmp(column, units[i].begins, strlen(units[i].begins)) == 0) return units[i].unit;
    return "";
}

static SingeResult tables_no_memory(SingeError *error) {
    return refuse(error, SINGE_ERROR_MEMORY, "output", -1, "out of memory");
}

// ---- files of lines

static void lines_close(LineFile *file) {
    if (file->fd >= 0) close(file->fd);
    file->fd = -1;
}

/// Appends whole lines; if they do not fit on the disk, none is left.
static SingeResult lines_append(LineFile *file, const char *text, size_t size, SingeError *error) {
    for (size_t done = 0; done < size;) {
        ssize_t n = write(file->fd, text + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            int reason = n < 0 ? errno : ENOSPC;
            if (ftruncate(file->fd, (off_t)file->size) != 0) return folder_fail(file->path, "cut", errno, error);
            return folder_fail(file->path, "write", reason, error);
        }

        done += (size_t)n;
    }

    file->size += (int64_t)size;
    return SINGE_OK;
}

/// The lines of a table behind its header, at a frame.
typedef struct Extent {
    const char *header;
    uint64_t lines;
    uint32_t per_frame; ///< if not 0, each line begins with its frame, and a frame has that many
    char what[80];      ///< for messages: "frames 1 to 12"
} Extent;

static bool is_asked(int table, const Scene *scene) {
    return table == TABLE_PROBES ? scene->probe_count > 0 : table == TABLE_EVENTS ? scene->output.events : true;
}

static Extent extent_at(int table, const Scene *scene, int frames, const Totals *totals) {
    Extent extent = {.header = headers[table], .per_frame = table == TABLE_PROBES ? scene->probe_count : 1};
    extent.lines = (uint64_t)frames * extent.per_frame;
    snprintf(extent.what, sizeof extent.what, "frames 1 to %d", frames);
    if (table != TABLE_EVENTS) return extent;

    extent.per_frame = 0;
    extent.lines = totals->ignited + totals->holes_opened + totals->pieces_freed;
    snprintf(extent.what, sizeof extent.what, "the %" PRIu64 " events up to frame %d", extent.lines, frames);
    return extent;
}

static const char *table_path(const Folder *folder, int table) {
    return table == TABLE_STATS ? folder->stats : table == TABLE_PROBES ? folder->probes : folder->events;
}

/// Reads a file and checks that it has these lines, which take *size bytes.
static SingeResult lines_read(const char *path, const Extent *extent, Bytes *bytes, size_t *size, SingeError *error) {
    TRY(file_read(path, (SingeAllocator){0}, bytes, error));

    size_t at = strlen(extent->header);
    bool good = bytes->size >= at && memcmp(bytes->data, extent->header, at) == 0;
    for (uint64_t i = 0; good && i < extent->lines; i++) {
        const char *line = (const char *)bytes->data + at, *end = memchr(line, '\n', bytes->size - at);
        char number[24] = "";
        if (extent->per_frame) snprintf(number, sizeof number, "%" PRIu64 ",", i / extent->per_frame + 1);
        good = end && (size_t)(end - line) >= strlen(number) && memcmp(line, number, strlen(number)) == 0;
        if (good) at += (size_t)(end - line) + 1;
    }

    *size = at;
    if (good) return SINGE_OK;

    bytes_free(bytes);
    return refuse(error, SINGE_ERROR_FORMAT, "resume", -1,
                  "%.200s lacks %s, which the checkpoint needs; run without --resume to start over", path,
                  extent->what);
}

// ---- the three tables

SingeResult tables_open(Tables *tables, const Folder *folder, const Scene *scene, const SceneAssets *assets,
                        SingeError *error) {
    *tables = (Tables)TABLES_CLOSED;
    tables->scene = scene;
    tables->assets = assets;
    for (int i = 0; i < TABLE_COUNT; i++) {
        if (!is_asked(i, scene)) continue;

        // without O_NONBLOCK a named pipe would wait here for its reader
        const int flags = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
        LineFile *file = &tables->files[i];
        struct stat info;

        file->path = table_path(folder, i);
        file->fd = open(file->path, flags, 0666);
        if (file->fd < 0) return folder_fail(file->path, "write", errno == ENXIO ? 0 : errno, error);
        if (fstat(file->fd, &info) == 0 && S_ISREG(info.st_mode)) continue;

        lines_close(file);
        return folder_fail(file->path, "write", 0, error);
    }

    return SINGE_OK;
}

SingeResult tables_begin(Tables *tables, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int i = 0; i < TABLE_COUNT && !result; i++) {
        LineFile *file = &tables->files[i];
        if (file->fd < 0) continue;
        file->size = 0;
        result = ftruncate(file->fd, 0) != 0 ? folder_fail(file->path, "write", errno, error)
                                             : lines_append(file, headers[i], strlen(headers[i]), error);
    }

    return result;
}

SingeResult tables_cut(Tables *tables, int frames, const Totals *totals, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int i = 0; i < TABLE_COUNT && !result; i++) {
        LineFile *file = &tables->files[i];
        const Extent extent = extent_at(i, tables->scene, frames, totals);
        Bytes bytes = {0};
        size_t size = 0;
        if (file->fd < 0) continue;

        result = lines_read(file->path, &extent, &bytes, &size, error);
        if (result) break;
        bytes_free(&bytes);
        file->size = (int64_t)size;
        if (ftruncate(file->fd, (off_t)size) != 0) result = folder_fail(file->path, "cut", errno, error);
    }

    return result;
}

SingeResult tables_copy(const Folder *from, const Folder *to, const Scene *scene, int frames, const Totals *totals,
                        SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int i = 0; i < TABLE_COUNT && !result; i++) {
        const Extent extent = extent_at(i, scene, frames, totals);
        Bytes bytes = {0};
        size_t size;
        if (!is_asked(i, scene)) continue;
        result = lines_read(table_path(from, i), &extent, &bytes, &size, error);
        if (result) break;
        if (to) result = file_write(table_path(to, i), bytes.data, size, error);
        bytes_free(&bytes);
    }

    return result;
}

SingeResult tables_sync(Tables *tables, SingeError *error) {
    SingeResult result = SINGE_OK;
    for (int i = 0; i < TABLE_COUNT && !result; i++) {
        const LineFile *file = &tables->files[i];
        if (file->fd < 0 || fsync(file->fd) == 0 || errno == EINVAL || errno == ENOTSUP) continue;
        result = folder_fail(file->path, "write", errno, error); // EINVAL: the file system cannot flush
    }

    return result;
}

void tables_close(Tables *tables) {
    for (int i = 0; i < TABLE_COUNT; i++) lines_close(&tables->files[i]);
    store_free((SingeAllocator){0}, tables->held, tables->held_capacity, sizeof *tables->held);
    free(tables->lines);
    *tables = (Tables)TABLES_CLOSED;
}

// ---- events

SingeResult tables_take_step(Tables *tables, const SingeSim *sim, SingeError *error) {
    size_t count;
    const SingeEvent *events = singe_sim_events(sim, &count);
    if (tables->files[TABLE_EVENTS].fd < 0 || !count) return SINGE_OK;
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

/// Writes the first of the held events, and drops them.
static SingeResult write_events(Tables *tables, size_t count, int frame, SingeError *error) {
    static const char *const names[] = {
        [SINGE_EVENT_IGNITED] = "ignited", [SINGE_EVENT_HOLE_OPENED] = "hole", [SINGE_EVENT_PIECE_FREED] = "piece"};
    char *text = NULL;
    size_t size = 0;
    if (!count) return SINGE_OK;

    FILE *file = open_memstream(&text, &size);
    for (size_t i = 0; file && i < count; i++) {
        const SingeEvent *e = &tables->held[i].event;
        const float *uv = tables->held[i].uv;
        fprintf(file, "%d,%.9g,%s,%" PRId32 ",%.9g,%.9g,%.9g,", frame, e->time, names[e->kind], e->element,
                (double)e->position[0], (double)e->position[1], (double)e->position[2]);
        if (e->kind == SINGE_EVENT_PIECE_FREED) fputs(",\n", file);
        else fprintf(file, "%.9g,%.9g\n", (double)uv[0], (double)uv[1]);
    }

    SingeResult result = text_stream_end(file, &text) ? lines_append(&tables->files[TABLE_EVENTS], text, size, error)
                                                      : tables_no_memory(error);
    free(text);

    tables->held_count -= count;
    memmove(tables->held, tables->held + count, tables->held_count * sizeof *tables->held);
    return result;
}

SingeResult tables_write_steps(Tables *tables, int frame, SingeError *error) {
    return write_events(tables, tables->held_count, frame, error);
}

// ---- frames

/// A value at a probe, from the corners of its cell.
static double weighted(const SceneProbePoint *point, const uint32_t corner[4], const float *values, size_t stride) {
    double sum = 0;
    for (int i = 0; i < 4; i++) sum += point->weight[i] * (double)values[stride * corner[i]];
    return sum;
}

/// The line of a probe at the current time.
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

    // when the fire arrived, between corners that it has reached; -1 before
    const uint32_t *corner = view->cells[point->cell];
    double ignited = weighted(point, corner, view->time_ignited, 1);
    for (int i = 0; i < 4; i++)
        if (point->weight[i] > 0 && view->time_ignited[corner[i]] < 0) ignited = -1;

    for (int c = 0; c < 3; c++) fprintf(file, "%.9g,", weighted(point, corner, &view->position[0][c], 4));
    fprintf(file, "%.9g,%.9g,%.9g,%.9g,%.9g,%" PRId32 "\n", weighted(point, corner, view->temperature, 1),
            weighted(point, corner, view->temperature_peak, 1), weighted(point, corner, view->mass, 1),
            weighted(point, corner, view->burn_rate, 1), ignited, view->piece[view->vertex_count + point->cell]);
}

SingeResult tables_take_frame(Tables *tables, const SingeSim *sim, int frame, SingeError *error) {
    tables->due = tables->held_count;
    free(tables->lines);
    tables->lines = NULL;
    if (tables->files[TABLE_PROBES].fd < 0) return SINGE_OK;

    const SingeView view = singe_sim_view(sim);
    size_t size = 0;
    FILE *file = open_memstream(&tables->lines, &size);
    for (uint32_t i = 0; file && i < tables->scene->probe_count; i++)
        put_probe(file, &view, &tables->scene->probes[i], &tables->assets->probes[i], frame);
    return text_stream_end(file, &tables->lines) ? SINGE_OK : tables_no_memory(error);
}

SingeResult tables_write_frame(Tables *tables, int frame, const SingeStats *s, const Totals *totals,
                               const FrameCost *cost, SingeError *error) {
    SingeResult result = write_events(tables, tables->due, frame, error);
    tables->due = 0;
    if (!result && tables->lines)
        result = lines_append(&tables->files[TABLE_PROBES], tables->lines, strlen(tables->lines), error);
    free(tables->lines);
    tables->lines = NULL;
    if (result) return result;

    char line[1024];
    int length = snprintf(
        line, sizeof line,
        "%d,%.9g,%" PRIu32 ",%" PRIu32 ",%" PRIu64 ",%" PRIu32
        ",%.9g,%.9g,%.7g,%.9g,%.9g,%.9g,%.9g,%.4g,%.6g,%.6g,%.6g,%" PRIu32
        ",%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.6g,%.4g,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.6g,%" PRIu64 ",%.3f,%" PRIu32
        ",%" PRIu64 ",%.6g,%" PRIu32 ",%.6g,%.9g,%.3f,%.6g,%.6g,%.6g,%.6g\n",
        frame, s->time, s->particles, s->springs, cost->triangles, s->pieces, s->mass, s->burnt_fraction,
        (double)s->temperature_max, s->heat_in, s->heat_lost, s->heat_of_combustion, s->heat_stored, s->ledger_error,
        s->strain_mean, s->strain_p99, s->strain_max, s->inverted_cells, cost->stage[SINGE_STAGE_HEAT],
        cost->stage[SINGE_STAGE_BURN], cost->stage[SINGE_STAGE_ABLATE], cost->stage[SINGE_STAGE_DYNAMICS],
        cost->stage[SINGE_STAGE_GAS], cost->output, s->speed_rms_unburnt, s->mass_ledger_error, totals->ignited,
        totals->holes_opened, totals->pieces_freed, s->front_speed, cost->fine_triangles, cost->surface, s->tears,
        totals->contact_halts, s->arrival_error, s->arrival_missed, (double)s->pace, s->water, cost->contact,
        s->energy_kinetic, s->energy_elastic, s->energy_gravity, s->energy_lost);
    return lines_append(&tables->files[TABLE_STATS], line, (size_t)length, error);
}
