// The schema of scene files: one table for each map that a scene may hold. The reader, --set, the dump and
// docs/scene.md are all made from these tables.
#pragma once

#include "scene/scene.h"
#include "scene/tree.h"
#include "scene/units.h"

typedef enum RowType {
    ROW_BOOL,
    ROW_INT, ///< int
    ROW_UINT32,
    ROW_UINT64,
    ROW_FLOAT,
    ROW_VECTOR,   ///< float[length]
    ROW_INTS,     ///< int[length]
    ROW_TEXT,     ///< char *
    ROW_NAME,     ///< char *, valid as part of a file name
    ROW_FILE,     ///< SceneFile
    ROW_ENUM,     ///< an enum, by `names`
    ROW_ORDER,    ///< SingeColour[4], each once
    ROW_FORMATS,  ///< OutputSet: formats of formats/output.h, each once; the cache is always one
    ROW_BASE,     ///< the SceneMaterial at `offset`: the name or file of its base
    ROW_PARAM,    ///< SingeParam, with its SceneFile at `extra`
    ROW_MAP,      ///< a map by `sub`; `extra`, if not 0, is the bool that records that it is given
    ROW_LIST,     ///< pointer to maps by `sub`; their count at `extra`
    ROW_POINTS,   ///< ScenePoint *, count at `extra`
    ROW_INDICES,  ///< uint32_t *, count at `extra`
    ROW_STRENGTH, ///< a number or a list of maps by `sub`; count at `extra`
    ROW_POSITION, ///< SceneKey *: the position of its only key
    ROW_ROTATION, ///< SceneKey *: the rotation of its only key
    ROW_NODE,     ///< const YamlNode *: whatever is there
} RowType;

enum {
    ROW_REQUIRED = 1,
    ROW_OPEN_MIN = 2, ///< min itself is excluded
    ROW_OPEN_MAX = 4,
    ROW_INF = 8,       ///< "inf" is allowed
    ROW_NONE = 16,     ///< "none" is allowed: -INFINITY
    ROW_SHORT = 32,    ///< short for another key; not dumped
    ROW_NUMBERED = 64, ///< ROW_FILE: a name with a run of # instead of a number
    ROW_KEYED = 128,   ///< ROW_LIST: in place of the number that a later row of the same key takes
};

typedef struct SchemaRow {
    const char *key;
    RowType type;
    Dimension dimension;
    size_t offset, extra;
    int length;
    unsigned flags, kinds; ///< kinds: bits of the kinds that have this key, 0 for all
    double min, max;
    const char *const *names; ///< ROW_ENUM: NULL-terminated
    const struct Schema *sub;
    const char *doc;
} SchemaRow;

/// The state of the reader.
typedef struct Reader {
    SceneArena *arena;
    SceneText *text;
    SceneMessages *messages;
    const char *base_dir; ///< NULL: files are neither checked nor read
    const char *prefix;   ///< from base_dir to the folder of the current material file, "" or ending in a slash
    const struct BaseChain *chain; ///< the material files being read (base.c)
    Scene *scene;
} Reader;

/// Adds an error at a location of the text that is read; printf's arguments follow.
#define complain(reader, location, ...) message_add((reader)->messages, (reader)->text, location, __VA_ARGS__)

enum {
    SCENE_BYTES_MAX = 1 << 20, ///< of a scene or a material file
    SCENE_OBJECTS_MAX = 1000,  ///< sheets, and so on, each
};

typedef struct Schema {
    const char *title; ///< "a sheet": for messages and headings
    const char *doc;   ///< opening paragraph in docs/scene.md
    size_t size;
    const SchemaRow *rows;
    int row_count;
    size_t kind_offset; ///< of the enum that `kinds` are bits of; the row is called "kind"
    /// The key of a choice that is read before the other keys, and a function that sets the defaults of that choice
    /// (NULL: none). A bare word in place of the map is that choice. NULL: no such key.
    const char *choice;
    void (*chosen)(void *object); ///< NULL: nothing
    /// Fills in the defaults; false when out of memory. NULL: zeros, or the values set by the enclosing map.
    bool (*defaults)(SceneArena *arena, void *object);
    /// Checks that involve several rows.
    void (*finish)(Reader *reader, const YamlNode *map, void *object);
    bool located; ///< an object begins with its SceneLocation
} Schema;

