// singe check: finds every error that run would find, and prints what the scene amounts to. Writes no files.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "analysis/strip.h"
#include "cli/args.h"
#include "cli/checkpoint.h"
#include "cli/job.h"
#include "cli/pictures.h"
#include "common/printable.h"
#include "formats/gas_grid.h"
#include "scene/words.h"

typedef struct CheckOptions {
    const char *scene;
    int frames, threads; ///< frames 0: the scene's
    SetList sets;
} CheckOptions;

static const ArgOption check_options[] = {
    {"frames", 0, "N", "frames to estimate the time for", .read = args_int, offsetof(CheckOptions, frames), 1,
     JOB_FRAMES_MAX},
    {ARGS_THREADS(CheckOptions)},
    {ARGS_SET(CheckOptions)},
};

const ArgCommand check_command = {
    "check",
    "SCENE",
    "Reads a scene with its meshes and images, builds it, and prints its size and cost.",
    ARGS_OPTIONS(check_options),
    "Exit codes: 0 the scene is valid, 1 a step failed, memory ran out or standard output could not be written,\n"
    "2 bad input.",
    "singe check letter.yaml\n"
    "singe check letter.yaml --set sheets.0.material=newsprint",
    .operand_field = offsetof(CheckOptions, scene)};

/// Steps are timed until this many are done or this much time has passed.
enum { CHECK_STEPS = 10 };
static const double check_seconds = 3;

typedef struct CheckTimes {
    double step, surface, picture; ///< s each
    double mesh, gas, checkpoint;  ///< bytes: of the first frame's mesh, at most of a frame's gas, of a checkpoint
} CheckTimes;

/// A mesh has 1.4 to 4 times the bytes of the first, on average over a run, as cells near the front are split: measured
/// on eight runs of the examples. The gas takes at most some bytes a cell, and a picture some a pixel.
static const double mesh_growth = 4, gas_bytes = 3.5, pixel_bytes = 1.2;

/// Max rays and pixels of the timed picture, roughly: a larger one is drawn with fewer of them, and its time is scaled.
/// A quarter of the default picture's pixels foretells its time within 7 % (letter, stack, curtain); the whole of 16,384 x
/// 16,384 takes 21 GB, which checking a scene must not need.
static const double check_rays = 16e6, check_pixels = 0.5e6;

static double pixels_of(const PreviewDef *preview) { return (double)preview->width * (double)preview->height; }

/// Times what run computes for its first frame, except the files, and then some steps.
static SingeResult time_frame(const Job *job, SingeSim *sim, CheckTimes *times, SingeError *error) {
    Frame frame = {0};
    double begun = console_clock();
    SingeResult result = frame_take_surface(sim, &frame, error);

    times->surface = console_clock() - begun;
    if (!result) result = frame_take_gas(sim, &frame, error);
    if (!result) times->mesh = (double)ply_surface_size(&frame.surface);
    if (!result) times->gas = gas_bytes * (double)gas_cells(&frame.gas.view);

    if (!result) {
        Pictures *pictures = NULL;
        const uint8_t *rgb;
        PreviewDef *preview = &job->scene->preview.def;
        const PreviewDef wanted = *preview;

        while (pixels_of(preview) > check_pixels) {
            preview->width = (preview->width + 1) / 2;
            preview->height = (preview->height + 1) / 2;
        }
        while (preview->samples > 1 && pixels_of(preview) * preview->samples > check_rays) preview->samples /= 2;

        const double rays = pixels_of(preview) * preview->samples;
        result = pictures_open(job, &pictures, error);
        begun = console_clock();
        if (!result) result = frame_draw(&frame, pictures, &rgb, error);
        times->picture = (console_clock() - begun) * pixels_of(&wanted) * wanted.samples / rays;
        *preview = wanted;
        pictures_close(pictures);
    }

    frame_free(&frame);
    if (!result && (job->scene->checkpoints.every || job->scene->checkpoints.megabytes > 0)) {
        CheckpointBytes taken;
        result = checkpoint_take(sim, &taken, error);
        times->checkpoint = (double)taken.size;
        checkpoint_drop(sim, &taken);
    }

    if (result) return result;

    int count = 0;
    begun = console_clock();

    while (count < CHECK_STEPS && (count == 0 || console_clock() - begun < check_seconds)) {
        if (singe_sim_step(sim)) {
            *error = *singe_sim_error(sim);
            return error->code;
        }
        count++;
    }

    times->step = (console_clock() - begun) / count;
    return SINGE_OK;
}

