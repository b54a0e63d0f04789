#include "formats/usd_crate.h"

#include <string.h>

enum { HEADER_SIZE = 88, PACKED_MIN = 16, SECTIONS = 6 };
static const CrateValue flag_array = (uint64_t)1 << 63, flag_packed = (uint64_t)1 << 61;

/// Makes room for one more entry of a list; when out of memory the crate fails and this is false.
static bool grow(Crate *crate, void *list, size_t *capacity, size_t count, size_t size) {
    if (store_grow(crate->sink.allocator, list, capacity, count + 1, size)) return true;
    crate->sink.failed = true;
    return false;
}

/// A word's number; a new word is added.
static uint32_t word_number(Crate *crate, const char *text) {
    for (size_t i = 0; i < crate->word_count; i++)
        if (strcmp((const char *)crate->words.bytes + crate->offsets[i], text) == 0) return (uint32_t)i;
    if (!grow(crate, &crate->offsets, &crate->word_capacity, crate->word_count, sizeof *crate->offsets)) return 0;

    crate->offsets[crate->word_count] = (uint32_t)crate->words.size;
    sink_bytes(&crate->words, text, strlen(text) + 1);
    if (crate->words.failed) {
        crate->sink.failed = true;
        return 0;
    }

    return (uint32_t)crate->word_count++;
}

void crate_begin(Crate *crate, SingeAllocator allocator) {
    *crate = (Crate){.sink = {.allocator = allocator},
                     .words = {.allocator = allocator},
                     .scratch = {.allocator = allocator},
                     .packed = {.allocator = allocator}};
    sink_zeros(&crate->sink, HEADER_SIZE);
    word_number(crate, ""); // properties have negative numbers and 0 has no sign, so 0 is the root's
}

void crate_free(Crate *crate) {
    SingeAllocator a = crate->sink.allocator;
    store_free(a, crate->offsets, crate->word_capacity, sizeof *crate->offsets);
    store_free(a, crate->field_tokens, crate->field_capacity, sizeof *crate->field_tokens);
    store_free(a, crate->field_values, crate->value_capacity, sizeof *crate->field_values);
    store_free(a, crate->sets, crate->set_capacity, sizeof *crate->sets);
    store_free(a, crate->paths, crate->path_capacity, sizeof *crate->paths);
    store_free(a, crate->specs, crate->spec_capacity, sizeof *crate->specs);
    store_free(a, crate->table, crate->table_capacity, sizeof *crate->table);
    sink_free(&crate->sink), sink_free(&crate->words), sink_free(&crate->scratch), sink_free(&crate->packed);
    *crate = (Crate){.sink = {.allocator = a, .failed = true}};
}

// ---- packing

/// Writes `size` bytes compressed by LZ4: the length, the mark of a single chunk, and the data.
static void put_packed(Crate *crate, Sink *sink, const uint8_t *bytes, size_t size) {
    const size_t offset = sink->size;
    sink_u64(sink, 0);
    uint8_t *room = sink_room(sink, 1 + lz4_size_max(size));
    if (!room) return;

    *room = 0;
    const size_t length = 1 + lz4_pack(bytes, size, room + 1);
    sink->size = offset + 8 + length;
    store_u32_little(sink->bytes + offset, (uint32_t)length);
    store_u32_little(sink->bytes + offset + 4, (uint32_t)((uint64_t)length >> 32));
    if (sink->failed) crate->sink.failed = true;
}

/// Differences: the commonest one, two bits for each (it, or one, two or four bytes), then those bytes.
static void put_ints(Crate *crate, Sink *sink, const int32_t *values, size_t count) {
    Sink *scratch = &crate->scratch;
    scratch->size = 0;
    const size_t codes = (count + 3) / 4;
    uint8_t *bytes = sink_room(scratch, 4 + codes + 4 * count + 4);

    if (!bytes) {
        crate->sink.failed = true;
        return;
    }

    // the most frequent one-byte difference; of many differences one in seven is counted
    uint32_t counts[256] = {0};
    const size_t stride = count > 1000 ? 7 : 1;

    for (size_t i = 0; i < count; i += stride) {
        const int32_t step = (int32_t)((uint32_t)values[i] - (i ? (uint32_t)values[i - 1] : 0));
        if (step >= -128 && step <= 127) counts[step + 128]++;
    }

    int most = 128;
    for (int i = 0; i < 256; i++)
        if (counts[i] > counts[most]) most = i;
    const int32_t common = most - 128;

    uint8_t *code = bytes + 4, *at = code + codes;
    uint32_t before = 0;
    store_u32_little(bytes, (uint32_t)common);

    for (size_t i = 0; i < count; i += 4) {
        unsigned kinds = 0;
        for (size_t k = 0; k < 4 && i + k < count; k++) {
            const int32_t d = (int32_t)((uint32_t)values[i + k] - before);
            before = (uint32_t)values[i + k];

            // no branches, since they could not be predicted: writes all four bytes, and keeps as many as are needed
            const unsigned kind = (d != common) * (1u + (d != (int8_t)d) + (d != (int16_t)d));
            kinds |= kind << 2 * k;
            store_u32_little(at, (uint32_t)d);
            at += kind + (kind == 3);
        }

        *code++ = (uint8_t)kinds;
    }

    put_packed(crate, sink, bytes, (size_t)(at - bytes));
}

