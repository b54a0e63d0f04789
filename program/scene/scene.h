// Scenes: the model of a scene file, and the steps from a file to a simulation.
//
//   scene_read  file → Scene      reports all errors, each with its location
//   scene_load  Scene → meshes and pictures
//   scene_build Scene, meshes, pictures → SingeSim
//
// A Scene holds the filled-in Defs of include/singe/types.h, without the arrays they point to; scene_load reads those.
// Lengths are metres, angles radians, temperatures kelvin, as in the Defs.
#pragma once

#include <stdio.h>

#include "formats/formats.h"
#include "formats/output.h"
#include "mesh/to_quads.h"
#include "preview/preview.h"
#include "singe/singe.h"

// ---- locations and messages

/// The location of a value in a scene. A zeroed location is none.
typedef struct SceneLocation {
    int line, column; ///< from 1; 0 for none
    int set;          ///< 1 + index of the --set, 0 for a file
    int file;         ///< number of the material file, 0 for the scene
} SceneLocation;

/// One error. Without a line to show, `source` and the caret are absent (NULL, 0).
typedef struct SceneMessage {
    char *origin; ///< "letter.yaml:12:9", "letter.yaml" or "--set frames=x"
    char *text;   ///< the error, and what was expected
    SceneLocation location;
    char *source; ///< the line of the file, or NULL
    int caret;    ///< column of `source`, from 1, at which the error begins; 0 for none
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
    char *name; ///< as written; NULL if not given
    char *path; ///< resolved against the scene's folder
    SceneLocation location;
} SceneFile;

/// A key of a motion as written: the rotation is about x, then y, then z (fixed axes).
typedef struct SceneKey {
    float time, position[3];
    float rotation[3]; ///< radians
} SceneKey;

/// A sheet that is a grid.
typedef struct SceneGrid {
    bool given;
    SingeGridDef def;
} SceneGrid;

/// Slots for the textures of a material's SingeParams. A parameter's slot is its offset in the Def in units of
/// SingeParam, so no list of parameters is needed.
#define SCENE_PARAM_SLOT(member) (offsetof(SingeMaterialDef, member) / sizeof(SingeParam))

enum { SCENE_PARAM_SLOTS = sizeof(SingeMaterialDef) / sizeof(SingeParam) };

/// A material's fire according to its sources, each a range; 0 and 0 if unknown.
typedef struct SceneMeasured {
    bool given;
    bool calibrated;      ///< the material is calibrated to it; otherwise a prediction is compared with it
    float speed[2];       ///< m/s of a level front
    float temperature[2]; ///< K, hottest
    float residue[2];     ///< share of the mass that remains
} SceneMeasured;

/// What a parameter follows: a picture, or one for each frame (a name with a run of #); or keys over time.
typedef struct SceneFollowed {
    SceneFile texture;
    uint32_t key_count;
    SingeValueKey *keys;
} SceneFollowed;

typedef struct SceneMaterial {
    SingeMaterialDef
        def; ///< pictures have no values before scene_load; what has keys has its first, and `to` the farthest
    SceneFollowed followed[SCENE_PARAM_SLOTS];
    char *name; ///< for messages, may be NULL
    SceneMeasured measured;
    PreviewLook look;
} SceneMaterial;

/// The unit of a mesh file, and its axis that points up.
typedef enum SceneUnits { SCENE_UNITS_M, SCENE_UNITS_CM, SCENE_UNITS_MM, SCENE_UNITS_IN, SCENE_UNITS_FT } SceneUnits;

typedef enum SceneUp { SCENE_UP_Z, SCENE_UP_Y } SceneUp;

/// A mesh that is drawn in place of a sheet.
typedef struct SceneRenderMesh {
    bool given;
    SceneFile mesh;
    SingeRenderMeshDef def; ///< without the mesh
} SceneRenderMesh;

typedef struct SceneSheet {
    SceneLocation location;
    char *name;
    SceneFile mesh; ///< or grid
    SceneGrid grid;
    SceneRenderMesh render_mesh;
    SceneFile picture;   ///< drawn on the side from which it reads, may be absent
    SceneFile back;      ///< on the other side, may be absent
    float colour[3];     ///< linear tint
    float transmittance; ///< share of light transmitted, in the preview
    float scale;         ///< factor, in addition to `units`
    int units;           ///< SceneUnits of the mesh file
    int up;              ///< SceneUp of the mesh file
    float weld;          ///< m, or 0 for MESH_WELD of the size
    SingeMeshQuads quads;
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
    float scale;    ///< factor, in addition to `units`
    int units;      ///< SceneUnits of the files
    int up;         ///< SceneUp of the files
} SceneMotion;