/// Prints what was read and how it was repaired, sheet by sheet, and what was built of it.
static void report_shell(const Job *job, const SingeCounts *c) {
    for (uint32_t i = 0; i < job->assets.sheet_count; i++) {
        char text[200];
        for (int line = 0; mesh_report_line(&job->assets.reports[i], line, text, sizeof text); line++) {
            if (line) printf("              %s\n", text);
            else printf("mesh          %s: %s\n", shown_path(job->scene->sheets[i].mesh.name).text, text);
        }
    }

    static const struct {
        const char *name;
        SingeColour colour;
    } rows[] = {{"red", SINGE_RED}, {"green", SINGE_GREEN}, {"blue", SINGE_BLUE}, {"yellow", SINGE_YELLOW}};

    uint64_t springs = 0, strands = 0;
    for (int i = 0; i < SINGE_COLOUR_COUNT; i++) {
        springs += c->springs[i];
        strands += c->strands[i];
    }

    printf("particles     %" PRIu32 "\n", c->particles);
    printf("cells         %" PRIu32 " of %.3g mm\n", c->cells, 1e3 * (double)c->cell_size);
    printf("springs       %" PRIu64 " in %" PRIu64 " strands of %.1f on average\n", springs, strands,
           c->mean_strand_length);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        printf("  %-11s %" PRIu32 " in %" PRIu32 " strands, %" PRIu32 " families\n", rows[i].name,
               c->springs[rows[i].colour], c->strands[rows[i].colour], c->families[rows[i].colour]);
    printf("memory        %.1f MB\n", 1e-6 * (double)c->memory);
    printf("instructions  %s\n", enum_words.SingeInstructions[c->instructions]);
}

/// Office paper takes 8,000 units of work (StripSetup.work_max), a third of a second in all; a front that advances by
/// less than a cell in as many steps has gone out.
enum { CHECK_MATERIALS = 4, CHECK_STRIP_WORK = 60000, CHECK_STRIP_PATIENCE = 4000 };
static const float check_strip_length = 0.06f; ///< m, of which the first 2 cm are lit

/// Burns a strip of the material in steps of that length, for a few seconds at most. The speed is 0 if it does not
/// burn, and the end is missing if it cannot be known. Fails only when out of memory.
static SingeResult front_of(const SceneMaterial *material, float step, StripResult *front, SingeError *error) {
    StripSetup setup = strip_setup(&material->def);
    setup.length = check_strip_length;
    setup.time_step = step;
    setup.patience = CHECK_STRIP_PATIENCE;
    setup.work_max = CHECK_STRIP_WORK;
    *front = (StripResult){.end = STRIP_UNKNOWN};
    SingeResult result = step < 10 ? strip_burn(&setup, front, error) : SINGE_ERROR_ARGUMENT;
    if (result || !(front->speed > 0)) front->speed = 0;
    return result == SINGE_ERROR_MEMORY ? result : SINGE_OK;
}

/// Prints the sheets' materials, each name and grammage once; how fast each burns, and whether the scene's steps are too
/// long for it. Lighter paper burns faster, and a front thickened by F burns as it would with steps 1/F as long.
static SingeResult report_materials(const Scene *scene, float thickening, SingeError *error) {
    const float pace = scene->sim.pace;
    SingeResult result = SINGE_OK;

    for (uint32_t i = 0, reported = 0; !result && i < scene->sheet_count && reported < CHECK_MATERIALS; i++) {
        const SceneMaterial *material = &scene->sheets[i].material;
        const float grammage = material->def.grammage.value;
        uint32_t j = 0;
        while (!scene_material_same(&scene->sheets[j].material, material)) j++;
        if (j < i) continue;

        reported++;
        printf("material      %s, %.4g g/m2", material->name ? shown(material->name).text : "its own",
               1e3 * (double)grammage);

        StripResult front, rough;
        const float weight = grammage / 0.080f;
        const float fine = singe_default_sim().time_step * fmaxf(weight, 0.1f);
        result = front_of(material, fine, &front, error);
        if (!result && front.speed > 0) {
            printf(": a level front of %.3g mm/s and %.0f C", 1e3 * front.speed, front.hottest - 273.15);
            if (pace != 1) printf(", on film %.3g mm/s (pace %.3g)", 1e3 * front.speed * (double)pace, (double)pace);
            const float step = scene->sim.time_step * pace * (float)front.thickening / thickening;
            if (step > fine && !(result = front_of(material, step, &rough, error))) {
                const double slower = 1 - rough.speed / front.speed;
                if (slower > 0.1)
                    printf("\n              %.0f %% slower in steps this long: raise `steps`", 100 * slower);
            }
        } else if (!result && front.end == STRIP_OUT) {
            printf(": a level strip of it goes out");
        } else if (!result && front.end == STRIP_CUT) {
            printf(": measuring its burning speed would take too long");
        }
        printf("\n");
    }

    return result;
}

