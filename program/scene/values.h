// Reads one value from one node of the tree, and checks it against its row. Errors are reported with their location and
// leave the value unchanged.
#pragma once

#include "scene/schema.h"

/// "KEY must be WHAT THE ROW TAKES, not WHAT IS THERE".
void value_wrong(Reader *reader, const YamlNode *node, const SchemaRow *row);

bool value_float(Reader *reader, const SchemaRow *row, const YamlNode *node, float *result);
bool value_vector(Reader *reader, const SchemaRow *row, const YamlNode *node, float *result);

/// `field` is an int, uint32_t or uint64_t by the row's type.
void value_integer(Reader *reader, const SchemaRow *row, const YamlNode *node, void *field);
void value_ints(Reader *reader, const SchemaRow *row, const YamlNode *node, int *field);
void value_bool(Reader *reader, const SchemaRow *row, const YamlNode *node, bool *field);

/// The index of the node's word in `names`.
bool value_word(Reader *reader, const SchemaRow *row, const YamlNode *node, const char *const *names, int *result);
void value_order(Reader *reader, const SchemaRow *row, const YamlNode *node, SingeColour *field);
void value_formats(Reader *reader, const SchemaRow *row, const YamlNode *node, OutputSet *field);
bool value_is_text(const YamlNode *node);

/// Whether a name may be part of file names: the rule of ROW_NAME.
bool value_names_files(const char *text);
void value_name(Reader *reader, const SchemaRow *row, const YamlNode *node, char **field);

/// Refuses lists whose times do not increase. The time is the first member of an entry of `size` bytes.
void check_times(Reader *reader, const YamlNode *list, const void *items, size_t size, uint32_t count);

/// Also checks that the file exists, if the reader has a folder.
void value_file(Reader *reader, const SchemaRow *row, const YamlNode *node, SceneFile *field);
