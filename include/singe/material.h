/// Singe: materials, and the fields by which their parameters vary over a sheet.
#ifndef SINGE_MATERIAL_H
#define SINGE_MATERIAL_H

#include "singe/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A grey texture over the uv square. Rows run from the top (v = 1) to the bottom (v = 0); sampled
/// bilinearly, clamped at the border.
typedef struct SingeTexture {
    int width, height;   ///< pixels, at least 1 each
    const float *values; ///< [height * width], 0 black to 1 white
} SingeTexture;

/// Seeded value noise in [0, 1], evaluated at the rest position.
typedef struct SingeNoise {
    float scale;   ///< m, the size of its largest features, > 0
    int octaves;   ///< 1 to 8, each half the size and half the strength of the previous one
    uint32_t seed; ///< any
} SingeNoise;

/// A named value per vertex of a sheet's mesh.
typedef struct SingeAttribute {
    const char *name;    ///< a SingeField refers to it
    const float *values; ///< [vertex_count] any; 0 gives a parameter's `value`, 1 its `to`
} SingeAttribute;

typedef enum SingeFieldKind {
    SINGE_FIELD_NONE = 0,
    SINGE_FIELD_TEXTURE = 1,
    SINGE_FIELD_ATTRIBUTE = 2,
    SINGE_FIELD_NOISE = 3,
} SingeFieldKind;

/// A field by which a parameter varies over the sheet. Textures and noise are evaluated at the centres of cells, too;
/// of an attribute a centre takes the mean of its corners.
typedef struct SingeField {
    SingeFieldKind kind;
    SingeTexture texture;  ///< SINGE_FIELD_TEXTURE: needs the sheet's uv
    const char *attribute; ///< SINGE_FIELD_ATTRIBUTE: the name of one of the sheet's attributes
    SingeNoise noise;      ///< SINGE_FIELD_NOISE
} SingeField;

/// A parameter that may vary over the sheet: `value` where the field is 0, `to` where it is 1, linear in between.
/// Attributes outside [0, 1] extrapolate.
typedef struct SingeParam {
    float value;             ///< in the parameter's unit and range; so must `to` be, and all in between
    float to;                ///< finite; unused without a field
    const SingeField *field; ///< the caller's; parameters may share one. NULL: `value` everywhere
} SingeParam;

/// A parameter with the same value everywhere.
SINGE_API SingeParam singe_param(float value);

/// A parameter that follows a field, which must live until the Def has been passed on.
static inline SingeParam singe_param_field(float value, float to, const SingeField *field) {
    SingeParam param;
    param.value = value;
    param.to = to;
    param.field = field;
    return param;
}

/// The discrete Laplacian of the heat equation.
typedef enum SingeHeatOperator {
    SINGE_HEAT_SURFACE = 0,  ///< finite volumes in each layer and a conductance through the thickness
    SINGE_HEAT_UMBRELLA = 1, ///< the paper's scale-dependent umbrella over all springs, eq 3
} SingeHeatOperator;

/// Spring colours of the body-centred square, in the paper's order.
typedef enum SingeColour {
    SINGE_RED = 0,    ///< centre to corner
    SINGE_GREEN = 1,  ///< centre to centre
    SINGE_BLUE = 2,   ///< corner to corner along the mesh's edges
    SINGE_YELLOW = 3, ///< the diagonals of a cell
    SINGE_COLOUR_COUNT = 4
} SingeColour;

/// What a sheet is made of and how it burns: the rows of singe/material.def, each with its unit, range, default and
/// documentation. Mass is a fraction of the initial mass, 1 unburnt. A SingeParam may vary over the sheet; the others
/// have one value for it.
#define SINGE_TYPE_FLOAT float
#define SINGE_TYPE_BOOL bool
#define SINGE_TYPE_ENUM(name) name
typedef struct SingeMaterialDef {
    size_t struct_size;
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) SingeParam name;
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) SingeParam name[SINGE_COLOUR_COUNT];
#define SINGE_SCALAR(TYPE, name, dimension, standard, range, text) SINGE_TYPE_##TYPE name;
#include "singe/material.def"
} SingeMaterialDef;

SINGE_API void singe_init_material(SingeMaterialDef *def, size_t struct_size);

/// 80 g/m2 office paper at its real pace.
static inline SingeMaterialDef singe_default_material(void) {
    SingeMaterialDef def;
    singe_init_material(&def, sizeof def);
    return def;
}

/// A built-in material by its name: "office-paper", "newsprint", "tissue", "cotton" or "one-reaction"
/// (docs/materials.md). *def holds its struct_size, as after singe_default_material(). SINGE_ERROR_ARGUMENT: the
/// name is unknown; *error (may be NULL) lists the known ones, and *def is unchanged. In libsinge_input.
SINGE_API SINGE_NODISCARD SingeResult singe_material_preset(const char *name, SingeMaterialDef *def, SingeError *error);

/// The name of the index-th built-in material; NULL after the last. In libsinge_input.
SINGE_API const char *singe_material_preset_name(uint32_t index);

#ifdef __cplusplus
}
#endif
#endif
