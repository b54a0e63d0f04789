// A command that writes a page of experiments (`singe paper`, `singe validate`): its command line and its items.
#pragma once

#include "cli/args.h"
#include "page/lab.h"

/// An experiment: fills its item of the report.
typedef SingeResult LabFn(Lab *lab, SingeError *error);

typedef struct PageItem {
    const char *name, *heading, *shows; ///< of its report
    LabFn *run;
} PageItem;

typedef struct Page {
    const PageItem *items;
    int count;
    const char *folder;       ///< the default of --output
    const char *title, *lead; ///< of the report
    /// Items (the list ends with NULL) that run one by one after the others: they measure time, or need others' measures
    const char *const *alone;
    ReportGradeFn *grade; ///< NULL: its measures have none
} Page;

typedef struct PageRequest {
    const char *folder, *item, *only; ///< item or only: one item instead of all
    bool quick;
    int threads;
} PageRequest;

/// Reads a command line and runs items into a report: all, or the one named by an operand (or `all`) or --only. Items
/// run in parallel, one thread each; then those that run alone, each with all threads. The page and the output are in
/// the order of the items. The options of `command` are a
/// PageRequest's. Returns EXIT_FAILED if an
/// item fails or a measure does not hold.
ExitCode page_run(const Page *page, const ArgCommand *command, int argc, char **argv);
