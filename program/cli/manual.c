// singe manual: the manual pages, singe(1) and singe-COMMAND(1), from the tables that the commands read.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/cli.h"
#include "cli/console.h"
#include "cli/folder.h"
#include "cli/text.h"

typedef struct ManualOptions {
    const char *command, *folder; ///< NULL: none
} ManualOptions;

static const ArgOption manual_options[] = {
    {"output", 'o', "DIR", "writes all pages into this folder, as man reads them", .read = args_text,
     offsetof(ManualOptions, folder)},
};

const ArgCommand manual_command = {"manual",
                                   "[COMMAND]",
                                   "Prints the manual page of a command, or of singe itself, for man.",
                                   ARGS_OPTIONS(manual_options),
                                   "Exit codes: 0 success, 1 a page could not be written, 2 bad input.",
                                   "singe manual run | man -l -\n"
                                   "singe manual -o ~/.local/share/man/man1",
                                   .operand_field = offsetof(ManualOptions, command)};

/// Writes text as roff: dashes as they are typed, nothing that begins a line taken for a request.
static void put(FILE *page, const char *text) {
    if (*text == '.' || *text == '\'') fputs("\\&", page);
    for (const char *c = text; *c; c++) {
        if (*c == '\\') fputs("\\e", page);
        else if (*c == '-') fputs("\\-", page);
        else fputc(*c, page);
        if (*c == '\n' && (c[1] == '.' || c[1] == '\'')) fputs("\\&", page);
    }

    fputc('\n', page);
}

static void put_head(FILE *page, const char *command, const char *summary) {
    fputs(".\\\" Made by `singe manual` from the program's tables.\n.TH SINGE", page);
    if (command) fputs("\\-", page);
    for (const char *c = command ? command : ""; *c; c++)
        if (*c == '-') fputs("\\-", page);
        else fputc(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c, page);

    fprintf(page, " 1 \"\" \"singe %s\" \"Singe\"\n.SH NAME\nsinge", singe_version());
    fprintf(page, command ? "\\-" : " \\- ");
    for (const char *c = command ? command : ""; *c; c++) fprintf(page, *c == '-' ? "\\-" : "%c", *c);
    if (command) fputs(" \\- ", page);
    put(page, summary);
    fputs(".SH SYNOPSIS\n.B singe", page);
}

static void put_command(FILE *page, const Command *command) {
    const ArgCommand *arguments = command->arguments;
    put_head(page, command->name, command->summary ? command->summary : arguments->summary);
    fprintf(page, " %s\n", command->name);
    if (arguments->operand) fprintf(page, ".I %s\n", arguments->operand);
    fputs("[options]\n.SH DESCRIPTION\n", page);
    put(page, arguments->summary);

    fputs(".SH OPTIONS\n", page);
    for (int i = 0; i < arguments->option_count; i++) {
        const ArgOption *option = &arguments->options[i];
        fputs(".TP\n", page);
        if (option->letter) fprintf(page, "\\fB\\-%c\\fR, ", option->letter);
        fputs("\\fB\\-\\-", page);
        for (const char *c = option->name; *c; c++) fprintf(page, *c == '-' ? "\\-" : "%c", *c);
        fprintf(page, "\\fR%s%s%s\n", option->value ? " \\fI" : "", option->value ? option->value : "",
                option->value ? "\\fR" : "");
        put(page, option->help);
    }

    fputs(".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprints the options\n", page);

    if (arguments->examples) {
        fputs(".SH EXAMPLES\n.nf\n", page);
        put(page, arguments->examples);
        fputs(".fi\n", page);
    }

    if (arguments->footer) {
        fputs(".SH NOTES\n", page);
        put(page, arguments->footer);
    }
    fputs(".SH SEE ALSO\n.BR singe (1)\n", page);
}

/// For console_write_table: the page of a command, or, without one, that of the program.
static void print_page(FILE *page, const void *command) {
    if (command) {
        put_command(page, command);
        return;
    }

    put_head(page, NULL, "burns cloth and paper");
    fputs("\n.I COMMAND\n[options]\n.SH DESCRIPTION\nSinge takes a mesh, a material and a fire, and simulates a thin "
          "shell that heats, chars, shrinks, wrinkles, tears and turns to ash.\n.SH COMMANDS\n",
          page);

    for (int i = 0; i < command_table.command_count; i++) {
        const Command *one = &command_table.commands[i];
        if (!one->group) continue;
        fputs(".TP\n.BR singe\\-", page);
        for (const char *c = one->name; *c; c++) fprintf(page, *c == '-' ? "\\-" : "%c", *c);
        fputs(" (1)\n", page);
        put(page, one->summary);
    }

    fputs(".SH EXIT STATUS\n.TP\n0\nsuccess\n.TP\n1\nthe run failed or was interrupted\n.TP\n2\nbad input\n"
          ".SH ENVIRONMENT\n.TP\n.B NO_COLOR\nturns colours of messages off\n",
          page);
}

int command_manual(int argc, char **argv) {
    ManualOptions options = {0};
    ExitCode code;
    if (!args_read(&manual_command, argc, argv, &options, &code)) return code;

    const Command *const commands = command_table.commands, *command = NULL;
    const int count = command_table.command_count;
    const char *const word = options.command;
    const char *const folder = options.folder && !*options.folder ? "." : options.folder;

    for (int i = 0; i < count && word; i++)
        if (strcmp(word, commands[i].name) == 0) command = &commands[i];
    if (word && !command)
        return args_unknown(&manual_command, "unknown command", word, commands, count, sizeof *commands);

    if (!folder) {
        print_page(stdout, command);
        return EXIT_GOOD;
    }

    Console console = console_make(false);
    SingeError error = {0};
    if (folder_make(folder, &error)) {
        console_result(&console, &error);
        return EXIT_FAILED;
    }

    for (int i = -1; i < count && !code; i++) {
        if (i >= 0 && !commands[i].group) continue;
        char *path = text_format("%s/singe%s%s.1", folder, i < 0 ? "" : "-", i < 0 ? "" : commands[i].name);
        code = console_write_table(&console, path, print_page, i < 0 ? NULL : &commands[i]);
        free(path);
    }

    return code;
}
