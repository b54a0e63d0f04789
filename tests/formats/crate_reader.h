// OpenUSD's crate files, read back without OpenUSD and without the writer's code: what tests hold usd_crate.c against.
// Everything is asserted: lengths, ranges, and that every section is used up.
#pragma once

#include "format_test.h"

typedef struct CrateFile {
    const uint8_t *bytes;
    size_t size, section[6][2]; ///< TOKENS, STRINGS, FIELDS, FIELDSETS, PATHS, SPECS: begin, size
    uint64_t token_count, field_count, path_count, spec_count;
    char *words;
    const char **tokens;
    int32_t *field_tokens, *sets, *spec_paths, *spec_sets, *spec_kinds;
    uint64_t *field_values, set_count;
    char (*paths)[200];
} CrateFile;

static uint64_t crate_number(const CrateFile *file, size_t at, int bytes) {
    assert_true(at + (size_t)bytes <= file->size);
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++) value |= (uint64_t)file->bytes[at + (size_t)i] << 8 * i;
    return value;
}

/// An LZ4 block of one chunk. Returns the bytes it becomes.
static size_t crate_unpack(const uint8_t *in, size_t size, uint8_t *out, size_t most) {
    const uint8_t *end = in + size;
    size_t n = 0;
    assert_int_equal(*in++, 0);

    while (in < end) {
        size_t token = *in++, literals = token >> 4, match = (token & 15) + 4, more;
        if (literals == 15) do
                literals += more = *in++;
            while (more == 255);
        assert_true(in + literals <= end && n + literals <= most);
        memcpy(out + n, in, literals);
        n += literals, in += literals;
        if (in == end) break;

        size_t distance = in[0] | (size_t)in[1] << 8;
        in += 2;
        if (match == 19) do
                match += more = *in++;
            while (more == 255);
        assert_true(distance && distance <= n && n + match <= most);
        for (; match; match--, n++) out[n] = out[n - distance];
    }

    assert_ptr_equal(in, end);
    return n;
}

/// Packed integers at *at, which moves behind them.
static int32_t *crate_read_ints(const CrateFile *file, size_t *at, size_t count) {
    const size_t packed = (size_t)crate_number(file, *at, 8), codes = (count + 3) / 4, most = 4 + codes + 4 * count;
    uint8_t *bytes = malloc(most + 1);
    int32_t *values = malloc(4 * count + 4), before = 0;
    assert_true(*at + 8 + packed <= file->size);

    const size_t size = crate_unpack(file->bytes + *at + 8, packed, bytes, most);
    *at += 8 + packed;
    int32_t common;
    memcpy(&common, bytes, 4);

    size_t next = 4 + codes;
    for (size_t i = 0; i < count; i++) {
        const int code = bytes[4 + i / 4] >> 2 * (i % 4) & 3;
        int32_t d = common;
        int16_t two;
        if (code == 1) d = (int8_t)bytes[next], next += 1;
        if (code == 2) memcpy(&two, bytes + next, 2), d = two, next += 2;
        if (code == 3) memcpy(&d, bytes + next, 4), next += 4;
        values[i] = before = (int32_t)((uint32_t)before + (uint32_t)d);
    }

    assert_int_equal(next, size);
    free(bytes);
    return values;
}

static void crate_read_tree(CrateFile *file, const int32_t *numbers, const int32_t *names, const int32_t *jumps,
                            size_t *at, const char *above) {
    for (bool more = true; more;) {
        const size_t i = *at;
        assert_true(i < file->path_count);

        char *path = file->paths[numbers[i]];
        const int32_t name = names[i];
        assert_true((uint64_t)(name < 0 ? -name : name) < file->token_count);
        if (i) snprintf(path, 200, "%s%s%s", above, name < 0 ? "." : "/", file->tokens[name < 0 ? -name : name]);
        ++*at;
        if (jumps[i] == -1 || jumps[i] > 0) crate_read_tree(file, numbers, names, jumps, at, path);
        if (jumps[i] > 0) assert_int_equal(*at, i + (size_t)jumps[i]);
        more = jumps[i] >= 0;
    }
}

