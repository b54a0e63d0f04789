// `singe validate`: a function per check of the physics against sources outside the project.
#ifndef CLI_VALIDATE_H
#define CLI_VALIDATE_H

#include "cli/lab/page.h"

LabFn validate_heat, validate_umbrella, validate_front, validate_pmma, validate_disc, validate_beam, validate_kinetics,
    validate_ledgers;

#endif
