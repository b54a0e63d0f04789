// Parts of the command: odd cases that no run reaches.

#include "support/test.h"
#include <sys/wait.h>
#include <unistd.h>

#include "cli/args.h"
#include "cli/pictures.h"
#include "cli/interrupt.h"
#include "common/printable.h"

static void expect_member(const char *json, const char *name, const char *expected) {
    JsonText value;
    bool found = text_json_member((JsonText){json, strlen(json)}, name, &value);
    assert_int_equal(found, expected != NULL);
    if (!expected) return;
    assert_int_equal(value.size, strlen(expected));
    assert_memory_equal(value.text, expected, value.size);
}

TEST(finds_json_members) {
    const char *json = " {\"a\": 1, \"b\": {\"scene\": [1, \"}\\\"\"]} ,"
                       " \"scene\": {\"x\": [1,2]}, \"s\":\"q\\\"},\", \"z\":null}";
    expect_member(json, "a", "1");
    expect_member(json, "b", "{\"scene\": [1, \"}\\\"\"]}");
    expect_member(json, "scene", "{\"x\": [1,2]}");
    expect_member(json, "s", "\"q\\\"},\"");
    expect_member(json, "z", "null");
    expect_member(json, "x", NULL);
    expect_member("[1]", "a", NULL);
    expect_member("", "a", NULL);
}

TEST(refuses_cut_json) {
    const char *json = "{\"a\": [1, {\"b\": \"c\"}], \"scene\": {\"x\": 1}";
    JsonText value;
    assert_true(text_json_member((JsonText){json, strlen(json)}, "scene", &value));
    for (size_t cut = 0; cut < strlen(json); cut++)
        assert_false(text_json_member((JsonText){json, cut}, "scene", &value));
}

TEST(unquotes_what_it_quotes) {
    const char *texts[] = {"", "plain", "a \"b\" \\ c", "tab\tnewline\n\x01", "\xc3\xa4/\xe2\x82\xac",
                           // no UTF-8: a stray byte, one cut short, too long a form, a surrogate, beyond Unicode
                           "\xff", "a\xe2\x82", "\xc0\xaf", "\xed\xb2\x80", "\xf4\x90\x80\x80", "\x80 \xc3\xa4\xc3"};

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char *json = NULL;
        size_t size = 0;
        FILE *file = open_memstream(&json, &size);
        text_json_string(file, texts[i]);
        fclose(file);
        for (size_t at = 0; at < size; at += (size_t)utf8_length(json + at))
            assert_int_not_equal(utf8_length(json + at), 0);

        char *back = text_json_unquote((JsonText){json, size});
        assert_non_null(back);
        assert_string_equal(back, texts[i]);
        free(back);
        free(json);
    }

    // as other writers of JSON put it
    char *other = text_json_unquote((JsonText){"\"\\u00e4\\/\\uD83D\\uDD25\\n\"", 24});
    assert_string_equal(other, "\xc3\xa4/\xf0\x9f\x94\xa5\n");
    free(other);

    static const char *const bad[] = {"\"\\u12\"", "\"\\q\"", "\"\\\"", "\"\\u0000\"", "\"\\u12g4\""};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_null(text_json_unquote((JsonText){bad[i], strlen(bad[i])}));
    assert_null(text_json_unquote((JsonText){"12", 2}));
    assert_null(text_json_unquote((JsonText){"\"", 1}));
}

TEST(finds_the_nearest_word) {
    const char *words[] = {"frames", "threads", "resume", "set"};
    assert_string_equal(args_nearest("frame", words, 4, sizeof *words), "frames");
    assert_string_equal(args_nearest("thraeds", words, 4, sizeof *words), "threads");
    assert_string_equal(args_nearest("res", words, 4, sizeof *words), "resume");
    assert_null(args_nearest("something-else", words, 4, sizeof *words));
}

