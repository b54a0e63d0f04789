// A ticket tears along its perforation: a texture lowers the strength along a line, and a pin pulls.
//
// Prints:
//   1 piece, 0 vertices torn
//   2 pieces, 17 vertices torn
#include "sample.h"

static void print_pieces(const SingeSim *sim) {
    const SingeStats stats = singe_sim_stats(sim);
    printf("%u piece%s, %u vertices torn\n", stats.pieces, stats.pieces > 1 ? "s" : "", stats.tears);
}

int main(void) {
    float line[32] = {0}; // black but for one column in the middle
    line[15] = line[16] = 1;
    const SingeField perforation = {.kind = SINGE_FIELD_TEXTURE, .texture = {32, 1, line}};
    SingeSheetDef sheet = singe_default_sheet();
    sheet.material.strength = singe_param_field(200, 20, &perforation); // N/m where it is black, where it is white

    SingeSimDef def = singe_default_sim();
    def.solver.tearing = true, def.gravity[2] = 0;
    SingeSim *sim = sample_sim(def);
    const SingeSheetId ticket = sample_sheet(sim, sheet, 0.1f, 16, 0);
    SingePinDef pin = singe_default_pin();
    pin.sheet = ticket, pin.radius = 0.06f, pin.point_count = 1, pin.points = (const float[]){-0.08f, 0, 0};
    TRY(sim, singe_sim_add_pin(sim, &pin, NULL));
    const SingePoseKey path[] = {{0, {0, 0, 0}, {0, 0, 0, 1}}, {0.5f, {0.03f, 0, 0.01f}, {0, 0, 0, 1}}};
    pin.points = (const float[]){0.08f, 0, 0}, pin.path_count = 2, pin.path = path;
    TRY(sim, singe_sim_add_pin(sim, &pin, NULL));
    TRY(sim, singe_sim_commit(sim));
    print_pieces(sim);
    TRY(sim, singe_sim_advance(sim, 0.5, 0, NULL));
    print_pieces(sim);
    singe_sim_destroy(sim);
}
