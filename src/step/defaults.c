// The default Defs. Where the numbers come from: docs/equations.md, "Parameters".
#include "singe/types.h"

#include <math.h>

SingeParam singe_param(float value) {
    return (SingeParam){.value = value, .to = value, .noise = {.scale = 0.01f, .octaves = 4}};
}

SingeMaterialDef singe_default_material(void) {
    SingeMaterialDef def = {
        .struct_size = sizeof def,
        .grammage = 0.080f,
        .specific_heat = 1400,
        .thickness = singe_param(1e-3f),
        .heat_operator = SINGE_HEAT_SURFACE,
        .diffusivity = singe_param(3.4e-6f),
        .layer_exchange = 36,
        .convection = 14,
        .emissivity = 0.9f,
        .loss_mass_floor = 0.15f,
        .thickening = 0,
        .temperature = singe_param(293.15f),
        .ignition_temperature = singe_param(513.15f),
        .heating = singe_param(2250),
        .mass_rate = singe_param(9e-3f),
        .rate_ceiling = 260,
        .ash_exponent = singe_param(0.5f),
        .mass_min = singe_param(0.15f),
        .mass_loss = singe_param(0.25f),
        .ash_density = singe_param(0.3f),
        .shrink_front = singe_param(0.5f),
        .shrink_back = singe_param(0.5f),
        .ablate = true,
        .compliance = {0, 0, 0, 0},
        .char_weight = 0.4f,
        .drag = 1.3f,
        .damping = 0.5f,
    };
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) def.weight[colour] = singe_param(1);
    return def;
}

SingeSheetDef singe_default_sheet(void) {
    return (SingeSheetDef){.struct_size = sizeof(SingeSheetDef), .material = singe_default_material()};
}

SingeSourceDef singe_default_source(void) {
    return (SingeSourceDef){
        .struct_size = sizeof(SingeSourceDef),
        .kind = SINGE_SOURCE_SPOT,
        .start = 0,
        .end = INFINITY,
        .temperature = 1200,
        .conductance = 150,
        .radius = 0.005f,
        .falloff = 0.01f,
        .flux = 30e3f,
        .plume_share = 0.5f,
        .plume_height = 0.10f,
        .plume_conductance = 30,
    };
}

SingeColliderDef singe_default_collider(void) {
    return (SingeColliderDef){
        .struct_size = sizeof(SingeColliderDef),
        .kind = SINGE_COLLIDER_PLANE,
        .radius = 0.05f,
        .half_size = {0.05f, 0.05f, 0.05f},
        .height = 0.1f,
        .friction = 0.4f,
        .offset = 0.0005f,
        .temperature = 293.15f,
        .contact_distance = 0.002f,
    };
}

SingePinDef singe_default_pin(void) { return (SingePinDef){.struct_size = sizeof(SingePinDef), .radius = 0.005f}; }

SingeWindDef singe_default_wind(void) {
    return (SingeWindDef){.struct_size = sizeof(SingeWindDef), .gust_time = 0.5f, .gust_size = 0.3f, .seed = 1};
}

SingeSolverDef singe_default_solver(void) {
    return (SingeSolverDef){
        .struct_size = sizeof(SingeSolverDef),
        .substeps = 3,
        .order = {SINGE_GREEN, SINGE_RED, SINGE_YELLOW, SINGE_BLUE},
        .regularisation = {[SINGE_RED] = 4, [SINGE_GREEN] = 4, [SINGE_BLUE] = 0.01f, [SINGE_YELLOW] = 4},
        .smoothing = 170,
        .smoothing_length = 0.02f,
        .height_min = 0.3f,
        .height_gain = 0.5f,
    };
}

SingeSimDef singe_default_sim(void) {
    return (SingeSimDef){
        .struct_size = sizeof(SingeSimDef),
        .thread_count = 1,
        .seed = 1,
        .time_step = 1.0f / 480,
        .pace = 1,
        .gravity = {0, 0, -9.81f},
        .ambient_temperature = 293.15f,
        .air_density = 1.2f,
        .heat_tolerance = 1e-5f,
        .wind = singe_default_wind(),
        .solver = singe_default_solver(),
    };
}
