// Keys and words that this release has renamed. Old names are read for one release, and reported.
#include "scene/schema.h"

#include <string.h>

static const struct {
    const char *in; ///< a schema's title; RENAMED_PARAM, or the key whose word it is
    const char *before, *now;
} names[] = {
    {RENAMED_PARAM, "picture", "texture"},
    {"a source", "picture", "texture"},
    {"kind", "picture", "texture"},
    {"a grid", "relief", "displacement"},
};

const char *renamed(Reader *reader, const char *in, const char *word, SceneLocation location) {
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(names[i].in, in) != 0 || strcmp(names[i].before, word) != 0) continue;
        SceneRenamed *entry = reader->scene ? arena_new(reader->arena, 1, sizeof *entry) : NULL;
        if (entry) {
            *entry = (SceneRenamed){location, names[i].before, names[i].now, reader->text, reader->scene->renamed};
            reader->scene->renamed = entry;
        }
        return names[i].now;
    }
    return word;
}
