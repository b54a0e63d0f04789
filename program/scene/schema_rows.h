// Macros for the schema's tables.
#pragma once

#include "scene/schema.h"
#include "scene/words.h"
#include "singe/source.def"

#define AT(type, member) .offset = offsetof(type, member)
#define EXTRA(type, member) .extra = offsetof(type, member)
#define DEGREE (3.14159265358979323846 / 180)
#define ROWS(table) .rows = (table), .row_count = (int)(sizeof(table) / sizeof *(table))

// ranges, in the units that scenes are stored in: those of the library's tables, up to 1e9
#define MUCH 1e9
#define ANY .min = 0, .max = 0 // any number of the type
#define SPACE .min = -1e6, .max = 1e6
#define LOCATION .min = -1e4, .max = 1e4 // of drawn objects
#define TURN .min = -1e6 * DEGREE, .max = 1e6 * DEGREE
#define OVER(low) .flags = ROW_OPEN_MIN, .min = (low), .max = MUCH
#define FROM(low) .min = (low), .max = MUCH
#define FROM_OR_INF(low) .flags = ROW_INF, .min = (low), .max = MUCH
#define OVER_OR_INF(low) .flags = ROW_OPEN_MIN | ROW_INF, .min = (low), .max = MUCH
#define OVER_UP_TO(low, high) .flags = ROW_OPEN_MIN, .min = (low), .max = (high)
#define WITHIN(low, high) .min = (low), .max = (high)
#define BELOW(low, high) .flags = ROW_OPEN_MAX, .min = (low), .max = (high)

// the kinds that have a row
#define ALWAYS 0
#define BIT(KIND) (1u << (KIND))
/// Sources that have a path or a position.
#define SOURCES_MOVABLE ((SINGE_SOURCES_OF_AIR & ~BIT(SINGE_SOURCE_TURBULENCE)) | BIT(SINGE_SOURCE_BALL))

// Rows of the library's tables (singe/*.def), for an object of type OF that holds the Def at HELD, "def." or nothing.
#define ROW_OF_FLOAT ROW_FLOAT
#define ROW_OF_VECTOR ROW_VECTOR
#define ROW_OF_INT ROW_INT
#define ROW_OF_UINT32 ROW_UINT32
#define ROW_OF_UINTS ROW_INTS
#define ROW_OF_UINT64 ROW_UINT64
#define ROW_OF_BOOL ROW_BOOL
#define ROW_OF_ORDER ROW_ORDER
#define ROW_OF_ENUM(name) ROW_ENUM, .names = enum_words.name
#define ROW_OF_KIND(name) ROW_ENUM, .names = enum_words.name, .flags = ROW_REQUIRED
/// The range comes last, as it is several initialisers.
#define AS_ROW_AT(key_, type_, member, length_, dimension_, kinds_, text, ...) \
    {.key = key_,                                                              \
     .dimension = dimension_,                                                  \
     AT(OF, member),                                                           \
     .length = (length_) > 1 ? (length_) : 0,                                  \
     .kinds = kinds_,                                                          \
     .doc = text,                                                              \
     __VA_ARGS__,                                                              \
     .type = ROW_OF_##type_},

// the scene's maps, besides those in schema.c
extern const Schema schema_sheet, schema_source, schema_collider, schema_pin, schema_probe, schema_preview;
