// The swinging sheet of `singe bench swing`, or the falling one of `singe bench drop`, in NvCloth, for
// scripts/bench_peers.py.
// Usage: nvcloth CELLS FRAMES STEPS ITERATIONS OUT [drop]: prints the milliseconds of processor time of each frame, and
// writes the positions of its (CELLS + 1)^2 particles, row by row, to OUT.
#include <NvCloth/Callbacks.h>
#include <NvCloth/Cloth.h>
#include <NvCloth/Fabric.h>
#include <NvCloth/Factory.h>
#include <NvCloth/Solver.h>
#include <NvClothExt/ClothFabricCooker.h>
#include <foundation/PxAllocatorCallback.h>
#include <foundation/PxErrorCallback.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

using namespace nv::cloth;
using physx::PxU32;
using physx::PxVec3;
using physx::PxVec4;

struct Heap : physx::PxAllocatorCallback {
    void *allocate(size_t size, const char *, const char *, int) override {
        return std::aligned_alloc(16, (size + 15) / 16 * 16);
    }
    void deallocate(void *memory) override { std::free(memory); }
};

struct Errors : physx::PxErrorCallback {
    void reportError(physx::PxErrorCode::Enum, const char *message, const char *, int) override {
        std::fprintf(stderr, "%s\n", message);
    }
};

struct Asserts : nv::cloth::PxAssertHandler {
    void operator()(const char *text, const char *, int, bool &) override { std::fprintf(stderr, "%s\n", text); }
};

int main(int argc, char **argv) {
    if (argc != 6 && !(argc == 7 && !std::strcmp(argv[6], "drop"))) return 2;
    const int cells = std::atoi(argv[1]), frames = std::atoi(argv[2]), steps = std::atoi(argv[3]);
    const bool drop = argc == 7;
    const float cell = 1 / (float)cells, step = 1 / (24.f * (float)steps);
    FILE *out = std::fopen(argv[5], "wb");
    if (!out) return 1;

    static Heap heap;
    static Errors errors;
    static Asserts asserts;
    InitializeNvCloth(&heap, &errors, &asserts, nullptr);
    Factory *factory = NvClothCreateFactoryCPU();

    // 1 m x 1 m, 0.1 kg: held at two corners beside each other, or free and above the sphere
    const int side = cells + 1;
    const float high = drop ? 0.61f : 0;
    std::vector<PxVec3> points;
    std::vector<PxVec4> particles;
    std::vector<uint32_t> quads;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            const bool held = !drop && j == 0 && (i == 0 || i == cells);
            points.push_back(PxVec3((float)i * cell - 0.5f, (float)j * cell - 0.5f, high));
            particles.push_back(PxVec4(points.back(), held ? 0 : (float)(side * side) / 0.1f));
        }
    for (int j = 0; j < cells; j++)
        for (int i = 0; i < cells; i++)
            for (int corner : {0, 1, side + 1, side}) quads.push_back((uint32_t)(j * side + i + corner));

    ClothMeshDesc mesh;
    mesh.setToDefault();
    mesh.points.data = points.data(), mesh.points.stride = sizeof(PxVec3), mesh.points.count = (PxU32)points.size();
    mesh.quads.data = quads.data(), mesh.quads.stride = 16, mesh.quads.count = (PxU32)quads.size() / 4;
    std::vector<float> inverse;
    for (const PxVec4 &particle : particles) inverse.push_back(particle.w);
    mesh.invMasses.data = inverse.data(), mesh.invMasses.stride = 4, mesh.invMasses.count = (PxU32)inverse.size();
    const PxVec3 gravity(0, 0, -9.81f);
    nv::cloth::Vector<int32_t>::Type types;
    Fabric *fabric = NvClothCookFabricFromMesh(factory, mesh, gravity, &types, true);
    if (!fabric) return 1;
    Cloth *cloth = factory->createCloth(Range<const PxVec4>(particles.data(), particles.data() + particles.size()), *fabric);

    // Edges only, as stiff as possible: with diagonals it takes 1.4 times as long, for more strain. An iteration is a substep,
    // whose stiffness is 1 only if the stiffness's frequency is far above the substeps'.
    const float frequency = (float)std::atoi(argv[4]) / step;
    std::vector<PhaseConfig> phases;
    for (uint32_t k = 0; k < fabric->getNumPhases(); k++)
        if (types[(int)k] == ClothFabricPhaseType::eVERTICAL || types[(int)k] == ClothFabricPhaseType::eHORIZONTAL)
            phases.push_back(PhaseConfig((uint16_t)k));
    cloth->setPhaseConfig(Range<const PhaseConfig>(phases.data(), phases.data() + phases.size()));
    cloth->setGravity(gravity);
    cloth->setDamping(PxVec3(0));
    cloth->setLinearDrag(PxVec3(0)), cloth->setAngularDrag(PxVec3(0));
    cloth->setSolverFrequency(frequency);
    cloth->setStiffnessFrequency(10 * frequency);
    if (drop) { // its parts keep off each other by their particles alone, so by most of a cell
        const PxVec4 ball(0, 0, 0.3f, 0.3f), ground(0, 0, 1, 0);
        const uint32_t mask = 1;
        cloth->setSpheres(Range<const PxVec4>(&ball, &ball + 1), 0, 0);
        cloth->setPlanes(Range<const PxVec4>(&ground, &ground + 1), 0, 0);
        cloth->setConvexes(Range<const uint32_t>(&mask, &mask + 1), 0, 0);
        cloth->setFriction(0.3f);
        cloth->setSelfCollisionDistance(0.7f * cell);
        cloth->setSelfCollisionStiffness(1);
    }

    Solver *solver = factory->createSolver();
    solver->addCloth(cloth);
    for (int frame = 0; frame < frames; frame++) {
        const clock_t began = std::clock();
        for (int k = 0; k < steps; k++)
            if (solver->beginSimulation(step)) {
                for (int chunk = 0; chunk < solver->getSimulationChunkCount(); chunk++) solver->simulateChunk(chunk);
                solver->endSimulation();
            }
        std::printf("%.4f\n", 1e3 * (double)(std::clock() - began) / CLOCKS_PER_SEC);
        const MappedRange<const PxVec4> at = static_cast<const Cloth *>(cloth)->getCurrentParticles();
        for (uint32_t i = 0; i < at.size(); i++) std::fwrite(&at[i], 3 * sizeof(float), 1, out);
    }

    solver->removeCloth(cloth);
    NV_CLOTH_DELETE(solver);
    NV_CLOTH_DELETE(cloth);
    fabric->decRefCount();
    NvClothDestroyFactory(factory);
    return std::fclose(out) ? 1 : 0;
}
