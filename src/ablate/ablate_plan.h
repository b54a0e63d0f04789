// Shared declarations of the ablate stage's files.
#pragma once

#include "ablate/ablate.h"

struct AblatePlan {
    uint32_t particle_count, vertex_count;
    float *level;         ///< [particles] m' of eq 7 at the present masses
    uint8_t *rim;         ///< [vertices] 1 at the mesh's boundary, and where it is torn
    uint32_t split_count; ///< of the shell that `rim` is for
    // scratch of the pieces
    double *area;   ///< [particles] at a root: m2 at rest of its corner layer
    uint32_t *root; ///< [particles] of the disjoint sets; the smallest particle of its set
    uint32_t *size; ///< [particles] at a root: particles of the piece
    uint32_t *heir; ///< [particles] by id: root of the piece that keeps the id
    uint8_t *mark;  ///< [particles] at a root: PIECE_HELD, PIECE_DROPPED
};

/// Arguments of removal.
typedef struct Removal {
    AblatePlan *plan;
    const Shell *shell;
    const StateInput *state;
    AblateState *ablate;
    float heat_ambient; ///< K
    bool changed;       ///< something was removed
} Removal;

/// Removes a spring unless it is already gone, and a particle with its last spring.
void remove_spring(Removal *removal, SingeColour colour, uint32_t spring);

/// Finds the pieces after a change: drops small loose ones, keeps or gives ids, pushes SINGE_EVENT_PIECE_FREED.
void piece_update(Removal *removal, EventList *events);
