// Textures of the experiments: shown, and correlated with results.
#pragma once

#include "page/lab.h"

/// Adds the texture, as it lies on the sheet, to the report.
void texture_show(Lab *lab, const SingeTexture *picture);

/// The mean of its values.
double texture_mean(const SingeTexture *picture);

/// Correlation of the texture, or of its mirror image, with a field of the vertices.
double texture_correlation(const SingeView *view, const SingeTexture *picture, bool mirrored, const float *field);
