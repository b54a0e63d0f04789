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
    SINGE_HEAT_SURFACE = 0, ///< finite volumes in each layer and a conductance through the thickness
    /// the paper's scale-dependent umbrella over all springs, eq 3, with their initial lengths
    SINGE_HEAT_UMBRELLA = 1,
    SINGE_HEAT_UMBRELLA_LIVE = 2, ///< eq 3 as printed: over the springs that are left, with the lengths they have
} SingeHeatOperator;

/// Spring colours of the body-centred square, in the paper's order.
typedef enum SingeColour {
    SINGE_RED = 0,    ///< centre to corner
    SINGE_GREEN = 1,  ///< centre to centre
    SINGE_BLUE = 2,   ///< corner to corner along the mesh's edges
    SINGE_YELLOW = 3, ///< the diagonals of a cell
    SINGE_COLOUR_COUNT = 4
} SingeColour;

/// What a sheet is made of and how it burns. Mass is a fraction of the initial mass, 1 unburnt. A SingeParam may vary
/// over the sheet; the others have one value for it. Defaults: singe/material.def.
typedef struct SingeMaterialDef {
    size_t struct_size;
    SingeParam grammage; ///< kg/m2, 1e-6 to 1e6; mass per area before it burns
    /// kg/m2, 0 to 1e6; diffusivity, layer_exchange, mass_rate and char_rate are given for this mass per area; on a
    /// lighter sheet they are larger in proportion, and its fire is faster. 0: they hold for any mass. One number for
    /// the whole sheet
    float reference_grammage;
    SingeParam specific_heat; ///< J/(kg K), 1e-3 to 1e9; heat capacity of a kilogram
    /// m, 1e-6 to 100; distance between the model's two layers; it sets the size of the wrinkles, and is larger than
    /// the real sheet's
    SingeParam thickness;
    /// surface: finite volumes in each layer; umbrella: the paper's eq 3, with springs' initial lengths; umbrella-live:
    /// eq 3 as printed, with the springs that are left and the lengths they have
    SingeHeatOperator heat_operator;
    SingeParam diffusivity;     ///< m2/s, >= 0; alpha of eq 2: thermal diffusivity in the sheet
    SingeParam layer_exchange;  ///< 1/s, >= 0; rate at which the layers' temperatures equalise (surface only)
    SingeParam convection;      ///< W/(m2 K), >= 0; heat transfer to still air, per side
    SingeParam emissivity;      ///< 0 to 1; radiation relative to a black body
    SingeParam loss_mass_floor; ///< above 0, to 1; the mass fraction by which heat losses are divided is at least this
    /// >= 0; widens the burning front this many times (1 or more) at the same speed, so that cells can hold it; 0: as
    /// little as the cells need; one number for the whole sheet
    float thickening;
    SingeParam temperature;          ///< K, 1 to 1e4; initial temperature
    SingeParam ignition_temperature; ///< K, > 0; temperature above which the sheet burns
    SingeParam heat_of_combustion;   ///< J/kg, >= 0; heat released per kilogram burnt
    /// 0 to 1; share of it that stays in the sheet; the rest goes into the flame. eta of eq 1, the temperature rise
    /// when all mass burns without losses, is heat_share heat_of_combustion/specific_heat
    SingeParam heat_share;
    SingeParam mass_rate; ///< 1/(K s), >= 0; mu of eq 4: mass lost per second and kelvin above ignition
    /// K, > 0; temperature above ignition beyond which the burning rate stops growing, as air is limited; inf: as in
    /// the paper
    SingeParam rate_ceiling;
    /// >= 0; p: slows eq 4 near the end by ((m - m_min)/(1 - m_min))^p, so that flakes of ash stay; 0: as in the paper
    SingeParam ash_exponent;
    SingeParam mass_min; ///< 0 to below 1; m_min: mass fraction that never burns
    /// 0 to below 1; m_loss: mass fraction below which the sheet is removed; if it is below mass_min, the sheet
    /// wrinkles but stays whole
    SingeParam mass_loss;
    /// > 0; density at mass_min over the density at the start; with mass_min it sets the shrinkage, eq 5
    SingeParam ash_density;
    /// 0 to below 1; mass fraction that pyrolysis leaves as char, which is black and weak. Where it is hot and gets
    /// air, char glows and becomes grey ash, mass_min. At mass_min or below there is no char: one reaction, the paper's
    /// eq 4
    SingeParam char_yield;
    SingeParam char_density; ///< > 0; density of char over the density at the start
    /// J/kg, >= 0; heat released per kilogram of char that burns to CO2; all of it stays in the sheet. Hot embers burn
    /// to CO and release less
    SingeParam char_heat;
    /// 1/s, >= 0; share of hot char that burns per second at an edge; noise lets embers survive in some regions only
    SingeParam char_rate;
    /// 0 to 1; share of char_rate inside a leaf of char, away from edges and ash; lower values confine embers to edges
    SingeParam char_air;
    SingeParam shrink_front; ///< 0 to 2; factor on the shrinkage of the front layer (the upper side of a grid)
    /// 0 to 2; the same for the back layer; a difference of 5 to 10 % curls the sheet towards the side that shrinks
    /// more
    SingeParam shrink_back;
    /// rad, -6.2831853 to 6.2831853; direction of the fibres: angle from the direction of increasing u (x on a grid)
    /// towards increasing v; without uv from the first side of each cell
    SingeParam fibre_angle;
    SingeParam fibre_shrink; ///< 0.1 to 10; ratio of the shrinkage across the fibres to that along them; 1: isotropic
    bool ablate;             ///< no: burnt cells are not removed (Fig 4 b)
    SingeParam weight[SINGE_COLOUR_COUNT];     ///< 0 to 1; weight by colour of spring
    SingeParam compliance[SINGE_COLOUR_COUNT]; ///< >= 0; compliance by colour of spring
    SingeParam char_weight;                    ///< 0 to 1; factor on the weight of springs that are burnt to mass_min
    SingeParam drag;    ///< >= 0; coefficient of air drag, quadratic in the speed along the normal
    SingeParam damping; ///< 1/s, >= 0; damping of all motion
    /// m, >= 0; with creases: bending beyond this radius is partly plastic; 0: never. It applies to the model, which is
    /// ten times as thick as the real sheet
    SingeParam crease_radius;
    /// 0 to 1; share of the bend beyond that radius that is plastic; less in char, none in ash
    SingeParam crease_share;
    /// N/m, > 0; line force at which unburnt sheet tears; a texture may lower it at perforations and folds. The model's
    /// value is far below that of real paper
    SingeParam strength;
    /// N/m, > 0; the same for char, or without char for sheet burnt to mass_min; interpolated geometrically. Ash has a
    /// twentieth of it
    SingeParam char_strength;
    /// 1/s, >= 0; A: above 0, Arrhenius kinetics replace mass_rate: the mass that can still burn decreases at the rate
    /// A exp(-E/(R T)), of order ash_exponent, from ignition_temperature on
    SingeParam pre_exponential;
    SingeParam activation_energy; ///< J/mol, >= 0; E of the Arrhenius kinetics
    /// 1/m, >= 0; max curvature of unburnt sheet beyond the rest shape (solver strand); 0: no limit. Without it thin
    /// sheets that shrink fold along rows of cells
    SingeParam curvature_max;
    /// 0 to 3; mass of water at the start over the mass before it burns; it boils off before the sheet gets hotter than
    /// 100 C. Paper in a room holds 5 to 8 %. 0: dry
    SingeParam moisture;
    /// N m, >= 0; bending stiffness D, moment per width over curvature: paper has 1e-4 to 1e-3 N m, cloth 1e-6 to 1e-5.
    /// Above 0 it sets compliance.green to thickness^2/D, less compliance.blue; 0: compliance.green as it is, by
    /// default 1e-5 N m. Stiff sheets need substeps
    SingeParam bending;
    /// m, 0 to 1; what burns of other sheets within this distance of the sheet, in either layer, gets no air and goes
    /// out; 0: none. A blanket has 2 mm or so, and more than the contact's thickness, which sheets keep
    SingeParam smother_distance;
    /// kg/(m2 s), > 0; mass that air at either face lets burn per area and second where a large area burns; a front,
    /// whose air comes from the side, is not limited by it. inf: as in the paper
    SingeParam air_supply;
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
