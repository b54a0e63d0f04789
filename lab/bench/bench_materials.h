// The materials that `singe bench` burns.
#pragma once

#include "bench/options.h"
#include "cli/cli.h"
#include "scene/scene.h"

enum { BENCH_MATERIALS_MAX = 16 };

typedef struct BenchMaterials {
    int count;
    BenchMaterial items[BENCH_MATERIALS_MAX];
    Scene *scenes[BENCH_MATERIALS_MAX]; ///< the scenes that own them
} BenchMaterials;

/// Reads "office-paper,./mine.yaml", or all built-in ones (NULL). Messages have been printed unless the result is
/// EXIT_GOOD. Close it in any case.
ExitCode bench_materials_open(const char *list, BenchMaterials *materials);
void bench_materials_close(BenchMaterials *materials);

/// The material of a scene, as it is simulated.
BenchMaterial bench_material(const SceneMaterial *material);
