// Made by scene_presets from the files of this folder. Do not edit: change those and run
// `build/program/scene/scene_presets > src/materials/presets.c`.
#include "materials/preset.h"

#include <math.h>

static void cotton(SingeMaterialDef *def) {
    (void)def; // holds the defaults
    def->grammage = singe_param(0.12f);
    def->thickness = singe_param(0.0015f);
    def->emissivity = singe_param(0.85f);
    def->ignition_temperature = singe_param(578.15f);
    def->mass_min = singe_param(0.05f);
    static const SingeField mass_loss_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.025f, 5, 7}};
    def->mass_loss = singe_param_field(0, 0.36f, &mass_loss_0);
    def->ash_density = singe_param(0.08f);
    def->char_yield = singe_param(0.25f);
    def->char_density = singe_param(0.32f);
    static const SingeField char_rate_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.012f, 4, 5}};
    def->char_rate = singe_param_field(0.8f, 2.4f, &char_rate_0);
    static const SingeField shrink_front_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.05f, 2, 2}};
    def->shrink_front = singe_param_field(0.5f, 1.1f, &shrink_front_0);
    def->shrink_back = singe_param(0.7f);
    def->fibre_shrink = singe_param(1);
    def->compliance[1] = singe_param(0.5f);
    def->compliance[3] = singe_param(0.5f);
    def->crease_radius = singe_param(0);
    def->strength = singe_param(300);
    static const SingeField char_strength_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.015f, 4, 3}};
    def->char_strength = singe_param_field(2, 20, &char_strength_0);
    def->curvature_max = singe_param(270);
}

static void newsprint(SingeMaterialDef *def) {
    (void)def; // holds the defaults
    def->grammage = singe_param(0.045f);
    def->mass_min = singe_param(0.05f);
    static const SingeField mass_loss_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.025f, 5, 9}};
    def->mass_loss = singe_param_field(0, 0.36f, &mass_loss_0);
    def->ash_density = singe_param(0.08f);
    def->char_yield = singe_param(0.27f);
    def->char_density = singe_param(0.34f);
    static const SingeField char_rate_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.012f, 4, 5}};
    def->char_rate = singe_param_field(0.8f, 2.4f, &char_rate_0);
    def->strength = singe_param(50);
    static const SingeField char_strength_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.015f, 4, 3}};
    def->char_strength = singe_param_field(0.6f, 6, &char_strength_0);
}

static void office_paper(SingeMaterialDef *def) {
    (void)def; // holds the defaults
}

static void one_reaction(SingeMaterialDef *def) {
    (void)def; // holds the defaults
    def->heat_share = singe_param(0.2f);
    def->mass_loss = singe_param(0.25f);
    def->ash_density = singe_param(0.3f);
    def->char_yield = singe_param(0);
    static const SingeField shrink_front_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.008f, 2, 2}};
    def->shrink_front = singe_param_field(0.1f, 0.9f, &shrink_front_0);
    def->shrink_back = singe_param(0.3f);
    def->char_strength = singe_param(0.3f);
    def->curvature_max = singe_param(0);
    def->air_supply = singe_param(INFINITY);
}

static void tissue(SingeMaterialDef *def) {
    (void)def; // holds the defaults
    def->grammage = singe_param(0.02f);
    def->thickness = singe_param(0.0007f);
    def->mass_min = singe_param(0.03f);
    static const SingeField mass_loss_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.02f, 5, 7}};
    def->mass_loss = singe_param_field(0, 0.36f, &mass_loss_0);
    def->ash_density = singe_param(0.05f);
    def->char_yield = singe_param(0.25f);
    def->char_density = singe_param(0.32f);
    static const SingeField char_rate_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.012f, 4, 5}};
    def->char_rate = singe_param_field(0.8f, 2.4f, &char_rate_0);
    def->strength = singe_param(10);
    static const SingeField char_strength_0 = {.kind = SINGE_FIELD_NOISE, .noise = {0.015f, 4, 3}};
    def->char_strength = singe_param_field(0.3f, 3, &char_strength_0);
    def->curvature_max = singe_param(570);
}

const MaterialPreset material_presets[] = {
    {"cotton", cotton},
    {"newsprint", newsprint},
    {"office-paper", office_paper},
    {"one-reaction", one_reaction},
    {"tissue", tissue},
    {0},
};
