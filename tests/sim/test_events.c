// Events: an ignition for every particle that ignites, one hole for one disc, one piece for one cut.
#include "scenes.h"

static SingeSimDef calm(void) {
    SingeSimDef def = singe_default_sim();
    memset(def.gravity, 0, sizeof def.gravity);
    def.time_step = 1.0f / 240;
    return def;
}

TEST(a_particle_ignites_once) {
    OwnTestScene scene = scene_make(NULL, 14);
    SingeView view = singe_sim_view(scene.sim);
    unsigned char *seen = calloc(view.particle_count, 1);

    assert_non_null(seen);
    for (int i = 0; i < 120; i++) {
        double before = singe_sim_view(scene.sim).time;
        test_ok(scene.sim, singe_sim_step(scene.sim));

        size_t count;
        const SingeEvent *events = singe_sim_events(scene.sim, &count);
        int32_t last = -1;
        for (size_t k = 0; k < count; k++) {
            assert_true(events[k].time >= before && events[k].time <= singe_sim_view(scene.sim).time);
            for (int a = 0; a < 3; a++) assert_true(isfinite(events[k].position[a]));
            if (events[k].kind != SINGE_EVENT_IGNITED) continue;
            assert_true(events[k].element > last && (uint32_t)events[k].element < view.particle_count); // in order
            last = events[k].element;
            assert_int_equal(seen[last]++, 0);
            assert_true(view.time_ignited[last] == (float)events[k].time);
        }
    }

    uint32_t ignited = 0;
    for (uint32_t i = 0; i < view.particle_count; i++) {
        assert_int_equal(seen[i], view.time_ignited[i] >= 0);
        ignited += seen[i];
    }

    assert_true(ignited > 50);
    free(seen);
}

typedef struct Tally {
    int ignited, holes, pieces;
    SingeEvent hole, piece;
} Tally;

static void tally(const SingeSim *sim, Tally *tally_) {
    size_t count;
    const SingeEvent *events = singe_sim_events(sim, &count);
    for (size_t k = 0; k < count; k++) {
        tally_->ignited += events[k].kind == SINGE_EVENT_IGNITED;
        if (events[k].kind == SINGE_EVENT_HOLE_OPENED) tally_->holes++, tally_->hole = events[k];
        if (events[k].kind == SINGE_EVENT_PIECE_FREED) tally_->pieces++, tally_->piece = events[k];
    }
}

TEST(a_disc_burns_one_hole) {
    SingeSimDef def = calm();
    SingeMaterialDef material = scene_quick_material();
    OwnSim *sim = test_sim(&def, test_grid(24, 24, 0.005f, 0.005f), &material);

    test_spot(sim, 0.061f, 0.0605f, 0, 0.01f, 1500, 2000);
    Tally seen = {0};
    for (int i = 0; i < 400 && singe_sim_stats(sim).burnt_fraction < 0.25; i++) {
        uint64_t version = singe_sim_view(sim).topology_version;
        uint32_t springs = singe_sim_stats(sim).springs;
        test_ok(sim, singe_sim_step(sim));
        tally(sim, &seen);
        assert_int_equal(singe_sim_view(sim).topology_version > version, singe_sim_stats(sim).springs < springs);
    }

    assert_true(singe_sim_stats(sim).mass_removed > 0);
    assert_int_equal(seen.holes, 1);
    assert_int_equal(seen.pieces, 0);
    assert_true(hypotf(seen.hole.position[0] - 0.06f, seen.hole.position[1] - 0.06f) < 0.012f);
    assert_true(singe_sim_view(sim).time_burnt[seen.hole.element] >= 0);
    assert_int_equal(singe_sim_stats(sim).pieces, 1);
}

/// Heats a line across the strip at rest position x.
static void hot_line(void *context, const struct SingeView *view, float *flux, float *conductance,
                     float *conductance_temperature) {
    (void)flux;
    float x = *(float *)context;
    for (uint32_t i = 0; i < view->particle_count; i++)
        if (fabsf(view->rest_position[i][0] - x) < 0.006f)
            conductance[i] += 1000, conductance_temperature[i] += 1000 * 1300;
}

TEST(a_cut_makes_one_piece) {
    SingeSimDef def = calm();
    SingeMaterialDef material = scene_quick_material();
    material.heat_share = singe_param(0); // burns where it is heated and nowhere else
    OwnSim *sim = test_sim(&def, test_grid(30, 4, 0.005f, 0.005f), &material);
    float line = 0.05f;
    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_CALLBACK, source.callback = hot_line, source.callback_context = &line;
    test_add_source(sim, &source);

    Tally seen = {0};
    for (int i = 0; i < 400; i++) {
        test_ok(sim, singe_sim_step(sim));
        tally(sim, &seen);
    }

    SingeView view = singe_sim_view(sim);
    assert_int_equal(singe_sim_stats(sim).pieces, 2);
    assert_int_equal(seen.pieces, 1);

    // the larger part, on the right, keeps its id; the left one is new
    assert_int_equal(view.piece[30], 0);
    assert_int_equal(seen.piece.element, view.piece[0]);
    assert_true(view.piece[0] > 0);

    for (uint32_t i = 0; i < view.particle_count; i++) {
        bool alive = view.particle_flags[i] & SINGE_ALIVE;
        int32_t expected = !alive ? -1 : view.rest_position[i][0] > line ? 0 : view.piece[0];
        assert_int_equal(view.piece[i], expected);
    }
}

/// The switches: nothing goes with ablation off, or with m_loss under m_min.
TEST(no_cells_vanish_with_ablation_off) {
    for (int which = 0; which < 2; which++) {
        SingeSimDef def = calm();
        SingeMaterialDef material = scene_quick_material();
        if (which) material.mass_loss = singe_param(0.1f);
        else material.ablate = false;
        OwnSim *sim = test_sim(&def, test_grid(10, 10, 0.005f, 0.005f), &material);
        test_spot(sim, 0.025f, 0.025f, 0, 0.02f, 1500, 2000);

        Tally seen = {0};
        for (int i = 0; i < 150; i++) {
            test_ok(sim, singe_sim_step(sim));
            tally(sim, &seen);
        }

        SingeStats stats = singe_sim_stats(sim);
        assert_true(stats.burnt_fraction > 0.3);
        assert_true(stats.mass_removed == 0);
        assert_int_equal(stats.particles, singe_sim_view(sim).particle_count);
        assert_int_equal(seen.holes + seen.pieces, 0);
        assert_true(seen.ignited > 50);
    }
}
