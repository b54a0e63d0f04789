// Numbers are printed by printf: the program never calls setlocale, so the decimal point is a point.
#include "cli/stats_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char stats_header[] =
    "frame,time,particles,springs,triangles,pieces,mass,burnt_fraction,temperature_max,heat_in,heat_lost,"
    "heat_of_combustion,heat_stored,ledger_error,strain_mean,strain_p99,strain_max,inverted_cells,ms_heat,ms_burn,"
    "ms_ablate,ms_dynamics,ms_gas,ms_output,speed_rms_unburnt,mass_ledger_error,ignited,holes_opened,pieces_freed,"
    "front_speed,triangles_fine,ms_surface,tears\n";

/// A line begins with its frame.
static bool is_frame(uint64_t line, const char *text, size_t size, void *context) {
    (void)context;
    char number[24];
    const size_t length = (size_t)snprintf(number, sizeof number, "%" PRIu64 ",", line + 1);
    return size >= length && memcmp(text, number, length) == 0;
}

SingeResult stats_cut(LineFile *file, int frames_kept, SingeError *error) {
    char what[40];
    snprintf(what, sizeof what, "frames 1 to %d", frames_kept);
    return lines_cut(file, stats_header, (uint64_t)frames_kept, is_frame, NULL, what, error);
}

SingeResult stats_begin(LineFile *file, SingeError *error) { return lines_begin(file, stats_header, error); }

SingeResult stats_write(LineFile *file, int frame, const SingeStats *s, const Totals *totals, const FrameCost *cost,
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
        cost->stage[SINGE_STAGE_GAS], cost->output, s->speed_rms_unburnt, s->mass_ledger_error, totals->ignited,
        totals->holes_opened, totals->pieces_freed, s->front_speed, cost->fine_triangles, cost->surface, s->tears);
    return lines_append(file, line, (size_t)length, error);
}
