#include "cli/args.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/job.h"
#include "common/printable.h"
#include "scene/schema.h"

bool args_complain(const ArgCommand *command, const char *format, ...) {
    va_list list;
    va_start(list, format);
    char text[4096];
    vsnprintf(text, sizeof text, format, list);
    va_end(list);

    printable_trim(text);
    fprintf(stderr, "singe %s: error: ", command->name);
    printable_write(text, stderr);
    fprintf(stderr, "\nsee: singe %s --help\n", command->name);
    return false;
}

const char *args_nearest(const char *word, const void *first, int count, unsigned long stride) {
    Nearest nearest = {.word = word};
    const size_t length = strlen(word);

    for (int i = 0; i < count; i++) {
        const char *name;
        memcpy(&name, (const char *)first + (unsigned long)i * stride, sizeof name);
        const bool begun = length >= 3 && strncmp(word, name, length) == 0 && length < strlen(name);
        if (!begun) nearest_offer(&nearest, name);
        else if (!nearest.best || nearest.distance > 1) nearest = (Nearest){word, name, 1};
    }

    return nearest.best;
}

ExitCode args_unknown(const ArgCommand *command, const char *what, const char *word, const void *first, int count,
                      unsigned long stride) {
    const char *near = args_nearest(word, first, count, stride);
    if (near) args_complain(command, "%s '%s'; did you mean '%s'?", what, shown(word).text, near);
    else args_complain(command, "%s '%s'", what, shown(word).text);
    return EXIT_INPUT;
}

/// A command line that is being read.
typedef struct ArgReader {
    const ArgCommand *command;
    int argc, index;
    char **argv;
    int letters; ///< position within a group of one-letter switches
    void *options;
    bool help;
} ArgReader;

static bool unknown_option(const ArgReader *reader, const char *argument, const char *name) {
    const ArgCommand *command = reader->command;
    const char *near = args_nearest(name, command->options, command->option_count, sizeof *command->options);
    if (near) return args_complain(command, "unknown option '%s'; did you mean '--%s'?", shown(argument).text, near);
    return args_complain(command, "unknown option '%s'", shown(argument).text);
}

static bool take(const ArgReader *reader, const ArgOption *option, const char *value) {
    return option->read(reader->command, option, value, (char *)reader->options + option->field);
}

static bool take_long(ArgReader *reader, const char *argument) {
    const ArgCommand *command = reader->command;
    const char *name = argument + 2, *equals = strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    if (length == 4 && strncmp(name, "help", 4) == 0 && !equals) return reader->help = true;

    for (int i = 0; i < command->option_count; i++) {
        const ArgOption *option = &command->options[i];
        if (strlen(option->name) != length || strncmp(option->name, name, length) != 0) continue;
        if (!option->value && equals) return args_complain(command, "--%s takes no value", option->name);
        if (option->value && !equals && reader->index >= reader->argc)
            return args_complain(command, "--%s needs %s", option->name, option->value);
        return take(reader, option, !option->value ? NULL : equals ? equals + 1 : reader->argv[reader->index++]);
    }

    char word[41]; // longer words are no misspellings
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), name);
    return unknown_option(reader, argument, word);
}

static bool take_letter(ArgReader *reader) {
    const ArgCommand *command = reader->command;
    const char *argument = reader->argv[reader->index], *rest = argument + reader->letters + 1;
    const char letter = argument[reader->letters];
    if (letter == 'h') return reader->help = true;

    int i = 0;
    while (i < command->option_count && command->options[i].letter != letter) i++;
    if (i == command->option_count) return unknown_option(reader, argument, argument + 1);

    // a switch may be followed by others; a value is the rest of the word or the next one
    const ArgOption *option = &command->options[i];
    if (!option->value && *rest) {
        reader->letters++;
        return take(reader, option, NULL);
    }

    reader->index++;
    reader->letters = 0;
    if (!option->value) return take(reader, option, NULL);
    if (!*rest && reader->index >= reader->argc) return args_complain(command, "-%c needs %s", letter, option->value);

    return take(reader, option, *rest ? rest : reader->argv[reader->index++]);
}

