#include "cli/args.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/printable.h"
#include "scene/schema.h"

ArgReader args_begin(const ArgCommand *command, int argc, char **argv) {
    return (ArgReader){.command = command, .argc = argc, .argv = argv};
}

int args_complain(const ArgReader *reader, const char *format, ...) {
    va_list list;
    va_start(list, format);
    char text[4096];
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    printable_trim(text);
    fprintf(stderr, "singe %s: error: ", reader->command->name);
    printable_write(text, stderr);
    fprintf(stderr, "\nsee: singe %s --help\n", reader->command->name);
    return ARG_ERROR;
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

static int unknown_option(const ArgReader *reader, const char *argument, const char *name) {
    const ArgCommand *command = reader->command;
    const char *near = args_nearest(name, command->options, command->option_count, sizeof *command->options);
    if (near) return args_complain(reader, "unknown option '%s'; did you mean '--%s'?", shown(argument).text, near);
    return args_complain(reader, "unknown option '%s'", shown(argument).text);
}

static int take_long(ArgReader *reader, const char *argument, const char **value) {
    const ArgCommand *command = reader->command;
    const char *name = argument + 2, *equals = strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    if (length == 4 && strncmp(name, "help", 4) == 0 && !equals) {
        args_help(command);
        return ARG_HELP;
    }

    for (int i = 0; i < command->option_count; i++) {
        const ArgOption *option = &command->options[i];
        if (strlen(option->name) != length || strncmp(option->name, name, length) != 0) continue;
        if (!option->value && equals) return args_complain(reader, "--%s takes no value", option->name);
        if (option->value && !equals && reader->index >= reader->argc)
            return args_complain(reader, "--%s needs %s", option->name, option->value);
        *value = !option->value ? NULL : equals ? equals + 1 : reader->argv[reader->index++];
        return i;
    }

    char word[41]; // longer words are no misspellings
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), name);
    return unknown_option(reader, argument, word);
}

static int take_letter(ArgReader *reader, const char **value) {
    const ArgCommand *command = reader->command;
    const char *argument = reader->argv[reader->index], *rest = argument + reader->letters + 1;
    const char letter = argument[reader->letters];
    if (letter == 'h') {
        args_help(command);
        return ARG_HELP;
    }

    int i = 0;
    while (i < command->option_count && command->options[i].letter != letter) i++;
    if (i == command->option_count) return unknown_option(reader, argument, argument + 1);

    // a switch may be followed by others; a value is the rest of the word or the next one
    const ArgOption *option = &command->options[i];
    *value = NULL;
    if (!option->value && *rest) {
        reader->letters++;
        return i;
    }

    reader->index++;
    reader->letters = 0;
    if (!option->value) return i;
    if (!*rest && reader->index >= reader->argc) return args_complain(reader, "-%c needs %s", letter, option->value);

    *value = *rest ? rest : reader->argv[reader->index++];
    return i;
}

int args_next(ArgReader *reader, const char **value) {
    const ArgCommand *command = reader->command;
    if (reader->letters) return take_letter(reader, value);
    if (reader->index < reader->argc && !reader->operands_only && strcmp(reader->argv[reader->index], "--") == 0) {
        reader->operands_only = true;
        reader->index++;
    }

    if (reader->index >= reader->argc) {
        if (command->operand && command->operand[0] != '[' && reader->operand_count == 0)
            return args_complain(reader, "needs %s", command->operand);
        return ARG_END;
    }

    const char *argument = reader->argv[reader->index];
    if (!reader->operands_only && strncmp(argument, "--", 2) == 0) {
        reader->index++;
        return take_long(reader, argument, value);
    }

    if (!reader->operands_only && argument[0] == '-' && argument[1]) {
        reader->letters = 1;
        return take_letter(reader, value);
    }

    if (!command->operand || (++reader->operand_count > 1 && !strstr(command->operand, "...")))
        return args_complain(reader, "unexpected argument '%s'", shown(argument).text);
    reader->index++;
    *value = argument;
    return ARG_OPERAND;
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

bool args_int(const ArgReader *reader, int option, const char *text, int low, int high, int *number) {
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (errno == 0 && end != text && *end == 0 && value >= low && value <= high) {
        *number = (int)value;
        return true;
    }

    args_complain(reader, "--%s: expected a whole number from %d to %d, got '%s'",
                  reader->command->options[option].name, low, high, shown(text).text);
    return false;
}

bool args_span(const ArgReader *reader, int option, const char *text, int *first, int *last) {
    char *end;
    errno = 0;
    long a = strtol(text, &end, 10), b = a;
    bool good = errno == 0 && end != text;
    if (good && *end == '-') {
        const char *second = end + 1;
        b = strtol(second, &end, 10);
        good = errno == 0 && end != second;
    }

    if (good && *end == 0 && a >= 1 && a <= b && b <= INT_MAX) {
        *first = (int)a;
        *last = (int)b;
        return true;
    }

    args_complain(reader, "--%s: expected A-B with 1 <= A <= B, got '%s'", reader->command->options[option].name,
                  shown(text).text);
    return false;
}
