// What the experiments of `singe paper` and `singe validate` share: scenes to play, and the shapes that come of them.
#ifndef EXPERIMENTS_LAB_H
#define EXPERIMENTS_LAB_H

#include "cli/console.h"
#include "cli/job.h"
#include "cli/pictures.h"
#include "experiments/report.h"
#include "singe/singe.h"

typedef struct Lab {
    Report *report;
    bool quick; ///< small sizes: the measures must hold at them as well
    int threads;
    Console console;
    char *scenes; ///< folder of the scene files, within the report's
} Lab;

// ---- a scene that is played

typedef struct Play {
    Lab *lab;
    Job job;
    SingeSim *sim;
    Pictures *pictures; ///< opened with the first
    SingeSurface surface;
    bool plain; ///< drawn as if nothing had burnt: for shapes
    float glow; ///< K, no hotter than that is drawn; 0: as it is
} Play;

/// Builds a scene of the folder `paper`, with texts PATH=VALUE laid over it. `sets` ends with NULL; empty ones are
/// skipped. Close it in any case.
SINGE_NODISCARD SingeResult play_open(Play *play, Lab *lab, const char *scene, const char *const *sets,
                                      SingeError *error);
/// Steps to a time of the scene.
SINGE_NODISCARD SingeResult play_until(Play *play, double time, SingeError *error);
/// Draws the surface as it is, without detail and raggedness where the scene has none.
SINGE_NODISCARD SingeResult play_surface(Play *play, SingeError *error);
/// Draws a picture into *rgb, from malloc; NULL where the program cannot draw.
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
    float jitter;                                             ///< of a cell, how far vertices lie off the grid
    const float *mass;                                        ///< [vertices] the attribute "mass", or NULL
    double (*field)(const void *context, double x, double y); ///< the attribute "field", or NULL
    const void *context;
    bool (*inside)(double x, double y); ///< whether a cell with this centre is there, or NULL: all
} LabGrid;

/// From the origin to sides along x and y; vertex i + j (cells[0] + 1). Inert but for what its material is reported.
LabGrid lab_grid(int across, int along, float cell);
SINGE_NODISCARD SingeResult lab_build(const Lab *lab, const LabGrid *grid, SingeSim **sim, SingeError *error);

/// Steps `count` times.
SINGE_NODISCARD SingeResult lab_steps(SingeSim *sim, int count, SingeError *error);

/// Burns quickly, without heat, to the mass of the attribute "mass" of each vertex, and the lengths follow it: v = m.
void lab_sets_mass(SingeMaterialDef *material);

// ---- shapes

/// Radians between the normals of two cells.
double shape_angle(const SingeView *view, uint32_t a, uint32_t b);
/// Degrees, root mean square of the angle between neighbouring cells that are both there.
double shape_bend(const SingeView *view);
/// Lowest and highest position of the vertices that exist.
void shape_bounds(const SingeView *view, double low[3], double high[3]);
/// Share of the sheet's cells that are there.
double shape_left(const SingeView *view);
/// Pieces of at least that share of the sheet.
int shape_pieces(const SingeView *view, double share);
/// m, length of the surface's borders in its rest shape, over the root of its area.
double shape_border(const SingeSurface *surface);

/// m, power spectrum of the height over a grid's rest plane, along both its directions, in bands of half an octave
/// from `shortest` up: root mean square height in the band, NaN where no wave fits.
enum { SHAPE_BANDS = 12 };
typedef struct ShapeSpectrum {
    double wave[SHAPE_BANDS], height[SHAPE_BANDS];
} ShapeSpectrum;
SINGE_NODISCARD SingeResult shape_spectrum(const SingeView *view, int across, int along, double cell,
                                           ShapeSpectrum *spectrum);

#endif
