#include "cli/video.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/wait.h>

#include "cli/interrupt.h"
#include "cli/spawn.h"
#include "cli/text.h"

enum { WHY_SIZE = sizeof(((SingeError *)0)->message) };

/// The text with every % doubled, as ffmpeg's frame patterns require.
static char *pattern_escape(const char *text) {
    char *copy = text_format("%s%s", text, text), *out = copy; // never longer than twice
    for (const char *c = text; *c; c++) {
        *out++ = *c;
        if (*c == '%') *out++ = '%';
    }

    *out = 0;
    return copy;
}

/// Runs the program and waits. If it failed, `why` is the reason.
static VideoResult spawn(char *const *arguments, char why[WHY_SIZE]) {
    pid_t child;
    const int reason = spawn_program(arguments, NULL, &child);
    if (reason) {
        snprintf(why, WHY_SIZE, "cannot run ffmpeg (%s)", strerror(reason));
        return reason == ENOENT ? VIDEO_NO_PROGRAM : VIDEO_FAILED;
    }

    int status = 0; // stays 0 if the system has reaped the child itself; then the file decides
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return VIDEO_MADE;
    if (WIFEXITED(status)) snprintf(why, WHY_SIZE, "ffmpeg failed (exit %d)", WEXITSTATUS(status));
    else snprintf(why, WHY_SIZE, "ffmpeg was stopped (signal %d)", WTERMSIG(status));
    return VIDEO_FAILED;
}

/// A film that ffmpeg makes from the frames.
typedef struct Movie {
    const char *what, *path;    ///< for messages; the output file
    const char *const *options; ///< NULL-terminated, after the input
    const char *format;
} Movie;

enum { OPTIONS_MAX = 16 };

/// Makes ffmpeg write to a draft, whose name is put into the arguments, and publishes the draft.
static VideoResult write_movie(const Movie *movie, char *const *arguments, char **output, char why[WHY_SIZE]) {
    SingeError error = {0};
    char *draft;
    if (file_draft(movie->path, &draft, &error)) {
        snprintf(why, WHY_SIZE, "%s", error.message);
        return VIDEO_FAILED;
    }

    interrupt_own(draft);
    *output = text_format("file:%s", draft);

    VideoResult result = spawn(arguments, why);
    free(*output);
    interrupt_disown(draft);

    if (result == VIDEO_MADE && !folder_has(draft)) {
        snprintf(why, WHY_SIZE, "ffmpeg wrote nothing into preview.%s", movie->format);
        result = VIDEO_FAILED;
    }

    if (result != VIDEO_MADE) {
        file_discard(draft);
        return result;
    }

    if (!file_publish(draft, movie->path, &error)) return VIDEO_MADE;

    snprintf(why, WHY_SIZE, "%s", error.message);
    return VIDEO_FAILED;
}

static VideoResult movie_make(Console *console, const Folder *folder, const Movie *movie, double fps, int first,
                              int last) {
    char *path = pattern_escape(folder->path), *name = pattern_escape(folder->name), why[WHY_SIZE];
    // "file:" keeps a colon in a path from being read as a protocol, and a dash as an option
    char *input = text_format("file:%s/frames/%s.%%04d.png", path, name);
    char *final = text_format("file:%s", movie->path);
    char *rate = text_format("%.9g", fps), *start = text_format("%d", first);
    char *count = text_format("%d", last - first + 1);
    char *arguments[24 + OPTIONS_MAX] = {"ffmpeg", "-y",     "-nostdin",   "-loglevel", "error",
                                         "-f",     "image2", "-framerate", rate,        "-start_number",
                                         start,    "-i",     input,        "-frames:v", count};
    int n = 15;
    for (int i = 0; movie->options[i] && i < OPTIONS_MAX; i++) arguments[n++] = (char *)movie->options[i];

    arguments[n++] = "-f";
    arguments[n++] = (char *)movie->format;

    VideoResult result = write_movie(movie, arguments, &arguments[n], why);
    arguments[n] = final;

    // the command that makes it later
    const bool missing = result == VIDEO_NO_PROGRAM;
    if (missing) console_warn(console, "no %s: %s; to make it later:", movie->what, why);
    else if (result != VIDEO_MADE) console_error(console, "no %s: %s; to make it later:", movie->what, why);

    if (result != VIDEO_MADE && !(missing && console->quiet)) {
        char *line = text_format("ffmpeg");
        for (char *const *a = arguments + 1; *a; a++) {
            char *quoted = text_shell_quote(*a), *longer = text_format("%s %s", line, quoted);
            free(quoted);
            free(line);
            line = longer;
        }

        console_more(line);
        free(line);
    }

    char *const texts[] = {path, name, input, final, rate, start, count};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) free(texts[i]);
    return result;
}

VideoResult video_make(Console *console, const Folder *folder, double fps, int first, int last) {
    // H.264 in 4:2:0 needs even sides
    static const char *const options[] = {"-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                          "-c:v",      "libx264",
                                          "-crf",      "18",
                                          "-pix_fmt",  "yuv420p",
                                          "-movflags", "+faststart",
                                          NULL};
    const Movie movie = {"video", folder->video, options, "mp4"};
    return movie_make(console, folder, &movie, fps, first, last);
}

VideoResult gif_make(Console *console, const Folder *folder, double fps, int first, int last) {
    // one palette for the whole film, or still areas flicker; GIF measures time in hundredths of a second
    char *filter = text_format("fps=%.9g,scale='min(640,iw)':-2:flags=lanczos,split[a][b];"
                               "[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=bayer:bayer_scale=4",
                               fps < 25 ? fps : 25);
    const char *const options[] = {"-filter_complex", filter, NULL};
    const Movie movie = {"GIF", folder->gif, options, "gif"};
    VideoResult result = movie_make(console, folder, &movie, fps, first, last);
    free(filter);
    return result;
}
