#include "cli/console.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "cli/text.h"
#include "common/printable.h"
#include "formats/formats.h"

Console console_make(bool quiet) {
    const char *kind = getenv("TERM"), *plain = getenv("NO_COLOR");
    bool terminal = isatty(STDERR_FILENO) && kind && strcmp(kind, "dumb") != 0;
    return (Console){.quiet = quiet, .terminal = terminal, .colour = terminal && !(plain && *plain), .last = -1e9};
}

double console_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void console_clear(Console *console) {
    if (console->line_open) fputs("\r\033[K", stderr);
    console->line_open = false;
}

void console_say(Console *console, ConsoleKind kind, const char *format, ...) {
    static const struct {
        const char *word, *colour;
    } kinds[] = {[CONSOLE_ERROR] = {"error", "\033[1;31m"}, [CONSOLE_WARNING] = {"warning", "\033[1;33m"}};
    if (kind == CONSOLE_NOTE && console->quiet) return;

    console_clear(console);
    fputs("singe: ", stderr);
    if (kind != CONSOLE_NOTE)
        fprintf(stderr, "%s%s:%s ", console->colour ? kinds[kind].colour : "", kinds[kind].word,
                console->colour ? "\033[0m" : "");

    va_list list;
    va_start(list, format);
    char text[16384];
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    printable_trim(text);
    printable_write(text, stderr);
    fputc('\n', stderr);
}

void console_more(const char *text) {
    fputs("  ", stderr);
    printable_write(text, stderr);
    fputc('\n', stderr);
}

void console_result(Console *console, const SingeError *error) {
    const char *text = error->message[0] ? error->message : singe_result_name(error->code);
    if (error->stage[0]) console_error(console, "%s: %s", error->stage, text);
    else console_error(console, "%s", text);
}

/// `check` and run.json have the information that is left out here.
static void log_line(void *context, SingeLogLevel level, const char *line) {
    Console *console = context;
    if (level == SINGE_LOG_ERROR) console_error(console, "%s", line);
    else if (level == SINGE_LOG_WARNING) console_warn(console, "%s", line);
    else if (strncmp(line, "solver: ", 8) == 0) console_note(console, "%s", line);
}

SingeLog console_log(Console *console) { return (SingeLog){log_line, console}; }

