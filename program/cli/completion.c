// singe completion: what a shell completes after `singe`, from the tables that the commands read.
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/args.h"
#include "cli/cli.h"
#include "common/printable.h"

const ArgCommand completion_command = {.name = "completion",
                                       .operand = "SHELL",
                                       .summary = "Prints a script that lets bash, zsh or fish complete commands, "
                                                  "options and files.",
                                       .footer = "Packages install these scripts. Exit codes: 0 success, 2 bad input.",
                                       .examples = "eval \"$(singe completion bash)\"\n"
                                                   "singe completion zsh > ~/.zfunc/_singe\n"
                                                   "singe completion fish > ~/.config/fish/completions/singe.fish"};

/// What a value is, by its name: "DIR", or "[COMMAND]" of an operand. NULL: nothing that can be completed.
static const CommandValue *value_of(const char *name) {
    if (name && *name == '[') name++;
    for (int i = 0; name && i < command_table.value_count; i++) {
        const size_t length = strlen(command_table.values[i].name);
        if (strncmp(name, command_table.values[i].name, length) == 0 && (!name[length] || strchr("].|", name[length])))
            return &command_table.values[i];
    }

    return NULL;
}

/// Whether an option before this one has its name: measurements of bench share names.
static bool named_before(const ArgCommand *command, int option) {
    for (int i = 0; i < option; i++)
        if (strcmp(command->options[i].name, command->options[option].name) == 0) return true;
    return false;
}

static void put_words(const CommandValue *value) {
    const char *word;
    for (int i = 0; (word = value->word(i)); i++) printf("%s%s", i ? " " : "", word);
}

/// Text within single quotes, with a backslash before each character of `escaped`.
static void put_quoted(const char *text, const char *escaped) {
    for (; *text; text++) {
        if (*text == '\'') fputs("'\\''", stdout);
        else printf(*text != '\n' && strchr(escaped, *text) ? "\\%c" : "%c", *text == '\n' ? ' ' : *text);
    }
}

// ---- bash

static void bash_value(const char *name) {
    const CommandValue *value = value_of(name);
    if (!value) {
        putchar(':');
    } else if (value->kind == VALUE_WORD) {
        fputs("_singe_words '", stdout);
        put_words(value);
        putchar('\'');
    } else {
        fputs(value->kind == VALUE_FOLDER ? "_singe_files -d"
              : value->kind == VALUE_YAML ? "_singe_files -f '!*.@(yaml|yml|json)'"
                                          : "_singe_files -f",
              stdout);
    }
}

static void bash_command(const Command *command) {
    const ArgCommand *arguments = command->arguments;
    printf("    %s)\n        case $previous in\n", command->name);

    for (int i = 0; i < arguments->option_count; i++) {
        const ArgOption *option = &arguments->options[i];
        if (!option->value || named_before(arguments, i)) continue;
        fputs("        ", stdout);
        if (option->letter) printf("-%c | ", option->letter);
        printf("--%s)\n            ", option->name);
        bash_value(option->value);
        fputs("\n            return ;;\n", stdout);
    }

    fputs("        esac\n        options='--help", stdout);
    for (int i = 0; i < arguments->option_count; i++)
        if (!named_before(arguments, i)) printf(" --%s", arguments->options[i].name);
    fputs("'\n        [[ $current == -* ]] || ", stdout);
    bash_value(arguments->operand);
    fputs(" ;;\n", stdout);
}

static void bash(void) {
    fputs("# bash completion for singe, made by `singe completion bash`\n"
          "_singe_words() { COMPREPLY=($(compgen -W \"$1\" -- \"$current\")); }\n"
          "_singe_files() {\n"
          "    local IFS=$'\\n' glob\n"
          "    glob=$(shopt -p extglob)\n"
          "    shopt -s extglob\n"
          "    compopt -o filenames 2> /dev/null\n"
          "    COMPREPLY=($(compgen -d -- \"$current\"; [[ $1 == -f ]] && compgen -f -X \"$2\" -- \"$current\"))\n"
          "    COMPREPLY=($(printf '%s\\n' \"${COMPREPLY[@]}\" | sort -u))\n"
          "    eval \"$glob\"\n"
          "}\n"
          "_singe() {\n"
          "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} options=\n"
          "    COMPREPLY=()\n"
          "    [[ $current == = ]] && current=\n"
          "    [[ $previous == = ]] && previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
          "    [[ ${COMP_WORDS[COMP_CWORD]} == = ]] && previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
          "    local commands='help",
          stdout);

    for (int i = 0; i < command_table.command_count; i++)
        if (command_table.commands[i].group) printf(" %s", command_table.commands[i].name);

    fputs("'\n"
          "    if ((COMP_CWORD == 1)); then\n"
          "        _singe_words \"$commands --help --version\"\n"
          "        return\n"
          "    fi\n"
          "    case ${COMP_WORDS[1]} in\n"
          "    help) _singe_words \"$commands\" ;;\n",
          stdout);

    for (int i = 0; i < command_table.command_count; i++) bash_command(&command_table.commands[i]);
    fputs("    esac\n"
          "    [[ $current == -* ]] && _singe_words \"$options\"\n"
          "    return 0\n"
          "}\n"
          "complete -F _singe singe\n",
          stdout);
}

// ---- zsh

static void zsh_value(const char *name) {
    const CommandValue *value = value_of(name);
    printf(":%s:", name + (*name == '['));

    if (value && value->kind == VALUE_WORD) {
        putchar('(');
        put_words(value);
        putchar(')');
    } else if (value) {
        fputs(value->kind == VALUE_FOLDER ? "_files -/"
              : value->kind == VALUE_YAML ? "_files -g \"*.(yaml|yml|json)\""
                                          : "_files",
              stdout);
    }
}

