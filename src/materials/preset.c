// Materials by name.
#include "materials/preset.h"

#include "common/store.h"

#include <stdio.h>
#include <string.h>

const char *singe_material_preset_name(uint32_t index) {
    for (uint32_t i = 0; i < index; i++)
        if (!material_presets[i].name) return NULL;
    return material_presets[index].name;
}

SingeResult singe_material_preset(const char *name, SingeMaterialDef *def, SingeError *error) {
    const MaterialPreset *preset = material_presets;
    while (preset->name && !(name && strcmp(preset->name, name) == 0)) preset++;
    if (!preset->name) {
        char names[200] = "";
        for (const MaterialPreset *p = material_presets; p->name; p++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", p == material_presets ? "" : ", ",
                     p->name);
        return refuse(error, SINGE_ERROR_ARGUMENT, "material", -1, "there is no material of this name; there are: %s",
                      names);
    }

    const size_t size = def->struct_size;
    if (!struct_size_is_possible(size))
        return refuse(error, SINGE_ERROR_ARGUMENT, "material", -1, STRUCT_SIZE_UNKNOWN(singe_default_material));
    SingeMaterialDef made = singe_default_material();
    preset->apply(&made);
    singe_init_material(def, size); // fields of a newer header than ours become 0
    memcpy(def, &made, size < sizeof made ? size : sizeof made);
    def->struct_size = size;
    return SINGE_OK;
}