typedef struct SceneCollider {
    SceneLocation location;
    SingeColliderDef def; ///< its pointers are empty
    SceneFile mesh;       ///< of a mesh
    float scale;          ///< factor, in addition to `units`
    int units;            ///< SceneUnits of the mesh file
    SceneMotion motion;   ///< of a mesh that deforms, in place of `mesh`
    SceneFile picture;    ///< of a heightfield
    float heights[2];     ///< m, of black and of white pixels
    uint32_t key_count;   ///< at least 1
    SceneKey *keys;
    float colour[3]; ///< linear, in the preview
    int surface;     ///< PreviewSurface
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
    float radius, end;
    uint32_t vertex_count;
    uint32_t *vertices;
    uint32_t key_count;
    SceneKey *keys;
    SceneMotion motion; ///< in place of keys
    int holder;         ///< PreviewHolder, what it looks like
} ScenePin;

/// How a probe's position is given.
typedef enum SceneProbeKind { SCENE_PROBE_UV, SCENE_PROBE_POINT } SceneProbeKind;

/// A point of a sheet that is recorded through the run.
typedef struct SceneProbe {
    SceneLocation location;
    char *name;
    char *sheet; ///< as a pin's
    uint32_t sheet_index;
    int kind; ///< SceneProbeKind
    float uv[2];
    float point[3]; ///< m, in the world at the start
} SceneProbe;

/// Where the camera is at a time.
typedef struct SceneCameraKey {
    float time; ///< s; first, as check_times reads it
    float eye[3], target[3];
    float fov, focus; ///< as in PreviewCamera; fov 0: the camera's
} SceneCameraKey;

typedef struct ScenePreview {
    PreviewDef def;            ///< as scenes give it: scene_preview fills in the rest
    uint32_t camera_key_count; ///< 0: the camera stands still
    SceneCameraKey *camera_keys;
    bool camera_given;             ///< its eye or target; otherwise scene_frame places it
    SceneFile environment_picture; ///< in place of def.sky
    float shutter;                 ///< share of a frame's time
} ScenePreview;

/// The files that a run writes for other programs.
typedef struct SceneOutput {
    SceneLocation location; ///< of `formats`
    OutputSet formats;
    bool events;      ///< events.csv
    int texture_size; ///< pixels
} SceneOutput;

/// Which checkpoints a run keeps; all 0: only the last two.
typedef struct SceneCheckpoints {
    int every;       ///< frames
    float megabytes; ///< 0: any number
} SceneCheckpoints;

/// How much has burnt by when; the pace follows.
typedef struct SceneBurnBy {
    bool given;
    float fraction; ///< of the initial mass
    int frame;
} SceneBurnBy;

typedef struct Scene {
    char *name;     ///< of the outputs; the scene file's name without its ending by default
    int frames;     ///< frames to make, at least 1: frame 1 is the start, and N of them span (N - 1)/fps
    float fps;      ///< frames a second
    int steps;      ///< steps a frame
    int gas_detail; ///< factor by which the cells of gas_detail/ are smaller; 1: a run has no such files
    SceneLocation gas_detail_location;
    uint32_t pace_count; ///< 0: the pace is sim.pace throughout
    SingeValueKey *paces;
    SceneBurnBy burn_by;
    bool tearing; ///< sheets tear (sim.solver.tearing, whatever the solver's other keys say)
    /// time_step is 1/(fps * steps), and velocity_steps is steps; hooks and thread_count are not the scene's
    SingeSimDef sim;
    uint32_t sheet_count, source_count, collider_count, pin_count, probe_count;
    SceneSheet *sheets;
    SceneSource *sources;
    SceneCollider *colliders;
    ScenePin *pins;
    SceneProbe *probes;
    ScenePreview preview;
    SceneOutput output;
    SceneCheckpoints checkpoints;
    struct SceneText *text;   ///< the source, for messages after parsing
    struct SceneArena *arena; ///< owns all of the above
} Scene;

// ---- syntax

/// Reads a scene file (YAML, and so JSON). `sets` are PATH=VALUE texts that override the file. On failure *scene is
/// NULL and *messages holds every error. Results: SINGE_ERROR_FORMAT for errors in the scene, SINGE_ERROR_FILE when the
/// file itself cannot be read, SINGE_ERROR_LIMIT above 1 MiB, SINGE_ERROR_MEMORY.
SINGE_NODISCARD SingeResult scene_read(const char *path, const char *const *sets, int set_count, Scene **scene,
                                       SceneMessages *messages);

/// The same from memory. `name` is used in messages. Files are read relative to `base_dir`; NULL: files are neither
/// checked nor read.
SINGE_NODISCARD SingeResult scene_parse(const char *name, const char *bytes, size_t size, const char *base_dir,
                                        const char *const *sets, int set_count, Scene **scene, SceneMessages *messages);

void scene_free(Scene *scene);

typedef enum SceneSyntax { SCENE_YAML = 0, SCENE_JSON = 1 } SceneSyntax;

