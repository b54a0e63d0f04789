// Velocity of the air at a position and time.
#ifndef WORLD_WIND_H
#define WORLD_WIND_H

#include "common/error.h"
#include "common/float3.h"
#include "singe/types.h"

Float3 wind_velocity(const SingeWindDef *def, Float3 position, double time);

#endif
