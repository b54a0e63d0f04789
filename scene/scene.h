// Scenes: what a scene file describes, apart from its syntax, and the way from a file to a simulation.
//
//   scene_read  file → Scene      every error at once, each with its location
//   scene_load  Scene → meshes and pictures
//   scene_build Scene, meshes, pictures → SingeSim
//
// A Scene holds the Defs of include/singe/types.h filled in, without the arrays they point to; those come
// with scene_load. Lengths are metres, angles radians, temperatures kelvin, as in the Defs.
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include <stdio.h>

#include "formats/formats.h"
#include "formats/output.h"
#include "mesh/to_quads.h"
#include "preview/preview.h"
#include "singe/singe.h"

// ---- locations and messages

/// Where something in a scene was written. A zeroed location is nowhere.
typedef struct SceneLocation {
    int line, column; ///< counted from 1; 0 for nothing
    int set;          ///< 1 + index of the --set that it came from, 0 for a file
    int file;         ///< number of the material file that it is in, 0 for the scene's own
} SceneLocation;

/// One error. `source` and the caret are absent (NULL, 0) where there is no line to show.
typedef struct SceneMessage {
    char *origin; ///< "letter.yaml:12:9", "letter.yaml" or "--set frames=x"
    char *text;   ///< what is wrong and what was expected
    SceneLocation location;
    char *source; ///< the line of the file, or NULL
    int caret;    ///< column of `source`, from 1, that the error begins at; 0 for none
} SceneMessage;

/// All errors of a call, in the order of the file. Zero it before the first use.
typedef struct SceneMessages {
    uint32_t count;
    SceneMessage *items;
    uint32_t left_out; ///< errors beyond the first 200, counted only
} SceneMessages;

/// Prints each as "ORIGIN: error: TEXT", the source line and a caret under it.
void scene_messages_print(const SceneMessages *messages, FILE *file);
void scene_messages_free(SceneMessages *messages);

// ---- the model

/// A file named in a scene.
typedef struct SceneFile {
    char *name; ///< as written; NULL when not given
    char *path; ///< resolved against the scene's folder
    SceneLocation location;
} SceneFile;

/// A moment of a motion as it is written: the rotation turns about x, then y, then z (fixed axes).
typedef struct SceneKey {
    float time, position[3];
    float rotation[3]; ///< radians
} SceneKey;

/// A sheet made by the program.
typedef struct SceneGrid {
    bool given;
    float size[2]; ///< m
    int cells[2];
    GridWear wear;
} SceneGrid;

/// Slots for what belongs to a material's SingeParams. Each has its own: where it lies in the Def, counted in whole
/// SingeParams, so that no list of them is needed.
#define SCENE_PARAM_SLOT(member) (offsetof(SingeMaterialDef, member) / sizeof(SingeParam))
enum { SCENE_PARAM_SLOTS = sizeof(SingeMaterialDef) / sizeof(SingeParam) };

/// What sources say of a material's fire, each from .. to; 0 and 0 where they say nothing.
typedef struct SceneMeasured {
    bool given;
    bool calibrated;      ///< the material was made to agree with it; otherwise it is held against a prediction
    float speed[2];       ///< m/s of a front that runs level
    float temperature[2]; ///< K, hottest
    float residue[2];     ///< share of the mass that is left
} SceneMeasured;

typedef struct SceneMaterial {
    SingeMaterialDef def;                  ///< pictures have no values before scene_load
    SceneFile textures[SCENE_PARAM_SLOTS]; ///< of parameters that follow a texture
    char *name;                            ///< for messages, may be NULL
    SceneMeasured measured;
} SceneMaterial;

/// What a number in a mesh file is, and which of its axes points up.
typedef enum SceneUnits { SCENE_UNITS_M, SCENE_UNITS_CM, SCENE_UNITS_MM, SCENE_UNITS_IN, SCENE_UNITS_FT } SceneUnits;
typedef enum SceneUp { SCENE_UP_Z, SCENE_UP_Y } SceneUp;

