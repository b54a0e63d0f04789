// Writes values as text.
#pragma once

#include "scene/schema.h"

/// Writes one value as it may be written in a scene (flow style). Not for rows of maps.
void dump_value(const SchemaRow *row, const void *object, FILE *file);

/// An object's values, or that of one of its rows, as JSON from malloc; "" for a row that is absent. NULL when out of
/// memory. Two that are equal give the same text.
char *dump_text(const Schema *schema, const void *object);
char *dump_row_text(const SchemaRow *row, unsigned kind, const void *object);
