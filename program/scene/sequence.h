// Meshes that move frame by frame: a sequence of files, and the objects that follow it.
#pragma once

#include "scene/scene.h"

/// Reads the files of a motion for at most `frames` frames, in metres. Each must have the vertices and faces of the
/// first. On failure *sequence is empty.
SINGE_NODISCARD SingeResult sequence_read(const SceneMotion *motion, int frames, SceneSequence *sequence,
                                          SingeError *error);
void sequence_free(SceneSequence *sequence);

/// The path of a numbered file, from malloc; NULL when out of memory.
char *sequence_path(const char *path, int number);

/// How many files there are from number `first` on, at least 1 and at most `most`. Fails if one is missing while the next
/// one exists.
SINGE_NODISCARD SingeResult sequence_length(const char *path, int first, int most, int *length, SingeError *error);

/// Reads a picture's luminance; its values are to be freed (load.c).
SINGE_NODISCARD SingeResult luminance_read(const char *path, SingeTexture *picture, SingeError *error);

/// Gives a sheet its material for the steps after frame `frame` (from 1), if it differs from that of the frame before or
/// if `always`.
SINGE_NODISCARD SingeResult follow_material(const Scene *scene, const SceneAssets *assets, SingeSim *sim,
                                            uint32_t sheet, int frame, bool always, SingeError *error);

/// Whether a file's name has a place for the frame's number: one run of #, after the last slash.
bool sequence_name_fits(const char *name);