/// Writes the scene with every value that it uses; it reads back as the same scene. `indent` is the number
/// of spaces before each line but the first (for a JSON dump inside another document).
void scene_dump(const Scene *scene, SceneSyntax syntax, int indent, FILE *file);

/// The index-th built-in material, sorted by name; NULL after the last.
const char *scene_material_name(int index);

/// Whether all parameters of two materials are equal.
bool scene_material_same(const SceneMaterial *a, const SceneMaterial *b);

/// Writes docs/scene.md, the reference of scene files, from the schema.
void scene_document(FILE *file);

/// A pace of 0 is this one: the library takes none that is smaller. In a year of motion 30 seconds of fire pass.
#define SCENE_PACE_MIN 1e-6f

/// Writes the JSON Schema (draft 7) of scene files.
void scene_json_schema(FILE *file);

// ---- from scene to simulation

/// A collider's mesh or heights, in its own frame.
typedef struct SceneSolid {
    PreviewSolid surface;   ///< its arrays come from malloc; a heightfield has walls down to its lowest point
    uint32_t columns, rows; ///< of a heightfield
    float *heights;         ///< as in SingeColliderDef
} SceneSolid;

/// The location of a probe in its sheet's mesh: its values are weighted sums over a cell's corners.
typedef struct SceneProbePoint {
    uint32_t cell;    ///< numbered over all sheets
    double weight[4]; ///< of the cell's corners; their sum is 1
    double distance;  ///< from the point that the scene asks for: m, or in uv
} SceneProbePoint;

/// Binds a pin's particle to a triangle of a moving mesh (sequence.c).
typedef struct SceneBond {
    uint32_t triangle;
    double weights[3], away[3];
} SceneBond;

/// The frames of a moving mesh, in metres. All have the first frame's triangles.
typedef struct SceneSequence {
    uint32_t vertex_count, triangle_count, frame_count; ///< 0: there is none
    uint32_t *triangles;
    PreviewSolid *frames; ///< [frame_count] with vertices of their own
    uint32_t bond_count;
    SceneBond *bonds; ///< of a pin; NULL before scene_follow
} SceneSequence;

/// The meshes (transforms applied) and pictures that a scene names.
/// A mesh that is drawn in place of a sheet, as it was read.
typedef struct RenderFile {
    SingeRenderMeshDef def; ///< points at the arrays
    float *positions;       ///< [3 * def.vertex_count] m
    float *uv;              ///< [2 * def.vertex_count] or NULL
    uint32_t *triangles;    ///< [3 * def.triangle_count]
} RenderFile;

/// A drawn part of what holds a sheet (holders.c).
typedef struct SceneHolder {
    PreviewHolderPart part; ///< at the start
    int32_t pin;            ///< it moves with this one; -1: it stands still
    int32_t rod;            ///< a ring: the collider that it hangs from; -1: none
    bool swings;            ///< a ring: about its rod, which stands still if it is no collider
    float at[3];            ///< m, of a ring: what hangs from it
} SceneHolder;

typedef struct SceneAssets {
    uint32_t sheet_count, source_count, collider_count, pin_count, holder_count;
    Mesh *meshes;                            ///< [sheet_count]
    MeshReport *reports;                     ///< [sheet_count] repairs of meshes from files
    RenderFile *renders;                     ///< [sheet_count], zeroed if there is none
    Image *images;                           ///< [2 * sheet_count] of pictures, then of backs; zeroed if there is none
    const Image **pictures;                  ///< the same, for PreviewDef; NULL if there is none
    float (*colours)[3];                     ///< [sheet_count], for PreviewDef
    float *transmittances;                   ///< the same
    PreviewLook *looks;                      ///< the same
    SingeField (*fields)[SCENE_PARAM_SLOTS]; ///< [sheet_count] of parameters that vary, with their textures
    SingeTexture *source_textures;           ///< [source_count]
    SceneSolid *solids;                      ///< [collider_count], zeroed for primitives
    SceneSequence *collider_motions;         ///< [collider_count]
    SceneSequence *pin_motions;              ///< [pin_count]
    Image sky;                               ///< zeroed if there is none
    SceneProbePoint *probes;                 ///< [Scene.probe_count]
    SceneHolder *holders;                    ///< [holder_count]
} SceneAssets;

/// Reads every file that the scene names. On failure *assets is empty and *messages has the locations of the files'
/// names; also of meshes that the library would refuse.
SINGE_NODISCARD SingeResult scene_load(const Scene *scene, SceneAssets *assets, SceneMessages *messages);
void scene_assets_free(SceneAssets *assets);

/// Binds the meshes that are drawn in place of sheets, to a simulation that was built or loaded; in snapshots they are
/// not. On failure *sheet is the one whose mesh does not fit, and *error the library's.
SINGE_NODISCARD SingeResult scene_bind_meshes(const SceneAssets *assets, SingeSim *sim, uint32_t *sheet,
                                              SingeError *error);

