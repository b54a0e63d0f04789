// Shared by the readers of a plan's parts.
#ifndef SWEEP_PLAN_READER_H
#define SWEEP_PLAN_READER_H

#include "scene/messages.h"
#include "sweep/sweep_plan.h"

typedef struct PlanReader {
    Plan *plan;
    SceneText text;
    SceneMessages messages;
    const char *folder; ///< of the plan, "" or ending in a slash
} PlanReader;

/// Reports an error: what was expected at a node, and what it is.
void plan_complain(PlanReader *reader, const YamlNode *node, const char *key, const char *expected);

/// A path from the plan's folder; NULL after an error.
char *plan_read_path(PlanReader *reader, const YamlNode *node, const char *key);

/// The target of a fit (plan_target.c).
void plan_read_target(PlanReader *reader, const YamlNode *node);

#endif
