// Command lines: long options ("--name value" or "--name=value"), one-letter options, operands.
#ifndef CLI_ARGS_H
#define CLI_ARGS_H

#include <stdbool.h>

typedef struct ArgOption {
    const char *name;  ///< without its dashes
    char letter;       ///< 0 for none
    const char *value; ///< name of the value in the help ("DIR"); NULL for a switch
    const char *help;
} ArgOption;

typedef struct ArgCommand {
    const char *name;    ///< "run"
    const char *operand; ///< "SCENE" takes exactly one, "[NAME]" one at most, "FILE..." one or more, NULL none
    const char *summary;
    const ArgOption *options;
    int option_count;
    const char *footer;   ///< printed below the options in the help, or NULL
    const char *examples; ///< command lines, one a line, for the help and the manual; NULL: none
} ArgCommand;

/// Results of args_next besides an option, which is its index in `options`, from 0.
enum { ARG_END = -1, ARG_OPERAND = -2, ARG_HELP = -3, ARG_ERROR = -4 };

typedef struct ArgReader {
    const ArgCommand *command;
    int argc, index;
    char **argv;
    int letters;        ///< position within a group of one-letter switches
    bool operands_only; ///< after "--"
    int operand_count;
} ArgReader;

ArgReader args_begin(const ArgCommand *command, int argc, char **argv);

/// The next argument. ARG_ERROR: a message with a hint has been printed, also for a missing operand at the end.
/// ARG_HELP: the help has been printed.
int args_next(ArgReader *reader, const char **value);

void args_help(const ArgCommand *command);

/// The part of the help with the examples.
void args_examples(const ArgCommand *command);

/// Reads a whole number within [low, high], or prints what the option expects and returns false.
bool args_int(const ArgReader *reader, int option, const char *text, int low, int high, int *number);

/// Reads "A-B", or "A" for both, with 1 <= A <= B, or prints what was expected of the option and returns false.
bool args_span(const ArgReader *reader, int option, const char *text, int *first, int *last);

/// Prints "singe COMMAND: error: TEXT" and the hint to the help. Returns ARG_ERROR.
int args_complain(const ArgReader *reader, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/// The most similar of `count` words to `word`, or NULL if none is similar. `stride` is the distance between the words'
/// pointers in bytes, so that a table's names can be passed.
const char *args_nearest(const char *word, const void *first, int count, unsigned long stride);

#endif
