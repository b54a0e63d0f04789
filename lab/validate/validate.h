// `singe validate`: a function per comparison of the physics with independent sources.
#pragma once

#include "page/page.h"

/// The bar of a measurement of others, here over theirs: within a factor of one and a half, the same for all.
#define VALIDATE_LOW (1 / 1.5)
#define VALIDATE_HIGH 1.5

LabFn validate_heat, validate_umbrella, validate_front, validate_pmma, validate_disc, validate_beam, validate_kinetics,
    validate_ledgers, validate_cone, validate_oxygen, validate_damp, validate_plume, validate_grades;

/// The grade of a measure.
ReportGradeFn validate_grade;
