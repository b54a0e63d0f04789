// Velocity of the air at a position and time.
#pragma once

#include "common/error.h"
#include "common/float3.h"
#include "singe/types.h"

Float3 wind_velocity(const SingeWindDef *def, Float3 position, double time);
