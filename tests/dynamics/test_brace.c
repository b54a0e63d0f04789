// Springs between centres across vertices, with `isotropic`: no step or saved state depends on how they are stored.
#include "sim/scenes.h"

static SingeSimDef braced_def(int threads) {
    SingeSimDef def = scene_def();
    def.solver.isotropic = def.solver.creases = def.solver.tearing = true;
    def.thread_count = threads;
    return def;
}

/// While two sheets burn, tear and crease.
TEST(bytes_do_not_depend_on_threads_or_saving) {
    SingeSimDef def = braced_def(1), hooks = braced_def(3);
    OwnTestScene scene = scene_make(&def, 14);
    test_steps(scene.sim, 60);
    OwnSim *other = test_reload(&hooks, scene.sim);
    static float flux = 2000; // the scene's
    test_ok(other, singe_sim_set_source_callback(other, scene.callback, scene_flux, &flux));
    test_steps(scene.sim, 60), test_steps(other, 60);
    assert_true(singe_sim_stats(scene.sim).mass_burnt > 0);
    test_assert_same(scene.sim, other);
}

/// A flat sheet, a tube and a torus are at rest with their braces.
TEST(rest_shapes_have_no_braces_to_move_them) {
    for (int shape = 0; shape < 3; shape++) {
        SingeSimDef def = singe_default_sim();
        def.solver.isotropic = true;
        def.gravity[2] = 0;
        TestMesh mesh = shape == 0   ? test_grid(6, 5, 0.01f, 0.01f)
                        : shape == 1 ? test_cylinder(12, 4, 0.02f, 0.04f)
                                     : test_torus(16, 8, 0.05f, 0.02f);
        OwnSim *sim = test_sim(&def, mesh, NULL);
        test_steps(sim, 20);
        const SingeView view = singe_sim_view(sim);
        for (uint32_t i = 0; i < view.particle_count; i++)
            for (int k = 0; k < 3; k++) assert_float_equal(view.position[i][k], view.rest_position[i][k], 1e-6f);
    }
}

/// A single cell and a strip of single cells have no braces.
TEST(meshes_without_inner_vertices_have_none) {
    for (uint32_t cells = 1; cells < 4; cells++) {
        SingeSimDef def = singe_default_sim();
        def.solver.isotropic = true;
        OwnSim *sim = test_sim(&def, test_grid(cells, 1, 0.01f, 0.01f), NULL);
        test_steps(sim, 3);
    }
}
