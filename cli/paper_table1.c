// Table 1 and Fig 9: a particle between two fixed points, tied to the left one by a green and to the right one by a
// blue spring. From target lengths of 1 they go to 1.65 and 0.55, which exclude each other. The paper's digits come
// out when the system takes the fixed points for free and they are put back after each projection.
#include <math.h>
#include <stdio.h>

#include "cli/paper.h"

enum { STEPS = 5 };

static const double table1[STEPS][2] = {
    {0.4306, 0.4401}, {0.5527, 0.4954}, {0.5767, 0.5038}, {0.5804, 0.5050}, {0.5810, 0.5052}};

static SingeResult table1_network(SingeNetwork **network, SingeError *error) {
    SingeNetworkDef def = singe_default_network();
    def.particle_count = 3;
    def.positions = (const double[]){-1, 0, 0, 0, 0, 0, 1, 0, 0};
    def.held = (const uint8_t[]){1, 0, 1};
    def.spring_count = 2;
    def.ends = (const uint32_t[]){0, 1, 1, 2};
    def.lengths = (const double[]){1.65, 0.55};
    def.set_count = 2;
    def.sets = (const uint32_t[]){0, 1};
    def.regularisation = 0;
    return singe_network_create(&def, network, error);
}

ExitCode paper_table1(const PaperOptions *options) {
    (void)options;
    SingeNetwork *network;
    SingeError error = {0};
    if (table1_network(&network, &error)) return paper_fail(&error);
    const double *x = singe_network_positions(network) + 3;
    double worst = 0;
    SingeResult result = SINGE_OK;
    printf("positions of the free particle (paper's digits are cut, not rounded)\n\n"
           "step   project(S_G)           project(S_B)\n"
           "          here    paper          here    paper\n"
           "   0    0.0000   0.0000        0.0000   0.0000\n");
    for (int step = 0; step < STEPS && !result; step++) {
        printf("%4d  ", step + 1);
        for (uint32_t set = 0; set < 2 && !result; set++) {
            result = singe_network_project(network, set, NULL);
            printf("  %.4f   %.4f%s", floor(1e4 * x[0] + 1e-9) / 1e4, table1[step][set], set ? "\n" : "      ");
            worst = fmax(worst, fabs(floor(1e4 * x[0] + 1e-9) / 1e4 - table1[step][set]));
        }
    }
    singe_network_destroy(network);
    if (result) return paper_fail(&(SingeError){.code = result});
    printf("\nlargest difference %.4f\n", worst);
    return worst < 1e-4 ? EXIT_GOOD : EXIT_FAILED;
}
