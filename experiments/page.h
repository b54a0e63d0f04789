// A command that makes a page of experiments, as `singe paper` and `singe validate` do: its command line, its items.
#ifndef EXPERIMENTS_PAGE_H
#define EXPERIMENTS_PAGE_H

#include "cli/args.h"
#include "experiments/lab.h"

/// An experiment: fills its item of the report.
typedef SingeResult LabFn(Lab *lab, SingeError *error);

typedef struct PageItem {
    const char *name, *heading, *shows; ///< of its report
    LabFn *run;
} PageItem;

typedef struct Page {
    const PageItem *items;
    int count;
    const char *folder;       ///< where it goes unless --output tells another
    const char *title, *lead; ///< of the report
    const char *const *alone; ///< items, ends with NULL, that run after the others and one by one: they take times, or
                              ///< need the measures of the others
} Page;

/// Reads a command line and runs what it asks for into a report: all items, or the one that an operand (or `all`) or
/// --only names. All items run at once on as many threads as there are, each with one; then those that run alone, each
/// with all. The page and what is printed are in the order of the items. Of options `command` may have output, only,
/// quick and threads. Returns EXIT_FAILED where an item fails or a measure does not hold.
ExitCode page_run(const Page *page, const ArgCommand *command, int argc, char **argv);

#endif
