// The tables of the public Defs (include/singe/*.def) as data. From a row follow a field's check and its message, and its
// place in snapshots.
#pragma once

#include <math.h>

#include "common/stream.h"
#include "singe/surface.h"
#include "singe/types.h"

/// The values that a number may have. NaN is outside every range. An infinity is inside only where the range ends there
/// and is closed.
typedef struct FieldRange {
    float low, high;
    bool low_open, high_open;
    const char *words; ///< "between 0 and 1"; NULL: all values
} FieldRange;

// The ranges of a table's rows.
#define WITHIN(low, high) \
    { (float)(low), (float)(high), false, false, "between " #low " and " #high }
#define BELOW(low, high) \
    { (float)(low), (float)(high), false, true, "at least " #low " and below " #high }
#define OVER_UP_TO(low, high) \
    { (float)(low), (float)(high), true, false, "above " #low " and at most " #high }
#define FROM(low) \
    { (float)(low), INFINITY, false, true, #low " or more" }
#define FROM_OR_INF(low) \
    { (float)(low), INFINITY, false, false, #low " or more" }
#define OVER(low) \
    { (float)(low), INFINITY, true, true, "above " #low }
#define OVER_OR_INF(low) \
    { (float)(low), INFINITY, true, false, "above " #low }
#define ANY \
    { 0, 0, false, false, NULL }

static inline bool range_has(const FieldRange *range, float x) {
    return (range->low_open ? x > range->low : x >= range->low) &&
           (range->high_open ? x < range->high : x <= range->high);
}

typedef enum FieldType { FIELD_FLOAT, FIELD_INT, FIELD_UINT32, FIELD_UINT64, FIELD_BOOL, FIELD_ENUM } FieldType;

typedef struct DefField {
    const char *name;
    FieldType type;
    const char *words; ///< FIELD_ENUM: its name, "SingeSourceKind"
    int length;
    size_t offset;
    int dimension; ///< of dimensions.def
    FieldRange range;
    unsigned kinds; ///< bits of the kinds that have the field; 0: all
    bool stored;    ///< in snapshots
} DefField;

typedef struct DefTable {
    const char *stage;  ///< of errors
    const char *prefix; ///< of the fields' names in messages, "solver."
    const DefField *fields;
    int count;
    size_t kind; ///< offset of the enum that `kinds` are bits of; 0: there is none, as struct_size lies there
} DefTable;

extern const DefTable sheet_table, source_table, collider_table, pin_table, wind_table, solver_table, gas_table,
    contact_table, sim_table, render_mesh_table;

/// Checks each field that the Def's kind has. SINGE_ERROR_ARGUMENT names the first that is out of its range, and says
/// the range.
SingeResult def_check(const DefTable *table, const void *def, SingeError *error);

/// The same for one field, by its name, of `length` elements at `value`: for setters.
SingeResult def_check_field(const DefTable *table, const char *name, const void *value, const char *stage,
                            SingeError *error);

/// Passes the stored fields from the one at offset `first` to that before offset `end` through the stream, without
/// padding. Sets what is read; nothing else of the Def changes.
void def_stream(Stream *stream, const DefTable *table, void *def, size_t first, size_t end);

/// Whether an enum has this value.
bool def_has_value(const char *words, int value);