// ---- values

CrateValue crate_token(Crate *crate, const char *text) { return crate_inline(CRATE_TOKEN, word_number(crate, text)); }

CrateValue crate_double(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return crate_inline(CRATE_DOUBLE, bits);
}

static CrateValue lies_here(const Crate *crate, CrateType type) { return (uint64_t)type << 48 | crate->sink.size; }

CrateValue crate_token_list(Crate *crate, const char *const *texts, size_t count) {
    const CrateValue value = lies_here(crate, CRATE_TOKENS);
    sink_u64(&crate->sink, count);
    for (size_t i = 0; i < count; i++) sink_u32(&crate->sink, word_number(crate, texts[i]));
    return value;
}

CrateValue crate_ints(Crate *crate, const int32_t *values, size_t count) {
    CrateValue value = (uint64_t)CRATE_INT << 48 | flag_array;
    if (!count) return value;

    sink_align(&crate->sink, 8);
    value |= crate->sink.size;
    sink_u64(&crate->sink, count);
    if (count < PACKED_MIN) {
        sink_words(&crate->sink, values, count);
        return value;
    }

    put_ints(crate, &crate->sink, values, count);
    return value | flag_packed;
}

/// Floats as indices into a table: 't', the table's size, the table, the indices. False if that is not shorter.
static bool put_table(Crate *crate, const float *values, size_t count) {
    Sink *packed = &crate->packed;
    packed->size = 0;
    uint32_t *room = (uint32_t *)(void *)sink_room(packed, 3 * 4 * count);
    if (!room) return packed->failed = false;

    uint32_t *bits = room, *table = room + count;
    int32_t *numbers = (int32_t *)(room + 2 * count);
    memcpy(bits, values, 4 * count);

    // numbers the values that occur, in their order
    const size_t max = count - count / 3;
    int log = 5;
    while ((size_t)1 << log < 2 * max) log++;

    const size_t size = (size_t)1 << log;
    if (log > 31 || !store_grow(crate->sink.allocator, &crate->table, &crate->table_capacity, size, 4)) return false;
    memset(crate->table, 0, size * sizeof *crate->table);

    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        size_t at = bits[i] * 2654435761u >> (32 - log);
        while (crate->table[at] && table[crate->table[at] - 1] != bits[i]) at = (at + 1) & (size - 1);
        if (!crate->table[at]) {
            if (found == max) return false;
            table[found++] = bits[i];
            crate->table[at] = (uint32_t)found;
        }

        numbers[i] = (int32_t)crate->table[at] - 1;
    }

    const size_t before = crate->sink.size;
    sink_bytes(&crate->sink, "t", 1);
    sink_u32(&crate->sink, (uint32_t)found);
    sink_words(&crate->sink, table, found);
    put_ints(crate, &crate->sink, numbers, count);
    if (crate->sink.size - before < 4 * count) return true;

    crate->sink.size = before;
    return false;
}

CrateValue crate_floats(Crate *crate, int width, const float *values, size_t count) {
    static const CrateType types[] = {[1] = CRATE_FLOAT, [2] = CRATE_VEC2F, [3] = CRATE_VEC3F};
    CrateValue value = (uint64_t)types[width] << 48 | flag_array;
    if (!count) return value;

    sink_align(&crate->sink, 8);
    value |= crate->sink.size;
    sink_u64(&crate->sink, count);
    if (width == 1 && count >= PACKED_MIN && put_table(crate, values, count)) return value | flag_packed;
    sink_words(&crate->sink, values, count * (size_t)width);
    return value;
}

CrateValue crate_times(Crate *crate, double first, size_t count) {
    const CrateValue value = lies_here(crate, CRATE_DOUBLES);
    sink_u64(&crate->sink, count);
    for (size_t i = 0; i < count; i++) sink_double(&crate->sink, first + (double)i);
    return value;
}

CrateValue crate_series(Crate *crate, CrateValue times, const CrateValue *values, size_t count) {
    const CrateValue series = lies_here(crate, CRATE_SAMPLES);
    sink_u64(&crate->sink, 8); // the distance to the times, and behind them to the values
    sink_u64(&crate->sink, times);
    sink_u64(&crate->sink, 8);
    sink_u64(&crate->sink, count);
    for (size_t i = 0; i < count; i++) sink_u64(&crate->sink, values[i]);
    return series;
}

