// A part of a scene: `only_sheets` keeps some sheets, with their pins and probes, and drops the others. Objects that
// act on all sheets remain: sources, colliders, wind.
#include "scene/schema.h"

void scene_keep_only_sheets(Reader *reader, const YamlNode *node, Scene *scene) {
    enum { LEFT_OUT = -1 };
    int32_t *now = arena_new(reader->arena, scene->sheet_count, sizeof *now); // new numbers of the sheets
    if (!now) return;

    for (uint32_t i = 0; i < scene->sheet_count; i++) now[i] = LEFT_OUT;

    const uint32_t before = message_total(reader->messages);
    const YamlNode *number = node->first;
    for (uint32_t i = 0; number && i < scene->only_sheet_count; i++, number = number->next) {
        const uint32_t sheet = scene->only_sheets[i];
        if (sheet >= scene->sheet_count)
            message_add(reader->messages, reader->text, number->location,
                        "there is no sheet %u; the scene has %u, numbered from 0", sheet, scene->sheet_count);
        else if (now[sheet] != LEFT_OUT)
            message_add(reader->messages, reader->text, number->location, "sheet %u is given twice", sheet);
        else now[sheet] = 0;
    }

    if (message_total(reader->messages) != before) return;

    uint32_t sheets = 0, pins = 0, probes = 0;
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        if (now[i] == LEFT_OUT) continue;
        scene->sheets[sheets] = scene->sheets[i];
        now[i] = (int32_t)sheets++;
    }

    scene->sheet_count = sheets;

    // pins and probes name their sheets from now on, as the numbers have changed
    for (uint32_t i = 0; i < scene->pin_count; i++) {
        ScenePin pin = scene->pins[i];
        if (now[pin.sheet_index] == LEFT_OUT) continue;
        pin.sheet_index = (uint32_t)now[pin.sheet_index];
        pin.sheet = scene->sheets[pin.sheet_index].name;
        scene->pins[pins++] = pin;
    }

    scene->pin_count = pins;

    for (uint32_t i = 0; i < scene->probe_count; i++) {
        SceneProbe probe = scene->probes[i];
        if (now[probe.sheet_index] == LEFT_OUT) continue;
        probe.sheet_index = (uint32_t)now[probe.sheet_index];
        probe.sheet = scene->sheets[probe.sheet_index].name;
        scene->probes[probes++] = probe;
    }

    scene->probe_count = probes;
}
