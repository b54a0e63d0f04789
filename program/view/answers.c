// What the page may ask for, behind the token. `run/NUMBER/...` is of one run: after a restart the old ones are gone.
//
//   (nothing), view.js, ...   the page
//   state                     what is shown, and how far it is: asked several times a second
//   run/1/room                light, camera, ground, sheets
//   run/1/frame/12            a frame, as preview_pack writes it
//   run/1/solid/12/0          the triangles of a frame's shape
//   run/1/picture/0           what is printed on a sheet, of so many, and then on its back: width and height, then RGB
//   run/1/cells               the sheets' cells at rest: counts of vertices and cells, positions, four corners each
//   run/1/vertex/12/345       a vertex of the input in a frame
//   run/1/stats.csv, events.csv, probes.csv, run.json
//
// No path is built from a request: only the names of this list are served.
#include "view/view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/pictures.h"
#include "cli/text.h"
#include "scene/builtin.h"

enum { TABLE_BYTES = 64 << 20, LOG_BYTES = 4000 };

extern const SceneBuiltin view_pages[]; // made of web/view

Answer answer_text(unsigned status, const char *text) {
    return (Answer){.status = status,
                    .type = "text/plain; charset=utf-8",
                    .bytes = (char *)text,
                    .size = strlen(text),
                    .fixed = true};
}

static Answer answer_error(const SingeError *error) {
    char *text = text_format("%s", error->message[0] ? error->message : singe_result_name(error->code));
    return (Answer){.status = 500, .type = "text/plain; charset=utf-8", .bytes = text, .size = strlen(text)};
}

/// Bytes from malloc; NULL: there was no memory for them.
static Answer answer_data(void *bytes, size_t size) {
    if (!bytes) return answer_text(500, "out of memory");
    return (Answer){.status = 200, .type = "application/octet-stream", .bytes = bytes, .size = size, .large = true};
}

/// Writes a member that follows others.
static void put_text(FILE *out, const char *name, const char *text) {
    fprintf(out, ", \"%s\": ", name);
    text_json_string(out, text);
}

static Answer answer_nothing(void) { return answer_text(404, "not found"); }

/// Of a stream of open_memstream that has been written.
static Answer answer_stream(FILE *stream, char **text, const char *type) {
    if (!text_stream_end(stream, text)) {
        free(*text);
        return answer_text(500, "out of memory");
    }
    return (Answer){.status = 200, .type = type, .bytes = *text, .size = strlen(*text)};
}

// ---- what is shown

void shown_close(Exhibit *shown) {
    preview_destroy(shown->preview);
    free(shown->shapes);
    folder_free(&shown->folder);
    job_close(&shown->job);
    *shown = (Exhibit){.number = 0};
}

ExitCode shown_open(View *view, const char *path) {
    Exhibit shown = {.number = 1};
    const SetList none = {0};
    const ExitCode code = job_reopen(&shown.job, view->console, path, &none, 1);
    if (code) return code;

    shown.folder = folder_name(path, shown.job.scene->name);
    PreviewDef def;
    scene_preview(shown.job.scene, &shown.job.assets, &def);
    def.width = def.height = 1; // it draws nothing itself
    def.shutter = 0;

    SingeError error = {0};
    if (preview_create(&def, (SingeAllocator){0}, &shown.preview, &error)) {
        console_result(view->console, &error);
        shown_close(&shown);
        return EXIT_FAILED;
    }

    shown_close(&view->shown);
    view->shown = shown;
    return EXIT_GOOD;
}

/// The shapes of a time that are drawn. Returns their number, or -1 without memory.
static int64_t gather_shapes(Exhibit *shown, double time) {
    const Scene *scene = shown->job.scene;
    const SceneAssets *assets = &shown->job.assets;
    const uint32_t count = scene_shapes(scene, assets, time, NULL, 0);
    if (count > shown->shape_max || !shown->shapes) {
        PreviewShape *shapes = realloc(shown->shapes, (count + (size_t)1) * sizeof *shapes);
        if (!shapes) return -1;
        shown->shapes = shapes;
        shown->shape_max = count;
    }

    return scene_shapes(scene, assets, time, shown->shapes, shown->shape_max);
}

// ---- state and room

