// singe bench MEASUREMENT: cost and accuracy of the solver, measured on this machine.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text.h"
#include "cli/args.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "cli/console.h"
#include "common/printable.h"

// options that several measurements take
#define OUTPUT " json csv "
#define SOLVER " solver instructions projections start substeps "
#define TRAJECTORY " cells thickness pins time steps smoothing threads " SOLVER OUTPUT
#define SIZES " springs steps threads " OUTPUT

static const struct {
    const char *name;
    BenchFn *run;
    const char *accepted; ///< options, between spaces
    const char *summary;
} measurements[] = {
    {"swing", bench_swing, TRAJECTORY,
     "A sheet of 1 m x 1 m, held at corners, falls from the horizontal: time per frame, strain, motion."},
    {"hang-and-shrink", bench_hang_and_shrink, TRAJECTORY,
     "A sheet that hangs from two corner patches shrinks to 0.8 of its size: the numbers of swing."},
    {"tear", bench_tear, " threads instructions substeps " OUTPUT,
     "A strip with a weak line is pulled apart: the load at which it breaks, by cell size and time step."},
    {"dynamics", bench_dynamics, " state quick " SIZES SOLVER,
     "The dynamics and its projection of springs at several sizes, compared with the machine's peaks."},
    {"step", bench_step, " limit-ms curvature " SIZES SOLVER,
     "Whole steps of a burning sheet with a sphere and the ground: milliseconds per stage."},
    {"surface", bench_surface, SIZES,
     "The drawn surface of a burning sheet at several refinements: triangles and milliseconds."},
    {"heap", bench_heap, " cells time threads steps start substeps " OUTPUT,
     "A cloth falls over a sphere and folds: milliseconds per frame and stage, self-contact, strain."},
    {"collapse", bench_collapse, " cells time threads steps start substeps " OUTPUT,
     "A hollow ball collapses into self-contact under its weight: the numbers of heap."},
    {"stack", bench_stack, " cells sheets time threads steps start substeps " OUTPUT,
     "Sheets fall on top of each other over a sphere: mean and worst step, strain, crossings, memory."},
    {"drop", bench_drop, " cells time threads steps start substeps " OUTPUT,
     "A sheet of 1 m x 1 m falls flat on a sphere and on itself: the numbers of stack."},
    {"wind", bench_wind, " cells time threads substeps " OUTPUT,
     "A sheet held at two corners in gusts of 5, 15 and 30 m/s: processor time, CCD, strain, crossings."},
    {"memory", bench_memory, " springs threads " OUTPUT, "Bytes per spring of a simulation and of its drawn mesh."},
    {"front", bench_front, " material quick threads " OUTPUT,
     "The burning front of materials, level, down and up: speed, temperature, residue, and published values."},
    {"spread", bench_spread, " quick threads " OUTPUT,
     "The front of the default material with gas, level, down and up, by cells of sheet and gas: its speed."},
    {"output", bench_output, OUTPUT,
     "Frames of 25,000 vertices in every format: bytes, and milliseconds of the program and of the system."},
    {"preview", bench_preview, " threads quick " OUTPUT,
     "Pictures of 100,000 triangles at 1280 x 720 with 16 samples: seconds; and at 320 x 180 their error against 256 samples, and its change while the camera turns."},
    {"compare", bench_compare, " springs time threads instructions quick " OUTPUT,
     "The paper's solver and ours on the same trajectories: error, cost, and cost at equal error."},
    {"stability", bench_stability, " cells time threads smoothing quick " SOLVER OUTPUT,
     "Whether swinging and strongly shrinking sheets are stable at any thickness, resolution and time step."},
    {"fold", bench_fold, " substeps threads quick instructions " OUTPUT,
     "A strip is folded by 180 degrees and released: the angle that remains, by resolution and time step."},
    {"isotropy", bench_isotropy,
     " cells thickness curvature creases isotropic red outline seeds time threads substeps instructions quick " OUTPUT,
     "The same burn on a grid and on one turned by 45 degrees: whether its folds follow the mesh."},
    {"plate", bench_plate, " cells substeps threads instructions quick svg " OUTPUT,
     "Strips that sag and discs that roll up, by the direction of their mesh: stiffness and curvatures."},
    {"spectrum", bench_spectrum, " thickness time threads quick instructions substeps " OUTPUT,
     "Wrinkles of a burning edge by wavelength, and their peak by time step, resolution and thickness."},
};