/// An estimate from a scene's numbers, before anything is built.
typedef struct SceneSize {
    uint64_t cells;  ///< of sheets
    uint32_t unread; ///< sheets whose mesh file has not been read: their cells are not counted
    double memory;   ///< approximate bytes of the simulation and its drawn mesh
} SceneSize;

/// `assets` is NULL before scene_load.
SceneSize scene_size(const Scene *scene, const SceneAssets *assets);

/// Approximate bytes of its pictures, also while their layers are written.
double scene_picture_memory(const Scene *scene, bool layers);

/// Whether `wanted` bytes fit into `room` (0: unknown, they do); otherwise there is a message about what needs most: a
/// heightfield, the pictures or the largest sheet. `assets` is NULL before scene_load.
bool scene_fits(const Scene *scene, const SceneAssets *assets, double wanted, double room, SceneMessages *messages);

/// Makes the simulation: sheets, commit, sources, colliders, pins. Allocator, log, tasks and thread_count are taken
/// from `hooks`. On failure *sim is NULL and *messages names the scene's object: each refused sheet, or the first other
/// object. Settings that certainly have no effect are reported to the log of `hooks`, with their locations.
SINGE_NODISCARD SingeResult scene_build(const Scene *scene, const SceneAssets *assets, const SingeSimDef *hooks,
                                        SingeSim **sim, SceneMessages *messages);

/// Sets what the scene gives by keys for step `step` (from 0) after frame `frame` (from 1). Call it before each step.
SINGE_NODISCARD SingeResult scene_begin_step(const Scene *scene, SingeSim *sim, int frame, int step, SingeError *error);

/// Sets the positions at the end of frame `frame` (from 1) of colliders and pins that move with meshes. This is the
/// start of the next frame. Call it before the first step of each frame. `assets` hold the bonds of pins.
SINGE_NODISCARD SingeResult scene_follow(const Scene *scene, SceneAssets *assets, SingeSim *sim, int frame,
                                         SingeError *error);

// ---- branches: a scene continues from a frame of another

/// A scene with its files.
typedef struct SceneWhole {
    const Scene *scene;
    const SceneAssets *assets;
} SceneWhole;

/// Whether a simulation of the scene `before` can go on as `scene`. Otherwise *messages has a message at each value that
/// differs and cannot be changed: SINGE_ERROR_ARGUMENT. SINGE_ERROR_MEMORY.
SINGE_NODISCARD SingeResult scene_may_branch(SceneWhole scene, SceneWhole before, SceneMessages *messages);

/// Makes a simulation of `before`, at the end of frame `frame`, go on as `scene`: wind, gravity, pace, ambient
/// temperature, materials, and those sources, colliders and pins that differ. What is equal is not touched. The scenes
/// have passed scene_may_branch. On failure *messages has the reason at its place, and the simulation is to be destroyed.
SINGE_NODISCARD SingeResult scene_branch(SceneWhole scene, SceneWhole before, int frame, SingeSim *sim,
                                         SceneMessages *messages);

/// Whether frames of both are drawn alike: with the same preview, and sheets of the same colours and pictures.
bool scene_looks_alike(SceneWhole scene, SceneWhole before);

// ---- from scene to preview

/// The camera at a time: it follows its path smoothly.
void scene_camera(const Scene *scene, double time, PreviewCamera *camera);

/// Places a camera that is not given so that all sheets, at their start, and their flames fill the picture. If that is more than 10 km
/// from the origin, the camera keeps its default position.
void scene_frame(Scene *scene, const SceneAssets *assets);

/// Fills *def; the scene and the assets must outlive it. Threads: 1. Shapes: none (scene_shapes).
void scene_preview(const Scene *scene, const SceneAssets *assets, PreviewDef *def);

/// Writes at most `max` shapes of a time: visible colliders (planes are not shapes; see the ground) and hot balls.
/// Returns how many there are in total, which may be more. shapes may be NULL if max is 0. They point into the assets.
uint32_t scene_shapes(const Scene *scene, const SceneAssets *assets, double time, PreviewShape *shapes, uint32_t max);

/// How many slots of shapes there are: the scene's colliders, then its sources, then what holds its sheets.
static inline uint32_t scene_slots(const Scene *scene, const SceneAssets *assets) {
    return scene->collider_count + scene->source_count + assets->holder_count;
}

/// The shape at a slot. False if nothing is drawn at that time.
bool scene_shape(const Scene *scene, const SceneAssets *assets, uint32_t slot, double time, PreviewShape *shape);

/// Seconds from one frame to the next, and the simulation's step.
static inline double scene_frame_time(const Scene *scene) { return 1.0 / (double)scene->fps; }
