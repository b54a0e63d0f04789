// The table of the preview.
#include "scene/schema_rows.h"

static const char *const sky_names[] = {
    [PREVIEW_SKY_EVEN] = "even", [PREVIEW_SKY_STUDIO] = "studio", [PREVIEW_SKY_OPEN] = "open", NULL};
static const char *const ground_names[] = {
    [PREVIEW_GROUND_WOOD] = "wood", [PREVIEW_GROUND_STONE] = "stone", [PREVIEW_GROUND_PLAIN] = "plain", NULL};

static const SchemaRow camera_rows[] = {
    {"eye", ROW_VECTOR, DIM_LENGTH, AT(PreviewCamera, eye), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "its position; without eye and target the sheets fill the picture"},
    {"target", ROW_VECTOR, DIM_LENGTH, AT(PreviewCamera, target), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "what it looks at"},
    {"up", ROW_VECTOR, DIM_NONE, AT(PreviewCamera, up), .length = 3, WITHIN(-1e4, 1e4),
     .doc = "direction that is up in the picture"},
    {"fov", ROW_FLOAT, DIM_ANGLE, AT(PreviewCamera, fov), WITHIN(0.1 * DEGREE, 175 * DEGREE),
     .doc = "angle of view from bottom to top"},
    {"aperture", ROW_FLOAT, DIM_LENGTH, AT(PreviewCamera, aperture), WITHIN(0, 10),
     .doc = "diameter of the lens; a wider lens blurs more in front of the focus and behind it; 0: all is sharp"},
    {"focus", ROW_FLOAT, DIM_LENGTH, AT(PreviewCamera, focus), WITHIN(0, 1e4),
     .doc = "distance of the focus along the line of sight; 0: the target's"},
};
static const Schema schema_camera = {.title = "the camera",
                                     .size = sizeof(PreviewCamera),
                                     ROWS(camera_rows),
                                     .finish = finish_camera,
                                     .doc = "The camera of the preview."};

static const SchemaRow light_rows[] = {
    {"direction", ROW_VECTOR, DIM_NONE, AT(ScenePreview, light_direction), .length = 3, SPACE,
     .doc = "towards the light, any length"},
    {"angle", ROW_FLOAT, DIM_ANGLE, AT(ScenePreview, light_angle), WITHIN(0, 85 * DEGREE),
     .doc = "its apparent radius: larger is softer"},
    {"colour", ROW_VECTOR, DIM_NONE, AT(ScenePreview, light_colour), .length = 3, .min = 0, .max = 1e4,
     .doc = "linear red, green, blue; may exceed 1"},
};
static const Schema schema_light = {
    .title = "the light", .size = sizeof(ScenePreview), ROWS(light_rows), .doc = "One distant light."};

static const SchemaRow environment_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, environment), .names = sky_names,
     .doc = "`even`: the same from everywhere above; `studio`: a dim room with a tall window across from the light and "
            "a lamp; `open`: a clear day"},
    {"picture", ROW_FILE, DIM_NONE, AT(ScenePreview, environment_picture),
     .doc = "PNG or JPEG of all around, in place of a kind: twice as wide as high, its centre towards +y, its top up"},
    {"turn", ROW_FLOAT, DIM_ANGLE, AT(ScenePreview, environment_turn), WITHIN(-1000, 1000),
     .doc = "about the z axis, counted from above; kinds follow the light without it"},
};
static const Schema schema_environment = {
    .title = "the environment",
    .size = sizeof(ScenePreview),
    ROWS(environment_rows),
    .doc = "Where the light of `sky` comes from, and what shiny surfaces mirror. It is scaled so that a surface that "
           "faces up gets as much light as from an even sky."};

static const SchemaRow ground_rows[] = {
    {"kind", ROW_ENUM, DIM_NONE, AT(ScenePreview, ground), .names = ground_names,
     .doc = "`wood`: planks along x; `stone`: a honed slab; `plain`: one colour"},
    {"height", ROW_FLOAT, DIM_LENGTH, AT(ScenePreview, ground_height), .flags = ROW_NONE, WITHIN(-1e4, 1e4),
     .doc = "its z; `none`: no ground is drawn"},
    {"colour", ROW_VECTOR, DIM_FRACTION, AT(ScenePreview, ground_colour), .length = 3, WITHIN(0, 1),
     .doc = "linear red, green, blue"},
};
static const Schema schema_ground = {
    .title = "the ground",
    .size = sizeof(ScenePreview),
    ROWS(ground_rows),
    .doc = "A floor that is drawn. To let sheets rest on it, add a plane to `colliders` as well."};

static const SchemaRow preview_rows[] = {
    {"size", ROW_INTS, DIM_NONE, AT(ScenePreview, size), .length = 2, WITHIN(16, 16384),
     .doc = "width and height in pixels, even numbers for video"},
    {"samples", ROW_INT, DIM_NONE, AT(ScenePreview, samples), WITHIN(1, 4096),
     .doc = "rays a pixel: more is smoother and slower"},
    {"camera", ROW_MAP, DIM_NONE, AT(ScenePreview, camera), .sub = &schema_camera, .doc = "the camera"},
    {"light", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_light, .doc = "the distant light"},
    {"sky", ROW_VECTOR, DIM_NONE, AT(ScenePreview, sky), .length = 3, .min = 0, .max = 1e4,
     .doc = "light from all around, linear red, green, blue"},
    {"environment", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_environment,
     .doc = "distribution of the sky's light"},
    {"ground", ROW_MAP, DIM_NONE, .offset = 0, .sub = &schema_ground, .doc = "the floor"},
    {"background", ROW_VECTOR, DIM_NONE, AT(ScenePreview, background), .length = 3, .min = 0, .max = 1e4,
     .doc = "background colour, linear red, green, blue"},
    {"exposure", ROW_FLOAT, DIM_NONE, AT(ScenePreview, exposure), WITHIN(1e-6, 1000), .doc = "multiplies all light"},
    {"shutter", ROW_FLOAT, DIM_FRACTION, AT(ScenePreview, shutter), WITHIN(0, 1),
     .doc = "share of a frame's time during which the shutter is open; film has 0.5; 0: no motion blur"},
};
const Schema schema_preview = {.title = "the preview",
                               .size = sizeof(ScenePreview),
                               ROWS(preview_rows),
                               .finish = finish_preview,
                               .doc = "How frames are drawn. Nothing here changes the simulation."};
