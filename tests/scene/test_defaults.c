// docs/scene.md and the reader agree: a default on the page is the value that an object gets if a scene gives none, and
// a range that it has is the row's. The page is parsed as text; the objects come from the shortest scene.
#include "parsing.h"

#include "scene/dump.h"

// An object of every kind, each with what is required and nothing else.
static const char shortest[] = "sheets:\n"
                               "  - grid: {size: [0.2, 0.2], cells: [2, 2]}\n"
                               "  - grid: {size: [0.2, 0.2], cells: [2, 2]}\n"
                               "    material: {mass_rate: {from: 1, to: 2, noise: {}}, measured: {}}\n"
                               "sources:\n"
                               "  - {kind: ball, path: [{time: 0}]}\n"
                               "  - {kind: texture, texture: flux.png, strength: [{time: 0, value: 1}]}\n"
                               "  - {kind: spot, position: [0, 0, 0]}\n"
                               "colliders:\n"
                               "  - {kind: plane}\n"
                               "  - {kind: sphere}\n"
                               "  - {kind: box}\n"
                               "  - {kind: capsule}\n"
                               "  - {kind: heightfield, picture: heights.png}\n"
                               "  - {kind: mesh, motion: {mesh: cube.#.obj}}\n"
                               "pins:\n"
                               "  - {points: [[0, 0, 0]], motion: {mesh: cube.#.obj}}\n"
                               "probes:\n"
                               "  - {kind: uv, at: [0, 0]}\n"
                               "  - {kind: point, at: [0, 0, 0]}\n"
                               "gas: {}\ncontact: {}\nsolver: {}\nwind: {}\n"
                               "preview: {camera: {}, light: {}, environment: {}, ground: {}}\n";

typedef struct Page {
    char *text;
    int compared; ///< defaults so far
} Page;

static const char *line_end(const char *line) { return line + strcspn(line, "\n"); }

/// The lines of a schema, behind its heading; up to *end, which is the next heading.
static const char *page_section(const Page *page, const Schema *schema, const char **end) {
    char heading[80];
    const char *title = schema->title;
    title += strncmp(title, "a ", 2) == 0 ? 2 : strncmp(title, "the ", 4) == 0 ? 4 : 0;
    snprintf(heading, sizeof heading, "\n## %c%s\n", title[0] + 'A' - 'a', title + 1);
    const char *found = strstr(page->text, heading);
    if (!found) print_error("no section '%s'\n", title);
    assert_non_null(found);
    found += strlen(heading);
    *end = strstr(found, "\n## ");
    *end = *end ? *end : page->text + strlen(page->text);
    return found;
}

/// The row of a key in the section's table for a kind, or in the first table, which is that of all kinds.
static const char *page_row(const Page *page, const Schema *schema, const SchemaRow *row, const char *kind) {
    char only[60], start[60];
    const char *end, *line = page_section(page, schema, &end);
    snprintf(only, sizeof only, "Only `%s`:\n", kind ? kind : "");
    snprintf(start, sizeof start, "| `%s` | ", row->key);
    bool inside = !kind;
    for (; line < end; line = line_end(line) + 1) {
        if (strncmp(line, "Only `", 6) == 0) inside = kind && strncmp(line, only, strlen(only)) == 0;
        if (inside && strncmp(line, start, strlen(start)) == 0) return line;
    }
    print_error("no '%s' in the section of %s\n", row->key, schema->title);
    fail();
    return NULL;
}

/// The index-th cell of a table's line.
static void page_cell(const char *line, int index, char *cell, size_t size) {
    for (; index >= 0; index--) line = strstr(line, "| ") + 2;
    snprintf(cell, size, "%.*s", (int)(strstr(line, " |") - line), line);
}

static char *applied(const SchemaRow *row, const void *object) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    dump_value(row, object, file);
    fclose(file);
    return text;
}

static void compare(Page *page, const Schema *schema, const SchemaRow *row, const void *object, const char *kind) {
    char cell[200], range[200], expected[80];
    const char *line = page_row(page, schema, row, row->kinds ? kind : NULL);
    page_cell(line, 2, range, sizeof range);
    page_cell(line, 3, cell, sizeof cell);
    row_range(row, expected, sizeof expected);
    if (range[0] && range[0] != ' ') assert_memory_equal(range, expected, strlen(expected));
    assert_int_equal(strcmp(cell, "*required*") == 0, (row->flags & ROW_REQUIRED) != 0);
    if (!cell[0] || cell[0] == '|' || (row->flags & ROW_REQUIRED)) return;
    char *value = applied(row, object);
    if (strcmp(cell, value) != 0)
        print_error("%s of %s: documented %s, applied %s\n", row->key, schema->title, cell, value);
    assert_string_equal(cell, value);
    free(value);
    page->compared++;
}

static void walk(Page *page, const Schema *schema, const char *object) {
    unsigned kind = schema_kind(schema, object);
    int number = 0;
    while (schema->kind_offset && kind > 1u << number) number++;
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        const char *items;
        uint32_t count;
        if (!row_allowed(row, kind)) continue;

        const SingeParam *param = (const SingeParam *)(object + row->offset);
        if (row->type == ROW_PARAM && param->field && strcmp(row->key, "mass_rate") == 0) {
            walk(page, &schema_noise, (const char *)&param->field->noise); // the one that is given
            continue;
        }
        compare(page, schema, row, object, schema->kind_offset ? schema->rows[0].names[number] : NULL);
        if (row->type == ROW_MAP) walk(page, row->sub, object + row->offset);
        if (row->type != ROW_LIST && row->type != ROW_STRENGTH) continue;
        memcpy(&items, object + row->offset, sizeof items);
        memcpy(&count, object + row->extra, sizeof count);
        for (uint32_t k = 0; k < count; k++) walk(page, row->sub, items + k * row->sub->size);
    }
}

static void documented_defaults_are_those_in_use(void **state) {
    (void)state;
    Bytes bytes;
    SingeError error;
    assert_int_equal(file_read("docs/scene.md", (SingeAllocator){0}, &bytes, &error), SINGE_OK);
    Page page = {.text = (char *)bytes.data};
    Scene *scene = good_scene(shortest, NULL, 0);
    walk(&page, &schema_scene, (const char *)scene);
    scene_free(scene);
    bytes_free(&bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(documented_defaults_are_those_in_use)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
