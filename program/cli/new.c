// singe new: a commented scene to begin with. singe materials: the built-in materials, and the text of one.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/args.h"
#include "cli/cli.h"
#include "cli/console.h"
#include "cli/folder.h"
#include "cli/text.h"
#include "common/printable.h"
#include "scene/builtin.h"

#define PI 3.14159265358979323846

/// The files of templates/, embedded.
extern const SceneBuiltin new_templates[];

/// A template: a scene to begin with, and a file that it needs, which is written only if it does not exist.
static const struct {
    const char *name, *file, *needs;
} templates[] = {
    {"letter", "letter.yaml", NULL},
    {"cloth", "cloth.yaml", NULL},
    {"mesh", "mesh.yaml", "mesh.obj"},
    {"sweep", "sweep.yaml", "letter.yaml"},
};

enum { TEMPLATES = sizeof templates / sizeof *templates };
typedef struct NewOptions {
    const char *name, *folder;
    bool force;
} NewOptions;

static const ArgOption new_options[] = {
    {"output", 'o', "DIR", "folder of the scene [.]", .read = args_text, offsetof(NewOptions, folder)},
    {"force", 'f', NULL, "replaces a file of this name", .read = args_switch, offsetof(NewOptions, force)},
};

const ArgCommand new_command = {
    "new",
    "TEMPLATE",
    "Writes a commented scene to start from: letter, cloth, mesh or sweep.",
    ARGS_OPTIONS(new_options),
    "letter  a sheet of paper burns on a table\n"
    "cloth   a cloth hangs, and burns in the wind\n"
    "mesh    a sample mesh burns; replace it with yours\n"
    "sweep   the letter burns many times with different parameters\n\n"
    "Exit codes: 0 success, 1 a file could not be written, 2 bad input, or the file already exists.",
    "singe new letter\n"
    "singe new mesh -o lamp",
    .operand_field = offsetof(NewOptions, name)};

const char *new_template_word(int index) { return index < TEMPLATES ? templates[index].name : NULL; }

/// The paper shade of a lamp: rows of quads on a cone, as OBJ. The seam's vertices have two uv each.
static void print_lamp(FILE *file) {
    enum { AROUND = 48, ROWS = 18 };
    fputs("# The paper shade of a lamp: a cone, open above and below, in metres; z is up.\n", file);

    for (int j = 0; j <= ROWS; j++)
        for (int i = 0; i < AROUND; i++) {
            const double radius = 0.1 - 0.02 * j / ROWS, angle = 2 * PI * i / AROUND;
            fprintf(file, "v %.5f %.5f %.5f\n", radius * cos(angle), radius * sin(angle), 0.12 * j / ROWS);
        }

    for (int j = 0; j <= ROWS; j++)
        for (int i = 0; i <= AROUND; i++) fprintf(file, "vt %.4f %.4f\n", (double)i / AROUND, (double)j / ROWS);

    for (int j = 0; j < ROWS; j++)
        for (int i = 0; i < AROUND; i++) {
            const int v = j * AROUND + 1, uv = j * (AROUND + 1) + 1, next = (i + 1) % AROUND;
            fprintf(file, "f %d/%d %d/%d %d/%d %d/%d\n", v + i, uv + i, v + next, uv + i + 1, v + AROUND + next,
                    uv + AROUND + i + 2, v + AROUND + i, uv + AROUND + i + 1);
        }
}

/// One of the templates by its name, or the lamp, which is the only file that is not embedded.
static void print_file(FILE *file, const void *name) {
    const SceneBuiltin *found = new_templates;
    while (found->name && strcmp(found->name, name) != 0) found++;
    if (found->name) fwrite(found->bytes, 1, found->size, file);
    else print_lamp(file);
}

int command_new(int argc, char **argv) {
    NewOptions options = {.folder = "."};
    ExitCode code;
    if (!args_read(&new_command, argc, argv, &options, &code)) return code;

    const char *word = options.name, *folder = *options.folder ? options.folder : ".";
    int which = 0;
    while (which < TEMPLATES && strcmp(templates[which].name, word) != 0) which++;
    if (which == TEMPLATES)
        return args_unknown(&new_command, "expected letter, cloth, mesh or sweep, got", word, templates, TEMPLATES,
                            sizeof *templates);

    Console console = console_make(false);
    SingeError error = {0};
    if (folder_make(folder, &error)) {
        console_result(&console, &error);
        return EXIT_FAILED;
    }

    // what is needed comes first, so that the scene is never without it
    const char *const files[] = {templates[which].needs, templates[which].file};
    const char *before = strcmp(folder, ".") == 0 ? "" : folder, *slash = *before ? "/" : "";
    char *paths[2];
    struct stat info;

    for (int i = 0; i < 2; i++) paths[i] = text_format("%s%s%s", before, slash, files[i] ? files[i] : "");
    if (!options.force && lstat(paths[1], &info) == 0) {
        console_error(&console, "%s already exists; --force replaces it", shown_path(paths[1]).text);
        code = EXIT_INPUT;
    }

    for (int i = 0; i < 2 && !code; i++) {
        if (!files[i] || (i == 0 && lstat(paths[0], &info) == 0)) continue;
        code = console_write_table(&console, paths[i], print_file, files[i]);
        if (!code) printf("%s\n", paths[i]);
    }

    if (!code) console_note(&console, "next: singe %s %s", which == TEMPLATES - 1 ? "sweep" : "check", paths[1]);
    for (int i = 0; i < 2; i++) free(paths[i]);
    return code;
}

// ---- materials

const ArgCommand materials_command = {
    .name = "materials",
    .operand = "[MATERIAL]",
    .summary = "Lists the built-in materials, or prints one as a file that you can change.",
    .footer = "A scene names a material by `material: newsprint`, or a file by `material: mine.yaml`.\n"
              "Exit codes: 0 success, 2 bad input.",
    .examples = "singe materials\n"
                "singe materials newsprint > mine.yaml",
};

int command_materials(int argc, char **argv) {
    const char *word = NULL;
    ExitCode code;
    if (!args_read(&materials_command, argc, argv, &word, &code)) return code;

    int count = 0;
    for (const SceneBuiltin *material = scene_builtins; material->name; material++, count++) {
        if (word && strcmp(word, material->name) == 0) {
            fwrite(material->bytes, 1, material->size, stdout);
            return EXIT_GOOD;
        }
        if (word) continue;

        // the first sentence of the file's comment
        const char *text = material->bytes + strspn(material->bytes, "# "), *dot = strpbrk(text, ":.");
        printf("%-14s %.*s\n", material->name, (int)(dot - text), text);
    }

    if (!word) return EXIT_GOOD;
    return args_unknown(&materials_command, "there is no material", word, scene_builtins, count,
                        sizeof *scene_builtins);
}
