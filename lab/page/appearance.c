#include "page/appearance.h"

#include <math.h>

#include "common/store.h"

enum { RIM_NEAR = 3 }; ///< bands: 4 mm

SingeResult look_take(Play *play, double cut, Look *look, SingeError *error) {
    TRY(play_surface(play, error));

    const SingeView view = singe_sim_view(play->sim);
    const SingeStats stats = singe_sim_stats(play->sim);
    const SingeTimers timers = singe_sim_timers(play->sim);
    double seconds = 0;
    for (int s = 0; s < SINGE_STAGE_COUNT; s++) seconds += timers.seconds[s];

    look->step_ms = timers.steps ? 1e3 * seconds / (double)timers.steps : 0;
    look->dynamics = timers.seconds[SINGE_STAGE_DYNAMICS] / fmax(seconds, 1e-9);
    look->heat = timers.seconds[SINGE_STAGE_HEAT] / fmax(seconds, 1e-9);
    look->strain_mean = fmax(look->strain_mean, stats.strain_mean);
    look->strain_p99 = fmax(look->strain_p99, stats.strain_p99);
    if (stats.cells) look->inverted = fmax(look->inverted, (double)stats.inverted_cells / stats.cells);

    look->bend = fmax(look->bend, shape_bend(&view));
    look->hottest = fmax(look->hottest, (double)stats.temperature_max);
    look->left = shape_left(&view);
    look->pieces = shape_pieces(&view, 0.05);
    look->border = shape_border(&play->surface);
    if (cut > 0) {
        // drops the triangles with at most this mean mass
        uint32_t kept = 0;
        for (uint32_t t = 0; t < play->surface.triangle_count; t++) {
            const uint32_t *c = play->surface.triangles[t];
            const double mass = ((double)play->surface.mass[c[0]] + (double)play->surface.mass[c[1]] +
                                 (double)play->surface.mass[c[2]]) /
                                3;
            if (mass > cut) memmove(play->surface.triangles[kept++], c, sizeof *play->surface.triangles);
        }

        play->surface.triangle_count = kept;
    }

    if (rim_add(&play->surface, &look->rim) && wrinkles_add(&play->surface, &look->wrinkles)) return SINGE_OK;
    return refuse(error, SINGE_ERROR_MEMORY, "", -1, "out of memory");
}

double look_curl(const Look *look, double share) { return rim_percentile(look->rim.curl, share); }

double look_slope(const Look *look, double share) {
    double slope[RIM_ANGLES] = {0};
    for (int b = 0; b < RIM_NEAR; b++)
        for (int a = 0; a < RIM_ANGLES; a++) slope[a] += look->rim.band[b].slope[a];
    return rim_percentile(slope, share);
}

double look_area(const Look *look) {
    double now = 0, rest = 0;
    for (int b = 0; b < RIM_NEAR; b++) now += look->rim.band[b].area, rest += look->rim.band[b].rest_area;
    return rest > 0 ? now / rest : (double)NAN;
}

double look_wrinkles(const Look *look) { return sqrt(wrinkles_burnt(&look->wrinkles)) * 180 / acos(-1); }
