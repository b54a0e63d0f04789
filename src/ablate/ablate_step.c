// The ablate stage: holes, removal, pieces.
#include "ablate/ablate_plan.h"

static Removal removal_begin(AblatePlan *plan, const StepContext *context, AblateState *ablate) {
    return (Removal){.plan = plan,
                     .shell = context->shell,
                     .state = &context->state,
                     .ablate = ablate,
                     .heat_ambient = context->ambient_temperature};
}

void ablate_torn(AblatePlan *plan, const StepContext *context, AblateState *ablate) {
    Removal removal = removal_begin(plan, context, ablate);
    piece_update(&removal, context->events);
    ablate->topology_version++;
}

void ablate_step(AblatePlan *plan, const StepContext *context, AblateState *ablate) {
    Removal removal = removal_begin(plan, context, ablate);
    ablate_label(plan, context->shell, ablate);
    ablate_levels(plan, context->shell, context->state.burn);
    hole_report(plan, context->shell, &context->state, ablate, context->events);
    remove_burnt(&removal);
    if (!removal.changed) return;
    piece_update(&removal, context->events);
    ablate->topology_version++;
}
