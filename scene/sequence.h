// Meshes that move frame by frame: a sequence of files, and what follows it.
#ifndef SCENE_SEQUENCE_H
#define SCENE_SEQUENCE_H

#include "scene/scene.h"

/// Reads the files of a motion for at most `frames` frames, in metres. Each has the vertices and faces of the first. On
/// failure *sequence is empty.
SINGE_NODISCARD SingeResult sequence_read(const SceneMotion *motion, int frames, SceneSequence *sequence,
                                          SingeError *error);
void sequence_free(SceneSequence *sequence);

/// Whether a file's name says where the frame's number goes: one run of #, behind the last slash.
bool sequence_name_fits(const char *name);

#endif
