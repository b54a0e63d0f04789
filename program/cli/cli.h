// The command `singe`: a file per command, and the exit codes that all of them keep to.
#pragma once

/// The program's exit codes (docs/cli.md).
typedef enum ExitCode {
    EXIT_GOOD = 0,
    EXIT_FAILED = 1, ///< the run failed (diverged, full disk, unwritable folder, no memory) or was interrupted
    EXIT_INPUT = 2,  ///< usage, or a scene, mesh, picture or checkpoint that cannot be used
} ExitCode;

/// A command, as main.c lists it: for the help, the manual and completion.
typedef struct Command {
    const char *name;
    int (*run)(int argc, char **argv); ///< gets the arguments after the command's name
    const struct ArgCommand *arguments;
    const char *group; ///< heading in the help; NULL: not in the help
    const char *summary;
} Command;

/// What an operand or an option's value stands for, by its name in the help: "DIR".
typedef enum ValueKind { VALUE_FOLDER, VALUE_FILE, VALUE_YAML, VALUE_WORD } ValueKind;
typedef struct CommandValue {
    const char *name;
    ValueKind kind;
    const char *(*word)(int index); ///< VALUE_WORD: each in turn, NULL after the last
} CommandValue;

/// All of the command's words.
typedef struct CommandTable {
    const Command *commands;
    const CommandValue *values;
    int command_count, value_count;
} CommandTable;
extern const CommandTable command_table; ///< in main.c

extern const struct ArgCommand run_command, check_command, render_command, convert_command, measure_command,
    verify_command, replay_command, bench_command, paper_command, validate_command, sweep_command, fit_command,
    scene_doc_command, info_command, clean_command, view_command, scene_schema_command, materials_command, new_command,
    manual_command, completion_command;

/// The words of `convert --to`, `bench MEASUREMENT`, `paper WHAT` and `completion SHELL`.
const char *convert_format_word(int index);
const char *bench_measurement_word(int index);
const char *paper_item_word(int index);
const char *completion_shell_word(int index);
const char *new_template_word(int index);

typedef int CommandFn(int argc, char **argv);
CommandFn command_run, command_info, command_clean, command_check, command_view, command_render, command_convert,
    command_measure, command_verify, command_replay, command_bench, command_paper, command_validate, command_sweep,
    command_fit, command_scene_doc, command_scene_schema, command_materials, command_new, command_manual,
    command_completion;