extern const Schema schema_scene;
extern const Schema schema_noise;

/// The bit of an object's kind; all bits for a schema without kinds.
unsigned schema_kind(const Schema *schema, const void *object);
static inline bool row_allowed(const SchemaRow *row, unsigned kind) { return !row->kinds || (row->kinds & kind); }

/// "1 to 100", "> 0 to 1e9", "0 to < 1" or "" if the row is no number: its range in the unit of bare numbers.
void row_range(const SchemaRow *row, char *buffer, size_t size);
/// The type of a row's value, for messages: "a temperature (K, C, F)".
void row_expected(const SchemaRow *row, char *buffer, size_t size);

/// A parameter of a material that may vary over the sheet.
typedef struct SceneParam {
    char key[40];  ///< "grammage", "weight.red"
    size_t offset; ///< in SingeMaterialDef
    size_t slot;   ///< of its texture in SceneMaterial and SceneAssets
} SceneParam;

/// The index-th parameter, in the order of the schema's rows; false after the last.
bool scene_param(int index, SceneParam *param);
static inline SingeParam *scene_param_at(SingeMaterialDef *def, const SceneParam *param) {
    return (SingeParam *)((char *)def + param->offset);
}

/// Whether a parameter fixes a sheet's mass, shape or start, and so cannot change.
bool scene_param_lasts(const char *key);

/// Reads a map into an object whose defaults are set.
void schema_read(Reader *reader, const Schema *schema, const YamlNode *map, void *object);

/// The object of a row with a `sub` before its keys are read: the map in the object, or a new list entry, with its
/// defaults. Used by the reader and docs/scene.md. NULL when out of memory.
void *row_begin(SceneArena *arena, const SchemaRow *row, void *object);

/// Replaces bare words in place of maps by maps, so that --set can set their keys.
void schema_spell_out(SceneArena *arena, const Schema *schema, YamlNode *map);

/// Reads the base of a material: a built-in material or a file (base.c).
void read_base(Reader *reader, const SchemaRow *row, const YamlNode *node, SceneMaterial *material);
extern const Schema schema_material;
/// "cotton, newsprint, ..."
const char *base_names(char *buffer, size_t size);

// checks (checks.c)
void finish_scene(Reader *reader, const YamlNode *map, void *object);
void finish_material(Reader *reader, const YamlNode *map, void *object);
void finish_sheet(Reader *reader, const YamlNode *map, void *object);
void finish_source(Reader *reader, const YamlNode *map, void *object);
void finish_collider(Reader *reader, const YamlNode *map, void *object);
void finish_pin(Reader *reader, const YamlNode *map, void *object);
void finish_camera(Reader *reader, const YamlNode *map, void *object);
void finish_output(Reader *reader, const YamlNode *map, void *object);
void finish_preview(Reader *reader, const YamlNode *map, void *object);

// defaults (defaults.c)
bool default_scene(SceneArena *arena, void *object);
bool default_sheet(SceneArena *arena, void *object);
bool default_source(SceneArena *arena, void *object);
bool default_collider(SceneArena *arena, void *object);
bool default_motion(SceneArena *arena, void *object);
bool default_pin(SceneArena *arena, void *object);
bool default_measured(SceneArena *arena, void *object);
bool default_noise(SceneArena *arena, void *object);
bool default_grid(SceneArena *arena, void *object);
/// Sets the defaults of the solver's method.
void chosen_solver(void *object);

/// The candidate nearest to a mistyped word, or NULL if none is near (nearest.c).
typedef struct Nearest {
    const char *word, *best;
    int distance;
} Nearest;
void nearest_offer(Nearest *nearest, const char *candidate);
/// "" or "; did you mean 'best'?"
const char *nearest_hint(const Nearest *nearest, char *buffer, size_t size);
