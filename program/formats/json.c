#include "formats/json.h"

#include "formats/number.h"
#include "common/store.h"

#include <string.h>

typedef struct Parser {
    Json *json;
    const char *name;
    const uint8_t *at, *end;
    SingeError *error;
    uint32_t open[JSON_DEPTH]; ///< the open values around the cursor
    int depth;
} Parser;

static SingeResult json_bad(const Parser *parser, const char *what) {
    long long byte = parser->at - parser->json->text;
    return refuse(parser->error, SINGE_ERROR_FORMAT, "json", byte, "%s: byte %lld of its JSON: %s",
                  short_name(parser->name), byte, what);
}

static void skip_blanks(Parser *parser) {
    while (parser->at < parser->end &&
           (*parser->at == ' ' || *parser->at == '\t' || *parser->at == '\n' || *parser->at == '\r'))
        parser->at++;
}

static SingeResult json_add(Parser *parser, JsonKind kind, const uint8_t *begin, const uint8_t *end) {
    Json *json = parser->json;
    if (!store_grow(json->allocator, &json->values, &json->capacity, json->count + 1, sizeof *json->values))
        return refuse_memory(parser->error, "json", parser->name);
    json->values[json->count] =
        (JsonValue){kind, (uint32_t)(begin - json->text), (uint32_t)(end - json->text), 0, (uint32_t)json->count + 1};
    json->count++;
    return SINGE_OK;
}

static SingeResult take_string(Parser *parser) {
    if (parser->at == parser->end || *parser->at != '"') return json_bad(parser, "a string is missing");
    const uint8_t *begin = ++parser->at;

    for (; parser->at < parser->end && *parser->at != '"'; parser->at++) {
        if (*parser->at < ' ') return json_bad(parser, "a string contains a control character");
        if (*parser->at == '\\' && parser->at + 1 < parser->end) parser->at++;
    }

    if (parser->at == parser->end) return json_bad(parser, "unterminated string");
    TRY(json_add(parser, JSON_STRING, begin, parser->at));
    parser->at++;
    return SINGE_OK;
}

/// Reads a value, or the beginning of an object or array.
static SingeResult take_value(Parser *parser) {
    skip_blanks(parser);
    if (parser->at == parser->end) return json_bad(parser, "unexpected end of the text");

    uint8_t c = *parser->at;
    if (c == '"') return take_string(parser);

    if (c != '{' && c != '[') {
        const uint8_t *begin = parser->at;
        while (parser->at<parser->end && * parser->at> ' ' && !strchr(",]}[{:\"", *parser->at)) parser->at++;
        if (parser->at == begin) return json_bad(parser, "expected a value");
        return json_add(parser, JSON_PLAIN, begin, parser->at);
    }

    if (parser->depth == JSON_DEPTH) return json_bad(parser, "nested too deeply");
    parser->open[parser->depth++] = (uint32_t)parser->json->count;
    TRY(json_add(parser, c == '{' ? JSON_OBJECT : JSON_ARRAY, parser->at, parser->at + 1));
    parser->at++;
    return SINGE_OK;
}

SingeResult json_read(const char *name, const uint8_t *text, size_t size, SingeAllocator allocator, Json *json,
                      SingeError *error) {
    *json = (Json){.text = text, .allocator = allocator};
    Parser parser = {.json = json, .name = name, .at = text, .end = text + size, .error = error};
    if (size >= UINT32_MAX) return json_bad(&parser, "the text is too long");
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) parser.at += 3;
    TRY(take_value(&parser));

    while (parser.depth) { // in the innermost open value: to its end, or to its next value
        JsonValue *open = &parser.json->values[parser.open[parser.depth - 1]];
        bool object = open->kind == JSON_OBJECT;
        skip_blanks(&parser);

        if (parser.at < parser.end && *parser.at == (object ? '}' : ']')) {
            parser.at++, parser.depth--;
            open->end = (uint32_t)(parser.at - parser.json->text);
            open->after = (uint32_t)parser.json->count;
            continue;
        }

        if (open->count) {
            if (parser.at == parser.end || *parser.at != ',') return json_bad(&parser, "expected a comma or the end");
            parser.at++;
            skip_blanks(&parser);
        }

        open->count++;
        if (object) {
            TRY(take_string(&parser));
            skip_blanks(&parser);
            if (parser.at == parser.end || *parser.at != ':') return json_bad(&parser, "expected a colon");
            parser.at++;
        }

        TRY(take_value(&parser));
    }

    for (skip_blanks(&parser); parser.at < parser.end && *parser.at == 0; parser.at++) {
    } // padding of some chunks
    return parser.at < parser.end ? json_bad(&parser, "there is data after the end") : SINGE_OK;
}

void json_free(Json *json) {
    store_free(json->allocator, json->values, json->capacity, sizeof *json->values);
    memset(json, 0, sizeof *json);
}

bool json_is(const Json *json, int64_t value, const char *text) {
    if (value < 0 || json->values[value].kind != JSON_STRING) return false;
    size_t length = json->values[value].end - json->values[value].begin;
    return length == strlen(text) && memcmp(json->text + json->values[value].begin, text, length) == 0;
}

int64_t json_member(const Json *json, int64_t object, const char *key) {
    if (object < 0 || json->values[object].kind != JSON_OBJECT) return JSON_NONE;
    int64_t at = object + 1;
    for (uint32_t i = 0; i < json->values[object].count; i++, at = json->values[at + 1].after)
        if (json_is(json, at, key)) return at + 1;
    return JSON_NONE;
}

bool json_number(const Json *json, int64_t value, double *number) {
    if (value < 0 || json->values[value].kind != JSON_PLAIN) return false;
    const uint8_t *at = json->text + json->values[value].begin, *end = json->text + json->values[value].end;
    return number_double(&at, end, number) == NUMBER_OK && at == end;
}

bool json_count(const Json *json, int64_t value, uint64_t *number) {
    double whole;
    if (!json_number(json, value, &whole) || !(whole >= 0) || whole > 9007199254740992.0) return false;
    *number = (uint64_t)whole;
    return (double)*number == whole;
}

uint32_t json_items(const Json *json, int64_t value) {
    return value >= 0 && json->values[value].kind == JSON_ARRAY ? json->values[value].count : 0;
}
