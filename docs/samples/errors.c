// What goes wrong is said: a code, a stage, the element and a sentence. A call that fails changes nothing.
//
// Prints:
//   bad argument, material, element -1: there is no material of this name; there are: cotton, newsprint, office-paper, one-reaction, tissue
//   not allowed now, step, element -1: singe_sim_commit must come before the first step
//   bad mesh, sheet, element 3: sheet 'sheet': vertex 3 has a position that is not finite or beyond 1e15 m
//   bad argument, pace, element -1: pace must be between 1e-6 and 1e6
//   stale handle, pin, element 0: the handle is stale or invalid
#include "sample.h"

static void show(const SingeError *error) {
    printf("%s, %s, element %d: %s\n", singe_result_name(error->code), error->stage, (int)error->element,
           error->message);
}

int main(void) {
    SingeError error;
    SingeSheetDef sheet = singe_default_sheet();
    if (singe_material_preset("asbestos", &sheet.material, &error)) show(&error);

    SingeSim *sim = sample_sim(singe_default_sim());
    if (singe_sim_step(sim)) show(singe_sim_error(sim)); // before the commit
    const float corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, NAN, 0};
    sheet.vertex_count = 4, sheet.positions = corners;
    sheet.cell_count = 1, sheet.cells = (const uint32_t[]){0, 1, 2, 3};
    if (singe_sim_add_sheet(sim, &sheet, NULL)) show(singe_sim_error(sim));

    const SingeSheetId good = sample_sheet(sim, singe_default_sheet(), 0.1f, 4, 0);
    const SingePinId pin = sample_pin(sim, good, 0, 0, 0, 0.03f);
    TRY(sim, singe_sim_commit(sim));
    TRY(sim, singe_sim_set_pace(sim, 4));
    if (singe_sim_set_pace(sim, -1)) show(singe_sim_error(sim)); // it is still 4
    TRY(sim, singe_sim_remove_pin(sim, pin));
    if (singe_sim_remove_pin(sim, pin)) show(singe_sim_error(sim));
    singe_sim_destroy(sim);
}
