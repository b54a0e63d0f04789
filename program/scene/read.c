// Reads the scene from the tree by the rows of the schema: maps, lists and parameters that vary.
#include "scene/schema_rows.h"
#include "scene/values.h"

#include <math.h>
#include <string.h>

static void *read_at(void *object, size_t offset) { return (char *)object + offset; }

// ---- lists

static void *list_new(Reader *reader, void *object, const SchemaRow *row, uint32_t count, size_t size) {
    void *items = arena_new(reader->arena, count, size);
    memcpy(read_at(object, row->offset), &items, sizeof items);
    *(uint32_t *)read_at(object, row->extra) = items ? count : 0;
    return items;
}

static void read_list(Reader *reader, const SchemaRow *row, const YamlNode *node, void *object) {
    const Schema *schema = row->sub;
    const bool keyed = (row->flags & ROW_KEYED) || row->type == ROW_STRENGTH;

    if (node->kind != NODE_LIST) {
        value_wrong(reader, node, row);
        return;
    }

    if (keyed && !node->count)
        complain(reader, node->location, "'%s' is an empty list: it needs at least one entry", row->key);

    char *items = list_new(reader, object, row, node->count, schema->size);
    for (const YamlNode *child = node->first; items && child; child = child->next, items += schema->size) {
        if (schema->defaults && !schema->defaults(reader->arena, items)) return;

        if (schema->located) memcpy(items, &child->location, sizeof child->location);
        if (child->kind == NODE_MAP) {
            schema_read(reader, schema, child, items);
        } else {
            char seen[NODE_WORDS];
            complain(reader, child->location, "an entry of '%s' must be a map, not %s", row->key,
                     node_describe(child, seen, sizeof seen));
        }
    }
}

/// A list of points, or of indices, at least one.
static void read_elements(Reader *reader, const SchemaRow *row, const YamlNode *node, void *object) {
    if (node->kind != NODE_LIST || !node->count) {
        value_wrong(reader, node, row);
        return;
    }

    const bool points = row->type == ROW_POINTS;
    const size_t size = points ? sizeof(ScenePoint) : sizeof(uint32_t);
    char *items = list_new(reader, object, row, node->count, size);
    SchemaRow element = *row;
    element.type = points ? ROW_VECTOR : ROW_UINT32;
    for (const YamlNode *child = node->first; items && child; child = child->next, items += size) {
        if (points) value_vector(reader, &element, child, ((ScenePoint *)(void *)items)->position);
        else value_integer(reader, &element, child, items);
    }
}

// ---- parameters that may vary

/// Finds the field that the parameter follows; returns the number of such keys.
static int read_field(Reader *reader, const SchemaRow *row, const YamlNode *map, SingeField *field, SceneFile *file) {
    const YamlNode *texture = node_find(map, "texture"), *attribute = node_find(map, "attribute"),
                   *noise = node_find(map, "noise");
    if (texture) {
        SchemaRow part = {.key = "texture", .type = ROW_FILE};
        const bool numbered = texture->kind == NODE_VALUE && texture->text && strchr(texture->text, '#');
        if (numbered && scene_param_lasts(row->key))
            complain(reader, texture->location, "%s is fixed at the start: it accepts one picture only", row->key);
        if (numbered) part.flags = ROW_NUMBERED;
        field->kind = SINGE_FIELD_TEXTURE;
        value_file(reader, &part, texture, file);
    }

    if (attribute) {
        SchemaRow part = {.key = "attribute", .type = ROW_TEXT};
        field->kind = SINGE_FIELD_ATTRIBUTE;
        file->location = attribute->location;
        if (value_is_text(attribute)) field->attribute = attribute->text;
        else value_wrong(reader, attribute, &part);
    }

    if (noise) {
        field->kind = SINGE_FIELD_NOISE;
        file->location = noise->location;
        if (noise->kind != NODE_MAP)
            complain(reader, noise->location, "%s.noise must be a map {scale: , octaves: , seed: }", row->key);
        else if (default_noise(reader->arena, &field->noise)) schema_read(reader, &schema_noise, noise, &field->noise);
    }

    return !!texture + !!attribute + !!noise;
}