typedef struct SceneSheet {
    SceneLocation location;
    char *name;
    SceneFile mesh; ///< or grid
    SceneGrid grid;
    SceneFile picture;       ///< drawn on both sides, may be absent
    float colour[3];         ///< linear tint
    float transmittance;     ///< share of light that comes through, in the preview
    float scale;             ///< times what `units` says
    int units;               ///< SceneUnits of the mesh file
    int up;                  ///< SceneUp of the mesh file
    float weld;              ///< m, or 0 for MESH_WELD of the size
    int quads;               ///< MeshQuads
    float rotate[3];         ///< radians about x, then y, then z, after the scaling
    float translate[3];      ///< m, after the rotation
    float velocity[3];       ///< m/s at the start
    float drop_pieces_below; ///< m2
    SceneMaterial material;
} SceneSheet;

typedef struct SceneSource {
    SceneLocation location;
    SingeSourceDef def; ///< path, texture and strength pointers are empty
    uint32_t key_count;
    SceneKey *keys;
    SceneFile texture;
    uint32_t strength_count;
    SingeValueKey *strength;
    bool visible; ///< balls: drawn in the preview
} SceneSource;

/// A mesh that moves: a file for each frame.
typedef struct SceneMotion {
    bool given;
    SceneFile mesh; ///< with a run of # for the number
    int first;      ///< number of the file of frame 1
    float scale;    ///< times what `units` says
    int units;      ///< SceneUnits of the files
    int up;         ///< SceneUp of the files
} SceneMotion;

typedef struct SceneCollider {
    SceneLocation location;
    SingeColliderDef def; ///< its pointers are empty
    SceneFile mesh;       ///< of a mesh
    float scale;          ///< times what `units` says
    int units;            ///< SceneUnits of the mesh file
    SceneMotion motion;   ///< of a mesh that deforms, in place of `mesh`
    SceneFile picture;    ///< of a heightfield
    float heights[2];     ///< m, where the picture is black and where it is white
    uint32_t key_count;   ///< at least 1
    SceneKey *keys;
    float colour[3]; ///< linear, in the preview
    bool visible;
} SceneCollider;

typedef struct ScenePoint {
    float position[3];
} ScenePoint;

typedef struct ScenePin {
    SceneLocation location;
    char *sheet; ///< a sheet's name or number from 0; NULL is the first
    uint32_t sheet_index;
    uint32_t point_count;
    ScenePoint *points; ///< m, in the world at rest
    float radius;
    uint32_t vertex_count;
    uint32_t *vertices;
    uint32_t key_count;
    SceneKey *keys;
    SceneMotion motion; ///< in place of keys
} ScenePin;

/// How a probe's position is given.
typedef enum SceneProbeKind { SCENE_PROBE_UV, SCENE_PROBE_POINT } SceneProbeKind;

/// A point of a sheet that is followed through the run.
typedef struct SceneProbe {
    SceneLocation location;
    char *name;
    char *sheet; ///< as a pin's
    uint32_t sheet_index;
    int kind; ///< SceneProbeKind
    float uv[2];
    float point[3]; ///< m, in the world at the start
} SceneProbe;

typedef struct ScenePreview {
    int size[2]; ///< pixels
    int samples;
    PreviewCamera camera;
    bool camera_given; ///< its eye or target; otherwise scene_frame places it
    float light_direction[3], light_angle, light_colour[3];
    float sky[3];
    PreviewSky environment; ///< of the sky, if it has no picture
    SceneFile environment_picture;
    float environment_turn; ///< radians
    PreviewGround ground;
    float ground_height; ///< -INFINITY for none
    float ground_colour[3];
    float background[3];
    float exposure;
    float shutter; ///< share of a frame's time
} ScenePreview;

/// What a run writes for other programs.
typedef struct SceneOutput {
    OutputSet formats;
    bool events;      ///< events.csv
    int texture_size; ///< pixels
} SceneOutput;

/// A key or a word that the scene still calls by the name it had before this release.
typedef struct SceneRenamed {
    SceneLocation location;
    const char *before, *now;
    const struct SceneText *text; ///< that the location is in
    struct SceneRenamed *next;
} SceneRenamed;