// ---- paths and specs

uint32_t crate_path(Crate *crate, const char *name, bool property, uint32_t parent) {
    if (!grow(crate, &crate->paths, &crate->path_capacity, crate->path_count, sizeof *crate->paths)) return 0;
    crate->paths[crate->path_count] = (CratePath){word_number(crate, name), parent, property};
    return (uint32_t)crate->path_count++;
}

static void put_set(Crate *crate, uint32_t number) {
    if (grow(crate, &crate->sets, &crate->set_capacity, crate->set_count, sizeof *crate->sets))
        crate->sets[crate->set_count++] = number;
}

void crate_spec(Crate *crate, uint32_t path, CrateSpec kind, const CrateField *fields, size_t count) {
    if (!grow(crate, &crate->specs, &crate->spec_capacity, crate->spec_count, sizeof *crate->specs)) return;

    crate->specs[crate->spec_count++] = (CrateSpecRow){path, (uint32_t)crate->set_count, kind};
    for (size_t i = 0; i < count; i++) {
        if (!grow(crate, &crate->field_tokens, &crate->field_capacity, crate->field_count, 4) ||
            !grow(crate, &crate->field_values, &crate->value_capacity, crate->field_count, 8))
            return;
        put_set(crate, (uint32_t)crate->field_count);
        crate->field_tokens[crate->field_count] = word_number(crate, fields[i].name);
        crate->field_values[crate->field_count++] = fields[i].value;
    }

    put_set(crate, UINT32_MAX);
}

// ---- sections

static void put_tokens(Crate *crate) {
    sink_u64(&crate->sink, crate->word_count);
    sink_u64(&crate->sink, crate->words.size);
    put_packed(crate, &crate->sink, crate->words.bytes, crate->words.size);
}

static void put_strings(Crate *crate) { sink_u64(&crate->sink, 0); }

static void put_fields(Crate *crate) {
    sink_u64(&crate->sink, crate->field_count);
    put_ints(crate, &crate->sink, (const int32_t *)crate->field_tokens, crate->field_count);
    Sink *values = &crate->packed;
    values->size = 0;
    for (size_t i = 0; i < crate->field_count; i++) sink_u64(values, crate->field_values[i]);
    if (values->failed) crate->sink.failed = true;
    else put_packed(crate, &crate->sink, values->bytes, values->size);
}

static void put_fieldsets(Crate *crate) {
    sink_u64(&crate->sink, crate->set_count);
    put_ints(crate, &crate->sink, (const int32_t *)crate->sets, crate->set_count);
}

/// Room for columns of numbers; NULL, and the sink has failed, if there is no memory.
static int32_t *room_of(Crate *crate, size_t numbers) {
    crate->packed.size = 0;
    int32_t *room = (int32_t *)(void *)sink_room(&crate->packed, sizeof *room * numbers);
    if (!room) crate->sink.failed = true;
    return room;
}

/// Numbers, names (those of properties negative) and jumps.
static void put_paths(Crate *crate) {
    const size_t count = crate->path_count;
    int32_t *columns = room_of(crate, 4 * count);
    if (!columns) return;

    for (size_t i = 0; i < count; i++) {
        const int32_t name = (int32_t)crate->paths[i].token;
        columns[i] = (int32_t)i;
        columns[count + i] = crate->paths[i].property ? -name : name;
    }

    // the jump from each path: 0 if only a sibling follows, -1 if only a child, -2 if neither; with both the child
    // comes next, and the jump is the distance to the sibling
    const CratePath *paths = crate->paths;
    for (size_t i = 0; i < crate->path_count; i++)
        (columns + 3 * count)[i] = 0; // the child of it that comes next; 0: none

    for (size_t i = crate->path_count; i-- > 0;) {
        const bool child = i + 1 < crate->path_count && paths[i + 1].parent == i;
        const int32_t sibling = paths[i].parent == CRATE_NO_PARENT ? 0 : (columns + 3 * count)[paths[i].parent];
        (columns + 2 * count)[i] = child && sibling ? sibling - (int32_t)i : child ? -1 : sibling ? 0 : -2;
        if (paths[i].parent != CRATE_NO_PARENT) (columns + 3 * count)[paths[i].parent] = (int32_t)i;
    }

    sink_u64(&crate->sink, count);
    sink_u64(&crate->sink, count);
    for (int k = 0; k < 3; k++) put_ints(crate, &crate->sink, columns + (size_t)k * count, count);
}

