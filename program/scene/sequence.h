// Meshes that move frame by frame: a sequence of files, and the objects that follow it.
#ifndef SCENE_SEQUENCE_H
#define SCENE_SEQUENCE_H

#include "scene/scene.h"

/// Reads the files of a motion for at most `frames` frames, in metres. Each must have the vertices and faces of the
/// first. On failure *sequence is empty.
SINGE_NODISCARD SingeResult sequence_read(const SceneMotion *motion, int frames, SceneSequence *sequence,
                                          SingeError *error);
void sequence_free(SceneSequence *sequence);

/// Whether a file's name has a place for the frame's number: one run of #, after the last slash.
bool sequence_name_fits(const char *name);

#endif
