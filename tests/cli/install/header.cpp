#include <singe/singe.h>

bool commits() {
    SingeSimDef def = singe_default_sim();
    SingeSheetDef sheet = singe_default_sheet();
    SingeMaterialDef material = singe_default_material();
    SingeSourceDef source = singe_default_source();
    SingeColliderDef collider = singe_default_collider();
    SingePinDef pin = singe_default_pin();
    SingeWindDef wind = singe_default_wind();
    SingeSolverDef solver = singe_default_solver();
    sheet.material = material;
    def.wind = wind;
    def.solver = solver;
    SingeSim *sim;
    SingeSheetId sheet_id;
    SingeSourceId source_id;
    SingeColliderId collider_id;
    SingePinId pin_id;
    return !singe_sim_create(&def, &sim, nullptr) && !singe_sim_add_sheet(sim, &sheet, &sheet_id) &&
           !singe_sim_commit(sim) && !singe_sim_add_source(sim, &source, &source_id) &&
           !singe_sim_add_collider(sim, &collider, &collider_id) && !singe_sim_add_pin(sim, &pin, &pin_id);
}
