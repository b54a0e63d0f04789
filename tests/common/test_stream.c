// Streams of bytes and their checksum; errors.
#include "support/support.h"

#include "common/stream.h"
#include "common/error.h"

typedef struct Things {
    uint32_t number;
    double real;
    uint8_t list[5];
} Things;

static void walk(Stream *stream, Things *things) {
    STREAM(stream, things->number);
    STREAM(stream, things->real);
    stream_data(stream, NULL, 0);
    stream_data(stream, things->list, sizeof things->list);
}

TEST(streams_read_what_they_wrote) {
    Things out = {12345, 6.5, {1, 2, 3, 4, 5}}, in;
    Stream measure = {.mode = STREAM_MEASURE};
    walk(&measure, &out);
    assert_int_equal(measure.offset, 4 + 8 + 5);

    uint8_t bytes[17];
    Stream write = {.mode = STREAM_WRITE, .bytes = bytes, .size = sizeof bytes};
    walk(&write, &out);
    assert_false(write.failed);
    assert_int_equal(write.offset, 17);

    Stream read = {.mode = STREAM_READ, .bytes = bytes, .size = sizeof bytes};
    memset(&in, 0xFF, sizeof in);
    walk(&read, &in);
    assert_false(read.failed);
    assert_int_equal(in.number, 12345);
    assert_true(in.real == 6.5);
    assert_memory_equal(in.list, out.list, 5);
}

/// After a truncation, wherever it is, reads give zero and the failure remains.
TEST(truncated_bytes_read_as_zero) {
    for (size_t size = 0; size < 17; size++) {
        uint8_t *bytes = malloc(size + 1); // its own block, so that reading past it is noticed
        assert_non_null(bytes);
        memset(bytes, 0xEE, size + 1);
        uint8_t *exact = realloc(bytes, size ? size : 1);
        Things in;
        memset(&in, 0xFF, sizeof in);

        Stream read = {.mode = STREAM_READ, .bytes = exact, .size = size};
        walk(&read, &in);
        assert_true(read.failed);
        assert_int_equal(in.number, size < 4 ? 0 : 0xEEEEEEEEu);
        for (int i = 0; i < 5; i++) assert_int_equal(in.list[i], 0);

        Stream write = {.mode = STREAM_WRITE, .bytes = exact, .size = size};
        walk(&write, &in);
        assert_true(write.failed);
        assert_true(write.offset <= size);
        free(exact);
    }
}

TEST(checksum_sees_every_bit) {
    uint8_t bytes[43];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (uint8_t)(i * 37);

    uint64_t good = stream_checksum(bytes, sizeof bytes);
    for (size_t bit = 0; bit < 8 * sizeof bytes; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
        assert_true(stream_checksum(bytes, sizeof bytes) != good);
        bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }

    for (size_t size = 0; size < sizeof bytes; size++) assert_true(stream_checksum(bytes, size) != good);
    uint8_t swapped[43];
    memcpy(swapped, bytes, sizeof bytes);
    memcpy(swapped, bytes + 8, 8), memcpy(swapped + 8, bytes, 8);
    assert_true(stream_checksum(swapped, sizeof swapped) != good);
}

TEST(errors_are_cut_and_ended) {
    char word[600];
    memset(word, 'x', sizeof word - 1);
    word[sizeof word - 1] = 0;

    SingeError error;
    memset(&error, 0xFF, sizeof error);
    assert_int_equal(error_set(&error, SINGE_ERROR_MESH, "a stage with a name far too long", 42, "%s", word),
                     SINGE_ERROR_MESH);
    assert_int_equal(error.code, SINGE_ERROR_MESH);
    assert_int_equal(error.element, 42);
    assert_int_equal(strlen(error.stage), sizeof error.stage - 1);
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
    assert_int_equal(error_set(NULL, SINGE_ERROR_FILE, "x", 0, "%s", "y"), SINGE_ERROR_FILE);
}

static SingeResult fails_then_counts(int *count) {
    TRY(*count == 0 ? SINGE_OK : SINGE_ERROR_LIMIT);
    ++*count;
    return SINGE_OK;
}

TEST(failures_are_passed_up) {
    int count = 0;
    assert_int_equal(fails_then_counts(&count), SINGE_OK);
    assert_int_equal(fails_then_counts(&count), SINGE_ERROR_LIMIT);
    assert_int_equal(count, 1);
}

TEST(results_have_names) {
    for (int i = 0; i <= SINGE_ERROR_LIMIT; i++) {
        assert_string_not_equal(singe_result_name((SingeResult)i), "unknown result");
        for (int j = 0; j < i; j++)
            assert_string_not_equal(singe_result_name((SingeResult)i), singe_result_name((SingeResult)j));
    }

    assert_string_equal(singe_result_name((SingeResult)99), "unknown result");
    assert_string_equal(singe_version(), SINGE_VERSION);
}