/// A list of {time, value}. The parameter begins with the first value, and `to` is the one that is farthest from it.
static void read_keys(Reader *reader, const SchemaRow *row, const YamlNode *list, SingeParam *param,
                      SceneFollowed *followed) {
    const SchemaRow rows[] = {
        {"time", ROW_FLOAT, DIM_TIME, AT(SingeValueKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED,
         .doc = "when"},
        {"value", ROW_FLOAT, row->dimension, AT(SingeValueKey, value), .min = row->min, .max = row->max,
         .flags = ROW_REQUIRED | (row->flags & (ROW_OPEN_MIN | ROW_OPEN_MAX)), .doc = row->doc},
    };

    const Schema schema = {.title = row->key, .size = sizeof(SingeValueKey), ROWS(rows)};
    const SchemaRow keys = {
        row->key,           ROW_LIST,      DIM_NONE, AT(SceneFollowed, keys), EXTRA(SceneFollowed, key_count),
        .flags = ROW_KEYED, .sub = &schema};

    if (scene_param_lasts(row->key))
        complain(reader, list->location, "%s is fixed at the start: it accepts no keys", row->key);
    read_list(reader, &keys, list, followed);
    check_times(reader, list, followed->keys, sizeof *followed->keys, followed->key_count);
    if (!followed->key_count) return;

    *param = singe_param(followed->keys[0].value);
    for (uint32_t i = 1; i < followed->key_count; i++)
        if (fabsf(followed->keys[i].value - param->value) > fabsf(param->to - param->value))
            param->to = followed->keys[i].value;
}

static void read_param(Reader *reader, const SchemaRow *row, const YamlNode *node, SingeParam *param,
                       SceneFollowed *followed) {
    static const char *const keys[] = {"from", "to", "texture", "attribute", "noise"};
    SingeParam result = singe_param(param->value);
    *followed = (SceneFollowed){0}; // drop that of the base material

    if (node->kind == NODE_LIST) {
        read_keys(reader, row, node, param, followed);
        return;
    }

    if (node->kind != NODE_MAP) {
        if (value_float(reader, row, node, &result.value)) {
            result.to = result.value;
            *param = result;
        }
        return;
    }

    unsigned given = 0;
    for (const YamlNode *child = node->first; child; child = child->next) {
        Nearest nearest = {.word = child->key};
        int i = 0;
        for (; i < 5 && strcmp(child->key, keys[i]) != 0; i++) nearest_offer(&nearest, keys[i]);

        char hint[80], key[NODE_WORDS];
        if (i == 5)
            complain(reader, child->key_location, "unknown key%s in %s%s", node_key(child, key, sizeof key), row->key,
                     nearest_hint(&nearest, hint, sizeof hint));
        else if (given & 1u << i) complain(reader, child->key_location, "'%s' is given twice in %s", keys[i], row->key);
        else given |= 1u << i;
    }

    const YamlNode *from = node_find(node, "from"), *to = node_find(node, "to");
    SchemaRow end = *row; // no line leads to infinity
    end.flags &= ~(unsigned)ROW_INF;
    bool good = from && to;
    good = (!from || value_float(reader, &end, from, &result.value)) && good;
    good = (!to || value_float(reader, &end, to, &result.to)) && good;

    SingeField *field = arena_new(reader->arena, 1, sizeof *field);
    if (!field) return;

    int fields = read_field(reader, row, node, field, &followed->texture);
    result.field = field;
    if (!from || !to || fields != 1)
        complain(reader, node->location, "%s as a map needs 'from', 'to' and one of 'texture', 'attribute' and 'noise'",
                 row->key);
    else if (good) *param = result;
}

// ---- maps

static void read_row(Reader *reader, const SchemaRow *row, const YamlNode *node, void *object);

static const SchemaRow *choice_row(const Schema *schema) {
    const SchemaRow *row = schema->rows;
    while (strcmp(row->key, schema->choice) != 0) row++;
    return row;
}

/// The choice that determines an object's other defaults.
static void read_choice(Reader *reader, const Schema *schema, const YamlNode *node, void *object) {
    uint32_t before = message_total(reader->messages);
    read_row(reader, choice_row(schema), node, object);
    if (message_total(reader->messages) == before && schema->chosen) schema->chosen(object);
}

void *row_begin(SceneArena *arena, const SchemaRow *row, void *object) {
    void *begun = row->type == ROW_MAP ? read_at(object, row->offset) : arena_new(arena, 1, row->sub->size);
    return begun && (!row->sub->defaults || row->sub->defaults(arena, begun)) ? begun : NULL;
}

static void read_row(Reader *reader, const SchemaRow *row, const YamlNode *node, void *object) {
    void *field = read_at(object, row->offset);
    switch (row->type) {
    case ROW_BOOL: value_bool(reader, row, node, field); break;
    case ROW_INT:
    case ROW_UINT32:
    case ROW_UINT64: value_integer(reader, row, node, field); break;
    case ROW_FLOAT: {
        float value;
        if (value_float(reader, row, node, &value)) *(float *)field = value;
        break;
    }
    case ROW_VECTOR: value_vector(reader, row, node, field); break;
    case ROW_INTS: value_ints(reader, row, node, field); break;
    case ROW_TEXT:
        if (value_is_text(node)) *(char **)field = node->text;
        else value_wrong(reader, node, row);
        break;
    case ROW_NAME: value_name(reader, row, node, field); break;
    case ROW_FILE: value_file(reader, row, node, field); break;
    case ROW_ENUM: {
        int value;
        if (value_word(reader, row, node, row->names, &value)) memcpy(field, &value, sizeof value);
        break;
    }
    case ROW_NODE: *(const YamlNode **)field = node; break;
    case ROW_BASE: read_base(reader, row, node, field); break;
    case ROW_ORDER: value_order(reader, row, node, field); break;
    case ROW_FORMATS: value_formats(reader, row, node, field); break;
    case ROW_PARAM: read_param(reader, row, node, field, read_at(object, row->extra)); break;
    case ROW_MAP: {
        void *inner = row_begin(reader->arena, row, object); // a map with defaults of its own starts from these
        if (!inner) break;
        if (row->extra) *(bool *)read_at(object, row->extra) = true;
        if (node->kind == NODE_MAP) schema_read(reader, row->sub, node, inner);
        else if (row->sub->choice && node->kind == NODE_VALUE) read_choice(reader, row->sub, node, inner);
        else value_wrong(reader, node, row);
        break;
    }
    case ROW_LIST: read_list(reader, row, node, object); break;
    case ROW_POINTS:
    case ROW_INDICES: read_elements(reader, row, node, object); break;
    case ROW_STRENGTH: {
        float value;
        if (node->kind == NODE_LIST) {
            read_list(reader, row, node, object);
        } else if (value_float(reader, row, node, &value)) {
            SingeValueKey *items = list_new(reader, object, row, 1, sizeof *items);
            if (items) items[0] = (SingeValueKey){0, value};
        }
        break;
    }
    case ROW_POSITION:
    case ROW_ROTATION: { // of the only key of a path
        SceneKey *key;
        memcpy(&key, field, sizeof key);
        if (!key || *(uint32_t *)read_at(object, row->extra) != 1) key = list_new(reader, object, row, 1, sizeof *key);
        if (key) value_vector(reader, row, node, row->type == ROW_POSITION ? key->position : key->rotation);
        break;
    }
    }
}

/// Reads a key of a map by its row. A key that no row of this kind has is an error, which says which kind has it, or
/// which key was meant.
static void read_child(Reader *reader, const Schema *schema, unsigned kind, const YamlNode *child, void *object,
                       uint64_t *given) {
    const SchemaRow *other = NULL;
    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        if (strcmp(row->key, child->key) != 0 || ((row->flags & ROW_KEYED) && child->kind != NODE_LIST)) continue;
        if (!row_allowed(row, kind)) {
            other = row;
            continue;
        }

        if (*given & 1ull << i)
            complain(reader, child->key_location, "'%s' is given twice in %s", row->key, schema->title);
        else read_row(reader, row, child, object);
        *given |= 1ull << i;
        return;
    }

    if (reader->messages->left_out) { // the message will not be shown
        complain(reader, child->key_location, "unknown key");
    } else if (other) {
        const char *const *names = schema->rows[0].names; // the row "kind" is the first
        int mine = 0;
        while (kind > 1u << mine) mine++;
        complain(reader, child->key_location, "a %s has no '%s'", names[mine], other->key);
    } else {
        char hint[80], key[NODE_WORDS];
        Nearest nearest = {.word = child->key};
        for (int i = 0; i < schema->row_count; i++)
            if (row_allowed(&schema->rows[i], kind)) nearest_offer(&nearest, schema->rows[i].key);
        nearest_hint(&nearest, hint, sizeof hint);
        if (!nearest.best && (strcmp(child->key, "color") == 0 || strcmp(child->key, "colour") == 0))
            snprintf(hint, sizeof hint, "; sheets and colliders have a 'colour'");
        complain(reader, child->key_location, "unknown key%s in %s%s", node_key(child, key, sizeof key), schema->title,
                 hint);
    }
}