typedef struct Scene {
    SceneRenamed *renamed; ///< the last one first
    char *name;            ///< of the outputs; the scene file's name without its ending by default
    int frames;            ///< frames to make, at least 1: frame 1 is the start, and N of them span (N - 1)/fps
    float fps;             ///< frames a second
    int steps;             ///< steps a frame
    int gas_detail;  ///< how many times finer along a side the cells of gas_detail/ are; 1: a run has no such files
    bool tearing;    ///< sheets tear (sim.solver.tearing, whatever the solver's other keys say)
    SingeSimDef sim; ///< time_step is 1/(fps * steps); hooks and thread_count are not the scene's
    uint32_t sheet_count, source_count, collider_count, pin_count, probe_count;
    uint32_t only_sheet_count; ///< of only_sheets; 0: all
    uint32_t *only_sheets;     ///< as the file has them; `sheets`, `pins` and `probes` hold nothing else
    SceneSheet *sheets;
    SceneSource *sources;
    SceneCollider *colliders;
    ScenePin *pins;
    SceneProbe *probes;
    ScenePreview preview;
    SceneOutput output;
    struct SceneText *text;   ///< the source, for messages after parsing
    struct SceneArena *arena; ///< owns all of the above
} Scene;

// ---- syntax

/// Reads a scene file (YAML, and so JSON). `sets` are texts PATH=VALUE laid over the file. On failure
/// *scene is NULL and *messages holds every error. Results: SINGE_ERROR_FORMAT for errors in the scene,
/// SINGE_ERROR_FILE when the file itself cannot be read, SINGE_ERROR_LIMIT above 1 MiB,
/// SINGE_ERROR_MEMORY.
SINGE_NODISCARD SingeResult scene_read(const char *path, const char *const *sets, int set_count, Scene **scene,
                                       SceneMessages *messages);

/// The same from memory. `name` is used in messages. Files are looked for in `base_dir`; NULL: the files
/// that the scene names are not looked for at all.
SINGE_NODISCARD SingeResult scene_parse(const char *name, const char *bytes, size_t size, const char *base_dir,
                                        const char *const *sets, int set_count, Scene **scene, SceneMessages *messages);

void scene_free(Scene *scene);

typedef enum SceneSyntax { SCENE_YAML = 0, SCENE_JSON = 1 } SceneSyntax;

/// Writes the scene with every value that it uses; it reads back as the same scene. `indent` is the number
/// of spaces before each line but the first (for a JSON dump inside another document).
void scene_dump(const Scene *scene, SceneSyntax syntax, int indent, FILE *file);

/// The index-th material that the program brings along, in the order of their names; NULL behind the last.
const char *scene_material_name(int index);

/// Whether two materials are equal to the last parameter.
bool scene_material_same(const SceneMaterial *a, const SceneMaterial *b);

/// Writes docs/scene.md, the reference of scene files, from the schema.
void scene_document(FILE *file);

// ---- from scene to simulation

/// A collider's mesh or heights, in its own frame.
typedef struct SceneSolid {
    PreviewSolid surface;   ///< its arrays come from malloc; of a heightfield with walls down to its lowest point
    uint32_t columns, rows; ///< of a heightfield
    float *heights;         ///< as SingeColliderDef has them
} SceneSolid;

/// Where a probe is in its sheet's mesh: values there are the weighted sum of those at a cell's corners.
typedef struct SceneProbePoint {
    uint32_t cell;    ///< numbered over all sheets
    double weight[4]; ///< of the cell's corners; they add up to 1
    double distance;  ///< from what the scene asks for: m, or of uv
} SceneProbePoint;

/// A pin's particle on a triangle of a moving mesh (sequence.c).
typedef struct SceneBond {
    uint32_t triangle;
    double weights[3], away[3];
} SceneBond;

/// The frames of a moving mesh, in metres. All have the triangles of the first.
typedef struct SceneSequence {
    uint32_t vertex_count, triangle_count, frame_count; ///< 0: there is none
    uint32_t *triangles;
    PreviewSolid *frames; ///< [frame_count] with vertices of their own
    uint32_t bond_count;
    SceneBond *bonds; ///< of a pin; NULL until scene_follow has made them
} SceneSequence;

