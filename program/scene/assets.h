// What a scene takes from files, read by scene_load (load.c).
#pragma once

#include "scene/messages.h"

// ---- colliders

/// The triangles of a mesh file, times `scale`.
SINGE_NODISCARD SingeResult solid_read_mesh(const char *name, const uint8_t *bytes, size_t size, double scale,
                                            SceneSolid *solid, SingeError *error);

/// What is known of a face's corner while it is cut.
typedef struct SolidEar {
    double square;    ///< m2, of the new edge when it is clipped; infinite if it is no ear
    uint32_t blocker; ///< the first corner left that lies in its triangle; UINT32_MAX: none, or it turns the other way
} SolidEar;

/// Cuts a face into count - 2 triangles; `left` has its corners and is consumed, as is `ears`, of the same length.
void solid_cut_face(const float *vertices, uint32_t *left, SolidEar *ears, uint32_t count, uint32_t *triangles);

/// Heights from a picture, between the heights of black and of white, over a rectangle of that size, and the drawn
/// surface.
SINGE_NODISCARD SingeResult solid_make_heights(const SingeTexture *picture, const float size[2], const float heights[2],
                                               SceneSolid *solid, SingeError *error);

/// Metres per unit of a file with these SceneUnits, times `scale` (load.c).
double metres_per_unit(int unit, float scale);

void solid_free(SceneSolid *solid);

// ---- meshes that are drawn in place of sheets

/// Triangles of a file's polygons, whose positions are in metres and placed. Corners with different uv become vertices of
/// their own.
SINGE_NODISCARD SingeResult render_file_make(const char *name, const Polygons *polygons, RenderFile *file,
                                             SingeError *error);
void render_file_free(RenderFile *file);

// ---- meshes that move frame by frame, a file each, and the objects that follow them

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

// ---- what holds sheets

/// Fills assets->holders, by the sheets' meshes. False without memory.
bool holders_make(const Scene *scene, SceneAssets *assets);

/// The shape of a part at a time, but for its solid, its temperature and its velocity.
void holder_pose(const Scene *scene, const SceneHolder *holder, double time, PreviewShape *shape);

/// Position and rotation on a path at a time.
void keys_pose(const SceneKey *keys, uint32_t count, double time, PreviewShape *shape);
void holders_free(SceneAssets *assets);

// ---- probes

/// Fills assets->probes, which is allocated. Reports probes by uv on a mesh without uv.
void probes_find(const Scene *scene, SceneAssets *assets, SceneMessages *messages);
