// The ablate stage: holes, removal, pieces.
#include "ablate/ablate_plan.h"

void ablate_torn(AblatePlan *plan, const Shell *shell, const State *state, float heat_ambient, AblateState *ablate,
                 EventList *events) {
    Removal removal = {plan, shell, state, ablate, heat_ambient, false};
    piece_update(&removal, events);
    ablate->topology_version++;
}

SingeResult ablate_step(AblatePlan *plan, const Shell *shell, const State *state, Pool *pool, float heat_ambient,
                        AblateState *ablate, EventList *events, SingeError *error) {
    (void)pool, (void)error; // too little work to share, and nothing that can fail
    Removal removal = {plan, shell, state, ablate, heat_ambient, false};
    ablate_label(plan, shell, ablate);
    ablate_levels(plan, shell, state);
    hole_report(plan, shell, state, events);
    remove_burnt(&removal);
    if (!removal.changed) return SINGE_OK;
    piece_update(&removal, events);
    ablate->topology_version++;
    return SINGE_OK;
}