static void crate_open(CrateFile *file, const uint8_t *bytes, size_t size) {
    static const char *const names[] = {"TOKENS", "STRINGS", "FIELDS", "FIELDSETS", "PATHS", "SPECS"};
    *file = (CrateFile){.bytes = bytes, .size = size};
    assert_memory_equal(bytes, "PXR-USDC\0\10\0", 11);

    size_t at = (size_t)crate_number(file, 16, 8);
    assert_int_equal(crate_number(file, at, 8), 6);
    assert_int_equal(at + 8 + 6 * 32, size);

    for (int i = 0; i < 6; i++) {
        assert_string_equal((const char *)bytes + at + 8 + 32 * i, names[i]);
        file->section[i][0] = (size_t)crate_number(file, at + 8 + 32 * (size_t)i + 16, 8);
        file->section[i][1] = (size_t)crate_number(file, at + 8 + 32 * (size_t)i + 24, 8);
        assert_true(file->section[i][0] + file->section[i][1] == (i < 5 ? 0 : at) || i < 5);
    }

    at = file->section[0][0];
    file->token_count = crate_number(file, at, 8);
    const size_t text = (size_t)crate_number(file, at + 8, 8), packed = (size_t)crate_number(file, at + 16, 8);
    file->words = malloc(text);
    file->tokens = malloc(file->token_count * sizeof *file->tokens);
    assert_int_equal(crate_unpack(bytes + at + 24, packed, (uint8_t *)file->words, text), text);

    char *word = file->words;
    for (uint64_t i = 0; i < file->token_count; i++, word += strlen(word) + 1) file->tokens[i] = word;
    assert_ptr_equal(word, file->words + text);

    at = file->section[2][0];
    file->field_count = crate_number(file, at, 8), at += 8;
    file->field_tokens = crate_read_ints(file, &at, file->field_count);
    file->field_values = malloc(8 * file->field_count);
    assert_int_equal(crate_unpack(bytes + at + 8, (size_t)crate_number(file, at, 8), (uint8_t *)file->field_values,
                                  8 * file->field_count),
                     8 * file->field_count);

    at = file->section[3][0];
    file->set_count = crate_number(file, at, 8), at += 8;
    file->sets = crate_read_ints(file, &at, file->set_count);
    at = file->section[4][0];
    file->path_count = crate_number(file, at, 8);
    assert_int_equal(crate_number(file, at + 8, 8), file->path_count);
    at += 16;

    int32_t *columns[3];
    for (int k = 0; k < 3; k++) columns[k] = crate_read_ints(file, &at, file->path_count);
    file->paths = calloc(file->path_count, sizeof *file->paths);

    size_t done = 0;
    crate_read_tree(file, columns[0], columns[1], columns[2], &done, "");
    assert_int_equal(done, file->path_count);
    for (int k = 0; k < 3; k++) free(columns[k]);
    at = file->section[5][0];
    file->spec_count = crate_number(file, at, 8), at += 8;
    file->spec_paths = crate_read_ints(file, &at, file->spec_count);
    file->spec_sets = crate_read_ints(file, &at, file->spec_count);
    file->spec_kinds = crate_read_ints(file, &at, file->spec_count);
}

static void crate_close(CrateFile *file) {
    free(file->words), free(file->tokens), free(file->field_tokens), free(file->field_values), free(file->sets);
    free(file->paths), free(file->spec_paths), free(file->spec_sets), free(file->spec_kinds);
}

/// A field of a path; fails where there is none.
static uint64_t crate_field(const CrateFile *file, const char *path, const char *name) {
    for (uint64_t i = 0; i < file->spec_count; i++) {
        if (strcmp(file->paths[file->spec_paths[i]], path) != 0) continue;
        for (uint64_t k = (uint64_t)file->spec_sets[i]; file->sets[k] != -1; k++)
            if (strcmp(file->tokens[file->field_tokens[file->sets[k]]], name) == 0)
                return file->field_values[file->sets[k]];
    }
    fail_msg("no %s of %s", name, path);
    return 0;
}

static inline const char *crate_text(const CrateFile *file, const char *path, const char *name) {
    const uint64_t value = crate_field(file, path, name);
    assert_int_equal(value >> 48, 0x4000 | 11);
    return file->tokens[value & 0xffffffff];
}

/// The only sample of an attribute, of `width` values of 4 bytes an entry; from malloc. `type`: 3 int, 8 float, ...
static inline uint32_t *crate_samples(const CrateFile *file, const char *path, int type, int width, double *time,
                                      size_t *count) {
    uint64_t value = crate_field(file, path, "timeSamples");
    assert_int_equal(value >> 48, 46);
    size_t at = (size_t)(value & 0xffffffffffff);
    assert_int_equal(crate_number(file, at, 8), 8);

    const uint64_t times = crate_number(file, at + 8, 8);
    assert_int_equal(times >> 48, 48);
    assert_int_equal(crate_number(file, (size_t)(times & 0xffffffffffff), 8), 1);
    memcpy(time, file->bytes + (times & 0xffffffffffff) + 8, 8);
    assert_int_equal(crate_number(file, at + 16, 8), 8);
    assert_int_equal(crate_number(file, at + 24, 8), 1);

    value = crate_number(file, at + 32, 8);
    assert_int_equal(value >> 48 & 0xff, type);
    assert_true(value >> 63);
    at = (size_t)(value & 0xffffffffffff);
    *count = at ? (size_t)crate_number(file, at, 8) : 0;
    at += 8;

    uint32_t *values = malloc(4 * (size_t)width * *count + 4);
    if (!(value >> 61 & 1)) {
        assert_true(at + 4 * (size_t)width * *count <= file->size);
        if (*count) memcpy(values, file->bytes + at, 4 * (size_t)width * *count);
        return values;
    }

    assert_int_equal(width, 1);
    assert_true(*count >= 16);

    int32_t *numbers;
    if (type == 3) {
        numbers = crate_read_ints(file, &at, *count);
        memcpy(values, numbers, 4 * *count);
    } else {
        assert_int_equal(file->bytes[at], 't');
        const size_t table = (size_t)crate_number(file, at + 1, 4), begin = at + 5;
        at = begin + 4 * table;
        numbers = crate_read_ints(file, &at, *count);
        for (size_t i = 0; i < *count; i++) {
            assert_true(numbers[i] >= 0 && (size_t)numbers[i] < table);
            memcpy(values + i, file->bytes + begin + 4 * (size_t)numbers[i], 4);
        }
    }
    free(numbers);

    return values;
}
