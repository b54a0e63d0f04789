// singe sweep: many runs of a scene with other parameters. A sweep's folder:
//
//   plan.csv                a line per row: its number and its parameters
//   sweep.json              the scene's hash, to detect a changed plan or scene
//   rows/0001/              a complete row: the output of `singe run`, measure.csv and log.txt
//   unfinished/0001/        a row that is running, was stopped, or failed (then with failed.txt)
//   report.csv, index.html, sheet.svg   of complete rows (sweep_report.c)
//   slurm/                  scripts and logs of jobs (slurm_jobs.c)
//
// A row's folder moves from unfinished/ to rows/ as the last step: it is complete there, or absent.
#pragma once

#include "cli/job.h"
#include "cli/lock.h"
#include "sweep/sweep_plan.h"

typedef enum RowState {
    ROW_ABSENT, ///< or interrupted: it starts or resumes
    ROW_COMPLETE,
    ROW_FAILED,    ///< the next sweep skips it unless --retry is given
    ROW_ELSEWHERE, ///< another process is running it
} RowState;

typedef struct SweepOptions {
    const char *plan, *output;
    int jobs, threads; ///< rows at a time, threads of each
    int row;           ///< only this row, from 1; 0: all
    int max_running;   ///< Slurm: rows at a time; 0: no limit
    int frames;        ///< Slurm: frames drawn by a rendering job
    SetList slurm;     ///< further options of sbatch
    bool retry, print, openjd, submit, report, no_preview, quiet;
} SweepOptions;

typedef struct Sweep {
    Console *console;
    const SweepOptions *options;
    Plan plan;
    char *folder;     ///< without a slash at its end
    char *plan_path;  ///< absolute
    char *program;    ///< this one
    uint32_t *frames; ///< [row_count] of each row's scene
    char *name;       ///< of a row's files
    Lock lock;
} Sweep;

Sweep sweep_make(Console *console, const SweepOptions *options);
void sweep_close(Sweep *sweep);

/// Creates and locks the folder of a sweep whose plan has been read, and writes the plan there or compares it with the
/// one there.
ExitCode sweep_prepare(Sweep *sweep);

/// Paths from malloc; rows are numbered from 0 here and from 1 in names.
char *sweep_row_folder(const Sweep *sweep, uint32_t row, bool complete);
RowState sweep_row_state(const Sweep *sweep, uint32_t row);

/// Whether a row is neither complete nor running, and has not failed, or may fail again.
bool sweep_row_is_due(const Sweep *sweep, uint32_t row);
/// The rows that are due, from 1, in ranges: "1-4,7".
char *sweep_due_rows(const Sweep *sweep);

/// Checks the scene of a row, and stores its number of frames.
ExitCode sweep_check_row(Sweep *sweep, uint32_t row);

/// Checks the scene of every row, or of one. Messages have been printed unless the result is EXIT_GOOD.
ExitCode sweep_check_rows(Sweep *sweep);

/// Creates the subfolders, and writes the plan there or compares it with the one there.
ExitCode sweep_note_plan(Sweep *sweep);

/// The command of a row's run, NULL-terminated: the array and its texts come from malloc.
char **sweep_run_command(const Sweep *sweep, uint32_t row);
/// The command for a whole row, `singe sweep PLAN --row N`, quoted for a shell.
char *sweep_row_line(const Sweep *sweep, const char *number);
void sweep_free_command(char **command);

/// Runs the rows that are due (row_pool.c). EXIT_FAILED if one failed or the sweep was interrupted.
ExitCode sweep_run_rows(Sweep *sweep);

/// Writes the jobs' scripts, and submits them (slurm_jobs.c).
ExitCode sweep_submit(Sweep *sweep);

/// Prints the rows that are due and the report as a job of Open Job Description (openjd.c).
ExitCode sweep_print_openjd(const Sweep *sweep);

/// Writes report.csv, index.html and sheet.svg of the complete rows (sweep_report.c).
ExitCode sweep_report(Sweep *sweep);
