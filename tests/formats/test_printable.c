// Foreign text in messages: what is escaped, what is cut, and where.
#include "format_test.h"

#include "common/printable.h"

static void expect_shown(const char *text, const char *expected) {
    assert_string_equal(shown(text).text, expected);
    assert_string_equal(shown_path(text).text, expected);
    assert_int_equal(printable_is(text), strcmp(text, expected) == 0);
}

TEST(odd_characters_are_escaped) {
    expect_shown("", "");
    expect_shown("letter.yaml", "letter.yaml");
    expect_shown("\xc3\xa9\xe2\x82\xac\xf0\x9f\x94\xa5 \\", "\xc3\xa9\xe2\x82\xac\xf0\x9f\x94\xa5 \\");
    expect_shown("a\nb\tc\rd", "a\\nb\\tc\\rd");
    expect_shown("\x1b[31m\x7f\x01", "\\x1b[31m\\x7f\\x01");
    expect_shown("\xc2\x80\xc2\x9f\xc2\xad", "\\u0080\\u009f\\u00ad");
    expect_shown("\xe2\x80\xaa\xe2\x80\xae\xe2\x81\xa6\xe2\x81\xa9\xe2\x80\x8b\xe2\x80\x8d",
                 "\\u202a\\u202e\\u2066\\u2069\\u200b\\u200d");
    expect_shown("\xe2\x80\xa8\xe2\x80\xa9\xef\xbb\xbf\xef\xbf\xbe\xf3\xa0\x80\x81",
                 "\\u2028\\u2029\\ufeff\\ufffe\\U000e0001");

    // no UTF-8: a lone byte, a cut character, one that is too long, a surrogate, beyond Unicode
    expect_shown("\x9b\xff", "\\x9b\\xff");
    expect_shown("a\xe2\x82", "a\\xe2\\x82");
    expect_shown("\xc0\xaf", "\\xc0\\xaf");
    expect_shown("\xed\xa0\x80", "\\xed\\xa0\\x80");
    expect_shown("\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80");
}

/// Every code point and every pair of bytes: the result prints as it is, and has room.
TEST(every_character_is_printable) {
    for (unsigned code = 1; code < 0x110000; code++) {
        char text[5] = {0};
        if (code < 0x80) text[0] = (char)code;
        else if (code < 0x800) text[0] = (char)(0xc0 | code >> 6), text[1] = (char)(0x80 | (code & 63));
        else if (code < 0x10000)
            text[0] = (char)(0xe0 | code >> 12), text[1] = (char)(0x80 | (code >> 6 & 63)),
            text[2] = (char)(0x80 | (code & 63));
        else
            text[0] = (char)(0xf0 | code >> 18), text[1] = (char)(0x80 | (code >> 12 & 63)),
            text[2] = (char)(0x80 | (code >> 6 & 63)), text[3] = (char)(0x80 | (code & 63));

        const char *at = text;
        char piece[PRINTABLE_PIECE];
        size_t length = printable_character(&at, text + strlen(text), piece);
        assert_true(length > 0 && length < PRINTABLE_PIECE && strlen(piece) == length && printable_is(piece));
        if (code < 0xd800 || code > 0xdfff) assert_ptr_equal(at, text + strlen(text));
    }

    for (unsigned pair = 0x101; pair < 0x10000; pair++) {
        const char text[3] = {(char)(pair >> 8), (char)pair, 0};
        assert_true(printable_is(shown(text).text));
    }
}

TEST(long_texts_are_cut_between_characters) {
    static const char *const pieces[] = {"x",   "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x94\xa5", "\xf3\xa0\x80\x81",
                                         "\xff"};
    for (size_t p = 0; p < sizeof pieces / sizeof *pieces; p++)
        for (int count = 0; count < 260; count += count < 78 ? 13 : 1) {
            char text[2000] = "";
            for (int i = 0; i < count; i++) strcat(text, pieces[p]);
            const Shown word = shown(text), path = shown_path(text);
            assert_true(printable_is(word.text) && printable_is(path.text));
            bool cut = strstr(word.text, "...") != NULL, cut_path = strstr(path.text, "...") == path.text;
            assert_int_equal(cut, count > SHOWN_MAX);
            assert_int_equal(cut_path, count > SHOWN_PATH_MAX);
        }
}

TEST(a_cut_character_is_trimmed) {
    static const char *const cases[][2] = {{"", ""},
                                           {"a", "a"},
                                           {"a\xc3", "a"},
                                           {"a\xc3\xa9", "a\xc3\xa9"},
                                           {"\xe2\x82", ""},
                                           {"b\xf0\x9f\x94", "b"},
                                           {"\x80\x80\x80\x80\x80", NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[16];
        strcpy(text, cases[i][0]);
        printable_trim(text);
        assert_string_equal(text, cases[i][1] ? cases[i][1] : cases[i][0]);
    }
}
