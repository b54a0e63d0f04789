// Long-range attachments: no particle is farther from a pin than its geodesic distance along the sheet.
#pragma once

#include "common/stream.h"
#include "common/pool.h"
#include "dynamics/geodesic.h"

/// Max sources of a sheet; steps between two measurements while it burns (a search costs as much as several steps); and
/// while it tears.
enum { ATTACH_SOURCES = 4, ATTACH_PERIOD = 96, ATTACH_TORN_PERIOD = 8 };
_Static_assert(ATTACH_SOURCES == 4, "kernels load the lengths of a vertex as one quadruple");
_Static_assert(ATTACH_PERIOD % ATTACH_TORN_PERIOD == 0, "a measurement of a fire is one of a tear");

/// Sources farther apart than ATTACH_TIGHT times their distance along the sheet pull it apart. A sheet that can tear is
/// left to its springs little by little from ATTACH_EASE on, and altogether from ATTACH_LOOSE on, before it tears: springs
/// that take a load at once throw its vertices.
#define ATTACH_TIGHT 1.001f
#define ATTACH_EASE 1.0001f
#define ATTACH_LOOSE 1.0015f

/// A sheet's sources in a substep.
typedef struct AttachSpread {
    int count;                                   ///< 0 also where a tight sheet may tear
    float share;                                 ///< of a vertex's excess that is taken back
    float max;                                   ///< of the ratios
    bool tight;                                  ///< two sources are farther apart than their distance along the sheet
    bool gives;                                  ///< lengths grow with the distances of the sources
    float position[ATTACH_SOURCES][3];           ///< m
    float apart[ATTACH_SOURCES][ATTACH_SOURCES]; ///< m, of source p from source q < p
    float ratio
        [ATTACH_SOURCES]
        [ATTACH_SOURCES]; ///< of `apart` and their distance along the sheet; of a sheet that can tear, over ATTACH_EASE
} AttachSpread;

/// Held vertices of a sheet, far from each other, and every vertex's distance from them.
typedef struct Attachments {
    uint32_t (*source)[ATTACH_SOURCES]; ///< [sheets] vertices; SHELL_NONE where there are fewer
    float (*length)[ATTACH_SOURCES];    ///< [vertices] m, INFINITY if the source does not hold it
    float (*goal)[ATTACH_SOURCES];      ///< [vertices] m, as last measured; shortening lengths approach it
    AttachSpread *spread;               ///< [sheets] scratch of a substep
    float *distance;                    ///< [vertices] scratch
    Geodesic search;
    bool settled; ///< all lengths have reached their goals
    // the state that they were measured for
    uint64_t topology;
    double mass_burnt;
    uint32_t split_count;
} Attachments;

/// Moves vertices that are too far from the sources back: of `count` contiguous vertices, as many whole blocks of lanes
/// as there are (attach_kernel.h). `length` as in Attachments, `position` with the inverse mass as fourth.
typedef void AttachHold(const AttachSpread *spread, const float *length, float *position, int count);
AttachHold attach_hold_plain, attach_hold_v2, attach_hold_v3, attach_hold_v4, attach_hold_neon, attach_hold_simd128;

bool attach_create(Memory *memory, const Shell *shell, Attachments *attachments);
void attach_free(Memory *memory, const Shell *shell, Attachments *attachments);

/// At the end of a step, and after pins have changed: releases vertices that have come free of a source. Finds sources
/// and lengths again where pins have changed, and every ATTACH_PERIOD steps where the sheet has.
void attach_update(Attachments *attachments, const Shell *shell, const StateInput *state, bool pins_changed);

/// A tear has split `vertex`: `spare` gets the same lengths.
void attach_split(Attachments *attachments, uint32_t vertex, uint32_t spare);

/// Stores the positions of the sources.
void attach_position(Attachments *attachments, const Shell *shell, const DynamicsState *dynamics);

/// Puts vertices among the particles [begin, end) that are too far from a source back on the sphere around it.
void attach_range(const Attachments *attachments, const Shell *shell, AttachHold *hold, DynamicsState *dynamics,
                  int begin, int end);

/// The largest of the ratios, at least 1.
static inline float attach_stretched(const AttachSpread *spread) { return spread->max > 1 ? spread->max : 1; }

/// Whether sources hold nothing for now: a sheet that can tear and is held farther apart than it reaches is left to its
/// springs, so that it may tear.
static inline bool attach_rests(const Shell *shell, const AttachSpread *spread) {
    return spread->max >= ATTACH_LOOSE && shell->spare_count > 0;
}

/// attach_position and attach_range for all vertices.
void attach_project(Attachments *attachments, const Shell *shell, AttachHold *hold, Pool *pool,
                    DynamicsState *dynamics);

/// Sources and lengths are part of a snapshot, as they come from an earlier step.
void attach_stream(Attachments *attachments, const Shell *shell, Stream *stream);
