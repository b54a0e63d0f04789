// Meshes that are drawn in place of sheets, from files.
#pragma once

#include "scene/scene.h"

/// Triangles of a file's polygons, whose positions are in metres and placed. Corners with different uv become vertices of
/// their own.
SINGE_NODISCARD SingeResult render_file_make(const char *name, const Polygons *polygons, RenderFile *file,
                                             SingeError *error);
void render_file_free(RenderFile *file);
