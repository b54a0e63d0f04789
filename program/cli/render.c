// singe render: draws the pictures, video and contact sheet of a cache again, from its PLYs and the scene in its
// run.json.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/folder.h"
#include "cli/interrupt.h"
#include "cli/job.h"
#include "cli/lock.h"
#include "cli/pictures.h"
#include "cli/video.h"
#include "common/printable.h"

typedef struct RenderOptions {
    const char *folder, *output; ///< output NULL: the same
    SetList sets;
    int frames[2]; ///< the first and the last; 0: all
    int sheet[2];  ///< columns and rows; 0: none
    int threads;
    bool only_sheet, exr, gif, quiet;
} RenderOptions;

static bool read_set(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    if (strncmp(text, "preview.", 8) == 0) return args_set(command, option, text, field);
    return args_complain(command, "--set: only preview.* can be set here, got '%s'", shown(text).text);
}

static bool read_sheet(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    (void)option;
    int *size = field, end = 0;
    if (sscanf(text, "%2dx%2d%n", &size[0], &size[1], &end) == 2 && !text[end] && size[0] >= 1 && size[0] <= 64 &&
        size[1] >= 1 && size[1] <= 64)
        return true;
    return args_complain(command, "--sheet: expected COLUMNSxROWS such as 4x2, at most 64x64, got '%s'",
                         shown(text).text);
}

static const ArgOption render_options[] = {
    {"output", 'o', "FOLDER", "writes to this folder, not into the cache's", .read = args_folder,
     offsetof(RenderOptions, output)},
    {"set", 0, "preview.PATH=VALUE", "sets a value of the scene; may be repeated", .read = read_set,
     offsetof(RenderOptions, sets)},
    {ARGS_FRAMES("draws", ", and no video"), offsetof(RenderOptions, frames)},
    {"sheet", 0, "CxR", "also writes DIR/sheet.png, a contact sheet of C by R frames from the whole run",
     .read = read_sheet, offsetof(RenderOptions, sheet)},
    {"only-sheet", 0, NULL, "draws only the frames of that sheet, and writes nothing else", .read = args_switch,
     offsetof(RenderOptions, only_sheet)},
    {"exr", 0, NULL, "also writes DIR/exr/NAME.0001.exr, ...: the layers of each frame", .read = args_switch,
     offsetof(RenderOptions, exr)},
    {"gif", 0, NULL, "also writes the drawn frames as DIR/preview.gif", .read = args_switch,
     offsetof(RenderOptions, gif)},
    {ARGS_THREADS(RenderOptions)},
    {ARGS_QUIET(RenderOptions)},
};

static bool render_check(const ArgCommand *command, void *options) {
    RenderOptions *o = options;
    if (o->only_sheet && (o->exr || o->gif))
        return args_complain(command, "--only-sheet writes nothing else: not with --%s", o->exr ? "exr" : "gif");
    if (o->exr && !exr_available()) return args_complain(command, "--exr: this singe was built without EXR");

    if (o->only_sheet && !o->sheet[0]) {
        o->sheet[0] = 4;
        o->sheet[1] = 2;
    }

    return true;
}

const ArgCommand render_command = {"render",
                                   "DIR",
                                   "Draws the pictures and the video of a cache again.",
                                   ARGS_OPTIONS(render_options),
                                   "Exit codes: 0 success, 1 failed or interrupted, 2 bad input.",
                                   "singe render out --set preview.exposure=2\n"
                                   "singe render out --frames 24 --exr -o stills --set preview.samples=256\n"
                                   "singe render out --sheet 4x2 --only-sheet",
                                   .operand_field = offsetof(RenderOptions, folder),
                                   .check = render_check};

typedef struct Render {
    Console *console;
    const RenderOptions *options;
    Job job;
    Folder folder, drawn; ///< the cache's, and that of the pictures
    Pictures *pictures;
    ContactSheet sheet;
    int first, last; ///< frames to draw
    Lock lock;       ///< of the pictures
} Render;

// ---- drawing

/// Copies the frame to every tile of the sheet that shows it. Returns whether there is one.
static bool put_tiles(Render *render, int frame, const uint8_t *rgb) {
    int tiles = render->sheet.columns * render->sheet.rows;
    bool any = false;
    for (int tile = 0; tile < tiles; tile++) {
        if (contact_sheet_frame(tile, tiles, render->first, render->last) != frame) continue;
        any = true;
        if (rgb) contact_sheet_put(&render->sheet, tile, rgb);
    }

    return any;
}