void console_duration(double seconds, char text[32]) {
    long s = seconds < 0 || seconds > 1e8 ? 0 : (long)(seconds + 0.5);
    if (s < 60) snprintf(text, 32, "%ld s", s);
    else if (s < 3600) snprintf(text, 32, "%ld:%02ld", s / 60, s % 60);
    else snprintf(text, 32, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

enum { BAR = 24 };

static void show(Console *console, int frame, int frames, const char *line) {
    double now = console_clock(), gap = console->terminal ? 0.1 : 2.0;
    if (console->quiet || (now - console->last < gap && frame != frames)) return;

    console->last = now;
    if (!console->terminal) {
        fprintf(stderr, "%s\n", line);
        return;
    }

    char bar[BAR + 1];
    int full = frames > 0 ? (int)((long)frame * BAR / frames) : BAR;
    for (int i = 0; i < BAR; i++) bar[i] = i < full ? '#' : '.';
    bar[BAR] = 0;

    const char *colour = console->colour ? "\033[33m" : "", *plain = console->colour ? "\033[0m" : "";
    fprintf(stderr, "\r\033[K%s[%s]%s %s", colour, bar, plain, line);
    console->line_open = frame != frames;
    if (!console->line_open) fputc('\n', stderr);
    fflush(stderr);
}

void console_progress(Console *console, const ConsoleProgress *p) {
    char left[32], line[200];
    console_duration(p->frame_seconds * (p->frames - p->frame), left);
    snprintf(line, sizeof line, "frame %d/%d  burnt %.1f %%  T max %.0f C  %.0f ms/frame  %s left", p->frame, p->frames,
             100 * p->burnt_fraction, p->temperature_max - 273.15, 1e3 * p->frame_seconds, left);
    show(console, p->frame, p->frames, line);
}

void console_picture(Console *console, int frame, int frames, double frame_seconds) {
    char left[32], line[200];
    console_duration(frame_seconds * (frames - frame), left);
    snprintf(line, sizeof line, "frame %d/%d  %.0f ms/frame  %s left", frame, frames, 1e3 * frame_seconds, left);
    show(console, frame, frames, line);
}

void console_sweep(Console *console, const ConsoleSweep *p) {
    char left[32] = "?", line[200];
    if (p->seconds_left > 0) console_duration(p->seconds_left, left);
    snprintf(line, sizeof line,
             "rows %" PRIu32 "/%" PRIu32 "  %" PRIu32 " running  %" PRIu32 " failed  frame %" PRIu64 "/%" PRIu64
             "  %s left",
             p->complete, p->rows, p->running, p->failed, p->frames, p->frames_all, left);
    show(console, (int)(p->frames_all ? 1000 * p->frames / p->frames_all : 1000), 1000, line);
}

// ---- standard streams

int console_open(void) {
    signal(SIGXFSZ, SIG_IGN); // a file over its size limit is a write error instead of the program's end

    // open takes the lowest free descriptor. Standard output is opened for reading only, so that writing to it fails
    static const int modes[] = {[STDIN_FILENO] = O_RDONLY, [STDOUT_FILENO] = O_RDONLY, [STDERR_FILENO] = O_WRONLY};
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", modes[fd]) != fd) return -1;

    // with less than these a command fails midway, in a reader's words or in none
    static const struct {
        int resource;
        rlim_t unit, least;
        const char *what;
    } needs[] = {{RLIMIT_NOFILE, 1, 16, "open files (ulimit -n)"},
                 {RLIMIT_STACK, 1024, 256, "KiB of stack (ulimit -s)"}};
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        struct rlimit limit;
        if (getrlimit(needs[i].resource, &limit) || limit.rlim_cur >= needs[i].unit * needs[i].least) continue;
        fprintf(stderr, "singe: error: this process may have %" PRIu64 " %s, but singe needs %" PRIu64 "\n",
                (uint64_t)(limit.rlim_cur / needs[i].unit), needs[i].what, (uint64_t)needs[i].least);
        return -1;
    }

    return 0;
}

/// Writes to a pipe, a device or through a link. Returns 0 or the system's reason.
static int write_through(const char *path, const char *text, size_t size) {
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
    if (fd < 0) return errno;

    const int flags = fcntl(fd, F_GETFL);
    int reason = flags < 0 || fcntl(fd, F_SETFL, flags & ~O_NONBLOCK) ? errno : 0;
    while (size && !reason) {
        const ssize_t count = write(fd, text, size);
        if (count > 0) {
            text += count;
            size -= (size_t)count;
        } else if (count == 0 || errno != EINTR) reason = count ? errno : EIO;
    }

    if (close(fd) && !reason) reason = errno;
    return reason;
}

ExitCode console_write_table(Console *console, const char *path, void (*print)(FILE *file, const void *context),
                             const void *context) {
    char *text = NULL;
    size_t size = 0;
    int reason = ENOMEM;
    SingeResult result = SINGE_OK;
    SingeError error = {0};
    FILE *file = open_memstream(&text, &size);
    if (file) print(file, context);

    if (text_stream_end(file, &text)) {
        struct stat about;
        const bool ours = lstat(path, &about) ? errno == ENOENT : S_ISREG(about.st_mode);
        reason = ours ? 0 : write_through(path, text, size);
        if (ours) result = file_write(path, text, size, &error);
    }

    free(text);
    if (reason) console_error(console, "cannot write %s: %s", path, strerror(reason));
    if (result) console_result(console, &error);
    return reason || result ? EXIT_FAILED : EXIT_GOOD;
}

int console_finish(int code) {
    errno = 0;
    bool failed = fflush(stdout) != 0;
    if (!failed && !ferror(stdout)) return code;

    fprintf(stderr, "singe: error: cannot write to standard output%s%s\n", errno ? ": " : "",
            errno ? strerror(errno) : "");
    return code == EXIT_GOOD ? EXIT_FAILED : code;
}
