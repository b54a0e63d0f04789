// Every message about a scene has its location. The examples are broken in every simple way: cut off at each line, each
// word left out or doubled, each line left out, indented or outdented. A sample of these, or all with the argument `all`.
#include "parsing.h"

#include <glob.h>

static bool all; ///< everything

typedef struct Sweep {
    const char *name;
    char folder[200];
    int lines; ///< of the text as it is now
    int refused, parsed;
} Sweep;

static int count_lines(const char *text, size_t size) {
    int lines = 1;
    for (size_t i = 0; i < size; i++) lines += text[i] == '\n';
    return lines;
}

static void expect_location(const Sweep *sweep, const SceneMessage *message, const char *text) {
    char origin[300];
    const SceneLocation *location = &message->location;
    snprintf(origin, sizeof origin, "%s:%d:%d", sweep->name, location->line, location->column);
    bool good = location->line >= 1 && location->column >= 1 && location->line <= sweep->lines && !location->set;
    if (!good || strcmp(origin, message->origin) != 0)
        fail_msg("%s: %s\nin:\n%s", message->origin, message->text, text);
}

static void parse(Sweep *sweep, const char *bytes, size_t size) {
    Scene *scene = NULL;
    OwnMessages messages = {0};
    char *text = malloc(size + 1); // its end is the end of a block, for the sanitizer

    memcpy(text, bytes, size);
    text[size] = 0;
    sweep->lines = count_lines(text, size);

    SingeResult result = scene_parse(sweep->name, text, size, sweep->folder, NULL, 0, &scene, &messages);
    assert_true(result == SINGE_OK || result == SINGE_ERROR_FORMAT);
    assert_int_equal(result == SINGE_OK, messages.count == 0);
    for (uint32_t i = 0; i < messages.count; i++)
        if (!messages.items[i].location.file) expect_location(sweep, &messages.items[i], text);

    sweep->parsed++;
    sweep->refused += result != SINGE_OK;
    scene_free(scene);
    free(text);
}

/// The text with bytes `from` to `to` in `times` copies, and `before` in front of them.
static void parse_changed(Sweep *sweep, const char *text, size_t from, size_t to, int times, const char *before) {
    size_t size = strlen(text), length = to - from, used = from;
    char *changed = malloc(size + (size_t)times * length + strlen(before) + 1);
    memcpy(changed, text, from);
    used += (size_t)sprintf(changed + used, "%s", before);
    for (int i = 0; i < times; i++, used += length) memcpy(changed + used, text + from, length);
    memcpy(changed + used, text + to, size - to);
    parse(sweep, changed, used + size - to);
    free(changed);
}

static void sweep_lines(Sweep *sweep, const char *text) {
    int line = 0;
    for (size_t from = 0, to; text[from]; from = to, line++) {
        to = from + strcspn(text + from, "\n");
        to += text[to] == '\n';
        size_t blanks = strspn(text + from, " ");

        parse(sweep, text, from);
        if (all || line % 5 == 0) parse_changed(sweep, text, from, to, 0, "");
        if (all || line % 5 == 1) parse_changed(sweep, text, from, to, 2, "");
        if (all || line % 5 == 2) parse_changed(sweep, text, from, to, 1, "   ");
        if (all || line % 5 == 3) parse_changed(sweep, text, from, to, 1, "\t");
        if (blanks && (all || line % 5 == 4)) parse_changed(sweep, text, from, from + blanks, 0, "");
    }
}

static void sweep_words(Sweep *sweep, const char *text) {
    static const char marks[] = "[]{},:-\"'#&*!|>%@`";
    for (size_t from = 0, to; text[from]; from = to) {
        bool mark = strchr(marks, text[from]) != NULL;
        size_t word = strcspn(text + from, "[]{},: \n");
        to = from + (mark || !word ? 1 : word);
        if (text[from] == '#') // a comment
            to = from + strcspn(text + from, "\n");
        if (text[from] == ' ' || text[from] == '\n' || text[from] == '#') continue;

        parse_changed(sweep, text, from, to, 0, "");
        parse_changed(sweep, text, from, to, 2, "");
        char other[2] = {marks[from % (sizeof marks - 1)], 0};
        parse_changed(sweep, text, from, to, 0, other);
    }
}

TEST(every_prefix_of_the_examples_has_its_line) {
    glob_t files;
    assert_int_equal(glob("examples/*/*.yaml", 0, NULL, &files), 0);

    int words = 0;
    for (size_t i = 0; i < files.gl_pathc; i++) {
        OwnBytes bytes;
        Sweep sweep = {.name = files.gl_pathv[i]};
        snprintf(sweep.folder, sizeof sweep.folder, "%.*s", (int)(strrchr(sweep.name, '/') - sweep.name), sweep.name);
        assert_int_equal(file_read(sweep.name, (SingeAllocator){0}, &bytes, NULL), SINGE_OK);
        if (strstr((char *)bytes.data, "sheets:")) {
            sweep_lines(&sweep, (char *)bytes.data);
            if (words++ < 1 || all) sweep_words(&sweep, (char *)bytes.data);
            assert_true(sweep.refused > sweep.parsed / 4);
        }
    }

    assert_true(words >= 10);
    globfree(&files);
}

/// Texts that libfyaml refuses without a position.
TEST(odd_texts_have_their_line) {
    // clang-format off
    static const char *const texts[] = {
        "",      "\n",      "#",         "a: |0\n  x\n", "a: |00\n", "|0",       "a: >0",  "a: |-0",   "a: 1\n...\nb\n",
        "...\n", "---\n",   "---\n...\n---\n", "a: !",  "!",       "a: &",     "*",      ": x",      "? ",
        "?",     ":",       "-",         "- [",         "{",       "[",        "\"",     "'",        "a:\n\tb",
        "\t",    "a: b: c", "[a]b",      "\"a\"b",      "- a\nb",  "sheets: |0", "{a: ", "{a",       "a: |+",
        "a: 1\n... x", "...\n...\n", "a: 1\n...\n---\nb: 1\n", "\xef\xbb\xbf", "\xef\xbb\xbf\xef\xbb\xbf", "a\r\rb: [",
        "sheets:\n  - ", "sheets: [{}, {}]\n", "sheets: [[]]", "sheets: [~]", "sheets:\n  -\n  -\n", "~", "null", "{}",
        "[]",    "a: 'b\n\nc", "k: \"\\q\"", "k: \"\\u12\"", "- - - -", "{? a: b}", "[a: b, c: d]", "{a: b, a: c}",
    };

    // clang-format on
    Sweep sweep = {.name = "odd.yaml", .folder = "."};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) parse(&sweep, texts[i], strlen(texts[i]));
    assert_int_equal(sweep.refused, sizeof texts / sizeof *texts);
}

static void read_arguments(int argc, char **argv) { all = argc > 1 && strcmp(argv[1], "all") == 0; }

TEST_AROUND(read_arguments, NULL)