static Answer answer_state(const View *view) {
    const Live *live = &view->live;
    const Exhibit *shown = &view->shown;
    int first = 0, last = 0;
    SingeError error = {0};
    if (shown->number && folder_find(&shown->folder, &first, &last, &error)) return answer_error(&error);

    char *text = NULL;
    FILE *out = open_memstream(&text, &(size_t){0});
    if (!out) return answer_text(500, "out of memory");

    fprintf(out, "{\"version\": \"%s\", \"run\": %d, \"first\": %d, \"last\": %d, \"live\": %s", singe_version(),
            shown->number, first, last, live->scene ? "true" : "false");

    if (live->scene) {
        char log[LOG_BYTES + 1] = ""; // its end
        FILE *file = live->log ? fopen(live->log, "rb") : NULL;
        if (file) {
            if (fseek(file, -LOG_BYTES, SEEK_END) != 0) rewind(file);
            log[fread(log, 1, LOG_BYTES, file)] = 0;
            fclose(file);
        }

        fprintf(out, ", \"burning\": %s, \"newest\": %d, \"exit\": %d", live->process > 0 ? "true" : "false",
                live->number, live->exit_code);
        put_text(out, "scene", live->scene);
        put_text(out, "log", log);
    }

    put_text(out, "folder", shown->number ? shown->folder.path : "");
    fputs("}", out);
    return answer_stream(out, &text, "application/json");
}

static void put_numbers(FILE *out, const char *name, const float *values, int count) {
    fprintf(out, ", \"%s\": [", name);
    for (int i = 0; i < count; i++) {
        if (i) fputs(", ", out);
        text_json_number(out, (double)values[i]);
    }
    fputs("]", out);
}

static Answer answer_room(const Exhibit *shown) {
    const Scene *scene = shown->job.scene;
    PreviewDef def;
    scene_preview(scene, &shown->job.assets, &def);
    float sun[3], towards[3], ambient[9][3];
    preview_light(shown->preview, sun, towards, ambient);

    char *text = NULL;
    FILE *out = open_memstream(&text, &(size_t){0});
    if (!out) return answer_text(500, "out of memory");

    fputs("{\"name\": ", out);
    text_json_string(out, scene->name);
    fprintf(
        out,
        ", \"frames\": %d, \"fps\": %.9g, \"width\": %d, \"height\": %d, \"fov\": %.9g, \"exposure\": %.9g, \"sun_angle\": %.9g, \"ground\": %d, \"pace\": %.9g, "
        "\"sparks\": %.9g, \"flakes\": %.9g",
        scene->frames, (double)scene->fps, def.width, def.height, (double)def.camera.fov, (double)def.exposure,
        (double)def.sun_angle, (int)def.ground, (double)def.pace, (double)def.sparks, (double)def.flakes);

    fputs(", \"ground_height\": ", out);
    text_json_number(out, (double)def.ground_height); // null: there is none
    fprintf(out, ", \"wall\": %d, \"wall_turn\": %.9g, \"wall_distance\": ", (int)def.wall, (double)def.wall_turn);

    text_json_number(out, (double)def.wall_distance); // null: there is none
    put_numbers(out, "wall_colour", def.wall_colour, 3);
    put_numbers(out, "eye", def.camera.eye, 3);
    put_numbers(out, "target", def.camera.target, 3);
    put_numbers(out, "up", def.camera.up, 3);
    put_numbers(out, "ground_colour", def.ground_colour, 3);
    put_numbers(out, "background", def.background, 3);
    put_numbers(out, "sun", sun, 3);
    put_numbers(out, "towards", towards, 3);
    put_numbers(out, "ambient", &ambient[0][0], 27);
    fputs(", \"sheets\": [", out);

    for (uint32_t i = 0; i < def.sheet_count; i++) {
        static const float white[3] = {1, 1, 1};
        const bool cloth = def.looks && def.looks[i].weave > 0;
        fprintf(out, "%s{\"picture\": %s, \"back\": %s, \"cloth\": %s, \"transmittance\": %.9g", i ? ", " : "",
                def.pictures && def.pictures[i] ? "true" : "false", def.backs && def.backs[i] ? "true" : "false",
                cloth ? "true" : "false",
                def.transmittances ? (double)def.transmittances[i] : (double)PREVIEW_TRANSMITTANCE);
        put_numbers(out, "colour", def.colours ? def.colours[i] : white, 3);
        fputs("}", out);
    }

    fputs("]}", out);
    return answer_stream(out, &text, "application/json");
}

// ---- frames

