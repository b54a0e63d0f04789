#include <singe/singe.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    const float positions[] = {0, 0, 0, 0.01f, 0, 0, 0.01f, 0.01f, 0, 0, 0.01f, 0};
    const uint32_t cell[] = {0, 1, 2, 3};
    SingeSimDef def = singe_default_sim();
    SingeSheetDef sheet = singe_default_sheet();
    SingeSheetId id;
    SingeError error;
    SingeSim *sim;

    sheet.vertex_count = 4, sheet.positions = positions;
    sheet.cell_count = 1, sheet.cells = cell;
    if (singe_sim_create(&def, &sim, &error)) return 1;
    if (singe_sim_add_sheet(sim, &sheet, &id) || singe_sim_commit(sim) || singe_sim_step(sim)) return 1;

    printf("%s %u\n", singe_version(), (unsigned)singe_sim_stats(sim).particles);
    singe_sim_destroy(sim);
    return strcmp(singe_version(), SINGE_VERSION) != 0;
}
