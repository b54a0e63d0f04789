// Input of every stage of a step.
#pragma once

#include "common/pool.h"
#include "singe/sim.h"
#include "world/collider.h"
#include "world/pin.h"
#include "world/source.h"

/// A step in progress. A stage reads all of this, and writes its own part of the State, its plan and, if it has any,
/// events and the error. It owns nothing.
typedef struct StepContext {
    const Shell *shell;
    StateInput state; ///< all parts but the one that the stage writes
    const PinList *pins;
    const ColliderList *colliders; ///< may be NULL
    const SourceList *sources;     ///< may be NULL
    const SingeWindDef *wind;
    const SingeView *view; ///< of the State, for callback sources
    SingeFluxFn *heard;    ///< gets the arrays after each callback source, for a recording; may be NULL
    void *hearer;          ///< its first argument
    Pool *pool;            ///< NULL: the stage runs here
    EventList *events;
    SingeError *error;
    float h;                   ///< s, of the scene: length of the step
    float pace;                ///< s of fire over s of the scene
    float ambient_temperature; ///< K
} StepContext;
