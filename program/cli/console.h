// The program's output: errors, warnings, notes and the progress line on standard error, results on standard output,
// and the tables of `--csv`.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "cli/cli.h"
#include "singe/base.h"

typedef struct Console {
    bool quiet;    ///< warnings and errors only
    bool terminal; ///< standard error is a terminal
    bool colour;
    bool line_open; ///< a progress line is on the screen
    double last;    ///< s, when progress was last shown
} Console;

typedef struct ConsoleProgress {
    int frame, frames;
    double burnt_fraction, temperature_max; ///< fraction, K
    double frame_seconds;                   ///< time of a frame, smoothed
} ConsoleProgress;

Console console_make(bool quiet);
/// Prints a line; notes only unless the console is quiet.
typedef enum ConsoleKind { CONSOLE_ERROR, CONSOLE_WARNING, CONSOLE_NOTE } ConsoleKind;
void console_say(Console *console, ConsoleKind kind, const char *format, ...) SINGE_PRINTF(3, 4);
#define console_error(console, ...) console_say(console, CONSOLE_ERROR, __VA_ARGS__)
#define console_warn(console, ...) console_say(console, CONSOLE_WARNING, __VA_ARGS__)
#define console_note(console, ...) console_say(console, CONSOLE_NOTE, __VA_ARGS__)

/// Prints a line that belongs to the message before it.
void console_more(const char *text);

/// Prints a library's error: its stage and message.
void console_result(Console *console, const SingeError *error);

/// On a terminal: one line, redrawn at most ten times a second. Otherwise: a line every two seconds. The last frame is
/// always shown.
void console_progress(Console *console, const ConsoleProgress *progress);

/// The same while pictures are drawn again.
void console_picture(Console *console, int frame, int frames, double frame_seconds);

/// Rows of a sweep, and the frames of all of them.
typedef struct ConsoleSweep {
    uint32_t complete, running, failed, rows;
    uint64_t frames, frames_all;
    double seconds_left; ///< 0: not known
} ConsoleSweep;
void console_sweep(Console *console, const ConsoleSweep *progress);

/// Clears the progress line, so that other text can follow.
void console_clear(Console *console);

/// A log hook that writes to this console.
SingeLog console_log(Console *console);

/// "1:02:03", "2:03" or "4 s".
void console_duration(double seconds, char text[32]);

/// A clock for durations, in seconds.
double console_clock(void);

/// Call this before anything else is opened. It fills closed descriptors 0 to 2, so that none of our files becomes one
/// of them and receives messages. Printing to a closed standard output fails; messages to a closed standard error are
/// lost. Returns 0, or -1 on failure: the process has too few open files or too small a stack, which is printed.
int console_open(void);

/// Checks that printed output has arrived: a full disk, a closed pipe or a closed output is a failure. Returns the
/// command's exit code, or EXIT_FAILED in place of EXIT_GOOD.
int console_finish(int code);

/// Writes the output of `print`, the table of `--csv`. A file is replaced whole or not at all; a pipe or a device
/// receives it directly. A pipe without a reader is a failure: opening it would wait forever. Prints the error.
ExitCode console_write_table(Console *console, const char *path, void (*print)(FILE *file, const void *context),
                             const void *context);