/// The meshes (transforms applied) and pictures that a scene names.
typedef struct SceneAssets {
    uint32_t sheet_count, source_count, collider_count, pin_count;
    Mesh *meshes;                            ///< [sheet_count]
    MeshReport *reports;                     ///< [sheet_count] what was done to those of files
    Image *images;                           ///< [sheet_count], zeroed where there is none
    const Image **pictures;                  ///< [sheet_count], for PreviewDef: NULL where there is none
    float (*colours)[3];                     ///< [sheet_count], for PreviewDef
    float *transmittances;                   ///< the same
    SingeField (*fields)[SCENE_PARAM_SLOTS]; ///< [sheet_count] of parameters that vary, with their textures
    SingeTexture *source_textures;           ///< [source_count]
    SceneSolid *solids;                      ///< [collider_count], zeroed where they are primitives
    SceneSequence *collider_motions;         ///< [collider_count]
    SceneSequence *pin_motions;              ///< [pin_count]
    Image sky;                               ///< zeroed where there is none
    SceneProbePoint *probes;                 ///< [Scene.probe_count]
} SceneAssets;

/// Reads every file that the scene names. On failure *assets is empty and *messages points at the names, and also at
/// those of meshes that were read and that the library would refuse.
SINGE_NODISCARD SingeResult scene_load(const Scene *scene, SceneAssets *assets, SceneMessages *messages);
void scene_assets_free(SceneAssets *assets);

/// From a scene's numbers, before anything is made of it.
typedef struct SceneSize {
    uint64_t cells;  ///< of sheets
    uint32_t unread; ///< sheets whose mesh is in a file that was not read: their cells do not count
    double memory;   ///< bytes, about: of the simulation and its drawn mesh
} SceneSize;

/// `assets` are NULL before scene_load.
SceneSize scene_size(const Scene *scene, const SceneAssets *assets);

/// Bytes that its pictures take, about.
double scene_picture_memory(const Scene *scene);

/// Whether `wanted` bytes are there, of `room` (0: not known, and so they are); a message at the largest sheet
/// otherwise. `assets` are NULL before scene_load.
bool scene_fits(const Scene *scene, const SceneAssets *assets, double wanted, double room, SceneMessages *messages);

/// Makes the simulation: sheets, commit, sources, colliders, pins. Allocator, log, tasks and thread_count
/// are taken from `hooks`. On failure *sim is NULL and *messages names the scene's object: each sheet that is refused,
/// or the first other object. What is certain to have no effect is reported to the log of `hooks`, with its location.
SINGE_NODISCARD SingeResult scene_build(const Scene *scene, const SceneAssets *assets, const SingeSimDef *hooks,
                                        SingeSim **sim, SceneMessages *messages);

/// Tells a simulation of this scene where what moves with meshes is at the end of frame `frame` (from 1), which is the
/// start of the next. To be called before the first step of each frame. `assets` keep what pins are bonded to.
SINGE_NODISCARD SingeResult scene_follow(const Scene *scene, SceneAssets *assets, SingeSim *sim, int frame,
                                         SingeError *error);

// ---- from scene to preview

/// Places a camera that was not given so that all sheets, as they start, fill the picture. One that would have to
/// stand farther than 10 km from the origin stays where it is by default.
void scene_frame(Scene *scene, const SceneAssets *assets);

/// Fills *def; the scene and the assets must outlive it. Threads: 1. Shapes: none (scene_shapes).
void scene_preview(const Scene *scene, const SceneAssets *assets, PreviewDef *def);

/// Writes the visible colliders (planes are not shapes; see the ground) and hot balls at a time, at most
/// `max`, and returns how many the scene has then. shapes may be NULL when max is 0. They point into the assets.
uint32_t scene_shapes(const Scene *scene, const SceneAssets *assets, double time, PreviewShape *shapes, uint32_t max);

/// The shape at a slot, which are the scene's colliders, then its sources. False where nothing is drawn then.
bool scene_shape(const Scene *scene, const SceneAssets *assets, uint32_t slot, double time, PreviewShape *shape);

/// Seconds from one frame to the next, and the simulation's step.
static inline double scene_frame_time(const Scene *scene) { return 1.0 / (double)scene->fps; }

#endif