static void zsh_command(const Command *command) {
    const ArgCommand *arguments = command->arguments;
    printf("    (%s)\n      _arguments -s '(- *)'{-h,--help}'[prints the options]'", command->name);

    for (int i = 0; i < arguments->option_count; i++) {
        const ArgOption *option = &arguments->options[i];
        if (named_before(arguments, i)) continue;

        fputs(" \\\n        ", stdout);
        if (strstr(option->help, "may be repeated")) fputs("'*'", stdout);
        else if (option->letter) printf("'(-%c --%s)'", option->letter, option->name);
        if (option->letter) printf(option->value ? "{-%c+,--%s=}'[" : "{-%c,--%s}'[", option->letter, option->name);
        else printf(option->value ? "'--%s=[" : "'--%s[", option->name);
        put_quoted(option->help, "[]\\:");
        putchar(']');
        if (option->value) zsh_value(option->value);
        putchar('\'');
    }

    if (arguments->operand) {
        fputs(" \\\n        '1", stdout);
        zsh_value(arguments->operand);
        putchar('\'');
    }

    fputs(" ;;\n", stdout);
}

static void zsh(void) {
    fputs("#compdef singe\n"
          "# zsh completion for singe, made by `singe completion zsh`\n"
          "_singe() {\n"
          "  local curcontext=\"$curcontext\" state line\n"
          "  local -a commands=(\n"
          "    'help:shows the options of a command'\n",
          stdout);

    for (int i = 0; i < command_table.command_count; i++) {
        const Command *command = &command_table.commands[i];
        if (!command->group) continue;
        printf("    '%s:", command->name);
        put_quoted(command->summary, ":\\");
        fputs("'\n", stdout);
    }

    fputs("  )\n"
          "  _arguments -C '(- *)'{-h,--help}'[prints the commands]' '(- *)--version[prints the version]' \\\n"
          "    '1:command:->command' '*::argument:->argument'\n"
          "  case $state in\n"
          "  (command) _describe -t commands command commands ;;\n"
          "  (argument)\n"
          "    case $words[1] in\n"
          "    (help) _describe -t commands command commands ;;\n",
          stdout);

    for (int i = 0; i < command_table.command_count; i++) zsh_command(&command_table.commands[i]);
    fputs("    esac ;;\n"
          "  esac\n"
          "}\n"
          "if [[ $funcstack[1] == _singe ]]; then _singe \"$@\"; else compdef _singe singe; fi\n",
          stdout);
}

// ---- fish

/// After an option, `-x -a` offers only what follows; files need `-r -F`.
static void fish_value(const char *name, bool option) {
    const CommandValue *value = value_of(name);
    if (!value) {
        if (option) fputs(" -x", stdout);
    } else if (value->kind == VALUE_WORD) {
        printf(" %s-a '", option ? "-x " : "");
        put_words(value);
        putchar('\'');
    } else if (value->kind == VALUE_FOLDER) {
        printf(" %s-a '(__fish_complete_directories)'", option ? "-x " : "");
    } else if (value->kind == VALUE_YAML) {
        fputs(" -k -a '(__fish_complete_suffix .yaml)'", stdout);
    } else {
        fputs(option ? " -r -F" : " -F", stdout);
    }
}

static void fish(void) {
    fputs("# fish completion for singe, made by `singe completion fish`\n"
          "complete -c singe -f\n"
          "complete -c singe -n __fish_use_subcommand -l version -d 'prints the version'\n"
          "complete -c singe -s h -l help -d 'prints the options'\n"
          "complete -c singe -n '__fish_use_subcommand; or __fish_seen_subcommand_from help' -a help "
          "-d 'shows the options of a command'\n",
          stdout);

    for (int i = 0; i < command_table.command_count; i++) {
        const Command *command = &command_table.commands[i];
        if (!command->group) continue;
        printf("complete -c singe -n '__fish_use_subcommand; or __fish_seen_subcommand_from help' -a %s -d '",
               command->name);
        put_quoted(command->summary, "\\");
        fputs("'\n", stdout);
    }

    for (int i = 0; i < command_table.command_count; i++) {
        const Command *command = &command_table.commands[i];
        const ArgCommand *arguments = command->arguments;
        for (int j = 0; j < arguments->option_count; j++) {
            const ArgOption *option = &arguments->options[j];
            if (named_before(arguments, j)) continue;

            printf("complete -c singe -n '__fish_seen_subcommand_from %s'", command->name);
            if (option->letter) printf(" -s %c", option->letter);
            printf(" -l %s -d '", option->name);
            put_quoted(option->help, "\\");
            putchar('\'');
            if (option->value) fish_value(option->value, true);
            putchar('\n');
        }

        if (!value_of(arguments->operand)) continue;
        printf("complete -c singe -n '__fish_seen_subcommand_from %s'", command->name);
        fish_value(arguments->operand, false);
        putchar('\n');
    }
}

static const struct {
    const char *name;
    void (*print)(void);
} shells[] = {{"bash", bash}, {"zsh", zsh}, {"fish", fish}};

enum { SHELLS = sizeof shells / sizeof *shells };

const char *completion_shell_word(int index) { return index < SHELLS ? shells[index].name : NULL; }

int command_completion(int argc, char **argv) {
    const char *word;
    ExitCode code;
    if (!args_read(&completion_command, argc, argv, &word, &code)) return code;

    for (int i = 0; i < SHELLS; i++) {
        if (strcmp(word, shells[i].name) != 0) continue;
        shells[i].print();
        return EXIT_GOOD;
    }

    args_complain(&completion_command, "expected bash, zsh or fish, got '%s'", shown(word).text);
    return EXIT_INPUT;
}