static Answer answer_frame(Exhibit *shown, int number) {
    Frame frame;
    SingeError error = {0};
    char *path = folder_ply(&shown->folder, number);
    const bool there = access(path, F_OK) == 0;
    free(path);
    if (!there) return answer_nothing();

    uint8_t *bytes = NULL;
    size_t size = 0;
    SingeResult result = frame_read(&shown->folder, number, &frame, &error);
    const int64_t shapes = result ? 0 : gather_shapes(shown, frame.time);
    if (shapes < 0) {
        error = (SingeError){.code = SINGE_ERROR_MEMORY, .element = -1};
        result = SINGE_ERROR_MEMORY;
    }

    if (!result) result = preview_set_shapes(shown->preview, shown->shapes, (uint32_t)shapes, &error);
    if (!result) result = preview_set_gas(shown->preview, &frame.gas.view, &error);
    if (!result) result = preview_pack(shown->preview, &frame.surface, frame.time, &bytes, &size, &error);
    frame_free(&frame);
    if (result) return answer_error(&error);

    return (Answer){
        .status = 200, .type = "application/octet-stream", .bytes = (char *)bytes, .size = size, .large = true};
}

/// Two counts, and what they count, in two parts.
static Answer answer_pair(uint32_t a, uint32_t b, const void *first, size_t first_size, const void *second,
                          size_t second_size) {
    char *bytes = malloc(8 + first_size + second_size);
    if (!bytes) return answer_data(NULL, 0);
    memcpy(bytes, (const uint32_t[2]){a, b}, 8);
    memcpy(bytes + 8, first, first_size);
    if (second_size) memcpy(bytes + 8 + first_size, second, second_size);
    return answer_data(bytes, 8 + first_size + second_size);
}

/// Positions and triangles.
static Answer answer_solid(Exhibit *shown, int number, int wanted) {
    const int64_t count = gather_shapes(shown, (double)(number - 1) * scene_frame_time(shown->job.scene));
    int drawn = 0;
    for (int64_t i = 0; i < count; i++) {
        if (shown->shapes[i].kind == SINGE_COLLIDER_PLANE || drawn++ != wanted) continue;
        const PreviewSolid *solid = shown->shapes[i].solid;
        if (!solid) return answer_nothing();
        return answer_pair(solid->vertex_count, solid->triangle_count, solid->vertices,
                           12 * (size_t)solid->vertex_count, solid->triangles, 12 * (size_t)solid->triangle_count);
    }

    return answer_nothing();
}

static Answer answer_picture(const Exhibit *shown, int number) {
    PreviewDef def;
    scene_preview(shown->job.scene, &shown->job.assets, &def);
    const bool front = (uint32_t)number < def.sheet_count;
    const uint32_t sheet = front ? (uint32_t)number : (uint32_t)number - def.sheet_count;
    const Image *const *images = front ? def.pictures : def.backs;
    const Image *image = images && sheet < def.sheet_count ? images[sheet] : NULL;
    if (!image) return answer_nothing();
    return answer_pair((uint32_t)image->width, (uint32_t)image->height, image->rgb,
                       3 * (size_t)image->width * (size_t)image->height, NULL, 0);
}

/// The cells of all sheets, as one mesh.
static Answer answer_cells(const Exhibit *shown) {
    const SceneAssets *assets = &shown->job.assets;
    uint32_t counts[2] = {0, 0};
    for (uint32_t s = 0; s < assets->sheet_count; s++) {
        counts[0] += assets->meshes[s].vertex_count;
        counts[1] += assets->meshes[s].cell_count;
    }

    const size_t position_bytes = 3 * sizeof(float) * counts[0], corner_bytes = 4 * sizeof(uint32_t) * counts[1];
    const size_t size = sizeof counts + position_bytes + corner_bytes;
    char *bytes = malloc(size);
    if (!bytes) return answer_data(NULL, 0);

    memcpy(bytes, counts, sizeof counts);
    char *position = bytes + sizeof counts;
    uint32_t *corner = (uint32_t *)(void *)(position + position_bytes);
    uint32_t first = 0;
    for (uint32_t s = 0; s < assets->sheet_count; s++) {
        const Mesh *mesh = &assets->meshes[s];
        const size_t length = 3 * sizeof(float) * mesh->vertex_count;
        memcpy(position, mesh->positions, length);
        position += length;
        for (size_t k = 0; k < 4 * (size_t)mesh->cell_count; k++) *corner++ = first + mesh->cells[k];
        first += mesh->vertex_count;
    }

    return answer_data(bytes, size);
}

