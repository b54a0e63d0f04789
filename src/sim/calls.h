// The calls that change a simulation, as src/sim defines them: call_NAME for singe_sim_NAME. Inside the library they are
// called by these names, so that a recording holds what its user called, and no more.
#pragma once

#include "sim/sim_internal.h"

// The parameters of each kind of arguments, and their names.
#define PARAMETERS_NOTHING
#define PARAMETERS_DEF(Type, name) , const Singe##Type##Def *def
#define PARAMETERS_PIN_DEF PARAMETERS_DEF(Pin, pin)
#define PARAMETERS_NEW(Type) , Singe##Type##Id *made
#define PARAMETERS_HANDLE(Type, name) , Singe##Type##Id id
#define PARAMETERS_CALLBACK , SingeFluxFn *callback, void *context
#define PARAMETERS_COLLIDER_VERTICES , const float *points
#define PARAMETERS_PIN_POSITIONS , const float *points
#define PARAMETERS_PATH , uint32_t path_count, const SingePoseKey *path
#define PARAMETERS_GRAVITY , const float gravity[3]
#define PARAMETERS_NUMBER , float number
#define PARAMETERS_SECONDS , double seconds
#define PARAMETERS_VELOCITIES , uint32_t first, uint32_t count, const float *velocities
#define PARAMETERS_SHARE , const float *share
#define PARAMETERS_STEPS , uint32_t steps_max, uint32_t *steps
#define PARAMETERS_SURFACE , SingeSurface *surface, size_t struct_size
#define PARAMETERS_SNAPSHOT , uint8_t **bytes, size_t *size
#define PARAMETERS_COPY , SingeSim **copy

#define SINGE_CALL(number, name, A, B, C) \
    SingeResult call_##name(SingeSim *sim PARAMETERS_##A PARAMETERS_##B PARAMETERS_##C);
#include "sim/calls.def"

/// The points that set_collider_vertices and set_pin_positions read; 0 for a handle that they refuse.
uint32_t call_collider_points(const SingeSim *sim, SingeColliderId id);
uint32_t call_pin_points(const SingeSim *sim, SingePinId id);