bool args_read(const ArgCommand *command, int argc, char **argv, void *options, ExitCode *code) {
    ArgReader reader = {.command = command, .argc = argc, .argv = argv, .options = options};
    bool good = true, operands_only = false, operand = false;
    while (good && !reader.help && reader.index < argc) {
        const char *argument = argv[reader.index];
        if (reader.letters) {
            good = take_letter(&reader);
        } else if (!operands_only && strcmp(argument, "--") == 0) {
            operands_only = true;
            reader.index++;
        } else if (!operands_only && strncmp(argument, "--", 2) == 0) {
            reader.index++;
            good = take_long(&reader, argument);
        } else if (!operands_only && argument[0] == '-' && argument[1]) {
            reader.letters = 1;
            good = take_letter(&reader);
        } else if (!command->operand || operand) {
            good = args_complain(command, "unexpected argument '%s'", shown(argument).text);
        } else {
            operand = true;
            reader.index++;
            memcpy((char *)options + command->operand_field, &argument, sizeof argument);
        }
    }

    if (good && !reader.help && command->operand && command->operand[0] != '[' && !operand)
        good = args_complain(command, "needs %s", command->operand);
    if (good && !reader.help && command->check) good = command->check(command, options);
    if (reader.help) args_help(command);
    *code = good ? EXIT_GOOD : EXIT_INPUT;
    return good && !reader.help;
}

void args_help(const ArgCommand *command) {
    printf("usage: singe %s%s%s%s\n\n%s\n", command->name, command->operand ? " " : "",
           command->operand ? command->operand : "", command->option_count ? " [options]" : "", command->summary);
    if (command->option_count) printf("\noptions:\n");

    for (int i = 0; i < command->option_count; i++) {
        const ArgOption *option = &command->options[i];
        char left[64], letter[8] = "    ";
        if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
        snprintf(left, sizeof left, "%s--%s%s%s", letter, option->name, option->value ? " " : "",
                 option->value ? option->value : "");
        printf("  %-26s %s\n", left, option->help);
    }

    printf("  %-26s %s\n", "-h, --help", "this text");
    args_examples(command);
    if (command->footer) printf("\n%s\n", command->footer);
}

void args_examples(const ArgCommand *command) {
    if (command->examples) printf("\nexamples:\n");
    for (const char *line = command->examples; line && *line;) {
        const size_t length = strcspn(line, "\n");
        printf("  %.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

bool args_switch(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    (void)command, (void)option, (void)text;
    return *(bool *)field = true;
}

bool args_text(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    (void)command, (void)option;
    *(const char **)field = text;
    return true;
}

bool args_folder(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    if (!text[0]) return args_complain(command, "--%s: expected a folder", option->name);
    return args_text(command, option, text, field);
}

bool args_set(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    (void)command, (void)option;
    set_add(field, text);
    return true;
}

bool args_int(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    char *end;
    errno = 0;
    const long value = strtol(text, &end, 10);
    const bool good = errno == 0 && end != text && *end == 0;
    if (!good || (double)value < option->low || (double)value > option->high)
        return args_complain(command, "--%s: expected a whole number from %.0f to %.0f, got '%s'", option->name,
                             option->low, option->high, shown(text).text);

    *(int *)field = (int)value;
    return true;
}

bool args_number(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    char *end, range[64];
    errno = 0;
    const double number = strtod(text, &end);

    if (option->high < ARG_HIGHEST) snprintf(range, sizeof range, "from %.10g to %.10g", option->low, option->high);
    else snprintf(range, sizeof range, "of %.10g or more", option->low);
    if (errno || end == text || *end || !(number >= option->low && number <= option->high))
        return args_complain(command, "--%s %s: expected a number %s, got '%s'", option->name, option->value, range,
                             shown(text).text);

    *(double *)field = number;
    return true;
}

bool args_span(const ArgCommand *command, const ArgOption *option, const char *text, void *field) {
    char *end;
    errno = 0;
    long a = strtol(text, &end, 10), b = a;
    bool good = errno == 0 && end != text;
    if (good && *end == '-') {
        const char *second = end + 1;
        b = strtol(second, &end, 10);
        good = errno == 0 && end != second;
    }

    if (!good || *end != 0 || a < 1 || a > b || b > INT_MAX)
        return args_complain(command, "--%s: expected A-B with 1 <= A <= B, got '%s'", option->name, shown(text).text);

    int *span = field;
    span[0] = (int)a;
    span[1] = (int)b;
    return true;
}
