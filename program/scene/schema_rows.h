// Macros for the schema's tables.
#ifndef SCENE_SCHEMA_ROWS_H
#define SCENE_SCHEMA_ROWS_H

#include "scene/schema.h"

#define AT(type, member) .offset = offsetof(type, member)
#define EXTRA(type, member) .extra = offsetof(type, member)
#define DEGREE (3.14159265358979323846 / 180)
#define ROWS(table) .rows = (table), .row_count = (int)(sizeof(table) / sizeof *(table))

// ranges, in held units, never wider than the library's (tests/scene/test_ranges.c)
#define MUCH 1e9
#define ANY .min = -1e6, .max = 1e6
#define LOCATION .min = -1e4, .max = 1e4 // of drawn objects
#define TURN .min = -1e6 * DEGREE, .max = 1e6 * DEGREE
#define KELVIN .min = 1, .max = 1e4
#define OVER(low) .flags = ROW_OPEN_MIN, .min = (low), .max = MUCH
#define FROM(low) .min = (low), .max = MUCH
#define OVER_OR_INF(low) .flags = ROW_OPEN_MIN | ROW_INF, .min = (low), .max = MUCH
#define OVER_UP_TO(low, high) .flags = ROW_OPEN_MIN, .min = (low), .max = (high)
#define WITHIN(low, high) .min = (low), .max = (high)
#define BELOW(low, high) .flags = ROW_OPEN_MAX, .min = (low), .max = (high)

// the scene's maps, besides those in schema.c
extern const Schema schema_sheet, schema_source, schema_collider, schema_pin, schema_probe, schema_preview;

#endif
