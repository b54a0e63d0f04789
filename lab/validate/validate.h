// `singe validate`: a function per comparison of the physics with independent sources.
#ifndef VALIDATE_H
#define VALIDATE_H

#include "page/page.h"

LabFn validate_heat, validate_umbrella, validate_front, validate_pmma, validate_disc, validate_beam, validate_kinetics,
    validate_ledgers;

#endif
