// The command `singe`: a file per command, and the exit codes that all of them keep to.
#ifndef CLI_CLI_H
#define CLI_CLI_H

/// The program's exit codes (docs/cli.md).
typedef enum ExitCode {
    EXIT_GOOD = 0,
    EXIT_FAILED = 1, ///< the run failed (diverged, full disk, unwritable folder, no memory) or was interrupted
    EXIT_INPUT = 2,  ///< usage, or a scene, mesh, picture or checkpoint that cannot be used
} ExitCode;

/// Each gets the arguments after the command's name.
int command_run(int argc, char **argv);
int command_info(int argc, char **argv);
int command_clean(int argc, char **argv);
int command_check(int argc, char **argv);
int command_view(int argc, char **argv);
int command_render(int argc, char **argv);
int command_convert(int argc, char **argv);
int command_measure(int argc, char **argv);
int command_verify(int argc, char **argv);
int command_replay(int argc, char **argv);
int command_bench(int argc, char **argv);
int command_paper(int argc, char **argv);
int command_validate(int argc, char **argv);
int command_sweep(int argc, char **argv);
int command_fit(int argc, char **argv);
int command_scene_doc(int argc, char **argv);

#endif