static void report_size(const Job *job, const SceneAssets *assets, double pictures) {
    SceneSize size = scene_size(job->scene, assets);
    printf("needs         about %.2f GB of memory for %" PRIu64 " cells", 1e-9 * (size.memory + pictures), size.cells);
    if (size.unread) printf(" and those of %" PRIu32 " mesh file%s", size.unread, size.unread > 1 ? "s" : "");
    printf("\n");
    fflush(stdout);
}

static ExitCode check_scene(Console *console, const char *path, const SetList *sets, int threads) {
    Job job;
    SingeSim *sim = NULL;
    ExitCode code = job_read(&job, console, path, sets, threads);

    // the needs are printed before anything is built, and again when meshes have been read
    if (!code) {
        const double pictures = scene_picture_memory(job.scene, false);
        const bool unread = scene_size(job.scene, NULL).unread > 0;
        report_size(&job, NULL, pictures);
        code = job_load(&job, console, pictures);
        if (!code && unread) report_size(&job, &job.assets, pictures);
        if (!code) code = job_build(&job, console, &sim);
    }

    if (code) {
        job_close(&job);
        return code;
    }

    const SingeCounts counts = singe_sim_counts(sim);
    const float thickening = singe_sim_stats(sim).thickening;
    CheckTimes times = {0};
    SingeError error = {0};

    report_shell(&job, &counts);
    job_note_long(&job, console, "burning a strip of each material");
    SingeResult result = report_materials(job.scene, thickening, &error);
    if (!result) job_note_long(&job, console, "timing steps");
    if (!result && pixels_of(&job.scene->preview.def) > check_pixels) console_note(console, "drawing");
    if (!result) result = time_frame(&job, sim, &times, &error);

    if (result) {
        fflush(stdout);
        console_result(console, &error);
        code = EXIT_FAILED;
    } else {
        const Scene *scene = job.scene;
        const double frame = scene->steps * times.step + times.surface + times.picture;
        char text[32];
        console_duration(frame * scene->frames, text);

        printf("thickening    %.3g: the fire front is widened by this factor to span the cells\n", (double)thickening);
        printf("frames        %d at %.4g a second, %d steps of %.3g ms each\n", scene->frames, (double)scene->fps,
               scene->steps, 1e3 * (double)scene->sim.time_step);
        printf("time          about %s: a step %.2f ms, a surface %.2f ms, a picture %.0f ms, with %d threads\n", text,
               1e3 * times.step, 1e3 * times.surface, 1e3 * times.picture, job.hooks.thread_count);

        // what a run writes, with pictures and without other formats
        const double frames = scene->frames, pictures = pixel_bytes * pixels_of(&scene->preview.def);
        const SceneCheckpoints *keep = &scene->checkpoints;
        const double most = keep->megabytes > 0 ? 1e6 * (double)keep->megabytes : INFINITY;
        const double kept = fmin(floor(frames / (keep->every ? keep->every : 10)) * times.checkpoint, most);
        const double low = frames * (times.mesh + pictures) + kept;
        printf("disk          about %.3g to %.3g MB", 1e-6 * low,
               1e-6 * (low + frames * ((mesh_growth - 1) * times.mesh + times.gas)));
        if (kept > 0) printf(", %.3g MB of them checkpoints", 1e-6 * kept);
        printf("\n");
        printf("%s: good\n", shown_path(path).text); // only now, after its first steps
    }

    singe_sim_destroy(sim);
    job_close(&job);
    return code;
}

int command_check(int argc, char **argv) {
    CheckOptions options = {.threads = job_threads()};
    ExitCode code;
    if (args_read(&check_command, argc, argv, &options, &code)) {
        if (options.frames) set_frames(&options.sets, options.frames);
        Console console = console_make(false);
        char *path = job_scene_path(&console, options.scene);
        code = path ? check_scene(&console, path, &options.sets, options.threads) : EXIT_INPUT;
        free(path);
    }

    set_free(&options.sets);
    return code;
}
