// `singe validate`: a function per comparison of the physics with independent sources.
#ifndef EXPERIMENTS_VALIDATE_H
#define EXPERIMENTS_VALIDATE_H

#include "experiments/page.h"

LabFn validate_heat, validate_umbrella, validate_front, validate_pmma, validate_disc, validate_beam, validate_kinetics,
    validate_ledgers;

#endif
