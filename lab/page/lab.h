// Shared by the experiments of `singe paper` and `singe validate`: scenes to run, and measures of the resulting shapes.
#pragma once

#include "cli/console.h"
#include "cli/job.h"
#include "cli/pictures.h"
#include "common/store.h"
#include "page/report.h"
#include "singe/singe.h"

typedef struct Lab {
    Report *report;
    bool quick; ///< small sizes, at which the measures must hold as well
    int threads;
    Console console;
    char *scenes; ///< folder of the scene files, inside the report's
} Lab;

// ---- a running scene

typedef struct Play {
    Lab *lab;
    Job job;
    SingeSim *sim;
    Pictures *pictures; ///< opened with the first picture
    SingeSurface surface;
} Play;

/// Builds a scene of the folder `paper`, with PATH=VALUE texts that override it. `sets` ends with NULL; empty texts are
/// skipped. Close it in any case.
SINGE_NODISCARD SingeResult play_open(Play *play, Lab *lab, const char *scene, const char *const *sets,
                                      SingeError *error);
/// Writes the setting of the first sheet's compliances to those of an ordinary material, for our system in a scene of the
/// paper's.
void lab_usual_compliance(char *set, size_t size);
/// Steps to a time of the scene.
SINGE_NODISCARD SingeResult play_until(Play *play, double time, SingeError *error);
/// Draws the surface with the scene's own detail and raggedness, also if they are 0.
SINGE_NODISCARD SingeResult play_surface(Play *play, SingeError *error);
/// Draws a picture into *rgb, from malloc; NULL if the program cannot draw.
SINGE_NODISCARD SingeResult play_draw(Play *play, uint8_t **rgb, int size[2], SingeError *error);
/// Puts a picture into the report.
SINGE_NODISCARD SingeResult play_shoot(Play *play, const char *caption, SingeError *error);
/// Steps to a time and puts a picture into the report whose caption is the time.
SINGE_NODISCARD SingeResult play_shoot_at(Play *play, double time, SingeError *error);
void play_close(Play *play);

// ---- a grid of cells in the xy plane without a scene

typedef struct LabGrid {
    int cells[2];
    float sides[2];
    SingeMaterialDef material;
    SingeSolverDef solver;
    float time_step, gravity, pace;
    float jitter;                                             ///< max offset of vertices from the grid, in cells
    const float *mass;                                        ///< [vertices] the attribute "mass", or NULL
    double (*field)(const void *context, double x, double y); ///< the attribute "field", or NULL
    const void *context;
    bool (*inside)(double x, double y); ///< whether the cell with this centre exists; NULL: all do
} LabGrid;

/// From the origin to sides along x and y; vertex i + j (cells[0] + 1). Inert except for its material's settings.
LabGrid lab_grid(int across, int along, float cell);
SINGE_NODISCARD SingeResult lab_build(const Lab *lab, const LabGrid *grid, SingeSim **sim, SingeError *error);

/// Steps `count` times.
SINGE_NODISCARD SingeResult lab_steps(SingeSim *sim, int count, SingeError *error);

/// Burns quickly, without heat, to the mass of the attribute "mass" of each vertex, and the lengths follow it: v = m.
void lab_sets_mass(SingeMaterialDef *material);

// ---- shapes

/// Radians between the normals of two cells.
double shape_angle(const SingeView *view, uint32_t a, uint32_t b);
/// Degrees, root mean square of the angle between neighbouring cells that both exist.
double shape_bend(const SingeView *view);
/// Lowest and highest position of the vertices that exist.
void shape_bounds(const SingeView *view, double low[3], double high[3]);
/// Share of the sheet's cells that remain.
double shape_left(const SingeView *view);
/// Pieces of at least that share of the sheet.
int shape_pieces(const SingeView *view, double share);
/// m, length of the surface's borders in its rest shape, over the root of its area.
double shape_border(const SingeSurface *surface);

/// m, power spectrum of the height over a grid's rest plane, along both its directions, in bands of half an octave from
/// `shortest` up: root mean square height in the band, NaN if no wave fits.
enum { SHAPE_BANDS = 12 };
typedef struct ShapeSpectrum {
    double wave[SHAPE_BANDS], height[SHAPE_BANDS];
} ShapeSpectrum;
SINGE_NODISCARD SingeResult shape_spectrum(const SingeView *view, int across, int along, double cell,
                                           ShapeSpectrum *spectrum);

// ---- heat on a still sheet: the grid on which it is measured, and how fast a hot spot spreads.

static const double WARM_DIFFUSIVITY = 1e-4, WARM_MEAN = 600, WARM_AMPLITUDE = 300; // m2/s, K, K

/// Insulated, nothing burns; the temperature is WARM_MEAN plus WARM_AMPLITUDE times the field.
LabGrid warm_grid(int across, int along, float cell, SingeHeatOperator operator);

typedef struct SpotMesh {
    const char *name;
    int cells[2];
    float sides[2], jitter;
} SpotMesh;

/// The diffusivity along x and y at which a hot spot spreads, over WARM_DIFFUSIVITY.
SINGE_NODISCARD SingeResult spot_spread(Lab *lab, const SpotMesh *mesh, SingeHeatOperator operator, double ratio[2],
                                        SingeError *error);

// ---- textures of the experiments: shown, and correlated with results.

/// Adds the texture, as it lies on the sheet, to the report.
void texture_show(Lab *lab, const SingeTexture *picture);

/// The mean of its values.
double texture_mean(const SingeTexture *picture);

/// Correlation of the texture, or of its mirror image, with a field of the vertices.
double texture_correlation(const SingeView *view, const SingeTexture *picture, bool mirrored, const float *field);
