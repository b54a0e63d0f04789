// The plan of a sweep: a scene, and the parameters that its rows set (docs/sweep.md). A row is one run.
#pragma once

#include "cli/cli.h"
#include "cli/console.h"
#include "scene/scene.h"
#include "scene/tree.h"

typedef enum PlanMethod {
    PLAN_GRID,            ///< every combination of the values; the last parameter varies fastest
    PLAN_LIST,            ///< the first values of all parameters, then the second, ...
    PLAN_RANDOM,          ///< each value independently
    PLAN_LATIN_HYPERCUBE, ///< each range is cut into as many parts as there are rows; each is used once
} PlanMethod;

/// The values of a parameter: `values`, or numbers from `from` to `to`, both included.
typedef struct PlanParameter {
    char *key;        ///< PATH of --set
    uint32_t count;   ///< of values; 0: a range
    char **values;    ///< as --set takes them
    double from, to;  ///< in `unit`
    const char *unit; ///< as written; "" for none
    uint32_t steps;   ///< of a range, for a grid or a list; 0: not given
    bool logarithmic, whole;
    SceneLocation location, key_location;
} PlanParameter;

/// The target of a fit (docs/sweep.md): the sum of the given terms.
typedef struct PlanTarget {
    bool given;
    char *speed_text;   ///< of front_speed as written; NULL: none
    double front_speed; ///< m/s; 0: none
    SceneFile curve;    ///< a CSV table with columns time (s) and temperature (K)
    char *probe;        ///< the scene's probe for the curve
    SceneFile masks;    ///< PNGs with # for the frame's number, white where the sheet has burnt
} PlanTarget;

typedef enum PlanSearch {
    PLAN_SEARCH_LOCAL,  ///< from the centre of the ranges: Subplex (Rowan 1990)
    PLAN_SEARCH_GLOBAL, ///< over the whole ranges: DIRECT-L (Gablonsky and Kelley 2001)
} PlanSearch;

enum { PLAN_ROWS_MAX = 10000, PLAN_PARAMETERS_MAX = 64 };

typedef struct Plan {
    SceneArena *arena; ///< owns all of the below
    char *name;        ///< the file's, without its ending
    SceneFile scene;   ///< from the plan's folder, as are all
    SceneFile from;    ///< DIR:FRAME, of which all rows are branches
    PlanMethod method;
    uint32_t samples, seed;
    PlanTarget target;
    PlanSearch search;
    uint32_t evaluations;         ///< max rows of a fit
    const YamlNode *set, *varied; ///< the maps `set` and `parameters`
    uint32_t set_count, parameter_count, row_count;
    char **sets;                  ///< [set_count] PATH=VALUE for all rows
    SceneLocation *set_locations; ///< [set_count] of their keys
    PlanParameter *parameters;
    char **values; ///< [row_count * parameter_count], row by row
} Plan;

/// Reads the plan of a sweep or a fit, and creates its rows. All errors have been printed, with their lines, unless the
/// result is EXIT_GOOD.
ExitCode plan_read(const char *path, bool fit, Console *console, Plan *plan);
void plan_free(Plan *plan);

/// Creates the rows (plan_rows.c); those of a fit have no values yet. `message` says why there are none, about
/// `parameter`; without memory the arena has failed.
void plan_make_rows(Plan *plan, bool fit, uint32_t *parameter, char *message, size_t size);

/// Sets a row's values from coordinates in [0, 1] of the ranges. False when out of memory.
bool plan_set_row(Plan *plan, uint32_t row, const double *coordinates);

/// A row's value of a parameter.
static inline const char *plan_value(const Plan *plan, uint32_t row, uint32_t parameter) {
    return plan->values[(size_t)row * plan->parameter_count + parameter];
}

/// A parameter's short name: the part after the last dot, longer if others have the same end.
const char *plan_label(const Plan *plan, uint32_t parameter);
