// What the nodes of game engines have in common: a rectangle of a material that burns live, over the public headers alone.
// A frame allocates only where the drawn mesh outgrows its arrays.
#ifndef SINGE_BURNING_SHEET_H
#define SINGE_BURNING_SHEET_H

#include <singe/singe.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BURNING_KEPT = 64 };

typedef struct BurningSheet {
    // set before burning_start
    float size[2];      ///< m; in its x-y plane
    uint32_t cells[2];  ///< of ten springs each
    char material[64];  ///< of singe_material_preset
    float pace, detail; ///< as in SingeSimDef
    int threads;
    float gravity[3]; ///< m/s2, in the sheet's axes

    // what there is then
    SingeSim *sim; ///< NULL: it has not started
    SingeSheetId id;
    SingeSurface surface;  ///< as drawn after the last frame
    uint64_t allocations;  ///< asked for since the start
    SingeError error;      ///< why a call returned false
    double milliseconds;   ///< of the last frame, as a clock shows them
    double processor_time; ///< the same, of all of the process's threads
    bool burns;            ///< it has started: blocks that are freed are kept
    void *kept[BURNING_KEPT];
} BurningSheet;

/// A sheet of 20 cm that burns eight times as fast as a real one. It must stay where it is once it has started.
BurningSheet burning_default(void);

/// Builds and draws it. Here and below, false: `error` says why, and nothing has changed.
bool burning_start(BurningSheet *sheet);
/// Takes it away; may be called at any time.
void burning_stop(BurningSheet *sheet);
/// Steps and draws a frame of so many seconds. A slow frame makes no more steps than it has time for: the fire slows down.
bool burning_advance(BurningSheet *sheet, double seconds);

// After the start, at any time; m, m/s and s in the sheet's axes.

bool burning_pin(BurningSheet *sheet, const float point[3], float radius);
bool burning_ignite(BurningSheet *sheet, const float point[3], float radius, float seconds);
bool burning_blow(BurningSheet *sheet, const float velocity[3], float gust);
bool burning_add_sphere(BurningSheet *sheet, const float centre[3], float radius);
bool burning_add_plane(BurningSheet *sheet, const float point[3], const float normal[3]);

/// How a vertex looks. Red, green and blue are how far it has browned, charred and turned to ash, as a factor on the
/// sheet's picture; alpha is how brightly it glows. Temperatures in K, `burn` from 0 (fresh) to 1 (ash).
void burning_colour(float temperature, float peak, float burn, uint8_t colour[4]);

#ifdef __cplusplus
}
#endif

#endif
