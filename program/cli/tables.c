// Numbers are printed by printf: the program never calls setlocale, so the decimal point is a point.
#include "cli/tables.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/text.h"
#include "common/store.h"

/// The columns of stats.csv: COLUMN(name, unit, printf's format, value), of the frame, its statistics `s`, its `cost` and
/// the `totals` so far. Whole numbers are exact as doubles.
#define STATS_COLUMNS(COLUMN)                                             \
    COLUMN(frame, "", "%.0f", frame)                                      \
    COLUMN(time, "s", "%.9g", s->time)                                    \
    COLUMN(particles, "", "%.0f", s->particles)                           \
    COLUMN(springs, "", "%.0f", s->springs)                               \
    COLUMN(triangles, "", "%.0f", cost->triangles)                        \
    COLUMN(pieces, "", "%.0f", s->pieces)                                 \
    COLUMN(mass, "kg", "%.9g", s->mass)                                   \
    COLUMN(burnt_fraction, "", "%.9g", s->burnt_fraction)                 \
    COLUMN(temperature_max, "K", "%.7g", s->temperature_max)              \
    COLUMN(heat_in, "J", "%.9g", s->heat_in)                              \
    COLUMN(heat_lost, "J", "%.9g", s->heat_lost)                          \
    COLUMN(heat_of_combustion, "J", "%.9g", s->heat_of_combustion)        \
    COLUMN(heat_stored, "J", "%.9g", s->heat_stored)                      \
    COLUMN(ledger_error, "", "%.4g", s->ledger_error)                     \
    COLUMN(strain_mean, "", "%.6g", s->strain_mean)                       \
    COLUMN(strain_p99, "", "%.6g", s->strain_p99)                         \
    COLUMN(strain_max, "", "%.6g", s->strain_max)                         \
    COLUMN(inverted_cells, "", "%.0f", s->inverted_cells)                 \
    COLUMN(ms_heat, "ms", "%.3f", cost->stage[SINGE_STAGE_HEAT])          \
    COLUMN(ms_burn, "ms", "%.3f", cost->stage[SINGE_STAGE_BURN])          \
    COLUMN(ms_ablate, "ms", "%.3f", cost->stage[SINGE_STAGE_ABLATE])      \
    COLUMN(ms_dynamics, "ms", "%.3f", cost->stage[SINGE_STAGE_DYNAMICS])  \
    COLUMN(ms_gas, "ms", "%.3f", cost->stage[SINGE_STAGE_GAS])            \
    COLUMN(ms_output, "ms", "%.3f", cost->output)                         \
    COLUMN(speed_rms_unburnt, "m/s", "%.6g", s->speed_rms_unburnt)        \
    COLUMN(mass_ledger_error, "", "%.4g", s->mass_ledger_error)           \
    COLUMN(ignited, "", "%.0f", totals->ignited)                          \
    COLUMN(holes_opened, "", "%.0f", totals->holes_opened)                \
    COLUMN(pieces_freed, "", "%.0f", totals->pieces_freed)                \
    COLUMN(front_speed, "m/s of the fire's time", "%.6g", s->front_speed) \
    COLUMN(triangles_fine, "", "%.0f", cost->fine_triangles)              \
    COLUMN(ms_surface, "ms", "%.3f", cost->surface)                       \
    COLUMN(tears, "", "%.0f", s->tears)                                   \
    COLUMN(contact_halts, "", "%.0f", totals->contact_halts)              \
    COLUMN(arrival_error, "s", "%.6g", s->arrival_error)                  \
    COLUMN(arrival_missed, "", "%.0f", s->arrival_missed)                 \
    COLUMN(pace, "", "%.6g", s->pace)                                     \
    COLUMN(water, "kg", "%.9g", s->water)                                 \
    COLUMN(ms_contact, "ms", "%.3f", cost->contact)                       \
    COLUMN(energy_kinetic, "J", "%.6g", s->energy_kinetic)                \
    COLUMN(energy_elastic, "J", "%.6g", s->energy_elastic)                \
    COLUMN(energy_gravity, "J", "%.6g", s->energy_gravity)                \
    COLUMN(energy_lost, "J", "%.6g", s->energy_lost)

static const struct {
    const char *name, *unit, *format;
} stats_columns[] = {
#define AS_COLUMN(name, unit, format, value) {#name, unit, "," format},
    STATS_COLUMNS(AS_COLUMN)};
enum { STATS = sizeof stats_columns / sizeof *stats_columns };

#define AS_HEADER(name, ...) "," #name
static const char *const headers[TABLE_COUNT] = {
    [TABLE_STATS] = &(STATS_COLUMNS(AS_HEADER) "\n")[1],
    [TABLE_PROBES] =
        "frame,time,probe,sheet,there,x,y,z,temperature,temperature_peak,mass,burn_rate,time_ignited,piece\n",
    [TABLE_EVENTS] = "frame,time,event,element,x,y,z,u,v\n",
};

const char *tables_unit(const char *column) {
    for (int i = 0; i < STATS; i++)
        if (strcmp(column, stats_columns[i].name) == 0) return stats_columns[i].unit;
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

#define AS_VALUE(name, unit, format, value) (double)(value),
    const double values[STATS] = {STATS_COLUMNS(AS_VALUE)};
    char line[24 * STATS];
    int length = 0;
    for (int i = 0; i < STATS; i++)
        length += snprintf(line + length, sizeof line - (size_t)length, stats_columns[i].format + !i, values[i]);
    line[length++] = '\n';
    return lines_append(&tables->files[TABLE_STATS], line, (size_t)length, error);
}
