// Textures of sections 5 and 8 without a figure of their own, heat and diffusivity, and section 8.2's claim about
// layers that may cross.
#include <math.h>

#include "page/appearance.h"
#include "paper/paper.h"
#include "page/lab.h"

// ---- a heat texture

SingeResult paper_heat(Lab *lab, SingeError *error) {
    static const double times[] = {0.3, 0.6, 1, 1.6};
    enum { SHOTS = sizeof times / sizeof *times, RUNS = 2 };
    double correlation[2] = {0}, burnt = 0;
    Look looks[RUNS] = {{.left = 0}};
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, 5);

    for (int plain = 0; plain < RUNS && !result; plain++) { // the second does not shrink
        Play play;
        const char *sets[] = {lab->quick ? "sheets.0.grid.cells=[30, 42]" : "",
                              plain ? "sheets.0.material.shrink_front=0" : "",
                              plain ? "sheets.0.material.shrink_back=0" : "", NULL};
        result = play_open(&play, lab, "heat.yaml", sets, error);
        const SingeTexture *picture = play.job.assets.source_textures;
        if (!result && !plain) texture_show(lab, picture);
        for (int i = 0; i < SHOTS && !result; i++) {
            result = plain ? play_until(&play, times[i], error) : play_shoot_at(&play, times[i], error);
            const SingeView view = play.sim ? singe_sim_view(play.sim) : (SingeView){0};
            for (int m = 0; m < 2 && i == 0 && !plain && !result; m++)
                correlation[m] = texture_correlation(&view, picture, m, view.temperature);
            if (!result && times[i] >= 1) result = look_take(&play, 0, &looks[plain], error);
            if (!result && !plain) burnt = singe_sim_stats(play.sim).burnt_fraction;
        }

        play_close(&play);
    }

    if (result) return result;
    report_text(lab->report, "%.0f %% has burnt after 1.6 s.", 100 * burnt);
    report_bar(lab->report, "correlation", "correlation of the texture with the temperature after 0.3 s",
               correlation[0], 0.9, 1, correlation[1], "with its mirror image");
    report_bar(lab->report, "curl", "curl of the rim over 10 mm, 90 of 100 have less, degrees",
               look_curl(&looks[0], 0.9), 15, 180, look_curl(&looks[1], 0.9), "the same sheet without shrinkage");
    return SINGE_OK;
}

// ---- diffusivity by a texture

SingeResult paper_alpha(Lab *lab, SingeError *error) {
    static const double times[] = {0.5, 1, 1.5};
    double ratio[2] = {0};
    SingeResult result = SINGE_OK;

    report_pictures(lab->report, 4);
    for (int even = 0; even < 2 && !result; even++) {
        Play play;
        const char *sets[] = {lab->quick ? "sheets.0.grid.cells=[48, 36]" : "",
                              even ? "sheets.0.material.diffusivity=3.4e-6" : "", NULL};
        result = play_open(&play, lab, "alpha.yaml", sets, error);
        if (!result && !even) texture_show(lab, &play.job.assets.fields[0][SCENE_PARAM_SLOT(diffusivity)].texture);
        for (int i = 0; i < 3 && !result; i++)
            result = even ? play_until(&play, times[i], error) : play_shoot_at(&play, times[i], error);
        const SingeView view = play.sim ? singe_sim_view(play.sim) : (SingeView){0};

        // the distance of the fire to the left of the centre over that to the right
        double left = 0, right = 0;
        for (uint32_t v = 0; v < view.vertex_count; v++) {
            const double x = (double)view.rest_position[v][0], y = (double)view.rest_position[v][1];
            if (view.time_ignited[v] < 0 || fabs(y) > 0.01) continue;
            left = fmax(left, -x);
            right = fmax(right, x);
        }

        if (!result) ratio[even] = right > 0 ? left / right : (double)NAN;
        play_close(&play);
    }

    if (result) return result;
    report_text(lab->report, "Speed goes with the root of the diffusivity, which is four times as high on the left.");
    report_bar(lab->report, "ratio", "way of the fire to the left over that to the right", ratio[0], 1.2, 2.2, ratio[1],
               "one diffusivity all over");
    return SINGE_OK;
}

// ---- layers that may cross

SingeResult paper_crossing(Lab *lab, SingeError *error) {
    enum { RUNS = 3 };
    static const char *const names[RUNS] = {"may cross", "kept apart", "kept apart, 2 mm thick"};
    static const char *const sets[RUNS] = {"solver.height_min=0", "", "sheets.0.material.thickness=2 mm"};
    Look looks[RUNS] = {{.left = 0}};
    SingeResult result = SINGE_OK;
    report_pictures(lab->report, RUNS);

    for (int i = 0; i < RUNS && !result; i++) {
        Play play;
        const char *laid[] = {
            "contact=no", "tearing=no", sets[i], "sheets.0.material.mass_loss=10 %", "sheets.0.grid.cells=[30, 42]",
            NULL};
        result = play_open(&play, lab, "fig1.yaml", laid, error);
        for (int k = 0; k < 3 && !result; k++) {
            result = play_until(&play, 1.2 + 0.4 * k, error);
            if (!result) result = look_take(&play, 0, &looks[i], error);
        }

        if (!result) result = play_shoot(&play, names[i], error);
        play_close(&play);
    }

    if (result) return result;
    report_heads(lab->report, "layers|cells turned over %|normal at 3 to 15 mm, degrees|degrees from cell to cell");
    for (int i = 0; i < RUNS; i++)
        report_row(lab->report, "%s|%.1f|%.2f|%.2f", names[i], 100 * looks[i].inverted, look_wrinkles(&looks[i]),
                   looks[i].bend);

    const double apart = look_wrinkles(&looks[1]), added = look_wrinkles(&looks[0]) / apart;
    report_bar(lab->report, "turned", "share of cells turned over where layers may cross", looks[0].inverted, 0.01, 1,
               looks[1].inverted, "where they are kept apart");
    report_bar(lab->report, "added",
               "normal at 3 to 15 mm where layers may cross, over where they are kept "
               "apart",
               added, 1.05, 1.3, look_wrinkles(&looks[2]) / apart, "a sheet of 2 mm over one of 1 mm");
    return SINGE_OK;
}
