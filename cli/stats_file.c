// Numbers are printed by printf: the program never calls setlocale, so the decimal point is a point.
#include "cli/stats_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "formats/formats.h"

static const char stats_header[] =
    "frame,time,particles,springs,triangles,pieces,mass,burnt_fraction,temperature_max,heat_in,heat_lost,"
    "heat_of_combustion,heat_stored,ledger_error,strain_mean,strain_p99,strain_max,inverted_cells,ms_heat,ms_burn,"
    "ms_ablate,ms_dynamics,ms_gas,ms_output,speed_rms_unburnt,mass_ledger_error,ignited,holes_opened,pieces_freed,"
    "front_speed,triangles_fine,ms_surface,tears\n";

static SingeResult append(StatsFile *file, const char *text, size_t size, SingeError *error) {
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

/// Bytes of the header and the lines of frames 1 to `frames`, or -1 when they are not all there.
static int64_t kept_size(const Bytes *bytes, int frames) {
    size_t header = sizeof stats_header - 1;
    if (bytes->size < header || memcmp(bytes->data, stats_header, header) != 0) return -1;
    size_t at = header;
    for (int frame = 1; frame <= frames; frame++) {
        char number[16];
        int length = snprintf(number, sizeof number, "%d,", frame);
        const char *line = (const char *)bytes->data + at;
        const char *end = memchr(line, '\n', bytes->size - at);
        if (!end || end - line < length || memcmp(line, number, (size_t)length) != 0) return -1;
        at += (size_t)(end - line) + 1;
    }
    return (int64_t)at;
}

SingeResult stats_cut(StatsFile *file, int frames_kept, SingeError *error) {
    Bytes bytes = {0};
    SingeResult result = file_read(file->path, (SingeAllocator){0}, &bytes, error);
    if (result) return result;
    file->size = kept_size(&bytes, frames_kept);
    bytes_free(&bytes);
    if (file->size < 0) {
        *error = (SingeError){.code = SINGE_ERROR_FORMAT, .stage = "resume", .element = -1};
        snprintf(error->message, sizeof error->message,
                 "%.200s does not hold frames 1 to %d of the checkpoint; run without --resume to start over",
                 file->path, frames_kept);
        return SINGE_ERROR_FORMAT;
    }
    if (ftruncate(file->fd, (off_t)file->size) != 0) return folder_fail(file->path, "cut", errno, error);
    return SINGE_OK;
}

SingeResult stats_open(StatsFile *file, const Folder *folder, SingeError *error) {
    struct stat info;
    // without O_NONBLOCK a named pipe would wait here for its reader
    int flags = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    *file = (StatsFile){.path = folder->stats, .fd = open(folder->stats, flags, 0666)};
    if (file->fd < 0) return folder_fail(file->path, "write", errno == ENXIO ? 0 : errno, error);
    if (fstat(file->fd, &info) == 0 && S_ISREG(info.st_mode)) return SINGE_OK;
    stats_close(file);
    return folder_fail(file->path, "write", 0, error);
}

SingeResult stats_begin(StatsFile *file, SingeError *error) {
    if (ftruncate(file->fd, 0) != 0) return folder_fail(file->path, "write", errno, error);
    file->size = 0;
    return append(file, stats_header, sizeof stats_header - 1, error);
}

SingeResult stats_write(StatsFile *file, int frame, const SingeStats *s, const Totals *totals, const FrameCost *cost,
                        SingeError *error) {
    char line[1024];
    int length = snprintf(
        line, sizeof line,
        "%d,%.9g,%" PRIu32 ",%" PRIu32 ",%" PRIu64 ",%" PRIu32
        ",%.9g,%.9g,%.7g,%.9g,%.9g,%.9g,%.9g,%.4g,%.6g,%.6g,%.6g,%" PRIu32
        ",%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.6g,%.4g,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.6g,%" PRIu64 ",%.3f,%" PRIu32
        "\n",
        frame, s->time, s->particles, s->springs, cost->triangles, s->pieces, s->mass, s->burnt_fraction,
        (double)s->temperature_max, s->heat_in, s->heat_lost, s->heat_of_combustion, s->heat_stored, s->ledger_error,
        s->strain_mean, s->strain_p99, s->strain_max, s->inverted_cells, cost->stage[SINGE_STAGE_HEAT],
        cost->stage[SINGE_STAGE_BURN], cost->stage[SINGE_STAGE_ABLATE], cost->stage[SINGE_STAGE_DYNAMICS],
        cost->stage[SINGE_STAGE_GAS], cost->output,
        s->speed_rms_unburnt, s->mass_ledger_error, totals->ignited, totals->holes_opened, totals->pieces_freed,
        s->front_speed, cost->fine_triangles, cost->surface, s->tears);
    return append(file, line, (size_t)length, error);
}

SingeResult stats_sync(StatsFile *file, SingeError *error) {
    // file systems that cannot flush say so by EINVAL
    if (fsync(file->fd) == 0 || errno == EINVAL || errno == ENOTSUP) return SINGE_OK;
    return folder_fail(file->path, "write", errno, error);
}

void stats_close(StatsFile *file) {
    if (file->fd >= 0) close(file->fd);
    file->fd = -1;
}
