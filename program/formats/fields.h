// The fields of a drawn vertex, by their names in every format.
#ifndef FORMATS_FIELDS_H
#define FORMATS_FIELDS_H

#include "formats/formats.h"

#include <stddef.h>
#include <string.h>

typedef struct SurfaceField {
    const char *name;
    size_t array; ///< offset of the array's pointer in SingeSurface
    bool integer;
} SurfaceField;

/// Scalar fields; each format has names of its own for vectors.
static const SurfaceField surface_fields[] = {
    {"temperature", offsetof(SingeSurface, temperature), false},
    {"temperature_peak", offsetof(SingeSurface, temperature_peak), false},
    {"mass", offsetof(SingeSurface, mass), false},
    {"burn_rate", offsetof(SingeSurface, burn_rate), false},
    {"char_fraction", offsetof(SingeSurface, char_fraction), false},
    {"ash_fraction", offsetof(SingeSurface, ash_fraction), false},
    {"burnt", offsetof(SingeSurface, burn), false},
    {"time_ignited", offsetof(SingeSurface, time_ignited), false},
    {"piece_id", offsetof(SingeSurface, piece), true},
    {"vertex_id", offsetof(SingeSurface, source_vertex), true},
    {"sheet", offsetof(SingeSurface, sheet), true},
};
enum { SURFACE_FIELDS = sizeof surface_fields / sizeof *surface_fields };

/// The values of a field: floats or int32_t.
static inline const void *surface_field(const SingeSurface *surface, const SurfaceField *field) {
    const void *array;
    memcpy(&array, (const char *)surface + field->array, sizeof array);
    return array;
}

#endif