static void put_specs(Crate *crate) {
    const size_t count = crate->spec_count;
    int32_t *columns = room_of(crate, 3 * count);
    if (!columns) return;

    for (size_t i = 0; i < count; i++) {
        columns[i] = (int32_t)crate->specs[i].path;
        columns[count + i] = (int32_t)crate->specs[i].fields;
        columns[2 * count + i] = (int32_t)crate->specs[i].kind;
    }

    sink_u64(&crate->sink, count);
    for (int k = 0; k < 3; k++) put_ints(crate, &crate->sink, columns + (size_t)k * count, count);
}

static void put_sections(Crate *crate) {
    static const struct {
        const char *name;
        void (*put)(Crate *);
    } sections[SECTIONS] = {{"TOKENS", put_tokens},       {"STRINGS", put_strings}, {"FIELDS", put_fields},
                            {"FIELDSETS", put_fieldsets}, {"PATHS", put_paths},     {"SPECS", put_specs}};

    size_t offsets[SECTIONS + 1];
    for (int i = 0; i < SECTIONS; i++) {
        offsets[i] = crate->sink.size;
        sections[i].put(crate);
    }

    offsets[SECTIONS] = crate->sink.size;
    sink_u64(&crate->sink, SECTIONS);

    for (int i = 0; i < SECTIONS; i++) {
        char name[16] = "";
        memcpy(name, sections[i].name, strlen(sections[i].name));
        sink_bytes(&crate->sink, name, sizeof name);
        sink_u64(&crate->sink, offsets[i]);
        sink_u64(&crate->sink, offsets[i + 1] - offsets[i]);
    }

    if (crate->sink.failed) return;
    uint8_t *header = crate->sink.bytes;
    memcpy(header, "PXR-USDC\0\10\0", 11);
    store_u32_little(header + 16, (uint32_t)offsets[SECTIONS]);
    store_u32_little(header + 20, (uint32_t)((uint64_t)offsets[SECTIONS] >> 32));
}

bool crate_take(Crate *crate, Sink *bytes) {
    put_sections(crate);
    *bytes = crate->sink;
    crate->sink = (Sink){.allocator = bytes->allocator};
    return !bytes->failed;
}

SingeResult crate_write(Crate *crate, const char *path, SingeError *error) {
    put_sections(crate);
    SingeResult result = sink_write(&crate->sink, path, error);
    crate_free(crate);
    return result;
}

// A block is a row of sequences: a byte with two lengths (of literals in its upper half, of a match less 4 in its lower
// one; 15 continues in bytes up to one below 255), the literals, and the match's distance back (u16). The last sequence
// has only literals, at least 5, and no match begins in the last 12 bytes. Matches are found by a table with the last
// position of each hash of 4 bytes; the stride grows while nothing matches.

enum { HASH_BITS = 13, MATCH_MIN = 4, TAIL = 5, MATCH_MARGIN = 12, DISTANCE_MAX = 65535 };

static uint32_t read_word(const uint8_t *p) {
    uint32_t word;
    memcpy(&word, p, sizeof word);
    return word;
}

static uint8_t *put_length(uint8_t *out, size_t rest) {
    for (; rest >= 255; rest -= 255) *out++ = 255;
    *out++ = (uint8_t)rest;
    return out;
}

/// A sequence; `match` 0: the last.
static uint8_t *put_sequence(uint8_t *out, const uint8_t *literals, size_t count, size_t match, size_t distance) {
    uint8_t *token = out++;
    *token = (uint8_t)((count < 15 ? count : 15) << 4);
    if (count >= 15) out = put_length(out, count - 15);
    memcpy(out, literals, count);
    out += count;
    if (!match) return out;

    *out++ = (uint8_t)distance;
    *out++ = (uint8_t)(distance >> 8);
    size_t rest = match - MATCH_MIN;
    *token |= (uint8_t)(rest < 15 ? rest : 15);
    return rest >= 15 ? put_length(out, rest - 15) : out;
}

size_t lz4_pack(const uint8_t *in, size_t size, uint8_t *out) {
    uint32_t last[1 << HASH_BITS] = {0}; // one more than the offset; 0: none
    uint8_t *begin = out;
    size_t at = 0, literals = 0, misses = 0;

    while (size > MATCH_MARGIN && at < size - MATCH_MARGIN && at < UINT32_MAX) {
        const uint32_t hash = (read_word(in + at) * 2654435761u >> (32 - HASH_BITS)), before = last[hash];
        last[hash] = (uint32_t)at + 1;

        const size_t distance = at + 1 - before;
        if (!before || distance > DISTANCE_MAX || read_word(in + before - 1) != read_word(in + at)) {
            at += 1 + (misses++ >> 6);
            continue;
        }

        size_t length = 0;
        while (at + length < size - TAIL && in[before - 1 + length] == in[at + length]) length++;
        out = put_sequence(out, in + literals, at - literals, length, distance);
        at += length;
        literals = at;
        misses = 0;
    }

    out = put_sequence(out, in + literals, size - literals, 0, 0);
    return (size_t)(out - begin);
}
