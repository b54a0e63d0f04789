/// Singe burns cloth and paper: one header for the whole library.
#ifndef SINGE_SINGE_H
#define SINGE_SINGE_H

#include "singe/base.h"
#include "singe/material.h"
#include "singe/types.h"
#include "singe/mesh.h"
#include "singe/surface.h"
#include "singe/sim.h"
#include "singe/replay.h"
#include "singe/research.h"

#endif
