// Made by scene_presets from the files of this folder. Do not edit: change those and run
// `build/scene/scene_presets > materials/presets.c`.
#include "materials/preset.h"

static void cotton(SingeMaterialDef *def) {
    (void)def;
    preset_even(&def->grammage, 0.12f);
    preset_even(&def->thickness, 0.0015f);
    preset_even(&def->emissivity, 0.85f);
    preset_even(&def->ignition_temperature, 578.15f);
    preset_even(&def->mass_min, 0.05f);
    preset_noise(&def->mass_loss, 0, 0.36f, 0.025f, 5, 7);
    preset_even(&def->ash_density, 0.08f);
    preset_even(&def->char_yield, 0.25f);
    preset_even(&def->char_density, 0.32f);
    preset_noise(&def->char_rate, 0.8f, 2.4f, 0.012f, 4, 5);
    preset_noise(&def->shrink_front, 0.5f, 1.1f, 0.05f, 2, 2);
    preset_even(&def->shrink_back, 0.7f);
    preset_even(&def->fibre_shrink, 1);
    preset_even(&def->compliance[1], 0.5f);
    preset_even(&def->compliance[3], 0.5f);
    preset_even(&def->crease_radius, 0);
    preset_even(&def->strength, 300);
    preset_noise(&def->char_strength, 2, 20, 0.015f, 4, 3);
    preset_even(&def->curvature_max, 270);
}

static void newsprint(SingeMaterialDef *def) {
    (void)def;
    preset_even(&def->grammage, 0.045f);
    preset_even(&def->mass_min, 0.05f);
    preset_noise(&def->mass_loss, 0, 0.36f, 0.025f, 5, 9);
    preset_even(&def->ash_density, 0.08f);
    preset_even(&def->char_yield, 0.27f);
    preset_even(&def->char_density, 0.34f);
    preset_noise(&def->char_rate, 0.8f, 2.4f, 0.012f, 4, 5);
    preset_even(&def->strength, 50);
    preset_noise(&def->char_strength, 0.6f, 6, 0.015f, 4, 3);
}

static void office_paper(SingeMaterialDef *def) { (void)def; }

static void one_reaction(SingeMaterialDef *def) {
    (void)def;
    preset_even(&def->heat_share, 0.2f);
    preset_even(&def->mass_loss, 0.25f);
    preset_even(&def->ash_density, 0.3f);
    preset_even(&def->char_yield, 0);
    preset_noise(&def->shrink_front, 0.1f, 0.9f, 0.008f, 2, 2);
    preset_even(&def->shrink_back, 0.3f);
    preset_even(&def->char_strength, 0.3f);
    preset_even(&def->curvature_max, 0);
}

static void tissue(SingeMaterialDef *def) {
    (void)def;
    preset_even(&def->grammage, 0.02f);
    preset_even(&def->thickness, 0.0007f);
    preset_even(&def->mass_min, 0.03f);
    preset_noise(&def->mass_loss, 0, 0.36f, 0.02f, 5, 7);
    preset_even(&def->ash_density, 0.05f);
    preset_even(&def->char_yield, 0.25f);
    preset_even(&def->char_density, 0.32f);
    preset_noise(&def->char_rate, 0.8f, 2.4f, 0.012f, 4, 5);
    preset_even(&def->strength, 10);
    preset_noise(&def->char_strength, 0.3f, 3, 0.015f, 4, 3);
    preset_even(&def->curvature_max, 570);
}

const MaterialPreset material_presets[] = {
    {"cotton", cotton},
    {"newsprint", newsprint},
    {"office-paper", office_paper},
    {"one-reaction", one_reaction},
    {"tissue", tissue},
    {0},
};