static SingeResult draw_all(Render *render, bool *interrupted, SingeError *error) {
    const RenderOptions *o = render->options;
    const double begun = console_clock();

    for (int number = render->first, drawn = 0; number <= render->last && !*interrupted; number++) {
        if (o->only_sheet && !put_tiles(render, number, NULL)) continue;

        Frame frame;
        const uint8_t *rgb = NULL;
        SingeResult result = frame_read(&render->folder, number, &frame, error);
        if (!result) result = frame_draw(&frame, render->pictures, &rgb, error);
        frame_free(&frame);

        if (!result && !o->only_sheet) {
            char *png = folder_png(&render->drawn, number);
            char *exr = o->exr ? folder_exr(&render->drawn, number) : NULL;
            result = frame_write_picture(render->pictures, rgb, png, exr, error);
            free(png);
            free(exr);
        }

        *interrupted = result && interrupt_left_work();
        if (*interrupted) return SINGE_OK;
        if (result) return result;

        put_tiles(render, number, rgb);
        drawn++;
        console_picture(render->console, number, render->last, (console_clock() - begun) / drawn);
        *interrupted = interrupt_asked() && number < render->last;
    }

    if (!render->sheet.rgb) return SINGE_OK;
    return png_write(render->drawn.sheet, render->sheet.width, render->sheet.height, render->sheet.rgb, error);
}

static ExitCode render_frames(Render *render) {
    const RenderOptions *o = render->options;
    SingeError error = {0};
    bool interrupted = false;
    SingeResult result = pictures_open(&render->job, &render->pictures, &error);

    if (!result && o->output) result = folder_make(render->drawn.path, &error);

    // several processes may draw parts of a run at the same time; one that draws all of it makes the video, and must be
    // alone
    if (!result && !o->only_sheet)
        result = lock_take(&render->lock, render->drawn.pictures_lock, "pictures", o->frames[0] > 0, render->console,
                           &error);

    const FolderParts parts = {.pictures = !o->only_sheet, .exr = o->exr, .elsewhere = o->output != NULL};
    if (!result) result = folder_create(&render->drawn, parts, &error);
    if (!result && o->exr) result = pictures_keep_layers(render->pictures, &error);
    if (!result && o->sheet[0]) {
        int width, height;
        pictures_size(render->pictures, &width, &height);
        result = contact_sheet_make(&render->sheet, o->sheet[0], o->sheet[1], width, height, &error);
    }

    interrupt_watch();
    if (!result) result = draw_all(render, &interrupted, &error);
    console_clear(render->console);

    if (result) {
        console_result(render->console, &error);
        return result == SINGE_ERROR_FORMAT ? EXIT_INPUT : EXIT_FAILED;
    }

    if (interrupted) return EXIT_FAILED;
    if (!o->quiet && o->sheet[0]) printf("%s\n", render->drawn.sheet);

    // the films
    const double fps = (double)render->job.scene->fps;
    VideoResult gif = VIDEO_NO_PROGRAM, video = VIDEO_NO_PROGRAM;
    if (o->gif) gif = gif_make(render->console, &render->drawn, fps, render->first, render->last);
    if (gif == VIDEO_MADE && !o->quiet) printf("%s\n", render->drawn.gif);
    if (!o->frames[0] && !o->only_sheet)
        video = video_make(render->console, &render->drawn, fps, render->first, render->last);
    if (video == VIDEO_MADE && !o->quiet) printf("%s\n", render->drawn.video);
    return video == VIDEO_FAILED || gif == VIDEO_FAILED ? EXIT_FAILED : EXIT_GOOD;
}

int command_render(int argc, char **argv) {
    RenderOptions options = {.threads = job_threads()};
    ExitCode code;
    if (args_read(&render_command, argc, argv, &options, &code)) {
        interrupt_shield();
        Console console = console_make(options.quiet);
        Render render = {.console = &console, .options = &options, .lock = LOCK_NONE};
        code = job_reopen(&render.job, &console, options.folder, &options.sets, options.threads);
        if (!code) code = job_fits(&render.job, &console, scene_picture_memory(render.job.scene, options.exr));

        if (!code) {
            render.folder = folder_name(options.folder, render.job.scene->name);
            render.drawn = folder_name(options.output ? options.output : options.folder, render.job.scene->name);
            render.first = options.frames[0];
            render.last = options.frames[1];
            code = folder_span(&render.folder, &console, &render.first, &render.last);
        }

        if (!code) code = render_frames(&render);
        contact_sheet_free(&render.sheet);
        pictures_close(render.pictures);
        lock_release(&render.lock);
        folder_free(&render.folder);
        folder_free(&render.drawn);
        job_close(&render.job);
    }

    set_free(&options.sets);
    return code;
}