enum { MEASUREMENTS = sizeof measurements / sizeof *measurements };

static void print_csv(FILE *file, const void *context) { table_write_csv(context, file); }
static void print_text(FILE *file, const void *context) { fputs(context, file); }

static ExitCode bench_measure(int m, const BenchRequest *request) {
    Console console = console_make(false);
    BenchTable table = {.command = measurements[m].name, .text = request->json ? NULL : stdout};
    SingeError error = {.element = -1};
    BenchOptions options = request->options;
    char *svg = NULL;
    if (request->svg) options.drawing = text_open(&svg);

    SingeResult result = measurements[m].run(&options, &table, &error);
    ExitCode code = EXIT_GOOD;
    if (request->svg) text_close(options.drawing, &svg);

    if (result) {
        fflush(stdout);
        error.code = result;
        console_result(&console, &error);

        // a refused argument is the user's error; everything else is a failure
        code = result == SINGE_ERROR_ARGUMENT ? EXIT_INPUT : EXIT_FAILED;
    }

    if (!result && request->json) table_write_json(&table, stdout);
    if (!result && request->csv) code = console_write_table(&console, request->csv, print_csv, &table);
    if (!result && request->svg && !code) code = console_write_table(&console, request->svg, print_text, svg);
    free(svg);
    table_free(&table);
    return code;
}

const ArgCommand bench_command = {
    .name = "bench",
    .operand = "MEASUREMENT",
    .summary = "Measures speed, strain and stability of the solver on this machine.",
    .options = bench_all_options,
    .option_count = BENCH_OPTION_COUNT,
    .footer = "Each measurement takes some of these options: `singe bench MEASUREMENT --help` shows which.",
    .examples = "singe bench front --material newsprint,cotton\n"
                "singe bench step --springs 100000 --threads 2 --csv step.csv",
};

const char *bench_measurement_word(int index) { return index < MEASUREMENTS ? measurements[index].name : NULL; }

int command_bench(int argc, char **argv) {
    if (argc < 1) {
        args_complain(&bench_command, "a measurement is missing");
        return EXIT_INPUT;
    }

    if (strcmp(argv[0], "--help") == 0 || strcmp(argv[0], "-h") == 0) {
        printf("usage: singe bench MEASUREMENT [options]\n\nmeasurements:\n");
        for (int i = 0; i < MEASUREMENTS; i++) printf("  %-16s %s\n", measurements[i].name, measurements[i].summary);
        printf("\n  singe bench MEASUREMENT --help   shows its options\n");
        args_examples(&bench_command);
        return EXIT_GOOD;
    }

    const char *word = argv[0];
    int m = 0;
    while (m < MEASUREMENTS && strcmp(measurements[m].name, word) != 0) m++;

    if (m == MEASUREMENTS)
        return args_unknown(&bench_command, "unknown measurement", word, measurements, MEASUREMENTS,
                            sizeof *measurements);

    BenchRequest request;
    ExitCode code;
    if (!bench_args_read(measurements[m].name, measurements[m].summary, measurements[m].accepted, argc - 1, argv + 1,
                         &request, &code))
        return code;
    if (!bench_takes(measurements[m].accepted, "material")) return bench_measure(m, &request);

    BenchMaterials materials;
    code = bench_materials_open(request.materials, &materials);
    request.options.material_count = materials.count;
    request.options.materials = materials.items;
    if (!code) code = bench_measure(m, &request);
    bench_materials_close(&materials);
    return code;
}
