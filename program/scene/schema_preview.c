// The table of the preview.
#include "scene/schema_rows.h"

#include <stddef.h>

static const char *const sky_names[] = {
    [PREVIEW_SKY_EVEN] = "even", [PREVIEW_SKY_STUDIO] = "studio", [PREVIEW_SKY_OPEN] = "open", NULL};
static const char *const ground_names[] = {
    [PREVIEW_GROUND_WOOD] = "wood", [PREVIEW_GROUND_STONE] = "stone", [PREVIEW_GROUND_PLAIN] = "plain", NULL};
static const char *const wall_names[] = {
    [PREVIEW_WALL_PLASTER] = "plaster", [PREVIEW_WALL_BRICK] = "brick", [PREVIEW_WALL_PLAIN] = "plain", NULL};

#define OF ScenePreview
#define PREVIEW_ROW(TYPE, key, target, length, dimension, standard, range, text) \
    AS_ROW_AT(#key, TYPE, def.target, length, dimension, ALWAYS, text, range)

#define PREVIEW_CAMERA PREVIEW_ROW
static const SchemaRow camera_rows[] = {
#include "preview/preview.def"
};
static const SchemaRow camera_key_rows[] = {
    {"time", ROW_FLOAT, DIM_TIME, AT(SceneCameraKey, time), .min = 0, .max = 1e6, .flags = ROW_REQUIRED, .doc = "when"},
    {"eye", ROW_VECTOR, DIM_LENGTH, AT(SceneCameraKey, eye), .length = 3, LOCATION, .flags = ROW_REQUIRED,
     .doc = "its position"},
    {"target", ROW_VECTOR, DIM_LENGTH, AT(SceneCameraKey, target), .length = 3, LOCATION, .flags = ROW_REQUIRED,
     .doc = "what it looks at"},
    {"fov", ROW_FLOAT, DIM_ANGLE, AT(SceneCameraKey, fov), WITHIN(0, 175 * DEGREE),
     .doc = "angle of view from bottom to top; 0: the camera's"},
    {"focus", ROW_FLOAT, DIM_LENGTH, AT(SceneCameraKey, focus), WITHIN(0, 1e4),
     .doc = "distance of the focus along the line of sight; 0: the target's"},
};
static const Schema schema_camera_key = {
    .title = "an entry of the camera's path",
    .size = sizeof(SceneCameraKey),
    ROWS(camera_key_rows),
    .doc = "The camera at one time, in place of `camera`'s eye, target, focus and fov. It moves smoothly through the "
           "entries, and stands still before the first and after the last. Times must increase."};

static const Schema schema_camera = {.title = "the camera",
                                     .size = sizeof(ScenePreview),
                                     ROWS(camera_rows),
                                     .finish = finish_camera,
                                     .doc = "The camera of the preview."};

#define PREVIEW_LIGHT PREVIEW_ROW
static const SchemaRow light_rows[] = {
#include "preview/preview.def"
};
static const Schema schema_light = {
    .title = "the light", .size = sizeof(ScenePreview), ROWS(light_rows), .doc = "One distant light."};

#define PREVIEW_LAMP PREVIEW_ROW
static const SchemaRow lamp_rows[] = {
#include "preview/preview.def"
};
static const Schema schema_lamp = {
    .title = "the lamp",
    .size = sizeof(ScenePreview),
    ROWS(lamp_rows),
    .doc =
        "A lamp near the sheets, with soft shadows; its light falls with the square of the distance. It is not drawn."};

#define PREVIEW_ENVIRONMENT PREVIEW_ROW
static const SchemaRow environment_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, def.sky), .names = sky_names,
     .doc = "`even`: the same from everywhere above; `studio`: a dim room with a tall window across from the light and "
            "a lamp; `open`: a clear day"},
    {"picture", ROW_FILE, DIM_NONE, AT(ScenePreview, environment_picture),
     .doc = "PNG or JPEG panorama of the surroundings, twice as wide as high, instead of a kind; its centre faces +y"},
#include "preview/preview.def"
};
static const Schema schema_environment = {
    .title = "the environment",
    .size = sizeof(ScenePreview),
    ROWS(environment_rows),
    .doc = "Where the light of `sky` comes from, and what shiny surfaces mirror. It is scaled so that a surface that "
           "faces up gets as much light as from an even sky."};

#define PREVIEW_GROUND PREVIEW_ROW
static const SchemaRow ground_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, def.ground), .names = ground_names,
     .doc = "`wood`: planks along x; `stone`: honed slabs; `plain`: one colour"},
    {"height", ROW_FLOAT, DIM_LENGTH, AT(ScenePreview, def.ground_height), .flags = ROW_NONE, WITHIN(-1e4, 1e4),
     .doc = "its z; `none`: no ground is drawn"},
#include "preview/preview.def"
};
static const Schema schema_ground = {
    .title = "the ground",
    .size = sizeof(ScenePreview),
    ROWS(ground_rows),
    .doc = "A floor that is drawn. To let sheets rest on it, add a plane to `colliders` as well."};

#define PREVIEW_WALL PREVIEW_ROW
static const SchemaRow wall_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, def.wall), .names = wall_names,
     .doc = "`plaster`: trowelled and painted; `brick`: in a stretcher bond; `plain`: one colour"},
    {"distance", ROW_FLOAT, DIM_LENGTH, AT(ScenePreview, def.wall_distance), .flags = ROW_NONE, WITHIN(-1e4, 1e4),
     .doc = "from the z axis; `none`: no wall is drawn"},
#include "preview/preview.def"
};
static const Schema schema_wall = {
    .title = "the wall",
    .size = sizeof(ScenePreview),
    ROWS(wall_rows),
    .doc = "A vertical wall that is drawn behind the scene, for the light of the fire and for shadows. It is visible "
           "from the side of the z axis only."};

#define PREVIEW_MAIN PREVIEW_ROW
static const SchemaRow preview_rows[] = {
    {"size", ROW_INTS, DIM_NONE, AT(ScenePreview, def.width), .length = 2, WITHIN(16, 16384),
     .doc = "width and height in pixels, even numbers for video"},
    {"camera", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_camera, .doc = "the camera"},
    {"camera_path", ROW_LIST, DIM_NONE, AT(ScenePreview, camera_keys), EXTRA(ScenePreview, camera_key_count),
     .sub = &schema_camera_key, .doc = "positions, targets and focus of the camera over time; empty: it stands still"},
    {"light", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_light, .doc = "the distant light"},
    {"lamp", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_lamp, .doc = "a near lamp"},
    {"environment", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_environment,
     .doc = "distribution of the sky's light"},
    {"ground", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_ground, .doc = "the floor"},
    {"wall", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_wall, .doc = "the wall behind the scene"},
    {"shutter", ROW_FLOAT, DIM_FRACTION, AT(ScenePreview, shutter), WITHIN(0, 1),
     .doc = "share of a frame's time during which the shutter is open; film has 0.5; 0: no motion blur"},
    {"plain", ROW_BOOL, DIM_NONE, AT(ScenePreview, def.plain),
     .doc = "yes: sheets are drawn as if nothing had burnt, to show their shapes"},
#include "preview/preview.def"
};
// `size` is both
_Static_assert(offsetof(PreviewDef, height) == offsetof(PreviewDef, width) + sizeof(int), "height follows width");

const Schema schema_preview = {.title = "the preview",
                               .size = sizeof(ScenePreview),
                               ROWS(preview_rows),
                               .finish = finish_preview,
                               .doc = "How frames are drawn. Nothing here changes the simulation."};
