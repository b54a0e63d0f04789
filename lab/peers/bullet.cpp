// The swinging sheet of `singe bench swing` in Bullet's soft bodies, for scripts/bench_peers.py.
// Usage: bullet CELLS FRAMES STEPS ITERATIONS OUT: prints the milliseconds of processor time of each frame, and writes the
// positions of its (CELLS + 1)^2 nodes, row by row, to OUT.
#include <btBulletDynamicsCommon.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>

int main(int argc, char **argv) {
    if (argc != 6) return 2;
    const int cells = std::atoi(argv[1]), frames = std::atoi(argv[2]), steps = std::atoi(argv[3]);
    FILE *out = std::fopen(argv[5], "wb");
    if (!out) return 1;

    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    const btVector3 gravity(0, 0, -9.81f);
    world.setGravity(gravity);
    btSoftBodyWorldInfo &info = world.getWorldInfo();
    info.m_gravity = gravity;
    info.air_density = 0;
    info.m_sparsesdf.Initialize();

    // 1 m x 1 m, 0.1 kg, held at two corners beside each other
    btSoftBody *sheet = btSoftBodyHelpers::CreatePatch(info, btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0),
                                                       btVector3(1, 1, 0), cells + 1, cells + 1, 1 + 2, true);
    sheet->m_materials[0]->m_kLST = 1;
    sheet->m_cfg.piterations = std::atoi(argv[4]);
    sheet->m_cfg.collisions = 0;
    sheet->setTotalMass(0.1f);
    world.addSoftBody(sheet);

    for (int frame = 0; frame < frames; frame++) {
        const clock_t began = std::clock();
        for (int step = 0; step < steps; step++) world.stepSimulation(1 / (24.f * (float)steps), 0);
        std::printf("%.4f\n", 1e3 * (double)(std::clock() - began) / CLOCKS_PER_SEC);
        for (int i = 0; i < sheet->m_nodes.size(); i++) {
            const float at[3] = {(float)sheet->m_nodes[i].m_x.x(), (float)sheet->m_nodes[i].m_x.y(),
                                 (float)sheet->m_nodes[i].m_x.z()};
            std::fwrite(at, sizeof at, 1, out);
        }
    }

    world.removeSoftBody(sheet);
    delete sheet;
    return std::fclose(out) ? 1 : 0;
}