void schema_read(Reader *reader, const Schema *schema, const YamlNode *map, void *object) {
    uint64_t given = 0;
    unsigned kind = ~0u;
    const YamlNode *first = schema->kind_offset ? node_find(map, "kind") : NULL;

    if (first) {
        uint32_t before = message_total(reader->messages);
        read_row(reader, &schema->rows[0], first, object);
        given |= 1;
        // if the kind is unknown, only keys that no kind has are errors
        kind = message_total(reader->messages) == before ? schema_kind(schema, object) : ~0u;
    }

    if (schema->choice && (first = node_find(map, schema->choice))) {
        read_choice(reader, schema, first, object);
        given |= 1ull << (choice_row(schema) - schema->rows);
    }

    for (const YamlNode *child = map->first; child; child = child->next)
        if (child != first && !arena_failed(reader->arena)) read_child(reader, schema, kind, child, object, &given);

    for (int i = 0; i < schema->row_count; i++) {
        const SchemaRow *row = &schema->rows[i];
        bool due = (row->flags & ROW_REQUIRED) && row_allowed(row, kind) && (kind != ~0u || !row->kinds);
        if (due && !(given & 1ull << i))
            complain(reader, map->location, "%s needs '%s': %s", schema->title, row->key, row->doc);
    }

    if (schema->finish) schema->finish(reader, map, object);
}

void schema_spell_out(SceneArena *arena, const Schema *schema, YamlNode *map) {
    for (YamlNode *child = map->kind == NODE_MAP ? map->first : NULL; child; child = child->next) {
        const SchemaRow *row = schema->rows, *end = row + schema->row_count;
        while (row < end && !(row->sub && strcmp(row->key, child->key) == 0)) row++;
        if (row == end) continue;

        if (row->type == ROW_MAP && row->sub->choice && value_is_text(child)) {
            // a word becomes a map that has it as its choice
            YamlNode *word = arena_new(arena, 1, sizeof *word);
            char *key = arena_text(arena, row->sub->choice, strlen(row->sub->choice));
            if (!word || !key) return;

            *word = *child;
            word->next = NULL;
            word->key = key;
            word->key_location = child->location;
            child->kind = NODE_MAP;
            child->text = NULL;
            child->first = child->last = word;
            child->count = 1;
        } else if (child->kind == NODE_MAP) {
            schema_spell_out(arena, row->sub, child);
        }

        for (YamlNode *entry = child->kind == NODE_LIST ? child->first : NULL; entry; entry = entry->next)
            schema_spell_out(arena, row->sub, entry);
    }
}
