/// Singe burns cloth and paper: one header for the whole library.
///
/// In order: singe_sim_create makes a simulation; singe_mesh_create (or any quads) and singe_sim_add_sheet fill it, with
/// sources, colliders and pins; singe_sim_commit builds it; singe_sim_advance or singe_sim_step runs it; singe_sim_view and
/// singe_sim_surface show it; singe_sim_destroy frees it. docs/samples has a program for each thing.
///
/// What it does not do: it reads and writes no files, prints nothing, ends no program and keeps no globals. It draws no
/// pictures and knows no scene files, units but SI, or lights: that is the command `singe`.
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
