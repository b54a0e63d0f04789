#include "bench/bench_materials.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/job.h"
#include "cli/text.h"

BenchMaterial bench_material(const SceneMaterial *material) {
    BenchMaterial bench = {.name = material->name ? material->name : "-",
                           .def = material->def,
                           .calibrated = material->measured.given && material->measured.calibrated};
    memcpy(bench.speed, material->measured.speed, sizeof bench.speed);
    memcpy(bench.temperature, material->measured.temperature, sizeof bench.temperature);
    memcpy(bench.residue, material->measured.residue, sizeof bench.residue);
    return bench;
}

/// A material is read as the material of a sheet in a scene, so that its errors are reported in the same way.
static ExitCode read_one(const char *name, size_t length, BenchMaterials *materials) {
    static const char text[] = "sheets: [{grid: {size: [1, 1], cells: [1, 1]}}]";
    char *set = text_format("sheets.0.material.base=%.*s", (int)length, name);
    const char *sets[] = {set};
    SceneMessages messages = {0};
    Scene **scene = &materials->scenes[materials->count];
    SingeResult result = scene_parse("material", text, sizeof text - 1, ".", sets, 1, scene, &messages);

    scene_messages_print(&messages, stderr);
    scene_messages_free(&messages);
    free(set);
    if (!result) materials->items[materials->count++] = bench_material(&(*scene)->sheets[0].material);
    return job_exit(result);
}

ExitCode bench_materials_open(const char *list, BenchMaterials *materials) {
    ExitCode code = EXIT_GOOD;
    const char *name;
    *materials = (BenchMaterials){0};
    for (int i = 0; !list && !code && (name = scene_material_name(i)) && i < BENCH_MATERIALS_MAX; i++)
        code = read_one(name, strlen(name), materials);
    while (list && !code) {
        size_t length = strcspn(list, ",");
        if (materials->count == BENCH_MATERIALS_MAX) {
            fprintf(stderr, "singe bench: error: at most %d materials\n", BENCH_MATERIALS_MAX);
            return EXIT_INPUT;
        }
        code = read_one(list, length, materials);
        list = list[length] ? list + length + 1 : NULL;
    }

    return code;
}

void bench_materials_close(BenchMaterials *materials) {
    for (int i = 0; i < BENCH_MATERIALS_MAX; i++) scene_free(materials->scenes[i]);
    *materials = (BenchMaterials){0};
}
