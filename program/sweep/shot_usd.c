// The shot of a scene whose sheets ran in rows (method `sheets`): a USD file that refers to the root of each row.
// Camera, lights, ground and colliders are in every root; those of the first row are kept.
#include <stdio.h>
#include <stdlib.h>

#include "cli/folder.h"
#include "cli/text.h"
#include "formats/formats.h"
#include "formats/usd.h"
#include "sweep/sweep.h"

static bool has_root(const Sweep *sweep, uint32_t row) {
    char *path = text_format("%s/rows/%04u/%s.usda", sweep->folder, row + 1, sweep->name);
    const bool has = folder_has(path);
    free(path);
    return has;
}

static void write_row(const Sweep *sweep, uint32_t row, FILE *file) {
    static const char *const shared[] = {"camera", "sun", "sky", "props"};
    fprintf(file, "\n    def \"row_%04u\" (\n        prepend references = @./rows/%04u/%s.usda@\n    )\n    {\n",
            row + 1, row + 1, sweep->name);
    for (size_t i = 0; row && i < sizeof shared / sizeof *shared; i++)
        fprintf(file, "        over \"%s\" (\n            active = false\n        )\n        {\n        }\n",
                shared[i]);
    fputs("    }\n", file);
}

static void write_shot(const Sweep *sweep, double fps, FILE *file) {
    char name[USD_NAME];
    usd_name(sweep->name, name);
    fprintf(file,
            "#usda 1.0\n(\n    defaultPrim = \"%s\"\n    endTimeCode = %u\n    framesPerSecond = %.9g\n"
            "    metersPerUnit = 1\n    startTimeCode = 1\n    timeCodesPerSecond = %.9g\n    upAxis = \"Z\"\n)\n\n"
            "def Xform \"%s\" (\n    kind = \"assembly\"\n)\n{",
            name, sweep->frames[0], fps, fps, name);
    for (uint32_t row = 0; row < sweep->plan.row_count; row++) write_row(sweep, row, file);
    fputs("}\n", file);
}

bool sweep_write_shot(const Sweep *sweep, double fps) {
    for (uint32_t row = 0; row < sweep->plan.row_count; row++)
        if (!has_root(sweep, row)) return true;
    char *path = text_format("%s/%s.usda", sweep->folder, sweep->name), *text = NULL;
    size_t size = 0;
    SingeError error = {.code = SINGE_ERROR_MEMORY, .stage = "report", .element = -1};
    FILE *file = open_memstream(&text, &size);
    if (file) write_shot(sweep, fps, file);
    const bool good = text_stream_end(file, &text) && !file_write(path, text, size, &error);
    if (!good) console_result(sweep->console, &error);
    free(text), free(path);
    return good;
}
