// JSON as a flat list of values, in the order of the file, for the reader of glTF.
#pragma once

#include "formats/formats.h"

typedef enum JsonKind { JSON_OBJECT, JSON_ARRAY, JSON_STRING, JSON_PLAIN } JsonKind; ///< plain: numbers, true, null

/// No value.
enum { JSON_NONE = -1, JSON_DEPTH = 100 };

/// A value. An object's members are pairs of values; the first is a string.
typedef struct JsonValue {
    JsonKind kind;
    uint32_t begin, end; ///< bytes of the text; of a string within its quotes
    uint32_t count;      ///< items, or members
    uint32_t after;      ///< the next value after it and everything inside it
} JsonValue;

typedef struct Json {
    const uint8_t *text;
    JsonValue *values; ///< the first is the root
    size_t count, capacity;
    SingeAllocator allocator;
} Json;

/// Reads a text of less than 4 GiB, in which nothing is nested deeper than JSON_DEPTH. Errors have the byte offset;
/// free with json_free, also after an error.
SINGE_NODISCARD SingeResult json_read(const char *name, const uint8_t *text, size_t size, SingeAllocator allocator,
                                      Json *json, SingeError *error);
void json_free(Json *json);

/// The value of an object's member; JSON_NONE if there is none or it is no object.
int64_t json_member(const Json *json, int64_t object, const char *key);

/// Whether a value is a string with these characters.
bool json_is(const Json *json, int64_t value, const char *text);

/// True, and its value, for a number; for an integer from 0 to 2^53.
bool json_number(const Json *json, int64_t value, double *number);
bool json_count(const Json *json, int64_t value, uint64_t *number);

/// Places an array's items from: for (i = 0, v = value + 1; i < count; i++, v = values[v].after).
uint32_t json_items(const Json *json, int64_t value);