static Answer answer_vertex(Exhibit *shown, int number, int wanted) {
    Frame frame;
    SingeError error = {0};
    SingeResult result = frame_read_surface(&shown->folder, number, &frame, &error);
    const SingeSurface *surface = &frame.surface;
    uint32_t i = 0;
    while (!result && i < surface->vertex_count && surface->source_vertex[i] != wanted) i++;

    char *text = NULL;
    FILE *out = !result && i < surface->vertex_count ? open_memstream(&text, &(size_t){0}) : NULL;
    if (out) {
        const float values[] = {surface->temperature[i], surface->mass[i],      surface->char_fraction[i],
                                surface->burn[i],        surface->burn_rate[i], preview_stretch(surface, i)};
        fprintf(out, "{\"frame\": %d", number);
        put_numbers(out, "values", values, 6);
        put_numbers(out, "position", surface->position[i], 3);
        fputs("}", out);
    }

    frame_free(&frame);
    if (result) return answer_error(&error);

    return out ? answer_stream(out, &text, "application/json") : answer_nothing();
}

/// A run does not write every table: one that is not there is empty.
static Answer answer_file(const char *path, const char *type) {
    Bytes bytes = {0};
    SingeError error = {0};
    if (access(path, F_OK) != 0) return (Answer){.status = 200, .type = type, .bytes = "", .fixed = true};
    if (file_read_max(path, TABLE_BYTES, (SingeAllocator){0}, &bytes, &error)) return answer_error(&error);
    return (Answer){.status = 200, .type = type, .bytes = (char *)bytes.data, .size = bytes.size};
}

// ---- the paths

/// Reads "/NUMBER" at *text and moves behind it. False if there is none, or it is none of a frame, shape or vertex.
static bool take_number(const char **text, int *number) {
    if (**text != '/') return false;
    const char *digits = *text + 1;
    const size_t length = strspn(digits, "0123456789");
    if (length < 1 || length > 9) return false;
    *number = (int)strtol(digits, NULL, 10);
    *text = digits + length;
    return true;
}

static bool take_word(const char **text, const char *word) {
    const size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0) return false;
    *text += length;
    return true;
}

/// Whether the text is the word, and a number or two; `b` may be NULL.
static bool take_all(const char *text, const char *word, int *a, int *b) {
    return take_word(&text, word) && take_number(&text, a) && (!b || take_number(&text, b)) && !*text;
}

Answer answer_to(View *view, const char *path) {
    const char *rest = path;
    if (strcmp(path, "state") == 0) return answer_state(view);

    for (const SceneBuiltin *page = view_pages; page->name; page++) {
        if (strcmp(page->name, *path ? path : "index.html") != 0) continue;

        const char *dot = strrchr(page->name, '.');
        const bool html = dot && strcmp(dot, ".html") == 0, css = dot && strcmp(dot, ".css") == 0;
        return (Answer){.status = 200,
                        .type = html  ? "text/html; charset=utf-8"
                                : css ? "text/css; charset=utf-8"
                                      : "text/javascript; charset=utf-8",
                        .bytes = (char *)page->bytes,
                        .size = page->size,
                        .fixed = true};
    }
    if (!take_word(&rest, "run")) return answer_nothing();

    Exhibit *shown = &view->shown;
    const Folder *folder = &shown->folder;
    int run, a, b;
    if (!take_number(&rest, &run) || !shown->number || run != shown->number || *rest++ != '/') return answer_nothing();
    if (strcmp(rest, "room") == 0) return answer_room(shown);
    if (strcmp(rest, "cells") == 0) return answer_cells(shown);
    if (strcmp(rest, "stats.csv") == 0) return answer_file(folder->stats, "text/csv");
    if (strcmp(rest, "events.csv") == 0) return answer_file(folder->events, "text/csv");
    if (strcmp(rest, "probes.csv") == 0) return answer_file(folder->probes, "text/csv");
    if (strcmp(rest, "run.json") == 0) return answer_file(folder->record, "application/json");
    if (take_all(rest, "frame", &a, NULL)) return answer_frame(shown, a);
    if (take_all(rest, "picture", &a, NULL)) return answer_picture(shown, a);
    if (take_all(rest, "solid", &a, &b)) return answer_solid(shown, a, b);
    if (take_all(rest, "vertex", &a, &b)) return answer_vertex(shown, a, b);

    return answer_nothing();
}
