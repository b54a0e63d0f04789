// Writes values as text.
#ifndef SCENE_DUMP_H
#define SCENE_DUMP_H

#include "scene/schema.h"

/// Writes one value as it may be written in a scene (flow style). Not for rows of maps.
void dump_value(const SchemaRow *row, const void *object, FILE *file);

#endif
