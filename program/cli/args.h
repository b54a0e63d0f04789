// Command lines: long options ("--name value" or "--name=value"), one-letter options, operands.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "cli/cli.h"

typedef struct ArgCommand ArgCommand;
typedef struct ArgOption ArgOption;

/// Reads what is given for an option into its field, or prints what is expected and returns false.
typedef bool ArgRead(const ArgCommand *command, const ArgOption *option, const char *text, void *field);

/// Completes what has been read, or prints what contradicts itself and returns false.
typedef bool ArgCheck(const ArgCommand *command, void *options);

struct ArgOption {
    const char *name;  ///< without its dashes
    char letter;       ///< 0 for none
    const char *value; ///< name of the value in the help ("DIR"); NULL for a switch
    const char *help;
    ArgRead *read;
    size_t field;     ///< its offset in the command's options
    double low, high; ///< of a number
};

/// In place of the highest number: any.
#define ARG_HIGHEST 1e300

struct ArgCommand {
    const char *name;    ///< "run"
    const char *operand; ///< "SCENE" takes exactly one, "[NAME]" one at most, NULL none
    const char *summary;
    const ArgOption *options;
    int option_count;
    const char *footer;   ///< printed below the options in the help, or NULL
    const char *examples; ///< command lines, one a line, for the help and the manual; NULL: none
    size_t operand_field; ///< of a const char *
    ArgCheck *check;      ///< of all options together, or NULL
};

/// Reads a command line into the command's options, a struct with the fields that its table names. False where the
/// command ends here, with *code: the help has been printed, or an error with a hint to it.
bool args_read(const ArgCommand *command, int argc, char **argv, void *options, ExitCode *code);

/// Fields: a bool; a const char *, also of a folder, which is not empty; an int, and a double, within low and high; int[2]
/// of "A-B", or of "A" for both, with 1 <= A <= B; a SetList, to which it adds.
ArgRead args_switch, args_text, args_folder, args_int, args_number, args_span, args_set;

/// The option `--frames`, a row but for its field: what the command does with these frames, and what else it means.
#define ARGS_FRAMES(does, more) "frames", 0, "A-B", does " only these frames (or A alone)" more, .read = args_span

/// Options that several commands have, each a whole row; the field of the options `S` has the same name.
#define ARGS_THREADS(S)                                                                                                \
    "threads", 0, "N", "threads [all]; the result does not depend on them", .read = args_int, offsetof(S, threads), 1, \
                                                                            JOB_THREADS_MAX
#define ARGS_SET(S) \
    "set", 0, "PATH=VALUE", "sets a value of the scene; may be repeated", .read = args_set, offsetof(S, sets)
#define ARGS_QUIET(S) "quiet", 'q', NULL, "prints only warnings and errors", .read = args_switch, offsetof(S, quiet)

/// A command's table of options and their number.
#define ARGS_OPTIONS(table) table, sizeof table / sizeof *(table)

void args_help(const ArgCommand *command);

/// The part of the help with the examples.
void args_examples(const ArgCommand *command);

/// Prints "singe COMMAND: error: TEXT" and the hint to the help. Returns false.
bool args_complain(const ArgCommand *command, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/// Complains about an unknown word, "unknown command 'rum'; did you mean 'run'?", and returns EXIT_INPUT. `what` is
/// "unknown command"; the words are args_nearest's.
ExitCode args_unknown(const ArgCommand *command, const char *what, const char *word, const void *first, int count,
                      unsigned long stride);

/// The most similar of `count` words to `word`, or NULL if none is similar. `stride` is the distance between the words'
/// pointers in bytes, so that a table's names can be passed.
const char *args_nearest(const char *word, const void *first, int count, unsigned long stride);
