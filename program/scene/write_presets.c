// Writes src/materials/presets.c to standard output, from the material files; with a file's name, compares that file with
// it instead.
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A parameter or number of a material, by its name in SingeMaterialDef.
typedef struct PresetRow {
    const char *name;
    size_t offset;
    int colours; ///< SINGE_COLOUR_COUNT if there is one for each colour, else 0
} PresetRow;

static const PresetRow params[] = {
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    {#name, offsetof(SingeMaterialDef, name), 0},
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) \
    {#name, offsetof(SingeMaterialDef, name), SINGE_COLOUR_COUNT},
#include "singe/material.def"
};

/// The shortest decimal number that reads back as the value.
static void write_float(FILE *out, float value) {
    char text[40] = "";
    if (isinf(value)) {
        fprintf(out, "INFINITY");
        return;
    }

    if (value == (float)(int)value && fabsf(value) < 1e6f) {
        fprintf(out, "%d", (int)value);
        return;
    }

    for (int digits = 1; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) break;
    }

    fprintf(out, strpbrk(text, ".e") ? "%sf" : "%s", text);
}

static void write_param(FILE *out, const PresetRow *row, int colour, const SingeParam *param) {
    char name[80], noise[80];
    if (row->colours) snprintf(name, sizeof name, "%s[%d]", row->name, colour);
    else snprintf(name, sizeof name, "%s", row->name);
    snprintf(noise, sizeof noise, "%s_%d", row->name, colour);

    if (param->field) {
        fprintf(out, "    static const SingeField %s = {.kind = SINGE_FIELD_NOISE, .noise = {", noise);
        write_float(out, param->field->noise.scale);
        fprintf(out, ", %d, %u}};\n", param->field->noise.octaves, (unsigned)param->field->noise.seed);
    }

    fprintf(out, "    def->%s = singe_param%s(", name, param->field ? "_field" : "");
    write_float(out, param->value);

    if (param->field) {
        fprintf(out, ", ");
        write_float(out, param->to);
        fprintf(out, ", &%s", noise);
    }

    fprintf(out, ");\n");
}

static void write_material(FILE *out, const char *name, const SingeMaterialDef *def) {
    const SingeMaterialDef standard = singe_default_material();
    fprintf(out, "static void ");
    for (const char *c = name; *c; c++) fputc(*c == '-' ? '_' : *c, out);
    fprintf(out, "(SingeMaterialDef *def) {\n    (void)def; // holds the defaults\n");

    for (size_t i = 0; i < sizeof params / sizeof *params; i++)
        for (int colour = 0; colour < (params[i].colours ? params[i].colours : 1); colour++) {
            const SingeParam *a = (const SingeParam *)((const char *)def + params[i].offset) + colour;
            const SingeParam *b = (const SingeParam *)((const char *)&standard + params[i].offset) + colour;
            bool same = !a->field == !b->field && a->value == b->value;
            if (same && a->field) {
                const SingeNoise *p = &a->field->noise, *q = &b->field->noise;
                same = a->to == b->to && a->field->kind == b->field->kind && p->scale == q->scale &&
                       p->octaves == q->octaves && p->seed == q->seed;
            }

            if (!same) write_param(out, &params[i], colour, a);
        }

    if (def->reference_grammage != standard.reference_grammage) {
        fprintf(out, "    def->reference_grammage = ");
        write_float(out, def->reference_grammage);
        fprintf(out, ";\n");
    }

    if (def->thickening != standard.thickening) {
        fprintf(out, "    def->thickening = ");
        write_float(out, def->thickening);
        fprintf(out, ";\n");
    }

    if (def->heat_operator != standard.heat_operator)
        fprintf(out, "    def->heat_operator = (SingeHeatOperator)%d;\n", (int)def->heat_operator);
    if (def->ablate != standard.ablate) fprintf(out, "    def->ablate = %s;\n", def->ablate ? "true" : "false");
    fprintf(out, "}\n\n");
}

int main(int argc, char **argv) {
    char *text = NULL;
    const char *name;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return 1;

    fprintf(
        out,
        "// Made by scene_presets from the files of this folder. Do not edit: change those and run\n"
        "// `build/program/scene/scene_presets > src/materials/presets.c`.\n#include \"materials/preset.h\"\n\n#include <math.h>\n\n");

    for (int i = 0; (name = scene_material_name(i)); i++) {
        // read as a scene does
        Scene *scene;
        char sheet[200];
        SceneMessages messages = {0};
        snprintf(sheet, sizeof sheet, "sheets: [{grid: {size: [10 cm, 10 cm], cells: [2, 2]}, material: %s}]\n", name);

        SingeResult result = scene_parse("presets", sheet, strlen(sheet), NULL, NULL, 0, &scene, &messages);
        scene_messages_print(&messages, stderr);
        scene_messages_free(&messages);
        if (result) return 1;
        write_material(out, name, &scene->sheets[0].material.def);
        scene_free(scene);
    }

    fprintf(out, "const MaterialPreset material_presets[] = {\n");
    for (int i = 0; (name = scene_material_name(i)); i++) {
        fprintf(out, "    {\"%s\", ", name);
        for (const char *c = name; *c; c++) fputc(*c == '-' ? '_' : *c, out);
        fprintf(out, "},\n");
    }

    fprintf(out, "    {0},\n};\n");
    if (fclose(out)) return 1;
    if (argc < 2) return fwrite(text, 1, size, stdout) == size && fflush(stdout) == 0 ? 0 : 1;

    Bytes bytes = {0};
    SingeError error;
    if (file_read(argv[1], (SingeAllocator){0}, &bytes, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }

    bool equal = bytes.size == size && memcmp(bytes.data, text, size) == 0;
    if (!equal) fprintf(stderr, "%s: differs from the material files; run scene_presets > %s\n", argv[1], argv[1]);
    bytes_free(&bytes);
    free(text);
    return equal ? 0 : 1;
}
