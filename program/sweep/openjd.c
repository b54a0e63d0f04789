// A job template of Open Job Description (github.com/OpenJobDescription, jobtemplate-2023-09): a step of rows, a task each,
// and the report, which waits for all of them. A task that is canceled gets SIGTERM, writes a checkpoint, and resumes
// from it when it is started again.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text.h"
#include "common/printable.h"
#include "sweep/sweep.h"

enum { NAME_MAX_OPENJD = 128, NOTICE = 30 }; // characters; s from SIGTERM to SIGKILL

/// The script of a step: an action that runs `singe sweep` with these arguments, in JSON.
static void print_script(const Sweep *sweep, const char *what) {
    fputs("      \"script\": {\"actions\": {\"onRun\": {\n        \"command\": ", stdout);
    text_json_string(stdout, sweep->program);
    fputs(",\n        \"args\": [\"sweep\", ", stdout);
    text_json_string(stdout, sweep->plan_path);
    fputs(", \"-o\", ", stdout);
    text_json_string(stdout, sweep->folder);
    printf(", %s],\n        \"cancelation\": {\"mode\": \"NOTIFY_THEN_TERMINATE\", \"notifyPeriodInSeconds\": %d}\n"
           "      }}}\n",
           what, NOTICE);
}

ExitCode sweep_print_openjd(const Sweep *sweep) {
    // there, {{ begins an expression, and nothing takes its meaning away
    const char *const texts[] = {sweep->program, sweep->plan_path, sweep->folder, sweep->plan.name};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        if (!strstr(texts[i], "{{")) continue;
        console_error(sweep->console, "--openjd: Open Job Description reserves '{{'; rename %s", shown(texts[i]).text);
        return EXIT_INPUT;
    }

    if (strlen(sweep->plan.name) > NAME_MAX_OPENJD) {
        console_error(sweep->console, "--openjd: a job's name has at most %d characters: %s", NAME_MAX_OPENJD,
                      shown(sweep->plan.name).text);
        return EXIT_INPUT;
    }

    char *rows = sweep_due_rows(sweep);
    fputs("{\n  \"specificationVersion\": \"jobtemplate-2023-09\",\n  \"name\": ", stdout);
    text_json_string(stdout, sweep->plan.name);
    fputs(",\n  \"steps\": [\n", stdout);

    if (*rows) {
        printf("    {\n      \"name\": \"Rows\",\n"
               "      \"parameterSpace\": {\"taskParameterDefinitions\": [{\"name\": \"Row\", \"type\": \"INT\", "
               "\"range\": \"%s\"}]},\n"
               "      \"hostRequirements\": {\"amounts\": [{\"name\": \"amount.worker.vcpu\", \"min\": %d}]},\n",
               rows, sweep->options->threads);

        char *row = text_format("\"--row\", \"{{Task.Param.Row}}\", \"--threads\", \"%d\"%s", sweep->options->threads,
                                sweep->options->no_preview ? ", \"--no-preview\"" : "");
        print_script(sweep, row);
        fputs("    },\n", stdout);
        free(row);
    }

    printf("    {\n      \"name\": \"Report\",\n%s",
           *rows ? "      \"dependencies\": [{\"dependsOn\": \"Rows\"}],\n" : "");
    print_script(sweep, "\"--report\"");
    fputs("    }\n  ]\n}\n", stdout);
    free(rows);
    return EXIT_GOOD;
}