TEST(reads_arguments) {
    typedef struct Read {
        const char *scene;
        SetList out;
        bool quiet, all;
    } Read;

    static const ArgOption options[] = {
        {"out", 'o', "DIR", "", .read = args_set, offsetof(Read, out)},
        {"quiet", 'q', NULL, "", .read = args_switch, offsetof(Read, quiet)},
        {"all", 'a', NULL, "", .read = args_switch, offsetof(Read, all)},
    };

    const ArgCommand command = {
        .name = "test", .operand = "SCENE", .summary = "", .options = options, .option_count = 3};
    char *argv[] = {"-qa", "-oX", "--out=Y", "--out", "Z", "-qo", "W", "--", "--quiet"};
    Read read = {0};
    ExitCode code = EXIT_FAILED;
    assert_true(args_read(&command, 9, argv, &read, &code));
    assert_int_equal(code, EXIT_GOOD);
    assert_true(read.quiet && read.all);
    assert_string_equal(read.scene, "--quiet");

    const char *const given[] = {"X", "Y", "Z", "W"};
    assert_int_equal(read.out.count, 4);
    for (int i = 0; i < 4; i++) assert_string_equal(read.out.items[i], given[i]);
    set_free(&read.out);
}

TEST(averages_tiles) {
    enum { W = 1000, H = 4 };
    uint8_t *rgb = malloc(W * H * 3);
    for (int i = 0; i < W * H; i++) {
        int x = i % W, y = i / W;
        rgb[3 * i] = (uint8_t)(x % 2 ? 200 : 100);   // mean over 2 columns: 150
        rgb[3 * i + 1] = (uint8_t)(y < 2 ? 10 : 30); // rows of the tile keep theirs
        rgb[3 * i + 2] = 7;
    }

    ContactSheet sheet;
    assert_int_equal(contact_sheet_make(&sheet, 3, 2, W, H, NULL), SINGE_OK); // 3000 wide: halved
    assert_int_equal(sheet.width, 1500);
    assert_int_equal(sheet.height, 4);
    contact_sheet_put(&sheet, 4, rgb);

    const uint8_t *pixel = sheet.rgb + 3 * (2 * 1500 + 500);
    assert_int_equal(pixel[0], 150), assert_int_equal(pixel[1], 10), assert_int_equal(pixel[2], 7);
    assert_int_equal(pixel[3 * 1500 + 1], 30);
    assert_int_equal(pixel[-3], 0); // the tile beside it is untouched
    contact_sheet_free(&sheet);
    free(rgb);
}

TEST(spreads_frames) {
    const int expected[] = {1, 29, 58, 86, 115, 143, 172, 200};
    for (int tile = 0; tile < 8; tile++) assert_int_equal(contact_sheet_frame(tile, 8, 1, 200), expected[tile]);
    assert_int_equal(contact_sheet_frame(0, 1, 5, 9), 5);
    assert_int_equal(contact_sheet_frame(3, 4, 2, 2), 2);
}

TEST(writes_durations) {
    char text[32];
    console_duration(3.6, text);
    assert_string_equal(text, "4 s");
    console_duration(125, text);
    assert_string_equal(text, "2:05");
    console_duration(3723, text);
    assert_string_equal(text, "1:02:03");
    console_duration(-1, text);
    assert_string_equal(text, "0 s");
}

TEST(a_program_that_ends_early_removes_its_drafts) {
    char mine[64], kept[64]; // owned to the end, and not
    char *const drafts[] = {mine, kept};
    for (int i = 0; i < 2; i++) {
        snprintf(drafts[i], sizeof mine, "/tmp/singe-draft-XXXXXX");
        int file = mkstemp(drafts[i]);
        assert_true(file >= 0);
        close(file);
    }

    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        interrupt_shield();
        interrupt_own(mine), interrupt_own(kept);
        interrupt_disown(kept);
        exit(EXIT_FAILED);
    }

    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), EXIT_FAILED);
    assert_int_equal(access(mine, F_OK), -1);
    assert_int_equal(unlink(kept), 0);
}
